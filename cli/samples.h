/* SPDX-License-Identifier: MIT
 * samples.h - the light samples of one pixel, what becomes of each, and how that is told. */
#ifndef HELIOSTAT_CLI_SAMPLES_H
#define HELIOSTAT_CLI_SAMPLES_H

#include "frame_label.h"
#include "render_job.h"
#include "shown_picture.h"

/* As in helio_counts: those of the light come first, then that of the surface. */
enum { TECHNIQUES = 7, SURFACE_TECHNIQUE = 6 };

typedef enum sample_fate {
    SAMPLE_USED = 0, /* its light is part of the pixel */
    SAMPLE_SHADOWED, /* it would be, if nothing were in the way */
    SAMPLE_BELOW,    /* below the point's horizon, or that of the flat surface */
    SAMPLE_DARK,     /* above it, but there is no light, or the surface reflects none of it */
    SAMPLE_FATES
} sample_fate;

/* One word for each, as JSON has it; the last two are called useless together. */
const char *sample_fate_name(sample_fate fate);

typedef struct point_sample {
    float direction[3];          /* in the map's space */
    float world_direction[3];    /* in that of the scene */
    uint32_t face, row, column;  /* the texel of the cube there */
    double contribution[3];      /* to the pixel, if the light arrives: all of them sum to the unoccluded radiance */
    double density;              /* of all samples of the pixel there, 1/sr */
    uint32_t technique;          /* 0 ... TECHNIQUES - 1 */
    bool is_of_tiles;            /* in place of the pool of a bin */
    uint32_t pass, pool, number; /* which sample of which pool it is; not for those of the surface */
    sample_fate fate;
} point_sample;

typedef struct technique_count {
    double expected; /* m */
    uint32_t realised, fates[SAMPLE_FATES];
} technique_count;

typedef struct samples_findings {
    const char *source; /* of the light */
    char label[FRAME_LABEL_SIZE];
    uint64_t index; /* of the frame */
    bool is_dynamic;
    uint32_t x, y; /* the pixel */
    helio_strategy strategy;
    helio_pixel_step pixel;               /* in the first pass */
    float normal[3], geometric_normal[3]; /* in the map's space */
    uint32_t passes;                      /* each has pools of its own */
    bool reads_tiles, reads_pools;        /* in some pass the lists of tiles; in some pass pools */
    uint32_t pool_count, pool_length;     /* pools that the point reads in a pass, samples of the longest */
    uint32_t pooled;                      /* samples of these pools; there are none of faces without light */
    helio_pool_sample *pools;             /* [pooled] */
    uint32_t sample_count, capacity;      /* samples; room for them */
    point_sample *samples;                /* [sample_count] */
    technique_count techniques[TECHNIQUES], all;
    uint32_t fallen[6]; /* samples that lie in each face, whatever took them there */
    double flux[6];     /* of each face */
    double control[3];  /* of the control variate, see helio_counts */
    double radiance[3]; /* sum over the samples that are used, and this */
    float exposure;     /* stops */
} samples_findings;

/* Takes the memory for what the job's renderer does. False where there is none. */
bool samples_make(samples_findings *found, const render_job *job);
void samples_release(samples_findings *found);

/* What the pixel (found->x, found->y) does in this frame, which may be rendered or not. Fills everything from .pixel to
 * .radiance but the flux. */
helio_status samples_gather(samples_findings *found, render_job *job, uint64_t index);

/* "+X" and so on where there is a pool for each face; "map", "bin", "tiles", both by turns, "BRDF", "cosine". */
const char *samples_technique_name(const samples_findings *found, uint32_t technique);
bool samples_is_by_face(const samples_findings *found);
uint32_t samples_useless(const technique_count *count);

/* The most remarkable of it in one sentence. */
void samples_remark(const samples_findings *found, char *text, size_t size);

/* ---- telling -------------------------------------------------------------------------------- */

void samples_print(const samples_findings *found);

/* What is drawn: findings, the cube that they belong to, and the render. */
typedef struct samples_view {
    const samples_findings *found;
    const render_plan *plan;
    const float *cube; /* [6][cube_size][cube_size][3] */
    uint32_t cube_size;
    shown_picture picture;
} samples_view;

/* Draws one figure to a path that figure_path_check() found good. Returns an exit code. */
int samples_draw(const char *path, const samples_view *view);

/* One figure of six frames. */
typedef struct samples_sheet samples_sheet;

enum { SAMPLES_SHEET_CELLS = 6 };

/* total: frames that will come; 0 where nobody knows. NULL where there is no memory. */
samples_sheet *samples_sheet_make(const char *path, uint64_t total);
void samples_sheet_release(samples_sheet *sheet);

/* Is the frame shown that comes after so many others? Frames are asked for one after the other. */
bool samples_sheet_wants(const samples_sheet *sheet, uint64_t position);
bool samples_sheet_is_full(const samples_sheet *sheet);
void samples_sheet_add(samples_sheet *sheet, const samples_view *view);
int samples_sheet_write(const samples_sheet *sheet);

#endif
