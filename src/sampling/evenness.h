/* SPDX-License-Identifier: MIT
 * evenness.h - does it pay to aim samples at the light of a map at all? */
#ifndef HELIOSTAT_SRC_EVENNESS_H
#define HELIOSTAT_SRC_EVENNESS_H

#include "sampling/tiles.h"

/* Is the light of each face so even that stratified samples of the surface, which never look at it, have the smaller
 * error? True for constant maps, gradients, overcast skies; false as soon as there is a lamp. Tiles and tables must be
 * those of the current frame. Looks at no texel where tiles differ enough from their neighbours. */
bool evenness_holds(const tiles *t, const helio_tables *tables);

#endif
