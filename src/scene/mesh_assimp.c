/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "image/image.h"
#include "scene/gzip.h"
#include "scene/mesh_import.h"
#include "scene/ply_check.h"
#include "scene/texture.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

/* Files, and what gzipped ones hold, may be this large. */
#define MAX_FILE_BYTES ((size_t)2 << 30)

/* assimp walks the tree of nodes by recursion, and so do we. */
enum { MAX_DEPTH = 500 };

/* ---- the file as assimp's scene -------------------------------------------------------- */

/* Only what is cheap: everything else that assimp offers, joining of vertices for example, takes longer than reading.
 */
static const unsigned POST_PROCESSING = aiProcess_Triangulate;

/* Files that end too early are found before assimp sees them: it makes up what is missing, or crashes. */
static helio_status check_bytes(const char *path, const unsigned char *bytes, size_t size)
{
    ply_stream stream;
    ply_stream_open_memory(&stream, bytes, size);
    return ply_check(&stream, path);
}

static const struct aiScene *import_bytes(const char *path, const unsigned char *bytes, size_t size)
{
    /* "ply" of "dragon.ply.gz" tells assimp the format. */
    char inner[16] = "";
    size_t stem = strlen(path) - strlen(".gz");
    size_t start = stem;
    while (start > 0 && path[start - 1] != '.' && path[start - 1] != '/')
        start--;
    if (start > 0 && path[start - 1] == '.' && stem - start < sizeof inner)
        memcpy(inner, path + start, stem - start);
    return aiImportFileFromMemory((const char *)bytes, (unsigned)size, POST_PROCESSING, inner);
}

static helio_status import_gzip(helio_context *context, const char *path, const struct aiScene **scene)
{
    unsigned char *bytes;
    size_t size;
    HELIO_TRY(gzip_read(context, path, MAX_FILE_BYTES, &bytes, &size));
    helio_status status = check_bytes(path, bytes, size);
    *scene = status == HELIO_OK ? import_bytes(path, bytes, size) : NULL;
    context_release(context, bytes);
    return status;
}

static helio_status import_file(const char *path, const struct aiScene **scene)
{
    ply_stream stream;
    FILE *file;
    uint64_t size;
    HELIO_TRY(file_open(path, &file, &size));
    ply_stream_open_file(&stream, file, size);
    helio_status status = ply_check(&stream, path);
    fclose(file);
    *scene = status == HELIO_OK ? aiImportFile(path, POST_PROCESSING) : NULL;
    return status;
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

/* In assimp's words, which may hold words of the file. */
static helio_status fail_with_assimp(const char *path)
{
    char reason[512];
    snprintf(reason, sizeof reason, "%s", aiGetErrorString());
    image_make_printable(reason);
    if (strstr(reason, "bad_alloc") != NULL || strstr(reason, "bad allocation") != NULL)
        return fail(HELIO_ERR_MEMORY, "no memory to read %s", path);
    return fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: %s", path, reason);
}

static helio_status open_scene(helio_context *context, const char *path, const struct aiScene **scene)
{
    HELIO_TRY(check_file(path));
    if (file_has_extension(path, "gz"))
        HELIO_TRY(import_gzip(context, path, scene));
    else
        HELIO_TRY(import_file(path, scene));
    return *scene == NULL ? fail_with_assimp(path) : HELIO_OK;
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
    material_use *uses;           /* [scene->mNumMaterials] */
    bool bad_coordinates;         /* some texture coordinates were not usable */
} flattener;

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

/* assimp counts v from the lower edge, in glTF too. Meshes without coordinates keep (0, 0). */
static void fill_texture_coordinates(flattener *f, const struct aiMesh *mesh)
{
    uint32_t set = f->uses[mesh->mMaterialIndex].coordinate_set;
    if (f->arrays->texture_coordinates == NULL || set >= AI_MAX_NUMBER_OF_TEXTURECOORDS ||
        mesh->mTextureCoords[set] == NULL)
        return;
    float *to = f->arrays->texture_coordinates + 2 * f->vertices;
    for (size_t i = 0; i < mesh->mNumVertices; i++) {
        const struct aiVector3D *from = &mesh->mTextureCoords[set][i];
        float u = (float)from->x, v = 1.0f - (float)from->y;
        bool good = fabsf(u) <= TEXTURE_MAX_COORDINATE && fabsf(v) <= TEXTURE_MAX_COORDINATE;
        to[2 * i] = good ? u : 0.0f;
        to[2 * i + 1] = good ? v : 0.0f;
        f->bad_coordinates |= !good;
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
            f->arrays->triangle_materials[at] = f->uses[mesh->mMaterialIndex].number;
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
        f->uses[mesh->mMaterialIndex].used = true;
    } else {
        double cofactors[3][3];
        bool mirrored = transform_cofactors(t, cofactors);
        fill_vertices(f, mesh, t, cofactors);
        fill_texture_coordinates(f, mesh);
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
    if (arrays->material_count != 0 &&
        (arrays->triangle_materials = context_allocate(context, f->triangles, sizeof(uint32_t))) == NULL)
        return HELIO_ERR_MEMORY;
    if (arrays->texture_count != 0 &&
        (arrays->texture_coordinates = context_allocate(context, 2 * f->vertices, sizeof(float))) == NULL)
        return HELIO_ERR_MEMORY;
    return HELIO_OK;
}

static helio_status flatten_scene(const mesh_file *file, flattener *f)
{
    helio_context *context = file->context;
    const char *path = file->path;
    if (f->scene->mRootNode == NULL)
        return fail(HELIO_ERR_DATA, "%s holds no triangles", path);
    if (flatten_tree(f) != HELIO_OK)
        return fail(HELIO_ERR_DATA, "%s cannot be used: %s", path, helio_last_error());
    if (f->triangles == 0)
        return fail(HELIO_ERR_DATA, "%s holds no triangles", path);
    HELIO_TRY(import_materials(file, f->uses));
    HELIO_TRY(allocate_arrays(context, f));
    f->fill = true;
    if (flatten_tree(f) != HELIO_OK)
        return fail(HELIO_ERR_DATA, "%s cannot be used: %s", path, helio_last_error());
    if (f->bad_coordinates)
        context_log(context, HELIO_LOG_WARNING, "%s: some texture coordinates are not finite or beyond %g; 0 is used",
                    path, (double)TEXTURE_MAX_COORDINATE);
    return HELIO_OK;
}

helio_status mesh_import(helio_context *context, const char *path, const mesh_import_options *options,
                         mesh_arrays *arrays)
{
    *arrays = (mesh_arrays){0};
    const struct aiScene *scene;
    HELIO_TRY(open_scene(context, path, &scene));
    flattener f = {.scene = scene, .arrays = arrays};
    f.uses = context_allocate(context, scene->mNumMaterials, sizeof *f.uses);
    const mesh_file file = {context, path, options, scene, arrays};
    helio_status status = f.uses ? flatten_scene(&file, &f) : HELIO_ERR_MEMORY;
    context_release(context, f.uses);
    aiReleaseImport(scene);
    if (status != HELIO_OK)
        mesh_arrays_release(context, arrays);
    return status;
}
