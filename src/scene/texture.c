/* SPDX-License-Identifier: MIT */
#include "scene/texture.h"

#include "core/context.h"
#include "core/error.h"
#include "image/colour.h"
#include "image/image.h"

#include <math.h>

/* ---- lookup -------------------------------------------------------------------------- */

texture_curve texture_curve_srgb(void)
{
    texture_curve curve;
    for (int i = 0; i < 256; i++)
        curve.value[i] = srgb_decode((float)i / 255);
    return curve;
}

texture_curve texture_curve_linear(void)
{
    texture_curve curve;
    for (int i = 0; i < 256; i++)
        curve.value[i] = (float)i / 255;
    return curve;
}

/* The place in 0..1 that shows what is seen at x. */
static float fold(float x, helio_wrap wrap)
{
    if (wrap == HELIO_WRAP_CLAMP)
        return fminf(fmaxf(x, 0.0f), 1.0f);
    if (wrap == HELIO_WRAP_REPEAT)
        return x - floorf(x);
    float in_pair = x - 2.0f * floorf(0.5f * x);
    return in_pair > 1.0f ? 2.0f - in_pair : in_pair;
}

/* The two texels of a row or column around a place, and how much the second one weighs. */
typedef struct texel_pair {
    size_t first, second;
    float weight;
} texel_pair;

static texel_pair find_texels(float x, uint32_t count, helio_wrap wrap)
{
    float place = fold(x, wrap) * (float)count - 0.5f; /* -0.5 ... count - 0.5 */
    float below = floorf(place);
    int32_t first = (int32_t)below, last = (int32_t)count - 1;
    texel_pair pair = {.weight = place - below};
    bool repeats = wrap == HELIO_WRAP_REPEAT;
    pair.first = (size_t)(first >= 0 ? first : repeats ? last : 0);
    pair.second = (size_t)(first < last ? first + 1 : repeats ? 0 : last);
    return pair;
}

void texture_lookup(const helio_texture *texture, const texture_curve *curve, float u, float v, float rgb[3])
{
    texel_pair x = find_texels(u, texture->width, texture->wrap_u);
    texel_pair y = find_texels(v, texture->height, texture->wrap_v);
    const uint8_t *upper = texture->rgba + 4 * y.first * texture->width;
    const uint8_t *lower = texture->rgba + 4 * y.second * texture->width;
    for (size_t c = 0; c < 3; c++) {
        float top =
            (1.0f - x.weight) * curve->value[upper[4 * x.first + c]] + x.weight * curve->value[upper[4 * x.second + c]];
        float bottom =
            (1.0f - x.weight) * curve->value[lower[4 * x.first + c]] + x.weight * curve->value[lower[4 * x.second + c]];
        rgb[c] = (1.0f - y.weight) * top + y.weight * bottom;
    }
}

/* ---- life ---------------------------------------------------------------------------- */

helio_status texture_check(const helio_texture *texture)
{
    if (texture->width == 0 || texture->height == 0 || texture->width > TEXTURE_MAX_EDGE ||
        texture->height > TEXTURE_MAX_EDGE)
        return fail(HELIO_ERR_DATA, "a texture of %u x %u texels cannot be used; use 1 to %d each way", texture->width,
                    texture->height, TEXTURE_MAX_EDGE);
    if ((unsigned)texture->wrap_u > HELIO_WRAP_MIRROR || (unsigned)texture->wrap_v > HELIO_WRAP_MIRROR)
        return fail(HELIO_ERR_DATA, "there are no wrap modes %d and %d; use HELIO_WRAP_REPEAT, _CLAMP or _MIRROR",
                    (int)texture->wrap_u, (int)texture->wrap_v);
    if (texture->rgba == NULL)
        return fail(HELIO_ERR_DATA, "it has no texels");
    return HELIO_OK;
}

helio_status texture_decode(helio_context *context, const char *name, const unsigned char *bytes, size_t size,
                            uint64_t max_bytes, const char *way_out, helio_texture *texture)
{
    uint8_t *texels = NULL;
    const image_file file = {.context = context,
                             .path = name,
                             .bytes = bytes,
                             .size = size,
                             .max_pixels = max_bytes / 4,
                             .way_out = way_out,
                             .max_edge = TEXTURE_MAX_EDGE,
                             .texels = &texels};
    helio_image *image;
    helio_status status = image_decode(&file, &image);
    if (status != HELIO_OK) {
        context_release(context, texels);
        return status;
    }
    texture->width = image->width;
    texture->height = image->height;
    texture->rgba = texels;
    helio_image_destroy(context, image);
    return HELIO_OK;
}

void texture_release(helio_context *context, helio_texture *texture)
{
    context_release(context, (void *)texture->rgba);
    texture->rgba = NULL;
}
