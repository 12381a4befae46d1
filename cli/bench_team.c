/* SPDX-License-Identifier: MIT */
#include "bench_team.h"

#include "message.h"

#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

typedef struct worker {
    bench_team *team;
    uint32_t index;
    pthread_t thread;
} worker;

struct bench_team {
    pthread_mutex_t mutex;
    pthread_cond_t work_is_there, work_is_done;
    bench_team_body body;
    void *data;
    uint64_t round;   /* of work */
    uint32_t threads; /* the caller's included */
    uint32_t running; /* workers that are not done with this round */
    uint32_t started; /* workers that exist */
    bool stopping;
    worker workers[];
};

static void *work(void *argument)
{
    worker *self = argument;
    bench_team *team = self->team;
    uint64_t seen = 0;
    pthread_mutex_lock(&team->mutex);
    for (;;) {
        while (!team->stopping && team->round == seen)
            pthread_cond_wait(&team->work_is_there, &team->mutex);
        if (team->stopping)
            break;
        seen = team->round;
        pthread_mutex_unlock(&team->mutex);
        team->body(team->data, self->index, team->threads);
        pthread_mutex_lock(&team->mutex);
        if (--team->running == 0)
            pthread_cond_signal(&team->work_is_done);
    }
    pthread_mutex_unlock(&team->mutex);
    return NULL;
}

int bench_team_create(uint32_t threads, bench_team **out)
{
    *out = NULL;
    bench_team *team = calloc(1, sizeof *team + (threads - 1) * sizeof team->workers[0]);
    if (team == NULL)
        return message_failure("no memory for a team of %u threads", threads);
    team->threads = threads;
    pthread_mutex_init(&team->mutex, NULL);
    pthread_cond_init(&team->work_is_there, NULL);
    pthread_cond_init(&team->work_is_done, NULL);
    for (; team->started + 1 < threads; team->started++) {
        worker *next = &team->workers[team->started];
        *next = (worker){.team = team, .index = team->started + 1};
        if (pthread_create(&next->thread, NULL, work, next) != 0) {
            bench_team_destroy(team);
            return message_failure("%u threads cannot be started; give --threads smaller numbers", threads);
        }
    }
    *out = team;
    return EXIT_CODE_OK;
}

void bench_team_destroy(bench_team *team)
{
    if (team == NULL)
        return;
    pthread_mutex_lock(&team->mutex);
    team->stopping = true;
    pthread_cond_broadcast(&team->work_is_there);
    pthread_mutex_unlock(&team->mutex);
    for (uint32_t i = 0; i < team->started; i++)
        pthread_join(team->workers[i].thread, NULL);
    pthread_cond_destroy(&team->work_is_done);
    pthread_cond_destroy(&team->work_is_there);
    pthread_mutex_destroy(&team->mutex);
    free(team);
}

uint32_t bench_team_threads(const bench_team *team)
{
    return team->threads;
}

void bench_team_run(bench_team *team, bench_team_body body, void *data)
{
    pthread_mutex_lock(&team->mutex);
    team->body = body;
    team->data = data;
    team->running = team->started;
    team->round++;
    pthread_cond_broadcast(&team->work_is_there);
    pthread_mutex_unlock(&team->mutex);
    body(data, 0, team->threads);
    pthread_mutex_lock(&team->mutex);
    while (team->running != 0)
        pthread_cond_wait(&team->work_is_done, &team->mutex);
    pthread_mutex_unlock(&team->mutex);
}
