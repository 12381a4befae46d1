/* SPDX-License-Identifier: MIT
 *
 * comparison.h - how far a picture is from its reference, in numbers and pixel by pixel.
 *
 * Two kinds of numbers. RMSE, relMSE and flicker compare radiance as it is. Lab, CIEDE2000, PSNR and FLIP compare what
 * a screen shows: radiance after exposure and tone map, clipped to 0..1, white (1, 1, 1) being CIE D65 with Y = 1.
 * docs/comparison.md has every formula. Means go over the pixels that are compared: those in the mask that are finite
 * in both pictures. The others in the mask are counted, see helio_comparison_info.skipped, and never reach a mean.
 *
 * One comparison serves for any number of pairs of one size, one after the other; it works on the context's threads.
 * Results have the same bits on any number of threads. All memory is taken at creation.
 */
#ifndef HELIOSTAT_COMPARISON_H
#define HELIOSTAT_COMPARISON_H

#include <heliostat/core.h>
#include <heliostat/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct helio_comparison helio_comparison;

typedef struct helio_comparison_desc {
    uint32_t width, height;  /* of both pictures, pixels, 1..65536 each, at most 2^28 in all; required */
    bool without_lab;        /* leave out Lab and CIEDE2000; default: HELIO_ERR_UNSUPPORTED in builds without lcms2 */
    bool without_flip;       /* leave out FLIP, which takes the most time and memory */
    bool flicker;            /* remember each pair, for the flicker of the next one */
    float pixels_per_degree; /* how large FLIP's viewer sees a pixel, 1..200; default 67: a screen of 3840 pixels,
                                0.7 m wide, from 0.7 m */
} helio_comparison_desc;

/* Takes 4 bytes of memory a pixel, 8 for Lab, 28 for FLIP and 24 for flicker. */
HELIO_API helio_status helio_comparison_create(helio_context *context, const helio_comparison_desc *desc,
                                               helio_comparison **comparison);
HELIO_API void helio_comparison_destroy(helio_comparison *comparison);

/* Is Lab, and with it CIEDE2000, in this build? */
HELIO_API bool helio_comparison_has_lab(void);

/* What is compared. The arrays stay the caller's. */
typedef struct helio_comparison_pair {
    const float *picture;   /* [height][width][picture_channels], linear Rec. 709; may hold any bits; required */
    const float *reference; /* [height][width][reference_channels], likewise; required */
    uint32_t picture_channels, reference_channels; /* 3 or 4; default 3. The fourth, alpha, is not looked at:
                                                      premultiplied colours are compared as over black */
    const float *mask;     /* [height][width]: pixels of 0.5 or more are in it; default: all are */
    float exposure;        /* stops, for what a screen shows, -100..100; default 0 */
    helio_tonemap tonemap; /* likewise */
} helio_comparison_pair;

/* NaN stands for what was left out, and in every mean where no pixel is compared. */
typedef struct helio_comparison_info {
    uint64_t pixels;                             /* that are compared */
    uint64_t skipped;                            /* in the mask, but NaN or infinite in one of both */
    helio_bad_pixels picture_bad, reference_bad; /* in the mask. Negative pixels are compared as they are */
    double rmse;     /* sqrt(mean((a - b)^2)), a the picture's channels, b the reference's; in the unit of radiance */
    double relmse;   /* mean((a - b)^2 / (b^2 + e)), e = 0.01 mean(b^2); infinite where the reference is black and
                        the picture is not */
    double psnr;     /* of the shown pictures, sRGB-encoded, peak 1, in dB; infinite where they are equal */
    double lab_mean; /* mean difference CIE 1976 L*a*b*, white D65: 1 is just noticed, black and white are 100 apart */
    double de2000_mean;  /* mean difference CIEDE2000, likewise */
    double flip;         /* mean LDR-FLIP, 0..1 */
    double flicker;      /* mean(((d - d')^2 / 2) / ((b^2 + b'^2) / 2 + e)), d = a - b, a prime: of the pair before, e
                            = 0.01 of the mean of (b^2 + b'^2) / 2, over pixels that are compared in both. The relMSE of
                            errors that are new in each frame, 0 for those that stay. NaN for the first pair */
    double flicker_rmse; /* sqrt(mean((d - d')^2)); in the unit of radiance */
    uint64_t flicker_pixels; /* that are compared in both */
} helio_comparison_info;

/* Compares a pair. HELIO_OK also where no pixel is compared. */
HELIO_API helio_status helio_comparison_measure(helio_comparison *comparison, const helio_comparison_pair *pair,
                                                helio_comparison_info *info);

/* The next pair is the first of another sequence: it has no flicker. */
HELIO_API void helio_comparison_restart(helio_comparison *comparison);

/* Errors pixel by pixel. */
typedef enum helio_error_map {
    HELIO_ERROR_MAP_LAB = 0,  /* difference CIE 1976 L*a*b* */
    HELIO_ERROR_MAP_DE2000,   /* CIEDE2000 */
    HELIO_ERROR_MAP_RELATIVE, /* (a - b)^2 / (b^2 + e), mean of the three channels, as relmse has it */
    HELIO_ERROR_MAP_FLIP,     /* LDR-FLIP, 0..1 */
} helio_error_map;

HELIO_API const char *helio_error_map_name(helio_error_map map); /* "lab", "de2000", "relative", "flip" */
HELIO_API helio_status helio_error_map_parse(const char *name, helio_error_map *map);

/* The errors of the latest pair: [height][width], all >= 0, NaN where nothing is compared. Valid until the next
 * measure. NULL for a map that was left out, and before the first pair. */
HELIO_API const float *helio_comparison_map(const helio_comparison *comparison, helio_error_map map);

/* Stops at which the reference is well seen: 95 of 100 of its pixels in the mask that are lit get a luminance of 0.8 or
 * less. 0 where none is. Of pictures that were made for a screen, as PNG, take 0 instead. Of the pair, reference, its
 * channels and mask are looked at. */
HELIO_API helio_status helio_comparison_auto_exposure(const helio_comparison *comparison,
                                                      const helio_comparison_pair *pair, float *exposure);

#ifdef __cplusplus
}
#endif
#endif
