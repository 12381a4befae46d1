/* SPDX-License-Identifier: MIT
 *
 * renderer.h - a scene, a camera and an environment in, a picture out.
 */
#ifndef HELIOSTAT_RENDERER_H
#define HELIOSTAT_RENDERER_H

#include <heliostat/core.h>
#include <heliostat/device.h>
#include <heliostat/environment.h>
#include <heliostat/image.h>
#include <heliostat/sampling.h>
#include <heliostat/scene.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum helio_background {
    HELIO_BACKGROUND_DEFAULT = 0, /* ENVIRONMENT, or NONE over a shadow catcher */
    HELIO_BACKGROUND_ENVIRONMENT, /* the map, filtered; alpha is 1 */
    HELIO_BACKGROUND_NONE,        /* nothing; alpha is the coverage of object and plane, and over a shadow catcher
                                     1 - the share of light that reaches it */
} helio_background;

typedef struct helio_renderer helio_renderer;

typedef struct helio_renderer_desc {
    helio_environment *environment; /* required */
    const helio_scene *scene;       /* required */
    uint32_t width, height;         /* default 1280 x 720; 1..16384 each */
    uint32_t spp;                   /* light + BRDF samples per shading point; default 64; 1..2^20 */
    uint32_t aa;                    /* camera samples per pixel, each with spp of its own; default 1; 1..4096.
                                       1 looks through the pixel's centre, more are spread over the pixel. */
    helio_strategy strategy;
    helio_weighting weighting;
    uint32_t pool_length; /* M, see helio_pools_desc; default 1024, for PRODUCT the power of two that is 4 spp aa or
                             next to it, 128..1024 */
    uint32_t bins;        /* B, for PRODUCT; default 8 */
    float brdf_share;     /* default 0.5 */
    bool no_beta;
    bool no_control;
    bool no_decorrelation; /* all pixels read the same windows of the pools: shows bands */
    bool no_visibility;    /* light passes through everything, the paper's setting; default: shadow rays */
    helio_background background;
    helio_device *device; /* computes tables, pools, rays, light and background; it must outlive the renderer. Default:
                             the CPU computes all */
    bool aovs;            /* also fill albedo, normal, position and depth: means over the camera samples that
                                                  hit object or plane (a shadow catcher is not hit) */
} helio_renderer_desc;

typedef struct helio_frame_desc {
    helio_camera camera; /* required */
    uint32_t seed;
    /* Called about ten times a second or more often, on the calling thread, with the part done, 0..1; where a device
     * computes, after each step, of which there are helio_renderer_steps(). false stops the frame: HELIO_OK is returned
     * and each pixel holds the samples that it got so far (none: black, alpha 0). Default: none. */
    bool (*progress)(void *user, float done);
    void *user;
    bool no_picture; /* where a device computes, leave the picture there: helio_renderer_picture() keeps what it had.
                        The frame may then still be on its way on return, two frames are at the most, and the info is
                        that of the latest frame that is over */
    const helio_picture_write_desc *shown; /* make helio_picture.shown, too, as a PNG would show the picture: exposed,
                                              tone-mapped, sRGB; with alpha straight and with its alpha, else over black
                                              and with 255. Within 1 of 255 the same on every device. Default: none */
    bool no_radiance; /* nobody wants rgba and object, which become NULL: what a device makes of them stays there. With
                         shown 4 bytes of a pixel come back in place of 20 */
    bool retrace;     /* trace the camera rays even if the previous frame's still hold: to measure them */
} helio_frame_desc;

typedef struct helio_frame_info {
    double tables_ms, pools_ms, primary_ms, shade_ms; /* time in each stage, all passes; monotonic clock. Threads
                                                         divide camera rays and shading by tiles: the time of both is
                                                         shared out in proportion to what threads spent on each.
                                                         With a device all but camera rays is by its own clock, 0
                                                         where it has none. */
    double upload_ms, read_back_ms; /* with a device: map or cube, and points, to it, and the picture back, with
                                        the making of shown */
    double cube_ms;          /* with a device: map or sky into cube, where it makes it; see helio_environment_update */
    helio_bad_pixels bad;    /* of the map, where a device has made the cube; else 0: the update has told */
    double flux[6];          /* of the environment's faces, by the tables: see helio_environment_info */
    uint32_t passes;         /* how often the pools were redrawn */
    uint64_t samples;        /* light + BRDF samples taken */
    uint64_t samples_useful; /* above the horizon, with a contribution > 0 */
    uint64_t rays;           /* shadow rays */
    uint64_t camera_rays;    /* traced; 0 where those of the previous frame still hold */
    uint64_t points;         /* shading points: camera samples that hit something */
    bool stopped;            /* progress said so */
} helio_frame_info;

/* Takes all memory. Makes its own tables and pools. */
HELIO_API helio_status helio_renderer_create(helio_context *context, const helio_renderer_desc *desc,
                                             helio_renderer **renderer);
HELIO_API void helio_renderer_destroy(helio_renderer *renderer);

/* Renders the environment's current frame: tables, then for each pass pools, camera rays and shading. The same seed
 * gives the same bits on any number of threads. With one camera sample per pixel, what its rays met is kept for the
 * next frames until the camera changes. info may be NULL. */
HELIO_API helio_status helio_renderer_render(helio_renderer *renderer, const helio_frame_desc *desc,
                                             helio_frame_info *info);

/* What the latest render made. Arrays are the renderer's, valid until its next render. */
HELIO_API helio_picture helio_renderer_picture(const helio_renderer *renderer);

/* How many passes a frame takes: about spp x aa / (M / 8). Each redraws the pools. */
HELIO_API uint32_t helio_renderer_passes(const helio_renderer *renderer);

/* ---- a single pixel, to be looked into ---------------------------------------------- */

/* What the camera ray of a pixel meets. */
typedef enum helio_hit {
    HELIO_HIT_NOTHING = 0, /* the background */
    HELIO_HIT_OBJECT,
    HELIO_HIT_PLANE,
    HELIO_HIT_CATCHER, /* the plane of which only the shadows are seen */
} helio_hit;

/* What the renderer estimates for a pixel in one step. helio_count(), helio_gather() and helio_estimate() with
 * helio_renderer_pools(), this point and this desc give what it uses and what it gets. */
typedef struct helio_pixel_step {
    helio_hit hit;
    helio_shading_point point;    /* all 0 where nothing is hit */
    helio_estimate_desc estimate; /* its visibility function asks the scene; valid as long as the renderer */
} helio_pixel_step;

/* How many steps a frame takes: one for each camera sample where the pools have enough samples for a point, else
 * several, each with new pools. A pixel of the object is the mean of its steps' estimates, weighted by their samples.
 */
HELIO_API uint32_t helio_renderer_steps(const helio_renderer *renderer);

/* Looks into step 0 ... helio_renderer_steps() - 1 of a frame, rendered or not: column x from the left, row y from the
 * top, counted from 0. Builds the tables where the environment has a new frame, draws the pools of the step and traces
 * what is not known of its camera rays; takes no memory and leaves the picture as it is. */
HELIO_API helio_status helio_renderer_pixel(helio_renderer *renderer, const helio_frame_desc *desc, uint32_t x,
                                            uint32_t y, uint32_t step, helio_pixel_step *pixel);

/* The pools as the latest render or helio_renderer_pixel() left them; they live as long as the renderer. */
HELIO_API const helio_pools *helio_renderer_pools(const helio_renderer *renderer);

#ifdef __cplusplus
}
#endif
#endif
