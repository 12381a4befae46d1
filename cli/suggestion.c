/* SPDX-License-Identifier: MIT */
#include "suggestion.h"

#include <string.h>

enum { LONGEST_WORD = 32 };

static size_t least(size_t a, size_t b, size_t c)
{
    size_t least_of_two = a < b ? a : b;
    return least_of_two < c ? least_of_two : c;
}

/* How many letters must be put in, taken out or changed to make one word from the other (Levenshtein). */
static size_t edit_distance(const char *from, size_t from_length, const char *to, size_t to_length)
{
    size_t row[LONGEST_WORD + 1];
    for (size_t j = 0; j <= to_length; j++)
        row[j] = j;
    for (size_t i = 1; i <= from_length; i++) {
        size_t diagonal = row[0];
        row[0] = i;
        for (size_t j = 1; j <= to_length; j++) {
            size_t above = row[j];
            row[j] = least(above + 1, row[j - 1] + 1, diagonal + (from[i - 1] != to[j - 1]));
            diagonal = above;
        }
    }
    return row[to_length];
}

void suggestion_consider(word_suggestion *suggestion, const char *candidate)
{
    size_t length = strlen(suggestion->word), candidate_length = strlen(candidate);
    if (length == 0 || length > LONGEST_WORD || candidate_length > LONGEST_WORD)
        return;
    size_t distance = edit_distance(suggestion->word, length, candidate, candidate_length);
    size_t bearable = length < 4 ? 1 : 1 + length / 4;
    if (distance <= bearable && (suggestion->best == NULL || distance < suggestion->distance)) {
        suggestion->best = candidate;
        suggestion->distance = distance;
    }
}
