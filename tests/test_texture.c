/* SPDX-License-Identifier: MIT
 *
 * Textures: how they are looked up, what meshes take, and what comes out of files. */
#include "support.h"

#include "scene/scene.h"
#include "scene/texture.h"

#include <heliostat/heliostat.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#if HELIO_WITH_PNG
#include <png.h>
#endif
#if HELIO_WITH_JPEG
#include <jpeglib.h>
#endif

static helio_context *context;
static char log_text[8192]; /* what the context said, a line each */

static void keep_line(void *user, helio_log_level level, const char *message)
{
    (void)user;
    (void)level;
    size_t length = strlen(log_text);
    snprintf(log_text + length, sizeof log_text - length, "%s\n", message);
}

static int start(void **state)
{
    (void)state;
    log_text[0] = 0;
    return helio_context_create(&(helio_context_desc){.threads = 1, .log_level = HELIO_LOG_WARNING, .log = keep_line},
                                &context);
}

static int stop(void **state)
{
    (void)state;
    helio_context_destroy(context);
    return 0;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not %.9g within %g", value, expected, tolerance);
}

static void assert_colour(const float rgb[3], double r, double g, double b, double tolerance)
{
    assert_near((double)rgb[0], r, tolerance);
    assert_near((double)rgb[1], g, tolerance);
    assert_near((double)rgb[2], b, tolerance);
}

static void assert_refused(helio_status status, helio_status expected, const char *words)
{
    assert_int_equal(status, expected);
    if (strstr(helio_last_error(), words) == NULL)
        fail_msg("\"%s\" is not in: %s", words, helio_last_error());
}

/* ---- lookup ---- */

/* Red is 10 20 / 30 40, green 0 or 255 by column, blue by row. */
static const uint8_t four[2][2][4] = {{{10, 0, 0, 255}, {20, 255, 0, 255}}, {{30, 0, 255, 255}, {40, 255, 255, 255}}};

static double red_at(const helio_texture *texture, float u, float v)
{
    static texture_curve bytes;
    for (int i = 0; i < 256; i++)
        bytes.value[i] = (float)i;
    float rgb[3];
    texture_lookup(texture, &bytes, u, v, rgb);
    return (double)rgb[0];
}

static void lookup_is_bilinear_between_centres(void **state)
{
    (void)state;
    const helio_texture texture = {2, 2, HELIO_WRAP_CLAMP, HELIO_WRAP_CLAMP, four[0][0]};
    assert_near(red_at(&texture, 0.25f, 0.25f), 10, 1e-5);
    assert_near(red_at(&texture, 0.75f, 0.25f), 20, 1e-5);
    assert_near(red_at(&texture, 0.25f, 0.75f), 30, 1e-5);
    assert_near(red_at(&texture, 0.75f, 0.75f), 40, 1e-5);
    assert_near(red_at(&texture, 0.5f, 0.5f), 25, 1e-5);
    assert_near(red_at(&texture, 0.375f, 0.25f), 12.5, 1e-5);
    assert_near(red_at(&texture, 0.625f, 0.375f), 22.5, 1e-5); /* 17.5 and 37.5, one quarter of the way */
}

static void texels_repeat_stay_or_are_mirrored(void **state)
{
    (void)state;
    helio_texture texture = {2, 2, HELIO_WRAP_REPEAT, HELIO_WRAP_CLAMP, four[0][0]};
    assert_near(red_at(&texture, 0.0f, 0.0f), 15, 1e-5);
    assert_near(red_at(&texture, 1.0f, 0.0f), 15, 1e-5);
    assert_near(red_at(&texture, 1.25f, 0.0f), 10, 1e-5);
    assert_near(red_at(&texture, -0.25f, -9.0f), 20, 1e-5);
    assert_near(red_at(&texture, -7.75f, 9.0f), 30, 1e-5);
    assert_near(red_at(&texture, -1e-9f, 0.0f), 15, 1e-4);
    assert_near(red_at(&texture, 1e6f, 1e6f), 35, 1e-5);

    texture.wrap_u = HELIO_WRAP_CLAMP;
    assert_near(red_at(&texture, 0.0f, 0.0f), 10, 1e-5);
    assert_near(red_at(&texture, -5.0f, 0.0f), 10, 1e-5);
    assert_near(red_at(&texture, 1.25f, 0.0f), 20, 1e-5);

    texture.wrap_u = texture.wrap_v = HELIO_WRAP_MIRROR;
    assert_near(red_at(&texture, 0.0f, 0.0f), 10, 1e-5);
    assert_near(red_at(&texture, 1.0f, 0.0f), 20, 1e-5);
    assert_near(red_at(&texture, 1.25f, 0.25f), 20, 1e-5);
    assert_near(red_at(&texture, 1.75f, 1.75f), 10, 1e-5);
    assert_near(red_at(&texture, -0.25f, -1.25f), 30, 1e-5);
    assert_near(red_at(&texture, 2.75f, 2.0f), 20, 1e-5);

    const uint8_t one[4] = {7, 0, 0, 0};
    for (int wrap = HELIO_WRAP_REPEAT; wrap <= HELIO_WRAP_MIRROR; wrap++) {
        texture = (helio_texture){1, 1, (helio_wrap)wrap, (helio_wrap)wrap, one};
        for (float x = -2.5f; x < 2.5f; x += 0.1f)
            assert_near(red_at(&texture, x, -x), 7, 1e-5);
    }
}

static void colours_are_decoded_before_they_are_mixed(void **state)
{
    (void)state;
    const texture_curve srgb = texture_curve_srgb(), linear = texture_curve_linear();
    const helio_texture texture = {2, 2, HELIO_WRAP_CLAMP, HELIO_WRAP_CLAMP, four[0][0]};
    float rgb[3];
    texture_lookup(&texture, &srgb, 0.5f, 0.5f, rgb);
    assert_near((double)rgb[1], 0.5, 1e-6);
    assert_near((double)srgb.value[0], 0, 0);
    assert_near((double)srgb.value[10], 10 / 255.0 / 12.92, 1e-7);
    assert_near((double)srgb.value[128], 0.2158605, 1e-6);
    assert_near((double)srgb.value[255], 1, 0);
    assert_near((double)linear.value[51], 0.2, 1e-7);
    texture_lookup(&texture, &linear, 0.75f, 0.75f, rgb);
    assert_colour(rgb, 40 / 255.0, 1, 1, 1e-6);
}

/* ---- meshes ---- */

/* A square from (-1, -1, 0) to (1, 1, 0) that faces +Z; (0, 0) of the texture is its upper left corner. */
static const float square_positions[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
static const float square_coordinates[4][2] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
static const uint32_t square_triangles[2][3] = {{0, 1, 2}, {0, 2, 3}}, square_materials[2] = {0, 0};
static const helio_material square_material = {
    .kind = HELIO_MATERIAL_GGX, .diffuse = {0.5f, 1.0f, 1.0f}, .metallic = 0.5f, .roughness = 0.8f};
static const helio_material_textures square_textures = {.base_colour = 2, .metallic_roughness = 1};
static const uint8_t grey[4] = {0, 51, 102, 255};
static const helio_texture two_textures[2] = {{1, 1, HELIO_WRAP_REPEAT, HELIO_WRAP_REPEAT, grey},
                                              {2, 2, HELIO_WRAP_CLAMP, HELIO_WRAP_CLAMP, four[0][0]}};

static const helio_mesh_desc square = {
    .vertex_count = 4,
    .triangle_count = 2,
    .positions = square_positions[0],
    .triangles = square_triangles[0],
    .material_count = 1,
    .triangle_materials = square_materials,
    .materials = &square_material,
    .texture_coordinates = square_coordinates[0],
    .texture_count = 2,
    .textures = two_textures,
    .material_textures = &square_textures,
};

static void refuse(const helio_mesh_desc *desc, helio_status status, const char *words)
{
    helio_mesh *mesh = (helio_mesh *)&mesh;
    assert_refused(helio_mesh_create(context, desc, &mesh), status, words);
    assert_null(mesh);
}

static void meshes_refuse_textures_that_do_not_fit(void **state)
{
    (void)state;
    helio_mesh_desc desc = square;
    desc.textures = NULL;
    refuse(&desc, HELIO_ERR_ARGUMENT, "2 textures but no array");
    desc = square;
    desc.material_textures = NULL;
    refuse(&desc, HELIO_ERR_ARGUMENT, "material_textures");
    desc = square;
    desc.texture_coordinates = NULL;
    refuse(&desc, HELIO_ERR_ARGUMENT, "texture_coordinates");
    desc = square;
    desc.material_count = 0;
    desc.triangle_materials = NULL;
    refuse(&desc, HELIO_ERR_ARGUMENT, "no materials");

    const helio_material_textures beyond = {.base_colour = 1, .metallic_roughness = 3};
    desc = square;
    desc.material_textures = &beyond;
    refuse(&desc, HELIO_ERR_DATA, "material 0 names texture 3; there are 2");

    float coordinates[4][2] = {{0, 0}, {0, 0}, {0, 0}, {0, NAN}};
    desc = square;
    desc.texture_coordinates = coordinates[0];
    refuse(&desc, HELIO_ERR_DATA, "vertex 3 has v = nan");
    coordinates[3][1] = 0;
    coordinates[1][0] = -INFINITY;
    refuse(&desc, HELIO_ERR_DATA, "vertex 1 has u = -inf");
    coordinates[1][0] = 1.1e6f;
    refuse(&desc, HELIO_ERR_DATA, "vertex 1 has u = 1.1e+06");
    desc.texture_count = 0; /* they are checked without textures too */
    refuse(&desc, HELIO_ERR_DATA, "vertex 1");
}

static void meshes_refuse_bad_textures(void **state)
{
    (void)state;
    helio_texture textures[2] = {two_textures[0], two_textures[1]};
    helio_mesh_desc desc = square;
    desc.textures = textures;
    textures[1].width = 0;
    refuse(&desc, HELIO_ERR_DATA, "texture 1: a texture of 0 x 2");
    textures[1].width = 16385;
    refuse(&desc, HELIO_ERR_DATA, "16385 x 2 texels");
    textures[1] = two_textures[1];
    textures[1].wrap_v = (helio_wrap)3;
    refuse(&desc, HELIO_ERR_DATA, "wrap modes 1 and 3");
    textures[1] = two_textures[1];
    textures[1].rgba = NULL;
    refuse(&desc, HELIO_ERR_DATA, "texture 1: it has no texels");
    /* Sizes come before texels are read, or memory is taken. */
    textures[0].width = 16384;
    textures[0].height = 8192;
    textures[1] = two_textures[1];
    refuse(&desc, HELIO_ERR_DATA, "up to number 1 take more than the 512 MiB");
}

static void meshes_keep_texels_of_their_own(void **state)
{
    (void)state;
    uint8_t texels[2][2][4];
    memcpy(texels, four, sizeof texels);
    helio_texture textures[2] = {two_textures[0], two_textures[1]};
    textures[1].rgba = texels[0][0];
    helio_mesh_desc desc = square;
    desc.textures = textures;
    helio_mesh *mesh;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    memset(texels, 0, sizeof texels);
    assert_int_equal(mesh->texture_count, 2);
    assert_memory_equal(mesh->textures[1].rgba, four, sizeof four);
    assert_int_equal(mesh->textures[1].wrap_u, HELIO_WRAP_CLAMP);
    assert_memory_equal(mesh->texture_coordinates, square_coordinates, sizeof square_coordinates);
    assert_memory_equal(mesh->material_textures, &square_textures, sizeof square_textures);
    helio_mesh_destroy(context, mesh);

    desc.texture_count = 0;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    assert_non_null(mesh->texture_coordinates);
    assert_null(mesh->textures);
    assert_null(mesh->material_textures);
    helio_mesh_destroy(context, mesh);
}

/* ---- what is seen ---- */

#if HELIO_WITH_EMBREE

/* What is seen of a square at this point of it. */
static helio_material seen_at(const helio_scene *scene, float x, float y)
{
    scene_hit hit;
    assert_true(scene_intersect(scene, (vec3){x, y, 2}, (vec3){0, 0, -1}, &hit));
    return hit.material;
}

static void textures_multiply_the_material(void **state)
{
    (void)state;
    helio_mesh *mesh;
    helio_scene *scene;
    assert_ok(helio_mesh_create(context, &square, &mesh));
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh}, &scene));
    const texture_curve srgb = texture_curve_srgb();
    helio_material seen = seen_at(scene, -0.5f, 0.5f); /* upper left: the first texel */
    assert_colour(seen.diffuse, 0.5 * (double)srgb.value[10], 0, 0, 1e-6);
    assert_near((double)seen.roughness, 0.8 * 0.2, 1e-6);
    assert_near((double)seen.metallic, 0.5 * 0.4, 1e-6);
    assert_int_equal(seen.kind, HELIO_MATERIAL_GGX);
    seen = seen_at(scene, 0.5f, -0.5f);
    assert_colour(seen.diffuse, 0.5 * (double)srgb.value[40], 1, 1, 1e-6);
    helio_scene_destroy(scene);

    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh, .material = &square_material}, &scene));
    seen = seen_at(scene, -0.5f, 0.5f);
    assert_memory_equal(&seen, &square_material, sizeof seen);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void only_ggx_takes_metallic_roughness(void **state)
{
    (void)state;
    const helio_material phong = {.kind = HELIO_MATERIAL_PHONG,
                                  .diffuse = {0.5f, 0.5f, 0.5f},
                                  .specular = {0.5f, 0.25f, 0},
                                  .exponent = 9,
                                  .roughness = 0.7f};
    helio_mesh_desc desc = square;
    desc.materials = &phong;
    helio_mesh *mesh;
    helio_scene *scene;
    assert_ok(helio_mesh_create(context, &desc, &mesh));
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh}, &scene));
    helio_material seen = seen_at(scene, 0.5f, 0.5f);
    assert_colour(seen.diffuse, 0.5 * (double)texture_curve_srgb().value[20], 0.5, 0, 1e-6);
    assert_colour(seen.specular, 0.5, 0.25, 0, 0);
    assert_near((double)seen.roughness, 0.7, 1e-7);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

#endif

/* ---- pictures ---- */

#if HELIO_WITH_PNG

/* Makes a PNG of 8 bit RGBA in memory that free() releases. */
static unsigned char *make_png(uint32_t width, uint32_t height, const uint8_t *rgba, size_t *size)
{
    png_image image = {.version = PNG_IMAGE_VERSION, .width = width, .height = height, .format = PNG_FORMAT_RGBA};
    png_alloc_size_t bytes = 0;
    assert_true(png_image_write_to_memory(&image, NULL, &bytes, 0, rgba, 0, NULL));
    unsigned char *png = malloc(bytes);
    assert_non_null(png);
    assert_true(png_image_write_to_memory(&image, png, &bytes, 0, rgba, 0, NULL));
    *size = bytes;
    return png;
}

static void png_texels_are_those_of_the_file(void **state)
{
    (void)state;
    uint8_t rgba[256][4];
    for (unsigned i = 0; i < 256; i++) {
        const uint8_t texel[4] = {(uint8_t)i, (uint8_t)(255 - i), (uint8_t)(i * 7), (uint8_t)(i * 3)};
        memcpy(rgba[i], texel, 4);
    }
    size_t size;
    unsigned char *png = make_png(16, 16, rgba[0], &size);
    helio_texture texture = {.wrap_u = HELIO_WRAP_MIRROR};
    assert_ok(texture_decode(context, "all.png", png, size, TEXTURE_MAX_BYTES, NULL, &texture));
    assert_int_equal(texture.width, 16);
    assert_int_equal(texture.height, 16);
    assert_int_equal(texture.wrap_u, HELIO_WRAP_MIRROR);
    assert_memory_equal(texture.rgba, rgba, sizeof rgba);
    texture_release(context, &texture);

    assert_refused(texture_decode(context, "all.png", png, size, 1023, NULL, &texture), HELIO_ERR_DATA,
                   "all.png is too large: 16 x 16 pixels, where 255 in all are allowed; if you trust it, raise");
    assert_refused(texture_decode(context, "all.png", png, size, 1023, "make room", &texture), HELIO_ERR_DATA,
                   "where 255 in all are allowed; make room");
    assert_refused(texture_decode(context, "all.png", png, size / 2, 1024, NULL, &texture), HELIO_ERR_DATA, "all.png");
    assert_null(texture.rgba);
    free(png);
}

/* The nearest of 256: 128 of 65535 is nearer to 0, 129 to 1. */
static void png_of_16_bits_becomes_8(void **state)
{
    (void)state;
    const uint16_t rgba[2][4] = {{0, 128, 129, 65535}, {65535, 65406, 257 * 77 + 128, 65535}};
    png_image image = {.version = PNG_IMAGE_VERSION, .width = 2, .height = 1, .format = PNG_FORMAT_LINEAR_RGB_ALPHA};
    unsigned char png[1024];
    png_alloc_size_t size = sizeof png;
    assert_true(png_image_write_to_memory(&image, png, &size, 0, rgba, 0, NULL));
    helio_texture texture = {0};
    assert_ok(texture_decode(context, "deep.png", png, size, TEXTURE_MAX_BYTES, NULL, &texture));
    const uint8_t expected[8] = {0, 0, 1, 255, 255, 254, 77, 255};
    assert_memory_equal(texture.rgba, expected, sizeof expected);
    texture_release(context, &texture);
}

static void large_pictures_are_refused(void **state)
{
    (void)state;
    uint8_t *rgba = calloc(16385, 4);
    size_t size;
    helio_texture texture = {0};
    unsigned char *png = make_png(16385, 1, rgba, &size);
    assert_refused(texture_decode(context, "wide.png", png, size, TEXTURE_MAX_BYTES, NULL, &texture), HELIO_ERR_DATA,
                   "wide.png is too large: 16385 x 1 pixels, where 16384");
    free(png);
    png = make_png(1, 16384, rgba, &size);
    assert_ok(texture_decode(context, "high.png", png, size, TEXTURE_MAX_BYTES, NULL, &texture));
    assert_int_equal(texture.height, 16384);
    texture_release(context, &texture);
    free(png);
    free(rgba);
}

#else

static void png_textures_need_png(void **state)
{
    (void)state;
    const unsigned char png[] = "\x89PNG\r\n\x1a\n";
    helio_texture texture = {0};
    assert_refused(texture_decode(context, "a.png", png, 8, TEXTURE_MAX_BYTES, NULL, &texture), HELIO_ERR_UNSUPPORTED,
                   "a.png is PNG, which this build cannot read");
}

#endif

#if HELIO_WITH_JPEG
static void jpeg_texels_are_those_of_the_file(void **state)
{
    (void)state;
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr errors;
    unsigned char *bytes = NULL;
    unsigned long size = 0;
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = jpeg.image_height = 8;
    jpeg.input_components = 1;
    jpeg.in_color_space = JCS_GRAYSCALE;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 100, TRUE);
    jpeg_start_compress(&jpeg, TRUE);
    JSAMPLE row[8];
    memset(row, 200, sizeof row);
    for (int i = 0; i < 8; i++)
        jpeg_write_scanlines(&jpeg, &(JSAMPROW){row}, 1);
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);

    helio_texture texture = {0};
    assert_ok(texture_decode(context, "grey.jpg", bytes, size, TEXTURE_MAX_BYTES, NULL, &texture));
    free(bytes);
    assert_int_equal(texture.width, 8);
    for (size_t i = 0; i < 64; i++)
        assert_memory_equal(texture.rgba + 4 * i, ((uint8_t[4]){200, 200, 200, 255}), 4);
    texture_release(context, &texture);
}
#endif

static void textures_are_png_or_jpeg(void **state)
{
    (void)state;
    const char pfm[] = "PF\n1 1\n-1\n............";
    helio_texture texture = {0};
    assert_refused(
        texture_decode(context, "a.pfm", (const unsigned char *)pfm, sizeof pfm - 1, TEXTURE_MAX_BYTES, NULL, &texture),
        HELIO_ERR_DATA, "a.pfm is PFM, which cannot be used here; give PNG or JPEG");
    assert_refused(texture_decode(context, "a.tga", (const unsigned char *)"", 0, TEXTURE_MAX_BYTES, NULL, &texture),
                   HELIO_ERR_DATA, "empty");
}

/* ---- files ---- */

#if HELIO_WITH_PNG && HELIO_WITH_ASSIMP && HELIO_WITH_EMBREE

static char folder[TEST_PATH_SIZE];

static int start_in_folder(void **state)
{
    make_directory(folder);
    return start(state);
}

static int stop_in_folder(void **state)
{
    remove_directory(folder);
    return stop(state);
}

static const char *path_of(const char *name)
{
    static char path[2 * TEST_PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void write_file(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(path_of(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Red, green / blue, white: 8 x 8, in quarters. As numbers of metallic-roughness: roughness is green, metallic is blue.
 */
static unsigned char *make_quarters(size_t *size)
{
    static const uint8_t colours[2][2][4] = {{{255, 0, 0, 255}, {0, 255, 0, 255}},
                                             {{0, 0, 255, 255}, {255, 255, 255, 255}}};
    uint8_t rgba[8][8][4];
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            memcpy(rgba[y][x], colours[y / 4][x / 4], 4);
    return make_png(8, 8, rgba[0][0], size);
}

static void write_quarters(const char *name)
{
    size_t size;
    unsigned char *png = make_quarters(&size);
    write_file(name, png, size);
    free(png);
}

static helio_mesh *load(const char *name)
{
    helio_mesh *mesh;
    assert_ok(helio_mesh_load(context, path_of(name), NULL, &mesh));
    return mesh;
}

static void load_and_see(const char *name, helio_material seen[2][2])
{
    helio_mesh *mesh = load(name);
    helio_scene *scene;
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh}, &scene));
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 2; column++)
            seen[row][column] = seen_at(scene, (float)column - 0.5f, 0.5f - (float)row);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void assert_quarters(helio_material seen[2][2], double factor)
{
    assert_colour(seen[0][0].diffuse, factor, 0, 0, 1e-6);
    assert_colour(seen[0][1].diffuse, 0, factor, 0, 1e-6);
    assert_colour(seen[1][0].diffuse, 0, 0, factor, 1e-6);
    assert_colour(seen[1][1].diffuse, factor, factor, factor, 1e-6);
}

static void assert_plain(helio_material seen[2][2], double factor)
{
    for (int i = 0; i < 4; i++)
        assert_colour(seen[i / 2][i % 2].diffuse, factor, factor, factor, 1e-6);
}

/* One warning, that names all of these words. */
static void assert_warning(const char *first, const char *second)
{
    const char *end = strchr(log_text, '\n');
    if (end == NULL || end[1] != 0 || strstr(log_text, first) == NULL || strstr(log_text, second) == NULL)
        fail_msg("not one warning with \"%s\" and \"%s\":\n%s", first, second, log_text);
    log_text[0] = 0;
}

static void write_obj(const char *material)
{
    static const char obj[] = "mtllib a.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                              "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3 4/4\n";
    char text[1024];
    int length = snprintf(text, sizeof text, "newmtl a\n%s\n", material);
    write_file("a.obj", obj, sizeof obj - 1);
    write_file("a.mtl", text, (size_t)length);
}

/* A glTF square: JSON about its material, textures and images, and bytes of a picture, or NULL. */
typedef struct gltf {
    const char *json;
    const unsigned char *picture; /* buffer view 4 */
    size_t picture_size;
} gltf;

enum { GEOMETRY_BYTES = 48 + 32 + 32 + 12 };

/* Second set of texture coordinates: mirrored left to right. */
static void fill_geometry(unsigned char bytes[GEOMETRY_BYTES])
{
    const float mirrored[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
    const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    memcpy(bytes, square_positions, 48);
    memcpy(bytes + 48, square_coordinates, 32);
    memcpy(bytes + 80, mirrored, 32);
    memcpy(bytes + 112, indices, 12);
}

static int print_json(char *text, size_t size, const gltf *g, const char *buffer_uri)
{
    size_t picture = g->picture_size ? g->picture_size : 4;
    return snprintf(
        text, size,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"buffers\":[{%s\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":80,\"byteLength\":32},"
        "{\"buffer\":0,\"byteOffset\":112,\"byteLength\":12},{\"buffer\":0,\"byteOffset\":124,\"byteLength\":%zu}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[-1,-1,0],\"max\":[1,1,0]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1,\"TEXCOORD_1\":2},"
        "\"indices\":3,\"material\":0}]}],%s}",
        buffer_uri, (size_t)GEOMETRY_BYTES + picture, picture, g->json);
}

static void write_gltf(const char *json)
{
    char text[4096];
    unsigned char bytes[GEOMETRY_BYTES + 4] = {0};
    int length = print_json(text, sizeof text, &(gltf){.json = json}, "\"uri\":\"a.bin\",");
    assert_in_range(length, 1, sizeof text - 1);
    fill_geometry(bytes);
    write_file("a.bin", bytes, sizeof bytes);
    write_file("a.gltf", text, (size_t)length);
}

static void write_glb(const gltf *g)
{
    static unsigned char bytes[16384];
    char *text = (char *)bytes + 20;
    int length = print_json(text, 4096, g, "");
    assert_in_range(length, 1, 4095);
    while (length % 4 != 0)
        text[length++] = ' ';
    size_t binary = (GEOMETRY_BYTES + g->picture_size + 3) / 4 * 4, total = 28 + (size_t)length + binary;
    assert_true(total <= sizeof bytes);
    unsigned char *chunk = bytes + 20 + length;
    memset(chunk, 0, 8 + binary);
    fill_geometry(chunk + 8);
    memcpy(chunk + 8 + GEOMETRY_BYTES, g->picture, g->picture_size);
    const uint32_t head[5] = {0x46546c67, 2, (uint32_t)total, (uint32_t)length, 0x4e4f534a};
    const uint32_t chunk_head[2] = {(uint32_t)binary, 0x004e4942};
    memcpy(bytes, head, sizeof head);
    memcpy(chunk, chunk_head, sizeof chunk_head);
    write_file("a.glb", bytes, total);
}

#define BOTH_TEXTURES                                                                                                  \
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"metallicFactor\":0.5,"            \
    "\"roughnessFactor\":0.25,\"baseColorTexture\":{\"index\":0},\"metallicRoughnessTexture\":{\"index\":0}}}],"       \
    "\"textures\":[{\"source\":0}],"
#define COLOUR_TEXTURE                                                                                                 \
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"baseColorTexture\":{\"index\":0"  \
    "}}}],\"textures\":[{\"source\":0}],"

static void obj_textures_are_upright(void **state)
{
    (void)state;
    helio_material seen[2][2];
    write_quarters("quarters.png");
    write_obj("Kd 0.5 0.5 0.5\nmap_Kd quarters.png");
    load_and_see("a.obj", seen);
    assert_quarters(seen, 0.5);
    assert_int_equal(seen[0][0].kind, HELIO_MATERIAL_DIFFUSE);
    write_obj("Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 30\nmap_Kd quarters.png");
    load_and_see("a.obj", seen);
    assert_quarters(seen, 0.5);
    assert_colour(seen[0][1].specular, 0.5, 0.5, 0.5, 1e-6);
    assert_string_equal(log_text, "");
}

static void gltf_textures_are_upright(void **state)
{
    (void)state;
    helio_material seen[2][2];
    write_quarters("a b.png"); /* names are URIs */
    write_gltf(BOTH_TEXTURES "\"images\":[{\"uri\":\"a%20b.png\"}]");
    load_and_see("a.gltf", seen);
    assert_quarters(seen, 0.5);
    for (int i = 0; i < 4; i++) {
        assert_near((double)seen[i / 2][i % 2].roughness, i & 1 ? 0.25 : 0, 1e-6);
        assert_near((double)seen[i / 2][i % 2].metallic, i & 2 ? 0.5 : 0, 1e-6);
    }
    assert_string_equal(log_text, "");
    helio_mesh *mesh = load("a.gltf");
    assert_int_equal(mesh->texture_count, 1); /* one picture, read once */
    helio_mesh_destroy(context, mesh);
}

static void glb_textures_are_upright(void **state)
{
    (void)state;
    gltf g = {.json = BOTH_TEXTURES "\"images\":[{\"bufferView\":4,\"mimeType\":\"image/png\"}]"};
    unsigned char *png = make_quarters(&g.picture_size);
    g.picture = png;
    write_glb(&g);
    helio_material seen[2][2];
    load_and_see("a.glb", seen);
    assert_quarters(seen, 0.5);
    assert_near((double)seen[0][1].roughness, 0.25, 1e-6);
    assert_string_equal(log_text, "");

    png[40] ^= 0x55;
    write_glb(&g);
    load_and_see("a.glb", seen);
    assert_plain(seen, 0.5);
    assert_near((double)seen[0][1].roughness, 0.25, 1e-6);
    assert_warning("a.glb: a texture is left out", "picture 0");
    free(png);
}

static void wrap_modes_and_coordinates_are_the_files(void **state)
{
    (void)state;
    write_quarters("a.png");
    write_gltf("\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],\"baseColorTexture\":"
               "{\"index\":0,\"texCoord\":1},\"metallicRoughnessTexture\":{\"index\":0}}}],"
               "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33648}],"
               "\"textures\":[{\"source\":0,\"sampler\":0}],\"images\":[{\"uri\":\"a.png\"}]");
    helio_material seen[2][2];
    load_and_see("a.gltf", seen);
    assert_colour(seen[0][0].diffuse, 0, 0.5, 0, 1e-6); /* mirrored */
    assert_colour(seen[0][1].diffuse, 0.5, 0, 0, 1e-6);
    assert_near((double)seen[0][0].roughness, 1, 1e-6);
    assert_warning("a.gltf: a metallic-roughness texture is left out", "other texture coordinates");
    helio_mesh *mesh = load("a.gltf");
    assert_int_equal(mesh->textures[0].wrap_u, HELIO_WRAP_CLAMP);
    assert_int_equal(mesh->textures[0].wrap_v, HELIO_WRAP_MIRROR);
    assert_near((double)mesh->texture_coordinates[0], 1, 1e-6);
    helio_mesh_destroy(context, mesh);

    write_obj("Kd 0.5 0.5 0.5\nmap_Kd -clamp on a.png");
    mesh = load("a.obj");
    assert_int_equal(mesh->textures[0].wrap_u, HELIO_WRAP_CLAMP);
    helio_mesh_destroy(context, mesh);
    write_obj("Kd 0.5 0.5 0.5\nmap_Kd a.png");
    mesh = load("a.obj");
    assert_int_equal(mesh->textures[0].wrap_u, HELIO_WRAP_REPEAT);
    helio_mesh_destroy(context, mesh);
}

static void textures_are_found_from_the_folder_of_the_mesh(void **state)
{
    (void)state;
    helio_material seen[2][2];
    assert_int_equal(mkdir(path_of("sub"), 0777), 0);
    write_quarters("sub/q.png");
    static const char *const inside[] = {"map_Kd sub/q.png", "map_Kd sub\\q.png", "map_Kd ./sub/../sub/q.png"};
    for (size_t i = 0; i < sizeof inside / sizeof *inside; i++) {
        write_obj(inside[i]);
        load_and_see("a.obj", seen);
        assert_colour(seen[0][1].diffuse, 0, (double)seen[1][1].diffuse[0], 0, 1e-6);
        assert_string_equal(log_text, "");
    }
    char text[3 * TEST_PATH_SIZE];
    snprintf(text, sizeof text, "map_Kd ..%s/sub/q.png", strrchr(folder, '/'));
    write_obj(text);
    load_and_see("a.obj", seen);
    assert_string_equal(log_text, "");
    /* An absolute name is only a hint: nothing outside is opened, even if it is there. */
    write_obj("map_Kd C:\\somewhere\\r.png");
    load_and_see("a.obj", seen);
    assert_warning("a.obj: a texture is left out", "/r.png cannot be opened: No such file");
    snprintf(text, sizeof text, "map_Kd %s", path_of("sub/q.png"));
    write_obj(text);
    load_and_see("a.obj", seen);
    assert_warning("a.obj: a texture is left out", "/q.png cannot be opened: No such file");
    write_quarters("q.png");
    load_and_see("a.obj", seen);
    assert_string_equal(log_text, "");
    assert_colour(seen[0][0].diffuse, (double)seen[1][1].diffuse[0], 0, 0, 1e-6);
}

static void missing_and_damaged_textures_leave_the_factor(void **state)
{
    (void)state;
    helio_material seen[2][2];
    write_gltf(BOTH_TEXTURES "\"images\":[{\"uri\":\"none.png\"}]");
    load_and_see("a.gltf", seen);
    assert_plain(seen, 0.5);
    assert_near((double)seen[0][0].roughness, 0.25, 1e-6);
    assert_warning("a.gltf: a texture is left out", "none.png cannot be opened: No such file");

    size_t size;
    unsigned char *png = make_quarters(&size);
    write_file("cut.png", png, size / 2);
    write_obj("Kd 0.5 0.5 0.5\nmap_Kd cut.png");
    load_and_see("a.obj", seen);
    assert_plain(seen, 0.5);
    assert_warning("a.obj: a texture is left out", "cut.png cannot be read as PNG");
    free(png);
    write_file("other.png", "not a picture", 13);
    write_obj("Kd 0.5 0.5 0.5\nmap_Kd other.png");
    load_and_see("a.obj", seen);
    assert_plain(seen, 0.5);
    assert_warning("a.obj: a texture is left out", "other.png is not a picture that can be read");
    write_obj("Kd 0.5 0.5 0.5\nmap_Kd sub");
    assert_int_equal(mkdir(path_of("sub"), 0777), 0);
    load_and_see("a.obj", seen);
    assert_plain(seen, 0.5);
    assert_warning("a.obj: a texture is left out", "sub is not a file");
}

static void transforms_of_textures_are_left_out(void **state)
{
    (void)state;
    helio_material seen[2][2];
    write_quarters("a.png");
    write_gltf("\"extensionsUsed\":[\"KHR_texture_transform\"],\"materials\":[{\"pbrMetallicRoughness\":{"
               "\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"scale\":[2,2]}}}}}],"
               "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"a.png\"}]");
    load_and_see("a.gltf", seen);
    assert_quarters(seen, 1);
    assert_warning("a.gltf: ", "scales textures, which is left out");
}

static void no_memory_is_an_error_and_no_leak(void **state)
{
    (void)state;
    gltf g = {.json = COLOUR_TEXTURE "\"images\":[{\"bufferView\":4,\"mimeType\":\"image/png\"}]"};
    unsigned char *png = make_quarters(&g.picture_size);
    g.picture = png;
    write_glb(&g);
    free(png);
    helio_status status = HELIO_ERR_MEMORY;
    for (size_t allowed = 2; status != HELIO_OK; allowed++) {
        memory_count count = {.refuse_after = allowed};
        helio_context *own = make_context(1, &count);
        helio_mesh *mesh;
        status = helio_mesh_load(own, path_of("a.glb"), &(helio_mesh_load_desc){.in_process = true}, &mesh);
        if (status == HELIO_OK)
            assert_int_equal(mesh->texture_count, 1);
        else
            assert_int_equal(status, HELIO_ERR_MEMORY);
        helio_mesh_destroy(own, mesh);
        helio_context_destroy(own);
        assert_int_equal(atomic_load(&count.live), 0);
        assert_true(allowed < 100);
    }
}

/* As a user sees it: the picture's upper left is red, and so on. */
static void rendered_albedo_shows_the_texture(void **state)
{
    (void)state;
    enum { SIZE = 16 };
    write_quarters("a.png");
    write_gltf(COLOUR_TEXTURE "\"images\":[{\"uri\":\"a.png\"}]");
    helio_mesh *mesh = load("a.gltf");
    helio_scene *scene;
    helio_renderer *renderer;
    const float white[2][3] = {{1, 1, 1}, {1, 1, 1}};
    helio_environment *environment = make_environment(context, HELIO_LAYOUT_LATLONG, 2, 1, 16, white[0], NULL);
    assert_ok(helio_scene_create(context, &(helio_scene_desc){.mesh = mesh}, &scene));
    const helio_renderer_desc desc = {
        .environment = environment, .scene = scene, .width = SIZE, .height = SIZE, .spp = 1, .aovs = true};
    assert_ok(helio_renderer_create(context, &desc, &renderer));
    helio_frame_desc frame = {.seed = 1};
    assert_ok(helio_camera_parse("lookat:eye=0,0,3,at=0,0,0,fov=30", mesh, 1.0f, &frame.camera));
    assert_ok(helio_renderer_render(renderer, &frame, NULL));
    helio_picture picture = helio_renderer_picture(renderer);
    for (size_t row = 0; row < SIZE; row++)
        for (size_t column = 0; column < SIZE; column++) {
            bool right = column >= SIZE / 2, low = row >= SIZE / 2;
            if (row == SIZE / 2 || row == SIZE / 2 - 1 || column == SIZE / 2 || column == SIZE / 2 - 1)
                continue; /* where the quarters meet */
            assert_colour(picture.albedo + 3 * (row * SIZE + column), right == low ? 0.5 : 0, right ? 0.5 : 0,
                          low ? 0.5 : 0, 1e-6);
        }
    helio_renderer_destroy(renderer);
    helio_environment_destroy(environment);
    helio_scene_destroy(scene);
    helio_mesh_destroy(context, mesh);
}

static void the_flight_helmet_has_its_textures(void **state)
{
    char path[TEST_PATH_SIZE];
    find_test_data("meshes/gltf/FlightHelmet/FlightHelmet.gltf", path);
    assert_int_equal(start(state), 0);
    helio_mesh *mesh;
    assert_ok(helio_mesh_load(context, path, NULL, &mesh));
    assert_int_equal(mesh->texture_count, 10);
    for (uint32_t i = 0; i < mesh->material_count; i++) {
        assert_in_range(mesh->material_textures[i].base_colour, 1, 10);
        assert_in_range(mesh->material_textures[i].metallic_roughness, 1, 10);
    }
    assert_non_null(strstr(log_text, "normal maps of 6 materials"));
    assert_null(strstr(log_text, "texture")); /* none is left out that ours could have */
    helio_mesh_destroy(context, mesh);
    stop(state);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lookup_is_bilinear_between_centres),
        cmocka_unit_test(texels_repeat_stay_or_are_mirrored),
        cmocka_unit_test(colours_are_decoded_before_they_are_mixed),
        cmocka_unit_test_setup_teardown(meshes_refuse_textures_that_do_not_fit, start, stop),
        cmocka_unit_test_setup_teardown(meshes_refuse_bad_textures, start, stop),
        cmocka_unit_test_setup_teardown(meshes_keep_texels_of_their_own, start, stop),
#if HELIO_WITH_EMBREE
        cmocka_unit_test_setup_teardown(textures_multiply_the_material, start, stop),
        cmocka_unit_test_setup_teardown(only_ggx_takes_metallic_roughness, start, stop),
#endif
#if HELIO_WITH_PNG
        cmocka_unit_test_setup_teardown(png_texels_are_those_of_the_file, start, stop),
        cmocka_unit_test_setup_teardown(png_of_16_bits_becomes_8, start, stop),
        cmocka_unit_test_setup_teardown(large_pictures_are_refused, start, stop),
#else
        cmocka_unit_test_setup_teardown(png_textures_need_png, start, stop),
#endif
#if HELIO_WITH_JPEG
        cmocka_unit_test_setup_teardown(jpeg_texels_are_those_of_the_file, start, stop),
#endif
        cmocka_unit_test_setup_teardown(textures_are_png_or_jpeg, start, stop),
#if HELIO_WITH_PNG && HELIO_WITH_ASSIMP && HELIO_WITH_EMBREE
        cmocka_unit_test_setup_teardown(obj_textures_are_upright, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(gltf_textures_are_upright, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(glb_textures_are_upright, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(wrap_modes_and_coordinates_are_the_files, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(textures_are_found_from_the_folder_of_the_mesh, start_in_folder,
                                        stop_in_folder),
        cmocka_unit_test_setup_teardown(missing_and_damaged_textures_leave_the_factor, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(transforms_of_textures_are_left_out, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(no_memory_is_an_error_and_no_leak, start_in_folder, stop_in_folder),
        cmocka_unit_test_setup_teardown(rendered_albedo_shows_the_texture, start_in_folder, stop_in_folder),
        cmocka_unit_test(the_flight_helmet_has_its_textures),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
