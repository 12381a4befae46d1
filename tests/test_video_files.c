/* SPDX-License-Identifier: MIT
 *
 * Video files that are damaged, cut off, hostile or not video at all, and devices: frames or one sentence. */
#include "video_support.h"

#include <heliostat/source.h>

#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

/* A moving pattern, so that packets differ. */
static unsigned pattern(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)clip;
    unsigned noise = (unsigned)(x * 7 + y * 13 + frame * 29 + component * 50);
    return 40 + (noise ^ noise >> 3) % 170;
}

static video_clip plain_clip(const char *muxer, enum AVCodecID codec)
{
    bool is_jpeg = codec == AV_CODEC_ID_MJPEG;
    return (video_clip){.muxer = muxer,
                        .codec = codec,
                        .format = is_jpeg ? AV_PIX_FMT_YUVJ420P : AV_PIX_FMT_YUV420P,
                        .width = 64,
                        .height = 48,
                        .frames = 12,
                        .range = is_jpeg ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG,
                        .primaries = AVCOL_PRI_BT709,
                        .transfer = AVCOL_TRC_BT709,
                        .matrix = is_jpeg ? AVCOL_SPC_BT470BG : AVCOL_SPC_BT709,
                        .key_distance = 4,
                        .code = pattern};
}

typedef struct outcome {
    unsigned frames;
    helio_status status; /* of opening or of the first call that failed */
    char sentence[512];
    bool ended; /* the end came, after the failure if there was one */
} outcome;

static void note(outcome *result, helio_status status)
{
    if (status == HELIO_OK || result->status != HELIO_OK)
        return;
    result->status = status;
    snprintf(result->sentence, sizeof result->sentence, "%s", helio_last_error());
}

/* Reads to the end, over damaged frames too. */
static outcome read_all(fixture *f, const char *path, const helio_video_read_desc *desc)
{
    outcome result = {0};
    helio_video_reader *reader;
    helio_video_frame frame = {0};
    note(&result, helio_video_open(f->context, path, desc, &reader));
    if (result.status != HELIO_OK) {
        assert_null(reader);
        assert_true(result.sentence[0] != 0);
        return result;
    }
    for (unsigned calls = 0; calls < 1000 && !result.ended; calls++) {
        helio_status status = helio_video_next(reader, &frame);
        note(&result, status);
        result.ended = status == HELIO_OK && frame.rgb == NULL;
        if (status == HELIO_OK && frame.rgb != NULL) {
            result.frames++;
            for (size_t i = 0; i < (size_t)frame.width * frame.height * 3; i++)
                assert_true(isfinite((double)frame.rgb[i]));
        }
    }
    helio_video_close(reader);
    return result;
}

static void expect(const outcome *result, helio_status status, const char *words)
{
    if (result->status != status || strstr(result->sentence, words) == NULL)
        fail_msg("%s: %s, where something with '%s' was expected", helio_status_name(result->status), result->sentence,
                 words);
}

/* ---- whole files ---- */

static void whole_files_are_read_to_their_end(void **state)
{
    static const struct {
        const char *name, *muxer;
        enum AVCodecID codec;
    } KINDS[] = {{"a.mkv", "matroska", AV_CODEC_ID_FFV1},    {"a.mp4", "mp4", AV_CODEC_ID_MPEG4},
                 {"a.mov", "mov", AV_CODEC_ID_MJPEG},        {"a.avi", "avi", AV_CODEC_ID_MPEG4},
                 {"a.ts", "mpegts", AV_CODEC_ID_MPEG2VIDEO}, {"a.mkv", "matroska", AV_CODEC_ID_MPEG2VIDEO},
                 {"a.mp4", "mp4", AV_CODEC_ID_H264},         {"a.mkv", "matroska", AV_CODEC_ID_HEVC},
                 {"a.webm", "webm", AV_CODEC_ID_VP9},        {"a.mjpeg", "mjpeg", AV_CODEC_ID_MJPEG}};
    fixture *f = *state;
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++) {
        if (avcodec_find_encoder(KINDS[i].codec) == NULL) {
            print_message("left out: this FFmpeg has no encoder for %s\n", avcodec_get_name(KINDS[i].codec));
            continue;
        }
        video_clip made = plain_clip(KINDS[i].muxer, KINDS[i].codec);
        join(f->path, f->directory, KINDS[i].name);
        write_clip(f->path, &made);
        outcome result = read_all(f, f->path, NULL);
        if (result.status != HELIO_OK || result.frames != 12 || !result.ended)
            fail_msg("%s in %s: %u frames, %s", avcodec_get_name(KINDS[i].codec), KINDS[i].muxer, result.frames,
                     result.sentence);
    }
}

static void sizes_may_change_midway(void **state)
{
    fixture *f = *state;
    char second[TEST_PATH_SIZE];
    join(f->path, f->directory, "a.mjpeg");
    join(second, f->directory, "b.mjpeg");
    video_clip made = plain_clip("mjpeg", AV_CODEC_ID_MJPEG);
    write_clip(f->path, &made);
    made.width = 33;
    made.height = 71;
    write_clip(second, &made);
    size_t size[2];
    unsigned char *one = load_bytes(f->path, &size[0]), *two = load_bytes(second, &size[1]);
    unsigned char *both = malloc(size[0] + size[1]);
    memcpy(both, one, size[0]);
    memcpy(both + size[0], two, size[1]);
    save_bytes(f->path, both, size[0] + size[1]);
    free(one);
    free(two);
    free(both);

    helio_video_reader *reader;
    assert_ok(helio_video_open(f->context, f->path, NULL, &reader));
    for (int i = 0; i < 24; i++) {
        helio_video_frame frame;
        assert_ok(helio_video_next(reader, &frame));
        assert_non_null(frame.rgb);
        assert_int_equal(frame.width, i < 12 ? 64 : 33);
        assert_int_equal(frame.height, i < 12 ? 48 : 71);
    }
    helio_video_close(reader);
}

static void memory_stays_flat_and_refusals_are_sentences(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "a.mkv");
    video_clip made = plain_clip("matroska", AV_CODEC_ID_FFV1);
    made.frames = 40;
    write_clip(f->path, &made);
    helio_video_reader *reader;
    helio_video_frame frame;
    assert_ok(helio_video_open(f->context, f->path, NULL, &reader));
    assert_ok(helio_video_next(reader, &frame));
    size_t taken = atomic_load(&f->memory.taken);
    for (int i = 1; i < 40; i++)
        assert_ok(helio_video_next(reader, &frame));
    assert_int_equal(atomic_load(&f->memory.taken), taken);
    helio_video_close(reader);

    for (size_t allowed = 1; allowed < 100; allowed++) {
        fixture poor = {.memory = {.refuse_after = allowed + 2}};
        poor.context = make_context(1, &poor.memory);
        outcome result = read_all(&poor, f->path, NULL);
        helio_context_destroy(poor.context);
        assert_int_equal(atomic_load(&poor.memory.live), 0);
        if (result.status == HELIO_OK)
            return;
        assert_int_equal(result.status, HELIO_ERR_MEMORY);
    }
    fail_msg("reading takes more than 100 allocations");
}

/* ---- damage ---- */

static void cut_files_give_their_good_frames_and_a_sentence(void **state)
{
    static const struct {
        const char *name, *muxer;
        enum AVCodecID codec;
    } KINDS[] = {{"a.mkv", "matroska", AV_CODEC_ID_FFV1}, {"a.mov", "mov", AV_CODEC_ID_MJPEG}};
    fixture *f = *state;
    for (size_t i = 0; i < 2; i++) {
        char cut[TEST_PATH_SIZE];
        join(f->path, f->directory, KINDS[i].name);
        join(cut, f->directory, "cut");
        video_clip made = plain_clip(KINDS[i].muxer, KINDS[i].codec);
        write_clip(f->path, &made);
        size_t size;
        unsigned char *bytes = load_bytes(f->path, &size);
        for (size_t part = 0; part < 20; part++) {
            save_bytes(cut, bytes, size * part / 20);
            outcome result = read_all(f, cut, NULL);
            assert_int_equal(result.status, HELIO_ERR_DATA);
            assert_true(result.frames < 12);
            if (i == 0 && part > 2) { /* MOV has its index at the end, and is nothing without */
                char words[64];
                snprintf(words, sizeof words, "ends after %u frames", result.frames);
                expect(&result, HELIO_ERR_DATA, words);
                assert_true(result.frames + 2 >= part * 12 / 20);
                assert_true(result.ended);
            }
        }
        free(bytes);
    }
}

/* Overwrites so many bytes of the sixth picture, counted by how pictures begin. */
static void damage_sixth(const char *path, const char *beginning, size_t count)
{
    size_t size, start = 0;
    unsigned char *bytes = load_bytes(path, &size);
    for (int pictures = 0; start + count < size; start++) {
        pictures += memcmp(bytes + start, beginning, strlen(beginning)) == 0;
        if (pictures == 6)
            break;
    }
    memset(bytes + start, 0, count);
    save_bytes(path, bytes, size);
    free(bytes);
}

static void reading_goes_on_behind_a_damaged_frame(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "a.mov");
    video_clip made = plain_clip("mov", AV_CODEC_ID_PNG);
    made.format = AV_PIX_FMT_RGB24;
    write_clip(f->path, &made);
    damage_sixth(f->path, "\x89PNG", 8);
    outcome result = read_all(f, f->path, NULL);
    expect(&result, HELIO_ERR_DATA, "is damaged after 5 frames");
    assert_int_equal(result.frames, 11);
    assert_true(result.ended);
}

static void count_warnings(void *user, helio_log_level level, const char *message)
{
    unsigned *count = user;
    *count += level == HELIO_LOG_WARNING && strstr(message, "is damaged at frame") != NULL;
}

/* The JPEG decoder goes on where it can, and says so to its log alone. */
static void damage_that_ffmpeg_patches_up_is_warned_of_once(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "a.mov");
    video_clip made = plain_clip("mov", AV_CODEC_ID_MJPEG);
    write_clip(f->path, &made);
    for (uint32_t threads = 1; threads < 3; threads++)
        for (unsigned damaged = 0; damaged < 2; damaged++) {
            unsigned warnings = 0;
            const helio_context_desc desc = {
                .threads = threads, .log_level = HELIO_LOG_WARNING, .log = count_warnings, .user = &warnings};
            fixture own = {0};
            if (damaged)
                damage_sixth(f->path, "\xff\xd8\xff", 100);
            else
                write_clip(f->path, &made);
            assert_ok(helio_context_create(&desc, &own.context));
            outcome result = read_all(&own, f->path, NULL);
            assert_int_equal(warnings + (result.status != HELIO_OK), damaged);
            helio_context_destroy(own.context);
        }
}

/* Damage at fixed places: whatever comes of it, the reader comes to an end and the sanitizers stay silent. */
static void flipped_bits_do_no_harm(void **state)
{
    static const struct {
        const char *name, *muxer;
        enum AVCodecID codec;
    } KINDS[] = {{"a.mkv", "matroska", AV_CODEC_ID_FFV1},
                 {"a.mp4", "mp4", AV_CODEC_ID_MPEG4},
                 {"a.mov", "mov", AV_CODEC_ID_MJPEG},
                 {"a.mp4", "mp4", AV_CODEC_ID_H264},
                 {"a.avi", "avi", AV_CODEC_ID_MPEG4}};
    fixture *f = *state;
    uint64_t seed = 20;
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++) {
        if (avcodec_find_encoder(KINDS[i].codec) == NULL)
            continue;
        char hurt[TEST_PATH_SIZE];
        join(f->path, f->directory, KINDS[i].name);
        join(hurt, f->directory, "hurt");
        video_clip made = plain_clip(KINDS[i].muxer, KINDS[i].codec);
        made.frames = 6;
        write_clip(f->path, &made);
        size_t size;
        unsigned char *bytes = load_bytes(f->path, &size), *copy = malloc(size);
        for (int round = 0; round < 40; round++) {
            memcpy(copy, bytes, size);
            size_t reach = round % 2 == 0 ? size : size < 600 ? size : 600; /* the head every other time */
            for (int k = 0; k < 1 + round % 5; k++)
                copy[random_bits(&seed) % reach] ^= (unsigned char)(1u << random_bits(&seed) % 8);
            save_bytes(hurt, copy, size);
            const helio_video_read_desc desc = {.max_pixels = 1 << 16};
            outcome result = read_all(f, hurt, &desc);
            assert_true(result.ended || result.status != HELIO_OK);
            assert_true(result.status == HELIO_OK || result.sentence[0] != 0);
        }
        free(bytes);
        free(copy);
    }
}

static void what_is_no_video_is_refused_in_a_sentence(void **state)
{
    fixture *f = *state;
    helio_video_reader *reader;
    join(f->path, f->directory, "text.mp4");
    save_bytes(f->path, (const unsigned char *)"This is no video.\n", 18);
    outcome result = read_all(f, f->path, NULL);
    expect(&result, HELIO_ERR_DATA, "no video that can be read");
    save_bytes(f->path, (const unsigned char *)"", 0);
    result = read_all(f, f->path, NULL);
    expect(&result, HELIO_ERR_DATA, f->path);
    join(f->path, f->directory, "missing.mp4");
    result = read_all(f, f->path, NULL);
    expect(&result, HELIO_ERR_IO, "No such file");
    result = read_all(f, f->directory, NULL);
    expect(&result, HELIO_ERR_IO, "is not a file");
    assert_int_equal(mkfifo(f->path, 0600), 0);
    result = read_all(f, f->path, NULL);
    expect(&result, HELIO_ERR_IO, "is not a file");
    assert_int_equal(helio_video_open(f->context, NULL, NULL, &reader), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_video_open(NULL, f->path, NULL, &reader), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_video_next(NULL, NULL), HELIO_ERR_ARGUMENT);
    helio_video_close(NULL);
}

static void sound_alone_is_no_video(void **state)
{
    static const unsigned char WAVE[] =
        "RIFF\x34\0\0\0WAVEfmt \x10\0\0\0\1\0\1\0\x40\x1f\0\0\x80\x3e\0\0\2\0\x10\0data\x10"
        "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
    fixture *f = *state;
    join(f->path, f->directory, "sound.wav");
    save_bytes(f->path, WAVE, sizeof WAVE - 1);
    outcome result = read_all(f, f->path, NULL);
    expect(&result, HELIO_ERR_DATA, "holds no video");
}

/* Code 188 in all samples but those of the first frame. */
static unsigned flicker(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)clip;
    (void)component;
    return frame == 0 ? (unsigned)(x + y) : 188;
}

/* As sRGB, as other PNG files are, though nothing in the file says so. */
static void animated_png_is_a_video(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "moving.png");
    const video_clip made = {.muxer = "apng",
                             .codec = AV_CODEC_ID_APNG,
                             .format = AV_PIX_FMT_RGB24,
                             .width = 16,
                             .height = 8,
                             .frames = 3,
                             .range = AVCOL_RANGE_JPEG,
                             .primaries = AVCOL_PRI_UNSPECIFIED,
                             .transfer = AVCOL_TRC_UNSPECIFIED,
                             .matrix = AVCOL_SPC_RGB,
                             .code = flicker};
    write_clip(f->path, &made);
    helio_source *source;
    helio_source_frame frame;
    assert_ok(helio_source_open(f->context, f->path, NULL, &source));
    assert_int_equal(helio_source_get_info(source).kind, HELIO_SOURCE_VIDEO);
    for (uint64_t i = 0; i < 3; i++) {
        assert_ok(helio_source_next(source, &frame));
        assert_non_null(frame.rgb);
        assert_int_equal(frame.index, i);
        assert_true(i == 0 || fabs((double)frame.rgb[7] - pow((188 / 255.0 + 0.055) / 1.055, 2.4)) < 1e-4);
    }
    assert_ok(helio_source_next(source, &frame));
    assert_null(frame.rgb);
    helio_source_close(source);
}

/* Two frames of one pixel. */
static void animated_webp_is_named_where_it_cannot_be_decoded(void **state)
{
    static const unsigned char WEBP[] =
        "\x52\x49\x46\x46\x86\x00\x00\x00\x57\x45\x42\x50\x56\x50\x38\x58\x0a\x00\x00\x00\x02\x00\x00\x00"
        "\x00\x00\x00\x00\x00\x00\x41\x4e\x49\x4d\x06\x00\x00\x00\x00\x00\x00\x00\x00\x00\x41\x4e\x4d\x46"
        "\x28\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x64\x00\x00\x02\x56\x50\x38\x4c"
        "\x10\x00\x00\x00\x2f\x00\x00\x00\x00\x07\x50\xc0\xe8\x7f\xff\x03\x11\xd1\xff\x00\x41\x4e\x4d\x46"
        "\x2a\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x64\x00\x00\x00\x56\x50\x38\x4c"
        "\x11\x00\x00\x00\x2f\x00\x00\x00\x00\x07\x50\xc0\x22\xf7\xbf\xff\x81\x88\xe8\x7f\x00\x00";
    fixture *f = *state;
    join(f->path, f->directory, "moving.webp");
    save_bytes(f->path, WEBP, sizeof WEBP - 1);
    outcome result = read_all(f, f->path, NULL);
    if (result.frames > 0 || avcodec_find_decoder(AV_CODEC_ID_WEBP) == NULL) {
        print_message("skipped: the FFmpeg here can decode animated WebP, or no WebP at all\n");
        skip();
    }
    expect(&result, HELIO_ERR_UNSUPPORTED, "moving.webp is an animated WebP picture");
    assert_true(result.ended);
}

/* A playlist names a file that is there, and which must stay unread. */
static void files_cannot_lead_to_others(void **state)
{
    fixture *f = *state;
    char list[TEST_PATH_SIZE], text[2 * TEST_PATH_SIZE];
    join(f->path, f->directory, "inner.ts");
    join(list, f->directory, "list.mp4");
    video_clip made = plain_clip("mpegts", AV_CODEC_ID_MPEG2VIDEO);
    write_clip(f->path, &made);
    const char *const forms[] = {"#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n%s\n#EXT-X-ENDLIST\n",
                                 "ffconcat version 1.0\nfile '%s'\n"};
    for (int i = 0; i < 2; i++) {
        snprintf(text, sizeof text, i == 0 ? forms[0] : forms[1], f->path);
        save_bytes(list, (const unsigned char *)text, strlen(text));
        outcome result = read_all(f, list, NULL);
        assert_int_equal(result.status, HELIO_ERR_DATA);
        assert_int_equal(result.frames, 0);
    }
}

static void large_frames_are_refused(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "a.mkv");
    video_clip made = plain_clip("matroska", AV_CODEC_ID_FFV1);
    write_clip(f->path, &made);
    helio_video_read_desc desc = {.max_pixels = 64 * 48};
    outcome result = read_all(f, f->path, &desc);
    assert_int_equal(result.status, HELIO_OK);
    desc.max_pixels--;
    result = read_all(f, f->path, &desc);
    expect(&result, HELIO_ERR_DATA, "max_pixels");
}

/* ---- devices ---- */

static void test_patterns_come_from_lavfi(void **state)
{
    fixture *f = *state;
    const helio_video_read_desc desc = {.device = "lavfi"};
    helio_video_reader *reader;
    helio_video_frame frame;
    assert_ok(helio_video_open(f->context, "testsrc2=size=322x180:rate=30", &desc, &reader));
    helio_video_info info = helio_video_get_info(reader);
    assert_int_equal(info.width, 322);
    assert_int_equal(info.height, 180);
    assert_true(fabs(info.fps - 30) < 1e-6);
    assert_int_equal(info.frame_count, 0);
    for (int i = 0; i < 50; i++) {
        assert_ok(helio_video_next(reader, &frame));
        assert_non_null(frame.rgb);
        assert_true(fabs(frame.seconds - i / 30.0) < 1e-3);
    }
    helio_video_close(reader);
    outcome result = read_all(f, "testsrc2=size=32x32:duration=1:rate=10", &desc);
    assert_int_equal(result.status, HELIO_OK);
    assert_int_equal(result.frames, 10);
}

static void devices_that_are_not_there_are_named(void **state)
{
    fixture *f = *state;
    helio_video_read_desc desc = {.device = "v4l2"};
    outcome result = read_all(f, "/dev/video-that-is-missing", &desc);
    expect(&result, HELIO_ERR_IO, "/dev/video-that-is-missing");
    desc.device = "lavfi";
    result = read_all(f, "nosuchfilter", &desc);
    expect(&result, HELIO_ERR_IO, "nosuchfilter");
    desc.device = "periscope";
    result = read_all(f, "x", &desc);
    expect(&result, HELIO_ERR_UNSUPPORTED, "periscope");
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { RESIDENT_MEANS_LITTLE = 1 }; /* sanitizers keep what was given back */
#else
enum { RESIDENT_MEANS_LITTLE = 0 };
#endif

static size_t resident_pages(void)
{
    unsigned long total = 0, resident = 0;
    FILE *stream = fopen("/proc/self/statm", "r");
    if (stream != NULL) {
        assert_int_equal(fscanf(stream, "%lu %lu", &total, &resident), 2);
        fclose(stream);
    }
    return resident;
}

static void thousands_of_frames_take_no_more_memory(void **state)
{
    fixture *f = *state;
    const helio_video_read_desc desc = {.device = "lavfi"};
    helio_video_reader *reader;
    helio_video_frame frame;
    assert_ok(helio_video_open(f->context, "testsrc2=size=48x32", &desc, &reader));
    size_t pages = 0, taken = 0;
    for (int i = 0; i < 3000; i++) {
        if (i == 500) {
            pages = resident_pages();
            taken = atomic_load(&f->memory.taken);
        }
        assert_ok(helio_video_next(reader, &frame));
        assert_non_null(frame.rgb);
    }
    assert_int_equal(atomic_load(&f->memory.taken), taken);
    if (!RESIDENT_MEANS_LITTLE)
        assert_true(resident_pages() < pages + (2 << 20) / (size_t)sysconf(_SC_PAGESIZE));
    helio_video_close(reader);
}

/* ---- threads and log ---- */

static void *read_in_thread(void *f)
{
    fixture *own = f;
    outcome result = read_all(own, own->path, NULL);
    return result.status == HELIO_OK && result.frames == 12 ? f : NULL;
}

static void readers_do_not_disturb_each_other(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "a.mkv");
    video_clip made = plain_clip("matroska", AV_CODEC_ID_FFV1);
    write_clip(f->path, &made);
    pthread_t threads[3];
    for (int i = 0; i < 3; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, read_in_thread, f), 0);
    for (int i = 0; i < 3; i++) {
        void *good;
        pthread_join(threads[i], &good);
        assert_non_null(good);
    }
}

typedef struct heard {
    unsigned debug, others;
} heard;

static void hear(void *user, helio_log_level level, const char *message)
{
    heard *count = user;
    assert_null(strchr(message, '\n'));
    if (level == HELIO_LOG_DEBUG && strncmp(message, "FFmpeg: ", 8) == 0)
        count->debug++;
    else
        count->others++;
}

static void ffmpeg_speaks_at_debug_level_only(void **state)
{
    fixture *f = *state;
    join(f->path, f->directory, "a.mp4");
    static const unsigned char HEAD[] = "\0\0\0\x18"
                                        "ftypmp42\0\0\0\0mp42isom\0\0\0\x08"
                                        "free";
    save_bytes(f->path, HEAD, sizeof HEAD - 1);
    for (helio_log_level level = HELIO_LOG_ERROR; level <= HELIO_LOG_DEBUG; level++) {
        heard count = {0};
        const helio_context_desc desc = {.log_level = level, .log = hear, .user = &count, .threads = 1};
        fixture own = {0};
        assert_ok(helio_context_create(&desc, &own.context));
        outcome result = read_all(&own, f->path, NULL);
        expect(&result, HELIO_ERR_DATA, "moov atom not found");
        assert_true(count.others == 0 && (count.debug > 0) == (level == HELIO_LOG_DEBUG));
        helio_context_destroy(own.context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(whole_files_are_read_to_their_end, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sizes_may_change_midway, set_up, tear_down),
        cmocka_unit_test_setup_teardown(memory_stays_flat_and_refusals_are_sentences, set_up, tear_down),
        cmocka_unit_test_setup_teardown(cut_files_give_their_good_frames_and_a_sentence, set_up, tear_down),
        cmocka_unit_test_setup_teardown(reading_goes_on_behind_a_damaged_frame, set_up, tear_down),
        cmocka_unit_test_setup_teardown(damage_that_ffmpeg_patches_up_is_warned_of_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(flipped_bits_do_no_harm, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_no_video_is_refused_in_a_sentence, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sound_alone_is_no_video, set_up, tear_down),
        cmocka_unit_test_setup_teardown(animated_png_is_a_video, set_up, tear_down),
        cmocka_unit_test_setup_teardown(animated_webp_is_named_where_it_cannot_be_decoded, set_up, tear_down),
        cmocka_unit_test_setup_teardown(files_cannot_lead_to_others, set_up, tear_down),
        cmocka_unit_test_setup_teardown(large_frames_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_patterns_come_from_lavfi, set_up, tear_down),
        cmocka_unit_test_setup_teardown(thousands_of_frames_take_no_more_memory, set_up, tear_down),
        cmocka_unit_test_setup_teardown(devices_that_are_not_there_are_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(readers_do_not_disturb_each_other, set_up, tear_down),
        cmocka_unit_test_setup_teardown(ffmpeg_speaks_at_debug_level_only, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
