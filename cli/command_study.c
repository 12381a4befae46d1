/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "interrupt.h"
#include "message.h"
#include "study_charts.h"
#include "study_csv.h"
#include "study_file.h"
#include "study_job.h"
#include "study_markdown.h"
#include "study_page.h"
#include "study_sheets.h"
#include "study_summary.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- what is told -------------------------------------------------------------------------- */

static void print_number(double value, int width)
{
    if (isfinite(value))
        printf(" %*.*g", width, width > 8 ? 4 : 3, value);
    else
        printf(" %*s", width, "-");
}

static int name_width(const study_plan *plan)
{
    size_t width = strlen("equal samples");
    for (uint32_t s = 0; s < plan->strategy_count; s++) {
        size_t length = strlen(plan->strategies[s].name);
        width = length > width ? length : width;
    }
    return (int)width;
}

static void print_head(const study_record *record, uint32_t material, int terms)
{
    const study_plan *plan = record->plan;
    bool is_at_time = terms != STUDY_EQUAL_SAMPLES;
    printf("  %-*s", name_width(plan), is_at_time ? "equal time" : "equal samples");
    for (uint32_t i = 0; i < plan->spp_count; i++) {
        char head[32];
        if (is_at_time)
            snprintf(head, sizeof head, "%.3g ms", study_score_mean(record, material, 0, i, terms).ms);
        else
            snprintf(head, sizeof head, "%u spp", plan->spp[i]);
        printf(" %10s", head);
    }
    printf("  %*s%s\n", 7 * (int)plan->spp_count - 1, "Lab of each", is_at_time ? "" : "   useful");
}

static void print_means(const study_record *record, uint32_t material, int terms)
{
    const study_plan *plan = record->plan;
    print_head(record, material, terms);
    for (uint32_t s = 0; s < plan->strategy_count; s++) {
        printf("  %-*s", name_width(plan), plan->strategies[s].name);
        for (uint32_t i = 0; i < plan->spp_count; i++)
            print_number(study_score_mean(record, material, s, i, terms).relmse, 10);
        printf(" ");
        for (uint32_t i = 0; i < plan->spp_count; i++)
            print_number(study_score_mean(record, material, s, i, terms).lab, 6);
        if (terms == STUDY_EQUAL_SAMPLES)
            printf("  %5.1f %%",
                   100 * study_score_mean(record, material, s, plan->spp_count - 1, STUDY_EQUAL_SAMPLES).useful);
        printf("\n");
    }
}

/* Of the samples that are shown, at equal samples and at equal time. */
static void print_flicker(const study_record *record, uint32_t material)
{
    const study_plan *plan = record->plan;
    for (uint32_t i = 0; i < plan->spp_count; i++) {
        char head[48];
        if (!plan->is_shown[i])
            continue;
        snprintf(head, sizeof head, "in %.3g ms", study_score_mean(record, material, 0, i, STUDY_TIME_OF_SLOWEST).ms);
        printf("  %-*s %6u spp %12s   of relMSE\n", name_width(plan), "flicker", plan->spp[i], head);
        for (uint32_t s = 0; s < plan->strategy_count; s++) {
            const study_score equal = study_score_mean(record, material, s, i, STUDY_EQUAL_SAMPLES);
            printf("  %-*s", name_width(plan), plan->strategies[s].name);
            print_number(equal.flicker, 10);
            print_number(study_score_mean(record, material, s, i, STUDY_TIME_OF_SLOWEST).flicker, 12);
            print_number(100 * equal.flicker_ratio, 8);
            printf(" %%\n");
        }
    }
}

static void print_summary(const study_record *record)
{
    const study_plan *plan = record->plan;
    for (uint32_t material = 0; material < plan->material_count; material++) {
        printf("%srelMSE of %s", material > 0 ? "\n" : "", plan->materials[material].name);
        if (plan->environment_count > 1)
            printf(", geometric mean over %u environments", plan->environment_count);
        printf("\n");
        print_means(record, material, STUDY_EQUAL_SAMPLES);
        print_means(record, material, STUDY_TIME_OF_SLOWEST);
        if (plan->sequence > 1)
            print_flicker(record, material);
    }
}

/* ---- the run ------------------------------------------------------------------------------- */

static int write_results(const study_job *job)
{
    char page[STUDY_PATH], table[STUDY_PATH], tables[STUDY_PATH];
    study_job_path(job->plan, "study.html", page);
    study_job_path(job->plan, "study.csv", table);
    study_job_path(job->plan, "study.md", tables);
    int code = study_csv_write(&job->record, table);
    if (code == EXIT_CODE_OK)
        code = study_markdown_write(&job->record, tables);
    if (code == EXIT_CODE_OK)
        code = study_charts_write(&job->record);
    if (code == EXIT_CODE_OK)
        code = study_sheets_write(&job->record);
    if (code == EXIT_CODE_OK)
        code = study_page_write(&job->record, page);
    if (code != EXIT_CODE_OK || job->plan->options->quiet)
        return code;
    print_summary(&job->record);
    message_note("the page is %s", page);
    return EXIT_CODE_OK;
}

static int study(const cli_options *options)
{
    study_plan plan;
    study_job job = {0};
    int code = study_plan_make(&plan, options);
    interrupt_install();
    if (code == EXIT_CODE_OK)
        code = study_job_open(&job, &plan);
    if (code == EXIT_CODE_OK)
        code = study_job_run(&job);
    if (code == EXIT_CODE_OK)
        code = write_results(&job);
    study_job_close(&job);
    study_plan_release(&plan);
    return code;
}

int command_study(const cli_options *options)
{
    if (options->study.file == NULL)
        return study(options);
    study_file file;
    cli_options merged;
    int code = study_file_read(&file, options->study.file, options->word_count, options->words);
    if (code == EXIT_CODE_OK)
        code = options_parse(&merged, COMMAND_STUDY, "study", file.count, file.words);
    if (code == EXIT_CODE_OK)
        code = study(&merged);
    study_file_release(&file);
    return code;
}
