/* SPDX-License-Identifier: MIT */
#include "inspect.h"

#include "json_file.h"

static json_t *file_object(const inspect_findings *found)
{
    json_t *object = json_object();
    json_object_set_new(object, "kind", json_string(found->file_kind));
    json_object_set_new(object, "size", json_pack("[oo]", json_whole(found->width), json_whole(found->height)));
    json_object_set_new(object, "frame", json_whole(found->frame));
    json_object_set_new(object, "is_one_of_several", json_boolean(found->is_dynamic));
    return object;
}

static json_t *layout_object(const inspect_findings *found)
{
    json_t *object = json_object();
    json_object_set_new(object, "name",
                        found->layout == HELIO_LAYOUT_AUTO ? json_null()
                                                           : json_string(helio_layout_name(found->layout)));
    json_object_set_new(object, "found", json_string(found->layout_why));
    return object;
}

static json_t *luminance_object(const inspect_findings *found)
{
    json_t *object = json_object();
    json_object_set_new(object, "min", json_number(found->least));
    json_object_set_new(object, "min_positive", json_number(found->least_positive));
    json_object_set_new(object, "max", json_number(found->greatest));
    json_object_set_new(object, "mean", json_number(found->mean_luminance));
    return object;
}

static json_t *flux_object(const inspect_findings *found)
{
    json_t *object = json_object();
    for (int face = 0; face < FACE_COUNT; face++)
        json_object_set_new(object, face_names[face], json_number(found->flux[face]));
    return object;
}

static json_t *bad_object(const inspect_findings *found)
{
    return json_pack("{so so so so}", "nan", json_whole(found->bad.nan), "inf", json_whole(found->bad.infinite),
                     "negative", json_whole(found->bad.negative), "out_of_gamut", json_whole(found->out_of_gamut));
}

static json_t *spot_object(const inspect_findings *found)
{
    const inspect_spot *spot = &found->spot;
    if (!found->has_spot)
        return json_null();
    json_t *object = json_object();
    json_object_set_new(object, "direction",
                        json_pack("[fff]", spot->direction[0], spot->direction[1], spot->direction[2]));
    json_object_set_new(object, "azimuth", json_number(spot->azimuth));
    json_object_set_new(object, "elevation", json_number(spot->elevation));
    json_object_set_new(object, "solid_angle", json_number(spot->solid_angle));
    json_object_set_new(object, "max_luminance", json_number(spot->luminance));
    json_object_set_new(object, "edge", json_number(spot->edge));
    json_object_set_new(object, "flux_share", json_number(spot->share));
    json_object_set_new(object, "irradiance_share", json_number(spot->irradiance_share));
    return object;
}

static json_t *clipping_object(const inspect_findings *found)
{
    json_t *object = json_object();
    json_object_set_new(object, "is_clipped", json_boolean(found->clipping != CLIPPING_NONE));
    json_object_set_new(object, "reason", json_string(inspect_clipping_name(found->clipping)));
    json_object_set_new(object, "plateau_pixels", json_whole(found->plateau));
    json_object_set_new(object, "max_channel", json_number(found->greatest_channel));
    return object;
}

static json_t *findings_object(const inspect_findings *found)
{
    json_t *object = json_object();
    json_object_set_new(object, "name", json_text(found->name));
    json_object_set_new(object, "file", file_object(found));
    json_object_set_new(object, "layout", layout_object(found));
    json_object_set_new(object, "cube_size", json_whole(found->cube_size));
    json_object_set_new(object, "pixels", json_whole(found->pixels));
    json_object_set_new(object, "dark_pixels", json_whole(found->dark));
    json_object_set_new(object, "bad_pixels", bad_object(found));
    json_object_set_new(object, "luminance", luminance_object(found));
    json_object_set_new(object, "dynamic_range_stops", json_number(found->stops));
    json_object_set_new(object, "mean_rgb", json_pack("[fff]", found->mean[0], found->mean[1], found->mean[2]));
    json_object_set_new(object, "auto_exposure", json_number(found->exposure));
    json_object_set_new(object, "flux", json_number(found->all_flux));
    json_object_set_new(object, "face_flux", flux_object(found));
    json_object_set_new(object, "irradiance", json_number(found->irradiance));
    json_object_set_new(object, "brightest", spot_object(found));
    json_object_set_new(object, "clipping", clipping_object(found));
    json_object_set_new(object, "advice", json_string(found->advice));
    return object;
}

int inspect_write_json(const char *path, const inspect_findings *found)
{
    json_t *object = findings_object(found);
    int code = json_file_write_or_print("json", path, object);
    json_decref(object);
    return code;
}
