/* SPDX-License-Identifier: MIT
 * Environment maps written to files: each format against its own limits, six faces, failures. */
#include "support.h"

#include <heliostat/image.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[TEST_PATH_SIZE];

static int set_up(void **state)
{
    (void)state;
    make_directory(folder);
    return chdir(folder);
}

static int tear_down(void **state)
{
    (void)state;
    if (chdir("/") != 0)
        return -1;
    remove_directory(folder);
    return 0;
}

static float *make_pixels(uint32_t width, uint32_t height)
{
    float *rgb = malloc((size_t)width * height * 3 * sizeof *rgb);
    assert_non_null(rgb);
    return rgb;
}

/* Of many magnitudes, with runs of equal pixels as in real maps. */
static void fill_with_noise(float *rgb, size_t pixels, uint64_t seed)
{
    for (size_t i = 0; i < pixels; i++) {
        bool repeats = i > 0 && random_bits(&seed) % 3 != 0;
        float scale = exp2f((float)(random_bits(&seed) % 40) - 20);
        for (size_t c = 0; c < 3; c++)
            rgb[3 * i + c] = repeats ? rgb[3 * (i - 1) + c] : (float)random_unit(&seed) * scale;
    }
}

static helio_image *read_back(helio_context *context, const char *path, uint32_t width, uint32_t height)
{
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    return image;
}

static float greatest(const float rgb[3])
{
    return fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
}

/* Writes the map, reads it again, and fails unless each channel is within a part of its pixel's greatest channel. */
static void check_copy(const char *path, const helio_map *map, const helio_map_write_desc *desc, float part)
{
    helio_context *context = make_context(1, NULL);
    assert_ok(helio_map_write(context, path, map, desc));
    helio_image *image = read_back(context, path, map->width, map->height);
    size_t pixels = (size_t)map->width * map->height;
    for (size_t i = 0; i < 3 * pixels; i++) {
        float bound = part * greatest(map->rgb + i / 3 * 3);
        if (fabsf(image->rgb[i] - map->rgb[i]) > bound)
            fail_msg("%s: %g became %g at number %zu of %ux%u", path, (double)map->rgb[i], (double)image->rgb[i], i,
                     map->width, map->height);
    }
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

/* ---- Radiance ---------------------------------------------------------------------------- */

/* A mantissa has 8 bits and readers add half a step: at most 1/256 of the greatest channel, whose mantissa is 128 or
 * more. */
static const float RGBE_PART = 1.0f / 256;

static void radiance_keeps_noise_and_runs_of_any_width(void **state)
{
    (void)state;
    static const uint32_t widths[] = {1, 2, 7, 8, 9, 127, 128, 129, 255, 1000};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
        float *rgb = make_pixels(widths[i], 5);
        fill_with_noise(rgb, 5 * (size_t)widths[i], i);
        const helio_map map = {.width = widths[i], .height = 5, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
        check_copy("noise.hdr", &map, NULL, RGBE_PART);
        free(rgb);
    }
}

/* Longer lines than 32767 pixels have no run-length coding. */
static void radiance_writes_lines_that_are_too_long_for_its_coding(void **state)
{
    (void)state;
    static const uint32_t widths[] = {32767, 32768, 65536};
    for (size_t i = 0; i < sizeof widths / sizeof *widths; i++) {
        float *rgb = make_pixels(widths[i], 2);
        fill_with_noise(rgb, 2 * (size_t)widths[i], i);
        const helio_map map = {.width = widths[i], .height = 2, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
        check_copy("long.hdr", &map, NULL, RGBE_PART);
        free(rgb);
    }
}

static size_t size_of(const char *path)
{
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    return (size_t)status.st_size;
}

static void radiance_codes_runs(void **state)
{
    (void)state;
    float *rgb = make_pixels(1024, 512);
    for (size_t i = 0; i < 3 * 1024 * 512; i++)
        rgb[i] = 0.5f;
    const helio_map map = {.width = 1024, .height = 512, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    check_copy("even.hdr", &map, NULL, RGBE_PART);
    /* 9 runs of at most 127 for each of four components, two bytes each, and four bytes of mark. */
    assert_in_range(size_of("even.hdr"), 512 * (4 + 4 * 9 * 2), 512 * (4 + 4 * 9 * 2) + 200);
    free(rgb);
}

static void radiance_holds_its_extremes(void **state)
{
    (void)state;
    const float limit = ldexpf(255.5f, 119);   /* mantissa 255, exponent 255 */
    const float rgb[] = {NAN,      -1,      2, /* NaN and negative: 0 */
                         0,        0,       0, /* exactly 0 */
                         1e-39f,   0,       0, /* less than the format has */
                         INFINITY, 1,       1, /* its greatest */
                         3.4e38f,  3.4e38f, 0, /* beyond 2^127 */
                         1,        0.5f,    0.25f, 8e-39f, 0, 0, 1e30f, 1, 1};
    const helio_map map = {.width = 8, .height = 1, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    helio_context *context = make_context(1, NULL);
    assert_ok(helio_map_write(context, "limits.hdr", &map, NULL));
    helio_image *image = read_back(context, "limits.hdr", 8, 1);
    const float *read = image->rgb;
    assert_true(read[0] < 0.01f && read[1] < 0.01f && fabsf(read[2] - 2) < 0.02f);
    assert_true(read[3] == 0 && read[4] == 0 && read[5] == 0);
    assert_true(read[6] == 0);
    assert_true(read[9] == limit && read[10] > 0);
    assert_true(read[12] == limit && read[13] == limit);
    assert_true(fabsf(read[15] - 1) < 0.01f && fabsf(read[17] - 0.25f) < 0.01f);
    assert_true(fabsf(read[18] / 8e-39f - 1) < 0.01f);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

/* ---- the others -------------------------------------------------------------------------- */

static void pfm_keeps_every_bit(void **state)
{
    (void)state;
    float *rgb = make_pixels(17, 9);
    fill_with_noise(rgb, 17 * 9, 1);
    const helio_map map = {.width = 17, .height = 9, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    check_copy("map.pfm", &map, NULL, 0);
    free(rgb);
}

#ifdef HELIO_WITH_OPENEXR
static void exr_keeps_every_bit_of_floats_and_half_of_halves(void **state)
{
    (void)state;
    float *rgb = make_pixels(65, 33);
    fill_with_noise(rgb, 65 * 33, 2);
    for (size_t i = 0; i < 3 * 65 * 33; i++)
        rgb[i] = fminf(rgb[i], 65504);
    const helio_map map = {.width = 65, .height = 33, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    check_copy("float.exr", &map, NULL, 0);
    /* 11 bits, and for the darkest the smallest half, which is far below 2^-11 of most of these pixels. */
    for (size_t i = 0; i < 3 * 65 * 33; i++)
        rgb[i] = fmaxf(rgb[i], 6.2e-5f); /* the smallest normal half */
    check_copy("half.exr", &map, &(helio_map_write_desc){.half = true}, 0x1p-11f);
    assert_true(size_of("half.exr") < size_of("float.exr"));
    free(rgb);
}

static void half_floats_are_refused_where_they_lose_light(void **state)
{
    (void)state;
    float rgb[] = {1, 65504, 1, 1, 65536, 1};
    helio_context *context = make_context(1, NULL);
    helio_map map = {.width = 1, .height = 1, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    const helio_map_write_desc desc = {.half = true};
    assert_ok(helio_map_write(context, "half.exr", &map, &desc));
    map.width = 2;
    assert_int_equal(helio_map_write(context, "lost.exr", &map, &desc), HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "65536"));
    assert_int_equal(access("lost.exr", F_OK), -1);
    assert_ok(helio_map_write(context, "pixels.hdr", &map, &desc)); /* only EXR has halves */
    helio_context_destroy(context);
}
#endif

#ifdef HELIO_WITH_PNG
static void png_holds_eight_bits_of_srgb(void **state)
{
    (void)state;
    const float rgb[] = {0, 0.5f, 1, 2, 0.25f, NAN};
    const helio_map map = {.width = 2, .height = 1, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    helio_context *context = make_context(1, NULL);
    assert_ok(helio_map_write(context, "map.png", &map, &(helio_map_write_desc){.exposure = -1}));
    helio_image *image = read_back(context, "map.png", 2, 1);
    const float wanted[] = {0, 0.25f, 0.5f, 1, 0.125f, 0};
    for (size_t i = 0; i < 6; i++) /* half a step of 255, at most 0.0045 where the curve is steepest */
        assert_true(fabsf(image->rgb[i] - wanted[i]) < 0.005f);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}
#endif

/* ---- layouts ----------------------------------------------------------------------------- */

static void files_tell_their_layout(void **state)
{
    (void)state;
    static const char *const names[] = {"map.hdr", "map.exr"};
    helio_context *context = make_context(1, NULL);
    for (int i = HELIO_LAYOUT_LATLONG; i <= HELIO_LAYOUT_MIRRORBALL; i++)
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
            helio_map map = {.layout = (helio_layout)i};
            if (i == HELIO_LAYOUT_FACES || helio_map_check_path(names[k], map.layout) != HELIO_OK)
                continue;
            assert_ok(helio_layout_shape(map.layout, 4, &map.width, &map.height));
            float *rgb = make_pixels(map.width, map.height);
            fill_with_noise(rgb, (size_t)map.width * map.height, 3);
            map.rgb = rgb;
            assert_ok(helio_map_write(context, names[k], &map, NULL));
            helio_image *image = read_back(context, names[k], map.width, map.height);
            assert_int_equal(image->layout, map.layout);
            helio_image_destroy(context, image);
            free(rgb);
        }
    helio_context_destroy(context);
}

static void comments_that_do_not_fit_are_left_alone(void **state)
{
    (void)state;
    static const char *const comments[] = {"layout: octahedral", "layout: round", "layout: auto",
                                           "layout: octahedral map",
                                           "layout: a very long comment about all kinds of things"};
    helio_context *context = make_context(1, NULL);
    for (size_t i = 0; i < sizeof comments / sizeof *comments; i++) {
        FILE *stream = fopen("comment.hdr", "wb");
        assert_non_null(stream);
        fprintf(stream, "#?RADIANCE\n# %s\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x80\x80\x80\x80\x80",
                comments[i]);
        assert_int_equal(fclose(stream), 0);
        helio_image *image = read_back(context, "comment.hdr", 2, 1);
        assert_int_equal(image->layout, HELIO_LAYOUT_AUTO);
        helio_image_destroy(context, image);
    }
    helio_context_destroy(context);
}

/* ---- six faces --------------------------------------------------------------------------- */

static const char *const FACES[6] = {"px", "nx", "py", "ny", "pz", "nz"};

static helio_map make_faces(void)
{
    static float rgb[6 * 4 * 4 * 3];
    for (size_t i = 0; i < sizeof rgb / sizeof *rgb; i++)
        rgb[i] = (float)(i / (4 * 4 * 3)) + 0.25f * (float)(i % 3);
    return (helio_map){.width = 4, .height = 24, .rgb = rgb, .layout = HELIO_LAYOUT_FACES};
}

static void check_faces(helio_context *context, const char *format, const helio_map *map)
{
    for (int i = 0; i < 6; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s%s.pfm", format, FACES[i]);
        helio_image *image = read_back(context, path, 4, 4);
        assert_memory_equal(image->rgb, map->rgb + (size_t)i * 4 * 4 * 3, 4 * 4 * 3 * sizeof(float));
        helio_image_destroy(context, image);
    }
}

static void six_faces_go_to_six_files(void **state)
{
    (void)state;
    const helio_map map = make_faces();
    helio_context *context = make_context(1, NULL);
    assert_ok(helio_map_write(context, "map_%s.pfm", &map, NULL));
    check_faces(context, "map_", &map);
    helio_context_destroy(context);
}

static void a_folder_gets_six_files(void **state)
{
    (void)state;
    const helio_map map = make_faces();
    helio_context *context = make_context(1, NULL);
    assert_int_equal(mkdir("there", 0777), 0);
    assert_ok(helio_map_write(context, "there", &map, NULL));
    assert_ok(helio_map_write(context, "there/", &map, NULL));
    assert_ok(helio_map_write(context, "new/", &map, NULL));
    for (int i = 0; i < 6; i++) {
        char exr[64], hdr[64];
        snprintf(exr, sizeof exr, "new/%s.exr", FACES[i]);
        snprintf(hdr, sizeof hdr, "new/%s.hdr", FACES[i]);
        assert_true(access(exr, R_OK) == 0 || access(hdr, R_OK) == 0);
    }
    assert_int_equal(helio_map_write(context, "far/away/", &map, NULL), HELIO_ERR_IO);
    helio_context_destroy(context);
}

static void a_face_that_cannot_be_written_leaves_the_others_as_they_were(void **state)
{
    (void)state;
    const helio_map map = make_faces();
    helio_context *context = make_context(1, NULL);
    assert_int_equal(mkdir("bad_nz.pfm", 0777), 0);
    assert_int_equal(helio_map_write(context, "bad_%s.pfm", &map, NULL), HELIO_ERR_IO);
    for (int i = 0; i < 5; i++) {
        char path[64];
        snprintf(path, sizeof path, "bad_%s.pfm", FACES[i]);
        assert_int_equal(access(path, F_OK), -1);
    }
    helio_context_destroy(context);
}

/* ---- failures ---------------------------------------------------------------------------- */

static void refuses(const char *path, const helio_map *map, const helio_map_write_desc *desc, helio_status status,
                    const char *word)
{
    helio_context *context = make_context(1, NULL);
    assert_int_equal(helio_map_write(context, path, map, desc), status);
    if (strstr(helio_last_error(), word) == NULL)
        fail_msg("no \"%s\" in: %s", word, helio_last_error());
    helio_context_destroy(context);
}

static void mistakes_are_one_sentence(void **state)
{
    (void)state;
    const float rgb[3] = {1, 1, 1};
    const helio_map good = {.width = 1, .height = 1, .rgb = rgb, .layout = HELIO_LAYOUT_LATLONG};
    helio_map map = good;
    refuses(NULL, &good, NULL, HELIO_ERR_ARGUMENT, "path");
    refuses("map.tiff", &good, NULL, HELIO_ERR_ARGUMENT, ".hdr");
    refuses("no/where/map.pfm", &good, NULL, HELIO_ERR_IO, "no/where/map.pfm");
    refuses("map.pfm", &good, &(helio_map_write_desc){.exposure = NAN}, HELIO_ERR_ARGUMENT, "exposure");
    refuses("map.pfm", &good, &(helio_map_write_desc){.tonemap = (helio_tonemap)9}, HELIO_ERR_ARGUMENT, "tone map 9");
    map.rgb = NULL;
    refuses("map.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "rgb");
    map = good;
    map.layout = HELIO_LAYOUT_AUTO;
    refuses("map.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "layout");
    map = good;
    map.width = 0;
    refuses("map.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "0 x 1");
    map = good;
    map.layout = HELIO_LAYOUT_FACES;
    refuses("map_%s.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "1:6");
    refuses("map.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "%s");
    refuses("%s_%s.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "%s");
    refuses("%d_%s.pfm", &map, NULL, HELIO_ERR_ARGUMENT, "%s");
    assert_int_equal(helio_map_write(NULL, "map.pfm", &good, NULL), HELIO_ERR_ARGUMENT);
}

static void memory_that_runs_out_leaves_no_file(void **state)
{
    (void)state;
    static const char *const paths[] = {"none.hdr", "none.pfm", "none.exr", "none.png", "none_%s.hdr"};
    helio_map map = make_faces();
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        map.layout = strchr(paths[i], '%') ? HELIO_LAYOUT_FACES : HELIO_LAYOUT_STRIP;
        if (helio_map_check_path(paths[i], map.layout) != HELIO_OK)
            continue;
        helio_status status = HELIO_ERR_MEMORY;
        for (size_t granted = 0; status != HELIO_OK; granted++) {
            memory_count count = {0};
            helio_context *context = make_context(1, &count);
            count.refuse_after = atomic_load(&count.taken) + granted;
            status = helio_map_write(context, paths[i], &map, NULL);
            assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
            count.refuse_after = 0;
            if (status != HELIO_OK)
                assert_int_equal(access(paths[i], F_OK), -1);
            helio_context_destroy(context);
            assert_int_equal(atomic_load(&count.live), 0);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(radiance_keeps_noise_and_runs_of_any_width),
        cmocka_unit_test(radiance_writes_lines_that_are_too_long_for_its_coding),
        cmocka_unit_test(radiance_codes_runs),
        cmocka_unit_test(radiance_holds_its_extremes),
        cmocka_unit_test(pfm_keeps_every_bit),
#ifdef HELIO_WITH_OPENEXR
        cmocka_unit_test(exr_keeps_every_bit_of_floats_and_half_of_halves),
        cmocka_unit_test(half_floats_are_refused_where_they_lose_light),
#endif
#ifdef HELIO_WITH_PNG
        cmocka_unit_test(png_holds_eight_bits_of_srgb),
#endif
        cmocka_unit_test(files_tell_their_layout),
        cmocka_unit_test(comments_that_do_not_fit_are_left_alone),
        cmocka_unit_test(six_faces_go_to_six_files),
        cmocka_unit_test(a_folder_gets_six_files),
        cmocka_unit_test(a_face_that_cannot_be_written_leaves_the_others_as_they_were),
        cmocka_unit_test(mistakes_are_one_sentence),
        cmocka_unit_test(memory_that_runs_out_leaves_no_file),
    };
    return cmocka_run_group_tests_name("map", tests, set_up, tear_down);
}
