/* SPDX-License-Identifier: MIT
 *
 * Checkpoints of references. Each is read as it is and with its checksums set right: damage would otherwise never get
 * past them. */
#include "fuzz.h"

#include "core/digest.h"
#include "eval/checkpoint.h"

#include <math.h>
#include <stdlib.h>

enum { RECORDS_CHECKSUM = 88, HEAD_CHECKSUM = 96 };

static void store(uint8_t *bytes, uint64_t value)
{
    for (int i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(value >> (8 * i));
}

static void repair_checksums(uint8_t *bytes, size_t size)
{
    uint64_t digest = 0;
    if (size < CHECKPOINT_HEAD)
        return;
    for (size_t at = CHECKPOINT_HEAD; at + 8 <= size; at += 8)
        digest = digest_word(digest, digest_load(bytes + at, 8));
    store(bytes + RECORDS_CHECKSUM, digest);
    store(bytes + HEAD_CHECKSUM, digest_bytes(0, bytes, HEAD_CHECKSUM));
}

typedef struct watch {
    checkpoint_head head;
    size_t pixels; /* that came */
} watch;

static helio_status check_head(void *user, const checkpoint_head *head)
{
    watch *w = user;
    FUZZ_EXPECT(head->width >= 1 && head->width <= CHECKPOINT_EDGE && head->height >= 1 &&
                head->height <= CHECKPOINT_EDGE && head->numbers >= 1 && head->numbers <= CHECKPOINT_NUMBERS);
    FUZZ_EXPECT(head->isa[0] != 0 && memchr(head->isa, 0, CHECKPOINT_ISA_SIZE) != NULL);
    w->head = *head;
    return HELIO_OK;
}

static void put_record(void *user, size_t pixel, const double *record)
{
    watch *w = user;
    FUZZ_EXPECT(pixel == w->pixels);
    for (uint32_t i = 0; i < w->head.numbers; i++)
        FUZZ_EXPECT(isfinite(record[i]));
    w->pixels++;
}

static void read_checkpoint(const uint8_t *data, size_t size)
{
    watch w = {.pixels = 0};
    const checkpoint_reader reader = {.check = check_head, .put = put_record, .user = &w};
    helio_status status = checkpoint_read(fuzz_file(data, size), &reader);
    if (status == HELIO_OK) {
        FUZZ_EXPECT(w.pixels == (size_t)w.head.width * w.head.height);
        FUZZ_EXPECT(size == CHECKPOINT_HEAD + w.pixels * w.head.numbers * 8);
    } else {
        FUZZ_EXPECT(status == HELIO_ERR_DATA);
        fuzz_expect_sentence(true);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    read_checkpoint(data, size);
    uint8_t *repaired = fuzz_copy(data, size);
    repair_checksums(repaired, size);
    if (size >= CHECKPOINT_HEAD && memcmp(repaired, data, size) != 0)
        read_checkpoint(repaired, size);
    free(repaired);
    return 0;
}
