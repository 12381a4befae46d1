/* SPDX-License-Identifier: MIT
 * Importers that crash, hang, lie and eat memory, in the process that is made for them: what becomes of it is one
 * sentence, and this process goes on as if nothing had happened. */
#include "support.h"

#include "core/context.h"
#include "core/error.h"
#include "scene/mesh_process.h"

#include <heliostat/source.h>

#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#ifdef HELIO_WITH_ASSIMP

#define MIB (UINT64_C(1) << 20)

static const mesh_limits LIMITS = {
    .memory = 256 * MIB, .seconds = 60, .texture_seconds = 60, .clock_seconds = 120, .texture_pixels = 1 << 20};

static helio_context *context;

static char warnings[8192];
static uint32_t warning_count;

static void keep_warning(void *user, helio_log_level level, const char *message)
{
    (void)user;
    if (level > HELIO_LOG_WARNING)
        return;
    size_t used = strlen(warnings);
    snprintf(warnings + used, sizeof warnings - used, "%s\n", message);
    warning_count++;
}

static size_t open_descriptors(void)
{
    size_t count = 0;
    for (int i = 0; i < 256; i++)
        count += fcntl(i, F_GETFD) >= 0;
    return count;
}

static size_t descriptors_before;

static int make_quiet_context(void **state)
{
    (void)state;
    helio_context_desc desc = {.threads = 2, .log_level = HELIO_LOG_WARNING, .log = keep_warning};
    warnings[0] = 0;
    warning_count = 0;
    descriptors_before = open_descriptors();
    return helio_context_create(&desc, &context) == HELIO_OK ? 0 : -1;
}

/* Also finds what a test left behind: processes and descriptors. */
static int check_nothing_is_left(void **state)
{
    (void)state;
    helio_context_destroy(context);
    if (waitpid(-1, NULL, WNOHANG) == -1 && open_descriptors() == descriptors_before)
        return 0;
    print_error("a child process or a descriptor is left\n");
    return -1;
}

/* ---- meshes ----------------------------------------------------------------------------- */

/* Everything that a mesh can have, once: two triangles, two materials, one texture of 2 x 1 texels. */
static helio_status import_square(helio_context *own, const char *path, const mesh_import_options *options,
                                  mesh_arrays *arrays)
{
    static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    (void)path;
    (void)options;
    *arrays = (mesh_arrays){.vertex_count = 4, .triangle_count = 2, .material_count = 2, .texture_count = 1};
    arrays->positions = context_allocate(own, 4, 12);
    arrays->normals = context_allocate(own, 4, 12);
    arrays->triangles = context_allocate(own, 2, 12);
    arrays->triangle_materials = context_allocate(own, 2, 4);
    arrays->materials = context_allocate(own, 2, sizeof(helio_material));
    arrays->texture_coordinates = context_allocate(own, 4, 8);
    arrays->textures = context_allocate(own, 1, sizeof(helio_texture));
    arrays->material_textures = context_allocate(own, 2, sizeof(helio_material_textures));
    uint8_t *texels = context_allocate(own, 2, 4);
    memcpy(arrays->positions, positions, sizeof positions);
    memcpy(arrays->triangles, triangles, sizeof triangles);
    for (size_t i = 0; i < 4; i++)
        arrays->normals[3 * i + 2] = 2;
    arrays->triangle_materials[1] = 1;
    arrays->materials[0].diffuse[0] = 0.25f;
    arrays->material_textures[1].base_colour = 1;
    memset(texels, 77, 8);
    arrays->textures[0] = (helio_texture){2, 1, HELIO_WRAP_CLAMP, HELIO_WRAP_MIRROR, texels};
    return HELIO_OK;
}

/* What helio_mesh_load() does, with another importer. */
static helio_status load(mesh_importer import, const mesh_limits *limits, helio_mesh **mesh)
{
    mesh_delivery delivery;
    *mesh = NULL;
    helio_status status = mesh_process_import(context, "some.ply", import, limits, &delivery);
    if (status != HELIO_OK)
        return status;
    status = helio_mesh_create(context, &delivery.receipt.desc, mesh);
    mesh_delivery_release(context, &delivery);
    return status;
}

static void expect_square(void)
{
    helio_mesh *mesh;
    if (load(import_square, &LIMITS, &mesh) != HELIO_OK || mesh == NULL) {
        fail_msg("a good mesh is not read: %s", helio_last_error());
        return;
    }
    assert_int_equal(mesh->vertex_count, 4);
    assert_int_equal(mesh->triangle_count, 2);
    assert_int_equal(mesh->triangles[5], 3);
    assert_true(mesh->positions[7] == 1 && mesh->normals[11] == 1);
    assert_int_equal(mesh->triangle_materials[1], 1);
    assert_true(mesh->materials[0].diffuse[0] == 0.25f);
    assert_int_equal(mesh->material_textures[1].base_colour, 1);
    assert_int_equal(mesh->textures[0].width, 2);
    assert_int_equal(mesh->textures[0].wrap_v, HELIO_WRAP_MIRROR);
    assert_int_equal(mesh->textures[0].rgba[7], 77);
    assert_true(mesh->texture_coordinates[7] == 0);
    helio_mesh_destroy(context, mesh);
}

/* One sentence that holds the words; afterwards a good mesh is read as ever. */
static void expect_sentence(mesh_importer import, const mesh_limits *limits, helio_status expected, const char *words)
{
    helio_mesh *mesh;
    helio_status status = load(import, limits, &mesh);
    if (status != expected || strstr(helio_last_error(), words) == NULL || strchr(helio_last_error(), '\n') != NULL)
        fail_msg("%s in place of %s, no \"%s\" in: %s", helio_status_name(status), helio_status_name(expected), words,
                 helio_last_error());
    assert_null(mesh);
    expect_square();
}

static void a_good_mesh_comes_back_whole(void **state)
{
    (void)state;
    expect_square();
    assert_int_equal(warning_count, 0);
}

/* ---- deaths ----------------------------------------------------------------------------- */

static helio_status import_by_abort(helio_context *own, const char *path, const mesh_import_options *options,
                                    mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options, (void)arrays;
    abort();
}

/* By the signal itself: sanitizers would report a real one. */
static helio_status import_by_fault(helio_context *own, const char *path, const mesh_import_options *options,
                                    mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options, (void)arrays;
    raise(SIGSEGV);
    return HELIO_OK;
}

static helio_status import_by_exit(helio_context *own, const char *path, const mesh_import_options *options,
                                   mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options, (void)arrays;
    _exit(3);
}

static helio_status import_killed(helio_context *own, const char *path, const mesh_import_options *options,
                                  mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options, (void)arrays;
    raise(SIGKILL);
    return HELIO_OK;
}

static atomic_bool handled;

static void host_handler(int number)
{
    (void)number;
    atomic_store(&handled, true);
    _exit(77);
}

static void crashes_become_a_sentence(void **state)
{
    (void)state;
    expect_sentence(import_by_abort, &LIMITS, HELIO_ERR_DATA, "some.ply cannot be read as a mesh: it crashes");
    expect_sentence(import_by_fault, &LIMITS, HELIO_ERR_DATA, "Segmentation fault");
    expect_sentence(import_by_exit, &LIMITS, HELIO_ERR_DATA, "exit code 3");
    expect_sentence(import_killed, &LIMITS, HELIO_ERR_MEMORY, "killed by the system");
}

/* The way out is another format than the file's own. */
static void crashes_have_a_way_out(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"some.ply", "with another program, to glTF"},        {"some.PLY.gz", "with another program, to glTF"},
        {"some.glb", "with another program, to PLY"},         {"some.gltf", "with another program, to PLY"},
        {"some.obj", "with another program, to PLY or glTF"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_delivery delivery;
        assert_int_equal(mesh_process_import(context, cases[i][0], import_by_abort, &LIMITS, &delivery),
                         HELIO_ERR_DATA);
        const char *way_out = strstr(helio_last_error(), "with another program");
        assert_non_null(way_out);
        assert_string_equal(way_out, cases[i][1]);
    }
}

/* A crash handler that writes reports must not write one for a file that is damaged. */
static void handlers_of_the_host_are_not_run(void **state)
{
    (void)state;
    struct sigaction action = {.sa_handler = host_handler}, before[2];
    sigaction(SIGSEGV, &action, &before[0]);
    sigaction(SIGABRT, &action, &before[1]);
    expect_sentence(import_by_fault, &LIMITS, HELIO_ERR_DATA, "Segmentation fault");
    expect_sentence(import_by_abort, &LIMITS, HELIO_ERR_DATA, "Aborted");
    sigaction(SIGSEGV, &before[0], NULL);
    sigaction(SIGABRT, &before[1], NULL);
}

/* Then nobody can tell how the child died. */
static void hosts_may_ignore_their_children(void **state)
{
    (void)state;
    void (*before)(int) = signal(SIGCHLD, SIG_IGN);
    expect_sentence(import_by_abort, &LIMITS, HELIO_ERR_DATA, "unknown reason");
    expect_square();
    signal(SIGCHLD, before);
}

/* ---- time and memory -------------------------------------------------------------------- */

static volatile uint64_t counter;

static helio_status import_for_ever(helio_context *own, const char *path, const mesh_import_options *options,
                                    mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options, (void)arrays;
    while (counter < UINT64_MAX)
        counter++;
    return HELIO_ERR_DATA;
}

static helio_status import_asleep(helio_context *own, const char *path, const mesh_import_options *options,
                                  mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options, (void)arrays;
    while (counter < UINT64_MAX)
        pause();
    return HELIO_ERR_DATA;
}

static double processor_seconds(void)
{
    struct timespec used;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

/* Takes longer than the file itself may, but not longer than with its textures. */
static helio_status import_with_textures(helio_context *own, const char *path, const mesh_import_options *options,
                                         mesh_arrays *arrays)
{
    options->on_textures(options->user);
    while (processor_seconds() < 1.4)
        counter++;
    return import_square(own, path, options, arrays);
}

/* Damage in a texture shows only when the time for the file itself no longer holds. */
static helio_status import_textures_for_ever(helio_context *own, const char *path, const mesh_import_options *options,
                                             mesh_arrays *arrays)
{
    options->on_textures(options->user);
    return import_for_ever(own, path, options, arrays);
}

static helio_status import_by_allocation(helio_context *own, const char *path, const mesh_import_options *options,
                                         mesh_arrays *arrays)
{
    (void)path, (void)options, (void)arrays;
    while (context_allocate(own, MIB, 1) != NULL)
        ;
    return HELIO_ERR_MEMORY;
}

static void time_is_limited(void **state)
{
    (void)state;
    mesh_limits brief = LIMITS;
    brief.seconds = 1;
    expect_sentence(import_for_ever, &brief, HELIO_ERR_DATA,
                    "more than 1 s of processor time; if you trust it, raise max_seconds (--max-mesh-seconds)");
    brief.texture_seconds = 2;
    expect_sentence(import_textures_for_ever, &brief, HELIO_ERR_DATA, "more than 2 s of processor time; if you trust");
    helio_mesh *mesh;
    assert_ok(load(import_with_textures, &brief, &mesh));
    helio_mesh_destroy(context, mesh);
    brief = LIMITS;
    brief.clock_seconds = 1;
    expect_sentence(import_asleep, &brief, HELIO_ERR_DATA, "takes more than 1 s; if you trust it, raise");
}

static helio_status import_with_a_word(helio_context *own, const char *path, const mesh_import_options *options,
                                       mesh_arrays *arrays)
{
    context_log(own, HELIO_LOG_WARNING, "%s: a word", path);
    return import_square(own, path, options, arrays);
}

/* Keeps the waiting thread away until the child is gone, and the time over. */
static void log_slowly(void *user, helio_log_level level, const char *message)
{
    const struct timespec more_than_allowed = {.tv_sec = 1, .tv_nsec = 100000000};
    siginfo_t information;
    (void)user, (void)level, (void)message;
    waitid(P_ALL, 0, &information, WEXITED | WNOWAIT);
    nanosleep(&more_than_allowed, NULL);
}

static void last_words_of_a_child_are_heard(void **state)
{
    (void)state;
    mesh_limits brief = LIMITS;
    brief.clock_seconds = 1;
    helio_context_desc desc = {.threads = 1, .log_level = HELIO_LOG_WARNING, .log = log_slowly};
    helio_context *before = context;
    assert_ok(helio_context_create(&desc, &context));
    helio_mesh *mesh;
    helio_status status = load(import_with_a_word, &brief, &mesh);
    helio_mesh_destroy(context, mesh);
    helio_context_destroy(context);
    context = before;
    assert_ok(status);
}

static helio_status import_and_look_at_limits(helio_context *own, const char *path, const mesh_import_options *options,
                                              mesh_arrays *arrays)
{
    struct rlimit files, time[2];
    getrlimit(RLIMIT_FSIZE, &files);
    getrlimit(RLIMIT_CPU, &time[0]);
    options->on_textures(options->user);
    getrlimit(RLIMIT_CPU, &time[1]);
    if (files.rlim_max != MIB || time[0].rlim_cur != 30 || time[1].rlim_cur != 30)
        return fail(HELIO_ERR_DATA, "%s may take more than the host", path);
    return import_square(own, path, options, arrays);
}

/* Soft limits of the host below those asked for hold for the child, too. */
static void limits_of_the_host_are_kept(void **state)
{
    (void)state;
    struct rlimit before[2];
    getrlimit(RLIMIT_FSIZE, &before[0]);
    getrlimit(RLIMIT_CPU, &before[1]);
    const struct rlimit files = {MIB, before[0].rlim_max}, time = {30, before[1].rlim_max};
    setrlimit(RLIMIT_FSIZE, &files);
    setrlimit(RLIMIT_CPU, &time);
    helio_mesh *mesh;
    helio_status status = load(import_and_look_at_limits, &LIMITS, &mesh);
    setrlimit(RLIMIT_FSIZE, &before[0]);
    setrlimit(RLIMIT_CPU, &before[1]);
    helio_mesh_destroy(context, mesh);
    assert_ok(status);
}

static void small_files_of_the_host_are_told(void **state)
{
    (void)state;
    struct rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    const struct rlimit files = {100, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &files);
    helio_mesh *mesh;
    helio_status status = load(import_square, &LIMITS, &mesh);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(status, HELIO_ERR_IO);
    assert_non_null(strstr(helio_last_error(), "some.ply is not read"));
    assert_non_null(strstr(helio_last_error(), "no file of more than 100 bytes"));
    expect_square();
}

/* Of 3 MiB. With address sanitizer there is memory for it, but no file. */
static helio_status import_large(helio_context *own, const char *path, const mesh_import_options *options,
                                 mesh_arrays *arrays)
{
    (void)path, (void)options;
    *arrays = (mesh_arrays){.vertex_count = 1 << 18};
    arrays->positions = context_allocate(own, arrays->vertex_count, 12);
    return arrays->positions != NULL ? HELIO_OK : HELIO_ERR_MEMORY;
}

/* The limit of files is that of memory where the host has no lower one. */
static void large_meshes_are_a_matter_of_memory(void **state)
{
    (void)state;
    mesh_limits limits = LIMITS;
    limits.memory = MIB;
    expect_sentence(import_large, &limits, HELIO_ERR_MEMORY,
                    "some.ply needs more than the 1 MiB of memory allowed for reading it");
}

static void memory_is_limited(void **state)
{
    (void)state;
    if (!mesh_process_limits_memory) {
        print_message("skipped: with this sanitizer address space has no limit\n");
        skip();
    }
    expect_sentence(import_by_allocation, &LIMITS, HELIO_ERR_MEMORY,
                    "some.ply needs more than the 256 MiB of memory allowed for reading it");
}

/* ---- words ------------------------------------------------------------------------------ */

static helio_status import_with_colour(helio_context *own, const char *path, const mesh_import_options *options,
                                       mesh_arrays *arrays)
{
    (void)options, (void)arrays;
    context_log(own, HELIO_LOG_WARNING, "%s: \x1b[31mred\x1b[0m\n\xc2\x9bno caf\xc3\xa9\ttab", path);
    return fail(HELIO_ERR_DATA, "%s: \x1b]0;title\x07\x7f", path);
}

static helio_status import_noisily(helio_context *own, const char *path, const mesh_import_options *options,
                                   mesh_arrays *arrays)
{
    for (int i = 0; i < 20000; i++)
        context_log(own, HELIO_LOG_WARNING, "%s: noise", path);
    return import_square(own, path, options, arrays);
}

static helio_status import_by_print(helio_context *own, const char *path, const mesh_import_options *options,
                                    mesh_arrays *arrays)
{
    if (write(STDOUT_FILENO, "loud\n", 5) != 5)
        _exit(4);
    return import_square(own, path, options, arrays);
}

static void texts_hold_no_control_characters(void **state)
{
    (void)state;
    helio_mesh *mesh;
    assert_int_equal(load(import_with_colour, &LIMITS, &mesh), HELIO_ERR_DATA);
    assert_string_equal(helio_last_error(), "some.ply: ?]0;title??");
    assert_string_equal(warnings, "some.ply: ?[31mred?[0m??\?no caf\xc3\xa9 tab\n");
}

static void a_flood_of_messages_is_cut_off(void **state)
{
    (void)state;
    helio_mesh *mesh;
    assert_ok(load(import_noisily, &LIMITS, &mesh));
    helio_mesh_destroy(context, mesh);
    assert_int_equal(warning_count, 101);
    assert_non_null(strstr(warnings, "more than 100 messages"));
}

static void what_importers_print_goes_nowhere(void **state)
{
    (void)state;
    char path[] = "/tmp/heliostat-print-XXXXXX", text[64];
    int file = mkstemp(path), stdout_before = dup(STDOUT_FILENO);
    fflush(stdout);
    printf("kept in the buffer"); /* must not be written a second time by the child */
    dup2(file, STDOUT_FILENO);
    helio_mesh *mesh;
    helio_status status = load(import_by_print, &LIMITS, &mesh);
    fflush(stdout);
    dup2(stdout_before, STDOUT_FILENO);
    close(stdout_before);
    assert_int_equal(status, HELIO_OK);
    helio_mesh_destroy(context, mesh);
    ssize_t length = pread(file, text, sizeof text, 0);
    close(file);
    unlink(path);
    assert_int_equal(length, strlen("kept in the buffer"));
    assert_memory_equal(text, "kept in the buffer", (size_t)length);
}

static int host_descriptor;

static helio_status import_and_look(helio_context *own, const char *path, const mesh_import_options *options,
                                    mesh_arrays *arrays)
{
    if (fcntl(host_descriptor, F_GETFD) >= 0)
        return fail(HELIO_ERR_DATA, "%s sees a descriptor of the host", path);
    struct rlimit core;
    if (getrlimit(RLIMIT_CORE, &core) != 0 || core.rlim_max != 0)
        return fail(HELIO_ERR_DATA, "%s may leave a core file", path);
    return import_square(own, path, options, arrays);
}

static void files_of_the_host_are_closed(void **state)
{
    (void)state;
    helio_mesh *mesh;
    host_descriptor = dup2(STDERR_FILENO, 100);
    assert_int_equal(host_descriptor, 100);
    helio_status status = load(import_and_look, &LIMITS, &mesh);
    close(host_descriptor);
    assert_ok(status);
    helio_mesh_destroy(context, mesh);
}

/* ---- lies ------------------------------------------------------------------------------- */

enum { LIES = 12 };
static int lie;

static helio_status import_a_lie(helio_context *own, const char *path, const mesh_import_options *options,
                                 mesh_arrays *arrays)
{
    import_square(own, path, options, arrays);
    helio_texture *texture = &arrays->textures[0];
    switch (lie) {
    case 0: arrays->triangles[3] = 4; break;
    case 1: arrays->triangles[0] = UINT32_MAX; break;
    case 2: arrays->positions[5] = NAN; break;
    case 3: arrays->positions[0] = INFINITY; break;
    case 4: arrays->triangle_materials[0] = 2; break;
    case 5: arrays->materials[1].kind = (helio_material_kind)1000; break;
    case 6: arrays->materials[1].diffuse[2] = NAN; break;
    case 7: arrays->texture_coordinates[3] = NAN; break;
    case 8: arrays->material_textures[0].metallic_roughness = 2; break;
    case 9: texture->wrap_u = (helio_wrap)3; break;
    case 10: texture->width = 0; break;
    default: arrays->normals[4] = NAN; break; /* alone no lie: normals that are none are computed */
    }
    return HELIO_OK;
}

static void arrays_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    for (lie = 0; lie < LIES; lie++) {
        helio_mesh *mesh;
        helio_status status = load(import_a_lie, &LIMITS, &mesh);
        assert_int_equal(status, lie == LIES - 1 ? HELIO_OK : HELIO_ERR_DATA);
        helio_mesh_destroy(context, mesh);
    }
}

static helio_status import_nothing(helio_context *own, const char *path, const mesh_import_options *options,
                                   mesh_arrays *arrays)
{
    (void)own, (void)path, (void)options;
    *arrays = (mesh_arrays){.vertex_count = UINT32_MAX, .triangle_count = UINT32_MAX, .texture_count = 0};
    return HELIO_OK;
}

static void counts_without_arrays_are_refused(void **state)
{
    (void)state;
    expect_sentence(import_nothing, &LIMITS, HELIO_ERR_DATA, "do not fit its counts");
}

/* Bytes as the child writes them, at an address as the parent has them. */
static unsigned char *make_receipt(size_t *size)
{
    mesh_arrays arrays;
    import_square(context, "", NULL, &arrays);
    int file = memfd_create("receipt", MFD_CLOEXEC);
    assert_ok(mesh_receipt_write(context, file, &arrays));
    *size = (size_t)lseek(file, 0, SEEK_END);
    assert_true(*size > 0);
    unsigned char *bytes = aligned_alloc(64, *size);
    assert_int_equal(pread(file, bytes, *size, 0), *size);
    close(file);
    return bytes;
}

static void try_receipt(const unsigned char *bytes, size_t size, bool *good)
{
    mesh_receipt receipt;
    helio_mesh *mesh = NULL;
    *good = mesh_receipt_open(context, bytes, size, &receipt) == HELIO_OK;
    if (*good && helio_mesh_create(context, &receipt.desc, &mesh) == HELIO_OK)
        helio_mesh_destroy(context, mesh);
    mesh_receipt_close(context, &receipt);
}

static void receipts_are_believed_in_nothing(void **state)
{
    (void)state;
    size_t size;
    bool good;
    unsigned char *bytes = make_receipt(&size);
    try_receipt(bytes, size, &good);
    assert_true(good);
    for (size_t shorter = 0; shorter < size; shorter++) {
        unsigned char *copy = aligned_alloc(64, (shorter + 63) / 64 * 64 + 64);
        memcpy(copy, bytes, shorter);
        try_receipt(copy, shorter, &good);
        free(copy);
        assert_false(good);
    }
    uint64_t random = 5;
    for (int i = 0; i < 20000; i++) {
        uint32_t bits = random_bits(&random);
        size_t at = i % 2 ? bits % size : bits % 24; /* the counts take the first 24 */
        unsigned char before = bytes[at];
        bytes[at] = (unsigned char)(bits >> 24);
        try_receipt(bytes, size, &good);
        bytes[at] = before;
    }
    free(bytes);
}

/* ---- surroundings ----------------------------------------------------------------------- */

static void no_process_is_told(void **state)
{
    (void)state;
    struct rlimit before, none;
    helio_mesh *mesh;
    getrlimit(RLIMIT_NOFILE, &before);
    none = before;
    none.rlim_cur = 0;
    setrlimit(RLIMIT_NOFILE, &none);
    helio_status status = load(import_square, &LIMITS, &mesh);
    setrlimit(RLIMIT_NOFILE, &before);
    assert_int_equal(status, HELIO_ERR_UNSUPPORTED);
    assert_non_null(strstr(helio_last_error(), "some.ply is not read, as no process can be made for it"));
    assert_non_null(strstr(helio_last_error(), "in_process"));
}

static void no_memory_is_told_and_nothing_leaks(void **state)
{
    (void)state;
    helio_status status = HELIO_ERR_MEMORY;
    for (size_t allowed = 1; status != HELIO_OK; allowed++) {
        memory_count count = {.refuse_after = allowed};
        helio_context_desc desc = {.threads = 1, .allocate = count_allocate, .release = count_release, .user = &count};
        helio_context *before = context;
        status = helio_context_create(&desc, &context);
        if (status == HELIO_OK) {
            helio_mesh *mesh;
            status = load(import_square, &LIMITS, &mesh);
            helio_mesh_destroy(context, mesh);
            helio_context_destroy(context);
        }
        context = before;
        assert_true(status == HELIO_OK || status == HELIO_ERR_MEMORY);
        assert_int_equal(atomic_load(&count.live), 0);
        assert_true(allowed < 100);
    }
}

static char mesh_path[64];

static void *load_some(void *failures)
{
    for (int i = 0; i < 10; i++) {
        const helio_mesh_load_desc desc = {.in_process = i % 5 == 4};
        helio_mesh *mesh;
        if (helio_mesh_load(context, mesh_path, &desc, &mesh) != HELIO_OK)
            atomic_fetch_add((atomic_int *)failures, 1);
        helio_mesh_destroy(context, mesh);
    }
    return NULL;
}

static void threads_load_at_the_same_time(void **state)
{
    (void)state;
    snprintf(mesh_path, sizeof mesh_path, "/tmp/heliostat-hostile-%ld.obj", (long)getpid());
    FILE *file = fopen(mesh_path, "w");
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", file);
    fclose(file);
    pthread_t threads[4];
    atomic_int failures = 0;
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, load_some, &failures), 0);
    for (size_t i = 0; i < 4; i++)
        pthread_join(threads[i], NULL);
    unlink(mesh_path);
    assert_int_equal(atomic_load(&failures), 0);
}

/* More than what a thread has at hand, so that all sizes are taken from what threads share. */
static void take_memory(void)
{
    enum { BLOCKS = 1000 };
    void *blocks[BLOCKS];
    for (size_t i = 0; i < BLOCKS; i++)
        blocks[i] = malloc(1 + i * 37 % 5000);
    for (size_t i = 0; i < BLOCKS; i++)
        free(blocks[i]);
}

static helio_status import_with_much_memory(helio_context *own, const char *path, const mesh_import_options *options,
                                            mesh_arrays *arrays)
{
    take_memory();
    return import_square(own, path, options, arrays);
}

/* Of the thread that reads frames: within the allocator nearly all the time. */
static void *allocate_busily(void *user, size_t bytes, size_t alignment)
{
    (void)user;
    take_memory();
    return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void release(void *user, void *memory)
{
    (void)user;
    free(memory);
}

enum { FRAMES = 24 };

static void write_frames(const char *pattern)
{
    char path[128];
    for (int i = 0; i < FRAMES; i++) {
        snprintf(path, sizeof path, pattern, (long)getpid(), i);
        FILE *file = fopen(path, "w");
        fputs("PF\n2 1\n-1\n                        ", file); /* all bytes are blanks: 1.4e-19 */
        fclose(file);
    }
}

static void remove_frames(const char *pattern)
{
    char path[128];
    for (int i = 0; i < FRAMES; i++) {
        snprintf(path, sizeof path, pattern, (long)getpid(), i);
        unlink(path);
    }
}

/* The lock that a thread holds while a process is made stays locked in that process: see fork_gate.h. */
static void meshes_are_read_while_frames_are(void **state)
{
    (void)state;
    static const char paths[] = "/tmp/heliostat-hostile-%ld-%02d.pfm";
    char pattern[128];
    const helio_context_desc desc = {.threads = 1, .allocate = allocate_busily, .release = release};
    const mesh_limits limits = {.memory = 256 * MIB, .seconds = 60, .texture_seconds = 60, .clock_seconds = 20};
    helio_context *before = context;
    helio_source *source;
    helio_source_frame frame;
    helio_status status = HELIO_OK;
    snprintf(pattern, sizeof pattern, "/tmp/heliostat-hostile-%ld-%%02d.pfm", (long)getpid());
    write_frames(paths);
    assert_ok(helio_context_create(&desc, &context));
    assert_ok(helio_source_open(context, pattern, NULL, &source));
    for (int i = 0; i < FRAMES && status == HELIO_OK; i++) {
        helio_mesh *mesh = NULL;
        status = helio_source_next(source, &frame);
        if (status == HELIO_OK)
            status = load(import_with_much_memory, &limits, &mesh);
        helio_mesh_destroy(context, mesh);
    }
    helio_source_close(source);
    helio_context_destroy(context);
    context = before;
    remove_frames(paths);
    assert_ok(status);
}

#else

static void hostile_meshes_need_assimp(void **state)
{
    (void)state;
    print_message("skipped: this build has no assimp\n");
    skip();
}

#endif

#define TEST(name) cmocka_unit_test_setup_teardown(name, make_quiet_context, check_nothing_is_left)

int main(void)
{
    const struct CMUnitTest tests[] = {
#ifdef HELIO_WITH_ASSIMP
        TEST(a_good_mesh_comes_back_whole),
        TEST(crashes_become_a_sentence),
        TEST(crashes_have_a_way_out),
        TEST(handlers_of_the_host_are_not_run),
        TEST(hosts_may_ignore_their_children),
        TEST(time_is_limited),
        TEST(last_words_of_a_child_are_heard),
        TEST(limits_of_the_host_are_kept),
        TEST(small_files_of_the_host_are_told),
        TEST(large_meshes_are_a_matter_of_memory),
        TEST(memory_is_limited),
        TEST(texts_hold_no_control_characters),
        TEST(a_flood_of_messages_is_cut_off),
        TEST(what_importers_print_goes_nowhere),
        TEST(files_of_the_host_are_closed),
        TEST(arrays_that_do_not_fit_are_refused),
        TEST(counts_without_arrays_are_refused),
        TEST(receipts_are_believed_in_nothing),
        TEST(no_process_is_told),
        TEST(no_memory_is_told_and_nothing_leaks),
        TEST(threads_load_at_the_same_time),
        TEST(meshes_are_read_while_frames_are),
#else
        cmocka_unit_test(hostile_meshes_need_assimp),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
