/* SPDX-License-Identifier: MIT */
#include "scene/mesh.h"

#include "core/context.h"
#include "core/error.h"
#include "scene/texture.h"

#include <string.h>

/* A triangle counts as degenerate if its height is less than this part of its longest edge. */
#define DEGENERATE_HEIGHT 1e-12

/* Vertex normals whose sum cancels to less than this part of the summed weights have no direction worth the name. */
#define CANCELLED_SUM 1e-4

/* ---- triangles --------------------------------------------------------------------- */

/* In double precision: products of three coordinates of large or tiny meshes leave the range of floats. */
typedef struct edge {
    double x, y, z;
} edge;

static edge edge_between(const float *from, const float *to)
{
    return (edge){(double)to[0] - (double)from[0], (double)to[1] - (double)from[1], (double)to[2] - (double)from[2]};
}

static double edge_dot(edge a, edge b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static edge edge_cross(edge a, edge b)
{
    return (edge){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static const float *triangle_corner(const helio_mesh *mesh, uint32_t triangle, uint32_t corner)
{
    return mesh->positions + 3 * (size_t)mesh->triangles[3 * (size_t)triangle + corner % 3];
}

/* The edges that run from corner i to corner i + 1, and their common unit normal. */
static bool measure_triangle(const helio_mesh *mesh, uint32_t triangle, edge edges[3], edge *normal)
{
    double longest = 0.0;
    for (uint32_t i = 0; i < 3; i++) {
        edges[i] = edge_between(triangle_corner(mesh, triangle, i), triangle_corner(mesh, triangle, i + 1));
        longest = fmax(longest, edge_dot(edges[i], edges[i]));
    }
    edge n = edge_cross(edges[0], edges[1]);
    double area = sqrt(edge_dot(n, n));
    if (area <= DEGENERATE_HEIGHT * longest)
        return false;
    *normal = (edge){n.x / area, n.y / area, n.z / area};
    return true;
}

bool mesh_triangle_normal(const helio_mesh *mesh, uint32_t triangle, vec3 *normal)
{
    edge edges[3], n;
    if (!measure_triangle(mesh, triangle, edges, &n))
        return false;
    *normal = (vec3){(float)n.x, (float)n.y, (float)n.z};
    return true;
}

/* Unreferenced vertices, common in scans, neither carry the ground nor widen the picture. */
static void measure_bounds(helio_mesh *mesh)
{
    for (int axis = 0; axis < 3; axis++) {
        mesh->bounds[0][axis] = INFINITY;
        mesh->bounds[1][axis] = -INFINITY;
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        for (uint32_t corner = 0; corner < 3; corner++) {
            const float *position = triangle_corner(mesh, i, corner);
            for (int axis = 0; axis < 3; axis++) {
                mesh->bounds[0][axis] = fminf(mesh->bounds[0][axis], position[axis]);
                mesh->bounds[1][axis] = fmaxf(mesh->bounds[1][axis], position[axis]);
            }
        }
}

static void count_degenerate(helio_mesh *mesh)
{
    vec3 normal;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        mesh->degenerate_triangles += !mesh_triangle_normal(mesh, i, &normal);
}

/* ---- vertices at the same place ------------------------------------------------------ */

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

static uint32_t coordinate_bits(float value)
{
    float plain = value + 0.0f; /* -0 becomes 0 */
    uint32_t bits;
    memcpy(&bits, &plain, sizeof bits);
    return bits;
}

/* One pass of a radix sort: brings from into the order of one digit of one coordinate, and keeps it otherwise. */
static void sort_by_digit(const float *positions, int axis, int shift, const uint32_t *from, uint32_t *to,
                          uint32_t count)
{
    uint32_t start[DIGITS + 1] = {0};
    for (uint32_t i = 0; i < count; i++)
        start[(coordinate_bits(positions[3 * (size_t)i + (size_t)axis]) >> shift) % DIGITS + 1]++;
    for (uint32_t digit = 0; digit < DIGITS; digit++)
        start[digit + 1] += start[digit];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bits = coordinate_bits(positions[3 * (size_t)from[i] + (size_t)axis]);
        to[start[(bits >> shift) % DIGITS]++] = from[i];
    }
}

static bool same_place(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Writes for each vertex the first vertex that has the same position. A sort takes the same time for every file; a hash
 * table could be slowed down at will. */
static helio_status find_first_vertices(helio_context *context, const helio_mesh *mesh, uint32_t *first)
{
    uint32_t count = mesh->vertex_count;
    uint32_t *memory = context_allocate(context, 2 * (size_t)count, sizeof *memory);
    if (memory == NULL)
        return HELIO_ERR_MEMORY;
    uint32_t *order = memory, *other = memory + count;
    for (uint32_t i = 0; i < count; i++)
        order[i] = i;
    for (int axis = 0; axis < 3; axis++)
        for (int shift = 0; shift < 32; shift += DIGIT_BITS) {
            sort_by_digit(mesh->positions, axis, shift, order, other, count);
            uint32_t *sorted = other;
            other = order;
            order = sorted;
        }
    for (uint32_t i = 0; i < count; i++) {
        const float *position = mesh->positions + 3 * (size_t)order[i];
        bool starts = i == 0 || !same_place(position, mesh->positions + 3 * (size_t)order[i - 1]);
        first[order[i]] = starts ? order[i] : first[order[i - 1]];
    }
    context_release(context, memory);
    return HELIO_OK;
}

/* ---- normals ------------------------------------------------------------------------- */

/* Sum of the face normals around a place, and of their weights: angle x roundness. The angle makes the normal
 * independent of how a flat part is cut into triangles. Alone it lets slivers and folds, of which decimated scans are
 * full, count as much as what they stick out of, and they show as black specks. */
typedef struct normal_sum {
    edge normal;
    double weight;
} normal_sum;

static double angle_between(edge a, edge b)
{
    edge n = edge_cross(a, b);
    return atan2(sqrt(edge_dot(n, n)), edge_dot(a, b));
}

/* Height over the longest edge: 0.87 for equal sides, 0 for a needle. */
static double roundness_of(const edge edges[3])
{
    edge n = edge_cross(edges[0], edges[1]);
    double longest =
        fmax(edge_dot(edges[0], edges[0]), fmax(edge_dot(edges[1], edges[1]), edge_dot(edges[2], edges[2])));
    return sqrt(edge_dot(n, n)) / longest;
}

static void sum_normals(const helio_mesh *mesh, const uint32_t *first, normal_sum *sums)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        edge edges[3], normal;
        if (!measure_triangle(mesh, i, edges, &normal))
            continue;
        double roundness = roundness_of(edges);
        for (uint32_t corner = 0; corner < 3; corner++) {
            edge in = edges[(corner + 2) % 3];
            double weight = roundness * angle_between(edges[corner], (edge){-in.x, -in.y, -in.z});
            normal_sum *sum = &sums[first[mesh->triangles[3 * (size_t)i + corner]]];
            sum->normal.x += weight * normal.x;
            sum->normal.y += weight * normal.y;
            sum->normal.z += weight * normal.z;
            sum->weight += weight;
        }
    }
}

static bool has_normal(const float *normal)
{
    return normal[0] != 0.0f || normal[1] != 0.0f || normal[2] != 0.0f;
}

/* For vertices whose sum cancels, as on both sides of a sheet: the normal of a face of their own. */
static void take_face_normals(helio_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        for (uint32_t corner = 0; corner < 3; corner++) {
            float *normal = mesh->normals + 3 * (size_t)mesh->triangles[3 * (size_t)i + corner];
            vec3 face;
            if (!has_normal(normal) && mesh_triangle_normal(mesh, i, &face))
                vec3_to(face, normal);
        }
}

/* Fills in the normals that are zero. */
static helio_status compute_normals(helio_context *context, helio_mesh *mesh)
{
    uint32_t *first = context_allocate(context, mesh->vertex_count, sizeof *first);
    normal_sum *sums = context_allocate(context, mesh->vertex_count, sizeof *sums);
    helio_status status = first && sums ? find_first_vertices(context, mesh, first) : HELIO_ERR_MEMORY;
    if (status == HELIO_OK) {
        sum_normals(mesh, first, sums);
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            normal_sum sum = sums[first[i]];
            double size = sqrt(edge_dot(sum.normal, sum.normal));
            if (!has_normal(mesh->normals + 3 * i) && size > CANCELLED_SUM * sum.weight)
                vec3_to(
                    (vec3){(float)(sum.normal.x / size), (float)(sum.normal.y / size), (float)(sum.normal.z / size)},
                    mesh->normals + 3 * i);
        }
        take_face_normals(mesh);
        for (size_t i = 0; i < mesh->vertex_count; i++)
            if (!has_normal(mesh->normals + 3 * i))
                mesh->normals[3 * i + 1] = 1.0f;
    }
    context_release(context, first);
    context_release(context, sums);
    return status;
}

/* Copies normals at unit length; those without a length become zero. Returns how many these are. */
static uint32_t copy_normals(helio_mesh *mesh, const float *normals)
{
    uint32_t missing = 0;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        edge n = {(double)normals[3 * i], (double)normals[3 * i + 1], (double)normals[3 * i + 2]};
        double size = sqrt(edge_dot(n, n));
        if (size > 0.0 && isfinite(size))
            vec3_to((vec3){(float)(n.x / size), (float)(n.y / size), (float)(n.z / size)}, mesh->normals + 3 * i);
        else
            missing++;
    }
    return missing;
}

/* ---- life ---------------------------------------------------------------------------- */

static helio_status allocate_mesh(helio_context *context, const helio_mesh_desc *desc, helio_mesh *mesh)
{
    size_t vertices = desc->vertex_count, triangles = desc->triangle_count;
    /* One float more: the ray tracer reads vertices by 16 bytes, also the last one. */
    mesh->positions = context_allocate(context, 3 * vertices + 1, sizeof(float));
    mesh->normals = context_allocate(context, 3 * vertices, sizeof(float));
    mesh->triangles = context_allocate(context, 3 * triangles, sizeof(uint32_t));
    if (mesh->positions == NULL || mesh->normals == NULL || mesh->triangles == NULL)
        return HELIO_ERR_MEMORY;
    if (desc->material_count == 0)
        return HELIO_OK;
    mesh->triangle_materials = context_allocate(context, triangles, sizeof(uint32_t));
    mesh->materials = context_allocate(context, desc->material_count, sizeof(helio_material));
    return mesh->triangle_materials && mesh->materials ? HELIO_OK : HELIO_ERR_MEMORY;
}

static void *copy_array(helio_context *context, const void *from, size_t count, size_t size)
{
    void *to = context_allocate(context, count, size);
    if (to != NULL)
        memcpy(to, from, count * size);
    return to;
}

static helio_status fill_textures(helio_context *context, const helio_mesh_desc *desc, helio_mesh *mesh)
{
    if (desc->texture_coordinates != NULL &&
        (mesh->texture_coordinates =
             copy_array(context, desc->texture_coordinates, desc->vertex_count, 2 * sizeof(float))) == NULL)
        return HELIO_ERR_MEMORY;
    if (desc->texture_count == 0)
        return HELIO_OK;
    mesh->material_textures =
        copy_array(context, desc->material_textures, desc->material_count, sizeof(helio_material_textures));
    mesh->textures = context_allocate(context, desc->texture_count, sizeof(helio_texture));
    if (mesh->material_textures == NULL || mesh->textures == NULL)
        return HELIO_ERR_MEMORY;
    for (uint32_t i = 0; i < desc->texture_count; i++) {
        helio_texture texture = desc->textures[i];
        texture.rgba = copy_array(context, texture.rgba, (size_t)texture.width * texture.height, 4);
        if (texture.rgba == NULL)
            return HELIO_ERR_MEMORY;
        mesh->textures[mesh->texture_count++] = texture;
    }
    return HELIO_OK;
}

static helio_status fill_mesh(helio_context *context, const helio_mesh_desc *desc, helio_mesh *mesh)
{
    size_t vertices = desc->vertex_count, triangles = desc->triangle_count;
    HELIO_TRY(allocate_mesh(context, desc, mesh));
    mesh->vertex_count = desc->vertex_count;
    mesh->triangle_count = desc->triangle_count;
    mesh->material_count = desc->material_count;
    memcpy(mesh->positions, desc->positions, vertices * 3 * sizeof(float));
    memcpy(mesh->triangles, desc->triangles, triangles * 3 * sizeof(uint32_t));
    if (desc->material_count != 0) {
        memcpy(mesh->triangle_materials, desc->triangle_materials, triangles * sizeof(uint32_t));
        memcpy(mesh->materials, desc->materials, desc->material_count * sizeof(helio_material));
    }
    HELIO_TRY(fill_textures(context, desc, mesh));
    measure_bounds(mesh);
    count_degenerate(mesh);
    uint32_t missing = desc->normals ? copy_normals(mesh, desc->normals) : mesh->vertex_count;
    mesh->has_file_normals = missing < mesh->vertex_count;
    return missing ? compute_normals(context, mesh) : HELIO_OK;
}

helio_status helio_mesh_create(helio_context *context, const helio_mesh_desc *desc, helio_mesh **out)
{
    if (out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_create needs a place for the mesh");
    *out = NULL;
    if (context == NULL || desc == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_mesh_create needs a context and a desc");
    HELIO_TRY(mesh_desc_check(desc));
    helio_mesh *mesh = context_allocate(context, 1, sizeof *mesh);
    if (mesh == NULL)
        return HELIO_ERR_MEMORY;
    helio_status status = fill_mesh(context, desc, mesh);
    if (status != HELIO_OK) {
        helio_mesh_destroy(context, mesh);
        return status;
    }
    *out = mesh;
    return HELIO_OK;
}

void mesh_arrays_release(helio_context *context, mesh_arrays *arrays)
{
    context_release(context, arrays->positions);
    context_release(context, arrays->normals);
    context_release(context, arrays->triangles);
    context_release(context, arrays->triangle_materials);
    context_release(context, arrays->materials);
    context_release(context, arrays->texture_coordinates);
    context_release(context, arrays->material_textures);
    for (uint32_t i = 0; i < arrays->texture_count; i++)
        texture_release(context, &arrays->textures[i]);
    context_release(context, arrays->textures);
    *arrays = (mesh_arrays){0};
}

void helio_mesh_destroy(helio_context *context, helio_mesh *mesh)
{
    if (mesh == NULL)
        return;
    mesh_arrays_release(context, mesh);
    context_release(context, mesh);
}
