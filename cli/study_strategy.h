/* SPDX-License-Identifier: MIT
 * study_strategy.h - a strategy that a study compares, with options of its own. */
#ifndef HELIOSTAT_CLI_STUDY_STRATEGY_H
#define HELIOSTAT_CLI_STUDY_STRATEGY_H

#include "options.h"

#include <heliostat/heliostat.h>

typedef struct study_strategy {
    char name[96]; /* as it was given */
    helio_strategy strategy;
    helio_weighting weighting;
    bool no_beta, no_control, no_decorrelation;
    float brdf_share;
} study_strategy;

/* Understands "face", or "face:no-beta:weighting=paper" with some of the options no-beta, no-control, brdf-share=X,
 * weighting=W and decorrelate=D of the command line, which are in place of those in options. Returns an exit code; one
 * sentence on stderr tells what is wrong. */
int study_strategy_parse(const char *text, const cli_options *options, study_strategy *strategy);

/* Its colour in charts and tables: those of Okabe and Ito that can be read on white, an indigo and a brown, which the
 * colour-blind tell apart, and for what has options of its own a darker one. */
uint32_t study_strategy_colour(const study_strategy *strategy);

#endif
