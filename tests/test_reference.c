/* SPDX-License-Identifier: MIT
 *
 * References: what they come to, how far they say that they may be off, and that they can be stopped, written and taken
 * up again anywhere. */
#include "support.h"

#include "image_support.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 20, HEIGHT = 18, PIXELS = WIDTH * HEIGHT, SIZE = 16, TEXELS = 6 * SIZE * SIZE };

static const helio_material matte = {.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.6f, 0.4f}};
static const helio_material glossy = {
    .kind = HELIO_MATERIAL_PHONG, .diffuse = {0.5f, 0.4f, 0.3f}, .specular = {0.5f, 0.5f, 0.5f}, .exponent = 120};
static const helio_material metal = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 0.8f, 0.3f}, .metallic = 1, .roughness = 0.3f};
static const helio_material mirror = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {0.9f, 0.8f, 0.7f}, .metallic = 0.5f, .roughness = 0.1f};

/* ---- what is lit ---------------------------------------------------------------------------------- */

/* An uneven sky, with a sun in four texels of +Y, beside its middle. */
static void fill_sky(float pixels[3 * TEXELS], float sun)
{
    uint64_t random = 1;
    for (int i = 0; i < 3 * TEXELS; i++)
        pixels[i] = 0.3f + (float)random_unit(&random);
    for (int i = 0; sun > 0 && i < 12; i++)
        pixels[3 * ((2 * SIZE + SIZE / 2 + i / 6) * SIZE + SIZE / 2 + 3 + i / 3 % 2) + i % 3] =
            sun * (1.0f - 0.2f * (float)(i % 3));
}

/* A tent with bent normals, so that the two horizons of its points are not the same; it stands before another wall, so
 * that there are shadows. */
static helio_mesh *make_tent(helio_context *context)
{
    static const float positions[10][3] = {{-1, 0, 1},   {1, 0, 1},  {0, 1.5f, 0},   {1, 0, -1},        {-1, 0, -1},
                                           {0, 1.5f, 0}, {-2, 0, 1}, {-2, 2, -0.5f}, {-0.5f, 1.5f, -2}, {0, 0, -2}};
    static const float normals[10][3] = {{-0.6f, 0, 0.8f},  {0.6f, 0, 0.8f}, {0, 1, 0}, {0.6f, 0, -0.8f},
                                         {-0.6f, 0, -0.8f}, {0, 1, 0},       {1, 0, 0}, {0.8f, 0, 0.6f},
                                         {0, 0, 1},         {0, 0.6f, 0.8f}};
    static const uint32_t triangles[4][3] = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {6, 8, 9}};
    const helio_mesh_desc desc = {.vertex_count = 10,
                                  .triangle_count = 4,
                                  .positions = positions[0],
                                  .normals = normals[0],
                                  .triangles = triangles[0]};
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    return mesh;
}

typedef struct setup {
    helio_context *context;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_environment *environment;
    helio_reference_desc desc;
} setup;

typedef struct setup_desc {
    uint32_t threads;
    const helio_material *material;
    helio_ground ground;
    float sun;
    memory_count *memory;
} setup_desc;

static setup make_setup(setup_desc desc, helio_reference_desc reference)
{
    static float pixels[3 * TEXELS];
    setup s = {.context = make_context(desc.threads, desc.memory), .desc = reference};
    fill_sky(pixels, desc.sun);
    s.mesh = make_tent(s.context);
    s.environment = make_environment(s.context, HELIO_LAYOUT_STRIP, SIZE, 6 * SIZE, SIZE, pixels, NULL);
    const helio_orientation turned = {.rotate = 30, .intensity = 1.5f};
    assert_ok(helio_environment_orient(s.environment, &turned));
    const helio_scene_desc scene = {
        .mesh = s.mesh, .material = desc.material ? desc.material : &matte, .ground = desc.ground};
    assert_ok(helio_scene_create(s.context, &scene, &s.scene));
    s.desc.renderer.environment = s.environment;
    s.desc.renderer.scene = s.scene;
    s.desc.renderer.width = s.desc.renderer.width ? s.desc.renderer.width : WIDTH;
    s.desc.renderer.height = s.desc.renderer.height ? s.desc.renderer.height : HEIGHT;
    assert_ok(helio_camera_parse("orbit:azimuth=25,elevation=30,distance=1.0", s.mesh,
                                 (float)s.desc.renderer.width / (float)s.desc.renderer.height, &s.desc.camera));
    return s;
}

static void destroy_setup(setup *s)
{
    helio_scene_destroy(s->scene);
    helio_environment_destroy(s->environment);
    helio_mesh_destroy(s->context, s->mesh);
    helio_context_destroy(s->context);
}

static helio_reference *make_reference(const setup *s)
{
    helio_reference *reference;
    assert_ok(helio_reference_create(s->context, &s->desc, &reference));
    return reference;
}

static void advance(helio_reference *reference, int pieces)
{
    for (int i = 0; i < pieces; i++)
        assert_ok(helio_reference_advance(reference, NULL, NULL, NULL));
}

static void complete(helio_reference *reference)
{
    while (!helio_reference_get_info(reference).complete)
        advance(reference, 1);
}

static helio_reference_desc quadrature(void)
{
    return (helio_reference_desc){.method = HELIO_REFERENCE_QUADRATURE, .renderer = {.no_visibility = true}};
}

/* ---- quadrature against samples ---------------------------------------------------------------------- */

typedef struct agreement {
    double greatest; /* |z| */
    double squares;  /* mean of z^2 */
    size_t count;
} agreement;

/* Pixels in the unit of their own standard errors. exact has an error, too, of which nothing is seen here. */
static agreement compare(const helio_picture *exact, const helio_picture *sampled)
{
    agreement result = {0};
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3 && exact->object[i] > 0.5f; c++) {
            double error = (double)sampled->standard_error[3 * i + c];
            double off = (double)sampled->rgba[4 * i + c] - (double)exact->rgba[4 * i + c];
            double bound = (double)exact->standard_error[3 * i + c];
            double z = fmax(0.0, fabs(off) - bound) / error;
            result.greatest = fmax(result.greatest, z);
            result.squares += z * z;
            result.count++;
        }
    result.squares /= (double)result.count;
    return result;
}

/* Every strategy and quadrature, each with its own way to the same picture. Samples need many passes where few of them
 * meet the sun or a lobe: before, neither their mean nor its error is near to a normal distribution. */
static void check_agreement(const helio_material *material, const char *name, helio_strategy strategy, int passes)
{
    setup s = make_setup((setup_desc){.threads = 2, .material = material, .sun = 100}, quadrature());
    helio_reference *exact = make_reference(&s);
    complete(exact);
    s.desc = (helio_reference_desc){.renderer = s.desc.renderer, .camera = s.desc.camera};
    s.desc.renderer.strategy = strategy;
    helio_reference *sampled = make_reference(&s);
    advance(sampled, passes);
    helio_picture a = helio_reference_picture(exact), b = helio_reference_picture(sampled);
    agreement found = compare(&a, &b);
    print_message("%s, %s: %zu numbers, greatest |z| %.2f, mean of z^2 %.3f; error %.4f, bound %.1e\n", name,
                  helio_strategy_name(strategy), found.count, found.greatest, found.squares,
                  helio_reference_error(sampled), helio_reference_error(exact));
    assert_true(found.count > PIXELS / 2);
    /* About 500 numbers in each of 8 comparisons: |z| < 6.5 has p = 8e-11 each, 3e-7 in all. What is left of skewness
     * takes from that; the mean of z^2 would tell of a standard error that is a few per cent off. */
    assert_true(found.greatest < 6.5);
    assert_true(found.squares > 0.7 && found.squares < 1.4);
    helio_reference_destroy(exact);
    helio_reference_destroy(sampled);
    destroy_setup(&s);
}

static void quadrature_agrees_with_cosine_samples(void **state)
{
    (void)state;
    check_agreement(&matte, "diffuse", HELIO_STRATEGY_COSINE, 800);
    check_agreement(&glossy, "Phong 120", HELIO_STRATEGY_COSINE, 800);
    check_agreement(&metal, "GGX 0.3", HELIO_STRATEGY_COSINE, 800);
    check_agreement(&mirror, "GGX 0.1", HELIO_STRATEGY_COSINE, 1500);
}

static void quadrature_agrees_with_other_samples(void **state)
{
    (void)state;
    check_agreement(&matte, "diffuse", HELIO_STRATEGY_FACE, 200);
    check_agreement(&glossy, "Phong 120", HELIO_STRATEGY_LIGHT_BRDF, 300);
    check_agreement(&metal, "GGX 0.3", HELIO_STRATEGY_FACE_BRDF, 300);
    check_agreement(&mirror, "GGX 0.1", HELIO_STRATEGY_FACE_BRDF, 300);
}

/* ---- standard errors ----------------------------------------------------------------------------------- */

/* Twenty independent references: the spread of their pixels against what each of them says of its own. */
static void check_calibration(helio_reference_desc desc, helio_ground ground, const char *name)
{
    enum { RUNS = 20, PASSES = 24 };
    static float rgb[RUNS][3 * PIXELS];
    static double squared_errors[3 * PIXELS];
    double total = 0, freedom = 0;
    memset(squared_errors, 0, sizeof squared_errors);
    setup s = make_setup((setup_desc){.threads = 2, .ground = ground}, desc);
    for (uint32_t run = 0; run < RUNS; run++) {
        s.desc.seed = run;
        helio_reference *reference = make_reference(&s);
        advance(reference, PASSES);
        helio_picture picture = helio_reference_picture(reference);
        for (int i = 0; i < PIXELS; i++)
            for (int c = 0; c < 3; c++) {
                double error = (double)picture.standard_error[3 * i + c];
                rgb[run][3 * i + c] = picture.rgba[4 * i + c];
                squared_errors[3 * i + c] += error * error / RUNS;
            }
        helio_reference_destroy(reference);
    }
    for (int k = 0; k < 3 * PIXELS; k++) {
        double mean = 0, sum = 0;
        for (int run = 0; run < RUNS; run++)
            mean += (double)rgb[run][k] / RUNS;
        for (int run = 0; run < RUNS; run++)
            sum += pow((double)rgb[run][k] - mean, 2);
        if (!(squared_errors[k] > 0))
            continue;
        total += sum / squared_errors[k];
        freedom += RUNS - 1;
    }
    print_message("%s: spread of %d references / what they say of it: %.4f, over %.0f degrees of freedom\n", name, RUNS,
                  total / freedom, freedom);
    assert_true(freedom > 19.0 * PIXELS / 2);
    /* Chi-square has a relative standard deviation of sqrt(2 / freedom), a per cent here; the three channels of a pixel
     * and pixels that share pools are not independent, and passes are not quite normal: five times as much, and six
     * standard deviations of that. */
    assert_true(fabs(total / freedom - 1.0) < 6.0 * 5.0 * sqrt(2.0 / freedom));
    destroy_setup(&s);
}

static void standard_errors_are_what_independent_references_show(void **state)
{
    (void)state;
    check_calibration((helio_reference_desc){.renderer = {.spp = 16}}, HELIO_GROUND_NONE, "cosine");
    check_calibration((helio_reference_desc){.renderer = {.spp = 16, .strategy = HELIO_STRATEGY_FACE_BRDF}},
                      HELIO_GROUND_PLANE, "face+brdf");
    check_calibration((helio_reference_desc){.renderer = {.spp = 16, .aa = 4, .background = HELIO_BACKGROUND_NONE}},
                      HELIO_GROUND_NONE, "cosine, four camera samples");
}

static void errors_fall_with_the_root_of_the_passes(void **state)
{
    (void)state;
    setup s = make_setup((setup_desc){.threads = 2}, (helio_reference_desc){.renderer = {.spp = 8}});
    helio_reference *reference = make_reference(&s);
    assert_true(isnan(helio_reference_error(reference)));
    advance(reference, 1);
    assert_true(isnan(helio_reference_error(reference)));
    assert_null(helio_reference_picture(reference).standard_error);
    advance(reference, 49);
    double before = helio_reference_error(reference);
    advance(reference, 350);
    double ratio = before / helio_reference_error(reference);
    assert_true(fabs(ratio / sqrt(8.0) - 1.0) < 0.1); /* known to some per cent after fifty passes */
    helio_reference_info info = helio_reference_get_info(reference);
    assert_int_equal(info.pieces, 400);
    assert_int_equal(info.piece_spp, 8);
    assert_int_equal(info.spp, 3200);
    assert_int_equal(info.piece_count, 0);
    assert_false(info.complete);
    helio_reference_destroy(reference);
    destroy_setup(&s);
}

/* By the definition in reference.h, from the picture. */
static void the_error_is_the_mean_over_the_object(void **state)
{
    (void)state;
    setup s = make_setup((setup_desc){.threads = 2, .ground = HELIO_GROUND_PLANE}, (helio_reference_desc){0});
    helio_reference *reference = make_reference(&s);
    advance(reference, 5);
    helio_picture picture = helio_reference_picture(reference);
    double squares = 0, sum = 0, count = 0;
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3 && picture.object[i] >= 0.5f; c++, count++)
            squares += pow((double)picture.rgba[4 * i + c], 2);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3 && picture.object[i] >= 0.5f; c++)
            sum += (double)picture.standard_error[3 * i + c] /
                   sqrt(pow((double)picture.rgba[4 * i + c], 2) + 0.01 * squares / count);
    assert_true(count > 0 && fabs(helio_reference_error(reference) / (sum / count) - 1) < 1e-5);
    helio_reference_destroy(reference);
    destroy_setup(&s);
}

/* Of a ratio of two sums the mean over passes would be off, however many there are. */
static void a_shadow_catcher_goes_to_the_same_alpha_in_passes_of_any_size(void **state)
{
    (void)state;
    double means[2] = {0, 0}, covered = 0;
    for (int k = 0; k < 2; k++) {
        setup s = make_setup((setup_desc){.threads = 2, .ground = HELIO_GROUND_SHADOW, .sun = 300},
                             (helio_reference_desc){.renderer = {.spp = k == 0 ? 4 : 128}});
        s.desc.renderer.strategy = HELIO_STRATEGY_FACE;
        helio_reference *reference = make_reference(&s);
        advance(reference, k == 0 ? 1600 : 50);
        helio_picture picture = helio_reference_picture(reference);
        for (int i = 0; i < PIXELS; i++)
            if (picture.object[i] == 0.0f) {
                means[k] += (double)picture.rgba[4 * i + 3];
                covered += k;
            }
        helio_reference_destroy(reference);
        destroy_setup(&s);
    }
    assert_true(means[1] / covered > 0.01); /* there are shadows */
    /* Both have 6,400 samples. The ratio's bias in passes of 4 would be some per cent. */
    assert_true(fabs(means[0] / means[1] - 1) < 0.01);
}

/* ---- the picture ----------------------------------------------------------------------------------------- */

/* What is not the object has no error; the object reflects no more than its albedo, and less where its bent normals see
 * below the flat horizon. Both methods agree. */
static void an_even_sky_is_reflected_and_stands_behind(void **state)
{
    (void)state;
    setup s = make_setup((setup_desc){.threads = 2}, quadrature());
    static float even[3 * TEXELS];
    for (int i = 0; i < 3 * TEXELS; i++)
        even[i] = 1.0f;
    assert_ok(helio_environment_update(s.environment, even, NULL));
    helio_reference *exact = make_reference(&s);
    s.desc.method = HELIO_REFERENCE_SAMPLING;
    helio_reference *sampled = make_reference(&s);
    complete(exact);
    advance(sampled, 60);
    helio_picture a = helio_reference_picture(exact), b = helio_reference_picture(sampled);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            float value = a.rgba[4 * i + c], other = b.rgba[4 * i + c], whole = matte.diffuse[c] * 1.5f;
            float error = b.standard_error[3 * i + c];
            assert_true(a.rgba[4 * i + 3] == 1.0f && b.rgba[4 * i + 3] == 1.0f && a.object[i] == b.object[i]);
            if (a.object[i] == 0.0f) {
                assert_true(fabsf(value - 1.5f) < 1e-6f && value == other && error == 0.0f);
                assert_true(a.standard_error[3 * i + c] == 0.0f);
                continue;
            }
            assert_true(value <= whole * 1.00001f && value > 0.5f * whole);
            assert_true(a.standard_error[3 * i + c] < 2e-5f * whole);
            assert_true(fabsf(value - other) < 7.0f * error + 1e-5f); /* Student's t, 59 degrees of freedom */
        }
    helio_reference_destroy(exact);
    helio_reference_destroy(sampled);
    destroy_setup(&s);
}

/* Camera samples of quadrature are passes: their mean is the pixel, their spread its error. */
static void quadrature_takes_camera_samples(void **state)
{
    (void)state;
    helio_reference_desc desc = quadrature();
    desc.renderer.aa = 8;
    desc.renderer.background = HELIO_BACKGROUND_NONE;
    setup s = make_setup((setup_desc){.threads = 2}, desc);
    helio_reference *exact = make_reference(&s);
    assert_int_equal(helio_reference_get_info(exact).piece_count, 8 * ((HEIGHT + 15) / 16));
    complete(exact);
    s.desc.method = HELIO_REFERENCE_SAMPLING;
    s.desc.renderer.spp = 256;
    s.desc.renderer.aa = 64;
    helio_reference *sampled = make_reference(&s);
    advance(sampled, 40);
    helio_picture a = helio_reference_picture(exact), b = helio_reference_picture(sampled);
    size_t partly = 0;
    double off = 0, error = 0;
    for (int i = 0; i < PIXELS; i++) {
        partly += a.object[i] > 0.0f && a.object[i] < 1.0f;
        assert_true(a.rgba[4 * i + 3] == a.object[i]);
        off += pow((double)(a.rgba[4 * i + 1] - b.rgba[4 * i + 1]), 2);
        error += pow((double)a.standard_error[3 * i + 1], 2) + pow((double)b.standard_error[3 * i + 1], 2);
    }
    assert_true(partly > 20);
    /* Eight scrambled points cover a pixel more evenly than independent ones, which the errors speak of. */
    assert_true(off < 1.3 * error && off > 0.05 * error);
    helio_reference_destroy(exact);
    helio_reference_destroy(sampled);
    destroy_setup(&s);
}

/* ---- the same bits ------------------------------------------------------------------------------------------- */

static void assert_same(const helio_picture *a, const helio_picture *b)
{
    assert_memory_equal(a->rgba, b->rgba, PIXELS * 4 * sizeof(float));
    assert_memory_equal(a->object, b->object, PIXELS * sizeof(float));
    assert_int_equal(a->standard_error != NULL, b->standard_error != NULL);
    if (a->standard_error != NULL)
        assert_memory_equal(a->standard_error, b->standard_error, PIXELS * 3 * sizeof(float));
}

static helio_reference_desc kinds[4];
static helio_ground grounds[4];
enum { KINDS = 4 };

static void fill_kinds(void)
{
    kinds[0] = (helio_reference_desc){.renderer = {.spp = 16}};
    kinds[1] =
        (helio_reference_desc){.renderer = {.spp = 300, .aa = 2, .strategy = HELIO_STRATEGY_FACE_BRDF}, .seed = 5};
    kinds[2] = (helio_reference_desc){.renderer = {.spp = 16, .strategy = HELIO_STRATEGY_LIGHT}};
    kinds[3] = quadrature();
    kinds[3].renderer.aa = 2;
    grounds[1] = HELIO_GROUND_PLANE;
    grounds[2] = HELIO_GROUND_SHADOW;
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    fill_kinds();
    for (int kind = 0; kind < KINDS; kind++) {
        helio_reference *references[3];
        helio_picture pictures[3];
        setup setups[3];
        double errors[3];
        for (uint32_t threads = 1; threads <= 3; threads++) {
            uint32_t i = threads - 1;
            setups[i] = make_setup((setup_desc){.threads = threads, .ground = grounds[kind], .sun = 300}, kinds[kind]);
            references[i] = make_reference(&setups[i]);
            advance(references[i], 3);
            pictures[i] = helio_reference_picture(references[i]);
            errors[i] = helio_reference_error(references[i]);
            assert_same(&pictures[0], &pictures[i]);
            assert_memory_equal(&errors[0], &errors[i], sizeof errors[0]);
        }
        for (int i = 0; i < 3; i++) {
            helio_reference_destroy(references[i]);
            destroy_setup(&setups[i]);
        }
    }
}

static void other_seeds_are_other_samples(void **state)
{
    (void)state;
    setup s = make_setup((setup_desc){.threads = 1}, (helio_reference_desc){.renderer = {.spp = 4}});
    float first[4 * PIXELS];
    for (uint32_t seed = 0; seed < 3; seed++) {
        s.desc.seed = seed;
        helio_reference *reference = make_reference(&s);
        advance(reference, 2);
        helio_picture picture = helio_reference_picture(reference);
        if (seed == 0)
            memcpy(first, picture.rgba, sizeof first);
        else
            assert_true(memcmp(first, picture.rgba, sizeof first) != 0);
        helio_reference_destroy(reference);
    }
    destroy_setup(&s);
}

/* ---- stopping and going on ------------------------------------------------------------------------------------ */

/* Counts down; the answer is false at 0. */
static bool count_down(void *user, float done)
{
    int *left = user;
    assert_true(done >= 0.0f && done <= 1.0f);
    return --*left > 0;
}

static void a_piece_that_is_stopped_leaves_no_trace(void **state)
{
    (void)state;
    fill_kinds();
    for (int kind = 0; kind < KINDS; kind++) {
        setup s = make_setup((setup_desc){.threads = 2, .ground = grounds[kind]}, kinds[kind]);
        helio_reference *whole = make_reference(&s), *stopped = make_reference(&s);
        advance(whole, 3);
        for (int piece = 0; piece < 3; piece++) {
            int left = 1;
            helio_reference_info info;
            assert_ok(helio_reference_advance(stopped, count_down, &left, &info));
            assert_true(info.stopped);
            assert_int_equal(info.pieces, piece);
            left = 1000000;
            assert_ok(helio_reference_advance(stopped, count_down, &left, &info));
            assert_false(info.stopped);
            assert_int_equal(info.pieces, piece + 1);
        }
        helio_picture a = helio_reference_picture(whole), b = helio_reference_picture(stopped);
        assert_same(&a, &b);
        helio_reference_destroy(whole);
        helio_reference_destroy(stopped);
        destroy_setup(&s);
    }
}

typedef struct folder {
    char directory[TEST_PATH_SIZE], path[TEST_PATH_SIZE + 16];
} folder;

static folder make_folder(void)
{
    folder f;
    make_directory(f.directory);
    snprintf(f.path, sizeof f.path, "%s/checkpoint", f.directory);
    return f;
}

/* On other threads than before. */
static void a_resumed_reference_equals_an_unbroken_one(void **state)
{
    (void)state;
    folder f = make_folder();
    fill_kinds();
    for (int kind = 0; kind < KINDS; kind++) {
        setup s = make_setup((setup_desc){.threads = 2, .ground = grounds[kind], .sun = 300}, kinds[kind]);
        setup other = make_setup((setup_desc){.threads = 1, .ground = grounds[kind], .sun = 300}, kinds[kind]);
        helio_reference *whole = make_reference(&s);
        for (int piece = 0; piece < 4; piece++) {
            helio_reference *next = make_reference(piece % 2 ? &s : &other);
            if (piece > 0)
                assert_ok(helio_reference_resume(next, f.path));
            assert_int_equal(helio_reference_get_info(next).pieces, piece);
            advance(next, 1);
            advance(whole, 1);
            helio_picture a = helio_reference_picture(whole), b = helio_reference_picture(next);
            assert_same(&a, &b);
            assert_ok(helio_reference_save(next, f.path));
            helio_reference_destroy(next);
        }
        helio_reference_destroy(whole);
        destroy_setup(&s);
        destroy_setup(&other);
        unlink(f.path);
    }
    remove_directory(f.directory);
}

/* What is not done yet is black, clear and of unknown error. */
static void an_unfinished_sum_shows_what_is_done(void **state)
{
    (void)state;
    setup s = make_setup((setup_desc){.threads = 2}, quadrature());
    helio_reference *reference = make_reference(&s);
    advance(reference, 1);
    helio_picture picture = helio_reference_picture(reference);
    for (int i = 0; i < PIXELS; i++) {
        bool is_done = i < 16 * WIDTH;
        assert_true(isfinite(picture.standard_error[3 * i]) == is_done);
        assert_true((picture.rgba[4 * i + 3] == 1.0f) == is_done && (picture.rgba[4 * i] > 0.0f) == is_done);
    }
    helio_reference_info info = helio_reference_get_info(reference);
    assert_int_equal(info.pieces, 1);
    assert_int_equal(info.piece_count, 2);
    assert_false(info.complete);
    advance(reference, 5); /* one is left, the others do nothing */
    info = helio_reference_get_info(reference);
    assert_int_equal(info.pieces, 2);
    assert_true(info.complete);
    helio_reference_destroy(reference);
    destroy_setup(&s);
}

/* ---- checkpoints of something else ------------------------------------------------------------------------------ */

static void expect_refusal(const setup *s, const char *path, const char *word)
{
    helio_reference *reference = make_reference(s), *fresh = make_reference(s);
    advance(reference, 1);
    if (helio_reference_resume(reference, path) != HELIO_ERR_DATA || strstr(helio_last_error(), word) == NULL)
        fail_msg("no \"%s\" in: %s", word, helio_last_error());
    assert_non_null(strstr(helio_last_error(), path));
    /* It is as new. */
    assert_int_equal(helio_reference_get_info(reference).pieces, 0);
    advance(reference, 1);
    advance(fresh, 1);
    helio_picture a = helio_reference_picture(reference), b = helio_reference_picture(fresh);
    assert_same(&a, &b);
    helio_reference_destroy(reference);
    helio_reference_destroy(fresh);
}

static void checkpoints_of_another_reference_are_refused(void **state)
{
    (void)state;
    folder f = make_folder();
    const setup_desc plain = {.threads = 2, .ground = HELIO_GROUND_PLANE, .sun = 100};
    setup s = make_setup(plain, (helio_reference_desc){.renderer = {.spp = 4, .no_visibility = true}});
    helio_reference *reference = make_reference(&s);
    advance(reference, 2);
    assert_ok(helio_reference_save(reference, f.path));
    helio_reference_destroy(reference);
    static const setup_desc others[] = {{2, NULL, HELIO_GROUND_PLANE, 101, NULL},
                                        {2, NULL, HELIO_GROUND_NONE, 100, NULL},
                                        {2, &metal, HELIO_GROUND_PLANE, 100, NULL}};
    static const char *const words[] = {"another map", "another mesh", "another mesh"};
    for (int i = 0; i < 3; i++) {
        setup other = make_setup(others[i], s.desc);
        expect_refusal(&other, f.path, words[i]);
        destroy_setup(&other);
    }
    const helio_reference_desc good = s.desc;
    s.desc.camera.fov += 1;
    expect_refusal(&s, f.path, "another camera");
    for (int i = 0; i < 8; i++) {
        s.desc = good;
        switch (i) {
        case 0: s.desc.seed = 1; break;
        case 1: s.desc.renderer.spp = 5; break;
        case 2: s.desc.renderer.aa = 2; break;
        case 3: s.desc.renderer.strategy = HELIO_STRATEGY_BRDF; break;
        case 4: s.desc.renderer.weighting = HELIO_WEIGHTING_PAPER; break;
        case 5: s.desc.renderer.no_decorrelation = true; break;
        case 6: s.desc.renderer.no_visibility = false; break;
        default: s.desc.method = HELIO_REFERENCE_QUADRATURE; break;
        }
        expect_refusal(&s, f.path, "another method or other settings");
    }
    s.desc = good;
    assert_ok(helio_environment_orient(s.environment, &(helio_orientation){.rotate = 30, .intensity = 1.6f}));
    expect_refusal(&s, f.path, "another map");
    destroy_setup(&s);
    remove_directory(f.directory);
}

/* ---- damaged checkpoints ------------------------------------------------------------------------------------------
 */

static void expect_damage(helio_reference *reference, const char *path)
{
    assert_int_equal(helio_reference_resume(reference, path), HELIO_ERR_DATA);
    assert_non_null(strstr(helio_last_error(), path));
    assert_int_equal(helio_reference_get_info(reference).pieces, 0);
}

static void damaged_checkpoints_are_refused(void **state)
{
    (void)state;
    folder f = make_folder();
    setup s = make_setup((setup_desc){.threads = 1}, (helio_reference_desc){.renderer = {.spp = 4}});
    helio_reference *reference = make_reference(&s);
    advance(reference, 2);
    assert_ok(helio_reference_save(reference, f.path));
    size_t good_size;
    unsigned char *good = read_file(f.path, &good_size);
    assert_int_equal(good_size, 104 + PIXELS * 64);
    for (size_t size = 0; size < good_size; size += size < 200 ? 1 : 577) { /* cut */
        write_file(f.path, good, size);
        expect_damage(reference, f.path);
    }
    good = realloc(good, good_size + 8);
    assert_non_null(good);
    memset(good + good_size, 0, 8);
    write_file(f.path, good, good_size + 8); /* longer */
    expect_damage(reference, f.path);
    for (size_t place = 0; place < good_size; place += place < 200 ? 1 : 91) { /* a bit here, a bit there */
        good[place] ^= (unsigned char)(1u << place % 8);
        write_file(f.path, good, good_size);
        expect_damage(reference, f.path);
        good[place] ^= (unsigned char)(1u << place % 8);
    }
    write_file(f.path, good, good_size);
    assert_ok(helio_reference_resume(reference, f.path));
    assert_int_equal(helio_reference_get_info(reference).pieces, 2);
    free(good);
    helio_reference_destroy(reference);
    destroy_setup(&s);
    remove_directory(f.directory);
}

static void checkpoints_that_are_no_files_are_told(void **state)
{
    (void)state;
    folder f = make_folder();
    setup s = make_setup((setup_desc){.threads = 1}, (helio_reference_desc){.renderer = {.spp = 4}});
    helio_reference *reference = make_reference(&s);
    assert_int_equal(helio_reference_resume(reference, f.path), HELIO_ERR_IO);
    assert_int_equal(helio_reference_resume(reference, f.directory), HELIO_ERR_IO);
    assert_int_equal(helio_reference_save(reference, f.directory), HELIO_ERR_IO);
    assert_int_equal(helio_reference_save(reference, "/no/such/folder/checkpoint"), HELIO_ERR_IO);
    helio_reference_destroy(reference);
    destroy_setup(&s);
    remove_directory(f.directory);
}

/* ---- arguments and memory
 * --------------------------------------------------------------------------------------------- */

static void mistakes_are_told(void **state)
{
    (void)state;
    setup s = make_setup((setup_desc){.threads = 1}, (helio_reference_desc){0});
    const helio_reference_desc good = s.desc;
    static const char *const words[] = {"no aovs", "no_visibility", "tolerance", "method 7", "fov", "16384", "map"};
    for (int i = 0; i < 7; i++) {
        helio_reference_desc desc = good;
        helio_reference *reference = (helio_reference *)&desc;
        helio_environment *empty = NULL;
        assert_ok(helio_environment_create(s.context, &(helio_environment_desc){.cube_size = 4}, &empty));
        switch (i) {
        case 0: desc.renderer.aovs = true; break;
        case 1: desc.method = HELIO_REFERENCE_QUADRATURE; break;
        case 2: desc.tolerance = 0.5; break;
        case 3: desc.method = (helio_reference_method)7; break;
        case 4: desc.camera.fov = 0; break;
        case 5: desc.renderer.width = 20000; break;
        default: desc.renderer.environment = empty; break;
        }
        assert_int_equal(helio_reference_create(s.context, &desc, &reference), HELIO_ERR_ARGUMENT);
        assert_null(reference);
        if (strstr(helio_last_error(), words[i]) == NULL)
            fail_msg("no \"%s\" in: %s", words[i], helio_last_error());
        helio_environment_destroy(empty);
    }
    assert_int_equal(helio_reference_create(s.context, NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_reference_advance(NULL, NULL, NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_reference_save(NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_int_equal(helio_reference_resume(NULL, NULL), HELIO_ERR_ARGUMENT);
    helio_reference *reference = make_reference(&s);
    advance(reference, 1);
    static float pixels[3 * TEXELS];
    assert_ok(helio_environment_update(s.environment, pixels, NULL));
    assert_int_equal(helio_reference_advance(reference, NULL, NULL, NULL), HELIO_ERR_ARGUMENT);
    assert_non_null(strstr(helio_last_error(), "new map"));
    helio_reference_destroy(reference);
    helio_reference_destroy(NULL);
    destroy_setup(&s);
}

/* Whatever is refused at creation; and nothing is asked for later. */
static void memory_is_taken_at_creation(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        memory_count memory = {0};
        setup s = make_setup((setup_desc){.threads = 1, .memory = &memory},
                             kind ? quadrature() : (helio_reference_desc){.renderer = {.spp = 4}});
        size_t live = memory.live, failures = 0;
        helio_reference *reference = NULL;
        for (helio_status status = HELIO_ERR_MEMORY; status != HELIO_OK; failures++) {
            memory.refuse_after = memory.taken + failures;
            status = helio_reference_create(s.context, &s.desc, &reference);
            assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
            if (status != HELIO_OK)
                assert_int_equal(memory.live, live);
        }
        assert_true(failures > 10);
        size_t taken = memory.taken;
        memory.refuse_after = taken;
        folder f = make_folder();
        advance(reference, 2);
        helio_reference_picture(reference);
        helio_reference_error(reference);
        assert_ok(helio_reference_save(reference, f.path));
        assert_ok(helio_reference_resume(reference, f.path));
        assert_int_equal(memory.taken, taken);
        memory.refuse_after = 0;
        remove_directory(f.directory);
        helio_reference_destroy(reference);
        assert_int_equal(memory.live, live);
        destroy_setup(&s);
    }
}

/* An argument names the tests to be run, with * for any letters. */
int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quadrature_agrees_with_cosine_samples),
        cmocka_unit_test(quadrature_agrees_with_other_samples),
        cmocka_unit_test(standard_errors_are_what_independent_references_show),
        cmocka_unit_test(errors_fall_with_the_root_of_the_passes),
        cmocka_unit_test(the_error_is_the_mean_over_the_object),
        cmocka_unit_test(a_shadow_catcher_goes_to_the_same_alpha_in_passes_of_any_size),
        cmocka_unit_test(an_even_sky_is_reflected_and_stands_behind),
        cmocka_unit_test(quadrature_takes_camera_samples),
        cmocka_unit_test(threads_change_no_bit),
        cmocka_unit_test(other_seeds_are_other_samples),
        cmocka_unit_test(a_piece_that_is_stopped_leaves_no_trace),
        cmocka_unit_test(a_resumed_reference_equals_an_unbroken_one),
        cmocka_unit_test(an_unfinished_sum_shows_what_is_done),
        cmocka_unit_test(checkpoints_of_another_reference_are_refused),
        cmocka_unit_test(damaged_checkpoints_are_refused),
        cmocka_unit_test(checkpoints_that_are_no_files_are_told),
        cmocka_unit_test(mistakes_are_told),
        cmocka_unit_test(memory_is_taken_at_creation),
    };
    if (count > 1)
        cmocka_set_test_filter(arguments[1]);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
