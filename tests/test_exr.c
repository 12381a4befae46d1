/* SPDX-License-Identifier: MIT
 *
 * OpenEXR. Files come from the library's own writers: OpenEXRCore for most, and its C++ side (through the C interface)
 * for what the core of version 3.1 cannot write. */
#include "image_support.h"

#include <float.h>
#include <math.h>

#include <ImfCRgbaFile.h>
#include <openexr.h>

enum { WIDTH = 37, HEIGHT = 21, PIXELS = WIDTH * HEIGHT, TILE = 16, CHANNEL_LIMIT = 8 };

enum { EVEN_WIDTH = 36, EVEN_HEIGHT = 20 }; /* where channels have half the size */

typedef struct exr_channel {
    const char *name;
    exr_pixel_type_t type;
    const void *pixels; /* [height][width] in that type, or half of each */
    bool halved;        /* one value for 2 x 2 pixels; scan lines only */
} exr_channel;

typedef struct exr_source {
    exr_channel channels[CHANNEL_LIMIT]; /* up to the first without a name */
    exr_compression_t compression;
    bool tiled;
    exr_attr_box2i_t data, display; /* both 0: the usual size at (0, 0) */
    const exr_attr_chromaticities_t *chromaticities;
    int envmap;       /* the attribute's value + 1 */
    bool second_part; /* behind a part that only has a channel Z */
} exr_source;

#define BOX(x0, y0, x1, y1)                                                                                            \
    {                                                                                                                  \
        {.arr = {x0, y0}},                                                                                             \
        {                                                                                                              \
            .arr = { x1, y1 }                                                                                          \
        }                                                                                                              \
    }

/* ---- writing ---- */

static int type_bytes(exr_pixel_type_t type)
{
    return type == EXR_PIXEL_HALF ? 2 : 4;
}

static void write_chunk(exr_context_t library, int part, const exr_source *source, const exr_chunk_info_t *chunk,
                        int column, int row, int width)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    assert_int_equal(exr_encoding_initialize(library, part, chunk, &pipeline), 0);
    for (int i = 0; i < pipeline.channel_count; i++)
        for (const exr_channel *c = source->channels; c->name != NULL; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[i];
            if (strcmp(c->name, channel->channel_name) != 0)
                continue;
            int bytes = type_bytes(c->type), step = c->halved ? 2 : 1;
            channel->user_bytes_per_element = (int16_t)bytes;
            channel->user_data_type = (uint16_t)c->type;
            channel->user_pixel_stride = bytes;
            channel->user_line_stride = width / step * bytes;
            channel->encode_from_ptr = (const uint8_t *)c->pixels + (row / step * (width / step) + column) * bytes;
        }
    assert_int_equal(exr_encoding_choose_default_routines(library, part, &pipeline), 0);
    assert_int_equal(exr_encoding_run(library, part, &pipeline), 0);
    exr_encoding_destroy(library, &pipeline);
}

static void write_chunks(exr_context_t library, int part, const exr_source *source, exr_attr_box2i_t data)
{
    int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1, lines = 0;
    exr_chunk_info_t chunk;
    if (source->tiled) {
        for (int y = 0; y * TILE < height; y++)
            for (int x = 0; x * TILE < width; x++) {
                assert_int_equal(exr_write_tile_chunk_info(library, part, x, y, 0, 0, &chunk), 0);
                write_chunk(library, part, source, &chunk, x * TILE, y * TILE, width);
            }
        return;
    }
    assert_int_equal(exr_get_scanlines_per_chunk(library, part, &lines), 0);
    for (int row = 0; row < height; row += lines) {
        assert_int_equal(exr_write_scanline_chunk_info(library, part, data.min.y + row, &chunk), 0);
        write_chunk(library, part, source, &chunk, 0, row, width);
    }
}

static int add_part(exr_context_t library, const char *name, const exr_source *source, exr_attr_box2i_t data,
                    exr_attr_box2i_t display)
{
    int part;
    exr_attr_v2f_t centre = {.arr = {0, 0}};
    assert_int_equal(exr_add_part(library, name, source->tiled ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr(library, part, &display, &data, 1, &centre, 1,
                                                  EXR_LINEORDER_INCREASING_Y, source->compression),
                     0);
    if (source->tiled)
        assert_int_equal(exr_set_tile_descriptor(library, part, TILE, TILE, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN),
                         0);
    for (const exr_channel *c = source->channels; c->name != NULL; c++) {
        int step = c->halved ? 2 : 1;
        assert_int_equal(exr_add_channel(library, part, c->name, c->type, EXR_PERCEPTUALLY_LOGARITHMIC, step, step), 0);
    }
    if (source->chromaticities != NULL)
        assert_int_equal(exr_attr_set_chromaticities(library, part, "chromaticities", source->chromaticities), 0);
    if (source->envmap != 0)
        assert_int_equal(exr_attr_set_envmap(library, part, "envmap", (exr_envmap_t)(source->envmap - 1)), 0);
    return part;
}

static const char *write_exr(const fixture *f, const exr_source *source)
{
    const exr_attr_box2i_t usual = BOX(0, 0, WIDTH - 1, HEIGHT - 1);
    const exr_source depth = {.channels = {{"Z", EXR_PIXEL_FLOAT, source->channels[0].pixels, false}}};
    bool has_windows = source->data.max.x != 0 || source->data.max.y != 0;
    exr_attr_box2i_t data = has_windows ? source->data : usual, display = has_windows ? source->display : usual;
    const char *path = fixture_path(f, "test.exr");
    exr_context_t library;
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    assert_int_equal(exr_start_write(&library, path, EXR_WRITE_FILE_DIRECTLY, &initializer), 0);
    if (source->second_part)
        add_part(library, "depth", &depth, data, display);
    int part = add_part(library, source->second_part ? "colour" : NULL, source, data, display);
    assert_int_equal(exr_write_header(library), 0);
    if (source->second_part)
        write_chunks(library, 0, &depth, data);
    write_chunks(library, part, source, data);
    assert_int_equal(exr_finish(&library), 0);
    return path;
}

static helio_image *read_source(fixture *f, const exr_source *source)
{
    const char *path = write_exr(f, source);
    helio_image *image = read_image(f, path);
    unlink(path);
    return image;
}

/* Smooth, all different, half floats as they are. */
static void make_planes(float planes[4][PIXELS], ImfHalf halves[4][PIXELS])
{
    for (int c = 0; c < 4; c++) {
        for (int i = 0; i < PIXELS; i++) {
            ImfFloatToHalf((float)(i % WIDTH + 2 * (i / WIDTH) + 30 * c + 8) / 16, &halves[c][i]);
            planes[c][i] = ImfHalfToFloat(halves[c][i]);
        }
    }
}

static void expect_planes(const helio_image *image, float planes[4][PIXELS], float tolerance)
{
    assert_int_equal(image->width, WIDTH);
    assert_int_equal(image->height, HEIGHT);
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 3; c++)
            assert_float_equal(image->rgb[3 * i + c], planes[c][i], tolerance * planes[c][i]);
        if (image->alpha != NULL)
            assert_float_equal(image->alpha[i], planes[3][i], tolerance * planes[3][i]);
    }
}

/* ---- compressions and types ---- */

static void test_all_compressions_of_half_and_float(void **state)
{
    static const struct {
        exr_compression_t compression;
        float half_loss, float_loss; /* relative */
    } compressions[] = {{EXR_COMPRESSION_NONE, 0, 0},    {EXR_COMPRESSION_RLE, 0, 0},
                        {EXR_COMPRESSION_ZIPS, 0, 0},    {EXR_COMPRESSION_ZIP, 0, 0},
                        {EXR_COMPRESSION_PIZ, 0, 0},     {EXR_COMPRESSION_PXR24, 0, 1.0f / 65536},
                        {EXR_COMPRESSION_B44, 0.05f, 0}, {EXR_COMPRESSION_B44A, 0.05f, 0}};
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    for (size_t i = 0; i < sizeof compressions / sizeof *compressions; i++)
        for (int variant = 0; variant < 4; variant++) {
            bool half = variant & 1, tiled = variant & 2;
            if (compressions[i].half_loss > 0 && half && tiled)
                continue; /* the core of 3.1 writes small tiles of B44 that no library reads */
            exr_pixel_type_t type = half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
            exr_source source = {.compression = compressions[i].compression, .tiled = tiled};
            static const char *const names[] = {"R", "G", "B", "A"};
            for (int c = 0; c < 4; c++)
                source.channels[c] =
                    (exr_channel){names[c], type, half ? (const void *)halves[c] : (const void *)planes[c], false};
            helio_image *image = read_source(f, &source);
            assert_non_null(image->alpha);
            expect_planes(image, planes, half ? compressions[i].half_loss : compressions[i].float_loss);
            assert_int_equal(image->layout, HELIO_LAYOUT_AUTO);
            assert_int_equal(bad_pixels(image), 0);
            helio_image_destroy(f->context, image);
        }
    assert_int_equal(f->warnings, 0);
}

static void test_mixed_types_and_other_channels(void **state)
{
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    static uint32_t integers[PIXELS];
    make_planes(planes, halves);
    for (int i = 0; i < PIXELS; i++)
        planes[2][i] = (float)(integers[i] = (uint32_t)i * 3);
    const exr_source source = {.channels = {{"Z", EXR_PIXEL_FLOAT, planes[3], false},
                                            {"B", EXR_PIXEL_UINT, integers, false},
                                            {"diffuse.R", EXR_PIXEL_HALF, halves[3], false},
                                            {"R", EXR_PIXEL_HALF, halves[0], false},
                                            {"G", EXR_PIXEL_FLOAT, planes[1], false}},
                               .compression = EXR_COMPRESSION_ZIP};
    helio_image *image = read_source(f, &source);
    assert_null(image->alpha);
    expect_planes(image, planes, 0);
    helio_image_destroy(f->context, image);
}

/* ---- channels ---- */

static void test_grey_and_layers(void **state)
{
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    const exr_source layer = {.channels = {{"a.X", EXR_PIXEL_FLOAT, planes[3], false},
                                           {"b.A", EXR_PIXEL_FLOAT, planes[3], false},
                                           {"b.R", EXR_PIXEL_FLOAT, planes[0], false},
                                           {"b.G", EXR_PIXEL_FLOAT, planes[1], false},
                                           {"b.B", EXR_PIXEL_FLOAT, planes[2], false}},
                              .compression = EXR_COMPRESSION_PIZ};
    helio_image *image = read_source(f, &layer);
    assert_non_null(image->alpha);
    expect_planes(image, planes, 0);
    helio_image_destroy(f->context, image);

    const exr_source grey = {
        .channels = {{"Y", EXR_PIXEL_HALF, halves[0], false}, {"A", EXR_PIXEL_HALF, halves[3], false}},
        .compression = EXR_COMPRESSION_RLE};
    memcpy(planes[1], planes[0], sizeof planes[0]);
    memcpy(planes[2], planes[0], sizeof planes[0]);
    image = read_source(f, &grey);
    expect_planes(image, planes, 0);
    assert_non_null(image->alpha);
    helio_image_destroy(f->context, image);
}

/* OpenEXRCore 3.1.5 would write such channels to a null pointer by itself. */
static void test_unwanted_subsampled_channels_are_skipped(void **state)
{
    fixture *f = *state;
    static ImfHalf grey[EVEN_WIDTH * EVEN_HEIGHT], quarter[EVEN_WIDTH * EVEN_HEIGHT / 4];
    for (int i = 0; i < EVEN_WIDTH * EVEN_HEIGHT; i++)
        ImfFloatToHalf((float)i, &grey[i]);
    exr_source source = {.channels = {{"Y", EXR_PIXEL_HALF, grey, false},
                                      {"BY", EXR_PIXEL_HALF, quarter, true},
                                      {"Z", EXR_PIXEL_HALF, quarter, true}},
                         .data = BOX(0, 0, EVEN_WIDTH - 1, EVEN_HEIGHT - 1),
                         .display = BOX(0, 0, EVEN_WIDTH - 1, EVEN_HEIGHT - 1)};
    for (source.compression = EXR_COMPRESSION_NONE; source.compression <= EXR_COMPRESSION_PIZ; source.compression++) {
        helio_image *image = read_source(f, &source);
        for (int i = 0; i < 3 * EVEN_WIDTH * EVEN_HEIGHT; i++)
            assert_float_equal(image->rgb[i], ImfHalfToFloat(grey[i / 3]), 0);
        helio_image_destroy(f->context, image);
    }
}

static void test_first_part_with_colours_is_read(void **state)
{
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    const exr_source source = {.channels = {{"R", EXR_PIXEL_FLOAT, planes[0], false},
                                            {"G", EXR_PIXEL_FLOAT, planes[1], false},
                                            {"B", EXR_PIXEL_FLOAT, planes[2], false}},
                               .compression = EXR_COMPRESSION_ZIPS,
                               .second_part = true};
    helio_image *image = read_source(f, &source);
    expect_planes(image, planes, 0);
    helio_image_destroy(f->context, image);
}

static void test_missing_channels_are_listed(void **state)
{
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    const exr_source source = {.channels = {{"R", EXR_PIXEL_FLOAT, planes[0], false},
                                            {"G", EXR_PIXEL_FLOAT, planes[1], false},
                                            {"depth.Z", EXR_PIXEL_FLOAT, planes[2], false}}};
    const char *path = write_exr(f, &source);
    expect_failure(f, path, HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "it has: G, R, depth.Z"));
    unlink(path);
}

/* ---- windows ---- */

static void test_display_window_crops_and_frames(void **state)
{
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    exr_source source = {.channels = {{"R", EXR_PIXEL_FLOAT, planes[0], false},
                                      {"G", EXR_PIXEL_FLOAT, planes[1], false},
                                      {"B", EXR_PIXEL_FLOAT, planes[2], false},
                                      {"A", EXR_PIXEL_FLOAT, planes[3], false}},
                         .compression = EXR_COMPRESSION_ZIP,
                         .data = BOX(-5, -7, WIDTH - 6, HEIGHT - 8),
                         .display = BOX(-10, 0, 19, 99)};
    helio_image *image = read_source(f, &source);
    assert_int_equal(image->width, 30);
    assert_int_equal(image->height, 100);
    for (int row = 0; row < 100; row++)
        for (int column = 0; column < 30; column++) {
            bool inside = column >= 5 && row < HEIGHT - 7;
            int pixel = (row + 7) * WIDTH + column - 5;
            const float *rgb = image->rgb + 3 * (row * 30 + column);
            for (int c = 0; c < 3; c++)
                assert_float_equal(rgb[c], (inside ? planes[c][pixel] : 0), 0);
            assert_float_equal(image->alpha[row * 30 + column], (inside ? planes[3][pixel] : 0), 0);
        }
    helio_image_destroy(f->context, image);

    /* An environment map is its data window. */
    source.envmap = EXR_ENVMAP_LATLONG + 1;
    image = read_source(f, &source);
    expect_planes(image, planes, 0);
    assert_int_equal(image->layout, HELIO_LAYOUT_LATLONG);
    helio_image_destroy(f->context, image);
    source.envmap = EXR_ENVMAP_CUBE + 1;
    image = read_source(f, &source);
    assert_int_equal(image->layout, HELIO_LAYOUT_STRIP_OPENEXR);
    helio_image_destroy(f->context, image);
    assert_int_equal(f->warnings, 0);
}

static void test_alpha_can_be_left_out(void **state)
{
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    exr_source source = {.channels = {{"A", EXR_PIXEL_FLOAT, planes[3], false},
                                      {"B", EXR_PIXEL_FLOAT, planes[2], false},
                                      {"G", EXR_PIXEL_FLOAT, planes[1], false},
                                      {"R", EXR_PIXEL_FLOAT, planes[0], false}},
                         .compression = EXR_COMPRESSION_ZIP,
                         .data = BOX(0, 0, WIDTH - 1, HEIGHT - 1),
                         .display = BOX(0, 0, WIDTH - 1, HEIGHT - 1)};
    for (int shift = 0; shift < 2; shift++) {
        source.display.max.x = WIDTH - 1 + shift; /* also where the windows differ */
        const char *path = write_exr(f, &source);
        helio_image *image;
        assert_int_equal(helio_image_read(f->context, path, &(helio_image_read_desc){.without_alpha = true}, &image),
                         HELIO_OK);
        assert_null(image->alpha);
        for (int c = 0; c < 3; c++)
            assert_float_equal(image->rgb[3 * 7 + c], planes[c][7], 0);
        helio_image_destroy(f->context, image);
        unlink(path);
    }
}

static void test_absurd_display_windows_are_ignored(void **state)
{
    static const exr_attr_box2i_t windows[] = {BOX(1000, 1000, 1010, 1010), BOX(0, 0, 999999, 999999),
                                               BOX(-1000, -1000, 1000, 1000)};
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    for (unsigned i = 0; i < sizeof windows / sizeof *windows; i++) {
        exr_source source = {.channels = {{"R", EXR_PIXEL_FLOAT, planes[0], false},
                                          {"G", EXR_PIXEL_FLOAT, planes[1], false},
                                          {"B", EXR_PIXEL_FLOAT, planes[2], false}},
                             .data = BOX(0, 0, WIDTH - 1, HEIGHT - 1),
                             .display = windows[i]};
        f->largest = 0;
        helio_image *image = read_source(f, &source);
        assert_true(f->largest < 100000);
        expect_planes(image, planes, 0);
        helio_image_destroy(f->context, image);
        assert_int_equal(f->warnings, i + 1);
        assert_non_null(strstr(f->warning, "display window"));
    }
}

/* ---- colour ---- */

static void test_chromaticities_are_converted(void **state)
{
    const exr_attr_chromaticities_t rec709 = {0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
    const exr_attr_chromaticities_t ap1 = {0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
    const exr_attr_chromaticities_t none = {0};
    fixture *f = *state;
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    planes[1][0] = planes[2][0] = 0; /* a pixel of pure red, and one of white */
    planes[0][1] = planes[1][1] = planes[2][1] = 2;
    planes[1][2] = -1;
    exr_source source = {.channels = {{"R", EXR_PIXEL_FLOAT, planes[0], false},
                                      {"G", EXR_PIXEL_FLOAT, planes[1], false},
                                      {"B", EXR_PIXEL_FLOAT, planes[2], false}},
                         .chromaticities = &rec709};
    helio_image *image = read_source(f, &source);
    expect_planes(image, planes, 0);
    helio_image_destroy(f->context, image);
    source.chromaticities = &none;
    image = read_source(f, &source);
    expect_planes(image, planes, 0);
    helio_image_destroy(f->context, image);

    /* ACEScg (AP1, D60) to Rec. 709: the matrix that the ACES project publishes. */
    source.chromaticities = &ap1;
    image = read_source(f, &source);
    const float red = planes[0][0];
    assert_float_equal(image->rgb[0], 1.70505f * red, 1e-4f);
    assert_float_equal(image->rgb[1], -0.13026f * red, 1e-4f);
    assert_float_equal(image->rgb[2], -0.02400f * red, 1e-4f);
    for (int c = 3; c < 6; c++)
        assert_float_equal(image->rgb[c], 2, 1e-5f);
    assert_int_equal(bad_pixels(image), 1); /* of the file, not of what conversion makes */
    helio_image_destroy(f->context, image);
}

/* ---- what only the C++ library can write ---- */

static void make_rgba(ImfRgba *pixels, int count, float scale)
{
    for (int i = 0; i < count; i++) {
        float value = scale * (1 + (float)(i % EVEN_WIDTH) / EVEN_WIDTH);
        ImfFloatToHalf(value, &pixels[i].r);
        ImfFloatToHalf(value / 2, &pixels[i].g);
        ImfFloatToHalf(value / 4, &pixels[i].b);
        ImfFloatToHalf(0.5f, &pixels[i].a);
    }
}

static const char *write_rgba(const fixture *f, int compression, int channels, bool tiled, const ImfRgba *pixels)
{
    const char *path = fixture_path(f, "test.exr");
    ImfHeader *header = ImfNewHeader();
    /* Far from the origin, which the reader must undo. */
    ImfHeaderSetDataWindow(header, -100, 50, -100 + EVEN_WIDTH - 1, 50 + EVEN_HEIGHT - 1);
    ImfHeaderSetDisplayWindow(header, -100, 50, -100 + EVEN_WIDTH - 1, 50 + EVEN_HEIGHT - 1);
    ImfHeaderSetCompression(header, compression);
    const ImfRgba *origin = (const ImfRgba *)((uintptr_t)pixels - (uintptr_t)((50 * EVEN_WIDTH - 100) * 8));
    if (tiled) {
        ImfTiledOutputFile *file = ImfOpenTiledOutputFile(path, header, channels, TILE, TILE, IMF_ONE_LEVEL, 0);
        assert_non_null(file);
        assert_true(ImfTiledOutputSetFrameBuffer(file, origin, 1, EVEN_WIDTH));
        assert_true(ImfTiledOutputWriteTiles(file, 0, (EVEN_WIDTH - 1) / TILE, 0, (EVEN_HEIGHT - 1) / TILE, 0, 0));
        assert_true(ImfCloseTiledOutputFile(file));
    } else {
        ImfOutputFile *file = ImfOpenOutputFile(path, header, channels);
        assert_non_null(file);
        assert_true(ImfOutputSetFrameBuffer(file, origin, 1, EVEN_WIDTH));
        assert_true(ImfOutputWritePixels(file, EVEN_HEIGHT));
        assert_true(ImfCloseOutputFile(file));
    }
    ImfDeleteHeader(header);
    return path;
}

static void expect_rgba(const helio_image *image, float scale, float tolerance)
{
    assert_int_equal(image->width, EVEN_WIDTH);
    assert_int_equal(image->height, EVEN_HEIGHT);
    for (int i = 0; i < EVEN_WIDTH * EVEN_HEIGHT; i++) {
        float value = scale * (1 + (float)(i % EVEN_WIDTH) / EVEN_WIDTH);
        for (int c = 0; c < 3; c++)
            assert_float_equal(image->rgb[3 * i + c], value / (float)(1 << c), tolerance * value);
        if (image->alpha != NULL)
            assert_float_equal(image->alpha[i], 0.5f, 0.01f);
    }
}

static void test_dwa_and_luminance_chroma(void **state)
{
    static const struct {
        int compression, channels;
        bool tiled, alpha;
        float tolerance;
    } files[] = {{IMF_DWAA_COMPRESSION, IMF_WRITE_RGB, false, false, 0.02f},
                 {IMF_DWAB_COMPRESSION, IMF_WRITE_RGBA, false, true, 0.02f},
                 {IMF_DWAA_COMPRESSION, IMF_WRITE_RGBA, true, true, 0.02f},
                 {IMF_B44A_COMPRESSION, IMF_WRITE_RGBA, true, true, 0.05f},
                 {IMF_PIZ_COMPRESSION, IMF_WRITE_YC, false, false, 0.05f},
                 {IMF_ZIP_COMPRESSION, IMF_WRITE_YCA, false, true, 0.05f}};
    fixture *f = *state;
    ImfRgba pixels[PIXELS];
    make_rgba(pixels, PIXELS, 2);
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const char *path = write_rgba(f, files[i].compression, files[i].channels, files[i].tiled, pixels);
        helio_image *image = read_image(f, path);
        assert_int_equal(image->alpha != NULL, files[i].alpha);
        expect_rgba(image, 2, files[i].tolerance);
        helio_image_destroy(f->context, image);
        expect_memory_failures(f, path);
        unlink(path);
    }
    assert_int_equal(f->warnings, 0);
}

static void test_overflow_of_half_floats_is_told(void **state)
{
    fixture *f = *state;
    static float luminance[EVEN_WIDTH * EVEN_HEIGHT], chroma[EVEN_WIDTH * EVEN_HEIGHT / 4];
    for (int i = 0; i < EVEN_WIDTH * EVEN_HEIGHT; i++)
        luminance[i] = 1;
    luminance[5] = 1e6f;
    const exr_source source = {.channels = {{"Y", EXR_PIXEL_FLOAT, luminance, false},
                                            {"RY", EXR_PIXEL_FLOAT, chroma, true},
                                            {"BY", EXR_PIXEL_FLOAT, chroma, true}},
                               .compression = EXR_COMPRESSION_ZIP,
                               .data = BOX(0, 0, EVEN_WIDTH - 1, EVEN_HEIGHT - 1),
                               .display = BOX(0, 0, EVEN_WIDTH - 1, EVEN_HEIGHT - 1)};
    helio_image *image = read_source(f, &source);
    assert_float_equal(image->rgb[0], 1, 0.01f);
    assert_true(isinf(image->rgb[3 * 5]));
    assert_in_range(bad_pixels(image), 1, 4);
    assert_int_equal(f->warnings, 1);
    assert_non_null(strstr(f->warning, "65504"));
    helio_image_destroy(f->context, image);
}

/* ---- damaged files ---- */

static void write_small(fixture *f, exr_compression_t compression, bool tiled, char path[512])
{
    static float planes[4][PIXELS];
    static ImfHalf halves[4][PIXELS];
    make_planes(planes, halves);
    const exr_source source = {.channels = {{"R", EXR_PIXEL_HALF, halves[0], false},
                                            {"G", EXR_PIXEL_HALF, halves[1], false},
                                            {"B", EXR_PIXEL_FLOAT, planes[2], false}},
                               .compression = compression,
                               .tiled = tiled};
    snprintf(path, 512, "%s", write_exr(f, &source));
}

static void test_truncated_files_are_refused(void **state)
{
    fixture *f = *state;
    char path[512];
    for (exr_compression_t compression = EXR_COMPRESSION_NONE; compression <= EXR_COMPRESSION_B44A; compression++)
        for (int tiled = 0; tiled < 2; tiled++) {
            write_small(f, compression, tiled, path);
            expect_bad_beginnings(f, path, 0);
            unlink(path);
        }
    ImfRgba pixels[PIXELS];
    make_rgba(pixels, PIXELS, 2);
    snprintf(path, sizeof path, "%s", write_rgba(f, IMF_DWAA_COMPRESSION, IMF_WRITE_RGB, false, pixels));
    expect_bad_beginnings(f, path, 0);
    unlink(path);
}

static void test_changed_bytes_do_no_harm(void **state)
{
    static const exr_compression_t compressions[] = {EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE, EXR_COMPRESSION_ZIP};
    fixture *f = *state;
    char path[512];
    for (size_t i = 0; i < sizeof compressions / sizeof *compressions; i++) {
        write_small(f, compressions[i], i == 1, path);
        expect_no_harm_from_changes(f, path, 300);
        expect_memory_failures(f, path);
        unlink(path);
    }
}

/* The bytes of the data window's last corner in a file, to be overwritten. */
static unsigned char *find_window(unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i + 40 < size; i++)
        if (memcmp(bytes + i, "dataWindow\0box2i\0\x10\0\0\0", 21) == 0)
            return bytes + i + 21 + 8;
    fail();
    return NULL;
}

static void test_bombs_take_no_memory(void **state)
{
    static const int32_t corners[][2] = {{15999, 15999}, {1048575, 255},         {255, 1048575},
                                         {99999999, 0},  {INT32_MAX, INT32_MAX}, {-2, 5}};
    fixture *f = *state;
    char path[512];
    write_small(f, EXR_COMPRESSION_ZIP, false, path);
    size_t size;
    unsigned char *bytes = read_file(path, &size), *corner = find_window(bytes, size);
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++) {
        memcpy(corner, corners[i], 8);
        f->largest = 0;
        expect_bad_bytes(f, bytes, size);
        assert_true(f->largest < 100000);
    }
    free(bytes);
    unlink(path);
}

/* A tile as large as the picture is in memory three times while it is decoded. */
static void test_huge_tiles_count_as_pixels(void **state)
{
    enum { EDGE = 5000 };
    const int32_t corner[2] = {EDGE - 1, EDGE - 1}, tile[2] = {EDGE, EDGE};
    fixture *f = *state;
    char path[512];
    write_small(f, EXR_COMPRESSION_ZIP, true, path);
    size_t size;
    unsigned char *bytes = read_file(path, &size), *at = find_window(bytes, size);
    memcpy(at, corner, sizeof corner);
    while (memcmp(at, "tiledesc\0\x09\0\0\0", 13) != 0 && (size_t)(at - bytes) + 32 < size)
        at++;
    memcpy(at + 13, tile, sizeof tile);
    write_file(path, bytes, size);
    f->largest = 0;
    helio_image *image;
    assert_int_equal(helio_image_read(f->context, path, &(helio_image_read_desc){.max_pixels = EDGE * EDGE}, &image),
                     HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "MiB to be decoded"));
    expect_failure(f, path, HELIO_ERR_DATA); /* by default the tile is granted, but the file is too short for it */
    assert_non_null(strstr(helio_last_error(), "truncated or damaged"));
    assert_true(f->largest < 100000);
    free(bytes);
    unlink(path);
}

/* ---- helio_picture_write ---- */

static void test_written_pictures_keep_every_bit(void **state)
{
    fixture *f = *state;
    static float rgba[4 * PIXELS];
    for (int i = 0; i < 4 * PIXELS; i++)
        rgba[i] = (float)i / 7;
    rgba[0] = NAN;
    rgba[5] = INFINITY;
    rgba[10] = -FLT_MAX;
    rgba[11] = FLT_TRUE_MIN;
    rgba[13] = -0.0f;
    const helio_picture picture = {.width = WIDTH, .height = HEIGHT, .rgba = rgba};
    const char *path = fixture_path(f, "test.exr");
    assert_int_equal(helio_picture_write(f->context, path, &picture, NULL), HELIO_OK);
    helio_image *image = read_image(f, path);
    unlink(path);
    assert_int_equal(image->width, WIDTH);
    assert_int_equal(image->height, HEIGHT);
    for (int i = 0; i < PIXELS; i++) {
        assert_memory_equal(image->rgb + 3 * i, rgba + 4 * i, 3 * sizeof(float));
        assert_memory_equal(image->alpha + i, rgba + 4 * i + 3, sizeof(float));
    }
    assert_int_equal(bad_pixels(image), 3);
    helio_image_destroy(f->context, image);
}

/* Reads one channel of a file by its name. */
static void read_channel(const char *path, const char *name, float plane[PIXELS])
{
    exr_context_t library;
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    assert_int_equal(exr_start_read(&library, path, &initializer), 0);
    int lines = 0;
    bool found = false;
    assert_int_equal(exr_get_scanlines_per_chunk(library, 0, &lines), 0);
    for (int row = 0; row < HEIGHT; row += lines) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
        assert_int_equal(exr_read_scanline_chunk_info(library, 0, row, &chunk), 0);
        assert_int_equal(exr_decoding_initialize(library, 0, &chunk, &pipeline), 0);
        for (int i = 0; i < pipeline.channel_count; i++) {
            if (strcmp(pipeline.channels[i].channel_name, name) != 0)
                continue;
            found = true;
            assert_int_equal(pipeline.channels[i].data_type, EXR_PIXEL_FLOAT);
            pipeline.channels[i].user_pixel_stride = 4;
            pipeline.channels[i].user_line_stride = 4 * WIDTH;
            pipeline.channels[i].decode_to_ptr = (uint8_t *)(plane + row * WIDTH);
        }
        assert_int_equal(exr_decoding_choose_default_routines(library, 0, &pipeline), 0);
        assert_int_equal(exr_decoding_run(library, 0, &pipeline), 0);
        exr_decoding_destroy(library, &pipeline);
    }
    exr_finish(&library);
    assert_true(found);
}

enum { LAYERS = 18 };

/* A picture whose every channel holds other numbers: values[layer] are those of names[layer]. */
static void write_layers(fixture *f, const char *path, float values[LAYERS][PIXELS])
{
    static float rgba[4 * PIXELS], albedo[3 * PIXELS], normal[3 * PIXELS], position[3 * PIXELS], error[3 * PIXELS];
    for (int layer = 0; layer < LAYERS; layer++)
        for (int i = 0; i < PIXELS; i++)
            values[layer][i] = (float)(1000 * layer + i);
    values[14][3] = INFINITY;
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 4; c++)
            rgba[4 * i + c] = values[c][i];
        for (int c = 0; c < 3; c++) {
            albedo[3 * i + c] = values[4 + c][i];
            normal[3 * i + c] = values[7 + c][i];
            position[3 * i + c] = values[10 + c][i];
            error[3 * i + c] = values[15 + c][i];
        }
    }
    const helio_picture picture = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .rgba = rgba,
                                   .object = values[13],
                                   .albedo = albedo,
                                   .normal = normal,
                                   .position = position,
                                   .depth = values[14],
                                   .standard_error = error};
    assert_int_equal(helio_picture_write(f->context, path, &picture, NULL), HELIO_OK);
}

static void test_layers_are_written(void **state)
{
    fixture *f = *state;
    static float values[LAYERS][PIXELS];
    static const char *const names[LAYERS] = {"R",          "G",          "B",          "A",        "albedo.R",
                                              "albedo.G",   "albedo.B",   "normal.X",   "normal.Y", "normal.Z",
                                              "position.X", "position.Y", "position.Z", "object.A", "depth.Z",
                                              "stderr.R",   "stderr.G",   "stderr.B"};
    const char *path = fixture_path(f, "layers.exr");
    write_layers(f, path, values);
    for (int layer = 0; layer < LAYERS; layer++) {
        float plane[PIXELS];
        read_channel(path, names[layer], plane);
        assert_memory_equal(plane, values[layer], sizeof plane);
    }
    /* The C++ side of the library reads it too. */
    ImfInputFile *file = ImfOpenInputFile(path);
    assert_non_null(file);
    assert_int_equal(ImfInputChannels(file), IMF_WRITE_RGBA);
    assert_int_equal(ImfHeaderCompression(ImfInputHeader(file)), IMF_ZIP_COMPRESSION);
    ImfCloseInputFile(file);
    unlink(path);
}

static void test_a_layer_is_read_by_its_name(void **state)
{
    fixture *f = *state;
    static float values[LAYERS][PIXELS];
    static const struct {
        const char *layer;
        int first[3];
    } layers[] = {{NULL, {0, 1, 2}},          {"albedo", {4, 5, 6}},    {"normal", {7, 8, 9}},
                  {"position", {10, 11, 12}}, {"object", {13, 13, 13}}, {"depth", {14, 14, 14}},
                  {"stderr", {15, 16, 17}}};
    const char *path = fixture_path(f, "layers.exr");
    write_layers(f, path, values);
    for (size_t k = 0; k < sizeof layers / sizeof *layers; k++) {
        helio_image *image = NULL;
        const helio_image_read_desc desc = {.layer = layers[k].layer};
        assert_int_equal(helio_image_read(f->context, path, &desc, &image), HELIO_OK);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++)
                assert_true(image->rgb[3 * i + c] == values[layers[k].first[c]][i]);
        assert_int_equal(image->alpha != NULL, layers[k].layer == NULL);
        assert_false(image->is_encoded);
        helio_image_destroy(f->context, image);
    }
    unlink(path);
}

static void test_a_layer_that_is_missing_is_told(void **state)
{
    fixture *f = *state;
    static float values[LAYERS][PIXELS];
    char path[512], other[512];
    helio_image *image;
    snprintf(path, sizeof path, "%s", fixture_path(f, "layers.exr"));
    snprintf(other, sizeof other, "%s", fixture_path(f, "layers.pfm"));
    write_layers(f, path, values);
    write_layers(f, other, values);
    assert_int_equal(helio_image_read(f->context, path, &(helio_image_read_desc){.layer = "stder"}, &image),
                     HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "no layer 'stder'"));
    assert_non_null(strstr(helio_last_error(), "stderr.R"));
    assert_int_equal(helio_image_read(f->context, other, &(helio_image_read_desc){.layer = "stderr"}, &image),
                     HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), "only OpenEXR has layers"));
    unlink(path);
    unlink(other);
}

/* ---- files of others ---- */

static void luminance_of(const helio_image *image, double *greatest, double *mean)
{
    size_t pixels = (size_t)image->width * image->height;
    *greatest = *mean = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float *rgb = image->rgb + 3 * i;
        double luminance = 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
        *greatest = luminance > *greatest ? luminance : *greatest;
        *mean += luminance / (double)pixels;
    }
}

/* Luminances by another decoder, from the data's own list. */
static void test_captured_maps_have_known_values(void **state)
{
    static const struct {
        const char *name;
        uint32_t width, height;
        helio_layout layout;
        uint64_t bad;
        double greatest, mean;
    } maps[] = {
        {"latlong/StageEnvLatLong.exr", 1000, 500, HELIO_LAYOUT_LATLONG, 0, 4096, 2.7125},
        {"latlong/blender/city.exr", 1024, 512, HELIO_LAYOUT_AUTO, 299, 31749.4, 1.0545},
        {"latlong/blender/interior.exr", 1024, 512, HELIO_LAYOUT_AUTO, 5053, 32216.1, 0.97253},
        {"latlong/blender/night.exr", 1024, 512, HELIO_LAYOUT_AUTO, 596, 4219.62, 0.14068},
        {"latlong/san_giuseppe_bridge_2k.exr", 2048, 1024, HELIO_LAYOUT_AUTO, 0, 35445.6, 0.35257},
        {"cube-strip-openexr/StageEnvCube.exr", 256, 1536, HELIO_LAYOUT_STRIP_OPENEXR, 0, 4096, 3.0915},
        {"orientation-tests/WavyLinesCube.exr", 256, 1536, HELIO_LAYOUT_STRIP_OPENEXR, 0, 0.999512, 0.19541},
        {"orientation-tests/OrientationLatLong.exr", 1024, 512, HELIO_LAYOUT_LATLONG, 0, 0.990723, 0.90983},
    };
    fixture *f = *state;
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        char name[128];
        snprintf(name, sizeof name, "environments/%s", maps[i].name);
        const char *path = data_path(name);
        if (path == NULL)
            skip();
        helio_image *image = read_image(f, path);
        double greatest, mean;
        luminance_of(image, &greatest, &mean);
        assert_int_equal(image->width, maps[i].width);
        assert_int_equal(image->height, maps[i].height);
        assert_int_equal(image->layout, maps[i].layout);
        assert_int_equal(bad_pixels(image), maps[i].bad);
        assert_true(fabs(greatest / maps[i].greatest - 1) < 1e-4);
        assert_true(fabs(mean / maps[i].mean - 1) < 1e-4);
        helio_image_destroy(f->context, image);
    }
}

static void test_odd_files_of_others(void **state)
{
    fixture *f = *state;
    const char *folder = data_path("malformed/exr-edge");
    if (folder == NULL)
        skip();
    assert_int_equal(read_folder(f, folder), 5); /* of seven: one has only G, one has only A */
}

static void test_damaged_files_of_others(void **state)
{
    fixture *f = *state;
    const char *folder = data_path("malformed/exr-damaged");
    if (folder == NULL)
        skip();
    f->largest = 0;
    assert_in_range(read_folder(f, folder), 1, 8); /* a few are whole enough, which depends on the library's version */
    assert_true(f->largest < 64 << 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_all_compressions_of_half_and_float),
        TEST(test_mixed_types_and_other_channels),
        TEST(test_grey_and_layers),
        TEST(test_unwanted_subsampled_channels_are_skipped),
        TEST(test_first_part_with_colours_is_read),
        TEST(test_missing_channels_are_listed),
        TEST(test_display_window_crops_and_frames),
        TEST(test_alpha_can_be_left_out),
        TEST(test_absurd_display_windows_are_ignored),
        TEST(test_chromaticities_are_converted),
        TEST(test_dwa_and_luminance_chroma),
        TEST(test_overflow_of_half_floats_is_told),
        TEST(test_truncated_files_are_refused),
        TEST(test_changed_bytes_do_no_harm),
        TEST(test_bombs_take_no_memory),
        TEST(test_huge_tiles_count_as_pixels),
        TEST(test_written_pictures_keep_every_bit),
        TEST(test_layers_are_written),
        TEST(test_a_layer_is_read_by_its_name),
        TEST(test_a_layer_that_is_missing_is_told),
        TEST(test_captured_maps_have_known_values),
        TEST(test_odd_files_of_others),
        TEST(test_damaged_files_of_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
