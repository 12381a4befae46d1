/* SPDX-License-Identifier: MIT
 * gauss.h - Gauss-Legendre quadrature, and polynomials through its points. */
#ifndef HELIOSTAT_SRC_GAUSS_H
#define HELIOSTAT_SRC_GAUSS_H

#include <stdint.h>

enum { GAUSS_LIMIT = 32 };

/* Points in (-1, 1) and weights, which sum to 2: exact for polynomials of degree 2 count - 1. */
typedef struct gauss_rule {
    uint32_t count;
    double points[GAUSS_LIMIT], weights[GAUSS_LIMIT];
} gauss_rule;

/* count: 1..GAUSS_LIMIT */
gauss_rule gauss_make(uint32_t count);

/* The polynomial of least degree that is 1 at one point of the rule and 0 at the others. */
double gauss_basis(const gauss_rule *rule, uint32_t point, double x);

#endif
