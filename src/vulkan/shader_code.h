/* SPDX-License-Identifier: MIT
 * shader_code.h - the shaders as SPIR-V, made by the build. */
#ifndef HELIOSTAT_SRC_SHADER_CODE_H
#define HELIOSTAT_SRC_SHADER_CODE_H

#include <stddef.h>
#include <stdint.h>

typedef struct shader_code {
    const char *name; /* of the file in shaders/, without its end */
    const uint32_t *words;
    size_t bytes;
} shader_code;

extern const shader_code shader_codes[];
extern const size_t shader_code_count;

#endif
