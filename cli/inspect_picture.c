/* SPDX-License-Identifier: MIT
 *
 * The picture of inspect: the cube unfolded as a horizontal cross in false colours, what was found to its upper right,
 * a histogram with the scale of the colours to its lower right. */
#include "inspect_drawing.h"

#include "message.h"
#include "output_file.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* ---- faces -------------------------------------------------------------------------------- */

/* Where each face lies in the cross, in faces from the upper left. */
static const int FACE_PLACES[FACE_COUNT][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};

/* Average luminance of the texels that a pixel of the drawing covers; texels that are larger show as squares. */
static double covered(const float *face, uint32_t size, int row, int column)
{
    uint32_t top = (uint32_t)row * size / FACE_EDGE, bottom = (uint32_t)(row + 1) * size / FACE_EDGE;
    uint32_t left = (uint32_t)column * size / FACE_EDGE, right = (uint32_t)(column + 1) * size / FACE_EDGE;
    bottom = bottom > top ? bottom : top + 1;
    right = right > left ? right : left + 1;
    double sum = 0;
    for (uint32_t y = top; y < bottom; y++)
        for (uint32_t x = left; x < right; x++) {
            const float *rgb = face + 3 * ((size_t)y * size + x);
            sum += 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
        }
    return sum / ((double)(bottom - top) * (right - left));
}

static uint32_t pixel_of(const colour_scale *scale, double luminance)
{
    double rgb[3] = {0, 0, 0};
    if (luminance > 0)
        colour_scale_colour(scale, log2(luminance), rgb);
    return (uint32_t)(rgb[0] * 255 + 0.5) << 16 | (uint32_t)(rgb[1] * 255 + 0.5) << 8 | (uint32_t)(rgb[2] * 255 + 0.5);
}

static void draw_face(const drawing *d, int face)
{
    uint32_t size = d->found->cube_size;
    const float *texels = d->cube + 3 * (size_t)face * size * size;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, FACE_EDGE, FACE_EDGE);
    unsigned char *data = cairo_image_surface_get_data(surface);
    int stride = cairo_image_surface_get_stride(surface);
    for (int row = 0; data != NULL && row < FACE_EDGE; row++)
        for (int column = 0; column < FACE_EDGE; column++) {
            uint32_t pixel = pixel_of(&d->scale, covered(texels, size, row, column));
            memcpy(data + row * stride + 4 * column, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
    cairo_set_source_surface(d->cairo, surface, MARGIN + FACE_PLACES[face][0] * FACE_EDGE,
                             MARGIN + FACE_PLACES[face][1] * FACE_EDGE);
    cairo_paint(d->cairo);
    cairo_surface_destroy(surface);
}

static void draw_face_label(const drawing *d, int face)
{
    const inspect_findings *found = d->found;
    cairo_t *cairo = d->cairo;
    double x = MARGIN + FACE_PLACES[face][0] * FACE_EDGE, y = MARGIN + FACE_PLACES[face][1] * FACE_EDGE;
    char text[64];
    snprintf(text, sizeof text, "%s   %.3g %%", face_names[face],
             found->all_flux > 0 ? 100 * found->flux[face] / found->all_flux : 0.0);
    set_grey(cairo, BACKGROUND);
    cairo_set_line_width(cairo, 1);
    cairo_rectangle(cairo, x + 0.5, y + 0.5, FACE_EDGE - 1, FACE_EDGE - 1);
    cairo_stroke(cairo);
    set_font(cairo, 13, true);
    cairo_set_source_rgba(cairo, BACKGROUND, BACKGROUND, BACKGROUND, 0.75);
    cairo_rectangle(cairo, x + 1, y + 1, text_width(cairo, text) + 14, 22);
    cairo_fill(cairo);
    set_grey(cairo, INK);
    draw_text(cairo, x + 8, y + 16, 0, text);
}

static void draw_ring(cairo_t *cairo, double x, double y, double radius)
{
    cairo_new_path(cairo);
    cairo_arc(cairo, x, y, radius, 0, 2 * acos(-1));
    cairo_set_line_width(cairo, 4);
    set_grey(cairo, BACKGROUND);
    cairo_stroke_preserve(cairo);
    cairo_set_line_width(cairo, 2);
    set_accent(cairo);
    cairo_stroke(cairo);
}

/* Nothing but faces can be drawn on from here on. */
static void clip_to_faces(cairo_t *cairo)
{
    cairo_new_path(cairo);
    for (int face = 0; face < FACE_COUNT; face++)
        cairo_rectangle(cairo, MARGIN + FACE_PLACES[face][0] * FACE_EDGE, MARGIN + FACE_PLACES[face][1] * FACE_EDGE,
                        FACE_EDGE, FACE_EDGE);
    cairo_clip(cairo);
}

/* Around the brightest spot, at least so large that it is seen. */
static void mark_spot(const drawing *d)
{
    enum { FINE = 1 << 20 }; /* texels of a cube that is fine enough to place the mark */
    const inspect_spot *spot = &d->found->spot;
    if (!d->found->has_spot)
        return;
    size_t texel = face_texel(FINE, spot->direction), face = texel / ((size_t)FINE * FINE);
    double row = (double)(texel / FINE % FINE) / FINE, column = (double)(texel % FINE) / FINE;
    double radius = sqrt(spot->solid_angle / acos(-1)) * FACE_EDGE / 2 + 5;
    cairo_save(d->cairo);
    clip_to_faces(d->cairo);
    draw_ring(d->cairo, MARGIN + (FACE_PLACES[face][0] + column) * FACE_EDGE,
              MARGIN + (FACE_PLACES[face][1] + row) * FACE_EDGE, fmax(radius, 9));
    cairo_restore(d->cairo);
}

static void draw_all(cairo_t *cairo, const inspect_findings *found, const float *cube)
{
    const drawing d = {.cairo = cairo, .found = found, .cube = cube, .scale = colour_scale_choose(&found->histogram)};
    set_grey(cairo, BACKGROUND);
    cairo_paint(cairo);
    for (int face = 0; face < FACE_COUNT; face++)
        draw_face(&d, face);
    for (int face = 0; face < FACE_COUNT; face++)
        draw_face_label(&d, face);
    mark_spot(&d);
    const double left = MARGIN + 2 * FACE_EDGE + 20, width = WIDTH - MARGIN - left;
    draw_findings(&d, left, MARGIN, width);
    draw_histogram(&d, left, MARGIN + 2 * FACE_EDGE + 14, width, FACE_EDGE - 14);
}

/* ---- files -------------------------------------------------------------------------------- */

/* Cairo has one word for all that may go wrong with a file; the system's is kept here. */
typedef struct picture_stream {
    FILE *file;
    int error; /* of errno; 0 while all is well */
} picture_stream;

static cairo_status_t write_bytes(void *user, const unsigned char *bytes, unsigned length)
{
    picture_stream *stream = user;
    errno = 0;
    if (fwrite(bytes, 1, length, stream->file) == length)
        return CAIRO_STATUS_SUCCESS;
    stream->error = errno;
    return CAIRO_STATUS_WRITE_ERROR;
}

static cairo_status_t draw_to(picture_stream *stream, const char *path, const inspect_findings *found,
                              const float *cube)
{
    bool is_png = output_file_has_extension(path, "png");
    cairo_surface_t *surface = is_png ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, WIDTH, HEIGHT)
                               : output_file_has_extension(path, "svg")
                                   ? cairo_svg_surface_create_for_stream(write_bytes, stream, WIDTH, HEIGHT)
                                   : cairo_pdf_surface_create_for_stream(write_bytes, stream, WIDTH, HEIGHT);
    cairo_t *cairo = cairo_create(surface);
    draw_all(cairo, found, cube);
    cairo_status_t status = cairo_status(cairo);
    cairo_destroy(cairo);
    if (status == CAIRO_STATUS_SUCCESS && is_png)
        status = cairo_surface_write_to_png_stream(surface, write_bytes, stream);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return status;
}

int inspect_picture_check(const char *path)
{
    if (output_file_has_extension(path, "png") || output_file_has_extension(path, "svg") ||
        output_file_has_extension(path, "pdf"))
        return EXIT_CODE_OK;
    return message_usage("--out %s ends in none of .png, .svg and .pdf, which inspect draws", path);
}

int inspect_draw(const char *path, const inspect_findings *found, const float *cube)
{
    char temporary[4096];
    picture_stream stream = {output_file_open(path, temporary, sizeof temporary), 0};
    if (stream.file == NULL)
        return message_failure("%s cannot be written: %s; give --out another path", path, strerror(errno));
    cairo_status_t status = draw_to(&stream, path, found, cube);
    bool is_closed = fclose(stream.file) == 0;
    if (!is_closed && stream.error == 0)
        stream.error = errno;
    bool good = is_closed && status == CAIRO_STATUS_SUCCESS;
    if (good && rename(temporary, path) == 0)
        return EXIT_CODE_OK;
    if (good)
        stream.error = errno;
    int code = message_failure("%s cannot be written: %s; give --out another path", path,
                               stream.error != 0 ? strerror(stream.error) : cairo_status_to_string(status));
    unlink(temporary);
    return code;
}
