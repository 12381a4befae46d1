/* SPDX-License-Identifier: MIT */
#include "finished_frame.h"

#include "message.h"
#include "picture_file.h"

#include <inttypes.h>
#include <unistd.h>

int finished_frame_read(helio_context *context, const char *name, uint32_t width, uint32_t height,
                        finished_frame *frame)
{
    *frame = (finished_frame){0};
    helio_image **image = &frame->image;
    if (access(name, F_OK) != 0 || picture_file_read(context, name, 0, image) != HELIO_OK)
        return EXIT_CODE_OK;
    frame->is_shown = (*image)->is_encoded;
    uint32_t found_width = (*image)->width, found_height = (*image)->height;
    if (found_width == width && found_height == height)
        return EXIT_CODE_OK;
    helio_image_destroy(context, *image);
    *image = NULL;
    return message_failure("%s cannot be resumed: it is %" PRIu32 "x%" PRIu32 " pixels, not %" PRIu32 "x%" PRIu32
                           "; give the same --size as before, another --out, or no --resume",
                           name, found_width, found_height, width, height);
}
