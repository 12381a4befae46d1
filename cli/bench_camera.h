/* SPDX-License-Identifier: MIT
 * bench_camera.h - the camera that sees a mesh as large as comparisons want it. */
#ifndef HELIOSTAT_CLI_BENCH_CAMERA_H
#define HELIOSTAT_CLI_BENCH_CAMERA_H

#include <heliostat/heliostat.h>

/* Finds the distance at which the mesh covers 40 % of the pixels, or as near to it as it comes. scene: of the mesh.
 * size: width and height of the picture. */
helio_status bench_camera_find(helio_context *context, const helio_scene *scene, const helio_mesh *mesh,
                               const uint32_t size[2], helio_camera *camera);

#endif
