/* SPDX-License-Identifier: MIT
 *
 * Ten thousand frames: memory stays flat, as nothing that a frame took is kept when the next one is there. */
#include "support.h"

#include <heliostat/source.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { FRAMES = 10000, KINDS = 4, SETTLED = 1000, PAGES_OF_GROWTH = 512 };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { IS_SANITIZED = 1 }; /* what is released stays in memory for a while */
#else
enum { IS_SANITIZED = 0 };
#endif

static void ignore_log(void *user, helio_log_level level, const char *message)
{
    (void)user;
    (void)level;
    (void)message;
}

static void write_pfm(const char *path, uint32_t width, uint32_t height)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fprintf(stream, "PF\n%u %u\n-1.0\n", width, height);
    for (uint32_t i = 0; i < 3 * width * height; i++)
        fwrite(&(float){0.5f}, sizeof(float), 1, stream);
    assert_int_equal(fclose(stream), 0);
}

static void write_garbage(const char *path)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    fputs("#?RADIANCE\n\n-Y 16 +X 32\nends too early", stream);
    assert_int_equal(fclose(stream), 0);
}

/* A file under each name, though there are only a few files. Pictures are told by their content, so that PNG may be
 * called .pfm. */
static void write_frames(const char *directory, helio_context *context)
{
    static float rgba[32 * 16 * 4];
    const helio_picture picture = {.width = 32, .height = 16, .rgba = rgba};
    char path[TEST_PATH_SIZE + 64], originals[KINDS][TEST_PATH_SIZE + 64];
    static const char *const names[KINDS] = {"a.pfm", "b.pfm", "c.png", "d.hdr"};
    for (int i = 0; i < KINDS; i++)
        snprintf(originals[i], sizeof originals[i], "%s/%s", directory, names[i]);
    write_pfm(originals[0], 8, 4);
    write_pfm(originals[1], 16, 8);
    if (helio_picture_write(context, originals[2], &picture, NULL) != HELIO_OK)
        write_pfm(originals[2], 32, 16); /* a build without PNG */
    write_garbage(originals[3]);
    for (int i = 0; i < FRAMES; i++) {
        if (i % 11 == 10)
            continue; /* a gap */
        snprintf(path, sizeof path, "%s/f%05d.pfm", directory, i);
        assert_int_equal(link(originals[i / 3 % KINDS], path), 0);
    }
}

static size_t resident_pages(void)
{
    size_t total = 0, resident = 0;
    FILE *stream = fopen("/proc/self/statm", "r");
    if (stream == NULL || fscanf(stream, "%zu %zu", &total, &resident) != 2)
        resident = 0; /* not Linux */
    if (stream != NULL)
        fclose(stream);
    return resident;
}

static void test_memory_stays_flat_over_ten_thousand_frames(void **state)
{
    (void)state;
    memory_count memory = {0};
    helio_context_desc desc = {.threads = 2,
                               .log_level = HELIO_LOG_WARNING,
                               .log = ignore_log,
                               .allocate = count_allocate,
                               .release = count_release,
                               .user = &memory};
    helio_context *context;
    assert_ok(helio_context_create(&desc, &context));
    char directory[TEST_PATH_SIZE], pattern[TEST_PATH_SIZE + 64];
    make_directory(directory);
    write_frames(directory, context);
    snprintf(pattern, sizeof pattern, "%s/f%%05d.pfm", directory);

    size_t live_at_first = atomic_load(&memory.live), most = 0, settled = 0, pages = 0;
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 4}, &environment));
    helio_source *source;
    const helio_source_desc wanted = {.on_missing = HELIO_ON_MISSING_HOLD, .queue = 4};
    assert_ok(helio_source_open(context, pattern, &wanted, &source));
    assert_int_equal(helio_source_get_info(source).frame_count, FRAMES);
    uint32_t held = 0;
    for (uint32_t i = 0; i < FRAMES; i++) {
        helio_source_frame frame;
        assert_ok(helio_source_next(source, &frame));
        assert_int_equal(frame.index, i);
        assert_non_null(frame.rgb);
        held += frame.is_held;
        assert_ok(helio_source_apply(source, &frame, environment, NULL));
        size_t live = atomic_load(&memory.live);
        most = live > most ? live : most;
        if (i == SETTLED) {
            settled = most;
            pages = resident_pages();
        }
    }
    print_message("%u frames held; at most %zu blocks of memory, %zu after %d frames; pages: %zu, then %zu\n", held,
                  most, settled, SETTLED, pages, resident_pages());
    assert_in_range(held, FRAMES / 4, FRAMES / 2);
    assert_true(most <= settled + 8);
    if (!IS_SANITIZED)
        assert_true(resident_pages() < pages + PAGES_OF_GROWTH);
    helio_source_close(source);
    helio_environment_destroy(environment);
    assert_int_equal(atomic_load(&memory.live), live_at_first);
    helio_context_destroy(context);
    remove_directory(directory);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_memory_stays_flat_over_ten_thousand_frames)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
