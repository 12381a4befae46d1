/* SPDX-License-Identifier: MIT
 *
 * What is decoded from code values that were put in without loss, compared with the arithmetic of BT.709, BT.601,
 * BT.2020, BT.1886 and BT.2100, written here once more. */
#include "support.h"

#include <heliostat/video.h>

#include <math.h>
#include <string.h>

#include "image/transfer.h"

#define assert_near(got, expected, tolerance) check_near(got, expected, tolerance, __LINE__)

static void check_near(double got, double expected, double tolerance, int line)
{
    if (!(fabs(got - expected) <= tolerance))
        fail_msg("line %d: %.12g is not %.12g", line, got, expected);
}

/* ---- curves ---- */

static double pq(double v)
{
    const double m1 = 0.1593017578125, m2 = 78.84375, c1 = 0.8359375, c2 = 18.8515625, c3 = 18.6875;
    double p = pow(v < 0 ? 0 : v > 1 ? 1 : v, 1 / m2);
    return 10000 * pow((p > c1 ? p - c1 : 0) / (c2 - c3 * p), 1 / m1) / 203;
}

static double hlg_scene(double v)
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a);
    v = v < 0 ? 0 : v > 955.0 / 876 ? 955.0 / 876 : v;
    return v <= 0.5 ? v * v / 3 : (exp((v - c) / a) + b) / 12;
}

static double hlg(double v)
{
    return hlg_scene(v) / hlg_scene(0.75);
}

static double sdr(double v)
{
    return v > 0 ? pow(v, 2.4) : 0;
}

static double srgb(double v)
{
    return v <= 0 ? 0 : v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

static double linear(double v)
{
    return v;
}

static double (*const CURVES[])(double) = {NULL, sdr, srgb, pq, hlg, linear};

static void transfers_have_names(void **state)
{
    (void)state;
    for (helio_transfer t = HELIO_TRANSFER_AUTO; t <= HELIO_TRANSFER_LINEAR; t++) {
        helio_transfer parsed;
        assert_ok(helio_transfer_parse(helio_transfer_name(t), &parsed));
        assert_int_equal(parsed, t);
    }
    helio_transfer untouched = HELIO_TRANSFER_PQ;
    assert_int_equal(helio_transfer_parse("gamma", &untouched), HELIO_ERR_ARGUMENT);
    assert_int_equal(untouched, HELIO_TRANSFER_PQ);
    assert_non_null(strstr(helio_last_error(), "hlg"));
}

/* Numbers that others have published: BT.2408 for PQ at 203 and 1000 cd/m^2, ST 2084's table for 100. */
static void curves_go_through_the_published_points(void **state)
{
    (void)state;
    assert_near(transfer_encode(HELIO_TRANSFER_PQ, 1), 0.5807, 5e-5);
    assert_near(transfer_encode(HELIO_TRANSFER_PQ, 100.0 / 203), 0.5081, 5e-5);
    assert_near(transfer_encode(HELIO_TRANSFER_PQ, 1000.0 / 203), 0.7518, 5e-5);
    assert_near(transfer_decode(HELIO_TRANSFER_PQ, 1), 10000.0 / 203, 1e-9);
    assert_near(transfer_decode(HELIO_TRANSFER_HLG, 0.75), 1, 1e-12);
    assert_near(transfer_decode(HELIO_TRANSFER_HLG, 0.5), 1 / 12.0 / 0.26496256042100718, 1e-9);
    assert_near(transfer_decode(HELIO_TRANSFER_HLG, 1), 1 / 0.26496256042100718, 1e-6);
    assert_near(transfer_decode(HELIO_TRANSFER_SDR, 0.5), 0.18946457081379978, 1e-12);
    assert_near(transfer_decode(HELIO_TRANSFER_SRGB, 0.5), 0.21404114048223255, 1e-12);
    assert_near(transfer_decode(HELIO_TRANSFER_LINEAR, -2), -2, 0);
}

static void tables_keep_to_the_curves(void **state)
{
    (void)state;
    static transfer_table table;
    for (helio_transfer t = HELIO_TRANSFER_SDR; t <= HELIO_TRANSFER_LINEAR; t++) {
        transfer_table_fill(&table, t);
        for (int i = -1000; i <= 30000; i++) {
            float signal = (float)i / 12345;
            double expected = CURVES[t]((double)signal), got = (double)transfer_look_up(&table, signal);
            if (!(fabs(got - expected) <= 1e-5 * fabs(expected) + 1e-7))
                fail_msg("%s of %g is %g, not %g", helio_transfer_name(t), (double)signal, got, expected);
        }
        assert_true(isnan(transfer_look_up(&table, NAN)));
    }
}

static void encoding_tables_keep_to_the_curves(void **state)
{
    (void)state;
    static transfer_encoder encoder;
    const helio_transfer both[] = {HELIO_TRANSFER_SRGB, HELIO_TRANSFER_PQ};
    for (int k = 0; k < 2; k++) {
        transfer_encoder_fill(&encoder, both[k]);
        double peak = CURVES[both[k]](1);
        for (int i = 0; i <= 20000; i++) {
            float light = (float)(peak * exp2(-28.0 * i / 20000));
            double back = (double)transfer_encoder_look_up(&encoder, light);
            assert_near(back, transfer_encode(both[k], (double)light), 2.5e-6);
        }
        assert_true(transfer_encoder_look_up(&encoder, -1) == 0 && transfer_encoder_look_up(&encoder, NAN) == 0);
        assert_true(transfer_encoder_look_up(&encoder, INFINITY) == 1);
    }
}

#if HELIO_WITH_FFMPEG

#include "video_support.h"

#include <libavutil/pixdesc.h>

/* ---- colours ---- */

/* RGB to XYZ from chromaticities, by Cramer's rule; the white is D65. */
static void rgb_to_xyz(const double xy[3][2], double m[3][3])
{
    double p[3][3], white[3] = {0.3127 / 0.3290, 1, (1 - 0.3127 - 0.3290) / 0.3290}, determinant[4];
    for (int c = 0; c < 3; c++) {
        p[0][c] = xy[c][0];
        p[1][c] = xy[c][1];
        p[2][c] = 1 - xy[c][0] - xy[c][1];
    }
    for (int k = 0; k < 4; k++) {
        double q[3][3];
        for (int i = 0; i < 9; i++)
            q[i / 3][i % 3] = i % 3 == k ? white[i / 3] : p[i / 3][i % 3];
        determinant[k] = q[0][0] * (q[1][1] * q[2][2] - q[1][2] * q[2][1]) -
                         q[0][1] * (q[1][0] * q[2][2] - q[1][2] * q[2][0]) +
                         q[0][2] * (q[1][0] * q[2][1] - q[1][1] * q[2][0]);
    }
    for (int i = 0; i < 9; i++)
        m[i / 3][i % 3] = p[i / 3][i % 3] * determinant[i % 3] / determinant[3];
}

/* The XYZ of linear light in some primaries, which says as much as its Rec. 709. */
static void find_xyz(enum AVColorPrimaries primaries, const double rgb[3], double xyz[3])
{
    static const double REC709[3][2] = {{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}};
    static const double BT2020[3][2] = {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}};
    static const double P3[3][2] = {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}};
    static const double NTSC[3][2] = {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}};
    double m[3][3];
    rgb_to_xyz(primaries == AVCOL_PRI_BT2020      ? BT2020
               : primaries == AVCOL_PRI_SMPTE432  ? P3
               : primaries == AVCOL_PRI_SMPTE170M ? NTSC
                                                  : REC709,
               m);
    for (int c = 0; c < 3; c++)
        xyz[c] = m[c][0] * rgb[0] + m[c][1] * rgb[1] + m[c][2] * rgb[2];
}

typedef struct decode_case {
    const char *name;
    enum AVPixelFormat format;
    enum AVColorRange range;
    enum AVColorPrimaries primaries;
    enum AVColorTransferCharacteristic transfer;
    enum AVColorSpace matrix;
    helio_transfer curve;
} decode_case;

static const decode_case CASES[] = {
    {"SDR 8 bit 4:2:0", AV_PIX_FMT_YUV420P, AVCOL_RANGE_MPEG, AVCOL_PRI_BT709, AVCOL_TRC_BT709, AVCOL_SPC_BT709,
     HELIO_TRANSFER_SDR},
    {"SDR 8 bit full", AV_PIX_FMT_YUV444P, AVCOL_RANGE_JPEG, AVCOL_PRI_BT709, AVCOL_TRC_BT709, AVCOL_SPC_BT709,
     HELIO_TRANSFER_SDR},
    {"SDR 10 bit 4:2:2 BT.601", AV_PIX_FMT_YUV422P10, AVCOL_RANGE_MPEG, AVCOL_PRI_SMPTE170M, AVCOL_TRC_SMPTE170M,
     AVCOL_SPC_SMPTE170M, HELIO_TRANSFER_SDR},
    {"SDR BT.2020 12 bit", AV_PIX_FMT_YUV420P12, AVCOL_RANGE_MPEG, AVCOL_PRI_BT2020, AVCOL_TRC_BT2020_12,
     AVCOL_SPC_BT2020_NCL, HELIO_TRANSFER_SDR},
    {"sRGB P3", AV_PIX_FMT_YUV444P, AVCOL_RANGE_JPEG, AVCOL_PRI_SMPTE432, AVCOL_TRC_IEC61966_2_1, AVCOL_SPC_BT709,
     HELIO_TRANSFER_SRGB},
    {"PQ 10 bit 4:2:0", AV_PIX_FMT_YUV420P10, AVCOL_RANGE_MPEG, AVCOL_PRI_BT2020, AVCOL_TRC_SMPTE2084,
     AVCOL_SPC_BT2020_NCL, HELIO_TRANSFER_PQ},
    {"PQ 12 bit 4:2:2 full", AV_PIX_FMT_YUV422P12, AVCOL_RANGE_JPEG, AVCOL_PRI_BT2020, AVCOL_TRC_SMPTE2084,
     AVCOL_SPC_BT2020_NCL, HELIO_TRANSFER_PQ},
    {"PQ 16 bit 4:4:4", AV_PIX_FMT_YUV444P16, AVCOL_RANGE_MPEG, AVCOL_PRI_BT2020, AVCOL_TRC_SMPTE2084,
     AVCOL_SPC_BT2020_NCL, HELIO_TRANSFER_PQ},
    {"PQ 8 bit", AV_PIX_FMT_YUV420P, AVCOL_RANGE_MPEG, AVCOL_PRI_BT2020, AVCOL_TRC_SMPTE2084, AVCOL_SPC_BT2020_NCL,
     HELIO_TRANSFER_PQ},
    {"PQ RGB 12 bit", AV_PIX_FMT_GBRP12, AVCOL_RANGE_JPEG, AVCOL_PRI_BT2020, AVCOL_TRC_SMPTE2084, AVCOL_SPC_RGB,
     HELIO_TRANSFER_PQ},
    {"HLG 10 bit 4:2:0", AV_PIX_FMT_YUV420P10, AVCOL_RANGE_MPEG, AVCOL_PRI_BT2020, AVCOL_TRC_ARIB_STD_B67,
     AVCOL_SPC_BT2020_NCL, HELIO_TRANSFER_HLG},
    {"HLG 8 bit full Rec. 709", AV_PIX_FMT_YUV422P, AVCOL_RANGE_JPEG, AVCOL_PRI_BT709, AVCOL_TRC_ARIB_STD_B67,
     AVCOL_SPC_BT709, HELIO_TRANSFER_HLG},
    {"HLG RGB 16 bit", AV_PIX_FMT_GBRP16, AVCOL_RANGE_JPEG, AVCOL_PRI_BT2020, AVCOL_TRC_ARIB_STD_B67, AVCOL_SPC_RGB,
     HELIO_TRANSFER_HLG},
    {"linear 16 bit", AV_PIX_FMT_GBRP16, AVCOL_RANGE_JPEG, AVCOL_PRI_BT709, AVCOL_TRC_LINEAR, AVCOL_SPC_RGB,
     HELIO_TRANSFER_LINEAR},
    {"sRGB 8 bit RGB", AV_PIX_FMT_0RGB32, AVCOL_RANGE_JPEG, AVCOL_PRI_BT709, AVCOL_TRC_IEC61966_2_1, AVCOL_SPC_RGB,
     HELIO_TRANSFER_SRGB},
    {"YCgCo 10 bit", AV_PIX_FMT_YUV444P10, AVCOL_RANGE_JPEG, AVCOL_PRI_BT709, AVCOL_TRC_IEC61966_2_1, AVCOL_SPC_YCGCO,
     HELIO_TRANSFER_SRGB},
    {"grey 10 bit", AV_PIX_FMT_GRAY10, AVCOL_RANGE_MPEG, AVCOL_PRI_BT709, AVCOL_TRC_BT709, AVCOL_SPC_BT709,
     HELIO_TRANSFER_SDR},
};

/* Patches of 16 x 16 pixels, 4 by 2. */
enum { PATCH = 16, PATCHES = 8, CLIP_WIDTH = 4 * PATCH, CLIP_HEIGHT = 2 * PATCH };

/* Codes that are black, white, grey, the largest and smallest, and four colours. */
static unsigned patch_code(const AVPixFmtDescriptor *format, int patch, int component)
{
    static const double SHARES[PATCHES][3] = {{16, 128, 128}, {235, 128, 128}, {126, 128, 128}, {255, 128, 128},
                                              {81, 90, 190},  {145, 60, 100},  {100, 200, 60},  {201, 180, 77}};
    return (unsigned)(SHARES[patch][component] / 255 * (double)((1u << format->comp[component].depth) - 1) + 0.5);
}

static unsigned patches(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)frame;
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(clip->format);
    bool is_chroma = component > 0 && !(format->flags & AV_PIX_FMT_FLAG_RGB);
    int column = (x << (is_chroma ? format->log2_chroma_w : 0)) / PATCH;
    int row = (y << (is_chroma ? format->log2_chroma_h : 0)) / PATCH;
    return patch_code(format, 4 * row + column, component);
}

static video_clip clip_of_case(const decode_case *c)
{
    return (video_clip){.muxer = "matroska",
                        .codec = AV_CODEC_ID_FFV1,
                        .format = c->format,
                        .width = CLIP_WIDTH,
                        .height = CLIP_HEIGHT,
                        .frames = 2,
                        .range = c->range,
                        .primaries = c->primaries,
                        .transfer = c->transfer,
                        .matrix = c->matrix,
                        .code = patches};
}

/* R'G'B' of codes by the letter of BT.2100, table 9 and BT.709, section 4. */
static void find_signal(const decode_case *c, const unsigned code[3], double signal[3])
{
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(c->format);
    int depth = format->comp[0].depth;
    double steps = ldexp(1, depth - 8), most = ldexp(1, depth) - 1, value[3];
    bool is_rgb = (format->flags & AV_PIX_FMT_FLAG_RGB) != 0 || format->nb_components == 1;
    for (int i = 0; i < 3; i++)
        if (c->range == AVCOL_RANGE_JPEG)
            value[i] = is_rgb || i == 0 ? code[i] / most : (code[i] - ldexp(1, depth - 1)) / most;
        else
            value[i] = is_rgb || i == 0 ? (code[i] / steps - 16) / 219 : (code[i] / steps - 128) / 224;
    memcpy(signal, value, sizeof value);
    if (is_rgb)
        return;
    if (c->matrix == AVCOL_SPC_YCGCO) {
        signal[0] = value[0] - value[1] + value[2];
        signal[1] = value[0] + value[1];
        signal[2] = value[0] - value[1] - value[2];
        return;
    }
    double red = 0.2126, blue = 0.0722;
    if (c->matrix == AVCOL_SPC_SMPTE170M)
        red = 0.299, blue = 0.114;
    if (c->matrix == AVCOL_SPC_BT2020_NCL)
        red = 0.2627, blue = 0.0593;
    signal[0] = value[0] + (2 - 2 * red) * value[2];
    signal[2] = value[0] + (2 - 2 * blue) * value[1];
    signal[1] = (value[0] - red * signal[0] - blue * signal[2]) / (1 - red - blue);
}

static void check_pixel(const decode_case *c, int patch, const float *rgb)
{
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(c->format);
    bool is_grey = format->nb_components == 1;
    unsigned code[3];
    for (int i = 0; i < 3; i++)
        code[i] = patch_code(format, patch, is_grey ? 0 : i);
    double signal[3], light[3], expected[3], found[3];
    const double got[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]};
    find_signal(c, code, signal);
    for (int i = 0; i < 3; i++)
        light[i] = CURVES[c->curve](signal[i]);
    find_xyz(c->primaries, light, expected);
    find_xyz(AVCOL_PRI_BT709, got, found);
    double brightest = fmax(fmax(fabs(light[0]), fabs(light[1])), fabs(light[2]));
    for (int i = 0; i < 3; i++)
        if (!(fabs(found[i] - expected[i]) <= 2e-5 * brightest + 2e-7))
            fail_msg("%s, patch %d: XYZ[%d] is %.9g, not %.9g", c->name, patch, i, found[i], expected[i]);
}

static void check_frame(const decode_case *c, const helio_video_frame *frame)
{
    assert_int_equal(frame->width, CLIP_WIDTH);
    assert_int_equal(frame->height, CLIP_HEIGHT);
    assert_int_equal(frame->bad.nan + frame->bad.infinite + frame->bad.negative, 0);
    for (int patch = 0; patch < PATCHES; patch++)
        for (int i = 0; i < 2; i++) {
            int x = patch % 4 * PATCH + 3 + 9 * i, y = patch / 4 * PATCH + 3 + 9 * i;
            check_pixel(c, patch, frame->rgb + 3 * (y * CLIP_WIDTH + x));
        }
}

static void code_values_become_the_light_that_the_standards_say(void **state)
{
    (void)state;
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    make_directory(directory);
    join(path, directory, "clip.mkv");
    helio_context *context = make_context(2, NULL);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        video_clip made = clip_of_case(&CASES[i]);
        write_clip(path, &made);
        helio_video_reader *reader;
        assert_ok(helio_video_open(context, path, NULL, &reader));
        helio_video_info info = helio_video_get_info(reader);
        assert_int_equal(info.transfer, CASES[i].curve);
        assert_string_equal(info.codec, "ffv1");
        assert_near(info.fps, 25, 1e-9);
        helio_video_frame frame;
        for (int k = 0; k < 2; k++) {
            assert_ok(helio_video_next(reader, &frame));
            assert_non_null(frame.rgb);
            assert_near(frame.seconds, k / 25.0, 1e-9);
            check_frame(&CASES[i], &frame);
        }
        for (int k = 0; k < 2; k++) {
            assert_ok(helio_video_next(reader, &frame));
            assert_null(frame.rgb);
        }
        helio_video_close(reader);
    }
    helio_context_destroy(context);
    remove_directory(directory);
}

/* The tags say PQ, the caller knows better. */
/* Every code of luma from black to white and beyond, without colour. */
static unsigned greys(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)frame;
    return component > 0 ? 512 : 4 + (unsigned)(y * clip->width + x) % 1016;
}

/* Black bars would otherwise be told as colours that Rec. 709 has not. */
static void what_is_grey_in_a_wider_gamut_is_inside_of_rec709(void **state)
{
    (void)state;
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    make_directory(directory);
    join(path, directory, "clip.mkv");
    helio_context *context = make_context(1, NULL);
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        video_clip made = clip_of_case(&CASES[i]);
        if (made.primaries == AVCOL_PRI_BT709)
            continue;
        made.format = AV_PIX_FMT_YUV444P10;
        made.range = AVCOL_RANGE_MPEG;
        made.matrix = made.matrix == AVCOL_SPC_RGB ? AVCOL_SPC_BT2020_NCL : made.matrix;
        made.width = 64;
        made.height = 16;
        made.code = greys;
        write_clip(path, &made);
        helio_video_reader *reader;
        helio_video_frame frame;
        assert_ok(helio_video_open(context, path, NULL, &reader));
        assert_ok(helio_video_next(reader, &frame));
        for (int k = 0; k < made.width * made.height * 3; k++)
            if (!(frame.rgb[k] >= 0))
                fail_msg("%s: channel %d of grey %u is %g", CASES[i].name, k % 3, greys(&made, 0, 0, k / 3, 0),
                         (double)frame.rgb[k]);
        helio_video_close(reader);
    }
    helio_context_destroy(context);
    remove_directory(directory);
}

static void callers_overrule_the_tags(void **state)
{
    (void)state;
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    make_directory(directory);
    join(path, directory, "clip.mkv");
    decode_case tagged = CASES[9];
    video_clip made = clip_of_case(&tagged);
    write_clip(path, &made);
    helio_context *context = make_context(1, NULL);
    for (helio_transfer t = HELIO_TRANSFER_SDR; t <= HELIO_TRANSFER_LINEAR; t++) {
        helio_video_read_desc desc = {.transfer = t};
        helio_video_reader *reader;
        helio_video_frame frame;
        assert_ok(helio_video_open(context, path, &desc, &reader));
        assert_int_equal(helio_video_get_info(reader).transfer, t);
        assert_ok(helio_video_next(reader, &frame));
        tagged.curve = t;
        check_frame(&tagged, &frame);
        helio_video_close(reader);
    }
    helio_context_destroy(context);
    remove_directory(directory);
}

/* ---- ICtCp ---- */

static double pq_signal(double light)
{
    const double m1 = 0.1593017578125, m2 = 78.84375, c1 = 0.8359375, c2 = 18.8515625, c3 = 18.6875;
    double p = pow(light * 203 / 10000, m1);
    return pow((c1 + c2 * p) / (1 + c3 * p), m2);
}

/* Linear BT.2020 of the patches of 16 x 16 pixels in a row. */
static const double ICTCP_COLOURS[4][3] = {{1, 1, 1}, {0.05, 0.3, 2}, {8, 1, 0.2}, {0.01, 0.02, 0.015}};

/* The way there, as BT.2100, tables 6 and 7 have it. */
static unsigned ictcp_code(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)clip;
    (void)frame;
    (void)y;
    const double *c = ICTCP_COLOURS[x / PATCH], lms[3] = {(1688 * c[0] + 2146 * c[1] + 262 * c[2]) / 4096,
                                                          (683 * c[0] + 2951 * c[1] + 462 * c[2]) / 4096,
                                                          (99 * c[0] + 309 * c[1] + 3688 * c[2]) / 4096};
    double l = pq_signal(lms[0]), m = pq_signal(lms[1]), s = pq_signal(lms[2]);
    double value = component == 0   ? 0.5 * l + 0.5 * m
                   : component == 1 ? (6610 * l - 13613 * m + 7003 * s) / 4096
                                    : (17933 * l - 17390 * m - 543 * s) / 4096;
    return (unsigned)(value * 65535 + (component == 0 ? 0 : 32768) + 0.5);
}

static void ictcp_is_undone(void **state)
{
    (void)state;
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    make_directory(directory);
    join(path, directory, "clip.mkv");
    const video_clip made = {.muxer = "matroska",
                             .codec = AV_CODEC_ID_FFV1,
                             .format = AV_PIX_FMT_YUV444P16,
                             .width = 4 * PATCH,
                             .height = 4,
                             .frames = 1,
                             .range = AVCOL_RANGE_JPEG,
                             .primaries = AVCOL_PRI_BT2020,
                             .transfer = AVCOL_TRC_SMPTE2084,
                             .matrix = AVCOL_SPC_ICTCP,
                             .code = ictcp_code};
    write_clip(path, &made);
    helio_context *context = make_context(1, NULL);
    helio_video_reader *reader;
    helio_video_frame frame;
    assert_ok(helio_video_open(context, path, NULL, &reader));
    assert_ok(helio_video_next(reader, &frame));
    for (int patch = 0; patch < 4; patch++) {
        const float *rgb = frame.rgb + 3 * (patch * PATCH + 5);
        const double got[3] = {(double)rgb[0], (double)rgb[1], (double)rgb[2]}, *colour = ICTCP_COLOURS[patch];
        double expected[3], found[3];
        find_xyz(AVCOL_PRI_BT2020, colour, expected);
        find_xyz(AVCOL_PRI_BT709, got, found);
        for (int i = 0; i < 3; i++) /* 16 bits are steps of 0.05 % here */
            assert_near(found[i], expected[i], 1e-3 * fmax(colour[0], fmax(colour[1], colour[2])));
    }
    helio_video_close(reader);
    helio_context_destroy(context);
    remove_directory(directory);
}

/* ---- chroma ---- */

typedef struct site {
    enum AVChromaLocation location;
    double x, y; /* of the first chroma sample, in luma samples */
} site;

/* Chroma that grows evenly over the picture, sampled where it lies; luma is constant. */
static unsigned ramps(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)frame;
    const site *where = clip->user;
    double column = 2 * x + where->x, row = 2 * y + where->y;
    return component == 0 ? 32768 : (unsigned)(component == 1 ? 20000 + 500 * column : 20000 + 400 * row);
}

static void chroma_is_found_where_it_lies(void **state)
{
    (void)state;
    static const site SITES[] = {
        {AVCHROMA_LOC_LEFT, 0, 0.5}, {AVCHROMA_LOC_CENTER, 0.5, 0.5}, {AVCHROMA_LOC_TOPLEFT, 0, 0}};
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    make_directory(directory);
    join(path, directory, "clip.mkv");
    helio_context *context = make_context(1, NULL);
    for (size_t i = 0; i < sizeof SITES / sizeof *SITES; i++) {
        const video_clip made = {.muxer = "matroska",
                                 .codec = AV_CODEC_ID_FFV1,
                                 .format = AV_PIX_FMT_YUV420P16,
                                 .width = 32,
                                 .height = 22,
                                 .frames = 1,
                                 .range = AVCOL_RANGE_JPEG,
                                 .primaries = AVCOL_PRI_BT709,
                                 .transfer = AVCOL_TRC_LINEAR,
                                 .matrix = AVCOL_SPC_BT709,
                                 .location = SITES[i].location,
                                 .code = ramps,
                                 .user = &SITES[i]};
        write_clip(path, &made);
        helio_video_reader *reader;
        helio_video_frame frame;
        assert_ok(helio_video_open(context, path, NULL, &reader));
        assert_ok(helio_video_next(reader, &frame));
        for (int y = 1; y < 21; y++)
            for (int x = 1; x < 31; x++) {
                const float *rgb = frame.rgb + 3 * (y * 32 + x);
                double luma = 32768 / 65535.0, cb = (20000 + 500 * x - 32768) / 65535.0;
                double cr = (20000 + 400 * y - 32768) / 65535.0;
                assert_near((double)rgb[0], luma + 1.5748 * cr, 2e-5);
                assert_near((double)rgb[2], luma + 1.8556 * cb, 2e-5);
            }
        helio_video_close(reader);
    }
    helio_context_destroy(context);
    remove_directory(directory);
}

/* ---- turning ---- */

/* Red counts columns and green counts rows. */
static unsigned coordinates(const video_clip *clip, int frame, int component, int x, int y)
{
    (void)clip;
    (void)frame;
    return (unsigned)(component == 0 ? 10 * x : component == 1 ? 10 * y : 0);
}

typedef struct turned {
    int32_t matrix[9];
    int a, b, c, d; /* column = a x + b y, and so on, up to a shift */
} turned;

static void check_turn(helio_context *context, const char *path, const turned *turn)
{
    const video_clip made = {.muxer = "mov",
                             .codec = AV_CODEC_ID_PNG,
                             .format = AV_PIX_FMT_RGB24,
                             .width = 7,
                             .height = 4,
                             .frames = 1,
                             .display = turn->matrix,
                             .code = coordinates};
    helio_video_reader *reader;
    helio_video_frame frame;
    helio_video_read_desc linear_light = {.transfer = HELIO_TRANSFER_LINEAR};
    write_clip(path, &made);
    assert_ok(helio_video_open(context, path, &linear_light, &reader));
    assert_ok(helio_video_next(reader, &frame));
    int width = turn->a != 0 ? 7 : 4, height = turn->a != 0 ? 4 : 7;
    assert_int_equal(frame.width, width);
    assert_int_equal(frame.height, height);
    assert_int_equal(helio_video_get_info(reader).width, width);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 7; x++) {
            int column = turn->a * x + turn->b * y, row = turn->c * x + turn->d * y;
            column += turn->a + turn->b < 0 ? width - 1 : 0;
            row += turn->c + turn->d < 0 ? height - 1 : 0;
            const float *rgb = frame.rgb + 3 * (row * width + column);
            assert_near((double)rgb[0] * 255, 10 * x, 1e-4);
            assert_near((double)rgb[1] * 255, 10 * y, 1e-4);
        }
    helio_video_close(reader);
}

static void pictures_are_turned_as_they_are_to_be_shown(void **state)
{
    (void)state;
    enum { ONE = 1 << 16, UNIT = 1 << 30 };
    static const turned TURNS[] = {
        {{ONE, 0, 0, 0, ONE, 0, 0, 0, UNIT}, 1, 0, 0, 1},
        {{0, ONE, 0, -ONE, 0, 0, 0, 0, UNIT}, 0, -1, 1, 0}, /* a telephone held upright: a quarter clockwise */
        {{0, -ONE, 0, ONE, 0, 0, 0, 0, UNIT}, 0, 1, -1, 0},
        {{-ONE, 0, 0, 0, -ONE, 0, 0, 0, UNIT}, -1, 0, 0, -1},
        {{-ONE, 0, 0, 0, ONE, 0, 0, 0, UNIT}, -1, 0, 0, 1}, /* mirrored */
    };
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE];
    make_directory(directory);
    join(path, directory, "clip.mov");
    helio_context *context = make_context(1, NULL);
    for (size_t i = 0; i < sizeof TURNS / sizeof *TURNS; i++)
        check_turn(context, path, &TURNS[i]);

    const int32_t slanted[9] = {46341, 46341, 0, -46341, 46341, 0, 0, 0, UNIT};
    const video_clip made = {.muxer = "mov",
                             .codec = AV_CODEC_ID_PNG,
                             .format = AV_PIX_FMT_RGB24,
                             .width = 7,
                             .height = 4,
                             .frames = 1,
                             .display = slanted,
                             .code = coordinates};
    write_clip(path, &made);
    helio_video_reader *reader;
    assert_int_equal(helio_video_open(context, path, NULL, &reader), HELIO_ERR_UNSUPPORTED);
    assert_null(reader);
    assert_non_null(strstr(helio_last_error(), "90 degrees"));
    helio_context_destroy(context);
    remove_directory(directory);
}

/* ---- other kinds of pixels ---- */

/* What FFmpeg's own source of a colour gives in this format, in the middle of the picture. */
static void read_colour(helio_context *context, const char *format, helio_transfer transfer, float rgb[3])
{
    char graph[256];
    snprintf(graph, sizeof graph, "color=color=0xff8000:size=24x16:duration=0.1,format=%s", format);
    const helio_video_read_desc desc = {.transfer = transfer, .device = "lavfi"};
    helio_video_reader *reader;
    helio_video_frame frame;
    assert_ok(helio_video_open(context, graph, &desc, &reader));
    assert_ok(helio_video_next(reader, &frame));
    assert_int_equal(frame.bad.nan + frame.bad.infinite + frame.bad.negative, 0);
    memcpy(rgb, frame.rgb + 3 * (8 * 24 + 12), 3 * sizeof *rgb);
    helio_video_close(reader);
}

/* Packed, half-packed, with a palette, of bits, in either byte order, of floats: the same orange, as near as the format
 * can have it and FFmpeg's conversion, which this does not test, comes. */
static void all_kinds_of_pixels_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *format;
        double tolerance;
    } FORMATS[] = {{"rgb24", 1e-6},       {"bgra", 1e-6},      {"gbrp", 0.02},      {"rgb48le", 0.02},
                   {"rgb48be", 0.02},     {"rgba64be", 0.02},  {"gbrp10be", 0.02},  {"rgb565le", 0.04},
                   {"rgb555be", 0.04},    {"bgr8", 0.2},       {"x2rgb10le", 0.02}, {"nv12", 0.02},
                   {"p010le", 0.02},      {"p010be", 0.02},    {"yuyv422", 0.02},   {"uyvy422", 0.02},
                   {"yuv410p", 0.02},     {"yuv411p", 0.02},   {"yuv440p", 0.02},   {"yuva444p10le", 0.02},
                   {"yuv444p16be", 0.02}, {"gbrpf32le", 0.02}, {"gbrpf32be", 0.02}, {"pal8", 0.2}};
    helio_context *context = make_context(1, NULL);
    for (size_t i = 0; i < sizeof FORMATS / sizeof *FORMATS; i++) {
        float rgb[3];
        read_colour(context, FORMATS[i].format, HELIO_TRANSFER_LINEAR, rgb);
        const double orange[3] = {1, 128 / 255.0, 0};
        for (int c = 0; c < 3; c++)
            if (!(fabs((double)rgb[c] - orange[c]) <= FORMATS[i].tolerance))
                fail_msg("%s: channel %d is %g", FORMATS[i].format, c, (double)rgb[c]);
    }
    helio_context_destroy(context);
}

static void bits_and_grey_are_read(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    const char *const formats[] = {"monow", "monob", "gray", "ya8", "gray16be"};
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
        for (int white = 0; white < 2; white++) {
            char graph[256];
            snprintf(graph, sizeof graph, "color=color=%s:size=24x16:duration=0.1,format=%s", white ? "white" : "black",
                     formats[i]);
            const helio_video_read_desc desc = {.device = "lavfi"};
            helio_video_reader *reader;
            helio_video_frame frame;
            assert_ok(helio_video_open(context, graph, &desc, &reader));
            assert_ok(helio_video_next(reader, &frame));
            double sum = 0; /* as FFmpeg may mix dots of black into white */
            for (int k = 0; k < 24 * 16 * 3; k++)
                sum += (double)frame.rgb[k];
            assert_near(sum / (24 * 16 * 3), white, 0.2);
            helio_video_close(reader);
        }
    helio_context_destroy(context);
}
#else

static void without_ffmpeg_video_is_refused_in_a_sentence(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    const helio_video_write_desc desc = {.width = 64, .height = 64};
    helio_video_reader *reader;
    helio_video_writer *writer;
    assert_int_equal(helio_video_open(context, "a.mp4", NULL, &reader), HELIO_ERR_UNSUPPORTED);
    assert_null(reader);
    assert_non_null(strstr(helio_last_error(), "a.mp4"));
    assert_non_null(strstr(helio_last_error(), "FFmpeg"));
    assert_int_equal(helio_video_check_path("b.mp4", &desc), HELIO_ERR_UNSUPPORTED);
    assert_non_null(strstr(helio_last_error(), "b.mp4"));
    assert_int_equal(helio_video_create(context, "c.mp4", &desc, &writer), HELIO_ERR_UNSUPPORTED);
    assert_null(writer);
    assert_non_null(strstr(helio_last_error(), "c.mp4"));
    assert_true(helio_video_has_extension("a.mp4"));
    helio_context_destroy(context);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transfers_have_names),
        cmocka_unit_test(curves_go_through_the_published_points),
        cmocka_unit_test(tables_keep_to_the_curves),
        cmocka_unit_test(encoding_tables_keep_to_the_curves),
#if HELIO_WITH_FFMPEG
        cmocka_unit_test(code_values_become_the_light_that_the_standards_say),
        cmocka_unit_test(what_is_grey_in_a_wider_gamut_is_inside_of_rec709),
        cmocka_unit_test(callers_overrule_the_tags),
        cmocka_unit_test(ictcp_is_undone),
        cmocka_unit_test(chroma_is_found_where_it_lies),
        cmocka_unit_test(pictures_are_turned_as_they_are_to_be_shown),
        cmocka_unit_test(all_kinds_of_pixels_are_read),
        cmocka_unit_test(bits_and_grey_are_read),
#else
        cmocka_unit_test(without_ffmpeg_video_is_refused_in_a_sentence),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
