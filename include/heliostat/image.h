/* SPDX-License-Identifier: MIT
 *
 * image.h - pictures in memory and in files: environment maps that come in, rendered pictures that go out.
 */
#ifndef HELIOSTAT_IMAGE_H
#define HELIOSTAT_IMAGE_H

#include <heliostat/core.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How the pixels of an environment map are laid over the sphere. docs/conventions.md has the axes. */
typedef enum helio_layout {
    HELIO_LAYOUT_AUTO = 0,      /* guess from the file's metadata and from its shape */
    HELIO_LAYOUT_LATLONG,       /* OpenEXR's axes: top row +Y, centre column +Z, a quarter from the left +X */
    HELIO_LAYOUT_STRIP,         /* six faces +X -X +Y -Y +Z -Z, 6x1 or 1x6, each as in the Vulkan/OpenGL tables */
    HELIO_LAYOUT_STRIP_OPENEXR, /* 1x6 (stacked), OpenEXR's face orientation, outer pixel centres on the face edges */
} helio_layout;

/* "latlong", "strip", "strip-openexr", "auto"; static, never NULL. */
HELIO_API const char *helio_layout_name(helio_layout layout);

/* Parses a name as above. HELIO_ERR_ARGUMENT for others, with the list of names in the error. */
HELIO_API helio_status helio_layout_parse(const char *name, helio_layout *layout);

/* What layout a picture of this shape has. hint: what metadata says, or AUTO. HELIO_ERR_DATA, with the choices, where
 * the shape does not tell: a lat-long map is twice as wide as high (within 1 %), a strip 6:1 or 1:6; 1x1 is constant.
 */
HELIO_API helio_status helio_layout_guess(uint32_t width, uint32_t height, helio_layout hint, helio_layout *layout);

/* Pixels that cannot be light. Each counts once, in the first class that fits. */
typedef struct helio_bad_pixels {
    uint64_t nan;      /* with a NaN channel */
    uint64_t infinite; /* with a channel that is infinite or beyond 1e30 in magnitude */
    uint64_t negative; /* with a negative channel */
} helio_bad_pixels;

/* A picture that was read. Own it through helio_image_destroy(). */
typedef struct helio_image {
    uint32_t width, height; /* pixels, each >= 1 */
    float *rgb;   /* [height][width][3], linear Rec. 709; may hold NaN, Inf and negative values as the file does */
    float *alpha; /* [height][width] in 0..1, or NULL where the file has none */
    helio_layout layout;  /* what the file's metadata says (OpenEXR's envmap attribute), else AUTO */
    helio_bad_pixels bad; /* as stored, before any colour conversion */
} helio_image;

typedef struct helio_image_read_desc {
    /* Larger pictures are refused before memory is taken: a guard against small files that claim to be huge. Default:
     * 2^26 (8192 x 8192), or one for each byte of the file where that is more, up to 2^28. */
    uint64_t max_pixels;

    bool without_alpha; /* takes no memory for alpha; default: as the file has it */
} helio_image_read_desc;

/* Reads OpenEXR (scan lines and tiles, all compressions that the library here reads), Radiance HDR, PFM, PNG and JPEG.
 * The kind is told by the first bytes, not by the name. PNG and JPEG are taken as sRGB. EXR chromaticities and
 * Radiance EXPOSURE, COLORCORR, PRIMARIES and orientation are honoured. desc may be NULL. */
HELIO_API helio_status helio_image_read(helio_context *context, const char *path, const helio_image_read_desc *desc,
                                        helio_image **image);
HELIO_API void helio_image_destroy(helio_context *context, helio_image *image);

/* ---- writing --------------------------------------------------------------------- */

typedef enum helio_tonemap {
    HELIO_TONEMAP_CLIP = 0, /* exposure, clip to 0..1, sRGB */
    HELIO_TONEMAP_REINHARD, /* exposure, L / (1 + L) on luminance, clip, sRGB */
} helio_tonemap;

HELIO_API const char *helio_tonemap_name(helio_tonemap tonemap);
HELIO_API helio_status helio_tonemap_parse(const char *name, helio_tonemap *tonemap);

/* A picture to be written. Layers that are NULL are left out. All arrays stay the caller's. */
typedef struct helio_picture {
    uint32_t width, height;
    const float *rgba;     /* [height][width][4], linear, premultiplied; required */
    const float *object;   /* [height][width], coverage of the object alone, 0..1 */
    const float *albedo;   /* [height][width][3] */
    const float *normal;   /* [height][width][3], world space; 0 where nothing was hit */
    const float *position; /* [height][width][3], world space, metres; 0 where nothing was hit */
    const float *depth; /* [height][width], distance from the eye along its axis, metres; +Inf where nothing was hit */
} helio_picture;

typedef struct helio_picture_write_desc {
    float exposure;        /* stops, applied in PNG only; default 0 */
    helio_tonemap tonemap; /* PNG only */
    bool alpha;            /* PNG: write RGBA, straight; default: RGB */
} helio_picture_write_desc;

/* Writes by the extension of path: .exr (float, ZIP; R G B A, object.A, albedo.R/G/B, normal.X/Y/Z, position.X/Y/Z,
 * depth.Z), .pfm (R G B) or .png (8 bit sRGB). The file is made under a temporary name in the same directory and then
 * renamed, so that path holds either the old or the whole new picture. desc may be NULL. */
HELIO_API helio_status helio_picture_write(helio_context *context, const char *path, const helio_picture *picture,
                                           const helio_picture_write_desc *desc);

/* HELIO_OK if helio_picture_write() knows the extension of path and this build can write it; else the reason. */
HELIO_API helio_status helio_picture_check_path(const char *path);

#ifdef __cplusplus
}
#endif
#endif
