/* SPDX-License-Identifier: MIT
 * texture.h - the colour of a texture at a point, and textures from the bytes of PNG and JPEG files. */
#ifndef HELIOSTAT_SRC_TEXTURE_H
#define HELIOSTAT_SRC_TEXTURE_H

#include <heliostat/scene.h>

enum { TEXTURE_MAX_EDGE = 16384 };

/* All texels of one mesh, at four bytes. */
#define TEXTURE_MAX_BYTES (UINT64_C(512) << 20)

/* Beyond this a float no longer tells the texels of a small texture apart. */
#define TEXTURE_MAX_COORDINATE 1e6f

/* What the bytes of texels stand for. */
typedef struct texture_curve {
    float value[256];
} texture_curve;

texture_curve texture_curve_srgb(void);
texture_curve texture_curve_linear(void);

/* Bilinear between the values that the curve gives; alpha is left out. */
void texture_lookup(const helio_texture *texture, const texture_curve *curve, float u, float v, float rgb[3]);

/* HELIO_ERR_DATA if the size or the wrap modes are out of range, or if there are no texels. */
helio_status texture_check(const helio_texture *texture);

static inline uint64_t texture_bytes(const helio_texture *texture)
{
    return UINT64_C(4) * texture->width * texture->height;
}

/* Decodes a PNG or JPEG file in memory. name: for sentences; max_bytes: of texels; way_out: how the sentence about more
 * ends, or NULL: to raise max_pixels. The texels are memory of the context; wrap modes are left alone. */
helio_status texture_decode(helio_context *context, const char *name, const unsigned char *bytes, size_t size,
                            uint64_t max_bytes, const char *way_out, helio_texture *texture);
void texture_release(helio_context *context, helio_texture *texture);

#endif
