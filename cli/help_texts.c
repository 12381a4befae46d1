/* SPDX-License-Identifier: MIT */
#include "help.h"

#include <stdio.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

const char help_tagline[] = "light scenes by importance sampling of environment maps";

static const help_entry source_forms[] = {
    {"FILE", "EXR, Radiance HDR, PFM, PNG or JPEG; the kind is told by what the file holds"},
    {"constant:R,G,B", "the same light from everywhere, such as constant:1,1,1"},
};

static const help_entry layout_forms[] = {
    {"latlong", "twice as wide as high; top row +Y, centre column +Z, +X a quarter from the left. For maps whose "
                "centre is another direction use --rotate, and for mirrored ones --flip"},
    {"strip", "six faces +X -X +Y -Y +Z -Z side by side or stacked, as in the Vulkan and OpenGL cube map tables"},
    {"strip-openexr", "six stacked faces as OpenEXR turns them"},
    {"auto", "what the file says, else what its shape tells"},
};

static const help_entry material_forms[] = {
    {"file", "what the mesh brings; where it brings nothing phong:kd=0.5,ks=0.5,n=120"},
    {"diffuse:0.8", "matte, albedo 0.8; also in three numbers, diffuse:0.8,0.2,0.1"},
    {"phong:kd=0.5,ks=0.5,n=120", "matte and glossy parts with kd + ks up to 1, exponent n"},
    {"ggx:base=1,0.8,0.3,metallic=1,roughness=0.2", "the metallic-roughness material of glTF 2.0"},
};

static const help_entry camera_forms[] = {
    {"auto", "the object fills the picture; the same as orbit with its defaults"},
    {"orbit:azimuth=30,elevation=15,distance=1.0,fov=40",
     "around the object: degrees, distance in units of the one where it just fits, vertical field of view; azimuth 0 "
     "looks from +Z, 90 from +X"},
    {"lookat:eye=X,Y,Z,at=X,Y,Z,fov=36",
     "from eye towards at, in metres; without at, towards the middle of the object"},
};

const help_section help_forms[] = {
    {"--env SRC", source_forms, COUNT(source_forms)},
    {"--layout L", layout_forms, COUNT(layout_forms)},
    {"--material SPEC", material_forms, COUNT(material_forms)},
    {"--camera SPEC", camera_forms, COUNT(camera_forms)},
};
const size_t help_form_count = COUNT(help_forms);

static const help_entry examples[] = {
    {"heliostat render", "the dragon under a sunrise, into heliostat.png"},
    {"heliostat render --env studio.exr --mesh teapot.obj --out teapot.png", "your map, your mesh"},
    {"heliostat render --camera orbit:azimuth=120,elevation=30 --rotate 90 --ground plane",
     "walk around it, turn the sky, put it on a plane"},
    {"heliostat render --material ggx:base=1,0.8,0.3,metallic=1,roughness=0.2 --aa 4 --spp 256",
     "in gold, with smooth edges and little noise"},
    {"heliostat render --ground shadow --out shot.exr --aovs",
     "object and shadow with alpha and layers, for compositing"},
    {"heliostat render --strategy light --stats light.json", "another strategy, with times and counts"},
    {"heliostat bench --stages tables,frame --json bench.json", "how fast this machine is"},
};
const help_section help_examples = {"Examples", examples, COUNT(examples)};

static const help_entry exit_codes[] = {
    {"0", "the work is done"},
    {"1", "it failed: one sentence on stderr says why, and no half-written file is left"},
    {"2", "the command line is wrong; nothing was read or written"},
    {"130", "Ctrl-C stopped it; nothing was written (143: SIGTERM, 129: SIGHUP)"},
};
const help_section help_exit_codes = {"Exit status", exit_codes, COUNT(exit_codes)};

static const help_entry variables[] = {
    {"HELIOSTAT_ASSETS", "folder that is searched for the map and the dragon that come with heliostat, in place of the "
                         "usual ones"},
    {"HELIOSTAT_ISA", "instruction set that the kernels use, in place of the best that the machine has: scalar, sse2, "
                      "avx2 or avx512 (see heliostat info)"},
};
const help_section help_variables = {"Environment variables", variables, COUNT(variables)};

void help_sentence(const cli_option *option, char *text, size_t size)
{
    int used = snprintf(text, size, "%s", option->help);
    if (option->choices != NULL && used > 0 && (size_t)used < size) {
        char choices[256];
        option_choices(option, choices, sizeof choices);
        used += snprintf(text + used, size - (size_t)used, " (%s)", choices);
    }
    const char *initial = option_default(option);
    if (initial != NULL && used > 0 && (size_t)used < size)
        snprintf(text + used, size - (size_t)used, " [%s]", initial);
}
