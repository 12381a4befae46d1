/* SPDX-License-Identifier: MIT
 *
 * Frames of a sequence need the same few blocks again and again, some of them of nearly the same size. Taking 24 MiB
 * afresh for each map of 2048 x 1024 pixels would have the system clear them and hand them out page by page. */
#include "env/source_memory.h"

#include "core/context.h"
#include "core/error.h"

#include <pthread.h>
#include <stdalign.h>
#include <stddef.h>

enum {
    MAX_IDLE = 32,   /* blocks that are kept */
    MAX_AGE = 256,   /* allocations after which a block that nobody wanted goes back */
    SLACK = 8,       /* a block is larger by 1 / SLACK than was asked for: files differ a little in size */
    SMALL = 1 << 12, /* bytes; a block up to this size serves for all that are smaller */
};

/* Stands before each block. */
typedef struct block_head {
    alignas(CONTEXT_ALIGNMENT) size_t size;
    uint64_t given_back; /* at which tick */
} block_head;

struct source_memory {
    helio_context *parent, *context;
    bool keep;
    pthread_mutex_t mutex; /* guards what follows: frames are given back by the thread that uses them */
    block_head *idle[MAX_IDLE];
    size_t idle_count;
    uint64_t tick; /* counts allocations */
};

static void drop_idle(source_memory *memory, size_t index)
{
    context_release(memory->parent, memory->idle[index]);
    memory->idle[index] = memory->idle[--memory->idle_count];
}

static size_t find_oldest(const source_memory *memory)
{
    size_t oldest = 0;
    for (size_t i = 1; i < memory->idle_count; i++)
        if (memory->idle[i]->given_back < memory->idle[oldest]->given_back)
            oldest = i;
    return oldest;
}

/* The smallest idle block that holds so much and is not far too large; NULL if there is none. */
static block_head *take_idle(source_memory *memory, size_t bytes)
{
    size_t best = memory->idle_count;
    for (size_t i = 0; i < memory->idle_count; i++) {
        size_t size = memory->idle[i]->size;
        bool fits = size >= bytes && (size <= SMALL || size / 2 <= bytes);
        if (fits && (best == memory->idle_count || size < memory->idle[best]->size))
            best = i;
    }
    if (best == memory->idle_count)
        return NULL;
    block_head *head = memory->idle[best];
    memory->idle[best] = memory->idle[--memory->idle_count];
    return head;
}

static block_head *take_fresh(source_memory *memory, size_t bytes)
{
    size_t size = memory->keep ? bytes + bytes / SLACK : bytes;
    block_head *head = context_allocate(memory->parent, 1, sizeof *head + size);
    if (head == NULL && memory->idle_count > 0) {
        while (memory->idle_count > 0)
            drop_idle(memory, 0);
        head = context_allocate(memory->parent, 1, sizeof *head + size);
    }
    if (head != NULL)
        head->size = size;
    return head;
}

static void *allocate(void *user, size_t bytes, size_t alignment)
{
    source_memory *memory = user;
    if (alignment > CONTEXT_ALIGNMENT || bytes > SIZE_MAX / 4)
        return NULL;
    pthread_mutex_lock(&memory->mutex);
    memory->tick++;
    block_head *head = take_idle(memory, bytes);
    if (memory->idle_count > 0) {
        size_t oldest = find_oldest(memory);
        if (memory->tick - memory->idle[oldest]->given_back > MAX_AGE)
            drop_idle(memory, oldest);
    }
    if (head == NULL)
        head = take_fresh(memory, bytes);
    pthread_mutex_unlock(&memory->mutex);
    return head != NULL ? head + 1 : NULL;
}

static void release(void *user, void *block)
{
    source_memory *memory = user;
    block_head *head = (block_head *)block - 1;
    pthread_mutex_lock(&memory->mutex);
    if (memory->keep) {
        if (memory->idle_count == MAX_IDLE)
            drop_idle(memory, find_oldest(memory));
        head->given_back = memory->tick;
        memory->idle[memory->idle_count++] = head;
    } else {
        context_release(memory->parent, head);
    }
    pthread_mutex_unlock(&memory->mutex);
}

static void forward_log(void *user, helio_log_level level, const char *message)
{
    context_log(((source_memory *)user)->parent, level, "%s", message);
}

static void run_here(void *user, size_t count, helio_loop_body body, void *data)
{
    (void)user;
    for (size_t i = 0; i < count; i++)
        body(data, i);
}

helio_status source_memory_create(helio_context *parent, bool keep, source_memory **out)
{
    source_memory *memory = context_allocate(parent, 1, sizeof *memory);
    if (memory == NULL)
        return HELIO_ERR_MEMORY;
    memory->parent = parent;
    memory->keep = keep;
    pthread_mutex_init(&memory->mutex, NULL);
    helio_context_desc desc = {.threads = helio_context_threads(parent), /* decoders have threads of their own */
                               .log_level = context_log_level(parent),
                               .log = forward_log,
                               .allocate = allocate,
                               .release = release,
                               .parallel_for = run_here,
                               .user = memory,
                               .isa = helio_context_isa(parent)};
    helio_status status = helio_context_create(&desc, &memory->context);
    if (status != HELIO_OK) {
        source_memory_destroy(memory);
        return status;
    }
    *out = memory;
    return HELIO_OK;
}

void source_memory_destroy(source_memory *memory)
{
    if (memory == NULL)
        return;
    helio_context_destroy(memory->context);
    source_memory_trim(memory);
    pthread_mutex_destroy(&memory->mutex);
    context_release(memory->parent, memory);
}

helio_context *source_memory_context(source_memory *memory)
{
    return memory->context;
}

void source_memory_trim(source_memory *memory)
{
    pthread_mutex_lock(&memory->mutex);
    while (memory->idle_count > 0)
        drop_idle(memory, 0);
    pthread_mutex_unlock(&memory->mutex);
}
