/* SPDX-License-Identifier: MIT */
#include "figure.h"

#include "message.h"
#include "output_file.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

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

static cairo_status_t draw_to(picture_stream *stream, const char *path, const figure *drawn)
{
    int width = drawn->width, height = drawn->height;
    bool is_png = output_file_has_extension(path, "png");
    cairo_surface_t *surface = is_png ? cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height)
                               : output_file_has_extension(path, "svg")
                                   ? cairo_svg_surface_create_for_stream(write_bytes, stream, width, height)
                                   : cairo_pdf_surface_create_for_stream(write_bytes, stream, width, height);
    cairo_t *cairo = cairo_create(surface);
    drawn->draw(cairo, drawn->data);
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

int figure_write(const char *option, const char *path, const figure *drawn)
{
    char temporary[4096];
    picture_stream stream = {output_file_open(path, temporary, sizeof temporary), 0};
    if (stream.file == NULL)
        return message_failure("%s cannot be written: %s; give --%s another path", path, strerror(errno), option);
    cairo_status_t status = draw_to(&stream, path, drawn);
    bool is_closed = fclose(stream.file) == 0;
    if (!is_closed && stream.error == 0)
        stream.error = errno;
    bool good = is_closed && status == CAIRO_STATUS_SUCCESS;
    if (good && rename(temporary, path) == 0)
        return EXIT_CODE_OK;
    if (good)
        stream.error = errno;
    int code = message_failure("%s cannot be written: %s; give --%s another path", path,
                               stream.error != 0 ? strerror(stream.error) : cairo_status_to_string(status), option);
    unlink(temporary);
    return code;
}
