/* SPDX-License-Identifier: MIT
 *
 * Videos that are written: what players find in them, and what is left where writing fails. */
#include "video_support.h"

#include "image/colour.h"
#include "image/tonemap.h"

#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <libavformat/avformat.h>

typedef struct fixture {
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    memory_count memory;
    helio_context *context;
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    make_directory(f->directory);
    f->context = make_context(2, &f->memory);
    *state = f;
    return 0;
}

/* Also finds leaks. */
static int tear_down(void **state)
{
    fixture *f = *state;
    helio_context_destroy(f->context);
    size_t live = atomic_load(&f->memory.live);
    remove_directory(f->directory);
    free(f);
    return live == 0 ? 0 : -1;
}

static int count_files(const char *directory)
{
    DIR *folder = opendir(directory);
    int count = 0;
    for (const struct dirent *entry; (entry = readdir(folder)) != NULL;)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(folder);
    return count;
}

/* ---- pictures ---- */

/* Smooth colours from black to brightest that move with time. */
static float *make_picture(uint32_t width, uint32_t height, int number, float brightest, helio_picture *picture)
{
    float *rgba = malloc(4 * sizeof(float) * width * height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            float u = ((float)x + 0.5f) / (float)width, v = ((float)y + 0.5f) / (float)height;
            float *pixel = rgba + 4 * ((size_t)y * width + x);
            pixel[0] = brightest * u * u;
            pixel[1] = brightest * v * v;
            pixel[2] = brightest * (1 - u) * (0.5f + 0.02f * (float)number);
            pixel[3] = 1;
        }
    *picture = (helio_picture){.width = width, .height = height, .rgba = rgba};
    return rgba;
}

enum { FRAMES = 5 };

/* In place of its radiance. */
static void take_as_shown(helio_picture *picture, const helio_video_write_desc *desc, uint8_t *shown)
{
    const helio_picture_write_desc look = {.exposure = desc->exposure, .tonemap = desc->tonemap};
    for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
        tonemap_shown(picture->rgba + 4 * i, &look, shown + 4 * i);
    picture->rgba = NULL;
    picture->shown = shown;
}

/* Every other frame comes as it is shown. Skips the test where there is no such encoder. */
static void write_video(fixture *f, const char *name, const helio_video_write_desc *desc, float brightest)
{
    join(f->path, f->directory, name);
    helio_status status = helio_video_check_path(f->path, desc);
    if (status == HELIO_ERR_UNSUPPORTED) {
        print_message("skipped: %s\n", helio_last_error());
        skip();
    }
    helio_video_writer *writer;
    assert_ok(status);
    assert_ok(helio_video_create(f->context, f->path, desc, &writer));
    for (int i = 0; i < FRAMES; i++) {
        helio_picture picture;
        float *rgba = make_picture(desc->width, desc->height, i, brightest, &picture);
        uint8_t *shown = malloc((size_t)4 * desc->width * desc->height);
        assert_non_null(shown);
        if (i % 2 != 0 && !desc->hdr)
            take_as_shown(&picture, desc, shown);
        assert_ok(helio_video_add(writer, &picture));
        free(shown);
        free(rgba);
    }
    assert_ok(helio_video_finish(writer, true));
    assert_int_equal(count_files(f->directory), 1);
}

/* The screen's values of a pixel: what a PNG would hold, as floats. */
static void show(const helio_video_write_desc *desc, const float rgba[4], float shown[3])
{
    const helio_picture_write_desc look = {.exposure = desc->exposure, .tonemap = desc->tonemap};
    unsigned char bytes[3];
    tonemap_pixel(rgba, &look, bytes);
    for (int c = 0; c < 3; c++)
        shown[c] = (float)bytes[c] / 255;
}

typedef struct difference {
    double mean, greatest;
} difference;

/* Compares every frame with its picture in the screen's values, without repeated columns and rows. */
static difference compare_with_png(fixture *f, const helio_video_write_desc *desc, float brightest)
{
    difference result = {0, 0};
    helio_video_reader *reader;
    assert_ok(helio_video_open(f->context, f->path, NULL, &reader));
    for (int i = 0; i < FRAMES; i++) {
        helio_video_frame frame;
        helio_picture picture;
        float *rgba = make_picture(desc->width, desc->height, i, brightest, &picture);
        assert_ok(helio_video_next(reader, &frame));
        assert_non_null(frame.rgb);
        for (uint32_t y = 0; y < desc->height; y++)
            for (uint32_t x = 0; x < desc->width; x++) {
                float shown[3];
                show(desc, rgba + 4 * ((size_t)y * desc->width + x), shown);
                for (int c = 0; c < 3; c++) {
                    float value = frame.rgb[3 * ((size_t)y * frame.width + x) + (size_t)c];
                    value = srgb_encode(value > 0 ? value < 1 ? value : 1 : 0);
                    double error = fabs((double)(value - shown[c]));
                    result.mean += error / (3.0 * FRAMES * desc->width * desc->height);
                    result.greatest = fmax(result.greatest, error);
                }
            }
        free(rgba);
    }
    helio_video_frame last;
    assert_ok(helio_video_next(reader, &last));
    assert_null(last.rgb);
    helio_video_close(reader);
    return result;
}

static void ffv1_holds_the_pixels_of_a_png(void **state)
{
    const helio_video_write_desc descs[] = {
        {.width = 37, .height = 23},
        {.width = 37, .height = 23, .exposure = -1.5f, .tonemap = HELIO_TONEMAP_REINHARD, .codec = "ffv1"}};
    for (int i = 0; i < 2; i++) {
        write_video(*state, "a.mkv", &descs[i], 2);
        difference d = compare_with_png(*state, &descs[i], 2);
        assert_true(d.greatest < 2e-5);
    }
}

static void players_show_what_a_png_shows(void **state)
{
    static const struct {
        const char *name, *codec;
        uint32_t width, height;
    } KINDS[] = {{"a.mp4", NULL, 64, 48},   {"a.mov", NULL, 64, 48},   {"a.mp4", "h264", 65, 47},
                 {"a.mkv", "h264", 64, 48}, {"a.mp4", "hevc", 64, 48}, {"a.mp4", "hevc", 63, 49},
                 {"a.webm", NULL, 64, 64},  {"a.webm", NULL, 33, 31},  {"a.mp4", "av1", 64, 64},
                 {"a.mkv", "vp9", 64, 48}};
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++) {
        const helio_video_write_desc desc = {.width = KINDS[i].width,
                                             .height = KINDS[i].height,
                                             .codec = KINDS[i].codec,
                                             .quality = 1,
                                             .exposure = 0.5f};
        fixture *f = *state;
        join(f->path, f->directory, KINDS[i].name);
        if (helio_video_check_path(f->path, &desc) == HELIO_ERR_UNSUPPORTED) {
            print_message("left out: %s\n", helio_last_error());
            continue;
        }
        write_video(f, KINDS[i].name, &desc, 1);
        difference d = compare_with_png(f, &desc, 1);
        if (d.mean > 0.006 || d.greatest > 0.15)
            fail_msg("%s %s: the values differ by %.4f, at most %.4f", KINDS[i].name,
                     KINDS[i].codec != NULL ? KINDS[i].codec : "", d.mean, d.greatest);
        remove(f->path);
    }
}

/* PQ in ten bits: half a step is 1.3 % of the light at most. */
static void hdr_keeps_light_beyond_white(void **state)
{
    fixture *f = *state;
    const helio_video_write_desc desc = {.width = 48, .height = 32, .hdr = true, .codec = "ffv1", .exposure = 1};
    const float brightest = 20;
    write_video(f, "a.mkv", &desc, brightest);
    helio_video_reader *reader;
    assert_ok(helio_video_open(f->context, f->path, NULL, &reader));
    assert_int_equal(helio_video_get_info(reader).transfer, HELIO_TRANSFER_PQ);
    for (int i = 0; i < FRAMES; i++) {
        helio_video_frame frame;
        helio_picture picture;
        float *rgba = make_picture(desc.width, desc.height, i, brightest, &picture);
        assert_ok(helio_video_next(reader, &frame));
        for (size_t k = 0; k < (size_t)desc.width * desc.height; k++) {
            const float *pixel = rgba + 4 * k;
            double most = 2 * fmax((double)pixel[0], fmax((double)pixel[1], (double)pixel[2]));
            for (size_t c = 0; c < 3; c++)
                if (!(fabs((double)frame.rgb[3 * k + c] - 2 * (double)pixel[c]) <= 0.022 * most + 1e-4))
                    fail_msg("pixel %zu, channel %zu: %g became %g", k, c, 2 * (double)pixel[c],
                             (double)frame.rgb[3 * k + c]);
        }
        free(rgba);
    }
    helio_video_close(reader);
}

/* ---- what the file says ---- */

static bool has_mastering_display(const AVStream *stream)
{
#if LIBAVCODEC_VERSION_INT >= AV_VERSION_INT(60, 30, 100)
    return av_packet_side_data_get(stream->codecpar->coded_side_data, stream->codecpar->nb_coded_side_data,
                                   AV_PKT_DATA_MASTERING_DISPLAY_METADATA) != NULL;
#else
    return av_stream_get_side_data(stream, AV_PKT_DATA_MASTERING_DISPLAY_METADATA, NULL) != NULL;
#endif
}

static void check_tags(fixture *f, bool hdr, bool is_rgb)
{
    AVFormatContext *format = NULL;
    assert_true(avformat_open_input(&format, f->path, NULL, NULL) >= 0);
    assert_true(avformat_find_stream_info(format, NULL) >= 0);
    assert_int_equal(format->nb_streams, 1);
    const AVStream *stream = format->streams[0];
    assert_int_equal(stream->codecpar->color_primaries, hdr ? AVCOL_PRI_BT2020 : AVCOL_PRI_BT709);
    assert_int_equal(stream->codecpar->color_trc, hdr ? AVCOL_TRC_SMPTE2084 : AVCOL_TRC_IEC61966_2_1);
    assert_int_equal(stream->codecpar->color_space, is_rgb ? AVCOL_SPC_RGB
                                                    : hdr  ? AVCOL_SPC_BT2020_NCL
                                                           : AVCOL_SPC_BT709);
    assert_int_equal(stream->codecpar->color_range, is_rgb ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG);
    assert_int_equal(stream->avg_frame_rate.num, 30000);
    assert_int_equal(stream->avg_frame_rate.den, 1001);
    assert_int_equal(has_mastering_display(stream), hdr);
    avformat_close_input(&format);
}

static void files_say_what_they_hold(void **state)
{
    static const struct {
        const char *name, *codec;
        bool hdr, is_rgb;
    } KINDS[] = {{"a.mp4", NULL, false, false},
                 {"a.mp4", NULL, true, false},
                 {"a.mov", NULL, false, false},
                 {"a.mp4", "av1", true, false}};
    fixture *f = *state;
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++) {
        const helio_video_write_desc desc = {
            .width = 64, .height = 64, .fps = 29.97, .codec = KINDS[i].codec, .hdr = KINDS[i].hdr};
        join(f->path, f->directory, KINDS[i].name);
        if (helio_video_check_path(f->path, &desc) == HELIO_ERR_UNSUPPORTED) {
            print_message("left out: %s\n", helio_last_error());
            continue;
        }
        write_video(f, KINDS[i].name, &desc, 1);
        check_tags(f, KINDS[i].hdr, KINDS[i].is_rgb);
        remove(f->path);
    }
}

static size_t find_bytes(const unsigned char *bytes, size_t size, const char *text)
{
    for (size_t i = 0; i + 4 <= size; i++)
        if (memcmp(bytes + i, text, 4) == 0)
            return i;
    return size;
}

static void mp4_begins_with_its_index(void **state)
{
    fixture *f = *state;
    const helio_video_write_desc desc = {.width = 64, .height = 64};
    write_video(f, "a.mp4", &desc, 1);
    size_t size;
    unsigned char *bytes = load_bytes(f->path, &size);
    assert_true(find_bytes(bytes, size, "moov") < find_bytes(bytes, size, "mdat"));
    free(bytes);
}

/* 4:2:0 has no odd sizes. */
static void odd_sizes_repeat_the_last_column_and_row(void **state)
{
    fixture *f = *state;
    const helio_video_write_desc desc = {.width = 33, .height = 31, .quality = 1};
    write_video(f, "a.mp4", &desc, 1);
    helio_video_reader *reader;
    helio_video_frame frame;
    assert_ok(helio_video_open(f->context, f->path, NULL, &reader));
    assert_ok(helio_video_next(reader, &frame));
    assert_int_equal(frame.width, 34);
    assert_int_equal(frame.height, 32);
    for (size_t y = 0; y < 31; y++)
        assert_true(fabsf(frame.rgb[3 * (34 * y + 33)] - frame.rgb[3 * (34 * y + 32)]) < 0.1f);
    helio_video_close(reader);
}

/* ---- failures ---- */

static void wishes_that_cannot_be_met_are_refused(void **state)
{
    fixture *f = *state;
    helio_video_writer *writer;
    static const struct {
        const char *name, *words;
        helio_video_write_desc desc;
    } CASES[] = {
        {"a.avi", ".mp4", {.width = 8, .height = 8}},
        {"a.mp4", "needs a size", {.width = 8}},
        {"a.webm", "h264", {.width = 64, .height = 64, .codec = "h264"}},
        {"a.mp4", "h264 in HDR", {.width = 64, .height = 64, .codec = "h264", .hdr = true}},
        {"a.mp4", "theora", {.width = 64, .height = 64, .codec = "theora"}},
        {"a.mp4", "frames per second", {.width = 64, .height = 64, .fps = -1}},
        {"a.mp4", "quality", {.width = 64, .height = 64, .quality = 1.5f}},
        {"a.mp4", "tone map", {.width = 64, .height = 64, .tonemap = (helio_tonemap)7}},
        {"a.mp4", "each must be", {.width = 1u << 30, .height = 64}},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        join(f->path, f->directory, CASES[i].name);
        assert_int_equal(helio_video_create(f->context, f->path, &CASES[i].desc, &writer), HELIO_ERR_ARGUMENT);
        assert_null(writer);
        if (strstr(helio_last_error(), CASES[i].words) == NULL)
            fail_msg("'%s' does not say '%s'", helio_last_error(), CASES[i].words);
    }
    assert_int_equal(count_files(f->directory), 0);
    assert_true(helio_video_has_extension("x/y.MP4") && helio_video_has_extension("a.webm"));
    assert_false(helio_video_has_extension("mp4") || helio_video_has_extension("a.png") ||
                 helio_video_has_extension(NULL));
    assert_int_equal(helio_video_finish(NULL, true), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_video_finish(NULL, false), HELIO_OK);
}

static helio_video_writer *start(fixture *f, const char *name)
{
    const helio_video_write_desc desc = {.width = 64, .height = 48, .codec = "ffv1"};
    helio_video_writer *writer;
    join(f->path, f->directory, name);
    assert_ok(helio_video_create(f->context, f->path, &desc, &writer));
    return writer;
}

static helio_status add_noise(helio_video_writer *writer, uint64_t *seed)
{
    static float rgba[64 * 48 * 4];
    for (size_t i = 0; i < sizeof rgba / sizeof *rgba; i++)
        rgba[i] = (float)random_unit(seed);
    const helio_picture picture = {.width = 64, .height = 48, .rgba = rgba};
    return helio_video_add(writer, &picture);
}

static void nothing_is_left_of_what_is_given_up(void **state)
{
    fixture *f = *state;
    uint64_t seed = 1;
    helio_video_writer *writer = start(f, "a.mkv");
    assert_ok(add_noise(writer, &seed));
    assert_ok(helio_video_finish(writer, false));
    assert_int_equal(count_files(f->directory), 0);

    writer = start(f, "a.mkv");
    assert_int_equal(helio_video_finish(writer, true), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "no frames"));
    assert_int_equal(count_files(f->directory), 0);

    writer = start(f, "a.mkv");
    const float pixel[4] = {0};
    const helio_picture small = {.width = 1, .height = 1, .rgba = pixel};
    assert_int_equal(helio_video_add(writer, &small), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "1 x 1"));
    assert_ok(add_noise(writer, &seed));
    assert_ok(helio_video_finish(writer, true));
    assert_int_equal(count_files(f->directory), 1);
}

static void a_full_disk_leaves_the_old_file(void **state)
{
    fixture *f = *state;
    uint64_t seed = 2;
    helio_video_writer *writer = start(f, "a.mkv");
    assert_ok(add_noise(writer, &seed));
    assert_ok(helio_video_finish(writer, true));
    size_t before, after;
    free(load_bytes(f->path, &before));

    struct rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    const struct rlimit low = {200000, limit.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    writer = start(f, "a.mkv");
    setrlimit(RLIMIT_FSIZE, &low);
    helio_status status = HELIO_OK;
    for (int i = 0; i < 200 && status == HELIO_OK; i++)
        status = add_noise(writer, &seed);
    helio_status finish = helio_video_finish(writer, true);
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_int_equal(status, HELIO_ERR_IO);
    assert_int_equal(finish, HELIO_ERR_IO);
    free(load_bytes(f->path, &after));
    assert_int_equal(before, after);
    assert_int_equal(count_files(f->directory), 1);
}

static void folders_that_cannot_be_written_are_named(void **state)
{
    fixture *f = *state;
    const helio_video_write_desc desc = {.width = 64, .height = 48, .codec = "ffv1"};
    helio_video_writer *writer;
    join(f->path, f->directory, "missing/a.mkv");
    assert_int_equal(helio_video_create(f->context, f->path, &desc, &writer), HELIO_ERR_IO);
    assert_non_null(strstr(helio_last_error(), "missing/a.mkv"));
    assert_null(writer);
}

static void refused_memory_is_a_sentence(void **state)
{
    fixture *f = *state;
    const helio_video_write_desc desc = {.width = 64, .height = 48, .codec = "ffv1"};
    join(f->path, f->directory, "a.mkv");
    for (size_t allowed = 1; allowed < 100; allowed++) {
        memory_count memory = {.refuse_after = allowed + 2};
        helio_context *context = make_context(1, &memory);
        helio_video_writer *writer;
        helio_status status = helio_video_create(context, f->path, &desc, &writer);
        if (status == HELIO_OK)
            assert_ok(helio_video_finish(writer, false));
        else
            assert_int_equal(status, HELIO_ERR_MEMORY);
        helio_context_destroy(context);
        assert_int_equal(atomic_load(&memory.live), 0);
        assert_int_equal(count_files(f->directory), 0);
        if (status == HELIO_OK)
            return;
    }
    fail_msg("writing takes more than 100 allocations");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(ffv1_holds_the_pixels_of_a_png, set_up, tear_down),
        cmocka_unit_test_setup_teardown(players_show_what_a_png_shows, set_up, tear_down),
        cmocka_unit_test_setup_teardown(hdr_keeps_light_beyond_white, set_up, tear_down),
        cmocka_unit_test_setup_teardown(files_say_what_they_hold, set_up, tear_down),
        cmocka_unit_test_setup_teardown(mp4_begins_with_its_index, set_up, tear_down),
        cmocka_unit_test_setup_teardown(odd_sizes_repeat_the_last_column_and_row, set_up, tear_down),
        cmocka_unit_test_setup_teardown(wishes_that_cannot_be_met_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_is_left_of_what_is_given_up, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_full_disk_leaves_the_old_file, set_up, tear_down),
        cmocka_unit_test_setup_teardown(folders_that_cannot_be_written_are_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(refused_memory_is_a_sentence, set_up, tear_down),
    };
    setenv("SVT_LOG", "1", 0); /* this encoder talks past FFmpeg's log */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
