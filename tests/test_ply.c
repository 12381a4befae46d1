/* SPDX-License-Identifier: MIT
 *
 * PLY files that end before all is there that they announce, whatever else they may hold. */
#include "support.h"

#include "scene/ply_check.h"
#include "scene/ply_header.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define XYZ "property float x\nproperty float y\nproperty float z\n"
#define FACE_LIST "property list uchar int vertex_indices\n"
#define TRIANGLE_HEAD "element vertex 3\n" XYZ "element face 1\n" FACE_LIST "end_header\n"

static helio_context *context;
static char folder[TEST_PATH_SIZE], path[TEST_PATH_SIZE + 16];

static int set_up(void **state)
{
    (void)state;
    context = make_context(1, NULL);
    make_directory(folder);
    snprintf(path, sizeof path, "%s/mesh.ply", folder);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    remove_directory(folder);
    helio_context_destroy(context);
    return 0;
}

/* ---- files ------------------------------------------------------------------------------ */

typedef struct ply_bytes {
    unsigned char bytes[1 << 18];
    size_t size;
} ply_bytes;

static ply_bytes ply;

static void start_ply(const char *text)
{
    ply.size = strlen(text);
    memcpy(ply.bytes, text, ply.size);
}

static void append(const void *bytes, size_t size, bool big_endian)
{
    assert_true(ply.size + size <= sizeof ply.bytes);
    for (size_t i = 0; i < size; i++)
        ply.bytes[ply.size + (big_endian ? size - 1 - i : i)] = ((const unsigned char *)bytes)[i];
    ply.size += size;
}

static void append_float(float value, bool big_endian)
{
    append(&value, sizeof value, big_endian);
}

static void append_int(int32_t value, bool big_endian)
{
    append(&value, sizeof value, big_endian);
}

static void append_byte(unsigned char value)
{
    append(&value, 1, false);
}

static void write_ply(size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(ply.bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static helio_status check_memory(size_t size)
{
    static ply_stream stream;
    unsigned char *copy = malloc(size + (size == 0)); /* of exactly this size, for the address sanitizer */
    assert_non_null(copy);
    memcpy(copy, ply.bytes, size);
    ply_stream_open_memory(&stream, copy, size);
    helio_status status = ply_check(&stream, "mesh.ply");
    free(copy);
    return status;
}

static helio_status check_file(size_t size)
{
    static ply_stream stream;
    write_ply(size);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    ply_stream_open_file(&stream, file, size);
    helio_status status = ply_check(&stream, "mesh.ply");
    fclose(file);
    return status;
}

/* What the start of the PLY lacks, found in memory and in a file. */
static void assert_lacks(size_t size, const char *words)
{
    char sentence[256];
    snprintf(sentence, sizeof sentence, "mesh.ply ends too early: its header announces %s; copy or download it again",
             words);
    assert_int_equal(check_memory(size), HELIO_ERR_DATA);
    assert_string_equal(helio_last_error(), sentence);
    assert_int_equal(check_file(size), HELIO_ERR_DATA);
    assert_string_equal(helio_last_error(), sentence);
}

static void assert_passes(size_t size)
{
    assert_ok(check_memory(size));
    assert_ok(check_file(size));
}

static void assert_text_passes(const char *text)
{
    start_ply(text);
    assert_passes(ply.size);
}

static void assert_text_lacks(const char *text, const char *words)
{
    start_ply(text);
    assert_lacks(ply.size, words);
}

static void assert_loads(uint32_t triangles)
{
    helio_mesh *mesh;
    write_ply(ply.size);
    assert_ok(helio_mesh_load(context, path, NULL, &mesh));
    assert_int_equal(mesh->triangle_count, triangles);
    assert_int_equal(mesh->degenerate_triangles, 0);
    helio_mesh_destroy(context, mesh);
}

/* ---- ASCII ------------------------------------------------------------------------------ */

static void ascii_files_have_a_line_for_each_vertex_and_face(void **state)
{
    (void)state;
    static const char head[] = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\n" XYZ
                               "element face 2\n" FACE_LIST "end_header\n";
    start_ply(head);
    assert_lacks(ply.size, "4 vertices, and there are 0");
    static const char body[] = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
    append(body, strlen(body), false);
    assert_passes(ply.size);
    assert_passes(ply.size - 1); /* the last line need not end */
    assert_loads(2);
    assert_lacks(ply.size - 8, "2 faces, and there are 1");
    assert_lacks(ply.size - 10, "2 faces, and there are 0"); /* a line that was cut is not counted */
    assert_lacks(ply.size - 16, "2 faces, and there are 0");
    assert_lacks(ply.size - 22, "4 vertices, and there are 3");
    assert_lacks(strlen(head) + 1, "4 vertices, and there are 0");
}

static void lines_end_in_many_ways(void **state)
{
    (void)state;
    start_ply("ply\r\nformat ascii 1.0\r\nobj_info none\r\nelement vertex 3\r\nproperty float x\r\n"
              "property float y\r\nproperty  float\tz \r\nelement face 1\r\nproperty list uchar int vertex_indices\r\n"
              "end_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n");
    assert_passes(ply.size);
    assert_loads(1);
    assert_lacks(ply.size - 9, "1 face, and there are 0");
    assert_text_passes("ply\nformat ascii 1.0\n" TRIANGLE_HEAD "\n0 0 0\n1 0 0\n \t\n\n0 1 0\n\n3 0 1 2");
    assert_text_lacks("ply\nformat ascii 1.0\n" TRIANGLE_HEAD "0 0 0\n1 0 0\n \t\r\n\n\n\n\n\n",
                      "3 vertices, and there are 2");
    /* Lines and comments longer than any buffer. */
    start_ply("ply\nformat ascii 1.0\ncomment ");
    memset(ply.bytes + ply.size, 'c', 100000);
    ply.size += 100000;
    append("\n" TRIANGLE_HEAD "0 0 0\n", strlen("\n" TRIANGLE_HEAD "0 0 0\n"), false);
    memset(ply.bytes + ply.size, '1', 100000);
    ply.size += 100000;
    append("\n", 1, false);
    assert_lacks(ply.size, "3 vertices, and there are 2");
}

static void elements_of_other_names_are_counted_where_they_precede(void **state)
{
    (void)state;
    static const char head[] =
        "ply\nformat ascii 1.0\nelement camera 2\nproperty float fov\nelement nothing 7\n"
        "element vertex 3\n" XYZ "element face 1\n" FACE_LIST "element edge 5\nproperty int a\nend_header\n";
    start_ply(head);
    append("40\n", 3, false);
    assert_lacks(ply.size, "2 of \"camera\", and there are 1");
    append("41\n0 0 0\n1 0 0\n0 1 0\n", 21, false);
    assert_lacks(ply.size, "1 face, and there are 0");
    append("3 0 1 2\n", 8, false);
    assert_passes(ply.size); /* edges are of no use */
}

/* ---- binary ----------------------------------------------------------------------------- */

enum { VERTICES = 2000, FACES = 1500 };

static void make_binary(bool big_endian)
{
    char head[512];
    snprintf(head, sizeof head,
             "ply\nformat binary_%s_endian 1.0\nelement vertex %d\n" XYZ "element face %d\n" FACE_LIST
             "property uchar quality\nend_header\n",
             big_endian ? "big" : "little", VERTICES, FACES);
    start_ply(head);
    for (int i = 0; i < VERTICES; i++) {
        append_float((float)i, big_endian);
        append_float((float)(i % 2), big_endian);
        append_float((float)(i % 3), big_endian);
    }
    for (int i = 0; i < FACES; i++) {
        append_byte(3);
        for (int corner = 0; corner < 3; corner++)
            append_int(i + corner, big_endian);
        append_byte('\n');
    }
}

static void binary_files_are_checked_to_the_byte(void **state)
{
    (void)state;
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        make_binary(big_endian);
        assert_passes(ply.size);
        assert_loads(FACES);
        assert_lacks(ply.size - 1, "1500 faces, and there are 1499");
        assert_lacks(ply.size - 14 * 1000, "1500 faces, and there are 500");
        assert_lacks(ply.size - 14 * FACES, "1500 faces, and there are 0");
        assert_lacks(ply.size - 14 * FACES - 1, "2000 vertices, and there are 1999");
        assert_lacks(ply.size - 14 * FACES - 12 * VERTICES, "2000 vertices, and there are 0");
    }
}

static void every_beginning_of_a_binary_file_is_told_from_the_whole(void **state)
{
    (void)state;
    start_ply("ply\nformat binary_little_endian 1.0\n" TRIANGLE_HEAD);
    size_t head = ply.size;
    for (int i = 0; i < 9; i++)
        append_float((float)i, false);
    append_byte(3);
    for (int i = 0; i < 3; i++)
        append_int(i, false);
    for (size_t size = 0; size <= ply.size; size++)
        assert_int_equal(check_memory(size), size < head || size == ply.size ? HELIO_OK : HELIO_ERR_DATA);
}

/* Longer than what is in memory at once. */
static void lists_may_be_long(void **state)
{
    (void)state;
    for (int big_endian = 0; big_endian < 2; big_endian++) {
        char head[256];
        snprintf(head, sizeof head,
                 "ply\nformat binary_%s_endian 1.0\nelement blob 2\nproperty list uint short words\n" TRIANGLE_HEAD,
                 big_endian ? "big" : "little");
        start_ply(head);
        append_int(0, big_endian);
        append_int(50000, big_endian);
        memset(ply.bytes + ply.size, 0, 100000 + 36 + 13);
        assert_lacks(ply.size + 99999, "2 of \"blob\", and there are 1");
        ply.size += 100000;
        assert_lacks(ply.size, "3 vertices, and there are 0");
        assert_lacks(ply.size + 36, "1 face, and there are 0");
        ply.bytes[ply.size + 36] = 3;
        assert_lacks(ply.size + 36 + 12, "1 face, and there are 0");
        assert_passes(ply.size + 36 + 13);
    }
}

/* ---- headers ---------------------------------------------------------------------------- */

static void huge_counts_do_not_overflow(void **state)
{
    (void)state;
    static const char *const formats[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    static const char *const properties[] = {"property double x\nproperty double y\n", FACE_LIST,
                                             "property double x\nproperty list uint double y\n"};
    for (size_t i = 0; i < COUNT(formats); i++)
        for (size_t j = 0; j < COUNT(properties); j++) {
            char text[256];
            snprintf(text, sizeof text, "ply\nformat %s 1.0\nelement vertex 18446744073709551615\n%send_header\n",
                     formats[i], properties[j]);
            assert_text_lacks(text, "18446744073709551615 vertices, and there are 0");
        }
    /* 2^61 times 8 bytes are 0 in 64 bits. */
    assert_text_lacks("ply\nformat binary_big_endian 1.0\nelement vertex 2305843009213693952\nproperty double x\n"
                      "end_header\n12345678",
                      "2305843009213693952 vertices, and there are 1");
    /* A list that claims 2^32 - 1 numbers, or -1 of them. */
    static const char *const types[] = {"uint", "int", "short", "char"};
    for (size_t i = 0; i < COUNT(types); i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list %s double i\nend_header\n"
                 "\xff\xff\xff\xff, and then some of them",
                 types[i]);
        assert_text_lacks(text, "1 face, and there are 0");
    }
}

static void what_is_not_understood_is_left_to_the_importer(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "",
        "pl",
        "ply",
        "ply\n",
        "plywood\nformat ascii 1.0\n" TRIANGLE_HEAD,
        "ply\rformat ascii 1.0\relement vertex 3\r",
        "v 0 0 0\nv 1 0 0\nf 1 2 3\n",
        "ply\n" TRIANGLE_HEAD,
        "ply\nformat\n" TRIANGLE_HEAD,
        "ply\nformat ternary 1.0\n" TRIANGLE_HEAD,
        "ply\nformat ascii 1.0\nelement vertex 3\n" XYZ,
        "ply\nformat ascii 1.0\nelement vertex\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex -3\n" XYZ "end_header\n",
        "ply\nformat ascii 1.0\nelement vertex 3 4\n" XYZ "end_header\n",
        "ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n" XYZ "end_header\n",
        "ply\nformat ascii 1.0\nelement an_element_with_a_name_of_some_length 3\n" XYZ "element face 3\nend_header\n",
        "ply\nformat ascii 1.0\nproperty float x\nelement vertex 3\n" XYZ "end_header\n",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nend_header\n",
        "ply\nformat ascii 1.0\nelement face 3\nproperty list float int i\nend_header\n",
        "ply\nformat ascii 1.0\nelement face 3\nproperty list uchar int\nend_header\n",
        "ply\nformat ascii 1.0\nelement face 3\nproperty list uchar int i j k l\nend_header\n",
        "ply\nformat ascii 1.0\nwhatever\nelement vertex 3\n" XYZ "end_header\n",
        "ply\nformat ascii 1.0\nelement vertex 0\n" XYZ "element face 0\n" FACE_LIST "end_header\n",
        "ply\nformat binary_big_endian 1.0\nelement vertex 0\n" XYZ "element face 0\n" FACE_LIST "end_header\n",
        "ply\nformat ascii 1.0\nelement vertex 5\nend_header\n",
        "ply\nformat binary_big_endian 1.0\nelement vertex 5\nend_header\n",
        "ply\nformat ascii 1.0\nelement edge 5\nproperty int a\nend_header\n",
        "ply\nformat ascii 1.0\nend_header\n",
    };
    for (size_t i = 0; i < COUNT(texts); i++)
        assert_text_passes(texts[i]);
}

static void headers_may_be_endless(void **state)
{
    (void)state;
    static char text[65536];
    char *end = text + sprintf(text, "ply\nformat ascii 1.0\n");
    for (int i = 0; i < 1000; i++)
        end += sprintf(end, "element vertex 7\nproperty float x\n");
    sprintf(end, "end_header\n");
    assert_text_passes(text);
    end = text + sprintf(text, "ply\nformat ascii 1.0\nelement vertex 7\n");
    for (int i = 0; i < PLY_MAX_PROPERTIES; i++)
        end += sprintf(end, "property float x\n");
    sprintf(end, "end_header\n");
    assert_text_lacks(text, "7 vertices, and there are 0");
    sprintf(end, "property float x\nend_header\n");
    assert_text_passes(text);
    memset(text + 3, 'x', sizeof text - 4); /* and not one line */
    assert_text_passes(text);
}

static void names_are_printable(void **state)
{
    (void)state;
    assert_text_lacks("ply\nformat ascii 1.0\nelement \x1b[31mred\xc3\xa9 3\nproperty float x\nelement vertex 1\n" XYZ
                      "end_header\n",
                      "3 of \"?[31mred??\", and there are 0");
}

/* ---- meshes ----------------------------------------------------------------------------- */

static void assert_load_fails(const char *file, const char *words)
{
    helio_mesh *mesh = NULL;
    for (int in_process = 0; in_process < 2; in_process++) {
        const helio_mesh_load_desc desc = {.in_process = in_process};
        assert_int_equal(helio_mesh_load(context, file, &desc, &mesh), HELIO_ERR_DATA);
        if (strncmp(helio_last_error(), file, strlen(file)) != 0 || strstr(helio_last_error(), words) == NULL)
            fail_msg("no \"%s\" in: %s", words, helio_last_error());
        assert_null(mesh);
    }
}

static void truncated_meshes_are_not_loaded(void **state)
{
    (void)state;
    make_binary(false);
    write_ply(ply.size - 100);
    assert_load_fails(path, "ends too early: its header announces 1500 faces, and there are 1492");
    start_ply("ply\nformat ascii 1.0\nelement vertex 3\n" XYZ "element face 2\n" FACE_LIST
              "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    write_ply(ply.size);
    assert_load_fails(path, "ends too early: its header announces 2 faces, and there are 1");
    strcat(path, ".gz");
    gzFile gz = gzopen(path, "wb");
    assert_int_equal(gzwrite(gz, ply.bytes, (unsigned)ply.size), (int)ply.size);
    gzclose(gz);
    assert_load_fails(path, "ends too early: its header announces 2 faces, and there are 1");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(ascii_files_have_a_line_for_each_vertex_and_face),
        TEST(lines_end_in_many_ways),
        TEST(elements_of_other_names_are_counted_where_they_precede),
        TEST(binary_files_are_checked_to_the_byte),
        TEST(every_beginning_of_a_binary_file_is_told_from_the_whole),
        TEST(lists_may_be_long),
        TEST(huge_counts_do_not_overflow),
        TEST(what_is_not_understood_is_left_to_the_importer),
        TEST(headers_may_be_endless),
        TEST(names_are_printable),
        TEST(truncated_meshes_are_not_loaded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
