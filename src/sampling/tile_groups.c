/* SPDX-License-Identifier: MIT */
#include "sampling/tile_groups.h"

#include "sampling/tiles.h"

_Static_assert((int)TILES_MOST / (int)TILE_GROUP == (int)TILE_GROUPS, "each tile is in a group");

static vec3 centre_of(const tiles *t, uint32_t position)
{
    return (vec3){t->x[position], t->y[position], t->z[position]};
}

/* Around the sum of its tiles' centres. */
static void place_group(tiles *t, uint32_t group)
{
    tile_groups *groups = &t->groups;
    const uint32_t first = group * TILE_GROUP, end = first + TILE_GROUP < t->count ? first + TILE_GROUP : t->count;
    vec3 sum = {0, 0, 0};
    float least = 1.0f;
    for (uint32_t i = first; i < end; i++) {
        sum = add(sum, centre_of(t, i));
        groups->angle[group] += t->angle[i];
    }
    vec3 middle = dot(sum, sum) > 1e-6f ? normalize(sum) : (vec3){1, 0, 0}; /* opposite faces, where T is 1 */
    for (uint32_t i = first; i < end; i++)
        least = fminf(least, dot(middle, centre_of(t, i)));
    groups->x[group] = middle.x;
    groups->y[group] = middle.y;
    groups->z[group] = middle.z;
    groups->edge[group] = tiles_sine(acosf(least) + t->radius);
    groups->slope[group] = 0.25f / groups->edge[group];
    groups->inner[group] = tiles_sine(acosf(least) + 0.25f * t->radius);
}

void tile_groups_place(tiles *t)
{
    t->groups.count = (t->count + TILE_GROUP - 1) / TILE_GROUP;
    for (uint32_t group = 0; group < t->groups.count; group++)
        place_group(t, group);
}

/* In the order of the tiles, so that it has the same bits everywhere. */
static void sum_group(tiles *t, uint32_t group)
{
    tile_groups *groups = &t->groups;
    vec3 sum = {0, 0, 0};
    float light = 0.0f, spread = 0.0f, peak = 0.0f;
    for (uint32_t i = group * TILE_GROUP; i < (group + 1) * TILE_GROUP; i++) {
        light += t->light[i];
        spread += t->light[i] * t->spread[i];
        peak += t->light[i] * t->peak[i];
        sum = add_scaled(sum, centre_of(t, i), t->light[i]);
    }
    const float length = sqrtf(dot(sum, sum)), part = light > 0.0f ? fminf(length / light, 1.0f) : 1.0f;
    const bool has_mean = part > 1e-3f && length > 0.0f;
    groups->light[group] = light;
    groups->light_x[group] = has_mean ? sum.x / length : groups->x[group];
    groups->light_y[group] = has_mean ? sum.y / length : groups->y[group];
    groups->light_z[group] = has_mean ? sum.z / length : groups->z[group];
    groups->moment[group] = length;
    groups->variance[group] = 1.0f - part * part;
    groups->spread[group] = light > 0.0f ? spread / light : 0.0f;
    groups->peak[group] = light > 0.0f ? peak / light : 0.0f;
}

static void sum_colour(tiles *t, uint32_t group, int c)
{
    const float *hue = t->colours.hue[c];
    vec3 sum = {0, 0, 0};
    for (uint32_t i = group * TILE_GROUP; i < (group + 1) * TILE_GROUP; i++)
        sum = add_scaled(sum, centre_of(t, i), t->light[i] * hue[i]);
    t->groups.hue[c][0][group] = sum.x;
    t->groups.hue[c][1][group] = sum.y;
    t->groups.hue[c][2][group] = sum.z;
    for (int axis = 0; axis < 3; axis++) {
        float radiance = 0.0f;
        for (uint32_t i = group * TILE_GROUP; i < (group + 1) * TILE_GROUP; i++)
            radiance += t->colours.light[axis][c][i];
        t->groups.radiance[c][axis][group] = radiance;
    }
}

void tile_groups_update(tiles *t)
{
    for (uint32_t group = 0; group < t->groups.count; group++) {
        sum_group(t, group);
        for (int c = 0; c < 3; c++)
            sum_colour(t, group, c);
    }
}
