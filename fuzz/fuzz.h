/* SPDX-License-Identifier: MIT
 * fuzz.h - what the fuzz targets share: a context that counts its memory, inputs as numbers and as files, and what must
 * hold whatever the input is. */
#ifndef HELIOSTAT_FUZZ_H
#define HELIOSTAT_FUZZ_H

#include <heliostat/core.h>
#include <heliostat/image.h>

/* Each target defines it: tries one input and returns 0. Called by libFuzzer, or for the files of a folder by replay.c.
 */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Aborts, so that the input counts as a finding, where something does not hold that must. */
#define FUZZ_EXPECT(condition)                                                                                         \
    do {                                                                                                               \
        if (!(condition))                                                                                              \
            fuzz_stop(__FILE__, __LINE__, #condition);                                                                 \
    } while (0)

_Noreturn void fuzz_stop(const char *file, int line, const char *condition);

/* ---- context ---- */

enum {
    FUZZ_MAX_PIXELS = 1 << 16, /* of pictures: larger ones are refused, which keeps the targets quick */
    FUZZ_MAX_BLOCK = 64 << 20, /* bytes: to ask for more at once, for inputs of some kilobytes, is a finding */
};

/* A context with one thread, made on the first call. */
helio_context *fuzz_context(void);

/* Blocks of memory that the library holds, the context's own not counted. */
size_t fuzz_live_blocks(void);

/* A failure must have its sentence: a single line, and only printable ASCII if it speaks of a file, whose words may be
 * anything. */
void fuzz_expect_sentence(bool printable);

/* ---- inputs ---- */

/* Reads an input piece by piece; zeros follow its end. */
typedef struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
} fuzz_bytes;

uint8_t fuzz_take_byte(fuzz_bytes *bytes);
uint32_t fuzz_take_whole(fuzz_bytes *bytes, uint32_t least, uint32_t greatest); /* from two bytes */
void fuzz_take(fuzz_bytes *bytes, void *to, size_t size);

/* A copy of exactly size bytes, or of the input as a text, so that the address sanitizer sees what reads too far. */
void *fuzz_copy(const uint8_t *data, size_t size);
char *fuzz_text(const uint8_t *data, size_t size);

/* Puts the input into a file in memory and returns its path. */
const char *fuzz_file(const uint8_t *data, size_t size);

/* Does the input start with these bytes? */
bool fuzz_starts_with(const uint8_t *data, size_t size, const char *start, size_t length);

/* ---- pictures ---- */

/* Reads the input as a picture from a file and, as materials do, as a texture from memory; looks at every pixel. */
void fuzz_read_image(const uint8_t *data, size_t size);
void fuzz_decode_texture(const uint8_t *data, size_t size);

#endif
