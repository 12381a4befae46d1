/* SPDX-License-Identifier: MIT
 *
 * Memory that runs out: every allocation of every function that takes memory is refused in turn, alone and with all
 * that follow. Each time a status and a sentence come back, nothing leaks and nothing is left half made. */
#include "support.h"

#include <heliostat/heliostat.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#if HELIO_WITH_OPENEXR
#include <ImfCRgbaFile.h>
#endif
#if HELIO_WITH_JPEG
#include <jpeglib.h>
#endif
#if HELIO_WITH_ASSIMP
#include <zlib.h>
#endif

enum { WIDTH = 8, HEIGHT = 4, PIXELS = WIDTH * HEIGHT };

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* ---- memory that runs out ---------------------------------------------------------------- */

typedef struct scarce_memory {
    atomic_size_t taken; /* allocations since it was last armed */
    atomic_size_t live, refused;
    size_t first, last; /* those that are refused, counted from 0 */
} scarce_memory;

static void *scarce_allocate(void *user, size_t bytes, size_t alignment)
{
    scarce_memory *memory = user;
    size_t number = atomic_fetch_add(&memory->taken, 1);
    if (number >= memory->first && number <= memory->last) {
        atomic_fetch_add(&memory->refused, 1);
        return NULL;
    }
    void *block = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    atomic_fetch_add(&memory->live, block != NULL);
    return block;
}

static void scarce_release(void *user, void *block)
{
    scarce_memory *memory = user;
    atomic_fetch_sub(&memory->live, 1);
    free(block);
}

static void arm(scarce_memory *memory, size_t first, size_t last)
{
    memory->first = first;
    memory->last = last;
    memory->taken = memory->refused = 0;
}

static void disarm(scarce_memory *memory)
{
    arm(memory, SIZE_MAX, SIZE_MAX);
}

/* ---- hosts ------------------------------------------------------------------------------- */

/* What an engine might do: all pieces on its own thread, the last one first. */
static void run_backwards(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    while (count-- > 0)
        body(data, count);
}

static void ignore_message(void *user, helio_log_level level, const char *message)
{
    (void)user;
    (void)level;
    (void)message;
}

static const struct {
    uint32_t threads;
    bool own_loop;
} hosts[] = {{1, false}, {2, false}, {2, true}};

/* Everything that work may need, made while there is memory. */
typedef struct world {
    scarce_memory memory;
    helio_context_desc desc;
    helio_context *context;
    char folder[TEST_PATH_SIZE];
    char path[TEST_PATH_SIZE + 64]; /* of the file that the work is about */
    helio_mesh *mesh;
    helio_environment *environment;
    helio_tables *tables;
} world;

static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
static const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
static const float coordinates[4][2] = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
static const uint8_t texels[4] = {1, 2, 3, 255};
static float pixels[PIXELS * 4];

/* Of everything that a mesh can have, but normals: they are computed, which takes memory too. */
static helio_mesh_desc full_desc(void)
{
    static const uint32_t triangle_materials[4] = {0, 1, 1, 0};
    static const helio_material materials[2] = {{.diffuse = {1, 1, 1}}, {.diffuse = {0.5f, 0, 0}}};
    static const helio_texture textures[2] = {{1, 1, HELIO_WRAP_CLAMP, HELIO_WRAP_REPEAT, texels},
                                              {1, 1, HELIO_WRAP_REPEAT, HELIO_WRAP_MIRROR, texels}};
    static const helio_material_textures material_textures[2] = {{1, 0}, {2, 1}};
    return (helio_mesh_desc){.vertex_count = 4,
                             .triangle_count = 4,
                             .positions = positions[0],
                             .triangles = triangles[0],
                             .material_count = 2,
                             .triangle_materials = triangle_materials,
                             .materials = materials,
                             .texture_coordinates = coordinates[0],
                             .texture_count = 2,
                             .textures = textures,
                             .material_textures = material_textures};
}

static void make_world(world *w, size_t host)
{
    *w = (world){0};
    w->desc = (helio_context_desc){.threads = hosts[host].threads,
                                   .log = ignore_message,
                                   .allocate = scarce_allocate,
                                   .release = scarce_release,
                                   .user = &w->memory};
    if (hosts[host].own_loop)
        w->desc.parallel_for = run_backwards;
    disarm(&w->memory);
    for (size_t i = 0; i < COUNT(pixels); i++)
        pixels[i] = 0.25f * (float)(i % 5);
    make_directory(w->folder);
    assert_ok(helio_context_create(&w->desc, &w->context));
    const helio_mesh_desc mesh = full_desc();
    assert_ok(helio_mesh_create(w->context, &mesh, &w->mesh));
    w->environment = make_environment(w->context, HELIO_LAYOUT_LATLONG, WIDTH, HEIGHT, 4, pixels, NULL);
    assert_ok(helio_tables_create(w->environment, HELIO_WEIGHTING_SOLID_ANGLE, &w->tables));
    assert_ok(helio_tables_update(w->tables));
}

static void destroy_world(world *w)
{
    helio_tables_destroy(w->tables);
    helio_environment_destroy(w->environment);
    helio_mesh_destroy(w->context, w->mesh);
    helio_context_destroy(w->context);
    assert_int_equal(w->memory.live, 0);
    remove_directory(w->folder);
}

static void name_file(world *w, const char *name)
{
    snprintf(w->path, sizeof w->path, "%s/%s", w->folder, name);
}

static size_t count_files(const world *w)
{
    DIR *folder = opendir(w->folder);
    assert_non_null(folder);
    size_t count = 0;
    while (readdir(folder) != NULL)
        count++;
    closedir(folder);
    return count;
}

/* ---- the harness ---------------------------------------------------------------------------- */

/* Does something that takes memory and, where that succeeds, gives all of it back. */
typedef helio_status (*scenario)(world *w);

/* What stays in the last error if a function fails without a sentence of its own. */
static const char OLD_SENTENCE[] = "a sentence from before";

static void assert_failed_cleanly(const world *w, helio_status status, size_t number)
{
    /* Where another process did the work, its memory ran out, and it may say so in other words. */
    if (w->memory.refused > 0 && status != HELIO_ERR_MEMORY)
        fail_msg("allocation %zu was refused, which is no %s: %s", number, helio_status_name(status),
                 helio_last_error());
    const char *sentence = helio_last_error();
    assert_true(strlen(sentence) > 10 && strstr(sentence, OLD_SENTENCE) == NULL && strchr(sentence, '\n') == NULL);
}

/* Refuses allocation 0, 1, 2, ... until none is left to be refused. Returns how many there were. */
static size_t refuse_each(world *w, scenario work, bool alone)
{
    size_t live = w->memory.live, files = count_files(w);
    for (size_t number = 0;; number++) {
        assert_true(number < 1000);
        helio_layout layout;
        assert_int_equal(helio_layout_parse(OLD_SENTENCE, &layout), HELIO_ERR_ARGUMENT);
        arm(&w->memory, number, alone ? number : SIZE_MAX);
        helio_status status = work(w);
        bool refused = w->memory.refused > 0;
        if (status != HELIO_OK)
            assert_failed_cleanly(w, status, number);
        disarm(&w->memory);
        assert_int_equal(w->memory.live, live);
        if (status != HELIO_OK)
            assert_int_equal(count_files(w), files);
        if (status == HELIO_OK && refused)
            fail_msg("allocation %zu was refused, but the work was done", number);
        if (status == HELIO_OK)
            return number;
    }
}

/* least: how many allocations the work takes at the very least. */
static void refuse_both_ways(world *w, scenario work, size_t least)
{
    for (int alone = 0; alone < 2; alone++) {
        size_t taken = refuse_each(w, work, alone != 0);
        if (taken < least)
            fail_msg("only %zu allocations were refused, where at least %zu were expected", taken, least);
    }
}

/* For every host: makes a world, prepares it (NULL: it is fine as it is), and refuses each allocation of the work. */
static void refuse_in_all_hosts(void (*prepare)(world *w), scenario work, size_t least)
{
    for (size_t host = 0; host < COUNT(hosts); host++) {
        world w;
        make_world(&w, host);
        if (prepare != NULL)
            prepare(&w);
        refuse_both_ways(&w, work, least);
        destroy_world(&w);
    }
}

/* ---- context, meshes, scenes ---------------------------------------------------------------- */

static helio_status create_context(world *w)
{
    helio_context *context = (helio_context *)w;
    helio_status status = helio_context_create(&w->desc, &context);
    assert_true((status == HELIO_OK) == (context != NULL));
    helio_context_destroy(context);
    return status;
}

static void contexts(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_context, 1);
}

static helio_status create_mesh(world *w)
{
    const helio_mesh_desc desc = full_desc();
    helio_mesh *mesh = (helio_mesh *)w;
    helio_status status = helio_mesh_create(w->context, &desc, &mesh);
    assert_true((status == HELIO_OK) == (mesh != NULL));
    helio_mesh_destroy(w->context, mesh);
    return status;
}

static void meshes_from_arrays(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_mesh, 12);
}

#if HELIO_WITH_ASSIMP
static helio_status load_mesh_in(world *w, bool in_process)
{
    const helio_mesh_load_desc desc = {.in_process = in_process};
    helio_mesh *mesh = (helio_mesh *)w;
    helio_status status = helio_mesh_load(w->context, w->path, &desc, &mesh);
    assert_true((status == HELIO_OK) == (mesh != NULL));
    helio_mesh_destroy(w->context, mesh);
    return status;
}

static helio_status load_mesh(world *w)
{
    return load_mesh_in(w, false);
}

static helio_status load_mesh_here(world *w)
{
    return load_mesh_in(w, true);
}

static void write_text(world *w, const char *name, const char *text)
{
    name_file(w, name);
    FILE *stream = fopen(w->path, "w");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
}

/* With two materials, one of which has a texture if this build reads PNG. */
static void prepare_obj(world *w)
{
#if HELIO_WITH_PNG
    name_file(w, "a.png");
    assert_ok(helio_picture_write(w->context, w->path, &(helio_picture){WIDTH, HEIGHT, .rgba = pixels}, NULL));
    write_text(w, "a.mtl", "newmtl one\nKd 1 1 1\nmap_Kd a.png\nnewmtl two\nKd 0.5 0 0\n");
#else
    write_text(w, "a.mtl", "newmtl one\nKd 1 1 1\nnewmtl two\nKd 0.5 0 0\n");
#endif
    write_text(w, "a.obj",
               "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
               "usemtl one\nf 1/1 3/2 2/3\nusemtl two\nf 1/1 2/2 4/3\n");
}

static void prepare_gzip(world *w)
{
    static const char text[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                               "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    name_file(w, "a.ply.gz");
    gzFile file = gzopen(w->path, "wb");
    assert_non_null(file);
    assert_true(gzputs(file, text) > 0 && gzclose(file) == Z_OK);
}

static void meshes_from_files(void **state)
{
    (void)state;
    refuse_in_all_hosts(prepare_obj, load_mesh, 8);
    refuse_in_all_hosts(prepare_obj, load_mesh_here, 12);
    refuse_in_all_hosts(prepare_gzip, load_mesh, 5);
    refuse_in_all_hosts(prepare_gzip, load_mesh_here, 7);
}
#endif

#if HELIO_WITH_EMBREE
static helio_status create_scene(world *w)
{
    helio_scene *scene = (helio_scene *)w;
    const helio_scene_desc desc = {.mesh = w->mesh, .ground = HELIO_GROUND_PLANE};
    helio_status status = helio_scene_create(w->context, &desc, &scene);
    assert_true((status == HELIO_OK) == (scene != NULL));
    helio_scene_destroy(scene);
    return status;
}

static void scenes(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_scene, 1);
}
#endif

/* ---- environments, tables, pools ------------------------------------------------------------- */

static helio_status create_environments(world *w)
{
    static const helio_environment_desc descs[] = {
        {.width = WIDTH, .height = HEIGHT, .cube_size = 4},
        {.width = 12, .height = 2, .cube_size = 3},
        {.width = 2, .height = 12, .cube_size = 3, .layout = HELIO_LAYOUT_STRIP_OPENEXR},
        {.width = 1, .height = 1, .cube_size = 2},
    };
    for (size_t i = 0; i < COUNT(descs); i++) {
        helio_environment *environment = (helio_environment *)w;
        helio_status status = helio_environment_create(w->context, &descs[i], &environment);
        assert_true((status == HELIO_OK) == (environment != NULL));
        helio_environment_destroy(environment);
        if (status != HELIO_OK)
            return status;
    }
    return HELIO_OK;
}

static void environments(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_environments, 16);
}

static helio_status create_tables(world *w)
{
    helio_tables *tables = (helio_tables *)w;
    helio_status status = helio_tables_create(w->environment, HELIO_WEIGHTING_PAPER, &tables);
    assert_true((status == HELIO_OK) == (tables != NULL));
    helio_tables_destroy(tables);
    return status;
}

static void tables(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_tables, 4);
}

static helio_status create_pools(world *w)
{
    for (helio_strategy strategy = HELIO_STRATEGY_AUTO; strategy <= HELIO_STRATEGY_PRODUCT_BRDF; strategy++) {
        helio_pools *pools = (helio_pools *)w;
        const helio_pools_desc desc = {.strategy = strategy, .length = 64};
        helio_status status = helio_pools_create(w->tables, &desc, &pools);
        assert_true((status == HELIO_OK) == (pools != NULL));
        helio_pools_destroy(pools);
        if (status != HELIO_OK)
            return status;
    }
    return HELIO_OK;
}

static void pools(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_pools, 7);
}

/* ---- rendering ---------------------------------------------------------------------------------- */

#if HELIO_WITH_EMBREE
static helio_renderer_desc small_picture(const world *w, const helio_scene *scene)
{
    return (helio_renderer_desc){.environment = w->environment,
                                 .scene = scene,
                                 .width = 6,
                                 .height = 4,
                                 .spp = 4,
                                 .pool_length = 64,
                                 .aovs = true};
}

static helio_status create_renderer(world *w)
{
    helio_scene *scene;
    helio_status status = helio_scene_create(w->context, &(helio_scene_desc){.mesh = w->mesh}, &scene);
    if (status != HELIO_OK)
        return status;
    helio_renderer *renderer = (helio_renderer *)w;
    const helio_renderer_desc desc = small_picture(w, scene);
    status = helio_renderer_create(w->context, &desc, &renderer);
    assert_true((status == HELIO_OK) == (renderer != NULL));
    helio_renderer_destroy(renderer);
    helio_scene_destroy(scene);
    return status;
}

static void renderers(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_renderer, 10);
}

/* Nothing that happens once a frame takes memory: it works where there is none left. */
static void frames_without_memory(void **state)
{
    (void)state;
    for (size_t host = 0; host < COUNT(hosts); host++) {
        world w;
        make_world(&w, host);
        helio_scene *scene;
        helio_renderer *renderer;
        assert_ok(helio_scene_create(w.context, &(helio_scene_desc){.mesh = w.mesh}, &scene));
        const helio_renderer_desc desc = small_picture(&w, scene);
        assert_ok(helio_renderer_create(w.context, &desc, &renderer));
        helio_frame_desc frame = {.seed = 1};
        helio_environment_info info;
        assert_ok(helio_camera_parse("auto", w.mesh, 1.5f, &frame.camera));
        arm(&w.memory, 0, SIZE_MAX);
        for (int i = 0; i < 2; i++) {
            assert_ok(helio_environment_update(w.environment, pixels, &info));
            assert_ok(helio_tables_update(w.tables));
            assert_ok(helio_renderer_render(renderer, &frame, NULL));
        }
        assert_int_equal(w.memory.taken, 0);
        disarm(&w.memory);
        helio_renderer_destroy(renderer);
        helio_scene_destroy(scene);
        destroy_world(&w);
    }
}
#endif

/* ---- pictures -------------------------------------------------------------------------------------- */

static helio_status read_image(world *w)
{
    helio_image *image = (helio_image *)w;
    helio_status status = helio_image_read(w->context, w->path, NULL, &image);
    assert_true((status == HELIO_OK) == (image != NULL));
    helio_image_destroy(w->context, image);
    return status;
}

static helio_status write_image(world *w)
{
    const helio_picture picture = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .rgba = pixels,
                                   .object = pixels,
                                   .albedo = pixels,
                                   .normal = pixels,
                                   .position = pixels,
                                   .depth = pixels};
    const helio_picture_write_desc desc = {.alpha = true};
    helio_status status = helio_picture_write(w->context, w->path, &picture, &desc);
    if (status == HELIO_OK)
        assert_int_equal(remove(w->path), 0);
    return status;
}

static void name_exr(world *w)
{
    name_file(w, "a.exr");
}

static void name_png(world *w)
{
    name_file(w, "a.png");
}

static void name_pfm(world *w)
{
    name_file(w, "a.pfm");
}

static void written_pictures(void **state)
{
    (void)state;
    refuse_in_all_hosts(name_pfm, write_image, 1);
    if (helio_picture_check_path("a.png") == HELIO_OK)
        refuse_in_all_hosts(name_png, write_image, 1);
    if (helio_picture_check_path("a.exr") == HELIO_OK)
        refuse_in_all_hosts(name_exr, write_image, 1);
}

static void write_picture(world *w)
{
    const helio_picture_write_desc desc = {.alpha = true};
    assert_ok(helio_picture_write(w->context, w->path, &(helio_picture){WIDTH, HEIGHT, .rgba = pixels}, &desc));
}

static void prepare_pfm(world *w)
{
    name_pfm(w);
    write_picture(w);
}

static void prepare_radiance(world *w)
{
    name_file(w, "a.hdr");
    FILE *stream = fopen(w->path, "wb");
    assert_non_null(stream);
    fprintf(stream, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", HEIGHT, WIDTH);
    for (int i = 0; i < PIXELS; i++)
        assert_int_equal(fwrite((unsigned char[4]){200, 100, 50, 128}, 1, 4, stream), 4);
    assert_int_equal(fclose(stream), 0);
}

#if HELIO_WITH_PNG
static void prepare_png(world *w)
{
    name_png(w);
    write_picture(w);
}
#endif

#if HELIO_WITH_JPEG
static void prepare_jpeg(world *w)
{
    name_file(w, "a.jpg");
    struct jpeg_compress_struct library;
    struct jpeg_error_mgr errors;
    JSAMPLE row[3 * WIDTH] = {100};
    JSAMPROW rows[] = {row};
    FILE *stream = fopen(w->path, "wb");
    assert_non_null(stream);
    library.err = jpeg_std_error(&errors);
    jpeg_create_compress(&library);
    jpeg_stdio_dest(&library, stream);
    library.image_width = WIDTH;
    library.image_height = HEIGHT;
    library.input_components = 3;
    library.in_color_space = JCS_RGB;
    jpeg_set_defaults(&library);
    jpeg_start_compress(&library, TRUE);
    for (int i = 0; i < HEIGHT; i++)
        jpeg_write_scanlines(&library, rows, 1);
    jpeg_finish_compress(&library);
    jpeg_destroy_compress(&library);
    assert_int_equal(fclose(stream), 0);
}
#endif

#if HELIO_WITH_OPENEXR
static void prepare_exr(world *w)
{
    name_exr(w);
    write_picture(w);
}

/* Luminance and chroma, which only the C++ library reads, and a display window that is larger than the data window. */
static void prepare_chroma(world *w)
{
    static const ImfRgba colours[PIXELS];
    name_exr(w);
    ImfHeader *header = ImfNewHeader();
    ImfHeaderSetDataWindow(header, 0, 0, WIDTH - 1, HEIGHT - 1);
    ImfHeaderSetDisplayWindow(header, -2, -2, WIDTH, HEIGHT);
    ImfHeaderSetCompression(header, IMF_ZIP_COMPRESSION);
    ImfOutputFile *file = ImfOpenOutputFile(w->path, header, IMF_WRITE_YCA);
    assert_non_null(file);
    assert_true(ImfOutputSetFrameBuffer(file, colours, 1, WIDTH));
    assert_true(ImfOutputWritePixels(file, HEIGHT));
    assert_true(ImfCloseOutputFile(file));
    ImfDeleteHeader(header);
}
#endif

static void read_pictures(void **state)
{
    (void)state;
    refuse_in_all_hosts(prepare_pfm, read_image, 3);
    refuse_in_all_hosts(prepare_radiance, read_image, 4);
#if HELIO_WITH_PNG
    refuse_in_all_hosts(prepare_png, read_image, 6);
#endif
#if HELIO_WITH_JPEG
    refuse_in_all_hosts(prepare_jpeg, read_image, 5);
#endif
#if HELIO_WITH_OPENEXR
    refuse_in_all_hosts(prepare_exr, read_image, 5);
    refuse_in_all_hosts(prepare_chroma, read_image, 8);
#endif
}

/* ---- skies and sources ------------------------------------------------------------------------------ */

static helio_status create_sky(world *w)
{
    helio_sky *sky = (helio_sky *)w;
    helio_status status = helio_sky_create(w->context, 8, &sky);
    assert_true((status == HELIO_OK) == (sky != NULL));
    helio_sky_destroy(sky);
    return status;
}

static void skies(void **state)
{
    (void)state;
    refuse_in_all_hosts(NULL, create_sky, 2);
}

/* To its end, where a failure leaves it, too. */
static helio_status read_source(world *w)
{
    helio_source *source = (helio_source *)w;
    helio_status status = helio_source_open(w->context, w->path, NULL, &source);
    assert_true((status == HELIO_OK) == (source != NULL));
    helio_source_frame frame = {.rgb = pixels};
    while (status == HELIO_OK && frame.rgb != NULL)
        status = helio_source_next(source, &frame);
    if (source != NULL && status != HELIO_OK) {
        char sentence[512];
        snprintf(sentence, sizeof sentence, "%s", helio_last_error());
        assert_ok(helio_source_next(source, &frame)); /* it stays at its end */
        assert_null(frame.rgb);
        assert_string_equal(helio_last_error(), sentence);
    }
    helio_source_close(source);
    return status;
}

static void prepare_sequence(world *w)
{
    for (int i = 0; i < 3; i++) {
        char name[16];
        snprintf(name, sizeof name, "s%d.pfm", i);
        name_file(w, name);
        write_picture(w);
    }
    name_file(w, "s%d.pfm");
}

static void sources(void **state)
{
    (void)state;
    refuse_in_all_hosts(prepare_pfm, read_source, 4);
    refuse_in_all_hosts(prepare_sequence, read_source, 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(contexts),
        cmocka_unit_test(meshes_from_arrays),
#if HELIO_WITH_ASSIMP
        cmocka_unit_test(meshes_from_files),
#endif
#if HELIO_WITH_EMBREE
        cmocka_unit_test(scenes),
#endif
        cmocka_unit_test(environments),
        cmocka_unit_test(tables),
        cmocka_unit_test(pools),
#if HELIO_WITH_EMBREE
        cmocka_unit_test(renderers),
        cmocka_unit_test(frames_without_memory),
#endif
        cmocka_unit_test(written_pictures),
        cmocka_unit_test(read_pictures),
        cmocka_unit_test(skies),
        cmocka_unit_test(sources),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
