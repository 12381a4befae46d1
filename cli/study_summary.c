/* SPDX-License-Identifier: MIT */
#include "study_summary.h"

#include "bench_series.h"
#include "json_file.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
        curve.flicker[k] = cell->flicker;
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

/* ---- scores -------------------------------------------------------------------------------- */

static study_curve curve_of(const study_record *record, const study_point *point)
{
    return study_curve_make(record, point->environment, point->material, point->strategy);
}

/* The time of pools and shading for so many samples. */
static double find_budget(const study_record *record, const study_point *point, int terms)
{
    const study_plan *plan = record->plan;
    study_point other = *point;
    double slowest = 0;
    for (other.strategy = 0; other.strategy < plan->strategy_count; other.strategy++) {
        study_pace pace;
        const study_curve curve = curve_of(record, &other);
        if (terms != STUDY_TIME_OF_SLOWEST && terms != (int)other.strategy)
            continue;
        if (!study_curve_pace(&curve, &pace))
            return (double)NAN;
        slowest = fmax(slowest, pace.fixed + pace.each * plan->spp[point->spp]);
    }
    return slowest;
}

/* As relMSE falls, so does flicker; from the points that have it. */
static double find_flicker(const study_curve *curve, double spp)
{
    study_curve known = {.count = 0};
    for (uint32_t i = 0; i < curve->count; i++) {
        if (isnan(curve->flicker[i]))
            continue;
        known.spp[known.count] = curve->spp[i];
        known.flicker[known.count++] = curve->flicker[i];
    }
    return study_curve_at(&known, known.flicker, -1, spp);
}

static study_score score_at_time(const study_record *record, const study_point *point, int terms)
{
    study_pace pace = {0};
    const study_curve curve = curve_of(record, point);
    double budget = find_budget(record, point, terms);
    double samples = study_curve_pace(&curve, &pace) ? (budget - pace.fixed) / pace.each : (double)NAN;
    return (study_score){.relmse = study_curve_at(&curve, curve.relmse, -1, samples),
                         .lab = study_curve_at(&curve, curve.lab, -0.5, samples),
                         .ms = find_rest(record, point->environment, point->material) + budget,
                         .spp = samples,
                         .flicker = find_flicker(&curve, samples),
                         .useful = (double)NAN,
                         .flicker_ratio = (double)NAN};
}

study_score study_score_of(const study_record *record, const study_point *point, int terms)
{
    static const double none = (double)NAN;
    const study_cell *cell = &record->cells[study_plan_index(record->plan, point)];
    if (terms != STUDY_EQUAL_SAMPLES)
        return score_at_time(record, point, terms);
    if (!cell->is_done)
        return (study_score){none, none, none, none, none, none, none};
    return (study_score){.relmse = cell->relmse,
                         .lab = cell->lab_mean,
                         .ms = cell->total_ms,
                         .spp = record->plan->spp[point->spp],
                         .flicker = cell->flicker,
                         .useful = cell->useful_share,
                         .flicker_ratio = cell->flicker_ratio};
}

study_score study_score_mean(const study_record *record, uint32_t material, uint32_t strategy, uint32_t spp, int terms)
{
    study_score sums = {0};
    study_point each = {.material = material, .strategy = strategy, .spp = spp};
    double count = record->plan->environment_count;
    for (each.environment = 0; each.environment < record->plan->environment_count; each.environment++) {
        const study_score score = study_score_of(record, &each, terms);
        sums.relmse += log(score.relmse);
        sums.lab += score.lab;
        sums.ms += log(score.ms);
        sums.spp += log(score.spp);
        sums.flicker += log(score.flicker);
        sums.useful += score.useful;
        sums.flicker_ratio += score.flicker_ratio;
    }
    return (study_score){.relmse = exp(sums.relmse / count),
                         .lab = sums.lab / count,
                         .ms = exp(sums.ms / count),
                         .spp = exp(sums.spp / count),
                         .flicker = exp(sums.flicker / count),
                         .useful = sums.useful / count,
                         .flicker_ratio = sums.flicker_ratio / count};
}

int study_terms_of_paper(const study_plan *plan)
{
    uint32_t strategy;
    return study_plan_find(plan, helio_strategy_name(HELIO_STRATEGY_FACE), &strategy) ? (int)strategy : 0;
}

/* ---- ratios -------------------------------------------------------------------------------- */

typedef struct rivals {
    helio_strategy strategies[2];
    uint32_t count;
} rivals;

static const rivals baselines[STUDY_BASELINES] = {{{HELIO_STRATEGY_FACE, HELIO_STRATEGY_FACE_BRDF}, 2},
                                                  {{HELIO_STRATEGY_LIGHT_BRDF}, 1}};

bool study_baseline_name(const study_plan *plan, int baseline, char name[STUDY_BASELINE_NAME])
{
    uint32_t strategy;
    name[0] = 0;
    for (uint32_t i = 0; i < baselines[baseline].count; i++) {
        const char *word = helio_strategy_name(baselines[baseline].strategies[i]);
        size_t used = strlen(name);
        if (study_plan_find(plan, word, &strategy))
            snprintf(name + used, STUDY_BASELINE_NAME - used, "%s%s", used > 0 ? " or " : "", word);
    }
    return name[0] != 0;
}

const char *study_error_name(study_error error)
{
    return error == STUDY_FLICKER ? "flicker" : "relMSE";
}

static double error_of(const study_record *record, study_error error, const study_point *point, int terms)
{
    const study_score score = study_score_of(record, point, terms);
    return error == STUDY_FLICKER ? score.flicker : score.relmse;
}

/* The least error of those that are compared to. */
static double baseline_error(const study_record *record, study_error error, int baseline, const study_point *point,
                             int terms)
{
    double least = (double)NAN;
    study_point rival = *point;
    for (uint32_t i = 0; i < baselines[baseline].count; i++)
        if (study_plan_find(record->plan, helio_strategy_name(baselines[baseline].strategies[i]), &rival.strategy))
            least = fmin(least, error_of(record, error, &rival, terms)); /* passes over NaN */
    return least;
}

study_ratio study_ratio_mean(const study_record *record, study_error error, int baseline, const study_point *point,
                             int terms)
{
    study_ratio ratio = {.worst = (double)NAN};
    study_point each = *point;
    uint32_t count = record->plan->environment_count;
    for (each.environment = 0; each.environment < count; each.environment++) {
        double part = error_of(record, error, &each, terms) / baseline_error(record, error, baseline, &each, terms);
        ratio.mean += log(part) / count;
        if (isfinite(part) && !(part <= ratio.worst)) {
            ratio.worst = part;
            ratio.environment = each.environment;
        }
    }
    ratio.mean = exp(ratio.mean);
    return ratio;
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

/* Names of what a mean over environments is of. */
static json_t *point_object(const study_plan *plan, const study_point *point)
{
    json_t *object = json_object();
    json_object_set_new(object, "material", json_string(plan->materials[point->material].name));
    json_object_set_new(object, "strategy", json_string(plan->strategies[point->strategy].name));
    json_object_set_new(object, "spp", json_whole(plan->spp[point->spp]));
    return object;
}

static json_t *mean_object(const study_record *record, const study_point *point)
{
    study_score equal_spp = study_score_mean(record, point->material, point->strategy, point->spp, STUDY_EQUAL_SAMPLES);
    study_score equal_time =
        study_score_mean(record, point->material, point->strategy, point->spp, STUDY_TIME_OF_SLOWEST);
    json_t *object = point_object(record->plan, point);
    json_object_set_new(object, "relmse", json_number(equal_spp.relmse));
    json_object_set_new(object, "lab_mean", json_number(equal_spp.lab));
    json_object_set_new(object, "total_ms", json_number(equal_spp.ms));
    json_object_set_new(object, "useful_share", json_number(equal_spp.useful));
    json_object_set_new(object, "flicker", json_number(equal_spp.flicker));
    json_object_set_new(object, "flicker_ratio", json_number(equal_spp.flicker_ratio));
    json_object_set_new(object, "equal_time_ms", json_number(equal_time.ms));
    json_object_set_new(object, "equal_time_spp", json_number(equal_time.spp));
    json_object_set_new(object, "equal_time_relmse", json_number(equal_time.relmse));
    json_object_set_new(object, "equal_time_lab_mean", json_number(equal_time.lab));
    json_object_set_new(object, "equal_time_flicker", json_number(equal_time.flicker));
    return object;
}

static json_t *ratio_object(const study_record *record, study_error error, int baseline, const study_point *point,
                            int terms)
{
    const study_plan *plan = record->plan;
    const study_ratio ratio = study_ratio_mean(record, error, baseline, point, terms);
    char name[STUDY_BASELINE_NAME];
    json_t *object = point_object(plan, point);
    study_baseline_name(plan, baseline, name);
    json_object_set_new(object, "of", json_string(study_error_name(error)));
    json_object_set_new(object, "against", json_string(name));
    json_object_set_new(object, "time_of", terms < 0 ? json_null() : json_string(plan->strategies[terms].name));
    json_object_set_new(object, "mean", json_number(ratio.mean));
    json_object_set_new(object, "worst", json_number(ratio.worst));
    json_object_set_new(object, "worst_environment",
                        isnan(ratio.worst) ? json_null() : json_string(plan->environments[ratio.environment].name));
    return object;
}

/* For the samples that are shown, against all that there are: at equal samples and at equal time. */
static void add_ratios(const study_record *record, study_error error, const study_point *point, json_t *list)
{
    char name[STUDY_BASELINE_NAME];
    for (int i = 0; i < STUDY_BASELINES && record->plan->is_shown[point->spp]; i++) {
        if (!study_baseline_name(record->plan, i, name))
            continue;
        json_array_append_new(list, ratio_object(record, error, i, point, STUDY_EQUAL_SAMPLES));
        json_array_append_new(list, ratio_object(record, error, i, point, study_terms_of_paper(record->plan)));
    }
}

void study_summary_describe(const study_record *record, json_t *object)
{
    const study_plan *plan = record->plan;
    json_t *curves = json_array(), *means = json_array(), *ratios = json_array();
    for (size_t i = 0; i < study_plan_count(plan); i++) {
        study_point point = study_plan_point(plan, i);
        if (point.spp == 0)
            json_array_append_new(curves, curve_object(record, point.environment, point.material, point.strategy));
        if (point.environment != 0)
            continue;
        json_array_append_new(means, mean_object(record, &point));
        add_ratios(record, STUDY_RELMSE, &point, ratios);
        if (plan->sequence > 1)
            add_ratios(record, STUDY_FLICKER, &point, ratios);
    }
    json_object_set_new(object, "curves", curves);
    json_object_set_new(object, "means", means);
    json_object_set_new(object, "ratios", ratios);
}
