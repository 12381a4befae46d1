/* SPDX-License-Identifier: MIT
 *
 * Layouts, PFM, PNG and JPEG, and how pictures are written. Radiance and OpenEXR have programs of their own. */
#include "image_support.h"

#include "image/colour.h"
#include "image/tonemap.h"

#include <errno.h>
#include <math.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#if HELIO_WITH_PNG
#include <png.h>
#endif
#if HELIO_WITH_JPEG
#include <jpeglib.h>
#endif

/* ---- layouts ---- */

static void test_layout_names_parse_back(void **state)
{
    (void)state;
    for (helio_layout layout = HELIO_LAYOUT_AUTO; layout <= HELIO_LAYOUT_MIRRORBALL; layout++) {
        helio_layout parsed = (helio_layout)99;
        assert_int_equal(helio_layout_parse(helio_layout_name(layout), &parsed), HELIO_OK);
        assert_int_equal(parsed, layout);
    }
    assert_string_equal(helio_layout_name((helio_layout)77), "unknown");
    helio_layout untouched = HELIO_LAYOUT_STRIP;
    assert_int_equal(helio_layout_parse("cross", &untouched), HELIO_ERR_ARGUMENT);
    assert_int_equal(untouched, HELIO_LAYOUT_STRIP);
    assert_non_null(strstr(helio_last_error(), "\"cross\""));
    assert_non_null(strstr(helio_last_error(),
                           "auto, latlong, cross-v, cross-h, faces, strip, strip-openexr, octahedral, equal-area, "
                           "angular or mirrorball"));
    assert_int_equal(helio_layout_parse(NULL, &untouched), HELIO_ERR_ARGUMENT);
}

static void test_layouts_are_guessed_from_the_shape(void **state)
{
    static const struct {
        uint32_t width, height;
        helio_layout hint, layout;
    } good[] = {
        {1024, 512, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_LATLONG},
        {1010, 500, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_LATLONG},
        {990, 500, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_LATLONG},
        {1, 1, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_LATLONG},
        {1, 1, HELIO_LAYOUT_STRIP, HELIO_LAYOUT_LATLONG},
        {1536, 256, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_STRIP},
        {256, 1536, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_STRIP},
        {256, 1536, HELIO_LAYOUT_STRIP_OPENEXR, HELIO_LAYOUT_STRIP_OPENEXR},
        {300, 200, HELIO_LAYOUT_LATLONG, HELIO_LAYOUT_LATLONG},
        {715827882, 4294967292u, HELIO_LAYOUT_AUTO, HELIO_LAYOUT_STRIP},
    };
    static const struct {
        uint32_t width, height;
        helio_layout hint;
    } bad[] = {{1011, 500, HELIO_LAYOUT_AUTO},          {512, 1024, HELIO_LAYOUT_AUTO},
               {1537, 256, HELIO_LAYOUT_AUTO},          {1024, 512, HELIO_LAYOUT_STRIP},
               {1536, 256, HELIO_LAYOUT_STRIP_OPENEXR}, {1024, 512, HELIO_LAYOUT_STRIP_OPENEXR}};
    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        helio_layout layout = (helio_layout)99;
        assert_int_equal(helio_layout_guess(good[i].width, good[i].height, good[i].hint, &layout), HELIO_OK);
        assert_int_equal(layout, good[i].layout);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        helio_layout layout = HELIO_LAYOUT_AUTO;
        assert_int_equal(helio_layout_guess(bad[i].width, bad[i].height, bad[i].hint, &layout), HELIO_ERR_DATA);
        assert_int_equal(layout, HELIO_LAYOUT_AUTO);
        assert_non_null(strstr(helio_last_error(), "latlong"));
        assert_non_null(strstr(helio_last_error(), "strip"));
    }
    helio_layout layout;
    assert_int_equal(helio_layout_guess(0, 1, HELIO_LAYOUT_AUTO, &layout), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_layout_guess(2, 1, (helio_layout)99, &layout), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_layout_guess(2, 1, HELIO_LAYOUT_AUTO, NULL), HELIO_ERR_ARGUMENT);
}

/* ---- what all kinds share ---- */

static void test_reading_checks_its_arguments(void **state)
{
    fixture *f = *state;
    helio_image *image = (helio_image *)f;
    assert_int_equal(helio_image_read(NULL, "x", NULL, &image), HELIO_ERR_ARGUMENT);
    assert_null(image);
    assert_int_equal(helio_image_read(f->context, NULL, NULL, &image), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_image_read(f->context, "x", NULL, NULL), HELIO_ERR_ARGUMENT);
    helio_image_destroy(f->context, NULL);
}

static void test_files_that_are_no_pictures(void **state)
{
    fixture *f = *state;
    expect_failure(f, fixture_path(f, "missing.exr"), HELIO_ERR_IO);
    expect_failure(f, f->directory, HELIO_ERR_IO);
    expect_bad_bytes(f, "", 0);
    expect_bad_bytes(f, "P", 1);
    expect_bad_bytes(f, "P6\n1 1\n255\nabc", 14);
    expect_bad_bytes(f, "II*\0picture", 11);
    const char *path = fixture_path(f, "pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    expect_failure(f, path, HELIO_ERR_IO);
    unlink(path);
}

static void test_pixel_limit_is_kept(void **state)
{
    fixture *f = *state;
    const char *path = fixture_path(f, "small.pfm");
    write_file(path, "Pf\n2 2\n-1\n0123012301230123", 26);
    helio_image *image;
    assert_int_equal(helio_image_read(f->context, path, &(helio_image_read_desc){.max_pixels = 3}, &image),
                     HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "2 x 2"));
    assert_int_equal(helio_image_read(f->context, path, &(helio_image_read_desc){.max_pixels = 4}, &image), HELIO_OK);
    helio_image_destroy(f->context, image);
    expect_memory_failures(f, path);
    unlink(path);
}

/* 8200 x 8200 pixels are more than any file may have unasked, but this one has as many bytes. */
static void test_large_files_may_have_many_pixels(void **state)
{
    static const char head[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8200 +X 8200\n";
    fixture *f = *state;
    const char *path = fixture_path(f, "large.hdr");
    write_file(path, head, sizeof head - 1);
    expect_failure(f, path, HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "where 67108864 in all are allowed"));
    assert_non_null(strstr(helio_last_error(), "max_pixels"));
    assert_int_equal(truncate(path, 8200L * 8200), 0); /* without taking room on the disk */
    f->allowed = 2;                                    /* the bytes and the picture, but not its pixels */
    expect_failure(f, path, HELIO_ERR_MEMORY);
    assert_non_null(strstr(helio_last_error(), "8200 x 8200"));
    f->allowed = SIZE_MAX;
    unlink(path);
}

/* ---- PFM ---- */

/* Head, then floats with their bytes in the order asked for. */
static const char *write_pfm(const fixture *f, const char *head, const float *values, size_t count, bool big_endian)
{
    unsigned char bytes[1024];
    size_t size = strlen(head);
    memcpy(bytes, head, size);
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], 4);
        for (int b = 0; b < 4; b++)
            bytes[size++] = (unsigned char)(bits >> 8 * (big_endian ? 3 - b : b));
    }
    const char *path = fixture_path(f, "test.pfm");
    write_file(path, bytes, size);
    return path;
}

static const float COLOURS[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12.5f};

static void expect_colours(fixture *f, const char *path, float scale)
{
    helio_image *image = read_image(f, path);
    unlink(path);
    assert_int_equal(image->width, 2);
    assert_int_equal(image->height, 2);
    for (int i = 0; i < 6; i++) {
        assert_float_equal(image->rgb[6 + i], scale * COLOURS[i], 0); /* the lowest row comes first */
        assert_float_equal(image->rgb[i], scale * COLOURS[6 + i], 0);
    }
    helio_image_destroy(f->context, image);
}

static void test_pfm_heads(void **state)
{
    fixture *f = *state;
    expect_colours(f, write_pfm(f, "PF\n2 2\n-1.0\n", COLOURS, 12, false), 1);
    expect_colours(f, write_pfm(f, "PF\n2 2\n1.0\n", COLOURS, 12, true), 1);
    expect_colours(f, write_pfm(f, "PF\n2 2\n-0.25\n", COLOURS, 12, false), 0.25f);
    expect_colours(f, write_pfm(f, "PF\n2 2\n4\n", COLOURS, 12, true), 4);
    expect_colours(f, write_pfm(f, "PF 2\n2\t-1 ", COLOURS, 12, false), 1);
    expect_colours(f, write_pfm(f, "PF\r\n2 2\r\n-1.0\r\n", COLOURS, 12, false), 1);
    /* The first byte of the pixels may look like white space. */
    float newline;
    memcpy(&newline, "\n\n\n\x40", 4);
    helio_image *image = read_image(f, write_pfm(f, "Pf\n1 1\n-1\r", &newline, 1, false));
    assert_memory_equal(image->rgb, &newline, 4);
    helio_image_destroy(f->context, image);
    unlink(fixture_path(f, "test.pfm"));
}

static void test_grey_pfm_becomes_rgb(void **state)
{
    fixture *f = *state;
    helio_image *image = read_image(f, write_pfm(f, "Pf\n3 1\n-1\n", COLOURS, 3, false));
    for (int i = 0; i < 9; i++)
        assert_float_equal(image->rgb[i], COLOURS[i / 3], 0);
    helio_image_destroy(f->context, image);
    unlink(fixture_path(f, "test.pfm"));
}

static void test_bad_pixels_are_counted_and_kept(void **state)
{
    const float values[18] = {NAN, 1, 1, 1, INFINITY, 1, 1, 1, -1e-9f, 0, 0, 0, 3e38f, 3e38f, 3e38f, NAN, -1, INFINITY};
    fixture *f = *state;
    helio_image *image = read_image(f, write_pfm(f, "PF\n6 1\n-1\n", values, 18, false));
    assert_int_equal(image->bad.nan, 2);
    assert_int_equal(image->bad.infinite, 2); /* 3e38 counts as infinite */
    assert_int_equal(image->bad.negative, 1);
    assert_memory_equal(image->rgb, values, sizeof values);
    helio_image_destroy(f->context, image);
    unlink(fixture_path(f, "test.pfm"));
}

static void test_damaged_pfm_is_refused(void **state)
{
    static const char *const heads[] = {"PF",
                                        "PFM",
                                        "PF\n",
                                        "PF\n2",
                                        "PF\n2 2",
                                        "PF\n2 2\n-1",
                                        "PF4 1 1 -1 ",
                                        "PF\n0 2\n-1 ",
                                        "PF\n2 0\n-1 ",
                                        "PF\n-2 2\n-1 ",
                                        "PF\n2 2\n0 1 ",
                                        "PF\n2 2\nnan 1 ",
                                        "PF\n2 2\ninf ",
                                        "PF\n2 2\n1e99 ",
                                        "PF\n2x 2\n-1 ",
                                        "PF\n1048577 1\n-1 ",
                                        "PF\n99999999999 1\n-1 ",
                                        "PF\n1000000 1000000\n-1 ",
                                        "PF\n16000 16000\n-1\n"};
    fixture *f = *state;
    f->largest = 0;
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
        expect_bad_bytes(f, heads[i], strlen(heads[i]));
    assert_true(f->largest < 1000);
    char path[512];
    snprintf(path, sizeof path, "%s", write_pfm(f, "PF\n2 2\n-1.0\n", COLOURS, 12, false));
    expect_bad_beginnings(f, path, 0);
    expect_no_harm_from_changes(f, path, 500);
    unlink(path);
}

/* ---- sRGB ---- */

static void test_srgb_curve(void **state)
{
    (void)state;
    assert_float_equal(srgb_decode(0), 0, 0);
    assert_float_equal(srgb_decode(1), 1, 0);
    assert_float_equal(srgb_decode(0.04045f), 0.04045f / 12.92f, 1e-8f);
    assert_float_equal(srgb_decode(0.5f), 0.21404114f, 1e-7f);
    assert_float_equal(srgb_decode(188 / 255.0f), 0.50288653f, 1e-6f);
    for (int i = 0; i < 256; i++)
        assert_int_equal(lroundf(255 * srgb_encode(srgb_decode((float)i / 255))), i);
}

/* ---- PNG ---- */

#if HELIO_WITH_PNG
typedef struct png_source {
    uint32_t width, height;
    int depth, type;
    bool interlaced;
    const unsigned char *rows; /* packed as libpng wants them, 16 bits with the high byte first */
    size_t row_bytes;
    int transparent; /* grey value of the tRNS chunk, -1 for none */
} png_source;

static void write_png(const char *path, const png_source *source)
{
    static png_color palette[3] = {{255, 0, 0}, {0, 128, 0}, {10, 20, 30}};
    png_structp library = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(library);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    png_init_io(library, stream);
    png_set_IHDR(library, info, source->width, source->height, source->depth, source->type,
                 source->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (source->type == PNG_COLOR_TYPE_PALETTE) {
        png_set_PLTE(library, info, palette, 3);
        png_set_tRNS(library, info, (png_byte[3]){255, 51, 0}, 3, NULL);
    }
    if (source->transparent >= 0)
        png_set_tRNS(library, info, NULL, 0, &(png_color_16){.gray = (png_uint_16)source->transparent});
    png_write_info(library, info);
    int passes = png_set_interlace_handling(library);
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t row = 0; row < source->height; row++)
            png_write_row(library, source->rows + row * source->row_bytes);
    png_write_end(library, NULL);
    png_destroy_write_struct(&library, &info);
    fclose(stream);
}

static helio_image *read_png(fixture *f, const png_source *source)
{
    const char *path = fixture_path(f, "test.png");
    write_png(path, source);
    helio_image *image = read_image(f, path);
    unlink(path);
    assert_int_equal(image->width, source->width);
    assert_int_equal(image->height, source->height);
    return image;
}

static void test_png_rgb_and_alpha_of_8_bits(void **state)
{
    fixture *f = *state;
    const unsigned char rgb[6] = {0, 128, 255, 1, 2, 3};
    helio_image *image = read_png(f, &(png_source){2, 1, 8, PNG_COLOR_TYPE_RGB, false, rgb, 6, -1});
    assert_null(image->alpha);
    for (int i = 0; i < 6; i++)
        assert_float_equal(image->rgb[i], srgb_decode((float)rgb[i] / 255), 0);
    helio_image_destroy(f->context, image);

    const unsigned char rgba[8] = {0, 128, 255, 51, 1, 2, 3, 255};
    image = read_png(f, &(png_source){1, 2, 8, PNG_COLOR_TYPE_RGB_ALPHA, false, rgba, 4, -1});
    for (int i = 0; i < 6; i++)
        assert_float_equal(image->rgb[i], srgb_decode((float)rgb[i] / 255), 0);
    assert_float_equal(image->alpha[0], 0.2f, 1e-7f);
    assert_float_equal(image->alpha[1], 1, 0);
    assert_true(image->is_encoded);
    assert_int_equal(bad_pixels(image), 0);
    helio_image_destroy(f->context, image);

    const char *path = fixture_path(f, "test.png");
    write_png(path, &(png_source){1, 2, 8, PNG_COLOR_TYPE_RGB_ALPHA, false, rgba, 4, -1});
    assert_int_equal(helio_image_read(f->context, path, &(helio_image_read_desc){.without_alpha = true}, &image), 0);
    unlink(path);
    assert_null(image->alpha);
    for (int i = 0; i < 6; i++)
        assert_float_equal(image->rgb[i], srgb_decode((float)rgb[i] / 255), 0);
    helio_image_destroy(f->context, image);
}

static void test_png_of_16_bits(void **state)
{
    fixture *f = *state;
    const unsigned char rows[8] = {0x80, 0x01, 0xff, 0xff, 0x00, 0x01, 0x33, 0x33};
    helio_image *image = read_png(f, &(png_source){1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, false, rows, 8, -1});
    assert_float_equal(image->rgb[0], srgb_decode(32769 / 65535.0f), 0);
    assert_float_equal(image->rgb[1], 1, 0);
    assert_float_equal(image->rgb[2], 1 / 65535.0f / 12.92f, 1e-9f);
    assert_float_equal(image->alpha[0], 0.2f, 1e-7f);
    helio_image_destroy(f->context, image);
}

static void test_png_palette_and_grey(void **state)
{
    fixture *f = *state;
    const unsigned char indices[2] = {0x12, 0x00}; /* 4 bits each: 1, 2, 0 */
    helio_image *image = read_png(f, &(png_source){3, 1, 4, PNG_COLOR_TYPE_PALETTE, false, indices, 2, -1});
    assert_float_equal(image->rgb[1], srgb_decode(128 / 255.0f), 0);
    assert_float_equal(image->rgb[5], srgb_decode(30 / 255.0f), 0);
    assert_float_equal(image->rgb[6], 1, 0);
    assert_float_equal(image->alpha[0], 0.2f, 1e-7f);
    assert_float_equal(image->alpha[1], 0, 0);
    assert_float_equal(image->alpha[2], 1, 0);
    helio_image_destroy(f->context, image);

    const unsigned char bits[1] = {0xa0}; /* 1 0 1 */
    image = read_png(f, &(png_source){3, 1, 1, PNG_COLOR_TYPE_GRAY, false, bits, 1, 0});
    for (int i = 0; i < 9; i++)
        assert_float_equal(image->rgb[i], (i / 3 == 1 ? 0 : 1), 0);
    assert_float_equal(image->alpha[0], 1, 0);
    assert_float_equal(image->alpha[1], 0, 0);
    helio_image_destroy(f->context, image);
}

static void fill_gradient(unsigned char *rows, size_t size)
{
    for (size_t i = 0; i < size; i++)
        rows[i] = (unsigned char)(i * 7 + i / 31);
}

static void test_interlaced_png_is_the_same(void **state)
{
    fixture *f = *state;
    unsigned char rows[19 * 3 * 23];
    fill_gradient(rows, sizeof rows);
    helio_image *plain = read_png(f, &(png_source){19, 23, 8, PNG_COLOR_TYPE_RGB, false, rows, 19 * 3, -1});
    helio_image *woven = read_png(f, &(png_source){19, 23, 8, PNG_COLOR_TYPE_RGB, true, rows, 19 * 3, -1});
    assert_memory_equal(plain->rgb, woven->rgb, sizeof(float) * 3 * 19 * 23);
    helio_image_destroy(f->context, plain);
    helio_image_destroy(f->context, woven);
}

static void test_damaged_png_is_refused(void **state)
{
    fixture *f = *state;
    unsigned char rows[32 * 3 * 32];
    fill_gradient(rows, sizeof rows);
    char path[512];
    snprintf(path, sizeof path, "%s", fixture_path(f, "good.png"));
    write_png(path, &(png_source){32, 32, 8, PNG_COLOR_TYPE_RGB, true, rows, 32 * 3, -1});
    expect_bad_beginnings(f, path, 0);
    expect_no_harm_from_changes(f, path, 1000);
    expect_memory_failures(f, path);
    unlink(path);
    /* A head that claims 16000 x 16000 pixels, with its right checksum, and nothing behind it. */
    f->largest = 0;
    const char bomb[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x3e\x80\0\0\x3e\x80\x8\2\0\0\0\xce\x1c\x48\x89\0\0\0\0IDAT";
    expect_bad_bytes(f, bomb, sizeof bomb - 1);
    assert_true(f->largest < 1000);
}
#endif

/* ---- JPEG ---- */

#if HELIO_WITH_JPEG
static void write_jpeg(const char *path, const JSAMPLE *samples, uint32_t size, int components, J_COLOR_SPACE space,
                       bool progressive)
{
    struct jpeg_compress_struct library;
    struct jpeg_error_mgr errors;
    library.err = jpeg_std_error(&errors);
    jpeg_create_compress(&library);
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    jpeg_stdio_dest(&library, stream);
    library.image_width = library.image_height = size;
    library.input_components = components;
    library.in_color_space = space;
    jpeg_set_defaults(&library);
    jpeg_set_quality(&library, 100, TRUE);
    if (progressive)
        jpeg_simple_progression(&library);
    jpeg_start_compress(&library, TRUE);
    for (uint32_t row = 0; row < size; row++) {
        JSAMPROW line = (JSAMPROW)(samples + row * size * (uint32_t)components);
        jpeg_write_scanlines(&library, &line, 1);
    }
    jpeg_finish_compress(&library);
    jpeg_destroy_compress(&library);
    fclose(stream);
}

/* One colour, which JPEG keeps but for rounding. */
static void fill_samples(JSAMPLE *samples, size_t pixels, const JSAMPLE *colour, size_t components)
{
    for (size_t i = 0; i < pixels * components; i++)
        samples[i] = colour[i % components];
}

static void test_jpeg_colour_and_grey(void **state)
{
    const JSAMPLE colour[3] = {200, 100, 50};
    fixture *f = *state;
    for (int variant = 0; variant < 3; variant++) {
        bool grey = variant == 2;
        JSAMPLE samples[16 * 16 * 3];
        fill_samples(samples, 256, colour, grey ? 1 : 3);
        const char *path = fixture_path(f, "test.jpg");
        write_jpeg(path, samples, 16, grey ? 1 : 3, grey ? JCS_GRAYSCALE : JCS_RGB, variant == 1);
        helio_image *image = read_image(f, path);
        unlink(path);
        assert_int_equal(image->width, 16);
        assert_int_equal(image->height, 16);
        assert_null(image->alpha);
        for (int i = 0; i < 3 * 256; i++)
            assert_float_equal(255 * srgb_encode(image->rgb[i]), colour[grey ? 0 : i % 3], 1.6f);
        helio_image_destroy(f->context, image);
    }
}

static void test_cmyk_jpeg_is_refused(void **state)
{
    fixture *f = *state;
    JSAMPLE samples[8 * 8 * 4] = {0};
    const char *path = fixture_path(f, "test.jpg");
    write_jpeg(path, samples, 8, 4, JCS_CMYK, false);
    expect_failure(f, path, HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "CMYK"));
    unlink(path);
}

/* Scans that add nothing take a few bytes each, and time for all pixels. */
static void test_jpeg_of_endless_scans_is_refused(void **state)
{
    fixture *f = *state;
    JSAMPLE samples[16 * 16 * 3] = {0};
    char path[512];
    snprintf(path, sizeof path, "%s", fixture_path(f, "scans.jpg"));
    write_jpeg(path, samples, 16, 3, JCS_RGB, true);
    size_t size, last = 0;
    unsigned char *bytes = read_file(path, &size);
    for (size_t i = 0; i + 1 < size; i++)
        if (bytes[i] == 0xff && bytes[i + 1] == 0xda)
            last = i;
    assert_true(last > 0);
    FILE *stream = fopen(path, "wb");
    fwrite(bytes, 1, last, stream);
    for (int i = 0; i < 10000; i++)
        fwrite(bytes + last, 1, size - 2 - last, stream);
    fwrite(bytes + size - 2, 1, 2, stream);
    fclose(stream);
    free(bytes);
    expect_failure(f, path, HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "scans"));
    unlink(path);
}

static void test_damaged_jpeg_is_refused(void **state)
{
    fixture *f = *state;
    JSAMPLE samples[32 * 32 * 3];
    for (size_t i = 0; i < sizeof samples; i++)
        samples[i] = (JSAMPLE)(i * i >> 6);
    char path[512];
    snprintf(path, sizeof path, "%s", fixture_path(f, "good.jpg"));
    for (int progressive = 0; progressive < 2; progressive++) {
        write_jpeg(path, samples, 32, 3, JCS_RGB, progressive);
        expect_bad_beginnings(f, path, 0);
        expect_no_harm_from_changes(f, path, 500);
        expect_memory_failures(f, path);
    }
    /* The same file, with 65500 x 65500 in its frame header. */
    size_t size;
    unsigned char *bytes = read_file(path, &size);
    unlink(path);
    size_t frame = 2;
    while (bytes[frame + 1] != 0xc2)
        frame += 2 + (size_t)(bytes[frame + 2] << 8 | bytes[frame + 3]);
    memcpy(bytes + frame + 5, "\xff\xdc\xff\xdc", 4);
    f->largest = 0;
    expect_bad_bytes(f, bytes, size);
    assert_true(f->largest < 100000);
    free(bytes);
}
#endif

/* ---- writing ---- */

#if HELIO_WITH_OPENEXR
#define EXR_STATUS HELIO_OK
#else
#define EXR_STATUS HELIO_ERR_UNSUPPORTED
#endif
#if HELIO_WITH_PNG
#define PNG_STATUS HELIO_OK
#else
#define PNG_STATUS HELIO_ERR_UNSUPPORTED
#endif

static void test_paths_to_write_are_checked(void **state)
{
    fixture *f = *state;
    const float rgba[4] = {0};
    helio_picture picture = {.width = 1, .height = 1, .rgba = rgba};
    assert_int_equal(helio_picture_check_path("a.pfm"), HELIO_OK);
    assert_int_equal(helio_picture_check_path("A.PFM"), HELIO_OK);
    assert_int_equal(helio_picture_check_path("a.exr"), EXR_STATUS);
    assert_int_equal(helio_picture_check_path("a.png"), PNG_STATUS);
    static const char *const bad[] = {"a", "", "pfm", "a.jpg", "a.pfm/b"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(helio_picture_check_path(bad[i]), HELIO_ERR_ARGUMENT);
        assert_int_equal(helio_picture_write(f->context, bad[i], &picture, NULL), HELIO_ERR_ARGUMENT);
    }
    assert_int_equal(helio_picture_check_path(NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_picture_write(f->context, NULL, &picture, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_picture_write(f->context, "a.pfm", NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_picture_write(NULL, "a.pfm", &picture, NULL), HELIO_ERR_ARGUMENT);
    helio_picture_write_desc desc = {.exposure = NAN};
    assert_int_equal(helio_picture_write(f->context, "a.pfm", &picture, &desc), HELIO_ERR_ARGUMENT);
    desc = (helio_picture_write_desc){.tonemap = (helio_tonemap)7};
    assert_int_equal(helio_picture_write(f->context, "a.pfm", &picture, &desc), HELIO_ERR_ARGUMENT);
    picture.width = 0;
    assert_int_equal(helio_picture_write(f->context, "a.pfm", &picture, NULL), HELIO_ERR_ARGUMENT);
    picture = (helio_picture){.width = 1, .height = 1};
    assert_int_equal(helio_picture_write(f->context, "a.pfm", &picture, NULL), HELIO_ERR_ARGUMENT);
}

static void test_pfm_round_trip_keeps_every_bit(void **state)
{
    enum { WIDTH = 5, HEIGHT = 3 };
    fixture *f = *state;
    float rgba[4 * WIDTH * HEIGHT];
    for (size_t i = 0; i < 4 * WIDTH * HEIGHT; i++)
        rgba[i] = (float)i / 7;
    rgba[4] = NAN;
    rgba[5] = INFINITY;
    rgba[6] = -0.0f;
    rgba[8] = -3e38f;
    rgba[9] = 1e-45f;
    const char *path = fixture_path(f, "test.pfm");
    helio_picture picture = {.width = WIDTH, .height = HEIGHT, .rgba = rgba};
    assert_int_equal(helio_picture_write(f->context, path, &picture, NULL), HELIO_OK);
    helio_image *image = read_image(f, path);
    unlink(path);
    assert_int_equal(image->width, WIDTH);
    assert_int_equal(image->height, HEIGHT);
    assert_int_equal(bad_pixels(image), 2);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_memory_equal(image->rgb + 3 * i, rgba + 4 * i, 3 * sizeof(float));
    helio_image_destroy(f->context, image);
}

static void test_tonemap_names_parse_back(void **state)
{
    (void)state;
    for (helio_tonemap tonemap = HELIO_TONEMAP_CLIP; tonemap <= HELIO_TONEMAP_REINHARD; tonemap++) {
        helio_tonemap parsed = (helio_tonemap)99;
        assert_int_equal(helio_tonemap_parse(helio_tonemap_name(tonemap), &parsed), HELIO_OK);
        assert_int_equal(parsed, tonemap);
    }
    helio_tonemap parsed;
    assert_int_equal(helio_tonemap_parse("filmic", &parsed), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "clip or reinhard"));
    assert_string_equal(helio_tonemap_name((helio_tonemap)9), "unknown");
}

#if HELIO_WITH_PNG
/* The bytes of a picture of one pixel, alpha included if desc->alpha. */
static void write_and_read(fixture *f, const helio_picture *picture, const helio_picture_write_desc *desc,
                           unsigned char bytes[4])
{
    const char *path = fixture_path(f, "test.png");
    assert_int_equal(helio_picture_write(f->context, path, picture, desc), HELIO_OK);
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&image, path));
    assert_int_equal(image.format, desc->alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB);
    assert_true(png_image_finish_read(&image, NULL, bytes, 0, NULL));
    unlink(path);
}

/* What that pixel becomes, whoever tone-maps it. */
static void tonemapped(fixture *f, const float rgba[4], const helio_picture_write_desc *desc, unsigned char bytes[4])
{
    uint8_t shown[4];
    unsigned char again[4] = {0};
    write_and_read(f, &(helio_picture){.width = 1, .height = 1, .rgba = rgba}, desc, bytes);
    tonemap_shown(rgba, desc, shown);
    write_and_read(f, &(helio_picture){.width = 1, .height = 1, .shown = shown}, desc, again);
    assert_memory_equal(bytes, again, desc->alpha ? 4 : 3);
    assert_true(desc->alpha || shown[3] == 255);
}

static void expect_bytes(fixture *f, const float rgba[4], helio_picture_write_desc desc, const char *expected)
{
    unsigned char bytes[4] = {0};
    tonemapped(f, rgba, &desc, bytes);
    char text[32];
    snprintf(text, sizeof text, desc.alpha ? "%d %d %d %d" : "%d %d %d", bytes[0], bytes[1], bytes[2], bytes[3]);
    assert_string_equal(text, expected);
}

static void test_tonemapped_values(void **state)
{
    fixture *f = *state;
    const helio_picture_write_desc plain = {0};
    expect_bytes(f, (float[]){0, 0.5f, 1, 1}, plain, "0 188 255");
    expect_bytes(f, (float[]){0.2158605f, 0.18f, 0.001f, 1}, plain, "128 118 3");
    expect_bytes(f, (float[]){NAN, INFINITY, -1, 1}, plain, "0 255 0");
    expect_bytes(f, (float[]){4, 1, -INFINITY, NAN}, plain, "255 255 0");
    expect_bytes(f, (float[]){0.25f, 0.125f, 0, 1}, (helio_picture_write_desc){.exposure = 1}, "188 137 0");
    expect_bytes(f, (float[]){1, 2, 4, 1}, (helio_picture_write_desc){.exposure = -1}, "188 255 255");
    /* Reinhard divides all channels by 1 + luminance. */
    helio_picture_write_desc reinhard = {.tonemap = HELIO_TONEMAP_REINHARD};
    expect_bytes(f, (float[]){1, 1, 1, 1}, reinhard, "188 188 188");
    expect_bytes(f, (float[]){1, 0, 0, 1}, reinhard, "234 0 0");
    expect_bytes(f, (float[]){INFINITY, INFINITY, INFINITY, 1}, reinhard, "255 255 255");
    /* Without alpha, over black; with it, straight. */
    expect_bytes(f, (float[]){0.25f, 0.125f, 0, 0.5f}, plain, "137 99 0");
    helio_picture_write_desc alpha = {.alpha = true};
    expect_bytes(f, (float[]){0.25f, 0.125f, 0, 0.5f}, alpha, "188 137 0 128");
    expect_bytes(f, (float[]){0.25f, 0.125f, 0, 0}, alpha, "0 0 0 0");
    expect_bytes(f, (float[]){0.25f, 0.125f, 0, NAN}, alpha, "0 0 0 0");
    expect_bytes(f, (float[]){1, 1, 1, 7}, alpha, "255 255 255 255");
}

static void test_png_round_trip(void **state)
{
    enum { WIDTH = 16, HEIGHT = 16 };
    fixture *f = *state;
    float rgba[4 * WIDTH * HEIGHT];
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        for (size_t c = 0; c < 4; c++)
            rgba[4 * i + c] = c == 3 ? 1 : srgb_decode((float)((i + 50 * c) % 256) / 255);
    const char *path = fixture_path(f, "test.png");
    helio_picture picture = {.width = WIDTH, .height = HEIGHT, .rgba = rgba};
    assert_int_equal(helio_picture_write(f->context, path, &picture, NULL), HELIO_OK);
    helio_image *image = read_image(f, path);
    unlink(path);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_memory_equal(image->rgb + 3 * i, rgba + 4 * i, 3 * sizeof(float));
    helio_image_destroy(f->context, image);
}
#endif

static const char *const WRITABLE[] = {
    "pfm",
#if HELIO_WITH_OPENEXR
    "exr",
#endif
#if HELIO_WITH_PNG
    "png",
#endif
};
enum { WRITABLE_COUNT = sizeof WRITABLE / sizeof *WRITABLE };

static unsigned count_files(const char *directory)
{
    unsigned count = 0;
    DIR *stream = opendir(directory);
    for (struct dirent *entry; (entry = readdir(stream)) != NULL;)
        count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
    closedir(stream);
    return count;
}

/* Noise, so that no compression makes the file small. */
static float *make_noise(size_t floats)
{
    float *noise = malloc(floats * sizeof *noise);
    uint32_t random = 7;
    for (size_t i = 0; i < floats; i++) {
        random = random * 1664525u + 1013904223u;
        noise[i] = (float)(random >> 8) / (1 << 24);
    }
    return noise;
}

/* The limit on the size of files stands in for a full disk: writes fail in the same places. */
static void test_full_disk_leaves_the_old_file(void **state)
{
    fixture *f = *state;
    struct rlimit before, limit;
    float *noise = make_noise(256 * 256 * 4);
    helio_picture picture = {.width = 256, .height = 256, .rgba = noise};
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    for (int i = 0; i < WRITABLE_COUNT; i++)
        for (rlim_t bytes = 1; bytes < 200000; bytes = bytes * 40 + 9) {
            char name[16];
            snprintf(name, sizeof name, "test.%s", WRITABLE[i]);
            const char *path = fixture_path(f, name);
            write_file(path, "old", 3);
            limit = before;
            limit.rlim_cur = bytes;
            setrlimit(RLIMIT_FSIZE, &limit);
            helio_status status = helio_picture_write(f->context, path, &picture, NULL);
            setrlimit(RLIMIT_FSIZE, &before);
            assert_int_equal(status, HELIO_ERR_IO);
            assert_non_null(strstr(helio_last_error(), path));
            size_t size;
            unsigned char *old = read_file(path, &size);
            assert_int_equal(size, 3);
            free(old);
            unlink(path);
            assert_int_equal(count_files(f->directory), 0);
        }
    signal(SIGXFSZ, SIG_DFL);
    free(noise);
}

static void test_places_that_cannot_be_written(void **state)
{
    fixture *f = *state;
    const float rgba[4] = {0};
    helio_picture picture = {.width = 1, .height = 1, .rgba = rgba};
    for (int i = 0; i < WRITABLE_COUNT; i++) {
        char name[32];
        snprintf(name, sizeof name, "missing/a.%s", WRITABLE[i]);
        assert_int_equal(helio_picture_write(f->context, fixture_path(f, name), &picture, NULL), HELIO_ERR_IO);
        assert_non_null(strstr(helio_last_error(), name));
        snprintf(name, sizeof name, "folder.%s", WRITABLE[i]);
        const char *folder = fixture_path(f, name);
        assert_int_equal(mkdir(folder, 0700), 0);
        assert_int_equal(helio_picture_write(f->context, folder, &picture, NULL), HELIO_ERR_IO);
        assert_int_equal(rmdir(folder), 0);
    }
    assert_int_equal(count_files(f->directory), 0);
}

static void test_writing_replaces_and_survives_lack_of_memory(void **state)
{
    fixture *f = *state;
    float *noise = make_noise(8 * 8 * 4);
    helio_picture picture = {.width = 8, .height = 8, .rgba = noise};
    for (int i = 0; i < WRITABLE_COUNT; i++) {
        char name[16];
        snprintf(name, sizeof name, "test.%s", WRITABLE[i]);
        const char *path = fixture_path(f, name);
        write_file(path, "old", 3);
        helio_status status = HELIO_ERR_MEMORY;
        for (size_t allowed = 0; status != HELIO_OK; allowed++) {
            size_t blocks = f->blocks;
            f->allowed = allowed;
            status = helio_picture_write(f->context, path, &picture, NULL);
            f->allowed = SIZE_MAX;
            assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
            assert_int_equal(f->blocks, blocks);
            assert_int_equal(count_files(f->directory), 1);
        }
        helio_image *image = read_image(f, path);
        assert_int_equal(image->width, 8);
        helio_image_destroy(f->context, image);
        unlink(path);
    }
    free(noise);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_layout_names_parse_back),
        TEST(test_layouts_are_guessed_from_the_shape),
        TEST(test_reading_checks_its_arguments),
        TEST(test_files_that_are_no_pictures),
        TEST(test_pixel_limit_is_kept),
        TEST(test_large_files_may_have_many_pixels),
        TEST(test_pfm_heads),
        TEST(test_grey_pfm_becomes_rgb),
        TEST(test_bad_pixels_are_counted_and_kept),
        TEST(test_damaged_pfm_is_refused),
        TEST(test_srgb_curve),
#if HELIO_WITH_PNG
        TEST(test_png_rgb_and_alpha_of_8_bits),
        TEST(test_png_of_16_bits),
        TEST(test_png_palette_and_grey),
        TEST(test_interlaced_png_is_the_same),
        TEST(test_damaged_png_is_refused),
        TEST(test_tonemapped_values),
        TEST(test_png_round_trip),
#endif
#if HELIO_WITH_JPEG
        TEST(test_jpeg_colour_and_grey),
        TEST(test_cmyk_jpeg_is_refused),
        TEST(test_jpeg_of_endless_scans_is_refused),
        TEST(test_damaged_jpeg_is_refused),
#endif
        TEST(test_paths_to_write_are_checked),
        TEST(test_pfm_round_trip_keeps_every_bit),
        TEST(test_tonemap_names_parse_back),
        TEST(test_full_disk_leaves_the_old_file),
        TEST(test_places_that_cannot_be_written),
        TEST(test_writing_replaces_and_survives_lack_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
