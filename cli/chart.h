/* SPDX-License-Identifier: MIT
 * chart.h - curves over two logarithmic axes. */
#ifndef HELIOSTAT_CLI_CHART_H
#define HELIOSTAT_CLI_CHART_H

#include "canvas.h"

enum { CHART_SERIES = 16, CHART_POINTS = 16, CHART_WIDTH = 520, CHART_HEIGHT = 340 };

typedef struct chart_series {
    const char *name;
    uint32_t colour;
    uint32_t count;
    double x[CHART_POINTS], y[CHART_POINTS]; /* only what is finite and above 0 is drawn */
} chart_series;

typedef struct chart {
    const char *title, *x_name, *y_name;
    chart_series series[CHART_SERIES];
    uint32_t series_count;
    const uint32_t *x_ticks; /* [x_tick_count]: where x has lines and numbers; NULL: round numbers */
    uint32_t x_tick_count;
    double slope; /* of a dashed line that is drawn beside the curves; 0: none */
    const char *slope_name;
    double level; /* of a dotted line; 0: none */
    const char *level_name;
} chart;

/* Draws it with its upper left corner at x, y, CHART_WIDTH wide and CHART_HEIGHT high. */
void chart_draw(canvas *on, const chart *subject, double x, double y);

#endif
