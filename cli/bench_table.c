/* SPDX-License-Identifier: MIT */
#include "bench_result.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LABEL_WIDTH = 34, BAR_WIDTH = 20 };

/* Four digits, whatever the size. */
static void format_figure(double value, char text[16])
{
    int digits = value >= 1000 ? 0 : value >= 100 ? 1 : value >= 10 ? 2 : 3;
    snprintf(text, 16, "%.*f", digits, fmin(value, 1e12));
}

static void format_bar(double part, char bar[BAR_WIDTH + 1])
{
    size_t length = (size_t)(fmin(fmax(part, 0), 1) * BAR_WIDTH + 0.5);
    memset(bar, '#', length);
    bar[length] = 0;
}

static void print_line(const bench_result *result, double longest)
{
    char median[16], low[16], high[16], spread[40], bar[BAR_WIDTH + 1];
    format_figure(result->value.median, median);
    format_figure(result->value.low, low);
    format_figure(result->value.high, high);
    snprintf(spread, sizeof spread, "%s .. %s", low, high);
    format_bar(longest > 0 ? result->value.median / longest : 0, bar);
    printf("  %-*s %8s %-11s %-18s  %-*s  %s\n", LABEL_WIDTH, result->label, median, result->unit, spread, BAR_WIDTH,
           bar, result->note);
}

void bench_table_print(const char *title, const bench_result *results, size_t count)
{
    double longest = 0;
    for (size_t i = 0; i < count; i++)
        longest = fmax(longest, results[i].value.median);
    printf("\n%s\n", title);
    for (size_t i = 0; i < count; i++)
        print_line(&results[i], longest);
    fflush(stdout);
}
