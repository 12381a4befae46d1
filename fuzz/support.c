/* SPDX-License-Identifier: MIT */
#include "fuzz.h"

#include "scene/texture.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

_Noreturn void fuzz_stop(const char *file, int line, const char *condition)
{
    fprintf(stderr, "%s:%d: this does not hold: %s\n", file, line, condition);
    abort();
}

/* ---- context ---- */

static atomic_size_t live_blocks;
static size_t own_blocks; /* of the context itself */

static void *count_allocate(void *user, size_t bytes, size_t alignment)
{
    (void)user;
    FUZZ_EXPECT(bytes <= FUZZ_MAX_BLOCK);
    atomic_fetch_add(&live_blocks, 1);
    return aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
}

static void count_release(void *user, void *memory)
{
    (void)user;
    atomic_fetch_sub(&live_blocks, 1);
    free(memory);
}

static bool is_printable(const char *text)
{
    for (; *text != 0; text++)
        if (*text < ' ' || *text > '~')
            return false;
    return true;
}

static void check_message(void *user, helio_log_level level, const char *message)
{
    (void)user;
    (void)level;
    FUZZ_EXPECT(message[0] != 0 && is_printable(message));
}

helio_context *fuzz_context(void)
{
    static helio_context *context;
    if (context == NULL) {
        helio_context_desc desc = {.threads = 1,
                                   .log_level = HELIO_LOG_DEBUG,
                                   .log = check_message,
                                   .allocate = count_allocate,
                                   .release = count_release};
        FUZZ_EXPECT(helio_context_create(&desc, &context) == HELIO_OK);
        own_blocks = live_blocks;
    }
    return context;
}

size_t fuzz_live_blocks(void)
{
    return live_blocks - own_blocks;
}

void fuzz_expect_sentence(bool printable)
{
    const char *sentence = helio_last_error();
    FUZZ_EXPECT(sentence[0] != 0);
    FUZZ_EXPECT(!printable || is_printable(sentence));
}

/* ---- inputs ---- */

void fuzz_take(fuzz_bytes *bytes, void *to, size_t size)
{
    size_t count = size < bytes->left ? size : bytes->left;
    memset(to, 0, size);
    if (count > 0)
        memcpy(to, bytes->at, count);
    bytes->at += count;
    bytes->left -= count;
}

uint8_t fuzz_take_byte(fuzz_bytes *bytes)
{
    uint8_t byte;
    fuzz_take(bytes, &byte, 1);
    return byte;
}

uint32_t fuzz_take_whole(fuzz_bytes *bytes, uint32_t least, uint32_t greatest)
{
    uint32_t low = fuzz_take_byte(bytes), high = fuzz_take_byte(bytes);
    return least + (low | high << 8) % (greatest - least + 1);
}

void *fuzz_copy(const uint8_t *data, size_t size)
{
    void *copy = malloc(size > 0 ? size : 1);
    FUZZ_EXPECT(copy != NULL);
    if (size > 0)
        memcpy(copy, data, size);
    return copy;
}

char *fuzz_text(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    FUZZ_EXPECT(text != NULL);
    if (size > 0)
        memcpy(text, data, size);
    text[size] = 0;
    return text;
}

const char *fuzz_file(const uint8_t *data, size_t size)
{
    static char path[64];
    static int descriptor = -1;
    if (descriptor < 0) {
        descriptor = memfd_create("fuzz", MFD_CLOEXEC);
        snprintf(path, sizeof path, "/proc/self/fd/%d", descriptor);
    }
    FUZZ_EXPECT(ftruncate(descriptor, 0) == 0 && pwrite(descriptor, data, size, 0) == (ssize_t)size);
    return path;
}

bool fuzz_starts_with(const uint8_t *data, size_t size, const char *start, size_t length)
{
    return size >= length && memcmp(data, start, length) == 0;
}

/* ---- pictures ---- */

static void check_image(const helio_image *image)
{
    FUZZ_EXPECT(image->width >= 1 && image->height >= 1);
    uint64_t pixels = (uint64_t)image->width * image->height;
    FUZZ_EXPECT(pixels <= FUZZ_MAX_PIXELS);
    FUZZ_EXPECT(strcmp(helio_layout_name(image->layout), "unknown") != 0);
    FUZZ_EXPECT(image->bad.nan + image->bad.infinite + image->bad.negative <= pixels);
    volatile float seen; /* every pixel is there: the address sanitizer would tell */
    for (size_t i = 0; i < 3 * pixels; i++)
        seen = image->rgb[i];
    for (size_t i = 0; image->alpha != NULL && i < pixels; i++)
        seen = image->alpha[i];
    (void)seen;
}

void fuzz_read_image(const uint8_t *data, size_t size)
{
    const helio_image_read_desc desc = {.max_pixels = FUZZ_MAX_PIXELS};
    helio_context *context = fuzz_context();
    helio_image *image = (helio_image *)&desc;
    helio_status status = helio_image_read(context, fuzz_file(data, size), &desc, &image);
    if (status == HELIO_OK) {
        check_image(image);
    } else {
        FUZZ_EXPECT(image == NULL);
        FUZZ_EXPECT(status == HELIO_ERR_DATA || status == HELIO_ERR_UNSUPPORTED);
        fuzz_expect_sentence(true);
    }
    helio_image_destroy(context, image);
    FUZZ_EXPECT(fuzz_live_blocks() == 0);
}

void fuzz_decode_texture(const uint8_t *data, size_t size)
{
    helio_context *context = fuzz_context();
    unsigned char *bytes = fuzz_copy(data, size);
    helio_texture texture = {0};
    helio_status status =
        texture_decode(context, "texture", bytes, size, UINT64_C(4) * FUZZ_MAX_PIXELS, NULL, &texture);
    if (status == HELIO_OK) {
        texture_curve curve = texture_curve_srgb();
        float rgb[3];
        FUZZ_EXPECT(texture_check(&texture) == HELIO_OK);
        texture_lookup(&texture, &curve, 0.3f, -7.9f, rgb);
        for (int c = 0; c < 3; c++)
            FUZZ_EXPECT(rgb[c] >= 0.0f && rgb[c] <= 1.0f + 1e-6f);
        texture_release(context, &texture);
    } else {
        FUZZ_EXPECT(status == HELIO_ERR_DATA || status == HELIO_ERR_UNSUPPORTED);
        fuzz_expect_sentence(true);
    }
    free(bytes);
    FUZZ_EXPECT(fuzz_live_blocks() == 0);
}
