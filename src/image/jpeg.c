/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "image/colour.h"
#include "image/image.h"

#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jerror.h>
#include <jpeglib.h>

enum {
    LEAST_PIXELS = 1 << 16,  /* as which a scan counts at least */
    PIXELS_PER_BYTE = 4096,  /* a block of 64 pixels takes at least one bit, or a little less by arithmetic coding */
    USUAL_SCANS = 32,        /* real progressive files have about ten; hundreds of empty ones only waste time */
    SCANNED_PIXELS = 1 << 28 /* what more scans than usual may go over, in all */
};

typedef struct jpeg_decoder {
    struct jpeg_decompress_struct library;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf failed;
    char message[JMSG_LENGTH_MAX];
    const image_file *file;
    helio_image *image;
    JSAMPLE *row;
} jpeg_decoder;

static void on_error(j_common_ptr library)
{
    jpeg_decoder *decoder = library->client_data;
    library->err->format_message(library, decoder->message);
    longjmp(decoder->failed, 1);
}

/* Level -1 is damage that the library can paper over; a missing end is more than we want to paper over. */
static void on_message(j_common_ptr library, int level)
{
    if (level >= 0)
        return;
    jpeg_decoder *decoder = library->client_data;
    int code = library->err->msg_code;
    if (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)
        on_error(library);
    char message[JMSG_LENGTH_MAX];
    library->err->format_message(library, message);
    context_log(decoder->file->context, HELIO_LOG_WARNING, "%s: %s", decoder->file->path, message);
}

static void on_progress(j_common_ptr library)
{
    jpeg_decoder *decoder = library->client_data;
    int scans = decoder->library.input_scan_number;
    uint64_t pixels = (uint64_t)decoder->library.image_width * decoder->library.image_height;
    if (scans <= USUAL_SCANS || (uint64_t)scans * (pixels + LEAST_PIXELS) <= SCANNED_PIXELS)
        return;
    snprintf(decoder->message, sizeof decoder->message, "it has more than %d scans", scans - 1);
    longjmp(decoder->failed, 1);
}

static helio_status read_header(jpeg_decoder *decoder)
{
    const image_file *file = decoder->file;
    struct jpeg_decompress_struct *library = &decoder->library;
    jpeg_mem_src(library, file->bytes, (unsigned long)file->size);
    jpeg_read_header(library, TRUE);
    if (library->jpeg_color_space == JCS_CMYK || library->jpeg_color_space == JCS_YCCK)
        return fail(HELIO_ERR_DATA, "%s is a CMYK JPEG; convert it to RGB", file->path);
    if (library->num_components != 1 && library->num_components != 3)
        return fail(HELIO_ERR_DATA, "%s is a JPEG with %d components; convert it to RGB", file->path,
                    library->num_components);
    library->out_color_space = library->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    uint64_t pixels = (uint64_t)library->image_width * library->image_height;
    return image_create(file, library->image_width, library->image_height, false, pixels / PIXELS_PER_BYTE,
                        &decoder->image);
}

/* samples: 3 for RGB, 1 for grey, which becomes all three. */
static void copy_row(const jpeg_decoder *decoder, size_t row, size_t samples)
{
    size_t width = decoder->image->width;
    uint8_t *texel = *decoder->file->texels + 4 * row * width;
    for (size_t column = 0; column < width; column++, texel += 4) {
        texel[3] = 255;
        for (size_t c = 0; c < 3; c++)
            texel[c] = decoder->row[samples * column + (samples == 3 ? c : 0)];
    }
}

static void convert_row(const jpeg_decoder *decoder, size_t row, size_t samples, const float linear[256])
{
    size_t width = decoder->image->width;
    float *rgb = decoder->image->rgb + 3 * row * width;
    for (size_t column = 0; column < width; column++)
        for (size_t c = 0; c < 3; c++)
            rgb[3 * column + c] = linear[decoder->row[samples * column + (samples == 3 ? c : 0)]];
}

static void read_rows(jpeg_decoder *decoder)
{
    struct jpeg_decompress_struct *library = &decoder->library;
    float linear[256];
    for (int i = 0; i < 256; i++)
        linear[i] = srgb_decode((float)i / 255);
    jpeg_start_decompress(library);
    size_t samples = (size_t)library->output_components;
    while (library->output_scanline < library->output_height) {
        size_t row = library->output_scanline;
        jpeg_read_scanlines(library, &decoder->row, 1);
        if (decoder->file->texels != NULL)
            copy_row(decoder, row, samples);
        else
            convert_row(decoder, row, samples, linear);
    }
    jpeg_finish_decompress(library);
}

/* All that may jump: nothing here is a variable that would have to survive the jump. */
static helio_status decode(jpeg_decoder *decoder)
{
    if (setjmp(decoder->failed) != 0)
        return fail(HELIO_ERR_DATA, "%s cannot be read as JPEG: %s", decoder->file->path, decoder->message);
    jpeg_create_decompress(&decoder->library);
    decoder->library.client_data = decoder;
    decoder->progress.progress_monitor = on_progress;
    decoder->library.progress = &decoder->progress;
    HELIO_TRY(read_header(decoder));
    decoder->row = context_allocate(decoder->file->context, decoder->image->width, 3);
    if (decoder->row == NULL)
        return HELIO_ERR_MEMORY;
    read_rows(decoder);
    return HELIO_OK;
}

helio_status jpeg_read(const image_file *file, helio_image **image)
{
    jpeg_decoder *decoder = context_allocate(file->context, 1, sizeof *decoder);
    if (decoder == NULL)
        return HELIO_ERR_MEMORY;
    decoder->file = file;
    decoder->library.err = jpeg_std_error(&decoder->errors);
    decoder->errors.error_exit = on_error;
    decoder->errors.emit_message = on_message;
    decoder->library.client_data = decoder;
    helio_status status = decode(decoder);
    jpeg_destroy_decompress(&decoder->library);
    context_release(file->context, decoder->row);
    if (status == HELIO_OK)
        *image = decoder->image;
    else
        helio_image_destroy(file->context, decoder->image);
    context_release(file->context, decoder);
    return status;
}
