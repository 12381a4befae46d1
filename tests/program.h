/* SPDX-License-Identifier: MIT
 * program.h - the heliostat program as the tests run it: command lines in; exit codes, sentences and files out.
 * HELIOSTAT_PROGRAM names the program. One program at a time.
 *
 * Runs are calls of the program's main() in a child of the test: to start the file takes ten times as long, as a
 * hundred libraries have to be linked. The file itself is started by thorough runs, by the tests on terminals and by
 * check_install. */
#ifndef HELIOSTAT_TESTS_PROGRAM_H
#define HELIOSTAT_TESTS_PROGRAM_H

#include "support.h"

#include <jansson.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/types.h>

/* ---- set-up ---- */

/* For the whole group: finds the program and makes a folder for all tests; removes it with everything in it. */
int set_up_program(void **state);
int tear_down_program(void **state);

/* For each test: goes to a folder that holds nothing but tetrahedron.obj, and sets program_limits to {0}. */
int set_up_folder(void **state);

#define program_test(function) cmocka_unit_test_setup(function, set_up_folder)

/* What a build may be without. */
enum { NEEDS_RENDERER = 1, NEEDS_PNG = 2, NEEDS_EXR = 4, NEEDS_ALL = 7 };

/* Skips the test, and says so, if this build lacks one of them. */
void skip_without(unsigned features);

/* ---- runs ---- */

int heliostat_main(int count, char **arguments);

/* Of the programs that are started from here on; 0: none. */
typedef struct program_limit {
    rlim_t file_size; /* bytes of each file that it writes; what a full disk does */
    unsigned seconds; /* by the clock, after which SIGALRM ends it */
} program_limit;

extern program_limit program_limits;

/* What the program wrote to stdout and stderr, after finish_program() and whatever calls it. */
extern char program_out[1 << 17], program_err[1 << 17];

/* Starts "heliostat LINE": of words with a blank between them, or of words that NULL ends. stdin is empty. */
pid_t start_program(const char *line);
pid_t start_program_words(const char *const *words);

/* Waits until the program says the word on stdout or stderr, minutes at most. Did it? The program goes on. */
bool program_says(const char *word);

/* Returns the exit code; minus the signal's number where a signal ended the program. usage: of the program with the
 * processes that it made; may be NULL. */
int finish_program(pid_t child, struct rusage *usage);

int run_program(const char *line);

/* Fails the test unless the exit code is 0. */
void succeeds(const char *line);

/* Fails the test unless the exit code is this one, stdout is empty, and stderr is one line which starts with the
 * program's name and holds the word. */
void fails(const char *line, int code, const char *word);

/* ---- files ---- */

void write_bytes(const char *path, const void *bytes, size_t size);
void write_text(const char *path, const char *text);

/* Returns the length; a 0 follows the last byte. Fails the test if there is no such file, or if it is larger. */
size_t read_text(const char *path, char *text, size_t size);

bool exists(const char *path);
size_t count_files(const char *folder); /* folders in it count as well */

/* ---- JSON ---- */

/* To be given to json_decref(). Fails the test if it is not JSON, or if an object has a key twice. */
json_t *load_json(const char *path);

/* All fail the test if there is none under this key. */
json_t *member(const json_t *object, const char *key);
double number_of(const json_t *object, const char *key);
const char *text_of(const json_t *object, const char *key);

#endif
