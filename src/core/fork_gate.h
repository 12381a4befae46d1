/* SPDX-License-Identifier: MIT
 * fork_gate.h - keeps threads out of the allocator while a process is made, in builds with sanitizers.
 *
 * The C library's allocator comes whole through fork(). That of address sanitizer does not: if another thread is within
 * it, the child finds a lock that nobody will ever open, and waits for it until it is killed. Other builds do nothing
 * here. */
#ifndef HELIOSTAT_SRC_CORE_FORK_GATE_H
#define HELIOSTAT_SRC_CORE_FORK_GATE_H

/* Around work that takes memory beside the host's threads. Not nested. */
void fork_gate_enter(void);
void fork_gate_leave(void);

/* Around fork(): waits until all have left, and lets nobody enter. */
void fork_gate_close(void);
void fork_gate_open(void);

#endif
