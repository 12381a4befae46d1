/* SPDX-License-Identifier: MIT */
#include "inspect.h"

#include "message.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

enum { LABEL_WIDTH = 16 };

static void print_label(const char *label)
{
    printf("  %-*s", LABEL_WIDTH, label);
}

static void print_file(const inspect_findings *found)
{
    printf("%s\n", found->name);
    print_label("file");
    printf("%s", found->file_kind);
    if (found->width > 0)
        printf(", %" PRIu32 " x %" PRIu32 " pixels", found->width, found->height);
    if (found->is_dynamic)
        printf("; this is frame %" PRIu64 " of several", found->frame);
    printf("\n");
    print_label("layout");
    printf("%s (%s)\n", found->layout == HELIO_LAYOUT_AUTO ? "none" : helio_layout_name(found->layout),
           found->layout_why);
}

static void print_range(const inspect_findings *found)
{
    print_label("range");
    printf("luminance of %s %.4g to %.6g", found->width > 0 ? "pixels" : "texels", found->least, found->greatest);
    if (found->dark > 0)
        printf(", above 0 from %.4g; %" PRIu64 " pixel%s without light", found->least_positive, found->dark,
               found->dark == 1 ? "" : "s");
    printf("\n");
    print_label("dynamic range");
    printf("%.1f stops\n", found->stops);
    print_label("mean");
    printf("luminance %.4g; RGB %.4g %.4g %.4g; auto exposure %+.2f stops\n", found->mean_luminance, found->mean[0],
           found->mean[1], found->mean[2], found->exposure);
}

static void print_flux(const inspect_findings *found)
{
    print_label("flux");
    printf("%.4g in all; on a horizontal surface %.4g\n", found->all_flux, found->irradiance);
    for (int face = 0; face < FACE_COUNT; face++) {
        if (face % 3 == 0)
            print_label("");
        printf("%s %.4g (%.1f %%)%s", face_names[face], found->flux[face],
               found->all_flux > 0 ? 100 * found->flux[face] / found->all_flux : 0.0, face % 3 == 2 ? "\n" : "  ");
    }
}

static void print_bad(const inspect_findings *found)
{
    const helio_bad_pixels *bad = &found->bad;
    print_label("bad pixels");
    if (bad->nan + bad->infinite + bad->negative + found->out_of_gamut == 0)
        printf("none\n");
    else
        printf("%" PRIu64 " NaN, %" PRIu64 " infinite, %" PRIu64 " negative, %" PRIu64 " out of gamut\n", bad->nan,
               bad->infinite, bad->negative, found->out_of_gamut);
}

/* As wide as the angle of a disc of that size: people know that the sun has half a degree. */
static double disc_degrees(double solid_angle)
{
    const double pi = acos(-1);
    return 2 * acos(fmax(1 - solid_angle / (2 * pi), -1)) * 180 / pi;
}

static void print_spot(const inspect_findings *found)
{
    const inspect_spot *spot = &found->spot;
    print_label("brightest spot");
    if (!found->has_spot) {
        printf("none; nothing is twice as bright as the mean\n");
        return;
    }
    printf("azimuth %.2f (from -Z over +X), elevation %.2f degrees; direction %.4f %.4f %.4f\n", spot->azimuth,
           spot->elevation, spot->direction[0], spot->direction[1], spot->direction[2]);
    print_label("");
    double degrees = disc_degrees(spot->solid_angle);
    printf("%.3g sr, as a disc of %.*f degrees, down to %.0f %% of its greatest luminance\n", spot->solid_angle,
           degrees < 1    ? 2
           : degrees < 10 ? 1
                          : 0,
           degrees, 100 * spot->edge);
    print_label("");
    printf("that is %.6g, averaged over a texel of a cube of 6 x %" PRIu32 " x %" PRIu32 "\n", spot->luminance,
           found->cube_size, found->cube_size);
    print_label("");
    printf("gives %.1f %% of all light, %.1f %% of that on a horizontal surface\n", 100 * spot->share,
           100 * spot->irradiance_share);
}

void inspect_clipping_tell(const inspect_findings *found, char *text, size_t size)
{
    switch (found->clipping) {
    case CLIPPING_NONE: snprintf(text, size, "it does not look so"); break;
    case CLIPPING_WHITE:
        snprintf(text, size, "yes: %" PRIu64 " pixels are as bright as the file can hold", found->plateau);
        break;
    case CLIPPING_HALF: snprintf(text, size, "yes: the brightest pixels are as bright as half floats go"); break;
    case CLIPPING_PLATEAU:
        snprintf(text, size, "it looks so: %" PRIu64 " pixels share the greatest value, %.6g", found->plateau,
                 found->greatest_channel);
        break;
    case CLIPPING_WEAK:
        snprintf(text, size, "it looks so: a sun with so small a part of the light is not whole");
        break;
    }
}

static void print_clipping(const inspect_findings *found)
{
    char text[128];
    inspect_clipping_tell(found, text, sizeof text);
    print_label("clipped");
    printf("%s\n", text);
    print_label("advice");
    printf("%s\n", found->advice);
}

int inspect_print(const inspect_findings *found)
{
    print_file(found);
    print_range(found);
    print_flux(found);
    print_bad(found);
    print_spot(found);
    print_clipping(found);
    return EXIT_CODE_OK;
}
