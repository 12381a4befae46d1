/* SPDX-License-Identifier: MIT
 * study_charts.h - the curves of a study, and the PDF files with them. */
#ifndef HELIOSTAT_CLI_STUDY_CHARTS_H
#define HELIOSTAT_CLI_STUDY_CHARTS_H

#include "chart.h"
#include "study_record.h"

/* RMSE over samples, or over the time of a frame. */
chart study_chart_pair(const study_record *record, uint32_t environment, uint32_t material, bool is_over_time);

/* The same of the root of relMSE, geometric means over all environments. */
chart study_chart_mean(const study_record *record, uint32_t material, bool is_over_time);

/* The same of flicker, where it was measured. */
chart study_chart_flicker(const study_record *record, uint32_t material, bool is_over_time);

/* Is there more than a point for it? */
bool study_chart_has_flicker(const study_plan *plan);

/* Writes curves-*.pdf into the study's folder: of each material, and of each pair. Does nothing in builds without
 * cairo. Returns an exit code; one sentence on stderr tells of a failure. */
int study_charts_write(const study_record *record);

#endif
