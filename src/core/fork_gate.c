/* SPDX-License-Identifier: MIT */
#include "core/fork_gate.h"

#include "core/sanitized.h"

#include <pthread.h>

static pthread_rwlock_t gate = PTHREAD_RWLOCK_INITIALIZER;

void fork_gate_enter(void)
{
    if (SANITIZED)
        pthread_rwlock_rdlock(&gate);
}

void fork_gate_leave(void)
{
    if (SANITIZED)
        pthread_rwlock_unlock(&gate);
}

void fork_gate_close(void)
{
    if (SANITIZED)
        pthread_rwlock_wrlock(&gate);
}

void fork_gate_open(void)
{
    if (SANITIZED)
        pthread_rwlock_unlock(&gate);
}
