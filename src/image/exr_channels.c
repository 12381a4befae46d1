/* SPDX-License-Identifier: MIT */
#include "image/exr.h"

#include "core/error.h"

#include <stdio.h>
#include <string.h>

#include <ImfCRgbaFile.h>

/* ---- which channels ---- */

/* The entry called prefix + name, where the first prefix_length characters of prefix count; NULL if there is none. */
static const exr_attr_chlist_entry_t *find(const exr_attr_chlist_t *list, const char *prefix, size_t prefix_length,
                                           const char *name)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *candidate = list->entries[i].name.str;
        if (strncmp(candidate, prefix, prefix_length) == 0 && strcmp(candidate + prefix_length, name) == 0)
            return &list->entries[i];
    }
    return NULL;
}

static bool is_whole(const exr_attr_chlist_entry_t *entry)
{
    return entry != NULL && entry->x_sampling == 1 && entry->y_sampling == 1;
}

static void use(exr_channels *channels, int index, const exr_attr_chlist_entry_t *entry)
{
    if (!is_whole(entry))
        return;
    channels->names[index] = entry->name.str;
    channels->has_float |= entry->pixel_type == EXR_PIXEL_FLOAT;
}

/* Takes three channels and perhaps a fourth, named by letters behind the prefix, which is empty or ends in a point. */
static bool find_letters(const exr_attr_chlist_t *list, const char *prefix, size_t prefix_length,
                         const char *const letters[4], exr_channels *channels)
{
    for (int i = 0; i < 3; i++)
        if (!is_whole(find(list, prefix, prefix_length, letters[i])))
            return false;
    for (int i = 0; i < 4; i++)
        use(channels, i, find(list, prefix, prefix_length, letters[i]));
    channels->has_layer = prefix_length > 0;
    return true;
}

static bool find_rgb(const exr_attr_chlist_t *list, const char *prefix, size_t prefix_length, exr_channels *channels)
{
    static const char *const letters[] = {"R", "G", "B", "A"};
    return find_letters(list, prefix, prefix_length, letters, channels);
}

static bool find_luminance(const exr_attr_chlist_t *list, exr_channels *channels)
{
    const exr_attr_chlist_entry_t *luminance = find(list, "", 0, "Y");
    if (!is_whole(luminance))
        return false;
    use(channels, 0, luminance);
    use(channels, 3, find(list, "", 0, "A"));
    channels->luminance_chroma = find(list, "", 0, "RY") != NULL && find(list, "", 0, "BY") != NULL;
    return true;
}

static bool find_layer(const exr_attr_chlist_t *list, exr_channels *channels)
{
    for (int i = 0; i < list->num_channels; i++) {
        const char *name = list->entries[i].name.str;
        size_t length = strlen(name);
        if (length > 2 && strcmp(name + length - 2, ".R") == 0 && find_rgb(list, name, length - 1, channels))
            return true;
    }
    return false;
}

/* The only channel behind a prefix. */
static bool find_single(const exr_attr_chlist_t *list, const char *prefix, size_t prefix_length, exr_channels *channels)
{
    const exr_attr_chlist_entry_t *found = NULL;
    for (int i = 0; i < list->num_channels; i++)
        if (strncmp(list->entries[i].name.str, prefix, prefix_length) == 0) {
            if (found != NULL)
                return false;
            found = &list->entries[i];
        }
    if (!is_whole(found))
        return false;
    use(channels, 0, found);
    channels->has_layer = true;
    return true;
}

static bool find_named_layer(const exr_attr_chlist_t *list, const char *layer, exr_channels *channels)
{
    static const char *const letters[] = {"X", "Y", "Z", "A"};
    char prefix[256];
    int length = snprintf(prefix, sizeof prefix, "%s.", layer);
    return length > 0 && (size_t)length < sizeof prefix &&
           (find_rgb(list, prefix, (size_t)length, channels) ||
            find_letters(list, prefix, (size_t)length, letters, channels) ||
            find_single(list, prefix, (size_t)length, channels));
}

static bool find_wanted(const image_file *file, const exr_attr_chlist_t *list, exr_channels *channels)
{
    if (file->layer != NULL)
        return find_named_layer(list, file->layer, channels);
    return find_rgb(list, "", 0, channels) || find_luminance(list, channels) || find_layer(list, channels);
}

/* Non-deep parts only; NULL for others. */
static const exr_attr_chlist_t *part_channels(exr_const_context_t library, int part)
{
    exr_storage_t storage;
    const exr_attr_chlist_t *list;
    if (exr_get_storage(library, part, &storage) != EXR_ERR_SUCCESS ||
        (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) ||
        exr_get_channels(library, part, &list) != EXR_ERR_SUCCESS)
        return NULL;
    return list;
}

static helio_status fail_with_list(const image_file *file, const exr_attr_chlist_t *list)
{
    char text[300] = "";
    size_t used = 0;
    for (int i = 0; i < list->num_channels && used < sizeof text; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[i];
        int added = snprintf(text + used, sizeof text - used, "%s%s%s", i ? ", " : "", entry->name.str,
                             is_whole(entry) ? "" : " (subsampled)");
        used += added > 0 ? (size_t)added : 0;
    }
    if (used >= sizeof text)
        strcpy(text + sizeof text - 4, "...");
    image_make_printable(text);
    if (file->layer != NULL)
        return fail(HELIO_ERR_DATA, "%s has no layer '%s' with three channels or one; it has: %s", file->path,
                    file->layer, used ? text : "none");
    return fail(HELIO_ERR_DATA, "%s has no channels R, G and B, nor Y, nor a layer with R, G and B; it has: %s",
                file->path, used ? text : "none");
}

helio_status exr_channels_find(const image_file *file, exr_const_context_t library, exr_channels *channels)
{
    int parts = 0;
    exr_get_count(library, &parts);
    const exr_attr_chlist_t *first = NULL;
    for (int part = 0; part < parts; part++) {
        const exr_attr_chlist_t *list = part_channels(library, part);
        if (list == NULL)
            continue;
        *channels = (exr_channels){.part = part};
        if (find_wanted(file, list, channels))
            return HELIO_OK;
        if (first == NULL)
            first = list;
    }
    if (first == NULL)
        return fail(HELIO_ERR_DATA, "%s holds only deep pixels; flatten it first", file->path);
    return fail_with_list(file, first);
}

/* ---- their pixels ---- */

/* OpenEXR is little-endian everywhere. */
static float read_half(const uint8_t *bytes)
{
    return ImfHalfToFloat((ImfHalf)(bytes[0] | bytes[1] << 8));
}

static uint32_t read_bits(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static void convert_line(const uint8_t *bytes, exr_pixel_type_t type, int count, float *target, size_t step)
{
    for (int i = 0; i < count; i++, target += step) {
        if (type == EXR_PIXEL_HALF) {
            *target = read_half(bytes + 2 * i);
        } else {
            uint32_t bits = read_bits(bytes + 4 * i);
            if (type == EXR_PIXEL_UINT)
                *target = (float)bits;
            else
                memcpy(target, &bits, sizeof bits);
        }
    }
}

/* The first sample of a line of this channel in the picture, and how many floats lie between two; NULL: not wanted. */
static float *find_target(const exr_unpacking *unpacking, const char *name, size_t line, size_t *step)
{
    const helio_image *image = unpacking->image;
    size_t pixel = (unpacking->row + line) * image->width + unpacking->column;
    for (size_t c = 0; c < 4; c++) {
        const char *wanted = unpacking->channels->names[c];
        if (wanted == NULL || strcmp(wanted, name) != 0)
            continue;
        *step = c < 3 ? 3 : 1;
        return c < 3 ? image->rgb + 3 * pixel + c : image->alpha + pixel;
    }
    return NULL;
}

/* A chunk holds line after line, and in each line channel after channel, without those whose turn it is not. */
exr_result_t exr_unpack(exr_decode_pipeline_t *pipeline)
{
    const exr_chunk_info_t *chunk = &pipeline->chunk;
    const uint8_t *bytes = pipeline->unpacked_buffer ? pipeline->unpacked_buffer : pipeline->packed_buffer;
    uint64_t left = pipeline->unpacked_buffer ? chunk->unpacked_size : chunk->packed_size;
    for (int line = 0; line < chunk->height; line++)
        for (int i = 0; i < pipeline->channel_count; i++) {
            const exr_coding_channel_info_t *channel = &pipeline->channels[i];
            if (channel->y_samples > 1 && ((int64_t)chunk->start_y + line) % channel->y_samples != 0)
                continue;
            uint64_t size = (uint64_t)channel->width * (uint64_t)channel->bytes_per_element;
            if (channel->width < 0 || size > left)
                return EXR_ERR_CORRUPT_CHUNK;
            size_t step;
            float *target = find_target(pipeline->decoding_user_data, channel->channel_name, (size_t)line, &step);
            if (target != NULL && channel->width != chunk->width)
                return EXR_ERR_CORRUPT_CHUNK;
            if (target != NULL)
                convert_line(bytes, (exr_pixel_type_t)channel->data_type, channel->width, target, step);
            bytes += size;
            left -= size;
        }
    return EXR_ERR_SUCCESS;
}
