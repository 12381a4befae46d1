/* SPDX-License-Identifier: MIT
 *
 * Whole pictures of small scenes: what every pixel should hold, and that it does not depend on threads or strategy. */
#include "support.h"

#include "core/isa.h"
#include "core/vector.h"
#include "cpu/background.h"
#include "sampling/kernels.h"
#include "scene/camera.h"

#include <heliostat/heliostat.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { MAP_WIDTH = 32, MAP_HEIGHT = 16, WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

static const helio_material white = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {1, 1, 1}};
static const helio_material glossy = {
    .kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.5f, 0.5f, 0.5f}, .exponent = 40};
static const helio_material metal = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 0.8f, 0.3f}, .metallic = 1.0f, .roughness = 0.3f};

/* ---- scenes made by code ---- */

/* A box from (-1, 0, -1) to (1, 2, 1) with flat normals. */
static helio_mesh *make_box(helio_context *context)
{
    float positions[24][3], normals[24][3];
    uint32_t triangles[12][3];
    for (uint32_t side = 0; side < 6; side++) {
        vec3 normal = {0, 0, 0}, right, up;
        float sign = side & 1 ? -1.0f : 1.0f;
        ((float *)&normal)[side / 2] = sign;
        right = side / 2 == 1 ? (vec3){1, 0, 0} : (vec3){0, 1, 0};
        up = cross(normal, right);
        for (uint32_t corner = 0; corner < 4; corner++) {
            vec3 p = add_scaled(add_scaled(normal, right, corner == 1 || corner == 2 ? 1.0f : -1.0f), up,
                                corner >= 2 ? 1.0f : -1.0f);
            p.y += 1.0f;
            vec3_to(p, positions[side * 4 + corner]);
            vec3_to(normal, normals[side * 4 + corner]);
        }
        memcpy(triangles[side * 2], (uint32_t[3]){side * 4, side * 4 + 1, side * 4 + 2}, sizeof triangles[0]);
        memcpy(triangles[side * 2 + 1], (uint32_t[3]){side * 4, side * 4 + 2, side * 4 + 3}, sizeof triangles[0]);
    }
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context,
                                &(helio_mesh_desc){.vertex_count = 24,
                                                   .triangle_count = 12,
                                                   .positions = positions[0],
                                                   .normals = normals[0],
                                                   .triangles = triangles[0]},
                                &mesh));
    return mesh;
}

enum { RINGS = 24, SPOKES = 48, SPHERE_VERTICES = (RINGS + 1) * SPOKES, SPHERE_TRIANGLES = 2 * RINGS * SPOKES };

/* A unit sphere about (0, 1, 0) with exact normals. */
static helio_mesh *make_sphere(helio_context *context)
{
    static float positions[SPHERE_VERTICES][3], normals[SPHERE_VERTICES][3];
    static uint32_t triangles[SPHERE_TRIANGLES][3];
    uint32_t t = 0;
    for (uint32_t ring = 0; ring <= RINGS; ring++)
        for (uint32_t spoke = 0; spoke < SPOKES; spoke++) {
            double polar = PI * ring / RINGS, around = 2 * PI * spoke / SPOKES;
            vec3 n = {(float)(sin(polar) * cos(around)), (float)cos(polar), (float)(sin(polar) * sin(around))};
            uint32_t i = ring * SPOKES + spoke, next = ring * SPOKES + (spoke + 1) % SPOKES;
            vec3_to(n, normals[i]);
            vec3_to(add(n, (vec3){0, 1, 0}), positions[i]);
            if (ring == RINGS)
                continue;
            memcpy(triangles[t++], (uint32_t[3]){i, next, i + SPOKES}, sizeof triangles[0]);
            memcpy(triangles[t++], (uint32_t[3]){next, next + SPOKES, i + SPOKES}, sizeof triangles[0]);
        }
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context,
                                &(helio_mesh_desc){.vertex_count = SPHERE_VERTICES,
                                                   .triangle_count = SPHERE_TRIANGLES,
                                                   .positions = positions[0],
                                                   .normals = normals[0],
                                                   .triangles = triangles[0]},
                                &mesh));
    return mesh;
}

static void fill_map(float map[MAP_HEIGHT][MAP_WIDTH][3], float r, float g, float b)
{
    for (int y = 0; y < MAP_HEIGHT; y++)
        for (int x = 0; x < MAP_WIDTH; x++) {
            map[y][x][0] = r;
            map[y][x][1] = g;
            map[y][x][2] = b;
        }
}

/* A blue sky over a brown ground with a sun of 2000 in one pixel, 40 degrees high, to the right of +Z. */
static void fill_sunny(float map[MAP_HEIGHT][MAP_WIDTH][3])
{
    for (int y = 0; y < MAP_HEIGHT; y++)
        for (int x = 0; x < MAP_WIDTH; x++) {
            float height = 1.0f - 2.0f * (float)y / (MAP_HEIGHT - 1);
            float sky[3] = {0.3f + 0.2f * height, 0.5f + 0.2f * height, 1.0f}, ground[3] = {0.2f, 0.15f, 0.1f};
            memcpy(map[y][x], height > 0 ? sky : ground, 3 * sizeof(float));
        }
    map[4][13][0] = 2000.0f;
    map[4][13][1] = 1800.0f;
    map[4][13][2] = 1500.0f;
}

typedef struct setup {
    helio_context *context;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_environment *environment;
    helio_renderer *renderer;
    helio_camera camera;
} setup;

typedef helio_mesh *(*mesh_maker)(helio_context *context);

static setup make_setup(helio_context *context, mesh_maker make_mesh, const helio_material *material,
                        helio_ground ground, float map[MAP_HEIGHT][MAP_WIDTH][3], helio_renderer_desc desc)
{
    setup s = {.context = context, .mesh = make_mesh(context)};
    s.environment = make_environment(context, HELIO_LAYOUT_LATLONG, MAP_WIDTH, MAP_HEIGHT, 32, &map[0][0][0], NULL);
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = s.mesh, .material = material, .ground = ground},
                                 &s.scene));
    desc.environment = s.environment;
    desc.scene = s.scene;
    desc.width = desc.width ? desc.width : WIDTH;
    desc.height = desc.height ? desc.height : HEIGHT;
    assert_ok(helio_renderer_create(context, &desc, &s.renderer));
    assert_ok(helio_camera_parse("orbit:azimuth=30,elevation=25,distance=1.6,fov=35", s.mesh,
                                 (float)desc.width / (float)desc.height, &s.camera));
    return s;
}

static void destroy_setup(setup *s)
{
    helio_renderer_destroy(s->renderer);
    helio_scene_destroy(s->scene);
    helio_environment_destroy(s->environment);
    helio_mesh_destroy(s->context, s->mesh);
}

static helio_picture render(setup *s, uint32_t seed, helio_frame_info *info)
{
    assert_ok(helio_renderer_render(s->renderer, &(helio_frame_desc){.camera = s->camera, .seed = seed}, info));
    return helio_renderer_picture(s->renderer);
}

/* ---- light ---- */

static void a_white_box_vanishes_in_a_furnace(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_map(map, 1, 1, 1);
    /* Cosine samples have no variance here; a convex body casts no shadow on itself. */
    setup s = make_setup(context, make_box, &white, HELIO_GROUND_NONE, map,
                         (helio_renderer_desc){.strategy = HELIO_STRATEGY_COSINE});
    helio_picture picture = render(&s, 0, NULL);
    double covered = 0;
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 3; c++)
            assert_float_equal(picture.rgba[i * 4 + c], 1.0f, 1e-5f);
        assert_float_equal(picture.rgba[i * 4 + 3], 1.0f, 0.0f);
        covered += (double)picture.object[i];
    }
    assert_true(covered > 0.1 * PIXELS && covered < 0.8 * PIXELS);
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* Mean of a channel over the object, and the standard error that 16 renders with other seeds show. */
static double mean_light(setup *s, double *error)
{
    enum { RENDERS = 16 };
    double sum = 0, sum2 = 0;
    for (uint32_t seed = 0; seed < RENDERS; seed++) {
        helio_picture picture = render(s, seed, NULL);
        double light = 0, count = 0;
        for (int i = 0; i < PIXELS; i++)
            if (picture.object[i] > 0.5f) {
                light += (double)picture.rgba[i * 4 + 1];
                count++;
            }
        sum += light / count / RENDERS;
        sum2 += light / count * (light / count) / RENDERS;
    }
    *error = sqrt(fmax(0, sum2 - sum * sum) / (RENDERS - 1));
    return sum;
}

static void all_strategies_agree_with_shadows_on_each_material(void **state)
{
    (void)state;
    static const helio_strategy strategies[] = {
        HELIO_STRATEGY_LIGHT, HELIO_STRATEGY_COSINE,    HELIO_STRATEGY_BRDF,    HELIO_STRATEGY_LIGHT_BRDF,
        HELIO_STRATEGY_FACE,  HELIO_STRATEGY_FACE_BRDF, HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF};
    const helio_material *materials[] = {&white, &glossy, &metal};
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    map[4][13][0] = map[4][13][1] = map[4][13][2] = 60.0f; /* a sun that cosine samples can meet */
    for (int m = 0; m < 3; m++) {
        double reference = 0, reference_error = 0;
        for (int i = 0; i < 8; i++) {
            setup s = make_setup(context, make_sphere, materials[m], HELIO_GROUND_PLANE, map,
                                 (helio_renderer_desc){.strategy = strategies[i], .spp = 128});
            double error, mean = mean_light(&s, &error);
            if (i == 0) {
                reference = mean;
                reference_error = error;
            }
            double z = (mean - reference) / sqrt(error * error + reference_error * reference_error + 1e-20);
            if (fabs(z) > 8) /* 15 degrees of freedom: 8 has p = 1e-6 in Student's distribution */
                fail_msg("material %d: %s gives %g, light %g: z = %.1f", m, helio_strategy_name(strategies[i]), mean,
                         reference, z);
            destroy_setup(&s);
        }
    }
    helio_context_destroy(context);
}

/* More samples than the pools hold: the error keeps falling. */
static void samples_beyond_the_pools_take_more_passes_and_converge(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    const uint32_t spps[3] = {8, 128, 2048};
    static float pictures[2][3][PIXELS * 4];
    for (int run = 0; run < 2; run++)
        for (int i = 0; i < 3; i++) {
            setup s = make_setup(
                context, make_sphere, &glossy, HELIO_GROUND_PLANE, map,
                (helio_renderer_desc){.strategy = HELIO_STRATEGY_FACE_BRDF, .spp = spps[i], .pool_length = 64});
            helio_frame_info info;
            assert_int_equal(helio_renderer_passes(s.renderer), spps[i] / 8);
            memcpy(pictures[run][i], render(&s, 100 + (uint32_t)run, &info).rgba, sizeof pictures[run][i]);
            assert_int_equal(info.passes, spps[i] / 8);
            assert_int_equal(info.samples, info.points * spps[i]);
            destroy_setup(&s);
        }
    double errors[3] = {0};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < PIXELS * 4; k++)
            errors[i] += pow((double)(pictures[0][i][k] - pictures[1][i][k]), 2);
    print_message("squared difference of two seeds at 8, 128, 2048 spp: %.3g %.3g %.3g\n", errors[0], errors[1],
                  errors[2]);
    /* 16 and 256 times the samples should leave 1/16 and 1/256 of the variance. All pixels share the pools, so that
     * their errors go together and the sum over pixels is known to a factor of about four only. */
    assert_true(errors[1] < errors[0] / 4);
    assert_true(errors[2] < errors[0] / 50);
    helio_context_destroy(context);
}

static void camera_samples_smooth_edges_and_share_passes(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s =
        make_setup(context, make_sphere, &white, HELIO_GROUND_NONE, map,
                   (helio_renderer_desc){
                       .strategy = HELIO_STRATEGY_FACE_BRDF, .spp = 16, .aa = 20, .background = HELIO_BACKGROUND_NONE});
    helio_frame_info info;
    helio_picture picture = render(&s, 0, &info);
    assert_int_equal(info.passes, 3); /* 8 camera samples of 16 fit in one eighth of 1024 */
    int partial = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_float_equal(picture.rgba[i * 4 + 3], picture.object[i], 1e-6f);
        partial += picture.object[i] > 0.0f && picture.object[i] < 1.0f;
    }
    assert_true(partial > 40 && partial < PIXELS / 4);
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* The supplement's Figure 1, as a test: along a row of pixels over a sphere under a low sun, the noise of neighbouring
 * pixels differs by a step where the sun's face dips below the horizon, unless beta fades its samples out. */
static void beta_leaves_no_step_in_the_noise(void **state)
{
    (void)state;
    enum { SEEDS = 400 };
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_map(map, 0.5f, 0.5f, 0.5f);
    map[7][16][0] = map[7][16][1] = map[7][16][2] = 600.0f; /* low, towards +Z: most of the light */
    double steps[2];
    for (int no_beta = 0; no_beta < 2; no_beta++) {
        setup s = make_setup(context, make_sphere, &white, HELIO_GROUND_NONE, map,
                             (helio_renderer_desc){.strategy = HELIO_STRATEGY_FACE,
                                                   .spp = 16,
                                                   .width = 96,
                                                   .height = 32,
                                                   .no_visibility = true,
                                                   .no_beta = no_beta});
        /* From behind and the side: in the middle of the row is the normal whose horizon the face +Z just touches. */
        assert_ok(helio_camera_parse("lookat:eye=-8,1,-8,at=0,1,0,fov=1.07", s.mesh, 3.0f, &s.camera));
        double sum[96] = {0}, sum2[96] = {0};
        for (uint32_t seed = 0; seed < SEEDS; seed++) {
            helio_picture picture = render(&s, seed, NULL);
            for (int x = 0; x < 96; x++) {
                double light = (double)picture.rgba[(16 * 96 + x) * 4];
                sum[x] += light;
                sum2[x] += light * light;
            }
        }
        steps[no_beta] = 0;
        for (int x = 4; x <= 92; x++) { /* compares means over four pixels, 1.6 degrees, on either side */
            double left = 0, right = 0;
            for (int i = 1; i <= 4; i++) {
                left += sqrt(sum2[x - i] / SEEDS - pow(sum[x - i] / SEEDS, 2)) / 4;
                right += sqrt(sum2[x + i - 1] / SEEDS - pow(sum[x + i - 1] / SEEDS, 2)) / 4;
            }
            steps[no_beta] = fmax(steps[no_beta], fabs(log(left / right)));
        }
        destroy_setup(&s);
    }
    print_message("largest step of the noise: factor %.2f with beta, %.2f without\n", exp(steps[0]), exp(steps[1]));
    assert_true(exp(steps[0]) < 1.5);
    assert_true(exp(steps[1]) > 1.8);
    helio_context_destroy(context);
}

/* ---- shadows and alpha ---- */

static float alpha_at(const helio_picture *picture, int x, int y)
{
    return picture->rgba[(y * WIDTH + x) * 4 + 3];
}

static void the_plane_is_darker_where_the_box_hides_the_sun(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map); /* the sun stands towards +Z and +X, so the shadow falls towards -Z and -X */
    setup s = make_setup(context, make_box, &white, HELIO_GROUND_PLANE, map, (helio_renderer_desc){.spp = 128});
    assert_ok(helio_camera_parse("lookat:eye=0,12,0.01,at=0,0,0,fov=60", s.mesh, (float)WIDTH / HEIGHT, &s.camera));
    helio_picture picture = render(&s, 0, NULL);
    /* From above: x to the right is +X, y down is +Z. The box fills the middle, the plane everything else. */
    int middle = (HEIGHT / 2 * WIDTH + WIDTH / 2) * 4, sunny = ((HEIGHT / 2 + 14) * WIDTH + WIDTH / 2) * 4;
    int shaded = ((HEIGHT / 2 - 9) * WIDTH + WIDTH / 2 - 4) * 4;
    assert_float_equal(picture.object[middle / 4], 1.0f, 0.0f);
    assert_float_equal(picture.object[sunny / 4], 0.0f, 0.0f);
    assert_true(picture.rgba[shaded] < 0.3f * picture.rgba[sunny]);
    assert_true(picture.rgba[shaded] > 0.0f);
    destroy_setup(&s);
    helio_context_destroy(context);
}

static void the_shadow_catcher_keeps_only_the_shadow(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s = make_setup(context, make_box, &white, HELIO_GROUND_SHADOW, map, (helio_renderer_desc){.spp = 128});
    assert_ok(helio_camera_parse("lookat:eye=0,12,0.01,at=0,0,0,fov=60", s.mesh, (float)WIDTH / HEIGHT, &s.camera));
    helio_picture picture = render(&s, 0, NULL);
    int shaded = (HEIGHT / 2 - 9) * WIDTH + WIDTH / 2 - 4;
    assert_float_equal(alpha_at(&picture, WIDTH / 2, HEIGHT / 2), 1.0f, 0.0f); /* the box */
    assert_true(alpha_at(&picture, WIDTH / 2 - 4, HEIGHT / 2 - 9) > 0.6f);     /* its shadow */
    assert_true(alpha_at(&picture, WIDTH - 2, HEIGHT - 2) < 0.05f);            /* open ground */
    for (int c = 0; c < 3; c++)
        assert_float_equal(picture.rgba[shaded * 4 + c], 0.0f, 0.0f);
    assert_float_equal(picture.object[shaded], 0.0f, 0.0f);
    destroy_setup(&s);

    /* With the environment asked for, it shows through, darkened, and the picture is opaque. */
    s = make_setup(context, make_box, &white, HELIO_GROUND_SHADOW, map,
                   (helio_renderer_desc){.spp = 128, .background = HELIO_BACKGROUND_ENVIRONMENT});
    assert_ok(helio_camera_parse("lookat:eye=0,12,0.01,at=0,0,0,fov=60", s.mesh, (float)WIDTH / HEIGHT, &s.camera));
    picture = render(&s, 0, NULL);
    int open = (HEIGHT - 2) * WIDTH + WIDTH - 2;
    assert_float_equal(picture.rgba[shaded * 4 + 3], 1.0f, 0.0f);
    assert_float_equal(picture.rgba[open * 4], 0.2f, 0.01f); /* the map's brown ground, hardly darkened */
    assert_true(picture.rgba[shaded * 4] < 0.4f * picture.rgba[open * 4]);
    destroy_setup(&s);
    helio_context_destroy(context);
}

static void alpha_is_coverage_without_a_background(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s = make_setup(context, make_box, &white, HELIO_GROUND_PLANE, map,
                         (helio_renderer_desc){.spp = 16, .background = HELIO_BACKGROUND_NONE});
    assert_ok(helio_camera_parse("lookat:eye=0,1,8,at=0,1,0,fov=60", s.mesh, (float)WIDTH / HEIGHT, &s.camera));
    helio_picture picture = render(&s, 0, NULL);
    assert_float_equal(alpha_at(&picture, 2, 2), 0.0f, 0.0f); /* sky */
    assert_float_equal(picture.rgba[(2 * WIDTH + 2) * 4], 0.0f, 0.0f);
    assert_float_equal(alpha_at(&picture, WIDTH / 2, HEIGHT / 2), 1.0f, 0.0f); /* box */
    assert_float_equal(alpha_at(&picture, 2, HEIGHT - 2), 1.0f, 0.0f);         /* plane */
    assert_float_equal(picture.object[(HEIGHT - 2) * WIDTH + 2], 0.0f, 0.0f);
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* ---- axes ---- */

/* What a camera sees of the map: a pixel of each of the six directions, and what is to the right and above. */
static void the_background_shows_the_map_the_right_way_round(void **state)
{
    (void)state;
    /* Directions by OpenEXR's lat-long axes: column 16 of 32 is +Z, 8 is +X, 0 is -Z, 24 is -X; row 0 is +Y. */
    static const struct {
        const char *camera;
        int row, column;
    } views[] = {
        {"lookat:eye=0,1,0,at=0,1,9,fov=30", 7, 15},
        {"lookat:eye=0,1,0,at=9,1,0,fov=30", 7, 7},
        {"lookat:eye=0,1,0,at=0,1,-9,fov=30", 7, 31},
        {"lookat:eye=0,1,0,at=-9,1,0,fov=30", 7, 23},
    };
    helio_context *context = make_context(1, NULL);
    for (int i = 0; i < 4; i++) {
        float map[MAP_HEIGHT][MAP_WIDTH][3];
        fill_map(map, 0, 0, 0);
        map[views[i].row][views[i].column][0] =
            1.0f; /* just above the horizon, just left of the middle of the map's view */
        setup s =
            make_setup(context, make_box, &white, HELIO_GROUND_NONE, map, (helio_renderer_desc){.spp = 8, .aa = 1});
        /* The box is in the way of every view from its inside: move the eye far above it. */
        assert_ok(helio_camera_parse(views[i].camera, s.mesh, (float)WIDTH / HEIGHT, &s.camera));
        s.camera.eye[1] = s.camera.at[1] = 1000.0f;
        helio_picture picture = render(&s, 0, NULL);
        double light = 0, x = 0, y = 0;
        for (int p = 0; p < PIXELS; p++) {
            light += (double)picture.rgba[p * 4];
            x += (double)picture.rgba[p * 4] * (p % WIDTH + 0.5);
            y += (double)picture.rgba[p * 4] * (p / WIDTH + 0.5);
        }
        assert_true(light > 1.0);
        /* A camera that looks along +Z has +X at its left, as the map has: a column left of the centre is seen left.
         * The pixel is 11.25 degrees wide and high: its centre is 5.6 degrees left of the middle and 5.6 above. */
        double per_degree = HEIGHT / 30.0;
        assert_float_equal((float)(x / light), (float)(WIDTH / 2 - 5.6 * per_degree), (float)(1.5 * per_degree));
        assert_float_equal((float)(y / light), (float)(HEIGHT / 2 - 5.6 * per_degree), (float)(1.5 * per_degree));
        destroy_setup(&s);
    }
    helio_context_destroy(context);
}

static void light_comes_from_where_the_map_shows_it(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_map(map, 0, 0, 0);
    map[7][7][0] = map[7][8][0] = 100.0f; /* red from +X */
    for (int x = 0; x < MAP_WIDTH; x++)
        map[0][x][1] = 100.0f;              /* green from +Y */
    map[7][15][2] = map[7][16][2] = 100.0f; /* blue from +Z */
    setup s = make_setup(context, make_box, &white, HELIO_GROUND_NONE, map, (helio_renderer_desc){.spp = 128});
    assert_ok(helio_camera_parse("lookat:eye=8,9,8,at=0,1,0,fov=25", s.mesh, (float)WIDTH / HEIGHT, &s.camera));
    helio_picture picture = render(&s, 0, NULL);
    /* The corner (1, 2, 1) is in the middle: +Y above it, +Z to its left, +X to its right. */
    const float *top = picture.rgba + ((HEIGHT / 2 - 12) * WIDTH + WIDTH / 2) * 4;
    const float *left = picture.rgba + ((HEIGHT / 2 + 6) * WIDTH + WIDTH / 2 - 6) * 4;
    const float *right = picture.rgba + ((HEIGHT / 2 + 6) * WIDTH + WIDTH / 2 + 6) * 4;
    assert_true(right[0] > 10 * right[2] && left[2] > 10 * left[0] && top[1] > 5 * left[1] && top[1] > 5 * right[1]);
    /* A turn by 90 degrees brings the light of +Z to +X. */
    assert_ok(helio_environment_orient(s.environment, &(helio_orientation){.rotate = 90}));
    picture = render(&s, 0, NULL);
    assert_true(right[2] > 10 * right[0]);
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* ---- the interface ---- */

static void the_same_seed_gives_the_same_bits_on_any_number_of_threads(void **state)
{
    (void)state;
    static float first[PIXELS * 4];
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    const uint32_t threads[] = {1, 2, 5};
    for (int i = 0; i < 3; i++) {
        helio_context *context = make_context(threads[i], NULL);
        setup s = make_setup(context, make_sphere, &glossy, HELIO_GROUND_PLANE, map,
                             (helio_renderer_desc){.spp = 100, .aa = 3, .pool_length = 256});
        helio_picture picture = render(&s, 5, NULL);
        if (i == 0)
            memcpy(first, picture.rgba, sizeof first);
        assert_memory_equal(first, picture.rgba, sizeof first);
        picture = render(&s, 6, NULL);
        assert_memory_not_equal(first, picture.rgba, sizeof first);
        destroy_setup(&s);
        helio_context_destroy(context);
    }
}

static void update_and_render_take_no_memory(void **state)
{
    (void)state;
    memory_count count = {0};
    helio_context *context = make_context(2, &count);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s = make_setup(context, make_sphere, &glossy, HELIO_GROUND_SHADOW, map,
                         (helio_renderer_desc){.spp = 200, .aa = 2, .aovs = true});
    size_t before = count.taken;
    for (uint32_t frame = 0; frame < 3; frame++) {
        map[3][frame][0] = 50.0f;
        assert_ok(helio_environment_update(s.environment, &map[0][0][0], NULL));
        render(&s, frame, NULL);
    }
    assert_int_equal(count.taken, before);
    destroy_setup(&s);
    helio_context_destroy(context);
    assert_int_equal(count.live, 0);
}

/* Frame t is lit by the tables of frame t: after an update the picture equals that of a renderer that never saw another
 * map. */
static void every_frame_is_lit_by_its_own_map(void **state)
{
    (void)state;
    static float expected[PIXELS * 4];
    helio_context *context = make_context(2, NULL);
    float sunny[MAP_HEIGHT][MAP_WIDTH][3], grey[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(sunny);
    fill_map(grey, 0.5f, 0.5f, 0.5f);
    setup fresh = make_setup(context, make_sphere, &glossy, HELIO_GROUND_PLANE, grey, (helio_renderer_desc){.spp = 32});
    memcpy(expected, render(&fresh, 9, NULL).rgba, sizeof expected);
    destroy_setup(&fresh);
    setup s = make_setup(context, make_sphere, &glossy, HELIO_GROUND_PLANE, sunny, (helio_renderer_desc){.spp = 32});
    assert_memory_not_equal(expected, render(&s, 9, NULL).rgba, sizeof expected);
    assert_ok(helio_environment_update(s.environment, &grey[0][0][0], NULL));
    assert_memory_equal(expected, render(&s, 9, NULL).rgba, sizeof expected);
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* ---- frames that stop ---- */

/* Longer than a frame works before it tells its progress, so that each thread gets one tile done in between. */
static void run_late(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    nanosleep(&(struct timespec){.tv_nsec = 100000000}, NULL);
    for (size_t i = 0; i < count; i++)
        body(data, i);
}

enum { TILES = 3, TILE_WIDTH = 16, STRIP = TILES * TILE_WIDTH * TILE_WIDTH };

typedef struct stop {
    int calls, last_call;
    float done;
} stop;

static bool stop_at_call(void *user, float done)
{
    stop *s = user;
    assert_true(done > s->done && done <= 1.0f);
    s->done = done;
    return ++s->calls < s->last_call;
}

/* A picture of three tiles side by side, stopped at some call of the progress function. */
static helio_frame_info render_stopped(const setup *s, int last_call, float rgba[STRIP * 4])
{
    stop at = {.last_call = last_call};
    helio_frame_info info;
    helio_frame_desc desc = {.camera = s->camera, .progress = stop_at_call, .user = &at};
    assert_ok(helio_renderer_render(s->renderer, &desc, &info));
    assert_int_equal(at.calls, last_call);
    memcpy(rgba, helio_renderer_picture(s->renderer).rgba, STRIP * 4 * sizeof *rgba);
    return info;
}

/* Do `count` tiles, from the first on, hold the same bits? */
static bool same_tiles(const float *a, const float *b, int first, int count)
{
    for (int y = 0; y < TILE_WIDTH; y++) {
        size_t start = (size_t)(y * TILES + first) * TILE_WIDTH * 4;
        if (memcmp(a + start, b + start, (size_t)count * TILE_WIDTH * 4 * sizeof *a) != 0)
            return false;
    }
    return true;
}

static setup make_strip(uint32_t aa)
{
    static float map[MAP_HEIGHT][MAP_WIDTH][3];
    helio_context *context;
    assert_ok(helio_context_create(&(helio_context_desc){.threads = 1, .parallel_for = run_late}, &context));
    fill_sunny(map);
    return make_setup(context, make_sphere, &white, HELIO_GROUND_PLANE, map,
                      (helio_renderer_desc){.spp = 8, .aa = aa, .width = TILES * TILE_WIDTH, .height = TILE_WIDTH});
}

static void a_stopped_frame_holds_what_it_got(void **state)
{
    (void)state;
    static float whole[STRIP * 4], part[STRIP * 4];
    static const float nothing[STRIP * 4];
    setup s = make_strip(1);
    assert_true(render_stopped(&s, 2, part).stopped);
    assert_true(same_tiles(part, nothing, 2, 1));
    /* The hits of the last tile are not known yet: the next frame traces all again, and the one after it none. */
    helio_frame_info info;
    memcpy(whole, render(&s, 0, &info).rgba, sizeof whole);
    assert_int_equal(info.camera_rays, STRIP);
    assert_true(same_tiles(part, whole, 0, 2));
    assert_false(same_tiles(whole, nothing, 2, 1));
    assert_true(render_stopped(&s, 1, part).stopped);
    assert_true(same_tiles(part, whole, 0, 1) && same_tiles(part, nothing, 1, 2));
    render(&s, 0, &info);
    assert_int_equal(info.camera_rays, 0);
    destroy_setup(&s);
    helio_context_destroy(s.context);

    /* Two steps: after the first, then with one tile of the second. */
    static float first[STRIP * 4];
    s = make_strip(2);
    memcpy(whole, render(&s, 0, NULL).rgba, sizeof whole);
    assert_true(render_stopped(&s, 3, first).stopped);
    assert_true(render_stopped(&s, 4, part).stopped);
    assert_false(same_tiles(first, whole, 0, 1) || same_tiles(first, nothing, 0, 1));
    assert_true(same_tiles(part, whole, 0, 1) && same_tiles(part, first, 1, 2));
    assert_true(render_stopped(&s, 1, part).stopped);
    assert_true(same_tiles(part, first, 0, 1) && same_tiles(part, nothing, 1, 2));
    destroy_setup(&s);
    helio_context_destroy(s.context);
}

/* ---- hits and sums ---- */

static void hits_are_kept_while_the_camera_stays(void **state)
{
    (void)state;
    static float fresh[PIXELS * 4], moved[PIXELS * 4];
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    for (int ground = HELIO_GROUND_NONE; ground <= HELIO_GROUND_SHADOW; ground++) {
        setup s = make_setup(context, make_sphere, &glossy, (helio_ground)ground, map,
                             (helio_renderer_desc){.spp = 200, .aovs = ground == HELIO_GROUND_PLANE});
        helio_frame_info info;
        memcpy(fresh, render(&s, 3, &info).rgba, sizeof fresh);
        assert_int_equal(info.camera_rays, PIXELS);
        assert_memory_equal(fresh, render(&s, 3, &info).rgba, sizeof fresh);
        assert_int_equal(info.camera_rays, 0);
        helio_frame_desc desc = {.camera = s.camera, .seed = 3, .retrace = true};
        assert_ok(helio_renderer_render(s.renderer, &desc, &info));
        assert_int_equal(info.camera_rays, PIXELS);
        assert_memory_equal(fresh, helio_renderer_picture(s.renderer).rgba, sizeof fresh);
        s.camera.eye[0] += 0.25f;
        memcpy(moved, render(&s, 3, &info).rgba, sizeof moved);
        assert_int_equal(info.camera_rays, PIXELS);
        assert_memory_not_equal(fresh, moved, sizeof fresh);
        s.camera.eye[0] -= 0.25f;
        assert_memory_equal(fresh, render(&s, 3, &info).rgba, sizeof fresh);
        destroy_setup(&s);
    }
    setup s =
        make_setup(context, make_sphere, &glossy, HELIO_GROUND_NONE, map, (helio_renderer_desc){.spp = 8, .aa = 3});
    helio_frame_info info;
    for (int frame = 0; frame < 2; frame++) { /* each camera sample takes the place of the one before */
        render(&s, 0, &info);
        assert_int_equal(info.camera_rays, 3 * PIXELS);
    }
    destroy_setup(&s);
    helio_context_destroy(context);
}

static float largest_difference(const float *a, const float *b, int count)
{
    float largest = 0;
    for (int i = 0; i < count; i++)
        if (!(isinf(a[i]) && isinf(b[i]))) /* depth of the sky */
            largest = fmaxf(largest, fabsf(a[i] - b[i]));
    return largest;
}

/* A frame of one step writes the picture at once, one of several adds up. Where no sample is noisy, that makes no
 * difference: cosine samples of a white box before a grey sky, which casts no shadow on itself. */
static void one_step_makes_the_same_picture_as_many(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_map(map, 0.75f, 0.5f, 0.25f);
    for (int variant = 0; variant < 8; variant++) {
        helio_renderer_desc desc = {.strategy = HELIO_STRATEGY_COSINE,
                                    .pool_length = 256,
                                    .spp = 30,
                                    .aovs = variant & 1,
                                    .background = variant & 2 ? HELIO_BACKGROUND_NONE : HELIO_BACKGROUND_ENVIRONMENT,
                                    .no_visibility = true};
        helio_ground ground = variant & 4 ? HELIO_GROUND_PLANE : HELIO_GROUND_NONE;
        setup one = make_setup(context, make_box, &white, ground, map, desc);
        desc.spp = 100;
        setup many = make_setup(context, make_box, &white, ground, map, desc);
        helio_frame_info info;
        helio_picture a = render(&one, 0, &info);
        assert_int_equal(info.passes, 1);
        helio_picture b = render(&many, 0, &info);
        assert_int_equal(info.passes, 4);
        assert_true(largest_difference(a.rgba, b.rgba, 4 * PIXELS) < 1e-6f);
        assert_memory_equal(a.object, b.object, PIXELS * sizeof *a.object);
        if (desc.aovs) {
            assert_true(largest_difference(a.albedo, b.albedo, 3 * PIXELS) == 0.0f);
            assert_true(largest_difference(a.normal, b.normal, 3 * PIXELS) == 0.0f);
            assert_true(largest_difference(a.position, b.position, 3 * PIXELS) == 0.0f);
            assert_memory_equal(a.depth, b.depth, PIXELS * sizeof *a.depth);
        }
        destroy_setup(&one);
        destroy_setup(&many);
    }
    helio_context_destroy(context);
}

/* The variants of a picture that are made with sums and without: output variables must not change its light. */
static void output_variables_leave_the_picture_as_it_is(void **state)
{
    (void)state;
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    for (int background = HELIO_BACKGROUND_ENVIRONMENT; background <= HELIO_BACKGROUND_NONE; background++) {
        helio_renderer_desc desc = {.spp = 64, .background = (helio_background)background};
        setup plain = make_setup(context, make_sphere, &glossy, HELIO_GROUND_PLANE, map, desc);
        desc.aovs = true;
        setup full = make_setup(context, make_sphere, &glossy, HELIO_GROUND_PLANE, map, desc);
        helio_picture a = render(&plain, 0, NULL), b = render(&full, 0, NULL);
        assert_memory_equal(a.rgba, b.rgba, PIXELS * 4 * sizeof *a.rgba);
        assert_memory_equal(a.object, b.object, PIXELS * sizeof *a.object);
        destroy_setup(&plain);
        destroy_setup(&full);
    }
    helio_context_destroy(context);
}

/* ---- the background ---- */

/* All around, so that every edge and corner of the cube is seen. Returns the largest difference from the plain way. */
static float compare_background(const helio_environment *environment, const kernel_set *kernels, helio_camera camera,
                                float *checksum)
{
    enum { SIDE = 96 };
    camera_frame frame;
    float largest = 0;
    assert_ok(camera_frame_create(&camera, 1, &frame));
    struct background b = background_prepare(environment, kernels, &frame, SIDE, SIDE);
    for (int row = 0; row < SIDE; row++)
        for (int first = 0; first < SIDE; first += 13) { /* not a multiple of any register */
            float x[13], y[13], rgba[13][4];
            uint32_t count = first + 13 < SIDE ? 13 : (uint32_t)(SIDE - first);
            for (uint32_t i = 0; i < count; i++) {
                x[i] = (float)first + (float)i + 0.5f;
                y[i] = (float)row + 0.5f;
            }
            background_fill(&b, count, x, y, rgba);
            for (uint32_t i = 0; i < count; i++) {
                float direction[3], expected[3];
                vec3_to(camera_direction(&frame, x[i] / SIDE, y[i] / SIDE), direction);
                helio_environment_filtered(environment, direction, expected);
                largest = fmaxf(largest, largest_difference(rgba[i], expected, 3));
                assert_true(rgba[i][3] == 1.0f);
                for (int c = 0; c < 3; c++)
                    *checksum = *checksum * 0.99f + rgba[i][c];
            }
        }
    return largest;
}

static void the_background_is_that_of_the_plain_lookup(void **state)
{
    (void)state;
    static const uint32_t sizes[] = {1, 2, 3, 7, 64, 512};
    static const float views[][3] = {{1, 0.1f, 0}, {-1, 0, 0.2f}, {0.1f, 1, 0}, {0.1f, -1, 0},        {0, 0, 1},
                                     {0, 0, -1},   {1, 1, 1},     {-1, -1, 1},  {1, 0.001f, -1.001f}, {-1, 1, 0.01f}};
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    uint64_t random = 5;
    for (int i = 0; i < MAP_HEIGHT * MAP_WIDTH * 3; i++)
        (&map[0][0][0])[i] = (float)random_unit(&random);
    helio_context *context = make_context(1, NULL);
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        helio_environment *environment =
            make_environment(context, HELIO_LAYOUT_LATLONG, MAP_WIDTH, MAP_HEIGHT, sizes[k], &map[0][0][0], NULL);
        assert_ok(
            helio_environment_orient(environment, &(helio_orientation){.rotate = 33, .flip = true, .intensity = 2}));
        float largest = 0, checksums[ISA_COUNT] = {0};
        for (int set = 0; set < ISA_COUNT; set++) {
            if (!isa_is_supported((isa)set))
                continue;
            for (size_t v = 0; v < sizeof views / sizeof views[0]; v++) {
                helio_camera camera = {.up = {0, 1, 0}, .fov = v % 2 ? 100 : 20};
                memcpy(camera.at, views[v], sizeof camera.at);
                largest =
                    fmaxf(largest, compare_background(environment, kernels_of((isa)set), camera, &checksums[set]));
            }
            assert_true(checksums[set] == checksums[ISA_SCALAR]); /* the same bits, so the same sum */
        }
        print_message("cube of %u texels: background differs by at most %.1e\n", sizes[k], (double)largest);
        /* A direction is off by a few roundings, each of 6e-8, which moves it by less than 2e-7 of the face's texels;
         * neighbouring texels differ by up to 2. */
        assert_true(largest < 1e-6f + 1e-6f * (float)sizes[k]);
        helio_environment_destroy(environment);
    }
    helio_context_destroy(context);
}

static void aovs_hold_what_the_camera_meets(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s =
        make_setup(context, make_box, &glossy, HELIO_GROUND_NONE, map, (helio_renderer_desc){.spp = 8, .aovs = true});
    assert_ok(helio_camera_parse("lookat:eye=0,1,8,at=0,1,0,fov=40", s.mesh, (float)WIDTH / HEIGHT, &s.camera));
    helio_picture picture = render(&s, 0, NULL);
    int middle = HEIGHT / 2 * WIDTH + WIDTH / 2;
    assert_float_equal(picture.depth[middle], 7.0f, 1e-4f);
    assert_float_equal(picture.normal[middle * 3 + 2], 1.0f, 1e-6f);
    assert_float_equal(picture.position[middle * 3 + 2], 1.0f, 1e-5f);
    assert_float_equal(picture.albedo[middle * 3], 1.0f, 1e-6f); /* kd + ks */
    assert_true(isinf(picture.depth[0]) && picture.normal[0] == 0.0f && picture.albedo[0] == 0.0f);
    destroy_setup(&s);
    helio_context_destroy(context);
}

static void bad_descs_are_refused_with_a_sentence(void **state)
{
    (void)state;
    helio_context *context = make_context(1, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s = make_setup(context, make_box, &white, HELIO_GROUND_SHADOW, map, (helio_renderer_desc){.spp = 8});
    const helio_renderer_desc bad[] = {
        {.environment = NULL, .scene = s.scene},
        {.environment = s.environment, .scene = NULL},
        {.environment = s.environment, .scene = s.scene, .width = 20000},
        {.environment = s.environment, .scene = s.scene, .spp = 1u << 21},
        {.environment = s.environment, .scene = s.scene, .aa = 5000},
        {.environment = s.environment, .scene = s.scene, .pool_length = 1000},
        {.environment = s.environment, .scene = s.scene, .brdf_share = 1.5f},
        {.environment = s.environment, .scene = s.scene, .strategy = (helio_strategy)99},
        {.environment = s.environment, .scene = s.scene, .no_visibility = true}, /* with a shadow catcher */
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        helio_renderer *renderer = (helio_renderer *)&s;
        assert_int_equal(helio_renderer_create(context, &bad[i], &renderer), HELIO_ERR_ARGUMENT);
        assert_null(renderer);
        assert_true(strlen(helio_last_error()) > 20);
    }
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* ---- stored references ---- */

/* Pictures of 32 x 24 pixels at 65,536 spp, made by HELIO_WRITE_REFERENCES=1 test_render and looked at. */
enum { REFERENCE_WIDTH = 32, REFERENCE_HEIGHT = 24 };

static void compare_with_reference(const char *name, mesh_maker make_mesh, const helio_material *material,
                                   helio_strategy strategy, double tolerance)
{
    const char *folder = getenv("HELIO_TEST_FILES");
    bool write = getenv("HELIO_WRITE_REFERENCES") != NULL;
    char path[TEST_PATH_SIZE];
    if (folder == NULL) {
        print_message("skipped: HELIO_TEST_FILES does not name the folder of references\n");
        skip();
    }
    snprintf(path, sizeof path, "%s/reference-%s.pfm", folder, name);
    helio_context *context = make_context(2, NULL);
    float map[MAP_HEIGHT][MAP_WIDTH][3];
    fill_sunny(map);
    setup s = make_setup(
        context, make_mesh, material, HELIO_GROUND_PLANE, map,
        (helio_renderer_desc){
            .width = REFERENCE_WIDTH, .height = REFERENCE_HEIGHT, .strategy = strategy, .spp = write ? 65536 : 64});
    helio_picture picture = render(&s, 1, NULL);
    if (write)
        assert_ok(helio_picture_write(context, path, &picture, NULL));
    helio_image *reference;
    assert_ok(helio_image_read(context, path, NULL, &reference));
    assert_int_equal(reference->width, REFERENCE_WIDTH);
    assert_int_equal(reference->height, REFERENCE_HEIGHT);
    double error = 0, power = 0;
    for (int i = 0; i < REFERENCE_WIDTH * REFERENCE_HEIGHT; i++)
        for (int c = 0; c < 3; c++) {
            double exact = (double)reference->rgb[i * 3 + c];
            error += pow((double)picture.rgba[i * 4 + c] - exact, 2);
            power += exact * exact;
        }
    print_message("%s, %s: error %.2e of the picture's power\n", name, helio_strategy_name(strategy), error / power);
    assert_true(error / power < tolerance);
    helio_image_destroy(context, reference);
    destroy_setup(&s);
    helio_context_destroy(context);
}

/* Tolerances are about three times what 64 spp give; a wrong factor, axis or shadow is off by far more. */
static void sphere_matches_its_reference(void **state)
{
    (void)state;
    compare_with_reference("sphere-matte", make_sphere, &white, HELIO_STRATEGY_FACE, 3e-3);
    compare_with_reference("sphere-matte", make_sphere, &white, HELIO_STRATEGY_LIGHT_BRDF, 3e-3);
    compare_with_reference("sphere-glossy", make_sphere, &glossy, HELIO_STRATEGY_FACE_BRDF, 3e-3);
    compare_with_reference("sphere-metal", make_sphere, &metal, HELIO_STRATEGY_FACE_BRDF, 3e-3);
}

static void box_matches_its_reference(void **state)
{
    (void)state;
    compare_with_reference("box-glossy", make_box, &glossy, HELIO_STRATEGY_FACE_BRDF, 3e-3);
    compare_with_reference("box-glossy", make_box, &glossy, HELIO_STRATEGY_LIGHT, 3e-2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_box_vanishes_in_a_furnace),
        cmocka_unit_test(all_strategies_agree_with_shadows_on_each_material),
        cmocka_unit_test(samples_beyond_the_pools_take_more_passes_and_converge),
        cmocka_unit_test(camera_samples_smooth_edges_and_share_passes),
        cmocka_unit_test(beta_leaves_no_step_in_the_noise),
        cmocka_unit_test(the_plane_is_darker_where_the_box_hides_the_sun),
        cmocka_unit_test(the_shadow_catcher_keeps_only_the_shadow),
        cmocka_unit_test(alpha_is_coverage_without_a_background),
        cmocka_unit_test(the_background_shows_the_map_the_right_way_round),
        cmocka_unit_test(light_comes_from_where_the_map_shows_it),
        cmocka_unit_test(the_same_seed_gives_the_same_bits_on_any_number_of_threads),
        cmocka_unit_test(update_and_render_take_no_memory),
        cmocka_unit_test(every_frame_is_lit_by_its_own_map),
        cmocka_unit_test(a_stopped_frame_holds_what_it_got),
        cmocka_unit_test(hits_are_kept_while_the_camera_stays),
        cmocka_unit_test(one_step_makes_the_same_picture_as_many),
        cmocka_unit_test(output_variables_leave_the_picture_as_it_is),
        cmocka_unit_test(the_background_is_that_of_the_plain_lookup),
        cmocka_unit_test(aovs_hold_what_the_camera_meets),
        cmocka_unit_test(bad_descs_are_refused_with_a_sentence),
        cmocka_unit_test(sphere_matches_its_reference),
        cmocka_unit_test(box_matches_its_reference),
    };
    return cmocka_run_group_tests_name("render", tests, NULL, NULL);
}
