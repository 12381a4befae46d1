/* SPDX-License-Identifier: MIT */
#include "core/context.h"

#include "core/error.h"
#include "core/thread_pool.h"

#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

enum { MAX_THREADS = 1024, HUGE_PAGE = 1 << 21, HUGE_FROM = HUGE_PAGE / 2 /* no more than twice what is asked */ };

struct helio_context {
    helio_context_desc desc; /* with defaults resolved */
    isa isa;
    pthread_mutex_t log_mutex;
    thread_pool pool;
    bool has_pool;
};

/* Samples reach into large arrays at random: with small pages each would also miss the table of pages. */
static void *allocate_huge(size_t bytes)
{
    size_t rounded = (bytes + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE;
    void *memory = aligned_alloc(HUGE_PAGE, rounded);
    if (memory != NULL)
        madvise(memory, rounded, MADV_HUGEPAGE); /* a wish: without it all is as right, but slower */
    return memory;
}

static void *default_allocate(void *user, size_t bytes, size_t alignment)
{
    (void)user;
    if (bytes >= HUGE_FROM && alignment <= HUGE_PAGE)
        return allocate_huge(bytes);
    return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void default_release(void *user, void *memory)
{
    (void)user;
    free(memory);
}

static void default_log(void *user, helio_log_level level, const char *message)
{
    static const char *const names[] = {"error", "warning", "info", "debug"};
    (void)user;
    fprintf(stderr, "heliostat: %s: %s\n", names[level], message);
}

/* Cores that this process may use: in a container often far fewer than the machine has. */
static uint32_t logical_cores(void)
{
    cpu_set_t allowed;
    long cores =
        sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : cores > MAX_THREADS ? MAX_THREADS : (uint32_t)cores;
}

/* The only place where the defaults of a context live. */
static helio_status resolve_desc(const helio_context_desc *given, helio_context_desc *desc)
{
    *desc = given ? *given : (helio_context_desc){0};
    if ((desc->allocate == NULL) != (desc->release == NULL))
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_context_desc has only one of allocate and release; give both or neither");
    if (desc->threads > MAX_THREADS)
        return fail(HELIO_ERR_ARGUMENT, "%u threads were asked for; use 1 to %d, or 0 for one per core", desc->threads,
                    MAX_THREADS);
    if (desc->log_level < HELIO_LOG_ERROR || desc->log_level > HELIO_LOG_DEBUG)
        return fail(HELIO_ERR_ARGUMENT, "log level %d is unknown; use HELIO_LOG_ERROR to HELIO_LOG_DEBUG",
                    (int)desc->log_level);
    if (desc->threads == 0)
        desc->threads = logical_cores();
    if (desc->allocate == NULL) {
        desc->allocate = default_allocate;
        desc->release = default_release;
    }
    if (desc->log == NULL)
        desc->log = default_log;
    return HELIO_OK;
}

helio_status helio_context_create(const helio_context_desc *given, helio_context **out)
{
    if (out == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_context_create needs a place for the context");
    *out = NULL;
    helio_context_desc desc;
    isa set;
    HELIO_TRY(resolve_desc(given, &desc));
    HELIO_TRY(isa_choose(desc.isa, &set));

    helio_context *context = desc.allocate(desc.user, sizeof *context, CONTEXT_ALIGNMENT);
    if (context == NULL)
        return fail(HELIO_ERR_MEMORY, "no memory for a context");
    memset(context, 0, sizeof *context);
    context->desc = desc;
    context->isa = set;
    pthread_mutex_init(&context->log_mutex, NULL);

    if (desc.parallel_for == NULL) {
        pthread_t *workers = context_allocate(context, desc.threads, sizeof *workers);
        if (workers == NULL) {
            helio_context_destroy(context);
            return HELIO_ERR_MEMORY;
        }
        thread_pool_start(&context->pool, workers, desc.threads);
        context->has_pool = true;
        if (context->pool.worker_count + 1 < desc.threads) {
            context_log(context, HELIO_LOG_WARNING, "only %u of %u threads could be started",
                        context->pool.worker_count + 1, desc.threads);
            context->desc.threads = context->pool.worker_count + 1;
        }
    }
    *out = context;
    return HELIO_OK;
}

void helio_context_destroy(helio_context *context)
{
    if (context == NULL)
        return;
    if (context->has_pool) {
        thread_pool_stop(&context->pool);
        context_release(context, context->pool.workers);
    }
    pthread_mutex_destroy(&context->log_mutex);
    context->desc.release(context->desc.user, context);
}

uint32_t helio_context_threads(const helio_context *context)
{
    return context->desc.threads;
}

helio_log_level context_log_level(const helio_context *context)
{
    return context->desc.log_level;
}

isa context_isa(const helio_context *context)
{
    return context->isa;
}

const char *helio_context_isa(const helio_context *context)
{
    return isa_name(context->isa);
}

void *context_allocate(helio_context *context, size_t count, size_t size)
{
    size_t bytes;
    void *memory = NULL;
    if (!__builtin_mul_overflow(count, size, &bytes) && bytes <= SIZE_MAX / 2)
        memory = context->desc.allocate(context->desc.user, bytes ? bytes : 1, CONTEXT_ALIGNMENT);
    if (memory == NULL) {
        fail(HELIO_ERR_MEMORY, "no memory for %zu elements of %zu bytes", count, size);
        return NULL;
    }
    memset(memory, 0, bytes ? bytes : 1);
    return memory;
}

void context_release(helio_context *context, void *memory)
{
    if (memory != NULL)
        context->desc.release(context->desc.user, memory);
}

void context_log(helio_context *context, helio_log_level level, const char *format, ...)
{
    if (level > context->desc.log_level)
        return;
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    pthread_mutex_lock(&context->log_mutex);
    context->desc.log(context->desc.user, level, message);
    pthread_mutex_unlock(&context->log_mutex);
}

void context_parallel_for(helio_context *context, size_t count, helio_loop_body body, void *data)
{
    if (context->desc.parallel_for != NULL)
        context->desc.parallel_for(context->desc.user, count, body, data);
    else
        thread_pool_run(&context->pool, count, body, data);
}
