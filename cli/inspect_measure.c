/* SPDX-License-Identifier: MIT */
#include "inspect.h"
#include "stats.h"

#include "message.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

double inspect_luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

/* ---- what kind of file it is ------------------------------------------------------------ */

static const char SIX_FILES[] = "six files";

typedef struct file_mark {
    const char *bytes;
    size_t length;
    const char *kind;
} file_mark;

static const char *kind_of_file(const char *path)
{
    static const file_mark marks[] = {
        {"\x76\x2f\x31\x01", 4, "OpenEXR"},
        {"#?", 2, "Radiance HDR"},
        {"PF", 2, "PFM"},
        {"Pf", 2, "PFM, grey"},
        {"\x89PNG", 4, "PNG"},
        {"\xff\xd8\xff", 3, "JPEG"},
    };
    char start[4] = "";
    FILE *stream = fopen(path, "rb");
    size_t length = stream != NULL ? fread(start, 1, sizeof start, stream) : 0;
    if (stream != NULL)
        fclose(stream);
    for (size_t i = 0; i < sizeof marks / sizeof marks[0]; i++)
        if (length >= marks[i].length && memcmp(start, marks[i].bytes, marks[i].length) == 0)
            return marks[i].kind;
    return SIX_FILES;
}

static const char *kind_of(const inspect_subject *subject)
{
    switch (subject->source->kind) {
    case HELIO_SOURCE_VIDEO: return "video";
    case HELIO_SOURCE_DEVICE: return "device";
    case HELIO_SOURCE_CONSTANT: return "constant light";
    case HELIO_SOURCE_SKY:
    case HELIO_SOURCE_SKY_DAY: return "sky";
    case HELIO_SOURCE_FILE:
    case HELIO_SOURCE_SEQUENCE:
    case HELIO_SOURCE_CALLBACK: break;
    }
    return kind_of_file(subject->frame->name);
}

/* What six files hold is called faces, though in memory it is the same as a strip. */
static helio_layout layout_of(const inspect_subject *subject)
{
    if (subject->frame->rgb == NULL)
        return HELIO_LAYOUT_AUTO;
    return kind_of(subject) == SIX_FILES ? HELIO_LAYOUT_FACES : subject->frame->layout;
}

static const char *why_layout(const inspect_subject *subject)
{
    const helio_source_frame *frame = subject->frame;
    helio_layout guessed;
    if (frame->rgb == NULL)
        return "made for the cube";
    if (frame->width == 1 && frame->height == 1)
        return "one pixel: any layout will do";
    if (subject->layout_is_given)
        return "as --layout says";
    bool is_guessed = helio_layout_guess(frame->width, frame->height, HELIO_LAYOUT_AUTO, &guessed) == HELIO_OK;
    return is_guessed && guessed == layout_of(subject) ? "by its shape" : "as its files say";
}

/* ---- pixels ------------------------------------------------------------------------------ */

/* Faces are squares of that edge; all lie in the second column or in the second row. */
static bool is_in_cross(uint32_t edge, uint32_t column, uint32_t row)
{
    return edge > 0 && (column / edge == 1 || row / edge == 1);
}

static bool is_in_disc(const helio_source_frame *frame, uint32_t column, uint32_t row)
{
    double x = (2.0 * column + 1) / frame->width - 1, y = (2.0 * row + 1) / frame->height - 1;
    return x * x + y * y < 1;
}

/* Crosses and discs do not fill their picture. */
static bool is_used(const helio_source_frame *frame, uint32_t column, uint32_t row)
{
    switch (frame->layout) {
    case HELIO_LAYOUT_CROSS_V: return is_in_cross(frame->width / 3, column, row);
    case HELIO_LAYOUT_CROSS_H: return is_in_cross(frame->width / 4, column, row);
    case HELIO_LAYOUT_ANGULAR:
    case HELIO_LAYOUT_MIRRORBALL: return is_in_disc(frame, column, row);
    default: return true;
    }
}

/* The pixel as light: what is none of it is 0. */
static void take_light(const float from[3], float to[3])
{
    const float brightest = 1e30f;
    bool good = fabsf(from[0]) <= brightest && fabsf(from[1]) <= brightest && fabsf(from[2]) <= brightest;
    for (int c = 0; c < 3; c++)
        to[c] = good && from[c] > 0 ? from[c] : 0;
}

static double greatest_of(const float rgb[3])
{
    return fmax(fmax((double)rgb[0], (double)rgb[1]), (double)rgb[2]);
}

static void count_range(inspect_findings *found, const float rgb[3])
{
    double value = inspect_luminance(rgb), channel = greatest_of(rgb);
    found->least = found->pixels == 0 ? value : fmin(found->least, value);
    found->greatest = fmax(found->greatest, value);
    found->greatest_channel = fmax(found->greatest_channel, channel);
    found->pixels++;
    if (value > 0)
        found->least_positive = found->least_positive > 0 ? fmin(found->least_positive, value) : value;
    else
        found->dark++;
}

static void count_brightest(inspect_findings *found, const float rgb[3])
{
    double channel = greatest_of(rgb);
    found->plateau += channel == found->greatest_channel;
    found->bright += channel >= 0.1 * found->greatest_channel;
}

/* Hands all pixels that mean something to a function, as light. */
static void for_each_pixel(const inspect_subject *subject, inspect_findings *found,
                           void (*function)(inspect_findings *found, const float rgb[3]))
{
    const helio_source_frame *frame = subject->frame;
    size_t texels = FACE_COUNT * (size_t)found->cube_size * found->cube_size;
    const float *cube = helio_environment_cube(subject->environment), *pixel = frame->rgb;
    float rgb[3];
    for (size_t i = 0; frame->rgb == NULL && i < texels; i++)
        function(found, cube + 3 * i);
    for (uint32_t row = 0; frame->rgb != NULL && row < frame->height; row++)
        for (uint32_t column = 0; column < frame->width; column++, pixel += 3)
            if (is_used(frame, column, row)) {
                take_light(pixel, rgb);
                function(found, rgb);
            }
}

static void count_pixels(const inspect_subject *subject, inspect_findings *found)
{
    for_each_pixel(subject, found, count_range);
    for_each_pixel(subject, found, count_brightest);
    if (found->least_positive > 0)
        found->stops = log2(found->greatest / found->least_positive);
}

/* ---- the sphere -------------------------------------------------------------------------- */

static size_t bin_of(double value)
{
    double bin = floor((log2(value) - LOWEST_STOP) * STOP_BINS); /* of no light: the lowest */
    return (size_t)fmin(fmax(bin, 0), HISTOGRAM_BINS - 1);
}

static void add_texel(inspect_findings *found, int face, uint32_t row, uint32_t column, const float rgb[3],
                      double upper[HISTOGRAM_BINS])
{
    uint32_t size = found->cube_size;
    double area = face_solid_angle(size, row, column), value = inspect_luminance(rgb), direction[3];
    for (int c = 0; c < 3; c++)
        found->mean[c] += area * (double)rgb[c];
    face_direction(face, (2.0 * column + 1) / size - 1, (2.0 * row + 1) / size - 1, direction);
    double up =
        direction[1] / sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    found->irradiance += area * value * fmax(up, 0);
    if (up > 0) {
        upper[bin_of(value)] += area;
        found->upper_mean += area * value;
    }
    if (value > 0) {
        found->histogram.area[bin_of(value)] += area;
        found->histogram.light[bin_of(value)] += area * value;
    } else {
        found->histogram.black += area;
    }
}

/* Luminance that half of the solid angle does not reach. */
static double find_median(const double area[HISTOGRAM_BINS])
{
    double all = 0, below = 0;
    for (int i = 0; i < HISTOGRAM_BINS; i++)
        all += area[i];
    int bin = 0;
    while (bin < HISTOGRAM_BINS - 1 && below + area[bin] < all / 2)
        below += area[bin++];
    return exp2(LOWEST_STOP + (bin + 0.5) / STOP_BINS);
}

static void integrate(const inspect_subject *subject, inspect_findings *found)
{
    const double sphere = 4 * acos(-1);
    const float *rgb = helio_environment_cube(subject->environment);
    double upper[HISTOGRAM_BINS] = {0};
    for (int face = 0; face < FACE_COUNT; face++)
        for (uint32_t row = 0; row < found->cube_size; row++)
            for (uint32_t column = 0; column < found->cube_size; column++, rgb += 3)
                add_texel(found, face, row, column, rgb, upper);
    for (int c = 0; c < 3; c++)
        found->mean[c] /= sphere;
    found->upper_median = find_median(upper);
    for (int face = 0; face < FACE_COUNT; face++) {
        found->flux[face] = subject->light->flux[face];
        found->all_flux += found->flux[face];
    }
    found->mean_luminance = found->all_flux / sphere;
}

bool inspect_measure(const inspect_subject *subject, inspect_findings *found)
{
    const helio_source_frame *frame = subject->frame;
    stats_frame pixels = {0};
    stats_note_bad_pixels(&pixels, &frame->bad, &subject->light->bad);
    *found = (inspect_findings){
        .name = frame->name,
        .file_kind = kind_of(subject),
        .layout_why = why_layout(subject),
        .layout = layout_of(subject),
        .width = frame->width,
        .height = frame->height,
        .cube_size = helio_environment_cube_size(subject->environment),
        .is_dynamic = subject->source->is_dynamic,
        .frame = frame->index,
        .bad = {.nan = pixels.nan, .infinite = pixels.infinite, .negative = pixels.negative},
        .out_of_gamut = pixels.out_of_gamut,
        .exposure = (double)subject->light->auto_exposure,
    };
    count_pixels(subject, found);
    integrate(subject, found);
    if (!inspect_find_spot(helio_environment_cube(subject->environment), found->cube_size, found))
        return false;
    const inspect_spot *spot = &found->spot;
    if (spot->elevation > 0)
        found->upper_mean -= spot->share * found->all_flux;
    found->upper_mean = fmax(found->upper_mean, 0) / (2 * acos(-1));
    inspect_judge(found);
    return true;
}
