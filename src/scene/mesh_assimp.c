/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "scene/material.h"
#include "scene/mesh.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <errno.h>
#include <pthread.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

#define MEBIBYTE ((size_t)1 << 20)

/* Files, and what gzipped ones hold, may be this large. */
#define MAX_FILE_BYTES (2048 * MEBIBYTE)

/* A gzipped mesh of this size or less is always fine. A larger one may hold MAX_RATIO times the bytes of the file: text
 * meshes reach 30, and deflate itself 1032, for zeros. */
#define MODEST_BYTES (64 * MEBIBYTE)
#define MAX_RATIO 200

/* assimp walks the tree of nodes by recursion, and so do we. */
enum { MAX_DEPTH = 500 };

/* assimp keeps one error text for the whole process. */
static pthread_mutex_t assimp_mutex = PTHREAD_MUTEX_INITIALIZER;

/* ---- gzip ---------------------------------------------------------------------------- */

typedef struct byte_buffer {
    helio_context *context;
    unsigned char *bytes;
    size_t size, capacity, limit;
} byte_buffer;

/* Doubles the capacity, up to the limit. */
static helio_status buffer_grow(byte_buffer *buffer, const char *path)
{
    if (buffer->capacity == buffer->limit)
        return fail(HELIO_ERR_DATA,
                    "%s holds more than %zu bytes, which is too much for a mesh of its size; unpack it first", path,
                    buffer->limit);
    size_t capacity = buffer->capacity < buffer->limit / 2 ? 2 * buffer->capacity : buffer->limit;
    unsigned char *bytes = context_allocate(buffer->context, capacity, 1);
    if (bytes == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to unpack %s (%zu bytes)", path, capacity);
    memcpy(bytes, buffer->bytes, buffer->size);
    context_release(buffer->context, buffer->bytes);
    buffer->bytes = bytes;
    buffer->capacity = capacity;
    return HELIO_OK;
}

/* Inflates one member after the other until the file ends. */
static helio_status inflate_members(z_stream *stream, byte_buffer *buffer, const char *path)
{
    for (;;) {
        if (buffer->size == buffer->capacity)
            HELIO_TRY(buffer_grow(buffer, path));
        stream->next_out = buffer->bytes + buffer->size;
        stream->avail_out = (uInt)(buffer->capacity - buffer->size);
        int result = inflate(stream, Z_NO_FLUSH);
        buffer->size = buffer->capacity - stream->avail_out;
        if (result == Z_STREAM_END) {
            /* Whatever else follows a member is padding, which gzip ignores too. */
            if (stream->avail_in < 2 || stream->next_in[0] != 0x1f || stream->next_in[1] != 0x8b)
                return HELIO_OK;
            inflateReset(stream);
        } else if (result == Z_MEM_ERROR) {
            return fail(HELIO_ERR_MEMORY, "no memory to unpack %s", path);
        } else if (result != Z_OK && !(result == Z_BUF_ERROR && stream->avail_out == 0)) {
            return fail(HELIO_ERR_DATA, "%s is not a complete gzip file: %s", path,
                        stream->msg ? stream->msg : "it ends too early");
        }
    }
}

/* Reads a gzipped file; *bytes is memory of the context. */
static helio_status read_gzip(helio_context *context, const char *path, unsigned char **bytes, size_t *size)
{
    unsigned char *packed;
    size_t packed_size;
    HELIO_TRY(file_read(context, path, MAX_FILE_BYTES, &packed, &packed_size));

    byte_buffer buffer = {.context = context, .capacity = 4 * packed_size + 4096, .limit = MODEST_BYTES};
    if (packed_size > MODEST_BYTES / MAX_RATIO)
        buffer.limit = packed_size < MAX_FILE_BYTES / MAX_RATIO ? packed_size * MAX_RATIO : MAX_FILE_BYTES;
    if (buffer.capacity > buffer.limit)
        buffer.capacity = buffer.limit;
    z_stream stream = {.next_in = packed, .avail_in = (uInt)packed_size};
    helio_status status = HELIO_OK;
    buffer.bytes = context_allocate(context, buffer.capacity, 1);
    if (buffer.bytes == NULL || inflateInit2(&stream, 16 + MAX_WBITS) != Z_OK) {
        status = fail(HELIO_ERR_MEMORY, "no memory to unpack %s", path);
    } else {
        status = inflate_members(&stream, &buffer, path);
        inflateEnd(&stream);
    }
    context_release(context, packed);
    if (status != HELIO_OK) {
        context_release(context, buffer.bytes);
        return status;
    }
    *bytes = buffer.bytes;
    *size = buffer.size;
    return HELIO_OK;
}

/* ---- the file as assimp's scene -------------------------------------------------------- */

/* Only what is cheap: everything else that assimp offers, joining of vertices for example, takes longer than reading. */
static const unsigned POST_PROCESSING = aiProcess_Triangulate;

static const struct aiScene *import_gzip(helio_context *context, const char *path, helio_status *status)
{
    unsigned char *bytes;
    size_t size;
    *status = read_gzip(context, path, &bytes, &size);
    if (*status != HELIO_OK)
        return NULL;
    /* "ply" of "dragon.ply.gz" tells assimp the format. */
    char inner[16] = "";
    size_t stem = strlen(path) - strlen(".gz");
    size_t start = stem;
    while (start > 0 && path[start - 1] != '.' && path[start - 1] != '/')
        start--;
    if (start > 0 && path[start - 1] == '.' && stem - start < sizeof inner)
        memcpy(inner, path + start, stem - start);
    const struct aiScene *scene = aiImportFileFromMemory((const char *)bytes, (unsigned)size, POST_PROCESSING, inner);
    context_release(context, bytes);
    return scene;
}

/* assimp's own sentence about a file that does not exist names no reason, and it would wait for a named pipe. */
static helio_status check_file(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return fail(HELIO_ERR_IO, "%s cannot be opened: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return fail(HELIO_ERR_IO, "%s is not a file", path);
    if ((uintmax_t)status.st_size > MAX_FILE_BYTES)
        return fail(HELIO_ERR_DATA, "%s is too large: %jd bytes, where %zu are allowed", path, (intmax_t)status.st_size,
                    MAX_FILE_BYTES);
    return HELIO_OK;
}

static helio_status open_scene(helio_context *context, const char *path, const struct aiScene **scene)
{
    HELIO_TRY(check_file(path));
    helio_status status = HELIO_OK;
    pthread_mutex_lock(&assimp_mutex);
    if (file_has_extension(path, "gz"))
        *scene = import_gzip(context, path, &status);
    else
        *scene = aiImportFile(path, POST_PROCESSING);
    if (*scene == NULL && status == HELIO_OK)
        status = fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: %s", path, aiGetErrorString());
    pthread_mutex_unlock(&assimp_mutex);
    return status;
}

/* ---- materials ----------------------------------------------------------------------- */

static float clamp(float value, float greatest)
{
    return value >= 0.0f ? fminf(value, greatest) : 0.0f; /* NaN becomes 0 */
}

static bool read_colour(const struct aiMaterial *from, const char *key, float colour[3])
{
    struct aiColor4D rgba;
    if (aiGetMaterialColor(from, key, 0, 0, &rgba) != aiReturn_SUCCESS)
        return false;
    colour[0] = clamp(rgba.r, 1.0f);
    colour[1] = clamp(rgba.g, 1.0f);
    colour[2] = clamp(rgba.b, 1.0f);
    return true;
}

static bool read_float(const struct aiMaterial *from, const char *key, float greatest, float *value)
{
    ai_real number;
    if (aiGetMaterialFloatArray(from, key, 0, 0, &number, NULL) != aiReturn_SUCCESS)
        return false;
    *value = clamp((float)number, greatest);
    return true;
}

static bool has_texture(const struct aiMaterial *from)
{
    return aiGetMaterialTextureCount(from, aiTextureType_DIFFUSE) != 0 ||
           aiGetMaterialTextureCount(from, aiTextureType_BASE_COLOR) != 0;
}

/* Does the material come from the file? assimp makes one up where a file brings none: it is named "DefaultMaterial", or
 * nothing in PLY, or is glTF's own default, which is a file's way to say nothing. */
static bool is_from_file(const struct aiMaterial *from, const helio_material *material)
{
    struct aiString name;
    bool named = aiGetMaterialString(from, AI_MATKEY_NAME, &name) == aiReturn_SUCCESS && name.length != 0;
    if (named)
        return strcmp(name.data, AI_DEFAULT_MATERIAL_NAME) != 0;
    if (material->kind != HELIO_MATERIAL_GGX)
        return false;
    bool white = material->diffuse[0] == 1.0f && material->diffuse[1] == 1.0f && material->diffuse[2] == 1.0f;
    return !white || material->metallic != 1.0f || material->roughness != 1.0f || has_texture(from);
}

/* Scales diffuse and specular down to where they conserve energy. False if they do anyway. */
static bool limit_energy(helio_material *material)
{
    float greatest = 0.0f;
    for (int c = 0; c < 3; c++)
        greatest = fmaxf(greatest, material->diffuse[c] + material->specular[c]);
    if (greatest <= 1.0f)
        return false;
    for (int c = 0; c < 3; c++) {
        material->diffuse[c] /= greatest;
        material->specular[c] /= greatest;
    }
    return true;
}

/* Metallic-roughness where the file has it, else diffuse, else Phong if there are Ks and Ns. */
static helio_material read_material(helio_context *context, const char *path, const struct aiMaterial *from)
{
    helio_material material = {.kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 1.0f, 1.0f}, .metallic = 1.0f};
    if (!read_colour(from, "$clr.base", material.diffuse))
        read_colour(from, "$clr.diffuse", material.diffuse);
    if (read_float(from, "$mat.metallicFactor", 1.0f, &material.metallic)) {
        material.roughness = 1.0f;
        read_float(from, "$mat.roughnessFactor", 1.0f, &material.roughness);
        return material;
    }
    material.kind = HELIO_MATERIAL_DIFFUSE;
    material.metallic = 0.0f;
    bool glossy = read_colour(from, "$clr.specular", material.specular) &&
                  read_float(from, "$mat.shininess", 1e5f, &material.exponent) && material.exponent > 0.0f &&
                  material.specular[0] + material.specular[1] + material.specular[2] > 0.0f;
    if (!glossy) {
        memset(material.specular, 0, sizeof material.specular);
        return material;
    }
    material.kind = HELIO_MATERIAL_PHONG;
    if (limit_energy(&material))
        context_log(context, HELIO_LOG_WARNING,
                    "%s: a material reflects more than it receives (Kd + Ks > 1); scaled down", path);
    return material;
}

/* ---- flattening ------------------------------------------------------------------------ */

/* Three rows of an affine transform. */
typedef struct transform {
    double m[3][4];
} transform;

static transform transform_from(const struct aiMatrix4x4 *a)
{
    return (transform){{{(double)a->a1, (double)a->a2, (double)a->a3, (double)a->a4},
                        {(double)a->b1, (double)a->b2, (double)a->b3, (double)a->b4},
                        {(double)a->c1, (double)a->c2, (double)a->c3, (double)a->c4}}};
}

/* a after b */
static transform transform_multiply(const transform *a, const transform *b)
{
    transform product;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            product.m[i][j] = j == 3 ? a->m[i][3] : 0.0;
            for (int k = 0; k < 3; k++)
                product.m[i][j] += a->m[i][k] * b->m[k][j];
        }
    return product;
}

/* The matrix for normals, which is the inverse transpose but for a positive factor: the cofactors, negated if the
 * transform mirrors. Returns whether it does. */
static bool transform_cofactors(const transform *t, double cofactors[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            cofactors[i][j] = t->m[i1][j1] * t->m[i2][j2] - t->m[i1][j2] * t->m[i2][j1];
        }
    double determinant = 0.0;
    for (int j = 0; j < 3; j++)
        determinant += t->m[0][j] * cofactors[0][j];
    if (determinant >= 0.0)
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            cofactors[i][j] = -cofactors[i][j];
    return true;
}

/* Walks the tree twice: first counts (arrays without memory), then fills. */
typedef struct flattener {
    const struct aiScene *scene;
    mesh_arrays *arrays;
    bool fill;
    uint64_t vertices, triangles; /* so far */
    bool normals;                 /* some mesh has them */
    uint32_t *materials;          /* [scene->mNumMaterials]: ours for each of assimp's, or how it is used */
} flattener;

/* What flattener.materials holds before materials have numbers. */
#define MATERIAL_UNUSED 0u
#define MATERIAL_USED 1u

/* And for materials that assimp made up, until it is known whether the file brings others. */
#define MATERIAL_MADE_UP UINT32_MAX

static uint32_t count_triangles(const struct aiMesh *mesh)
{
    uint32_t count = 0;
    for (unsigned i = 0; i < mesh->mNumFaces; i++)
        count += mesh->mFaces[i].mNumIndices == 3; /* the others are points and lines */
    return count;
}

static void fill_vertices(flattener *f, const struct aiMesh *mesh, const transform *t, double cofactors[3][3])
{
    for (size_t i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *p = &mesh->mVertices[i];
        const struct aiVector3D *n = mesh->mNormals ? &mesh->mNormals[i] : NULL;
        for (size_t row = 0; row < 3; row++) {
            const double *m = t->m[row], *c = cofactors[row];
            size_t at = 3 * (f->vertices + i) + row;
            f->arrays->positions[at] = (float)(m[0] * (double)p->x + m[1] * (double)p->y + m[2] * (double)p->z + m[3]);
            if (n != NULL)
                f->arrays->normals[at] = (float)(c[0] * (double)n->x + c[1] * (double)n->y + c[2] * (double)n->z);
        }
    }
}

/* Mirrored triangles are turned round, so that they stay counter-clockwise from outside. */
static helio_status fill_triangles(flattener *f, const struct aiMesh *mesh, bool mirrored)
{
    size_t at = f->triangles;
    for (unsigned i = 0; i < mesh->mNumFaces; i++) {
        const struct aiFace *face = &mesh->mFaces[i];
        if (face->mNumIndices != 3)
            continue;
        for (int corner = 0; corner < 3; corner++) {
            unsigned index = face->mIndices[mirrored ? 2 - corner : corner];
            if (index >= mesh->mNumVertices)
                return fail(HELIO_ERR_DATA, "a triangle names vertex %u of %u", index, mesh->mNumVertices);
            f->arrays->triangles[3 * at + (size_t)corner] = (uint32_t)f->vertices + index;
        }
        if (f->arrays->triangle_materials != NULL)
            f->arrays->triangle_materials[at] = f->materials[mesh->mMaterialIndex];
        at++;
    }
    return HELIO_OK;
}

static helio_status flatten_mesh(flattener *f, unsigned index, const transform *t)
{
    const struct aiMesh *mesh = index < f->scene->mNumMeshes ? f->scene->mMeshes[index] : NULL;
    uint32_t triangles = mesh && mesh->mVertices ? count_triangles(mesh) : 0;
    if (triangles == 0)
        return HELIO_OK;
    if (mesh->mMaterialIndex >= f->scene->mNumMaterials)
        return fail(HELIO_ERR_DATA, "a mesh names material %u of %u", mesh->mMaterialIndex, f->scene->mNumMaterials);
    if (!f->fill) {
        f->materials[mesh->mMaterialIndex] = MATERIAL_USED;
    } else {
        double cofactors[3][3];
        bool mirrored = transform_cofactors(t, cofactors);
        fill_vertices(f, mesh, t, cofactors);
        HELIO_TRY(fill_triangles(f, mesh, mirrored));
    }
    f->normals |= mesh->mNormals != NULL;
    f->vertices += mesh->mNumVertices;
    f->triangles += triangles;
    if (f->vertices > MESH_MAX_ELEMENTS || f->triangles > MESH_MAX_ELEMENTS)
        return fail(HELIO_ERR_DATA, "it has more than %u vertices or triangles", MESH_MAX_ELEMENTS);
    return HELIO_OK;
}

static helio_status flatten_node(flattener *f, const struct aiNode *node, const transform *parent, int depth)
{
    if (depth > MAX_DEPTH)
        return fail(HELIO_ERR_DATA, "its nodes are nested more than %d deep", MAX_DEPTH);
    transform own = transform_from(&node->mTransformation);
    transform t = transform_multiply(parent, &own);
    for (unsigned i = 0; i < node->mNumMeshes; i++)
        HELIO_TRY(flatten_mesh(f, node->mMeshes[i], &t));
    for (unsigned i = 0; i < node->mNumChildren; i++)
        HELIO_TRY(flatten_node(f, node->mChildren[i], &t, depth + 1));
    return HELIO_OK;
}

static helio_status flatten_tree(flattener *f)
{
    static const transform identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    f->vertices = 0;
    f->triangles = 0;
    return flatten_node(f, f->scene->mRootNode, &identity, 0);
}

/* Gives numbers to the materials in use. Those that assimp made up share one of ours, and where there are no others the
 * mesh has no materials. */
static helio_status number_materials(helio_context *context, const char *path, flattener *f)
{
    mesh_arrays *arrays = f->arrays;
    arrays->materials = context_allocate(context, (size_t)f->scene->mNumMaterials + 1, sizeof *arrays->materials);
    if (arrays->materials == NULL)
        return HELIO_ERR_MEMORY;
    uint32_t textures = 0, count = 0, made_up = 0;
    for (unsigned i = 0; i < f->scene->mNumMaterials; i++) {
        const struct aiMaterial *from = f->scene->mMaterials[i];
        if (f->materials[i] == MATERIAL_UNUSED)
            continue;
        helio_material material = read_material(context, path, from);
        if (is_from_file(from, &material)) {
            textures += has_texture(from);
            f->materials[i] = count;
            arrays->materials[count++] = material;
        } else {
            f->materials[i] = MATERIAL_MADE_UP;
            made_up++;
        }
    }
    if (textures != 0)
        context_log(context, HELIO_LOG_WARNING, "%s: the colour textures of %u material%s are not read", path, textures,
                    textures == 1 ? "" : "s");
    if (count == 0)
        return HELIO_OK;
    arrays->material_count = count + (made_up != 0);
    arrays->materials[count] = material_default();
    for (unsigned i = 0; i < f->scene->mNumMaterials; i++)
        if (f->materials[i] == MATERIAL_MADE_UP)
            f->materials[i] = count;
    return HELIO_OK;
}

static helio_status allocate_arrays(helio_context *context, const flattener *f)
{
    mesh_arrays *arrays = f->arrays;
    arrays->vertex_count = (uint32_t)f->vertices;
    arrays->triangle_count = (uint32_t)f->triangles;
    arrays->positions = context_allocate(context, 3 * f->vertices, sizeof(float));
    arrays->triangles = context_allocate(context, 3 * f->triangles, sizeof(uint32_t));
    if (arrays->positions == NULL || arrays->triangles == NULL)
        return HELIO_ERR_MEMORY;
    if (f->normals && (arrays->normals = context_allocate(context, 3 * f->vertices, sizeof(float))) == NULL)
        return HELIO_ERR_MEMORY;
    if (arrays->material_count != 0) {
        arrays->triangle_materials = context_allocate(context, f->triangles, sizeof(uint32_t));
        return arrays->triangle_materials ? HELIO_OK : HELIO_ERR_MEMORY;
    }
    context_release(context, arrays->materials);
    arrays->materials = NULL;
    return HELIO_OK;
}

static helio_status flatten_scene(helio_context *context, const char *path, flattener *f)
{
    if (f->scene->mRootNode == NULL)
        return fail(HELIO_ERR_DATA, "%s holds no triangles", path);
    if (flatten_tree(f) != HELIO_OK)
        return fail(HELIO_ERR_DATA, "%s cannot be used: %s", path, helio_last_error());
    if (f->triangles == 0)
        return fail(HELIO_ERR_DATA, "%s holds no triangles", path);
    HELIO_TRY(number_materials(context, path, f));
    HELIO_TRY(allocate_arrays(context, f));
    f->fill = true;
    if (flatten_tree(f) != HELIO_OK)
        return fail(HELIO_ERR_DATA, "%s cannot be used: %s", path, helio_last_error());
    return HELIO_OK;
}

helio_status mesh_import(helio_context *context, const char *path, mesh_arrays *arrays)
{
    *arrays = (mesh_arrays){0};
    const struct aiScene *scene;
    HELIO_TRY(open_scene(context, path, &scene));
    flattener f = {.scene = scene, .arrays = arrays};
    f.materials = context_allocate(context, scene->mNumMaterials, sizeof *f.materials);
    helio_status status = f.materials ? flatten_scene(context, path, &f) : HELIO_ERR_MEMORY;
    context_release(context, f.materials);
    aiReleaseImport(scene);
    if (status != HELIO_OK)
        mesh_arrays_release(context, arrays);
    return status;
}

void mesh_arrays_release(helio_context *context, mesh_arrays *arrays)
{
    context_release(context, arrays->positions);
    context_release(context, arrays->normals);
    context_release(context, arrays->triangles);
    context_release(context, arrays->triangle_materials);
    context_release(context, arrays->materials);
    *arrays = (mesh_arrays){0};
}
