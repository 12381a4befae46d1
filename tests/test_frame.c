/* SPDX-License-Identifier: MIT
 *
 * Frames on several threads, small enough for the thread sanitizer: kept and traced camera rays, several steps,
 * progress and stopping, shadow rays, a mesh without a ground and a shadow catcher. */
#include "support.h"

#include "image/tonemap.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <string.h>

enum { WIDTH = 72, HEIGHT = 50, MAP = 32 };

typedef struct stage {
    helio_context *context;
    helio_environment *environment;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_renderer *renderer;
    helio_frame_desc frame;
} stage;

static stage make_stage(uint32_t threads, helio_ground ground, uint32_t aa, uint32_t spp)
{
    static float map[MAP / 2 * MAP * 3];
    stage s = {.context = make_context(threads, NULL)};
    for (int i = 0; i < MAP / 2 * MAP * 3; i++)
        map[i] = i % 97 == 0 ? 40.0f : 0.2f + (float)(i % 11) * 0.1f;
    s.environment = make_environment(s.context, HELIO_LAYOUT_LATLONG, MAP, MAP / 2, 16, map, NULL);
    s.mesh = make_unit_sphere(s.context);
    const helio_scene_desc scene = {.mesh = s.mesh, .ground = ground};
    assert_ok(helio_scene_create(s.context, &scene, &s.scene));
    const helio_renderer_desc renderer = {.environment = s.environment,
                                          .scene = s.scene,
                                          .width = WIDTH,
                                          .height = HEIGHT,
                                          .aa = aa,
                                          .spp = spp,
                                          .pool_length = 128,
                                          .aovs = aa > 1};
    assert_ok(helio_renderer_create(s.context, &renderer, &s.renderer));
    assert_ok(helio_camera_parse("auto", s.mesh, (float)WIDTH / HEIGHT, &s.frame.camera));
    return s;
}

static void destroy_stage(stage *s)
{
    helio_renderer_destroy(s->renderer);
    helio_scene_destroy(s->scene);
    helio_mesh_destroy(s->context, s->mesh);
    helio_environment_destroy(s->environment);
    helio_context_destroy(s->context);
}

static void compare_pictures(const stage *a, const stage *b)
{
    helio_picture x = helio_renderer_picture(a->renderer), y = helio_renderer_picture(b->renderer);
    assert_memory_equal(x.rgba, y.rgba, sizeof(float) * 4 * WIDTH * HEIGHT);
    assert_memory_equal(x.object, y.object, sizeof(float) * WIDTH * HEIGHT);
}

/* One part, several camera samples, several parts: with shadow rays, on one thread and on three. */
static void pictures_do_not_depend_on_threads(void **state)
{
    (void)state;
    static const uint32_t settings[][2] = {{1, 8}, {3, 8}, {1, 40}};
    for (int k = 0; k < 6; k++) {
        helio_ground ground = k < 3 ? HELIO_GROUND_NONE : HELIO_GROUND_SHADOW;
        stage one = make_stage(1, ground, settings[k % 3][0], settings[k % 3][1]);
        stage three = make_stage(3, ground, settings[k % 3][0], settings[k % 3][1]);
        assert_ok(helio_renderer_render(one.renderer, &one.frame, NULL));
        assert_ok(helio_renderer_render(three.renderer, &three.frame, NULL));
        compare_pictures(&one, &three);
        destroy_stage(&one);
        destroy_stage(&three);
    }
}

static void kept_camera_rays_give_the_same_picture(void **state)
{
    (void)state;
    stage kept = make_stage(3, HELIO_GROUND_PLANE, 1, 8), traced = make_stage(3, HELIO_GROUND_PLANE, 1, 8);
    helio_frame_info info;
    for (uint32_t frame = 0; frame < 3; frame++) {
        kept.frame.seed = traced.frame.seed = frame;
        traced.frame.retrace = true;
        assert_ok(helio_renderer_render(kept.renderer, &kept.frame, &info));
        assert_int_equal(info.camera_rays, frame == 0 ? WIDTH * HEIGHT : 0);
        assert_ok(helio_renderer_render(traced.renderer, &traced.frame, &info));
        assert_int_equal(info.camera_rays, WIDTH * HEIGHT);
        compare_pictures(&kept, &traced);
    }
    destroy_stage(&kept);
    destroy_stage(&traced);
}

static bool stop_at_once(void *user, float done)
{
    (*(int *)user)++;
    return done < 0.0f;
}

/* What a stopped frame leaves behind must not be seen by the next. */
static void a_frame_after_a_stopped_one_is_whole(void **state)
{
    (void)state;
    for (uint32_t aa = 1; aa <= 2; aa++) {
        stage stopped = make_stage(3, HELIO_GROUND_NONE, aa, 8), other = make_stage(3, HELIO_GROUND_NONE, aa, 8);
        helio_frame_info info;
        int calls = 0;
        stopped.frame.progress = stop_at_once;
        stopped.frame.user = &calls;
        assert_ok(helio_renderer_render(stopped.renderer, &stopped.frame, &info));
        assert_true(info.stopped && calls == 1);
        stopped.frame.progress = NULL;
        assert_ok(helio_renderer_render(stopped.renderer, &stopped.frame, &info));
        assert_false(info.stopped);
        assert_ok(helio_renderer_render(other.renderer, &other.frame, NULL));
        compare_pictures(&stopped, &other);
        destroy_stage(&stopped);
        destroy_stage(&other);
    }
}

/* Also of a frame that was stopped, and where nobody wants radiance. */
static void what_is_shown_is_what_a_png_shows(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 8; i++) {
        const helio_picture_write_desc look = {
            .exposure = (float)(i % 3) - 1.5f, .tonemap = (helio_tonemap)(i % 2), .alpha = i / 2 % 2};
        stage s = make_stage(3, i < 4 ? HELIO_GROUND_SHADOW : HELIO_GROUND_NONE, 2, 8);
        int calls = 0;
        s.frame.shown = &look;
        s.frame.progress = i == 5 ? stop_at_once : NULL;
        s.frame.user = &calls;
        assert_ok(helio_renderer_render(s.renderer, &s.frame, NULL));
        const helio_picture picture = helio_renderer_picture(s.renderer);
        for (size_t k = 0; k < WIDTH * HEIGHT; k++) {
            uint8_t expected[4];
            tonemap_shown(picture.rgba + 4 * k, &look, expected);
            assert_memory_equal(picture.shown + 4 * k, expected, 4);
        }
        s.frame.no_radiance = true;
        assert_ok(helio_renderer_render(s.renderer, &s.frame, NULL));
        assert_null(helio_renderer_picture(s.renderer).rgba);
        assert_null(helio_renderer_picture(s.renderer).object);
        s.frame.shown = NULL;
        assert_ok(helio_renderer_render(s.renderer, &s.frame, NULL));
        assert_null(helio_renderer_picture(s.renderer).shown);
        s.frame.shown = &(helio_picture_write_desc){.exposure = NAN};
        assert_int_equal(helio_renderer_render(s.renderer, &s.frame, NULL), HELIO_ERR_ARGUMENT);
        destroy_stage(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_do_not_depend_on_threads),
        cmocka_unit_test(kept_camera_rays_give_the_same_picture),
        cmocka_unit_test(a_frame_after_a_stopped_one_is_whole),
        cmocka_unit_test(what_is_shown_is_what_a_png_shows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
