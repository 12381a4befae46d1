/* SPDX-License-Identifier: MIT
 *
 * Sources of environment maps: what may be written for one, sequences with all that can be wrong with them, the thread
 * that reads ahead, and what becomes of frames in an environment. */
#include "support.h"

#include "env/source_names.h"
#include "env/source_pattern.h"

#include <heliostat/source.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { WIDTH = 4, HEIGHT = 2, LOG_SIZE = 16384 };

/* ---- what the tests share ---------------------------------------------------------------- */

static memory_count memory;
static helio_context *context;
static char directory[TEST_PATH_SIZE];
static char text_of_log[LOG_SIZE]; /* written by any thread, one at a time; read after the source was closed */
static unsigned warnings;

static void keep_log(void *user, helio_log_level level, const char *message)
{
    (void)user;
    warnings += level <= HELIO_LOG_WARNING;
    size_t used = strlen(text_of_log);
    snprintf(text_of_log + used, LOG_SIZE - used, "%s\n", message);
}

static int setup(void **state)
{
    (void)state;
    memory = (memory_count){0};
    text_of_log[0] = 0;
    warnings = 0;
    helio_context_desc desc = {.threads = 2,
                               .log_level = HELIO_LOG_INFO,
                               .log = keep_log,
                               .allocate = count_allocate,
                               .release = count_release,
                               .user = &memory};
    make_directory(directory);
    return helio_context_create(&desc, &context) == HELIO_OK ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    helio_context_destroy(context);
    remove_directory(directory);
    if (atomic_load(&memory.live) == 0 && !atomic_load(&memory.misaligned))
        return 0;
    print_error("%zu blocks of memory leaked, or one was asked for in a wrong way\n", atomic_load(&memory.live));
    return -1;
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

/* A path in the test's directory. The last sixteen stay valid. */
static const char *in_directory(const char *name)
{
    static char paths[16][2 * TEST_PATH_SIZE];
    static unsigned turn;
    char *path = paths[turn++ % 16];
    snprintf(path, sizeof paths[0], "%s/%s", directory, name);
    return path;
}

static void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static void write_text(const char *name, const char *text)
{
    write_bytes(in_directory(name), text, strlen(text));
}

/* A map of one value in all of its numbers. */
static void write_map(const char *name, uint32_t width, uint32_t height, float value)
{
    FILE *stream = fopen(in_directory(name), "wb");
    assert_non_null(stream);
    fprintf(stream, "PF\n%u %u\n-1.0\n", width, height);
    for (uint32_t i = 0; i < 3 * width * height; i++)
        fwrite(&value, sizeof value, 1, stream);
    assert_int_equal(fclose(stream), 0);
}

/* Maps name 0 ... count - 1, each of which has its number plus 1 as its value. */
static void write_sequence(const char *pattern, uint32_t count)
{
    char name[256];
    source_pattern parsed;
    assert_int_equal(source_pattern_parse(pattern, &parsed), PATTERN_NUMBER);
    char path[SOURCE_PATH_SIZE];
    for (uint32_t i = 0; i < count; i++) {
        assert_true(source_pattern_format(&parsed, i, path));
        snprintf(name, sizeof name, "%.255s", path);
        write_map(name, WIDTH, HEIGHT, (float)i + 1.0f);
    }
}

static helio_source *open_source(const char *specification, const helio_source_desc *desc)
{
    helio_source *source;
    assert_ok(helio_source_open(context, specification, desc, &source));
    return source;
}

static helio_source_frame next_frame(helio_source *source)
{
    helio_source_frame frame;
    assert_ok(helio_source_next(source, &frame));
    return frame;
}

static void expect_end(helio_source *source)
{
    for (int i = 0; i < 2; i++) {
        helio_source_frame frame = next_frame(source);
        assert_null(frame.rgb);
        assert_null(frame.pixels.data);
        assert_null(frame.sky);
    }
}

/* All of the frame's numbers are this one. */
static void assert_pixels(const helio_source_frame *frame, float value)
{
    assert_non_null(frame->rgb);
    assert_ptr_equal(frame->pixels.data, frame->rgb);
    for (size_t i = 0; i < 3 * (size_t)frame->width * frame->height; i++)
        assert_true(frame->rgb[i] == value);
}

static void expect_frame(helio_source *source, uint64_t index, float value, bool is_held)
{
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.index, index);
    assert_int_equal(frame.is_held, is_held);
    assert_int_equal(frame.width, WIDTH);
    assert_int_equal(frame.height, HEIGHT);
    assert_int_equal(frame.layout, HELIO_LAYOUT_LATLONG);
    assert_pixels(&frame, value);
}

static void expect_open_failure(const char *specification, const helio_source_desc *desc, helio_status expected,
                                const char *words)
{
    helio_source *source = (helio_source *)&memory;
    helio_status status = helio_source_open(context, specification, desc, &source);
    if (status != expected || strstr(helio_last_error(), words) == NULL)
        fail_msg("\"%s\": %s, %s", specification, helio_status_name(status), helio_last_error());
    assert_null(source);
}

static void expect_next_failure(helio_source *source, helio_status expected, const char *words)
{
    helio_source_frame frame = {.index = 77};
    helio_status status = helio_source_next(source, &frame);
    if (status != expected || strstr(helio_last_error(), words) == NULL)
        fail_msg("%s, %s", helio_status_name(status), helio_last_error());
    assert_int_equal(frame.index, 77);
}

static void expect_log(const char *words, unsigned expected_warnings)
{
    if (strstr(text_of_log, words) == NULL || warnings != expected_warnings)
        fail_msg("%u warnings:\n%s", warnings, text_of_log);
}

/* ---- specifications ---------------------------------------------------------------------- */

static void test_check_tells_the_kind(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        helio_source_kind kind;
    } cases[] = {
        {"map.exr", HELIO_SOURCE_FILE},
        {"no such folder/", HELIO_SOURCE_FILE},
        {"face_%s.png", HELIO_SOURCE_FILE},
        {"frame_%04d.exr", HELIO_SOURCE_SEQUENCE},
        {"100%%_%d.exr", HELIO_SOURCE_SEQUENCE},
        {"no such folder/*.hdr", HELIO_SOURCE_SEQUENCE},
        {"frame_?.hdr", HELIO_SOURCE_SEQUENCE},
        {"frame_[0-9].hdr", HELIO_SOURCE_SEQUENCE},
        {"film.mp4", HELIO_SOURCE_VIDEO},
        {"FILM.MKV", HELIO_SOURCE_VIDEO},
        {"lavfi:testsrc2", HELIO_SOURCE_DEVICE},
        {"v4l2:/dev/video0", HELIO_SOURCE_DEVICE},
        {"constant:1,2,3", HELIO_SOURCE_CONSTANT},
        {"constant:0.5", HELIO_SOURCE_CONSTANT},
        {"sky:lat=44.8,lon=-0.6", HELIO_SOURCE_SKY},
        {"sky:day", HELIO_SOURCE_SKY_DAY},
        {"sky:day,lat=10", HELIO_SOURCE_SKY_DAY},
        {"constant.exr", HELIO_SOURCE_FILE},
        {"sky.hdr", HELIO_SOURCE_FILE},
        {"100%.exr", HELIO_SOURCE_FILE}, /* only the file system knows */
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        helio_source_kind kind = (helio_source_kind)-1;
        if (helio_source_check(cases[i].text, &kind) != HELIO_OK || kind != cases[i].kind)
            fail_msg("%s: kind %d, %s", cases[i].text, (int)kind, helio_last_error());
        assert_ok(helio_source_check(cases[i].text, NULL));
    }
}

static void test_mistakes_in_specifications_are_told_before_anything_is_opened(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "",
        "constant:",
        "constant:1,2",
        "constant:1,2,3,4",
        "constant:red",
        "constant:-1,0,0",
        "constant:nan",
        "constant:1e13",
        "lavfi:",
        "v4l2:",
        "sky:height=3",
        "sky:lat=91",
        "sky:day,time=12:00",
        "sky:date=2026-02-30",
    };
    for (size_t i = 0; i < COUNT(wrong); i++) {
        helio_source_kind kind = HELIO_SOURCE_DEVICE;
        if (helio_source_check(wrong[i], &kind) != HELIO_ERR_ARGUMENT)
            fail_msg("\"%s\" was taken", wrong[i]);
        assert_int_equal(kind, HELIO_SOURCE_DEVICE);
        expect_open_failure(wrong[i], NULL, HELIO_ERR_ARGUMENT, "");
    }
    assert_int_equal(helio_source_check(NULL, NULL), HELIO_ERR_ARGUMENT);

    static const char *const told[][2] = {
        {"constant:1,2,3,4", "environment \"constant:1,2,3,4\": it has more than 3 numbers"},
        {"sky:disc=2", "environment \"sky:disc=2\": disc is 2; use 0 or 1"},
        {"sky:disc=0.5", "disc is 0.5; use 0 or 1"},
        {"sky:disc=no", "disc is \"no\"; use 0 or 1"},
        {"sky:date=2026-02-30", "environment \"sky:date=2026-02-30\": there is no day 30"},
        {"sky:day,date=1800-01-01",
         "environment \"sky:day,date=1800-01-01\": the sun's place is not known in the year"},
    };
    for (size_t i = 0; i < COUNT(told); i++)
        expect_open_failure(told[i][0], NULL, HELIO_ERR_ARGUMENT, told[i][1]);

    char *endless = malloc(100001);
    memset(endless, 'a', 100000);
    endless[100000] = 0;
    expect_open_failure(endless, NULL, HELIO_ERR_ARGUMENT, "100000 characters");
    free(endless);
}

static void test_wrong_descs_are_refused(void **state)
{
    (void)state;
    const helio_source_desc wrong[] = {
        {.queue = 17},
        {.fps = -1},
        {.fps = (double)NAN},
        {.fps = (double)INFINITY},
        {.frames = 2000000000},
        {.on_missing = (helio_on_missing)3},
        {.has_frames = true, .first = 2, .last = 1},
    };
    for (size_t i = 0; i < COUNT(wrong); i++)
        expect_open_failure("constant:1", &wrong[i], HELIO_ERR_ARGUMENT, "");
    helio_source *source;
    assert_int_equal(helio_source_open(NULL, "constant:1", NULL, &source), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_source_open(context, NULL, NULL, &source), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_source_open(context, "constant:1", NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_source_next(NULL, NULL), HELIO_ERR_ARGUMENT);
    helio_source_close(NULL);
}

static void test_choices_for_missing_frames_have_names(void **state)
{
    (void)state;
    for (int i = HELIO_ON_MISSING_STOP; i <= HELIO_ON_MISSING_HOLD; i++) {
        helio_on_missing value;
        assert_ok(helio_on_missing_parse(helio_on_missing_name((helio_on_missing)i), &value));
        assert_int_equal(value, i);
    }
    helio_on_missing value;
    assert_int_equal(helio_on_missing_parse("wait", &value), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "stop, skip or hold"));
}

/* ---- patterns and names ------------------------------------------------------------------ */

static void test_patterns_have_one_strict_integer(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        source_pattern_kind kind;
        uint32_t number;
        const char *name;
    } cases[] = {
        {"map.exr", PATTERN_NONE, 0, NULL},
        {"100%%", PATTERN_NONE, 0, NULL},
        {"a%db", PATTERN_NUMBER, 0, "a0b"},
        {"a%04db", PATTERN_NUMBER, 12, "a0012b"},
        {"a%04d", PATTERN_NUMBER, 123456, "a123456"},
        {"%4d", PATTERN_NUMBER, 7, "   7"},
        {"%u", PATTERN_NUMBER, 4294967295u, "4294967295"},
        {"%020i", PATTERN_NUMBER, 1, "00000000000000000001"},
        {"50%%/%d%%s", PATTERN_NUMBER, 3, "50%/3%s"},
        {"face_%s.png", PATTERN_FACES, 0, NULL},
        {"%n", PATTERN_WRONG, 0, NULL},
        {"%s%d", PATTERN_WRONG, 0, NULL},
        {"%d%s", PATTERN_WRONG, 0, NULL},
        {"%d%d", PATTERN_WRONG, 0, NULL},
        {"%d%n", PATTERN_WRONG, 0, NULL},
        {"%s%s", PATTERN_WRONG, 0, NULL},
        {"%99999999d", PATTERN_WRONG, 0, NULL},
        {"%4294967298d", PATTERN_WRONG, 0, NULL},
        {"%21d", PATTERN_WRONG, 0, NULL},
        {"%*d", PATTERN_WRONG, 0, NULL},
        {"%.4d", PATTERN_WRONG, 0, NULL},
        {"%-4d", PATTERN_WRONG, 0, NULL},
        {"%+d", PATTERN_WRONG, 0, NULL},
        {"% d", PATTERN_WRONG, 0, NULL},
        {"%ld", PATTERN_WRONG, 0, NULL},
        {"%1$d", PATTERN_WRONG, 0, NULL},
        {"%x", PATTERN_WRONG, 0, NULL},
        {"%f", PATTERN_WRONG, 0, NULL},
        {"%04s", PATTERN_WRONG, 0, NULL},
        {"100%", PATTERN_WRONG, 0, NULL},
        {"%d%", PATTERN_WRONG, 0, NULL},
        {"%0", PATTERN_WRONG, 0, NULL},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        source_pattern pattern;
        char path[SOURCE_PATH_SIZE];
        if (source_pattern_parse(cases[i].text, &pattern) != cases[i].kind)
            fail_msg("%s is of another kind", cases[i].text);
        if (cases[i].kind != PATTERN_NUMBER)
            continue;
        assert_true(source_pattern_format(&pattern, cases[i].number, path));
        assert_string_equal(path, cases[i].name);
    }
}

static void test_hostile_patterns_are_mistakes_unless_a_file_has_the_name(void **state)
{
    (void)state;
    static const char *const hostile[] = {"%n", "%s%d", "%99999999d", "%d%d.exr", "%.9999f", "100%.pfm"};
    for (size_t i = 0; i < COUNT(hostile); i++) {
        expect_open_failure(in_directory(hostile[i]), NULL, HELIO_ERR_ARGUMENT, "no pattern");
        write_map(hostile[i], WIDTH, HEIGHT, 5.0f);
        helio_source *source = open_source(in_directory(hostile[i]), NULL);
        assert_int_equal(helio_source_get_info(source).kind, HELIO_SOURCE_FILE);
        expect_frame(source, 0, 5.0f, false);
        expect_end(source);
        helio_source_close(source);
    }
}

static void test_files_that_exist_win_over_patterns(void **state)
{
    (void)state;
    static const char *const names[] = {"a_%d.pfm", "a_*.pfm", "a_[1].pfm", "a_%s.pfm"};
    write_map("a_1.pfm", WIDTH, HEIGHT, 1.0f);
    for (size_t i = 0; i < COUNT(names); i++) {
        write_map(names[i], WIDTH, HEIGHT, 9.0f);
        helio_source *source = open_source(in_directory(names[i]), NULL);
        assert_int_equal(helio_source_get_info(source).kind, HELIO_SOURCE_FILE);
        assert_false(helio_source_get_info(source).is_dynamic);
        expect_frame(source, 0, 9.0f, false);
        helio_source_close(source);
        assert_int_equal(unlink(in_directory(names[i])), 0);
    }
}

static void test_names_are_sorted_as_people_count(void **state)
{
    (void)state;
    static const char *const sorted[] = {
        "",
        "1",
        "01",
        "2",
        "10",
        "010",
        "99999999999999999999999",
        "100000000000000000000000",
        "a",
        "a1",
        "a1b",
        "a1b2",
        "a1b10",
        "a2",
        "a10",
        "b",
        "frame2.exr",
        "frame10.exr",
        "frame10.exr~",
        "frame_2.exr",
    };
    for (size_t i = 0; i < COUNT(sorted); i++)
        for (size_t j = 0; j < COUNT(sorted); j++) {
            int order = source_names_compare(sorted[i], sorted[j]), wanted = (i > j) - (i < j);
            /* "1" and "01" only need some order, and the same each time. */
            bool same_number = strtod(sorted[i], NULL) == strtod(sorted[j], NULL) && sorted[i][0] && sorted[j][0] &&
                               sorted[i][0] <= '9' && sorted[j][0] <= '9';
            if (same_number
                    ? (order == 0) != (i == j) || (order > 0) != (source_names_compare(sorted[j], sorted[i]) < 0)
                    : (order > 0) - (order < 0) != wanted)
                fail_msg("\"%s\" and \"%s\" come in the wrong order", sorted[i], sorted[j]);
        }
}

/* ---- sequences --------------------------------------------------------------------------- */

static void test_numbered_frames_come_in_order(void **state)
{
    (void)state;
    write_sequence("frame_%04d.pfm", 12);
    write_map("frame_5.pfm", WIDTH, HEIGHT, 99.0f); /* not what the pattern makes of 5 */
    write_map("frame_0003.pfm.old", WIDTH, HEIGHT, 99.0f);
    write_map("frame_00xx.pfm", WIDTH, HEIGHT, 99.0f);
    char pattern[2 * TEST_PATH_SIZE];
    strcpy(pattern, in_directory("frame_%04d.pfm"));
    for (uint32_t queue = 1; queue <= 16; queue += 5) {
        helio_source *source = open_source(pattern, &(helio_source_desc){.queue = queue, .fps = 8});
        helio_source_info info = helio_source_get_info(source);
        assert_int_equal(info.kind, HELIO_SOURCE_SEQUENCE);
        assert_int_equal(info.frame_count, 12);
        assert_true(info.is_dynamic);
        assert_true(info.fps == 8.0);
        assert_string_equal(info.label, pattern);
        for (uint32_t i = 0; i < 12; i++) {
            char name[64];
            snprintf(name, sizeof name, "frame_%04u.pfm", i);
            helio_source_frame frame = next_frame(source);
            assert_int_equal(frame.index, i);
            assert_true(frame.seconds == i / 8.0);
            assert_string_equal(frame.name, in_directory(name));
            assert_true(frame.read_ms > 0);
            assert_pixels(&frame, (float)i + 1.0f);
        }
        expect_end(source);
        helio_source_close(source);
    }
    assert_int_equal(warnings, 0);
}

static void test_a_range_of_numbers_is_honoured(void **state)
{
    (void)state;
    write_sequence("%d.pfm", 12);
    const char *pattern = in_directory("%d.pfm");
    helio_source *source = open_source(pattern, &(helio_source_desc){.has_frames = true, .first = 9, .last = 10});
    assert_int_equal(helio_source_get_info(source).frame_count, 2);
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.index, 9);
    assert_true(frame.seconds == 0.0);
    assert_pixels(&frame, 10.0f);
    expect_frame(source, 10, 11.0f, false);
    expect_end(source);
    helio_source_close(source);
    expect_open_failure(pattern, &(helio_source_desc){.has_frames = true, .first = 20, .last = 4294967295u},
                        HELIO_ERR_IO, "0 to 11");
}

static void test_numbers_may_be_in_the_names_of_folders(void **state)
{
    (void)state;
    for (uint32_t i = 8; i < 12; i++) {
        char name[64];
        snprintf(name, sizeof name, "shot%02u", i);
        assert_int_equal(mkdir(in_directory(name), 0777), 0);
        snprintf(name, sizeof name, "shot%02u/map_7.pfm", i);
        if (i < 11) /* the last folder is empty */
            write_map(name, WIDTH, HEIGHT, (float)i);
    }
    helio_source *source = open_source(in_directory("shot%02d/map_7.pfm"), NULL);
    assert_int_equal(helio_source_get_info(source).frame_count, 3);
    for (uint32_t i = 8; i < 11; i++)
        expect_frame(source, i, (float)i, false);
    expect_end(source);
    helio_source_close(source);
}

static void test_a_name_may_go_on_with_digits_after_the_number(void **state)
{
    (void)state;
    write_sequence("v%d2.pfm", 12);
    helio_source *source = open_source(in_directory("v%d2.pfm"), NULL);
    assert_int_equal(helio_source_get_info(source).frame_count, 12);
    for (uint32_t i = 0; i < 12; i++)
        expect_frame(source, i, (float)i + 1.0f, false);
    helio_source_close(source);
}

static void test_globs_are_sorted_by_number(void **state)
{
    (void)state;
    write_sequence("frame%d.pfm", 12);
    write_text("frame3.txt", "not wanted");
    helio_source *source = open_source(in_directory("frame*.pfm"), &(helio_source_desc){.fps = 2});
    assert_int_equal(helio_source_get_info(source).frame_count, 12);
    for (uint32_t i = 0; i < 12; i++) {
        helio_source_frame frame = next_frame(source);
        assert_int_equal(frame.index, i);
        assert_true(frame.seconds == i / 2.0);
        assert_pixels(&frame, (float)i + 1.0f);
    }
    expect_end(source);
    helio_source_close(source);

    source = open_source(in_directory("frame*.pfm"), &(helio_source_desc){.has_frames = true, .first = 10, .last = 20});
    assert_int_equal(helio_source_get_info(source).frame_count, 2);
    expect_frame(source, 10, 11.0f, false);
    expect_frame(source, 11, 12.0f, false);
    expect_end(source);
    helio_source_close(source);
    expect_open_failure(in_directory("frame*.pfm"), &(helio_source_desc){.has_frames = true, .first = 12, .last = 20},
                        HELIO_ERR_ARGUMENT, "it has only 12");
}

static void test_sequences_without_files_are_told_when_they_are_opened(void **state)
{
    (void)state;
    expect_open_failure(in_directory("frame_%04d.exr"), NULL, HELIO_ERR_IO, directory);
    expect_open_failure(in_directory("none/frame_%04d.exr"), NULL, HELIO_ERR_IO, "none");
    expect_open_failure(in_directory("*.exr"), NULL, HELIO_ERR_IO, "*.exr");
    expect_open_failure(in_directory("none.exr"), NULL, HELIO_ERR_IO, "none.exr");
    expect_open_failure(in_directory("face_%s.exr"), NULL, HELIO_ERR_IO, "face_");
    expect_open_failure(in_directory("none.mkv"), NULL, HELIO_ERR_IO, "none.mkv");
}

static const char *const FACES[] = {"px", "nx", "py", "ny", "pz", "nz"};

/* Each face has its number and the value as its pixels. */
static void write_faces(const char *before, const char *after, uint32_t size, float value)
{
    for (int i = 0; i < 6; i++) {
        char name[128];
        snprintf(name, sizeof name, "%s%s%s", before, FACES[i], after);
        write_map(name, size, size, (float)i + value);
    }
}

static void expect_faces(helio_source *source, uint64_t index, uint32_t size, float value)
{
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.index, index);
    assert_int_equal(frame.layout, HELIO_LAYOUT_STRIP);
    assert_int_equal(frame.width, size);
    assert_int_equal(frame.height, 6 * size);
    for (size_t i = 0; i < (size_t)6 * size * size * 3; i++)
        assert_true(frame.rgb[i] == (float)(i / (3 * (size_t)size * size)) + value);
}

static void test_six_faces_are_one_frame(void **state)
{
    (void)state;
    write_faces("sky_", ".pfm", 4, 1.0f);
    char pattern[2 * TEST_PATH_SIZE];
    strcpy(pattern, in_directory("sky_%s.pfm"));
    const char *const names[] = {pattern, directory};
    for (size_t i = 0; i < COUNT(names); i++) {
        helio_source *source = open_source(names[i], NULL);
        assert_int_equal(helio_source_get_info(source).kind, HELIO_SOURCE_FILE);
        assert_false(helio_source_get_info(source).is_dynamic);
        expect_faces(source, 0, 4, 1.0f);
        expect_end(source);
        helio_source_close(source);
    }
    helio_source *source = open_source(in_directory("sky_py.pfm"), &(helio_source_desc){.layout = HELIO_LAYOUT_FACES});
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.height, 24);
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 4}, &environment));
    assert_ok(helio_source_apply(source, &frame, environment, NULL));
    assert_true(fabsf(helio_environment_cube(environment)[2 * 4 * 4 * 3] - 3.0f) < 1e-5f); /* +Y */
    helio_environment_destroy(environment);
    helio_source_close(source);
    const helio_source_desc latlong = {.layout = HELIO_LAYOUT_LATLONG};
    expect_open_failure(pattern, &latlong, HELIO_ERR_ARGUMENT, "layout cannot be latlong");
    expect_open_failure(directory, &latlong, HELIO_ERR_ARGUMENT, "layout cannot be latlong");
    source = open_source(in_directory("sky_py.pfm"), NULL); /* a square, which may be one of six */
    expect_next_failure(source, HELIO_ERR_DATA, "if this is one of the six files of a cube, it is faces");
    helio_source_close(source);
    assert_int_equal(unlink(in_directory("sky_ny.pfm")), 0);
    expect_open_failure(pattern, NULL, HELIO_ERR_IO, "lacks");
    expect_open_failure(directory, NULL, HELIO_ERR_IO, "lacks");
}

/* Folders of six faces, by number and by name; one of them lacks a face. */
static void test_sequences_may_be_of_six_faces_each(void **state)
{
    (void)state;
    static const char *const folders[] = {"s1", "s2", "s10"};
    for (int i = 0; i < 3; i++) {
        char before[16];
        snprintf(before, sizeof before, "%s/", folders[i]);
        assert_int_equal(mkdir(in_directory(folders[i]), 0777), 0);
        write_faces(before, ".pfm", 2, 10.0f * (float)i);
    }
    helio_source *source = open_source(in_directory("s*"), NULL);
    for (uint32_t i = 0; i < 3; i++)
        expect_faces(source, i, 2, 10.0f * (float)i);
    expect_end(source);
    helio_source_close(source);
    assert_int_equal(unlink(in_directory("s2/pz.pfm")), 0);
    source = open_source(in_directory("s%d"), &(helio_source_desc){.on_missing = HELIO_ON_MISSING_SKIP});
    expect_faces(source, 1, 2, 0.0f);
    expect_faces(source, 10, 2, 20.0f);
    expect_end(source);
    helio_source_close(source);
    expect_log("frame 2 of", 2);
}

/* ---- frames that are missing or unreadable ----------------------------------------------- */

/* 0 1 . . 4 5x 6, and in the file of 5 is no picture. */
static const char *write_damaged_sequence(void)
{
    write_sequence("d%d.pfm", 7);
    assert_int_equal(unlink(in_directory("d2.pfm")), 0);
    assert_int_equal(unlink(in_directory("d3.pfm")), 0);
    write_text("d5.pfm", "no picture");
    return in_directory("d%d.pfm");
}

static void test_stop_ends_at_a_gap(void **state)
{
    (void)state;
    helio_source *source = open_source(write_damaged_sequence(), NULL);
    assert_int_equal(helio_source_get_info(source).frame_count, 7);
    expect_frame(source, 0, 1.0f, false);
    expect_frame(source, 1, 2.0f, false);
    expect_next_failure(source, HELIO_ERR_IO, "d2.pfm cannot be opened");
    assert_non_null(strstr(helio_last_error(), "--on-missing"));
    expect_end(source);
    helio_source_close(source);
}

static void test_stop_ends_at_an_unreadable_frame(void **state)
{
    (void)state;
    helio_source *source =
        open_source(write_damaged_sequence(), &(helio_source_desc){.has_frames = true, .first = 4, .last = 6});
    expect_frame(source, 4, 5.0f, false);
    expect_next_failure(source, HELIO_ERR_DATA, "d5.pfm is not a picture");
    expect_end(source);
    helio_source_close(source);
}

static void test_skip_goes_on_after_a_gap(void **state)
{
    (void)state;
    helio_source *source =
        open_source(write_damaged_sequence(), &(helio_source_desc){.on_missing = HELIO_ON_MISSING_SKIP, .fps = 1});
    assert_int_equal(helio_source_get_info(source).frame_count, 5);
    expect_frame(source, 0, 1.0f, false);
    expect_frame(source, 1, 2.0f, false);
    expect_frame(source, 4, 5.0f, false);
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.index, 6);
    assert_true(frame.seconds == 6.0); /* the others keep their time */
    expect_end(source);
    helio_source_close(source);
    expect_log("frames 2 to 3 of", 2);
    expect_log("frame 5 of", 2);
}

static void test_hold_repeats_the_frame_before(void **state)
{
    (void)state;
    helio_source *source =
        open_source(write_damaged_sequence(), &(helio_source_desc){.on_missing = HELIO_ON_MISSING_HOLD});
    assert_int_equal(helio_source_get_info(source).frame_count, 7);
    expect_frame(source, 0, 1.0f, false);
    expect_frame(source, 1, 2.0f, false);
    expect_frame(source, 2, 2.0f, true);
    expect_frame(source, 3, 2.0f, true);
    expect_frame(source, 4, 5.0f, false);
    expect_frame(source, 5, 5.0f, true);
    expect_frame(source, 6, 7.0f, false);
    expect_end(source);
    helio_source_close(source);
    expect_log("frame 3 of", 3);
}

static void test_hold_skips_what_comes_before_the_first_good_frame(void **state)
{
    (void)state;
    write_sequence("h%d.pfm", 6);
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "h%d.pfm", i);
        assert_int_equal(unlink(in_directory(name)), 0);
    }
    const helio_source_desc desc = {.on_missing = HELIO_ON_MISSING_HOLD, .has_frames = true, .first = 0, .last = 6};
    helio_source *source = open_source(in_directory("h%d.pfm"), &desc);
    assert_int_equal(helio_source_get_info(source).frame_count, 4);
    expect_frame(source, 3, 4.0f, false);
    expect_frame(source, 4, 5.0f, false);
    expect_frame(source, 5, 6.0f, false);
    expect_frame(source, 6, 6.0f, true);
    expect_end(source);
    helio_source_close(source);
    expect_log("frames 0 to 2 of", 2);
}

/* Frames 0 and 2^32 - 1: the four thousand million between them are one gap. */
static void test_the_largest_gap_is_skipped_at_once(void **state)
{
    (void)state;
    write_map("g0.pfm", WIDTH, HEIGHT, 1.0f);
    write_map("g4294967295.pfm", WIDTH, HEIGHT, 2.0f);
    write_map("g4294967296.pfm", WIDTH, HEIGHT, 3.0f); /* beyond what counts as a number */
    helio_source *source =
        open_source(in_directory("g%d.pfm"), &(helio_source_desc){.on_missing = HELIO_ON_MISSING_SKIP});
    assert_int_equal(helio_source_get_info(source).frame_count, 2);
    expect_frame(source, 0, 1.0f, false);
    expect_frame(source, 4294967295u, 2.0f, false);
    expect_end(source);
    helio_source_close(source);
    expect_log("frames 1 to 4294967294", 1);
}

static void test_sequences_without_a_good_frame_fail(void **state)
{
    (void)state;
    for (int i = HELIO_ON_MISSING_SKIP; i <= HELIO_ON_MISSING_HOLD; i++) {
        write_text("bad1.hdr", "");
        write_text("bad2.hdr", "#?RADIANCE\n\n-Y 3 +X 4\n");
        write_text("bad3.hdr", "\x76\x2f\x31\x01");
        helio_source *source =
            open_source(in_directory("bad*.hdr"), &(helio_source_desc){.on_missing = (helio_on_missing)i});
        expect_next_failure(source, HELIO_ERR_DATA, "not one frame");
        assert_non_null(strstr(helio_last_error(), "bad3.hdr"));
        expect_end(source);
        helio_source_close(source);
    }
}

static void test_frames_without_a_layout_count_as_unreadable(void **state)
{
    (void)state;
    write_map("l1.pfm", WIDTH, HEIGHT, 1.0f);
    write_map("l2.pfm", 5, 7, 2.0f);
    write_map("l3.pfm", WIDTH, HEIGHT, 3.0f);
    helio_source *source = open_source(in_directory("l%d.pfm"), NULL);
    expect_frame(source, 1, 1.0f, false);
    expect_next_failure(source, HELIO_ERR_DATA, "l2.pfm: 5 x 7");
    helio_source_close(source);
    source = open_source(in_directory("l%d.pfm"), &(helio_source_desc){.on_missing = HELIO_ON_MISSING_HOLD});
    expect_frame(source, 1, 1.0f, false);
    expect_frame(source, 2, 1.0f, true);
    expect_frame(source, 3, 3.0f, false);
    helio_source_close(source);
    source = open_source(in_directory("l%d.pfm"), &(helio_source_desc){.layout = HELIO_LAYOUT_LATLONG});
    next_frame(source);
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.width, 5);
    assert_int_equal(frame.layout, HELIO_LAYOUT_LATLONG);
    helio_source_close(source);
}

static void test_files_may_vanish_or_turn_to_garbage_while_they_are_read(void **state)
{
    (void)state;
    for (int i = HELIO_ON_MISSING_STOP; i <= HELIO_ON_MISSING_HOLD; i++) {
        write_sequence("v%02d.pfm", 12);
        helio_source *source =
            open_source(in_directory("v%02d.pfm"), &(helio_source_desc){.queue = 1, .on_missing = (helio_on_missing)i});
        expect_frame(source, 0, 1.0f, false);
        assert_int_equal(unlink(in_directory("v08.pfm")), 0); /* frame 2 may be on its way by now, but not this one */
        write_text("v10.pfm", "PF\n4 2\n-1.0\nends too early");
        for (uint32_t k = 1; k < 8; k++)
            expect_frame(source, k, (float)k + 1.0f, false);
        if (i == HELIO_ON_MISSING_STOP) {
            expect_next_failure(source, HELIO_ERR_IO, "v08.pfm");
        } else {
            if (i == HELIO_ON_MISSING_HOLD)
                expect_frame(source, 8, 8.0f, true);
            expect_frame(source, 9, 10.0f, false);
            if (i == HELIO_ON_MISSING_HOLD)
                expect_frame(source, 10, 10.0f, true);
            expect_frame(source, 11, 12.0f, false);
        }
        expect_end(source);
        helio_source_close(source);
    }
}

/* A folder, a pipe that nobody writes to and a link to nowhere are no frames, and nothing waits for them. */
static void test_what_is_no_file_is_unreadable(void **state)
{
    (void)state;
    write_sequence("n%d.pfm", 1);
    assert_int_equal(mkdir(in_directory("n1.pfm"), 0777), 0);
    assert_int_equal(mkfifo(in_directory("n2.pfm"), 0666), 0);
    assert_int_equal(symlink("nowhere", in_directory("n3.pfm")), 0);
    write_map("n4.pfm", WIDTH, HEIGHT, 4.0f);
    helio_source *source =
        open_source(in_directory("n%d.pfm"), &(helio_source_desc){.on_missing = HELIO_ON_MISSING_SKIP});
    expect_frame(source, 0, 1.0f, false);
    expect_frame(source, 4, 4.0f, false);
    expect_end(source);
    helio_source_close(source);
}

static void test_claims_of_huge_frames_are_refused(void **state)
{
    (void)state;
    write_sequence("c%d.pfm", 1);
    write_text("c1.pfm", "PF\n60000 30000\n-1.0\n0123456789");
    write_map("c2.pfm", 8, 4, 2.0f);
    helio_source *source =
        open_source(in_directory("c%d.pfm"),
                    &(helio_source_desc){.on_missing = HELIO_ON_MISSING_SKIP, .max_pixels = WIDTH * HEIGHT});
    expect_frame(source, 0, 1.0f, false);
    expect_end(source);
    helio_source_close(source);
    expect_log("frame 1 of", 2);
    expect_log("frame 2 of", 2);
}

/* ---- the thread -------------------------------------------------------------------------- */

static void test_closing_at_any_moment_ends_the_thread(void **state)
{
    (void)state;
    write_sequence("t%03d.pfm", 20);
    const char *pattern = in_directory("t%03d.pfm");
    for (uint32_t i = 0; i < 300; i++) {
        helio_source *source = open_source(pattern, &(helio_source_desc){.queue = 1 + i % 4});
        for (uint32_t k = 0; k < i % 23; k++)
            next_frame(source);
        if (i % 5 == 0)
            usleep(i % 7 * 100);
        helio_source_close(source);
    }
}

static void spend_time(void *data, size_t index)
{
    double *sums = data;
    for (int i = 1; i < 2000; i++)
        sums[index] += 1.0 / i;
}

/* The caller works with all of its threads, and with another source, while frames are read. */
static void test_reading_goes_on_beside_the_callers_work(void **state)
{
    (void)state;
    write_sequence("w%02d.pfm", 40);
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 8}, &environment));
    helio_source *first = open_source(in_directory("w%02d.pfm"), NULL);
    helio_source *second = open_source(in_directory("w*.pfm"), &(helio_source_desc){.queue = 5});
    for (uint32_t i = 0; i < 40; i++) {
        helio_source_frame a = next_frame(first), b = next_frame(second);
        helio_environment_info info;
        assert_ok(helio_source_apply(i % 2 ? first : second, i % 2 ? &a : &b, environment, &info));
        assert_true(fabsf(info.max_luminance - (float)(i + 1)) < 1e-4f * (float)(i + 1));
        double sum = 0;
        spend_time(&sum, 0);
        assert_true(sum > 1.0);
    }
    expect_end(first);
    expect_end(second);
    helio_source_close(first);
    helio_source_close(second);
    helio_environment_destroy(environment);
}

/* Once all blocks are there, frames take no more memory from the host. */
static void test_frames_use_their_memory_again(void **state)
{
    (void)state;
    write_sequence("m%03d.pfm", 200);
    helio_source *source = open_source(in_directory("m%03d.pfm"), NULL);
    for (uint32_t i = 0; i < 10; i++)
        next_frame(source);
    size_t taken = atomic_load(&memory.taken), live = atomic_load(&memory.live);
    for (uint32_t i = 10; i < 200; i++)
        expect_frame(source, i, (float)i + 1.0f, false);
    assert_in_range(atomic_load(&memory.taken) - taken, 0, 3); /* the thread may have been slow at first */
    assert_true(atomic_load(&memory.live) <= live + 3);
    expect_end(source);
    assert_true(atomic_load(&memory.live) < live); /* what is no longer needed is given back at the end */
    helio_source_close(source);
}

/* Sizes that change all the time leave no pile of blocks behind. */
static void test_memory_is_bounded_where_sizes_change(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 100; i++) {
        char name[64];
        snprintf(name, sizeof name, "s%02u.pfm", i);
        write_map(name, 2 * (1 + i * i % 37), 1 + i * i % 37, 1.0f);
    }
    helio_source *source = open_source(in_directory("s%02d.pfm"), NULL);
    for (uint32_t i = 0; i < 100; i++) {
        helio_source_frame frame = next_frame(source);
        assert_int_equal(frame.height, 1 + i * i % 37);
        assert_pixels(&frame, 1.0f);
        assert_true(atomic_load(&memory.live) < 64);
    }
    expect_end(source);
    helio_source_close(source);
}

/* Memory is refused from the n-th allocation on: a sentence, nothing leaks, and nothing hangs. */
static void test_memory_that_runs_out_is_told(void **state)
{
    (void)state;
    write_sequence("a%d.pfm", 4);
    char names[3][2 * TEST_PATH_SIZE];
    strcpy(names[0], in_directory("a%d.pfm"));
    strcpy(names[1], in_directory("a*.pfm"));
    strcpy(names[2], in_directory("a1.pfm"));
    const char *const specifications[] = {names[0], names[1], names[2], "constant:1", "sky:day"};
    for (size_t s = 0; s < COUNT(specifications); s++) {
        bool done = false;
        size_t failures = 0;
        for (size_t allowed = 0; !done; allowed++) {
            size_t live = atomic_load(&memory.live);
            memory.refuse_after = atomic_load(&memory.taken) + allowed;
            helio_source *source;
            helio_status status = helio_source_open(
                context, specifications[s],
                &(helio_source_desc){.on_missing = s == 0 ? HELIO_ON_MISSING_HOLD : HELIO_ON_MISSING_STOP}, &source);
            helio_source_frame frame = {.rgb = &(float){0}};
            while (status == HELIO_OK && (frame.rgb != NULL || frame.sky != NULL))
                status = helio_source_next(source, &frame);
            assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
            done = status == HELIO_OK;
            failures += !done;
            helio_source_close(source);
            memory.refuse_after = 0;
            assert_int_equal(atomic_load(&memory.live), live);
            assert_true(allowed < 1000);
        }
        assert_true(failures > 3);
    }
}

/* ---- frames in an environment ------------------------------------------------------------ */

static void test_frames_of_another_size_or_layout_reshape_the_environment(void **state)
{
    (void)state;
    write_map("r0.pfm", 4, 2, 1.0f);
    write_map("r1.pfm", 4, 2, 2.0f);
    write_map("r2.pfm", 16, 8, 3.0f);
    write_map("r3.pfm", 24, 4, 4.0f); /* a strip */
    write_map("r4.pfm", 1, 1, 5.0f);
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 8}, &environment));
    helio_source *source = open_source(in_directory("r%d.pfm"), NULL);
    for (uint32_t i = 0; i < 5; i++) {
        helio_source_frame frame = next_frame(source);
        helio_environment_info info;
        assert_ok(helio_source_apply(source, &frame, environment, &info));
        assert_true(fabsf(info.max_luminance - (float)(i + 1)) < 1e-5f * (float)(i + 1));
        assert_true(fabs(info.mean_luminance - (i + 1)) < 1e-4 * (i + 1));
    }
    helio_source_frame end = next_frame(source);
    assert_int_equal(helio_source_apply(source, &end, environment, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_environment_frame(environment), 5);
    helio_source_close(source);
    helio_environment_destroy(environment);
    assert_non_null(strstr(text_of_log, "r2.pfm has 16 x 8 pixels, layout latlong, after 4 x 2, latlong"));
    assert_non_null(strstr(text_of_log, "r3.pfm has 24 x 4 pixels, layout strip"));
    assert_null(strstr(text_of_log, "r0.pfm"));
    assert_null(strstr(text_of_log, "r1.pfm"));
    assert_int_equal(warnings, 0);
}

static void test_bad_and_black_frames_are_frames(void **state)
{
    (void)state;
    write_map("b0.pfm", WIDTH, HEIGHT, NAN);
    write_map("b1.pfm", WIDTH, HEIGHT, -1.0f);
    write_map("b2.pfm", WIDTH, HEIGHT, 0.0f);
    write_map("b3.pfm", WIDTH, HEIGHT, INFINITY);
    write_map("b4.pfm", WIDTH, HEIGHT, 1.0f);
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 8}, &environment));
    helio_source *source = open_source(in_directory("b%d.pfm"), NULL);
    static const helio_bad_pixels expected[] = {
        {.nan = WIDTH * HEIGHT}, {.negative = WIDTH * HEIGHT}, {0}, {.infinite = WIDTH * HEIGHT}, {0}};
    for (uint32_t i = 0; i < 5; i++) {
        helio_source_frame frame = next_frame(source);
        assert_memory_equal(&frame.bad, &expected[i], sizeof frame.bad);
        helio_environment_info info;
        assert_ok(helio_source_apply(source, &frame, environment, &info));
        assert_true(info.max_luminance == (i == 4 ? 1.0f : 0.0f));
    }
    helio_source_close(source);
    helio_environment_destroy(environment);
}

/* ---- stills and skies -------------------------------------------------------------------- */

static void test_constants_are_maps_of_one_pixel(void **state)
{
    (void)state;
    helio_source *source = open_source("constant:0.25,0.5,1e12", &(helio_source_desc){.fps = 30});
    helio_source_info info = helio_source_get_info(source);
    assert_int_equal(info.kind, HELIO_SOURCE_CONSTANT);
    assert_int_equal(info.frame_count, 1);
    assert_false(info.is_dynamic);
    helio_source_frame frame = next_frame(source);
    assert_int_equal(frame.width, 1);
    assert_int_equal(frame.height, 1);
    assert_int_not_equal(frame.layout, HELIO_LAYOUT_AUTO);
    assert_true(frame.rgb[0] == 0.25f && frame.rgb[1] == 0.5f && frame.rgb[2] == 1e12f);
    assert_string_equal(frame.name, "constant:0.25,0.5,1e12");
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 4}, &environment));
    assert_ok(helio_source_apply(source, &frame, environment, NULL));
    assert_true(helio_environment_cube(environment)[1] == 0.5f);
    expect_end(source);
    helio_source_close(source);
    helio_environment_destroy(environment);

    source = open_source("constant:3", NULL);
    frame = next_frame(source);
    assert_pixels(&frame, 3.0f);
    helio_source_close(source);
    expect_open_failure("constant:3", &(helio_source_desc){.has_frames = true, .first = 1, .last = 1},
                        HELIO_ERR_ARGUMENT, "it has only 1");
}

/* Frames in memory: every second one is a lat-long map in halves with alpha and padded rows, the others are strips of
 * floats. */
typedef struct memory_frames {
    uint16_t halves[HEIGHT][WIDTH + 1][4];
    float floats[6][3];
    uint64_t calls, count, failing; /* frame that fails */
} memory_frames;

static helio_status give_map(void *user, uint64_t index, helio_source_map *map)
{
    memory_frames *frames = user;
    frames->calls++;
    assert_null(map->pixels.data);
    if (index == frames->failing)
        return HELIO_ERR_IO;
    if (index == frames->count)
        return HELIO_OK;
    if (index % 2) {
        for (int i = 0; i < 18; i++)
            frames->floats[i / 3][i % 3] = (float)index;
        *map = (helio_source_map){.pixels = {.data = frames->floats}, .width = 6, .height = 1};
        return HELIO_OK;
    }
    for (int i = 0; i < HEIGHT * WIDTH * 4; i++) /* 1.25, and an alpha that is not a number */
        frames->halves[i / 4 / WIDTH][i / 4 % WIDTH][i % 4] = i % 4 < 3 ? 0x3d00 : 0x7e00;
    *map = (helio_source_map){
        .pixels = {frames->halves, HELIO_PIXELS_RGBA_HALF, sizeof frames->halves[0]}, .width = WIDTH, .height = HEIGHT};
    return HELIO_OK;
}

static void test_callbacks_give_maps_where_they_lie(void **state)
{
    (void)state;
    memory_frames frames = {.count = 8, .failing = UINT64_MAX};
    helio_source *source;
    helio_environment *environment;
    assert_ok(
        helio_source_open_callback(context, "engine", give_map, &frames, &(helio_source_desc){.fps = 50}, &source));
    helio_source_info info = helio_source_get_info(source);
    assert_int_equal(info.kind, HELIO_SOURCE_CALLBACK);
    assert_true(info.is_dynamic && info.frame_count == 0 && info.fps == 50);
    assert_string_equal(info.label, "engine");
    assert_int_equal(frames.calls, 0);
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 4}, &environment));
    for (uint64_t i = 0; i < frames.count; i++) {
        size_t before = memory.taken;
        helio_source_frame frame = next_frame(source);
        assert_int_equal(memory.taken, before);
        assert_int_equal(frames.calls, i + 1); /* nothing is read ahead */
        assert_true(frame.index == i && frame.seconds == (double)i / 50);
        assert_string_equal(frame.name, "engine");
        assert_int_equal(frame.layout, i % 2 ? HELIO_LAYOUT_STRIP : HELIO_LAYOUT_LATLONG);
        assert_ptr_equal(frame.pixels.data, i % 2 ? (void *)frames.floats : (void *)frames.halves);
        assert_ptr_equal(frame.rgb, i % 2 ? frames.floats : NULL);
        helio_environment_info seen;
        assert_ok(helio_source_apply(source, &frame, environment, &seen));
        assert_true(seen.bad.nan == 0 && helio_environment_cube(environment)[0] == (i % 2 ? (float)i : 1.25f));
    }
    expect_end(source);
    assert_int_equal(frames.calls, frames.count + 1);
    helio_source_close(source);
    helio_environment_destroy(environment);
}

static void test_callbacks_of_one_shape_take_no_memory(void **state)
{
    (void)state;
    memory_frames frames = {.count = UINT64_MAX, .failing = UINT64_MAX};
    helio_source *source;
    helio_environment *environment;
    const helio_environment_desc desc = {.cube_size = 4, .width = WIDTH, .height = HEIGHT};
    assert_ok(helio_environment_create(context, &desc, &environment));
    for (uint32_t i = 0; i < 6; i += 2) {
        const helio_source_desc range = {.has_frames = true, .first = i, .last = i};
        assert_ok(helio_source_open_callback(context, NULL, give_map, &frames, &range, &source));
        size_t before = memory.taken;
        helio_source_frame frame = next_frame(source);
        assert_true(frame.index == i && frame.seconds == 0);
        assert_ok(helio_source_apply(source, &frame, environment, NULL));
        assert_int_equal(memory.taken, before);
        expect_end(source);
        helio_source_close(source);
    }
    assert_int_equal(frames.calls, 3);
    helio_environment_destroy(environment);
}

static helio_status give_square(void *user, uint64_t index, helio_source_map *map)
{
    static const float square[4][3];
    (void)index;
    *map = (helio_source_map){.pixels = {.data = square}, .width = 2, .height = 2, .layout = *(helio_layout *)user};
    return HELIO_OK;
}

static void test_callbacks_may_fail(void **state)
{
    (void)state;
    memory_frames frames = {.count = 8, .failing = 1};
    helio_source *source;
    helio_environment *environment;
    assert_ok(helio_source_open_callback(context, "camera", give_map, &frames, NULL, &source));
    next_frame(source);
    expect_next_failure(source, HELIO_ERR_IO, "frame 1 of camera cannot be had");
    expect_end(source);
    helio_source_close(source);

    helio_layout layout = HELIO_LAYOUT_AUTO;
    assert_ok(helio_source_open_callback(context, NULL, give_square, &layout, NULL, &source));
    expect_next_failure(source, HELIO_ERR_ARGUMENT, "frame 0 of callback: 2 x 2 pixels do not tell the layout");
    helio_source_close(source);
    layout = HELIO_LAYOUT_OCTAHEDRAL;
    assert_ok(helio_source_open_callback(context, NULL, give_square, &layout, NULL, &source));
    helio_source_frame frame = next_frame(source);
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 4}, &environment));
    assert_ok(helio_source_apply(source, &frame, environment, NULL));
    assert_ok(helio_source_check_output(source, in_directory("picture.exr")));
    helio_source_close(source);
    helio_environment_destroy(environment);

    source = (helio_source *)&memory;
    assert_int_equal(helio_source_open_callback(context, NULL, NULL, NULL, NULL, &source), HELIO_ERR_ARGUMENT);
    assert_null(source);
}

static const char SKY[] = "sky:lat=44.8,lon=-0.6,date=2026-06-21,time=10:30,zone=2";

static void test_a_sky_is_one_frame(void **state)
{
    (void)state;
    helio_source *source = open_source(SKY, NULL);
    helio_source_info info = helio_source_get_info(source);
    assert_int_equal(info.kind, HELIO_SOURCE_SKY);
    assert_int_equal(info.frame_count, 1);
    assert_false(info.is_dynamic);
    helio_source_frame frame = next_frame(source);
    assert_null(frame.rgb);
    assert_non_null(frame.sky);
    assert_true(frame.hours == 10.5);
    const helio_sky_place place = {
        .latitude = 44.8, .longitude = -0.6, .year = 2026, .month = 6, .day = 21, .hours = 10.5, .zone = 2};
    helio_sun sun;
    assert_ok(helio_sun_find(&place, &sun));
    assert_true(fabs(frame.sky->sun.elevation - sun.elevation) < 1e-3);
    assert_true(fabs(frame.sky->sun.azimuth - sun.azimuth) < 1e-3);
    helio_environment *environment;
    assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = 16}, &environment));
    helio_environment_info light;
    assert_ok(helio_source_apply(source, &frame, environment, &light));
    assert_true(light.mean_luminance > 0);
    assert_int_equal(helio_environment_frame(environment), 1);
    expect_end(source);
    helio_source_close(source);
    helio_environment_destroy(environment);

    source = open_source("sky:azimuth=90,elevation=30", NULL);
    frame = next_frame(source);
    assert_true(isnan(frame.hours));
    assert_true(fabs(frame.sky->sun.elevation - 30) < 1e-4);
    helio_source_close(source);
}

static void test_a_day_goes_from_sunrise_to_sunset(void **state)
{
    (void)state;
    const helio_sky_place place = {.latitude = 44.8, .longitude = -0.6, .year = 2026, .month = 6, .day = 21, .zone = 0};
    double sunrise, sunset;
    assert_ok(helio_sun_day(&place, &sunrise, &sunset));
    helio_source *source =
        open_source("sky:day,lat=44.8,lon=-0.6,date=2026-06-21,zone=0", &(helio_source_desc){.frames = 25, .fps = 12});
    helio_source_info info = helio_source_get_info(source);
    assert_int_equal(info.kind, HELIO_SOURCE_SKY_DAY);
    assert_int_equal(info.frame_count, 25);
    assert_true(info.is_dynamic);
    double highest = 0;
    for (uint32_t i = 0; i < 25; i++) {
        helio_source_frame frame = next_frame(source);
        assert_int_equal(frame.index, i);
        assert_true(fabs(frame.seconds - i / 12.0) < 1e-9);
        assert_true(fabs(frame.hours - (sunrise + (sunset - sunrise) * i / 24.0)) < 1e-3);
        double elevation = frame.sky->sun.elevation;
        assert_true(i == 0 || i == 24 ? fabs(elevation) < 1.0 : elevation > 0.0);
        highest = fmax(highest, elevation);
    }
    assert_true(fabs(highest - (90 - 44.8 + 23.44)) < 0.5);
    expect_end(source);
    helio_source_close(source);

    source = open_source("sky:day", NULL);
    assert_int_equal(helio_source_get_info(source).frame_count, 240);
    helio_source_close(source);
    source = open_source("sky:day", &(helio_source_desc){.has_frames = true, .first = 238, .last = 500});
    assert_int_equal(helio_source_get_info(source).frame_count, 2);
    assert_int_equal(next_frame(source).index, 238);
    assert_int_equal(next_frame(source).index, 239);
    expect_end(source);
    helio_source_close(source);
    source = open_source("sky:day", &(helio_source_desc){.frames = 1});
    assert_false(helio_source_get_info(source).is_dynamic);
    next_frame(source);
    expect_end(source);
    helio_source_close(source);
    /* Its sun sets after midnight of the zone. */
    source = open_source("sky:day,lat=0,lon=-170,zone=0", &(helio_source_desc){.frames = 9});
    for (uint32_t i = 0; i < 9; i++) {
        double hours = next_frame(source).hours;
        assert_true(hours >= 0 && hours <= 24);
    }
    helio_source_close(source);
    expect_open_failure("sky:day,lat=80,date=2026-12-21", NULL, HELIO_ERR_DATA, "");
}

static void test_skies_come_for_cubes_of_any_size_and_beside_maps(void **state)
{
    (void)state;
    helio_source *day = open_source("sky:day,turbidity=2", &(helio_source_desc){.frames = 7});
    helio_source *map = open_source("constant:7", NULL);
    helio_source_frame colour = next_frame(map);
    static const uint32_t sizes[] = {1, 8, 4, 64};
    for (size_t i = 0; i < COUNT(sizes); i++) {
        helio_environment *environment;
        assert_ok(helio_environment_create(context, &(helio_environment_desc){.cube_size = sizes[i]}, &environment));
        helio_source_frame frame = next_frame(day);
        helio_environment_info info;
        assert_ok(helio_source_apply(day, &frame, environment, &info));
        assert_true(info.max_luminance > 0);
        assert_ok(helio_source_apply(map, &colour, environment, &info));
        assert_true(fabsf(info.max_luminance - 7.0f) < 1e-5f);
        assert_ok(helio_source_apply(day, &frame, environment, &info));
        assert_true(fabsf(info.max_luminance - 7.0f) > 1e-3f);
        helio_environment_destroy(environment);
    }
    helio_source_close(map);
    helio_source_close(day);
}

static void test_files_that_are_neither_picture_nor_video_are_told(void **state)
{
    (void)state;
    write_text("notes", "neither the one nor the other, and long enough to be looked at by a prober of formats\n");
    expect_open_failure(in_directory("notes"), NULL, HELIO_ERR_DATA,
                        "notes is no picture of a kind that is known here, and it");
    assert_null(strstr(strstr(helio_last_error(), "notes") + 1, "notes")); /* named once */
    write_text("map.exr", "not OpenEXR at all");
    helio_source *source = open_source(in_directory("map.exr"), NULL);
    expect_next_failure(source, HELIO_ERR_DATA, "map.exr is not a picture");
    expect_end(source);
    helio_source_close(source);
    write_map("picture.mp4", WIDTH, HEIGHT, 2.0f); /* its content counts, not its name */
    source = open_source(in_directory("picture.mp4"), NULL);
    assert_int_equal(helio_source_get_info(source).kind, HELIO_SOURCE_FILE);
    expect_frame(source, 0, 2.0f, false);
    helio_source_close(source);
}

static uint32_t find_checksum(const unsigned char *bytes, size_t size)
{
    uint32_t sum = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        sum ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            sum = sum >> 1 ^ (sum & 1 ? UINT32_C(0xedb88320) : 0);
    }
    return ~sum;
}

/* A picture that says of itself to be the first of some, behind the file's signature and its first chunk. */
static void write_animation(const char *path, unsigned char frames)
{
    enum { CUT = 33, CHUNK = 20, MOST = 4096 };
    static const float rgba[WIDTH * HEIGHT * 4];
    unsigned char bytes[MOST], chunk[CHUNK] = {0, 0, 0, 8, 'a', 'c', 'T', 'L', 0, 0, 0, frames};
    uint32_t sum = find_checksum(chunk + 4, 12);
    for (int i = 0; i < 4; i++)
        chunk[16 + i] = (unsigned char)(sum >> (24 - 8 * i));
    assert_ok(
        helio_picture_write(context, path, &(helio_picture){.width = WIDTH, .height = HEIGHT, .rgba = rgba}, NULL));
    FILE *stream = fopen(path, "rb");
    assert_non_null(stream);
    size_t size = fread(bytes, 1, MOST - CHUNK, stream);
    assert_int_equal(fclose(stream), 0);
    assert_in_range(size, CUT + 12, MOST - CHUNK - 1);
    memmove(bytes + CUT + CHUNK, bytes + CUT, size - CUT);
    memcpy(bytes + CUT, chunk, CHUNK);
    write_bytes(path, bytes, size + CHUNK);
}

static void test_of_pictures_that_move_the_first_is_read_with_a_warning(void **state)
{
    (void)state;
    const char *path = in_directory("moving.png");
    if (helio_picture_check_path(path) != HELIO_OK) {
        print_message("skipped: %s\n", helio_last_error());
        skip();
    }
    helio_image *image;
    write_animation(path, 1);
    helio_source *source = open_source(path, NULL);
    assert_int_equal(helio_source_get_info(source).kind, HELIO_SOURCE_FILE);
    expect_frame(source, 0, 0.0f, false);
    helio_source_close(source);
    expect_log("", 0);
    write_animation(path, 3);
    assert_ok(helio_image_read(context, path, NULL, &image));
    helio_image_destroy(context, image);
    expect_log("moving.png is an animation of 3 pictures, of which the first is used", 1);
    unsigned char cut[40] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"; /* the file ends before anything else is told */
    write_bytes(path, cut, sizeof cut);
    source = open_source(path, NULL);
    expect_next_failure(source, HELIO_ERR_DATA, "moving.png");
    helio_source_close(source);
}

/* ---- video ------------------------------------------------------------------------------- */

enum { FILM_WIDTH = 64, FILM_HEIGHT = 32, FILM_FRAMES = 40 };

/* A film that gets brighter; false, and a word about it, where this build cannot make one. */
static bool write_film(const char *path)
{
    const helio_video_write_desc desc = {.width = FILM_WIDTH, .height = FILM_HEIGHT, .fps = 20, .codec = "ffv1"};
    helio_video_writer *writer;
    helio_status status = helio_video_create(context, path, &desc, &writer);
    if (status == HELIO_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", helio_last_error());
        return false;
    }
    assert_ok(status);
    static float rgba[FILM_WIDTH * FILM_HEIGHT * 4];
    for (int i = 0; i < FILM_FRAMES; i++) {
        for (int k = 0; k < FILM_WIDTH * FILM_HEIGHT * 4; k++) /* not flat, so that frames have some bytes */
            rgba[k] = k % 4 == 3 ? 1.0f : (float)(i + 1) / (FILM_FRAMES + 2) + 0.02f * (float)(k * 7919 % 101) / 101.0f;
        assert_ok(helio_video_add(writer, &(helio_picture){.width = FILM_WIDTH, .height = FILM_HEIGHT, .rgba = rgba}));
    }
    assert_ok(helio_video_finish(writer, true));
    return true;
}

/* Brightness of the whole frame. */
static double frame_mean(const helio_source_frame *frame)
{
    double sum = 0;
    size_t count = 3 * (size_t)frame->width * frame->height;
    for (size_t i = 0; i < count; i++)
        sum += (double)frame->rgb[i];
    return sum / (double)count;
}

static void test_video_frames_come_in_order(void **state)
{
    (void)state;
    const char *path = in_directory("film.mkv");
    if (!write_film(path))
        skip();
    assert_int_equal(rename(path, in_directory("film")), 0); /* told by its content */
    path = in_directory("film");
    for (uint32_t queue = 1; queue <= 4; queue += 3) {
        helio_source *source = open_source(path, &(helio_source_desc){.queue = queue, .fps = 7});
        helio_source_info info = helio_source_get_info(source);
        assert_int_equal(info.kind, HELIO_SOURCE_VIDEO);
        assert_true(info.frame_count == FILM_FRAMES || info.frame_count == 0);
        assert_true(info.is_dynamic);
        assert_true(fabs(info.fps - 20.0) < 1e-6);
        double before = 0;
        for (uint32_t i = 0; i < FILM_FRAMES; i++) {
            helio_source_frame frame = next_frame(source);
            assert_int_equal(frame.index, i);
            assert_true(fabs(frame.seconds - i / 20.0) < 1e-3);
            assert_int_equal(frame.width, FILM_WIDTH);
            assert_int_equal(frame.layout, HELIO_LAYOUT_LATLONG);
            assert_string_equal(frame.name, path);
            assert_true(frame_mean(&frame) > before);
            before = frame_mean(&frame);
        }
        expect_end(source);
        helio_source_close(source);
    }
}

static void test_parts_of_a_video_can_be_asked_for(void **state)
{
    (void)state;
    const char *path = in_directory("film.mkv");
    if (!write_film(path))
        skip();
    helio_source *source = open_source(path, NULL);
    double means[FILM_FRAMES];
    for (uint32_t i = 0; i < FILM_FRAMES; i++) {
        helio_source_frame frame = next_frame(source);
        means[i] = frame_mean(&frame);
    }
    helio_source_close(source);
    source = open_source(path, &(helio_source_desc){.has_frames = true, .first = 30, .last = 33});
    for (uint32_t i = 30; i <= 33; i++) {
        helio_source_frame frame = next_frame(source);
        assert_int_equal(frame.index, i);
        assert_true(fabs(frame.seconds - (i - 30) / 20.0) < 1e-3);
        assert_true(frame_mean(&frame) == means[i]);
    }
    expect_end(source);
    helio_source_close(source);

    const helio_source_desc beyond = {.has_frames = true, .first = FILM_FRAMES + 5, .last = FILM_FRAMES + 9};
    helio_status status = helio_source_open(context, path, &beyond, &source);
    helio_source_frame frame;
    if (status == HELIO_OK) /* the file does not say how many frames it has */
        status = helio_source_next(source, &frame);
    assert_int_equal(status, HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "it has only 40"));
    helio_source_close(source);
}

static void test_a_truncated_video_ends_with_a_sentence_after_its_frames(void **state)
{
    (void)state;
    const char *path = in_directory("film.mkv");
    struct stat file;
    if (!write_film(path))
        skip();
    assert_int_equal(stat(path, &file), 0);
    assert_int_equal(truncate(path, file.st_size * 3 / 5), 0);
    helio_source *source = open_source(path, NULL);
    uint32_t good = 0;
    helio_source_frame frame;
    helio_status status;
    while ((status = helio_source_next(source, &frame)) == HELIO_OK && frame.rgb != NULL)
        good++;
    assert_int_equal(status, HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), path));
    assert_in_range(good, 5, FILM_FRAMES - 5);
    expect_end(source);
    helio_source_close(source);

    source = open_source(path, &(helio_source_desc){.on_missing = HELIO_ON_MISSING_SKIP});
    for (uint32_t i = 0; i < good; i++)
        assert_int_equal(next_frame(source).index, i);
    expect_end(source);
    helio_source_close(source);
    expect_log("what cannot be decoded is skipped", 1);
}

static void test_videos_can_be_closed_at_any_moment(void **state)
{
    (void)state;
    const char *path = in_directory("film.mkv");
    if (!write_film(path))
        skip();
    for (uint32_t i = 0; i < 24; i++) {
        helio_source *source = open_source(path, &(helio_source_desc){.queue = 1 + i % 3});
        for (uint32_t k = 0; k < i; k++)
            next_frame(source);
        helio_source_close(source);
    }
    helio_source *source = open_source(path, &(helio_source_desc){.has_frames = true, .first = 39, .last = 39});
    helio_source_close(source);
}

/* A device that never ends, and can be left all the same. */
static void test_devices_give_frames_for_ever(void **state)
{
    (void)state;
    helio_source *source;
    helio_status status =
        helio_source_open(context, "lavfi:testsrc2=size=128x64:rate=30", &(helio_source_desc){.fps = 7}, &source);
    if (status == HELIO_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", helio_last_error());
        skip();
    }
    assert_ok(status);
    helio_source_info info = helio_source_get_info(source);
    assert_int_equal(info.kind, HELIO_SOURCE_DEVICE);
    assert_int_equal(info.frame_count, 0);
    assert_true(info.is_dynamic);
    for (uint32_t i = 0; i < 50; i++) {
        helio_source_frame frame = next_frame(source);
        assert_int_equal(frame.index, i);
        assert_int_equal(frame.width, 128);
    }
    helio_source_close(source);
    expect_open_failure("v4l2:/dev/null", NULL, HELIO_ERR_IO, "/dev/null");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_check_tells_the_kind),
        TEST(test_mistakes_in_specifications_are_told_before_anything_is_opened),
        TEST(test_wrong_descs_are_refused),
        TEST(test_choices_for_missing_frames_have_names),
        TEST(test_patterns_have_one_strict_integer),
        TEST(test_hostile_patterns_are_mistakes_unless_a_file_has_the_name),
        TEST(test_files_that_exist_win_over_patterns),
        TEST(test_names_are_sorted_as_people_count),
        TEST(test_numbered_frames_come_in_order),
        TEST(test_a_range_of_numbers_is_honoured),
        TEST(test_numbers_may_be_in_the_names_of_folders),
        TEST(test_a_name_may_go_on_with_digits_after_the_number),
        TEST(test_globs_are_sorted_by_number),
        TEST(test_sequences_without_files_are_told_when_they_are_opened),
        TEST(test_six_faces_are_one_frame),
        TEST(test_sequences_may_be_of_six_faces_each),
        TEST(test_stop_ends_at_a_gap),
        TEST(test_stop_ends_at_an_unreadable_frame),
        TEST(test_skip_goes_on_after_a_gap),
        TEST(test_hold_repeats_the_frame_before),
        TEST(test_hold_skips_what_comes_before_the_first_good_frame),
        TEST(test_the_largest_gap_is_skipped_at_once),
        TEST(test_sequences_without_a_good_frame_fail),
        TEST(test_frames_without_a_layout_count_as_unreadable),
        TEST(test_files_may_vanish_or_turn_to_garbage_while_they_are_read),
        TEST(test_what_is_no_file_is_unreadable),
        TEST(test_claims_of_huge_frames_are_refused),
        TEST(test_closing_at_any_moment_ends_the_thread),
        TEST(test_reading_goes_on_beside_the_callers_work),
        TEST(test_frames_use_their_memory_again),
        TEST(test_memory_is_bounded_where_sizes_change),
        TEST(test_memory_that_runs_out_is_told),
        TEST(test_frames_of_another_size_or_layout_reshape_the_environment),
        TEST(test_bad_and_black_frames_are_frames),
        TEST(test_constants_are_maps_of_one_pixel),
        TEST(test_callbacks_give_maps_where_they_lie),
        TEST(test_callbacks_of_one_shape_take_no_memory),
        TEST(test_callbacks_may_fail),
        TEST(test_a_sky_is_one_frame),
        TEST(test_a_day_goes_from_sunrise_to_sunset),
        TEST(test_skies_come_for_cubes_of_any_size_and_beside_maps),
        TEST(test_files_that_are_neither_picture_nor_video_are_told),
        TEST(test_of_pictures_that_move_the_first_is_read_with_a_warning),
        TEST(test_video_frames_come_in_order),
        TEST(test_parts_of_a_video_can_be_asked_for),
        TEST(test_a_truncated_video_ends_with_a_sentence_after_its_frames),
        TEST(test_videos_can_be_closed_at_any_moment),
        TEST(test_devices_give_frames_for_ever),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
