/* SPDX-License-Identifier: MIT
 * The panel of the picture that tells in words what was found. */
#include "inspect_drawing.h"

#include "output_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

static double draw_spot_lines(const drawing *d, text_box box, double y)
{
    const inspect_spot *spot = &d->found->spot;
    char text[256];
    if (!d->found->has_spot)
        return draw_entry(d->cairo, &box, y, "brightest", "nothing is twice as bright as the mean");
    snprintf(text, sizeof text, "azimuth %.1f\u00b0, elevation %.1f\u00b0, %.3g sr", spot->azimuth, spot->elevation,
             spot->solid_angle);
    y = draw_entry(d->cairo, &box, y, "brightest", text);
    snprintf(text, sizeof text, "%.3g %% of all light, %.3g %% of that on the ground", 100 * spot->share,
             100 * spot->irradiance_share);
    return draw_entry(d->cairo, &box, y, "it gives", text);
}

void draw_findings(const drawing *d, double left, double top, double width)
{
    const inspect_findings *found = d->found;
    const helio_bad_pixels *bad = &found->bad;
    const text_box box = {.left = left, .width = width, .label_width = 92};
    double y = top + 16;
    char text[256];
    set_grey(d->cairo, INK);
    draw_name(d->cairo, left, y, width, output_file_last_part(found->name));
    y += 30;
    if (found->width > 0)
        snprintf(text, sizeof text, "%s, %" PRIu32 " \u00d7 %" PRIu32 ", %s (%s)", found->file_kind, found->width,
                 found->height, helio_layout_name(found->layout), found->layout_why);
    else
        snprintf(text, sizeof text, "%s", found->file_kind);
    y = draw_entry(d->cairo, &box, y, "file", text);
    snprintf(text, sizeof text, "%.3g to %.6g, %.1f stops; mean %.3g", found->least, found->greatest, found->stops,
             found->mean_luminance);
    y = draw_entry(d->cairo, &box, y, "luminance", text);
    snprintf(text, sizeof text, "%.4g in all, on the ground %.4g; faces: parts of all", found->all_flux,
             found->irradiance);
    y = draw_entry(d->cairo, &box, y, "flux", text);
    snprintf(text, sizeof text, "%" PRIu64 " NaN, %" PRIu64 " infinite, %" PRIu64 " negative, %" PRIu64 " out of gamut",
             bad->nan, bad->infinite, bad->negative, found->out_of_gamut);
    bool is_good = bad->nan + bad->infinite + bad->negative + found->out_of_gamut == 0;
    y = draw_entry(d->cairo, &box, y, "bad pixels", is_good ? "none" : text);
    y = draw_spot_lines(d, box, y);
    inspect_clipping_tell(found, text, sizeof text);
    y = draw_entry(d->cairo, &box, y, "clipped", text);
    draw_entry(d->cairo, &box, y, "advice", found->advice);
}
