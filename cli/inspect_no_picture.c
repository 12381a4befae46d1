/* SPDX-License-Identifier: MIT
 * What builds without cairo have in place of inspect_picture.c. */
#include "inspect.h"

#include "message.h"

int inspect_picture_check(const char *path)
{
    return message_usage("--out %s cannot be drawn: this build has no cairo; --json and the text tell the same", path);
}

int inspect_draw(const char *path, const inspect_findings *found, const float *cube)
{
    (void)found;
    (void)cube;
    return inspect_picture_check(path);
}
