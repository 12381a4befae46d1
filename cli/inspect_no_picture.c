/* SPDX-License-Identifier: MIT
 * What builds without cairo have in place of inspect_picture.c. */
#include "figure_path.h"
#include "inspect.h"

int inspect_draw(const char *path, const inspect_findings *found, const float *cube)
{
    (void)found;
    (void)cube;
    return figure_path_check("out", path, "inspect");
}
