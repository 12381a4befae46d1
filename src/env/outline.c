/* SPDX-License-Identifier: MIT */
#include "env/outline.h"

#include <math.h>

/* An edge is halved at most so often. */
enum { OUTLINE_DEPTH = 6 };
_Static_assert(OUTLINE_EDGE_POINTS == 1 << OUTLINE_DEPTH, "each halving doubles the arcs");

/* Of the piece's own area, for the triangle of three neighbouring points: what is between an arc and its chord is
 * smaller than MOST before it is taken for a parabola, and of no interest below LEAST. */
static const double MOST = 1e-3, LEAST = 1e-7;

static const direction RIM = {0, 0, 1};

/* A line across the map, or down. */
typedef struct map_line {
    const projection *map;
    bool across;
    double fixed; /* the other coordinate */
    double reach; /* half the length of the line inside of a disc; 0 where they do not meet */
    double area;  /* of the piece, sr */
} map_line;

static direction find_point(const map_line *line, double at)
{
    if (line->map->is_disc && !(fabs(at) < line->reach))
        return RIM;
    return line->across ? line->map->find(at, line->fixed) : line->map->find(line->fixed, at);
}

static double find_density(const map_line *line, double at)
{
    return line->across ? line->map->density(at, line->fixed) : line->map->density(line->fixed, at);
}

/* On discs the middle of the angle whose sine is at / reach: in even steps of it the curve runs evenly into the rim,
 * also that of a mirror ball, whose last pixels reach far around the ball. */
static double find_middle(const map_line *line, double a, double b)
{
    if (!line->map->is_disc)
        return 0.5 * (a + b);
    double sines = a / line->reach + b / line->reach;
    double cosines = sqrt(fmax(0.0, 1.0 - a / line->reach * (a / line->reach))) +
                     sqrt(fmax(0.0, 1.0 - b / line->reach * (b / line->reach)));
    return line->reach * sines / sqrt(sines * sines + cosines * cosines);
}

/* About the area between the curve and the chord, the same for a and c exchanged, to the last bit. */
static double triangle_area(direction a, direction b, direction c)
{
    return 0.5 * fabs(b.x * (a.y * c.z - a.z * c.y) + b.y * (a.z * c.x - a.x * c.z) + b.z * (a.x * c.y - a.y * c.x));
}

/* The point that makes the triangle as large as what is between the chord and the parabola through all three: by 4/3.
 * So pieces get their area with few points. */
static direction lift(direction a, direction middle, direction b)
{
    return (direction){middle.x + (middle.x - 0.5 * (a.x + b.x)) / 3.0, middle.y + (middle.y - 0.5 * (a.y + b.y)) / 3.0,
                       middle.z + (middle.z - 0.5 * (a.z + b.z)) / 3.0};
}

/* Adds the points between a and b. */
static void bend(const map_line *line, double a, direction at_a, double b, direction at_b, int depth, outline *result)
{
    double middle = find_middle(line, a, b);
    direction at_middle = find_point(line, middle);
    double area = triangle_area(at_a, at_middle, at_b);
    if (area > MOST * line->area && depth + 1 < OUTLINE_DEPTH) {
        bend(line, a, at_a, middle, at_middle, depth + 1, result);
        result->points[result->count++] = at_middle;
        bend(line, middle, at_middle, b, at_b, depth + 1, result);
    } else if (area > LEAST * line->area) {
        result->points[result->count++] = lift(at_a, at_middle, at_b);
    }
}

/* Adds the points from a on, without the one at b. */
static void trace_edge(const projection *map, bool across, double fixed, double a, double b, outline *result)
{
    map_line line = {.map = map, .across = across, .fixed = fixed};
    double width = fabs(b - a);
    if (map->is_disc) {
        line.reach = fixed * fixed < 1.0 ? sqrt(1.0 - fixed * fixed) : 0.0;
        a = fmax(-line.reach, fmin(a, line.reach));
        b = fmax(-line.reach, fmin(b, line.reach));
    }
    direction at_a = find_point(&line, a);
    result->points[result->count++] = at_a;
    if (a == b)
        return;
    line.area = find_density(&line, 0.5 * (a + b)) * width * width;
    bend(&line, a, at_a, b, find_point(&line, b), 0, result);
}

static double nearest_to_zero(const double range[2])
{
    return range[0] > 0.0 ? range[0] : range[1] < 0.0 ? range[1] : 0.0;
}

void outline_trace(const projection *map, const double right[2], const double down[2], outline *result)
{
    result->count = 0;
    double x = nearest_to_zero(right), y = nearest_to_zero(down);
    if (map->is_disc && x * x + y * y >= 1.0)
        return;
    trace_edge(map, true, down[0], right[0], right[1], result);
    trace_edge(map, false, right[1], down[0], down[1], result);
    trace_edge(map, true, down[1], right[1], right[0], result);
    trace_edge(map, false, right[0], down[1], down[0], result);
}
