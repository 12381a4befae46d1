/* SPDX-License-Identifier: MIT
 *
 * The figure of one frame: the cube unfolded as a horizontal cross with the samples in it; around it, where the cross
 * leaves room, the render, the legend and the counts. */
#include "figure.h"
#include "output_file.h"
#include "samples_drawing.h"
#include "srgb.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    FACE_EDGE = 320,
    GAP = 16,
    WIDTH = 4 * FACE_EDGE + 2 * SAMPLES_MARGIN,
    HEIGHT = 3 * FACE_EDGE + 2 * SAMPLES_MARGIN
};

int samples_detail(const char *path)
{
    return output_file_has_extension(path, "png") ? 1 : 2;
}

/* ---- the render --------------------------------------------------------------------------- */

static uint32_t pack(const float rgb[3])
{
    uint32_t pixel = 0;
    for (int c = 0; c < 3; c++)
        pixel = pixel << 8 | (uint32_t)(srgb_encode((double)rgb[c]) * 255 + 0.5);
    return pixel;
}

static void fill_surface(cairo_surface_t *surface, const float *rgb, size_t width, size_t height)
{
    unsigned char *data = cairo_image_surface_get_data(surface);
    size_t stride = (size_t)cairo_image_surface_get_stride(surface);
    for (size_t row = 0; data != NULL && row < height; row++)
        for (size_t column = 0; column < width; column++) {
            uint32_t pixel = pack(rgb + 3 * (row * width + column));
            memcpy(data + row * stride + 4 * column, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
}

/* Where there is no memory, one that is in error: cairo keeps that in mind for the whole figure. */
static cairo_surface_t *make_surface(const shown_picture *picture, uint32_t width, uint32_t height)
{
    float *rgb = malloc((size_t)width * height * 3 * sizeof *rgb);
    if (rgb == NULL)
        return cairo_image_surface_create(CAIRO_FORMAT_RGB24, -1, -1);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)height);
    shown_picture_shrink(picture, width, height, rgb);
    fill_surface(surface, rgb, width, height);
    free(rgb);
    return surface;
}

/* Pixels that are enlarged stay squares. */
static void paint_picture(const samples_drawing *d, double left, double top, double scale)
{
    const shown_picture *picture = &d->view->picture;
    double shrink = fmin(scale * d->detail, 1);
    uint32_t width = (uint32_t)fmax(round(picture->width * shrink), 1);
    uint32_t height = (uint32_t)fmax(round(picture->height * shrink), 1);
    cairo_surface_t *surface = make_surface(picture, width, height);
    cairo_save(d->cairo);
    cairo_translate(d->cairo, left, top);
    cairo_scale(d->cairo, picture->width * scale / width, picture->height * scale / height);
    cairo_set_source_surface(d->cairo, surface, 0, 0);
    if (scale > 1)
        cairo_pattern_set_filter(cairo_get_source(d->cairo), CAIRO_FILTER_NEAREST);
    cairo_paint(d->cairo);
    cairo_restore(d->cairo);
    cairo_surface_destroy(surface);
}

static void trace_crosshair(cairo_t *cairo, double x, double y, double size)
{
    const double near = 8 * size, far = 18 * size;
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, near, 0, 2 * acos(-1));
    for (int side = 0; side < 4; side++) {
        double along_x = side % 2 == 0 ? side - 1.0 : 0, along_y = side % 2 == 0 ? 0 : side - 2.0;
        cairo_move_to(cairo, x + near * along_x, y + near * along_y);
        cairo_line_to(cairo, x + far * along_x, y + far * along_y);
    }
}

static void mark_pixel(const samples_drawing *d, double x, double y)
{
    trace_crosshair(d->cairo, x, y, d->size);
    cairo_set_source_rgba(d->cairo, 0, 0, 0, 0.7);
    cairo_set_line_width(d->cairo, 4.5 * d->size);
    cairo_stroke_preserve(d->cairo);
    set_accent(d->cairo);
    cairo_set_line_width(d->cairo, 2 * d->size);
    cairo_stroke(d->cairo);
}

void samples_draw_render(const samples_drawing *d, double left, double top, double width, double height)
{
    const shown_picture *picture = &d->view->picture;
    double scale = fmin(width / picture->width, height / picture->height);
    double shown_width = picture->width * scale, shown_height = picture->height * scale;
    cairo_save(d->cairo);
    cairo_rectangle(d->cairo, left, top, shown_width, shown_height);
    cairo_clip(d->cairo);
    paint_picture(d, left, top, scale);
    mark_pixel(d, left + (d->view->found->x + 0.5) * scale, top + (d->view->found->y + 0.5) * scale);
    cairo_restore(d->cairo);
}

/* ---- the figure --------------------------------------------------------------------------- */

static void draw_words(const samples_drawing *d)
{
    const double edge = FACE_EDGE, far = SAMPLES_MARGIN + 2 * edge + GAP, low = SAMPLES_MARGIN + 2 * edge + GAP;
    const double width = WIDTH - SAMPLES_MARGIN - far;
    char remark[256];
    samples_draw_title(d, SAMPLES_MARGIN, SAMPLES_MARGIN, edge - GAP);
    samples_draw_bars(d, SAMPLES_MARGIN, SAMPLES_MARGIN + edge - GAP, edge - GAP);
    samples_draw_table(d, SAMPLES_MARGIN, low, edge - GAP);
    double y = samples_draw_legend(d, far, low, width);
    samples_remark(d->view->found, remark, sizeof remark - 1);
    strcat(remark, ".");
    set_font(d->cairo, 14, true);
    set_grey(d->cairo, INK);
    draw_paragraph(d->cairo, far, y + 16, width, 20, remark);
}

typedef struct figure_of_samples {
    const samples_view *view;
    int detail;
} figure_of_samples;

static void draw_figure(cairo_t *cairo, const void *data)
{
    const figure_of_samples *content = data;
    const samples_drawing d = {.cairo = cairo,
                               .view = content->view,
                               .cross = {.left = SAMPLES_MARGIN, .top = SAMPLES_MARGIN, .edge = FACE_EDGE},
                               .size = 1,
                               .detail = content->detail};
    const double left = SAMPLES_MARGIN + 2 * FACE_EDGE + GAP;
    set_grey(cairo, BACKGROUND);
    cairo_paint(cairo);
    samples_draw_map(&d);
    samples_draw_pools(&d);
    samples_draw_face_labels(&d, 13);
    samples_draw_samples(&d);
    samples_draw_render(&d, left, SAMPLES_MARGIN, WIDTH - SAMPLES_MARGIN - left, FACE_EDGE - GAP);
    draw_words(&d);
}

int samples_draw(const char *path, const samples_view *view)
{
    const figure_of_samples content = {view, samples_detail(path)};
    const figure whole = {.width = WIDTH, .height = HEIGHT, .draw = draw_figure, .data = &content};
    return figure_write("out", path, &whole);
}
