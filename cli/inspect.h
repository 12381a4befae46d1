/* SPDX-License-Identifier: MIT
 * inspect.h - what inspect finds in an environment map, and how it tells it. */
#ifndef HELIOSTAT_CLI_INSPECT_H
#define HELIOSTAT_CLI_INSPECT_H

#include "face.h"

#include <heliostat/heliostat.h>

/* Of luminance, in bins of 1/8 stop from 2^-40 to 2^40; what lies beyond counts in the last bin on that side. */
enum { STOP_BINS = 8, LOWEST_STOP = -40, HIGHEST_STOP = 40, HISTOGRAM_BINS = (HIGHEST_STOP - LOWEST_STOP) * STOP_BINS };

typedef struct inspect_histogram {
    double area[HISTOGRAM_BINS], light[HISTOGRAM_BINS]; /* solid angle, sr; flux */
    double black;                                       /* solid angle where there is no light */
} inspect_histogram;

/* A spot that stands out ends where luminance falls below this part of its greatest. */
#define SPOT_FIRST_EDGE 0.1

/* The brightest texel of the cube with all its neighbours, near and far, of at least so much of its luminance that it
 * is no large part of the sphere. */
typedef struct inspect_spot {
    double direction[3];       /* unit vector; of its light's centre */
    double azimuth, elevation; /* degrees; from -Z over +X (from north over east under a sky), above the horizon */
    double solid_angle;        /* sr */
    double luminance;          /* of its brightest texel */
    double edge;               /* where it ends, as a part of that */
    double share;              /* of all light */
    double irradiance_share;   /* of the light on a horizontal surface that faces up */
} inspect_spot;

typedef enum inspect_clipping {
    CLIPPING_NONE = 0,
    CLIPPING_WHITE,   /* few bits: many pixels are as bright as the format goes */
    CLIPPING_HALF,    /* the brightest pixels are as bright as half floats go */
    CLIPPING_PLATEAU, /* many of the brightest pixels are equal */
    CLIPPING_WEAK,    /* a spot of the sun's size in a sky, with too little light for the sun */
} inspect_clipping;

/* One word for each, as JSON has it. */
const char *inspect_clipping_name(inspect_clipping clipping);

typedef struct inspect_findings inspect_findings;

/* Does it look clipped, and why? In words. */
void inspect_clipping_tell(const inspect_findings *findings, char *text, size_t size);

struct inspect_findings {
    const char *name;       /* of the file, or the source's specification */
    const char *file_kind;  /* "OpenEXR" and so on; static */
    const char *layout_why; /* how the layout was found; static */
    helio_layout layout;    /* AUTO for a sky */
    uint32_t width, height; /* pixels; 0 for a sky */
    uint32_t cube_size;     /* of the cube that was looked at */
    bool is_dynamic;        /* this is one frame of several */
    uint64_t frame;         /* its number */

    uint64_t pixels;                        /* that show something of the sphere */
    double least, least_positive, greatest; /* luminance of a pixel; 0 if there is none */
    double greatest_channel;
    double stops;  /* dynamic range: log2(greatest / least_positive) */
    uint64_t dark; /* pixels without light */
    helio_bad_pixels bad;
    uint64_t out_of_gamut;

    double mean[3], mean_luminance; /* over the sphere */
    double flux[FACE_COUNT], all_flux;
    double irradiance;               /* on a horizontal surface that faces up */
    double upper_median, upper_mean; /* luminance above the horizon; the mean without the spot */
    double exposure;                 /* stops, see helio_environment_info */
    inspect_histogram histogram;

    bool has_spot; /* something is brighter than the rest */
    inspect_spot spot;
    uint64_t plateau; /* pixels whose greatest channel is the map's greatest */
    uint64_t bright;  /* pixels whose greatest channel is a tenth of that or more */
    inspect_clipping clipping;
    const char *advice; /* one sentence without full stop; static */
};

/* What is known before pixels are looked at. frame, environment and light belong together. */
typedef struct inspect_subject {
    const helio_source_frame *frame;
    const helio_source_info *source;
    const helio_environment *environment;
    const helio_environment_info *light;
    bool layout_is_given; /* by --layout */
} inspect_subject;

/* Fills findings. False after one sentence on stderr. */
bool inspect_measure(const inspect_subject *subject, inspect_findings *findings);

/* Parts of the above. */
double inspect_luminance(const float rgb[3]);
bool inspect_find_spot(const float *cube, uint32_t size, inspect_findings *findings);
void inspect_judge(inspect_findings *findings);

/* Each tells it all. Exit codes. */
int inspect_print(const inspect_findings *findings);
int inspect_write_json(const char *path, const inspect_findings *findings);

/* To a path that figure_path_check() found good. */
int inspect_draw(const char *path, const inspect_findings *findings, const float *cube);

#endif
