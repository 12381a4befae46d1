/* SPDX-License-Identifier: MIT
 * suggestion.h - the known word that is nearest to a mistyped one. */
#ifndef HELIOSTAT_CLI_SUGGESTION_H
#define HELIOSTAT_CLI_SUGGESTION_H

#include <stddef.h>

/* Start from {.word = "..."}; best is NULL until a candidate is near enough to be worth a mention. */
typedef struct word_suggestion {
    const char *word;
    const char *best;
    size_t distance;
} word_suggestion;

void suggestion_consider(word_suggestion *suggestion, const char *candidate);

#endif
