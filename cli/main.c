/* SPDX-License-Identifier: MIT */
#include "command.h"
#include "help.h"
#include "message.h"
#include "suggestion.h"

#include <heliostat/core.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const cli_command command_table[] = {
    {"render", COMMAND_RENDER, "render [options]",
     "light a mesh by environment maps, still or moving, and write pictures or a video", command_render},
    {"convert", COMMAND_CONVERT, "convert SRC [--to L] --out PATH [options]",
     "write an environment map in another layout, size or file format", command_convert},
    {"inspect", COMMAND_INSPECT, "inspect SRC [options]",
     "tell what an environment map holds: layout, range, flux, bad pixels, the sun", command_inspect},
    {"samples", COMMAND_SAMPLES, "samples [--pixel X,Y] [options]",
     "show where the light samples of a pixel are, which of them are used, and by how many", command_samples},
    {"compare", COMMAND_COMPARE, "compare PICTURE REFERENCE [options]",
     "measure how far a picture or a sequence is from its reference", command_compare},
    {"study", COMMAND_STUDY, "study [options]",
     "compare strategies over sample counts, maps and materials, and make a page of it", command_study},
    {"reference", COMMAND_REFERENCE, "reference [options]",
     "ground truth of a scene: a picture with the standard error of each pixel", command_reference},
    {"bench", COMMAND_BENCH, "bench [options]", "measure how fast each stage is on this machine", command_bench},
    {"info", COMMAND_INFO, "info", "show the version, what this build can do, and the processor", command_info},
    {"help", COMMAND_HELP, "help [command] [--man]", "print the help of a command, or the manual page", command_help},
};
const size_t command_count = sizeof command_table / sizeof command_table[0];

const cli_command *command_find(const char *name)
{
    word_suggestion suggestion = {.word = name};
    for (size_t i = 0; i < command_count; i++) {
        if (strcmp(command_table[i].name, name) == 0)
            return &command_table[i];
        suggestion_consider(&suggestion, command_table[i].name);
    }
    if (suggestion.best != NULL)
        message_usage("there is no command '%s'; did you mean %s?", name, suggestion.best);
    else
        message_usage("there is no command '%s'; heliostat --help lists the commands", name);
    return NULL;
}

/* Output that did not arrive, on a full disk say, is a failure; but a failure is not made worse by it. */
static int close_output(int code)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return code;
    return code == EXIT_CODE_OK ? message_failure("standard output cannot be written") : code;
}

static int run(int count, char **arguments)
{
    if (count < 2)
        return message_usage("name a command, such as render; heliostat --help lists the commands");
    const char *word = arguments[1];
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        help_program();
        return EXIT_CODE_OK;
    }
    if (strcmp(word, "--version") == 0) {
        printf("heliostat %s\n", HELIO_VERSION_TEXT);
        return EXIT_CODE_OK;
    }
    if (word[0] == '-')
        return message_usage(
            "the command comes first, such as heliostat render %s; heliostat --help lists the commands", word);
    const cli_command *command = command_find(word);
    if (command == NULL)
        return EXIT_CODE_USAGE;
    cli_options options;
    int code = options_parse(&options, command->bit, command->name, count - 2, arguments + 2);
    if (code != EXIT_CODE_OK)
        return code;
    if (!options.help)
        return command->run(&options);
    help_command(command);
    return EXIT_CODE_OK;
}

int main(int count, char **arguments)
{
    setenv("SVT_LOG", "1", 0); /* the AV1 encoder prints past FFmpeg's log; errors are told all the same */
    return close_output(run(count, arguments));
}
