/* SPDX-License-Identifier: MIT */
#include "study_progress.h"

/* What a frame takes beside its samples: the cube, camera rays, the comparison. */
static const double FRAME_WORK = 40;

double study_progress_frame(helio_strategy strategy, uint32_t spp)
{
    helio_strategy resolved = helio_strategy_resolve(strategy);
    bool is_of_pools =
        resolved == HELIO_STRATEGY_LIGHT || resolved == HELIO_STRATEGY_FACE || resolved == HELIO_STRATEGY_PRODUCT;
    return FRAME_WORK + (is_of_pools ? 0.2 : 1) * spp;
}

void study_progress_begin(study_progress *progress, double work)
{
    progress->part = work;
}

void study_progress_end(study_progress *progress)
{
    progress->done += progress->part;
    progress->part = 0;
}

bool study_progress_update(void *user, float done)
{
    study_progress *progress = user;
    double total = progress->total > 0 ? progress->total : 1;
    return progress_update(&progress->bar, (float)((progress->done + (double)done * progress->part) / total));
}
