/* SPDX-License-Identifier: MIT
 *
 * Layout: the head, then the arrays in the order of mesh_receipt_open(), each from a multiple of 64 on. No offset is
 * stored: the reader computes each from the counts, and the sum must be the size. */
#include "scene/mesh_receipt.h"

#include "core/context.h"
#include "core/error.h"

#include <errno.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

enum { ALIGNMENT = 64 };

typedef struct receipt_head {
    uint32_t vertex_count, triangle_count, material_count, texture_count;
    uint32_t has_normals, has_texture_coordinates;
} receipt_head;

typedef struct receipt_texture {
    uint32_t width, height, wrap_u, wrap_v;
} receipt_texture;

/* ---- writing --------------------------------------------------------------------------- */

static helio_status write_bytes(int descriptor, const void *bytes, size_t size)
{
    for (const char *at = bytes; size > 0;) {
        ssize_t written = write(descriptor, at, size);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return fail(errno == EFBIG ? HELIO_ERR_IO : HELIO_ERR_MEMORY, "the mesh cannot be handed on: %s",
                        strerror(errno));
        at += written;
        size -= (size_t)written;
    }
    return HELIO_OK;
}

static helio_status write_array(int descriptor, const void *array, size_t count, size_t size)
{
    static const char padding[ALIGNMENT];
    if (array == NULL)
        return HELIO_OK;
    HELIO_TRY(write_bytes(descriptor, array, count * size));
    return write_bytes(descriptor, padding, -(count * size) % ALIGNMENT);
}

typedef struct receipt_writer {
    helio_context *context;
    int descriptor;
    mesh_arrays *arrays;
} receipt_writer;

/* Writes an array and releases it at once, so that a mesh is in memory little more than once. */
static helio_status hand_on(const receipt_writer *writer, void *array, size_t count, size_t size)
{
    helio_status status = write_array(writer->descriptor, array, count, size);
    context_release(writer->context, array);
    return status;
}

/* The same for a member of the arrays, which becomes NULL. */
static helio_status hand_on_member(const receipt_writer *writer, size_t member, size_t count, size_t size)
{
    char *place = (char *)writer->arrays + member;
    void *array;
    memcpy(&array, place, sizeof array);
    memset(place, 0, sizeof array);
    return hand_on(writer, array, count, size);
}

static helio_status write_textures(const receipt_writer *writer)
{
    const mesh_arrays *arrays = writer->arrays;
    for (uint32_t i = 0; i < arrays->texture_count; i++) {
        const helio_texture *texture = &arrays->textures[i];
        const receipt_texture head = {texture->width, texture->height, texture->wrap_u, texture->wrap_v};
        HELIO_TRY(write_array(writer->descriptor, &head, 1, sizeof head));
    }
    for (uint32_t i = 0; i < arrays->texture_count; i++) {
        helio_texture *texture = &arrays->textures[i];
        void *texels = (void *)texture->rgba;
        texture->rgba = NULL;
        HELIO_TRY(hand_on(writer, texels, (size_t)texture->width * texture->height, 4));
    }
    return HELIO_OK;
}

static helio_status write_all(const receipt_writer *writer)
{
    const mesh_arrays *arrays = writer->arrays;
    const receipt_head head = {
        .vertex_count = arrays->vertex_count,
        .triangle_count = arrays->triangle_count,
        .material_count = arrays->material_count,
        .texture_count = arrays->texture_count,
        .has_normals = arrays->normals != NULL,
        .has_texture_coordinates = arrays->texture_coordinates != NULL,
    };
    const struct {
        size_t member, count, size;
    } list[] = {
        {offsetof(mesh_arrays, positions), head.vertex_count, 3 * sizeof(float)},
        {offsetof(mesh_arrays, normals), head.vertex_count, 3 * sizeof(float)},
        {offsetof(mesh_arrays, triangles), head.triangle_count, 3 * sizeof(uint32_t)},
        {offsetof(mesh_arrays, triangle_materials), head.triangle_count, sizeof(uint32_t)},
        {offsetof(mesh_arrays, materials), head.material_count, sizeof(helio_material)},
        {offsetof(mesh_arrays, texture_coordinates), head.vertex_count, 2 * sizeof(float)},
        {offsetof(mesh_arrays, material_textures), head.texture_count > 0 ? head.material_count : 0,
         sizeof(helio_material_textures)},
    };
    HELIO_TRY(write_array(writer->descriptor, &head, 1, sizeof head));
    for (size_t i = 0; i < sizeof list / sizeof *list; i++)
        HELIO_TRY(hand_on_member(writer, list[i].member, list[i].count, list[i].size));
    return write_textures(writer);
}

helio_status mesh_receipt_write(helio_context *context, int descriptor, mesh_arrays *arrays)
{
    const receipt_writer writer = {context, descriptor, arrays};
    helio_status status = write_all(&writer);
    mesh_arrays_release(context, arrays);
    return status;
}

/* ---- reading --------------------------------------------------------------------------- */

typedef struct receipt_reader {
    const unsigned char *bytes;
    size_t size, at;
    bool ended; /* an array did not fit */
} receipt_reader;

/* The next array, or NULL if it does not lie within the bytes. */
static const void *read_array(receipt_reader *reader, uint64_t count, size_t size)
{
    uint64_t bytes, padded;
    if (__builtin_mul_overflow(count, size, &bytes) || __builtin_add_overflow(bytes, ALIGNMENT - 1, &padded) ||
        padded / ALIGNMENT * ALIGNMENT > reader->size - reader->at) {
        reader->ended = true;
        return NULL;
    }
    const void *array = reader->bytes + reader->at;
    reader->at += (size_t)(padded / ALIGNMENT * ALIGNMENT);
    return array;
}

static helio_status read_textures(helio_context *context, receipt_reader *reader, mesh_receipt *receipt)
{
    uint32_t count = receipt->desc.texture_count;
    if ((uint64_t)count * ALIGNMENT > reader->size - reader->at) {
        reader->ended = true;
        return HELIO_OK;
    }
    receipt->textures = context_allocate(context, count, sizeof *receipt->textures);
    if (receipt->textures == NULL)
        return HELIO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const receipt_texture *head = read_array(reader, 1, sizeof *head);
        receipt->textures[i] =
            (helio_texture){head->width, head->height, (helio_wrap)head->wrap_u, (helio_wrap)head->wrap_v, NULL};
    }
    for (uint32_t i = 0; i < count && !reader->ended; i++) {
        helio_texture *texture = &receipt->textures[i];
        texture->rgba = read_array(reader, (uint64_t)texture->width * texture->height, 4);
    }
    receipt->desc.textures = receipt->textures;
    return HELIO_OK;
}

static helio_status read_all(helio_context *context, receipt_reader *reader, mesh_receipt *receipt)
{
    const receipt_head *head = read_array(reader, 1, sizeof *head);
    if (head == NULL)
        return HELIO_OK;
    helio_mesh_desc *desc = &receipt->desc;
    desc->vertex_count = head->vertex_count;
    desc->triangle_count = head->triangle_count;
    desc->material_count = head->material_count;
    desc->texture_count = head->texture_count;
    desc->positions = read_array(reader, head->vertex_count, 3 * sizeof(float));
    if (head->has_normals)
        desc->normals = read_array(reader, head->vertex_count, 3 * sizeof(float));
    desc->triangles = read_array(reader, head->triangle_count, 3 * sizeof(uint32_t));
    if (head->material_count > 0) {
        desc->triangle_materials = read_array(reader, head->triangle_count, sizeof(uint32_t));
        desc->materials = read_array(reader, head->material_count, sizeof(helio_material));
    }
    if (head->has_texture_coordinates)
        desc->texture_coordinates = read_array(reader, head->vertex_count, 2 * sizeof(float));
    if (head->texture_count == 0)
        return HELIO_OK;
    desc->material_textures = read_array(reader, head->material_count, sizeof(helio_material_textures));
    return read_textures(context, reader, receipt);
}

helio_status mesh_receipt_open(helio_context *context, const void *bytes, size_t size, mesh_receipt *receipt)
{
    receipt_reader reader = {.bytes = bytes, .size = size};
    *receipt = (mesh_receipt){0};
    helio_status status = read_all(context, &reader, receipt);
    if (status == HELIO_OK && (reader.ended || reader.at != size))
        status = fail(HELIO_ERR_DATA, "the importer returned %zu bytes, which do not fit its counts", size);
    if (status != HELIO_OK)
        mesh_receipt_close(context, receipt);
    return status;
}

void mesh_receipt_close(helio_context *context, mesh_receipt *receipt)
{
    context_release(context, receipt->textures);
    *receipt = (mesh_receipt){0};
}
