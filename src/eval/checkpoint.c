/* SPDX-License-Identifier: MIT */
#include "eval/checkpoint.h"

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>

static const char MAGIC[8] = {'H', 'E', 'L', 'I', 'O', 'R', 'E', 'F'};

enum { RECORDS_AT_ONCE = 256, CHECKSUM_PLACE = CHECKPOINT_HEAD - 8 };

/* ---- numbers as bytes ---- */

static void store(unsigned char *bytes, uint64_t value, int size)
{
    for (int i = 0; i < size; i++)
        bytes[i] = (unsigned char)(value >> (8 * i));
}

/* The head but for its own checksum. records: the checksum of these. */
static void store_head(unsigned char bytes[CHECKPOINT_HEAD], const checkpoint_head *head, uint64_t records)
{
    const uint32_t words[] = {CHECKPOINT_FORMAT, head->version, head->width, head->height, head->numbers, 0};
    const uint64_t longs[] = {head->subject.map,      head->subject.scene, head->subject.view,
                              head->subject.settings, head->pieces,        records};
    memcpy(bytes, MAGIC, 8);
    for (int i = 0; i < 6; i++)
        store(bytes + 8 + 4 * i, words[i], 4);
    memcpy(bytes + 32, head->isa, CHECKPOINT_ISA_SIZE);
    for (int i = 0; i < 6; i++)
        store(bytes + 48 + 8 * i, longs[i], 8);
    store(bytes + CHECKSUM_PLACE, digest_bytes(0, bytes, CHECKSUM_PLACE), 8);
}

static uint64_t load_head(const unsigned char bytes[CHECKPOINT_HEAD], checkpoint_head *head)
{
    *head = (checkpoint_head){
        .version = (uint32_t)digest_load(bytes + 12, 4),
        .width = (uint32_t)digest_load(bytes + 16, 4),
        .height = (uint32_t)digest_load(bytes + 20, 4),
        .numbers = (uint32_t)digest_load(bytes + 24, 4),
        .subject = {digest_load(bytes + 48, 8), digest_load(bytes + 56, 8), digest_load(bytes + 64, 8),
                    digest_load(bytes + 72, 8)},
        .pieces = digest_load(bytes + 80, 8),
    };
    memcpy(head->isa, bytes + 32, CHECKPOINT_ISA_SIZE - 1);
    return digest_load(bytes + 88, 8);
}

/* ---- writing ---- */

/* Writes some records and returns the checksum so far, to which each number is a word. */
static uint64_t write_records(FILE *stream, const checkpoint_head *head, checkpoint_get get, const void *user,
                              size_t first, size_t count, uint64_t digest)
{
    unsigned char bytes[RECORDS_AT_ONCE * CHECKPOINT_NUMBERS * 8] = {0};
    double record[CHECKPOINT_NUMBERS] = {0};
    size_t size = 0;
    for (size_t i = 0; i < count; i++) {
        get(user, first + i, record);
        for (uint32_t k = 0; k < head->numbers; k++, size += 8) {
            uint64_t bits;
            memcpy(&bits, &record[k], sizeof bits);
            store(bytes + size, bits, 8);
            digest = digest_word(digest, bits);
        }
    }
    fwrite(bytes, 1, size, stream); /* file_writer_commit() looks for errors */
    return digest;
}

static size_t pixels_of(const checkpoint_head *head)
{
    return (size_t)head->width * head->height;
}

static size_t records_from(const checkpoint_head *head, size_t first)
{
    size_t left = pixels_of(head) - first;
    return left < RECORDS_AT_ONCE ? left : RECORDS_AT_ONCE;
}

helio_status checkpoint_write(const char *path, const checkpoint_head *head, checkpoint_get get, const void *user)
{
    unsigned char bytes[CHECKPOINT_HEAD] = {0};
    file_writer writer;
    uint64_t digest = 0;
    HELIO_TRY(file_writer_open(&writer, path));
    fwrite(bytes, 1, sizeof bytes, writer.stream); /* its place, until the checksum of the records is known */
    for (size_t first = 0; first < pixels_of(head) && !ferror(writer.stream); first += RECORDS_AT_ONCE)
        digest = write_records(writer.stream, head, get, user, first, records_from(head, first), digest);
    store_head(bytes, head, digest);
    if (!ferror(writer.stream) && fseeko(writer.stream, 0, SEEK_SET) == 0)
        fwrite(bytes, 1, sizeof bytes, writer.stream);
    return file_writer_commit(&writer);
}

/* ---- reading ---- */

static helio_status fail_as_damaged(const char *path)
{
    return fail(HELIO_ERR_DATA, "the checkpoint %s is damaged; remove it and begin anew", path);
}

/* Names go into sentences. */
static bool is_name(const char text[CHECKPOINT_ISA_SIZE])
{
    size_t length = strspn(text, "abcdefghijklmnopqrstuvwxyz0123456789");
    return length > 0 && text[length] == 0;
}

/* size: of the file. */
static helio_status check_head(const char *path, const unsigned char bytes[CHECKPOINT_HEAD], uint64_t size,
                               checkpoint_head *head, uint64_t *records)
{
    if (memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
        return fail(HELIO_ERR_DATA, "%s is no checkpoint of a reference; remove it", path);
    uint32_t format = (uint32_t)digest_load(bytes + 8, 4);
    if (format != CHECKPOINT_FORMAT)
        return fail(HELIO_ERR_DATA,
                    "the checkpoint %s has format %" PRIu32
                    ", and this version knows %d only; remove it and begin anew",
                    path, format, CHECKPOINT_FORMAT);
    if (digest_load(bytes + CHECKSUM_PLACE, 8) != digest_bytes(0, bytes, CHECKSUM_PLACE))
        return fail_as_damaged(path);
    *records = load_head(bytes, head);
    bool fits = head->width >= 1 && head->width <= CHECKPOINT_EDGE && head->height >= 1 &&
                head->height <= CHECKPOINT_EDGE && head->numbers >= 1 && head->numbers <= CHECKPOINT_NUMBERS;
    if (!fits || !is_name(head->isa) || size != CHECKPOINT_HEAD + (uint64_t)pixels_of(head) * head->numbers * 8)
        return fail_as_damaged(path);
    return HELIO_OK;
}

/* Reads some records; false if they are not there or not finite. */
static bool read_records(FILE *stream, const checkpoint_head *head, const checkpoint_reader *reader, size_t first,
                         size_t count, uint64_t *digest)
{
    unsigned char bytes[RECORDS_AT_ONCE * CHECKPOINT_NUMBERS * 8];
    double record[CHECKPOINT_NUMBERS];
    size_t size = count * head->numbers * 8, at = 0;
    if (fread(bytes, 1, size, stream) != size)
        return false;
    for (size_t i = 0; i < count; i++) {
        for (uint32_t k = 0; k < head->numbers; k++, at += 8) {
            uint64_t bits = digest_load(bytes + at, 8);
            memcpy(&record[k], &bits, sizeof bits);
            *digest = digest_word(*digest, bits);
            if (!isfinite(record[k]))
                return false;
        }
        reader->put(reader->user, first + i, record);
    }
    return true;
}

static helio_status read_stream(FILE *stream, const char *path, uint64_t size, const checkpoint_reader *reader)
{
    unsigned char bytes[CHECKPOINT_HEAD] = {0};
    checkpoint_head head;
    uint64_t expected = 0, digest = 0;
    if (fread(bytes, 1, sizeof bytes, stream) != sizeof bytes && ferror(stream))
        return fail(HELIO_ERR_IO, "%s cannot be read: %s", path, strerror(errno));
    HELIO_TRY(check_head(path, bytes, size, &head, &expected));
    HELIO_TRY(reader->check(reader->user, &head));
    for (size_t first = 0; first < pixels_of(&head); first += RECORDS_AT_ONCE)
        if (!read_records(stream, &head, reader, first, records_from(&head, first), &digest))
            return fail_as_damaged(path);
    return digest == expected ? HELIO_OK : fail_as_damaged(path);
}

helio_status checkpoint_read(const char *path, const checkpoint_reader *reader)
{
    FILE *stream;
    uint64_t size;
    HELIO_TRY(file_open(path, &stream, &size));
    helio_status status = read_stream(stream, path, size, reader);
    fclose(stream);
    return status;
}
