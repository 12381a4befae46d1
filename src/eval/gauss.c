/* SPDX-License-Identifier: MIT */
#include "eval/gauss.h"

#include "core/vector.h"

/* Legendre's polynomial of this degree and its derivative at x, |x| < 1. */
static double legendre(uint32_t degree, double x, double *derivative)
{
    double before = 1.0, value = x;
    for (uint32_t k = 2; k <= degree; k++) {
        double next = ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k;
        before = value;
        value = next;
    }
    *derivative = degree * (x * value - before) / (x * x - 1.0);
    return value;
}

gauss_rule gauss_make(uint32_t count)
{
    gauss_rule rule = {.count = count};
    for (uint32_t i = 0; i < count; i++) {
        double x = -cos(PI * (i + 0.75) / (count + 0.5)), derivative = 1.0;
        for (int step = 0; step < 8; step++) /* Newton's method, from a few digits */
            x -= legendre(count, x, &derivative) / derivative;
        rule.points[i] = x;
        rule.weights[i] = 2.0 / ((1.0 - x * x) * derivative * derivative);
    }
    return rule;
}

double gauss_basis(const gauss_rule *rule, uint32_t point, double x)
{
    double value = 1.0;
    for (uint32_t i = 0; i < rule->count; i++)
        if (i != point)
            value *= (x - rule->points[i]) / (rule->points[point] - rule->points[i]);
    return value;
}
