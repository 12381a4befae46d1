/* SPDX-License-Identifier: MIT
 *
 * The words of the figure: what was asked for, what the marks mean, and the counts. */
#include "output_file.h"
#include "samples_drawing.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- legend ------------------------------------------------------------------------------- */

enum { MARK_TEXT = 160 };

static void count_text(char text[MARK_TEXT], uint32_t count, const char *words)
{
    snprintf(text, MARK_TEXT, "%" PRIu32 " %s", count, words);
}

static void tell_pools(const samples_findings *found, char text[MARK_TEXT])
{
    char passes[32] = "";
    if (found->passes > 1)
        snprintf(passes, sizeof passes, ", in %" PRIu32 " passes", found->passes);
    if (samples_is_by_face(found))
        snprintf(text, MARK_TEXT, "%" PRIu32 " pre-generated light samples, %" PRIu32 " for each face with light%s",
                 found->pooled, found->pool_length, passes);
    else if (found->pool_count > 0)
        snprintf(text, MARK_TEXT, "%" PRIu32 " pre-generated light samples%s", found->pooled, passes);
}

/* "" for marks that are not there. */
static void tell_mark(const samples_findings *found, samples_mark mark, char text[MARK_TEXT])
{
    const technique_count *surface = &found->techniques[SURFACE_TECHNIQUE];
    const char *name = samples_technique_name(found, SURFACE_TECHNIQUE);
    bool has_light = found->pool_count > 0, has_surface = surface->expected > 0;
    bool has_shadows = found->pixel.estimate.visibility != NULL;
    uint32_t used = found->all.fates[SAMPLE_USED] - surface->fates[SAMPLE_USED];
    uint32_t shadowed = found->all.fates[SAMPLE_SHADOWED] - surface->fates[SAMPLE_SHADOWED];
    char words[64];
    text[0] = 0;
    switch (mark) {
    case MARK_POOLED: tell_pools(found, text); break;
    case MARK_USED:
        if (has_light)
            count_text(text, used, "of them are used: they light the point");
        break;
    case MARK_SHADOWED:
        if (has_light && has_shadows)
            count_text(text, shadowed, "in shadow: something is in their way");
        break;
    case MARK_USELESS:
        if (has_light)
            count_text(text, samples_useless(&found->all) - samples_useless(surface),
                       "useless: below the horizon, or without light");
        break;
    case MARK_SURFACE_USED:
        snprintf(words, sizeof words, "%s samples light the point", name);
        if (has_surface)
            count_text(text, surface->fates[SAMPLE_USED], words);
        break;
    case MARK_SURFACE_SHADOWED:
        snprintf(words, sizeof words, "%s samples in shadow", name);
        if (has_surface && has_shadows)
            count_text(text, surface->fates[SAMPLE_SHADOWED], words);
        break;
    case MARK_SURFACE_USELESS:
        snprintf(words, sizeof words, "useless %s samples", name);
        if (has_surface)
            count_text(text, samples_useless(surface), words);
        break;
    case MARK_NORMAL: snprintf(text, MARK_TEXT, "the surface normal"); break;
    case MARK_HORIZON: snprintf(text, MARK_TEXT, "the horizon of the point; darkened: what lies below it"); break;
    case MARK_FLAT_HORIZON:
        if (samples_has_flat_horizon(found))
            snprintf(text, MARK_TEXT, "the horizon of the flat triangle");
        break;
    case MARK_COUNT: break;
    }
}

double samples_draw_legend(const samples_drawing *d, double left, double top, double width)
{
    enum { LINE = 25, TEXT_LEFT = 32 };
    double y = top + 10;
    for (int mark = 0; mark < MARK_COUNT; mark++) {
        char text[MARK_TEXT];
        tell_mark(d->view->found, (samples_mark)mark, text);
        if (text[0] == 0)
            continue;
        samples_draw_mark(d->cairo, (samples_mark)mark, left + 11, y, mark == MARK_POOLED ? 1.6 : 1.1);
        set_font(d->cairo, 13, false);
        set_grey(d->cairo, INK);
        draw_paragraph(d->cairo, left + TEXT_LEFT, y + 4.5, width - TEXT_LEFT, LINE, text);
        y += LINE;
    }
    return y;
}

/* ---- title -------------------------------------------------------------------------------- */

static void tell_material(const helio_material *material, char *text, size_t size)
{
    const float *kd = material->diffuse, *ks = material->specular;
    if (material->kind == HELIO_MATERIAL_PHONG)
        snprintf(text, size, "Phong, kd %.2g, ks %.2g, n %.4g", (double)kd[1], (double)ks[1],
                 (double)material->exponent);
    else if (material->kind == HELIO_MATERIAL_GGX)
        snprintf(text, size, "GGX, metallic %.2g, roughness %.2g", (double)material->metallic,
                 (double)material->roughness);
    else
        snprintf(text, size, "diffuse %.2g, %.2g, %.2g", (double)kd[0], (double)kd[1], (double)kd[2]);
}

static double draw_point_entries(const samples_drawing *d, const text_box *box, double y)
{
    const samples_findings *found = d->view->found;
    const float *normal = found->pixel.point.normal;
    char text[MARK_TEXT];
    snprintf(text, sizeof text, "%" PRIu32 ", %" PRIu32 " of %" PRIu32 " \u00d7 %" PRIu32, found->x, found->y,
             d->view->picture.width, d->view->picture.height);
    y = draw_entry(d->cairo, box, y, "pixel", text);
    snprintf(text, sizeof text, "%.2f, %.2f, %.2f", (double)normal[0], (double)normal[1], (double)normal[2]);
    y = draw_entry(d->cairo, box, y, "normal", text);
    tell_material(&found->pixel.point.material, text, sizeof text);
    y = draw_entry(d->cairo, box, y, "surface", text);
    snprintf(text, sizeof text, "%.3g, %.3g, %.3g", found->radiance[0], found->radiance[1], found->radiance[2]);
    return draw_entry(d->cairo, box, y, "radiance", text);
}

void samples_draw_title(const samples_drawing *d, double left, double top, double width)
{
    const samples_findings *found = d->view->found;
    const text_box box = {.left = left, .width = width, .label_width = 76};
    char text[4096];
    double y = top + 16;
    set_grey(d->cairo, INK);
    snprintf(text, sizeof text, "%s%s%s", output_file_last_part(found->source), found->is_dynamic ? ", " : "",
             found->is_dynamic ? found->label : "");
    draw_name(d->cairo, left, y, width, text);
    y += 30;
    snprintf(text, sizeof text, "%s, %" PRIu32 " samples%s", helio_strategy_name(found->strategy),
             d->view->plan->options->spp, found->pixel.estimate.visibility == NULL ? ", no shadows" : "");
    y = draw_entry(d->cairo, &box, y, "strategy", text);
    y = draw_point_entries(d, &box, y);
    snprintf(text, sizeof text, "%+.2f stops", (double)found->exposure);
    draw_entry(d->cairo, &box, y, "exposure", text);
}

/* ---- table -------------------------------------------------------------------------------- */

typedef struct table_row {
    const char *name;
    const technique_count *count;
    int face; /* -1: none */
} table_row;

enum { TABLE_COLUMNS = 7 };

/* Right edges, as parts of the width. */
static const double COLUMNS[TABLE_COLUMNS] = {0, 0.25, 0.42, 0.51, 0.64, 0.82, 1};

static double draw_cells(cairo_t *cairo, double left, double y, double width, char cells[TABLE_COLUMNS][16])
{
    for (int column = 0; column < TABLE_COLUMNS; column++)
        draw_text(cairo, left + width * COLUMNS[column], y, column == 0 ? 0 : 1, cells[column]);
    return y + 22;
}

static double draw_row(const samples_drawing *d, double left, double y, double width, const table_row *row)
{
    const technique_count *count = row->count;
    const double *flux = d->view->found->flux, all = flux[0] + flux[1] + flux[2] + flux[3] + flux[4] + flux[5];
    char cells[TABLE_COLUMNS][16] = {{0}};
    snprintf(cells[0], sizeof cells[0], "%s", row->name);
    if (row->face >= 0)
        snprintf(cells[1], sizeof cells[1], "%.1f %%", all > 0 ? 100 * flux[row->face] / all : 0.0);
    snprintf(cells[2], sizeof cells[2], count->expected < 100 ? "%.2f" : "%.1f", count->expected);
    snprintf(cells[3], sizeof cells[3], "%" PRIu32, count->realised);
    snprintf(cells[4], sizeof cells[4], "%" PRIu32, count->fates[SAMPLE_USED]);
    snprintf(cells[5], sizeof cells[5], "%" PRIu32, count->fates[SAMPLE_SHADOWED]);
    snprintf(cells[6], sizeof cells[6], "%" PRIu32, samples_useless(count));
    set_grey(d->cairo, count->expected > 0 ? INK : FAINT);
    return draw_cells(d->cairo, left, y, width, cells);
}

static double draw_rule(cairo_t *cairo, double left, double y, double width)
{
    set_grey(cairo, RULE);
    cairo_set_line_width(cairo, 1);
    cairo_move_to(cairo, left, y - 15.5);
    cairo_line_to(cairo, left + width, y - 15.5);
    cairo_stroke(cairo);
    return y + 3;
}

void samples_draw_table(const samples_drawing *d, double left, double top, double width)
{
    const samples_findings *found = d->view->found;
    char head[TABLE_COLUMNS][16] = {"", "light", "m", "N", "used", "shadow", "useless"};
    double y = top + 12;
    set_font(d->cairo, 12, false);
    set_grey(d->cairo, FAINT);
    y = draw_rule(d->cairo, left, draw_cells(d->cairo, left, y, width, head), width);
    set_font(d->cairo, 12, false);
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++) {
        bool has_pool = technique < found->pool_count;
        const table_row row = {samples_technique_name(found, technique), &found->techniques[technique],
                               has_pool && samples_is_by_face(found) ? (int)technique : -1};
        if (has_pool || row.count->expected > 0)
            y = draw_row(d, left, y, width, &row);
    }
    const table_row all = {"all", &found->all, -1};
    y = draw_row(d, left, draw_rule(d->cairo, left, y, width), width, &all);
    set_font(d->cairo, 11, false);
    set_grey(d->cairo, FAINT);
    draw_paragraph(d->cairo, left, y + 6, width, 15, "m: expected samples; N: taken; light: part of all light");
}

void samples_draw_face_labels(const samples_drawing *d, double font_size)
{
    const samples_findings *found = d->view->found;
    for (int face = 0; face < FACE_COUNT; face++) {
        const technique_count *count = &found->techniques[face];
        char text[64];
        if (samples_is_by_face(found))
            snprintf(text, sizeof text, "%s   N %" PRIu32 "   m %.2f", face_names[face], count->realised,
                     count->expected);
        else
            snprintf(text, sizeof text, "%s   %" PRIu32 " sample%s", face_names[face], found->fallen[face],
                     found->fallen[face] == 1 ? "" : "s");
        cube_cross_label(d->cairo, &d->cross, face, font_size, text);
    }
}

/* ---- the legend of several frames ----------------------------------------------------------- */

static const char *word_of(const samples_findings *found, samples_mark mark)
{
    static const char *const words[MARK_COUNT] = {
        "pre-generated",   "used",          "in shadow", "useless", "BRDF, used",
        "BRDF, in shadow", "BRDF, useless", "normal",    "horizon", "horizon of the triangle"};
    char text[MARK_TEXT];
    tell_mark(found, mark, text);
    return text[0] != 0 ? words[mark] : NULL;
}

void samples_draw_key(cairo_t *cairo, const samples_findings *found, double left, double y)
{
    enum { MARK_WIDTH = 26, GAP = 30 };
    double x = left;
    for (int mark = 0; mark < MARK_COUNT; mark++) {
        const char *word = word_of(found, (samples_mark)mark);
        if (word == NULL)
            continue;
        samples_draw_mark(cairo, (samples_mark)mark, x + 10, y - 5, mark == MARK_POOLED ? 1.8 : 1.15);
        set_font(cairo, 15, false);
        set_grey(cairo, INK);
        draw_text(cairo, x + MARK_WIDTH, y, 0, word);
        x += MARK_WIDTH + text_width(cairo, word) + GAP;
    }
}
