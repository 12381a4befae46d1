/* SPDX-License-Identifier: MIT
 * Environment maps in six files: how they are named, found and put together. */
#include "support.h"

#include <heliostat/image.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static helio_context *shared_context;
static memory_count shared_memory;
static char folder[TEST_PATH_SIZE];

static void join(char path[TEST_PATH_SIZE], const char *name)
{
    assert_true(snprintf(path, TEST_PATH_SIZE, "%s/%s", folder, name) < TEST_PATH_SIZE);
}

/* A picture of one value but for its top left pixel, which is 100 more. */
static void write_picture(const char *name, uint32_t width, uint32_t height, float value)
{
    char path[TEST_PATH_SIZE];
    join(path, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "PF\n%u %u\n-1.0\n", width, height);
    for (uint32_t i = 0; i < width * height; i++) { /* from the bottom row on */
        float number = i == width * (height - 1) ? value + 100 : value;
        for (int c = 0; c < 3; c++)
            assert_int_equal(fwrite(&number, sizeof number, 1, file), 1);
    }
    assert_int_equal(fclose(file), 0);
}

static void write_six(const char *const names[6], uint32_t size)
{
    for (int face = 0; face < 6; face++)
        write_picture(names[face], size, size, (float)(face + 1));
}

static void expect_strip(const char *name, helio_layout layout, uint32_t size)
{
    char path[TEST_PATH_SIZE];
    helio_image *image;
    join(path, name);
    assert_ok(helio_image_read(shared_context, path, &(helio_image_read_desc){.layout = layout}, &image));
    assert_int_equal(image->width, size);
    assert_int_equal(image->height, 6 * size);
    assert_int_equal(image->layout, HELIO_LAYOUT_STRIP);
    assert_null(image->alpha);
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        uint32_t face = i / (size * size), place = i % (size * size);
        assert_true(image->rgb[i * 3] == (float)(face + 1 + (place == 0 ? 100 : 0)));
    }
    helio_image_destroy(shared_context, image);
}

static void expect_failure(const char *name, helio_layout layout, helio_status status, const char *const words[2])
{
    char path[TEST_PATH_SIZE];
    helio_image *image;
    join(path, name);
    size_t live = shared_memory.live;
    assert_int_equal(helio_image_read(shared_context, path, &(helio_image_read_desc){.layout = layout}, &image),
                     status);
    assert_null(image);
    assert_int_equal(shared_memory.live, live);
    for (int i = 0; i < 2; i++)
        if (strstr(helio_last_error(), words[i]) == NULL)
            fail_msg("\"%s\" does not say \"%s\"", helio_last_error(), words[i]);
}

static void all_spellings_are_understood(void **state)
{
    (void)state;
    const char *const spellings[][6] = {
        {"px.pfm", "nx.pfm", "py.pfm", "ny.pfm", "pz.pfm", "nz.pfm"},
        {"a_PX.pfm", "a_NX.pfm", "a_PY.pfm", "a_NY.pfm", "a_PZ.pfm", "a_NZ.pfm"},
        {"posx.pfm", "negx.pfm", "posy.pfm", "negy.pfm", "posz.pfm", "negz.pfm"},
        {"Right.pfm", "Left.pfm", "Top.pfm", "Bottom.pfm", "Front.pfm", "Back.pfm"},
        {"sky-right.pfm", "sky-left.pfm", "sky-up.pfm", "sky-down.pfm", "sky-front.pfm", "sky-back.pfm"},
        {"+x.pfm", "-x.pfm", "+y.pfm", "-y.pfm", "+z.pfm", "-z.pfm"},
        {"sky+X.pfm", "sky-X.pfm", "sky+Y.pfm", "sky-Y.pfm", "sky+Z.pfm", "sky-Z.pfm"},
        {"x+.pfm", "x-.pfm", "y+.pfm", "y-.pfm", "z+.pfm", "z-.pfm"},
        {"dm_rt.pfm", "dm_lf.pfm", "dm_up.pfm", "dm_dn.pfm", "dm_ft.pfm", "dm_bk.pfm"},
        {"pos_x.pfm", "neg_x.pfm", "pos_y.pfm", "neg_y.pfm", "pos_z.pfm", "neg_z.pfm"},
        {"s-positive_x.pfm", "s-negative_x.pfm", "s-positive_y.pfm", "s-negative_y.pfm", "s-positive_z.pfm",
         "s-negative_z.pfm"},
        {"xp.pfm", "xn.pfm", "yp.pfm", "yn.pfm", "zp.pfm", "zn.pfm"}};
    for (size_t i = 0; i < sizeof spellings / sizeof *spellings; i++) {
        make_directory(folder);
        write_six(spellings[i], 3);
        expect_strip("", HELIO_LAYOUT_AUTO, 3);
        expect_strip(spellings[i][2], HELIO_LAYOUT_FACES, 3); /* one stands for all, if somebody says so */
        remove_directory(folder);
    }
}

static void patterns_name_six_files_among_others(void **state)
{
    (void)state;
    make_directory(folder);
    write_six((const char *const[6]){"a0.pfm", "a1.pfm", "a2.pfm", "a3.pfm", "a4.pfm", "a5.pfm"}, 2);
    write_six((const char *const[6]){"b_px.pfm", "b_nx.pfm", "b_py.pfm", "b_ny.pfm", "b_pz.pfm", "b_nz.pfm"}, 4);
    write_six(
        (const char *const[6]){"right-c.pfm", "left-c.pfm", "up-c.pfm", "down-c.pfm", "front-c.pfm", "back-c.pfm"}, 1);
    write_picture("a6.pfm", 9, 9, 0);
    write_picture("b_px2.pfm", 9, 9, 0);
    expect_strip("a%s.pfm", HELIO_LAYOUT_AUTO, 2);
    expect_strip("b_%s.pfm", HELIO_LAYOUT_AUTO, 4);
    expect_strip("%s-c.pfm", HELIO_LAYOUT_AUTO, 1);
    expect_strip("b_nz.pfm", HELIO_LAYOUT_FACES, 4);
    remove_directory(folder);
}

/* Six pictures that are all numbered, and nothing else that is one. */
static void folders_may_have_numbers_alone(void **state)
{
    (void)state;
    make_directory(folder);
    write_six((const char *const[6]){"s_0.pfm", "s_1.pfm", "s_2.pfm", "s_3.pfm", "s_4.pfm", "s_5.pfm"}, 2);
    expect_strip("", HELIO_LAYOUT_AUTO, 2);
    char path[TEST_PATH_SIZE];
    join(path, "notes.txt");
    FILE *notes = fopen(path, "w");
    assert_non_null(notes);
    assert_int_equal(fclose(notes), 0);
    expect_strip("", HELIO_LAYOUT_AUTO, 2);
    write_picture("s_6.pfm", 2, 2, 1);
    expect_failure("", HELIO_LAYOUT_AUTO, HELIO_ERR_IO, (const char *const[2]){"px, posx", "/sky_%s.exr"});
    expect_strip("s_%s.pfm", HELIO_LAYOUT_AUTO, 2);
    join(path, "s_5.pfm");
    assert_int_equal(remove(path), 0);
    expect_failure("", HELIO_LAYOUT_AUTO, HELIO_ERR_IO, (const char *const[2]){"nz, negz", "/sky_%s.exr"});
    remove_directory(folder);
}

static void a_single_file_is_itself_unless_faces_are_asked_for(void **state)
{
    (void)state;
    char path[TEST_PATH_SIZE];
    helio_image *image;
    make_directory(folder);
    write_six((const char *const[6]){"px.pfm", "nx.pfm", "py.pfm", "ny.pfm", "pz.pfm", "nz.pfm"}, 2);
    write_picture("strip.pfm", 2, 12, 1);
    write_picture("100%s.pfm", 5, 5, 1); /* a file that exists wins over a pattern */
    const char *const names[] = {"px.pfm", "strip.pfm", "100%s.pfm"};
    const uint32_t sizes[][2] = {{2, 2}, {2, 12}, {5, 5}};
    for (int i = 0; i < 3; i++) {
        join(path, names[i]);
        const helio_image_read_desc desc = {.layout = i == 0 ? HELIO_LAYOUT_STRIP : HELIO_LAYOUT_FACES};
        assert_ok(helio_image_read(shared_context, path, &desc, &image));
        assert_int_equal(image->width, sizes[i][0]);
        assert_int_equal(image->height, sizes[i][1]);
        assert_int_equal(image->layout, HELIO_LAYOUT_AUTO);
        helio_image_destroy(shared_context, image);
    }
    remove_directory(folder);
}

static void mistakes_name_the_file(void **state)
{
    (void)state;
    make_directory(folder);
    expect_failure("", HELIO_LAYOUT_AUTO, HELIO_ERR_IO, (const char *const[2]){folder, "px, posx"});
    expect_failure("no/such/%s.pfm", HELIO_LAYOUT_AUTO, HELIO_ERR_IO,
                   (const char *const[2]){"no/such/%s.pfm", "opened"});
    expect_failure("%s/%s.pfm", HELIO_LAYOUT_AUTO, HELIO_ERR_IO, (const char *const[2]){"%s/%s.pfm", "opened"});
    expect_failure("%s%s.pfm", HELIO_LAYOUT_AUTO, HELIO_ERR_ARGUMENT, (const char *const[2]){"%s%s.pfm", "one %s"});
    expect_failure("%s/px.pfm", HELIO_LAYOUT_AUTO, HELIO_ERR_ARGUMENT, (const char *const[2]){"%s/px.pfm", "one %s"});
    write_six((const char *const[6]){"px.pfm", "nx.pfm", "py.pfm", "ny.pfm", "pz.pfm", "notes.pfm"}, 2);
    expect_failure("", HELIO_LAYOUT_AUTO, HELIO_ERR_IO, (const char *const[2]){folder, "nz, negz"});
    expect_failure("px.pfm", HELIO_LAYOUT_FACES, HELIO_ERR_IO, (const char *const[2]){"px.pfm", "nz, negz"});
    write_picture("nz.pfm", 3, 3, 1);
    expect_failure("%s.pfm", HELIO_LAYOUT_AUTO, HELIO_ERR_DATA, (const char *const[2]){"nz.pfm", "3 x 3"});
    write_picture("nz.pfm", 3, 2, 1);
    expect_failure("", HELIO_LAYOUT_AUTO, HELIO_ERR_DATA, (const char *const[2]){"nz.pfm", "not square"});
    write_picture("nz.pfm", 2, 2, 1);
    write_picture("back.pfm", 2, 2, 1);
    expect_failure("", HELIO_LAYOUT_AUTO, HELIO_ERR_DATA, (const char *const[2]){"nz.pfm", "back.pfm"});
    remove_directory(folder);
}

static void bad_pixels_of_all_faces_are_counted(void **state)
{
    (void)state;
    helio_image *image;
    make_directory(folder);
    const char *const names[6] = {"px.pfm", "nx.pfm", "py.pfm", "ny.pfm", "pz.pfm", "nz.pfm"};
    write_six(names, 2);
    write_picture(names[1], 2, 2, -1000);
    write_picture(names[5], 2, 2, 1e35f);
    assert_ok(helio_image_read(shared_context, folder, NULL, &image));
    assert_int_equal(image->bad.negative, 4);
    assert_int_equal(image->bad.infinite, 4);
    assert_int_equal(image->bad.nan, 0);
    helio_image_destroy(shared_context, image);
    remove_directory(folder);
}

static void too_many_pixels_are_refused(void **state)
{
    (void)state;
    helio_image *image;
    make_directory(folder);
    write_six((const char *const[6]){"px.pfm", "nx.pfm", "py.pfm", "ny.pfm", "pz.pfm", "nz.pfm"}, 4);
    helio_image_read_desc desc = {.max_pixels = 96};
    assert_ok(helio_image_read(shared_context, folder, &desc, &image));
    helio_image_destroy(shared_context, image);
    desc.max_pixels = 95;
    assert_int_equal(helio_image_read(shared_context, folder, &desc, &image), HELIO_ERR_DATA);
    remove_directory(folder);
}

static int make_shared_context(void **state)
{
    (void)state;
    shared_context = make_context(1, &shared_memory);
    return 0;
}

static int destroy_shared_context(void **state)
{
    (void)state;
    helio_context_destroy(shared_context);
    return shared_memory.live == 0 ? 0 : -1;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_spellings_are_understood),
        cmocka_unit_test(patterns_name_six_files_among_others),
        cmocka_unit_test(folders_may_have_numbers_alone),
        cmocka_unit_test(a_single_file_is_itself_unless_faces_are_asked_for),
        cmocka_unit_test(mistakes_name_the_file),
        cmocka_unit_test(bad_pixels_of_all_faces_are_counted),
        cmocka_unit_test(too_many_pixels_are_refused),
    };
    return cmocka_run_group_tests_name("faces", tests, make_shared_context, destroy_shared_context);
}
