/* SPDX-License-Identifier: MIT */
#include "finished_frame.h"

#include "message.h"

#include <inttypes.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

/* A PNG's colours are straight. */
static void premultiply(helio_image *image)
{
    size_t pixels = (size_t)image->width * image->height;
    for (size_t i = 0; image->alpha != NULL && i < 3 * pixels; i++)
        image->rgb[i] *= image->alpha[i / 3];
}

static bool is_png(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot != NULL && strcasecmp(dot, ".png") == 0;
}

int finished_frame_read(helio_context *context, const char *name, uint32_t width, uint32_t height,
                        finished_frame *frame)
{
    *frame = (finished_frame){.is_shown = is_png(name)};
    helio_image **image = &frame->image;
    if (access(name, F_OK) != 0 || helio_image_read(context, name, NULL, image) != HELIO_OK)
        return EXIT_CODE_OK;
    if (frame->is_shown)
        premultiply(*image);
    uint32_t found_width = (*image)->width, found_height = (*image)->height;
    if (found_width == width && found_height == height)
        return EXIT_CODE_OK;
    helio_image_destroy(context, *image);
    *image = NULL;
    return message_failure("%s cannot be resumed: it is %" PRIu32 "x%" PRIu32 " pixels, not %" PRIu32 "x%" PRIu32
                           "; give the same --size as before, another --out, or no --resume",
                           name, found_width, found_height, width, height);
}
