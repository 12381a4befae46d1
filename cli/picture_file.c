/* SPDX-License-Identifier: MIT */
#include "picture_file.h"

#include "srgb.h"

static size_t pixels_of(const helio_image *image)
{
    return (size_t)image->width * image->height;
}

helio_status picture_file_read(helio_context *context, const char *path, uint64_t max_pixels, helio_image **image)
{
    const helio_image_read_desc desc = {.max_pixels = max_pixels};
    helio_status status = helio_image_read(context, path, &desc, image);
    bool is_straight = status == HELIO_OK && (*image)->is_encoded && (*image)->alpha != NULL;
    for (size_t i = 0; is_straight && i < 3 * pixels_of(*image); i++)
        (*image)->rgb[i] *= (*image)->alpha[i / 3];
    return status;
}

/* One number for each pixel, where three were. */
static void keep_first_channel(helio_image *image)
{
    for (size_t i = 0; i < pixels_of(image); i++)
        image->rgb[i] = image->rgb[3 * i];
}

static void keep_brightness(helio_image *image)
{
    for (size_t i = 0; i < pixels_of(image); i++) {
        const float *rgb = image->rgb + 3 * i;
        double light = 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
        image->rgb[i] = (float)(image->is_encoded ? srgb_encode(light) : light);
    }
}

static bool has_holes(const helio_image *image)
{
    for (size_t i = 0; image->alpha != NULL && i < pixels_of(image); i++)
        if (image->alpha[i] < 1)
            return true;
    return false;
}

void picture_file_read_object(helio_context *context, const char *path, uint64_t max_pixels, picture_mask *mask)
{
    const helio_image_read_desc desc = {.max_pixels = max_pixels, .without_alpha = true, .layer = "object"};
    *mask = (picture_mask){0};
    if (helio_image_read(context, path, &desc, &mask->image) != HELIO_OK)
        return;
    keep_first_channel(mask->image);
    mask->mask = mask->image->rgb;
}

helio_status picture_file_read_mask(helio_context *context, const char *path, uint64_t max_pixels, picture_mask *mask)
{
    const helio_image_read_desc desc = {.max_pixels = max_pixels};
    picture_file_read_object(context, path, max_pixels, mask);
    if (mask->mask != NULL)
        return HELIO_OK;
    helio_status status = helio_image_read(context, path, &desc, &mask->image);
    if (status != HELIO_OK)
        return status;
    bool is_alpha = has_holes(mask->image);
    if (!is_alpha)
        keep_brightness(mask->image);
    mask->mask = is_alpha ? mask->image->alpha : mask->image->rgb;
    return HELIO_OK;
}
