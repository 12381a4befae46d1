/* SPDX-License-Identifier: MIT
 *
 * The receipt of a mesh: arrays of all sizes, with any numbers in them. */
#include "fuzz.h"

#include <heliostat/scene.h>

#include <math.h>
#include <stdlib.h>

enum { MAX_COUNT = 48, MAX_TEXTURES = 3, MAX_TEXTURE_EDGE = 4 };

/* The first byte: which arrays are handed over, and what is in them. */
enum {
    GIVE_NORMALS = 1 << 0,
    GIVE_COORDINATES = 1 << 1,
    ANY_INDICES = 1 << 2, /* else they name what is there */
    ANY_NUMBERS = 1 << 3, /* else they are small */
    GIVE_MATERIALS = 1 << 4,
    GIVE_TEXTURES = 1 << 5,
    ODD_COUNT = 1 << 6, /* one of the counts is out of range */
};

/* Memory of exactly this size, so that the address sanitizer sees reads beyond it. */
static void *make_array(size_t count, size_t size)
{
    void *array = malloc(count * size > 0 ? count * size : 1);
    FUZZ_EXPECT(array != NULL);
    return array;
}

static float *take_floats(fuzz_bytes *bytes, size_t count, uint8_t flags, float step)
{
    float *array = make_array(count, sizeof *array);
    if (flags & ANY_NUMBERS)
        fuzz_take(bytes, array, count * sizeof *array);
    for (size_t i = 0; i < count && !(flags & ANY_NUMBERS); i++)
        array[i] = step * (float)(int8_t)fuzz_take_byte(bytes);
    return array;
}

static uint32_t *take_indices(fuzz_bytes *bytes, size_t count, uint8_t flags, uint32_t limit)
{
    uint32_t *array = make_array(count, sizeof *array);
    if (flags & ANY_INDICES)
        fuzz_take(bytes, array, count * sizeof *array);
    for (size_t i = 0; i < count && !(flags & ANY_INDICES); i++)
        array[i] = limit > 0 ? fuzz_take_byte(bytes) % limit : 0;
    return array;
}

static helio_material *take_materials(fuzz_bytes *bytes, uint32_t count, uint8_t flags)
{
    helio_material *materials = make_array(count, sizeof *materials);
    if (flags & ANY_NUMBERS)
        fuzz_take(bytes, materials, count * sizeof *materials);
    for (uint32_t i = 0; i < count && !(flags & ANY_NUMBERS); i++) {
        float share = (float)fuzz_take_byte(bytes) / 255.0f;
        materials[i] = (helio_material){.kind = (helio_material_kind)(fuzz_take_byte(bytes) % 3),
                                        .diffuse = {share, 0.5f, 1.0f - share},
                                        .roughness = share};
    }
    return materials;
}

static helio_texture *take_textures(fuzz_bytes *bytes, uint32_t count)
{
    helio_texture *textures = make_array(count, sizeof *textures);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t width = fuzz_take_byte(bytes) % (MAX_TEXTURE_EDGE + 1);
        uint32_t height = fuzz_take_byte(bytes) % (MAX_TEXTURE_EDGE + 1);
        uint8_t wrap = fuzz_take_byte(bytes);
        uint8_t *rgba = make_array((size_t)width * height, 4);
        fuzz_take(bytes, rgba, (size_t)4 * width * height);
        textures[i] = (helio_texture){width, height, (helio_wrap)(wrap % 4), (helio_wrap)(wrap / 4 % 4), rgba};
    }
    return textures;
}

static void take_desc(fuzz_bytes *bytes, helio_mesh_desc *desc)
{
    uint8_t flags = fuzz_take_byte(bytes);
    desc->vertex_count = fuzz_take_byte(bytes) % MAX_COUNT;
    desc->triangle_count = fuzz_take_byte(bytes) % MAX_COUNT;
    desc->positions = take_floats(bytes, (size_t)3 * desc->vertex_count, flags, 0.25f);
    desc->triangles = take_indices(bytes, (size_t)3 * desc->triangle_count, flags, desc->vertex_count);
    if (flags & GIVE_NORMALS)
        desc->normals = take_floats(bytes, (size_t)3 * desc->vertex_count, flags, 1.0f);
    if (flags & GIVE_COORDINATES)
        desc->texture_coordinates = take_floats(bytes, (size_t)2 * desc->vertex_count, flags, 0.125f);
    if (flags & GIVE_MATERIALS) {
        desc->material_count = fuzz_take_byte(bytes) % 8;
        desc->triangle_materials = take_indices(bytes, desc->triangle_count, flags, desc->material_count);
        desc->materials = take_materials(bytes, desc->material_count, flags);
    }
    if (flags & GIVE_TEXTURES) {
        desc->texture_count = fuzz_take_byte(bytes) % (MAX_TEXTURES + 1);
        desc->textures = take_textures(bytes, desc->texture_count);
        desc->material_textures = (const helio_material_textures *)take_indices(bytes, (size_t)2 * desc->material_count,
                                                                                flags, desc->texture_count + 1);
    }
    if (flags & ODD_COUNT) {
        uint8_t which = fuzz_take_byte(bytes);
        *(which & 1 ? &desc->vertex_count : &desc->triangle_count) = which & 2 ? UINT32_C(1) << 31 : UINT32_MAX;
    }
}

static void release_desc(const helio_mesh_desc *desc)
{
    for (uint32_t i = 0; i < desc->texture_count; i++)
        free((void *)desc->textures[i].rgba);
    free((void *)desc->positions);
    free((void *)desc->normals);
    free((void *)desc->triangles);
    free((void *)desc->triangle_materials);
    free((void *)desc->materials);
    free((void *)desc->texture_coordinates);
    free((void *)desc->textures);
    free((void *)desc->material_textures);
}

/* What the rest of the library relies on. */
static void check_mesh(const helio_mesh *mesh)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float *n = mesh->normals + 3 * i;
        float squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        FUZZ_EXPECT(squared > 0.999f && squared < 1.001f);
    }
    for (size_t i = 0; i < (size_t)3 * mesh->triangle_count; i++)
        FUZZ_EXPECT(mesh->triangles[i] < mesh->vertex_count);
    for (size_t i = 0; mesh->material_count > 0 && i < mesh->triangle_count; i++)
        FUZZ_EXPECT(mesh->triangle_materials[i] < mesh->material_count);
    for (int axis = 0; axis < 3; axis++)
        FUZZ_EXPECT(isfinite(mesh->bounds[0][axis]) && mesh->bounds[0][axis] <= mesh->bounds[1][axis] &&
                    isfinite(mesh->bounds[1][axis]));
    FUZZ_EXPECT(mesh->degenerate_triangles <= mesh->triangle_count);

    helio_camera camera;
    FUZZ_EXPECT(helio_camera_parse("auto", mesh, 1.5f, &camera) == HELIO_OK);
    for (int axis = 0; axis < 3; axis++)
        FUZZ_EXPECT(isfinite(camera.eye[axis]) && isfinite(camera.at[axis]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes bytes = {data, size};
    helio_mesh_desc desc = {0};
    take_desc(&bytes, &desc);
    helio_mesh *mesh = (helio_mesh *)&desc;
    helio_status status = helio_mesh_create(fuzz_context(), &desc, &mesh);
    if (status == HELIO_OK) {
        check_mesh(mesh);
    } else {
        FUZZ_EXPECT(mesh == NULL);
        FUZZ_EXPECT(status == HELIO_ERR_DATA || status == HELIO_ERR_ARGUMENT);
        fuzz_expect_sentence(true);
    }
    helio_mesh_destroy(fuzz_context(), mesh);
    FUZZ_EXPECT(fuzz_live_blocks() == 0);
    release_desc(&desc);
    return 0;
}
