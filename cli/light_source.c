/* SPDX-License-Identifier: MIT */
#include "light_source.h"

#include "asset.h"
#include "message.h"

static const char SHIPPED_MAP[] = "sunrise.hdr";
static const char SHIPPED_SKY[] = "sky:day";

int light_source_choose(const char *specification, bool may_be_sequence, light_source *light)
{
    *light = (light_source){.specification = specification};
    if (specification == NULL && may_be_sequence) {
        light->specification = SHIPPED_SKY;
    } else if (specification == NULL) {
        light->specification = light->shipped;
        if (!asset_find(SHIPPED_MAP, light->shipped, sizeof light->shipped))
            return message_failure("the map %s that comes with heliostat was not found; give light by --env SRC",
                                   SHIPPED_MAP);
        return EXIT_CODE_OK;
    }
    helio_status status = helio_source_check(light->specification, &light->kind);
    if (status == HELIO_OK)
        return EXIT_CODE_OK;
    return status == HELIO_ERR_ARGUMENT ? message_usage("%s", helio_last_error())
                                        : message_failure("%s", helio_last_error());
}
