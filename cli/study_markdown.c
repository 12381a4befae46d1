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

static void write_ratio_head(FILE *stream, const study_plan *plan, uint32_t material, uint32_t spp)
{
    uint32_t columns = 1;
    char name[STUDY_BASELINE_NAME];
    fprintf(stream, "\n| `%s`, %u spp |", plan->materials[material].name, plan->spp[spp]);
    for (int i = 0; i < STUDY_BASELINES; i++)
        if (study_baseline_name(plan, i, name)) {
            fprintf(stream, " relMSE / that of %s | at equal time |", name);
            columns += 2;
        }
    write_rule(stream, columns);
}

static void write_ratio(FILE *stream, const study_record *record, int baseline, const study_point *point, int terms)
{
    const study_ratio ratio = study_ratio_mean(record, baseline, point, terms);
    fputc(' ', stream);
    write_number(stream, ratio.mean);
    if (record->plan->environment_count > 1 && isfinite(ratio.mean)) {
        fprintf(stream, " (%.3g, ", ratio.worst);
        write_text(stream, record->plan->environments[ratio.environment].name);
        fputc(')', stream);
    }
    fputs(" |", stream);
}

static void write_ratio_table(FILE *stream, const study_record *record, uint32_t material, uint32_t spp)
{
    const study_plan *plan = record->plan;
    study_point point = {.material = material, .spp = spp};
    char name[STUDY_BASELINE_NAME];
    write_ratio_head(stream, plan, material, spp);
    for (point.strategy = 0; point.strategy < plan->strategy_count; point.strategy++) {
        write_strategy(stream, plan, point.strategy);
        for (int i = 0; i < STUDY_BASELINES; i++)
            if (study_baseline_name(plan, i, name)) {
                write_ratio(stream, record, i, &point, STUDY_EQUAL_SAMPLES);
                write_ratio(stream, record, i, &point, study_terms_of_paper(plan));
            }
        fputc('\n', stream);
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
    }
    return output_file_finish(stream, temporary, path);
}
