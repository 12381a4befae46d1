/* SPDX-License-Identifier: MIT
 * render_plan.h - the options of render, checked and turned into what the library takes. */
#ifndef HELIOSTAT_CLI_RENDER_PLAN_H
#define HELIOSTAT_CLI_RENDER_PLAN_H

#include "frame_sink.h"
#include "light_source.h"
#include "options.h"

#include <heliostat/heliostat.h>

typedef struct render_plan {
    const cli_options *options;
    light_source light;
    helio_source_desc source;
    char mesh[4096];
    frame_sink_kind sink;
    bool has_made_folder;     /* of numbered pictures; to be removed if nothing comes into it */
    char out[SINK_PATH_SIZE]; /* "" until render_plan_settle(), where --out was not given */
    bool has_material;        /* else what the mesh brings */
    helio_material material;
    helio_ground ground;
    helio_strategy strategy;
    helio_weighting weighting;
    helio_background background;
    helio_tonemap tonemap;
    helio_video_write_desc video; /* without exposure and tone map */
    bool alpha;                   /* the background lets alpha below 1 happen */
} render_plan;

/* Reads and writes no file. The options must outlive the plan. Returns EXIT_CODE_OK, or another exit code after one
 * sentence on stderr. */
int render_plan_make(render_plan *plan, const cli_options *options);

/* What can only be told once the source is open: does what comes fit --out, and does no file that it reads get
 * replaced? */
int render_plan_settle(render_plan *plan, helio_source *source);

/* Both of these for commands that make something else of a scene than pictures of it: without a look at what render
 * writes. may_be_sequence: where --env was not given, take a day. */
int render_plan_make_scene(render_plan *plan, const cli_options *options, bool may_be_sequence);
void render_plan_settle_scene(render_plan *plan, const helio_source *source);

/* Removes the folder that was made, if nothing came into it. */
void render_plan_release(const render_plan *plan);

/* Width / height. */
float render_plan_aspect(const render_plan *plan);

#endif
