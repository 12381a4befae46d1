/* SPDX-License-Identifier: MIT
 * render_job.h - the objects that render works with, and the making of one frame with them. */
#ifndef HELIOSTAT_CLI_RENDER_JOB_H
#define HELIOSTAT_CLI_RENDER_JOB_H

#include "frame_error.h"
#include "frame_warnings.h"
#include "progress.h"
#include "render_plan.h"
#include "stats.h"

typedef struct render_job {
    render_plan plan;
    helio_context *context;
    helio_device *device; /* that computes, for --backend vulkan; else NULL */
    helio_source *source;
    helio_source_info source_info;
    helio_environment *environment;
    helio_mesh *mesh;
    helio_scene *scene;
    helio_renderer *renderer;
    helio_camera camera;
    progress_bar progress;
    frame_warnings warnings;
    frame_error error;                     /* against --reference */
    uint32_t passes;                       /* of the latest frame */
    const helio_picture_write_desc *shown; /* what frames are asked for beside radiance, see helio_frame_desc ... */
    bool no_radiance;                      /* ... or in place of it */
    bool light_is_late; /* the device makes the cube: of the frame's light is told when it is rendered */
} render_job;

/* Understands the options, opens the source and starts reading it, and loads the scene. Returns an exit code; one
 * sentence on stderr tells what failed. */
int render_job_open(render_job *job, const cli_options *options);

/* The same in two halves, for commands that check for themselves what they write, before and between: the plan is to be
 * made first, and to be settled once the source is open. */
int render_job_open_source(render_job *job);
int render_job_open_scene(render_job *job);

/* The second half without a renderer, for commands that make their own, such as this one. */
int render_job_open_parts(render_job *job);
helio_renderer_desc render_job_describe(const render_job *job);

void render_job_close(render_job *job);

/* The next frame of the source; rgb and sky are NULL at the end. */
helio_status render_job_next(render_job *job, helio_source_frame *frame, stats_frame *stats);

/* Makes it the light of the scene. light: what was seen in it; NULL, where a device renders: nobody needs to know
 * before the frame is rendered, and the device may make the cube. */
helio_status render_job_light(render_job *job, const helio_source_frame *frame, helio_environment_info *light,
                              stats_frame *stats);

/* What the renderer is asked for when it renders frame `index`. */
helio_frame_desc render_job_frame(render_job *job, uint64_t index);

/* Renders what is lit now, by this frame. *is_whole is false where a signal stopped it. */
helio_status render_job_render(render_job *job, const helio_source_frame *frame, stats_frame *stats, bool *is_whole);

#endif
