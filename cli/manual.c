/* SPDX-License-Identifier: MIT */
#include "help.h"

#include <heliostat/core.h>

#include <ctype.h>
#include <stdio.h>

/* Prints text so that troff shows it as it is. A dash becomes a plain minus, which people can copy into a shell. */
static void print_escaped(const char *text)
{
    if (*text == '.' || *text == '\'')
        printf("\\&");
    for (; *text != 0; text++) {
        if (*text == '\\')
            printf("\\e");
        else if (*text == '-')
            printf("\\-");
        else
            putchar(*text);
    }
}

static void print_bold(const char *text)
{
    printf("\\fB");
    print_escaped(text);
    printf("\\fR");
}

static void print_heading(const char *macro, const char *text)
{
    printf("%s \"", macro);
    for (; *text != 0; text++)
        putchar(macro[2] == 'H' ? toupper((unsigned char)*text) : *text);
    printf("\"\n");
}

static void print_entries(const help_section *section)
{
    for (size_t i = 0; i < section->count; i++) {
        printf(".TP\n");
        print_bold(section->entries[i].term);
        printf("\n");
        print_escaped(section->entries[i].text);
        printf(".\n");
    }
}

static void print_option(const cli_option *option)
{
    char sentence[512];
    printf(".TP\n");
    if (option->letter != 0)
        printf("\\fB\\-%c\\fR, ", option->letter);
    printf("\\fB\\-\\-");
    print_escaped(option->name);
    printf("\\fR");
    if (option->argument != NULL)
        printf(" \\fI%s\\fR", option->argument);
    printf("\n");
    help_sentence(option, sentence, sizeof sentence);
    print_escaped(sentence);
    printf(".\n");
}

static void print_options(void)
{
    print_heading(".SH", "Options");
    printf("Values follow their option as \\fB\\-\\-name\\fR \\fIvalue\\fR or \\fB\\-\\-name=\\fR\\fIvalue\\fR.\n"
           "Defaults stand in brackets.\n");
    for (int group = 0; group < GROUP_COUNT; group++) {
        print_heading(".SS", option_group_names[group]);
        for (size_t i = 0; i < option_count; i++)
            if ((int)option_table[i].group == group)
                print_option(&option_table[i]);
    }
}

static void print_commands(void)
{
    print_heading(".SH", "Commands");
    for (size_t i = 0; i < command_count; i++) {
        printf(".TP\n");
        print_bold(command_table[i].usage);
        printf("\n");
        print_escaped(command_table[i].summary);
        printf(".\n");
    }
    printf(".PP\n\\fB\\-\\-version\\fR in place of a command prints the version.\n");
}

static void print_forms(void)
{
    print_heading(".SH", "Values");
    for (size_t i = 0; i < help_form_count; i++) {
        printf(".SS \"");
        print_escaped(help_forms[i].title);
        printf("\"\n");
        print_entries(&help_forms[i]);
    }
}

static void print_examples(void)
{
    print_heading(".SH", help_examples.title);
    for (size_t i = 0; i < help_examples.count; i++) {
        printf(".PP\n");
        print_escaped(help_examples.entries[i].text);
        printf(":\n.PP\n.nf\n    ");
        print_escaped(help_examples.entries[i].term);
        printf("\n.fi\n");
    }
}

void help_manual(void)
{
    printf(".\\\" Made by: heliostat help --man\n");
    printf(".TH HELIOSTAT 1 \"\" \"heliostat %s\" \"User Commands\"\n", HELIO_VERSION_TEXT);
    printf(".SH NAME\nheliostat \\- %s\n", help_tagline);
    printf(".SH SYNOPSIS\n\\fBheliostat\\fR \\fIcommand\\fR [\\fIoptions\\fR]\n");
    printf(
        ".SH DESCRIPTION\n"
        "Heliostat aims light samples at an environment map: each pixel of the picture is lit by directions that are\n"
        "chosen where the map is bright and the surface can see it, one set of tables per face of a cube.\n"
        "Directions are right\\-handed with +Y up, lengths are metres, colours are linear Rec. 709 RGB.\n"
        "EXR and PFM hold radiance in the unit of the map; a PNG holds it after exposure and tone map, as sRGB.\n"
        "Alpha is premultiplied in EXR and straight in PNG.\n"
        "A picture appears under its name only when it is complete.\n");
    print_commands();
    print_options();
    print_forms();
    print_heading(".SH", help_variables.title);
    print_entries(&help_variables);
    print_heading(".SH", help_exit_codes.title);
    print_entries(&help_exit_codes);
    print_examples();
}
