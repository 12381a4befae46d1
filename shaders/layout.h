/* SPDX-License-Identifier: MIT
 * layout.h - what the host and the shaders must agree on: constants and structures in memory. Read by C and by GLSL.
 *
 * Shaders reach all memory by addresses, so that no binding limits its size: the host pushes the addresses of a state,
 * which stays the same, and of the numbers of a step. Members are in an order in which neither language pads. */
#ifndef HELIOSTAT_SHADERS_LAYOUT_H
#define HELIOSTAT_SHADERS_LAYOUT_H

#ifdef VULKAN
#define ADDRESS(type, name) type name
#define UINT uint
#define INT int
#define FLOAT float
#define STRUCT
#else
#include <stdint.h>
#define ADDRESS(type, name) uint64_t name
#define UINT uint32_t
#define INT int32_t
#define FLOAT float
#define STRUCT struct
#endif

#define LAYOUT_FACES 6
#define LAYOUT_VIEWS (4 * LAYOUT_FACES) /* of quarters of faces */
#define LAYOUT_TILES_PER_EDGE 16
#define LAYOUT_TILE_GROUP 16 /* tiles that follow each other */
#define LAYOUT_TILE_RUN 16   /* groups that follow each other */
#define LAYOUT_GROUP_ROWS 6  /* what is known of a group */
#define LAYOUT_REFINED_PARTS 256 /* POINT_REFINED_PARTS, see point_tiles.h */
#define LAYOUT_REFINED_TIMES 6
/* See lobe_variance.h. */
#define LAYOUT_LOBE_CLASSES 3

#define LAYOUT_TILES_MOST (LAYOUT_FACES * LAYOUT_TILES_PER_EDGE * LAYOUT_TILES_PER_EDGE)

/* layout_state.light and .surface: strategy_light and strategy_surface. */
#define LAYOUT_LIGHT_NONE 0
#define LAYOUT_LIGHT_WHOLE 1
#define LAYOUT_LIGHT_FACES 2
#define LAYOUT_LIGHT_BINS 3
#define LAYOUT_SURFACE_NONE 0
#define LAYOUT_SURFACE_COSINE 1
#define LAYOUT_SURFACE_BRDF 2

/* layout_state.weighting: helio_weighting. */
#define LAYOUT_BY_SOLID_ANGLE 0
#define LAYOUT_BY_PAPER 1
#define LAYOUT_COMPENSATED 2

/* Materials, as bits: a pipeline is built for those that a scene has. */
#define LAYOUT_DIFFUSE 0
#define LAYOUT_PHONG 1
#define LAYOUT_GGX 2

/* A pool holds two vectors for each sample, in planes one after the other: its direction with its density given the
 * pool, and radiance / density with the number of the tile, for pools of bins. */
#define LAYOUT_POOL_PLANES 2

/* The control variate, see control.h: rows of a matrix, which are vectors, and samples that are summed together. */
#define LAYOUT_CONTROL_ROWS 4
#define LAYOUT_CONTROL_CHUNK 4

/* Streams of random numbers of a point, see gathering.h. */
#define LAYOUT_STREAM_ROUNDING 1
#define LAYOUT_STREAM_SURFACE 2
#define LAYOUT_STREAM_WINDOW 3
#define LAYOUT_STREAM_BIN 4
#define LAYOUT_STREAM_LOBE 5

/* helio_wrap, and where the curve of a kind of texture begins among all. */
#define LAYOUT_WRAP_REPEAT 0
#define LAYOUT_WRAP_CLAMP 1
#define LAYOUT_WRAP_MIRROR 2
#define LAYOUT_CURVE_SRGB 0
#define LAYOUT_CURVE_LINEAR 256

/* What camera rays meet, see hits.h. */
#define LAYOUT_MATERIAL_OBJECT 0 /* of all points; those of single points or triangles come behind */
#define LAYOUT_MATERIAL_GROUND 1
#define LAYOUT_SHARED_MATERIALS 2
#define LAYOUT_HIT_OBJECT 1
#define LAYOUT_HIT_PLANE 2
#define LAYOUT_HIT_CATCHER 3

#define LAYOUT_NOTHING_SEEN 0xffffffffu /* in place of a triangle */

/* What becomes of light that something is in the way of, a constant of pipelines: nothing, as it passes; shadows; shadows
 * which are all that is seen of the ground. */
#define LAYOUT_SHADOWS_NONE 0
#define LAYOUT_SHADOWS_CAST 1
#define LAYOUT_SHADOWS_CAUGHT 2

/* How a picture is shown, as bits: see show.comp. */
#define LAYOUT_SHOW_REINHARD 1u
#define LAYOUT_SHOW_ALPHA 2u

/* sum x 2^-exponent, see row_sum in tables.h. */
struct layout_row_sum {
    UINT sum;
    INT exponent;
};

/* What is known of the map as a whole. */
struct layout_sums {
    STRUCT layout_row_sum flux[LAYOUT_FACES];    /* see tables_flux() */
    STRUCT layout_row_sum weights[LAYOUT_FACES]; /* of the faces */
    FLOAT worth[LAYOUT_FACES];                   /* as in tables.h */
    UINT faces[LAYOUT_FACES + 1];                /* prefix sums of the weights */
    UINT uneven_faces;                           /* where it pays to aim at light, see evenness.h */
};

struct layout_material {
    FLOAT diffuse[3];
    UINT kind;
    FLOAT specular[3];
    FLOAT exponent;
    FLOAT metallic;
    FLOAT roughness;
    UINT base_colour, metallic_roughness; /* see helio_material_textures; of materials of triangles */
};

/* Where the texels of a texture begin among all. */
struct layout_texture {
    UINT first, width, height;
    UINT wraps; /* helio_wrap of u, and << 2 of v */
};

/* What a camera ray met. */
struct layout_point {
    FLOAT normal[3];
    UINT pixel;
    FLOAT geometric_normal[3];
    UINT material; /* index */
    FLOAT view[3]; /* towards the eye */
    UINT hit;
};

/* Counted by shaders; 64 bits in two halves. */
struct layout_counts {
    UINT samples[2];
    UINT useful[2];
};

/* Pixels that were no light, see pixel_fault.h. */
struct layout_faults {
    UINT nan, infinite, negative;
    UINT padding;
};

/* How a quarter of a face sees the map, see resampler_plan.h. */
struct layout_view {
    INT row_offset, row_sign;
    INT column_offset, column_sign;
    UINT first_start; /* of its list */
};

/* A texel of the cube under which there are many pixels; among the starts it has this bit. */
#define LAYOUT_IS_LARGE 0x80000000u
struct layout_large {
    UINT texel, view, place; /* place: among the starts */
};

/* struct overlap_patch */
struct layout_patch {
    UINT weight, row, column, shape;
};

/* A sky, see sky_parts in sky_cube.h and sky_light in sky_model.h; behind it the texels in which the sun is seen. */
struct layout_sky {
    FLOAT sun[3];
    FLOAT horizon[3], horizon_exponent[3];
    FLOAT constant[3], glow[3], glow_exponent[3], rayleigh[3], mie[3], mie_near[3], mie_far[3], zenith[3];
    FLOAT even[3];
    FLOAT ground[3];
    UINT samples; /* along an edge of a texel */
    UINT sun_count;
    UINT padding;
};

struct layout_sun_texel {
    UINT texel;
    FLOAT rgb[3];
};

#ifdef VULKAN
layout(buffer_reference, std430, buffer_reference_align = 4) buffer floats
{
    float at[];
};
layout(buffer_reference, std430, buffer_reference_align = 4) buffer uints
{
    uint at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer texels
{
    vec3 at[];
};
layout(buffer_reference, std430, buffer_reference_align = 8) buffer row_sums
{
    layout_row_sum at[];
};
layout(buffer_reference, std430, buffer_reference_align = 8) buffer sums_of_map
{
    layout_sums all;
};
layout(buffer_reference, std430, buffer_reference_align = 16) buffer vectors
{
    vec4 at[];
};
layout(buffer_reference, std430, buffer_reference_align = 4) buffer counts_of_frame
{
    layout_counts all;
};
layout(buffer_reference, std430, buffer_reference_align = 4) buffer faults_of_map
{
    layout_faults all;
};
layout(buffer_reference, std430, buffer_reference_align = 4) buffer shapes_of_textures
{
    layout_texture at[];
};
layout(buffer_reference, std430, buffer_reference_align = 4) buffer large_texels
{
    layout_large at[];
};
layout(buffer_reference, std430, buffer_reference_align = 16) buffer patches_of_map
{
    layout_patch at[];
};
#endif

/* The textures of a mesh. */
struct layout_textures {
    ADDRESS(uints, texels);               /* as bytes red, green, blue, alpha */
    ADDRESS(floats, curves);              /* [2][256]: what the bytes stand for */
    ADDRESS(floats, coordinates);         /* [triangles][3][2] */
    ADDRESS(shapes_of_textures, shapes);
    UINT point_materials;                 /* where those of single points begin, behind those of the mesh */
    UINT padding;
};

#ifdef VULKAN
layout(buffer_reference, std430, buffer_reference_align = 8) buffer textures_of_mesh
{
    layout_textures all;
};
#endif

/* Memory, and sizes that stay the same. The shapes are those of the CPU: see tables.h, pools.h, tiles.h and
 * normal_bins.h. */
struct layout_state {
    ADDRESS(texels, cube);         /* [6][R][R][3] */
    ADDRESS(floats, solid_angles); /* [R][R] */
    ADDRESS(uints, rows);          /* [6][R][R + 1] */
    ADDRESS(uints, marginals);     /* [6][R + 1] */
    ADDRESS(floats, row_densities);
    ADDRESS(row_sums, weights);    /* [6][R] */
    ADDRESS(row_sums, fluxes);     /* the same array for LAYOUT_BY_SOLID_ANGLE */
    ADDRESS(sums_of_map, sums);
    ADDRESS(vectors, pools);       /* [LAYOUT_POOL_PLANES][pool_stride] */
    ADDRESS(uints, tile_grid);     /* [tiles]: (face x T + row) x T + column of the tile at a position */
    ADDRESS(uints, tile_positions); /* [6][T][T]: the way back */
    ADDRESS(vectors, tiles);       /* [tiles]: direction to the centre, light in proportion */
    ADDRESS(row_sums, tile_totals); /* [tiles] */
    ADDRESS(uints, tile_sums);     /* [tiles][tile_stride] */
    ADDRESS(floats, segment_densities); /* [6][R][T] */
    ADDRESS(floats, tile_spreads);      /* [tiles] */
    ADDRESS(floats, tile_angles);       /* [tiles]: sr */
    ADDRESS(vectors, bins);        /* [bins]: direction to the centre, reach */
    ADDRESS(uints, bin_sums);      /* [bins][tiles + 1] */
    ADDRESS(floats, bin_shares);   /* [bins] */
    ADDRESS(floats, lobe_variances); /* [bins][LAYOUT_LOBE_CLASSES] */
    ADDRESS(floats, greatest);     /* [tiles] */
    ADDRESS(uints, list_starts);   /* [tiles + 1] */
    ADDRESS(vectors, listed);      /* [list_capacity][2]: as in pools, given the tile */
    ADDRESS(floats, moments);      /* [6][T][T][3]: see moments.comp */
    ADDRESS(vectors, tile_light);   /* [tiles][LAYOUT_CONTROL_ROWS] */
    ADDRESS(vectors, tile_hues);    /* [tiles + 1]: hue and brightness; at the end brightness per light */
    ADDRESS(vectors, known);        /* [bins][LAYOUT_CONTROL_ROWS] */
    ADDRESS(vectors, control_sums); /* [bins][chunks + 1][LAYOUT_CONTROL_ROWS] */
    ADDRESS(vectors, groups);  /* [tiles / LAYOUT_TILE_GROUP][LAYOUT_GROUP_ROWS], see tile_groups.h: direction to the
                                  middle, edge; mean direction of the light, light; variance, spread, moment, inner;
                                  radiance x (x, y, z), with peak, angle, nothing */
    UINT size;                     /* R */
    UINT weighting;                /* helio_weighting */
    UINT light, surface;           /* parts of the strategy */
    UINT pool_count, techniques, pool_length, pool_stride;
    UINT tiles_per_edge, tile_count, tile_stride, bins_per_edge;
    UINT bin_count, list_capacity;
    FLOAT shake, tile_radius, tile_edge; /* of tiles: the greatest angle from the centre, and its sine rounded up */
    UINT is_automatic;      /* the strategy may be left where the light is even */
};

/* Numbers of a step of a frame. */
struct layout_step {
    ADDRESS(vectors, points);                /* [point_count][3]: struct layout_point */
    ADDRESS(vectors, materials);             /* [...][3]: struct layout_material */
    ADDRESS(vectors, picture);               /* [height][width]: red, green, blue, alpha */
    ADDRESS(floats, object);                 /* [height][width] */
    ADDRESS(vectors, caught);                /* [height][width][2]: see film.glsl; nothing without a shadow catcher */
    ADDRESS(uints, misses);                  /* [miss_count]: pixels that show the background */
    ADDRESS(counts_of_frame, counts);
    ADDRESS(vectors, origins);  /* [point_count]: where shadow rays start, see rays.glsl; nothing without them */
    ADDRESS(vectors, nodes);    /* [...][4]: struct bvh_node */
    ADDRESS(vectors, triangles); /* [...][3] */
    ADDRESS(vectors, normals);  /* [...][4]: of a triangle's plane and of its corners */
    ADDRESS(textures_of_mesh, textures); /* nothing where there are none */
    ADDRESS(vectors, surfaces); /* [height][width][3]: see primary.comp; nothing where layers are not wanted */
    ADDRESS(uints, seen);       /* [height][width]: see raster.h; nothing where camera rays are traced */
    ADDRESS(uints, counts_of_lists); /* [2]: points and misses */
    ADDRESS(uints, groups_of_lists); /* [3][3]: work groups for points, for points one by one, for misses */
    FLOAT map_axes[9];     /* see environment.h */
    FLOAT intensity;
    FLOAT background[9];   /* corner, across, down: see background.h */
    UINT pool_seed;        /* of the pass */
    UINT point_seed;       /* of the step */
    UINT same_seed;        /* all points have it */
    UINT samples;          /* of a point */
    FLOAT brdf_share;
    UINT no_beta;
    FLOAT camera[14]; /* eye, forward, right, up, tan_half_fov, aspect: see camera_frame in camera.h */
    FLOAT ground_height, extent; /* of the scene, see scene.h */
    FLOAT sphere[4];  /* around the mesh: centre, and the square of the distance from which it is too far away */
    UINT casts_rays;  /* shadow rays */
    UINT points_of_group; /* see shade.comp */
    UINT width, height;
    UINT camera_seed;      /* of the frame, for positions in the pixels ... */
    UINT camera_sample;    /* ... of this sample; UINT_MAX: the centre */
    UINT is_first, is_last;
    UINT shows_background;
    FLOAT weight;          /* of all samples when the step is over */
    UINT ground_hit;       /* LAYOUT_HIT_PLANE or _CATCHER; 0 where there is no ground */
    FLOAT control_part;    /* of the control variate that is added */
    UINT padding;
};

/* A map, and how it becomes a cube. Passes over a map push one instead of a step. */
struct layout_map {
    ADDRESS(uints, pixels);           /* rows without padding */
    ADDRESS(uints, starts);           /* see overlap_table.h */
    ADDRESS(patches_of_map, patches);
    ADDRESS(floats, weights);
    ADDRESS(large_texels, large);
    ADDRESS(faults_of_map, faults);
    UINT width, height;               /* pixels */
    UINT channels;                    /* of a pixel, 3 or 4 */
    UINT part_shift;                  /* columns of views are as many parts of a pixel, 1 << part_shift */
    UINT edge;                        /* texels along an edge of a quarter of a face */
    UINT padding;
    STRUCT layout_view views[LAYOUT_VIEWS]; /* [face][from below][from the right] */
};

/* What is pushed. */
struct layout_push {
    UINT state[2], step[2]; /* addresses */
    UINT parameter[4];      /* of a dispatch */
};

#ifndef VULKAN
_Static_assert(sizeof(struct layout_sums) == 152, "as in the shaders");
_Static_assert(sizeof(struct layout_material) == 48 && sizeof(struct layout_point) == 48, "as in the shaders");
_Static_assert(sizeof(struct layout_state) == 30 * 8 + 18 * 4, "as in the shaders");
_Static_assert(sizeof(struct layout_step) == 16 * 8 + 58 * 4, "as in the shaders");
_Static_assert(sizeof(struct layout_map) == 6 * 8 + 6 * 4 + LAYOUT_VIEWS * 20, "as in the shaders");
_Static_assert(sizeof(struct layout_sky) == 42 * 4 && sizeof(struct layout_sun_texel) == 16, "as in the shaders");
_Static_assert(sizeof(struct layout_push) == 32, "as in the shaders");
#endif
#endif
