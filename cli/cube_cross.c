/* SPDX-License-Identifier: MIT */
#include "cube_cross.h"

#include "figure_text.h"

#include <string.h>

/* Where each face lies in the cross, in faces from the upper left. */
static const int PLACES[FACE_COUNT][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};

/* ---- the picture --------------------------------------------------------------------------- */

/* First texel, and the one after the last, that a pixel covers: at least one. */
static void find_range(int pixel, int pixels, uint32_t size, uint32_t range[2])
{
    range[0] = (uint32_t)((uint64_t)pixel * size / (uint64_t)pixels);
    range[1] = (uint32_t)(((uint64_t)pixel + 1) * size / (uint64_t)pixels);
    if (range[1] <= range[0])
        range[1] = range[0] + 1;
}

static void average(const float *face, uint32_t size, const uint32_t rows[2], const uint32_t columns[2], double rgb[3])
{
    double sum[3] = {0, 0, 0};
    for (uint32_t y = rows[0]; y < rows[1]; y++)
        for (uint32_t x = columns[0]; x < columns[1]; x++)
            for (int c = 0; c < 3; c++)
                sum[c] += (double)face[3 * ((size_t)y * size + x) + c];
    for (int c = 0; c < 3; c++)
        rgb[c] = sum[c] / ((double)(rows[1] - rows[0]) * (columns[1] - columns[0]));
}

static uint32_t pack(const double shown[3])
{
    return (uint32_t)(shown[0] * 255 + 0.5) << 16 | (uint32_t)(shown[1] * 255 + 0.5) << 8 |
           (uint32_t)(shown[2] * 255 + 0.5);
}

static void fill_row(const cube_picture *picture, const float *face, int row, unsigned char *data)
{
    uint32_t rows[2], columns[2];
    find_range(row, picture->pixels, picture->size, rows);
    for (int column = 0; column < picture->pixels; column++) {
        double rgb[3], shown[3];
        find_range(column, picture->pixels, picture->size, columns);
        average(face, picture->size, rows, columns, rgb);
        picture->colour(picture->data, rgb, shown);
        uint32_t pixel = pack(shown);
        memcpy(data + 4 * column, &pixel, sizeof pixel);
    }
}

static cairo_surface_t *make_face(const cube_picture *picture, int face)
{
    const float *texels = picture->cube + 3 * (size_t)face * picture->size * picture->size;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, picture->pixels, picture->pixels);
    unsigned char *data = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int row = 0; data != NULL && row < picture->pixels; row++)
        fill_row(picture, texels, row, data + (ptrdiff_t)row * stride);
    cairo_surface_mark_dirty(surface);
    return surface;
}

void cube_cross_draw(cairo_t *cairo, const cube_cross *cross, const cube_picture *picture)
{
    for (int face = 0; face < FACE_COUNT; face++) {
        double x, y, scale = cross->edge / picture->pixels;
        cube_cross_corner(cross, face, &x, &y);
        cairo_surface_t *surface = make_face(picture, face);
        cairo_save(cairo);
        cairo_translate(cairo, x, y);
        cairo_scale(cairo, scale, scale);
        cairo_set_source_surface(cairo, surface, 0, 0);
        cairo_paint(cairo);
        cairo_restore(cairo);
        cairo_surface_destroy(surface);
    }
}

/* ---- places -------------------------------------------------------------------------------- */

void cube_cross_corner(const cube_cross *cross, int face, double *x, double *y)
{
    *x = cross->left + PLACES[face][0] * cross->edge;
    *y = cross->top + PLACES[face][1] * cross->edge;
}

void cube_cross_place(const cube_cross *cross, const double direction[3], double *x, double *y)
{
    double u, v;
    int face = face_project(direction, &u, &v);
    cube_cross_corner(cross, face, x, y);
    *x += (u + 1) / 2 * cross->edge;
    *y += (v + 1) / 2 * cross->edge;
}

void cube_cross_label(cairo_t *cairo, const cube_cross *cross, int face, double font_size, const char *text)
{
    double x, y;
    cube_cross_corner(cross, face, &x, &y);
    set_grey(cairo, BACKGROUND);
    cairo_set_line_width(cairo, 1);
    cairo_rectangle(cairo, x + 0.5, y + 0.5, cross->edge - 1, cross->edge - 1);
    cairo_stroke(cairo);
    set_font(cairo, font_size, true);
    cairo_set_source_rgba(cairo, BACKGROUND, BACKGROUND, BACKGROUND, 0.75);
    cairo_rectangle(cairo, x + 1, y + 1, text_width(cairo, text) + font_size + 1, font_size + 9);
    cairo_fill(cairo);
    set_grey(cairo, INK);
    draw_text(cairo, x + font_size / 2 + 1.5, y + font_size + 3, 0, text);
}

void cube_cross_clip(cairo_t *cairo, const cube_cross *cross)
{
    cairo_new_path(cairo);
    for (int face = 0; face < FACE_COUNT; face++) {
        double x, y;
        cube_cross_corner(cross, face, &x, &y);
        cairo_rectangle(cairo, x, y, cross->edge, cross->edge);
    }
    cairo_clip(cairo);
}
