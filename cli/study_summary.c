/* SPDX-License-Identifier: MIT */
#include "study_summary.h"

#include "bench_series.h"
#include "json_file.h"

#include <math.h>

/* ---- curves -------------------------------------------------------------------------------- */

study_curve study_curve_make(const study_record *record, uint32_t environment, uint32_t material, uint32_t strategy)
{
    const study_plan *plan = record->plan;
    study_curve curve = {.reference_rmse = 0};
    for (uint32_t i = 0; i < plan->spp_count; i++) {
        const study_point point = {environment, material, strategy, i};
        const study_cell *cell = &record->cells[study_plan_index(plan, &point)];
        if (!cell->is_done)
            continue;
        uint32_t k = curve.count++;
        curve.spp[k] = plan->spp[i];
        curve.ms[k] = cell->total_ms;
        curve.sampling_ms[k] = cell->pools_ms + cell->shade_ms;
        curve.rmse[k] = cell->rmse;
        curve.relmse[k] = cell->relmse;
        curve.lab[k] = cell->lab_mean;
        curve.reference_rmse = cell->reference_rmse;
    }
    return curve;
}

double study_curve_slope(const study_curve *curve)
{
    double floor = curve->reference_rmse, n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
    for (uint32_t i = 0; i < curve->count; i++) {
        double rmse = curve->rmse[i];
        if (!(rmse > 3 * floor))
            continue;
        double x = log(curve->spp[i]), y = log(rmse * rmse - floor * floor) / 2;
        n++;
        sum_x += x;
        sum_y += y;
        sum_xx += x * x;
        sum_xy += x * y;
    }
    return n < 2 ? (double)NAN : (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
}

/* Of (fixed + each x spp) / ms = 1 at all points, for the time of samples. False where that is no rising line above 0.
 */
static bool fit_pace(const study_curve *curve, study_pace *pace)
{
    double aa = 0, ab = 0, bb = 0, a = 0, b = 0;
    for (uint32_t i = 0; i < curve->count; i++) {
        double one = 1 / curve->sampling_ms[i], spp = curve->spp[i] / curve->sampling_ms[i];
        aa += one * one;
        ab += one * spp;
        bb += spp * spp;
        a += one;
        b += spp;
    }
    double determinant = aa * bb - ab * ab;
    *pace = (study_pace){(a * bb - b * ab) / determinant, (b * aa - a * ab) / determinant};
    return curve->count > 1 && pace->fixed >= 0 && pace->each > 0; /* false for NaN, too */
}

bool study_curve_pace(const study_curve *curve, study_pace *pace)
{
    bench_series each = {0};
    for (uint32_t i = 0; i < curve->count; i++)
        bench_series_add(&each, curve->sampling_ms[i] / curve->spp[i]);
    if (curve->count > 0 && !fit_pace(curve, pace))
        *pace = (study_pace){0, bench_series_spread(&each).median};
    return curve->count > 0 && pace->each > 0;
}

/* What a frame takes beside pools and shading: the median over all strategies of their medians. */
static double find_rest(const study_record *record, uint32_t environment, uint32_t material)
{
    bench_series rest = {0};
    for (uint32_t s = 0; s < record->plan->strategy_count; s++) {
        const study_curve curve = study_curve_make(record, environment, material, s);
        bench_series own = {0};
        for (uint32_t i = 0; i < curve.count; i++)
            bench_series_add(&own, curve.ms[i] - curve.sampling_ms[i]);
        if (curve.count > 0)
            bench_series_add(&rest, bench_series_spread(&own).median);
    }
    return rest.count > 0 ? bench_series_spread(&rest).median : (double)NAN;
}

/* Straight in log-log through a point, or through two. */
static double extend(double x, double y, double slope, double at)
{
    return y * pow(at / x, slope);
}

double study_curve_at(const study_curve *curve, const double *errors, double slope, double spp)
{
    static const double REACH = 64;
    uint32_t last = curve->count - 1;
    if (curve->count == 0 || !(spp >= curve->spp[0] / REACH && spp <= curve->spp[last] * REACH))
        return (double)NAN;
    if (spp <= curve->spp[0])
        return extend(curve->spp[0], errors[0], slope, spp);
    if (spp >= curve->spp[last])
        return extend(curve->spp[last], errors[last], slope, spp);
    uint32_t i = 0;
    while (curve->spp[i + 1] < spp)
        i++;
    double between = log(errors[i + 1] / errors[i]) / log(curve->spp[i + 1] / curve->spp[i]);
    return extend(curve->spp[i], errors[i], between, spp);
}

/* ---- means --------------------------------------------------------------------------------- */

typedef struct mean_sums {
    double relmse, lab, ms, spp, useful, count;
} mean_sums;

static study_mean mean_of(const mean_sums *sums)
{
    return (study_mean){exp(sums->relmse / sums->count), sums->lab / sums->count, exp(sums->ms / sums->count),
                        exp(sums->spp / sums->count), sums->useful / sums->count};
}

study_mean study_mean_at_spp(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp)
{
    mean_sums all = {.count = record->plan->environment_count};
    for (uint32_t i = 0; i < record->plan->environment_count; i++) {
        const study_point point = {i, material, strategy, spp};
        const study_cell *cell = &record->cells[study_plan_index(record->plan, &point)];
        all.relmse += cell->is_done ? log(cell->relmse) : (double)NAN;
        all.lab += cell->is_done ? cell->lab_mean : (double)NAN;
        all.ms += cell->is_done ? log(cell->total_ms) : (double)NAN;
        all.spp += log(record->plan->spp[spp]);
        all.useful += cell->is_done ? cell->useful_share : (double)NAN;
    }
    return mean_of(&all);
}

/* The time of pools and shading that the slowest strategy takes for so many samples. */
static double find_budget(const study_record *record, uint32_t environment, uint32_t material, uint32_t spp)
{
    double slowest = 0;
    for (uint32_t s = 0; s < record->plan->strategy_count; s++) {
        study_pace pace;
        const study_curve curve = study_curve_make(record, environment, material, s);
        if (!study_curve_pace(&curve, &pace))
            return (double)NAN;
        slowest = fmax(slowest, pace.fixed + pace.each * spp);
    }
    return slowest;
}

study_mean study_mean_at_time(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp)
{
    mean_sums all = {.count = record->plan->environment_count};
    for (uint32_t i = 0; i < record->plan->environment_count; i++) {
        study_pace pace = {0};
        const study_curve curve = study_curve_make(record, i, material, strategy);
        double budget = find_budget(record, i, material, record->plan->spp[spp]);
        double samples = study_curve_pace(&curve, &pace) ? (budget - pace.fixed) / pace.each : (double)NAN;
        all.relmse += log(study_curve_at(&curve, curve.relmse, -1, samples));
        all.lab += study_curve_at(&curve, curve.lab, -0.5, samples);
        all.ms += log(find_rest(record, i, material) + budget);
        all.spp += log(samples);
    }
    return mean_of(&all);
}

/* ---- JSON ---------------------------------------------------------------------------------- */

static json_t *numbers_of(const double *values, uint32_t count)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++)
        json_array_append_new(list, json_number(values[i]));
    return list;
}

static json_t *curve_object(const study_record *record, uint32_t environment, uint32_t material, uint32_t strategy)
{
    const study_plan *plan = record->plan;
    const study_curve curve = study_curve_make(record, environment, material, strategy);
    json_t *object = json_object();
    json_object_set_new(object, "environment", json_string(plan->environments[environment].name));
    json_object_set_new(object, "material", json_string(plan->materials[material].name));
    json_object_set_new(object, "strategy", json_string(plan->strategies[strategy].name));
    json_object_set_new(object, "slope", json_number(study_curve_slope(&curve)));
    json_object_set_new(object, "spp", numbers_of(curve.spp, curve.count));
    json_object_set_new(object, "ms", numbers_of(curve.ms, curve.count));
    json_object_set_new(object, "rmse", numbers_of(curve.rmse, curve.count));
    return object;
}

static json_t *mean_object(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp)
{
    const study_plan *plan = record->plan;
    study_mean equal_spp = study_mean_at_spp(record, material, strategy, spp);
    study_mean equal_time = study_mean_at_time(record, material, strategy, spp);
    json_t *object = json_object();
    json_object_set_new(object, "material", json_string(plan->materials[material].name));
    json_object_set_new(object, "strategy", json_string(plan->strategies[strategy].name));
    json_object_set_new(object, "spp", json_whole(plan->spp[spp]));
    json_object_set_new(object, "relmse", json_number(equal_spp.relmse));
    json_object_set_new(object, "lab_mean", json_number(equal_spp.lab));
    json_object_set_new(object, "total_ms", json_number(equal_spp.ms));
    json_object_set_new(object, "useful_share", json_number(equal_spp.useful));
    json_object_set_new(object, "equal_time_ms", json_number(equal_time.ms));
    json_object_set_new(object, "equal_time_spp", json_number(equal_time.spp));
    json_object_set_new(object, "equal_time_relmse", json_number(equal_time.relmse));
    json_object_set_new(object, "equal_time_lab_mean", json_number(equal_time.lab));
    return object;
}

void study_summary_describe(const study_record *record, json_t *object)
{
    const study_plan *plan = record->plan;
    json_t *curves = json_array(), *means = json_array();
    for (size_t i = 0; i < study_plan_count(plan); i++) {
        study_point point = study_plan_point(plan, i);
        if (point.spp == 0)
            json_array_append_new(curves, curve_object(record, point.environment, point.material, point.strategy));
        if (point.environment == 0)
            json_array_append_new(means, mean_object(record, point.material, point.strategy, point.spp));
    }
    json_object_set_new(object, "curves", curves);
    json_object_set_new(object, "means", means);
}
