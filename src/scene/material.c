/* SPDX-License-Identifier: MIT */
#include "scene/material.h"

#include "core/error.h"
#include "core/specification.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

#define MAX_EXPONENT 1e5f

/* Decimal fractions that add up to one, 0.9 + 0.1 say, may miss it by a rounding when they are floats. */
#define ENERGY_LIMIT (1.0f + 1e-6f)

helio_material material_default(void)
{
    return (helio_material){.kind = HELIO_MATERIAL_PHONG,
                            .diffuse = {0.5f, 0.5f, 0.5f},
                            .specular = {0.5f, 0.5f, 0.5f},
                            .exponent = 120.0f};
}

static helio_status parse_diffuse(const char *text, helio_material *material)
{
    *material = (helio_material){.kind = HELIO_MATERIAL_DIFFUSE, .diffuse = {0.8f, 0.8f, 0.8f}};
    specification_field fields[] = {
        {.key = "", .count = 3, .one_for_all = true, .greatest = 1.0f, .values = material->diffuse},
    };
    return specification_parse("material", text, fields, COUNT(fields));
}

static helio_status parse_phong(const char *text, helio_material *material)
{
    *material = material_default();
    specification_field fields[] = {
        {.key = "kd", .count = 3, .one_for_all = true, .greatest = 1.0f, .values = material->diffuse},
        {.key = "ks", .count = 3, .one_for_all = true, .greatest = 1.0f, .values = material->specular},
        {.key = "n", .count = 1, .greatest = MAX_EXPONENT, .values = &material->exponent},
    };
    return specification_parse("material", text, fields, COUNT(fields));
}

static helio_status parse_ggx(const char *text, helio_material *material)
{
    *material = (helio_material){
        .kind = HELIO_MATERIAL_GGX, .diffuse = {1.0f, 0.8f, 0.3f}, .metallic = 1.0f, .roughness = 0.2f};
    specification_field fields[] = {
        {.key = "base", .count = 3, .one_for_all = true, .greatest = 1.0f, .values = material->diffuse},
        {.key = "metallic", .count = 1, .greatest = 1.0f, .values = &material->metallic},
        {.key = "roughness", .count = 1, .greatest = 1.0f, .values = &material->roughness},
    };
    return specification_parse("material", text, fields, COUNT(fields));
}

helio_status helio_material_parse(const char *specification, helio_material *material)
{
    if (specification == NULL || material == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_material_parse needs a specification and a place for the material");
    helio_material parsed;
    if (specification_has_name(specification, "diffuse"))
        HELIO_TRY(parse_diffuse(specification, &parsed));
    else if (specification_has_name(specification, "phong"))
        HELIO_TRY(parse_phong(specification, &parsed));
    else if (specification_has_name(specification, "ggx"))
        HELIO_TRY(parse_ggx(specification, &parsed));
    else
        return fail(HELIO_ERR_ARGUMENT,
                    "material \"%.200s\" is unknown; use diffuse:0.8, phong:kd=0.5,ks=0.5,n=120 or "
                    "ggx:base=1,0.8,0.3,metallic=1,roughness=0.2",
                    specification);
    helio_status status = helio_material_check(&parsed);
    if (status != HELIO_OK)
        return fail(status, "material \"%.200s\": %s", specification, helio_last_error());
    *material = parsed;
    return HELIO_OK;
}

static helio_status check_range(const char *field, float value, float greatest)
{
    if (value >= 0.0f && value <= greatest)
        return HELIO_OK;
    return fail(HELIO_ERR_ARGUMENT, "%s is %g; use 0 to %g", field, (double)value, (double)greatest);
}

static helio_status check_colour(const char *field, const float colour[3])
{
    for (int c = 0; c < 3; c++)
        HELIO_TRY(check_range(field, colour[c], 1.0f));
    return HELIO_OK;
}

static helio_status check_phong(const helio_material *material)
{
    HELIO_TRY(check_colour("diffuse (kd)", material->diffuse));
    HELIO_TRY(check_colour("specular (ks)", material->specular));
    HELIO_TRY(check_range("exponent (n)", material->exponent, MAX_EXPONENT));
    for (int c = 0; c < 3; c++) {
        float sum = material->diffuse[c] + material->specular[c];
        if (sum > ENERGY_LIMIT)
            return fail(HELIO_ERR_ARGUMENT, "kd + ks is %g in the %s channel; use 0 to 1", (double)sum,
                        c == 0   ? "red"
                        : c == 1 ? "green"
                                 : "blue");
    }
    return HELIO_OK;
}

helio_status helio_material_check(const helio_material *material)
{
    if (material == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_material_check needs a material");
    switch (material->kind) {
    case HELIO_MATERIAL_DIFFUSE: return check_colour("diffuse", material->diffuse);
    case HELIO_MATERIAL_PHONG: return check_phong(material);
    case HELIO_MATERIAL_GGX:
        HELIO_TRY(check_colour("diffuse (base)", material->diffuse));
        HELIO_TRY(check_range("metallic", material->metallic, 1.0f));
        return check_range("roughness", material->roughness, 1.0f);
    }
    return fail(HELIO_ERR_ARGUMENT, "material kind %d is unknown; use a helio_material_kind", (int)material->kind);
}
