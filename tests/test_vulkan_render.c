/* SPDX-License-Identifier: MIT
 *
 * Pictures by a device are those of the CPU: the same samples of the same pools, for every strategy and material. */
#include "vulkan_support.h"

#include "env/environment.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 60, HEIGHT = 44, SIZE = 64 };

/* A scene with two renderers of it. */
typedef struct stage {
    helio_context *context;
    helio_device *device;
    helio_environment *environment;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_renderer *cpu, *vulkan;
    helio_frame_desc frame;
} stage;

static stage make_stage(const char *material, const helio_renderer_desc *given)
{
    stage s = {.context = make_context(1, NULL)};
    helio_material parsed;
    s.device = open_test_device(s.context);
    assert_ok(helio_environment_create(s.context, &(helio_environment_desc){.cube_size = SIZE}, &s.environment));
    s.mesh = make_sphere(s.context);
    assert_ok(helio_material_parse(material, &parsed));
    const helio_scene_desc scene = {.mesh = s.mesh, .material = &parsed, .ground = HELIO_GROUND_PLANE};
    assert_ok(helio_scene_create(s.context, &scene, &s.scene));
    helio_renderer_desc desc = *given;
    desc.environment = s.environment;
    desc.scene = s.scene;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.no_visibility = true;
    assert_ok(helio_renderer_create(s.context, &desc, &s.cpu));
    desc.device = s.device;
    assert_ok(helio_renderer_create(s.context, &desc, &s.vulkan));
    assert_ok(helio_camera_parse("auto", s.mesh, (float)WIDTH / HEIGHT, &s.frame.camera));
    s.frame.seed = 3;
    return s;
}

static void destroy_stage(stage *s)
{
    helio_renderer_destroy(s->vulkan);
    helio_renderer_destroy(s->cpu);
    helio_scene_destroy(s->scene);
    helio_mesh_destroy(s->context, s->mesh);
    helio_environment_destroy(s->environment);
    close_test_device(s->device);
    helio_context_destroy(s->context);
}

/* A sky with all sizes of detail, black in places, and a sun of four texels. */
static void light_stage_with(stage *s, uint64_t seed)
{
    float *rgb = s->environment->cube;
    for (size_t i = 0; i < (size_t)6 * SIZE * SIZE * 3; i++) {
        const size_t row = i / (3 * SIZE), patch = row / 16 + i / 48;
        rgb[i] = patch % 7 == 0 ? 0.0f : 0.1f + (float)(patch % 5) * 0.2f + 0.3f * (float)random_unit(&seed);
    }
    for (size_t c = 0; c < 12; c++)
        rgb[((4 * SIZE + 9 + c / 6) * SIZE + 30) * 3 + c % 6] = 2000.0f;
    s->environment->frame++;
}

typedef struct difference {
    double mean;    /* of the pixels' relative differences */
    double worst;   /* largest of them */
    uint32_t off;   /* pixels that differ by more than the tolerance */
    uint32_t count; /* pixels */
} difference;

static difference compare_pictures(const stage *s, double tolerance)
{
    const helio_picture a = helio_renderer_picture(s->vulkan), b = helio_renderer_picture(s->cpu);
    difference d = {.count = WIDTH * HEIGHT};
    for (size_t i = 0; i < d.count; i++) {
        double off = 0, size = 0;
        for (size_t c = 0; c < 4; c++) {
            off = fmax(off, fabs((double)a.rgba[4 * i + c] - (double)b.rgba[4 * i + c]));
            size = fmax(size, fabs((double)b.rgba[4 * i + c]));
        }
        off = size > 0 ? off / size : off;
        d.mean += off / d.count;
        d.worst = fmax(d.worst, off);
        d.off += off > tolerance;
        assert_true(fabs((double)a.object[i] - (double)b.object[i]) <= 1e-6);
    }
    return d;
}

static void render_both(stage *s, helio_frame_info *cpu, helio_frame_info *vulkan)
{
    assert_ok(helio_renderer_render(s->cpu, &s->frame, cpu));
    assert_ok(helio_renderer_render(s->vulkan, &s->frame, vulkan));
}

/* Where all samples come from pools both take exactly the same ones, and differ by rounding: by 64 products of a few
 * factors, and for a lobe of exponent 120 by 120 times the rounding of a cosine. */
static const double ROUNDING = 2e-4;

/* A BRDF sample whose direction is rounded otherwise may meet the texel beside: in few pixels, where only that sample
 * differs. */
static const double PIXELS_BESIDE = 0.02;

static void compare_strategy(helio_strategy strategy, const char *material)
{
    const helio_renderer_desc desc = {.strategy = strategy};
    const bool draws = strstr(helio_strategy_name(strategy), "brdf") || strategy == HELIO_STRATEGY_COSINE;
    stage s = make_stage(material, &desc);
    helio_frame_info cpu, vulkan;
    light_stage_with(&s, 17);
    render_both(&s, &cpu, &vulkan);
    const difference d = compare_pictures(&s, ROUNDING);
    print_message("%s, %s: mean %.2e, worst %.2e, %u of %u pixels off; useful %llu and %llu of %llu\n",
                  helio_strategy_name(strategy), material, d.mean, d.worst, d.off, d.count,
                  (unsigned long long)vulkan.samples_useful, (unsigned long long)cpu.samples_useful,
                  (unsigned long long)cpu.samples);
    assert_int_equal(vulkan.samples, cpu.samples);
    assert_int_equal(vulkan.points, cpu.points);
    assert_true(fabs((double)vulkan.samples_useful - (double)cpu.samples_useful) <= 1e-3 * (double)cpu.samples);
    assert_true(d.off <= (draws ? PIXELS_BESIDE * d.count : 0));
    assert_true(d.mean <= 1e-4);
    destroy_stage(&s);
}

static const char *const MATERIALS[] = {"diffuse:0.8,0.5,0.2", "phong:kd=0.5,ks=0.5,n=120",
                                        "ggx:base=1,0.8,0.3,metallic=0.5,roughness=0.3"};

static void strategies_give_the_pictures_of_the_cpu(void **state)
{
    static const helio_strategy strategies[] = {
        HELIO_STRATEGY_COSINE, HELIO_STRATEGY_BRDF,      HELIO_STRATEGY_LIGHT,   HELIO_STRATEGY_LIGHT_BRDF,
        HELIO_STRATEGY_FACE,   HELIO_STRATEGY_FACE_BRDF, HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF};
    (void)state;
    for (size_t i = 0; i < sizeof strategies / sizeof *strategies; i++)
        for (size_t m = 0; m < 3; m++)
            compare_strategy(strategies[i], MATERIALS[m]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strategies_give_the_pictures_of_the_cpu),
    };
    return cmocka_run_group_tests_name("vulkan_render", tests, NULL, NULL);
}
