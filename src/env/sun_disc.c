/* SPDX-License-Identifier: MIT
 *
 * On a face the disc is an ellipse, nearly, in the plane of face coordinates. It is cut along the texels' borders into
 * strips, and these into chords. Places within are counted as angles t, v = middle - half cos t, so that the integrand
 * is smooth up to the rim, and four points of Gauss and Legendre serve for each piece. */
#include "env/sun_disc.h"

#include "env/cube.h"

#include <string.h>

enum { NODES = 4 };

static const double node_places[NODES] = {-0.86113631159405257522, -0.33998104358485626480, 0.33998104358485626480,
                                          0.86113631159405257522};
static const double node_weights[NODES] = {0.34785484513745385737, 0.65214515486254614263, 0.65214515486254614263,
                                           0.34785484513745385737};

/* Effective wavelengths of the channels: 610, 550 and 465 nm. */
static const double darkening[3] = {-0.023 + 0.292 / 0.610, -0.023 + 0.292 / 0.550, -0.023 + 0.292 / 0.465};

static const double RADIUS = 959.63 / 3600.0 * PI / 180.0; /* at 1 AU */

/* A range of face coordinates of which only the part inside of the face is looked at. */
typedef struct span {
    double middle, half;
} span;

/* The disc before one face. */
typedef struct face_disc {
    double axis, right, down; /* the sun in the face's axes */
    double sine2;             /* square of the sine of the disc's radius */
    double up[3];             /* zenith in the face's axes */
    uint32_t size, face;
    span columns, rows; /* where the disc is, in u and v */
    uint32_t first_row, end_row, first_column, end_column;
} face_disc;

/* ---- geometry ---- */

/* The extent of the disc along one coordinate; across is the sun's component along it. */
static span find_extent(double axis, double across, double sine2)
{
    double scale_by = 1.0 / (axis * axis - sine2);
    return (span){axis * across * scale_by, sqrt(sine2 * (axis * axis + across * across - sine2)) * scale_by};
}

/* The chord of the disc at a v inside of it. From cos^2(radius) |p|^2 = (p . sun)^2 with p = axis + u right + v down.
 */
static span find_chord(const face_disc *f, double v)
{
    double k = f->axis + v * f->down, cosine2 = 1.0 - f->sine2;
    double a = cosine2 - f->right * f->right, root = k * k - a * (1.0 + v * v);
    return (span){k * f->right / a, root > 0.0 ? sqrt(cosine2 * root) / a : 0.0};
}

/* The angle t of a place in a span; places outside are at its ends. */
static double angle_in(const span *s, double place)
{
    double x = (s->middle - place) / s->half;
    return x >= 1.0 ? 0.0 : x <= -1.0 ? PI : acos(x);
}

static uint32_t texel_of(double place, uint32_t size)
{
    double position = floor((place + 1.0) * 0.5 * size);
    return position <= 0.0 ? 0 : position >= size ? size - 1 : (uint32_t)position;
}

static double border(uint32_t index, uint32_t size)
{
    return 2.0 * index / size - 1.0;
}

/* false where the disc does not touch the face. */
static bool find_face(const double sun[3], double sine2, uint32_t size, uint32_t face, face_disc *f)
{
    const cube_face *c = &cube_faces[face];
    const vec3 axes[3] = {c->axis, c->right, c->down};
    double parts[3];
    *f = (face_disc){.sine2 = sine2, .size = size, .face = face};
    for (int i = 0; i < 3; i++) {
        parts[i] = sun[0] * (double)axes[i].x + sun[1] * (double)axes[i].y + sun[2] * (double)axes[i].z;
        f->up[i] = (double)axes[i].y;
    }
    f->axis = parts[0];
    f->right = parts[1];
    f->down = parts[2];
    if (f->axis < 0.5) /* points of a face are at most 54.7 degrees from its centre */
        return false;
    f->columns = find_extent(f->axis, f->right, sine2);
    f->rows = find_extent(f->axis, f->down, sine2);
    if (fabs(f->columns.middle) - f->columns.half >= 1.0 || fabs(f->rows.middle) - f->rows.half >= 1.0)
        return false;
    f->first_row = texel_of(f->rows.middle - f->rows.half, size);
    f->end_row = texel_of(f->rows.middle + f->rows.half, size) + 1;
    f->first_column = texel_of(f->columns.middle - f->columns.half, size);
    f->end_column = texel_of(f->columns.middle + f->columns.half, size) + 1;
    return true;
}

/* ---- integrals ---- */

/* What sums are added to. */
typedef struct disc_sums {
    sun_share *row; /* of the face's row, from its first column; NULL below the horizon */
    double total[3];
    double horizontal[3];
} disc_sums;

/* Adds the light of a point that stands for an area of the plane. */
static void add_point(const face_disc *f, double u, double v, double area, sun_share *share, disc_sums *sums)
{
    double square = 1.0 + u * u + v * v, along = f->axis + u * f->right + v * f->down;
    double mu2 = 1.0 - (1.0 - along * along / square) / f->sine2;
    double solid_angle = area / (square * sqrt(square)), log_mu = 0.5 * log(mu2 > 1e-12 ? mu2 : 1e-12);
    double up = (f->up[0] + u * f->up[1] + v * f->up[2]) / sqrt(square);
    for (int i = 0; i < 3; i++) {
        double light = solid_angle * exp(darkening[i] * log_mu);
        sums->total[i] += light;
        if (share == NULL)
            continue;
        share->part[i] += light;
        sums->horizontal[i] += light * up;
    }
}

/* Adds a chord of the disc, texel by texel. width: of the strip that it stands for. */
static void add_chord(const face_disc *f, double v, double width, disc_sums *sums)
{
    span chord = find_chord(f, v);
    if (!(chord.half > 0.0))
        return;
    double begin = angle_in(&chord, -1.0);
    for (uint32_t column = f->first_column; column < f->end_column; column++) {
        double end = angle_in(&chord, border(column + 1, f->size));
        sun_share *share = sums->row != NULL ? sums->row + (column - f->first_column) : NULL;
        double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
        for (int i = 0; i < NODES && half > 0.0; i++) {
            double t = middle + half * node_places[i];
            double area = node_weights[i] * half * chord.half * sin(t) * width;
            add_point(f, chord.middle - chord.half * cos(t), v, area, share, sums);
        }
        begin = end;
    }
}

/* Adds the part of the disc between two angles of rows, in pieces of at most an eighth of a half turn. */
static void add_strip(const face_disc *f, double begin, double end, disc_sums *sums)
{
    if (!(end > begin))
        return;
    int pieces = (int)ceil((end - begin) * 8.0 / PI);
    double half = 0.5 * (end - begin) / pieces;
    for (int piece = 0; piece < pieces; piece++) {
        double middle = begin + (2 * piece + 1) * half;
        for (int i = 0; i < NODES; i++) {
            double t = middle + half * node_places[i];
            double width = node_weights[i] * half * f->rows.half * sin(t);
            add_chord(f, f->rows.middle - f->rows.half * cos(t), width, sums);
        }
    }
}

/* The horizon is the middle of the side faces. */
static void add_row(const face_disc *f, uint32_t row, sun_share *shares, disc_sums *sums)
{
    bool is_side = f->up[0] == 0.0;
    double begin = angle_in(&f->rows, border(row, f->size)), end = angle_in(&f->rows, border(row + 1, f->size));
    double horizon = is_side ? angle_in(&f->rows, 0.0) : f->up[0] > 0.0 ? PI : 0.0;
    horizon = horizon < begin ? begin : horizon > end ? end : horizon;
    sums->row = shares;
    add_strip(f, begin, horizon, sums);
    sums->row = NULL;
    add_strip(f, horizon, end, sums);
}

size_t sun_disc_share_limit(uint32_t size)
{
    /* Towards the corners a face coordinate grows up to three times as fast as the angle. Where the disc meets several
     * faces, it has a part on each. */
    size_t edge = (size_t)ceil(3.1 * RADIUS / SUN_NEAREST * size) + 3;
    edge = edge < size ? edge : size;
    return CUBE_FACES / 2 * edge * edge;
}

void sun_disc_find(const double sun[3], double distance, uint32_t size, sun_disc *disc)
{
    double sine = sin(RADIUS / distance);
    disc_sums sums = {0};
    disc->share_count = 0;
    for (uint32_t face = 0; face < CUBE_FACES; face++) {
        face_disc f;
        if (!find_face(sun, sine * sine, size, face, &f))
            continue;
        for (uint32_t row = f.first_row; row < f.end_row; row++) {
            sun_share *shares = disc->shares + disc->share_count;
            for (uint32_t column = f.first_column; column < f.end_column; column++)
                disc->shares[disc->share_count++] = (sun_share){.face = face, .row = row, .column = column};
            add_row(&f, row, shares, &sums);
        }
    }
    for (int i = 0; i < 3; i++)
        disc->horizontal[i] = sums.horizontal[i] / sums.total[i];
    for (size_t s = 0; s < disc->share_count; s++)
        for (int i = 0; i < 3; i++)
            disc->shares[s].part[i] /= sums.total[i];
}
