/* SPDX-License-Identifier: MIT
 * png_animation.h - PNG files that hold more than one picture. */
#ifndef HELIOSTAT_SRC_IMAGE_PNG_ANIMATION_H
#define HELIOSTAT_SRC_IMAGE_PNG_ANIMATION_H

#include <stddef.h>
#include <stdint.h>

/* Reads up to size bytes from this place of a file. Returns how many there were. */
typedef size_t (*png_animation_read)(const void *file, uint64_t at, unsigned char *bytes, size_t size);

/* The number of pictures of an animation: what a chunk acTL before the first data says. 0 where there is none. */
uint32_t png_animation_frames(png_animation_read read, const void *file);

#endif
