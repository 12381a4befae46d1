/* SPDX-License-Identifier: MIT */
#include "image/exr.h"

#include "core/context.h"
#include "core/error.h"
#include "image/colour.h"
#include "image/layout_comment.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    BYTES_PER_PIXEL = 28,   /* what any picture may take while it is read, see image.c */
    MODEST_PIXELS = 1 << 24 /* what chunks of fewer pixels than these need is always granted */
};

typedef struct exr_reader {
    const image_file *file;
    exr_context_t library;
    char message[256]; /* what the library said first */
    exr_channels channels;
    exr_attr_box2i_t window; /* of the data */
    helio_image *image;
    exr_decode_pipeline_t pipeline;
    bool has_pipeline;
    exr_unpacking unpacking; /* of the chunk that the pipeline works on */
} exr_reader;

/* ---- the file in memory as the library wants it ---- */

static void on_error(exr_const_context_t library, exr_result_t code, const char *message)
{
    void *user = NULL;
    exr_reader *reader = exr_get_user_data(library, &user) == EXR_ERR_SUCCESS ? user : NULL;
    (void)code;
    if (reader == NULL || reader->message[0] != 0)
        return;
    snprintf(reader->message, sizeof reader->message, "%s", message);
    image_make_printable(reader->message);
}

static int64_t on_size(exr_const_context_t library, void *user)
{
    const exr_reader *reader = user;
    (void)library;
    return (int64_t)reader->file->size;
}

static int64_t on_read(exr_const_context_t library, void *user, void *buffer, uint64_t bytes, uint64_t offset,
                       exr_stream_error_func_ptr_t error)
{
    const image_file *file = ((const exr_reader *)user)->file;
    (void)library;
    (void)error;
    if (offset >= file->size)
        return 0;
    uint64_t left = file->size - offset, count = bytes < left ? bytes : left;
    memcpy(buffer, file->bytes + offset, (size_t)count);
    return (int64_t)count;
}

static helio_status fail_with(const exr_reader *reader, exr_result_t result)
{
    const char *usual = exr_get_default_error_message(result);
    const char *message = reader->message[0] ? reader->message : usual;
    /* The decoder of PIZ says "out of memory" of damaged data as well, but with other words. */
    if (result == EXR_ERR_OUT_OF_MEMORY && strcmp(message, usual) == 0)
        return fail(HELIO_ERR_MEMORY, "no memory to read %s", reader->file->path);
    return fail(HELIO_ERR_DATA, "%s cannot be read as OpenEXR: %s", reader->file->path, message);
}

static helio_status open_file(exr_reader *reader)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = on_error;
    initializer.user_data = reader;
    initializer.read_fn = on_read;
    initializer.size_fn = on_size;
    initializer.max_image_width = initializer.max_image_height = IMAGE_EDGE_LIMIT;
    initializer.max_tile_width = initializer.max_tile_height = IMAGE_EDGE_LIMIT;
    initializer.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t result = exr_start_read(&reader->library, reader->file->path, &initializer);
    return result == EXR_ERR_SUCCESS ? HELIO_OK : fail_with(reader, result);
}

/* ---- how large it may be ---- */

/* How much larger pixels can be than what the compression makes of them; not less than the truth. */
static uint64_t greatest_ratio(exr_compression_t compression)
{
    switch (compression) {
    case EXR_COMPRESSION_NONE: return 1;
    case EXR_COMPRESSION_RLE: return 64;
    case EXR_COMPRESSION_B44:
    case EXR_COMPRESSION_B44A: return 16;
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
    case EXR_COMPRESSION_PIZ:
    case EXR_COMPRESSION_PXR24: return 2048;
    default: return 65536;
    }
}

/* Bytes that all channels of the part take together. They are decoded together, wanted or not. */
static uint64_t stored_bytes(const exr_attr_chlist_t *list, uint64_t width, uint64_t height)
{
    uint64_t bytes = 0;
    for (int i = 0; i < list->num_channels && bytes < UINT64_C(1) << 60; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        uint64_t x = entry->x_sampling > 0 ? (uint64_t)entry->x_sampling : 1;
        uint64_t y = entry->y_sampling > 0 ? (uint64_t)entry->y_sampling : 1;
        bytes += (width / x) * (height / y) * (entry->pixel_type == EXR_PIXEL_HALF ? 2 : 4);
    }
    return bytes;
}

/* Of the pixels that are decoded at once. */
static exr_result_t find_chunk_size(const exr_reader *reader, uint64_t *width, uint64_t *height)
{
    exr_storage_t storage;
    int32_t tile_width = 0, lines = 0;
    exr_result_t result = exr_get_storage(reader->library, reader->channels.part, &storage);
    if (result == EXR_ERR_SUCCESS && storage == EXR_STORAGE_TILED)
        result = exr_get_tile_sizes(reader->library, reader->channels.part, 0, 0, &tile_width, &lines);
    else if (result == EXR_ERR_SUCCESS)
        result = exr_get_scanlines_per_chunk(reader->library, reader->channels.part, &lines);
    if (tile_width > 0 && (uint64_t)tile_width < *width)
        *width = (uint64_t)tile_width;
    if (lines > 0 && (uint64_t)lines < *height)
        *height = (uint64_t)lines;
    return result;
}

/* A chunk is in memory up to three times while it is decoded: packed, unpacked, and on the way. Files whose chunks are
 * the whole picture, or have hundreds of channels, would need far more than the pixels that are wanted. */
static helio_status check_chunk(exr_reader *reader, const exr_attr_chlist_t *list, uint64_t width, uint64_t height)
{
    uint64_t chunk_width = width, chunk_height = height;
    exr_result_t result = find_chunk_size(reader, &chunk_width, &chunk_height);
    if (result != EXR_ERR_SUCCESS)
        return fail_with(reader, result);
    uint64_t bytes = 3 * stored_bytes(list, chunk_width, chunk_height) + 16 * width * height;
    uint64_t allowed = reader->file->max_pixels > MODEST_PIXELS ? reader->file->max_pixels : MODEST_PIXELS;
    if (bytes / BYTES_PER_PIXEL <= allowed)
        return HELIO_OK;
    return fail(HELIO_ERR_DATA,
                "%s needs %" PRIu64 " MiB to be decoded, as much as a picture of more than the %" PRIu64
                " pixels that are allowed; save it in scan lines with R, G and B alone, or raise max_pixels "
                "(--max-pixels)",
                reader->file->path, bytes >> 20, reader->file->max_pixels);
}

static helio_status create_image(exr_reader *reader)
{
    int part = reader->channels.part;
    const exr_attr_chlist_t *list;
    exr_compression_t compression;
    exr_result_t result = exr_get_data_window(reader->library, part, &reader->window);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_compression(reader->library, part, &compression);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_channels(reader->library, part, &list);
    if (result != EXR_ERR_SUCCESS)
        return fail_with(reader, result);
    const exr_attr_box2i_t *window = &reader->window;
    if (window->max.x < window->min.x || window->max.y < window->min.y)
        return fail(HELIO_ERR_DATA, "%s has no pixels: its data window is empty", reader->file->path);
    uint64_t width = (uint64_t)((int64_t)window->max.x - window->min.x + 1);
    uint64_t height = (uint64_t)((int64_t)window->max.y - window->min.y + 1);
    HELIO_TRY(image_check_size(reader->file, width, height, 0)); /* before sums that could overflow */
    HELIO_TRY(check_chunk(reader, list, width, height));
    uint64_t least_bytes = stored_bytes(list, width, height) / greatest_ratio(compression);
    return image_create(reader->file, width, height, reader->channels.names[3] != NULL, least_bytes, &reader->image);
}

/* ---- pixels ---- */

static exr_result_t read_chunk(exr_reader *reader, const exr_chunk_info_t *chunk, int64_t column, int64_t row)
{
    const helio_image *image = reader->image;
    if (column < 0 || row < 0 || chunk->width < 1 || chunk->height < 1 || column + chunk->width > image->width ||
        row + chunk->height > image->height)
        return EXR_ERR_BAD_CHUNK_LEADER;
    int part = reader->channels.part;
    bool is_first = !reader->has_pipeline;
    exr_result_t result = is_first ? exr_decoding_initialize(reader->library, part, chunk, &reader->pipeline)
                                   : exr_decoding_update(reader->library, part, chunk, &reader->pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    reader->has_pipeline = true;
    if (is_first)
        result = exr_decoding_choose_default_routines(reader->library, part, &reader->pipeline);
    reader->unpacking = (exr_unpacking){&reader->channels, image, (size_t)column, (size_t)row};
    reader->pipeline.decoding_user_data = &reader->unpacking;
    reader->pipeline.unpack_and_convert_fn = exr_unpack;
    return result == EXR_ERR_SUCCESS ? exr_decoding_run(reader->library, part, &reader->pipeline) : result;
}

static exr_result_t read_scan_lines(exr_reader *reader)
{
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(reader->library, reader->channels.part, &lines);
    if (result == EXR_ERR_SUCCESS && lines < 1)
        result = EXR_ERR_INVALID_ATTR;
    for (int64_t y = reader->window.min.y; result == EXR_ERR_SUCCESS && y <= reader->window.max.y; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_read_scanline_chunk_info(reader->library, reader->channels.part, (int)y, &chunk);
        if (result == EXR_ERR_SUCCESS)
            result = read_chunk(reader, &chunk, 0, (int64_t)chunk.start_y - reader->window.min.y);
    }
    return result;
}

/* Of a mip or rip map, the full level is read. */
static exr_result_t read_tiles(exr_reader *reader)
{
    int part = reader->channels.part;
    int32_t width = 0, height = 0;
    exr_result_t result = exr_get_tile_sizes(reader->library, part, 0, 0, &width, &height);
    if (result == EXR_ERR_SUCCESS && (width < 1 || height < 1))
        result = EXR_ERR_INVALID_ATTR;
    for (int64_t y = 0; result == EXR_ERR_SUCCESS && y * height < reader->image->height; y++)
        for (int64_t x = 0; result == EXR_ERR_SUCCESS && x * width < reader->image->width; x++) {
            exr_chunk_info_t chunk;
            result = exr_read_tile_chunk_info(reader->library, part, (int)x, (int)y, 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS)
                result = read_chunk(reader, &chunk, x * width, y * height);
        }
    return result;
}

static void spread_grey(helio_image *image)
{
    size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; i < pixels; i++)
        image->rgb[3 * i + 1] = image->rgb[3 * i + 2] = image->rgb[3 * i];
}

static helio_status read_pixels(exr_reader *reader)
{
    if (reader->channels.luminance_chroma)
        return exr_rgba_read(reader->file, &reader->channels, reader->window, reader->image);
    exr_storage_t storage;
    exr_result_t result = exr_get_storage(reader->library, reader->channels.part, &storage);
    if (result == EXR_ERR_SUCCESS)
        result = storage == EXR_STORAGE_TILED ? read_tiles(reader) : read_scan_lines(reader);
    if (result == EXR_ERR_FEATURE_NOT_IMPLEMENTED) /* DWAA and DWAB before OpenEXR 3.2 */
        return exr_rgba_read(reader->file, &reader->channels, reader->window, reader->image);
    if (result != EXR_ERR_SUCCESS)
        return fail_with(reader, result);
    if (reader->channels.names[1] == NULL)
        spread_grey(reader->image);
    return HELIO_OK;
}

/* ---- what the attributes say ---- */

static void convert_colour(exr_reader *reader)
{
    exr_attr_chromaticities_t found;
    if (exr_attr_get_chromaticities(reader->library, reader->channels.part, "chromaticities", &found) !=
        EXR_ERR_SUCCESS)
        return;
    chromaticities space = {{(double)found.red_x, (double)found.red_y},
                            {(double)found.green_x, (double)found.green_y},
                            {(double)found.blue_x, (double)found.blue_y},
                            {(double)found.white_x, (double)found.white_y}};
    colour_matrix matrix;
    if (colour_is_rec709(&space))
        return;
    if (colour_to_rec709(&space, &matrix))
        colour_apply(&matrix, reader->image->rgb, (size_t)reader->image->width * reader->image->height);
    else
        context_log(reader->file->context, HELIO_LOG_INFO,
                    "%s has chromaticities that span no colours; taken as Rec. 709", reader->file->path);
}

/* An environment map is its data window, by OpenEXR's definition; of other pictures the display window counts. */
static helio_status fit_window(exr_reader *reader)
{
    exr_envmap_t envmap;
    if (exr_attr_get_envmap(reader->library, reader->channels.part, "envmap", &envmap) == EXR_ERR_SUCCESS) {
        reader->image->layout = envmap == EXR_ENVMAP_LATLONG ? HELIO_LAYOUT_LATLONG
                                : envmap == EXR_ENVMAP_CUBE  ? HELIO_LAYOUT_STRIP_OPENEXR
                                                             : HELIO_LAYOUT_AUTO;
        return HELIO_OK;
    }
    exr_attr_box2i_t display;
    if (exr_get_display_window(reader->library, reader->channels.part, &display) != EXR_ERR_SUCCESS)
        return HELIO_OK;
    return exr_window_fit(reader->file, reader->window, display, reader->image);
}

static void read_comment(exr_reader *reader)
{
    char comment[LAYOUT_COMMENT_SIZE];
    const char *text;
    int32_t length;
    if (reader->image->layout != HELIO_LAYOUT_AUTO ||
        exr_attr_get_string(reader->library, reader->channels.part, "comments", &length, &text) != EXR_ERR_SUCCESS ||
        length <= 0 || length >= LAYOUT_COMMENT_SIZE)
        return;
    memcpy(comment, text, (size_t)length);
    comment[length] = 0;
    reader->image->layout = layout_comment_read(comment, reader->image->width, reader->image->height);
}

static helio_status read_image(exr_reader *reader)
{
    HELIO_TRY(exr_head_check(reader->file));
    HELIO_TRY(open_file(reader));
    HELIO_TRY(exr_channels_find(reader->file, reader->library, &reader->channels));
    if (reader->file->without_alpha)
        reader->channels.names[3] = NULL;
    HELIO_TRY(create_image(reader));
    HELIO_TRY(read_pixels(reader));
    HELIO_TRY(fit_window(reader));
    read_comment(reader);
    image_count_bad(reader->image);
    convert_colour(reader);
    return HELIO_OK;
}

helio_status exr_read(const image_file *file, helio_image **image)
{
    exr_reader *reader = context_allocate(file->context, 1, sizeof *reader);
    if (reader == NULL)
        return HELIO_ERR_MEMORY;
    reader->file = file;
    helio_status status = read_image(reader);
    if (reader->has_pipeline)
        exr_decoding_destroy(reader->library, &reader->pipeline);
    if (reader->library != NULL)
        exr_finish(&reader->library);
    if (status == HELIO_OK)
        *image = reader->image;
    else
        helio_image_destroy(file->context, reader->image);
    context_release(file->context, reader);
    return status;
}
