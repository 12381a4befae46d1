/* SPDX-License-Identifier: MIT
 *
 * environment.h - this frame's environment map as a cube: 6 faces of R x R texels of linear RGB.
 *
 * Faces come in the order +X -X +Y -Y +Z -Z, each oriented as in the Vulkan and OpenGL cube map tables. A direction d
 * with major axis ma has face coordinates u = sc / |ma|, v = tc / |ma| in [-1, 1]; column = floor((u + 1) / 2 R), row
 * likewise from v, both at most R - 1. Lighting takes a texel as constant over its area.
 *
 * Each update starts a new frame: helio_environment_frame() counts them, and tables and pools know which they belong
 * to.
 */
#ifndef HELIOSTAT_ENVIRONMENT_H
#define HELIOSTAT_ENVIRONMENT_H

#include <heliostat/core.h>
#include <heliostat/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct helio_environment helio_environment;

typedef struct helio_environment_desc {
    uint32_t cube_size;     /* R, texels along a face's edge, 1..4096; default 512 */
    uint32_t width, height; /* pixels of the maps to come, 1..65536 each, at most 2^28 in all; both 0: no map is
                               expected, the cube is black until helio_sky_update() or helio_environment_reshape() */
    helio_layout layout;    /* their layout; default: guessed from the shape, see helio_layout_guess() */
} helio_environment_desc;

/* How the numbers of a map lie in memory. Channels are interleaved; alpha is not looked at. */
typedef enum helio_pixel_format {
    HELIO_PIXELS_RGB_FLOAT = 0,
    HELIO_PIXELS_RGBA_FLOAT,
    HELIO_PIXELS_RGB_HALF, /* IEEE binary16 */
    HELIO_PIXELS_RGBA_HALF,
    HELIO_PIXELS_RGB9E5, /* a uint32_t for each pixel: from bit 0 on 9 bits each of red, green and blue, and 5 of an
                            exponent: a channel is bits x 2^(exponent - 24), at most 65408. As Vulkan's
                            E5B9G9R9_UFLOAT_PACK32 and OpenGL's RGB9_E5 */
} helio_pixel_format;

/* A map in the caller's memory, for instance a mapped buffer or a decoder's frame. */
typedef struct helio_pixels {
    const void *data; /* [height] rows of [width][channels]; aligned to its numbers */
    helio_pixel_format format;
    ptrdiff_t row_bytes; /* from one row to the next, negative for maps stored from below; default: without padding */
} helio_pixels;

/* What one update saw. A NaN or infinite channel makes its pixel 0, a negative channel becomes 0. Channels beyond 1e30
 * in magnitude count as infinite: no light is that bright, and sums of such numbers would not fit a float. */
typedef struct helio_environment_info {
    helio_bad_pixels bad;  /* of the map, as given to helio_environment_update(): negative ones include those that only
                              colour conversion made so, being out of gamut. Their number is bad.negative minus the
                              bad.negative of helio_image or helio_source_frame, which count pixels as stored */
    double flux[6];        /* integral of luminance over each face: radiance unit x sr */
    double mean_luminance; /* over the sphere: sum of flux / (4 pi) */
    float max_luminance;   /* of a texel of the cube */
    float auto_exposure;   /* stops that bring a white surface (albedo 1) facing the light of this frame to 0.8; 0 for a
                               black map. Depends on the map alone, not on rotation, intensity or scene. */
} helio_environment_info;

HELIO_API helio_status helio_environment_create(helio_context *context, const helio_environment_desc *desc,
                                                helio_environment **environment);
HELIO_API void helio_environment_destroy(helio_environment *environment);

/* Makes the cube of a new frame. rgb: [height][width][3] as promised at creation, copied; may hold any bits.
 * A cube texel is the average of the map over the texel's solid angle, so light is neither lost nor gained when the map
 * shrinks: a sun of one pixel keeps its flux. info may be NULL.
 * Without info the cube may be made elsewhere: where a renderer with a device lives, the first one of the environment,
 * it sends the map as it is and makes the cube there, and helio_frame_info tells what was found. A cube on the CPU is
 * then made when something wants to read it, within that call, which must be on a thread that could update the
 * environment. The first map of each shape, and of each format of numbers, takes memory of the device then. */
HELIO_API helio_status helio_environment_update(helio_environment *environment, const float *rgb,
                                                helio_environment_info *info);

/* The same from pixels of other formats and strides, read where they lie: no copy is made but the cube. Half numbers
 * and shared exponents give the same bits as the floats that they stand for. */
HELIO_API helio_status helio_environment_update_pixels(helio_environment *environment, const helio_pixels *pixels,
                                                       helio_environment_info *info);

/* From now on maps of another shape or layout come; the cube stays as it is until the next update. Takes memory, and
 * leaves the environment as it was if there is none. Does nothing where shape and layout stay. Use it alone, as an
 * update. */
HELIO_API helio_status helio_environment_reshape(helio_environment *environment, uint32_t width, uint32_t height,
                                                 helio_layout layout);

/* The way back: writes the cube, before orientation, as a map. Each pixel is the average of the texels over the pixel's
 * solid angle, so light is neither lost nor gained; pixels outside of a disc or of a cross are 0.
 * rgb: [height][width][3]; the shape must fit the layout (helio_layout_shape()). Takes memory for the time of the call.
 */
HELIO_API helio_status helio_environment_unfold(const helio_environment *environment, helio_layout layout,
                                                uint32_t width, uint32_t height, float *rgb);

/* How the map is turned and scaled when it is looked up; rebuilds nothing. */
typedef struct helio_orientation {
    float rotate;    /* degrees about +Y, from +Z towards +X; turns the map and its light */
    bool flip;       /* mirrors the map left to right (x becomes -x) before it is turned */
    float intensity; /* factor of all radiance, > 0, at most 1e6; default 1 */
} helio_orientation;

HELIO_API helio_status helio_environment_orient(helio_environment *environment, const helio_orientation *orientation);

/* A world-space direction in the map's space, that of the cube: turned back, and mirrored where the map is. */
HELIO_API void helio_environment_to_map(const helio_environment *environment, const float direction[3],
                                        float in_map[3]);

/* Radiance that arrives from a direction in world space: nearest texel, orientation applied. */
HELIO_API void helio_environment_radiance(const helio_environment *environment, const float direction[3],
                                          float radiance[3]);

/* The same, interpolated between texels, across the edges of faces too: for showing the map, not for lighting. */
HELIO_API void helio_environment_filtered(const helio_environment *environment, const float direction[3],
                                          float radiance[3]);

HELIO_API uint32_t helio_environment_cube_size(const helio_environment *environment);

/* Number of updates so far. */
HELIO_API uint64_t helio_environment_frame(const helio_environment *environment);

/* The cube: [6][R][R][3], before orientation. Valid until the next update. */
HELIO_API const float *helio_environment_cube(const helio_environment *environment);

#ifdef __cplusplus
}
#endif
#endif
