/* SPDX-License-Identifier: MIT
 *
 * The cube of the figure: the map, what of it lies below the point's horizon, samples and normal. */
#include "samples_drawing.h"
#include "srgb.h"

#include <math.h>
#include <string.h>

/* ---- the map ------------------------------------------------------------------------------ */

typedef struct map_tone {
    float intensity, exposure;
    helio_tonemap tonemap;
} map_tone;

static void colour_radiance(const void *data, const double rgb[3], double shown[3])
{
    const map_tone *tone = data;
    float pixel[3];
    for (int c = 0; c < 3; c++)
        pixel[c] = (float)rgb[c] * tone->intensity;
    helio_tonemap_apply(tone->tonemap, tone->exposure, pixel, pixel);
    for (int c = 0; c < 3; c++)
        shown[c] = srgb_encode((double)pixel[c]);
}

/* ---- the horizon --------------------------------------------------------------------------- */

/* The part of a face that lies below a horizon, in its coordinates u and v: great circles are straight lines there. */
typedef struct lower_part {
    double corners[6][2];
    int corner_count;
    double ends[2][2]; /* of the horizon, where it crosses the face */
    int end_count;
} lower_part;

static double height_of(const float normal[3], int face, const double uv[2])
{
    double direction[3];
    face_direction(face, uv[0], uv[1], direction);
    return (double)normal[0] * direction[0] + (double)normal[1] * direction[1] + (double)normal[2] * direction[2];
}

static lower_part find_lower_part(const float normal[3], int face)
{
    static const double square[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    lower_part part = {.corner_count = 0};
    for (int i = 0; i < 4; i++) {
        const double *here = square[i], *next = square[(i + 1) % 4];
        double height = height_of(normal, face, here), next_height = height_of(normal, face, next);
        if (height < 0)
            memcpy(part.corners[part.corner_count++], here, sizeof part.corners[0]);
        if ((height < 0) == (next_height < 0))
            continue;
        double t = height / (height - next_height);
        double crossing[2] = {here[0] + t * (next[0] - here[0]), here[1] + t * (next[1] - here[1])};
        memcpy(part.corners[part.corner_count++], crossing, sizeof crossing);
        if (part.end_count < 2)
            memcpy(part.ends[part.end_count++], crossing, sizeof crossing);
    }
    return part;
}

static void line_to(const samples_drawing *d, int face, const double uv[2])
{
    double x, y;
    cube_cross_corner(&d->cross, face, &x, &y);
    cairo_line_to(d->cairo, x + (uv[0] + 1) / 2 * d->cross.edge, y + (uv[1] + 1) / 2 * d->cross.edge);
}

static void darken_below(const samples_drawing *d, const float normal[3])
{
    cairo_new_path(d->cairo);
    for (int face = 0; face < FACE_COUNT; face++) {
        lower_part part = find_lower_part(normal, face);
        cairo_new_sub_path(d->cairo);
        for (int i = 0; i < part.corner_count; i++)
            line_to(d, face, part.corners[i]);
        cairo_close_path(d->cairo);
    }
    cairo_set_source_rgba(d->cairo, 0, 0, 0, 0.45);
    cairo_fill(d->cairo);
}

static void trace_horizon(const samples_drawing *d, const float normal[3])
{
    cairo_new_path(d->cairo);
    for (int face = 0; face < FACE_COUNT; face++) {
        lower_part part = find_lower_part(normal, face);
        if (part.end_count < 2)
            continue;
        cairo_new_sub_path(d->cairo);
        line_to(d, face, part.ends[0]);
        line_to(d, face, part.ends[1]);
    }
}

bool samples_has_flat_horizon(const samples_findings *found)
{
    const double hair = 1.0; /* degrees */
    double cosine = 0;
    for (int c = 0; c < 3; c++)
        cosine += (double)found->normal[c] * (double)found->geometric_normal[c];
    return cosine < cos(hair * acos(-1) / 180);
}

void samples_draw_map(const samples_drawing *d)
{
    const samples_view *view = d->view;
    const map_tone tone = {.intensity = (float)view->plan->options->intensity,
                           .exposure = view->picture.exposure,
                           .tonemap = view->picture.tonemap};
    const cube_picture picture = {.cube = view->cube,
                                  .size = view->cube_size,
                                  .pixels = (int)d->cross.edge * d->detail,
                                  .colour = colour_radiance,
                                  .data = &tone};
    cube_cross_draw(d->cairo, &d->cross, &picture);
    darken_below(d, view->found->normal);
    if (samples_has_flat_horizon(view->found)) {
        trace_horizon(d, view->found->geometric_normal);
        samples_stroke_horizon(d->cairo, d->size, true);
    }
    trace_horizon(d, view->found->normal);
    samples_stroke_horizon(d->cairo, d->size, false);
}

/* ---- samples ------------------------------------------------------------------------------ */

static void place(const samples_drawing *d, const float direction[3], double *x, double *y)
{
    const double wide[3] = {(double)direction[0], (double)direction[1], (double)direction[2]};
    cube_cross_place(&d->cross, wide, x, y);
}

void samples_draw_pools(const samples_drawing *d)
{
    const samples_findings *found = d->view->found;
    cairo_new_path(d->cairo);
    for (uint32_t i = 0; i < found->pooled; i++) {
        double x, y;
        place(d, found->pools[i].direction, &x, &y);
        samples_add_dot(d->cairo, x, y);
    }
    samples_stroke_dots(d->cairo, d->size / sqrt(found->passes));
}

static samples_mark mark_of(const point_sample *sample)
{
    bool is_surface = sample->technique == SURFACE_TECHNIQUE;
    if (sample->fate == SAMPLE_USED)
        return is_surface ? MARK_SURFACE_USED : MARK_USED;
    if (sample->fate == SAMPLE_SHADOWED)
        return is_surface ? MARK_SURFACE_SHADOWED : MARK_SHADOWED;
    return is_surface ? MARK_SURFACE_USELESS : MARK_USELESS;
}

/* The best ones last, so that they are on top. */
static void draw_fates(const samples_drawing *d)
{
    const samples_findings *found = d->view->found;
    for (int fate = SAMPLE_FATES - 1; fate >= 0; fate--)
        for (uint32_t i = 0; i < found->sample_count; i++) {
            double x, y;
            if ((int)found->samples[i].fate != fate)
                continue;
            place(d, found->samples[i].direction, &x, &y);
            samples_draw_mark(d->cairo, mark_of(&found->samples[i]), x, y, d->size);
        }
}

void samples_draw_samples(const samples_drawing *d)
{
    double x, y;
    draw_fates(d);
    place(d, d->view->found->normal, &x, &y);
    samples_draw_mark(d->cairo, MARK_NORMAL, x, y, d->size);
}
