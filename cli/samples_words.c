/* SPDX-License-Identifier: MIT
 *
 * The words for what samples found, which text, JSON and figures share; and the text. */
#include "face.h"
#include "samples.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

const char *sample_fate_name(sample_fate fate)
{
    static const char *const names[SAMPLE_FATES] = {"used", "shadowed", "below", "dark"};
    return names[fate];
}

bool samples_is_by_face(const samples_findings *found)
{
    return found->pool_count == FACE_COUNT;
}

static bool is_by_bin(const samples_findings *found)
{
    return found->strategy == HELIO_STRATEGY_PRODUCT || found->strategy == HELIO_STRATEGY_PRODUCT_BRDF;
}

const char *samples_technique_name(const samples_findings *found, uint32_t technique)
{
    if (technique == SURFACE_TECHNIQUE)
        return found->strategy == HELIO_STRATEGY_COSINE ? "cosine" : "BRDF";
    if (samples_is_by_face(found))
        return face_names[technique];
    if (!is_by_bin(found))
        return "map";
    return !found->reads_tiles ? "bin" : found->reads_pools ? "bin/tiles" : "tiles";
}

uint32_t samples_useless(const technique_count *count)
{
    return count->fates[SAMPLE_BELOW] + count->fates[SAMPLE_DARK];
}

static int brightest_face(const samples_findings *found)
{
    int brightest = 0;
    for (int face = 1; face < FACE_COUNT; face++)
        if (found->flux[face] > found->flux[brightest])
            brightest = face;
    return brightest;
}

static double all_flux(const samples_findings *found)
{
    double flux = 0;
    for (int face = 0; face < FACE_COUNT; face++)
        flux += found->flux[face];
    return flux;
}

void samples_remark(const samples_findings *found, char *text, size_t size)
{
    int face = brightest_face(found);
    double share = all_flux(found) > 0 ? 100 * found->flux[face] / all_flux(found) : 0;
    uint32_t useless = samples_useless(&found->all);
    if (found->sample_count == 0)
        snprintf(text, size, "No light can reach the point from above its horizon, so no sample is taken");
    else if (samples_is_by_face(found) && !(found->techniques[face].expected > 0))
        snprintf(text, size,
                 "The face %s gives %.0f %% of all light, but all of it is below the point's horizon: no light sample "
                 "is spent on it",
                 face_names[face], share);
    else if (samples_is_by_face(found))
        snprintf(text, size, "The face %s gives %.0f %% of all light and gets %" PRIu32 " of the %" PRIu32 " samples",
                 face_names[face], share, found->techniques[face].realised, found->sample_count);
    else if (found->reads_tiles)
        snprintf(text, size,
                 "Light samples follow light, material and cosine as they are at this point%s: %" PRIu32 " of %" PRIu32
                 " samples are useless",
                 found->reads_pools ? ", or in some passes, where light is calm, no material" : "", useless,
                 found->sample_count);
    else if (is_by_bin(found))
        snprintf(text, size,
                 "Light samples follow light and cosine for normals like the point's: %" PRIu32 " of %" PRIu32
                 " samples are useless",
                 useless, found->sample_count);
    else if (found->pool_count == 1)
        snprintf(text, size,
                 "Light samples follow the light alone, wherever the surface faces: %" PRIu32 " of %" PRIu32
                 " samples are useless",
                 useless, found->sample_count);
    else
        snprintf(text, size,
                 "Samples follow the surface alone, wherever the light is: %" PRIu32 " of %" PRIu32
                 " samples are useless",
                 useless, found->sample_count);
}

/* ---- text --------------------------------------------------------------------------------- */

static void print_count(const samples_findings *found, const char *name, const technique_count *count, int face)
{
    double light = all_flux(found);
    printf("  %-8s", name);
    if (face >= 0)
        printf(" %7.2f", light > 0 ? 100 * found->flux[face] / light : 0.0);
    else
        printf(" %7s", "");
    printf(" %8.2f %6" PRIu32 " %6" PRIu32 " %9" PRIu32 " %8" PRIu32 "\n", count->expected, count->realised,
           count->fates[SAMPLE_USED], count->fates[SAMPLE_SHADOWED], samples_useless(count));
}

void samples_print(const samples_findings *found)
{
    const float *normal = found->pixel.point.normal;
    char remark[256];
    printf("%s%s%s, pixel %" PRIu32 ",%" PRIu32 ": normal %.3f %.3f %.3f, strategy %s, radiance %.6g %.6g %.6g\n",
           found->source, found->is_dynamic ? ", " : "", found->is_dynamic ? found->label : "", found->x, found->y,
           (double)normal[0], (double)normal[1], (double)normal[2], helio_strategy_name(found->strategy),
           found->radiance[0], found->radiance[1], found->radiance[2]);
    printf("  %-8s %7s %8s %6s %6s %9s %8s\n", "samples", "light %", "expected", "taken", "used", "in shadow",
           "useless");
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++) {
        bool has_pool = technique < found->pool_count, is_face = has_pool && samples_is_by_face(found);
        if (has_pool || found->techniques[technique].expected > 0)
            print_count(found, samples_technique_name(found, technique), &found->techniques[technique],
                        is_face ? (int)technique : -1);
    }
    print_count(found, "all", &found->all, -1);
    samples_remark(found, remark, sizeof remark);
    printf("%s.\n", remark);
}
