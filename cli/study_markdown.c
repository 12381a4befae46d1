/* SPDX-License-Identifier: MIT */
#include "study_markdown.h"

#include "message.h"
#include "output_file.h"
#include "study_summary.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Names of files may hold what ends a cell. */
static void write_text(FILE *stream, const char *text)
{
    for (; *text != 0; text++)
        fprintf(stream, *text == '|' ? "\\|" : "%c", *text);
}

static void write_number(FILE *stream, double value)
{
    if (isfinite(value))
        fprintf(stream, "%.3g", value);
    else
        fputs("\u2013", stream);
}

static void write_rule(FILE *stream, uint32_t columns)
{
    fputs("\n|", stream);
    while (columns-- > 0)
        fputs("---|", stream);
    fputc('\n', stream);
}

static void write_strategy(FILE *stream, const study_plan *plan, uint32_t strategy)
{
    fprintf(stream, "| `%s` |", plan->strategies[strategy].name);
}

/* Numbers of samples that are shown, one after the other: the first one from here on. */
static uint32_t next_shown(const study_plan *plan, uint32_t spp)
{
    while (spp < plan->spp_count && !plan->is_shown[spp])
        spp++;
    return spp;
}

static void write_introduction(FILE *stream, const study_record *record)
{
    const study_plan *plan = record->plan;
    const cli_options *options = plan->options;
    char reference[STUDY_PLAN_REFERENCE];
    study_plan_describe_reference(plan, reference);
    fprintf(stream,
            "%u environment%s, %ux%u pixels, shadow rays: %s; references by %s. heliostat %s, %d threads (%s) of ",
            plan->environment_count, plan->environment_count == 1 ? "" : "s", options->size[0], options->size[1],
            options->study.visibility[0] == 'n' ? "none" : "yes", reference, HELIO_VERSION_TEXT,
            (int)json_integer_value(json_object_get(record->settings, "threads")),
            json_string_value(json_object_get(record->settings, "isa")));
    write_text(stream, json_string_value(json_object_get(record->settings, "processor")));
    fprintf(stream,
            ". Errors are relMSE (geometric means over the environments) and differences in L*a*b* (means). At equal "
            "time all strategies have the whole frame's time that `%s` takes; in brackets the samples that fit into "
            "it.\n",
            plan->strategies[study_terms_of_paper(plan)].name);
    if (plan->sequence > 1)
        fprintf(stream,
                "\nFlicker is the mean square change of the error over up to %u frames, relative like relMSE, and as a "
                "part of the relMSE of these frames: 1 where errors are new in each frame, 0 where they stand still.\n",
                plan->sequence);
}

/* ---- errors -------------------------------------------------------------------------------- */

static void write_score(FILE *stream, const study_score *score)
{
    fputc(' ', stream);
    write_number(stream, score->relmse);
    fputs(", ", stream);
    write_number(stream, score->lab);
}

static void write_error_head(FILE *stream, const study_record *record, uint32_t material)
{
    const study_plan *plan = record->plan;
    uint32_t columns = plan->spp_count + 2;
    fprintf(stream, "\n| `%s` |", plan->materials[material].name);
    for (uint32_t i = 0; i < plan->spp_count; i++)
        fprintf(stream, " %u spp |", plan->spp[i]);
    fputs(" useful |", stream);
    for (uint32_t i = next_shown(plan, 0); i < plan->spp_count; i = next_shown(plan, i + 1), columns++) {
        int terms = study_terms_of_paper(plan);
        fputs(" in ", stream);
        write_number(stream, study_score_mean(record, material, (uint32_t)terms, i, terms).ms);
        fputs(" ms |", stream);
    }
    write_rule(stream, columns);
}

static void write_errors(FILE *stream, const study_record *record, uint32_t material, uint32_t strategy)
{
    const study_plan *plan = record->plan;
    uint32_t last = plan->spp_count - 1;
    write_strategy(stream, plan, strategy);
    for (uint32_t i = 0; i < plan->spp_count; i++) {
        const study_score score = study_score_mean(record, material, strategy, i, STUDY_EQUAL_SAMPLES);
        write_score(stream, &score);
        fputs(" |", stream);
    }
    fprintf(stream, " %.0f %% |", 100 * study_score_mean(record, material, strategy, last, STUDY_EQUAL_SAMPLES).useful);
    for (uint32_t i = next_shown(plan, 0); i < plan->spp_count; i = next_shown(plan, i + 1)) {
        const study_score score = study_score_mean(record, material, strategy, i, study_terms_of_paper(plan));
        write_score(stream, &score);
        fputs(" (", stream);
        write_number(stream, score.spp);
        fputs(") |", stream);
    }
    fputc('\n', stream);
}

static void write_error_table(FILE *stream, const study_record *record, uint32_t material)
{
    write_error_head(stream, record, material);
    for (uint32_t s = 0; s < record->plan->strategy_count; s++)
        write_errors(stream, record, material, s);
}

/* ---- ratios -------------------------------------------------------------------------------- */

/* Returns how many columns that makes. */
static uint32_t write_ratio_names(FILE *stream, const study_plan *plan, study_error error)
{
    uint32_t columns = 0;
    char name[STUDY_BASELINE_NAME];
    for (int i = 0; i < STUDY_BASELINES; i++)
        if (study_baseline_name(plan, i, name)) {
            fprintf(stream, " %s / that of %s | at equal time |", study_error_name(error), name);
            columns += 2;
        }
    return columns;
}

static void write_ratio(FILE *stream, const study_record *record, study_error error, int baseline,
                        const study_point *point, int terms)
{
    const study_ratio ratio = study_ratio_mean(record, error, baseline, point, terms);
    fputc(' ', stream);
    write_number(stream, ratio.mean);
    if (record->plan->environment_count > 1 && isfinite(ratio.mean)) {
        fprintf(stream, " (%.3g, ", ratio.worst);
        write_text(stream, record->plan->environments[ratio.environment].name);
        fputc(')', stream);
    }
    fputs(" |", stream);
}

static void write_ratios(FILE *stream, const study_record *record, study_error error, const study_point *point)
{
    char name[STUDY_BASELINE_NAME];
    for (int i = 0; i < STUDY_BASELINES; i++)
        if (study_baseline_name(record->plan, i, name)) {
            write_ratio(stream, record, error, i, point, STUDY_EQUAL_SAMPLES);
            write_ratio(stream, record, error, i, point, study_terms_of_paper(record->plan));
        }
    fputc('\n', stream);
}

static void write_ratio_table(FILE *stream, const study_record *record, uint32_t material, uint32_t spp)
{
    const study_plan *plan = record->plan;
    study_point point = {.material = material, .spp = spp};
    fprintf(stream, "\n| `%s`, %u spp |", plan->materials[material].name, plan->spp[spp]);
    write_rule(stream, 1 + write_ratio_names(stream, plan, STUDY_RELMSE));
    for (point.strategy = 0; point.strategy < plan->strategy_count; point.strategy++) {
        write_strategy(stream, plan, point.strategy);
        write_ratios(stream, record, STUDY_RELMSE, &point);
    }
}

static bool has_baseline(const study_plan *plan)
{
    char name[STUDY_BASELINE_NAME];
    for (int i = 0; i < STUDY_BASELINES; i++)
        if (study_baseline_name(plan, i, name))
            return true;
    return false;
}

/* ---- flicker ------------------------------------------------------------------------------- */

static void write_flicker(FILE *stream, const study_record *record, const study_point *point)
{
    const study_plan *plan = record->plan;
    const study_score equal =
        study_score_mean(record, point->material, point->strategy, point->spp, STUDY_EQUAL_SAMPLES);
    const study_score timed =
        study_score_mean(record, point->material, point->strategy, point->spp, study_terms_of_paper(plan));
    write_strategy(stream, plan, point->strategy);
    fputc(' ', stream);
    write_number(stream, equal.flicker);
    fputs(" | ", stream);
    write_number(stream, equal.flicker_ratio);
    fputs(" | ", stream);
    write_number(stream, timed.flicker);
    fputs(" |", stream);
    write_ratios(stream, record, STUDY_FLICKER, point);
}

static void write_flicker_table(FILE *stream, const study_record *record, uint32_t material, uint32_t spp)
{
    const study_plan *plan = record->plan;
    study_point point = {.material = material, .spp = spp};
    int terms = study_terms_of_paper(plan);
    fprintf(stream, "\n| `%s`, %u spp | flicker | / relMSE | in ", plan->materials[material].name, plan->spp[spp]);
    write_number(stream, study_score_mean(record, material, (uint32_t)terms, spp, terms).ms);
    fputs(" ms |", stream);
    write_rule(stream, 4 + write_ratio_names(stream, plan, STUDY_FLICKER));
    for (point.strategy = 0; point.strategy < plan->strategy_count; point.strategy++)
        write_flicker(stream, record, &point);
}

int study_markdown_write(const study_record *record, const char *path)
{
    const study_plan *plan = record->plan;
    char temporary[4096];
    FILE *stream = output_file_open(path, temporary, sizeof temporary);
    if (stream == NULL)
        return message_failure("%s cannot be written: %s", path, strerror(errno));
    write_introduction(stream, record);
    for (uint32_t material = 0; material < plan->material_count; material++) {
        write_error_table(stream, record, material);
        for (uint32_t i = next_shown(plan, 0); i < plan->spp_count && has_baseline(plan); i = next_shown(plan, i + 1))
            write_ratio_table(stream, record, material, i);
        for (uint32_t i = next_shown(plan, 0); i < plan->spp_count && plan->sequence > 1; i = next_shown(plan, i + 1))
            write_flicker_table(stream, record, material, i);
    }
    return output_file_finish(stream, temporary, path);
}
