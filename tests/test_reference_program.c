/* SPDX-License-Identifier: MIT
 *
 * heliostat reference as people run it: what it writes, when it stops, and that nothing is lost when it is killed. */
#include "program.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define SCENE "reference --mesh tetrahedron.obj --env-size 16 --size 40x30 "

/* ---- files ---- */

/* Pictures are written from the same numbers to the same bytes. */
static void assert_same_file(const char *path, const char *other)
{
    static char bytes[2][1 << 17];
    size_t size = read_text(path, bytes[0], sizeof bytes[0]);
    assert_int_equal(read_text(other, bytes[1], sizeof bytes[1]), size);
    if (memcmp(bytes[0], bytes[1], size) != 0)
        fail_msg("%s and %s are not the same", path, other);
}

static helio_image *read_layer(helio_context *context, const char *path, const char *layer)
{
    helio_image *image;
    assert_ok(helio_image_read(context, path, &(helio_image_read_desc){.layer = layer}, &image));
    return image;
}

static const json_t *first_frame(const json_t *stats)
{
    const json_t *frame = json_array_get(json_object_get(stats, "frames"), 0);
    assert_non_null(frame);
    return frame;
}

/* ---- what it writes ---- */

static void pictures_come_with_their_errors(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--spp 200 --out a.exr --stats a.json");
    assert_non_null(strstr(program_out, "a.exr: 40x30, cosine, 256 spp, error 0."));
    assert_false(exists("a.exr.checkpoint"));
    helio_context *context = make_context(1, NULL);
    helio_image *picture = read_layer(context, "a.exr", NULL), *error = read_layer(context, "a.exr", "stderr");
    helio_image *object = read_layer(context, "a.exr", "object");
    size_t shown = 0;
    for (size_t i = 0; i < 40 * 30; i++) {
        bool is_object = object->rgb[3 * i] > 0.5f;
        shown += is_object;
        assert_true((error->rgb[3 * i] > 0.0f) == is_object);
        assert_true(picture->rgb[3 * i] > 0.0f && picture->alpha[i] == 1.0f);
    }
    assert_in_range(shown, 100, 1000);
    json_t *stats = load_json("a.json");
    assert_true(number_of(first_frame(stats), "spp") == 256 && number_of(first_frame(stats), "passes") == 4);
    assert_true(number_of(first_frame(stats), "error") > 0 && number_of(first_frame(stats), "samples") > 256 * 100.0);
    assert_string_equal(text_of(json_object_get(stats, "summary"), "method"), "cosine");
    json_decref(stats);
    helio_image_destroy(context, picture);
    helio_image_destroy(context, error);
    helio_image_destroy(context, object);
    helio_context_destroy(context);
}

static void the_output_has_a_usual_name_and_other_kinds(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    succeeds(SCENE "--spp 1 --quiet");
    assert_true(exists("reference.exr") && program_out[0] == 0);
    succeeds(SCENE "--spp 1 --out a.png --exposure 1");
    succeeds(SCENE "--spp 1 --out a.pfm");
    assert_true(exists("a.png") && exists("a.pfm"));
}

static void quadrature_is_exact_and_much_like_samples(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--method quadrature --visibility none --out exact.exr --stats exact.json");
    assert_non_null(strstr(program_out, "exact.exr: 40x30, quadrature, complete, error below"));
    succeeds(SCENE "--strategy face+brdf --visibility none --spp 10000 --out sampled.exr");
    json_t *stats = load_json("exact.json");
    assert_true(number_of(first_frame(stats), "error") < 1e-4 && number_of(first_frame(stats), "evaluations") > 1000);
    json_decref(stats);
    helio_context *context = make_context(1, NULL);
    helio_image *exact = read_layer(context, "exact.exr", NULL), *sampled = read_layer(context, "sampled.exr", NULL);
    helio_image *error = read_layer(context, "sampled.exr", "stderr");
    for (size_t i = 0; i < 3 * 40 * 30; i++) /* 3600 numbers within 7 standard errors: p = 9e-9 in all */
        assert_true(fabsf(exact->rgb[i] - sampled->rgb[i]) <= 7.0f * error->rgb[i] + 1e-4f * exact->rgb[i]);
    helio_image_destroy(context, exact);
    helio_image_destroy(context, sampled);
    helio_image_destroy(context, error);
    helio_context_destroy(context);
}

static void threads_change_no_bit(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--spp 256 --ground plane --threads 1 --out a.exr");
    succeeds(SCENE "--spp 256 --ground plane --threads 3 --out b.exr");
    assert_same_file("a.exr", "b.exr");
    succeeds(SCENE "--size 20x15 --method quadrature --visibility none --threads 1 --out a.exr");
    succeeds(SCENE "--size 20x15 --method quadrature --visibility none --threads 3 --out b.exr");
    assert_same_file("a.exr", "b.exr");
}

static void each_frame_has_a_reference_of_its_own(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--env sky:day --day-frames 3 --spp 128 --out day_%04d.exr --stats day.json");
    assert_true(exists("day_0000.exr") && exists("day_0001.exr") && exists("day_0002.exr"));
    json_t *stats = load_json("day.json");
    assert_int_equal(json_array_size(json_object_get(stats, "frames")), 3);
    json_decref(stats);
    succeeds(SCENE "--env sky:day --day-frames 3 --frames 1 --spp 128 --out one.exr");
    assert_same_file("one.exr", "day_0001.exr");
    /* Frames that are there are left as they are. */
    write_text("day_0001.exr", "damaged");
    unlink("day_0002.exr");
    succeeds(SCENE "--env sky:day --day-frames 3 --spp 128 --out day_%04d.exr --resume --stats day.json");
    assert_same_file("one.exr", "day_0001.exr");
    stats = load_json("day.json");
    assert_int_equal(json_array_size(json_object_get(stats, "frames")), 2);
    json_decref(stats);
}

/* ---- when it stops ---- */

static void it_stops_at_a_time_or_an_error(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--strategy face+brdf --time 0.4 --out a.exr --stats a.json");
    json_t *stats = load_json("a.json");
    double seconds = number_of(first_frame(stats), "seconds");
    assert_true(seconds >= 0.4 && seconds < 30); /* a pass takes some milliseconds, but machines are busy */
    json_decref(stats);
    succeeds(SCENE "--strategy face+brdf --error 0.01 --out a.exr --stats a.json");
    stats = load_json("a.json");
    double error = number_of(first_frame(stats), "error"), passes = number_of(first_frame(stats), "passes");
    assert_true(error <= 0.01 && passes >= 8);
    json_decref(stats);
    /* One pass less would not have been enough, give or take what passes tell of it. */
    assert_true(passes == 8 || error > 0.008);
    succeeds(SCENE "--strategy face+brdf --error 1e-9 --spp 128 --out a.exr --stats a.json"); /* whatever is first */
    stats = load_json("a.json");
    assert_true(number_of(first_frame(stats), "spp") == 128);
    json_decref(stats);
    fails(SCENE "--camera lookat:eye=0,0,9,at=0,0,20 --error 0.1 --out a.exr", 1, "shows the object");
}

static void numbers_are_printed_alone(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    size_t before = count_files(".");
    succeeds(SCENE "--spp 128 --out a.exr --stats -");
    json_t *stats = json_loads(program_out, JSON_REJECT_DUPLICATES, NULL);
    assert_true(number_of(first_frame(stats), "spp") == 128);
    json_decref(stats);
    assert_int_equal(count_files("."), before + 1);
}

static void light_that_samples_hardly_meet_is_told(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds("reference --mesh tetrahedron.obj --size 20x15 --env-size 64 --spp 128 --out a.exr --quiet");
    assert_non_null(strstr(program_err, "warning: a tenth of the light comes from"));
    succeeds(
        "reference --mesh tetrahedron.obj --size 20x15 --env-size 64 --spp 128 --out a.exr --quiet --strategy face");
    succeeds("reference --mesh tetrahedron.obj --size 20x15 --spp 128 --out b.exr --quiet --env constant:1,1,1");
    assert_true(program_err[0] == 0);
}

/* ---- killed and resumed ---- */

#define LONG_RUN SCENE "--spp 19200 --ground plane --save-every 0.05 --out "

/* Whenever it is killed: amid a pass, amid the writing of a checkpoint, while the map is read. */
static void a_killed_and_resumed_reference_equals_an_unbroken_one(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    uint64_t random = 7;
    int kills = 0, resumed = 0, code = -1;
    succeeds(LONG_RUN "whole.exr");
    while (code != 0 && kills < 60) {
        pid_t child = start_program(LONG_RUN "broken.exr --resume --stats broken.json");
        if (kills < 6 || code == 0) {
            usleep(100000 + (useconds_t)(random_unit(&random) * 200000));
            kill(child, SIGKILL);
        }
        code = finish_program(child, NULL);
        assert_true(code == 0 || code == -SIGKILL);
        kills += code != 0;
        resumed += exists("broken.exr.checkpoint");
    }
    assert_int_equal(code, 0);
    if (resumed == 0)
        print_message("no run came far enough to leave a checkpoint: the machine is very slow\n");
    print_message("killed %d times, %d with a checkpoint\n", kills, resumed);
    assert_same_file("whole.exr", "broken.exr");
    assert_false(exists("broken.exr.checkpoint"));
}

/* The first signal writes what there is. */
static void an_interrupted_reference_writes_what_it_has(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--spp 6400 --out whole.exr");
    pid_t child = start_program(SCENE "--spp 2000000000 --save-every 0.05 --out broken.exr");
    for (int i = 0; i < 3000 && !exists("broken.exr.checkpoint"); i++)
        usleep(10000);
    kill(child, SIGINT);
    assert_int_equal(finish_program(child, NULL), 130);
    assert_non_null(strstr(program_err, "stopped; "));
    assert_non_null(strstr(program_err, "written to broken.exr; --resume goes on from broken.exr.checkpoint"));
    assert_true(exists("broken.exr") && exists("broken.exr.checkpoint"));
    fails(SCENE "--spp 6400 --out broken.exr", 1, "go on with it by --resume");
    assert_true(exists("broken.exr.checkpoint"));
    /* The count at which it stops is not what a reference is of. If more passes are done than are wanted, it is done.
     */
    succeeds(SCENE "--spp 6400 --out broken.exr --resume --stats broken.json");
    json_t *stats = load_json("broken.json");
    if (number_of(first_frame(stats), "spp") == 6400)
        assert_same_file("whole.exr", "broken.exr");
    assert_true(number_of(first_frame(stats), "resumed_passes") >= 1);
    json_decref(stats);
}

static void more_samples_can_be_added_later(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--spp 512 --out whole.exr");
    succeeds(SCENE "--spp 192 --out part.exr --keep-checkpoint");
    assert_true(exists("part.exr.checkpoint"));
    succeeds(SCENE "--spp 512 --out part.exr --resume --keep-checkpoint");
    assert_same_file("whole.exr", "part.exr");
    assert_true(exists("part.exr.checkpoint"));
    succeeds(SCENE "--spp 512 --out new.exr --resume"); /* nothing is there: it begins */
    assert_same_file("whole.exr", "new.exr");
}

static void checkpoints_of_something_else_are_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    succeeds(SCENE "--spp 128 --out a.exr --keep-checkpoint");
    fails(SCENE "--spp 256 --out a.exr --resume --rotate 10", 1, "another map");
    fails(SCENE "--spp 256 --out a.exr --resume --env constant:1,1,1", 1, "another map");
    fails(SCENE "--spp 256 --out a.exr --resume --material diffuse:0.5", 1, "another mesh, material or ground");
    fails(SCENE "--spp 256 --out a.exr --resume --camera orbit:azimuth=31", 1, "another camera or size");
    fails("reference --mesh tetrahedron.obj --env-size 16 --size 41x30 --spp 256 --out a.exr --resume", 1,
          "another camera or size");
    fails(SCENE "--spp 256 --out a.exr --resume --strategy face", 1, "another method or other settings");
    fails(SCENE "--spp 256 --out a.exr --resume --seed 1", 1, "another method or other settings");
    write_text("a.exr.checkpoint", "HELIOREF, but not really");
    fails(SCENE "--spp 256 --out a.exr --resume", 1, "a.exr.checkpoint");
    write_text("a.exr.checkpoint", "");
    fails(SCENE "--spp 256 --out a.exr --resume", 1, "is no checkpoint");
    unlink("a.exr.checkpoint");
    succeeds(SCENE "--spp 256 --out a.exr --resume");
}

static void a_full_disk_is_told_and_the_old_picture_stays(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_EXR);
    write_text("a.exr", "the old one");
    program_limits.file_size = 5000;
    assert_int_equal(run_program(SCENE "--spp 128 --save-every 0.05 --out a.exr"), 1);
    assert_non_null(strstr(program_err, "a.exr"));
    program_limits.file_size = 0;
    char text[64];
    read_text("a.exr", text, sizeof text);
    assert_string_equal(text, "the old one");
    assert_int_equal(count_files("."), 2); /* the mesh is the other */
}

/* ---- the command line ---- */

static void mistakes_are_told(void **state)
{
    (void)state;
    static const struct {
        const char *line, *word;
    } cases[] = {
        {"reference --method quadrature", "--visibility none"},
        {"reference --method quadrature --visibility none --spp 64", "leave --spp away"},
        {"reference --method quadrature --visibility none --time 4", "leave --time away"},
        {"reference --method cosine --strategy face", "give one of them"},
        {"reference --method exact", "cosine or quadrature"},
        {"reference --strategy auto", "product or product+brdf"},
        {"reference --spp 0", "whole number"},
        {"reference --error 1", "--error"},
        {"reference --out a.mp4", "video"},
        {"reference --out a.txt", "a.txt"},
        {"reference --aovs", "no option --aovs"},
        {"reference --method quadrature --visibility none --ground shadow", "catches shadows"},
        {"reference room.obj", "--mesh"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        fails(cases[i].line, 2, cases[i].word);
    fails("reference --mesh nothing.obj", 1, "nothing.obj");
    fails("reference --mesh tetrahedron.obj --env sky:day --out a.pfm", 2, "--frames N..N");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(pictures_come_with_their_errors),
        program_test(the_output_has_a_usual_name_and_other_kinds),
        program_test(quadrature_is_exact_and_much_like_samples),
        program_test(threads_change_no_bit),
        program_test(each_frame_has_a_reference_of_its_own),
        program_test(it_stops_at_a_time_or_an_error),
        program_test(numbers_are_printed_alone),
        program_test(light_that_samples_hardly_meet_is_told),
        program_test(a_killed_and_resumed_reference_equals_an_unbroken_one),
        program_test(an_interrupted_reference_writes_what_it_has),
        program_test(more_samples_can_be_added_later),
        program_test(checkpoints_of_something_else_are_refused),
        program_test(a_full_disk_is_told_and_the_old_picture_stays),
        program_test(mistakes_are_told),
    };
    return cmocka_run_group_tests(tests, set_up_program, tear_down_program);
}
