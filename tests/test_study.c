/* SPDX-License-Identifier: MIT
 * study: what its files say of a small scene, that they say the same, and that it goes on where it was stopped. */
#include "program.h"

#include <heliostat/image.h>

#include <ctype.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MAP_WIDTH = 32, MAP_HEIGHT = 16 };

/* ---- scenes -------------------------------------------------------------------------------- */

/* A sky with a bright spot, which no strategy finds hard and none finds trivial. */
static void write_spot(const char *path, int column)
{
    float rgba[MAP_HEIGHT][MAP_WIDTH][4];
    for (int y = 0; y < MAP_HEIGHT; y++)
        for (int x = 0; x < MAP_WIDTH; x++) {
            bool is_spot = y == 4 && x > column && x < column + 4;
            for (int c = 0; c < 3; c++)
                rgba[y][x][c] = (is_spot ? 20 : 0.5f) + 0.1f * (float)c;
            rgba[y][x][3] = 1;
        }
    helio_context *context = make_context(1, NULL);
    const helio_picture map = {.width = MAP_WIDTH, .height = MAP_HEIGHT, .rgba = rgba[0][0]};
    assert_ok(helio_picture_write(context, path, &map, NULL));
    helio_context_destroy(context);
}

static void write_map(const char *path)
{
    write_spot(path, 12);
}

#define SCENE "study --mesh tetrahedron.obj --size 64x36 --env-size 16 --envs map.pfm --threads 2 "
#define SMALL SCENE "--spp 4,16,64 --reference-spp 8192 " /* of all strategies */

static json_t *run_study(const char *words)
{
    char line[1024], path[256];
    const char *out = strstr(words, "--out ");
    assert_non_null(out);
    assert_true(snprintf(line, sizeof line, "%s -q", words) < (int)sizeof line);
    succeeds(line);
    assert_true(snprintf(path, sizeof path, "%.*s/study.json", (int)strcspn(out + 6, " "), out + 6) < (int)sizeof path);
    return load_json(path);
}

static const json_t *cell_at(const json_t *study, size_t index)
{
    const json_t *cell = json_array_get(member(study, "cells"), index);
    assert_non_null(cell);
    return cell;
}

/* ---- CSV ----------------------------------------------------------------------------------- */

/* The next field of a line, without its quotes, which no field of these tests holds within. *rest moves behind it. */
static void take_field(char **rest, char *field, size_t size)
{
    bool is_quoted = **rest == '"';
    char *start = *rest + is_quoted;
    size_t length = strcspn(start, is_quoted ? "\"" : ",\n");
    assert_true(length < size);
    memcpy(field, start, length);
    field[length] = 0;
    *rest = start + length + is_quoted;
    if (**rest == ',')
        ++*rest;
}

static void assert_field(const json_t *cell, const char *name, const char *field)
{
    const json_t *value = member(cell, name);
    char *end;
    if (json_is_string(value)) {
        assert_string_equal(json_string_value(value), field);
    } else if (json_is_null(value)) {
        assert_string_equal(field, "");
    } else {
        assert_true(json_is_number(value));
        assert_true(strtod(field, &end) == json_number_value(value)); /* both have the same nine digits */
        assert_true(end != field && *end == 0);
    }
}

static size_t compare_csv(const char *path, const json_t *study)
{
    static char text[1 << 16];
    char head[1024], field[256], name[64];
    read_text(path, text, sizeof text);
    char *line = text;
    size_t length = strcspn(line, "\n"), rows = 0;
    assert_true(length < sizeof head);
    memcpy(head, line, length);
    head[length] = 0;
    for (line += length + 1; *line != 0; line++, rows++) {
        char *names = head;
        while (*names != 0) {
            take_field(&names, name, sizeof name);
            take_field(&line, field, sizeof field);
            assert_field(cell_at(study, rows), name, field);
        }
        assert_true(*line == '\n');
    }
    return rows;
}

/* ---- the page ------------------------------------------------------------------------------ */

static int digit_of(char digit)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *place = strchr(digits, digit);
    return digit != 0 && place != NULL ? (int)(place - digits) : -1;
}

/* Decodes base64 up to the quote; fails the test where it is none, or where the bytes are no whole PNG. */
static void check_png(const char *text)
{
    static const unsigned char start[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const unsigned char end[] = {'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
    size_t length = strcspn(text, "\""), count = 0;
    unsigned char *bytes = malloc(length);
    assert_non_null(bytes);
    assert_true(length % 4 == 0);
    while (length > 0 && text[length - 1] == '=')
        length--;
    unsigned bits = 0;
    for (size_t i = 0; i < length; i++) {
        assert_true(digit_of(text[i]) >= 0);
        bits = bits << 6 | (unsigned)digit_of(text[i]);
        if (i % 4 > 0)
            bytes[count++] = (unsigned char)(bits >> (6 - 2 * (i % 4)));
    }
    assert_true(count > sizeof start + sizeof end);
    assert_memory_equal(bytes, start, sizeof start);
    assert_memory_equal(bytes + count - sizeof end, end, sizeof end);
    free(bytes);
}

/* Is every element closed, in the right order, and every attribute quoted? What browsers forgive XML does not. */
static void check_markup(const char *page)
{
    char open[32][16];
    size_t depth = 0;
    for (const char *tag = strchr(page, '<'); tag != NULL; tag = strchr(tag + 1, '<')) {
        char name[16];
        bool closes = tag[1] == '/';
        size_t length = strcspn(tag + 1 + closes, " \n/>"), end = strcspn(tag, ">");
        if (tag[1] == '!')
            continue;
        assert_true(length > 0 && length < sizeof name && tag[end] == '>');
        snprintf(name, sizeof name, "%.*s", (int)length, tag + 1 + closes);
        size_t quotes = 0;
        for (size_t i = 0; i < end; i++)
            quotes += tag[i] == '"';
        assert_true(quotes % 2 == 0);
        if (closes) {
            assert_true(depth > 0);
            assert_string_equal(open[--depth], name);
        } else if (tag[end - 1] != '/') {
            assert_true(depth < 32);
            strcpy(open[depth++], name);
        }
    }
    assert_int_equal(depth, 0);
}

static size_t check_pictures(const char *page)
{
    static const char uri[] = "src=\"data:image/png;base64,";
    size_t count = 0;
    for (const char *source = strstr(page, "src="); source != NULL; source = strstr(source + 1, "src=")) {
        assert_memory_equal(source, uri, strlen(uri)); /* and so nothing outside of the page */
        check_png(source + strlen(uri));
        count++;
    }
    return count;
}

static char *read_page(const char *path)
{
    enum { SIZE = 1 << 23 };
    char *page = malloc(SIZE);
    assert_non_null(page);
    read_text(path, page, SIZE);
    return page;
}

/* ---- tests --------------------------------------------------------------------------------- */

/* Quasi-random points make errors fall faster than -1/2; noise of twelve repetitions, few pixels and fewer normals may
 * make it look slower by 0.1. A bias of a tenth of the error at 64 samples would flatten the slope by less, one as
 * large by 0.12, so that the reference's bound below tells more of bias. */
static void errors_fall_as_they_must(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    json_t *study = run_study(SMALL "--repeat 12 --out s --materials diffuse:0.8;phong:kd=0.5,ks=0.5,n=20");
    size_t index;
    const json_t *curve;
    assert_int_equal(json_array_size(member(study, "cells")), 2 * 8 * 3);
    json_array_foreach(member(study, "curves"), index, curve)
    {
        double slope = number_of(curve, "slope");
        if (!(slope < -0.4 && slope > -1.6))
            fail_msg("%s on %s has slope %g", text_of(curve, "strategy"), text_of(curve, "material"), slope);
    }
    json_decref(study);
}

static void times_count_everything(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    json_t *study = run_study(SCENE "--env-size 256 --spp 4,512 --strategies face --out s --reference-spp 16");
    for (size_t i = 0; i < 2; i++) {
        const json_t *cell = cell_at(study, i);
        double parts = 0;
        static const char *const names[] = {"cube_ms", "tables_ms", "pools_ms", "primary_ms", "shade_ms"};
        for (int k = 0; k < 5; k++) {
            assert_true(number_of(cell, names[k]) > 0);
            parts += number_of(cell, names[k]);
        }
        /* Medians of single parts need not be of the same frame, so that their sum differs from the median of the
         * whole; but a part that is left out, or counted twice, would show. */
        assert_true(number_of(cell, "high_ms") >= number_of(cell, "total_ms"));
        assert_true(number_of(cell, "low_ms") <= number_of(cell, "total_ms"));
        assert_true(parts < 3 * number_of(cell, "high_ms") && parts > 0.3 * number_of(cell, "low_ms"));
    }
    assert_true(number_of(cell_at(study, 0), "passes") == 1);
    assert_true(number_of(cell_at(study, 1), "passes") == 4); /* 512 samples, 128 from each drawing of the pools */
    json_decref(study);
}

static void files_say_the_same(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    json_t *study =
        run_study(SCENE "--spp 4,16 --strategies face,brdf --sequence 3 --out s --materials diffuse:0.8;ggx:"
                        "base=1,0.8,0.3,metallic=1,roughness=0.3");
    assert_int_equal(compare_csv("s/study.csv", study), 2 * 2 * 2);
    /* Flicker is that of the spp which is shown. */
    assert_true(json_is_null(member(cell_at(study, 0), "flicker")));
    assert_true(number_of(cell_at(study, 1), "flicker") > 0);
    char *page = read_page("s/study.html");
    check_markup(page);
#ifdef HELIO_WITH_PNG
    assert_int_equal(check_pictures(page), 2 * (1 + 2 * 2));
#else
    assert_int_equal(check_pictures(page), 0);
#endif
    assert_null(strstr(page, "href="));
    assert_null(strstr(page, "<script"));
    assert_non_null(strstr(page, "<polyline"));
    free(page);
#ifdef HELIO_WITH_CAIRO
    assert_int_equal(count_files("s/curves"), 4);
#endif
    json_decref(study);
}

/* Cells of two environments, three strategies and two numbers of samples, of which the second one is shown. */
static double relmse_of(const json_t *study, size_t environment, size_t strategy)
{
    return number_of(cell_at(study, (environment * 3 + strategy) * 2 + 1), "relmse");
}

static const json_t *ratio_at(const json_t *study, size_t strategy, size_t place, const char *against)
{
    const json_t *ratio = json_array_get(member(study, "ratios"), 4 * strategy + place);
    assert_non_null(ratio);
    assert_string_equal(text_of(ratio, "against"), against);
    assert_true(number_of(ratio, "spp") == 16);
    return ratio;
}

/* Files have nine digits. */
static bool is_near(double value, double expected)
{
    return fabs(value / expected - 1) < 1e-6;
}

static void compare_ratio(const json_t *study, const char *tables, size_t strategy)
{
    static const char *const names[] = {"map", "constant:1,0.5,0.25"};
    const json_t *ratio = ratio_at(study, strategy, 0, "face");
    double parts[2];
    char cell[128];
    for (size_t i = 0; i < 2; i++)
        parts[i] = relmse_of(study, i, strategy) / relmse_of(study, i, 0);
    assert_true(is_near(number_of(ratio, "mean"), sqrt(parts[0] * parts[1])));
    assert_true(is_near(number_of(ratio, "worst"), fmax(parts[0], parts[1])));
    assert_string_equal(text_of(ratio, "worst_environment"), names[parts[1] > parts[0]]);
    snprintf(cell, sizeof cell, "| `%s` | %.3g (%.3g, %s) |", text_of(ratio, "strategy"), number_of(ratio, "mean"),
             number_of(ratio, "worst"), text_of(ratio, "worst_environment"));
    if (strstr(tables, cell) == NULL)
        fail_msg("the tables have no cell %s", cell);
}

static void holds_strategies_against_others(void **state)
{
    static char tables[1 << 14];
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    json_t *study = run_study(SCENE "--spp 4,16 --show-spp 16 --strategies face,light+brdf,product --reference-spp 256 "
                                    "--out s --envs map.pfm;constant:1,0.5,0.25");
    read_text("s/study.md", tables, sizeof tables);
    assert_int_equal(json_array_size(member(study, "ratios")), 3 * 4);
    compare_ratio(study, tables, 1);
    compare_ratio(study, tables, 2);
    /* In the time of face it has the samples that it has, and no strategy is better or worse than itself. */
    assert_string_equal(text_of(ratio_at(study, 0, 1, "face"), "time_of"), "face");
    assert_true(is_near(number_of(ratio_at(study, 0, 1, "face"), "mean"), 1));
    assert_true(is_near(number_of(ratio_at(study, 1, 2, "light+brdf"), "mean"), 1));
    assert_non_null(strstr(tables, " (16) |\n| `light+brdf` |"));
    json_decref(study);
}

static void assert_same_errors(const json_t *study, const json_t *other)
{
    static const char *const names[] = {"relmse",  "rmse",         "lab_mean",      "flip",
                                        "flicker", "useful_share", "reference_rmse"};
    size_t count = json_array_size(member(study, "cells"));
    assert_int_equal(count, json_array_size(member(other, "cells")));
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < sizeof names / sizeof names[0]; k++)
            assert_true(json_equal(member(cell_at(study, i), names[k]), member(cell_at(other, i), names[k])));
}

static size_t count_cells(const char *path)
{
    json_t *study = load_json(path);
    size_t count = json_array_size(member(study, "cells"));
    json_decref(study);
    return count;
}

static void goes_on_where_it_was_killed(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
#define LONGER SCENE "--spp 4,64,1024 --strategies face,brdf,cosine --sequence 2 --repeat 5 -v --out "
    json_t *unbroken = run_study(SCENE "--spp 4,64,1024 --strategies face,brdf,cosine --sequence 2 --repeat 5 --out a");
    pid_t child = start_program(LONGER "b");
    assert_true(program_says("face, 64 spp"));
    kill(child, SIGKILL);
    assert_int_equal(finish_program(child, NULL), -SIGKILL);
    size_t before = count_cells("b/study.json");
    assert_true(before >= 1 && before < 9); /* killed after the second one was told, before or after it was written */
    fails(LONGER "b", 1, "--resume");
    succeeds(LONGER "b --resume");
    json_t *resumed = load_json("b/study.json");
    assert_same_errors(unbroken, resumed);
    json_decref(unbroken);
    json_decref(resumed);
}

static void stops_when_asked(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    pid_t child = start_program(SCENE "--spp 4,65536 --strategies cosine --repeat 101 -v --out s");
    assert_true(program_says("cosine, 4 spp"));
    kill(child, SIGINT);
    assert_int_equal(finish_program(child, NULL), 128 + SIGINT);
    assert_non_null(strstr(program_err, "--resume"));
    assert_int_equal(count_cells("s/study.json"), 1);
    assert_false(exists("s/study.html"));
}

/* A study with other settings, or of another map, is none to go on with. */
static void tells_studies_apart(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
#define TWO SCENE "--strategies face,brdf --reference-spp 64 --out s "
    json_t *study = run_study(TWO "--spp 4");
    fails(TWO "--spp 4 --resume --seed 2", 1, "seed");
    fails(TWO "--spp 16 --resume", 1, "4 spp");
    json_t *more = run_study(TWO "--spp 4,16 --resume");
    assert_int_equal(json_array_size(member(more, "cells")), 4);
    assert_true(json_equal(cell_at(study, 0), cell_at(more, 0)));
    json_decref(study);
    json_decref(more);
    write_text("map.pfm", "PF\n1 1\n-1\n            "); /* all bytes are blanks: 1.3e-19 */
    succeeds(TWO "--spp 4,16 --resume");
    assert_non_null(strstr(program_err, "measured again"));
}

static void takes_options_from_a_file(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    write_text("study.txt",
               "{\"mesh\": \"tetrahedron.obj\", \"size\": \"64x36\", \"env-size\": 16, \"envs\": [\"map.pfm\", "
               "\"constant:1,0.5,0.25\"], \"materials\": [\"diffuse:0.8,0.4,0.2\"], \"spp\": [4, 16], "
               "\"strategies\": [\"face\"], \"no-beta\": true, \"reference-spp\": 64, \"out\": \"s\"}");
    json_t *study = run_study("study --study study.txt --spp 8 --out s");
    assert_int_equal(json_array_size(member(study, "cells")), 2);
    assert_true(number_of(cell_at(study, 0), "spp") == 8);
    assert_string_equal(text_of(cell_at(study, 0), "material"), "diffuse:0.8,0.4,0.2");
    assert_string_equal(text_of(cell_at(study, 1), "environment"), "constant:1,0.5,0.25");
    assert_true(json_is_true(member(member(study, "settings"), "no-beta")));
    json_decref(study);
    write_text("study.txt", "{\"strategies\": {\"face\": 1}}");
    fails("study --study study.txt", 2, "strategies");
    write_text("study.txt", "{\"strategy\": \"face\"}");
    fails("study --study study.txt", 2, "study.txt: there is no key \"strategy\"; did you mean \"strategies\"?");
    write_text("study.txt", "{\"colour\": 1}");
    fails("study --study study.txt", 2, "study.txt: there is no key \"colour\";");
    write_text("study.txt", "{\"spp=4\": true}");
    fails("study --study study.txt", 2, "study.txt: there is no key \"spp=4\";");
    write_text("study.txt", "{\"spp\": 4,}");
    fails("study --study study.txt", 1, "line 1");
    write_text("study.txt", "[]");
    fails("study --study study.txt", 1, "no object");
    fails("study --study none.txt", 1, "heliostat: none.txt cannot be read: No such file or directory\n");
}

/* An option behind a colon is the option of the same name, for this strategy alone. */
static void gives_strategies_options(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
#define PLAIN SCENE "--spp 16 --repeat 2 --reference-spp 64 --show-spp all "
    json_t *study = run_study(PLAIN "--strategies face,face:no-beta,light+brdf:brdf-share=0.2:weighting=paper --out a");
    json_t *no_beta = run_study(PLAIN "--strategies face --no-beta --out b");
    json_t *light = run_study(PLAIN "--strategies light+brdf --brdf-share 0.2 --weighting paper --out c");
    assert_string_equal(text_of(cell_at(study, 1), "strategy"), "face:no-beta");
    assert_true(number_of(cell_at(study, 0), "rmse") != number_of(cell_at(study, 1), "rmse"));
    assert_true(number_of(cell_at(study, 1), "rmse") == number_of(cell_at(no_beta, 0), "rmse"));
    assert_true(number_of(cell_at(study, 2), "rmse") == number_of(cell_at(light, 0), "rmse"));
    json_decref(study);
    json_decref(no_beta);
    json_decref(light);
}

/* The frames of a day are those of the sequence; each file of a pattern is a map of its own. */
static void finds_environments(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("a.pfm");
    write_map("b.pfm");
    json_t *study =
        run_study("study --mesh tetrahedron.obj --size 32x18 --env-size 16 --spp 4 --strategies face --reference-"
                  "spp 16 --repeat 1 --sequence 3 --out s --envs ?.pfm,sky:day,albedo=0.3");
    assert_int_equal(json_array_size(member(study, "cells")), 3);
    assert_string_equal(text_of(cell_at(study, 0), "environment"), "a");
    assert_string_equal(text_of(cell_at(study, 2), "environment"), "sky:day,albedo=0.3");
    assert_true(number_of(cell_at(study, 2), "flicker") > 0);
    json_decref(study);
}

/* With one seed and a light that stands still all frames are the same; with new samples in each, flicker is relMSE but
 * for chance: 500 pixels whose errors are alike in some twenty groups, or in the windows of a few pools, over 4
 * changes. */
static void flicker_is_between_still_and_new(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
#define NOISE                                                                                                          \
    SCENE "--spp 16 --strategies face,product+brdf --frames 5..9 --turn 0 --repeat 1 --pictures 0 --materials "
    json_t *still = run_study(NOISE "diffuse:0.8 --reference-spp 64 --out a");
    json_t *noise = run_study(NOISE "diffuse:0.8 --reference-spp 1024 --seed-mode frame --out b");
    for (size_t i = 0; i < 2; i++) {
        const json_t *cell = cell_at(noise, i);
        double ratio = number_of(cell, "flicker_ratio");
        assert_true(number_of(cell_at(still, i), "flicker") == 0);
        assert_true(number_of(cell_at(still, i), "sequence_relmse") > 0);
        assert_true(is_near(ratio, number_of(cell, "flicker") / number_of(cell, "sequence_relmse")));
        if (!(fabs(ratio - 1) < 0.2))
            fail_msg("new samples flicker by %g of their error", ratio);
    }
    json_decref(still);
    json_decref(noise);
}

static const json_t *flicker_ratio_at(const json_t *study, size_t strategy, size_t place)
{
    const json_t *ratio = json_array_get(member(study, "ratios"), 8 * strategy + 4 + place); /* after those of relMSE */
    assert_non_null(ratio);
    assert_string_equal(text_of(ratio, "of"), "flicker");
    return ratio;
}

static void holds_flicker_against_others(void **state)
{
    static char tables[1 << 14];
    (void)state;
    skip_without(NEEDS_RENDERER);
#define DAY "study --mesh tetrahedron.obj --size 64x36 --env-size 16 --envs sky:day --day-frames 240 --threads 2 "
    succeeds(DAY "--frames 100..102 --spp 4,16 --show-spp 16 --strategies face,light+brdf --reference-spp 256 --out s");
    json_t *study = load_json("s/study.json");
    double parts = number_of(cell_at(study, 3), "flicker") / number_of(cell_at(study, 1), "flicker");
    assert_int_equal(json_array_size(member(study, "ratios")), 2 * 8);
    assert_true(is_near(number_of(flicker_ratio_at(study, 1, 0), "mean"), parts));
    assert_true(is_near(number_of(flicker_ratio_at(study, 0, 1), "mean"), 1)); /* face in its own time */
    assert_non_null(strstr(program_out, "of relMSE"));
    read_text("s/study.md", tables, sizeof tables);
    assert_non_null(strstr(tables, "16 spp | flicker | / relMSE | in "));
    char *page = read_page("s/study.html");
    check_markup(page);
    assert_non_null(strstr(page, "<caption>Flicker"));
    free(page);
    fails(DAY "--frames 100..103 --spp 4,16 --strategies face,light+brdf --reference-spp 256 --out s --resume", 1,
          "another frames");
    fails(DAY "--sequence 3 --frames 0..2", 2, "--frames");
    fails(DAY "--frames 0..1000", 2, "1000");
    fails(DAY "--frames 240..241 --out t", 2, "240");
    json_decref(study);
}

/* Of seven files the one in the middle is studied as if it were alone, though others have been read since. */
static void keeps_the_frames_of_files(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    for (int i = 0; i < 7; i++) {
        char path[32];
        snprintf(path, sizeof path, "f_%d.pfm", i);
        write_spot(path, 3 * i);
    }
#define ONE SCENE "--spp 16 --strategies face --repeat 1 --reference-spp 16 --pictures 0 "
    json_t *sequence = run_study(ONE "--envs f_%d.pfm --frames 0..6 --out a");
    json_t *alone = run_study(ONE "--envs f_3.pfm --out b");
    assert_true(json_equal(member(cell_at(sequence, 0), "rmse"), member(cell_at(alone, 0), "rmse")));
    json_decref(sequence);
    json_decref(alone);
}

/* auto knows when not to look at the light, which product+brdf does not. */
static void studies_auto_as_it_is(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    json_t *study = run_study("study --mesh tetrahedron.obj --size 32x18 --env-size 32 --spp 16 --repeat 1 --materials "
                              "diffuse:0.8 --envs constant:1,1,1 --strategies auto,product+brdf,auto:brdf-share=0.4 "
                              "--reference-spp 4096 --out s");
    assert_string_equal(text_of(cell_at(study, 0), "strategy"), "auto");
    assert_string_equal(text_of(cell_at(study, 2), "strategy"), "auto:brdf-share=0.4");
    assert_true(number_of(cell_at(study, 0), "rmse") < number_of(cell_at(study, 1), "rmse") / 5);
    json_decref(study);
}

#define TRUTH SCENE "--size 32x18 --spp 16 --strategies face --repeat 1 --materials diffuse:0.8 "

/* Two references differ, as RMSE, by about the root of the sum of their squared standard errors; and errors against
 * them by no more than they do. Twice that leaves room for the chance that samples are. */
static void takes_quadrature_for_the_truth(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    write_map("map.pfm");
    static const char *const aa[] = {"1", "2"};
    for (int i = 0; i < 2; i++) {
        char words[512];
        snprintf(words, sizeof words, TRUTH "--aa %s --reference-method quadrature --out a%s", aa[i], aa[i]);
        json_t *exact = run_study(words);
        snprintf(words, sizeof words, TRUTH "--aa %s --reference-spp 16384 --out b%s", aa[i], aa[i]);
        json_t *noisy = run_study(words);
        double bound = number_of(cell_at(exact, 0), "reference_rmse");
        double noise = number_of(cell_at(noisy, 0), "reference_rmse");
        double error = number_of(cell_at(exact, 0), "rmse");
        assert_true(noise < error / 5 && bound < (i == 0 ? noise / 100 : error / 5));
        assert_true(fabs(error - number_of(cell_at(noisy, 0), "rmse")) < 2 * hypot(bound, noise));
        json_decref(exact);
        json_decref(noisy);
    }
    fails(TRUTH "--reference-spp 16384 --out a1 --resume", 1, "reference-method");
}

static void refuses_what_makes_no_study(void **state)
{
    (void)state;
    write_map("map.pfm");
    fails(SCENE "--strategies face,face", 2, "twice");
    fails(SCENE "--strategies path", 2, "strategies");
    fails(SCENE "--strategies face:shiny", 2, "shiny");
    fails(SCENE "--strategies face:brdf-share=2", 2, "brdf-share=2");
    fails(SCENE "--spp 4,4", 2, "twice");
    fails(SCENE "--spp 4,none", 2, "not 'none'");
    fails(SCENE "--spp 4,16,x", 2, "not 'x'");
    fails(SCENE "--spp 4,x,16", 2, "not 'x'");
    fails(SCENE "--spp 4,16 --show-spp 4,x,16", 2, "not 'x'");
    fails(SCENE "--spp 4,16 --show-spp 8", 2, "--show-spp");
    fails(SCENE "--materials gold", 2, "materials");
    fails(SCENE "--ground shadow", 2, "--ground");
    fails(SCENE "--reference-method quadrature --visibility ray", 2, "--visibility none");
    fails(SCENE "--envs ,", 2, "--envs");
    fails("study --envs none/*.exr", 1, "none/*.exr");
    fails(SCENE "word", 2, "word");
    assert_false(exists("heliostat-study"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(errors_fall_as_they_must),
        program_test(times_count_everything),
        program_test(files_say_the_same),
        program_test(goes_on_where_it_was_killed),
        program_test(stops_when_asked),
        program_test(tells_studies_apart),
        program_test(takes_options_from_a_file),
        program_test(finds_environments),
        program_test(gives_strategies_options),
        program_test(takes_quadrature_for_the_truth),
        program_test(holds_strategies_against_others),
        program_test(flicker_is_between_still_and_new),
        program_test(holds_flicker_against_others),
        program_test(keeps_the_frames_of_files),
        program_test(studies_auto_as_it_is),
        program_test(refuses_what_makes_no_study),
    };
    return cmocka_run_group_tests_name("study", tests, set_up_program, tear_down_program);
}
