/* SPDX-License-Identifier: MIT */
#include "sampling/strategy.h"

#include "core/error.h"
#include "core/name_list.h"

static const char *const NAMES[] = {
    [HELIO_STRATEGY_AUTO] = "auto",
    [HELIO_STRATEGY_COSINE] = "cosine",
    [HELIO_STRATEGY_BRDF] = "brdf",
    [HELIO_STRATEGY_LIGHT] = "light",
    [HELIO_STRATEGY_LIGHT_BRDF] = "light+brdf",
    [HELIO_STRATEGY_FACE] = "face",
    [HELIO_STRATEGY_FACE_BRDF] = "face+brdf",
    [HELIO_STRATEGY_PRODUCT] = "product",
    [HELIO_STRATEGY_PRODUCT_BRDF] = "product+brdf",
};
static const name_list STRATEGIES = NAME_LIST("strategy", NAMES);

static const strategy_parts PARTS[] = {
    [HELIO_STRATEGY_COSINE] = {STRATEGY_LIGHT_NONE, STRATEGY_SURFACE_COSINE},
    [HELIO_STRATEGY_BRDF] = {STRATEGY_LIGHT_NONE, STRATEGY_SURFACE_BRDF},
    [HELIO_STRATEGY_LIGHT] = {STRATEGY_LIGHT_WHOLE, STRATEGY_SURFACE_NONE},
    [HELIO_STRATEGY_LIGHT_BRDF] = {STRATEGY_LIGHT_WHOLE, STRATEGY_SURFACE_BRDF},
    [HELIO_STRATEGY_FACE] = {STRATEGY_LIGHT_FACES, STRATEGY_SURFACE_NONE},
    [HELIO_STRATEGY_FACE_BRDF] = {STRATEGY_LIGHT_FACES, STRATEGY_SURFACE_BRDF},
    [HELIO_STRATEGY_PRODUCT] = {STRATEGY_LIGHT_BINS, STRATEGY_SURFACE_NONE},
    [HELIO_STRATEGY_PRODUCT_BRDF] = {STRATEGY_LIGHT_BINS, STRATEGY_SURFACE_BRDF},
};

const char *helio_strategy_name(helio_strategy strategy)
{
    return name_list_get(&STRATEGIES, (int)strategy);
}

helio_status helio_strategy_parse(const char *name, helio_strategy *strategy)
{
    int value;
    HELIO_TRY(name_list_find(&STRATEGIES, strategy ? name : NULL, &value));
    *strategy = (helio_strategy)value;
    return HELIO_OK;
}

helio_status strategy_check(helio_strategy strategy)
{
    return name_list_check(&STRATEGIES, (int)strategy);
}

helio_strategy helio_strategy_resolve(helio_strategy strategy)
{
    return strategy == HELIO_STRATEGY_AUTO ? HELIO_STRATEGY_PRODUCT_BRDF : strategy;
}

strategy_parts strategy_divide(helio_strategy strategy)
{
    return PARTS[helio_strategy_resolve(strategy)];
}

helio_status helio_strategy_check_weighting(helio_strategy strategy, helio_weighting weighting)
{
    HELIO_TRY(strategy_check(strategy));
    const helio_strategy resolved = helio_strategy_resolve(strategy);
    const bool is_mixed = resolved == HELIO_STRATEGY_LIGHT_BRDF || resolved == HELIO_STRATEGY_FACE_BRDF;
    if (weighting != HELIO_WEIGHTING_COMPENSATED || is_mixed || PARTS[resolved].light == STRATEGY_LIGHT_NONE)
        return HELIO_OK;
    return fail(HELIO_ERR_ARGUMENT,
                "the strategy %s cannot use compensated weights, which leave light out; take light+brdf or face+brdf",
                helio_strategy_name(strategy));
}
