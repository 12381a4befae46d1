/* SPDX-License-Identifier: MIT */
#include "program.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Beside the folder in which tests run, so that its files are the program's alone. */
#define OUT_PATH "../out"
#define ERR_PATH "../err"

program_limit program_limits;
char program_out[1 << 17], program_err[1 << 17];

static char program[TEST_PATH_SIZE], root[TEST_PATH_SIZE];

/* ---- set-up ---- */

int set_up_program(void **state)
{
    (void)state;
    const char *named = getenv("HELIOSTAT_PROGRAM");
    if (named == NULL || realpath(named, program) == NULL) {
        print_error("HELIOSTAT_PROGRAM must name the program to test\n");
        return -1;
    }
    unsetenv("HELIOSTAT_ASSETS");
    make_directory(root);
    return chdir(root) != 0 || mkdir("work", 0777) != 0 || chdir("work") != 0 ? -1 : 0;
}

int tear_down_program(void **state)
{
    (void)state;
    if (chdir("/") != 0)
        return -1;
    remove_directory(root);
    return 0;
}

/* Flat faces by normals of their own: without them the shading normals of so coarse a mesh would lose light. */
static void write_tetrahedron(void)
{
    write_text("tetrahedron.obj", "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\n"
                                  "vn -0.57735 0.57735 0.57735\nvn 0.57735 0.57735 -0.57735\n"
                                  "vn 0.57735 -0.57735 0.57735\nvn -0.57735 -0.57735 -0.57735\n"
                                  "f 1//1 3//1 2//1\nf 1//2 4//2 3//2\nf 1//3 2//3 4//3\nf 2//4 3//4 4//4\n");
}

int set_up_folder(void **state)
{
    (void)state;
    program_limits = (program_limit){0};
    if (chdir(root) != 0)
        return -1;
    remove_directory("work");
    if (mkdir("work", 0777) != 0 || chdir("work") != 0)
        return -1;
    write_tetrahedron();
    return 0;
}

static unsigned built_features(void)
{
    unsigned features = 0;
#if defined(HELIO_WITH_EMBREE) && defined(HELIO_WITH_ASSIMP)
    features |= NEEDS_RENDERER;
#endif
#ifdef HELIO_WITH_PNG
    features |= NEEDS_PNG;
#endif
#ifdef HELIO_WITH_OPENEXR
    features |= NEEDS_EXR;
#endif
    return features;
}

void skip_without(unsigned features)
{
    unsigned missing = features & ~built_features();
    if (missing == 0)
        return;
    print_message("skipped: this build has no%s%s%s\n", missing & NEEDS_RENDERER ? " renderer" : "",
                  missing & NEEDS_PNG ? " PNG" : "", missing & NEEDS_EXR ? " OpenEXR" : "");
    skip();
}

/* ---- runs ---- */

static void redirect(int descriptor, const char *path, int flags)
{
    int file = open(path, flags, 0666);
    if (file < 0 || dup2(file, descriptor) < 0)
        _exit(99);
}

/* cmocka's handlers would go on with the test. */
static void reset_signals(void)
{
    for (int number = 1; number < NSIG; number++)
        signal(number, SIG_DFL);
}

_Noreturn static void become_program(int count, char **arguments)
{
    reset_signals();
    redirect(STDIN_FILENO, "/dev/null", O_RDONLY);
    redirect(STDOUT_FILENO, OUT_PATH, O_WRONLY | O_CREAT | O_TRUNC);
    redirect(STDERR_FILENO, ERR_PATH, O_WRONLY | O_CREAT | O_TRUNC);
    if (program_limits.file_size > 0) {
        struct rlimit limit = {program_limits.file_size, program_limits.file_size};
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    alarm(program_limits.seconds);
    if (!is_thorough())
        exit(heliostat_main(count, arguments));
    execv(program, arguments);
    _exit(99);
}

pid_t start_program_words(const char *const *words)
{
    char *arguments[64] = {program};
    int count = 1;
    for (; *words != NULL; count++) {
        assert_true(count < 63);
        arguments[count] = (char *)*words++;
    }
    /* What another run said must not be taken for what this one says. */
    unlink(OUT_PATH);
    unlink(ERR_PATH);
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0)
        become_program(count, arguments);
    return child;
}

pid_t start_program(const char *line)
{
    char text[4096];
    const char *words[64] = {NULL};
    assert_true(snprintf(text, sizeof text, "%s", line) < (int)sizeof text);
    size_t count = 0;
    for (char *word = strtok(text, " "); word != NULL; word = strtok(NULL, " ")) {
        assert_true(count < 63);
        words[count++] = word;
    }
    return start_program_words(words);
}

/* The program makes its files one after the other. */
static bool has_said(const char *word)
{
    if (!exists(OUT_PATH) || !exists(ERR_PATH))
        return false;
    read_text(OUT_PATH, program_out, sizeof program_out);
    read_text(ERR_PATH, program_err, sizeof program_err);
    return strstr(program_out, word) != NULL || strstr(program_err, word) != NULL;
}

bool program_says(const char *word)
{
    for (int i = 0; i < 20000; i++) {
        if (has_said(word))
            return true;
        usleep(10000);
    }
    return false;
}

int finish_program(pid_t child, struct rusage *usage)
{
    int status;
    struct rusage unused;
    assert_int_equal(wait4(child, &status, 0, usage != NULL ? usage : &unused), child);
    read_text(OUT_PATH, program_out, sizeof program_out);
    read_text(ERR_PATH, program_err, sizeof program_err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

int run_program(const char *line)
{
    return finish_program(start_program(line), NULL);
}

void succeeds(const char *line)
{
    int code = run_program(line);
    if (code != 0)
        fail_msg("heliostat %s: exit code %d, %s", line, code, program_err);
}

void fails(const char *line, int expected, const char *word)
{
    int code = run_program(line);
    size_t length = strlen(program_err);
    bool is_sentence = strncmp(program_err, "heliostat: ", 11) == 0 && length > 20 &&
                       strchr(program_err, '\n') == program_err + length - 1;
    if (code != expected || !is_sentence || program_out[0] != 0 || strstr(program_err, word) == NULL)
        fail_msg("heliostat %s: exit code %d in place of %d, no \"%s\" in: %s%s", line, code, expected, word,
                 program_err, program_out);
}

/* ---- files ---- */

void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

void write_text(const char *path, const char *text)
{
    write_bytes(path, text, strlen(text));
}

size_t read_text(const char *path, char *text, size_t size)
{
    FILE *stream = fopen(path, "rb");
    if (stream == NULL)
        fail_msg("%s cannot be opened", path);
    size_t length = fread(text, 1, size - 1, stream);
    if (!feof(stream))
        fail_msg("%s has more than %zu bytes", path, size - 1);
    fclose(stream);
    text[length] = 0;
    return length;
}

bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

size_t count_files(const char *folder)
{
    DIR *stream = opendir(folder);
    assert_non_null(stream);
    size_t count = 0;
    while (readdir(stream) != NULL)
        count++;
    closedir(stream);
    return count - 2; /* . and .. */
}

/* ---- JSON ---- */

json_t *load_json(const char *path)
{
    json_error_t error;
    json_t *json = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (json == NULL)
        fail_msg("%s: %s", path, error.text);
    return json;
}

json_t *member(const json_t *object, const char *key)
{
    json_t *value = json_object_get(object, key);
    if (value == NULL)
        fail_msg("no \"%s\" in %s", key, json_dumps(object, JSON_COMPACT));
    return value;
}

double number_of(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value))
        fail_msg("no number \"%s\" in %s", key, json_dumps(object, JSON_COMPACT));
    return json_number_value(value);
}

const char *text_of(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    if (text == NULL)
        fail_msg("no text \"%s\" in %s", key, json_dumps(object, JSON_COMPACT));
    return text;
}
