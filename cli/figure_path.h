/* SPDX-License-Identifier: MIT
 * figure_path.h - names of figures, and whether this build can draw any. */
#ifndef HELIOSTAT_CLI_FIGURE_PATH_H
#define HELIOSTAT_CLI_FIGURE_PATH_H

/* EXIT_CODE_OK if a figure can be drawn to the path that --option names, EXIT_CODE_USAGE after one sentence if not.
 * command: the one that would draw it. */
int figure_path_check(const char *option, const char *path, const char *command);

#endif
