/* SPDX-License-Identifier: MIT
 *
 * reference.h - ground truth: the picture of a scene with how far each of its pixels may be off.
 *
 * A reference grows piece by piece, for as long as its caller likes:
 *
 *   create --> advance, advance, ... --> picture
 *                 save, resume
 *
 * SAMPLING: each piece is a pass, a picture of its own with samples that no other pass has. Passes are independent and
 * unbiased, so that their mean goes to the truth, and their spread tells the standard error of that mean, pixel by
 * pixel. QUADRATURE: the light of every texel of the cube is summed for every pixel, which leaves no noise; a piece is
 * a band of the picture. No rays are traced, so nothing shadows. docs/reference.md has the methods and what they were
 * held to.
 */
#ifndef HELIOSTAT_REFERENCE_H
#define HELIOSTAT_REFERENCE_H

#include <heliostat/renderer.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct helio_reference helio_reference;

typedef enum helio_reference_method {
    HELIO_REFERENCE_SAMPLING = 0,
    HELIO_REFERENCE_QUADRATURE,
} helio_reference_method;

typedef struct helio_reference_desc {
    /* Environment and scene are required; the environment holds its map already, and must keep it, with its
     * orientation, for as long as the reference lives. As in helio_renderer_create(), but for these:
     *  - strategy: HELIO_STRATEGY_AUTO, the default, is COSINE here, which knows least of what references are to judge
     *  - spp: light samples per pixel in a pass, default 64, divided among the camera samples; at least one for each
     *  - aa: camera samples in each pass, others in each. QUADRATURE: in all
     *  - no_visibility: QUADRATURE needs it set
     *  - aovs: there are none; must be false */
    helio_renderer_desc renderer;
    helio_camera camera; /* required */
    helio_reference_method method;
    /* Of the first pass; also of the camera samples of QUADRATURE. References with other seeds share no passes, but by
     * a rare chance, nor does helio_renderer_render() with small seeds. */
    uint32_t seed;

    /* QUADRATURE: grids are made finer until they change a pixel's part for one lobe by less than this part of it,
     * 1e-9..0.1; default 1e-5. What is reached is mostly a hundred times better. */
    double tolerance;
} helio_reference_desc;

/* Takes all memory. */
HELIO_API helio_status helio_reference_create(helio_context *context, const helio_reference_desc *desc,
                                              helio_reference **reference);
HELIO_API void helio_reference_destroy(helio_reference *reference);

typedef struct helio_reference_info {
    uint64_t pieces;      /* that are done */
    uint64_t piece_count; /* QUADRATURE: when it is complete; SAMPLING: 0, as there is no end */
    uint64_t spp;         /* SAMPLING: light samples per pixel so far ... */
    uint64_t piece_spp;   /* ... and in each piece */
    bool complete;        /* QUADRATURE: nothing is left to be done. Advancing then does nothing */
    bool stopped;         /* progress said so, and the piece is lost */
    uint64_t samples;     /* SAMPLING: of the latest piece, all pixels; QUADRATURE: evaluations of BRDFs */
} helio_reference_info;

/* Adds one piece. progress and user as in helio_frame_desc, with the part of the piece that is done; may be NULL. If it
 * returns false, the reference stays as it was before. The same pieces give the same bits on any number of threads.
 * info may be NULL. */
HELIO_API helio_status helio_reference_advance(helio_reference *reference, bool (*progress)(void *user, float done),
                                               void *user, helio_reference_info *info);

HELIO_API helio_reference_info helio_reference_get_info(const helio_reference *reference);

/* One number for how far the reference may be off: the mean over red, green and blue of all pixels of the object that
 * are done (coverage >= 0.5) of error / sqrt(b^2 + e), with the pixel's standard error and value b, and e = 0.01 x the
 * mean of b^2: the same e as that of relMSE. NaN where it is not known: before the second pass, or if no pixel shows
 * the object. */
HELIO_API double helio_reference_error(helio_reference *reference);

/* The picture so far, with rgba, object and standard_error, which is
 *  - SAMPLING: the standard deviation of the mean of the passes; NULL before the second pass
 *  - QUADRATURE: a bound rather, see docs/reference.md, and for several camera samples the standard error of their mean
 *    added to it. Infinite, with a pixel that is black and clear, where nothing was done yet.
 * Arrays are the reference's, valid until the next call of advance, picture or resume. */
HELIO_API helio_picture helio_reference_picture(helio_reference *reference);

/* Writes all that the reference has come to, so that another one with the same desc, map and scene can go on: under a
 * temporary name and renamed, so that path holds either the old or the whole new checkpoint. 64 bytes a pixel, 112 with
 * a shadow catcher, 24 more for QUADRATURE. */
HELIO_API helio_status helio_reference_save(const helio_reference *reference, const char *path);

/* Goes on from a checkpoint, in place of what this reference has. What follows has the same bits as if it had never
 * stopped, if the instruction set is the same; a warning in the log says where it is not. HELIO_ERR_DATA, and the
 * reference is as new, if the file is damaged, no checkpoint, of another version, or of a reference of something else:
 * the map, the scene, the camera or the size, or the settings. The sentence says which. */
HELIO_API helio_status helio_reference_resume(helio_reference *reference, const char *path);

#ifdef __cplusplus
}
#endif
#endif
