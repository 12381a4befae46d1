/* SPDX-License-Identifier: MIT
 *
 * Lat-long maps. Solid angle is d(longitude) d(sin latitude), so in these coordinates pixels are rectangles, and a
 * texel is bounded by its edges, which are great circles (great_circle.h). So every overlap is exact, and what one
 * texel does not get of a pixel its neighbour gets: no light is lost at edges or poles, whatever the sizes.
 *
 * Longitudes are counted in columns of the map, which run against them: a position p stands for the longitude
 * 2 pi (1/2 - p / width). */
#include "core/context.h"
#include "core/vector.h"
#include "env/great_circle.h"
#include "env/overlap.h"

/* Areas below this, in sr, are roundings where nothing overlaps. The least pixel of the largest map is 40 times larger.
 */
static const double LEAST_AREA = 1e-14;

/* ---- the map ---- */

/* Equal steps of latitude; the ends and the middle are exact, so that no light is lost at the poles and no row is
 * touched that lies beyond the equator. */
static void fill_borders(overlap_geometry *geometry)
{
    uint32_t height = geometry->map_height, quarter = geometry->map_width / 4;
    for (uint32_t k = 0; k <= height; k++) {
        geometry->borders[k] = cos(PI * k / height);
        geometry->cosines[k] = sin(PI * k / height);
    }
    geometry->borders[0] = 1.0;
    geometry->borders[height] = -1.0;
    if (height % 2 == 0)
        geometry->borders[height / 2] = 0.0;
    for (uint32_t k = 0; k <= quarter; k++)
        geometry->column_sines[k] = k < quarter ? sin(0.5 * PI * k / quarter) : 1.0;
}

helio_status overlap_latlong_geometry(helio_context *context, uint32_t size, uint32_t width, uint32_t height,
                                      overlap_geometry *geometry)
{
    *geometry = (overlap_geometry){.size = size, .map_width = width, .map_height = height};
    geometry->borders = context_allocate(context, (size_t)height + 1, sizeof *geometry->borders);
    geometry->cosines = context_allocate(context, (size_t)height + 1, sizeof *geometry->cosines);
    geometry->column_sines = context_allocate(context, (size_t)width / 4 + 1, sizeof *geometry->column_sines);
    if (geometry->borders == NULL || geometry->cosines == NULL || geometry->column_sines == NULL)
        return HELIO_ERR_MEMORY;
    fill_borders(geometry);
    return HELIO_OK;
}

/* The row that holds a sine of latitude; the search begins at a row nearby. */
static uint32_t find_row(const overlap_geometry *geometry, double sine, uint32_t row)
{
    while (row > 0 && geometry->borders[row] < sine)
        row--;
    while (row + 1 < geometry->map_height && geometry->borders[row + 1] > sine)
        row++;
    return row;
}

/* ---- overlaps of any outline ---- */

/* A meridian where the outline begins, ends, turns a corner or passes below an axis. */
typedef struct stop {
    double position;
    angle longitude;
} stop;

enum { MAX_STOPS = 10 };

/* Where a texel lies. */
typedef struct texel_outline {
    double highest, lowest; /* sines of latitude */
    stop stops[MAX_STOPS];  /* by position */
    int stop_count;
    const great_circle *upper[MAX_STOPS], *lower[MAX_STOPS]; /* edges from each stop to the next; NULL: the pole */
    uint32_t row;                                            /* of the map, one that is near; follows the texels */
} texel_outline;

/* The part of a texel that is between two meridians in one column of the map. */
typedef struct piece {
    uint32_t column;                    /* from the first one that is looked at */
    double width;                       /* radians */
    double highest, lowest;             /* sines of latitude that it reaches */
    double inner_highest, inner_lowest; /* and between which it has its full width */
    arc upper, lower;
} piece;

typedef struct piece_list {
    int piece_count, point_count;
    piece pieces[OVERLAP_RUN_LIMIT + MAX_STOPS];
    circle_point upper[OVERLAP_RUN_LIMIT + 2 * MAX_STOPS], lower[OVERLAP_RUN_LIMIT + 2 * MAX_STOPS];
} piece_list;

static void add_stop(texel_outline *outline, stop new_stop)
{
    int i = outline->stop_count++;
    for (; i > 0 && outline->stops[i - 1].position > new_stop.position; i--)
        outline->stops[i] = outline->stops[i - 1];
    outline->stops[i] = new_stop;
}

/* Signs do not matter here, see meet_meridian(). */
static stop column_border(const overlap_geometry *geometry, uint32_t column)
{
    uint32_t half = geometry->map_width / 2, quarter = half / 2, place = column;
    while (place >= half)
        place -= half;
    place = place > quarter ? half - place : place;
    return (stop){column, {geometry->column_sines[quarter - place], geometry->column_sines[place]}};
}

static circle_point meet(const great_circle *circle, angle meridian)
{
    return circle != NULL ? meet_meridian(circle, meridian) : (circle_point){.sine = 1.0};
}

/* Adds the points where two edges meet a meridian. */
static void add_points(const great_circle *upper, const great_circle *lower, angle meridian, piece_list *list)
{
    list->upper[list->point_count] = meet(upper, meridian);
    list->lower[list->point_count++] = meet(lower, meridian);
}

/* Adds the piece between the last two points. */
static void add_piece(const great_circle *upper, const great_circle *lower, uint32_t column, double width,
                      piece_list *list)
{
    int i = list->point_count - 2;
    piece *p = &list->pieces[list->piece_count++];
    p->column = column;
    p->width = width;
    p->upper = arc_cut(upper, &list->upper[i], &list->upper[i + 1]);
    p->lower = arc_cut(lower, &list->lower[i], &list->lower[i + 1]);
    p->highest = arc_highest(&p->upper);
    p->inner_highest = arc_lowest(&p->upper);
    p->inner_lowest = arc_highest(&p->lower);
    p->lowest = arc_lowest(&p->lower);
}

/* Cuts what the outline has in the columns first ... end - 1 into pieces. */
static void cut_pieces(const overlap_geometry *geometry, const texel_outline *outline, uint32_t first, uint32_t end,
                       piece_list *list)
{
    double column_width = 2 * PI / geometry->map_width;
    stop from = outline->stops[0].position < first ? column_border(geometry, first) : outline->stops[0];
    list->piece_count = list->point_count = 0;
    for (int s = 0; s + 1 < outline->stop_count && from.position < end; s++) {
        const stop *last = &outline->stops[s + 1];
        if (last->position <= from.position)
            continue;
        add_points(outline->upper[s], outline->lower[s], from.longitude, list);
        while (from.position < end && from.position < last->position) {
            uint32_t column = (uint32_t)from.position;
            stop to = last->position < column + 1.0 ? *last : column_border(geometry, column + 1);
            add_points(outline->upper[s], outline->lower[s], to.longitude, list);
            add_piece(outline->upper[s], outline->lower[s], column - first,
                      (to.position - from.position) * column_width, list);
            from = to;
        }
    }
}

/* Area, sr, of the part of a piece that lies in a row of the map; at least LEAST_AREA where they meet. */
static double area_in_row(const piece *p, const band *row, bool only_count)
{
    double height = lesser(row->top, p->highest) - greater(row->bottom, p->lowest);
    if (height * p->width <= LEAST_AREA)
        return 0.0;
    if (only_count || (row->top <= p->inner_highest && row->bottom >= p->inner_lowest))
        return height * p->width;
    return greater(LEAST_AREA, arc_area_below(&p->upper, row, p->width) - arc_area_below(&p->lower, row, p->width));
}

static void write_rows(const overlap_geometry *geometry, const texel_outline *outline, const piece_list *list,
                       overlap_run begin, uint32_t columns, overlap_writer *writer)
{
    for (uint32_t row = outline->row; geometry->borders[row] > outline->lowest; row++) {
        band b = {geometry->borders[row], geometry->borders[row + 1], geometry->cosines[row],
                  geometry->cosines[row + 1]};
        double areas[OVERLAP_RUN_LIMIT];
        for (uint32_t i = 0; i < columns; i++)
            areas[i] = 0.0;
        for (const piece *p = list->pieces; p < list->pieces + list->piece_count; p++)
            areas[p->column] += area_in_row(p, &b, writer->runs == NULL);
        begin.row = (uint16_t)row;
        overlap_write(writer, begin, areas, columns);
    }
}

/* The place of a column, counted on from 0 across the map's edge. */
static overlap_run begin_run(const overlap_geometry *geometry, uint32_t column)
{
    uint32_t quarter = geometry->map_width / 4;
    return (overlap_run){.column = column % quarter, .quarter = column / quarter % 4};
}

/* The end of the columns that can be taken at once: not too many, and not across a quarter of the map. */
static uint32_t find_end(const overlap_geometry *geometry, uint32_t first, double last)
{
    uint32_t quarter = geometry->map_width / 4, end = (first / quarter + 1) * quarter;
    end = end < last ? end : (uint32_t)ceil(last);
    return end - first > OVERLAP_RUN_LIMIT ? first + OVERLAP_RUN_LIMIT : end;
}

static void write_outline(const overlap_geometry *geometry, texel_outline *outline, overlap_writer *writer)
{
    piece_list list;
    double last = outline->stops[outline->stop_count - 1].position;
    uint32_t first = (uint32_t)outline->stops[0].position;
    uint32_t row = outline->row = find_row(geometry, outline->highest, outline->row);
    if (last <= first + 1.0 && geometry->borders[row + 1] <= outline->lowest) { /* all in one pixel */
        overlap_run begin = begin_run(geometry, first);
        begin.row = (uint16_t)row;
        overlap_write(writer, begin, &(double){1.0}, 1);
        overlap_end_texel(writer);
        return;
    }
    for (uint32_t end; first < last; first = end) {
        end = find_end(geometry, first, last);
        cut_pieces(geometry, outline, first, end, &list);
        write_rows(geometry, outline, &list, begin_run(geometry, first), end - first, writer);
    }
    overlap_end_texel(writer);
}

/* ---- the face +Z: two edges are meridians, the others circles whose highest point is on the face's axis ---- */

static stop side_stop(const overlap_geometry *geometry, double u)
{
    double scale_by = 1.0 / sqrt(1.0 + u * u);
    return (stop){geometry->map_width * (0.5 - atan(u) / (2 * PI)), {scale_by, u * scale_by}};
}

static great_circle side_circle(double v)
{
    double scale_by = 1.0 / sqrt(1.0 + v * v);
    return (great_circle){.height = fabs(v) * scale_by, .depth = scale_by, .south = v > 0};
}

void overlap_side(const void *data, uint32_t row, uint32_t first_column, uint32_t end_column, overlap_writer *writer)
{
    const overlap_geometry *geometry = data;
    double v0 = texel_border(row, geometry->size), v1 = texel_border(row + 1, geometry->size);
    const great_circle upper = side_circle(v0), lower = side_circle(v1);
    texel_outline outline = {.upper = {&upper, &upper}, .lower = {&lower, &lower}};
    stop left = side_stop(geometry, texel_border(first_column, geometry->size));
    for (uint32_t column = first_column; column < end_column; column++) {
        double u0 = texel_border(column, geometry->size), u1 = texel_border(column + 1, geometry->size);
        double nearest = u1 < 0 ? u1 : 0.0, farthest = greater(fabs(u0), fabs(u1));
        double bottom = v1 > 0 ? nearest : farthest;
        stop right = side_stop(geometry, u1);
        outline.highest = -v0 / sqrt(1.0 + nearest * nearest + v0 * v0);
        outline.lowest = -v1 / sqrt(1.0 + bottom * bottom + v1 * v1);
        outline.stop_count = 0;
        add_stop(&outline, right);
        add_stop(&outline, left);
        if (u1 > 0)
            add_stop(&outline, side_stop(geometry, 0.0));
        write_outline(geometry, &outline, writer);
        left = right;
    }
}

/* ---- the face +Y: u is x, v is z, and longitude is atan2(x, z); this quarter's positions start at width / 2 ---- */

typedef struct pole_texel {
    double x[2], z[2];
    great_circle x_edges[2], z_edges[2];
    stop corners[2][2]; /* [x][z]; without meaning at the pole */
} pole_texel;

static great_circle pole_circle(double offset, bool highest_at_x)
{
    double scale_by = 1.0 / sqrt(1.0 + offset * offset);
    return (great_circle){.height = scale_by, .depth = fabs(offset) * scale_by, .highest_at_x = highest_at_x};
}

static stop pole_stop(const overlap_geometry *geometry, double x, double z)
{
    double position = geometry->map_width * (0.5 - atan2(x, z) / (2 * PI)), scale_by = 1.0 / sqrt(x * x + z * z);
    position += position < 0.5 * geometry->map_width ? geometry->map_width : 0;
    return (stop){position, {z * scale_by, x * scale_by}};
}

static bool holds_pole(const pole_texel *texel)
{
    return texel->x[1] > 0 && texel->z[1] > 0;
}

static void add_pole_stops(const overlap_geometry *geometry, const pole_texel *texel, texel_outline *outline)
{
    static const angle axes[5] = {{1, 0}, {0, -1}, {-1, 0}, {0, 1}, {1, 0}}; /* +Z, -X, -Z, +X, +Z */
    outline->stop_count = 0;
    for (int i = 0; i < 4; i++)
        if (texel->x[i / 2] != 0 || texel->z[i % 2] != 0)
            add_stop(outline, texel->corners[i / 2][i % 2]);
    /* At most one corner of the four is the pole itself. */
    /* cppcheck-suppress negativeIndex */
    double first = outline->stops[0].position, last = outline->stops[outline->stop_count - 1].position;
    for (uint32_t i = 0; i < 5; i++) {
        double position = (2.0 + i) * 0.25 * geometry->map_width;
        if (holds_pole(texel) || (position > first && position < last))
            add_stop(outline, (stop){position, axes[i]});
    }
}

/* The edges where rays from the pole enter and leave the texel between two stops. */
static void find_edges(const pole_texel *texel, texel_outline *outline, int s)
{
    angle from = outline->stops[s].longitude, to = outline->stops[s + 1].longitude;
    double x = from.sine + to.sine, z = from.cosine + to.cosine;
    int x_near = x < 0, z_near = z < 0;
    double enter_x = texel->x[x_near] / x, enter_z = texel->z[z_near] / z;
    double leave_x = texel->x[!x_near] / x, leave_z = texel->z[!z_near] / z;
    bool starts_inside = !(enter_x > 0 || enter_z > 0);
    outline->upper[s] = starts_inside ? NULL : enter_x > enter_z ? &texel->x_edges[x_near] : &texel->z_edges[z_near];
    outline->lower[s] = leave_x < leave_z ? &texel->x_edges[!x_near] : &texel->z_edges[!z_near];
}

static void write_pole_texel(const overlap_geometry *geometry, const pole_texel *texel, texel_outline *outline,
                             overlap_writer *writer)
{
    double x = lesser(0.0, texel->x[1]), z = lesser(0.0, texel->z[1]); /* nearest to the pole; the farthest is [0][0] */
    outline->highest = 1.0 / sqrt(1.0 + x * x + z * z);
    outline->lowest = 1.0 / sqrt(1.0 + texel->x[0] * texel->x[0] + texel->z[0] * texel->z[0]);
    add_pole_stops(geometry, texel, outline);
    for (int s = 0; s + 1 < outline->stop_count; s++)
        find_edges(texel, outline, s);
    write_outline(geometry, outline, writer);
}

void overlap_pole(const void *data, uint32_t row, uint32_t first_column, uint32_t end_column, overlap_writer *writer)
{
    const overlap_geometry *geometry = data;
    texel_outline outline = {0};
    pole_texel texel = {.z = {texel_border(row, geometry->size), texel_border(row + 1, geometry->size)}};
    for (int i = 0; i < 2; i++)
        texel.z_edges[i] = pole_circle(texel.z[i], false);
    for (uint32_t border = first_column; border <= end_column; border++) {
        texel.x[0] = texel.x[1];
        texel.x_edges[0] = texel.x_edges[1];
        texel.x[1] = texel_border(border, geometry->size);
        texel.x_edges[1] = pole_circle(texel.x[1], true);
        for (int i = 0; i < 2; i++) {
            texel.corners[0][i] = texel.corners[1][i];
            texel.corners[1][i] = pole_stop(geometry, texel.x[1], texel.z[i]);
        }
        if (border > first_column)
            write_pole_texel(geometry, &texel, &outline, writer);
    }
}
