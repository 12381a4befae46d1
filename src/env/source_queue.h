/* SPDX-License-Identifier: MIT
 * source_queue.h - frames on their way from the thread that reads them to the one that uses them. */
#ifndef HELIOSTAT_SRC_SOURCE_QUEUE_H
#define HELIOSTAT_SRC_SOURCE_QUEUE_H

#include "env/source_reader.h"

#include <pthread.h>

/* Slots are filled, used and emptied in turn, as a ring. The counts only grow. */
typedef struct source_queue {
    source_reader *reader;
    source_slot *slots;
    uint32_t slot_count;
    bool has_thread; /* else frames are read when they are wanted */
    pthread_t thread;
    atomic_bool stopping;

    pthread_mutex_t mutex;
    pthread_cond_t changed;
    uint64_t filled; /* slots so far, by the reader; guarded by mutex, as is the next */
    uint64_t emptied;
    uint64_t taken; /* by the user, who has the latest; only the user's thread looks at it */
} source_queue;

/* ahead: frames that are read while one is in use; 0: no thread is made. */
helio_status source_queue_create(source_queue *queue, helio_context *context, uint32_t ahead);

/* From now on frames are read. If no thread can be had, they will be when they are wanted. */
void source_queue_start(source_queue *queue, source_reader *reader);

/* Waits for the next slot and takes back the one before. Not to be called any more after the end or a failure. */
source_slot *source_queue_next(source_queue *queue);

/* Stops the thread and empties all slots; destroys the reader. Fine after any of the functions above. */
void source_queue_stop(source_queue *queue);

void source_queue_destroy(source_queue *queue, helio_context *context);

#endif
