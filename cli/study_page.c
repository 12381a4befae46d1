/* SPDX-License-Identifier: MIT */
#include "study_page.h"

#include "data_uri.h"
#include "false_colour.h"
#include "message.h"
#include "output_file.h"
#include "study_charts.h"
#include "study_summary.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The page is XML, too: every element is closed. */
static const char HEAD[] =
    "<!DOCTYPE html>\n"
    "<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
    "<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>Heliostat study</title>\n<style>\n"
    "body { font: 15px/1.45 sans-serif; color: #222; background: #fff; max-width: 76rem; margin: 1.5rem auto; "
    "padding: 0 1rem; }\n"
    "h1 { font-size: 1.7rem; } h2 { font-size: 1.3rem; margin-top: 2.5rem; border-top: 1px solid #ccc; "
    "padding-top: 1rem; } h3 { font-size: 1rem; }\n"
    "table { border-collapse: collapse; margin: 0.6rem 0 1.2rem; font-variant-numeric: tabular-nums; }\n"
    "th, td { padding: 0.15rem 0.7rem; text-align: right; white-space: nowrap; border-bottom: 1px solid #e2e2e2; }\n"
    "th { font-weight: normal; color: #555; } th:first-child, td:first-child { text-align: left; }\n"
    "td.name { font-weight: bold; } td.best { background: #e4f2e4; } caption { text-align: left; color: #555; }\n"
    ".scroll, .charts { overflow-x: auto; } svg { max-width: 100%; height: auto; }\n"
    ".pictures { display: flex; flex-wrap: wrap; gap: 0.8rem; } figure { margin: 0; }\n"
    "figure img { display: block; max-width: 100%; min-width: 10rem; } figcaption { font-size: 0.85rem; }\n"
    "p.note { color: #555; max-width: 60rem; }\n"
    "</style>\n</head>\n<body>\n";

static void write_text(FILE *stream, const char *text)
{
    canvas_write_escaped(stream, text);
}

/* Three digits; a dash where there is no number. */
static void write_number(FILE *stream, double value)
{
    if (!isfinite(value))
        fputs("\u2013", stream);
    else if (value != 0 && (fabs(value) < 1e-3 || fabs(value) >= 1e5))
        fprintf(stream, "%.2e", value);
    else
        fprintf(stream, "%.*f", fabs(value) >= 100 ? 0 : fabs(value) >= 10 ? 1 : fabs(value) >= 1 ? 2 : 4, value);
}

static void write_strategy(FILE *stream, const study_plan *plan, uint32_t strategy)
{
    fprintf(stream, "<td class=\"name\" style=\"color:#%06x\">", study_strategy_colour(&plan->strategies[strategy]));
    write_text(stream, plan->strategies[strategy].name);
    fputs("</td>", stream);
}

/* ---- the scene ----------------------------------------------------------------------------- */

static void write_json_value(FILE *stream, const json_t *value)
{
    char *text = json_is_string(value) ? strdup(json_string_value(value))
                                       : json_dumps(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(5));
    write_text(stream, text != NULL ? text : "");
    free(text);
}

static void write_object(FILE *stream, const json_t *object, const char *caption)
{
    const char *key;
    json_t *value;
    fprintf(stream, "<div class=\"scroll\"><table><caption>%s</caption>\n", caption);
    json_object_foreach((json_t *)object, key, value)
    {
        fputs("<tr><td>", stream);
        write_text(stream, key);
        fputs("</td><td>", stream);
        write_json_value(stream, value);
        fputs("</td></tr>\n", stream);
    }
    fputs("</table></div>\n", stream);
}

static void write_scene(FILE *stream, const study_record *record)
{
    fputs("<h2>Scene, machine and settings</h2>\n", stream);
    write_object(stream, record->scene, "scene");
    write_object(stream, record->settings, "settings: those of render by the same names; mesh is a digest of the file");
    fputs("<div class=\"scroll\"><table><caption>environments</caption>\n", stream);
    for (uint32_t i = 0; i < record->plan->environment_count; i++) {
        fputs("<tr><td>", stream);
        write_text(stream, record->plan->environments[i].name);
        fputs("</td><td>", stream);
        write_text(stream, record->plan->environments[i].specification);
        fputs("</td></tr>\n", stream);
    }
    fputs("</table></div>\n", stream);
}

static void write_introduction(FILE *stream, const study_record *record)
{
    const study_plan *plan = record->plan;
    const cli_options *options = plan->options;
    char reference[STUDY_PLAN_REFERENCE];
    study_plan_describe_reference(plan, reference);
    fputs("<h1>Heliostat study</h1>\n<p>", stream);
    fprintf(stream, "%u strateg%s at %u numbers of samples, in the light of %u environment%s, on %u material%s; ",
            plan->strategy_count, plan->strategy_count == 1 ? "y" : "ies", plan->spp_count, plan->environment_count,
            plan->environment_count == 1 ? "" : "s", plan->material_count, plan->material_count == 1 ? "" : "s");
    fprintf(stream, "%ux%u pixels, shadow rays: %s. ", options->size[0], options->size[1],
            options->study.visibility[0] == 'n' ? "none" : "yes");
    fputs("heliostat ", stream);
    write_json_value(stream, json_object_get(record->settings, "version"));
    fputs(", ", stream);
    write_json_value(stream, json_object_get(record->settings, "threads"));
    fputs(" threads (", stream);
    write_json_value(stream, json_object_get(record->settings, "isa"));
    fputs(") of ", stream);
    write_json_value(stream, json_object_get(record->settings, "processor"));
    fputs(".</p>\n<p class=\"note\">", stream);
    fprintf(
        stream,
        "relMSE is the mean of (a \u2212 b)\u00b2 / (b\u00b2 + \u03b5) over the object's pixels, and like RMSE the "
        "mean "
        "of %u renders with different random samples. Lab is the mean difference in CIE L*a*b*. The time is that of a "
        "whole frame, from the map in memory to the picture: cube, tables, pools, camera rays and shading; the median "
        "of %u. Useful are samples with light and a BRDF above 0. ",
        options->study.repeat, options->study.repeat);
    fprintf(stream,
            "The slope is that of log RMSE over log spp, with the reference's own error taken out: \u22121/2 for "
            "independent unbiased samples, steeper for well spread ones, and flatter for what is biased. References "
            "are made "
            "by %s. The same numbers are in study.csv and study.json beside this page.</p>\n",
            reference);
}

/* ---- curves -------------------------------------------------------------------------------- */

static void write_charts(FILE *stream, const chart *first, const chart *second)
{
    canvas on = canvas_on_svg(stream);
    fprintf(stream,
            "<div class=\"charts\"><svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
            "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" role=\"img\">\n",
            2 * CHART_WIDTH, CHART_HEIGHT, 2 * CHART_WIDTH, CHART_HEIGHT);
    chart_draw(&on, first, 0, 0);
    chart_draw(&on, second, CHART_WIDTH, 0);
    fputs("</svg></div>\n", stream);
}

/* ---- means --------------------------------------------------------------------------------- */

static double least_relmse(const study_record *record, uint32_t material, uint32_t spp, int terms)
{
    double least = (double)INFINITY;
    for (uint32_t s = 0; s < record->plan->strategy_count; s++)
        least = fmin(least, study_score_mean(record, material, s, spp, terms).relmse); /* passes over NaN */
    return least;
}

static void write_mean_head(FILE *stream, const study_record *record, uint32_t material, int terms)
{
    const study_plan *plan = record->plan;
    static const char *const titles[] = {"relMSE", "Lab"};
    bool is_at_time = terms != STUDY_EQUAL_SAMPLES;
    fputs("<tr><th>strategy</th>", stream);
    for (uint32_t i = 0; i < 2 * plan->spp_count; i++) {
        uint32_t spp = i % plan->spp_count;
        fprintf(stream, "<th>%s, ", titles[i / plan->spp_count]);
        if (is_at_time)
            write_number(stream, study_score_mean(record, material, 0, spp, terms).ms);
        else
            fprintf(stream, "%u", plan->spp[spp]);
        fputs(is_at_time ? " ms</th>" : " spp</th>", stream);
    }
    fputs(is_at_time ? "</tr>\n" : "<th>useful</th></tr>\n", stream);
}

static void write_mean_table(FILE *stream, const study_record *record, uint32_t material, int terms)
{
    const study_plan *plan = record->plan;
    bool is_at_time = terms != STUDY_EQUAL_SAMPLES;
    fprintf(stream, "<div class=\"scroll\"><table><caption>%s</caption>\n",
            is_at_time ? "At equal time: with as many samples (their number in brackets) as fit into the time that the "
                         "slowest strategy takes; \u2013 beyond 64 times what was measured"
                       : "At equal samples");
    write_mean_head(stream, record, material, terms);
    for (uint32_t s = 0; s < plan->strategy_count; s++) {
        fputs("<tr>", stream);
        write_strategy(stream, plan, s);
        for (uint32_t i = 0; i < plan->spp_count; i++) {
            double relmse = study_score_mean(record, material, s, i, terms).relmse;
            fputs(relmse == least_relmse(record, material, i, terms) ? "<td class=\"best\">" : "<td>", stream);
            write_number(stream, relmse);
            if (is_at_time && isfinite(relmse))
                fprintf(stream, " (%.3g)", study_score_mean(record, material, s, i, terms).spp);
            fputs("</td>", stream);
        }
        for (uint32_t i = 0; i < plan->spp_count; i++) {
            fputs("<td>", stream);
            write_number(stream, study_score_mean(record, material, s, i, terms).lab);
            fputs("</td>", stream);
        }
        if (terms == STUDY_EQUAL_SAMPLES)
            fprintf(stream, "<td>%.1f %%</td>",
                    100 * study_score_mean(record, material, s, plan->spp_count - 1, STUDY_EQUAL_SAMPLES).useful);
        fputs("</tr>\n", stream);
    }
    fputs("</table></div>\n", stream);
}

static void write_flicker_head(FILE *stream, const study_record *record, uint32_t material)
{
    const study_plan *plan = record->plan;
    fprintf(
        stream,
        "<div class=\"scroll\"><table><caption>Flicker: the mean square change of the error from frame to frame, of "
        "%u, relative like relMSE; and as a part of the relMSE of these frames: 1 where errors are new in each "
        "frame, 0 where they stand still</caption>\n<tr><th>strategy</th>",
        plan->sequence);
    for (uint32_t i = 0; i < plan->spp_count; i++) {
        if (!plan->is_shown[i])
            continue;
        fprintf(stream, "<th>%u spp</th><th>of relMSE</th><th>", plan->spp[i]);
        write_number(stream, study_score_mean(record, material, 0, i, STUDY_TIME_OF_SLOWEST).ms);
        fputs(" ms</th>", stream);
    }
    fputs("</tr>\n", stream);
}

static void write_flicker_table(FILE *stream, const study_record *record, uint32_t material)
{
    const study_plan *plan = record->plan;
    write_flicker_head(stream, record, material);
    for (uint32_t s = 0; s < plan->strategy_count; s++) {
        fputs("<tr>", stream);
        write_strategy(stream, plan, s);
        for (uint32_t i = 0; i < plan->spp_count; i++) {
            const study_score equal = study_score_mean(record, material, s, i, STUDY_EQUAL_SAMPLES);
            if (!plan->is_shown[i])
                continue;
            fputs("<td>", stream);
            write_number(stream, equal.flicker);
            fputs("</td><td>", stream);
            write_number(stream, equal.flicker_ratio);
            fputs("</td><td>", stream);
            write_number(stream, study_score_mean(record, material, s, i, STUDY_TIME_OF_SLOWEST).flicker);
            fputs("</td>", stream);
        }
        fputs("</tr>\n", stream);
    }
    fputs("</table></div>\n", stream);
}

static void write_flicker(FILE *stream, const study_record *record, uint32_t material)
{
    if (record->plan->sequence < 2)
        return;
    write_flicker_table(stream, record, material);
    if (!study_chart_has_flicker(record->plan))
        return;
    const chart over_spp = study_chart_flicker(record, material, false);
    const chart over_time = study_chart_flicker(record, material, true);
    write_charts(stream, &over_spp, &over_time);
}

static void write_means(FILE *stream, const study_record *record)
{
    const study_plan *plan = record->plan;
    fprintf(stream, "<h2>%s</h2>\n<p class=\"note\">relMSE and time by geometric means, others by means.</p>\n",
            plan->environment_count > 1 ? "Means over all environments" : "Summary");
    for (uint32_t material = 0; material < plan->material_count; material++) {
        const chart over_spp = study_chart_mean(record, material, false);
        const chart over_time = study_chart_mean(record, material, true);
        fputs("<h3>", stream);
        write_text(stream, plan->materials[material].name);
        fputs("</h3>\n", stream);
        write_mean_table(stream, record, material, STUDY_EQUAL_SAMPLES);
        write_mean_table(stream, record, material, STUDY_TIME_OF_SLOWEST);
        write_charts(stream, &over_spp, &over_time);
        write_flicker(stream, record, material);
    }
}

/* ---- pairs --------------------------------------------------------------------------------- */

typedef struct column {
    const char *title;
    const char *number; /* of study_numbers */
    double scale;
} column;

static const column columns[] = {
    {"relMSE", "relmse", 1},
    {"RMSE", "rmse", 1},
    {"Lab", "lab_mean", 1},
    {"FLIP", "flip", 1},
    {"useful, %", "useful_share", 100},
    {"frame, ms", "total_ms", 1},
    {"cube", "cube_ms", 1},
    {"tables", "tables_ms", 1},
    {"pools", "pools_ms", 1},
    {"rays", "primary_ms", 1},
    {"shading", "shade_ms", 1},
    {"flicker", "flicker", 1},
    {"of relMSE, %", "flicker_ratio", 100},
};
enum { COLUMNS = sizeof columns / sizeof columns[0] };

static double value_of(const column *column_of, const study_cell *cell)
{
    for (int i = 0; i < STUDY_NUMBERS; i++)
        if (strcmp(study_numbers[i].name, column_of->number) == 0)
            return column_of->scale * study_number_of(cell, &study_numbers[i]);
    return (double)NAN;
}

static void write_point(FILE *stream, const study_record *record, const study_point *point)
{
    const study_plan *plan = record->plan;
    const study_cell *cell = &record->cells[study_plan_index(plan, point)];
    if (!cell->is_done)
        return;
    fputs("<tr>", stream);
    write_strategy(stream, plan, point->strategy);
    fprintf(stream, "<td>%u</td>", plan->spp[point->spp]);
    for (size_t i = 0; i < COLUMNS; i++) {
        fputs("<td>", stream);
        write_number(stream, value_of(&columns[i], cell));
        fputs("</td>", stream);
    }
    fputs("<td>", stream);
    if (point->spp == plan->spp_count - 1) {
        const study_curve curve = study_curve_make(record, point->environment, point->material, point->strategy);
        write_number(stream, study_curve_slope(&curve));
    }
    fputs("</td></tr>\n", stream);
}

static void write_pair_table(FILE *stream, const study_record *record, const study_point *pair)
{
    study_point point = *pair;
    fputs("<div class=\"scroll\"><table>\n<tr><th>strategy</th><th>spp</th>", stream);
    for (size_t i = 0; i < COLUMNS; i++)
        fprintf(stream, "<th>%s</th>", columns[i].title);
    fputs("<th>slope</th></tr>\n", stream);
    for (point.strategy = 0; point.strategy < record->plan->strategy_count; point.strategy++)
        for (point.spp = 0; point.spp < record->plan->spp_count; point.spp++)
            write_point(stream, record, &point);
    fputs("</table></div>\n", stream);
}

/* ---- pictures ------------------------------------------------------------------------------ */

static void write_picture(FILE *stream, const study_record *record, const study_point *point, const char *what,
                          const char *words)
{
    char path[STUDY_PATH];
    FILE *probe;
    study_job_picture_path(record->plan, point, what, path);
    if ((probe = fopen(path, "rb")) == NULL)
        return;
    fclose(probe);
    fputs("<figure><img alt=\"", stream);
    write_text(stream, words);
    fputs("\" src=\"", stream);
    data_uri_write(stream, "image/png", path);
    fputs("\"/><figcaption>", stream);
    write_text(stream, words);
    fputs("</figcaption></figure>\n", stream);
}

static void write_scale(FILE *stream)
{
    double range, rgb[3];
    helio_error_map map = study_job_error_map(&range);
    fputs("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"360\" height=\"34\" font-family=\"sans-serif\" "
          "font-size=\"11\">\n",
          stream);
    for (int i = 0; i < 64; i++) {
        false_colour((i + 0.5) / 64, rgb);
        fprintf(stream, "<rect x=\"%d\" y=\"0\" width=\"5\" height=\"12\" fill=\"#%02x%02x%02x\"/>\n", 5 * i,
                (unsigned)lrint(255 * rgb[0]), (unsigned)lrint(255 * rgb[1]), (unsigned)lrint(255 * rgb[2]));
    }
    fprintf(stream,
            "<text x=\"0\" y=\"26\">0</text><text x=\"320\" y=\"26\" text-anchor=\"end\">\u2265 %g</text>"
            "<text x=\"160\" y=\"26\" text-anchor=\"middle\">%s</text>\n</svg>\n",
            range, map == HELIO_ERROR_MAP_LAB ? "difference in L*a*b*" : "FLIP");
}

static void write_strategy_pictures(FILE *stream, const study_record *record, const study_point *point)
{
    const study_plan *plan = record->plan;
    const study_cell *cell = &record->cells[study_plan_index(plan, point)];
    const char *name = plan->strategies[point->strategy].name;
    char words[256];
    fputs("<div>", stream);
    snprintf(words, sizeof words, "%s: %.1f ms, relMSE %.3g", name, cell->total_ms, cell->relmse);
    write_picture(stream, record, point, "picture", words);
    snprintf(words, sizeof words, "error of %s, Lab %.3g", name, cell->lab_mean);
    write_picture(stream, record, point, "error", words);
    fputs("</div>\n", stream);
}

static void write_pictures(FILE *stream, const study_record *record, const study_point *pair)
{
    const study_plan *plan = record->plan;
    study_point point = *pair;
    write_picture(stream, record, &point, "reference", "reference");
    for (point.spp = 0; point.spp < plan->spp_count; point.spp++) {
        if (!plan->is_shown[point.spp])
            continue;
        fprintf(stream, "<h3>With %u samples</h3>\n<div class=\"pictures\">\n", plan->spp[point.spp]);
        for (point.strategy = 0; point.strategy < plan->strategy_count; point.strategy++)
            write_strategy_pictures(stream, record, &point);
        fputs("</div>\n", stream);
    }
    write_scale(stream);
}

static void write_pair(FILE *stream, const study_record *record, const study_point *pair)
{
    const study_plan *plan = record->plan;
    const study_cell *first = &record->cells[study_plan_index(plan, pair)];
    const chart over_spp = study_chart_pair(record, pair->environment, pair->material, false);
    const chart over_time = study_chart_pair(record, pair->environment, pair->material, true);
    fputs("<h2>", stream);
    write_text(stream, plan->environments[pair->environment].name);
    fputs(", ", stream);
    write_text(stream, plan->materials[pair->material].name);
    fprintf(stream,
            "</h2>\n<p class=\"note\">Shown at %+.2f stops, tone map %s, white D65. Standard error of the reference: "
            "%.3g, as an RMSE.</p>\n",
            first->exposure, helio_tonemap_name(plan->tonemap), first->reference_rmse);
    write_charts(stream, &over_spp, &over_time);
    write_pair_table(stream, record, pair);
    if (study_job_has_pictures() && study_plan_shows(plan, pair->environment, pair->material))
        write_pictures(stream, record, pair);
}

int study_page_write(const study_record *record, const char *path)
{
    char temporary[4096];
    FILE *stream = output_file_open(path, temporary, sizeof temporary);
    if (stream == NULL)
        return message_failure("%s cannot be written: %s", path, strerror(errno));
    fputs(HEAD, stream);
    write_introduction(stream, record);
    write_means(stream, record);
    for (size_t i = 0; i < study_plan_count(record->plan); i++) {
        study_point point = study_plan_point(record->plan, i);
        if (point.strategy == 0 && point.spp == 0)
            write_pair(stream, record, &point);
    }
    write_scene(stream, record);
    fputs("</body>\n</html>\n", stream);
    return output_file_finish(stream, temporary, path);
}
