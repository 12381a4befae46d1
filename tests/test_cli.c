/* SPDX-License-Identifier: MIT
 * The program as its users meet it: command lines in; exit codes, sentences and files out. HELIOSTAT_PROGRAM names the
 * program, HELIOSTAT_SOURCE_DIR the sources, for the README and the manual page. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <heliostat/core.h>
#include <heliostat/image.h>

#include <ctype.h>
#include <dirent.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/* A small picture of a small thing under even light: a fraction of a second. */
#define SMALL "render --env constant:1,1,1 --mesh tetrahedron.obj --size 64x48 --env-size 8 --spp 16 "

static char program[4096], root[64], directory[80], out_path[96], err_path[96];
static char out[1 << 17], err[1 << 17];
static rlim_t file_size_limit; /* of the program's files, in bytes; 0: none */

/* ---- running the program ---------------------------------------------------------------- */

static size_t read_text(const char *path, char *text, size_t size)
{
    FILE *stream = fopen(path, "rb");
    if (stream == NULL)
        fail_msg("%s cannot be opened", path);
    size_t length = fread(text, 1, size - 1, stream);
    assert_true(feof(stream));
    fclose(stream);
    text[length] = 0;
    return length;
}

static void redirect(int descriptor, const char *path)
{
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    if (file < 0 || dup2(file, descriptor) < 0)
        _exit(99);
}

/* Starts "heliostat LINE", with the words of line separated by blanks. */
static pid_t start(const char *line)
{
    static char words[4096];
    char *arguments[64] = {program};
    snprintf(words, sizeof words, "%s", line);
    size_t count = 1;
    for (char *word = strtok(words, " "); word != NULL && count < 63; word = strtok(NULL, " "))
        arguments[count++] = word;
    unlink(err_path);
    fflush(NULL);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child != 0)
        return child;
    redirect(STDOUT_FILENO, out_path);
    redirect(STDERR_FILENO, err_path);
    if (file_size_limit > 0) {
        struct rlimit limit = {file_size_limit, file_size_limit};
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    execv(program, arguments);
    _exit(99);
}

/* Exit code, with stdout and stderr in out and err; minus the signal's number where a signal ended the program. */
static int finish(pid_t child)
{
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    read_text(out_path, out, sizeof out);
    read_text(err_path, err, sizeof err);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

static int run(const char *line)
{
    return finish(start(line));
}

static void succeeds(const char *line)
{
    int code = run(line);
    if (code != 0)
        fail_msg("heliostat %s: exit code %d, %s", line, code, err);
}

/* Nothing on stdout, one line on stderr, which starts with the program's name and holds the word. */
static void fails(const char *line, int expected, const char *word)
{
    int code = run(line);
    size_t length = strlen(err);
    bool is_sentence = strncmp(err, "heliostat: ", 11) == 0 && length > 20 && strchr(err, '\n') == err + length - 1;
    if (code != expected || !is_sentence || out[0] != 0 || strstr(err, word) == NULL)
        fail_msg("heliostat %s: exit code %d in place of %d, no \"%s\" in: %s%s", line, code, expected, word, err, out);
}

/* ---- files ---------------------------------------------------------------------------- */

static void write_text(const char *path, const char *text)
{
    FILE *stream = fopen(path, "wb");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0);
    assert_int_equal(fclose(stream), 0);
}

static size_t count_files(void)
{
    DIR *stream = opendir(".");
    assert_non_null(stream);
    size_t count = 0;
    while (readdir(stream) != NULL)
        count++;
    closedir(stream);
    return count - 2; /* . and .. */
}

static bool exists(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0;
}

static bool same_bytes(const char *path, const char *other_path)
{
    static char bytes[1 << 18], other_bytes[1 << 18];
    size_t length = read_text(path, bytes, sizeof bytes);
    return length > 0 && length == read_text(other_path, other_bytes, sizeof other_bytes) &&
           memcmp(bytes, other_bytes, length) == 0;
}

/* Flat faces by normals of their own: without them the shading normals of so coarse a mesh would lose light. */
static void write_tetrahedron(void)
{
    write_text("tetrahedron.obj", "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\n"
                                  "vn -0.57735 0.57735 0.57735\nvn 0.57735 0.57735 -0.57735\n"
                                  "vn 0.57735 -0.57735 0.57735\nvn -0.57735 -0.57735 -0.57735\n"
                                  "f 1//1 3//1 2//1\nf 1//2 4//2 3//2\nf 1//3 2//3 4//3\nf 2//4 3//4 4//4\n");
}

static int set_up(void **state)
{
    (void)state;
    const char *named = getenv("HELIOSTAT_PROGRAM");
    if (named == NULL || realpath(named, program) == NULL) {
        print_error("HELIOSTAT_PROGRAM must name the program to test\n");
        return -1;
    }
    snprintf(root, sizeof root, "/tmp/heliostat-test-cli-XXXXXX");
    if (mkdtemp(root) == NULL)
        return -1;
    snprintf(directory, sizeof directory, "%s/work", root);
    snprintf(out_path, sizeof out_path, "%s/out", root);
    snprintf(err_path, sizeof err_path, "%s/err", root);
    unsetenv("HELIOSTAT_ASSETS");
    return mkdir(directory, 0777) != 0 || chdir(directory) != 0 ? -1 : 0;
}

static void remove_folder(const char *path)
{
    DIR *stream = opendir(path);
    for (struct dirent *entry; stream != NULL && (entry = readdir(stream)) != NULL;) {
        char inner[512];
        snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] != '.' || strlen(entry->d_name) > 2)
            remove(inner);
    }
    if (stream != NULL)
        closedir(stream);
    rmdir(path);
}

static int tear_down(void **state)
{
    (void)state;
    if (chdir("/") != 0)
        return -1;
    remove_folder(directory);
    remove_folder(root);
    return 0;
}

/* Each test starts in a folder that holds nothing but the mesh. */
static int clean(void **state)
{
    (void)state;
    file_size_limit = 0;
    if (chdir("/") != 0)
        return -1;
    remove_folder(directory);
    if (mkdir(directory, 0777) != 0 || chdir(directory) != 0)
        return -1;
    write_tetrahedron();
    return 0;
}

/* Pictures need a build that reads meshes and traces rays. */
/* Pictures are PNG files unless a command line says otherwise. */
static void needs_png(void)
{
#ifndef HELIO_WITH_PNG
    print_message("skipped: this build has no PNG\n");
    skip();
#endif
}

static void needs_renderer(void)
{
#if !defined(HELIO_WITH_EMBREE) || !defined(HELIO_WITH_ASSIMP) || !defined(HELIO_WITH_PNG) ||                          \
    !defined(HELIO_WITH_OPENEXR)
    print_message("skipped: this build renders nothing, or not into every kind of file\n");
    skip();
#endif
}

/* ---- help ------------------------------------------------------------------------------ */

/* Every option of render that the program promises, with values that must work. */
#define ALL_OPTIONS                                                                                                    \
    "--env=constant:1,1,1 --layout=auto --env-size=8 --rotate=-30.5 --flip --intensity=2 --mesh=tetrahedron.obj "      \
    "--material=file --camera=auto --ground=plane --spp=16 --aa=2 --strategy=face+brdf --brdf-share=0.25 "             \
    "--weighting=paper --no-beta --decorrelate=none --visibility=none --seed=7 --size=32x24 --out=all.exr --aovs "     \
    "--background=env --exposure=-1.5 --tonemap=clip --stats=all.json --max-pixels=1 "                                 \
    "--max-mesh-memory=300 --max-mesh-seconds=60 --backend=cpu --threads=2 --verbose"

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
        if (!mentions(out, word + 2))
            fail_msg("render --help does not mention %s", word);
    }
    assert_true(mentions(out, "quiet") && mentions(out, "help"));
    assert_non_null(strstr(out, "[1280x720]"));
    assert_non_null(strstr(out, "\nExamples\n"));
}

static void test_help_fits_100_columns(void **state)
{
    (void)state;
    static const char *const lines[] = {"--help", "render --help", "info --help", "help --help"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        succeeds(lines[i]);
        assert_int_equal(err[0], 0);
        for (const char *line = out; *line != 0; line += strcspn(line, "\n") + 1)
            assert_true(strcspn(line, "\n") <= 100);
    }
}

static void test_every_way_to_ask_for_help(void **state)
{
    (void)state;
    static char by_option[sizeof out];
    succeeds("render --help");
    strcpy(by_option, out);
    succeeds("help render");
    assert_string_equal(out, by_option);
    succeeds("render --spp 3 -h");
    assert_string_equal(out, by_option);
    succeeds("--help");
    strcpy(by_option, out);
    succeeds("help");
    assert_string_equal(out, by_option);
    succeeds("-h");
    assert_string_equal(out, by_option);
    assert_non_null(strstr(out, "render"));
    assert_non_null(strstr(out, "info"));
}

static void test_version_and_info(void **state)
{
    (void)state;
    succeeds("--version");
    assert_string_equal(out, "heliostat " HELIO_VERSION_TEXT "\n");
    succeeds("info");
    static const char *const words[] = {HELIO_VERSION_TEXT, "logical", "isa", "OpenEXR", "assimp", "Embree", "cpu"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        assert_non_null(strstr(out, words[i]));
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
    static char page[sizeof out];
    read_source("docs/heliostat.1", page, sizeof page);
    succeeds("help --man");
    if (strcmp(out, page) != 0)
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
    static char readme[sizeof out], all_help[2 * sizeof out];
    read_source("README.md", readme, sizeof readme);
    succeeds("render --help");
    strcpy(all_help, out);
    succeeds("--help");
    strcat(all_help, out);
    succeeds("help --help");
    strcat(all_help, out);
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

static void test_bad_command_lines_are_refused_in_one_sentence(void **state)
{
    (void)state;
    needs_png();
    static const struct {
        const char *line, *word; /* that the sentence holds */
    } table[] = {
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
        {"render --layout cross-v", "latlong"},
        {"render --weighting equal", "solid-angle or paper"},
        {"render --tonemap filmic", "clip or reinhard"},
        {"render --background black", "env or none"},
        {"render --ground grass", "none, plane or shadow"},
        {"render --visibility all", "none or ray"},
        {"render --decorrelate blue", "hash or none"},
        {"render --backend vulkan", "vulkan"},
        {"render --backend gpu", "gpu"},
        {"render --quiet --verbose", "--verbose"},
        {"render --ground shadow --visibility none", "--visibility ray"},
        {"render --material phong:kd=0.7,ks=0.7", "--material"},
        {"render --material wood", "wood"},
        {"render --camera orbit:azimuth=x", "--camera"},
        {"render --camera lookat:fov=20", "eye"},
        {"render --env sky:day", "sky"},
        {"render --env lavfi:testsrc", "lavfi"},
        {"render --env v4l2:/dev/video0", "camera"},
        {"render --env clip.mp4", "video"},
        {"render --env frame_%04d.exr", "sequence"},
        {"render --env *.hdr", "sequence"},
        {"render --env constant:1,2", "constant:1,2"},
        {"render --env constant:1,2,3,4", "three numbers"},
        {"render --env constant:1,2,-3", "-3"},
        {"render --env constant:1,2,inf", "inf"},
        {"render --out picture.tiff", "picture.tiff"},
        {"render --out picture", "picture"},
        {"render --out frame_%04d.png", "sequence"},
        {"render --aovs", ".exr"},
        {"render --aovs --out picture.pfm", ".exr"},
        {"render --out a.png --stats a.png", "a.png"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++)
        fails(table[i].line, 2, table[i].word);
    assert_int_equal(count_files(), 1);
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
    needs_png();
    write_text("bad.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100 +X 200\n");
    write_text("bad.obj", "this is no mesh\n");
    write_text("folder.txt", "");
    assert_int_equal(mkdir("folder.png", 0777), 0);
    size_t before = count_files();
    fails(SMALL "--env missing.hdr --out a.png", 1, "missing.hdr");
    fails(SMALL "--env bad.hdr --out a.png", 1, "bad.hdr");
    fails(SMALL "--env . --out a.png", 1, ".");
    fails(SMALL "--mesh missing.obj --out a.png", 1, "missing.obj");
    fails(SMALL "--mesh bad.obj --out a.png", 1, "bad.obj");
    fails(SMALL "--out nowhere/a.png", 1, "nowhere/");
    fails(SMALL "--out folder.txt/a.png", 1, "folder.txt");
    fails(SMALL "--out folder.png", 1, "directory");
    fails(SMALL "--out a.png --stats nowhere/a.json", 1, "--stats");
    assert_int_equal(count_files(), before);
    /* An input is never replaced by what is made from it, whatever it is called. */
    write_text("map.pfm", "PF\n1 1\n-1\n............");
    fails("render --env map.pfm --mesh tetrahedron.obj --out ./map.pfm", 1, "replace an input");
    fails(SMALL "--out a.png --stats tetrahedron.obj", 1, "replace an input");
    assert_int_equal(count_files(), before + 1);
}

static void test_options_without_effect_are_told(void **state)
{
    (void)state;
    needs_renderer();
    static const struct {
        const char *line, *word;
    } table[] = {
        {SMALL "--out idle.png --no-beta --strategy light", "--no-beta"},
        {SMALL "--out idle.png --brdf-share 0.2 --strategy face", "--brdf-share"},
        {SMALL "--out idle.png --layout latlong", "--layout"},
        {SMALL "--out idle.exr --exposure 2", "--exposure"},
        {SMALL "--out idle.pfm --ground shadow", "alpha"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        assert_int_equal(run(table[i].line), 0);
        assert_non_null(strstr(err, "warning"));
        assert_non_null(strstr(err, table[i].word));
    }
    assert_int_equal(run(SMALL "--out idle.png --no-beta --brdf-share 0.2 --exposure 1"), 0);
    assert_string_equal(err, "");
}

static void test_missing_assets_are_explained(void **state)
{
    (void)state;
    needs_png();
    setenv("HELIOSTAT_ASSETS", directory, 1);
    int without_map = run("render --mesh tetrahedron.obj");
    bool says_env = strstr(err, "--env") != NULL;
    int without_mesh = run("render --env constant:1,1,1");
    bool says_mesh = strstr(err, "--mesh") != NULL;
    unsetenv("HELIOSTAT_ASSETS");
    assert_int_equal(without_map, 1);
    assert_int_equal(without_mesh, 1);
    assert_true(says_env && says_mesh);
    assert_int_equal(count_files(), 1);
}

static void test_limits_name_their_option(void **state)
{
    (void)state;
    needs_renderer();
    write_text("map.pfm", "PF\n2 1\n-1\n012301230123012301230123");
    fails(SMALL "--env map.pfm --max-pixels 1", 1, "map.pfm is too large: 2 x 1 pixels, where 1 in all are allowed");
    assert_non_null(strstr(err, "--max-pixels"));
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
    needs_renderer();
    static const struct {
        const char *line, *name;
    } table[] = {
        {SMALL "--out a.pfm", "a.pfm"},
        {SMALL "--out a.exr --aovs --size 200x200", "a.exr"},
        {SMALL "--out a.png --size 400x400 --exposure -3", "a.png"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        clean(state);
        write_text(table[i].name, "old");
        file_size_limit = 2000;
        fails(table[i].line, 1, table[i].name);
        expect_old(table[i].name);
        assert_int_equal(count_files(), 2);
    }
}

/* The picture is then written already, and stays. */
static void test_full_disk_leaves_the_old_stats(void **state)
{
    (void)state;
    needs_renderer();
    write_text("a.json", "old");
    file_size_limit = 600;
    fails("render --env constant:1,1,1 --mesh tetrahedron.obj --size 2x2 --env-size 8 -q --out a.pfm --stats a.json", 1,
          "a.json");
    expect_old("a.json");
    assert_int_equal(count_files(), 3);
}

static void test_only_files_are_written_to(void **state)
{
    (void)state;
    needs_renderer();
    assert_int_equal(mkfifo("pipe.png", 0600), 0);
    assert_int_equal(symlink("/dev/full", "full.png"), 0);
    size_t before = count_files();
    fails(SMALL "--out pipe.png", 1, "pipe.png is a device or pipe");
    fails(SMALL "--out full.png", 1, "full.png is a device or pipe");
    fails(SMALL "--stats /dev/full", 1, "/dev/full is a device or pipe");
    assert_int_equal(count_files(), before);
}

/* No file can be made in /proc, not even by the superuser, who otherwise may write everywhere. */
static void test_folders_that_cannot_be_written_are_told(void **state)
{
    (void)state;
    needs_renderer();
    size_t before = count_files();
    fails(SMALL "--out /proc/a.png", 1, "/proc/a.png cannot be written");
    assert_int_equal(count_files(), before);
}

static void wait_for(const char *word)
{
    for (int i = 0; i < 2000; i++) {
        if (exists(err_path) && read_text(err_path, err, sizeof err) > 0 && strstr(err, word) != NULL)
            return;
        usleep(10000);
    }
    fail_msg("the program does not say \"%s\": %s", word, err);
}

static void test_interrupt_stops_without_a_picture(void **state)
{
    (void)state;
    needs_renderer();
    static const struct {
        int number, code;
    } signals[] = {{SIGINT, 130}, {SIGTERM, 143}};
    for (size_t i = 0; i < sizeof signals / sizeof signals[0]; i++) {
        pid_t child = start(SMALL "--spp 1048576 --size 256x256 -v --out a.png --stats a.json");
        wait_for("rendering");
        kill(child, signals[i].number);
        assert_int_equal(finish(child), signals[i].code);
        assert_non_null(strstr(err, "nothing was written to a.png"));
        assert_int_equal(count_files(), 1);
    }
}

static void check_size(const char *path, uint32_t width, uint32_t height)
{
    helio_context *context = NULL;
    helio_image *image = NULL;
    assert_int_equal(helio_context_create(NULL, &context), HELIO_OK);
    if (helio_image_read(context, path, NULL, &image) != HELIO_OK)
        fail_msg("%s", helio_last_error());
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    helio_image_destroy(context, image);
    helio_context_destroy(context);
}

/* Is there a file that is being written? */
static bool sees_temporary(void)
{
    DIR *stream = opendir(".");
    bool found = false;
    for (struct dirent *entry; stream != NULL && (entry = readdir(stream)) != NULL;)
        found |= strncmp(entry->d_name, ".heliostat-", 11) == 0;
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
    pid_t child = start(LONG_WRITE);
    for (int i = 0; i < 12000 && !sees_temporary(); i++)
        usleep(5000);
    return child;
}

static void test_signal_amid_writing_leaves_no_half_picture(void **state)
{
    (void)state;
    needs_renderer();
    pid_t child = start_writing();
    kill(child, SIGTERM);
    int code = finish(child);
    assert_false(sees_temporary());
    assert_int_equal(count_files(), 2);
    if (code == 0)
        check_size("a.exr", 600, 600);
    else
        expect_old("a.exr");
}

static void test_kill_amid_writing_keeps_the_old_picture(void **state)
{
    (void)state;
    needs_renderer();
    pid_t child = start_writing();
    kill(child, SIGKILL);
    assert_int_equal(finish(child), -SIGKILL);
    expect_old("a.exr");
}

/* ---- pictures --------------------------------------------------------------------------- */

static void check_picture(const char *path, float expected, float tolerance)
{
    helio_context *context = NULL;
    helio_image *image = NULL;
    assert_int_equal(helio_context_create(NULL, &context), HELIO_OK);
    if (helio_image_read(context, path, NULL, &image) != HELIO_OK)
        fail_msg("%s", helio_last_error());
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
    needs_renderer();
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out a.pfm");
    assert_non_null(strstr(out, "a.pfm: 64x48"));
    assert_non_null(strstr(out, "cosine"));
    assert_int_equal(err[0], 0);
    check_picture("a.pfm", 1, 1e-3F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out=a.exr --aovs");
    check_picture("a.exr", 1, 1e-3F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out a.png --exposure 0");
    check_picture("a.png", 1, 1e-2F);
    succeeds(SMALL "--material diffuse:1 --strategy cosine --out a.png --exposure -1");
    check_picture("a.png", 0.5F, 1e-2F);
    assert_int_equal(count_files(), 4);
}

/* Automatic exposure follows the map and leaves the intensity visible. */
static void test_exposure_depends_on_the_map_alone(void **state)
{
    (void)state;
    needs_renderer();
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
    needs_renderer();
    check_alpha("", 2);
    check_alpha("--ground plane", 2);
    check_alpha("--background env --ground shadow", 2);
    check_alpha("--background none", 6);
    check_alpha("--ground shadow", 6);
}

static void test_picture_depends_on_the_seed_but_not_on_threads(void **state)
{
    (void)state;
    needs_renderer();
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
    needs_renderer();
    succeeds("render " ALL_OPTIONS);
    assert_true(exists("all.exr") && exists("all.json"));
    assert_non_null(strstr(err, "triangles"));
}

static void test_quiet_is_quiet(void **state)
{
    (void)state;
    needs_renderer();
    succeeds(SMALL "-q");
    assert_int_equal(out[0], 0);
    assert_int_equal(err[0], 0);
    assert_true(exists("heliostat.png"));
}

/* ---- stats ------------------------------------------------------------------------------ */

static double number_of(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_number(value))
        fail_msg("the stats have no number \"%s\"", key);
    return json_number_value(value);
}

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
    helio_context *context;
    assert_int_equal(helio_context_create(NULL, &context), HELIO_OK);
    const char *const words[][2] = {
        {"strategy", "light+brdf"}, {"backend", "cpu"}, {"isa", helio_context_isa(context)}};
    helio_context_destroy(context);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        assert_string_equal(json_string_value(json_object_get(summary, words[i][0])), words[i][1]);
    assert_true(json_string_length(json_object_get(summary, "device")) > 0);
}

static void test_stats_hold_what_is_promised(void **state)
{
    (void)state;
    needs_renderer();
    succeeds(SMALL "--strategy light+brdf --threads 2 --exposure -1.5 --stats a.json");
    json_error_t error;
    json_t *stats = json_load_file("a.json", JSON_REJECT_DUPLICATES, &error);
    if (stats == NULL)
        fail_msg("a.json: %s", error.text);
    const json_t *frames = json_object_get(stats, "frames");
    assert_int_equal(json_array_size(frames), 1);
    check_frame(json_array_get(frames, 0));
    check_summary(json_object_get(stats, "summary"), json_array_get(frames, 0));
    json_decref(stats);
    assert_int_equal(count_files(), 3); /* mesh, picture, stats */
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
    needs_renderer();
    write_bad_map();
    succeeds(SMALL "--env bad.pfm --stats a.json -q");
    assert_non_null(strstr(err, "warning: bad.pfm has 2 bad pixels: 1 NaN and 0 infinite"));
    assert_true(strchr(err, '\n') == err + strlen(err) - 1);
    json_t *stats = json_load_file("a.json", 0, NULL);
    const json_t *bad = json_object_get(json_array_get(json_object_get(stats, "frames"), 0), "bad_texels");
    assert_true(number_of(bad, "nan") == 1 && number_of(bad, "inf") == 0);
    assert_true(number_of(bad, "negative") == 1 && number_of(bad, "out_of_gamut") == 0);
    json_decref(stats);
}

#define TEST(name) cmocka_unit_test_setup(test_##name, clean)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(help_of_render_mentions_every_option),
        TEST(help_fits_100_columns),
        TEST(every_way_to_ask_for_help),
        TEST(version_and_info),
        TEST(manual_page_is_up_to_date),
        TEST(readme_names_only_options_that_exist),
        TEST(bad_command_lines_are_refused_in_one_sentence),
        TEST(usage_errors_come_before_files),
        TEST(failures_exit_1_and_leave_nothing),
        TEST(options_without_effect_are_told),
        TEST(missing_assets_are_explained),
        TEST(limits_name_their_option),
        TEST(full_disk_leaves_the_old_picture),
        TEST(full_disk_leaves_the_old_stats),
        TEST(only_files_are_written_to),
        TEST(folders_that_cannot_be_written_are_told),
        TEST(interrupt_stops_without_a_picture),
        TEST(signal_amid_writing_leaves_no_half_picture),
        TEST(kill_amid_writing_keeps_the_old_picture),
        TEST(white_furnace_in_all_formats),
        TEST(exposure_depends_on_the_map_alone),
        TEST(png_has_alpha_where_it_means_something),
        TEST(picture_depends_on_the_seed_but_not_on_threads),
        TEST(all_options_together),
        TEST(quiet_is_quiet),
        TEST(stats_hold_what_is_promised),
        TEST(bad_texels_are_counted_and_told),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
