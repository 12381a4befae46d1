/* SPDX-License-Identifier: MIT */
#include "chart.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEFT = 58, TOP = 30, BOTTOM = 46, NAMES_GAP = 8, MOST_LABELS = 7 };

static const uint32_t INK = 0x222222, FAINT = 0x666666, GRID = 0xe2e2e2;
static const double FONT = 11, LETTER = 7.2; /* width of a bold letter, rather too much */

/* An axis: numbers from low to high lie between two places. */
typedef struct chart_axis {
    double low, high, from, to;
} chart_axis;

typedef struct frame {
    canvas *on;
    chart_axis x, y;
} frame;

static bool is_drawn(double value)
{
    return isfinite(value) && value > 0;
}

static double place_of(const chart_axis *axis, double value)
{
    return axis->from + (axis->to - axis->from) * log(value / axis->low) / log(axis->high / axis->low);
}

/* ---- axes ---------------------------------------------------------------------------------- */

static void include(chart_axis *axis, double value)
{
    axis->low = fmin(axis->low, value);
    axis->high = fmax(axis->high, value);
}

/* Some room at both ends; an axis of no numbers, or of one, gets a decade. */
static void widen(chart_axis *axis)
{
    if (axis->low > axis->high)
        axis->low = axis->high = 1;
    double room = axis->high > axis->low * 1.01 ? pow(axis->high / axis->low, 0.06) : sqrt(10);
    axis->low /= room;
    axis->high *= room;
}

static void find_ranges(const chart *subject, frame *area)
{
    for (uint32_t s = 0; s < subject->series_count; s++)
        for (uint32_t i = 0; i < subject->series[s].count; i++) {
            double x = subject->series[s].x[i], y = subject->series[s].y[i];
            if (!is_drawn(x) || !is_drawn(y))
                continue;
            include(&area->x, x);
            include(&area->y, y);
        }
    /* The level is worth a decade below the curves, but no more. */
    if (is_drawn(subject->level) && subject->level > area->y.low / 10)
        include(&area->y, subject->level);
    widen(&area->x);
    widen(&area->y);
}

/* Numbers 1, 2, 5 times powers of ten, or powers of ten alone if those are many. */
static uint32_t count_ticks(const chart_axis *axis, int step)
{
    static const int digits[] = {1, 2, 5};
    uint32_t count = 0;
    for (int power = (int)floor(log10(axis->low)); power <= (int)ceil(log10(axis->high)); power++)
        for (int i = 0; i < 3; i += step) {
            double value = digits[i] * pow(10, power);
            count += value >= axis->low && value <= axis->high;
        }
    return count;
}

static void write_tick(double value, char text[32])
{
    snprintf(text, 32, value >= 1e5 || value < 1e-3 ? "%.0e" : "%g", value);
}

static void draw_tick(const frame *area, bool is_x, double value)
{
    char text[32];
    const canvas_stroke grid = {GRID, 1, 0};
    const canvas_text style = {FAINT, FONT, false, is_x ? CANVAS_MIDDLE : CANVAS_END, false};
    double place = place_of(is_x ? &area->x : &area->y, value);
    const double upright[2][2] = {{place, area->y.from}, {place, area->y.to}};
    const double flat[2][2] = {{area->x.from, place}, {area->x.to, place}};
    area->on->line(area->on, &grid, is_x ? upright : flat, 2);
    write_tick(value, text);
    area->on->text(area->on, &style, is_x ? place : area->x.from - 6, is_x ? area->y.from + 15 : place + 4, text);
}

static void draw_axis(const frame *area, bool is_x)
{
    static const int digits[] = {1, 2, 5};
    const chart_axis *axis = is_x ? &area->x : &area->y;
    int step = count_ticks(axis, 1) > MOST_LABELS ? 3 : 1, skip = 1;
    while (step == 3 && count_ticks(axis, step) / (uint32_t)skip > MOST_LABELS)
        skip++;
    for (int power = (int)floor(log10(axis->low)); power <= (int)ceil(log10(axis->high)); power++)
        for (int i = 0; i < 3 && power % skip == 0; i += step) {
            double value = digits[i] * pow(10, power);
            if (value >= axis->low && value <= axis->high)
                draw_tick(area, is_x, value);
        }
}

static void draw_given_ticks(const frame *area, const chart *subject)
{
    for (uint32_t i = 0; i < subject->x_tick_count; i++)
        if (subject->x_ticks[i] >= area->x.low && subject->x_ticks[i] <= area->x.high)
            draw_tick(area, true, subject->x_ticks[i]);
}

static void draw_border(const frame *area, const chart *subject)
{
    const canvas_stroke border = {FAINT, 1, 0};
    const canvas_text title = {INK, 13, true, CANVAS_START, false}, name = {FAINT, FONT, false, CANVAS_MIDDLE, false},
                      side = {FAINT, FONT, false, CANVAS_MIDDLE, true};
    const double corner[3][2] = {{area->x.from, area->y.to}, {area->x.from, area->y.from}, {area->x.to, area->y.from}};
    canvas *on = area->on;
    on->line(on, &border, corner, 3);
    on->text(on, &title, area->x.from, area->y.to - 12, subject->title);
    on->text(on, &name, (area->x.from + area->x.to) / 2, area->y.from + 34, subject->x_name);
    on->text(on, &side, area->x.from - LEFT + 12, (area->y.from + area->y.to) / 2, subject->y_name);
}

/* ---- curves -------------------------------------------------------------------------------- */

static void draw_series(const frame *area, const chart_series *series)
{
    const canvas_stroke stroke = {series->colour, 2, 0};
    double points[CHART_POINTS][2];
    size_t count = 0;
    for (uint32_t i = 0; i < series->count; i++) {
        if (!is_drawn(series->x[i]) || !is_drawn(series->y[i]))
            continue;
        points[count][0] = place_of(&area->x, series->x[i]);
        points[count][1] = place_of(&area->y, series->y[i]);
        area->on->dot(area->on, series->colour, points[count][0], points[count][1], 3.2);
        count++;
    }
    if (count > 1)
        area->on->line(area->on, &stroke, (const double(*)[2])points, count);
}

/* Through the upper right of the curves, as far as it stays within the frame. */
static void draw_slope(const frame *area, const chart *subject)
{
    const canvas_stroke stroke = {INK, 1, 5};
    const canvas_text style = {INK, FONT, false, CANVAS_END, false};
    double x[2] = {area->x.low * 1.02, area->x.high / 1.02}, y[2];
    double middle = sqrt(area->y.low * area->y.high), centre = sqrt(area->x.low * area->x.high);
    for (int i = 0; i < 2; i++) {
        y[i] = middle * pow(x[i] / centre, subject->slope);
        double inside = fmin(fmax(y[i], area->y.low * 1.02), area->y.high / 1.02);
        x[i] *= pow(inside / y[i], 1 / subject->slope);
        y[i] = inside;
    }
    const double line[2][2] = {{place_of(&area->x, x[0]), place_of(&area->y, y[0])},
                               {place_of(&area->x, x[1]), place_of(&area->y, y[1])}};
    area->on->line(area->on, &stroke, line, 2);
    area->on->text(area->on, &style, line[1][0], line[1][1] - 6, subject->slope_name);
}

static void draw_level(const frame *area, const chart *subject)
{
    const canvas_stroke stroke = {FAINT, 1, 2};
    const canvas_text style = {FAINT, FONT, false, CANVAS_START, false};
    if (!(subject->level >= area->y.low))
        return;
    double y = place_of(&area->y, subject->level);
    const double line[2][2] = {{area->x.from, y}, {area->x.to, y}};
    area->on->line(area->on, &stroke, line, 2);
    area->on->text(area->on, &style, area->x.from + 6, y - 4, subject->level_name);
}

static void draw_names(const frame *area, const chart *subject)
{
    double y = area->y.to + 14;
    for (uint32_t s = 0; s < subject->series_count; s++, y += 15) {
        const chart_series *series = &subject->series[s];
        const canvas_text style = {series->colour, FONT, true, CANVAS_START, false};
        area->on->text(area->on, &style, area->x.to + NAMES_GAP, y, series->name);
    }
}

/* What the longest name takes, up to half of the chart. */
static double names_width(const chart *subject)
{
    size_t longest = 0;
    for (uint32_t s = 0; s < subject->series_count; s++) {
        size_t length = strlen(subject->series[s].name);
        longest = length > longest ? length : longest;
    }
    return fmin(NAMES_GAP + LETTER * (double)longest, CHART_WIDTH / 2.0);
}

void chart_draw(canvas *on, const chart *subject, double x, double y)
{
    frame area = {.on = on,
                  .x = {(double)INFINITY, 0, x + LEFT, x + CHART_WIDTH - names_width(subject)},
                  .y = {(double)INFINITY, 0, y + CHART_HEIGHT - BOTTOM, y + TOP}};
    find_ranges(subject, &area);
    if (subject->x_ticks != NULL)
        draw_given_ticks(&area, subject);
    else
        draw_axis(&area, true);
    draw_axis(&area, false);
    draw_border(&area, subject);
    if (is_drawn(subject->level))
        draw_level(&area, subject);
    if (subject->slope != 0)
        draw_slope(&area, subject);
    for (uint32_t s = 0; s < subject->series_count; s++)
        draw_series(&area, &subject->series[s]);
    draw_names(&area, subject);
}
