/* SPDX-License-Identifier: MIT
 * heliostat bench: what it prints and writes. That its figures are there and fit together, not how large they are: no
 * machine is too slow for these tests. */
#include "bench_series.h"
#include "list.h"
#include "program.h"
#include "scene/mesh_process.h"

#include <math.h>
#include <signal.h>
#include <string.h>

/* Everything, as small as it goes. */
#define SMALL                                                                                                          \
    "bench --env constant:1,1,1 --mesh tetrahedron.obj --size 64x36 --env-size 8,4 --map-size 16x8,8x4 --spp 4,200 "   \
    "--threads 2,1 --repeat 2 --mesh-size 100,200 "

static void succeeds_silently(const char *line)
{
    succeeds(line);
    assert_string_equal(program_err, "");
}

static uint32_t isa_count(void)
{
    uint32_t count = 0;
    while (helio_isa_name(count) != NULL)
        count++;
    return count;
}

/* ---- series and lists ------------------------------------------------------------------- */

static void test_spread_is_median_and_quartiles(void **state)
{
    (void)state;
    bench_series series = {0};
    bench_spread spread = bench_series_spread(&series);
    assert_int_equal(spread.repeats, 0);
    bench_series_add(&series, 7);
    spread = bench_series_spread(&series);
    assert_true(spread.median == 7 && spread.low == 7 && spread.high == 7 && spread.repeats == 1);
    static const double more[] = {1, 5, 3};
    for (int i = 0; i < 3; i++)
        bench_series_add(&series, more[i]);
    spread = bench_series_spread(&series); /* 1 3 5 7 */
    assert_true(spread.median == 4 && spread.low == 2.5 && spread.high == 5.5 && spread.repeats == 4);
    spread = bench_spread_rate(spread, 20);
    assert_true(spread.median == 5 && spread.low == 20 / 5.5 && spread.high == 8 && spread.repeats == 4);
}

static void test_series_hold_no_more_than_they_can(void **state)
{
    (void)state;
    bench_series series = {0};
    for (int i = 0; i < BENCH_REPEATS + 10; i++)
        bench_series_add(&series, i);
    assert_int_equal(series.count, BENCH_REPEATS);
    assert_true(bench_series_spread(&series).median == (BENCH_REPEATS - 1) / 2.0);
}

static void test_lists_are_divided_at_commas(void **state)
{
    (void)state;
    char item[LIST_ITEM];
    const char *list = "face,light+brdf";
    assert_true(list_take(&list, item));
    assert_string_equal(item, "face");
    assert_true(list_take(&list, item));
    assert_string_equal(item, "light+brdf");
    assert_null(list);
    static const char *const bad[] = {"", ",a"};
    for (size_t i = 0; i < 2; i++) {
        list = bad[i];
        assert_false(list_take(&list, item));
    }
    list = "a,"; /* a comma promises another item */
    assert_true(list_take(&list, item));
    assert_non_null(list);
    assert_false(list_take(&list, item));
    char longest[LIST_ITEM + 1];
    memset(longest, 'a', LIST_ITEM);
    longest[LIST_ITEM] = 0;
    list = longest;
    assert_false(list_take(&list, item));
}

static void test_specifications_keep_their_commas(void **state)
{
    (void)state;
    static const char *const items[] = {"diffuse:0.8,0.2,0.1", "ggx", "phong:kd=0.5,0.4,0.3,n=120", "diffuse"};
    const char *list = "diffuse:0.8,0.2,0.1,ggx,phong:kd=0.5,0.4,0.3,n=120,diffuse";
    char item[LIST_ITEM];
    for (size_t i = 0; i < 4; i++) {
        assert_true(list_take_specification(&list, item));
        assert_string_equal(item, items[i]);
    }
    assert_null(list);
}

/* ---- the report ------------------------------------------------------------------------- */

static bool is_positive(const json_t *object, const char *key)
{
    double number = number_of(object, key);
    return isfinite(number) && number > 0;
}

/* Results of a stage; of all stages where it is NULL. */
static size_t count_results(const json_t *report, const char *stage)
{
    size_t index, count = 0;
    json_t *result;
    json_array_foreach(json_object_get(report, "results"), index, result) count +=
        stage == NULL || strcmp(text_of(result, "stage"), stage) == 0;
    return count;
}

static bool has_result(const json_t *report, const char *stage, const char *key, const json_t *value)
{
    size_t index;
    json_t *result;
    json_array_foreach(json_object_get(report, "results"), index,
                       result) if (strcmp(text_of(result, "stage"), stage) == 0 &&
                                   json_equal(json_object_get(result, key), value)) return true;
    return false;
}

static void check_text_there(const json_t *report, const char *stage, const char *key, const char *text)
{
    json_t *value = json_string(text);
    if (!has_result(report, stage, key, value))
        fail_msg("no result of %s has %s %s", stage, key, text);
    json_decref(value);
}

static void check_number_there(const json_t *report, const char *stage, const char *key, json_int_t number)
{
    json_t *value = json_integer(number);
    if (!has_result(report, stage, key, value))
        fail_msg("no result of %s has %s %d", stage, key, (int)number);
    json_decref(value);
}

static void check_machine(const json_t *report)
{
    const json_t *machine = json_object_get(report, "machine"), *sets = json_object_get(machine, "isa");
    assert_true(strlen(text_of(machine, "processor")) > 0);
    assert_string_equal(text_of(machine, "version"), HELIO_VERSION_TEXT);
    assert_true(number_of(machine, "cores") >= 1);
    assert_int_equal(json_array_size(sets), isa_count());
    for (uint32_t i = 0; i < isa_count(); i++)
        assert_string_equal(json_string_value(json_array_get(sets, i)), helio_isa_name(i));
    assert_true(is_positive(report, "fma_peak_gflops"));
    assert_true(is_positive(report, "memcpy_gb_per_s"));
}

/* What every result has. */
static void check_figure(const json_t *result, uint32_t repeats)
{
    static const char *const units[] = {"ms", "GB/s", "GFLOPS", "M samples/s", "M rays/s", "frames/s"};
    bool known = false;
    for (size_t i = 0; i < sizeof units / sizeof units[0]; i++)
        known = known || strcmp(text_of(result, "unit"), units[i]) == 0;
    assert_true(known);
    assert_true(is_positive(result, "median"));
    assert_true(number_of(result, "quartile_low") <= number_of(result, "median"));
    assert_true(number_of(result, "quartile_high") >= number_of(result, "median"));
    assert_true(number_of(result, "repeats") >= 1 && number_of(result, "repeats") <= repeats);
    assert_true(number_of(result, "threads") >= 1);
}

static void check_frame(const json_t *result)
{
    static const char *const names[] = {"cube_ms", "tables_ms", "pools_ms", "primary_ms", "shade_ms"};
    const json_t *parts = json_object_get(result, "parts");
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        assert_true(number_of(parts, names[i]) >= 0);
    bool is_traced = strcmp(text_of(result, "camera_rays"), "traced") == 0;
    assert_true((number_of(parts, "primary_ms") > 0) == is_traced);
    double coverage = number_of(result, "coverage");
    assert_true(coverage > 0.3 && coverage < 0.5); /* about 0.4, in few pixels */
    assert_true(is_positive(result, "spp") && is_positive(result, "triangles"));
    assert_true(strlen(text_of(result, "material")) > 0 && strlen(text_of(result, "strategy")) > 0);
    assert_int_equal(json_array_size(json_object_get(result, "size")), 2);
}

static void check_result(const json_t *result)
{
    const char *stage = text_of(result, "stage");
    check_figure(result, 2);
    if (strcmp(stage, "memcpy") != 0)
        assert_true(strlen(text_of(result, "isa")) > 0);
    if (strcmp(stage, "cube") == 0 || strcmp(stage, "tables") == 0)
        assert_true(is_positive(result, "ratio_to_memcpy") && is_positive(result, "env_size"));
    if (strcmp(stage, "estimate") == 0)
        assert_true(is_positive(result, "share_of_fma_peak") && is_positive(result, "flops_per_sample") &&
                    is_positive(result, "samples_per_second"));
    if (strcmp(stage, "frame") == 0 || strcmp(stage, "camera_rays") == 0 || strcmp(stage, "shadow_rays") == 0)
        check_frame(result);
}

static void test_report_holds_every_stage_and_every_value(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    succeeds_silently(SMALL "--strategy face,cosine --material diffuse:0.8,0.2,0.1,ggx --json a.json");
    json_t *report = load_json("a.json"), *result;
    size_t index, sets = isa_count();
    check_machine(report);
    json_array_foreach(json_object_get(report, "results"), index, result) check_result(result);

    assert_int_equal(count_results(report, "memcpy"), 2);            /* threads */
    assert_int_equal(count_results(report, "fma"), 2 * sets);        /* threads, instruction sets */
    assert_int_equal(count_results(report, "cube"), 2 + 2 + 2);      /* maps, cubes, threads */
    assert_int_equal(count_results(report, "tables"), sets + 2 + 2); /* instruction sets, cubes, threads */
    assert_int_equal(count_results(report, "pools"), sets + 2 + 2);
    assert_int_equal(count_results(report, "estimate"), 2 * 2 * sets + 2 + 2); /* the matrix, samples, threads */
    assert_int_equal(count_results(report, "scene"), 3 + 2);                   /* meshes, threads */
    assert_int_equal(count_results(report, "camera_rays"), 3);
    assert_int_equal(count_results(report, "shadow_rays"), 3);
    assert_int_equal(count_results(report, "frame"), 2 + 2 + 2); /* camera rays, samples, threads */

    check_number_there(report, "tables", "env_size", 4);
    check_number_there(report, "tables", "threads", 1);
    check_number_there(report, "estimate", "spp", 4);
    check_number_there(report, "estimate", "spp", 200);
    check_text_there(report, "estimate", "material", "diffuse:0.8,0.2,0.1");
    check_text_there(report, "estimate", "material", "ggx");
    check_text_there(report, "estimate", "strategy", "cosine");
    check_text_there(report, "shadow_rays", "mesh", "tetrahedron.obj");
    check_number_there(report, "shadow_rays", "triangles", 4);
    check_text_there(report, "shadow_rays", "visibility", "ray");
    check_text_there(report, "frame", "camera_rays", "kept");
    check_text_there(report, "frame", "camera_rays", "traced");
    for (uint32_t i = 0; i < sets; i++) {
        check_text_there(report, "fma", "isa", helio_isa_name(i));
        check_text_there(report, "tables", "isa", helio_isa_name(i));
        check_text_there(report, "estimate", "isa", helio_isa_name(i));
    }
    json_decref(report);
}

static void test_table_shows_each_stage(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    succeeds_silently(SMALL "--isa best");
    static const char *const words[] = {"memcpy", "peak",        "Map into cube", "Tables", "Pools", "Estimate",
                                        "rays",   "Camera rays", "Shadow rays",   "Frames", "####"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strstr(program_out, words[i]) == NULL)
            fail_msg("the table does not show %s", words[i]);
    assert_null(strchr(program_out, '\r')); /* progress is for terminals */
    assert_false(exists("bench.json"));
}

static void test_stages_and_quick_limit_the_work(void **state)
{
    (void)state;
    succeeds_silently("bench --quick --stages tables --env constant:1,1,1 --env-size 4,8 --map-size 8x4 --json -");
    json_t *report = load_json("../out"); /* JSON alone is on standard output */
    assert_int_equal(count_results(report, "memcpy"), 1);
    assert_int_equal(count_results(report, "fma"), 1);
    assert_int_equal(count_results(report, "tables"), 1);
    assert_int_equal(count_results(report, NULL), 3);
    check_number_there(report, "tables", "env_size", 4);
    size_t index;
    json_t *result;
    json_array_foreach(json_object_get(report, "results"), index, result) check_figure(result, 3);
    json_decref(report);
}

static void test_instruction_sets_are_those_asked_for(void **state)
{
    (void)state;
    succeeds_silently(
        "bench --stages pools --isa scalar --repeat 1 --env constant:1,1,1 --env-size 4 --map-size 8x4 --threads 1 "
        "--json a.json -q");
    assert_int_equal(program_out[0], 0); /* -q */
    json_t *report = load_json("a.json");
    assert_int_equal(count_results(report, "fma"), 1);
    check_text_there(report, "pools", "isa", "scalar");
    assert_int_equal(count_results(report, "pools"), 1);
    json_decref(report);
}

/* ---- refusals ---------------------------------------------------------------------------- */

static void test_bad_command_lines_are_refused_in_one_sentence(void **state)
{
    (void)state;
    static const struct {
        const char *line, *word; /* that the sentence holds */
    } table[] = {
        {"bench --stages paint", "paint"},
        {"bench --stages tables,", "--stages takes"},
        {"bench --repeat 0", "1 to 101"},
        {"bench --repeat 102", "102"},
        {"bench --threads 0", "--threads"},
        {"bench --threads 1,x", "1,x"},
        {"bench --threads 1,,2", "1,,2"},
        {"bench --threads 1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1", "up to 16"},
        {"bench --isa mmx", "mmx"},
        {"bench --env-size 4097", "4096"},
        {"bench --map-size 1024", "1024x512"},
        {"bench --map-size 1024x", "1024x"},
        {"bench --spp 0", "--spp"},
        {"bench --mesh-size many", "many"},
        {"bench --strategy faces", "face+brdf"},
        {"bench --material wood", "wood"},
        {"bench --material diffuse:0.8,phong:kd=0.9,ks=0.9", "kd + ks"},
        {"bench --env sky:noon", "sky:noon"},
        {"bench --quick=1", "--quick"},
        {"bench --jsn a", "did you mean --json?"},
        {"bench --out a.png", "--out"},
        {"bench map.hdr", "map.hdr"},
        {"benhc", "did you mean bench?"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        fails(table[i].line, 2, table[i].word);
}

static void test_failures_exit_1_and_leave_nothing(void **state)
{
    (void)state;
    fails("bench --env missing.hdr --json b.json", 1, "missing.hdr");
    fails("bench --json nowhere/b.json", 1, "nowhere/");
    fails("bench --json .", 1, "directory");
    fails("bench --mesh tetrahedron.obj --json ./tetrahedron.obj", 1, "replace an input");
    write_text("map.pfm", "PF\n2 1\n-1\n012301230123012301230123");
    fails("bench --env map.pfm --max-pixels 1 --json b.json", 1, "--max-pixels");
    assert_false(exists("b.json"));
}

#ifdef HELIO_WITH_ASSIMP

static void test_limits_hold_for_the_mesh(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    if (!mesh_process_limits_memory) {
        print_message("skipped: with this sanitizer address space has no limit\n");
        skip();
    }
    fails("bench --stages scene --env constant:1,1,1 --mesh tetrahedron.obj --max-mesh-memory 1 --quick -q", 1,
          "tetrahedron.obj needs more than the 1 MiB of memory allowed for reading it");
    assert_non_null(strstr(program_err, "--max-mesh-memory"));
}

#endif

/* The table comes part by part, so that it tells when the work is under way. */
static void test_interrupt_stops_without_a_report(void **state)
{
    (void)state;
    pid_t child =
        start_program("bench --stages tables,estimate --isa best --env constant:1,1,1 --env-size 8 --map-size 16x8 "
                      "--repeat 101 --spp 65536 --json b.json");
    bool has_begun = program_says("memcpy");
    kill(child, SIGINT);
    int code = finish_program(child, NULL);
    assert_true(has_begun);
    assert_int_equal(code, 130);
    assert_non_null(strstr(program_err, "stopped"));
    assert_false(exists("b.json"));
}

/* ---- help ---------------------------------------------------------------------------------- */

static void test_help_tells_every_option(void **state)
{
    (void)state;
    static const char *const options[] = {"--stages",   "--repeat",     "--quick",           "--isa",
                                          "--threads",  "--env ",       "--mesh ",           "--size",
                                          "--json",     "--map-size",   "--env-size",        "--strategy",
                                          "--material", "--max-pixels", "--max-mesh-memory", "--max-mesh-seconds"};
    succeeds_silently("bench --help");
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        if (strstr(program_out, options[i]) == NULL)
            fail_msg("bench --help does not tell of %s", options[i]);
    for (const char *line = program_out; *line != 0; line += strcspn(line, "\n") + 1)
        assert_true(strcspn(line, "\n") <= 100);
    succeeds_silently("--help");
    assert_non_null(strstr(program_out, "bench"));
    succeeds_silently("help --man");
    assert_non_null(strstr(program_out, "bench"));
    assert_non_null(strstr(program_out, "map\\-size"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(test_spread_is_median_and_quartiles),
        program_test(test_series_hold_no_more_than_they_can),
        program_test(test_lists_are_divided_at_commas),
        program_test(test_specifications_keep_their_commas),
        program_test(test_report_holds_every_stage_and_every_value),
        program_test(test_table_shows_each_stage),
        program_test(test_stages_and_quick_limit_the_work),
        program_test(test_instruction_sets_are_those_asked_for),
        program_test(test_bad_command_lines_are_refused_in_one_sentence),
        program_test(test_failures_exit_1_and_leave_nothing),
#ifdef HELIO_WITH_ASSIMP
        program_test(test_limits_hold_for_the_mesh),
#endif
        program_test(test_interrupt_stops_without_a_report),
        program_test(test_help_tells_every_option),
    };
    return cmocka_run_group_tests(tests, set_up_program, tear_down_program);
}
