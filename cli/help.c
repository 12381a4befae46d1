/* SPDX-License-Identifier: MIT */
#include "help.h"

#include "message.h"

#include <heliostat/core.h>

#include <stdio.h>
#include <string.h>

enum { PAGE_WIDTH = 100, TERM_WIDTH = 28, INDENT = 2 };

/* Prints a term and, beside or below it, its text in a column that ends at the page's width. */
static void print_entry(const char *term, const char *text)
{
    int column = printf("%*s%s", INDENT, "", term);
    if (column > TERM_WIDTH - 2)
        column = PAGE_WIDTH;
    while (*text != 0) {
        int length = (int)strcspn(text, " ");
        if (column + 1 + length > PAGE_WIDTH) {
            putchar('\n');
            column = 0;
        }
        if (column < TERM_WIDTH)
            column += printf("%*s", TERM_WIDTH - column, "");
        else
            column += printf(" ");
        column += printf("%.*s", length, text);
        text += length;
        text += strspn(text, " ");
    }
    putchar('\n');
}

static void print_section(const help_section *section)
{
    printf("\n%s\n", section->title);
    for (size_t i = 0; i < section->count; i++)
        print_entry(section->entries[i].term, section->entries[i].text);
}

static bool is_example_of(const char *line, const char *command)
{
    size_t program = strlen("heliostat "), length = strlen(command);
    return strncmp(line + program, command, length) == 0 &&
           (line[program + length] == ' ' || line[program + length] == 0);
}

/* Command lines are long: the meaning stands above each. command: NULL for all. */
static void print_examples(const char *command)
{
    const char *between = "";
    for (size_t i = 0; i < help_examples.count; i++) {
        const help_entry *example = &help_examples.entries[i];
        if (command != NULL && !is_example_of(example->term, command))
            continue;
        if (between[0] == 0)
            printf("\n%s\n", help_examples.title);
        printf("%s  # %s\n  %s\n", between, example->text, example->term);
        between = "\n";
    }
}

static void print_option(const cli_option *option)
{
    char term[64], letter[8] = "    ", sentence[512];
    if (option->letter != 0)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(term, sizeof term, "%s--%s%s%s", letter, option->name, option->argument ? " " : "",
             option->argument ? option->argument : "");
    help_sentence(option, sentence, sizeof sentence);
    print_entry(term, sentence);
}

static void print_group(option_group group, unsigned commands)
{
    bool first = true;
    for (size_t i = 0; i < option_count; i++) {
        if (option_table[i].group != group || !(option_table[i].commands & commands))
            continue;
        if (first)
            printf("\n%s\n", option_group_names[group]);
        first = false;
        print_option(&option_table[i]);
    }
}

void help_program(void)
{
    printf("heliostat %s: %s\n\nUsage: heliostat COMMAND [options]\n\nCommands\n", HELIO_VERSION_TEXT, help_tagline);
    for (size_t i = 0; i < command_count; i++)
        print_entry(command_table[i].name, command_table[i].summary);
    printf("\nOptions\n");
    print_entry("--help", "print this help; after a command, the help of that command");
    print_entry("--version", "print the version");
    print_examples(NULL);
    printf("\nheliostat render --help shows all options of the main job.\n");
}

void help_command(const cli_command *command)
{
    printf("heliostat %s: %s\n\nUsage: heliostat %s\n", command->name, command->summary, command->usage);
    if (command->bit & ~(unsigned)(COMMAND_INFO | COMMAND_HELP))
        printf("\nValues follow their option as --name VALUE or --name=VALUE; [defaults] stand in brackets.\n");
    for (int group = 0; group < GROUP_COUNT; group++)
        print_group((option_group)group, command->bit);
    for (size_t i = 0; i < help_form_count; i++)
        if (help_forms[i].commands & command->bit)
            print_section(&help_forms[i]);
    print_examples(command->name);
}

int command_help(const cli_options *options)
{
    if (options->man && options->topic != NULL)
        return message_usage("help --man prints one page for all commands; leave '%s' away", options->topic);
    if (options->man) {
        help_manual();
        return EXIT_CODE_OK;
    }
    if (options->topic == NULL) {
        help_program();
        return EXIT_CODE_OK;
    }
    const cli_command *command = command_find(options->topic);
    if (command == NULL)
        return EXIT_CODE_USAGE;
    help_command(command);
    return EXIT_CODE_OK;
}
