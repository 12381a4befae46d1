/* SPDX-License-Identifier: MIT
 * estimate.c - a sky with a sun, made in memory, lights a few surfaces; prints the radiance that leaves them.
 * Build: cc estimate.c $(pkg-config --cflags --libs heliostat), or with the CMakeLists.txt beside it. */
#include <heliostat/heliostat.h>
#include <stdio.h>

enum { WIDTH = 256, HEIGHT = 128 };
static float sky[HEIGHT][WIDTH][3];

/* Blue above, dark below, and one pixel of sun 30 degrees high towards +Z, the centre column of a lat-long map. */
static void paint_sky(void)
{
    for (int row = 0; row < HEIGHT; row++)
        for (int column = 0; column < WIDTH; column++)
            for (int channel = 0; channel < 3; channel++)
                sky[row][column][channel] = row < HEIGHT / 2 ? 0.3f + 0.2f * (float)channel : 0.1f;
    for (int channel = 0; channel < 3; channel++)
        sky[HEIGHT / 3][WIDTH / 2][channel] = 5000.0f;
}

/* Light that leaves a surface straight along its normal. */
static bool print_light(const helio_pools *pools, const char *material, float y, float z)
{
    helio_shading_point point = {.normal = {0, y, z}, .geometric_normal = {0, y, z}, .view = {0, y, z}};
    float rgb[3];
    if (helio_material_parse(material, &point.material) != HELIO_OK ||
        helio_estimate(pools, &point, NULL, rgb, NULL) != HELIO_OK)
        return false;
    printf("%s normal 0,%g,%g: %.3f %.3f %.3f\n", material, (double)y, (double)z, (double)rgb[0], (double)rgb[1],
           (double)rgb[2]);
    return true;
}

int main(void)
{
    helio_context *context = NULL;
    helio_environment *environment = NULL;
    helio_tables *tables = NULL;
    helio_pools *pools = NULL;
    helio_environment_desc desc = {.width = WIDTH, .height = HEIGHT};
    paint_sky();
    bool ok = helio_context_create(NULL, &context) == HELIO_OK &&
              helio_environment_create(context, &desc, &environment) == HELIO_OK &&
              helio_environment_update(environment, &sky[0][0][0], NULL) == HELIO_OK && /* each frame: this, */
              helio_tables_create(environment, HELIO_WEIGHTING_SOLID_ANGLE, &tables) == HELIO_OK &&
              helio_tables_update(tables) == HELIO_OK && /* this */
              helio_pools_create(tables, NULL, &pools) == HELIO_OK &&
              helio_pools_draw(pools, 0, 0) == HELIO_OK && /* and this */
              print_light(pools, "diffuse:0.8", 1, 0) && print_light(pools, "diffuse:0.8", 0, -1) &&
              print_light(pools, "phong:kd=0.5,ks=0.5,n=120", 0.5f, 0.866f) &&
              print_light(pools, "ggx:metallic=1,roughness=0.3", 0.5f, 0.866f);
    if (!ok)
        fprintf(stderr, "estimate: %s\n", helio_last_error());
    helio_pools_destroy(pools);
    helio_tables_destroy(tables);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
    return ok ? 0 : 1;
}
