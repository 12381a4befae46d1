/* SPDX-License-Identifier: MIT
 * thread_pool.h - the default parallel_for: a few threads that wait for loops. */
#ifndef HELIOSTAT_SRC_THREAD_POOL_H
#define HELIOSTAT_SRC_THREAD_POOL_H

#include <heliostat/core.h>

#include <pthread.h>
#include <stdatomic.h>

typedef struct thread_pool {
    pthread_mutex_t mutex;
    pthread_cond_t work_is_there, work_is_done;
    pthread_t *workers;
    uint32_t worker_count; /* started, the calling thread not counted */

    /* The loop in progress, guarded by mutex except for next. */
    helio_loop_body body;
    void *data;
    size_t count;
    atomic_size_t next;
    uint64_t loop;    /* number of the loop, so that a worker joins each once */
    uint32_t running; /* workers that have not finished this loop */
    bool stopping;
} thread_pool;

/* workers: array for threads - 1 handles, kept by the pool. Starts as many threads as the system allows. */
void thread_pool_start(thread_pool *pool, pthread_t *workers, uint32_t threads);
void thread_pool_stop(thread_pool *pool);
void thread_pool_run(thread_pool *pool, size_t count, helio_loop_body body, void *data);

#endif
