/* SPDX-License-Identifier: MIT */
#include "day_exposure.h"

helio_status day_exposure_find(helio_context *context, const char *specification, helio_environment *environment,
                               float *exposure)
{
    const helio_source_desc desc = {.frames = 3, .has_frames = true, .first = 1, .last = 1};
    helio_source *source;
    helio_source_frame frame;
    helio_environment_info light;
    helio_status status = helio_source_open(context, specification, &desc, &source);
    if (status != HELIO_OK)
        return status;
    status = helio_source_next(source, &frame);
    if (status == HELIO_OK)
        status = helio_source_apply(source, &frame, environment, &light);
    if (status == HELIO_OK)
        *exposure = light.auto_exposure;
    helio_source_close(source);
    return status;
}
