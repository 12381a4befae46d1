/* SPDX-License-Identifier: MIT
 * study_picture.h - the small PNG pictures of a study: a part of what was rendered, pixel for pixel, and of its errors.
 */
#ifndef HELIOSTAT_CLI_STUDY_PICTURE_H
#define HELIOSTAT_CLI_STUDY_PICTURE_H

#include <heliostat/heliostat.h>

/* The part of a picture that is shown. */
typedef struct study_window {
    uint32_t left, top, width, height;
} study_window;

/* The object with a narrow border, or, if that is larger than `largest`, the middle of it. size, largest: width,
 * height. mask: [height][width], the object's coverage. */
study_window study_window_find(const float *mask, const uint32_t size[2], const uint32_t largest[2]);

/* pixels: [height][width][channels] of the whole picture, linear. */
helio_status study_picture_write(helio_context *context, const char *path, const study_window *window,
                                 const float *pixels, uint32_t width, uint32_t channels, float exposure,
                                 helio_tonemap tonemap);

/* errors: [height][width] of the whole picture, NaN where nothing is compared. range: the error with the last colour.
 */
helio_status study_picture_write_errors(helio_context *context, const char *path, const study_window *window,
                                        const float *errors, uint32_t width, double range);

#endif
