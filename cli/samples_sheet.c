/* SPDX-License-Identifier: MIT
 *
 * Six frames in one figure. Each is drawn when it comes, and kept as a drawing. */
#include "figure.h"
#include "output_file.h"
#include "samples_drawing.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum {
    FACE_EDGE = 160,
    CELL_WIDTH = 4 * FACE_EDGE,
    CELL_HEIGHT = 3 * FACE_EDGE,
    COLUMNS = 3,
    GAP = 28,
    HEAD_HEIGHT = 52,
    KEY_HEIGHT = 44
};

static const double MARK_SIZE = 0.72;

struct samples_sheet {
    const char *path;
    uint64_t total;
    uint32_t count;
    cairo_surface_t *cells[SAMPLES_SHEET_CELLS];
    samples_findings found; /* of the latest, without samples and pools: for title and legend */
    uint32_t width, height; /* of the render */
};

samples_sheet *samples_sheet_make(const char *path, uint64_t total)
{
    samples_sheet *sheet = calloc(1, sizeof *sheet);
    if (sheet != NULL) {
        sheet->path = path;
        sheet->total = total;
    }
    return sheet;
}

void samples_sheet_release(samples_sheet *sheet)
{
    for (uint32_t i = 0; sheet != NULL && i < sheet->count; i++)
        cairo_surface_destroy(sheet->cells[i]);
    free(sheet);
}

bool samples_sheet_is_full(const samples_sheet *sheet)
{
    return sheet->count == SAMPLES_SHEET_CELLS;
}

/* Of a known number the first, the last, and as even as can be between them; else the first ones. */
bool samples_sheet_wants(const samples_sheet *sheet, uint64_t position)
{
    if (samples_sheet_is_full(sheet))
        return false;
    if (sheet->total <= SAMPLES_SHEET_CELLS)
        return true;
    double next = (double)sheet->count * (double)(sheet->total - 1) / (SAMPLES_SHEET_CELLS - 1);
    return position >= (uint64_t)floor(next + 0.5);
}

/* ---- one frame ---------------------------------------------------------------------------- */

static void draw_counts(const samples_drawing *d, double left, double y)
{
    const samples_findings *found = d->view->found;
    char text[64];
    set_font(d->cairo, 13, false);
    set_grey(d->cairo, INK);
    snprintf(text, sizeof text, "%" PRIu32 " used", found->all.fates[SAMPLE_USED]);
    draw_text(d->cairo, left, y, 0, text);
    if (found->pixel.estimate.visibility != NULL) {
        snprintf(text, sizeof text, "%" PRIu32 " in shadow", found->all.fates[SAMPLE_SHADOWED]);
        draw_text(d->cairo, left, y += 20, 0, text);
    }
    snprintf(text, sizeof text, "%" PRIu32 " useless", samples_useless(&found->all));
    draw_text(d->cairo, left, y += 20, 0, text);
    set_grey(d->cairo, FAINT);
    snprintf(text, sizeof text, "of %" PRIu32, found->sample_count);
    draw_text(d->cairo, left, y + 20, 0, text);
}

static void draw_cell(const samples_drawing *d)
{
    char text[64];
    samples_draw_map(d);
    samples_draw_pools(d);
    samples_draw_face_labels(d, 10);
    samples_draw_samples(d);
    samples_draw_render(d, 2 * FACE_EDGE + 10, 0, 2 * FACE_EDGE - 10, FACE_EDGE - 10);
    set_grey(d->cairo, INK);
    draw_name(d->cairo, 0, 18, FACE_EDGE - 10, d->view->found->label);
    set_font(d->cairo, 13, false);
    set_grey(d->cairo, FAINT);
    snprintf(text, sizeof text, "%+.1f stops", (double)d->view->found->exposure);
    draw_text(d->cairo, 0, 42, 0, text);
    draw_counts(d, 0, 2 * FACE_EDGE + 28);
    samples_draw_bars(d, 2 * FACE_EDGE + 10, CELL_HEIGHT - 10, 2 * FACE_EDGE - 10);
}

void samples_sheet_add(samples_sheet *sheet, const samples_view *view)
{
    const cairo_rectangle_t extents = {0, 0, CELL_WIDTH, CELL_HEIGHT};
    cairo_surface_t *surface = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, &extents);
    const samples_drawing d = {.cairo = cairo_create(surface),
                               .view = view,
                               .cross = {.edge = FACE_EDGE},
                               .size = MARK_SIZE,
                               .detail = samples_detail(sheet->path)};
    draw_cell(&d);
    cairo_destroy(d.cairo);
    sheet->cells[sheet->count++] = surface;
    sheet->found = *view->found;
    sheet->found.pools = NULL;
    sheet->found.samples = NULL;
    sheet->width = view->picture.width;
    sheet->height = view->picture.height;
}

/* ---- the sheet ---------------------------------------------------------------------------- */

static int columns_of(const samples_sheet *sheet)
{
    return (int)sheet->count < COLUMNS ? (int)sheet->count : COLUMNS;
}

static int sheet_width(const samples_sheet *sheet)
{
    return 2 * SAMPLES_MARGIN + columns_of(sheet) * (CELL_WIDTH + GAP) - GAP;
}

static int sheet_height(const samples_sheet *sheet)
{
    int rows = ((int)sheet->count + COLUMNS - 1) / COLUMNS;
    return 2 * SAMPLES_MARGIN + rows * (CELL_HEIGHT + GAP) - GAP + HEAD_HEIGHT + KEY_HEIGHT;
}

static void draw_head(cairo_t *cairo, const samples_sheet *sheet)
{
    const samples_findings *found = &sheet->found;
    char text[160];
    set_font(cairo, 20, true);
    set_grey(cairo, INK);
    const char *name = output_file_last_part(found->source);
    draw_name(cairo, SAMPLES_MARGIN, SAMPLES_MARGIN + 18, sheet_width(sheet) / 2.0, name);
    snprintf(text, sizeof text,
             "the light samples of pixel %" PRIu32 ", %" PRIu32 " of %" PRIu32 " \u00d7 %" PRIu32 ", strategy %s",
             found->x, found->y, sheet->width, sheet->height, helio_strategy_name(found->strategy));
    set_font(cairo, 15, false);
    set_grey(cairo, FAINT);
    draw_text(cairo, sheet_width(sheet) - SAMPLES_MARGIN, SAMPLES_MARGIN + 18, 1, text);
}

static void draw_foot(cairo_t *cairo, const samples_sheet *sheet)
{
    double y = sheet_height(sheet) - SAMPLES_MARGIN;
    samples_draw_key(cairo, &sheet->found, SAMPLES_MARGIN, y);
    set_font(cairo, 15, false);
    set_grey(cairo, FAINT);
    draw_text(cairo, sheet_width(sheet) - SAMPLES_MARGIN, y, 1, "N: samples taken; m and |: expected");
}

static void draw_sheet(cairo_t *cairo, const void *data)
{
    const samples_sheet *sheet = data;
    set_grey(cairo, BACKGROUND);
    cairo_paint(cairo);
    draw_head(cairo, sheet);
    for (int i = 0; i < (int)sheet->count; i++) {
        int column = i % COLUMNS, row = i / COLUMNS;
        cairo_set_source_surface(cairo, sheet->cells[i], SAMPLES_MARGIN + column * (CELL_WIDTH + GAP),
                                 SAMPLES_MARGIN + HEAD_HEIGHT + row * (CELL_HEIGHT + GAP));
        cairo_paint(cairo);
    }
    draw_foot(cairo, sheet);
}

int samples_sheet_write(const samples_sheet *sheet)
{
    const figure whole = {
        .width = sheet_width(sheet), .height = sheet_height(sheet), .draw = draw_sheet, .data = sheet};
    return figure_write("contact-sheet", sheet->path, &whole);
}
