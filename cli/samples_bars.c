/* SPDX-License-Identifier: MIT
 *
 * How many samples each technique takes, and what becomes of them, as bars. */
#include "samples_drawing.h"

#include <inttypes.h>
#include <stdio.h>

enum { LINE = 19, BAR = 12, NAME_WIDTH = 46, NUMBER_WIDTH = 34 };

typedef struct bar_scale {
    double left, width; /* of a bar of all samples */
    double all;
} bar_scale;

static double bar_x(const bar_scale *scale, double samples)
{
    return scale->left + scale->width * samples / scale->all;
}

/* Those in shadow are hollow, as their marks are. */
static void draw_part(cairo_t *cairo, const bar_scale *scale, samples_mark mark, double y, const uint32_t range[2])
{
    double left = bar_x(scale, range[0]), right = bar_x(scale, range[1]);
    bool is_hollow = mark == MARK_SHADOWED || mark == MARK_SURFACE_SHADOWED;
    if (range[0] == range[1])
        return;
    samples_set_mark_colour(cairo, mark);
    cairo_set_line_width(cairo, 1);
    if (is_hollow)
        cairo_rectangle(cairo, left + 0.5, y + 0.5, right - left - 1, BAR - 1);
    else
        cairo_rectangle(cairo, left, y, right - left, BAR);
    if (is_hollow)
        cairo_stroke(cairo);
    else
        cairo_fill(cairo);
}

static void draw_parts(cairo_t *cairo, const bar_scale *scale, bool is_surface, const technique_count *count, double y)
{
    const uint32_t used = count->fates[SAMPLE_USED], lit = used + count->fates[SAMPLE_SHADOWED];
    const uint32_t ranges[3][2] = {{0, used}, {used, lit}, {lit, count->realised}};
    const samples_mark marks[3] = {is_surface ? MARK_SURFACE_USED : MARK_USED,
                                   is_surface ? MARK_SURFACE_SHADOWED : MARK_SHADOWED, MARK_USELESS};
    for (int part = 0; part < 3; part++)
        draw_part(cairo, scale, marks[part], y, ranges[part]);
}

static void draw_expected(cairo_t *cairo, const bar_scale *scale, double expected, double y)
{
    double x = bar_x(scale, expected);
    set_grey(cairo, INK);
    cairo_set_line_width(cairo, 1.5);
    cairo_move_to(cairo, x, y - 2.5);
    cairo_line_to(cairo, x, y + BAR + 2.5);
    cairo_stroke(cairo);
}

static void draw_bar(const samples_drawing *d, const bar_scale *scale, uint32_t technique, double y)
{
    const samples_findings *found = d->view->found;
    const technique_count *count = &found->techniques[technique];
    char number[16];
    double end = bar_x(scale, count->realised > count->expected ? count->realised : count->expected);
    set_font(d->cairo, 12, false);
    set_grey(d->cairo, count->expected > 0 ? INK : FAINT);
    draw_text(d->cairo, scale->left - 8, y + BAR - 2, 1, samples_technique_name(found, technique));
    snprintf(number, sizeof number, "%" PRIu32, count->realised);
    draw_text(d->cairo, end + 6, y + BAR - 2, 0, number);
    draw_parts(d->cairo, scale, technique == SURFACE_TECHNIQUE, count, y);
    if (count->expected > 0)
        draw_expected(d->cairo, scale, count->expected, y);
}

static bool has_bar(const samples_findings *found, uint32_t technique)
{
    return technique < found->pool_count || found->techniques[technique].expected > 0;
}

void samples_draw_bars(const samples_drawing *d, double left, double bottom, double width)
{
    const samples_findings *found = d->view->found;
    const bar_scale scale = {
        .left = left + NAME_WIDTH, .width = width - NAME_WIDTH - NUMBER_WIDTH, .all = d->view->plan->options->spp};
    double y = bottom + LINE - BAR;
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++)
        y -= has_bar(found, technique) ? LINE : 0;
    for (uint32_t technique = 0; technique < TECHNIQUES; technique++)
        if (has_bar(found, technique)) {
            draw_bar(d, &scale, technique, y);
            y += LINE;
        }
}
