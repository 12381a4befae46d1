/* SPDX-License-Identifier: MIT */
#include "study_sheets.h"

#include "false_colour.h"
#include "figure.h"
#include "figure_text.h"
#include "message.h"
#include "study_job.h"

#include <stdio.h>

enum { COLUMN = 340, GAP = 10, MARGIN = 16, CAPTION = 20 };

/* What a pair shows: the reference, and beside it a table of spp and strategies, of which each has a picture and the
 * errors below. */
typedef struct sheet {
    const study_record *record;
    study_point pair;
    bool has_rows_of_strategies; /* else columns, where there are more of them than of spp */
    double picture_height;       /* as it is drawn */
} sheet;

/* ---- pictures ------------------------------------------------------------------------------ */

/* The caller destroys it; its status tells whether there is such a picture. */
static cairo_surface_t *load(const study_plan *plan, const study_point *point, const char *what)
{
    char path[STUDY_PATH];
    study_job_picture_path(plan, point, what, path);
    return cairo_image_surface_create_from_png(path);
}

static void draw_picture(cairo_t *cairo, const sheet *subject, const study_point *point, const char *what, double x,
                         double y)
{
    cairo_surface_t *picture = load(subject->record->plan, point, what);
    if (cairo_surface_status(picture) == CAIRO_STATUS_SUCCESS) {
        double zoom = (double)COLUMN / cairo_image_surface_get_width(picture);
        cairo_save(cairo);
        cairo_translate(cairo, x, y);
        cairo_scale(cairo, zoom, zoom);
        cairo_set_source_surface(cairo, picture, 0, 0);
        cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_GOOD);
        cairo_paint(cairo);
        cairo_restore(cairo);
    }
    cairo_surface_destroy(picture);
}

static void draw_caption(cairo_t *cairo, double x, double y, const char *text)
{
    set_font(cairo, 12, false);
    set_grey(cairo, INK);
    draw_text(cairo, x + COLUMN / 2.0, y, 0.5, text);
}

/* ---- the sheet ----------------------------------------------------------------------------- */

static uint32_t count_shown(const study_plan *plan)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < plan->spp_count; i++)
        count += plan->is_shown[i];
    return count;
}

static void draw_cell(cairo_t *cairo, const sheet *subject, const study_point *point, double x, double y)
{
    const study_plan *plan = subject->record->plan;
    const study_cell *cell = &subject->record->cells[study_plan_index(plan, point)];
    char text[128];
    draw_picture(cairo, subject, point, "picture", x, y);
    y += subject->picture_height + CAPTION - 5;
    snprintf(text, sizeof text, "%s, %u spp, %.3g frames/s", plan->strategies[point->strategy].name,
             plan->spp[point->spp], 1e3 / cell->total_ms);
    draw_caption(cairo, x, y, text);
    draw_picture(cairo, subject, point, "error", x, y + 5);
    y += 5 + subject->picture_height + CAPTION - 5;
    snprintf(text, sizeof text, "Lab %.3g, relMSE %.3g", cell->lab_mean, cell->relmse);
    draw_caption(cairo, x, y, text);
}

static void draw_scale(cairo_t *cairo, double x, double y)
{
    double range, rgb[3];
    char text[64];
    helio_error_map map = study_job_error_map(&range);
    for (int i = 0; i < COLUMN; i++) {
        false_colour((i + 0.5) / COLUMN, rgb);
        cairo_set_source_rgb(cairo, rgb[0], rgb[1], rgb[2]);
        cairo_rectangle(cairo, x + i, y, 1, 12);
        cairo_fill(cairo);
    }
    snprintf(text, sizeof text, "\u2265 %g", range);
    set_font(cairo, 11, false);
    set_grey(cairo, FAINT);
    draw_text(cairo, x, y + 26, 0, "0");
    draw_text(cairo, x + COLUMN / 2.0, y + 26, 0.5, map == HELIO_ERROR_MAP_LAB ? "difference in L*a*b*" : "FLIP");
    draw_text(cairo, x + COLUMN, y + 26, 1, text);
}

static double row_height(const sheet *subject)
{
    return 2 * (subject->picture_height + CAPTION) + GAP;
}

static void draw(cairo_t *cairo, const void *data)
{
    const sheet *subject = data;
    const study_plan *plan = subject->record->plan;
    study_point point = subject->pair;
    set_grey(cairo, BACKGROUND);
    cairo_paint(cairo);
    draw_picture(cairo, subject, &point, "reference", MARGIN, MARGIN);
    draw_caption(cairo, MARGIN, MARGIN + subject->picture_height + CAPTION - 5, "reference");
    draw_scale(cairo, MARGIN, MARGIN + subject->picture_height + CAPTION + GAP);
    uint32_t shown = 0;
    for (point.spp = 0; point.spp < plan->spp_count; point.spp++) {
        if (!plan->is_shown[point.spp])
            continue;
        for (point.strategy = 0; point.strategy < plan->strategy_count; point.strategy++) {
            uint32_t column = subject->has_rows_of_strategies ? shown : point.strategy;
            uint32_t row = subject->has_rows_of_strategies ? point.strategy : shown;
            draw_cell(cairo, subject, &point, MARGIN + (column + 1.0) * (COLUMN + GAP),
                      MARGIN + row * row_height(subject));
        }
        shown++;
    }
}

static int write_sheet(const study_record *record, const study_point *pair)
{
    static const char *const endings[] = {"png", "pdf"};
    uint32_t shown = count_shown(record->plan), strategies = record->plan->strategy_count;
    sheet subject = {.record = record, .pair = *pair, .has_rows_of_strategies = shown >= strategies};
    uint32_t columns = subject.has_rows_of_strategies ? shown : strategies;
    uint32_t rows = subject.has_rows_of_strategies ? strategies : shown;
    char stem[160], name[192], path[STUDY_PATH];
    cairo_surface_t *reference = load(record->plan, pair, "reference");
    if (cairo_surface_status(reference) == CAIRO_STATUS_SUCCESS)
        subject.picture_height =
            (double)COLUMN * cairo_image_surface_get_height(reference) / cairo_image_surface_get_width(reference);
    cairo_surface_destroy(reference);
    const figure drawn = {.width = 2 * MARGIN + (int)(columns + 1) * (COLUMN + GAP) - GAP,
                          .height = 2 * MARGIN + (int)(rows * row_height(&subject)) - GAP,
                          .draw = draw,
                          .data = &subject};
    int code = EXIT_CODE_OK;
    study_job_pair_name(record->plan, pair->environment, pair->material, stem);
    for (int i = 0; code == EXIT_CODE_OK && i < 2; i++) {
        snprintf(name, sizeof name, "sheets/%s.%s", stem, endings[i]);
        study_job_path(record->plan, name, path);
        code = figure_write("out", path, &drawn);
    }
    return code;
}

int study_sheets_write(const study_record *record)
{
    const study_plan *plan = record->plan;
    int code =
        study_job_has_pictures() && plan->options->study.pictures > 0 ? study_job_folder(plan, "sheets") : EXIT_CODE_OK;
    for (size_t i = 0; code == EXIT_CODE_OK && study_job_has_pictures() && i < study_plan_count(plan); i++) {
        study_point point = study_plan_point(plan, i);
        if (point.strategy == 0 && point.spp == 0 && study_plan_shows(plan, point.environment, point.material))
            code = write_sheet(record, &point);
    }
    return code;
}
