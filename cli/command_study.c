/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "interrupt.h"
#include "message.h"
#include "study_charts.h"
#include "study_csv.h"
#include "study_file.h"
#include "study_job.h"
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

static study_mean mean_at(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp,
                          bool is_at_time)
{
    return is_at_time ? study_mean_at_time(record, material, strategy, spp)
                      : study_mean_at_spp(record, material, strategy, spp);
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

static void print_head(const study_record *record, uint32_t material, bool is_at_time)
{
    const study_plan *plan = record->plan;
    printf("  %-*s", name_width(plan), is_at_time ? "equal time" : "equal samples");
    for (uint32_t i = 0; i < plan->spp_count; i++) {
        char head[32];
        if (is_at_time)
            snprintf(head, sizeof head, "%.3g ms", mean_at(record, material, 0, i, true).ms);
        else
            snprintf(head, sizeof head, "%u spp", plan->spp[i]);
        printf(" %10s", head);
    }
    printf("  %*s%s\n", 7 * (int)plan->spp_count - 1, "Lab of each", is_at_time ? "" : "   useful");
}

static void print_means(const study_record *record, uint32_t material, bool is_at_time)
{
    const study_plan *plan = record->plan;
    print_head(record, material, is_at_time);
    for (uint32_t s = 0; s < plan->strategy_count; s++) {
        printf("  %-*s", name_width(plan), plan->strategies[s].name);
        for (uint32_t i = 0; i < plan->spp_count; i++)
            print_number(mean_at(record, material, s, i, is_at_time).relmse, 10);
        printf(" ");
        for (uint32_t i = 0; i < plan->spp_count; i++)
            print_number(mean_at(record, material, s, i, is_at_time).lab, 6);
        if (!is_at_time)
            printf("  %5.1f %%", 100 * study_mean_at_spp(record, material, s, plan->spp_count - 1).useful);
        printf("\n");
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
        print_means(record, material, false);
        print_means(record, material, true);
    }
}

/* ---- the run ------------------------------------------------------------------------------- */

static int write_results(const study_job *job)
{
    char page[STUDY_PATH], table[STUDY_PATH];
    study_job_path(job->plan, "study.html", page);
    study_job_path(job->plan, "study.csv", table);
    int code = study_csv_write(&job->record, table);
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
