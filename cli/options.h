/* SPDX-License-Identifier: MIT
 * options.h - the options of all commands: one table, from which parser, help and manual page are made. */
#ifndef HELIOSTAT_CLI_OPTIONS_H
#define HELIOSTAT_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Commands, as bits. */
enum {
    COMMAND_RENDER = 1 << 0,
    COMMAND_INFO = 1 << 1,
    COMMAND_HELP = 1 << 2,
    COMMAND_BENCH = 1 << 3,
    COMMAND_CONVERT = 1 << 4,
    COMMAND_INSPECT = 1 << 5,
    COMMAND_SAMPLES = 1 << 6,
    COMMAND_COMPARE = 1 << 7,
    COMMAND_REFERENCE = 1 << 8,
    COMMANDS_OF_SCENES = COMMAND_RENDER | COMMAND_SAMPLES | COMMAND_REFERENCE, /* which light a mesh */
    COMMAND_STUDY = 1 << 9,
    COMMAND_ALL = COMMANDS_OF_SCENES | COMMAND_INFO | COMMAND_HELP | COMMAND_BENCH | COMMAND_CONVERT | COMMAND_INSPECT |
                  COMMAND_COMPARE | COMMAND_STUDY
};

/* Lists, separated by commas, that bench walks through; some are single values in other commands. */
typedef struct bench_options {
    const char *stages, *isas, *threads, *env_sizes, *map_sizes, *spp, *strategies, *materials, *mesh_sizes;
    const char *json;
    uint32_t repeat;
    bool quick;
} bench_options;

/* Frames first ... last of a sequence, both included. */
typedef struct frame_range {
    uint32_t first, last;
    bool is_given;
} frame_range;

/* What convert alone takes. */
typedef struct convert_options {
    const char *to, *out;
    uint32_t env_size, size[2]; /* 0: not given */
    double exposure;            /* stops; NaN means auto */
    bool half;
} convert_options;

/* What inspect alone takes. */
typedef struct inspect_options {
    const char *json, *out;
} inspect_options;

/* What samples alone takes, or with other defaults. */
typedef struct samples_options {
    const char *pixel, *strategy, *out, *contact_sheet, *json;
    uint32_t day_frames; /* 0: not given */
} samples_options;

/* What compare alone takes. */
typedef struct compare_options {
    const char *mask, *json, *out, *map;
    double exposure; /* stops; NaN means auto */
    double range;    /* of the colours; 0: not given */
    double pixels_per_degree;
} compare_options;

/* What study alone takes. Lists are separated by commas, or by semicolons where there is one. */
typedef struct study_options {
    const char *file, *strategies, *spp, *envs, *materials, *visibility, *shown_spp, *reference_method, *out;
    uint32_t repeat, reference_spp, sequence, pictures;
    uint32_t day_frames;      /* 0: not given */
    uint32_t picture_size[2]; /* width, height */
    double turn;              /* degrees */
    double exposure;          /* stops; NaN means auto */
    bool resume;
} study_options;

/* What reference alone takes, or with other defaults. */
typedef struct reference_options {
    const char *method, *strategy, *out;
    uint32_t spp;                      /* 0: not given */
    double seconds, error, save_every; /* likewise; save_every: seconds */
    bool resume, keep_checkpoint;
} reference_options;

/* What the command line says. A pointer that is NULL means that the option was not given and has no fixed default. */
typedef struct cli_options {
    const char *env, *layout;
    uint32_t env_size;
    double rotate, intensity;
    bool flip;

    frame_range frames;
    uint32_t day_frames;
    double fps; /* 0: not given */
    const char *on_missing, *transfer;

    const char *mesh, *material, *camera, *ground;

    uint32_t spp, aa, seed, bins;
    uint32_t pool_length; /* 0: not given */
    const char *strategy, *weighting, *decorrelate, *visibility, *seed_mode;
    double brdf_share;
    bool no_beta;
    bool no_control;

    uint32_t size[2]; /* width, height */
    const char *background, *tonemap, *out, *stats;
    const char *contact_sheet, *codec;
    double exposure; /* stops; NaN means auto */
    double quality;  /* of a video; 0: not given */
    bool aovs, hdr, resume;

    uint32_t max_pixels, max_mesh_memory, max_mesh_seconds; /* 0: not given; memory in MiB */

    const char *input;     /* of convert and inspect: the SRC that follows the command; of compare: the picture */
    const char *reference; /* of compare: what follows the picture; of render: --reference */
    bench_options bench;
    convert_options convert;
    inspect_options inspect;
    samples_options samples;
    compare_options compare;
    study_options study;
    reference_options truth; /* of reference */

    const char *backend;
    const char *device; /* part of its name, or NULL */
    uint32_t threads;   /* 0: one per logical core */
    bool quiet, verbose;

    bool help, man;
    const char *topic; /* the command that help is about, or NULL */

    int word_count; /* the words that all this was read from, without the command's name */
    char **words;
} cli_options;

typedef enum option_kind {
    OPTION_FLAG,     /* bool, takes no value */
    OPTION_TEXT,     /* const char *, not empty */
    OPTION_CHOICE,   /* const char *, one of the choices */
    OPTION_WHOLE,    /* uint32_t in minimum..maximum */
    OPTION_POWER,    /* likewise, a power of two */
    OPTION_NUMBER,   /* double in minimum..maximum */
    OPTION_EXPOSURE, /* double in minimum..maximum, or the word auto: NaN */
    OPTION_SIZE,     /* uint32_t [2], each in minimum..maximum, as WxH */
    OPTION_RANGE,    /* frame_range, each in minimum..maximum and not falling, as A..B */
} option_kind;

/* Groups in the order in which the help shows them. */
typedef enum option_group {
    GROUP_ENVIRONMENT,
    GROUP_SEQUENCE,
    GROUP_SCENE,
    GROUP_SAMPLING,
    GROUP_PICTURE,
    GROUP_CONVERT,
    GROUP_INSPECT,
    GROUP_SAMPLES,
    GROUP_COMPARE,
    GROUP_STUDY,
    GROUP_REFERENCE,
    GROUP_BENCH,
    GROUP_PROGRAM,
    GROUP_COUNT
} option_group;

typedef struct cli_option {
    const char *name;     /* without the two dashes */
    char letter;          /* short form, or 0 */
    const char *argument; /* what the value is called in the help; NULL for a flag */
    const char *bare;     /* value where none follows: at the end, or before another option; NULL: one is needed */
    const char *initial;  /* default, parsed like a value from the command line; NULL: 0, NULL or false */
    const char *shown;    /* default in words, where initial does not say it */
    const char *help;     /* one sentence without full stop; the choices, if any, follow it */
    const char *choices;  /* separated by single spaces */
    option_group group;
    unsigned commands;
    option_kind kind;
    double minimum, maximum;
    size_t offset; /* of the member of options that receives the value */
} cli_option;

extern const cli_option option_table[];
extern const size_t option_count;
extern const char *const option_group_names[GROUP_COUNT];

/* Has the command an option of this name, which is without dashes? If not, which one is near enough to be meant? NULL:
 * none. */
bool option_exists(unsigned command, const char *name);
const char *option_suggest(unsigned command, const char *name);

/* Writes the choices of an option as words: "auto, cpu or vulkan". */
void option_choices(const cli_option *option, char *text, size_t size);

/* The default as the help shows it, or NULL where there is none to show. */
const char *option_default(const cli_option *option);

/* Sets the defaults and then reads the arguments that follow the command's name. Returns EXIT_CODE_OK, or
 * EXIT_CODE_USAGE after one sentence on stderr. The strings stay the caller's. */
int options_parse(cli_options *options, unsigned command, const char *command_name, int count, char **arguments);

#endif
