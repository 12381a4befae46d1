/* SPDX-License-Identifier: MIT */
#include "study_strategy.h"

#include "message.h"
#include "number.h"

#include <stdio.h>
#include <string.h>

static const char SEPARATOR[] = ":";

/* What follows "name=" in a word; "" where the word is another. */
static const char *value_of(const char *word, const char *name)
{
    size_t length = strlen(name);
    return strncmp(word, name, length) == 0 && word[length] == '=' ? word + length + 1 : "";
}

static int take_option(const char *word, study_strategy *strategy)
{
    const char *decorrelate = value_of(word, "decorrelate");
    double share = 0;
    bool is_share = number_parse(value_of(word, "brdf-share"), 0.001, 0.999, &share);
    if (is_share)
        strategy->brdf_share = (float)share;
    if (is_share || helio_weighting_parse(value_of(word, "weighting"), &strategy->weighting) == HELIO_OK)
        return EXIT_CODE_OK;
    if (strcmp(word, "no-beta") == 0) {
        strategy->no_beta = true;
        return EXIT_CODE_OK;
    }
    if (strcmp(word, "no-control") == 0) {
        strategy->no_control = true;
        return EXIT_CODE_OK;
    }
    if (strcmp(decorrelate, "none") == 0 || strcmp(decorrelate, "hash") == 0) {
        strategy->no_decorrelation = decorrelate[0] == 'n';
        return EXIT_CODE_OK;
    }
    return message_usage("--strategies: after %s: come no-beta, no-control, brdf-share=0.001..0.999, "
                         "weighting=solid-angle, paper or compensated, "
                         "decorrelate=hash or none, not '%s'",
                         helio_strategy_name(strategy->strategy), word);
}

int study_strategy_parse(const char *text, const cli_options *options, study_strategy *strategy)
{
    char words[sizeof strategy->name], *rest = NULL;
    *strategy = (study_strategy){.no_beta = options->no_beta,
                                 .no_control = options->no_control,
                                 .no_decorrelation = options->decorrelate[0] == 'n',
                                 .brdf_share = (float)options->brdf_share};
    if (strlen(text) >= sizeof words)
        return message_usage("--strategies takes no item of more than %zu bytes: '%s'", sizeof words - 1, text);
    strcpy(words, text);
    size_t length = strcspn(text, SEPARATOR);
    const char *word = strtok_r(words, SEPARATOR, &rest);
    if (word == NULL || length == 0)
        return message_usage("--strategies: '%s' names no strategy", text);
    if (helio_strategy_parse(word, &strategy->strategy) != HELIO_OK ||
        helio_weighting_parse(options->weighting, &strategy->weighting) != HELIO_OK)
        return message_usage("--strategies: %s", helio_last_error());
    snprintf(strategy->name, sizeof strategy->name, "%s%.64s", helio_strategy_name(strategy->strategy), text + length);
    while ((word = strtok_r(NULL, SEPARATOR, &rest)) != NULL) {
        int code = take_option(word, strategy);
        if (code != EXIT_CODE_OK)
            return code;
    }
    if (helio_strategy_check_weighting(strategy->strategy, strategy->weighting) != HELIO_OK)
        return message_usage("--strategies: %s", helio_last_error());
    return EXIT_CODE_OK;
}

static uint32_t base_colour(helio_strategy strategy)
{
    switch (strategy) {
    case HELIO_STRATEGY_FACE: return 0x0072b2;
    case HELIO_STRATEGY_FACE_BRDF: return 0xd55e00;
    case HELIO_STRATEGY_LIGHT: return 0x009e73;
    case HELIO_STRATEGY_LIGHT_BRDF: return 0xcc79a7;
    case HELIO_STRATEGY_PRODUCT: return 0x332288;
    case HELIO_STRATEGY_PRODUCT_BRDF: return 0xe69f00;
    case HELIO_STRATEGY_BRDF: return 0x7f3b08;
    case HELIO_STRATEGY_COSINE: return 0x56b4e9;
    default: return 0x777777; /* auto */
    }
}

uint32_t study_strategy_colour(const study_strategy *strategy)
{
    uint32_t colour = base_colour(strategy->strategy);
    return strchr(strategy->name, SEPARATOR[0]) == NULL ? colour : colour >> 1 & 0x7f7f7f;
}
