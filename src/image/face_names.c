/* SPDX-License-Identifier: MIT */
#include "image/face_names.h"

#include <ctype.h>
#include <string.h>
#include <strings.h>

enum { FACES = 6, SPELLINGS = 10 };

static const char *const NAMES[FACES][SPELLINGS] = {
    {"px", "posx", "pos_x", "positive_x", "xp", "right", "rt", "+x", "x+", NULL},
    {"nx", "negx", "neg_x", "negative_x", "xn", "left", "lf", "-x", "x-", NULL},
    {"py", "posy", "pos_y", "positive_y", "yp", "top", "up", "+y", "y+", NULL},
    {"ny", "negy", "neg_y", "negative_y", "yn", "bottom", "down", "dn", "-y", "y-"},
    {"pz", "posz", "pos_z", "positive_z", "zp", "front", "ft", "+z", "z+", NULL},
    {"nz", "negz", "neg_z", "negative_z", "zn", "back", "bk", "-z", "z-", NULL},
};

static const char *const LISTS[FACES] = {
    "px, posx, right, rt or +x",        "nx, negx, left, lf or -x",  "py, posy, top, up or +y",
    "ny, negy, bottom, down, dn or -y", "pz, posz, front, ft or +z", "nz, negz, back, bk or -z",
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

int face_names_find_last(const char *name, bool digits, size_t *begin, size_t *end)
{
    const char *dot = strrchr(name, '.');
    *end = dot != NULL ? (size_t)(dot - name) : strlen(name);
    for (*begin = 0; *begin < *end; (*begin)++) {
        bool alone = *begin == 0 || !isalnum((unsigned char)name[*begin - 1]) || !isalnum((unsigned char)name[*begin]);
        int face = alone ? face_names_find(name + *begin, *end - *begin, digits) : -1;
        if (face >= 0)
            return face;
    }
    return -1;
}

const char *face_names_usual(int face)
{
    return LISTS[face];
}
