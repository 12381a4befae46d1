/* SPDX-License-Identifier: MIT
 *
 * Lat-long maps. Solid angle is d(longitude) d(sin latitude), so in these coordinates pixels are rectangles, and a
 * texel is bounded by its edges, which are great circles:
 *
 *   sin(latitude) = k cos t / sqrt(1 - k^2 sin^2 t),   with integral   asin(k sin t),
 *
 * t the longitude from the circle's highest point, k the sine of its latitude there. Where the circle crosses a border
 * between rows follows from the same formula. So every overlap is exact, and what one texel does not get of a pixel its
 * neighbour gets: no light is lost at edges or poles, whatever the sizes. */
#include "core/vector.h"
#include "env/cube.h"
#include "env/overlap.h"

/* Areas below this, in sr, are roundings where nothing overlaps. The least pixel of the largest map is 40 times larger.
 */
static const double LEAST_AREA = 1e-14;

/* Where a texel lies: its longitudes, sines of latitudes, and the longitudes where its edges meet or turn. */
typedef struct texel_outline {
    double from, to, highest, lowest;
    double stops[10]; /* sorted, the first is from, the last is to */
    int stop_count;
    double u0, u1, v0, v1; /* face coordinates; on the pole face u is x and v is z */
} texel_outline;

/* ---- great circles ---- */

typedef struct great_circle {
    double k;         /* sine of the greatest latitude, >= 0 */
    double longitude; /* where that is */
    double sign;      /* -1: the circle's southern half */
} great_circle;

/* A piece of a circle's half on one side of its highest point, from angle near to far: latitude falls from high to low.
 */
typedef struct circle_piece {
    double k, sign, near, far;
    double high, low;                   /* sin(latitude) at near and far */
    double near_integral, far_integral; /* of sin(latitude) */
} circle_piece;

static double circle_height(double k, double angle)
{
    double cosine = cos(angle);
    return k * cosine / sqrt((1.0 - k * k) + k * k * cosine * cosine);
}

static double circle_integral(double k, double angle)
{
    return asin(fmin(1.0, k * sin(angle)));
}

/* The angle at which the circle comes down to this height, 0 < height < k. */
static double circle_angle(double k, double height)
{
    double squared = height * height * (1.0 - k * k) / (k * k * (1.0 - height * height));
    return acos(sqrt(fmin(1.0, squared)));
}

static circle_piece cut_circle(const great_circle *circle, double from, double to)
{
    double a = fabs(from - circle->longitude), b = fabs(to - circle->longitude);
    circle_piece piece = {.k = circle->k, .sign = circle->sign, .near = fmin(a, b), .far = fmax(a, b)};
    piece.high = circle_height(piece.k, piece.near);
    piece.low = circle_height(piece.k, piece.far);
    piece.near_integral = circle_integral(piece.k, piece.near);
    piece.far_integral = circle_integral(piece.k, piece.far);
    return piece;
}

/* Area below a northern piece inside of the band of sines bottom ... top. */
static double northern_area(const circle_piece *piece, double bottom, double top)
{
    if (piece->low >= top)
        return (top - bottom) * (piece->far - piece->near);
    if (piece->high <= bottom)
        return 0.0;
    double enter = piece->near, leave = piece->far; /* of the band */
    double enter_integral = piece->near_integral, leave_integral = piece->far_integral;
    if (piece->high > top) {
        enter = fmin(fmax(circle_angle(piece->k, top), piece->near), piece->far);
        enter_integral = circle_integral(piece->k, enter);
    }
    if (piece->low < bottom) {
        leave = fmin(fmax(circle_angle(piece->k, bottom), enter), piece->far);
        leave_integral = circle_integral(piece->k, leave);
    }
    return (top - bottom) * (enter - piece->near) + (leave_integral - enter_integral) - bottom * (leave - enter);
}

/* The southern half is the northern one upside down. */
static double area_below(const circle_piece *piece, double bottom, double top)
{
    if (piece->sign > 0)
        return northern_area(piece, bottom, top);
    return (top - bottom) * (piece->far - piece->near) - northern_area(piece, -top, -bottom);
}

/* ---- overlaps of any outline ---- */

typedef void (*bounding_circles)(const texel_outline *outline, double longitude, great_circle *upper,
                                 great_circle *lower);

/* Row of the map that holds a sine of latitude. */
static uint32_t find_row(const overlap_geometry *geometry, double sine)
{
    double position = acos(fmin(1.0, fmax(-1.0, sine))) / PI * geometry->map_height;
    uint32_t row = position < geometry->map_height ? (uint32_t)position : geometry->map_height - 1;
    while (row > 0 && geometry->borders[row] < sine)
        row--;
    while (row + 1 < geometry->map_height && geometry->borders[row + 1] > sine)
        row++;
    return row;
}

/* Column borders run against the longitude: column c spans longitudes from longitude_of(c + 1) up to longitude_of(c).
 */
static double longitude_of(const overlap_geometry *geometry, double column)
{
    return (0.5 - column / geometry->map_width) * 2 * PI;
}

static void find_columns(const overlap_geometry *geometry, const texel_outline *outline, int64_t *first, int64_t *last)
{
    *first = (int64_t)floor((0.5 - outline->to / (2 * PI)) * geometry->map_width);
    *last = (int64_t)floor((0.5 - outline->from / (2 * PI)) * geometry->map_width);
}

static size_t outline_bound(const overlap_geometry *geometry, const texel_outline *outline)
{
    int64_t first, last;
    find_columns(geometry, outline, &first, &last);
    uint32_t top = find_row(geometry, outline->highest), bottom = find_row(geometry, outline->lowest);
    return (size_t)(last - first + 1) * (bottom - top + 1);
}

/* Adds the areas of a piece of the outline, between two stops, to the rows top ... top + rows - 1 of one column. */
static void add_piece(const overlap_geometry *geometry, const great_circle *upper, const great_circle *lower,
                      double from, double to, uint32_t top, uint32_t rows, overlap *column)
{
    circle_piece above = cut_circle(upper, from, to), below = cut_circle(lower, from, to);
    for (uint32_t i = 0; i < rows; i++) {
        double high = geometry->borders[top + i], low = geometry->borders[top + i + 1];
        column[i].weight += (float)fmax(0.0, area_below(&above, low, high) - area_below(&below, low, high));
    }
}

/* Turns areas into shares of the texel and leaves out what does not overlap. */
static uint32_t compact(overlap *column, uint32_t rows, double solid_angle)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < rows; i++) {
        double area = (double)column[i].weight;
        if (area < LEAST_AREA)
            continue;
        column[kept] = column[i];
        column[kept++].weight = (float)(area / solid_angle);
    }
    return kept;
}

static uint32_t fill_outline(const overlap_geometry *geometry, const texel_outline *outline, bounding_circles circles,
                             overlap *overlaps)
{
    int64_t first, last, width = geometry->map_width;
    uint32_t top = find_row(geometry, outline->highest), rows = find_row(geometry, outline->lowest) - top + 1;
    double solid_angle = cube_solid_angle(outline->u0, outline->u1, outline->v0, outline->v1);
    uint32_t count = 0;
    find_columns(geometry, outline, &first, &last);
    for (int64_t c = first; c <= last; c++) {
        overlap *column = overlaps + count;
        for (uint32_t i = 0; i < rows; i++)
            column[i] = (overlap){top + i, (uint32_t)((c + width) % width), 0.0f};
        for (int s = 0; s + 1 < outline->stop_count; s++) {
            double from = fmax(outline->stops[s], longitude_of(geometry, (double)(c + 1)));
            double to = fmin(outline->stops[s + 1], longitude_of(geometry, (double)c));
            if (!(from < to))
                continue;
            great_circle upper, lower;
            circles(outline, 0.5 * (from + to), &upper, &lower);
            add_piece(geometry, &upper, &lower, from, to, top, rows, column);
        }
        count += compact(column, rows, solid_angle);
    }
    return count;
}

static void add_stop(texel_outline *outline, double longitude)
{
    if (!(longitude > outline->from && longitude < outline->to))
        return;
    int i = outline->stop_count++;
    for (; i > 0 && outline->stops[i - 1] > longitude; i--)
        outline->stops[i] = outline->stops[i - 1];
    outline->stops[i] = longitude;
}

static void set_range(texel_outline *outline, double from, double to)
{
    outline->from = from;
    outline->to = to;
    outline->stops[0] = from;
    outline->stops[1] = to;
    outline->stop_count = 2;
}

static texel_outline outline_texel(const overlap_geometry *geometry, uint32_t row, uint32_t column)
{
    return (texel_outline){
        .u0 = texel_border(column, geometry->size),
        .u1 = texel_border(column + 1, geometry->size),
        .v0 = texel_border(row, geometry->size),
        .v1 = texel_border(row + 1, geometry->size),
    };
}

/* ---- the face +Z: two edges are meridians, the others circles whose highest point is on the face's axis ---- */

static texel_outline outline_side(const overlap_geometry *geometry, uint32_t row, uint32_t column)
{
    texel_outline outline = outline_texel(geometry, row, column);
    double nearest = outline.u0 > 0 ? outline.u0 : outline.u1 < 0 ? -outline.u1 : 0.0;
    double farthest = fmax(fabs(outline.u0), fabs(outline.u1));
    double top = outline.v0 < 0 ? nearest : farthest, bottom = outline.v1 > 0 ? nearest : farthest;
    outline.highest = -outline.v0 / sqrt(1.0 + top * top + outline.v0 * outline.v0);
    outline.lowest = -outline.v1 / sqrt(1.0 + bottom * bottom + outline.v1 * outline.v1);
    set_range(&outline, atan(outline.u0), atan(outline.u1));
    add_stop(&outline, 0.0);
    return outline;
}

static great_circle side_circle(double v)
{
    return (great_circle){fabs(v) / sqrt(1.0 + v * v), 0.0, v < 0 ? 1.0 : -1.0};
}

static void side_circles(const texel_outline *outline, double longitude, great_circle *upper, great_circle *lower)
{
    (void)longitude;
    *upper = side_circle(outline->v0);
    *lower = side_circle(outline->v1);
}

size_t overlap_side_bound(const overlap_geometry *geometry, uint32_t row, uint32_t column)
{
    texel_outline outline = outline_side(geometry, row, column);
    return outline_bound(geometry, &outline);
}

uint32_t overlap_side(const overlap_geometry *geometry, uint32_t row, uint32_t column, overlap *overlaps)
{
    texel_outline outline = outline_side(geometry, row, column);
    return fill_outline(geometry, &outline, side_circles, overlaps);
}

/* ---- the face +Y: u is x, v is z, and longitude is atan2(x, z) ---- */

/* Longitude of a point, as near as can be to another. */
static double longitude_near(double x, double z, double reference)
{
    double longitude = atan2(x, z);
    return longitude - 2 * PI * round((longitude - reference) / (2 * PI));
}

static bool holds_pole(const texel_outline *o)
{
    return o->u0 < 0 && o->u1 > 0 && o->v0 < 0 && o->v1 > 0;
}

/* Longitudes from corner to corner; a corner that is the pole itself has none. */
static void set_pole_range(texel_outline *o, const double corners[4][2])
{
    if (holds_pole(o)) {
        set_range(o, -PI, PI);
        return;
    }
    double middle = atan2(o->u0 + o->u1, o->v0 + o->v1), from = middle, to = middle;
    for (int i = 0; i < 4; i++) {
        if (corners[i][0] == 0 && corners[i][1] == 0)
            continue;
        double longitude = longitude_near(corners[i][0], corners[i][1], middle);
        from = fmin(from, longitude);
        to = fmax(to, longitude);
    }
    set_range(o, from, to);
}

static texel_outline outline_pole(const overlap_geometry *geometry, uint32_t row, uint32_t column)
{
    texel_outline o = outline_texel(geometry, row, column);
    const double corners[4][2] = {{o.u0, o.v0}, {o.u0, o.v1}, {o.u1, o.v0}, {o.u1, o.v1}};
    set_pole_range(&o, corners);
    double middle = 0.5 * (o.from + o.to), farthest = 0;
    for (int i = 0; i < 4; i++) {
        add_stop(&o, longitude_near(corners[i][0], corners[i][1], middle));
        add_stop(&o, longitude_near(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, middle));
        farthest = fmax(farthest, corners[i][0] * corners[i][0] + corners[i][1] * corners[i][1]);
    }
    double x = fmin(fmax(0.0, o.u0), o.u1), z = fmin(fmax(0.0, o.v0), o.v1);
    o.highest = 1.0 / sqrt(1.0 + x * x + z * z);
    o.lowest = 1.0 / sqrt(1.0 + farthest);
    return o;
}

/* The circle of an edge x = offset (across_z false) or z = offset (true). */
static great_circle pole_circle(double offset, bool across_z)
{
    double quarter = across_z ? 0.0 : 0.5 * PI;
    return (great_circle){1.0 / sqrt(1.0 + offset * offset), offset < 0 ? quarter - PI : quarter, 1.0};
}

/* Moves the circle's highest point by whole turns, next to the longitude that is asked about. */
static great_circle turn_near(great_circle circle, double longitude)
{
    circle.longitude -= 2 * PI * round((circle.longitude - longitude) / (2 * PI));
    return circle;
}

/* Where a ray from the pole enters and leaves the rectangle: the edges there. */
static void pole_circles(const texel_outline *o, double longitude, great_circle *upper, great_circle *lower)
{
    double x = sin(longitude), z = cos(longitude);
    double x_near = x > 0 ? o->u0 : o->u1, x_far = x > 0 ? o->u1 : o->u0;
    double z_near = z > 0 ? o->v0 : o->v1, z_far = z > 0 ? o->v1 : o->v0;
    double enter_x = x_near / x, enter_z = z_near / z, leave_x = x_far / x, leave_z = z_far / z;
    great_circle inner = enter_x > enter_z ? pole_circle(x_near, false) : pole_circle(z_near, true);
    if (!(fmax(enter_x, enter_z) >
          0)) /* the ray starts inside: the pole, a circle of height 1 on either side of its top */
        inner = (great_circle){1.0, longitude - 0.25 * PI, 1.0};
    *upper = turn_near(inner, longitude);
    *lower = turn_near(leave_x < leave_z ? pole_circle(x_far, false) : pole_circle(z_far, true), longitude);
}

size_t overlap_pole_bound(const overlap_geometry *geometry, uint32_t row, uint32_t column)
{
    texel_outline outline = outline_pole(geometry, row, column);
    return outline_bound(geometry, &outline);
}

uint32_t overlap_pole(const overlap_geometry *geometry, uint32_t row, uint32_t column, overlap *overlaps)
{
    texel_outline outline = outline_pole(geometry, row, column);
    return fill_outline(geometry, &outline, pole_circles, overlaps);
}
