/* SPDX-License-Identifier: MIT
 *
 * The picture of inspect: the cube unfolded as a horizontal cross in false colours, what was found to its upper right,
 * a histogram with the scale of the colours to its lower right. */
#include "cube_cross.h"
#include "figure.h"
#include "inspect_drawing.h"

#include <math.h>
#include <stdio.h>

static const cube_cross CROSS = {.left = MARGIN, .top = MARGIN, .edge = FACE_EDGE};

static void colour_luminance(const void *data, const double rgb[3], double shown[3])
{
    double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    shown[0] = shown[1] = shown[2] = 0;
    if (luminance > 0)
        colour_scale_colour(data, log2(luminance), shown);
}

static void draw_map(const drawing *d)
{
    const cube_picture picture = {.cube = d->cube,
                                  .size = d->found->cube_size,
                                  .pixels = FACE_EDGE,
                                  .colour = colour_luminance,
                                  .data = &d->scale};
    cube_cross_draw(d->cairo, &CROSS, &picture);
}

static void draw_face_labels(const drawing *d)
{
    const inspect_findings *found = d->found;
    for (int face = 0; face < FACE_COUNT; face++) {
        char text[64];
        snprintf(text, sizeof text, "%s   %.3g %%", face_names[face],
                 found->all_flux > 0 ? 100 * found->flux[face] / found->all_flux : 0.0);
        cube_cross_label(d->cairo, &CROSS, face, 13, text);
    }
}

/* Around the brightest spot, at least so large that it is seen. */
static void mark_spot(const drawing *d)
{
    const inspect_spot *spot = &d->found->spot;
    double x, y, radius = sqrt(spot->solid_angle / acos(-1)) * FACE_EDGE / 2 + 5;
    if (!d->found->has_spot)
        return;
    cube_cross_place(&CROSS, spot->direction, &x, &y);
    cairo_save(d->cairo);
    cube_cross_clip(d->cairo, &CROSS);
    draw_ring(d->cairo, x, y, fmax(radius, 9));
    cairo_restore(d->cairo);
}

typedef struct inspect_picture {
    const inspect_findings *found;
    const float *cube;
} inspect_picture;

static void draw_all(cairo_t *cairo, const void *data)
{
    const inspect_picture *picture = data;
    const drawing d = {.cairo = cairo,
                       .found = picture->found,
                       .cube = picture->cube,
                       .scale = colour_scale_choose(&picture->found->histogram)};
    set_grey(cairo, BACKGROUND);
    cairo_paint(cairo);
    draw_map(&d);
    draw_face_labels(&d);
    mark_spot(&d);
    const double left = MARGIN + 2 * FACE_EDGE + 20, width = WIDTH - MARGIN - left;
    draw_findings(&d, left, MARGIN, width);
    draw_histogram(&d, left, MARGIN + 2 * FACE_EDGE + 14, width, FACE_EDGE - 14);
}

int inspect_draw(const char *path, const inspect_findings *found, const float *cube)
{
    const inspect_picture picture = {found, cube};
    const figure whole = {.width = WIDTH, .height = HEIGHT, .draw = draw_all, .data = &picture};
    return figure_write("out", path, &whole);
}
