/* SPDX-License-Identifier: MIT
 *
 * core.h - status codes, errors, the version and the context.
 *
 * Rules that hold for the whole API; a comment below speaks only where it differs:
 *  - Functions that can fail return helio_status. On failure outputs are untouched (a create
 *    function writes NULL) and helio_last_error() tells why, in one sentence, to the calling thread.
 *  - In a desc, 0 / NULL / false means the default written beside the field, so start from {0};
 *    only fields marked "required" must be set. The library keeps no pointer to a desc.
 *  - helio_x_create() and helio_x_load() give an object that you own; helio_x_destroy() accepts NULL.
 *    Destroy children before their parent: renderer, pools, tables, environment, scene, mesh, context. Images and
 * meshes are plain structs that know no context, so their destroy functions take it.
 *  - Array shapes are written [rows][columns][channels], row-major, without padding.
 *  - Directions are unit vectors, right-handed, +Y up. Densities are per steradian.
 *    Radiance is linear Rec. 709 RGB in the caller's own unit; results carry the same unit.
 *  - Memory is taken in create and load. Functions named update, draw, gather, estimate, render and measure take none,
 *    but for what helio_environment_update() and helio_sky_update() say of devices.
 *  - Functions that take a const object may run at the same time on many threads; those that take a
 *    non-const object need that object, and the objects made from it, to themselves.
 */
#ifndef HELIOSTAT_CORE_H
#define HELIOSTAT_CORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define HELIO_API
#else
#define HELIO_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define HELIO_VERSION 0x000100u /* 0xMMmmpp: major, minor, patch */
#define HELIO_VERSION_TEXT "0.1.0"

/* Version of the library that is really loaded, as HELIO_VERSION. */
HELIO_API uint32_t helio_version(void);

typedef enum helio_status {
    HELIO_OK = 0,
    HELIO_ERR_ARGUMENT = -1,    /* a caller's mistake: bad pointer, size, enum value or specification */
    HELIO_ERR_MEMORY = -2,      /* memory ran out */
    HELIO_ERR_UNSUPPORTED = -3, /* not built in, or this machine cannot do it */
    HELIO_ERR_IO = -4,          /* a file is missing, unreadable or cannot be written */
    HELIO_ERR_DATA = -5,        /* a file was read but what it holds is malformed or not usable */
    HELIO_ERR_DEVICE = -6,      /* a graphics processor or its driver failed, or was lost: destroy what is on it */
} helio_status;

/* "HELIO_ERR_MEMORY" and so on; static, never NULL. */
HELIO_API const char *helio_status_name(helio_status status);

/* One sentence about this thread's latest failure, "" if there was none. Valid until the thread's next failure. */
HELIO_API const char *helio_last_error(void);

/* ---- context: memory, log and threads, shared by everything made from it ---------- */

typedef struct helio_context helio_context;

typedef enum helio_log_level {
    HELIO_LOG_ERROR = 0,
    HELIO_LOG_WARNING = 1,
    HELIO_LOG_INFO = 2,
    HELIO_LOG_DEBUG = 3,
} helio_log_level;

/* One piece of a parallel loop; index in [0, count). Pieces may run in any order, on any thread. */
typedef void (*helio_loop_body)(void *data, size_t index);

typedef struct helio_context_desc {
    /* Threads of the built-in pool, the caller's included, 1..1024; default: one per logical core that the process may
     * use. With a parallel_for of your own: how many it uses, if you know. */
    uint32_t threads;

    helio_log_level log_level; /* messages above this level are dropped; default: errors only */

    /* Receives one line without a newline; may be called from any thread, one call at a time. Default: stderr. */
    void (*log)(void *user, helio_log_level level, const char *message);

    /* Give both or neither. alignment is a power of two; release gets what allocate returned, never NULL. May be called
     * by several threads at once: by the caller's, and by those with which sources read ahead. Default: the C library.
     */
    void *(*allocate)(void *user, size_t bytes, size_t alignment);
    void (*release)(void *user, void *memory);

    /* Runs body(data, 0) ... body(data, count - 1), returns when all are done. An engine gives its own job system
     * here; results do not depend on it. Default: a small pool of pthreads. Calls do not nest, and come from the
     * caller's threads only. */
    void (*parallel_for)(void *user, size_t count, helio_loop_body body, void *data);

    void *user; /* handed to the four functions above */

    /* The instruction set that the kernels use, a name of helio_isa_name(). Default: what the environment variable
     * HELIOSTAT_ISA names, else the best that the machine has. HELIO_ERR_UNSUPPORTED where the machine lacks it. */
    const char *isa;
} helio_context_desc;

/* desc may be NULL: all defaults. */
HELIO_API helio_status helio_context_create(const helio_context_desc *desc, helio_context **context);
HELIO_API void helio_context_destroy(helio_context *context);

/* Threads that a parallel loop of this context uses, at least 1. */
HELIO_API uint32_t helio_context_threads(const helio_context *context);

/* The instruction set that this context's kernels use: "scalar", "sse2", "avx2", "avx512", or "simd" on processors that
 * are not x86. Tables and pools have the same bits with each; images differ by no more than docs/method.md says. */
HELIO_API const char *helio_context_isa(const helio_context *context);

/* Name of the index-th instruction set that this build has kernels for and this machine runs, from the plainest
 * ("scalar") to the best; NULL from their number on. */
HELIO_API const char *helio_isa_name(uint32_t index);

#ifdef __cplusplus
}
#endif
#endif
