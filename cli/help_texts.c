/* SPDX-License-Identifier: MIT */
#include "help.h"

#include <stdio.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

const char help_tagline[] = "light scenes by importance sampling of environment maps";

static const help_entry source_forms[] = {
    {"FILE", "EXR, Radiance HDR, PFM, PNG or JPEG, told by what the file holds; or a video"},
    {"DIR or face_%s.exr", "six files, one for each face: px nx py ny pz nz and other usual names"},
    {"frame_%04d.exr", "the numbered files that there are, in the order of their numbers"},
    {"'DIR/*.hdr'", "all files that the shell would find, in natural order: 2 before 10"},
    {"sky:lat=44.8,lon=-0.6,date=2026-06-21,time=12:00,turbidity=3,albedo=0.2",
     "a clear sky with its sun; these are the defaults. Also zone=H, disc=0, or azimuth= and elevation= of the sun"},
    {"sky:day", "the same from sunrise to sunset, with --day-frames; takes the other keys after a comma"},
    {"lavfi:GRAPH, v4l2:DEVICE", "FFmpeg's filters and cameras, such as v4l2:/dev/video0"},
    {"constant:R,G,B", "the same light from everywhere, such as constant:1,1,1"},
};

static const help_entry layout_forms[] = {
    {"latlong", "twice as wide as high; top row +Y, centre column +Z, +X a quarter from the left. For maps whose "
                "centre is another direction use --rotate, and for mirrored ones --flip"},
    {"cross-v, cross-h", "six faces of a cube unfolded to 3x4 or 4x3 squares"},
    {"faces", "six files, one for each face"},
    {"strip", "six faces +X -X +Y -Y +Z -Z side by side or stacked, as in the Vulkan and OpenGL cube map tables"},
    {"strip-openexr", "six stacked faces as OpenEXR turns them"},
    {"octahedral, equal-area", "squares with +Y in the centre and -Y in the corners; equal-area as pbrt has it"},
    {"angular, mirrorball", "discs with -Z in the centre: Debevec's light probes, and a photograph of a mirror ball"},
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

static const help_entry picture_forms[] = {
    {"FILE", "one picture: EXR, PFM, PNG, JPEG or Radiance HDR. As REFERENCE also that of a whole sequence"},
    {"out_%04d.exr", "the numbered pictures that there are; those of one number are compared"},
    {"'DIR/*.exr'", "all files that the shell would find, in natural order, with as many others in theirs"},
    {"DIR", "all pictures in it, with those of the same names but for their endings in another one"},
};

const help_section help_forms[] = {
    {"SRC", source_forms, COUNT(source_forms), COMMANDS_OF_SCENES | COMMAND_CONVERT | COMMAND_INSPECT | COMMAND_STUDY},
    {"PICTURE and REFERENCE", picture_forms, COUNT(picture_forms), COMMAND_COMPARE},
    {"--layout L", layout_forms, COUNT(layout_forms),
     COMMANDS_OF_SCENES | COMMAND_CONVERT | COMMAND_INSPECT | COMMAND_STUDY},
    {"--material SPEC", material_forms, COUNT(material_forms), COMMANDS_OF_SCENES | COMMAND_STUDY},
    {"--camera SPEC", camera_forms, COUNT(camera_forms), COMMANDS_OF_SCENES | COMMAND_STUDY},
};
const size_t help_form_count = COUNT(help_forms);

static const help_entry examples[] = {
    {"heliostat render", "the dragon from sunrise to sunset, into heliostat_0000.png and so on"},
    {"heliostat render --out dragon.png", "one picture, in the light of the sunrise that comes with heliostat"},
    {"heliostat render --env 'probes/*.hdr' --out lit.mp4 --contact-sheet lit.png",
     "a sequence of maps to a video, and a sheet of a dozen frames"},
    {"heliostat render --env studio.mov --frames 0..99 --out frames/ --resume",
     "a hundred frames of a video to pictures; the same again goes on where it was stopped"},
    {"heliostat render --env studio.exr --mesh teapot.obj --out teapot.png", "your map, your mesh"},
    {"heliostat render --camera orbit:azimuth=120,elevation=30 --rotate 90 --ground plane --out a.png",
     "walk around it, turn the sky, put it on a plane"},
    {"heliostat render --material ggx:base=1,0.8,0.3,metallic=1,roughness=0.2 --aa 4 --out gold.png",
     "in gold, with smooth edges"},
    {"heliostat render --ground shadow --out shot.exr --aovs",
     "object and shadow with alpha and layers, for compositing"},
    {"heliostat render --strategy light --out light.png --stats light.json", "another strategy, with times and counts"},
    {"heliostat convert studio.exr --to cross-v --out studio.hdr", "another layout, another kind of file"},
    {"heliostat convert probe.hdr --layout angular --to latlong --size 2048x1024 --out probe.exr",
     "a light probe unwrapped"},
    {"heliostat convert studio.exr --env-size 16 --rotate 90 --out faces/",
     "turned, and shrunk without losing the sun, to six files faces/px.exr and so on"},
    {"heliostat convert 'capture/*.hdr' --half --out small/frame_%04d.exr", "a whole sequence"},
    {"heliostat inspect studio.hdr --out studio.png", "what is in a map, in words and as a picture"},
    {"heliostat inspect clip.mov --frames 24..24 --json -", "one frame of a video, for a script"},
    {"heliostat samples --pixel 640,330 --out samples.pdf",
     "where the 64 samples of a pixel are, as the paper's Figure 3"},
    {"heliostat samples --env sky:day --contact-sheet day.png", "the same pixel at six times of a day"},
    {"heliostat samples --strategy face+brdf --json -", "counts and all samples, for a script"},
    {"heliostat compare face.exr reference.exr --out error.png",
     "how far a picture is from its reference, in numbers and as a picture"},
    {"heliostat compare 'face/%04d.exr' 'truth/%04d.exr' --json flicker.json",
     "of a sequence, also how much its error flickers"},
    {"heliostat study --strategies face,face+brdf,light+brdf --spp 4,16,64,256 --envs 'probes/*.hdr'",
     "which strategy is best at equal samples and at equal time: a page of curves, pictures and tables"},
    {"heliostat study --study study.json --resume --out night", "go on with a study whose options are in a file"},
    {"heliostat reference --spp 655000 --out truth.exr --resume",
     "ground truth, by as many samples as the paper took; the same again goes on after a kill"},
    {"heliostat reference --strategy face+brdf --error 0.001 --out truth.exr",
     "until pixels are known to a thousandth, with samples that get there sooner"},
    {"heliostat reference --method quadrature --visibility none --size 640x360 --out exact.exr",
     "the light of every texel, without noise"},
    {"heliostat bench --stages tables,frame --json bench.json", "how fast this machine is"},
};
const help_section help_examples = {"Examples", examples, COUNT(examples), COMMAND_ALL};

static const help_entry exit_codes[] = {
    {"0", "the work is done"},
    {"1", "it failed: one sentence on stderr says why, and no half-written file is left; finished frames of a "
          "sequence stay"},
    {"2", "the command line is wrong; nothing was read or written"},
    {"130", "Ctrl-C stopped it; only frames that were finished are there, a video has those (143: SIGTERM, 129: "
            "SIGHUP)"},
};
const help_section help_exit_codes = {"Exit status", exit_codes, COUNT(exit_codes), COMMAND_ALL};

static const help_entry variables[] = {
    {"HELIOSTAT_ASSETS", "folder that is searched for the map and the dragon that come with heliostat, in place of the "
                         "usual ones"},
    {"HELIOSTAT_ISA", "instruction set that the kernels use, in place of the best that the machine has: scalar, sse2, "
                      "avx2 or avx512 (see heliostat info)"},
};
const help_section help_variables = {"Environment variables", variables, COUNT(variables), COMMAND_ALL};

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
