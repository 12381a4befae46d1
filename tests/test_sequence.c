/* SPDX-License-Identifier: MIT
 * render over sequences: numbered pictures, folders and videos out; what is missing, odd, interrupted and resumed. */
#include "program.h"

#include <heliostat/image.h>
#include <heliostat/video.h>

#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* Small pictures of a small thing: hundreds in a second. */
#define SMALL "render --mesh tetrahedron.obj --size 64x48 --env-size 8 --spp 16 "

/* A white object in even light cannot be told from what is behind it: all pixels have the map's radiance. */
#define FURNACE SMALL "--material diffuse:1 --strategy cosine "

/* ---- maps ---------------------------------------------------------------------------------- */

/* A map of 2 size x size pixels as PFM, all of this radiance; the first pixel may differ. */
static void write_map(const char *path, uint32_t size, float radiance, float first)
{
    char header[64];
    const uint16_t probe = 1;
    float rgb[6];
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    snprintf(header, sizeof header, "PF\n%u %u\n%s\n", 2 * size, size, *(const unsigned char *)&probe ? "-1.0" : "1.0");
    fputs(header, stream);
    for (uint32_t i = 0; i < size * size; i++) {
        for (int c = 0; c < 6; c++)
            rgb[c] = i == 0 && c < 3 ? first : radiance;
        assert_int_equal(fwrite(rgb, sizeof rgb, 1, stream), 1);
    }
    assert_int_equal(fclose(stream), 0);
}

static const char *number_name(const char *pattern, unsigned number)
{
    static char name[TEST_PATH_SIZE];
    const char *percent = strchr(pattern, '%');
    snprintf(name, sizeof name, "%.*s%04u%s", (int)(percent - pattern), pattern, number, percent + 4);
    return name;
}

/* Maps first ... last of radiance 1 + number. */
static void write_maps(unsigned first, unsigned last)
{
    for (unsigned i = first; i <= last; i++)
        write_map(number_name("in_%04d.pfm", i), 1, 1 + (float)i, 1 + (float)i);
}

/* ---- pictures ------------------------------------------------------------------------------ */

/* All pixels have this radiance. */
static void check_picture(const char *path, float expected, float tolerance)
{
    helio_context *context = make_context(1, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    assert_int_equal(image->width, 64);
    assert_int_equal(image->height, 48);
    for (size_t i = 0; i < (size_t)64 * 48 * 3; i++)
        if (!(fabsf(image->rgb[i] - expected) <= tolerance))
            fail_msg("%s: pixel %zu is %g, not %g", path, i / 3, (double)image->rgb[i], (double)expected);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

static double mean_of(const char *path)
{
    helio_context *context = make_context(1, NULL);
    helio_image *image;
    double sum = 0;
    assert_ok(helio_image_read(context, path, NULL, &image));
    size_t count = (size_t)image->width * image->height * 3;
    for (size_t i = 0; i < count; i++)
        sum += (double)image->rgb[i];
    helio_image_destroy(context, image);
    helio_context_destroy(context);
    return sum / (double)count;
}

static bool same_bytes(const char *path, const char *other_path)
{
    static char bytes[1 << 18], other_bytes[1 << 18];
    size_t length = read_text(path, bytes, sizeof bytes);
    return length > 0 && length == read_text(other_path, other_bytes, sizeof other_bytes) &&
           memcmp(bytes, other_bytes, length) == 0;
}

/* Lines on stderr that hold the word. */
static size_t count_lines(const char *word)
{
    size_t count = 0;
    for (const char *hit = strstr(program_err, word); hit != NULL; hit = strstr(hit + 1, word))
        count++;
    return count;
}

static void says(const char *word)
{
    if (strstr(program_err, word) == NULL && strstr(program_out, word) == NULL)
        fail_msg("no \"%s\" in: %s%s", word, program_err, program_out);
}

/* ---- where frames go ----------------------------------------------------------------------- */

static void test_frames_are_numbered_as_their_maps(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(3, 5);
    succeeds(FURNACE "--env in_%04d.pfm --out out_%04d.pfm");
    says("3 of 3 frames");
    assert_int_equal(count_files("."), 1 + 3 + 3);
    for (unsigned i = 3; i <= 5; i++)
        check_picture(number_name("out_%04d.pfm", i), 1 + (float)i, 1e-2F);
}

static void test_names_may_be_numbered_without_zeros(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(9, 10);
    succeeds(SMALL "--env in_%04d.pfm --out %d.pfm");
    assert_true(exists("9.pfm") && exists("10.pfm"));
}

static void test_glob_is_numbered_from_0_in_natural_order(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("m10.pfm", 1, 10, 10);
    write_map("m9.pfm", 1, 9, 9);
    succeeds(FURNACE "--env m*.pfm --out out_%04d.pfm");
    check_picture("out_0000.pfm", 9, 1e-2F);
    check_picture("out_0001.pfm", 10, 1e-2F);
}

static void test_folder_takes_numbered_pictures(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 1);
    assert_int_equal(mkdir("there", 0777), 0);
    succeeds(SMALL "--env in_%04d.pfm --out there");
    succeeds(SMALL "--env in_%04d.pfm --out made/");
    assert_int_equal(count_files("there"), 2);
    assert_int_equal(count_files("made"), 2);
    assert_true(same_bytes("there/heliostat_0001.png", "made/heliostat_0001.png"));
}

static void test_numbered_pictures_have_their_folder_made(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 1);
    succeeds(SMALL "--env in_%04d.pfm --out new/f_%04d.pfm --stats new/stats.json");
    assert_int_equal(count_files("new"), 3);
    succeeds(SMALL "--env in_%04d.pfm --out new/f_%04d.pfm");
    fails(SMALL "--env in_%04d.pfm --out no/new/f_%04d.pfm", 1, "no/new/f_%04d.pfm");
    assert_false(exists("no"));
    write_text("file", "");
    fails(SMALL "--env in_%04d.pfm --out file/f_%04d.pfm", 1, "file/f_0000.pfm");
    fails(SMALL "--env in_%04d.pfm --frames 1..7 --out file/f_%04d.pfm", 1, "file/f_0001.pfm");
}

static void test_folder_that_nothing_comes_into_is_not_left(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 1);
    fails(SMALL "--env in_%04d.pfm --mesh none.obj --out made/", 1, "none.obj");
    assert_false(exists("made"));
    fails(SMALL "--env in_%04d.pfm --mesh none.obj --out made/f_%04d.png", 1, "none.obj");
    assert_false(exists("made"));
    fails(SMALL "--env in_%04d.pfm --out made/f_%04d.png --stats no/stats.json", 1, "no/stats.json");
    assert_false(exists("made"));
    fails(SMALL "--env in_%04d.pfm --out no/made/", 1, "no/made");
    assert_false(exists("no"));
}

static void test_sequence_has_a_name_of_its_own(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(7, 8);
    succeeds(SMALL "--env in_%04d.pfm");
    assert_true(exists("heliostat_0007.png") && exists("heliostat_0008.png"));
}

static void test_one_picture_is_refused_for_many_frames(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 2);
    size_t before = count_files(".");
    fails(SMALL "--env in_%04d.pfm --out a.pfm", 2, "a_%04d.pfm");
    assert_non_null(strstr(program_err, "--frames N..N"));
    fails(SMALL "--env sky:day --out a.png", 2, "sky:day");
    fails(SMALL "--env in_%04d.pfm --frames 0..1 --out a.png", 2, "a_%04d.png");
    assert_int_equal(count_files("."), before);
    succeeds(FURNACE "--env in_%04d.pfm --frames 2..2 --out a.pfm");
    check_picture("a.pfm", 3, 1e-2F);
}

static void test_still_picture_may_be_numbered(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    succeeds(SMALL "--env constant:1,1,1 --out out_%04d.pfm");
    assert_true(exists("out_0000.pfm"));
    assert_int_equal(count_files("."), 2);
}

static void test_names_with_other_numbers_are_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    fails(SMALL "--env sky:day --out %04d_%04d.png", 2, "one number");
    fails(SMALL "--env sky:day --out %4d.png", 2, "one number");
    fails(SMALL "--env sky:day --out %0999d.png", 2, "one number");
    fails(SMALL "--env sky:day --out %s%d.png", 2, "one number");
    fails(SMALL "--env sky:day --out out_%04d.tiff", 2, "out_%04d.tiff");
    assert_int_equal(count_files("."), 1);
}

static void test_endings_of_pictures_and_videos_are_listed(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    fails(SMALL "--env sky:day --out x.gif", 2, ".png");
    fails(SMALL "--env sky:day --out x%d.gif", 2, ".png");
    assert_null(strstr(program_err, ".mp4"));
    const helio_video_write_desc desc = {.width = 64, .height = 48};
    if (helio_video_check_path("x.mkv", &desc) != HELIO_OK)
        return;
    fails(SMALL "--env sky:day --out x.gif", 2, ".mkv");
    fails(SMALL "--env sky:day --out x%04d.mkv", 2, "takes no number");
}

/* What is advised for one name must be a name that render takes. */
static void test_advice_for_a_name_with_a_percent_sign_is_sound(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    fails(SMALL "--env sky:day --out s/%s.png", 2, "as in s/frame_%04d.png,");
}

static void test_inputs_are_never_replaced(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 2);
    size_t before = count_files(".");
    fails(SMALL "--env in_%04d.pfm --out ./in_%04d.pfm", 1, "replace an input");
    fails(SMALL "--env *.pfm --out out_%04d.pfm", 2, "*.pfm");
    fails(SMALL "--env ./*.pfm --out ../work/out_%04d.pfm", 2, "*.pfm");
    assert_int_equal(count_files("."), before);
}

/* Maps as PNG, numbered as those of write_maps(). */
static void write_png_maps(void)
{
    succeeds(SMALL "--env in_%04d.pfm --out m%d.png");
}

static void test_no_output_replaces_a_map_of_the_sequence(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 2);
    write_png_maps();
    assert_int_equal(mkdir("q", 0777), 0);
    assert_int_equal(link("in_0002.pfm", "q/hard"), 0);
    assert_int_equal(symlink("../in_0002.pfm", "q/soft"), 0);
    size_t before = count_files(".");
    static const char *const lines[] = {
        SMALL "--env in_%04d.pfm --out out_%04d.pfm --stats in_0002.pfm",
        SMALL "--env in_%04d.pfm --frames 0..0 --out out_%04d.pfm --stats q/../in_0002.pfm",
        SMALL "--env in_*.pfm --out out_%04d.pfm --stats ./in_0002.pfm",
        SMALL "--env in_*.pfm --out out_%04d.pfm --stats q/hard",
        SMALL "--env in_*.pfm --out out_%04d.pfm --stats q/soft",
        SMALL "--env in_%04d.pfm --frames 0..0 --out in_0001.pfm",
        SMALL "--env in_%04d.pfm --frames 0..7 --on-missing skip --out out_%04d.pfm --stats in_0005.pfm",
        SMALL "--env m%d.png --out out_%04d.pfm --contact-sheet m1.png",
        "inspect in_%04d.pfm --frames 0..0 --json in_0002.pfm",
        "inspect m%d.png --frames 0..0 --json m2.png",
        "inspect in_*.pfm --json in_0001.pfm",
        "convert in_%04d.pfm --frames 0..0 --out in_0001.pfm",
        "convert m%d.png --frames 0..0 --out m1.png",
        "convert m*.png --frames 0..0 --out m1.png",
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++)
        fails(lines[i], 1, "replace an input");
    assert_int_equal(count_files("."), before);
    for (unsigned i = 0; i < 3; i++) {
        write_map("again.pfm", 1, 1 + (float)i, 1 + (float)i);
        assert_true(same_bytes("again.pfm", number_name("in_%04d.pfm", i)));
    }
}

/* a1.pfm is frame 1, and what frame 1 makes would be frame 11. */
static void test_frame_is_not_written_over_a_later_map(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("a1.pfm", 1, 1, 1);
    write_map("a11.pfm", 1, 2, 2);
    assert_int_equal(run_program(SMALL "--env a%d.pfm --on-missing skip --out a1%d.pfm"), 1);
    says("would replace an input");
    write_map("again.pfm", 1, 2, 2);
    assert_true(same_bytes("again.pfm", "a11.pfm"));
    /* The first name is nobody's, but the second one is. */
    write_map("b1.pfm", 1, 1, 1);
    write_map("b2.pfm", 1, 2, 2);
    assert_int_equal(run_program(SMALL "--env b[12].pfm --out b%d.pfm"), 1);
    says("b1.pfm would replace an input");
    assert_true(exists("b0.pfm") && same_bytes("again.pfm", "b2.pfm"));
}

static void test_six_faces_are_inputs_too(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds("convert constant:1 --to faces --env-size 8 --out six/");
    fails("inspect six --json six/ny.exr", 1, "replace an input");
    fails(SMALL "--env six --out out.pfm --stats six/px.exr", 1, "replace an input");
    fails(SMALL "--env six/%s.exr --out six/pz.exr", 1, "replace an input");
    fails("convert six --to faces --out six/./%s.exr", 1, "replace an input");
    succeeds(SMALL "--env six --out six/lit.pfm --stats six/lit.json");
    succeeds(SMALL "--env six --out six/lit.pfm --stats six/lit.json");
}

static void test_reports_are_no_frames_of_the_run(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 11);
    assert_int_equal(mkdir("sd", 0777), 0);
    size_t before = count_files(".");
    static const char *const lines[] = {
        "--out x_%d.png --contact-sheet x_1.png",
        "--out x_%d.png --contact-sheet ./x_11.png",
        "--out sd/ --stats sd/heliostat_0001.png",
        "--out sd/../x_%02d.png --stats x_07.png",
        "--contact-sheet heliostat_0003.png",
        "--frames 0..0 --out x.png --contact-sheet ./x.png",
        "--out x_%d.png --stats sd/../y.png --contact-sheet y.png",
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        char line[512];
        snprintf(line, sizeof line, SMALL "--env in_%%04d.pfm %s", lines[i]);
        fails(line, 2, "--");
    }
    assert_int_equal(count_files("."), before);
    assert_int_equal(count_files("sd"), 0);
    succeeds(SMALL "--env in_%04d.pfm --frames 1 --out x_%02d.png --stats x_1.png --contact-sheet x_001.png");
    assert_int_equal(count_files("."), before + 3);
}

/* ---- which frames -------------------------------------------------------------------------- */

static void test_range_takes_these_frames_only(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 9);
    succeeds(SMALL "--env in_%04d.pfm --frames 4..6 --out out_%04d.pfm");
    says("3 of 3 frames");
    assert_int_equal(count_files("."), 1 + 10 + 3);
    assert_true(exists("out_0004.pfm") && exists("out_0006.pfm"));
    static const char *const ranges[] = {"4..", "..6", "6..4", "4...6", "a..b", "-1..3", "0..4294967296"};
    for (size_t i = 0; i < sizeof ranges / sizeof ranges[0]; i++) {
        char line[128];
        snprintf(line, sizeof line, "render --frames=%s", ranges[i]);
        fails(line, 2, ranges[i]);
    }
}

static void test_one_number_takes_one_frame(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(6, 8);
    succeeds(FURNACE "--env in_%04d.pfm --frames 7 --out a.pfm");
    check_picture("a.pfm", 8, 1e-2F);
    fails(SMALL "--frames 7x", 2, "one number");
}

static void test_frame_that_is_missing_is_named(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 2);
    write_maps(4, 5);
    fails(SMALL "--env in_%04d.pfm --frames 3..3 --out a.pfm", 1, "there is no in_0003.pfm");
    fails(SMALL "--env in_%04d.pfm --frames 9 --out a.pfm", 1, "there is no in_0009.pfm");
}

static void test_missing_frames_stop_by_default_and_keep_the_rest(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 1);
    write_maps(3, 3);
    fails(SMALL "--env in_%04d.pfm --out out_%04d.pfm --stats a.json -q", 1, "in_0002.pfm");
    says("2 of 4 frames written to out_%04d.pfm");
    assert_true(exists("out_0001.pfm") && !exists("out_0003.pfm"));
    json_t *stats = load_json("a.json");
    assert_int_equal(json_array_size(json_object_get(stats, "frames")), 2);
    assert_non_null(strstr(text_of(json_object_get(stats, "summary"), "error"), "in_0002.pfm"));
    json_decref(stats);
}

static void test_missing_frames_may_be_skipped(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 1);
    write_maps(4, 4);
    write_text("in_0003.pfm", "PF\nrubbish");
    succeeds(FURNACE "--env in_%04d.pfm --on-missing skip --out out_%04d.pfm");
    says("in_0002.pfm");
    says("in_0003.pfm");
    assert_true(!exists("out_0002.pfm") && !exists("out_0003.pfm"));
    check_picture("out_0004.pfm", 5, 1e-2F);
}

static void test_missing_frames_may_hold_the_last_one(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 1);
    write_maps(4, 4);
    succeeds(FURNACE "--env in_%04d.pfm --on-missing hold --out out_%04d.pfm");
    check_picture("out_0002.pfm", 2, 1e-2F);
    check_picture("out_0003.pfm", 2, 1e-2F);
    check_picture("out_0004.pfm", 5, 1e-2F);
}

static void test_many_unreadable_frames_are_told_in_few_lines(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 0);
    for (unsigned i = 1; i < 60; i++)
        write_text(number_name("in_%04d.pfm", i), "PF\nrubbish");
    write_maps(60, 60);
    succeeds(SMALL "--env in_%04d.pfm --on-missing skip --out out_%04d.pfm");
    assert_true(count_lines("\n") <= 10);
    says("not shown");
}

static void test_source_without_frames_is_a_failure(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    fails(SMALL "--env in_%04d.pfm --out out_%04d.png", 1, "in_");
    write_text("in_0000.pfm", "rubbish");
    assert_int_equal(run_program(SMALL "--env in_%04d.pfm --on-missing skip --out out_%04d.png --stats a.json"), 1);
    says("in_%04d.pfm");
    assert_int_equal(count_files("."), 2);
}

/* ---- odd frames ---------------------------------------------------------------------------- */

static void test_bad_texels_name_their_frames_in_few_lines(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    for (unsigned i = 0; i < 8; i++)
        write_map(number_name("in_%04d.pfm", i), 2, 1, NAN);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm --stats a.json");
    says("in_0000.pfm has 1 bad pixel: 1 NaN (taken as black)\n");
    says("8 frames in all have bad pixels, 8");
    assert_true(count_lines("\n") <= 5);
    json_t *stats = load_json("a.json");
    const json_t *frames = json_object_get(stats, "frames");
    assert_int_equal(json_array_size(frames), 8);
    for (size_t i = 0; i < 8; i++)
        assert_true(number_of(json_object_get(json_array_get(frames, i), "bad_texels"), "nan") == 1);
    json_decref(stats);
}

static void test_colours_out_of_gamut_are_not_called_bad(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    /* The green of BT.2020. */
    static const char header[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n"
                                 "PRIMARIES=.708 .292 .170 .797 .131 .046 .3127 .3290\n\n-Y 2 +X 4\n";
    static const unsigned char green[4] = {0, 128, 0, 129};
    unsigned char bytes[sizeof header - 1 + 8 * sizeof green];
    memcpy(bytes, header, sizeof header - 1);
    for (size_t i = 0; i < 8; i++)
        memcpy(bytes + sizeof header - 1 + 4 * i, green, sizeof green);
    write_bytes("in_0.hdr", bytes, sizeof bytes);
    succeeds(SMALL "--env in_%d.hdr --out out_%04d.pfm");
    says("in_0.hdr: 8 pixels were outside of Rec. 709 and lost their negative channels\n");
    assert_null(strstr(program_err, "bad"));
}

static void test_size_may_change_and_is_told(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    for (unsigned i = 0; i < 3; i++)
        write_map(number_name("in_%04d.pfm", i), i == 1 ? 8 : 2, 1 + (float)i, 1 + (float)i);
    succeeds(FURNACE "--env in_%04d.pfm --out out_%04d.pfm");
    says("in_0001.pfm is 16x8 pixels");
    says("in_0002.pfm is 4x2 pixels");
    for (unsigned i = 0; i < 3; i++)
        check_picture(number_name("out_%04d.pfm", i), 1 + (float)i, 1e-2F);
}

/* ---- exposure and seeds -------------------------------------------------------------------- */

/* The first frame decides: twice the light looks twice as bright, and not the same. */
static void test_sequence_keeps_the_exposure_of_its_first_frame(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_map("in_0000.pfm", 1, 8, 8);
    write_map("in_0001.pfm", 1, 4, 4);
    succeeds(FURNACE "--env in_%04d.pfm --out out_%04d.png");
    check_picture("out_0000.png", 0.8F, 1e-2F);
    check_picture("out_0001.png", 0.4F, 1e-2F);
}

static void test_seed_mode(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    for (unsigned i = 0; i < 3; i++)
        write_map(number_name("in_%04d.pfm", i), 4, 1, 50);
    succeeds(SMALL "--env in_%04d.pfm --out a_%04d.pfm");
    assert_true(same_bytes("a_0000.pfm", "a_0001.pfm"));
    succeeds(SMALL "--env in_%04d.pfm --seed-mode frame --out b_%04d.pfm");
    assert_false(same_bytes("b_0000.pfm", "b_0001.pfm"));
    assert_false(same_bytes("b_0001.pfm", "b_0002.pfm"));
    /* By its number, so that a part of the sequence is as in the whole. */
    succeeds(SMALL "--env in_%04d.pfm --seed-mode frame --frames 2..2 --out c_%04d.pfm");
    assert_true(same_bytes("b_0002.pfm", "c_0002.pfm"));
}

/* ---- stats --------------------------------------------------------------------------------- */

static void test_stats_have_an_entry_for_each_frame(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(5, 7);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm --stats a.json");
    json_t *stats = load_json("a.json");
    const json_t *frames = json_object_get(stats, "frames"), *summary = json_object_get(stats, "summary");
    double seconds = 0;
    assert_int_equal(json_array_size(frames), 3);
    for (size_t i = 0; i < 3; i++) {
        const json_t *frame = json_array_get(frames, i);
        assert_true(number_of(frame, "index") == 5 + (double)i);
        assert_true(fabs(number_of(frame, "flux") / (4 * 3.14159265358979 * (6 + (double)i)) - 1) < 1e-4);
        assert_true(number_of(frame, "read_ms") >= 0 && number_of(frame, "samples") > 0);
        seconds += number_of(frame, "total_ms") / 1e3;
    }
    assert_true(number_of(summary, "frames") == 3);
    assert_true(number_of(summary, "skipped") == 0);
    assert_true(fabs(number_of(summary, "fps") * seconds / 3 - 1) < 1e-3);
    assert_null(json_object_get(summary, "error"));
    json_decref(stats);
}

/* ---- stopped and resumed ------------------------------------------------------------------- */

enum { LONG_SEQUENCE = 16 };

/* Frames of some hundredths of a second. */
#define LONG_RUN                                                                                                       \
    "render --env in_%04d.pfm --mesh tetrahedron.obj --size 160x120 --env-size 16 --spp 64 --seed-mode frame "

static void write_long_sequence(void)
{
    for (unsigned i = 0; i < LONG_SEQUENCE; i++)
        write_map(number_name("in_%04d.pfm", i), 4, 1, 20 + (float)i);
}

static void wait_for(const char *path)
{
    for (int i = 0; i < 6000 && !exists(path); i++)
        usleep(5000);
}

static unsigned count_numbered(const char *pattern)
{
    unsigned count = 0;
    while (exists(number_name(pattern, count)))
        count++;
    return count;
}

static void test_interrupt_keeps_the_frames(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_long_sequence();
    pid_t child = start_program(LONG_RUN "--out out_%04d.png --stats a.json");
    wait_for("out_0002.png");
    kill(child, SIGINT);
    assert_int_equal(finish_program(child, NULL), 130);
    unsigned count = count_numbered("out_%04d.png");
    char sentence[64];
    snprintf(sentence, sizeof sentence, "stopped; %u of %d frames written to out_", count, LONG_SEQUENCE);
    says(sentence);
    assert_true(count >= 3 && count < LONG_SEQUENCE);
    assert_int_equal(count_files("."), 1 + LONG_SEQUENCE + count + 1);
    for (unsigned i = 0; i < count; i++)
        assert_true(mean_of(number_name("out_%04d.png", i)) > 0);
    json_t *stats = load_json("a.json");
    assert_int_equal(json_array_size(json_object_get(stats, "frames")), count);
    assert_string_equal(text_of(json_object_get(stats, "summary"), "error"), "stopped");
    json_decref(stats);
}

/* Killed amid the sequence, one frame damaged afterwards, then resumed: as if nothing had been. */
static void check_resume(const char *extension)
{
    char line[512], pattern[32], out[32], first[TEST_PATH_SIZE];
    snprintf(pattern, sizeof pattern, "out_%%04d.%s", extension);
    snprintf(out, sizeof out, "whole_%%04d.%s", extension);
    snprintf(line, sizeof line, "%s--out %s", LONG_RUN, pattern);
    pid_t child = start_program(line);
    wait_for(number_name(pattern, 3));
    kill(child, SIGKILL);
    assert_int_equal(finish_program(child, NULL), -SIGKILL);
    unsigned count = count_numbered(pattern);
    assert_true(count >= 4 && count < LONG_SEQUENCE);
    assert_int_equal(truncate(number_name(pattern, 1), 1000), 0);

    snprintf(line, sizeof line, "%s--resume --stats resumed.json --out %s", LONG_RUN, pattern);
    succeeds(line);
    json_t *stats = load_json("resumed.json");
    assert_true(number_of(json_object_get(stats, "summary"), "skipped") == count - 1);
    assert_int_equal(json_array_size(json_object_get(stats, "frames")), LONG_SEQUENCE - count + 1);
    json_decref(stats);
    snprintf(line, sizeof line, "%s--out %s", LONG_RUN, out);
    succeeds(line);
    for (unsigned i = 0; i < LONG_SEQUENCE; i++) {
        snprintf(first, sizeof first, "%s", number_name(pattern, i));
        if (!same_bytes(first, number_name(out, i)))
            fail_msg("%s is not as in the run that was not killed", first);
    }
}

static void test_resumed_png_are_as_if_never_killed(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_long_sequence();
    check_resume("png");
}

static void test_resumed_exr_are_as_if_never_killed(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    write_long_sequence();
    check_resume("exr");
}

static void test_resume_of_all_frames_makes_none(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 2);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm --contact-sheet first.png");
    struct stat before, after;
    assert_int_equal(stat("out_0001.pfm", &before), 0);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm --resume --contact-sheet second.png");
    says("3 of 3 frames, 64x48, all of an earlier run");
    assert_int_equal(stat("out_0001.pfm", &after), 0);
    assert_true(before.st_ino == after.st_ino);
    assert_true(same_bytes("first.png", "second.png"));
}

static void test_resume_with_another_size_is_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 2);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.png");
    fails(SMALL "--env in_%04d.pfm --out out_%04d.png --size 32x24 --resume -q", 1, "out_0000.png");
    assert_non_null(strstr(program_err, "--resume"));
}

/* What a full disk does, by a limit on the size of files. */
static void test_full_disk_ends_a_sequence(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 2);
    program_limits.file_size = 1000;
    fails(SMALL "--env in_%04d.pfm --out out_%04d.pfm -q", 1, "out_0000.pfm");
    assert_int_equal(count_files("."), 1 + 3);
    /* A small picture fits, a large one does not. */
    program_limits.file_size = 40000;
    succeeds(SMALL "--env in_%04d.pfm --frames 0..1 --out out_%04d.pfm");
    fails(SMALL "--env in_%04d.pfm --out out_%04d.pfm --size 128x96 --frames 2..2", 1, "out_0002.pfm");
    assert_int_equal(count_files("."), 1 + 3 + 2);
}

static void test_full_disk_for_a_contact_sheet_leaves_the_frames(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 7);
    program_limits.file_size = 600;
    fails(SMALL "--size 8x6 --env in_%04d.pfm --out out_%04d.pfm --contact-sheet sheet.png -q", 1,
          "sheet.png cannot be written: File too large; 8 of 8 frames written to out_%04d.pfm");
    fails(SMALL "--size 128x96 --env in_%04d.pfm --frames 0 --out a.png", 1, "a.png cannot be written: File too large");
    assert_int_equal(count_files("."), 1 + 8 + 8);
}

/* ---- video --------------------------------------------------------------------------------- */

static void skip_without_video(const char *path)
{
    const helio_video_write_desc desc = {.width = 64, .height = 48};
    if (helio_video_check_path(path, &desc) == HELIO_OK)
        return;
    print_message("skipped: %s\n", helio_last_error());
    skip();
}

/* Counts the frames; every pixel of frame n has radiance[n], unless that is NULL. */
static unsigned check_video(const char *path, double fps, const float *radiance)
{
    helio_context *context = make_context(1, NULL);
    helio_video_reader *reader;
    helio_video_frame frame;
    const helio_video_read_desc desc = {.transfer = HELIO_TRANSFER_SRGB};
    unsigned count = 0;
    assert_ok(helio_video_open(context, path, &desc, &reader));
    assert_true(fabs(helio_video_get_info(reader).fps - fps) < 1e-3);
    assert_ok(helio_video_next(reader, &frame));
    for (; frame.rgb != NULL; count++) {
        assert_true(frame.width == 64 && frame.height == 48);
        for (size_t i = 0; radiance != NULL && i < (size_t)64 * 48 * 3; i++)
            assert_true(fabsf(frame.rgb[i] - radiance[count]) < 0.03F);
        assert_ok(helio_video_next(reader, &frame));
    }
    helio_video_close(reader);
    helio_context_destroy(context);
    return count;
}

static void test_video_holds_all_frames(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    static const float radiance[] = {0.8F, 0.4F, 0.2F, 0.1F};
    for (unsigned i = 0; i < 4; i++)
        write_map(number_name("in_%04d.pfm", i), 1, radiance[i], radiance[i]);
    succeeds(FURNACE "--env in_%04d.pfm --out a.mkv --fps 12");
    says("a.mkv: 4 of 4 frames");
    assert_int_equal(check_video("a.mkv", 12, radiance), 4);
    assert_int_equal(count_files("."), 1 + 4 + 1);
}

static void test_video_that_ends_early_is_finished(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    write_maps(0, 2);
    write_maps(4, 4);
    fails(SMALL "--env in_%04d.pfm --out a.mkv -q", 1, "in_0003.pfm");
    says("3 of 5 frames written to a.mkv");
    assert_int_equal(check_video("a.mkv", 24, NULL), 3);
}

static void test_video_is_finished_when_interrupted(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    write_long_sequence();
    pid_t child = start_program(LONG_RUN "--size 64x48 --spp 4096 -v --out a.mkv");
    assert_true(program_says("frame 3:"));
    kill(child, SIGTERM);
    assert_int_equal(finish_program(child, NULL), 143);
    unsigned count = check_video("a.mkv", 24, NULL);
    char sentence[64];
    snprintf(sentence, sizeof sentence, "stopped; %u of %d frames written to a.mkv", count, LONG_SEQUENCE);
    says(sentence);
    assert_true(count >= 3 && count < LONG_SEQUENCE);
    assert_int_equal(count_files("."), 1 + LONG_SEQUENCE + 1);
}

static void test_full_disk_leaves_no_half_video(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    write_long_sequence();
    write_text("a.mkv", "old");
    program_limits.file_size = 6000;
    fails(SMALL "--env in_%04d.pfm --codec ffv1 --out a.mkv -q", 1,
          "a.mkv cannot be written: File too large; nothing is kept");
    assert_null(strstr(program_err, "written to"));
    char text[8];
    assert_int_equal(read_text("a.mkv", text, sizeof text), 3);
    assert_int_equal(count_files("."), 1 + LONG_SEQUENCE + 1);
}

static void test_video_cannot_be_resumed_and_says_so(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    write_maps(0, 1);
    succeeds(SMALL "--env in_%04d.pfm --out a.mkv --resume");
    says("cannot be resumed");
    assert_int_equal(check_video("a.mkv", 24, NULL), 2);
}

static void test_missing_frames_concern_videos_too(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    write_maps(0, 2);
    succeeds(FURNACE "--size 64x32 --env in_%04d.pfm --codec ffv1 --out a.mkv");
    assert_int_equal(rename("a.mkv", "a"), 0);
    succeeds(SMALL "--env a --on-missing skip --out out_%04d.pfm -q");
    assert_string_equal(program_err, "");
}

static void test_video_lights_the_scene(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    skip_without_video("a.mkv");
    write_maps(0, 2);
    succeeds(FURNACE "--size 64x32 --env in_%04d.pfm --exposure -3 --codec ffv1 --out a.mkv --fps 7");
    succeeds(FURNACE "--env a.mkv --transfer srgb --out out_%04d.pfm");
    for (unsigned i = 0; i < 3; i++)
        check_picture(number_name("out_%04d.pfm", i), (1 + (float)i) / 8, 2e-2F);
    assert_int_equal(count_numbered("out_%04d.pfm"), 3);
}

/* ---- contact sheet ------------------------------------------------------------------------- */

static void check_sheet(const char *path, uint32_t columns, uint32_t rows)
{
    helio_context *context = make_context(1, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    assert_true(image->width > columns * 64 && image->width < columns * 64 * 3);
    assert_true(image->height > rows * 48 && image->height < rows * 48 * 3);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

static void test_contact_sheet_shows_a_dozen_frames(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 29);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm --contact-sheet sheet.png");
    check_sheet("sheet.png", 4, 3);
    succeeds(SMALL "--env in_%04d.pfm --frames 0..4 --out out_%04d.pfm --contact-sheet sheet.png");
    check_sheet("sheet.png", 4, 2);
    succeeds(SMALL "--env in_%04d.pfm --frames 3..3 --out out_%04d.pfm --contact-sheet sheet.png");
    check_sheet("sheet.png", 1, 1);
    fails(SMALL "--env in_%04d.pfm --contact-sheet sheet.jpg", 2, ".png");
}

/* A device may never say how many frames will come. */
static void test_contact_sheet_of_a_sequence_of_unknown_length(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    skip_without_video("a.mkv");
    succeeds(SMALL "--env lavfi:testsrc2=size=32x16:rate=25:duration=1 --out out_%04d.pfm --contact-sheet sheet.png");
    says("25 frames");
    check_sheet("sheet.png", 4, 2); /* of 0, 4, 8 ... 24 */
}

/* ---- skies --------------------------------------------------------------------------------- */

static void test_sky_is_one_picture(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    succeeds(SMALL "--env sky:lat=44.8,lon=-0.6,date=2026-06-21,time=12:00,turbidity=3,albedo=0.2");
    assert_true(mean_of("heliostat.png") > 0.05);
    assert_int_equal(count_files("."), 2);
}

static void test_day_goes_from_sunrise_to_sunset(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    succeeds(SMALL "--env sky:day --day-frames 5 --out out_%04d.pfm");
    assert_int_equal(count_files("."), 1 + 5);
    double morning = mean_of("out_0000.pfm"), noon = mean_of("out_0002.pfm"), evening = mean_of("out_0004.pfm");
    assert_true(morning > 0 && evening > 0 && noon > 4 * morning && noon > 4 * evening);
}

static void test_day_is_what_lights_without_options(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    succeeds(SMALL "--day-frames 3");
    assert_true(exists("heliostat_0000.png") && exists("heliostat_0002.png"));
    assert_int_equal(count_files("."), 1 + 3);
}

static void test_quiet_sequence_says_nothing(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_maps(0, 2);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm --contact-sheet sheet.png -q");
    assert_string_equal(program_out, "");
    assert_string_equal(program_err, "");
}

/* As a log should tell of a run that may be long. */
static void test_sequence_says_what_it_begins(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 2);
    succeeds(SMALL "--env in_%04d.pfm --out out_%04d.pfm");
    assert_string_equal(program_err, "heliostat: 3 frames of 64x48 to out_%04d.pfm\n");
    succeeds(SMALL "--env in_%04d.pfm --frames 1 --out out_%04d.pfm");
    assert_string_equal(program_err, "");
    succeeds(SMALL "--env constant:1,1,1 --out out.pfm");
    assert_string_equal(program_err, "");
}

/* What the program writes to stderr where that is a terminal. */
static void run_on_terminal(const char *const *words, unsigned columns, char *text, size_t size)
{
    int master = posix_openpt(O_RDWR | O_NOCTTY), status;
    assert_true(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
    int terminal = open(ptsname(master), O_RDWR | O_NOCTTY);
    assert_true(terminal >= 0);
    const struct winsize shape = {.ws_row = 24, .ws_col = (unsigned short)columns};
    assert_int_equal(ioctl(terminal, TIOCSWINSZ, &shape), 0);
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        dup2(open("/dev/null", O_RDWR), STDOUT_FILENO);
        dup2(terminal, STDERR_FILENO);
        execv(words[0], (char *const *)words);
        _exit(99);
    }
    close(terminal);
    size_t length = 0;
    for (ssize_t count; length < size - 1 && (count = read(master, text + length, size - 1 - length)) > 0;)
        length += (size_t)count;
    text[length] = 0;
    close(master);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

/* Frames that take a tenth of a second and more, so that there is something to show, but one core alone. */
#define ON_SHOW LONG_RUN "--threads 1 --frames 2..5 --size 320x240 --out out_%04d.pfm "

static void test_progress_shows_frames_on_a_terminal_alone(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_long_sequence();
    static char text[1 << 16];
    const char *words[32] = {getenv("HELIOSTAT_PROGRAM")};
    char line[] = ON_SHOW "-q";
    size_t count = 1;
    for (char *word = strtok(line, " "); word != NULL; word = strtok(NULL, " "))
        words[count++] = word;
    run_on_terminal(words, 80, text, sizeof text);
    assert_string_equal(text, "");
    words[count - 1] = NULL; /* without -q */
    run_on_terminal(words, 80, text, sizeof text);
    assert_non_null(strstr(text, " of 4 ["));
    assert_non_null(strstr(text, "frames/s, "));
    assert_non_null(strstr(text, " left"));
    assert_null(strchr(text, '\n'));
    succeeds(LONG_RUN "--frames 2..4 --out out_%04d.pfm");
    assert_null(strchr(program_err, '\r'));
}

/* Length of the longest line that is drawn over others. */
static size_t longest_line(const char *text)
{
    size_t longest = 0;
    for (; *text != 0; text += strspn(text, "\r")) {
        size_t length = strcspn(text, "\r");
        longest = length > longest ? length : longest;
        text += length;
    }
    return longest;
}

static void test_progress_never_wraps(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_long_sequence();
    static char text[1 << 16];
    static const struct {
        const char *line;
        unsigned columns;
        bool has_bar; /* looked at where there is surely room for one, or none */
    } runs[] = {{ON_SHOW, 12, false},
                {ON_SHOW, 72, true},
                {LONG_RUN "--threads 1 --frames 2 --size 320x240 --spp 256 --out out.pfm", 40, true},
                {ON_SHOW, 40, false},
                {ON_SHOW, 200, true}};
    for (size_t i = 0; i < (is_thorough() ? 5 : 3); i++) {
        char line[256];
        const char *words[32] = {getenv("HELIOSTAT_PROGRAM")};
        size_t count = 1;
        snprintf(line, sizeof line, "%s", runs[i].line);
        for (char *word = strtok(line, " "); word != NULL; word = strtok(NULL, " "))
            words[count++] = word;
        run_on_terminal(words, runs[i].columns, text, sizeof text);
        assert_true(longest_line(text) > 6 && longest_line(text) < runs[i].columns);
        assert_true(runs[i].columns == 40 || (strchr(text, '[') != NULL) == runs[i].has_bar);
    }
}

static void test_idle_options_of_sequences_are_told(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_maps(0, 0);
    static const char *const options[] = {"--day-frames 7", "--transfer pq", "--on-missing hold", "--codec ffv1",
                                          "--quality 0.5",  "--hdr",         "--resume"};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++) {
        char line[512], name[32];
        snprintf(line, sizeof line, SMALL "--env constant:1,1,1 --out a.pfm %s", options[i]);
        snprintf(name, sizeof name, "%.*s", (int)strcspn(options[i], " "), options[i]);
        succeeds(line);
        says("warning: ");
        says(name);
    }
}

/* A pattern as the first argument picks tests. */
int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        program_test(test_frames_are_numbered_as_their_maps),
        program_test(test_names_may_be_numbered_without_zeros),
        program_test(test_glob_is_numbered_from_0_in_natural_order),
        program_test(test_folder_takes_numbered_pictures),
        program_test(test_numbered_pictures_have_their_folder_made),
        program_test(test_folder_that_nothing_comes_into_is_not_left),
        program_test(test_sequence_has_a_name_of_its_own),
        program_test(test_one_picture_is_refused_for_many_frames),
        program_test(test_still_picture_may_be_numbered),
        program_test(test_names_with_other_numbers_are_refused),
        program_test(test_endings_of_pictures_and_videos_are_listed),
        program_test(test_advice_for_a_name_with_a_percent_sign_is_sound),
        program_test(test_inputs_are_never_replaced),
        program_test(test_no_output_replaces_a_map_of_the_sequence),
        program_test(test_frame_is_not_written_over_a_later_map),
        program_test(test_six_faces_are_inputs_too),
        program_test(test_reports_are_no_frames_of_the_run),
        program_test(test_range_takes_these_frames_only),
        program_test(test_one_number_takes_one_frame),
        program_test(test_frame_that_is_missing_is_named),
        program_test(test_missing_frames_stop_by_default_and_keep_the_rest),
        program_test(test_missing_frames_may_be_skipped),
        program_test(test_missing_frames_may_hold_the_last_one),
        program_test(test_many_unreadable_frames_are_told_in_few_lines),
        program_test(test_source_without_frames_is_a_failure),
        program_test(test_bad_texels_name_their_frames_in_few_lines),
        program_test(test_colours_out_of_gamut_are_not_called_bad),
        program_test(test_size_may_change_and_is_told),
        program_test(test_sequence_keeps_the_exposure_of_its_first_frame),
        program_test(test_seed_mode),
        program_test(test_stats_have_an_entry_for_each_frame),
        program_test(test_interrupt_keeps_the_frames),
        program_test(test_resumed_png_are_as_if_never_killed),
        program_test(test_resumed_exr_are_as_if_never_killed),
        program_test(test_resume_of_all_frames_makes_none),
        program_test(test_resume_with_another_size_is_refused),
        program_test(test_full_disk_ends_a_sequence),
        program_test(test_full_disk_for_a_contact_sheet_leaves_the_frames),
        program_test(test_full_disk_leaves_no_half_video),
        program_test(test_video_holds_all_frames),
        program_test(test_video_that_ends_early_is_finished),
        program_test(test_video_is_finished_when_interrupted),
        program_test(test_video_cannot_be_resumed_and_says_so),
        program_test(test_missing_frames_concern_videos_too),
        program_test(test_video_lights_the_scene),
        program_test(test_contact_sheet_shows_a_dozen_frames),
        program_test(test_contact_sheet_of_a_sequence_of_unknown_length),
        program_test(test_sky_is_one_picture),
        program_test(test_day_goes_from_sunrise_to_sunset),
        program_test(test_day_is_what_lights_without_options),
        program_test(test_quiet_sequence_says_nothing),
        program_test(test_sequence_says_what_it_begins),
        program_test(test_progress_shows_frames_on_a_terminal_alone),
        program_test(test_progress_never_wraps),
        program_test(test_idle_options_of_sequences_are_told),
    };
    if (count > 1)
        cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, set_up_program, tear_down_program);
}
