/* SPDX-License-Identifier: MIT */
#include "compared_files.h"

#include "message.h"

#include <inttypes.h>

static int failure(void)
{
    return message_failure("%s", helio_last_error());
}

static bool has_same_size(const helio_image *image, const helio_image *other)
{
    return image->width == other->width && image->height == other->height;
}

static int check_sizes(const compared_frame *frame, const compared_files *files)
{
    const helio_image *picture = files->picture, *reference = files->reference, *mask = files->mask.image;
    if (!has_same_size(picture, reference))
        return message_failure("%s has %" PRIu32 "x%" PRIu32 " pixels, and %s has %" PRIu32 "x%" PRIu32
                               "; only pictures of one size can be compared",
                               frame->picture, picture->width, picture->height, frame->reference, reference->width,
                               reference->height);
    if (mask != NULL && !has_same_size(picture, mask))
        return message_failure("the mask %s has %" PRIu32 "x%" PRIu32 " pixels, and %s has %" PRIu32 "x%" PRIu32
                               "; give one of the same size",
                               frame->mask, mask->width, mask->height, frame->picture, picture->width, picture->height);
    return EXIT_CODE_OK;
}

/* The first of the two that has the object's coverage. */
static void find_mask(helio_context *context, uint64_t max_pixels, compared_frame *frame, picture_mask *mask)
{
    const char *const paths[] = {frame->picture, frame->reference};
    const mask_origin origins[] = {MASK_OF_PICTURE, MASK_OF_REFERENCE};
    frame->mask_origin = MASK_NONE;
    for (int i = 0; i < 2 && frame->mask == NULL; i++) {
        picture_file_read_object(context, paths[i], max_pixels, mask);
        if (mask->mask == NULL)
            continue;
        frame->mask = paths[i];
        frame->mask_origin = origins[i];
    }
}

int compared_files_read(helio_context *context, uint64_t max_pixels, compared_frame *frame, compared_files *files)
{
    *files = (compared_files){0};
    if (picture_file_read(context, frame->picture, max_pixels, &files->picture) != HELIO_OK ||
        picture_file_read(context, frame->reference, max_pixels, &files->reference) != HELIO_OK)
        return failure();
    if (frame->mask == NULL)
        find_mask(context, max_pixels, frame, &files->mask);
    else if (picture_file_read_mask(context, frame->mask, max_pixels, &files->mask) != HELIO_OK)
        return failure();
    return check_sizes(frame, files);
}

void compared_files_release(helio_context *context, compared_files *files)
{
    helio_image_destroy(context, files->picture);
    helio_image_destroy(context, files->reference);
    helio_image_destroy(context, files->mask.image);
}
