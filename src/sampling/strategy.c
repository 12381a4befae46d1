/* SPDX-License-Identifier: MIT */
#include "sampling/strategy.h"

#include "core/error.h"
#include "env/cube.h"

#include <string.h>

static const struct {
    const char *name;
    strategy_parts parts;
} strategies[] = {
    [HELIO_STRATEGY_AUTO] = {"auto", {STRATEGY_LIGHT_FACES, STRATEGY_SURFACE_BRDF}},
    [HELIO_STRATEGY_COSINE] = {"cosine", {STRATEGY_LIGHT_NONE, STRATEGY_SURFACE_COSINE}},
    [HELIO_STRATEGY_BRDF] = {"brdf", {STRATEGY_LIGHT_NONE, STRATEGY_SURFACE_BRDF}},
    [HELIO_STRATEGY_LIGHT] = {"light", {STRATEGY_LIGHT_WHOLE, STRATEGY_SURFACE_NONE}},
    [HELIO_STRATEGY_LIGHT_BRDF] = {"light+brdf", {STRATEGY_LIGHT_WHOLE, STRATEGY_SURFACE_BRDF}},
    [HELIO_STRATEGY_FACE] = {"face", {STRATEGY_LIGHT_FACES, STRATEGY_SURFACE_NONE}},
    [HELIO_STRATEGY_FACE_BRDF] = {"face+brdf", {STRATEGY_LIGHT_FACES, STRATEGY_SURFACE_BRDF}},
};

enum { STRATEGIES = sizeof strategies / sizeof strategies[0] };

bool strategy_is_valid(helio_strategy strategy)
{
    return (int)strategy >= 0 && (int)strategy < STRATEGIES;
}

helio_strategy helio_strategy_resolve(helio_strategy strategy)
{
    return strategy == HELIO_STRATEGY_AUTO ? HELIO_STRATEGY_FACE_BRDF : strategy;
}

strategy_parts strategy_divide(helio_strategy strategy)
{
    return strategies[strategy].parts;
}

const char *helio_strategy_name(helio_strategy strategy)
{
    return strategy_is_valid(strategy) ? strategies[strategy].name : "unknown";
}

helio_status helio_strategy_parse(const char *name, helio_strategy *strategy)
{
    if (name == NULL || strategy == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_strategy_parse needs a name and a place for the strategy");
    for (int i = 0; i < STRATEGIES; i++)
        if (strcmp(name, strategies[i].name) == 0) {
            *strategy = (helio_strategy)i;
            return HELIO_OK;
        }
    return fail(HELIO_ERR_ARGUMENT,
                "strategy '%s' is unknown; choose auto, cosine, brdf, light, light+brdf, face or face+brdf", name);
}

float strategy_beta(uint32_t face, vec3 normal)
{
    const cube_face *f = &cube_faces[face];
    return fmaxf(0.0f, dot(normal, f->axis) + fabsf(dot(normal, f->right)) + fabsf(dot(normal, f->down)));
}

void strategy_round(const float expected[TECHNIQUES], uint32_t samples, float offset, uint32_t realised[TECHNIQUES])
{
    int last = -1;
    for (int k = 0; k < TECHNIQUES; k++)
        if (expected[k] > 0.0f)
            last = k;
    /* Double, because the offset must not be rounded away beside a large sum. */
    double sum = (double)offset;
    uint32_t given = 0;
    for (int k = 0; k < TECHNIQUES; k++) {
        sum += (double)expected[k];
        uint32_t up_to = sum < (double)samples ? (uint32_t)sum : samples;
        if (k > last)
            up_to = given;
        else if (k == last)
            up_to = samples;
        realised[k] = up_to - given;
        given = up_to;
    }
}
