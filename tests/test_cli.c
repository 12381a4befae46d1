/* SPDX-License-Identifier: MIT
 * The program as its users meet it: command lines in; exit codes, sentences and files out. HELIOSTAT_SOURCE_DIR names
 * the sources, for the README and the manual page. */
#include "program.h"

#include <heliostat/image.h>

#include <ctype.h>
#include <dirent.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* A small picture of a small thing under even light: a fraction of a second. */
#define SMALL "render --env constant:1,1,1 --mesh tetrahedron.obj --size 64x48 --env-size 8 --spp 16 "

static bool same_bytes(const char *path, const char *other_path)
{
    static char bytes[1 << 18], other_bytes[1 << 18];
    size_t length = read_text(path, bytes, sizeof bytes);
    return length > 0 && length == read_text(other_path, other_bytes, sizeof other_bytes) &&
           memcmp(bytes, other_bytes, length) == 0;
}

/* ---- help ------------------------------------------------------------------------------ */

/* Every option of render that the program promises, with values that must work. */
#define ALL_OPTIONS                                                                                                    \
    "--env=constant:1,1,1 --layout=auto --env-size=8 --rotate=-30.5 --flip --intensity=2 --mesh=tetrahedron.obj "      \
    "--material=file --camera=auto --ground=plane --spp=16 --aa=2 --strategy=face+brdf --brdf-share=0.25 "             \
    "--pool-length=256 --bins=8 --weighting=paper --no-beta --decorrelate=none --visibility=none --seed=7 "            \
    "--size=32x24 --out=all.exr --aovs "                                                                               \
    "--background=env --exposure=-1.5 --tonemap=clip --stats=all.json --max-pixels=1 "                                 \
    "--frames=0..0 --day-frames=9 --on-missing=hold --transfer=pq --fps=30 --codec=ffv1 --quality=0.5 --hdr "          \
    "--contact-sheet=sheet.png --reference=reference.pfm --resume --seed-mode=frame "                                  \
    "--max-mesh-memory=300 --max-mesh-seconds=60 --backend=cpu --device=any --threads=2 --verbose"

/* Is --name there as a word of its own? */
static bool mentions(const char *text, const char *name)
{
    char word[64];
    snprintf(word, sizeof word, "--%s", name);
    for (const char *hit = strstr(text, word); hit != NULL; hit = strstr(hit + 1, word)) {
        char next = hit[strlen(word)];
        if (next != '-' && !isalnum((unsigned char)next))
            return true;
    }
    return false;
}

static void test_help_of_render_mentions_every_option(void **state)
{
    (void)state;
    succeeds("render --help");
    char words[] = ALL_OPTIONS;
    for (char *word = strtok(words, " "); word != NULL; word = strtok(NULL, " ")) {
        word[strcspn(word, "=")] = 0;
        if (!mentions(program_out, word + 2))
            fail_msg("render --help does not mention %s", word);
    }
    assert_true(mentions(program_out, "quiet") && mentions(program_out, "help"));
    assert_non_null(strstr(program_out, "[1280x720]"));
    assert_non_null(strstr(program_out, "\nExamples\n"));
}

static void test_help_fits_100_columns(void **state)
{
    (void)state;
    static const char *const lines[] = {"--help",         "render --help", "convert --help", "inspect --help",
                                        "compare --help", "bench --help",  "info --help",    "help --help"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        succeeds(lines[i]);
        assert_int_equal(program_err[0], 0);
        for (const char *line = program_out; *line != 0; line += strcspn(line, "\n") + 1)
            assert_true(strcspn(line, "\n") <= 100);
    }
}

static void test_every_way_to_ask_for_help(void **state)
{
    (void)state;
    static char by_option[sizeof program_out];
    succeeds("render --help");
    strcpy(by_option, program_out);
    succeeds("help render");
    assert_string_equal(program_out, by_option);
    succeeds("render --spp 3 -h");
    assert_string_equal(program_out, by_option);
    succeeds("--help");
    strcpy(by_option, program_out);
    succeeds("help");
    assert_string_equal(program_out, by_option);
    succeeds("-h");
    assert_string_equal(program_out, by_option);
    assert_non_null(strstr(program_out, "render"));
    assert_non_null(strstr(program_out, "info"));
}

static void test_version_and_info(void **state)
{
    (void)state;
    succeeds("--version");
    assert_string_equal(program_out, "heliostat " HELIO_VERSION_TEXT "\n");
    succeeds("info");
    static const char *const words[] = {HELIO_VERSION_TEXT, "logical", "isa",    "OpenEXR",
                                        "FFmpeg",           "assimp",  "Embree", "cpu"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        assert_non_null(strstr(program_out, words[i]));
}

/* Reads a file of the sources; skips the test where they are not named. */
static void read_source(const char *name, char *text, size_t size)
{
    const char *sources = getenv("HELIOSTAT_SOURCE_DIR");
    if (sources == NULL) {
        print_message("skipped: HELIOSTAT_SOURCE_DIR is not set\n");
        skip();
        return;
    }
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", sources, name);
    read_text(path, text, size);
}

static void test_manual_page_is_up_to_date(void **state)
{
    (void)state;
    static char page[sizeof program_out];
    read_source("docs/heliostat.1", page, sizeof page);
    succeeds("help --man");
    if (strcmp(program_out, page) != 0)
        fail_msg("docs/heliostat.1 is old: write it anew by heliostat help --man > docs/heliostat.1");
}

/* Lines about other programs have options of their own. */
static bool is_about_another_program(const char *line)
{
    static const char *const programs[] = {"cmake", "git ", "apt", "ctest"};
    for (size_t i = 0; i < sizeof programs / sizeof programs[0]; i++)
        if (strstr(line, programs[i]) != NULL)
            return true;
    return false;
}

static void test_readme_names_only_options_that_exist(void **state)
{
    (void)state;
    static const char *const lines[] = {"render --help", "study --help", "--help", "help --help"};
    enum { LINES = sizeof lines / sizeof lines[0] };
    static char readme[sizeof program_out], all_help[LINES * sizeof program_out];
    read_source("README.md", readme, sizeof readme);
    for (size_t i = 0; i < LINES; i++) {
        succeeds(lines[i]);
        strcat(all_help, program_out);
    }
    for (char *line = strtok(readme, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        if (is_about_another_program(line))
            continue;
        for (const char *dashes = strstr(line, "--"); dashes != NULL; dashes = strstr(dashes + 2, "--")) {
            char name[64] = "";
            size_t length = strspn(dashes + 2, "abcdefghijklmnopqrstuvwxyz0123456789-");
            bool starts_word = dashes == line || strchr(" `(/['\"", dashes[-1]) != NULL;
            if (!starts_word || !isalpha((unsigned char)dashes[2]) || length >= sizeof name)
                continue;
            memcpy(name, dashes + 2, length);
            if (!mentions(all_help, name))
                fail_msg("README.md speaks of --%s, which is no option: %s", name, line);
        }
    }
}

/* ---- usage errors ----------------------------------------------------------------------- */

static const struct {
    const char *line, *word; /* that the sentence holds */
} bad_lines[] = {
    {"", "command"},
    {"rendr", "did you mean render?"},
    {"paint", "--help"},
    {"--spp 3", "command comes first"},
    {"help rendr", "did you mean render?"},
    {"help --man render", "--man"},
    {"info --spp 3", "--spp"},
    {"info now", "now"},
    {"render --envsize 4", "did you mean --env-size?"},
    {"render --stratgy face", "did you mean --strategy?"},
    {"render --quux", "render --help"},
    {"render --man", "--man"},
    {"render -x", "-x"},
    {"render --", "--"},
    {"render map.hdr", "--env"},
    {"render --spp", "--spp N"},
    {"render --env --mesh a.obj", "--env=--mesh"},
    {"render --env=", "--env"},
    {"render --flip=1", "--flip"},
    {"render --no-beta=yes", "--no-beta"},
    {"render --spp 0", "1 to 1048576"},
    {"render --spp 1048577", "1048577"},
    {"render --spp 12x", "12x"},
    {"render --spp=-3", "-3"},
    {"render --spp 1e3", "1e3"},
    {"render --spp 99999999999999999999999", "9999"},
    {"render --aa 0", "1 to 4096"},
    {"render --seed 4294967296", "4294967295"},
    {"render --threads 0", "1 to 1024"},
    {"render --env-size 4097", "4096"},
    {"render --pool-length 1000", "--pool-length takes a power of two from 64 to 65536, not '1000'"},
    {"render --pool-length 32", "--pool-length"},
    {"render --pool-length 131072", "--pool-length"},
    {"render --bins 33", "--bins takes a whole number from 1 to 32, not '33'"},
    {"render --size 640", "1280x720"},
    {"render --size 640x", "640x"},
    {"render --size 640x480x3", "640x480x3"},
    {"render --size 0x480", "16384"},
    {"render --size 640X480", "640X480"},
    {"render --size 16385x1", "16384"},
    {"render --rotate nan", "nan"},
    {"render --rotate 0x10", "0x10"},
    {"render --rotate 1e999", "1e999"},
    {"render --rotate 90deg", "90deg"},
    {"render --intensity 0", "--intensity"},
    {"render --intensity -1", "-1"},
    {"render --brdf-share 1", "0.999"},
    {"render --max-pixels 0", "1 to 268435456"},
    {"render --max-pixels 8192x8192", "8192x8192"},
    {"render --max-mesh-memory 0", "1 to 16777216"},
    {"render --max-mesh-seconds 1.5", "1.5"},
    {"render --exposure bright", "auto"},
    {"render --exposure inf", "inf"},
    {"render --strategy faces", "face+brdf"},
    {"render --layout cross", "latlong"},
    {"render --weighting equal", "solid-angle, paper or compensated"},
    {"render --weighting compensated", "take light+brdf or face+brdf"},
    {"render --tonemap filmic", "clip or reinhard"},
    {"render --background black", "env or none"},
    {"render --ground grass", "none, plane or shadow"},
    {"render --visibility all", "none or ray"},
    {"render --decorrelate blue", "hash or none"},
    {"samples --backend vulkan", "vulkan"},
    {"bench --stages device", "backend"},
    {"render --backend gpu", "gpu"},
    {"render --quiet --verbose", "--verbose"},
    {"render --ground shadow --visibility none", "--visibility ray"},
    {"render --material phong:kd=0.7,ks=0.7", "--material"},
    {"render --material wood", "wood"},
    {"render --camera orbit:azimuth=x", "--camera"},
    {"render --camera lookat:fov=20", "eye"},
    {"render --env sky:noon", "sky:noon"},
    {"render --env sky:lat=91", "91"},
    {"render --env sky:day --out a.png", "many frames"},
    {"render --env frame_%n.exr", "frame_%n.exr"},
    {"render --day-frames 0", "1 to 1000000"},
    {"render --on-missing wait", "skip, hold or stop"},
    {"render --transfer gamma", "sdr"},
    {"render --fps 0", "--fps"},
    {"render --codec mpeg2", "hevc"},
    {"render --quality 2", "0.01 to 1"},
    {"render --seed-mode random", "fixed or frame"},
    {"render --frames 3..", "first..last"},
    {"render --contact-sheet a.exr", ".png"},
    {"render --contact-sheet a.png --out a.png", "a.png"},
    {"render --env constant:1,2", "constant:1,2"},
    {"render --env constant:1,2,3,4", "3 numbers"},
    {"render --env constant:1,2,-3", "-3"},
    {"render --env constant:1,2,inf", "inf"},
    {"render --out picture.tiff", "picture.tiff"},
    {"render --out picture", "picture"},
    {"render --out frame_%04d_%d.png", "one number"},
    {"render --out clip.avi", "clip.avi"},
    {"render --aovs", ".exr"},
    {"render --aovs --out picture.pfm", ".exr"},
    {"render --out a.png --stats a.png", "a.png"},
};

static void test_bad_command_lines_are_refused_in_one_sentence(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    for (size_t i = 0; i < sizeof bad_lines / sizeof bad_lines[0]; i++)
        fails(bad_lines[i].line, 2, bad_lines[i].word);
    assert_int_equal(count_files("."), 1);
}

/* Usage errors come before files: the files named here do not exist. */
static void test_usage_errors_come_before_files(void **state)
{
    (void)state;
    fails("render --env none.hdr --mesh none.obj --spp 0", 2, "--spp");
    fails("render --env none.hdr --mesh none.obj --out x.gif", 2, "x.gif");
    fails("render --env none.hdr --mesh none.obj --camera orbit:fov=0", 2, "fov");
}

/* ---- failures --------------------------------------------------------------------------- */

static void test_failures_exit_1_and_leave_nothing(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    write_text("bad.obj", "this is no mesh\n");
    write_text("folder.txt", "");
    assert_int_equal(mkdir("folder.png", 0777), 0);
    size_t before = count_files(".");
    fails(SMALL "--env missing.hdr --out a.png", 1, "missing.hdr");
    fails(SMALL "--env . --out a.png", 1, ".");
    fails(SMALL "--mesh missing.obj --out a.png", 1, "missing.obj");
    fails(SMALL "--mesh bad.obj --out a.png", 1, "bad.obj");
    fails(SMALL "--out nowhere/a.png", 1, "nowhere/");
    fails(SMALL "--out folder.txt/a.png", 1, "folder.txt");
    fails(SMALL "--out folder.png", 1, "directory");
    fails(SMALL "--out a.png --stats nowhere/a.json", 1, "--stats");
    assert_int_equal(count_files("."), before);
    /* An input is never replaced by what is made from it, whatever it is called. */
    write_text("map.pfm", "PF\n1 1\n-1\n............");
    fails("render --env map.pfm --mesh tetrahedron.obj --out ./map.pfm", 1, "replace an input");
    fails(SMALL "--out a.png --stats tetrahedron.obj", 1, "replace an input");
    assert_int_equal(count_files("."), before + 1);
}

/* Pixels are read when there is something to light by them. */
static void test_damaged_maps_exit_1_and_leave_nothing(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_text("bad.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100 +X 200\n");
    size_t before = count_files(".");
    fails(SMALL "--env bad.hdr --out a.png", 1, "bad.hdr");
    assert_int_equal(count_files("."), before);
}

static void test_options_without_effect_are_told(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    static const struct {
        const char *line, *word;
    } table[] = {
        {SMALL "--out idle.png --no-beta --strategy light", "--no-beta"},
        {SMALL "--out idle.png --brdf-share 0.2 --strategy face", "--brdf-share"},
        {SMALL "--out idle.png --bins 4 --strategy face", "--bins"},
        {SMALL "--out idle.png --layout latlong", "--layout"},
        {SMALL "--out idle.exr --exposure 2", "--exposure"},
        {SMALL "--out idle.pfm --ground shadow", "alpha"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        assert_int_equal(run_program(table[i].line), 0);
        assert_non_null(strstr(program_err, "warning"));
        assert_non_null(strstr(program_err, table[i].word));
    }
    assert_int_equal(run_program(SMALL "--out idle.png --strategy face+brdf --no-beta --brdf-share 0.2 --exposure 1"),
                     0);
    assert_string_equal(program_err, "");
}

static void test_missing_assets_are_explained(void **state)
{
    (void)state;
    skip_without(NEEDS_PNG);
    setenv("HELIOSTAT_ASSETS", ".", 1);
    int without_map = run_program("render --mesh tetrahedron.obj --out a.png");
    bool says_env = strstr(program_err, "--env") != NULL;
    int without_mesh = run_program("render --env constant:1,1,1");
    bool says_mesh = strstr(program_err, "--mesh") != NULL;
    unsetenv("HELIOSTAT_ASSETS");
    assert_int_equal(without_map, 1);
    assert_int_equal(without_mesh, 1);
    assert_true(says_env && says_mesh);
    assert_int_equal(count_files("."), 1);
}

static void test_limits_name_their_option(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    write_text("map.pfm", "PF\n2 1\n-1\n012301230123012301230123");
    fails(SMALL "--env map.pfm --max-pixels 1", 1, "map.pfm is too large: 2 x 1 pixels, where 1 in all are allowed");
    assert_non_null(strstr(program_err, "--max-pixels"));
    succeeds(SMALL "--env map.pfm --max-pixels 2");
}

static void expect_old(const char *path)
{
    char text[8];
    assert_int_equal(read_text(path, text, sizeof text), 3);
    assert_string_equal(text, "old");
}

/* What a full disk does, by a limit on the size of files. */
static void test_full_disk_leaves_the_old_picture(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    static const struct {
        const char *line, *name;
    } table[] = {
        {SMALL "--out a.pfm", "a.pfm"},
        {SMALL "--out a.exr --aovs --size 200x200", "a.exr"},
        {SMALL "--out a.png --size 400x400 --exposure -3", "a.png"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        set_up_folder(state);
        write_text(table[i].name, "old");
        program_limits.file_size = 2000;
        fails(table[i].line, 1, table[i].name);
        expect_old(table[i].name);
        assert_int_equal(count_files("."), 2);
    }
}

/* The picture is then written already, and stays. */
static void test_full_disk_leaves_the_old_stats(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    write_text("a.json", "old");
    program_limits.file_size = 600;
    fails("render --env constant:1,1,1 --mesh tetrahedron.obj --size 2x2 --env-size 8 -q --out a.pfm --stats a.json", 1,
          "a.json");
    expect_old("a.json");
    assert_int_equal(count_files("."), 3);
}

static void test_only_files_are_written_to(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    assert_int_equal(mkfifo("pipe.png", 0600), 0);
    assert_int_equal(symlink("/dev/full", "full.png"), 0);
    size_t before = count_files(".");
    fails(SMALL "--out pipe.png", 1, "pipe.png is a device or pipe");
    fails(SMALL "--out full.png", 1, "full.png is a device or pipe");
    fails(SMALL "--stats /dev/full", 1, "/dev/full is a device or pipe");
    assert_int_equal(count_files("."), before);
}

/* No file can be made in /proc, not even by the superuser, who otherwise may write everywhere. */
static void test_folders_that_cannot_be_written_are_told(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    size_t before = count_files(".");
    fails(SMALL "--out /proc/a.png", 1, "/proc/a.png cannot be written");
    assert_int_equal(count_files("."), before);
}

static void test_interrupt_stops_without_a_picture(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    static const struct {
        int number, code;
    } signals[] = {{SIGINT, 130}, {SIGTERM, 143}};
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++) {
        pid_t child = start_program(SMALL "--spp 1048576 --size 256x256 -v --out a.png --stats a.json");
        bool has_begun = program_says("rendering");
        kill(child, signals[i].number);
        assert_int_equal(finish_program(child, NULL), signals[i].code);
        assert_true(has_begun);
        assert_non_null(strstr(program_err, "nothing was written to a.png"));
        assert_int_equal(count_files("."), 1);
    }
}

static void check_size(const char *path, uint32_t width, uint32_t height)
{
    helio_context *context = make_context(0, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

/* Has the program opened a file here that it writes? Until the file is whole, it may have no name. */
static bool is_writing(pid_t child)
{
    char folder[64], here[4096], path[4096];
    snprintf(folder, sizeof folder, "/proc/%ld/fd", (long)child);
    assert_non_null(getcwd(here, sizeof here));
    DIR *stream = opendir(folder);
    bool found = false;
    for (struct dirent *entry; stream != NULL && (entry = readdir(stream)) != NULL;) {
        ssize_t length = readlinkat(dirfd(stream), entry->d_name, path, sizeof path - 1);
        path[length > 0 ? length : 0] = 0;
        found |= strncmp(path, here, strlen(here)) == 0 && strstr(path, "tetrahedron.obj") == NULL;
    }
    if (stream != NULL)
        closedir(stream);
    return found;
}

/* Long enough in writing, so that signals arrive amid it. */
#define LONG_WRITE                                                                                                     \
    "render --env constant:1,1,1 --mesh tetrahedron.obj --size 600x600 --env-size 8 --spp 1 --visibility none "        \
    "--aovs --out a.exr"

static pid_t start_writing(void)
{
    write_text("a.exr", "old");
    pid_t child = start_program(LONG_WRITE);
    for (int i = 0; i < 12000 && !is_writing(child); i++)
        usleep(5000);
    return child;
}

static void test_signal_amid_writing_leaves_no_half_picture(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    pid_t child = start_writing();
    kill(child, SIGTERM);
    int code = finish_program(child, NULL);
    assert_int_equal(count_files("."), 2);
    if (code == 0)
        check_size("a.exr", 600, 600);
    else
        expect_old("a.exr");
}

static void test_kill_amid_writing_keeps_the_old_picture(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    pid_t child = start_writing();
    kill(child, SIGKILL);
    assert_int_equal(finish_program(child, NULL), -SIGKILL);
    expect_old("a.exr");
}

/* ---- pictures --------------------------------------------------------------------------- */

static void check_picture(const char *path, float expected, float tolerance)
{
    helio_context *context = make_context(0, NULL);
    helio_image *image;
    assert_ok(helio_image_read(context, path, NULL, &image));
    assert_int_equal(image->width, 64);
    assert_int_equal(image->height, 48);
    for (size_t i = 0; i < (size_t)64 * 48 * 3; i++)
        if (!(fabsf(image->rgb[i] - expected) <= tolerance))
            fail_msg("%s: pixel %zu is %g, not %g", path, i / 3, (double)image->rgb[i], (double)expected);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

/* A white object in even light cannot be told from what is behind it. */
static void test_white_furnace_in_all_formats(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out a.pfm");
    assert_non_null(strstr(program_out, "a.pfm: 64x48"));
    assert_non_null(strstr(program_out, "cosine"));
    assert_int_equal(program_err[0], 0);
    check_picture("a.pfm", 1, 1e-3F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out=a.exr --aovs");
    check_picture("a.exr", 1, 1e-3F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out a.png --exposure 0");
    check_picture("a.png", 1, 1e-2F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out a.png --exposure -1");
    check_picture("a.png", 0.5F, 1e-2F);
    assert_int_equal(count_files("."), 4);
}

/* Automatic exposure follows the map and leaves the intensity visible. */
static void test_exposure_depends_on_the_map_alone(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --env constant:37,37,37 --out a.png");
    check_picture("a.png", 0.8F, 1e-2F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --intensity 0.5 --out a.png");
    check_picture("a.png", 0.4F, 1e-2F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --intensity 2 --out a.pfm");
    check_picture("a.pfm", 2, 2e-3F);
}

/* The colour type of a PNG stands in its 26th byte: 2 for RGB, 6 for RGBA. */
static void check_alpha(const char *options, int colour_type)
{
    char line[512];
    static char bytes[1 << 18];
    snprintf(line, sizeof line, SMALL "%s", options);
    succeeds(line);
    assert_true(read_text("heliostat.png", bytes, sizeof bytes) > 26);
    assert_memory_equal(bytes, "\x89PNG", 4);
    assert_int_equal(bytes[25], colour_type);
}

static void test_png_has_alpha_where_it_means_something(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    check_alpha("", 2);
    check_alpha("--ground plane", 2);
    check_alpha("--background env --ground shadow", 2);
    check_alpha("--background none", 6);
    check_alpha("--ground shadow", 6);
}

static void test_picture_depends_on_the_seed_but_not_on_threads(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    succeeds(SMALL "--threads 1 --seed 5 --out a.pfm");
    succeeds(SMALL "--threads 2 --seed 5 --out b.pfm");
    succeeds(SMALL "--threads 2 --seed 5 --out c.pfm");
    succeeds(SMALL "--threads 2 --seed 6 --out d.pfm");
    assert_true(same_bytes("a.pfm", "b.pfm"));
    assert_true(same_bytes("b.pfm", "c.pfm"));
    assert_false(same_bytes("a.pfm", "d.pfm"));
    succeeds(SMALL "--seed 5 --out a.png");
    succeeds(SMALL "--seed 5 --out b.png");
    assert_true(same_bytes("a.png", "b.png"));
}

static void test_all_options_together(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    static const float black[24][32][4];
    const helio_picture reference = {.width = 32, .height = 24, .rgba = black[0][0]};
    helio_context *context = make_context(1, NULL);
    assert_ok(helio_picture_write(context, "reference.pfm", &reference, NULL));
    helio_context_destroy(context);
    succeeds("render " ALL_OPTIONS);
    assert_true(exists("all.exr") && exists("all.json"));
    assert_non_null(strstr(program_err, "triangles"));
}

static void test_quiet_is_quiet(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    succeeds(SMALL "-q");
    assert_int_equal(program_out[0], 0);
    assert_int_equal(program_err[0], 0);
    assert_true(exists("heliostat.png"));
}

/* ---- stats ------------------------------------------------------------------------------ */

static void check_times(const json_t *frame)
{
    static const char *const stages[] = {"source_ms",  "cube_ms",  "tables_ms", "pools_ms",
                                         "primary_ms", "shade_ms", "write_ms"};
    double sum = 0, total = number_of(frame, "total_ms");
    for (size_t i = 0; i < sizeof stages / sizeof stages[0]; i++) {
        double time = number_of(frame, stages[i]);
        assert_true(time >= 0 && time <= total);
        sum += time;
    }
    assert_true(sum > 0 && sum <= total + 0.01);
}

static void check_frame(const json_t *frame)
{
    check_times(frame);
    double samples = number_of(frame, "samples"), useful = number_of(frame, "samples_useful");
    assert_true(number_of(frame, "index") == 0);
    assert_true(samples > 0 && samples <= 64 * 48 * 16 && useful > 0 && useful <= samples);
    assert_true(fabs(number_of(frame, "flux") - 4 * 3.14159265358979) < 1e-4);
    static const char *const kinds[] = {"nan", "inf", "negative", "out_of_gamut"};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        assert_true(number_of(json_object_get(frame, "bad_texels"), kinds[i]) == 0);
}

static void check_summary(const json_t *summary, const json_t *frame)
{
    assert_true(number_of(summary, "frames") == 1);
    assert_true(number_of(summary, "spp") == 16);
    assert_true(number_of(summary, "passes") == 1);
    assert_true(number_of(summary, "threads") == 2);
    assert_true(number_of(summary, "ev") == -1.5);
    double seconds = number_of(frame, "total_ms") / 1e3;
    assert_true(fabs(number_of(summary, "fps") * seconds - 1) < 1e-3);
    assert_true(fabs(number_of(summary, "samples_per_second") * seconds / number_of(frame, "samples") - 1) < 1e-3);
    const json_t *size = json_object_get(summary, "size");
    assert_int_equal(json_array_size(size), 2);
    assert_int_equal(json_integer_value(json_array_get(size, 0)), 64);
    assert_int_equal(json_integer_value(json_array_get(size, 1)), 48);
    helio_context *context = make_context(0, NULL);
    const char *const words[][2] = {
        {"strategy", "light+brdf"}, {"backend", "cpu"}, {"isa", helio_context_isa(context)}};
    helio_context_destroy(context);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        assert_string_equal(text_of(summary, words[i][0]), words[i][1]);
    assert_true(json_string_length(json_object_get(summary, "device")) > 0);
}

static void test_stats_hold_what_is_promised(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    succeeds(SMALL "--strategy light+brdf --threads 2 --exposure -1.5 --stats a.json");
    json_t *stats = load_json("a.json");
    const json_t *frames = json_object_get(stats, "frames");
    assert_int_equal(json_array_size(frames), 1);
    check_frame(json_array_get(frames, 0));
    check_summary(json_object_get(stats, "summary"), json_array_get(frames, 0));
    json_decref(stats);
    assert_int_equal(count_files("."), 3); /* mesh, picture, stats */
}

static void test_stats_are_printed_alone(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    static const char *const lines[] = {SMALL "--stats -", SMALL "--stats", SMALL "--stats --out heliostat.png"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        succeeds(lines[i]);
        json_t *stats = json_loads(program_out, JSON_REJECT_DUPLICATES, NULL);
        assert_int_equal(json_array_size(member(stats, "frames")), 1);
        json_decref(stats);
        assert_int_equal(count_files("."), 2); /* mesh, picture */
    }
}

/* A map of 2 x 1 pixels as PFM: one is NaN, the other has a negative channel. */
static void write_bad_map(void)
{
    const float rgb[6] = {NAN, 1, 1, 1, -1, 1};
    const uint16_t probe = 1;
    FILE *stream = fopen("bad.pfm", "wb");
    assert_non_null(stream);
    fprintf(stream, "PF\n2 1\n%s\n", *(const unsigned char *)&probe ? "-1.0" : "1.0");
    assert_int_equal(fwrite(rgb, sizeof rgb, 1, stream), 1);
    fclose(stream);
}

static void test_bad_texels_are_counted_and_told(void **state)
{
    (void)state;
    skip_without(NEEDS_ALL);
    write_bad_map();
    succeeds(SMALL "--env bad.pfm --stats a.json -q");
    assert_non_null(strstr(program_err, "warning: bad.pfm has 2 bad pixels: 1 NaN (taken as black), 1 negative "));
    assert_true(strchr(program_err, '\n') == program_err + strlen(program_err) - 1);
    json_t *stats = load_json("a.json");
    const json_t *bad = json_object_get(json_array_get(json_object_get(stats, "frames"), 0), "bad_texels");
    assert_true(number_of(bad, "nan") == 1 && number_of(bad, "inf") == 0);
    assert_true(number_of(bad, "negative") == 1 && number_of(bad, "out_of_gamut") == 0);
    json_decref(stats);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        program_test(test_help_of_render_mentions_every_option),
        program_test(test_help_fits_100_columns),
        program_test(test_every_way_to_ask_for_help),
        program_test(test_version_and_info),
        program_test(test_manual_page_is_up_to_date),
        program_test(test_readme_names_only_options_that_exist),
        program_test(test_bad_command_lines_are_refused_in_one_sentence),
        program_test(test_usage_errors_come_before_files),
        program_test(test_failures_exit_1_and_leave_nothing),
        program_test(test_damaged_maps_exit_1_and_leave_nothing),
        program_test(test_options_without_effect_are_told),
        program_test(test_missing_assets_are_explained),
        program_test(test_limits_name_their_option),
        program_test(test_full_disk_leaves_the_old_picture),
        program_test(test_full_disk_leaves_the_old_stats),
        program_test(test_only_files_are_written_to),
        program_test(test_folders_that_cannot_be_written_are_told),
        program_test(test_interrupt_stops_without_a_picture),
        program_test(test_signal_amid_writing_leaves_no_half_picture),
        program_test(test_kill_amid_writing_keeps_the_old_picture),
        program_test(test_white_furnace_in_all_formats),
        program_test(test_exposure_depends_on_the_map_alone),
        program_test(test_png_has_alpha_where_it_means_something),
        program_test(test_picture_depends_on_the_seed_but_not_on_threads),
        program_test(test_all_options_together),
        program_test(test_quiet_is_quiet),
        program_test(test_stats_hold_what_is_promised),
        program_test(test_stats_are_printed_alone),
        program_test(test_bad_texels_are_counted_and_told),
    };
    return cmocka_run_group_tests(tests, set_up_program, tear_down_program);
}
