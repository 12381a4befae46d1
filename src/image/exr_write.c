/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "image/layout_comment.h"
#include "image/map.h"
#include "image/picture.h"

#include <errno.h>
#include <string.h>

#include <openexr.h>

enum { CHANNEL_LIMIT = 18 };

/* One channel of the file and where its floats are. */
typedef struct exr_layer {
    const char *name;
    const float *first;
    size_t step; /* floats from pixel to pixel */
} exr_layer;

typedef struct exr_writer {
    uint32_t width, height;
    exr_pixel_type_t type; /* of the file; in memory all is float */
    helio_layout layout;   /* AUTO: not an environment map */
    file_writer *file;
    exr_context_t library;
    int error; /* errno of the first write that failed, 0 if none has */
    exr_layer layers[CHANNEL_LIMIT];
    size_t layer_count;
    exr_encode_pipeline_t pipeline;
    bool has_pipeline;
} exr_writer;

static void on_error(exr_const_context_t library, exr_result_t code, const char *message)
{
    (void)library;
    (void)code;
    (void)message; /* the result code comes back to us and becomes our own sentence */
}

static int64_t on_write(exr_const_context_t library, void *user, const void *buffer, uint64_t bytes, uint64_t offset,
                        exr_stream_error_func_ptr_t error)
{
    exr_writer *writer = user;
    FILE *stream = writer->file->stream;
    (void)library;
    (void)error;
    if (fseeko(stream, (off_t)offset, SEEK_SET) == 0 && fwrite(buffer, 1, (size_t)bytes, stream) == bytes)
        return (int64_t)bytes;
    if (writer->error == 0)
        writer->error = errno;
    return -1;
}

static void add_layer(exr_writer *writer, const char *name, const float *first, size_t step)
{
    if (first != NULL)
        writer->layers[writer->layer_count++] = (exr_layer){name, first, step};
}

static const float *behind(const float *first, size_t floats)
{
    return first ? first + floats : NULL;
}

static void collect_layers(exr_writer *writer, const helio_picture *picture)
{
    static const char *const rgba[] = {"R", "G", "B", "A"};
    static const char *const albedo[] = {"albedo.R", "albedo.G", "albedo.B"};
    static const char *const normal[] = {"normal.X", "normal.Y", "normal.Z"};
    static const char *const position[] = {"position.X", "position.Y", "position.Z"};
    static const char *const standard_error[] = {"stderr.R", "stderr.G", "stderr.B"};
    for (size_t c = 0; c < 4; c++)
        add_layer(writer, rgba[c], picture->rgba + c, 4);
    for (size_t c = 0; c < 3; c++) {
        add_layer(writer, albedo[c], behind(picture->albedo, c), 3);
        add_layer(writer, normal[c], behind(picture->normal, c), 3);
        add_layer(writer, position[c], behind(picture->position, c), 3);
        add_layer(writer, standard_error[c], behind(picture->standard_error, c), 3);
    }
    add_layer(writer, "object.A", picture->object, 1);
    add_layer(writer, "depth.Z", picture->depth, 1);
}

/* OpenEXR knows two layouts by an attribute of its own. */
static exr_result_t note_layout(const exr_writer *writer, int part)
{
    char comment[LAYOUT_COMMENT_SIZE];
    switch (writer->layout) {
    case HELIO_LAYOUT_AUTO: return EXR_ERR_SUCCESS;
    case HELIO_LAYOUT_LATLONG: return exr_attr_set_envmap(writer->library, part, "envmap", EXR_ENVMAP_LATLONG);
    case HELIO_LAYOUT_STRIP_OPENEXR: return exr_attr_set_envmap(writer->library, part, "envmap", EXR_ENVMAP_CUBE);
    default:
        layout_comment_format(writer->layout, comment);
        return exr_attr_set_string(writer->library, part, "comments", comment);
    }
}

static exr_result_t write_header(exr_writer *writer)
{
    exr_context_initializer_t initializer = EXR_DEFAULT_CONTEXT_INITIALIZER;
    initializer.error_handler_fn = on_error;
    initializer.user_data = writer;
    initializer.write_fn = on_write;
    int part;
    exr_result_t result = exr_start_write(&writer->library, writer->file->path, EXR_WRITE_FILE_DIRECTLY, &initializer);
    if (result == EXR_ERR_SUCCESS)
        result = exr_add_part(writer->library, NULL, EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr_simple(writer->library, part, (int32_t)writer->width,
                                                     (int32_t)writer->height, EXR_COMPRESSION_ZIP);
    if (result == EXR_ERR_SUCCESS)
        result = note_layout(writer, part);
    for (size_t i = 0; i < writer->layer_count && result == EXR_ERR_SUCCESS; i++)
        result = exr_add_channel(writer->library, part, writer->layers[i].name, writer->type,
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1); /* the library sorts them by name */
    return result == EXR_ERR_SUCCESS ? exr_write_header(writer->library) : result;
}

static void aim_channels(exr_writer *writer, size_t row)
{
    for (int i = 0; i < writer->pipeline.channel_count; i++) {
        exr_coding_channel_info_t *channel = &writer->pipeline.channels[i];
        for (size_t k = 0; k < writer->layer_count; k++) {
            const exr_layer *layer = &writer->layers[k];
            if (strcmp(layer->name, channel->channel_name) != 0)
                continue;
            size_t row_floats = layer->step * writer->width;
            channel->encode_from_ptr = (const uint8_t *)(layer->first + row * row_floats);
            channel->user_bytes_per_element = sizeof(float);
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_pixel_stride = (int32_t)(layer->step * sizeof(float));
            channel->user_line_stride = (int32_t)(row_floats * sizeof(float));
        }
    }
}

static exr_result_t write_chunk(exr_writer *writer, uint32_t row)
{
    exr_chunk_info_t chunk;
    exr_result_t result = exr_write_scanline_chunk_info(writer->library, 0, (int)row, &chunk);
    if (result != EXR_ERR_SUCCESS)
        return result;
    bool is_first = !writer->has_pipeline;
    result = is_first ? exr_encoding_initialize(writer->library, 0, &chunk, &writer->pipeline)
                      : exr_encoding_update(writer->library, 0, &chunk, &writer->pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    writer->has_pipeline = true;
    aim_channels(writer, row);
    if (is_first)
        result = exr_encoding_choose_default_routines(writer->library, 0, &writer->pipeline);
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(writer->library, 0, &writer->pipeline) : result;
}

static exr_result_t write_chunks(exr_writer *writer)
{
    int32_t lines = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(writer->library, 0, &lines);
    for (uint32_t row = 0; result == EXR_ERR_SUCCESS && row < writer->height; row += (uint32_t)lines)
        result = write_chunk(writer, row);
    return result;
}

static helio_status to_status(const exr_writer *writer, exr_result_t result)
{
    if (result == EXR_ERR_SUCCESS && writer->error == 0)
        return HELIO_OK;
    if (result == EXR_ERR_OUT_OF_MEMORY)
        return fail(HELIO_ERR_MEMORY, "no memory to write %s", writer->file->path);
    return fail(HELIO_ERR_IO, "%s cannot be written: %s", writer->file->path,
                writer->error ? strerror(writer->error) : exr_get_default_error_message(result));
}

static helio_status write_file(exr_writer *writer)
{
    exr_result_t result = write_header(writer);
    if (result == EXR_ERR_SUCCESS)
        result = write_chunks(writer);
    if (writer->has_pipeline)
        exr_encoding_destroy(writer->library, &writer->pipeline);
    if (writer->library != NULL) {
        exr_result_t finished = exr_finish(&writer->library); /* writes the table of chunks */
        result = result == EXR_ERR_SUCCESS ? finished : result;
    }
    return to_status(writer, result);
}

helio_status exr_write(helio_context *context, file_writer *file, const helio_picture *picture,
                       const helio_picture_write_desc *desc)
{
    (void)desc;
    exr_writer *writer = context_allocate(context, 1, sizeof *writer);
    if (writer == NULL)
        return HELIO_ERR_MEMORY;
    writer->width = picture->width;
    writer->height = picture->height;
    writer->type = EXR_PIXEL_FLOAT;
    writer->file = file;
    collect_layers(writer, picture);
    helio_status status = write_file(writer);
    context_release(context, writer);
    return status;
}

helio_status exr_write_map(helio_context *context, file_writer *file, const helio_map *map,
                           const helio_map_write_desc *desc)
{
    exr_writer *writer = context_allocate(context, 1, sizeof *writer);
    if (writer == NULL)
        return HELIO_ERR_MEMORY;
    writer->width = map->width;
    writer->height = map->height;
    writer->type = desc->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
    writer->layout = map->layout;
    writer->file = file;
    static const char *const rgb[] = {"R", "G", "B"};
    for (size_t c = 0; c < 3; c++)
        add_layer(writer, rgb[c], map->rgb + c, 3);
    helio_status status = write_file(writer);
    context_release(context, writer);
    return status;
}
