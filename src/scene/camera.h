/* SPDX-License-Identifier: MIT
 * camera.h - the direction in which a camera sees a point of the picture. */
#ifndef HELIOSTAT_SRC_CAMERA_H
#define HELIOSTAT_SRC_CAMERA_H

#include "core/vector.h"

#include <heliostat/scene.h>

typedef struct camera_frame {
    vec3 eye, forward, right, up; /* the last three orthonormal */
    float tan_half_fov;           /* of the vertical field of view */
    float aspect;                 /* width / height */
} camera_frame;

/* HELIO_ERR_ARGUMENT, with the field and its range, if the camera cannot see. */
helio_status camera_frame_create(const helio_camera *camera, float aspect, camera_frame *frame);

/* Unit direction through the point (x, y) of the picture, each 0..1, from the left and from the top. */
static inline vec3 camera_direction(const camera_frame *frame, float x, float y)
{
    float across = (2.0f * x - 1.0f) * frame->tan_half_fov * frame->aspect;
    float upward = (1.0f - 2.0f * y) * frame->tan_half_fov;
    return normalize(add_scaled(add_scaled(frame->forward, frame->right, across), frame->up, upward));
}

#endif
