/* SPDX-License-Identifier: MIT
 * map_converter.h - environment maps in one layout and size made from frames in another, turned and brightened. */
#ifndef HELIOSTAT_CLI_MAP_CONVERTER_H
#define HELIOSTAT_CLI_MAP_CONVERTER_H

#include "map_shape.h"
#include "map_turn.h"

#include <heliostat/heliostat.h>

/* Memory for a map, kept from frame to frame. */
typedef struct map_buffer {
    float *rgb;
    size_t pixels;
} map_buffer;

/* The first four members are set by its owner. */
typedef struct map_converter {
    helio_context *context;
    helio_source *source;
    map_turn turn;
    float intensity;
    helio_environment *environment; /* NULL until a frame needs it; of cube_size */
    uint32_t cube_size;
    map_buffer out; /* the result */
    map_buffer turned, between;
} map_converter;

/* What one frame becomes. */
typedef struct map_conversion {
    const helio_source_frame *frame;
    map_shape from, to;
    bool is_copy;                 /* every pixel stays what it is, but for turns by whole columns */
    helio_environment_info light; /* of the frame; bad pixels are always counted */
    bool has_light;               /* the rest of light is known too */
} map_conversion;

/* Makes converter->out. frame, from and to are given. False after one sentence on stderr. */
bool map_converter_run(map_converter *converter, map_conversion *work);

/* Makes sure of work->light. False as above. */
bool map_converter_find_light(map_converter *converter, map_conversion *work);

/* Not the context and the source. */
void map_converter_release(map_converter *converter);

#endif
