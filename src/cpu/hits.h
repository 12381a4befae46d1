/* SPDX-License-Identifier: MIT
 * hits.h - what the camera rays of one camera sample met, kept for as long as the camera stays where it is. */
#ifndef HELIOSTAT_SRC_HITS_H
#define HELIOSTAT_SRC_HITS_H

#include "scene/camera.h"
#include "scene/scene.h"

typedef enum hit_kind {
    HIT_NOTHING = 0,
    HIT_OBJECT,
    HIT_PLANE,
    HIT_CATCHER,
} hit_kind;

typedef struct hit_surface {
    vec3 position, normal, geometric_normal;
} hit_surface;

/* Arrays [height][width]; misses take one byte of memory traffic. The direction of a ray follows from its pixel. */
struct hits {
    uint8_t *kinds;            /* of hit_kind */
    hit_surface *surfaces;     /* written where something was hit */
    helio_material *materials; /* of the object; NULL if it has the same everywhere */
    camera_frame camera;       /* that saw them ... */
    bool complete;             /* ... all */
};

helio_status hits_create(helio_context *context, const helio_scene *scene, uint32_t width, uint32_t height,
                         struct hits *hits);
void hits_destroy(helio_context *context, struct hits *hits);

/* Is this what the camera sees? */
bool hits_belong_to(const struct hits *hits, const camera_frame *camera);

#endif
