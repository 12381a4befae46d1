/* SPDX-License-Identifier: MIT
 *
 * scene.h - what is lit: meshes, materials, the ground, the camera.
 */
#ifndef HELIOSTAT_SCENE_H
#define HELIOSTAT_SCENE_H

#include <heliostat/core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* ---- materials -------------------------------------------------------------------- */

typedef enum helio_material_kind {
    HELIO_MATERIAL_DIFFUSE = 0, /* Lambert: diffuse / pi */
    HELIO_MATERIAL_PHONG,       /* energy-conserving Lafortune-Phong:
                                   diffuse / pi + specular (n + 2) / (2 pi) cos^n about the mirror direction */
    HELIO_MATERIAL_GGX,         /* glTF 2.0 metallic-roughness: GGX, separable Smith, Schlick's Fresnel,
                                   alpha = max(roughness^2, 1e-3). By glTF's formulas dielectrics seen at grazing
                                   angles reflect more than they receive, see docs/method.md. */
} helio_material_kind;

typedef struct helio_material {
    helio_material_kind kind;
    float diffuse[3];  /* DIFFUSE, PHONG: albedo kd; GGX: base colour. Each 0..1 */
    float specular[3]; /* PHONG: ks; diffuse + specular <= 1 in each channel */
    float exponent;    /* PHONG: n, 0..1e5 */
    float metallic;    /* GGX, 0..1 */
    float roughness;   /* GGX, 0..1 */
} helio_material;

/* Parses "diffuse:0.8", "diffuse:0.8,0.2,0.1", "phong:kd=0.5,ks=0.5,n=120",
 * "ggx:base=1,0.8,0.3,metallic=1,roughness=0.2". kd, ks and base take one number or three. Keys left out have the
 * values shown here. HELIO_ERR_ARGUMENT, with the key and its range, for anything else, kd + ks > 1 included. */
HELIO_API helio_status helio_material_parse(const char *specification, helio_material *material);

/* HELIO_ERR_ARGUMENT, with the field and its range, if a field is out of range. */
HELIO_API helio_status helio_material_check(const helio_material *material);

/* ---- textures ----------------------------------------------------------------------- */

/* What lies beyond 0..1. */
typedef enum helio_wrap {
    HELIO_WRAP_REPEAT = 0,
    HELIO_WRAP_CLAMP,
    HELIO_WRAP_MIRROR,
} helio_wrap;

/* A picture for a material. Looked up at a point (u, v) of the mesh: u = 0 is the left edge of the picture, v = 0 its
 * upper edge, as in glTF. Decoded to linear and then filtered bilinearly; there are no mipmaps, so use aa > 1. Alpha is
 * kept but never used: surfaces are opaque. There are no normal, occlusion or emission maps. */
typedef struct helio_texture {
    uint32_t width, height; /* texels, 1..16384 */
    helio_wrap wrap_u, wrap_v;
    const uint8_t *rgba; /* [height][width][4], top row first, encoded as in the file */
} helio_texture;

/* Which textures a material has: 1 is the first texture of the mesh, 0 is none. */
typedef struct helio_material_textures {
    uint32_t base_colour;        /* sRGB; multiplies helio_material.diffuse */
    uint32_t metallic_roughness; /* linear; G multiplies roughness and B metallic (GGX only) */
} helio_material_textures;

/* ---- mesh ------------------------------------------------------------------------- */

typedef struct helio_mesh {
    uint32_t vertex_count, triangle_count, material_count;
    float *positions;              /* [vertex_count][3], metres */
    float *normals;                /* [vertex_count][3], unit length */
    uint32_t *triangles;           /* [triangle_count][3], indices of vertices, counter-clockwise from outside */
    uint32_t *triangle_materials;  /* [triangle_count], indices of materials; NULL if material_count is 0 */
    helio_material *materials;     /* [material_count]; NULL where the file brings none */
    float bounds[2][3];            /* least and greatest corner, of the vertices that triangles use */
    bool has_file_normals;         /* false: the normals were computed, weighted by angle; slivers less */
    uint32_t degenerate_triangles; /* triangles without area: kept, never hit */
    float *texture_coordinates;    /* [vertex_count][2], u and v; NULL where there are none */
    uint32_t texture_count;
    helio_texture *textures;                    /* [texture_count]; NULL if texture_count is 0 */
    helio_material_textures *material_textures; /* [material_count]; NULL if texture_count is 0 */
} helio_mesh;

typedef struct helio_mesh_desc {
    uint32_t vertex_count, triangle_count; /* required, >= 1 */
    const float *positions;                /* [vertex_count][3], finite, up to 1e10 m; required */
    const float *normals;                  /* [vertex_count][3], or NULL: computed */
    const uint32_t *triangles;             /* [triangle_count][3], each < vertex_count; required */
    uint32_t material_count;
    const uint32_t *triangle_materials; /* [triangle_count], each < material_count */
    const helio_material *materials;    /* [material_count] */
    const float *texture_coordinates;   /* [vertex_count][2], finite, up to 1e6, or NULL; required with textures */
    uint32_t texture_count;
    const helio_texture *textures;                    /* [texture_count], 512 MiB of texels in all */
    const helio_material_textures *material_textures; /* [material_count]; required with textures */
} helio_mesh_desc;

/* Copies and checks arrays, texels included. HELIO_ERR_DATA, with the offending index, if they do not fit together. */
HELIO_API helio_status helio_mesh_create(helio_context *context, const helio_mesh_desc *desc, helio_mesh **mesh);

/* What reading a mesh may cost: guards against files that are damaged, or made to do harm. */
typedef struct helio_mesh_load_desc {
    uint64_t max_memory;  /* bytes that the importer may take; default: 1.5 GiB, and 16 for each byte of the file */
    uint32_t max_seconds; /* of processor time for the file itself; twice that with its textures, and 16 times by the
                             clock; default: 8, and one for each MiB of the file */
    uint64_t max_pixels;  /* of each texture; larger ones are left out; default: 2^26 */

    /* Runs the importer in the calling process, where it can crash it, and without the first two limits: for files that
     * you trust, where no other process can be made. */
    bool in_process;
} helio_mesh_load_desc;

/* Reads whatever assimp reads (PLY, OBJ, glTF/GLB, ...), also gzipped (.ply.gz). Node transforms are applied, polygons
 * become triangles, points and lines are dropped. desc may be NULL.
 *
 * Materials come with the base colour and metallic-roughness textures of glTF and with the diffuse ones (map_Kd) of
 * others, PNG or JPEG, from inside the file or from files named relative to its folder. As in other programs such a
 * name may lead out of the folder by "..". An absolute one is a place on somebody else's disk: only its last part is
 * looked for, beside the mesh. A texture that cannot be read is a warning in the log, and the material's own colour is
 * used. What else materials have, transmission, transparency, emission, normal maps and so on, is left out, and one
 * line of the log names it (docs/conventions.md).
 *
 * A PLY file that ends too early is HELIO_ERR_DATA, with the numbers of faces announced and present. Where more than a
 * tenth of the triangles of a file are without area, a warning is logged.
 *
 * assimp runs in a child process, made by fork() and gone when this function returns, so that a file that crashes it
 * or never ends becomes a failure. All that comes back is checked. docs/safety.md tells what a host should know. */
HELIO_API helio_status helio_mesh_load(helio_context *context, const char *path, const helio_mesh_load_desc *desc,
                                       helio_mesh **mesh);
HELIO_API void helio_mesh_destroy(helio_context *context, helio_mesh *mesh);

/* ---- scene: a mesh made ready for rays, and the ground ------------------------------ */

typedef enum helio_ground {
    HELIO_GROUND_NONE = 0,
    HELIO_GROUND_PLANE,  /* an endless matte plane (albedo 0.5) that touches the lowest point of the mesh */
    HELIO_GROUND_SHADOW, /* the same plane, but only its shadows are seen */
} helio_ground;

HELIO_API const char *helio_ground_name(helio_ground ground);
HELIO_API helio_status helio_ground_parse(const char *name, helio_ground *ground);

typedef struct helio_scene helio_scene;

typedef struct helio_scene_desc {
    const helio_mesh *mesh;         /* required; must outlive the scene */
    const helio_material *material; /* for every triangle; default: the mesh's own, and where it brings none
                                       phong:kd=0.5,ks=0.5,n=120 */
    helio_ground ground;
} helio_scene_desc;

/* Builds the acceleration structure. HELIO_ERR_UNSUPPORTED in a build without Embree. */
HELIO_API helio_status helio_scene_create(helio_context *context, const helio_scene_desc *desc, helio_scene **scene);
HELIO_API void helio_scene_destroy(helio_scene *scene);

/* ---- camera ------------------------------------------------------------------------- */

typedef struct helio_camera {
    float eye[3], at[3], up[3]; /* metres; up need not be orthogonal to the view */
    float fov;                  /* vertical field of view, degrees, 1..170 */
} helio_camera;

/* Parses "auto", "orbit:azimuth=30,elevation=15,distance=1.0,fov=40" (the defaults of orbit, and what auto means) or
 * "lookat:eye=X,Y,Z,at=X,Y,Z,fov=36" (eye is required, at is the mesh's centre by default) and frames the mesh: at
 * distance 1.0 the mesh just fits a picture of this aspect (width / height). Azimuth 0 looks from +Z, 90 from +X;
 * degrees. Without a mesh only the specification is checked and nothing is written. */
HELIO_API helio_status helio_camera_parse(const char *specification, const helio_mesh *mesh, float aspect,
                                          helio_camera *camera);

#ifdef __cplusplus
}
#endif
#endif
