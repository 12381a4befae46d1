/* SPDX-License-Identifier: MIT */
#include "scene/mesh_child.h"

#include "core/error.h"
#include "core/sanitized.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

const bool mesh_process_limits_memory = !SANITIZED;

/* ---- what is left of the host ---------------------------------------------------------- */

/* A crash must end the process, whatever the host does about its own crashes. */
static void reset_signals(void)
{
    for (int number = 1; number < NSIG; number++)
        signal(number, SIG_DFL); /* refused for some, which does no harm */
    signal(SIGXFSZ, SIG_IGN);    /* writing fails instead, with a reason */
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
}

/* Hosts may allow themselves a billion descriptors, which would take minutes to close one by one. */
enum { MAX_CLOSED = 65536 };

static void close_between(unsigned first, unsigned last)
{
    if (first > last || syscall(SYS_close_range, first, last, 0) == 0)
        return;
    for (unsigned i = first; i <= last && i < MAX_CLOSED; i++) /* Linux before 5.9 */
        close((int)i);
}

/* Closes what was inherited: other children's pipes would seem open as long as this process has them too. What the
 * importer prints goes nowhere; reports of sanitizers must be seen. */
static void close_descriptors(const mesh_child *child)
{
    int nowhere = open("/dev/null", O_RDWR);
    for (int i = 0; i < (SANITIZED ? 2 : 3); i++)
        if (nowhere < 0)
            close(i);
        else if (nowhere != i)
            dup2(nowhere, i);
    unsigned low = (unsigned)(child->memory < child->messages ? child->memory : child->messages);
    unsigned high = (unsigned)(child->memory < child->messages ? child->messages : child->memory);
    close_between(3, low - 1);
    close_between(low + 1, high - 1);
    close_between(high + 1, UINT32_MAX);
}

/* ---- limits ---------------------------------------------------------------------------- */

static uint64_t least(uint64_t a, uint64_t b)
{
    return a < b ? a : b;
}

/* Never more than the host has itself. */
static bool limit(int resource, uint64_t most)
{
    struct rlimit now;
    if (getrlimit(resource, &now) != 0)
        return false;
    now.rlim_cur = now.rlim_max = least(most, now.rlim_cur);
    return setrlimit(resource, &now) == 0;
}

/* The hard limit, which kills without telling why, comes a second after the one for all that may be granted. */
static bool limit_time(uint64_t seconds, uint64_t all)
{
    struct rlimit now;
    if (getrlimit(RLIMIT_CPU, &now) != 0)
        return false;
    now.rlim_max = least(least(all, now.rlim_cur) + 1, now.rlim_max);
    now.rlim_cur = least(seconds, now.rlim_max > 0 ? now.rlim_max - 1 : 0);
    return setrlimit(RLIMIT_CPU, &now) == 0;
}

/* Bytes of address space that are in use: those of the host, which this process inherited. */
static bool measure_address_space(uint64_t *bytes)
{
    char text[64];
    int descriptor = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    ssize_t length = descriptor < 0 ? -1 : read(descriptor, text, sizeof text - 1);
    if (descriptor >= 0)
        close(descriptor);
    if (length <= 0)
        return false;
    text[length] = 0;
    uint64_t pages = 0;
    for (const char *digit = text; *digit >= '0' && *digit <= '9'; digit++)
        pages = 10 * pages + (uint64_t)(*digit - '0');
    *bytes = pages * (uint64_t)sysconf(_SC_PAGESIZE);
    return pages > 0;
}

static bool limit_memory(uint64_t memory)
{
    uint64_t used, all;
    if (!mesh_process_limits_memory)
        return true;
    if (!measure_address_space(&used))
        return false;
    if (__builtin_add_overflow(used, memory, &all))
        all = RLIM_INFINITY;
    return limit(RLIMIT_AS, all);
}

static helio_status set_limits(const mesh_child *child)
{
    const mesh_limits *limits = child->limits;
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    if (limit_memory(limits->memory) && limit_time(limits->seconds, limits->texture_seconds) && limit(RLIMIT_CORE, 0) &&
        limit(RLIMIT_FSIZE, limits->memory))
        return HELIO_OK;
    return fail(HELIO_ERR_UNSUPPORTED,
                "%s is not read, as no limits can be set here (%s; is /proc mounted?); set in_process for a file that "
                "you trust",
                child->path, strerror(errno));
}

/* ---- messages -------------------------------------------------------------------------- */

static void send_message(const mesh_child *child, mesh_message_kind kind, int32_t value, const char *text)
{
    mesh_message message = {.kind = kind, .value = value};
    snprintf(message.text, sizeof message.text, "%s", text);
    if (write(child->messages, &message, sizeof message) != sizeof message)
        _exit(1);
}

/* Damaged files make importers loop, and textures only take the time that their pixels take: that is granted later. */
static void extend_time(void *user)
{
    struct rlimit now;
    if (getrlimit(RLIMIT_CPU, &now) == 0 && now.rlim_max > 0) {
        now.rlim_cur = now.rlim_max - 1;
        setrlimit(RLIMIT_CPU, &now);
    }
    send_message(user, MESH_MESSAGE_TEXTURES, 0, "");
}

static void send_log(void *user, helio_log_level level, const char *message)
{
    send_message(user, MESH_MESSAGE_LOG, (int32_t)level, message);
}

/* ---- the work -------------------------------------------------------------------------- */

/* A file that is too large for what max_memory allows is a matter of memory, and else one of a limit of the host. */
static helio_status hand_on(const mesh_child *child, helio_context *context, mesh_arrays *arrays)
{
    struct rlimit files;
    helio_status status = mesh_receipt_write(context, child->memory, arrays);
    if (status != HELIO_ERR_IO || getrlimit(RLIMIT_FSIZE, &files) != 0)
        return status;
    if (files.rlim_cur >= child->limits->memory)
        return HELIO_ERR_MEMORY;
    return fail(HELIO_ERR_IO,
                "%s is not read, as this process may write no file of more than %" PRIu64 " bytes, and its mesh needs "
                "one in memory; raise that limit (ulimit -f), or set in_process for a file that you trust",
                child->path, (uint64_t)files.rlim_cur);
}

static helio_status import(const mesh_child *child)
{
    helio_context_desc desc = {
        .threads = 1, .log_level = child->log_level, .log = send_log, .user = (void *)child, .isa = child->isa};
    const mesh_import_options options = {
        .max_texture_pixels = child->limits->texture_pixels, .on_textures = extend_time, .user = (void *)child};
    helio_context *context;
    mesh_arrays arrays;
    HELIO_TRY(set_limits(child));
    HELIO_TRY(helio_context_create(&desc, &context));
    HELIO_TRY(child->import(context, child->path, &options, &arrays));
    return hand_on(child, context, &arrays);
}

void mesh_child_run(const mesh_child *child)
{
    reset_signals();
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != child->parent) /* it died before it could be told of */
        _exit(1);
    close_descriptors(child);
    helio_status status = import(child);
    send_message(child, MESH_MESSAGE_END, status, status == HELIO_OK ? "" : helio_last_error());
    _exit(0);
}
