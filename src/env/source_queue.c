/* SPDX-License-Identifier: MIT */
#include "env/source_queue.h"

#include "core/clock.h"
#include "core/context.h"
#include "core/fork_gate.h"

#include <signal.h>
#include <stdio.h>

/* ---- slots ---- */

static void empty_slot(const source_queue *queue, source_slot *slot)
{
    helio_image_destroy(queue->reader->context, slot->image);
    slot->image = NULL;
    slot->frame = (helio_source_frame){0}; /* a copy's memory stays for the next frame */
}

static void fill_slot(const source_queue *queue, source_slot *slot)
{
    source_reader *reader = queue->reader;
    double start = clock_seconds();
    slot->frame = (helio_source_frame){.name = reader->label};
    slot->status = reader->kind->read(reader, slot);
    slot->frame.read_ms = 1e3 * (clock_seconds() - start);
    if (slot->status != HELIO_OK)
        snprintf(slot->error, sizeof slot->error, "%s", helio_last_error());
}

/* Gives the slot of a held frame the pixels of the frame before, with the memory that they are in. */
static void hand_over(source_slot *from, source_slot *to)
{
    helio_image *image = to->image;
    float *copy = to->copy;
    size_t copy_floats = to->copy_floats;
    to->image = from->image;
    to->copy = from->copy;
    to->copy_floats = from->copy_floats;
    from->image = image;
    from->copy = copy;
    from->copy_floats = copy_floats;
    to->frame.rgb = from->frame.rgb;
    to->frame.width = from->frame.width;
    to->frame.height = from->frame.height;
    to->frame.layout = from->frame.layout;
    to->frame.bad = from->frame.bad;
}

/* ---- the thread ---- */

static bool wait_for_room(source_queue *queue)
{
    pthread_mutex_lock(&queue->mutex);
    while (queue->filled - queue->emptied == queue->slot_count && !atomic_load(&queue->stopping))
        pthread_cond_wait(&queue->changed, &queue->mutex);
    pthread_mutex_unlock(&queue->mutex);
    return !atomic_load(&queue->stopping);
}

static void *read_frames(void *argument)
{
    source_queue *queue = argument;
    bool is_last = false;
    for (uint64_t number = 0; !is_last && wait_for_room(queue); number++) {
        source_slot *slot = &queue->slots[number % queue->slot_count];
        fork_gate_enter();
        fill_slot(queue, slot);
        fork_gate_leave();
        is_last = slot->status != HELIO_OK || source_slot_is_end(slot);
        pthread_mutex_lock(&queue->mutex);
        queue->filled++;
        pthread_cond_broadcast(&queue->changed);
        pthread_mutex_unlock(&queue->mutex);
    }
    return NULL;
}

/* Signals are for the threads of the program, not for this one. */
static bool start_thread(source_queue *queue)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    bool started = pthread_create(&queue->thread, NULL, read_frames, queue) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

/* ---- life ---- */

helio_status source_queue_create(source_queue *queue, helio_context *context, uint32_t ahead)
{
    queue->has_thread = ahead > 0;
    queue->slot_count = ahead > 0 ? ahead + 1 : 2; /* a held frame needs the one before */
    queue->slots = context_allocate(context, queue->slot_count, sizeof *queue->slots);
    if (queue->slots == NULL)
        return HELIO_ERR_MEMORY;
    pthread_mutex_init(&queue->mutex, NULL);
    pthread_cond_init(&queue->changed, NULL);
    atomic_init(&queue->stopping, false);
    return HELIO_OK;
}

void source_queue_start(source_queue *queue, source_reader *reader)
{
    queue->reader = reader;
    if (queue->has_thread && !start_thread(queue)) {
        queue->has_thread = false;
        context_log(reader->context, HELIO_LOG_WARNING,
                    "no thread can be had to read %s ahead; each frame is read when it is wanted", reader->label);
    }
}

source_slot *source_queue_next(source_queue *queue)
{
    source_slot *slot = &queue->slots[queue->taken % queue->slot_count];
    if (!queue->has_thread)
        fill_slot(queue, slot);
    pthread_mutex_lock(&queue->mutex);
    while (queue->has_thread && queue->filled == queue->taken)
        pthread_cond_wait(&queue->changed, &queue->mutex);
    pthread_mutex_unlock(&queue->mutex);
    if (queue->taken > 0) {
        source_slot *before = &queue->slots[(queue->taken - 1) % queue->slot_count];
        if (slot->frame.is_held)
            hand_over(before, slot);
        empty_slot(queue, before);
        pthread_mutex_lock(&queue->mutex);
        queue->emptied++;
        pthread_cond_broadcast(&queue->changed);
        pthread_mutex_unlock(&queue->mutex);
    }
    queue->taken++;
    return slot;
}

void source_queue_stop(source_queue *queue)
{
    if (queue->reader == NULL)
        return;
    if (queue->has_thread) {
        pthread_mutex_lock(&queue->mutex);
        atomic_store(&queue->stopping, true);
        pthread_cond_broadcast(&queue->changed);
        pthread_mutex_unlock(&queue->mutex);
        pthread_join(queue->thread, NULL);
        queue->has_thread = false;
    }
    for (uint32_t i = 0; i < queue->slot_count; i++) {
        empty_slot(queue, &queue->slots[i]);
        context_release(queue->reader->context, queue->slots[i].copy);
        queue->slots[i].copy = NULL;
    }
    queue->reader->kind->destroy(queue->reader);
    queue->reader = NULL;
}

void source_queue_destroy(source_queue *queue, helio_context *context)
{
    if (queue->slots == NULL)
        return;
    source_queue_stop(queue);
    pthread_cond_destroy(&queue->changed);
    pthread_mutex_destroy(&queue->mutex);
    context_release(context, queue->slots);
    queue->slots = NULL;
}
