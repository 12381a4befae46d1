/* SPDX-License-Identifier: MIT */
#include "bench_light.h"

#include "bench.h"

#include <math.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

int bench_map_create(const helio_environment *source, const uint32_t size[2], float turn, bench_map *map)
{
    *map = (bench_map){.width = size[0], .height = size[1]};
    map->rgb = malloc((size_t)map->width * map->height * 3 * sizeof map->rgb[0]);
    if (map->rgb == NULL)
        return message_failure("no memory for a map of %u x %u pixels", map->width, map->height);
    float *rgb = map->rgb;
    for (uint32_t row = 0; row < map->height; row++) {
        double polar = PI * (row + 0.5) / map->height;
        for (uint32_t column = 0; column < map->width; column++, rgb += 3) {
            double azimuth = 2 * PI * (0.5 - (column + 0.5) / map->width) + (double)turn * PI / 180;
            const float direction[3] = {(float)(sin(polar) * sin(azimuth)), (float)cos(polar),
                                        (float)(sin(polar) * cos(azimuth))};
            helio_environment_radiance(source, direction, rgb);
        }
    }
    return EXIT_CODE_OK;
}

void bench_map_destroy(bench_map *map)
{
    free(map->rgb);
    *map = (bench_map){0};
}

static int fill_light(const helio_environment *source, const uint32_t map_size[2], bench_light *light)
{
    int code = bench_map_create(source, map_size, 0, &light->map);
    if (code != EXIT_CODE_OK)
        return code;
    const helio_context_desc context = {.threads = light->threads, .isa = light->isa};
    const helio_environment_desc desc = {.cube_size = light->env_size,
                                         .width = light->map.width,
                                         .height = light->map.height,
                                         .layout = HELIO_LAYOUT_LATLONG};
    helio_status status = helio_context_create(&context, &light->context);
    if (status == HELIO_OK)
        status = helio_environment_create(light->context, &desc, &light->environment);
    if (status == HELIO_OK)
        status = helio_environment_update(light->environment, light->map.rgb, NULL);
    if (status == HELIO_OK)
        status = helio_tables_create(light->environment, HELIO_WEIGHTING_SOLID_ANGLE, &light->tables);
    if (status == HELIO_OK)
        status = helio_tables_update(light->tables);
    return bench_check(status);
}

static bool is_like(const bench_light *light, const char *isa, uint32_t threads, const uint32_t map_size[2],
                    uint32_t env_size)
{
    return light->isa == isa && light->threads == threads && light->env_size == env_size &&
           light->map.width == map_size[0] && light->map.height == map_size[1];
}

int bench_light_find(bench_light_list *list, const helio_environment *source, const char *isa, uint32_t threads,
                     const uint32_t map_size[2], uint32_t env_size, bench_light **out)
{
    for (bench_light *light = list->first; light != NULL; light = light->next)
        if (is_like(light, isa, threads, map_size, env_size)) {
            *out = light;
            return EXIT_CODE_OK;
        }
    bench_light *light = calloc(1, sizeof *light);
    if (light == NULL)
        return message_failure("no memory for an environment");
    *light = (bench_light){.isa = isa, .threads = threads, .env_size = env_size, .next = list->first};
    list->first = light;
    *out = light;
    return fill_light(source, map_size, light);
}

void bench_light_list_release(bench_light_list *list)
{
    while (list->first != NULL) {
        bench_light *light = list->first;
        list->first = light->next;
        helio_tables_destroy(light->tables);
        helio_environment_destroy(light->environment);
        helio_context_destroy(light->context);
        bench_map_destroy(&light->map);
        free(light);
    }
}
