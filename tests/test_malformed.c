/* SPDX-License-Identifier: MIT
 * The program and files that are damaged, or made to do harm: a picture and exit code 0, or one sentence and exit code
 * 1; never a crash, a hang, gigabytes, or a file left behind. */
#include "program.h"

#include <ftw.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#ifdef HELIO_WITH_PNG
#include <png.h>
#endif

enum {
    MOST_KIB = 2 << 20, /* 2 GiB, of the program and of each process that it makes */
    MOST_SECONDS = 10,  /* of processor time, which does not depend on what else the machine does */
    HANG_SECONDS = 120, /* by the clock: only keeps a test that hangs from lasting for ever */
    PROBLEM_SIZE = 2048
};

#define EVEN_LIGHT "constant:1,1,1"
#define SOUND_MESH "tetrahedron.obj"

/* Holds nothing before a run, and the picture alone after it. */
#define PICTURES "../pictures"
#define PICTURE "../pictures/picture.png"

static const char *mesh_seconds; /* for --max-mesh-seconds */
static long peak_kib;            /* of the last run, as MOST_KIB */

static int set_up(void **state)
{
    return set_up_program(state) != 0 || mkdir(PICTURES, 0777) != 0 ? -1 : 0;
}

static int set_up_test(void **state)
{
    int code = set_up_folder(state);
    program_limits.seconds = HANG_SECONDS;
    mesh_seconds = "8"; /* the program's own limit for small files */
    return code;
}

/* ---- one run ---------------------------------------------------------------------------- */

/* Lines of the program that are not warnings. A sanitizer's build lets through what libraries print. */
static size_t count_sentences(void)
{
    size_t count = 0;
    for (const char *line = program_err; *line != 0; line += strcspn(line, "\n") + 1)
        count += strncmp(line, "heliostat: ", 11) == 0 && strncmp(line + 11, "warning: ", 9) != 0;
    return count;
}

static bool has_control_characters(void)
{
    for (const char *c = program_err; *c != 0; c++)
        if ((unsigned char)*c < ' ' && *c != '\n')
            return true;
    return false;
}

static size_t take_pictures(void)
{
    size_t count = count_files(PICTURES);
    remove_directory(PICTURES);
    assert_int_equal(mkdir(PICTURES, 0777), 0);
    return count;
}

static double seconds_of(const struct rusage *usage)
{
    return (double)(usage->ru_utime.tv_sec + usage->ru_stime.tv_sec) +
           1e-6 * (double)(usage->ru_utime.tv_usec + usage->ru_stime.tv_usec);
}

/* Returns the exit code. problem: what is out of order, or "". */
static int try_render(const char *environment, const char *mesh, char problem[PROBLEM_SIZE])
{
    const char *const words[] = {
        "render",    "--size=64x36", "--spp=4", "--env-size=64",      "--out",      PICTURE, "--env",
        environment, "--mesh",       mesh,      "--max-mesh-seconds", mesh_seconds, NULL};
    struct rusage usage;
    int code = finish_program(start_program_words(words), &usage);
    size_t pictures = take_pictures(), sentences = count_sentences();
    bool good = (code == 0 && pictures == 1 && sentences == 0) || (code == 1 && pictures == 0 && sentences == 1);
    peak_kib = usage.ru_maxrss;
    problem[0] = 0;
    if (!good || has_control_characters() || peak_kib > MOST_KIB || seconds_of(&usage) > MOST_SECONDS)
        snprintf(problem, PROBLEM_SIZE, "%s, %s: exit code %d, %zu files, %ld KiB, %.1f s: %.1000s", environment, mesh,
                 code, pictures, peak_kib, seconds_of(&usage), program_err);
    return code;
}

/* Returns the exit code, 0 or 1, after everything else was found to be in order. */
static int render(const char *environment, const char *mesh)
{
    char problem[PROBLEM_SIZE];
    int code = try_render(environment, mesh, problem);
    if (problem[0] != 0)
        fail_msg("%s", problem);
    return code;
}

static void is_refused(const char *environment, const char *mesh, const char *words)
{
    if (render(environment, mesh) != 1 || strstr(program_err, words) == NULL)
        fail_msg("%s, %s: no failure with \"%s\": %s", environment, mesh, words, program_err);
}

/* ---- files ------------------------------------------------------------------------------ */

static void sound_files_render(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    assert_int_equal(render(EVEN_LIGHT, SOUND_MESH), 0);
    assert_string_equal(program_err, "");
}

static void maps_that_claim_to_be_huge_are_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_text("huge.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 40000 +X 80000\n\1\1\1\1");
    is_refused("huge.hdr", SOUND_MESH,
               "huge.hdr is too large: 80000 x 40000 pixels, where 67108864 in all are allowed");
    assert_non_null(strstr(program_err, "--max-pixels"));
    write_text("wide.pfm", "PF\n4294967295 4294967295\n-1\n");
    is_refused("wide.pfm", SOUND_MESH, "wide.pfm");
    write_text("short.pfm", "PF\n8000 4000\n-1\n0123");
    is_refused("short.pfm", SOUND_MESH, "short.pfm is truncated or damaged");
    static const unsigned char png[] =
        "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xff\xff\0\0\xff\xff\x10\6\0\0\1\x9a\xb4\xdf\x9b";
    write_bytes("huge.png", png, sizeof png - 1);
    is_refused("huge.png", SOUND_MESH, "huge.png");
    static const unsigned char jpeg[] = "\xff\xd8\xff\xc0\0\x11\10\xff\xdc\xff\xdc\3\1\x11\0\2\x11\0\3\x11\0";
    write_bytes("huge.jpg", jpeg, sizeof jpeg - 1);
    is_refused("huge.jpg", SOUND_MESH, "huge.jpg");
}

static void maps_that_are_no_files_are_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_text("empty.exr", "");
    is_refused("empty.exr", SOUND_MESH, "empty.exr is empty");
    assert_int_equal(mkfifo("pipe.hdr", 0600), 0);
    is_refused("pipe.hdr", SOUND_MESH, "pipe.hdr is not a file");
    is_refused("/dev/zero", SOUND_MESH, "/dev/zero is not a file");
    is_refused(".", SOUND_MESH, "lacks one of the six faces");
}

static void meshes_with_bad_numbers_are_refused(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    write_text("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    is_refused(EVEN_LIGHT, "index.obj", "index.obj");
    write_text("far.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1 0\nf 1 2 3\n");
    is_refused(EVEN_LIGHT, "far.obj", "far.obj: vertex ");
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
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
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
    is_refused(EVEN_LIGHT, "short.ply",
               "short.ply ends too early: its header announces 3 vertices, and there are 0; copy or download it again");
    write_text("text.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 9\nproperty list uchar int vertex_indices\nend_header\n"
                           "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1 0\n3 0 1");
    is_refused(EVEN_LIGHT, "text.ply", "text.ply ends too early: its header announces 9 faces, and there are 2");
}

/* textured.obj: a triangle for each of the pictures that textured.mtl names, up to NULL. */
static void write_textured_mesh(const char *const *pictures)
{
    FILE *mesh = fopen("textured.obj", "wb"), *materials = fopen("textured.mtl", "wb");
    assert_true(mesh != NULL && materials != NULL);
    fputs("mtllib textured.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n", mesh);
    for (size_t i = 0; pictures[i] != NULL; i++) {
        fprintf(materials, "newmtl material%zu\nmap_Kd %s\n", i, pictures[i]);
        fprintf(mesh, "usemtl material%zu\nf 1/1 2/1 3/1\n", i);
    }
    assert_int_equal(fclose(mesh), 0);
    assert_int_equal(fclose(materials), 0);
}

/* What a mesh names may be anything: a pipe that nobody writes to must not be waited for. */
static void textures_that_are_no_pictures_are_left_out(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    assert_int_equal(mkfifo("pipe.png", 0600), 0);
    write_textured_mesh((const char *const[]){"pipe.png", "/dev/zero", "missing.png", "\x1b[31mred.png", NULL});
    assert_int_equal(render(EVEN_LIGHT, "textured.obj"), 0);
    assert_non_null(strstr(program_err, "warning: textured.obj: a texture is left out: pipe.png is not a file"));
}

#ifdef HELIO_WITH_PNG

/* Each byte of a row holds 8 pixels. A file that is not whole has no rows, and is sound in all other ways. */
static void write_black_png(const char *path, uint32_t width, uint32_t height, bool is_whole)
{
    static const unsigned char row[16384 / 8];
    FILE *stream = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_true(stream != NULL && png != NULL && info != NULL);
    png_init_io(png, stream);
    png_set_IHDR(png, info, width, height, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (uint32_t i = 0; is_whole && i < height; i++)
        png_write_row(png, row);
    if (!is_whole)
        png_write_chunk(png, (png_const_bytep) "IDAT", NULL, 0);
    png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
    png_destroy_write_struct(&png, &info);
    assert_int_equal(fclose(stream), 0);
}

static void expect_words(const char *words)
{
    if (strstr(program_err, words) == NULL)
        fail_msg("no \"%s\" in: %s", words, program_err);
}

static void textures_that_claim_to_be_huge_take_no_memory(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    assert_int_equal(render(EVEN_LIGHT, SOUND_MESH), 0);
    long sound_kib = peak_kib;
    write_black_png("edge.png", 60000, 60000, false);  /* 13 GiB of texels */
    write_black_png("pixels.png", 16384, 16384, true); /* 1 GiB, and all there */
    write_black_png("empty.png", 8192, 8192, false);   /* 256 MiB: not too much, but not there */
    write_textured_mesh((const char *const[]){"edge.png", "pixels.png", "empty.png", NULL});
    assert_int_equal(render(EVEN_LIGHT, "textured.obj"), 0);
    expect_words("a texture is left out: edge.png is too large: 60000 x 60000");
    expect_words("a texture is left out: pixels.png is too large: 16384 x 16384");
    expect_words("a texture is left out: empty.png is truncated or damaged");
    if (peak_kib > sound_kib + (64 << 10))
        fail_msg("%ld KiB, where a mesh without textures takes %ld KiB", peak_kib, sound_kib);
}

/* Each of them may be read, but not all. The second is small, so that it is not the last one that fits exactly. */
static void textures_that_are_huge_together_are_left_out(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    static const char *const names[] = {"1.png", "2.png", "3.png", "4.png", "5.png", "6.png", NULL};
    for (size_t i = 0; names[i] != NULL; i++)
        write_black_png(names[i], 8192, i == 1 ? 64 : 8192, true); /* 256 MiB of texels */
    write_textured_mesh(names);
    assert_int_equal(render(EVEN_LIGHT, "textured.obj"), 0);
    for (size_t i = 0; names[i] != NULL; i++) {
        char words[64];
        snprintf(words, sizeof words, "a texture is left out: %s is too large", names[i]);
        assert_int_equal(strstr(program_err, words) != NULL, i >= 2);
    }
    assert_null(strstr(program_err, "--max-pixels")); /* which would not help */
    assert_true(peak_kib < 1 << 20); /* on their way from one process to the other, they are there twice */
}

#endif

static void names_of_files_cannot_command_a_terminal(void **state)
{
    (void)state;
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    is_refused("\x1b[31mred.hdr", SOUND_MESH, "?[31mred.hdr");
    is_refused(EVEN_LIGHT, "\x1b[31mred.obj", "?[31mred.obj");
    is_refused(EVEN_LIGHT, "caf\xc3\xa9.obj", "caf\xc3\xa9.obj");
}

/* ---- files of others -------------------------------------------------------------------- */

static unsigned file_total, picture_total, problem_total;

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
    char problem[PROBLEM_SIZE];
    bool map = is_map(path);
    file_total++;
    picture_total += try_render(map ? path : EVEN_LIGHT, map ? SOUND_MESH : path, problem) == 0;
    if (problem[0] != 0) { /* no test ends from within nftw(), which has memory of its own */
        print_error("%s\n", problem);
        problem_total++;
    }
    return 0;
}

static void malformed_files_of_others_do_no_harm(void **state)
{
    (void)state;
    char path[TEST_PATH_SIZE];
    skip_without(NEEDS_RENDERER | NEEDS_PNG);
    find_test_data("malformed", path);
    assert_int_equal(nftw(path, render_file, 8, FTW_PHYS), 0);
    print_message("%u files, of which %u give a picture\n", file_total, picture_total);
    assert_int_equal(problem_total, 0);
    assert_true(file_total > 100 && picture_total > 10);
}

#define malformed_test(function) cmocka_unit_test_setup(function, set_up_test)

int main(void)
{
    const struct CMUnitTest tests[] = {
        malformed_test(sound_files_render),
        malformed_test(maps_that_claim_to_be_huge_are_refused),
        malformed_test(maps_that_are_no_files_are_refused),
        malformed_test(meshes_with_bad_numbers_are_refused),
        malformed_test(truncated_meshes_do_no_harm),
        malformed_test(textures_that_are_no_pictures_are_left_out),
#ifdef HELIO_WITH_PNG
        malformed_test(textures_that_claim_to_be_huge_take_no_memory),
        malformed_test(textures_that_are_huge_together_are_left_out),
#endif
        malformed_test(names_of_files_cannot_command_a_terminal),
        malformed_test(malformed_files_of_others_do_no_harm),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down_program);
}
