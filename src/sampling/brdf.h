/* SPDX-License-Identifier: MIT
 * brdf.h - BRDFs with what depends on the point alone worked out once. */
#ifndef HELIOSTAT_SRC_BRDF_H
#define HELIOSTAT_SRC_BRDF_H

#include "core/vector.h"

#include <heliostat/sampling.h>

/* Least cosine between normal and view, see helio_shading_point. */
#define BRDF_LEAST_VIEW_COSINE 1e-3f

typedef struct brdf {
    helio_material_kind kind;
    vec3 normal, tangent, bitangent, view;
    float view_cosine;    /* normal . view */
    vec3 mirror;          /* PHONG: of the view direction */
    float diffuse[3];     /* albedo of the diffuse lobe */
    float specular[3];    /* PHONG: ks. GGX: reflectance at normal incidence */
    float specular_share; /* probability of the specular lobe when sampling */
    float exponent;       /* PHONG */
    float alpha2;         /* GGX: alpha^2 */
} brdf;

/* view must satisfy the rule for grazing views already. */
brdf brdf_prepare(const helio_material *material, vec3 normal, vec3 view);

/* value: [3], 1/sr. 0 below the normal's horizon. */
void brdf_value(const brdf *b, vec3 light, float value[3]);
float brdf_density(const brdf *b, vec3 light);

/* u: three numbers in [0, 1): lobe, and two for the direction. */
vec3 brdf_sample(const brdf *b, float lobe, float u, float v);

/* The rule for grazing views. */
vec3 brdf_lift_view(vec3 normal, vec3 view);

#endif
