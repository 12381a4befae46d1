/* SPDX-License-Identifier: MIT
 * material.h - the material of meshes that bring none. */
#ifndef HELIOSTAT_SRC_MATERIAL_H
#define HELIOSTAT_SRC_MATERIAL_H

#include <heliostat/scene.h>

/* phong:kd=0.5,ks=0.5,n=120, the material of the paper's dragon. */
helio_material material_default(void);

#endif
