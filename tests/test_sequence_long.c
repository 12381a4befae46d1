/* SPDX-License-Identifier: MIT
 *
 * Ten thousand frames through the program: its memory does not grow with their number. */
#include "program.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>

/* Peak memory of a day of so many tiny frames, in KiB. */
static long peak_of(unsigned frames)
{
    char line[256];
    struct rusage usage;
    snprintf(
        line, sizeof line,
        "render --mesh tetrahedron.obj --env sky:day --day-frames %u --size 16x8 --env-size 4 --spp 1 --visibility "
        "none --threads 2 --out out_%%05d.pfm --contact-sheet sheet.png",
        frames);
    int code = finish_program(start_program(line), &usage);
    if (code != 0)
        fail_msg("heliostat %s: exit code %d, %s", line, code, program_err);
    assert_int_equal(count_files("."), 1 + frames + 1);
    return usage.ru_maxrss;
}

static void test_memory_is_flat_over_many_frames(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    const long slack = 4096; /* what a heap may differ by from run to run */
    long few = peak_of(100), many = peak_of(10000);
    if (many > few + slack)
        fail_msg("100 frames took %ld KiB, 10,000 frames %ld KiB", few, many);
}

/* Half a minute and more of work, by a still and by many frames, of which a log should hear. */
static void test_long_work_tells_how_far_it_is(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER);
    static const struct {
        const char *line, *word;
    } runs[] = {
        {"render --mesh tetrahedron.obj --env constant:1,1,1 --env-size 8 --spp 1048576 --out out.pfm", "rendering "},
        {"render --mesh tetrahedron.obj --env sky:day --env-size 8 --spp 64 --day-frames 1000000 --out out_%07d.pfm "
         "--size 16x8 --visibility none",
         " of 1000000, "},
    };
    for (size_t i = 0; i < 2; i++) {
        pid_t child = start_program(runs[i].line);
        bool is_told = program_says(runs[i].word);
        kill(child, SIGTERM);
        finish_program(child, NULL);
        assert_true(is_told);
        assert_non_null(strstr(program_err, " left"));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(test_memory_is_flat_over_many_frames),
        program_test(test_long_work_tells_how_far_it_is),
    };
    return cmocka_run_group_tests(tests, set_up_program, tear_down_program);
}
