/* SPDX-License-Identifier: MIT */
#include "study_charts.h"

#include "figure.h"
#include "message.h"
#include "study_job.h"

#include <stdio.h>

enum { MARGIN = 10, HEADING = 24 };

typedef struct two_charts {
    char heading[512];
    chart charts[2];
} two_charts;

static void draw(cairo_t *cairo, const void *data)
{
    const two_charts *both = data;
    const canvas_text style = {0x222222, 13, false, CANVAS_START, false};
    canvas on = canvas_on_cairo(cairo);
    cairo_set_source_rgb(cairo, 1, 1, 1);
    cairo_paint(cairo);
    on.text(&on, &style, MARGIN, MARGIN + 10, both->heading);
    for (int i = 0; i < 2; i++)
        chart_draw(&on, &both->charts[i], MARGIN + i * CHART_WIDTH, MARGIN + HEADING);
}

static int write_charts(const study_plan *plan, const char *name, const two_charts *both)
{
    char path[STUDY_PATH];
    const figure drawn = {
        .width = 2 * (CHART_WIDTH + MARGIN), .height = CHART_HEIGHT + 2 * MARGIN + HEADING, .draw = draw, .data = both};
    study_job_path(plan, name, path);
    return figure_write("out", path, &drawn);
}

typedef chart chart_of_means(const study_record *record, uint32_t material, bool is_over_time);

static int write_mean(const study_record *record, uint32_t material, const char *word, chart_of_means *make)
{
    char name[64];
    two_charts both = {.charts = {make(record, material, false), make(record, material, true)}};
    snprintf(both.heading, sizeof both.heading, "%.400s, means over %u environment%s",
             record->plan->materials[material].name, record->plan->environment_count,
             record->plan->environment_count == 1 ? "" : "s");
    snprintf(name, sizeof name, "curves/%s-%u.pdf", word, material + 1);
    return write_charts(record->plan, name, &both);
}

static int write_pair(const study_record *record, const study_point *pair)
{
    char stem[160], name[192];
    two_charts both = {.charts = {study_chart_pair(record, pair->environment, pair->material, false),
                                  study_chart_pair(record, pair->environment, pair->material, true)}};
    snprintf(both.heading, sizeof both.heading, "%.200s, %.200s", record->plan->environments[pair->environment].name,
             record->plan->materials[pair->material].name);
    study_job_pair_name(record->plan, pair->environment, pair->material, stem);
    snprintf(name, sizeof name, "curves/%s.pdf", stem);
    return write_charts(record->plan, name, &both);
}

int study_charts_write(const study_record *record)
{
    const study_plan *plan = record->plan;
    int code = study_job_folder(plan, "curves");
    for (uint32_t i = 0; code == EXIT_CODE_OK && i < plan->material_count; i++)
        code = write_mean(record, i, "means", study_chart_mean);
    for (uint32_t i = 0; code == EXIT_CODE_OK && study_chart_has_flicker(plan) && i < plan->material_count; i++)
        code = write_mean(record, i, "flicker", study_chart_flicker);
    for (size_t i = 0; code == EXIT_CODE_OK && i < study_plan_count(plan); i++) {
        study_point point = study_plan_point(plan, i);
        if (point.strategy == 0 && point.spp == 0)
            code = write_pair(record, &point);
    }
    return code;
}
