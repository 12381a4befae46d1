/* SPDX-License-Identifier: MIT
 * image_support.h - a context that counts its memory, a directory for files, and checks for tests that read pictures.
 */
#ifndef HELIOSTAT_TESTS_IMAGE_SUPPORT_H
#define HELIOSTAT_TESTS_IMAGE_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <heliostat/image.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct fixture {
    helio_context *context;
    char directory[64];
    size_t blocks;      /* that the library holds */
    size_t largest;     /* bytes asked for at once since this was set to 0 */
    size_t allowed;     /* allocations that succeed before all fail */
    unsigned warnings;  /* in the log */
    unsigned notices;   /* in the log, at the level of information */
    char warning[1024]; /* the last one */
} fixture;

static inline void *fixture_allocate(void *user, size_t bytes, size_t alignment)
{
    fixture *f = user;
    f->largest = bytes > f->largest ? bytes : f->largest;
    if (f->allowed == 0)
        return NULL;
    f->allowed--;
    f->blocks++;
    return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static inline void fixture_release(void *user, void *memory)
{
    ((fixture *)user)->blocks--;
    free(memory);
}

static inline void fixture_log(void *user, helio_log_level level, const char *message)
{
    fixture *f = user;
    f->notices += level == HELIO_LOG_INFO;
    if (level > HELIO_LOG_WARNING)
        return;
    f->warnings++;
    snprintf(f->warning, sizeof f->warning, "%s", message);
}

static inline int fixture_setup(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    strcpy(f->directory, "/tmp/heliostat-test-XXXXXX");
    f->allowed = SIZE_MAX;
    helio_context_desc desc = {.threads = 1,
                               .log_level = HELIO_LOG_DEBUG,
                               .log = fixture_log,
                               .allocate = fixture_allocate,
                               .release = fixture_release,
                               .user = f};
    *state = f;
    return mkdtemp(f->directory) && helio_context_create(&desc, &f->context) == HELIO_OK ? 0 : -1;
}

/* Also finds leaks and files left behind: tests remove the files that they make. */
static inline int fixture_teardown(void **state)
{
    fixture *f = *state;
    helio_context_destroy(f->context);
    bool clean = f->blocks == 0 && rmdir(f->directory) == 0;
    if (!clean)
        print_error("%zu blocks of memory leaked, or files are left in %s\n", f->blocks, f->directory);
    free(f);
    return clean ? 0 : -1;
}

/* A name in the test's directory; valid until the next call. */
static inline const char *fixture_path(const fixture *f, const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", f->directory, name);
    return path;
}

static inline void write_file(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

/* The whole file, to be freed. */
static inline unsigned char *read_file(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    fseek(stream, 0, SEEK_END);
    *size = (size_t)ftell(stream);
    rewind(stream);
    unsigned char *bytes = malloc(*size + 1);
    assert_int_equal(fread(bytes, 1, *size, stream), *size);
    fclose(stream);
    return bytes;
}

static inline helio_image *read_image(fixture *f, const char *path)
{
    helio_image *image = NULL;
    helio_status status = helio_image_read(f->context, path, NULL, &image);
    if (status != HELIO_OK)
        print_error("%s\n", helio_last_error());
    assert_int_equal(status, HELIO_OK);
    assert_non_null(image);
    return image;
}

static inline void expect_failure(fixture *f, const char *path, helio_status expected)
{
    helio_image *image = (helio_image *)f;
    helio_status status = helio_image_read(f->context, path, NULL, &image);
    if (status != expected)
        print_error("%s: %s, %s\n", path, helio_status_name(status), helio_last_error());
    assert_int_equal(status, expected);
    assert_null(image);
    assert_non_null(strstr(helio_last_error(), path));
    assert_true(strlen(helio_last_error()) > strlen(path) + 8);
}

/* Writes the bytes to a file, which must not be taken for a picture, and removes it. */
static inline void expect_bad_bytes(fixture *f, const void *bytes, size_t size)
{
    const char *path = fixture_path(f, "bad");
    write_file(path, bytes, size);
    expect_failure(f, path, HELIO_ERR_DATA);
    unlink(path);
}

/* No beginning of a good file is good; a file that ends early by less than tail bytes may be. */
static inline void expect_bad_beginnings(fixture *f, const char *good, size_t tail)
{
    size_t size;
    unsigned char *bytes = read_file(good, &size);
    size_t step = size / 300 + 1;
    for (size_t length = 0; length + tail < size; length += step)
        expect_bad_bytes(f, bytes, length);
    free(bytes);
}

/* Whatever the bytes, a picture or a sentence. One byte at a time is changed. */
static inline void expect_no_harm_from_changes(fixture *f, const char *good, unsigned count)
{
    size_t size;
    unsigned char *bytes = read_file(good, &size);
    uint32_t random = 1;
    const char *path = fixture_path(f, "changed");
    for (unsigned i = 0; i < count; i++) {
        random = random * 1664525u + 1013904223u;
        size_t at = random >> 8 & 1 ? (random >> 9) % size : (random >> 9) % (size < 400 ? size : 400);
        unsigned char before = bytes[at];
        bytes[at] = (unsigned char)(random >> 24);
        write_file(path, bytes, size);
        helio_image *image;
        if (helio_image_read(f->context, path, &(helio_image_read_desc){.max_pixels = 1 << 20}, &image) == HELIO_OK)
            helio_image_destroy(f->context, image);
        else
            assert_non_null(strstr(helio_last_error(), path));
        bytes[at] = before;
    }
    unlink(path);
    free(bytes);
}

/* Wherever memory runs out, it is said so and nothing is kept. */
static inline void expect_memory_failures(fixture *f, const char *path)
{
    size_t failures = 0;
    for (helio_status status = HELIO_ERR_MEMORY; status != HELIO_OK; failures++) {
        helio_image *image;
        size_t before = f->blocks;
        f->allowed = failures;
        status = helio_image_read(f->context, path, NULL, &image);
        f->allowed = SIZE_MAX;
        assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
        helio_image_destroy(f->context, image);
        assert_int_equal(f->blocks, before);
    }
    assert_true(failures > 3);
}

/* The data folder's sub-folder, or NULL after saying what is skipped. */
static inline const char *data_path(const char *sub)
{
    static char path[1024];
    const char *data = getenv("HELIO_TEST_DATA");
    snprintf(path, sizeof path, "%s/%s", data ? data : "", sub);
    if (data != NULL && data[0] != 0 && access(path, R_OK) == 0)
        return path;
    print_message("skipped: HELIO_TEST_DATA has no %s\n", sub);
    return NULL;
}

/* Reads all files of a folder: each gives a picture or a sentence. Returns how many gave a picture. */
static inline unsigned read_folder(fixture *f, const char *folder)
{
    unsigned pictures = 0, files = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        if (entry->d_name[0] == '.')
            continue;
        char path[2048];
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        helio_image *image;
        files++;
        if (helio_image_read(f->context, path, NULL, &image) == HELIO_OK)
            pictures++;
        else
            assert_non_null(strstr(helio_last_error(), path));
        helio_image_destroy(f->context, image);
    }
    closedir(directory);
    assert_true(files > 0);
    return pictures;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, fixture_setup, fixture_teardown)

static inline uint64_t bad_pixels(const helio_image *image)
{
    return image->bad.nan + image->bad.infinite + image->bad.negative;
}

#endif
