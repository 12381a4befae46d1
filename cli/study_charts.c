/* SPDX-License-Identifier: MIT */
#include "study_charts.h"

#include "study_summary.h"

#include <math.h>

static chart begin(const study_record *record, bool is_over_time, const char *y_name)
{
    const study_plan *plan = record->plan;
    chart made = {.title = is_over_time ? "Equal time" : "Equal samples",
                  .x_name = is_over_time ? "time of the whole frame, ms" : "samples per shading point",
                  .y_name = y_name,
                  .x_ticks = is_over_time ? NULL : plan->spp,
                  .x_tick_count = plan->spp_count,
                  .slope = is_over_time ? 0 : -0.5,
                  .slope_name = "slope \u22121/2",
                  .series_count = plan->strategy_count};
    for (uint32_t s = 0; s < plan->strategy_count; s++)
        made.series[s] =
            (chart_series){.name = plan->strategies[s].name, .colour = study_strategy_colour(&plan->strategies[s])};
    return made;
}

chart study_chart_pair(const study_record *record, uint32_t environment, uint32_t material, bool is_over_time)
{
    chart made = begin(record, is_over_time, "RMSE");
    for (uint32_t s = 0; s < made.series_count; s++) {
        const study_curve curve = study_curve_make(record, environment, material, s);
        chart_series *series = &made.series[s];
        series->count = curve.count;
        for (uint32_t i = 0; i < curve.count; i++) {
            series->x[i] = is_over_time ? curve.ms[i] : curve.spp[i];
            series->y[i] = curve.rmse[i];
        }
        if (curve.count > 0)
            made.level = curve.reference_rmse;
    }
    made.level_name = "standard error of the reference";
    return made;
}

static chart chart_means(const study_record *record, study_error error, uint32_t material, bool is_over_time)
{
    const study_plan *plan = record->plan;
    bool is_flicker = error == STUDY_FLICKER;
    chart made = begin(record, is_over_time, is_flicker ? "\u221aflicker" : "relative RMSE, \u221arelMSE");
    for (uint32_t s = 0; s < made.series_count; s++) {
        chart_series *series = &made.series[s];
        series->count = plan->spp_count;
        for (uint32_t i = 0; i < plan->spp_count; i++) {
            study_score mean = study_score_mean(record, material, s, i, STUDY_EQUAL_SAMPLES);
            series->x[i] = is_over_time ? mean.ms : plan->spp[i];
            series->y[i] = sqrt(is_flicker ? mean.flicker : mean.relmse);
        }
    }
    return made;
}

chart study_chart_mean(const study_record *record, uint32_t material, bool is_over_time)
{
    return chart_means(record, STUDY_RELMSE, material, is_over_time);
}

chart study_chart_flicker(const study_record *record, uint32_t material, bool is_over_time)
{
    return chart_means(record, STUDY_FLICKER, material, is_over_time);
}

bool study_chart_has_flicker(const study_plan *plan)
{
    uint32_t shown = 0;
    for (uint32_t i = 0; i < plan->spp_count; i++)
        shown += plan->is_shown[i];
    return plan->sequence > 1 && shown > 1;
}
