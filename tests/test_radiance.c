/* SPDX-License-Identifier: MIT
 *
 * Radiance pictures, written here byte by byte. */
#include "image_support.h"

#include <locale.h>
#include <math.h>

enum { WIDTH = 12, HEIGHT = 9 };

typedef struct buffer {
    unsigned char bytes[65536];
    size_t size;
} buffer;

static void append(buffer *b, const void *bytes, size_t size)
{
    assert_true(b->size + size <= sizeof b->bytes);
    memcpy(b->bytes + b->size, bytes, size);
    b->size += size;
}

static void append_text(buffer *b, const char *text)
{
    append(b, text, strlen(text));
}

/* Some pixels with runs, without four equal first mantissas that would look like a code, and with black. */
static void make_pixel(uint32_t row, uint32_t column, unsigned char rgbe[4])
{
    uint32_t run = column / 5 + row / 2;
    rgbe[0] = (unsigned char)(40 + 7 * run);
    rgbe[1] = (unsigned char)(100 + 3 * run);
    rgbe[2] = (unsigned char)(17 * column + 60);
    rgbe[3] = run % 4 == 3 ? 0 : (unsigned char)(125 + run);
}

static void append_flat(buffer *b, const unsigned char *rgbe, uint32_t length)
{
    append(b, rgbe, 4 * (size_t)length);
}

/* 1 1 1 n repeats the last pixel n times; a second one right after it, 256 n times. */
static void append_old(buffer *b, const unsigned char *rgbe, uint32_t length)
{
    for (uint32_t i = 0; i < length;) {
        uint32_t run = 1;
        while (i + run < length && memcmp(rgbe + 4 * i, rgbe + 4 * (i + run), 4) == 0)
            run++;
        append(b, rgbe + 4 * i, 4);
        uint32_t repeats = run - 1;
        for (; repeats > 0; repeats >>= 8)
            append(b, (unsigned char[4]){1, 1, 1, (unsigned char)repeats}, 4);
        i += run;
    }
}

static void append_new(buffer *b, const unsigned char *rgbe, uint32_t length)
{
    append(b, (unsigned char[4]){2, 2, (unsigned char)(length >> 8), (unsigned char)length}, 4);
    for (uint32_t c = 0; c < 4; c++)
        for (uint32_t i = 0; i < length;) {
            uint32_t run = 1;
            while (i + run < length && run < 127 && rgbe[4 * i + c] == rgbe[4 * (i + run) + c])
                run++;
            if (run > 1)
                append(b, (unsigned char[2]){(unsigned char)(128 + run), rgbe[4 * i + c]}, 2);
            else
                append(b, (unsigned char[2]){1, rgbe[4 * i + c]}, 2);
            i += run;
        }
}

typedef void (*line_coder)(buffer *b, const unsigned char *rgbe, uint32_t length);

/* The test picture with this resolution line; x_first, x_minus and y_plus as it says. */
static void append_picture(buffer *b, const char *axes, line_coder code)
{
    bool x_first = axes[1] == 'X';
    bool x_minus = axes[x_first ? 0 : 2] == '-', y_plus = axes[x_first ? 2 : 0] == '+';
    uint32_t lines = x_first ? WIDTH : HEIGHT, length = x_first ? HEIGHT : WIDTH;
    char text[64];
    snprintf(text, sizeof text, "%.2s %u %.2s %u\n", axes, lines, axes + 2, length);
    append_text(b, text);
    for (uint32_t line = 0; line < lines; line++) {
        unsigned char rgbe[4 * WIDTH];
        for (uint32_t i = 0; i < length; i++) {
            uint32_t row = x_first ? i : line, column = x_first ? line : i;
            make_pixel(y_plus ? HEIGHT - 1 - row : row, x_minus ? WIDTH - 1 - column : column, rgbe + 4 * i);
        }
        code(b, rgbe, length);
    }
}

static helio_image *read_buffer(fixture *f, const buffer *b)
{
    const char *path = fixture_path(f, "test.hdr");
    write_file(path, b->bytes, b->size);
    helio_image *image = read_image(f, path);
    unlink(path);
    return image;
}

static helio_image *read_picture(fixture *f, const char *head, const char *axes, line_coder code)
{
    buffer b = {.size = 0};
    append_text(&b, head);
    append_picture(&b, axes, code);
    return read_buffer(f, &b);
}

/* One pixel of these bytes behind this head. */
static void read_pixel(fixture *f, const char *head, const unsigned char rgbe[4], float rgb[3])
{
    buffer b = {.size = 0};
    append_text(&b, head);
    append_text(&b, "\n-Y 1 +X 1\n");
    append(&b, rgbe, 4);
    helio_image *image = read_buffer(f, &b);
    assert_int_equal(image->width, 1);
    assert_int_equal(image->height, 1);
    memcpy(rgb, image->rgb, 3 * sizeof *rgb);
    helio_image_destroy(f->context, image);
}

#define HEAD "#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n"

static void test_radiance_values_are_mantissa_plus_half(void **state)
{
    fixture *f = *state;
    helio_image *image = read_picture(f, HEAD "\n", "-Y+X", append_flat);
    assert_int_equal(image->width, WIDTH);
    assert_int_equal(image->height, HEIGHT);
    assert_int_equal(image->layout, HELIO_LAYOUT_AUTO);
    assert_int_equal(bad_pixels(image), 0);
    assert_null(image->alpha);
    for (uint32_t row = 0; row < HEIGHT; row++)
        for (uint32_t column = 0; column < WIDTH; column++) {
            unsigned char rgbe[4];
            make_pixel(row, column, rgbe);
            const float *rgb = image->rgb + 3 * (row * WIDTH + column);
            for (int c = 0; c < 3; c++) {
                float expected = rgbe[3] ? (float)ldexp(rgbe[c] + 0.5, rgbe[3] - 136) : 0.0f;
                assert_memory_equal(&rgb[c], &expected, sizeof expected);
            }
        }
    helio_image_destroy(f->context, image);
}

static void expect_same_pixels(const helio_image *a, const helio_image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    assert_memory_equal(a->rgb, b->rgb, 3 * sizeof(float) * a->width * a->height);
}

static void test_all_codings_and_orientations_agree(void **state)
{
    static const char *const axes[] = {"-Y+X", "-Y-X", "+Y+X", "+Y-X", "+X-Y", "+X+Y", "-X-Y", "-X+Y"};
    static const line_coder coders[] = {append_flat, append_old, append_new};
    fixture *f = *state;
    helio_image *expected = read_picture(f, HEAD "\n", "-Y+X", append_flat);
    for (size_t a = 0; a < 8; a++)
        for (size_t c = 0; c < 3; c++) {
            helio_image *image = read_picture(f, HEAD "\n", axes[a], coders[c]);
            expect_same_pixels(image, expected);
            helio_image_destroy(f->context, image);
        }
    helio_image_destroy(f->context, expected);
}

static void test_old_runs_longer_than_255(void **state)
{
    enum { LENGTH = 1000 };
    fixture *f = *state;
    unsigned char rgbe[4 * LENGTH];
    for (uint32_t i = 0; i < LENGTH; i++)
        memcpy(rgbe + 4 * i, i < 900 ? "\x11\x22\x33\x80" : "\x44\x55\x66\x81", 4);
    buffer b = {.size = 0};
    append_text(&b, HEAD "\n-Y 2 +X 1000\n");
    append_old(&b, rgbe, LENGTH);
    append_flat(&b, rgbe, LENGTH);
    helio_image *image = read_buffer(f, &b);
    assert_memory_equal(image->rgb, image->rgb + 3 * LENGTH, 3 * sizeof(float) * LENGTH);
    assert_true(image->rgb[3 * 899] < image->rgb[3 * 900]);
    helio_image_destroy(f->context, image);
}

static void test_exposure_and_correction_are_divided_out(void **state)
{
    fixture *f = *state;
    const unsigned char rgbe[4] = {100, 150, 200, 130};
    float plain[3], changed[3];
    read_pixel(f, HEAD, rgbe, plain);
    read_pixel(f, "#?RGBE\nEXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR= 1 2 0.5\nCOLORCORR=1 1 0.5\n", rgbe, changed);
    assert_float_equal(changed[0], plain[0] / 8, 0);
    assert_float_equal(changed[1], plain[1] / 16, 0);
    assert_float_equal(changed[2], plain[2] / 2, 0);
}

static void test_heads_may_have_carriage_returns(void **state)
{
    fixture *f = *state;
    float rgb[3];
    read_pixel(f, "#?RGBE\r\nEXPOSURE=0.5\r\n\r", (unsigned char[4]){128, 128, 128, 128}, rgb);
    assert_float_equal(rgb[0], 128.5f / 256 / 0.5f, 0);
}

static void test_locale_does_not_matter(void **state)
{
    fixture *f = *state;
    float rgb[3];
    if (setlocale(LC_NUMERIC, "de_DE.UTF-8") == NULL && setlocale(LC_NUMERIC, "fr_FR.UTF-8") == NULL) {
        print_message("skipped: no locale with decimal commas is installed\n");
        skip();
    }
    read_pixel(f, "#?RGBE\nEXPOSURE=0.5\n", (unsigned char[4]){128, 128, 128, 128}, rgb);
    setlocale(LC_NUMERIC, "C");
    assert_float_equal(rgb[0], 128.5f / 256 / 0.5f, 0);
}

static void test_primaries_are_converted(void **state)
{
    fixture *f = *state;
    const unsigned char red[4] = {255, 0, 0, 128}, white[4] = {200, 200, 200, 128};
    float plain[3], rgb[3];
    read_pixel(f, HEAD, red, plain);
    read_pixel(f, HEAD "PRIMARIES= 0.64 0.33 0.30 0.60 0.15 0.06 0.3127 0.3290\n", red, rgb);
    assert_memory_equal(rgb, plain, sizeof rgb);

    /* Photoshop writes zeros for what it does not know; other numbers that span no colours are told of. */
    f->notices = 0;
    read_pixel(f, HEAD "PRIMARIES=0 0 0 0 0 0 0 0\n", red, rgb);
    assert_memory_equal(rgb, plain, sizeof rgb);
    assert_int_equal(f->notices, 0);
    read_pixel(f, HEAD "PRIMARIES= 0.64 0.33 0.64 0.33 0.64 0.33 0.3127 0.3290\n", red, rgb);
    assert_memory_equal(rgb, plain, sizeof rgb);
    assert_int_equal(f->notices, 1);

    /* Rec. 2020, with the matrix of BT.2087. */
    const char *wide = HEAD "PRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.3290\n";
    read_pixel(f, wide, red, rgb);
    const float low = 0.5f / 256; /* of the channels with mantissa 0 */
    assert_float_equal(rgb[0], 1.6605f * plain[0] - (0.5876f + 0.0728f) * low, 1e-4f);
    assert_float_equal(rgb[1], -0.1246f * plain[0] + (1.1329f - 0.0083f) * low, 1e-4f);
    assert_float_equal(rgb[2], -0.0182f * plain[0] + (-0.1006f + 1.1187f) * low, 1e-4f);

    /* White stays white whatever the white point. */
    read_pixel(f, HEAD, white, plain);
    read_pixel(f, HEAD "PRIMARIES= 0.640 0.330 0.290 0.600 0.150 0.060 0.3333 0.3333\n", white, rgb);
    for (int c = 0; c < 3; c++)
        assert_float_equal(rgb[c], plain[c], 1e-6f);
}

static void test_xyz_becomes_rec709(void **state)
{
    fixture *f = *state;
    float rgb[3];
    read_pixel(f, "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n", (unsigned char[4]){100, 150, 200, 136}, rgb);
    const float x = 100.5f, y = 150.5f, z = 200.5f;
    assert_float_equal(rgb[0], 3.2410f * x - 1.5374f * y - 0.4986f * z, 0.05f);
    assert_float_equal(rgb[1], -0.9692f * x + 1.8760f * y + 0.0416f * z, 0.05f);
    assert_float_equal(rgb[2], 0.0556f * x - 0.2040f * y + 1.0570f * z, 0.05f);
}

static void test_damaged_heads_are_refused(void **state)
{
    static const char *const heads[] = {
        "#?",
        "#?RADIANCE",
        "#?RADIANCE\n",
        HEAD,
        HEAD "\n",
        HEAD "\n-Y 1 +X",
        HEAD "\n-Y 1 +X 1",
        HEAD "\n-Y 1 +X 1\n",
        HEAD "\n-Y 0 +X 1\n\1\1\1\1",
        HEAD "\n-Y 1 +X 0\n\1\1\1\1",
        HEAD "\n-Y -1 +X 1\n\1\1\1\1",
        HEAD "\n-Y 1 +Y 1\n\1\1\1\1",
        HEAD "\n-Y 1 X 1\n\1\1\1\1",
        HEAD "\n-Y 1 +X 1 rest\n\1\1\1\1",
        HEAD "\n-Y 99999999999999999999 +X 1\n\1\1\1\1",
        HEAD "\n-Y 4294967295 +X 4294967295\n\1\1\1\1",
        HEAD "\n-Y 1048576 +X 1048576\n\1\1\1\1",
        "#?RADIANCE\nFORMAT=32-bit_rle_cmyk\n\n-Y 1 +X 1\n\2\2\2\2",
        "#?RADIANCE\nEXPOSURE=0\n\n-Y 1 +X 1\n\2\2\2\2",
        "#?RADIANCE\nEXPOSURE=-1\n\n-Y 1 +X 1\n\2\2\2\2",
        "#?RADIANCE\nEXPOSURE=nan\n\n-Y 1 +X 1\n\2\2\2\2",
        "#?RADIANCE\nEXPOSURE=1e30\nEXPOSURE=1e30\n\n-Y 1 +X 1\n\2\2\2\2",
        "#?RADIANCE\nCOLORCORR=1 1\n\n-Y 1 +X 1\n\2\2\2\2",
        "#?RADIANCE\nPRIMARIES=1 1\n\n-Y 1 +X 1\n\2\2\2\2",
        HEAD "\n-Y 1 +X 2\n\1\1\1\1\2\2\2\2",                 /* repeats a pixel before the first */
        HEAD "\n-Y 1 +X 2\n\2\2\2\2\1\1\1\2",                 /* repeats past the end */
        HEAD "\n-Y 1 +X 8\n\2\2\1\1\x88\1\x88\1\x88\1\x88\1", /* another length */
        HEAD "\n-Y 1 +X 8\n\2\2\377\377",                     /* a pixel, and then nothing */
    };
    fixture *f = *state;
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
        expect_bad_bytes(f, heads[i], strlen(heads[i]));
    /* Runs that pass the end of the line, or have no length. */
    static const char *const runs[] = {"\x89\1", "\x00\1", "\x09\1"};
    for (size_t i = 0; i < 3; i++) {
        buffer b = {.size = 0};
        append_text(&b, HEAD "\n-Y 1 +X 8\n\2\2");
        append(&b, (unsigned char[2]){0, 8}, 2);
        append(&b, runs[i], 2);
        append(&b, "0123456789abcdef0123456789abcdef", 32);
        expect_bad_bytes(f, b.bytes, b.size);
    }
}

static void test_truncated_pictures_are_refused(void **state)
{
    static const line_coder coders[] = {append_flat, append_old, append_new};
    fixture *f = *state;
    for (size_t c = 0; c < 3; c++) {
        buffer b = {.size = 0};
        append_text(&b, HEAD "\n");
        append_picture(&b, "-Y+X", coders[c]);
        for (size_t length = 0; length < b.size; length++)
            expect_bad_bytes(f, b.bytes, length);
    }
}

static void test_bombs_take_no_memory(void **state)
{
    static const char *const heads[] = {HEAD "\n-Y 40000 +X 40000\n", HEAD "\n-Y 16000 +X 16000\n",
                                        HEAD "\n+X 1 -Y 1000000\n\2\2\2\2\2\2\2\2"};
    fixture *f = *state;
    for (size_t i = 0; i < 3; i++) {
        f->largest = 0;
        expect_bad_bytes(f, heads[i], strlen(heads[i]));
        assert_true(f->largest < 100000);
    }
}

static void test_changed_bytes_do_no_harm(void **state)
{
    fixture *f = *state;
    buffer b = {.size = 0};
    append_text(&b, HEAD "EXPOSURE=1.5\n\n");
    append_picture(&b, "-X+Y", append_new);
    char path[512];
    snprintf(path, sizeof path, "%s", fixture_path(f, "good.hdr"));
    write_file(path, b.bytes, b.size);
    expect_no_harm_from_changes(f, path, 2000);
    expect_memory_failures(f, path);
    unlink(path);
}

/* Luminances by another decoder, from the data's own list. */
static void test_captured_maps_have_known_values(void **state)
{
    static const struct {
        const char *name;
        double greatest, mean;
    } maps[] = {{"environments/latlong/kloppenheim_05_1k.hdr", 79199.9, 1.5993},
                {"environments/latlong/aristea_wreck_puresky_1k.hdr", 125.254, 0.8417},
                {"environments/orientation-tests/spot1Lux.hdr", 26432, 0.050415}};
    fixture *f = *state;
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        const char *path = data_path(maps[i].name);
        if (path == NULL)
            skip();
        helio_image *image = read_image(f, path);
        double greatest = 0, sum = 0;
        size_t pixels = (size_t)image->width * image->height;
        for (size_t p = 0; p < pixels; p++) {
            const float *rgb = image->rgb + 3 * p;
            double luminance = 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
            greatest = luminance > greatest ? luminance : greatest;
            sum += luminance;
        }
        assert_int_equal(image->width, 1024);
        assert_int_equal(image->height, 512);
        assert_true(fabs(greatest / maps[i].greatest - 1) < 1e-5);
        assert_true(fabs(sum / (double)pixels / maps[i].mean - 1) < 1e-4);
        helio_image_destroy(f->context, image);
    }
}

static void test_odd_and_damaged_files_of_others(void **state)
{
    fixture *f = *state;
    const char *folder = data_path("malformed/hdr");
    if (folder == NULL)
        skip();
    assert_int_equal(read_folder(f, folder), 5); /* of eight: one bomb, one cut head, one of another kind */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_radiance_values_are_mantissa_plus_half),
        TEST(test_all_codings_and_orientations_agree),
        TEST(test_old_runs_longer_than_255),
        TEST(test_exposure_and_correction_are_divided_out),
        TEST(test_heads_may_have_carriage_returns),
        TEST(test_locale_does_not_matter),
        TEST(test_primaries_are_converted),
        TEST(test_xyz_becomes_rec709),
        TEST(test_damaged_heads_are_refused),
        TEST(test_truncated_pictures_are_refused),
        TEST(test_bombs_take_no_memory),
        TEST(test_changed_bytes_do_no_harm),
        TEST(test_captured_maps_have_known_values),
        TEST(test_odd_and_damaged_files_of_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
