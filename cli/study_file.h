/* SPDX-License-Identifier: MIT
 * study_file.h - options in a JSON file, turned into words of a command line. */
#ifndef HELIOSTAT_CLI_STUDY_FILE_H
#define HELIOSTAT_CLI_STUDY_FILE_H

typedef struct study_file {
    char **words; /* those of the file, which are ours, then those of the command line, which are not */
    int count;    /* of all */
    int owned;    /* of the file */
} study_file;

/* Reads an object such as {"strategies": ["face", "light"], "spp": [4, 16], "size": "640x360", "no-beta": true}: the
 * words --strategies=face;light and so on, and after them the others, so that the command line counts more. Returns an
 * exit code; one sentence on stderr tells what is wrong. Release it in any case. */
int study_file_read(study_file *file, const char *path, int count, char **words);
void study_file_release(study_file *file);

#endif
