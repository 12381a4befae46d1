/* SPDX-License-Identifier: MIT */
#include "core/thread_pool.h"

static void run_pieces(thread_pool *pool, helio_loop_body body, void *data, size_t count)
{
    for (;;) {
        size_t index = atomic_fetch_add_explicit(&pool->next, 1, memory_order_relaxed);
        if (index >= count)
            return;
        body(data, index);
    }
}

static void *worker_main(void *argument)
{
    thread_pool *pool = argument;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->mutex);
    for (;;) {
        while (!pool->stopping && pool->loop == seen)
            pthread_cond_wait(&pool->work_is_there, &pool->mutex);
        if (pool->stopping)
            break;
        seen = pool->loop;
        helio_loop_body body = pool->body;
        void *data = pool->data;
        size_t count = pool->count;
        pthread_mutex_unlock(&pool->mutex);
        run_pieces(pool, body, data, count);
        pthread_mutex_lock(&pool->mutex);
        if (--pool->running == 0)
            pthread_cond_signal(&pool->work_is_done);
    }
    pthread_mutex_unlock(&pool->mutex);
    return NULL;
}

void thread_pool_start(thread_pool *pool, pthread_t *workers, uint32_t threads)
{
    *pool = (thread_pool){.workers = workers};
    pthread_mutex_init(&pool->mutex, NULL);
    pthread_cond_init(&pool->work_is_there, NULL);
    pthread_cond_init(&pool->work_is_done, NULL);
    while (pool->worker_count + 1 < threads &&
           pthread_create(&workers[pool->worker_count], NULL, worker_main, pool) == 0)
        pool->worker_count++;
}

void thread_pool_stop(thread_pool *pool)
{
    pthread_mutex_lock(&pool->mutex);
    pool->stopping = true;
    pthread_cond_broadcast(&pool->work_is_there);
    pthread_mutex_unlock(&pool->mutex);
    for (uint32_t i = 0; i < pool->worker_count; i++)
        pthread_join(pool->workers[i], NULL);
    pthread_cond_destroy(&pool->work_is_done);
    pthread_cond_destroy(&pool->work_is_there);
    pthread_mutex_destroy(&pool->mutex);
}

static void run_alone(size_t count, helio_loop_body body, void *data)
{
    for (size_t i = 0; i < count; i++)
        body(data, i);
}

/* Two threads may start loops at once, for two objects of one context: the second runs its loop alone. */
void thread_pool_run(thread_pool *pool, size_t count, helio_loop_body body, void *data)
{
    if (pool->worker_count == 0 || count < 2) {
        run_alone(count, body, data);
        return;
    }
    pthread_mutex_lock(&pool->mutex);
    if (pool->body != NULL) {
        pthread_mutex_unlock(&pool->mutex);
        run_alone(count, body, data);
        return;
    }
    pool->body = body;
    pool->data = data;
    pool->count = count;
    pool->running = pool->worker_count;
    atomic_store_explicit(&pool->next, 0, memory_order_relaxed);
    pool->loop++;
    pthread_cond_broadcast(&pool->work_is_there);
    pthread_mutex_unlock(&pool->mutex);

    run_pieces(pool, body, data, count);

    pthread_mutex_lock(&pool->mutex);
    while (pool->running != 0)
        pthread_cond_wait(&pool->work_is_done, &pool->mutex);
    pool->body = NULL;
    pthread_mutex_unlock(&pool->mutex);
}
