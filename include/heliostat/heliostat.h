/* SPDX-License-Identifier: MIT
 *
 * heliostat.h - everything: light scenes with environment maps that change every frame.
 * Start with core.h for the rules that hold for all functions.
 */
#ifndef HELIOSTAT_HELIOSTAT_H
#define HELIOSTAT_HELIOSTAT_H

#include <heliostat/comparison.h>
#include <heliostat/core.h>
#include <heliostat/device.h>
#include <heliostat/environment.h>
#include <heliostat/image.h>
#include <heliostat/reference.h>
#include <heliostat/renderer.h>
#include <heliostat/sampling.h>
#include <heliostat/scene.h>
#include <heliostat/sky.h>
#include <heliostat/source.h>
#include <heliostat/video.h>

#endif
