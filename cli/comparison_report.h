/* SPDX-License-Identifier: MIT
 * comparison_report.h - what compare found, told as text and as JSON. */
#ifndef HELIOSTAT_CLI_COMPARISON_REPORT_H
#define HELIOSTAT_CLI_COMPARISON_REPORT_H

#include <heliostat/comparison.h>

/* Where the mask of a frame comes from, the first that there is. */
typedef enum mask_origin {
    MASK_OF_FILE,      /* --mask */
    MASK_OF_PICTURE,   /* object.A of the picture */
    MASK_OF_REFERENCE, /* object.A of the reference */
    MASK_NONE,         /* all pixels */
} mask_origin;

typedef struct compared_frame {
    uint64_t number;
    const char *picture, *reference, *mask; /* paths; mask: of the file that has it, NULL: all pixels */
    mask_origin mask_origin;
    helio_comparison_info info;
} compared_frame;

typedef struct comparison_report {
    const char *picture, *reference; /* as the command line has them */
    bool is_sequence;
    uint32_t width, height;
    float exposure; /* stops */
    bool has_auto_exposure;
    const char *tonemap;
    double pixels_per_degree;
    compared_frame *frames;
    size_t count;
} comparison_report;

/* One of the numbers of helio_comparison_info. */
typedef struct comparison_metric {
    const char *name, *meaning;
    size_t offset;      /* in helio_comparison_info */
    bool is_decibel;    /* of a mean square: means are taken of that */
    bool is_of_changes; /* there is none for the first frame, nor for a single one */
} comparison_metric;

enum { COMPARISON_METRICS = 8 };
extern const comparison_metric comparison_metrics[COMPARISON_METRICS];

double comparison_metric_value(const comparison_metric *metric, const helio_comparison_info *info);

/* Mean over the frames that have the number; NaN where none has. */
double comparison_metric_mean(const comparison_metric *metric, const comparison_report *report);

/* Exit codes. path: - is standard output. */
void comparison_report_print(const comparison_report *report);
int comparison_report_write_json(const char *path, const comparison_report *report);

#endif
