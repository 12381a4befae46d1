/* SPDX-License-Identifier: MIT
 * mesh_child.h - what happens in the process that reads a mesh, and what it tells to the one that waits for it. */
#ifndef HELIOSTAT_SRC_MESH_CHILD_H
#define HELIOSTAT_SRC_MESH_CHILD_H

#include "scene/mesh_process.h"

#include <sys/types.h>

typedef enum mesh_message_kind {
    MESH_MESSAGE_LOG = 1,  /* value: a helio_log_level */
    MESH_MESSAGE_TEXTURES, /* only textures remain: from here on their time holds */
    MESH_MESSAGE_END,      /* value: a helio_status; the last one */
} mesh_message_kind;

/* Shorter than what a pipe takes in one piece. */
typedef struct mesh_message {
    uint32_t kind;
    int32_t value;
    char text[1024];
} mesh_message;

/* All that the child needs, found out before the fork. */
typedef struct mesh_child {
    pid_t parent;
    const char *path;
    mesh_importer import;
    const mesh_limits *limits;
    const char *isa;
    helio_log_level log_level; /* what the host would not show is not sent */
    int memory, messages;      /* descriptors, above 2: a memory file for the mesh, the end of a pipe */
} mesh_child;

/* Never returns. Nothing of the host is used: not its context, its log, its handlers or its open files. */
_Noreturn void mesh_child_run(const mesh_child *child);

#endif
