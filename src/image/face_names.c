/* SPDX-License-Identifier: MIT */
#include "image/face_names.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

enum { FACES = 6, SPELLINGS = 6 };

static const char *const NAMES[FACES][SPELLINGS] = {
    {"px", "posx", "right", "+x", "x+", NULL}, {"nx", "negx", "left", "-x", "x-", NULL},
    {"py", "posy", "top", "up", "+y", "y+"},   {"ny", "negy", "bottom", "down", "-y", "y-"},
    {"pz", "posz", "front", "+z", "z+", NULL}, {"nz", "negz", "back", "-z", "z-", NULL},
};

static const char *const LISTS[FACES] = {
    "px, posx, right, +x or x+",        "nx, negx, left, -x or x-",  "py, posy, top, up, +y or y+",
    "ny, negy, bottom, down, -y or y-", "pz, posz, front, +z or z+", "nz, negz, back, -z or z-",
};

int face_names_find(const char *text, size_t length, bool digits)
{
    if (digits && length == 1 && text[0] >= '0' && text[0] < '0' + FACES)
        return text[0] - '0';
    for (int i = 0; i < FACES * SPELLINGS; i++) {
        const char *name = NAMES[i / SPELLINGS][i % SPELLINGS];
        if (name != NULL && strlen(name) == length && strncasecmp(name, text, length) == 0)
            return i / SPELLINGS;
    }
    return -1;
}

int face_names_find_last(const char *name, size_t *begin, size_t *end)
{
    const char *dot = strrchr(name, '.');
    *end = dot != NULL ? (size_t)(dot - name) : strlen(name);
    for (*begin = 0; *begin < *end; (*begin)++) {
        bool alone = *begin == 0 || !isalnum((unsigned char)name[*begin - 1]) || !isalnum((unsigned char)name[*begin]);
        int face = alone ? face_names_find(name + *begin, *end - *begin, false) : -1;
        if (face >= 0)
            return face;
    }
    return -1;
}

const char *face_names_all(int face)
{
    return LISTS[face];
}
