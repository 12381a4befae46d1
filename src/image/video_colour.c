/* SPDX-License-Identifier: MIT */
#include "image/video_colour.h"

#include "core/error.h"

#include <math.h>

/* What is not a curve of its own is SDR: the camera curves of BT.709, BT.601, SMPTE 240M and BT.2020 are all shown by
 * BT.1886. */
helio_transfer video_colour_transfer(const video_tags *tags, helio_transfer wanted)
{
    if (wanted != HELIO_TRANSFER_AUTO)
        return wanted;
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(tags->format);
    switch (tags->transfer) {
    case AVCOL_TRC_SMPTE2084: return HELIO_TRANSFER_PQ;
    case AVCOL_TRC_ARIB_STD_B67: return HELIO_TRANSFER_HLG;
    case AVCOL_TRC_IEC61966_2_1: return HELIO_TRANSFER_SRGB;
    case AVCOL_TRC_LINEAR: return HELIO_TRANSFER_LINEAR;
    case AVCOL_TRC_UNSPECIFIED:
        return format != NULL && format->flags & AV_PIX_FMT_FLAG_FLOAT ? HELIO_TRANSFER_LINEAR : HELIO_TRANSFER_SDR;
    default: return HELIO_TRANSFER_SDR;
    }
}

/* ---- matrix ---- */

static const double REC709_RED = 0.2126, REC709_BLUE = 0.0722;
static const double BT601_RED = 0.299, BT601_BLUE = 0.114;
static const double BT2020_RED = 0.2627, BT2020_BLUE = 0.0593;

/* R'G'B' of Y'CbCr whose Cb and Cr are (B' - Y') and (R' - Y') over twice what the other two weigh. */
static void set_weights(double red, double blue, colour_matrix *m)
{
    double green = 1 - red - blue, to_red = 2 * (1 - red), to_blue = 2 * (1 - blue);
    *m = (colour_matrix){{{1, 0, to_red}, {1, -blue * to_blue / green, -red * to_red / green}, {1, to_blue, 0}}};
}

void video_colour_matrix(enum AVColorSpace space, colour_matrix *m)
{
    colour_matrix inverse;
    bool is_wide = space == AVCOL_SPC_BT2020_NCL;
    set_weights(is_wide ? BT2020_RED : REC709_RED, is_wide ? BT2020_BLUE : REC709_BLUE, &inverse);
    colour_invert(&inverse, m);
}

static const colour_matrix IDENTITY = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const colour_matrix YCGCO = {{{1, -1, 1}, {1, 1, 0}, {1, -1, -1}}}; /* H.273, components Y, Cg, Co */

/* BT.2100, tables 6 and 7: the inverses of L'M'S' to ICtCp for PQ and for HLG, and of RGB to LMS. */
static const colour_matrix ICTCP_PQ = {{{1, 0.008609037037932761, 0.11102962500302596},
                                        {1, -0.008609037037932761, -0.11102962500302596},
                                        {1, 0.5600313357106791, -0.32062717498731885}}};
static const colour_matrix ICTCP_HLG = {{{1, 0.015718580108730416, 0.2095810681164055},
                                         {1, -0.015718580108730416, -0.20958106811640548},
                                         {1, 1.0212710798422344, -0.6052744909924316}}};
static const colour_matrix LMS_TO_BT2020 = {{{3.4366066943330784, -2.5064521186562698, 0.06984542432319148},
                                             {-0.7913295555989289, 1.983600451792291, -0.192270896193362},
                                             {-0.025949899690592845, -0.09891371471172644, 1.1248636144023193}}};

/* The rule of most players: what is no larger than standard definition is BT.601. */
static enum AVColorSpace guess_matrix(const video_tags *tags)
{
    if (tags->primaries == AVCOL_PRI_BT2020 || tags->transfer == AVCOL_TRC_SMPTE2084 ||
        tags->transfer == AVCOL_TRC_ARIB_STD_B67)
        return AVCOL_SPC_BT2020_NCL;
    return tags->width >= 1280 || tags->height > 576 ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M;
}

static bool find_matrix(enum AVColorSpace space, helio_transfer transfer, colour_matrix *matrix)
{
    switch (space) {
    case AVCOL_SPC_BT709: set_weights(REC709_RED, REC709_BLUE, matrix); return true;
    case AVCOL_SPC_BT470BG:
    case AVCOL_SPC_SMPTE170M: set_weights(BT601_RED, BT601_BLUE, matrix); return true;
    case AVCOL_SPC_BT2020_NCL: set_weights(BT2020_RED, BT2020_BLUE, matrix); return true;
    case AVCOL_SPC_FCC: set_weights(0.30, 0.11, matrix); return true;
    case AVCOL_SPC_SMPTE240M: set_weights(0.212, 0.087, matrix); return true;
    case AVCOL_SPC_YCGCO: *matrix = YCGCO; return true;
    case AVCOL_SPC_ICTCP: *matrix = transfer == HELIO_TRANSFER_HLG ? ICTCP_HLG : ICTCP_PQ; return true;
    default: return false;
    }
}

/* ---- range ---- */

/* scale and offset of codes: component = scale x code + offset. */
static void set_range(const AVPixFmtDescriptor *format, int depth, bool is_full, bool is_chroma, double *scale,
                      double *offset)
{
    if (format->flags & AV_PIX_FMT_FLAG_FLOAT) {
        *scale = 1;
        *offset = 0;
        return;
    }
    double greatest = ldexp(1, depth) - 1, unit = ldexp(1, depth - 8), middle = ldexp(1, depth - 1);
    *scale = is_full ? 1 / greatest : 1 / ((is_chroma ? 224 : 219) * unit);
    *offset = is_chroma ? -middle * *scale : is_full ? 0 : -16 * unit * *scale;
}

/* Of RGB and of grey video without a tag nobody expects a narrow range. */
static bool is_full_range(const video_tags *tags, bool is_rgb)
{
    switch (tags->format) {
    case AV_PIX_FMT_YUVJ411P:
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ440P:
    case AV_PIX_FMT_YUVJ444P: return true;
    default: return tags->range == AVCOL_RANGE_UNSPECIFIED ? is_rgb : tags->range == AVCOL_RANGE_JPEG;
    }
}

static void combine(const AVPixFmtDescriptor *format, bool is_full, bool is_rgb, const colour_matrix *matrix,
                    float signal[3][4])
{
    for (int row = 0; row < 3; row++) {
        double constant = 0;
        for (int column = 0; column < 3; column++) {
            double scale, offset;
            int depth = format->comp[column < format->nb_components ? column : 0].depth;
            set_range(format, depth, is_full, !is_rgb && column > 0, &scale, &offset);
            signal[row][column] = (float)(matrix->m[row][column] * scale);
            constant += matrix->m[row][column] * offset;
        }
        signal[row][3] = (float)constant;
    }
}

/* ---- primaries ---- */

/* H.273, table 2. Rec. 709 is not among them. */
static const struct {
    enum AVColorPrimaries name;
    chromaticities space;
} PRIMARIES[] = {
    {AVCOL_PRI_BT470M, {{0.67, 0.33}, {0.21, 0.71}, {0.14, 0.08}, {0.310, 0.316}}},
    {AVCOL_PRI_BT470BG, {{0.64, 0.33}, {0.29, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}}},
    {AVCOL_PRI_SMPTE170M, {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, {0.3127, 0.3290}}},
    {AVCOL_PRI_SMPTE240M, {{0.630, 0.340}, {0.310, 0.595}, {0.155, 0.070}, {0.3127, 0.3290}}},
    {AVCOL_PRI_FILM, {{0.681, 0.319}, {0.243, 0.692}, {0.145, 0.049}, {0.310, 0.316}}},
    {AVCOL_PRI_BT2020, {{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}},
    {AVCOL_PRI_SMPTE431, {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.314, 0.351}}},
    {AVCOL_PRI_SMPTE432, {{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}}},
    {AVCOL_PRI_EBU3213, {{0.630, 0.340}, {0.295, 0.605}, {0.155, 0.077}, {0.3127, 0.3290}}},
};

static enum AVColorPrimaries guess_primaries(const video_tags *tags)
{
    if (tags->primaries != AVCOL_PRI_UNSPECIFIED && tags->primaries != AVCOL_PRI_RESERVED0)
        return tags->primaries;
    bool is_wide = tags->matrix == AVCOL_SPC_BT2020_NCL || tags->matrix == AVCOL_SPC_ICTCP ||
                   tags->transfer == AVCOL_TRC_SMPTE2084 || tags->transfer == AVCOL_TRC_ARIB_STD_B67;
    return is_wide ? AVCOL_PRI_BT2020 : AVCOL_PRI_BT709;
}

static bool find_primaries(enum AVColorPrimaries name, colour_matrix *to_rec709)
{
    *to_rec709 = IDENTITY;
    if (name == AVCOL_PRI_BT709)
        return true;
    for (size_t i = 0; i < sizeof PRIMARIES / sizeof *PRIMARIES; i++)
        if (PRIMARIES[i].name == name)
            return colour_to_rec709(&PRIMARIES[i].space, to_rec709);
    if (name != AVCOL_PRI_SMPTE428)
        return false;
    *to_rec709 = colour_xyz_to_rec709();
    return true;
}

void video_colour_rec709_to_bt2020(colour_matrix *matrix)
{
    colour_matrix to_rec709;
    find_primaries(AVCOL_PRI_BT2020, &to_rec709);
    colour_invert(&to_rec709, matrix);
}

/* ---- all of it ---- */

static const char *text_or_unknown(const char *text)
{
    return text != NULL ? text : "unknown";
}

helio_status video_colour_resolve(const char *path, const video_tags *tags, helio_transfer wanted, video_colour *colour)
{
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get(tags->format);
    if (format == NULL || format->flags & (AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER) ||
        tags->format == AV_PIX_FMT_XYZ12LE || tags->format == AV_PIX_FMT_XYZ12BE)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s holds pixels of the kind %s, which cannot be read; convert it with FFmpeg", path,
                    text_or_unknown(format != NULL ? format->name : NULL));
    bool is_rgb =
        (format->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0 || format->nb_components <= 2; /* or grey */
    enum AVColorSpace space = tags->matrix;
    if (space == AVCOL_SPC_UNSPECIFIED || space == AVCOL_SPC_RESERVED || space == AVCOL_SPC_RGB)
        space = guess_matrix(tags);
    enum AVColorPrimaries primaries = guess_primaries(tags);
    helio_transfer transfer = video_colour_transfer(tags, wanted);

    colour_matrix matrix = IDENTITY, to_rec709;
    if (!is_rgb && !find_matrix(space, transfer, &matrix))
        return fail(HELIO_ERR_UNSUPPORTED, "%s has the colour matrix %s, which is not known; convert it to bt2020nc",
                    path, text_or_unknown(av_color_space_name(space)));
    if (!find_primaries(primaries, &to_rec709))
        return fail(HELIO_ERR_UNSUPPORTED, "%s has the primaries %s, which are not known; convert it to bt2020", path,
                    text_or_unknown(av_color_primaries_name(primaries)));

    bool is_ictcp = !is_rgb && space == AVCOL_SPC_ICTCP;
    *colour = (video_colour){.transfer = transfer, .is_rgb = is_rgb};
    colour->is_rec709 = primaries == AVCOL_PRI_BT709 && !is_ictcp;
    combine(format, is_full_range(tags, is_rgb), is_rgb, &matrix, colour->signal);
    to_rec709 = colour_multiply(&to_rec709, is_ictcp ? &LMS_TO_BT2020 : &IDENTITY);
    for (int i = 0; i < 9; i++)
        colour->rec709[i / 3][i % 3] = (float)to_rec709.m[i / 3][i % 3];
    return HELIO_OK;
}
