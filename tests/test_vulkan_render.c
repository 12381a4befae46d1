/* SPDX-License-Identifier: MIT
 *
 * Pictures by a device are those of the CPU: the same samples of the same pools, for every strategy and material. */
#include "vulkan_support.h"

#include "cpu/renderer.h"
#include "env/environment.h"
#include "image/tonemap.h"
#include "vulkan/frame.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

/* Whether devices are taken for hardware, so that several threads share a point; whether shadow rays are traced. */
static bool plays_hardware, casts_shadows;

/* Whether the device traces camera rays. The CPU's points are the same to the bit, so that their light can be compared
 * more closely. */
static bool traces;

static uint32_t cube_size = SIZE;

/* Of the scenes. Alpha tells of shadows by itself where the ground is a shadow catcher, and is a part of 1. */
static helio_ground ground = HELIO_GROUND_PLANE;

/* The sphere with two materials that textures of odd sizes and of all wrap modes are of. */
static helio_mesh *make_textured_sphere(helio_context *context)
{
    enum { TEXELS = 35, LAST = 2 };
    static uint8_t texels[LAST + 1][TEXELS][4];
    static float coordinates[1024][2];
    static uint32_t numbers[1024];
    helio_mesh *sphere = make_unit_sphere(context), *mesh;
    helio_material materials[2];
    uint64_t seed = 5;
    for (size_t i = 0; i < (LAST + 1) * TEXELS; i++)
        for (size_t c = 0; c < 4; c++)
            texels[i / TEXELS][i % TEXELS][c] = (uint8_t)random_bits(&seed);
    assert_true(sphere->vertex_count <= 1024 && sphere->triangle_count <= 1024);
    for (size_t i = 0; i < sphere->vertex_count; i++)
        for (size_t axis = 0; axis < 2; axis++)
            coordinates[i][axis] = 1.7f * sphere->positions[3 * i + axis] + 0.3f * sphere->positions[3 * i + 2];
    for (uint32_t i = 0; i < sphere->triangle_count; i++)
        numbers[i] = i / 40 % 2;
    assert_ok(helio_material_parse("ggx:base=0.9,0.8,0.7,metallic=0.9,roughness=0.8", &materials[0]));
    assert_ok(helio_material_parse("phong:kd=0.6,ks=0.2,n=20", &materials[1]));
    const helio_texture textures[LAST + 1] = {{7, 5, HELIO_WRAP_REPEAT, HELIO_WRAP_MIRROR, texels[0][0]},
                                              {5, 7, HELIO_WRAP_MIRROR, HELIO_WRAP_CLAMP, texels[1][0]},
                                              {1, 35, HELIO_WRAP_CLAMP, HELIO_WRAP_REPEAT, texels[2][0]}};
    const helio_material_textures of_materials[2] = {{.base_colour = 1, .metallic_roughness = 2}, {.base_colour = 3}};
    const helio_mesh_desc desc = {.vertex_count = sphere->vertex_count,
                                  .triangle_count = sphere->triangle_count,
                                  .positions = sphere->positions,
                                  .triangles = sphere->triangles,
                                  .material_count = 2,
                                  .triangle_materials = numbers,
                                  .materials = materials,
                                  .texture_coordinates = coordinates[0],
                                  .texture_count = LAST + 1,
                                  .textures = textures,
                                  .material_textures = of_materials};
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    helio_mesh_destroy(context, sphere);
    return mesh;
}

/* material: NULL for those of a mesh with textures. */
static stage make_stage(const char *material, const helio_renderer_desc *given)
{
    stage s = {.context = make_context(1, NULL)};
    helio_material parsed;
    s.device = open_test_device(s.context);
    if (plays_hardware)
        s.device->info.kind = HELIO_DEVICE_DISCRETE;
    assert_ok(helio_environment_create(s.context, &(helio_environment_desc){.cube_size = cube_size}, &s.environment));
    s.mesh = material != NULL ? make_unit_sphere(s.context) : make_textured_sphere(s.context);
    if (material != NULL)
        assert_ok(helio_material_parse(material, &parsed));
    const helio_scene_desc scene = {.mesh = s.mesh, .material = material != NULL ? &parsed : NULL, .ground = ground};
    assert_ok(helio_scene_create(s.context, &scene, &s.scene));
    helio_renderer_desc desc = *given;
    desc.environment = s.environment;
    desc.scene = s.scene;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.no_visibility = !casts_shadows;
    assert_ok(helio_renderer_create(s.context, &desc, &s.cpu));
    desc.device = s.device;
    assert_ok(renderer_create(s.context, &desc, &(renderer_extras){.cpu_rays = !traces}, &s.vulkan));
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

/* A sky with all sizes of detail, black in places, and a sun of four texels, or one. */
static void light_stage_with(stage *s, uint64_t seed)
{
    float *rgb = s->environment->cube;
    const size_t size = cube_size, sun_row = size > 10 ? 9 : 0, sun_column = size / 2 > 30 ? 30 : size / 3;
    for (size_t i = 0; i < 6 * size * size * 3; i++) {
        const size_t row = i / (3 * size), patch = row / 16 + i / 48;
        rgb[i] = patch % 7 == 0 ? 0.0f : 0.1f + (float)(patch % 5) * 0.2f + 0.3f * (float)random_unit(&seed);
    }
    for (size_t c = 0; c < (size > 1 ? 12 : 3); c++)
        rgb[((4 * size + sun_row + c / 6) * size + sun_column) * 3 + c % 6] = 2000.0f;
    s->environment->frame++;
}

/* Even but for noise, and a lamp on three faces. */
static void light_stage_softly(stage *s)
{
    float *rgb = s->environment->cube;
    uint64_t seed = 8;
    for (size_t i = 0; i < 6 * (size_t)SIZE * SIZE * 3; i++)
        rgb[i] = 0.7f + 0.3f * (float)random_unit(&seed);
    for (size_t row = 28; row < 3 * SIZE; row += row % 4 == 3 ? SIZE - 3 : 1)
        for (size_t i = 0; i < 12; i++)
            rgb[(row * SIZE + 20) * 3 + i] = 300.0f;
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
    difference d = {.count = a.width * a.height};
    for (size_t i = 0; i < d.count; i++) {
        double off = 0, size = ground == HELIO_GROUND_SHADOW ? 1 : 0;
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

/* A BRDF sample whose direction is rounded otherwise may meet the texel beside, and a point that weighs tiles may take
 * another of a tile's samples where its weights are rounded otherwise: in few pixels, where only that sample differs.
 */
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

/* One material for each strategy, unless there is time for all. */
static void strategies_give_the_pictures_of_the_cpu(void **state)
{
    static const helio_strategy strategies[] = {
        HELIO_STRATEGY_COSINE, HELIO_STRATEGY_BRDF,      HELIO_STRATEGY_LIGHT,   HELIO_STRATEGY_LIGHT_BRDF,
        HELIO_STRATEGY_FACE,   HELIO_STRATEGY_FACE_BRDF, HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF};
    (void)state;
    for (size_t i = 0; i < sizeof strategies / sizeof *strategies; i++)
        for (size_t m = 0; m < 3; m++)
            if (m == (i + 1 + i / 3) % 3 || is_thorough())
                compare_strategy(strategies[i], MATERIALS[m]);
}

/* Of points that look everywhere, those that weigh tiles. */
static uint32_t count_weighing(const stage *s, const char *material, uint32_t points)
{
    uint64_t seed = 5;
    uint32_t weighing = 0;
    const helio_estimate_desc desc = {.is_free = !casts_shadows};
    helio_shading_point point = {0};
    assert_ok(helio_material_parse(material, &point.material));
    for (point.seed = 0; point.seed < points; point.seed++) {
        vec3 normal = {0, 0, 0};
        helio_counts counts;
        while (!(dot(normal, normal) > 0.01f))
            normal = (vec3){(float)random_unit(&seed) - 0.5f, (float)random_unit(&seed) - 0.5f,
                            (float)random_unit(&seed) - 0.5f};
        vec3_to(normalize(normal), point.normal);
        vec3_to(normalize(normal), point.view);
        assert_ok(helio_count(helio_renderer_pools(s->cpu), &point, &desc, &counts));
        weighing += counts.pool[0] == HELIO_POOL_OF_TILES;
    }
    return weighing;
}

/* Calm points and others, of each class of lobes. With nothing but a sharp lobe a sample that meets the texel beside
 * shows more often. */
static void calm_lobes_are_lit_alike(void **state)
{
    static const char *const materials[] = {"ggx:base=1,0.8,0.3,metallic=1,roughness=0.15",
                                            "ggx:base=1,0.8,0.3,metallic=1,roughness=0.3",
                                            "ggx:base=1,0.8,0.3,metallic=1,roughness=0.4", "phong:kd=0,ks=0.9,n=120"};
    enum { POINTS = 500 };
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT_BRDF};
    (void)state;
    for (size_t i = 0; i < sizeof materials / sizeof *materials; i++) {
        plays_hardware = i % 2 == 1;
        casts_shadows = i == 2;
        stage s = make_stage(materials[i], &desc);
        helio_frame_info cpu, vulkan;
        light_stage_softly(&s);
        render_both(&s, &cpu, &vulkan);
        const difference d = compare_pictures(&s, ROUNDING);
        const uint32_t weighing = count_weighing(&s, materials[i], POINTS);
        print_message("%s: mean %.2e, worst %.2e, %u of %u pixels off; %u of %u points weigh tiles\n", materials[i],
                      d.mean, d.worst, d.off, d.count, weighing, POINTS);
        assert_true(weighing > POINTS / 10 && weighing < POINTS - POINTS / 10);
        assert_int_equal(vulkan.samples, cpu.samples);
        assert_true(d.off <= 2 * PIXELS_BESIDE * d.count && d.mean <= 1e-4);
        destroy_stage(&s);
    }
    plays_hardware = casts_shadows = false;
}

/* Tiles of a texel and less, groups with tiles that are missing or on opposite faces. */
static void small_cubes_light_points_that_weigh_tiles(void **state)
{
    static const uint32_t sizes[] = {1, 3, 13};
    static const char *const metal = "ggx:base=1,0.8,0.3,metallic=1,roughness=0.2";
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        cube_size = sizes[i];
        print_message("%u texels along an edge: ", cube_size);
        compare_strategy(HELIO_STRATEGY_PRODUCT_BRDF, i % 2 == 0 ? metal : MATERIALS[1]);
    }
    cube_size = SIZE;
}

static void threads_that_share_a_point_light_it_alike(void **state)
{
    (void)state;
    plays_hardware = true;
    compare_strategy(HELIO_STRATEGY_FACE_BRDF, MATERIALS[1]);
    compare_strategy(HELIO_STRATEGY_PRODUCT_BRDF, MATERIALS[2]);
    plays_hardware = false;
}

/* Rays that graze an edge may meet it in one tree and not in the other: few pixels. */
static void shadows_fall_where_the_cpu_has_them(void **state)
{
    (void)state;
    casts_shadows = true;
    compare_strategy(HELIO_STRATEGY_FACE_BRDF, MATERIALS[1]);
    compare_strategy(HELIO_STRATEGY_PRODUCT_BRDF, MATERIALS[2]);
    casts_shadows = false;
}

/* Points of the device's own rays are the CPU's but for rounding, by which some count, bin or texel comes out
 * otherwise: one sample of some pixels is another. At the edge of the object a pixel may see the other side. */
static void rays_of_the_device_see_the_same(void **state)
{
    static const helio_renderer_desc descs[] = {
        {.strategy = HELIO_STRATEGY_FACE_BRDF, .aa = 3, .spp = 8},
        {.spp = 64},
    };
    (void)state;
    traces = casts_shadows = true;
    for (size_t i = 0; i < 2; i++) {
        stage s = make_stage(MATERIALS[1 + i], &descs[i]);
        helio_frame_info cpu, vulkan;
        light_stage_with(&s, 17);
        render_both(&s, &cpu, &vulkan);
        const difference d = compare_pictures(&s, ROUNDING);
        print_message("mean %.2e, worst %.2e, %u of %u pixels off\n", d.mean, d.worst, d.off, d.count);
        assert_int_equal(vulkan.camera_rays, cpu.camera_rays);
        assert_true(abs((int)vulkan.points - (int)cpu.points) <= 4);
        assert_true(d.off <= d.count / 10 && d.mean < 1e-3);
        destroy_stage(&s);
    }
    traces = casts_shadows = false;
}

/* Pixels whose layers are not those of the CPU: rays that graze the sphere magnify rounding (found: 7e-5), and at an
 * edge a camera sample may see what is behind it. */
static uint32_t count_layers_off(const stage *s)
{
    const helio_picture a = helio_renderer_picture(s->vulkan), b = helio_renderer_picture(s->cpu);
    uint32_t off = 0;
    for (size_t i = 0; i < (size_t)a.width * a.height; i++) {
        double worst = isinf(b.depth[i]) ? (a.depth[i] == b.depth[i] ? 0.0 : 1.0)
                                         : fabs((double)a.depth[i] - (double)b.depth[i]) / (double)b.depth[i];
        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            worst = fmax(worst, fabs((double)a.albedo[c] - (double)b.albedo[c]));
            worst = fmax(worst, fabs((double)a.normal[c] - (double)b.normal[c]));
            worst = fmax(worst, fabs((double)a.position[c] - (double)b.position[c]) / fmax(1, (double)b.depth[i]));
        }
        off += worst > 2e-4;
    }
    return off;
}

/* Colours of points are those of the textures there, in the picture and in its layers. */
static void textures_and_layers_are_those_of_the_cpu(void **state)
{
    static const helio_renderer_desc descs[] = {
        {.strategy = HELIO_STRATEGY_FACE, .aa = 3, .spp = 8, .aovs = true},
        {.strategy = HELIO_STRATEGY_LIGHT_BRDF, .spp = 16, .aovs = true},
    };
    (void)state;
    traces = true;
    for (size_t i = 0; i < 2; i++) {
        stage s = make_stage(NULL, &descs[i]);
        helio_frame_info cpu, vulkan;
        light_stage_with(&s, 17);
        s.frame.no_picture = i == 1; /* whose layers then come with the next that is looked at */
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, NULL));
        s.frame.no_picture = false;
        render_both(&s, &cpu, &vulkan);
        const difference d = compare_pictures(&s, ROUNDING);
        const uint32_t layers_off = count_layers_off(&s);
        print_message("mean %.2e, worst %.2e, %u of %u pixels off, %u of their layers\n", d.mean, d.worst, d.off,
                      d.count, layers_off);
        assert_true(d.off <= d.count / 50 && d.mean < 1e-4 && layers_off <= 4);
        destroy_stage(&s);
    }
    traces = false;
}

/* The rasteriser has found a triangle where a pixel is of the object, and none elsewhere. */
static void expect_drawn(const stage *s)
{
    struct vulkan_renderer *v = s->vulkan->vulkan;
    const helio_picture picture = helio_renderer_picture(s->vulkan);
    uint32_t *seen = read_buffer(&v->slots[0].commands, &v->raster.seen, WIDTH * HEIGHT * sizeof *seen), off = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        assert_true(seen[i] == LAYOUT_NOTHING_SEEN || seen[i] < s->mesh->triangle_count);
        off += (seen[i] != LAYOUT_NOTHING_SEEN) != (picture.object[i] > 0.0f);
    }
    assert_int_equal(off, 0);
    free(seen);
}

/* Through the centres of pixels the rasteriser sees what rays meet, but where an edge passes within 1/256 of a pixel.
 */
static void the_rasteriser_sees_what_rays_meet(void **state)
{
    static const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 8, .aovs = true};
    static const char *const ways[] = {"raster", "auto"};
    (void)state;
    traces = true;
    for (size_t i = 0; i < 2; i++) {
        setenv("HELIOSTAT_VULKAN_PRIMARY", ways[i], 1);
        plays_hardware = i == 1;
        stage s = make_stage(NULL, &desc);
        helio_frame_info cpu, vulkan;
        light_stage_with(&s, 17);
        for (size_t view = i; view < 3; view += 2) {
            static const char *const cameras[] = {"auto", "orbit:azimuth=70", "lookat:eye=0.3,0.1,0.2,fov=70"};
            assert_ok(helio_camera_parse(cameras[view], s.mesh, (float)WIDTH / HEIGHT, &s.frame.camera));
            render_both(&s, &cpu, &vulkan);
            const difference d = compare_pictures(&s, ROUNDING);
            const uint32_t layers_off = count_layers_off(&s);
            print_message("%s: mean %.2e, worst %.2e, %u of %u pixels off, %u of their layers\n", ways[i], d.mean,
                          d.worst, d.off, d.count, layers_off);
            assert_true(d.off <= d.count / 50 && d.mean < 1e-4 && layers_off <= 4);
            if (s.vulkan->vulkan->way == PRIMARY_BY_RASTER)
                expect_drawn(&s);
        }
        assert_true(s.vulkan->vulkan->raster.device != NULL && s.vulkan->vulkan->way != PRIMARY_BY_FASTER);
        assert_true(i == 1 || s.vulkan->vulkan->way == PRIMARY_BY_RASTER);
        destroy_stage(&s);
    }
    unsetenv("HELIOSTAT_VULKAN_PRIMARY");
    traces = plays_hardware = false;
}

static double greatest_alpha_of_ground(const stage *s)
{
    const helio_picture picture = helio_renderer_picture(s->vulkan);
    double greatest = 0;
    for (size_t i = 0; i < (size_t)picture.width * picture.height; i++)
        if (picture.object[i] == 0.0f)
            greatest = fmax(greatest, (double)picture.rgba[4 * i + 3]);
    return greatest;
}

static bool stop_at_half(void *user, float done)
{
    (void)user;
    return done < 0.5f;
}

/* With the environment behind shadows or without, several camera samples, and a frame that stops. */
static void shadows_are_caught_as_on_the_cpu(void **state)
{
    static const helio_renderer_desc descs[] = {
        {.strategy = HELIO_STRATEGY_FACE, .aa = 4, .spp = 8, .background = HELIO_BACKGROUND_ENVIRONMENT},
        {.spp = 64, .bins = 3},
    };
    (void)state;
    ground = HELIO_GROUND_SHADOW;
    casts_shadows = true;
    for (size_t i = 0; i < 2; i++) {
        helio_frame_info cpu, vulkan;
        traces = plays_hardware = i == 1;
        stage s = make_stage(MATERIALS[i], &descs[i]);
        light_stage_with(&s, 17);
        render_both(&s, &cpu, &vulkan);
        const difference d = compare_pictures(&s, ROUNDING);
        print_message("mean %.2e, worst %.2e, %u of %u pixels off\n", d.mean, d.worst, d.off, d.count);
        assert_true(d.off <= (traces ? d.count / 10 : 0) && d.mean < 1e-3);
        assert_true(traces || (vulkan.points == cpu.points && vulkan.rays == cpu.rays));
        assert_true(i == 0 || greatest_alpha_of_ground(&s) > 0.5);
        if (i == 0) {
            s.frame.progress = stop_at_half;
            render_both(&s, &cpu, &vulkan);
            assert_true(cpu.stopped && vulkan.stopped);
            assert_int_equal(compare_pictures(&s, ROUNDING).off, 0);
        }
        destroy_stage(&s);
    }
    traces = casts_shadows = plays_hardware = false;
    ground = HELIO_GROUND_PLANE;
}

/* Layers of the CPU's own rays. */
static void compare_layers(const stage *s)
{
    const helio_picture a = helio_renderer_picture(s->vulkan), b = helio_renderer_picture(s->cpu);
    const size_t pixels = (size_t)a.width * a.height;
    if (b.albedo == NULL)
        return;
    assert_memory_equal(a.albedo, b.albedo, 3 * pixels * sizeof(float));
    assert_memory_equal(a.normal, b.normal, 3 * pixels * sizeof(float));
    assert_memory_equal(a.position, b.position, 3 * pixels * sizeof(float));
    assert_memory_equal(a.depth, b.depth, pixels * sizeof(float));
}

static void expect_same(stage *s, double tolerance, const char *what)
{
    helio_frame_info cpu, vulkan;
    render_both(s, &cpu, &vulkan);
    const difference d = compare_pictures(s, tolerance);
    compare_layers(s);
    const bool weighs_tiles =
        s->cpu->pools->parts.surface == STRATEGY_SURFACE_BRDF && s->cpu->pools->bins != NULL && !s->cpu->pools->is_even;
    const double beside = weighs_tiles ? PIXELS_BESIDE * d.count : 0;
    if (d.off > beside || d.mean > 1e-4 || vulkan.samples != cpu.samples || vulkan.passes != cpu.passes)
        fail_msg("%s: %u pixels differ, the worst by %g; %u passes in place of %u", what, d.off, d.worst, vulkan.passes,
                 cpu.passes);
}

/* Several camera samples, several passes for each, and the settings of a renderer. */
static void settings_do_what_they_do_on_the_cpu(void **state)
{
    static const helio_renderer_desc descs[] = {
        {.strategy = HELIO_STRATEGY_FACE, .aa = 3, .spp = 4, .pool_length = 64, .no_beta = true, .aovs = true},
        {.strategy = HELIO_STRATEGY_FACE, .aa = 2, .spp = 20, .pool_length = 64, .no_decorrelation = true},
        {.strategy = HELIO_STRATEGY_PRODUCT, .spp = 100, .bins = 3, .background = HELIO_BACKGROUND_NONE},
        {.strategy = HELIO_STRATEGY_FACE_BRDF, .weighting = HELIO_WEIGHTING_COMPENSATED},
        {.strategy = HELIO_STRATEGY_LIGHT, .weighting = HELIO_WEIGHTING_PAPER, .background = HELIO_BACKGROUND_NONE},
    };
    (void)state;
    for (size_t i = 0; i < sizeof descs / sizeof *descs; i++) {
        stage s = make_stage(MATERIALS[i % 2], &descs[i]);
        light_stage_with(&s, i);
        expect_same(&s, ROUNDING, "settings");
        destroy_stage(&s);
    }
}

/* Frame t is lit by frame t, whatever else changes: the map's turn, mirror and intensity, and the camera. */
static void sequences_give_the_pictures_of_the_cpu(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 8};
    const uint64_t frames = is_thorough() ? 300 : 16;
    stage s = make_stage(MATERIALS[0], &desc);
    (void)state;
    for (uint64_t i = 0; i < frames; i++) {
        const helio_orientation turn = {
            .rotate = (float)(i * 13), .flip = i % 6 > 3, .intensity = 1.0f + (float)(i % 4)};
        light_stage_with(&s, i);
        assert_ok(helio_environment_orient(s.environment, &turn));
        if (i % 8 == 7)
            assert_ok(helio_camera_parse(i % 16 == 7 ? "orbit:azimuth=70" : "auto", s.mesh, (float)WIDTH / HEIGHT,
                                         &s.frame.camera));
        s.frame.seed = (uint32_t)i;
        s.frame.retrace = i % 5 == 4;
        expect_same(&s, ROUNDING, "a frame");
    }
    destroy_stage(&s);
}

/* Frames whose picture is not wanted go on beside each other; what is told of them comes later. */
static void frames_on_their_way_do_not_mix(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT, .spp = 16, .bins = 3, .pool_length = 64};
    stage s = make_stage(MATERIALS[0], &desc);
    helio_frame_info info, told;
    (void)state;
    for (uint64_t round = 0; round < 6; round++) {
        s.frame.no_picture = true;
        for (uint64_t i = 0; i < round; i++) {
            light_stage_with(&s, 100 * round + i);
            s.frame.seed = (uint32_t)i;
            assert_ok(helio_renderer_render(s.vulkan, &s.frame, &told));
        }
        s.frame.no_picture = false;
        light_stage_with(&s, round);
        expect_same(&s, ROUNDING, "the frame after some that were not looked at");
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, &info));
        if (round > 2)
            assert_int_equal(told.samples, info.samples); /* every frame has as many */
    }
    destroy_stage(&s);
}

static bool stop_after_two(void *user, float done)
{
    uint32_t *calls = user;
    assert_true(done > 0.0f && done <= 1.0f);
    return ++*calls < 2;
}

/* In place of radiance, or beside it; also of a frame that has stopped. */
static void what_is_shown_is_what_the_cpu_shows(void **state)
{
    const helio_renderer_desc desc = {
        .strategy = HELIO_STRATEGY_FACE, .aa = 4, .spp = 8, .pool_length = 64, .background = HELIO_BACKGROUND_NONE};
    stage s = make_stage(MATERIALS[0], &desc);
    (void)state;
    light_stage_with(&s, 3);
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t calls = 0, off = 0;
        const helio_picture_write_desc look = {
            .exposure = -1.0f, .tonemap = (helio_tonemap)(i % 2), .alpha = i / 2 % 2};
        s.frame.shown = &look;
        s.frame.no_radiance = i % 2;
        s.frame.progress = i == 4 ? stop_after_two : NULL;
        s.frame.user = &calls;
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, NULL));
        const helio_picture found = helio_renderer_picture(s.vulkan);
        assert_true((found.rgba == NULL) == s.frame.no_radiance && (found.object == NULL) == s.frame.no_radiance);
        s.frame.no_radiance = false;
        s.frame.progress = NULL;
        assert_ok(helio_renderer_render(s.cpu, &s.frame, NULL));
        const helio_picture expected = helio_renderer_picture(s.cpu);
        for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
            uint8_t own[4];
            tonemap_shown((found.rgba != NULL ? found : expected).rgba + 4 * k, &look, own);
            for (size_t c = 0; c < 4; c++) {
                const int distance = abs((int)found.shown[4 * k + c] - (int)own[c]);
                assert_true(distance <= 1);
                off += distance > 0;
            }
        }
        print_message("%u of %d bytes are the next\n", off, 4 * WIDTH * HEIGHT);
    }
    destroy_stage(&s);
}

/* AUTO leaves even light to the BRDF, and comes back when it is even no more. */
static void even_light_is_not_aimed_at(void **state)
{
    const helio_renderer_desc desc = {.spp = 32, .bins = 3, .pool_length = 128};
    (void)state;
    for (size_t m = 0; m < 2; m++) {
        stage s = make_stage(MATERIALS[m], &desc);
        for (int i = 0; i < 3; i++) {
            light_stage_with(&s, 1);
            if (i != 1)
                for (size_t k = 0; k < (size_t)6 * SIZE * SIZE * 3; k++)
                    s.environment->cube[k] = 1.0f + 0.1f * (float)(k / ((size_t)SIZE * SIZE * 3));
            expect_same(&s, ROUNDING, "even light");
            assert_true(s.cpu->pools->is_even == (i != 1));
        }
        destroy_stage(&s);
    }
}

static void black_maps_give_black_pictures(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE_BRDF, .spp = 16};
    stage s = make_stage(MATERIALS[0], &desc);
    (void)state;
    fill_cube(s.environment, MAP_BLACK, 0);
    expect_same(&s, 0.0, "a black map");
    fill_cube(s.environment, MAP_ONE_TEXEL, 5);
    expect_same(&s, ROUNDING, "one texel");
    destroy_stage(&s);
}

/* ---- what a caller may do ---- */

static void frames_stop_when_told_to(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .aa = 4, .spp = 8, .pool_length = 64};
    stage s = make_stage(MATERIALS[0], &desc);
    uint32_t calls = 0;
    helio_frame_info info;
    (void)state;
    light_stage_with(&s, 1);
    s.frame.progress = stop_after_two;
    s.frame.user = &calls;
    assert_ok(helio_renderer_render(s.vulkan, &s.frame, &info));
    assert_true(info.stopped);
    assert_int_equal(calls, 2);
    const helio_picture picture = helio_renderer_picture(s.vulkan);
    double mean = 0, whole = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        mean += (double)picture.rgba[4 * i] / (WIDTH * HEIGHT);
    s.frame.no_picture = true;
    assert_ok(helio_renderer_render(s.vulkan, &s.frame, &info));
    assert_true(info.stopped);
    assert_int_equal(calls, 3);
    s.frame.no_picture = false;
    s.frame.progress = NULL;
    assert_ok(helio_renderer_render(s.vulkan, &s.frame, &info)); /* and go on as if nothing had been */
    assert_false(info.stopped);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        whole += (double)picture.rgba[4 * i] / (WIDTH * HEIGHT);
    assert_true(fabs(mean - whole) < 0.1 * whole);
    expect_same(&s, ROUNDING, "the frame after one that stopped");
    destroy_stage(&s);
}

static void what_a_device_cannot_do_is_told(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 8};
    stage s = make_stage(MATERIALS[0], &desc);
    helio_renderer *renderer;
    (void)state;
    const helio_renderer_desc wrong = {
        .environment = s.environment, .scene = s.scene, .width = 8, .height = 8, .device = s.device};
    assert_int_equal(renderer_create(s.context, &wrong, &(renderer_extras){.keeps_sums = true}, &renderer),
                     HELIO_ERR_UNSUPPORTED);
    assert_non_null(strstr(helio_last_error(), "--backend cpu"));
    assert_int_equal(helio_renderer_render(s.vulkan, &s.frame, NULL), HELIO_ERR_ARGUMENT); /* no map yet */
    destroy_stage(&s);
}

static VkResult VKAPI_CALL lose_submit(VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence)
{
    (void)queue;
    (void)count;
    (void)infos;
    (void)fence;
    return VK_ERROR_DEVICE_LOST;
}

static PFN_vkQueueSubmit real_submit;
static bool refuses_frames;

/* The work of frames waits for the map that was sent beside it; other work waits for nothing. */
static VkResult VKAPI_CALL refuse_frames(VkQueue queue, uint32_t count, const VkSubmitInfo *infos, VkFence fence)
{
    if (refuses_frames && infos->waitSemaphoreCount > 0)
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    return real_submit(queue, count, infos, fence);
}

/* Though the map of each was on its way. The validation layer has nothing to say of what follows, nor of the end. */
static void frames_that_fail_leave_the_next_alone(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 4, .pool_length = 64};
    (void)state;
    for (int is_last = 0; is_last < 2; is_last++) {
        stage s = make_stage(MATERIALS[0], &desc);
        light_stage_with(&s, 1);
        real_submit = s.device->vk.QueueSubmit;
        s.device->vk.QueueSubmit = refuse_frames;
        refuses_frames = true;
        for (int i = 0; i < 3; i++)
            assert_int_equal(helio_renderer_render(s.vulkan, &s.frame, NULL), HELIO_ERR_MEMORY);
        refuses_frames = false;
        for (int i = 0; i < 3 && !is_last; i++)
            expect_same(&s, ROUNDING, "the frame after some that failed");
        destroy_stage(&s);
    }
}

/* The program's frames: test_vulkan_program. */
static void a_lost_device_is_told_and_the_picture_stays(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 4, .pool_length = 64};
    stage s = make_stage(MATERIALS[0], &desc);
    (void)state;
    light_stage_with(&s, 1);
    expect_same(&s, ROUNDING, "the frame before");
    s.device->vk.QueueSubmit = lose_submit;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(helio_renderer_render(s.vulkan, &s.frame, NULL), HELIO_ERR_DEVICE);
        assert_non_null(strstr(helio_last_error(), "the device was lost"));
    }
    assert_int_equal(compare_pictures(&s, ROUNDING).off, 0);
    destroy_stage(&s);
}

/* Pictures and cubes of odd and least sizes, strategies that follow each other, two renderers at once. */
static void renderers_come_and_go_on_a_device(void **state)
{
    static const struct {
        uint32_t width, height, cube;
        helio_strategy strategy;
    } kinds[] = {{1, 1, 1, HELIO_STRATEGY_PRODUCT}, {17, 3, 5, HELIO_STRATEGY_FACE}, {33, 40, 2, HELIO_STRATEGY_LIGHT}};
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 4, .pool_length = 64};
    stage s = make_stage(MATERIALS[0], &desc);
    (void)state;
    light_stage_with(&s, 2);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        helio_environment *environment;
        assert_ok(
            helio_environment_create(s.context, &(helio_environment_desc){.cube_size = kinds[i].cube}, &environment));
        fill_cube(environment, MAP_RANDOM, i);
        helio_renderer_desc own = {.environment = environment,
                                   .scene = s.scene,
                                   .width = kinds[i].width,
                                   .height = kinds[i].height,
                                   .strategy = kinds[i].strategy,
                                   .spp = 16,
                                   .no_visibility = true};
        stage other = s;
        assert_ok(helio_renderer_create(s.context, &own, &other.cpu));
        own.device = s.device;
        assert_ok(renderer_create(s.context, &own, &(renderer_extras){.cpu_rays = true}, &other.vulkan));
        for (int frame = 0; frame < 2; frame++) {
            expect_same(&other, ROUNDING, "a renderer beside another");
            expect_same(&s, ROUNDING, "a renderer beside another");
        }
        helio_renderer_destroy(other.vulkan);
        helio_renderer_destroy(other.cpu);
        helio_environment_destroy(environment);
    }
    destroy_stage(&s);
}

/* ---- memory ---- */

static size_t resident_bytes(void)
{
    size_t pages = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%zu %zu", &pages, &resident), 2); /* NOLINT(cert-err34-c) */
    fclose(file);
    return resident * (size_t)sysconf(_SC_PAGESIZE);
}

/* Neither do drivers, over thousands of frames: in 10,000 the validation layer grows by 2 MiB, and half a KiB a frame
 * would be 5. */
static void memory_stays_flat(void **state)
{
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 1, .pool_length = 64};
    const int frames = is_thorough() ? 10000 : 50;
    stage s = make_stage(MATERIALS[0], &desc);
    (void)state;
    light_stage_with(&s, 1);
    s.frame.no_picture = true;
    for (int i = 0; i < frames / 10; i++)
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, NULL));
    const size_t before = resident_bytes();
    for (int i = 0; i < frames; i++)
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, NULL));
    const size_t after = resident_bytes();
    print_message("%zu KiB before, %zu after\n", before >> 10, after >> 10);
#ifndef __SANITIZE_ADDRESS__ /* which keeps what was released */
    assert_true(after < before + (4u << 20));
#endif
    destroy_stage(&s);
}

/* After the first frame none is taken: neither of the context, nor by objects of the device, which the validation layer
 * would have to be told of. */
static void frames_take_no_memory(void **state)
{
    memory_count count = {0};
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_PRODUCT, .spp = 8, .bins = 2, .pool_length = 64};
    stage s = make_stage(MATERIALS[0], &desc);
    helio_context *context = make_context(1, &count);
    (void)state;
    const size_t live = count.live;
    light_stage_with(&s, 1);
    helio_renderer_desc own = desc;
    own.environment = s.environment;
    own.scene = s.scene;
    own.width = own.height = 16;
    own.no_visibility = true;
    own.device = s.device;
    helio_renderer *renderer;
    assert_ok(helio_renderer_create(context, &own, &renderer));
    assert_ok(helio_renderer_render(renderer, &s.frame, NULL));
    const size_t taken = count.taken;
    for (int i = 0; i < 5; i++)
        assert_ok(helio_renderer_render(renderer, &s.frame, NULL));
    assert_int_equal(count.taken, taken);
    helio_renderer_destroy(renderer);
    assert_int_equal(count.live, live);
    helio_context_destroy(context);
    destroy_stage(&s);
}

/* ---- maps ---- */

enum { MAP_WIDTH = 96, MAP_HEIGHT = 48, MAP_NUMBERS = MAP_WIDTH * MAP_HEIGHT * 3 };

/* A sky with a sun, and `bad` pixels of each kind. */
static void fill_map(float *rgb, uint64_t seed, size_t bad)
{
    for (size_t i = 0; i < MAP_NUMBERS; i++)
        rgb[i] = 0.2f + (float)random_unit(&seed);
    for (size_t c = 0; c < 6; c++)
        rgb[(size_t)(11 * MAP_WIDTH + 20) * 3 + c] = 3000.0f;
    for (size_t i = 0; i < bad; i++) {
        rgb[i * 9] = NAN;
        rgb[i * 9 + 4] = -1.0f;
        rgb[i * 9 + 8] = INFINITY;
    }
}

static void expect_light(const helio_frame_info *found, const helio_environment_info *expected)
{
    assert_int_equal(found->bad.nan, expected->bad.nan);
    assert_int_equal(found->bad.infinite, expected->bad.infinite);
    assert_int_equal(found->bad.negative, expected->bad.negative);
    for (size_t face = 0; face < 6; face++)
        assert_true(fabs(found->flux[face] / expected->flux[face] - 1) < 1e-5);
}

/* Software would leave cubes to the CPU. */
static stage make_map_stage(const helio_renderer_desc *desc)
{
    plays_hardware = true;
    stage s = make_stage(MATERIALS[0], desc);
    plays_hardware = false;
    assert_ok(helio_environment_reshape(s.environment, MAP_WIDTH, MAP_HEIGHT, HELIO_LAYOUT_LATLONG));
    return s;
}

/* Every third frame is a sky. */
static void update_stage(const stage *s, helio_sky *sky, const float *rgb, size_t index, helio_environment_info *info)
{
    const helio_sky_desc desc = {.sun = {.azimuth = 160, .elevation = 3.0 * (double)index}, .albedo = 0.2f};
    if (index % 3 == 2)
        assert_ok(helio_sky_update(sky, &desc, s->environment, info));
    else
        assert_ok(helio_environment_update(s->environment, rgb, info));
}

/* A device's cubes differ in the last bits, so that a sample's row or column may be another: in few pixels. */
static void frames_of_maps_and_skies_give_the_pictures_of_the_cpu(void **state)
{
    static float rgb[MAP_NUMBERS];
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 64, .pool_length = 64};
    stage s = make_map_stage(&desc);
    helio_frame_info cpu, vulkan;
    helio_environment_info info;
    helio_sky *sky;
    (void)state;
    assert_ok(helio_sky_create(s.context, SIZE, &sky));
    for (size_t i = 0; i < 6; i++) {
        fill_map(rgb, i, i);
        update_stage(&s, sky, rgb, i, &info);
        assert_ok(helio_renderer_render(s.cpu, &s.frame, &cpu));
        update_stage(&s, sky, rgb, i, NULL);
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, &vulkan));
        assert_true(s.environment->is_late); /* nobody has asked the CPU for it */
        expect_light(&vulkan, &info);
        const difference d = compare_pictures(&s, 1e-3);
        print_message("a frame of a map or sky: mean %.2e, worst %.2e, %u of %u pixels off\n", d.mean, d.worst, d.off,
                      d.count);
        assert_true(d.mean <= 1e-4 && d.off <= PIXELS_BESIDE * d.count);
    }
    helio_sky_destroy(sky);
    destroy_stage(&s);
}

/* Counts of a frame come with it or with a later one, and are those of its own map. */
static void counts_belong_to_their_frames(void **state)
{
    static float rgb[MAP_NUMBERS];
    const helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_FACE, .spp = 8, .pool_length = 64};
    stage s = make_map_stage(&desc);
    helio_frame_info info;
    uint64_t next = 0;
    (void)state;
    s.frame.no_picture = true;
    for (size_t i = 0; i < 12; i++) {
        fill_map(rgb, i, 1 + i);
        assert_ok(helio_environment_update(s.environment, rgb, NULL));
        memset(rgb, 0, sizeof rgb); /* it was copied */
        s.frame.no_picture = i < 11;
        assert_ok(helio_renderer_render(s.vulkan, &s.frame, &info));
        assert_true(info.bad.nan >= next && info.bad.nan <= i + 1);
        assert_true(info.bad.negative == info.bad.nan && info.bad.infinite == info.bad.nan);
        assert_true(i < 2 || info.bad.nan > 0);
        next = info.bad.nan;
    }
    assert_int_equal(next, 12);
    destroy_stage(&s);
}

/* Nor do maps, once a shape is known, and skies after the first. */
static void maps_and_skies_take_no_memory(void **state)
{
    static float rgb[MAP_NUMBERS];
    memory_count count = {0};
    helio_context *context = make_context(1, &count);
    helio_environment *environment;
    const helio_environment_desc desc = {SIZE, MAP_WIDTH, MAP_HEIGHT, HELIO_LAYOUT_LATLONG};
    stage s = make_map_stage(&(helio_renderer_desc){.spp = 8, .strategy = HELIO_STRATEGY_FACE});
    (void)state;
    const size_t live = count.live;
    fill_map(rgb, 1, 1);
    assert_ok(helio_environment_create(context, &desc, &environment));
    const helio_renderer_desc own = {.environment = environment,
                                     .scene = s.scene,
                                     .width = 16,
                                     .height = 16,
                                     .spp = 8,
                                     .strategy = HELIO_STRATEGY_FACE,
                                     .no_visibility = true,
                                     .device = s.device};
    helio_renderer *renderer;
    helio_sky *sky;
    assert_ok(helio_renderer_create(context, &own, &renderer));
    assert_ok(helio_sky_create(context, SIZE, &sky));
    size_t taken = 0;
    s.frame.no_picture = true;
    stage other = s;
    other.environment = environment;
    for (size_t i = 0; i < 9; i++) {
        update_stage(&other, sky, rgb, i, NULL);
        assert_true(environment->is_late);
        assert_ok(helio_renderer_render(renderer, &s.frame, NULL));
        taken = i < 3 ? count.taken : taken;
        assert_int_equal(count.taken, taken);
    }
    helio_sky_destroy(sky);
    helio_renderer_destroy(renderer);
    helio_environment_destroy(environment);
    assert_int_equal(count.live, live);
    helio_context_destroy(context);
    destroy_stage(&s);
}

/* An argument is a filter for the names of tests. */
int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strategies_give_the_pictures_of_the_cpu),
        cmocka_unit_test(small_cubes_light_points_that_weigh_tiles),
        cmocka_unit_test(calm_lobes_are_lit_alike),
        cmocka_unit_test(threads_that_share_a_point_light_it_alike),
        cmocka_unit_test(shadows_fall_where_the_cpu_has_them),
        cmocka_unit_test(rays_of_the_device_see_the_same),
        cmocka_unit_test(textures_and_layers_are_those_of_the_cpu),
        cmocka_unit_test(the_rasteriser_sees_what_rays_meet),
        cmocka_unit_test(shadows_are_caught_as_on_the_cpu),
        cmocka_unit_test(settings_do_what_they_do_on_the_cpu),
        cmocka_unit_test(sequences_give_the_pictures_of_the_cpu),
        cmocka_unit_test(frames_on_their_way_do_not_mix),
        cmocka_unit_test(what_is_shown_is_what_the_cpu_shows),
        cmocka_unit_test(even_light_is_not_aimed_at),
        cmocka_unit_test(black_maps_give_black_pictures),
        cmocka_unit_test(frames_stop_when_told_to),
        cmocka_unit_test(what_a_device_cannot_do_is_told),
        cmocka_unit_test(frames_that_fail_leave_the_next_alone),
        cmocka_unit_test(a_lost_device_is_told_and_the_picture_stays),
        cmocka_unit_test(renderers_come_and_go_on_a_device),
        cmocka_unit_test(frames_take_no_memory),
        cmocka_unit_test(memory_stays_flat),
        cmocka_unit_test(frames_of_maps_and_skies_give_the_pictures_of_the_cpu),
        cmocka_unit_test(counts_belong_to_their_frames),
        cmocka_unit_test(maps_and_skies_take_no_memory),
    };
    if (count > 1)
        cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests_name("vulkan_render", tests, NULL, NULL);
}
