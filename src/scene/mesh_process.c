/* SPDX-License-Identifier: MIT */
#include "scene/mesh_process.h"

#include "core/clock.h"
#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "core/fork_gate.h"
#include "scene/mesh_child.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#ifndef MFD_NOEXEC_SEAL
#define MFD_NOEXEC_SEAL 0x0008U
#endif

enum {
    SLICE = 100,         /* milliseconds between two looks at the child */
    MAX_LOG_LINES = 100, /* of one file, among those that the host wants to see */
    MAX_LEFT = 2048      /* messages that a dead child may leave: more than a pipe holds */
};

/* Importers keep state for the whole process: none may be at work here when a child is made, nor two at once. */
static pthread_mutex_t import_mutex = PTHREAD_MUTEX_INITIALIZER;

helio_status mesh_import_here(helio_context *context, const char *path, mesh_importer import, const mesh_limits *limits,
                              mesh_arrays *arrays)
{
    const mesh_import_options options = {.max_texture_pixels = limits->texture_pixels};
    pthread_mutex_lock(&import_mutex);
    helio_status status = import(context, path, &options, arrays);
    pthread_mutex_unlock(&import_mutex);
    return status;
}

/* A child and what is known of it. */
typedef struct mesh_process {
    helio_context *context;
    const char *path;
    const mesh_limits *limits;
    int memory, messages; /* descriptors; -1: none */
    pid_t pid;
    double deadline; /* by the clock */

    bool ended; /* it said so itself: */
    helio_status status;
    char reason[sizeof((mesh_message *)0)->text];
    uint32_t log_lines;
    bool textures; /* only they remain */

    bool dead, late;
    int error; /* why it cannot be listened to, or 0 */
    int exit;  /* as waitpid() tells, or -1: the host has SIGCHLD ignored or waited itself */

    mesh_message message; /* received so far: */
    size_t received;
} mesh_process;

/* ---- start ------------------------------------------------------------------------------ */

/* Descriptors below 3 are taken for stdin, stdout and stderr. */
static int move_up(int descriptor)
{
    if (descriptor < 0 || descriptor > 2)
        return descriptor;
    int moved = fcntl(descriptor, F_DUPFD_CLOEXEC, 3);
    close(descriptor);
    return moved;
}

static int make_memory(void)
{
    int descriptor = memfd_create("heliostat-mesh", MFD_CLOEXEC | MFD_ALLOW_SEALING | MFD_NOEXEC_SEAL);
    if (descriptor < 0 && errno == EINVAL) /* Linux before 6.3 */
        descriptor = memfd_create("heliostat-mesh", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    return move_up(descriptor);
}

/* Signals wait meanwhile, so that no handler of the host runs in the child. */
static pid_t fork_child(const mesh_child *child)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_mutex_lock(&import_mutex);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    fork_gate_close();
    pid_t pid = fork();
    if (pid == 0)
        mesh_child_run(child);
    int error = errno;
    fork_gate_open();
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_mutex_unlock(&import_mutex);
    errno = error;
    return pid;
}

static helio_status start(mesh_process *process, mesh_importer import)
{
    int ends[2] = {-1, -1};
    process->memory = make_memory();
    bool good = process->memory >= 0 && pipe2(ends, O_CLOEXEC) == 0;
    process->messages = good ? move_up(ends[0]) : -1;
    ends[1] = move_up(ends[1]);
    if (good && process->messages >= 0 && ends[1] >= 0) {
        const mesh_child child = {
            .parent = getpid(),
            .path = process->path,
            .import = import,
            .limits = process->limits,
            .isa = helio_context_isa(process->context),
            .log_level = context_log_level(process->context),
            .memory = process->memory,
            .messages = ends[1],
        };
        process->pid = fork_child(&child);
    }
    int error = errno;
    if (ends[1] >= 0)
        close(ends[1]);
    if (process->pid > 0) {
        process->deadline = clock_seconds() + process->limits->clock_seconds;
        return HELIO_OK;
    }
    return fail(HELIO_ERR_UNSUPPORTED,
                "%s is not read, as no process can be made for it: %s; make room, or set in_process for a file that "
                "you trust",
                process->path, strerror(error));
}

/* ---- listening -------------------------------------------------------------------------- */

/* Text may come from a file or from a crashed program: no control characters, neither ASCII's nor U+0080 to U+009F. */
static void clean_text(char *text)
{
    for (unsigned char *c = (unsigned char *)text; *c != 0; c++)
        if (*c < ' ' || *c == 0x7f)
            *c = *c == '\t' ? ' ' : '?';
        else if (*c == 0xc2 && c[1] >= 0x80 && c[1] <= 0x9f)
            *c = c[1] = '?';
}

static void forward_log(mesh_process *process, int32_t value, const char *text)
{
    helio_log_level level =
        value >= HELIO_LOG_ERROR && value < HELIO_LOG_DEBUG ? (helio_log_level)value : HELIO_LOG_DEBUG;
    if (process->log_lines < MAX_LOG_LINES)
        context_log(process->context, level, "%s", text);
    else if (process->log_lines == MAX_LOG_LINES)
        context_log(process->context, HELIO_LOG_WARNING, "%s: more than %d messages; the others are left out",
                    process->path, MAX_LOG_LINES);
    process->log_lines += process->log_lines <= MAX_LOG_LINES;
}

static void take_message(mesh_process *process)
{
    mesh_message *message = &process->message;
    message->text[sizeof message->text - 1] = 0;
    clean_text(message->text);
    if (message->kind == MESH_MESSAGE_LOG) {
        forward_log(process, message->value, message->text);
        return;
    }
    if (message->kind == MESH_MESSAGE_TEXTURES) {
        process->textures = true;
        return;
    }
    process->ended = true;
    process->status =
        message->kind == MESH_MESSAGE_END && message->value <= HELIO_OK && message->value >= HELIO_ERR_DATA
            ? (helio_status)message->value
            : HELIO_ERR_DATA;
    strcpy(process->reason, message->text);
}

/* False when nothing more will come. */
static bool receive(mesh_process *process)
{
    ssize_t got = read(process->messages, (char *)&process->message + process->received,
                       sizeof process->message - process->received);
    if (got <= 0)
        return got < 0 && errno == EINTR;
    process->received += (size_t)got;
    if (process->received == sizeof process->message) {
        process->received = 0;
        take_message(process);
    }
    return !process->ended;
}

static bool has_died(mesh_process *process)
{
    int status = 0;
    pid_t pid = process->dead ? 0 : waitpid(process->pid, &status, WNOHANG);
    if (pid == process->pid || (pid < 0 && errno == ECHILD)) {
        process->dead = true;
        process->exit = pid < 0 ? -1 : status;
    }
    return process->dead;
}

/* The pipe is no sign of life: other processes that the host makes may hold its other end, too. */
static void listen_to(mesh_process *process)
{
    while (clock_seconds() < process->deadline) {
        struct pollfd pipe_end = {.fd = process->messages, .events = POLLIN};
        int ready = poll(&pipe_end, 1, SLICE);
        if (ready < 0 && errno != EINTR)
            process->error = errno;
        if (process->error != 0 || (ready > 0 && !receive(process)) || (ready == 0 && has_died(process)))
            return;
    }
}

/* What the child said after the last look and before its death. */
static void hear_the_rest(mesh_process *process)
{
    if (process->ended || fcntl(process->messages, F_SETFL, O_NONBLOCK) != 0)
        return;
    for (int i = 0; i < MAX_LEFT && receive(process); i++)
        ;
}

/* Waits for the child, kills it where it has nothing more to do, and leaves no zombie. */
static void reap(mesh_process *process)
{
    const struct timespec moment = {.tv_nsec = 1000000};
    while (!process->ended && process->error == 0 && !has_died(process) && clock_seconds() < process->deadline)
        nanosleep(&moment, NULL);
    if (has_died(process))
        return;
    process->late = !process->ended;
    kill(process->pid, SIGKILL);
    pid_t pid;
    do
        pid = waitpid(process->pid, &process->exit, 0);
    while (pid < 0 && errno == EINTR);
    process->dead = true;
}

/* ---- outcome ---------------------------------------------------------------------------- */

/* To another format than its own. */
static const char *way_out(const char *path)
{
    if (file_has_extension(path, "ply") || file_has_extension(path, "ply.gz"))
        return "if it is sound, convert it with another program, to glTF";
    if (file_has_extension(path, "gltf") || file_has_extension(path, "glb"))
        return "if it is sound, convert it with another program, to PLY";
    return "if it is sound, convert it with another program, to PLY or glTF";
}

static const char MORE_TIME[] = "if you trust it, raise max_seconds (--max-mesh-seconds)";

static helio_status fail_of_memory(const mesh_process *process)
{
    return fail(HELIO_ERR_MEMORY,
                "%s needs more than the %" PRIu64 " MiB of memory allowed for reading it; if you trust it, raise "
                "max_memory (--max-mesh-memory)",
                process->path, process->limits->memory >> 20);
}

static helio_status fail_of_death(const mesh_process *process)
{
    const char *path = process->path;
    const mesh_limits *limits = process->limits;
    if (process->error != 0)
        return fail(HELIO_ERR_IO, "%s was not read: its import cannot be waited for: %s", path,
                    strerror(process->error));
    if (process->late)
        return fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: its import takes more than %u s; %s", path,
                    limits->clock_seconds, MORE_TIME);
    if (process->exit == -1)
        return fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: its import ended for an unknown reason; %s", path,
                    way_out(path));
    if (!WIFSIGNALED(process->exit))
        return fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: its import ended with exit code %d; %s", path,
                    WEXITSTATUS(process->exit), way_out(path));
    int number = WTERMSIG(process->exit);
    if (number == SIGXCPU)
        return fail(HELIO_ERR_DATA,
                    "%s cannot be read as a mesh: its import takes more than %u s of processor time; %s", path,
                    process->textures ? limits->texture_seconds : limits->seconds, MORE_TIME);
    if (number == SIGKILL)
        return fail(HELIO_ERR_MEMORY,
                    "%s was not read: its import was killed by the system, which may have run out of memory; make room",
                    path);
    if (number == SIGINT || number == SIGTERM || number == SIGHUP)
        return fail(HELIO_ERR_IO, "%s was not read: its import was stopped (%s)", path, strsignal(number));
    return fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: it crashes the importer (%s); %s", path,
                strsignal(number), way_out(path));
}

static helio_status judge(const mesh_process *process)
{
    if (!process->ended)
        return fail_of_death(process);
    if (process->status == HELIO_ERR_MEMORY)
        return fail_of_memory(process);
    return process->status == HELIO_OK ? HELIO_OK : fail(process->status, "%s", process->reason);
}

/* From here on nobody can change or shorten the memory, not even a process that the child left behind. */
static helio_status map_memory(const mesh_process *process, mesh_delivery *delivery)
{
    struct stat status;
    int seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL;
    if (fcntl(process->memory, F_ADD_SEALS, seals) != 0 || fstat(process->memory, &status) != 0)
        return fail(HELIO_ERR_IO, "%s was read but cannot be taken over: %s", process->path, strerror(errno));
    if (status.st_size <= 0 || (uintmax_t)status.st_size > SIZE_MAX)
        return fail(HELIO_ERR_DATA, "%s cannot be read as a mesh: its import returned nothing", process->path);
    delivery->size = (size_t)status.st_size;
    void *mapping = mmap(NULL, delivery->size, PROT_READ, MAP_PRIVATE, process->memory, 0);
    if (mapping == MAP_FAILED)
        return fail(HELIO_ERR_MEMORY, "no memory for %s (%zu bytes)", process->path, delivery->size);
    delivery->mapping = mapping;
    helio_status opened = mesh_receipt_open(process->context, delivery->mapping, delivery->size, &delivery->receipt);
    if (opened == HELIO_OK)
        return HELIO_OK;
    mesh_delivery_release(process->context, delivery);
    return fail(opened, "%s: %s", process->path, helio_last_error());
}

helio_status mesh_process_import(helio_context *context, const char *path, mesh_importer import,
                                 const mesh_limits *limits, mesh_delivery *delivery)
{
    mesh_process process = {.context = context, .path = path, .limits = limits, .memory = -1, .messages = -1};
    *delivery = (mesh_delivery){0};
    helio_status status = start(&process, import);
    if (status == HELIO_OK) {
        listen_to(&process);
        reap(&process);
        hear_the_rest(&process);
        status = judge(&process);
    }
    if (status == HELIO_OK)
        status = map_memory(&process, delivery);
    if (process.messages >= 0)
        close(process.messages);
    if (process.memory >= 0)
        close(process.memory);
    return status;
}

void mesh_delivery_release(helio_context *context, mesh_delivery *delivery)
{
    mesh_receipt_close(context, &delivery->receipt);
    if (delivery->mapping != NULL)
        munmap(delivery->mapping, delivery->size);
    *delivery = (mesh_delivery){0};
}
