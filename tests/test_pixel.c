/* SPDX-License-Identifier: MIT
 *
 * What the library tells of a single pixel: the pools, the samples of them that it takes, the point and its estimate.
 * By the public interface alone. */
#include "support.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <string.h>

enum { SIZE = 16, MAP_FLOATS = 6 * SIZE * SIZE * 3, MOST_SAMPLES = 128 };

/* ---- what is lit ------------------------------------------------------------------------------- */

/* A ground without light, a sky, and a sun in two texels of +Z, 45 degrees high. As a strip. */
static void fill_sunny(float map[MAP_FLOATS])
{
    for (int i = 0; i < MAP_FLOATS / 3; i++) {
        int face = i / (SIZE * SIZE), row = i / SIZE % SIZE, column = i % SIZE;
        bool is_sky = face == 2 || (face != 3 && row < SIZE / 2);
        bool is_sun = face == 4 && row == 1 && (column == 8 || column == 9);
        for (int c = 0; c < 3; c++)
            map[3 * i + c] = is_sun ? 3000.0f : is_sky ? 0.5f + 0.25f * (float)c : 0.0f;
    }
}

/* A tent: two slopes that meet above, with normals that are bent away from them, and a third triangle that stands
 * beside it and shades it. */
static helio_mesh *make_tent(helio_context *context)
{
    static const float positions[9][3] = {{-1, 0, 1},  {1, 0, 1},   {0, 1, 0},      {1, 0, -1},  {-1, 0, -1},
                                          {0, 1, 0.0}, {-2, 0, .5}, {-1.2f, 2, .5}, {-1, 0, -.5}};
    static const float normals[9][3] = {{-0.6f, 0, 0.8f}, {0.6f, 0, 0.8f},   {0, 1, 0},
                                        {0.6f, 0, -0.8f}, {-0.6f, 0, -0.8f}, {0, 1, 0},
                                        {1, 0, 0},        {1, 0, 0},         {1, 0, 0}};
    static const uint32_t triangles[3][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
    const helio_mesh_desc desc = {.vertex_count = 9,
                                  .triangle_count = 3,
                                  .positions = positions[0],
                                  .normals = normals[0],
                                  .triangles = triangles[0]};
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    return mesh;
}

static const helio_material materials[] = {
    {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.6f, 0.4f}},
    {.kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.4f, 0.4f, 0.5f}, .exponent = 120},
    {.kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 0.8f, 0.3f}, .metallic = 0.5f, .roughness = 0.3f},
};
enum { MATERIALS = sizeof materials / sizeof materials[0] };

typedef struct setup {
    helio_context *context;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_environment *environment;
    helio_renderer *renderer;
    helio_frame_desc frame;
} setup;

/* Odd sizes, so that there are tiles of all kinds at the edges. Takes the context. */
static setup make_setup_in(helio_context *context, const helio_material *material, helio_ground ground,
                           helio_renderer_desc desc)
{
    static float map[MAP_FLOATS];
    fill_sunny(map);
    setup s = {.context = context};
    s.mesh = make_tent(s.context);
    s.environment = make_environment(s.context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, map, NULL);
    const helio_orientation turned = {.rotate = 25, .flip = true, .intensity = 1.5f};
    assert_ok(helio_environment_orient(s.environment, &turned));
    const helio_scene_desc scene = {.mesh = s.mesh, .material = material, .ground = ground};
    assert_ok(helio_scene_create(s.context, &scene, &s.scene));
    desc.environment = s.environment;
    desc.scene = s.scene;
    desc.width = 57;
    desc.height = 35;
    assert_ok(helio_renderer_create(s.context, &desc, &s.renderer));
    assert_ok(helio_camera_parse("orbit:azimuth=20,elevation=8,distance=0.8", s.mesh, 57.0f / 35.0f, &s.frame.camera));
    s.frame.seed = 7;
    return s;
}

static setup make_setup(const helio_material *material, helio_ground ground, helio_renderer_desc desc)
{
    return make_setup_in(make_context(2, NULL), material, ground, desc);
}

static void destroy_setup(setup *s)
{
    helio_renderer_destroy(s->renderer);
    helio_scene_destroy(s->scene);
    helio_environment_destroy(s->environment);
    helio_mesh_destroy(s->context, s->mesh);
    helio_context_destroy(s->context);
}

static helio_pixel_step look(setup *s, uint32_t x, uint32_t y, uint32_t step)
{
    helio_pixel_step pixel;
    assert_ok(helio_renderer_pixel(s->renderer, &s->frame, x, y, step, &pixel));
    return pixel;
}

/* ---- a pixel is what the renderer makes of it ---------------------------------------------------- */

/* Adds the samples that contribute, those in the shadow left out; as many rays at once as the library asks for. */
static void add_gathered(const helio_pools *pools, const helio_pixel_step *pixel, double sum[3])
{
    helio_sample samples[MOST_SAMPLES];
    float x[MOST_SAMPLES], y[MOST_SAMPLES], z[MOST_SAMPLES];
    uint32_t rays[MOST_SAMPLES], count, ray_count = 0;
    bool visible[MOST_SAMPLES];
    assert_in_range(pixel->estimate.samples, 1, MOST_SAMPLES);
    assert_ok(helio_gather(pools, &pixel->point, &pixel->estimate, samples, &count));
    helio_counts counts;
    assert_ok(helio_count(pools, &pixel->point, &pixel->estimate, &counts));
    for (int c = 0; c < 3; c++)
        sum[c] += (double)counts.control[c];
    for (uint32_t i = 0; i < count; i++) {
        const float *rgb = samples[i].contribution;
        if (rgb[0] != 0 || rgb[1] != 0 || rgb[2] != 0) {
            x[ray_count] = samples[i].direction[0];
            y[ray_count] = samples[i].direction[1];
            z[ray_count] = samples[i].direction[2];
            visible[ray_count] = true;
            rays[ray_count++] = i;
        }
    }
    for (uint32_t first = 0; pixel->estimate.visibility != NULL && first < ray_count; first += 64)
        pixel->estimate.visibility(pixel->estimate.user, &pixel->point, ray_count - first < 64 ? ray_count - first : 64,
                                   x + first, y + first, z + first, visible + first);
    for (uint32_t i = 0; i < ray_count; i++)
        for (int c = 0; visible[i] && c < 3; c++)
            sum[c] += (double)samples[rays[i]].contribution[c];
}

/* Sums of floats in another order, over up to 128 samples of one sign: some roundings of 6e-8 each. */
static const double ROUNDING = 2e-5;

static void assert_close(const float *pixel, const double *sum)
{
    double greatest = fmax(fabs(sum[0]), fmax(fabs(sum[1]), fabs(sum[2])));
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)pixel[c] - sum[c]) <= ROUNDING * greatest))
            fail_msg("channel %d of the picture is %.9g, of the pixel's steps %.9g", c, (double)pixel[c], sum[c]);
}

/* Compares a pixel of the picture with the estimates of its steps. Returns what it hit in the first. */
static helio_hit check_pixel(setup *s, const helio_picture *picture, uint32_t x, uint32_t y)
{
    const float *rgba = picture->rgba + 4 * ((size_t)y * picture->width + x);
    uint32_t steps = helio_renderer_steps(s->renderer), object_steps = 0;
    double estimates[3] = {0}, gathered[3] = {0}, weight = 0;
    helio_hit hit = HELIO_HIT_NOTHING;
    for (uint32_t step = 0; step < steps; step++) {
        helio_pixel_step pixel = look(s, x, y, step);
        hit = step == 0 ? pixel.hit : hit;
        weight += pixel.estimate.samples;
        object_steps += pixel.hit == HELIO_HIT_OBJECT;
        if (pixel.hit == HELIO_HIT_NOTHING || pixel.hit == HELIO_HIT_CATCHER)
            continue;
        float radiance[3];
        double sum[3] = {0};
        const helio_pools *pools = helio_renderer_pools(s->renderer);
        assert_ok(helio_estimate(pools, &pixel.point, &pixel.estimate, radiance, NULL));
        add_gathered(pools, &pixel, sum);
        for (int c = 0; c < 3; c++) {
            estimates[c] += (double)radiance[c] * pixel.estimate.samples;
            gathered[c] += sum[c] * pixel.estimate.samples;
        }
    }
    for (int c = 0; c < 3; c++) {
        estimates[c] /= weight;
        gathered[c] /= weight;
    }
    assert_float_equal(picture->object[(size_t)y * picture->width + x], (double)object_steps / steps, 1e-6);
    if (object_steps == steps || (steps == 1 && hit == HELIO_HIT_PLANE)) {
        assert_close(rgba, estimates);
        assert_close(rgba, gathered);
    }
    return hit;
}

/* Of all rows and columns of the tiles, in turn. */
static void check_pixels(setup *s, uint32_t hits[4])
{
    assert_ok(helio_renderer_render(s->renderer, &s->frame, NULL));
    const helio_picture picture = helio_renderer_picture(s->renderer);
    for (uint32_t y = 0; y < picture.height; y++)
        for (uint32_t x = y % 5; x < picture.width; x += 5)
            hits[check_pixel(s, &picture, x, y)]++;
}

static void the_samples_of_a_pixel_sum_to_the_picture(void **state)
{
    (void)state;
    static const helio_strategy strategies[] = {
        HELIO_STRATEGY_FACE,    HELIO_STRATEGY_FACE_BRDF,    HELIO_STRATEGY_LIGHT,
        HELIO_STRATEGY_COSINE,  HELIO_STRATEGY_LIGHT_BRDF,   HELIO_STRATEGY_BRDF,
        HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF, HELIO_STRATEGY_PRODUCT_BRDF};
    for (size_t i = 0; i < sizeof strategies / sizeof strategies[0]; i++) {
        const helio_renderer_desc desc = {.strategy = strategies[i],
                                          .spp = 24,
                                          .no_visibility = i == 2 || i == 8,
                                          .no_beta = i == 1,
                                          .no_decorrelation = i == 0,
                                          .brdf_share = 0.25f};
        uint32_t hits[4] = {0};
        setup s = make_setup(&materials[i % MATERIALS], i & 1 ? HELIO_GROUND_PLANE : HELIO_GROUND_NONE, desc);
        assert_int_equal(helio_renderer_steps(s.renderer), 1);
        check_pixels(&s, hits);
        assert_true(hits[HELIO_HIT_OBJECT] > 40 && hits[HELIO_HIT_NOTHING] > 20);
        assert_true(i & 1 ? hits[HELIO_HIT_PLANE] > 40 : hits[HELIO_HIT_PLANE] == 0);
        destroy_setup(&s);
    }
}

static void the_steps_of_a_pixel_average_to_the_picture(void **state)
{
    (void)state;
    static const helio_renderer_desc descs[] = {
        {.strategy = HELIO_STRATEGY_FACE_BRDF, .spp = 20, .pool_length = 64}, /* three parts, with pools of their own */
        {.spp = 8, .aa = 3}, /* three camera samples that share pools */
        {.strategy = HELIO_STRATEGY_FACE_BRDF, .spp = 11, .aa = 2, .pool_length = 64}, /* both */
        {.spp = 9, .strategy = HELIO_STRATEGY_BRDF, .aa = 2, .pool_length = 64},
    };
    static const uint32_t steps[] = {3, 3, 4, 4};
    for (size_t i = 0; i < sizeof descs / sizeof descs[0]; i++) {
        uint32_t hits[4] = {0};
        setup s = make_setup(&materials[i % MATERIALS], i == 1 ? HELIO_GROUND_SHADOW : HELIO_GROUND_NONE, descs[i]);
        assert_int_equal(helio_renderer_steps(s.renderer), steps[i]);
        check_pixels(&s, hits);
        assert_true(hits[HELIO_HIT_OBJECT] > 40);
        assert_true(i == 1 ? hits[HELIO_HIT_CATCHER] > 40 : hits[HELIO_HIT_CATCHER] == 0);
        destroy_setup(&s);
    }
}

static bool is_same(const helio_pixel_step *a, const helio_pixel_step *b)
{
    const helio_shading_point *p = &a->point, *q = &b->point;
    return a->hit == b->hit && p->seed == q->seed && memcmp(p->position, q->position, sizeof p->position) == 0 &&
           memcmp(p->normal, q->normal, sizeof p->normal) == 0 && memcmp(p->view, q->view, sizeof p->view) == 0 &&
           memcmp(p->geometric_normal, q->geometric_normal, sizeof p->normal) == 0;
}

/* The same bits before the first picture, after it, after one of another camera, and for another new frame. */
static void a_pixel_does_not_depend_on_what_was_rendered(void **state)
{
    (void)state;
    enum { X = 33, Y = 24 };
    static float map[MAP_FLOATS];
    fill_sunny(map);
    setup s = make_setup(&materials[1], HELIO_GROUND_PLANE, (helio_renderer_desc){.spp = 16});
    helio_pixel_step first = look(&s, X, Y, 0);
    float before[3], after[3];
    assert_int_equal(first.hit, HELIO_HIT_OBJECT);
    assert_ok(helio_estimate(helio_renderer_pools(s.renderer), &first.point, &first.estimate, before, NULL));
    assert_ok(helio_renderer_render(s.renderer, &s.frame, NULL));
    helio_pixel_step second = look(&s, X, Y, 0);
    helio_frame_desc moved = s.frame;
    moved.camera.eye[0] += 0.5f;
    assert_ok(helio_renderer_render(s.renderer, &moved, NULL));
    helio_pixel_step third = look(&s, X, Y, 0);
    assert_ok(helio_environment_update(s.environment, map, NULL));
    helio_pixel_step fourth = look(&s, X, Y, 0);
    assert_ok(helio_estimate(helio_renderer_pools(s.renderer), &fourth.point, &fourth.estimate, after, NULL));
    assert_true(is_same(&first, &second) && is_same(&first, &third) && is_same(&first, &fourth));
    assert_memory_equal(before, after, sizeof before);
    /* Looking moves nothing: the next picture of the other camera is as before, and so are the tables. */
    assert_ok(helio_renderer_render(s.renderer, &moved, NULL));
    helio_picture picture = helio_renderer_picture(s.renderer);
    float kept[4];
    memcpy(kept, picture.rgba + 4 * (Y * picture.width + X), sizeof kept);
    look(&s, X, Y, 0);
    assert_memory_equal(kept, picture.rgba + 4 * (Y * picture.width + X), sizeof kept);
    assert_ok(helio_renderer_render(s.renderer, &moved, NULL));
    assert_memory_equal(kept, picture.rgba + 4 * (Y * picture.width + X), sizeof kept);
    destroy_setup(&s);
}

static void looking_takes_no_memory(void **state)
{
    (void)state;
    memory_count memory = {0};
    setup s = make_setup_in(make_context(2, &memory), &materials[0], HELIO_GROUND_PLANE,
                            (helio_renderer_desc){.spp = 20, .aa = 2, .pool_length = 64});
    helio_pixel_step pixel = look(&s, 33, 24, 0);
    size_t taken = memory.taken;
    helio_sample samples[MOST_SAMPLES];
    helio_pool_sample pooled[8];
    uint32_t count;
    for (uint32_t step = 0; step < helio_renderer_steps(s.renderer); step++) {
        pixel = look(&s, 33, 24, step);
        assert_ok(helio_gather(helio_renderer_pools(s.renderer), &pixel.point, &pixel.estimate, samples, &count));
        assert_ok(helio_pools_read(helio_renderer_pools(s.renderer), 5, 0, 8, pooled));
    }
    assert_int_equal(memory.taken, taken);
    destroy_setup(&s);
    assert_int_equal(memory.live, 0);
}

static void what_is_hit_is_told(void **state)
{
    (void)state;
    setup s = make_setup(&materials[0], HELIO_GROUND_NONE, (helio_renderer_desc){.spp = 4});
    helio_pixel_step pixel = look(&s, 0, 0, 0);
    static const helio_shading_point nothing;
    assert_int_equal(pixel.hit, HELIO_HIT_NOTHING);
    assert_memory_equal(pixel.point.normal, nothing.normal, sizeof nothing.normal);
    pixel = look(&s, 33, 24, 0);
    assert_int_equal(pixel.hit, HELIO_HIT_OBJECT);
    assert_int_equal(pixel.estimate.samples, 4);
    assert_non_null(pixel.estimate.visibility);
    assert_memory_equal(&pixel.point.material, &materials[0], sizeof materials[0]);
    destroy_setup(&s);
}

static void assert_refused(helio_status status, const char *word)
{
    assert_int_equal(status, HELIO_ERR_ARGUMENT);
    if (strstr(helio_last_error(), word) == NULL)
        fail_msg("no \"%s\" in: %s", word, helio_last_error());
}

static void pixels_that_are_not_there_are_refused(void **state)
{
    (void)state;
    setup s = make_setup(&materials[0], HELIO_GROUND_NONE, (helio_renderer_desc){.spp = 4});
    helio_pixel_step pixel = {.hit = HELIO_HIT_PLANE};
    assert_refused(helio_renderer_pixel(s.renderer, &s.frame, 57, 0, 0, &pixel), "57x35");
    assert_refused(helio_renderer_pixel(s.renderer, &s.frame, 0, 35, 0, &pixel), "outside");
    assert_refused(helio_renderer_pixel(s.renderer, &s.frame, 0, 0, 1, &pixel), "no step 1");
    assert_refused(helio_renderer_pixel(NULL, &s.frame, 0, 0, 0, &pixel), "needs a renderer");
    assert_refused(helio_renderer_pixel(s.renderer, NULL, 0, 0, 0, &pixel), "needs a renderer");
    assert_refused(helio_renderer_pixel(s.renderer, &s.frame, 0, 0, 0, NULL), "needs a renderer");
    assert_int_equal(pixel.hit, HELIO_HIT_PLANE);
    helio_environment *empty;
    helio_renderer *renderer;
    assert_ok(helio_environment_create(s.context, &(helio_environment_desc){.cube_size = SIZE}, &empty));
    const helio_renderer_desc desc = {.environment = empty, .scene = s.scene, .width = 8, .height = 8};
    assert_ok(helio_renderer_create(s.context, &desc, &renderer));
    assert_int_equal(helio_renderer_pixel(renderer, &s.frame, 0, 0, 0, &pixel), HELIO_ERR_ARGUMENT); /* no frame yet */
    helio_renderer_destroy(renderer);
    helio_environment_destroy(empty);
    destroy_setup(&s);
}

/* ---- what is taken comes from the pools ------------------------------------------------------------ */

/* The direction of a pool's sample is in the map's space, that of a point's in the world's: both are turned to the
 * map's, where they may differ by the roundings of that. */
static void assert_is_sample(const helio_environment *environment, const helio_pool_sample *pooled,
                             const helio_sample *taken)
{
    float direction[3], radiance[3];
    helio_environment_to_map(environment, taken->direction, direction);
    for (int c = 0; c < 3; c++)
        assert_float_equal(direction[c], pooled->direction[c], 3e-7f);
    helio_environment_radiance(environment, taken->direction, radiance);
    for (int c = 0; c < 3; c++)
        assert_float_equal(radiance[c], 1.5f * pooled->radiance[c], 1e-3f);
}

static void check_membership(const setup *s, const helio_pixel_step *pixel)
{
    const helio_pools *pools = helio_renderer_pools(s->renderer);
    helio_sample samples[MOST_SAMPLES];
    helio_counts counts;
    uint32_t count, at = 0;
    assert_ok(helio_count(pools, &pixel->point, &pixel->estimate, &counts));
    assert_ok(helio_gather(pools, &pixel->point, &pixel->estimate, samples, &count));
    for (uint32_t k = 0; k < 7; k++) {
        bool has_pool = k < helio_pools_techniques(pools);
        assert_true(has_pool || counts.first[k] == 0);
        assert_true(counts.realised[k] > 0 || counts.first[k] == 0);
        for (uint32_t i = 0; i < counts.realised[k]; i++, at++) {
            assert_int_equal(samples[at].technique, k);
            helio_pool_sample pooled;
            if (!has_pool)
                continue;
            if (counts.pool[k] != HELIO_POOL_OF_TILES)
                assert_int_equal(samples[at].number, counts.first[k] + i);
            assert_ok(helio_pools_read(pools, counts.pool[k], samples[at].number, 1, &pooled));
            assert_is_sample(s->environment, &pooled, &samples[at]);
        }
    }
    assert_int_equal(at, count);
}

static void samples_of_a_point_are_members_of_the_pools(void **state)
{
    (void)state;
    static const helio_strategy strategies[] = {
        HELIO_STRATEGY_FACE,    HELIO_STRATEGY_FACE_BRDF,    HELIO_STRATEGY_LIGHT,       HELIO_STRATEGY_COSINE,
        HELIO_STRATEGY_PRODUCT, HELIO_STRATEGY_PRODUCT_BRDF, HELIO_STRATEGY_PRODUCT_BRDF};
    static const uint32_t pools[] = {6, 6, 1, 0, 384, 384}, lengths[] = {256, 256, 6 * 256, 256, 256, 256};
    for (size_t i = 0; i < 6; i++) {
        setup s = make_setup(&materials[1], HELIO_GROUND_NONE,
                             (helio_renderer_desc){.strategy = strategies[i], .spp = 30, .pool_length = 256});
        assert_int_equal(helio_pools_count(helio_renderer_pools(s.renderer)), pools[i]);
        assert_int_equal(helio_pools_length(helio_renderer_pools(s.renderer)), lengths[i]);
        for (uint32_t x = 16; x < 42; x++) {
            helio_pixel_step pixel = look(&s, x, 24, 0);
            if (pixel.hit == HELIO_HIT_OBJECT)
                check_membership(&s, &pixel);
        }
        destroy_setup(&s);
    }
}

/* Where nothing is turned, the directions are the same bits. */
static void without_orientation_pooled_and_taken_directions_have_the_same_bits(void **state)
{
    (void)state;
    setup s =
        make_setup(&materials[0], HELIO_GROUND_NONE, (helio_renderer_desc){.strategy = HELIO_STRATEGY_FACE, .spp = 64});
    assert_ok(helio_environment_orient(s.environment, &(helio_orientation){0}));
    helio_pixel_step pixel = look(&s, 33, 24, 0);
    const helio_pools *pools = helio_renderer_pools(s.renderer);
    helio_sample samples[64];
    helio_counts counts;
    uint32_t count, at = 0;
    assert_ok(helio_count(pools, &pixel.point, &pixel.estimate, &counts));
    assert_ok(helio_gather(pools, &pixel.point, &pixel.estimate, samples, &count));
    assert_int_equal(count, 64);
    for (uint32_t k = 0; k < 6; k++) {
        helio_pool_sample pooled[64];
        assert_ok(helio_pools_read(pools, k, counts.first[k], counts.realised[k], pooled));
        for (uint32_t i = 0; i < counts.realised[k]; i++, at++)
            assert_memory_equal(pooled[i].direction, samples[at].direction, sizeof pooled[i].direction);
    }
    destroy_setup(&s);
}

/* What is read is what the tables say of its direction. */
static void pools_read_as_the_tables_have_them(void **state)
{
    (void)state;
    static float map[MAP_FLOATS];
    fill_sunny(map);
    helio_context *context = make_context(1, NULL);
    helio_environment *environment = make_environment(context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, map, NULL);
    helio_tables *tables;
    helio_pools *pools;
    static helio_pool_sample samples[256];
    assert_ok(helio_tables_create(environment, HELIO_WEIGHTING_SOLID_ANGLE, &tables));
    assert_ok(helio_tables_update(tables));
    assert_ok(helio_pools_create(tables, &(helio_pools_desc){.strategy = HELIO_STRATEGY_FACE, .length = 256}, &pools));
    assert_refused(helio_pools_read(pools, 0, 0, 1, samples), "helio_pools_draw");
    assert_ok(helio_pools_draw(pools, 1, 0));
    for (uint32_t pool = 0; pool < 6; pool++) {
        assert_ok(helio_pools_read(pools, pool, 0, 256, samples));
        for (uint32_t i = 0; i < 256; i++) {
            uint32_t face = 0;
            float radiance[3], density = helio_tables_density(tables, samples[i].direction, &face);
            if (pool == 3) { /* the ground is black */
                assert_true(samples[i].density == 0.0f);
                continue;
            }
            helio_environment_radiance(environment, samples[i].direction, radiance);
            assert_int_equal(face, pool);
            assert_memory_equal(radiance, samples[i].radiance, sizeof radiance);
            assert_float_equal(density, samples[i].density, 1e-5f * density); /* (u, v) come back from the direction */
        }
    }
    helio_pool_sample one;
    assert_ok(helio_pools_read(pools, 4, 255, 1, &one));
    assert_ok(helio_pools_read(pools, 4, 0, 256, samples));
    assert_memory_equal(&one, &samples[255], sizeof one);
    assert_refused(helio_pools_read(pools, 6, 0, 1, samples), "no pool 6");
    assert_refused(helio_pools_read(pools, 0, 256, 1, samples), "256");
    assert_refused(helio_pools_read(pools, 0, 1, UINT32_MAX, samples), "it has 256");
    assert_refused(helio_pools_read(NULL, 0, 0, 1, samples), "needs pools");
    assert_refused(helio_pools_read(pools, 0, 0, 1, NULL), "needs pools");
    helio_pools_destroy(pools);
    helio_tables_destroy(tables);
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

/* ---- the map's space --------------------------------------------------------------------------------- */

/* The light that a world direction gets is that of the cube's texel in the direction of the map. */
static void world_directions_become_those_of_the_map(void **state)
{
    (void)state;
    static float map[MAP_FLOATS];
    fill_sunny(map);
    helio_context *context = make_context(1, NULL);
    helio_environment *environment = make_environment(context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, map, NULL);
    uint64_t random = 3;
    const float world[3] = {0.6f, 0.0f, 0.8f};
    float turned[3];
    assert_ok(helio_environment_orient(environment, &(helio_orientation){.rotate = 90})); /* +Z is seen at +X */
    helio_environment_to_map(environment, world, turned);
    assert_float_equal(turned[2], 0.6f, 1e-6f);
    assert_float_equal(turned[0], -0.8f, 1e-6f);
    for (int i = 0; i < 1000; i++) {
        const helio_orientation orientation = {.rotate = (float)(360 * random_unit(&random)), .flip = i & 1};
        float direction[3], in_map[3], there[3], here[3];
        for (int c = 0; c < 3; c++)
            direction[c] = (float)(2 * random_unit(&random) - 1);
        assert_ok(helio_environment_orient(environment, &orientation));
        helio_environment_to_map(environment, direction, in_map);
        helio_environment_radiance(environment, direction, there);
        assert_ok(helio_environment_orient(environment, &(helio_orientation){0}));
        helio_environment_radiance(environment, in_map, here);
        assert_memory_equal(here, there, sizeof here);
    }
    helio_environment_destroy(environment);
    helio_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pools_read_as_the_tables_have_them),
        cmocka_unit_test(world_directions_become_those_of_the_map),
        cmocka_unit_test(the_samples_of_a_pixel_sum_to_the_picture),
        cmocka_unit_test(the_steps_of_a_pixel_average_to_the_picture),
        cmocka_unit_test(a_pixel_does_not_depend_on_what_was_rendered),
        cmocka_unit_test(looking_takes_no_memory),
        cmocka_unit_test(what_is_hit_is_told),
        cmocka_unit_test(pixels_that_are_not_there_are_refused),
        cmocka_unit_test(samples_of_a_point_are_members_of_the_pools),
        cmocka_unit_test(without_orientation_pooled_and_taken_directions_have_the_same_bits),
    };
    return cmocka_run_group_tests_name("pixel", tests, NULL, NULL);
}
