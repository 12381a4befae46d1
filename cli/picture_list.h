/* SPDX-License-Identifier: MIT
 * picture_list.h - the pictures that a word on the command line stands for: one file, or a sequence. */
#ifndef HELIOSTAT_CLI_PICTURE_LIST_H
#define HELIOSTAT_CLI_PICTURE_LIST_H

#include "options.h"

typedef enum picture_list_kind {
    LIST_FILE,     /* one picture */
    LIST_NUMBERED, /* frame_%04d.exr: in the order of their numbers */
    LIST_GLOB,     /* 'out/?.exr': in natural order, 2 before 10 */
    LIST_FOLDER,   /* the pictures in it, likewise */
} picture_list_kind;

typedef struct listed_picture {
    char *path;
    uint64_t number; /* in its name; else counted from 0 */
} listed_picture;

typedef struct picture_list {
    const char *word;
    picture_list_kind kind;
    listed_picture *pictures;
    size_t count, capacity;
} picture_list;

/* Files that exist win over patterns. frames: which numbers to take. The word stays the caller's. Returns an exit code;
 * one sentence on stderr tells where there is no such file or not one frame of those. Release it in any case. */
int picture_list_find(picture_list *list, const char *word, const frame_range *frames);
void picture_list_release(picture_list *list);

/* Finds the partner of picture i in another list: the one file there is; that of the same number where both are
 * numbered, whatever else that list has; otherwise that in the same place, of equally many, and with the same name but
 * for its ending where both are folders. Returns an exit code, as above. */
int picture_list_partner(const picture_list *list, const picture_list *partners, size_t i, const char **path);

#endif
