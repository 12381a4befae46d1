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
    HELIO_LAYOUT_AUTO = 0, /* guess from the file's metadata and from its shape */
    HELIO_LAYOUT_LATLONG,  /* OpenEXR's axes: top row +Y, centre column +Z, a quarter from the left +X */
    HELIO_LAYOUT_CROSS_V,  /* 3x4 faces: +Y; -X +Z +X; -Y; -Z turned by half a turn. As in the Vulkan/OpenGL tables */
    HELIO_LAYOUT_CROSS_H,  /* 4x3 faces: +Y over the second of -X +Z +X -Z, -Y under it */
    HELIO_LAYOUT_FACES,    /* six files, one for each face; in memory they are a STRIP, one face wide and six high */
    HELIO_LAYOUT_STRIP,    /* six faces +X -X +Y -Y +Z -Z, 6x1 or 1x6, each as in the Vulkan/OpenGL tables */
    HELIO_LAYOUT_STRIP_OPENEXR, /* 1x6 (stacked), OpenEXR's face orientation, outer pixel centres on the face edges */
    HELIO_LAYOUT_OCTAHEDRAL,    /* square; centre +Y, right +X, down -Z; corners -Y */
    HELIO_LAYOUT_EQUAL_AREA,    /* the same axes, by Clarberg's equal-area map, which pbrt uses (about +Z) */
    HELIO_LAYOUT_ANGULAR,       /* Debevec's light probes: disc, centre -Z, angle in proportion to the radius, rim +Z */
    HELIO_LAYOUT_MIRRORBALL,    /* a mirror ball seen from far: disc, centre -Z, radius sin(angle / 2), rim +Z */
} helio_layout;

/* "latlong", "cross-v", "cross-h", "faces", "strip", "strip-openexr", "octahedral", "equal-area", "angular",
 * "mirrorball", "auto"; static, never NULL. */
HELIO_API const char *helio_layout_name(helio_layout layout);

/* Parses a name as above. HELIO_ERR_ARGUMENT for others, with the list of names in the error. */
HELIO_API helio_status helio_layout_parse(const char *name, helio_layout *layout);

/* The shape of a map of this layout that holds as much as a cube of 6 x size^2 texels: lat-long maps are 4 size wide,
 * squares and discs 2 sqrt(2) size, rounded up to even. FACES and STRIP: one face wide, six high. */
HELIO_API helio_status helio_layout_shape(helio_layout layout, uint32_t size, uint32_t *width, uint32_t *height);

/* What layout a picture of this shape has. hint: what metadata or somebody says, or AUTO. A lat-long map is twice as
 * wide as high (within 1 %, or of any shape if hint says so), a cross 3:4 or 4:3, a strip 6:1 or 1:6; 1x1 is constant.
 * HELIO_ERR_DATA, with the choices, where the shape does not tell, as that of squares, or does not fit the hint. */
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
    float *rgb;      /* [height][width][3], linear Rec. 709; may hold NaN, Inf and negative values as the file does */
    float *alpha;    /* [height][width] in 0..1, or NULL where the file has none */
    bool is_encoded; /* the file holds sRGB, as PNG and JPEG do, and not radiance: what a screen shows. Its colours are
                        straight where it has alpha; others are premultiplied */
    helio_layout layout;  /* what the file says (OpenEXR's envmap attribute, or a comment "layout: NAME"), else AUTO */
    helio_bad_pixels bad; /* as stored, before any colour conversion, which may make more of rgb negative: what is out
                             of Rec. 709's gamut. helio_environment_info.bad counts these, too */
} helio_image;

typedef struct helio_image_read_desc {
    /* Larger pictures are refused before memory is taken: a guard against small files that claim to be huge. Default:
     * 2^26 (8192 x 8192), or one for each byte of the file where that is more, up to 2^28. */
    uint64_t max_pixels;

    bool without_alpha; /* takes no memory for alpha; default: as the file has it */

    /* OpenEXR only: read this layer in place of the picture: "stderr" for stderr.R, stderr.G and stderr.B (and an
     * alpha), else X, Y and Z, or the one channel that a layer such as "object" or "depth" has, as grey.
     * HELIO_ERR_DATA, with a list of what is there, where it is missing. Default: the picture */
    const char *layer;

    /* FACES: a file that is named like a face of the cube, sky_px.exr say, stands for all six. Others change nothing.
     */
    helio_layout layout;
} helio_image_read_desc;

/* Reads OpenEXR (scan lines and tiles, all compressions that the library here reads), Radiance HDR, PFM, PNG and JPEG.
 * The kind is told by the first bytes, not by the name. PNG and JPEG are taken as sRGB. EXR chromaticities and
 * Radiance EXPOSURE, COLORCORR, PRIMARIES and orientation are honoured. desc may be NULL.
 *
 * Six square files of one size, without alpha, become a STRIP: those of a folder that end in the name of a face before
 * their extension (px.exr, sky_px.exr), or those that fit a path with one %s in the file's name for that name, where no
 * file has the path itself. Names, in any case: px nx py ny pz nz; posx negx posy...; pos_x neg_x...; positive_x
 * negative_x...; xp xn...; right left top (up) bottom (down) front back; rt lf up dn ft bk; +x -x...; x+ x-...; and 0
 * to 5, with %s or in a folder of six pictures that are all named so.
 *
 * Of an animated PNG the first picture, with a warning; helio_source_open() plays it. */
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

/* What a screen shows of linear radiance: exposed (stops), tone-mapped and clipped to 0..1, but still linear. NaN
 * becomes 0. The two may be the same array. */
HELIO_API void helio_tonemap_apply(helio_tonemap tonemap, float exposure, const float rgb[3], float shown[3]);

/* A picture to be written. Layers that are NULL are left out. All arrays stay the caller's. */
typedef struct helio_picture {
    uint32_t width, height;
    const float *rgba;     /* [height][width][4], linear, premultiplied; required where there is no shown, and for all
                              that holds radiance: EXR, PFM, HDR video */
    const float *object;   /* [height][width], coverage of the object alone, 0..1 */
    const float *albedo;   /* [height][width][3] */
    const float *normal;   /* [height][width][3], world space; 0 where nothing was hit */
    const float *position; /* [height][width][3], world space, metres; 0 where nothing was hit */
    const float *depth; /* [height][width], distance from the eye along its axis, metres; +Inf where nothing was hit */
    const float *standard_error; /* [height][width][3], of red, green and blue, see reference.h */
    const uint8_t *shown; /* [height][width][4], what a screen shows: 8-bit sRGB, exposed and tone-mapped already, see
                             helio_frame_desc. PNG and SDR video take it as it is, in place of rgba */
} helio_picture;

typedef struct helio_picture_write_desc {
    float exposure;        /* stops, applied in PNG only, to rgba; default 0 */
    helio_tonemap tonemap; /* likewise */
    bool alpha;            /* PNG: write RGBA, with straight alpha; default: RGB. The same as for shown */
} helio_picture_write_desc;

/* Writes by the extension of path: .exr (float, ZIP; R G B A, object.A, albedo.R/G/B, normal.X/Y/Z, position.X/Y/Z,
 * depth.Z, stderr.R/G/B), .pfm (R G B) or .png (8 bit sRGB). The file is made under a temporary name in the same
 * directory and then renamed, so that path holds either the old or the whole new picture. desc may be NULL. */
HELIO_API helio_status helio_picture_write(helio_context *context, const char *path, const helio_picture *picture,
                                           const helio_picture_write_desc *desc);

/* HELIO_OK if helio_picture_write() knows the extension of path and this build can write it; else the reason. */
HELIO_API helio_status helio_picture_check_path(const char *path);

/* ---- writing environment maps ---------------------------------------------------- */

typedef struct helio_map {
    uint32_t width, height;
    const float *rgb;    /* [height][width][3], linear Rec. 709; stays the caller's */
    helio_layout layout; /* not AUTO. FACES: rgb is a strip, one face wide and six high; six files are written */
} helio_map;

typedef struct helio_map_write_desc {
    bool half;             /* EXR in half floats, which hold up to 65504; default: float */
    float exposure;        /* stops, PNG only; default 0 */
    helio_tonemap tonemap; /* PNG only */
} helio_map_write_desc;

/* Writes by the extension of path: .exr (ZIP; with OpenEXR's envmap attribute for LATLONG and STRIP_OPENEXR, for others
 * with the comment "layout: NAME"), .hdr (Radiance, run-length coded, with the same comment; negative and NaN become
 * 0), .pfm or .png (8 bit sRGB: what is brighter than white is lost). Files are made under temporary names and then
 * renamed; those of the six faces when all of them are written.
 * FACES: %s in path stands for px, nx, py, ny, pz and nz; a path that is a folder, or ends in a slash and is made one,
 * gets px.exr and so on, or px.hdr in builds without OpenEXR.
 * HELIO_ERR_DATA if half floats cannot hold the map. desc may be NULL. */
HELIO_API helio_status helio_map_write(helio_context *context, const char *path, const helio_map *map,
                                       const helio_map_write_desc *desc);

/* HELIO_OK if helio_map_write() knows how to write maps of this layout to path in this build; else the reason. */
HELIO_API helio_status helio_map_check_path(const char *path, helio_layout layout);

#ifdef __cplusplus
}
#endif
#endif
