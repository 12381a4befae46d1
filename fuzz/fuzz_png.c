/* SPDX-License-Identifier: MIT
 *
 * Files that start as PNG does, as maps and as textures of a mesh. Each is read as it is and with the checksums of its
 * chunks set right: damage behind a checksum would otherwise never reach the decoder. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include <zlib.h>

enum { SIGNATURE_LENGTH = 8, CHUNK_FRAME = 12 }; /* length, name and checksum, four bytes each */

static uint32_t read_big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static void repair_checksums(uint8_t *bytes, size_t size)
{
    size_t at = SIGNATURE_LENGTH;
    while (at + CHUNK_FRAME <= size) {
        size_t length = read_big_endian(bytes + at);
        if (length > size - at - CHUNK_FRAME)
            return;
        uint8_t *checksum = bytes + at + 8 + length;
        uint32_t right = (uint32_t)crc32(0, bytes + at + 4, (uInt)(length + 4));
        for (int i = 0; i < 4; i++)
            checksum[i] = (uint8_t)(right >> (24 - 8 * i));
        at += CHUNK_FRAME + length;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!fuzz_starts_with(data, size, "\x89PNG\r\n\x1a\n", SIGNATURE_LENGTH))
        return 0;
    fuzz_read_image(data, size);
    uint8_t *repaired = fuzz_copy(data, size);
    repair_checksums(repaired, size);
    if (memcmp(repaired, data, size) != 0)
        fuzz_read_image(repaired, size);
    fuzz_decode_texture(repaired, size);
    free(repaired);
    return 0;
}
