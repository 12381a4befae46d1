/* SPDX-License-Identifier: MIT
 *
 * Texts of materials, skies and cameras, the names of layouts, strategies and so on, and numbers: every parser gets
 * every input. */
#include "fuzz.h"

#include "env/sky_specification.h"
#include "number.h"

#include <heliostat/sampling.h>
#include <heliostat/scene.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void try_material(const char *text)
{
    helio_material material;
    if (helio_material_parse(text, &material) == HELIO_OK)
        FUZZ_EXPECT(helio_material_check(&material) == HELIO_OK);
    else
        fuzz_expect_sentence(false);
}

/* A sky that was understood can be made. */
static void try_sky(const char *text)
{
    sky_specification s;
    if (sky_specification_parse(text, &s) != HELIO_OK) {
        fuzz_expect_sentence(false);
        return;
    }
    FUZZ_EXPECT(fabs(s.desc.sun.azimuth) <= 360.0 && fabs(s.desc.sun.elevation) <= 90.0);
    FUZZ_EXPECT(s.desc.turbidity >= 1.0f && s.desc.turbidity <= 10.0f);
    FUZZ_EXPECT(s.desc.albedo >= 0.0f && s.desc.albedo <= 1.0f);
    double sunrise = 0, sunset = 1;
    if (s.is_day && helio_sun_day(&s.place, &sunrise, &sunset) != HELIO_OK)
        fuzz_expect_sentence(false);
    FUZZ_EXPECT(sunrise < sunset);
}

static const helio_mesh *tetrahedron(void)
{
    static helio_mesh *mesh;
    static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}};
    static const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const helio_mesh_desc desc = {
        .vertex_count = 4, .triangle_count = 4, .positions = positions[0], .triangles = triangles[0]};
    if (mesh == NULL)
        FUZZ_EXPECT(helio_mesh_create(fuzz_context(), &desc, &mesh) == HELIO_OK);
    return mesh;
}

static void try_camera(const char *text, float aspect)
{
    helio_camera camera;
    helio_status unframed = helio_camera_parse(text, NULL, aspect, NULL);
    helio_status framed = helio_camera_parse(text, tetrahedron(), aspect, &camera);
    FUZZ_EXPECT(framed == HELIO_OK || framed == HELIO_ERR_ARGUMENT);
    FUZZ_EXPECT(framed != HELIO_OK || unframed == HELIO_OK);
    if (framed != HELIO_OK) {
        fuzz_expect_sentence(false);
        return;
    }
    for (int i = 0; i < 3; i++)
        FUZZ_EXPECT(isfinite(camera.eye[i]) && isfinite(camera.at[i]) && isfinite(camera.up[i]));
    FUZZ_EXPECT(camera.fov >= 1.0f && camera.fov <= 170.0f);
}

/* A parser of names and the function that goes the other way. */
#define TRY_NAME(type, parse, name)                                                                                    \
    do {                                                                                                               \
        type value;                                                                                                    \
        if (parse(text, &value) == HELIO_OK)                                                                           \
            FUZZ_EXPECT(strcmp(name(value), text) == 0);                                                               \
        else                                                                                                           \
            fuzz_expect_sentence(false);                                                                               \
    } while (0)

static void try_names(const char *text)
{
    TRY_NAME(helio_layout, helio_layout_parse, helio_layout_name);
    TRY_NAME(helio_strategy, helio_strategy_parse, helio_strategy_name);
    TRY_NAME(helio_weighting, helio_weighting_parse, helio_weighting_name);
    TRY_NAME(helio_ground, helio_ground_parse, helio_ground_name);
    TRY_NAME(helio_tonemap, helio_tonemap_parse, helio_tonemap_name);
}

static void try_numbers(const char *text)
{
    uint32_t whole;
    double number;
    if (number_parse_whole(text, 1, 1 << 20, &whole))
        FUZZ_EXPECT(whole >= 1 && whole <= 1 << 20);
    if (number_parse(text, -100, 100, &number))
        FUZZ_EXPECT(number >= -100 && number <= 100);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const float aspects[] = {1.0f, 16.0f / 9.0f, 1.0f / 65536.0f, 65536.0f};
    char *text = fuzz_text(data, size);
    const helio_mesh *mesh = tetrahedron();
    size_t blocks = fuzz_live_blocks();
    FUZZ_EXPECT(mesh != NULL);
    try_material(text);
    try_sky(text);
    try_camera(text, aspects[size % 4]);
    try_names(text);
    try_numbers(text);
    FUZZ_EXPECT(fuzz_live_blocks() == blocks);
    free(text);
    return 0;
}
