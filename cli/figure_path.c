/* SPDX-License-Identifier: MIT */
#include "figure_path.h"

#include "message.h"
#include "output_file.h"

int figure_path_check(const char *option, const char *path, const char *command)
{
#ifndef HELIO_WITH_CAIRO
    (void)command;
    return message_usage("--%s %s cannot be drawn: this build has no cairo; --json and the text tell the same", option,
                         path);
#else
    if (output_file_has_extension(path, "png") || output_file_has_extension(path, "svg") ||
        output_file_has_extension(path, "pdf"))
        return EXIT_CODE_OK;
    return message_usage("--%s %s ends in none of .png, .svg and .pdf, which %s draws", option, path, command);
#endif
}
