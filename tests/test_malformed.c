/* SPDX-License-Identifier: MIT
 * The program and files that are damaged, or made to do harm: a picture and exit code 0, or one sentence and exit code
 * 1; never a crash, a hang, gigabytes, or a file left behind. HELIOSTAT_PROGRAM names the program. */
#include "support.h"

#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    MOST_KIB = 2 << 20, /* 2 GiB, of the program and of each process that it makes */
    MOST_SECONDS = 10,  /* of processor time, which does not depend on what else the machine does */
    HANG_SECONDS = 120  /* by the clock: only keeps a test that hangs from lasting for ever */
};

static char program[TEST_PATH_SIZE], root[TEST_PATH_SIZE], inputs[TEST_PATH_SIZE + 16], work[TEST_PATH_SIZE + 16];
static char errors_path[TEST_PATH_SIZE + 16], errors[1 << 16];
static const char *mesh_seconds = "8"; /* the program's own limit for small files */

static int set_up(void **state)
{
    (void)state;
    const char *named = getenv("HELIOSTAT_PROGRAM");
    if (named == NULL || realpath(named, program) == NULL) {
        print_error("HELIOSTAT_PROGRAM must name the program to test\n");
        return -1;
    }
    make_directory(root);
    snprintf(inputs, sizeof inputs, "%s/inputs", root);
    snprintf(work, sizeof work, "%s/work", root);
    snprintf(errors_path, sizeof errors_path, "%s/errors", root);
    return mkdir(inputs, 0777) != 0 || mkdir(work, 0777) != 0 || chdir(inputs) != 0 ? -1 : 0;
}

static int tear_down(void **state)
{
    (void)state;
    if (chdir("/") != 0)
        return -1;
    remove_directory(root);
    return 0;
}

static void needs_renderer(void)
{
#if !defined(HELIO_WITH_EMBREE) || !defined(HELIO_WITH_ASSIMP) || !defined(HELIO_WITH_PNG)
    print_message("skipped: this build renders nothing\n");
    skip();
#endif
}

/* ---- one run ---------------------------------------------------------------------------- */

static void start_program(const char *environment, const char *mesh)
{
    int null = open("/dev/null", O_RDWR), file = open(errors_path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    alarm(HANG_SECONDS);
    char out[TEST_PATH_SIZE + 32];
    snprintf(out, sizeof out, "%s/picture.png", work);
    execl(program, program, "render", "--size", "64x36", "--spp", "4", "--env-size", "64", "--env", environment,
          "--mesh", mesh, "--out", out, "--max-mesh-seconds", mesh_seconds, (char *)NULL);
    _exit(99);
}

static void read_errors(void)
{
    FILE *stream = fopen(errors_path, "rb");
    assert_non_null(stream);
    size_t length = fread(errors, 1, sizeof errors - 1, stream);
    errors[length] = 0;
    fclose(stream);
}

/* Lines of the program that are not warnings. A sanitizer's build lets through what libraries print. */
static size_t count_sentences(void)
{
    size_t count = 0;
    for (const char *line = errors; *line != 0; line += strcspn(line, "\n") + 1)
        count += strncmp(line, "heliostat: ", 11) == 0 && strncmp(line + 11, "warning: ", 9) != 0;
    return count;
}

static bool has_control_characters(void)
{
    for (const char *c = errors; *c != 0; c++)
        if ((unsigned char)*c < ' ' && *c != '\n')
            return true;
    return false;
}

static size_t file_count;

static int count_file(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)path;
    (void)status;
    (void)place;
    file_count += kind == FTW_F;
    return 0;
}

/* Files in the working folder, from where they are then removed. */
static size_t clear_work(void)
{
    file_count = 0;
    assert_int_equal(nftw(work, count_file, 8, FTW_PHYS), 0);
    remove_directory(work);
    assert_int_equal(mkdir(work, 0777), 0);
    return file_count;
}

static double seconds_of(const struct rusage *usage)
{
    return (double)(usage->ru_utime.tv_sec + usage->ru_stime.tv_sec) +
           1e-6 * (double)(usage->ru_utime.tv_usec + usage->ru_stime.tv_usec);
}

/* Returns the exit code, 0 or 1, after everything else was found to be in order. */
static int render(const char *environment, const char *mesh)
{
    int status;
    struct rusage usage; /* with the processes that the program made */
    fflush(NULL);
    pid_t child = fork();
    if (child == 0)
        start_program(environment, mesh);
    assert_true(child > 0);
    assert_int_equal(wait4(child, &status, 0, &usage), child);
    read_errors();
    size_t files = clear_work(), sentences = count_sentences();
    int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    bool good = (code == 0 && files == 1 && sentences == 0) || (code == 1 && files == 0 && sentences == 1);
    if (!good || has_control_characters() || usage.ru_maxrss > MOST_KIB || seconds_of(&usage) > MOST_SECONDS)
        fail_msg("%s, %s: exit code %d, %zu files, %ld KiB, %.1f s: %s", environment, mesh, code, files,
                 usage.ru_maxrss, seconds_of(&usage), errors);
    return code;
}

static void fails(const char *environment, const char *mesh, const char *words)
{
    if (render(environment, mesh) != 1 || strstr(errors, words) == NULL)
        fail_msg("%s, %s: no failure with \"%s\": %s", environment, mesh, words, errors);
}

/* ---- files ------------------------------------------------------------------------------ */

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *stream = fopen(name, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    assert_int_equal(fclose(stream), 0);
}

static void write_text(const char *name, const char *text)
{
    write_bytes(name, text, strlen(text));
}

#define EVEN_LIGHT "constant:1,1,1"

static void write_triangle(void)
{
    write_text("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

static void sound_files_render(void **state)
{
    (void)state;
    needs_renderer();
    write_triangle();
    assert_int_equal(render(EVEN_LIGHT, "triangle.obj"), 0);
    assert_string_equal(errors, "");
}

static void maps_that_claim_to_be_huge_are_refused(void **state)
{
    (void)state;
    needs_renderer();
    write_triangle();
    write_text("huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 80000\n\1\1\1\1");
    fails("huge.hdr", "triangle.obj", "huge.hdr is too large: 80000 x 40000 pixels, where 67108864 in all are allowed");
    assert_non_null(strstr(errors, "--max-pixels"));
    write_text("wide.pfm", "PF\n4294967295 4294967295\n-1\n");
    fails("wide.pfm", "triangle.obj", "wide.pfm");
    write_text("short.pfm", "PF\n8000 4000\n-1\n0123");
    fails("short.pfm", "triangle.obj", "short.pfm is truncated or damaged");
    static const unsigned char png[] =
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff\x10\6\0\0\1\x9a\xb4\xdf\x9b";
    write_bytes("huge.png", png, sizeof png - 1);
    fails("huge.png", "triangle.obj", "huge.png");
    static const unsigned char jpeg[] = "\xff\xd8\xff\xc0\0\x11\10\xff\xdc\xff\xdc\3\1\x11\0\2\x11\0\3\x11\0";
    write_bytes("huge.jpg", jpeg, sizeof jpeg - 1);
    fails("huge.jpg", "triangle.obj", "huge.jpg");
}

static void maps_that_are_no_files_are_refused(void **state)
{
    (void)state;
    needs_renderer();
    write_triangle();
    write_text("empty.exr", "");
    fails("empty.exr", "triangle.obj", "empty.exr is empty");
    assert_int_equal(mkfifo("pipe.hdr", 0600), 0);
    fails("pipe.hdr", "triangle.obj", "pipe.hdr is not a file");
    fails("/dev/zero", "triangle.obj", "/dev/zero is not a file");
    fails(".", "triangle.obj", "not a file");
}

static void meshes_with_bad_numbers_are_refused(void **state)
{
    (void)state;
    needs_renderer();
    write_text("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    fails(EVEN_LIGHT, "index.obj", "index.obj");
    write_text("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n");
    fails(EVEN_LIGHT, "far.obj", "far.obj: vertex ");
    static const char head[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face %s\nproperty list uchar int vertex_indices\nend_header\n"
                               "%s 0 0\n1 0 0\n0 1 0\n3 %s\n";
    static const char *const cases[][3] = {
        {"1", "nan", "0 1 2"},
        {"1", "0", "0 1 99999999"},
        {"1", "0", "-1 -2 -3"},
        {"4294967295", "0", "0 1 2"},
        {"99999999999999999999", "0", "0 1 2"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(text, sizeof text, head, cases[i][0], cases[i][1], cases[i][2]);
        write_text("case.ply", text);
        render(EVEN_LIGHT, "case.ply"); /* assimp drops some of these triangles, and some files */
    }
}

/* On some of them assimp never ends. */
static void truncated_meshes_do_no_harm(void **state)
{
    (void)state;
    needs_renderer();
    mesh_seconds = "1";
    const unsigned char *bytes = (const unsigned char *)"ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
                                                        "property float x\nproperty float y\nproperty float z\n"
                                                        "element face 1\nproperty list uchar int vertex_indices\n"
                                                        "end_header\n";
    size_t length = strlen((const char *)bytes);
    for (size_t size = 4; size <= length; size += 13) {
        write_bytes("short.ply", bytes, size);
        render(EVEN_LIGHT, "short.ply");
    }
    write_bytes("short.ply", bytes, length);
    render(EVEN_LIGHT, "short.ply");
    mesh_seconds = "8";
}

/* What a mesh names may be anything: a pipe that nobody writes to must not be waited for. */
static void textures_that_are_no_pictures_are_left_out(void **state)
{
    (void)state;
    needs_renderer();
    assert_int_equal(mkfifo("pipe.png", 0600), 0);
    write_text("textured.mtl", "newmtl a\nmap_Kd pipe.png\nnewmtl b\nmap_Kd /dev/zero\nnewmtl c\nmap_Kd huge.png\n"
                               "newmtl d\nmap_Kd \x1b[31mred.png\n");
    write_text("textured.obj", "mtllib textured.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n"
                               "usemtl b\nf 1/1 2/1 3/1\nusemtl c\nf 1/1 2/1 3/1\nusemtl d\nf 1/1 2/1 3/1\n");
    assert_int_equal(render(EVEN_LIGHT, "textured.obj"), 0);
    assert_non_null(strstr(errors, "warning: textured.obj: a texture is left out: pipe.png is not a file"));
}

static void names_of_files_cannot_command_a_terminal(void **state)
{
    (void)state;
    needs_renderer();
    write_triangle();
    fails("\x1b[31mred.hdr", "triangle.obj", "?[31mred.hdr");
    fails(EVEN_LIGHT, "\x1b[31mred.obj", "?[31mred.obj");
    fails(EVEN_LIGHT, "caf\xc3\xa9.obj", "caf\xc3\xa9.obj");
}

/* ---- files of others -------------------------------------------------------------------- */

static unsigned file_total, picture_total;

static bool is_map(const char *path)
{
    return strstr(path, "/exr-") != NULL || strstr(path, "/hdr/") != NULL;
}

static int render_file(const char *path, const struct stat *status, int kind, struct FTW *place)
{
    (void)status;
    (void)place;
    if (kind != FTW_F)
        return 0;
    file_total++;
    picture_total += (is_map(path) ? render(path, "triangle.obj") : render(EVEN_LIGHT, path)) == 0;
    return 0;
}

static void malformed_files_of_others_do_no_harm(void **state)
{
    (void)state;
    char path[TEST_PATH_SIZE];
    needs_renderer();
    find_test_data("malformed", path);
    write_triangle();
    assert_int_equal(nftw(path, render_file, 8, FTW_PHYS), 0);
    print_message("%u files, of which %u give a picture\n", file_total, picture_total);
    assert_true(file_total > 100 && picture_total > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sound_files_render),
        cmocka_unit_test(maps_that_claim_to_be_huge_are_refused),
        cmocka_unit_test(maps_that_are_no_files_are_refused),
        cmocka_unit_test(meshes_with_bad_numbers_are_refused),
        cmocka_unit_test(truncated_meshes_do_no_harm),
        cmocka_unit_test(textures_that_are_no_pictures_are_left_out),
        cmocka_unit_test(names_of_files_cannot_command_a_terminal),
        cmocka_unit_test(malformed_files_of_others_do_no_harm),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
