/* SPDX-License-Identifier: MIT
 *
 * Is all there that a PLY file announces? Any bytes, in memory and as a file: both must get the same answer. */
#include "fuzz.h"

#include "scene/ply_check.h"

#include <stdlib.h>

static helio_status check_memory(const uint8_t *data, size_t size)
{
    ply_stream stream;
    unsigned char *bytes = fuzz_copy(data, size);
    ply_stream_open_memory(&stream, bytes, size);
    helio_status status = ply_check(&stream, "mesh.ply");
    free(bytes);
    return status;
}

static helio_status check_file(const uint8_t *data, size_t size)
{
    ply_stream stream;
    FILE *file = fopen(fuzz_file(data, size), "rb");
    FUZZ_EXPECT(file != NULL);
    ply_stream_open_file(&stream, file, size);
    helio_status status = ply_check(&stream, "mesh.ply");
    fclose(file);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    helio_status status = check_memory(data, size);
    if (status != HELIO_OK) {
        FUZZ_EXPECT(status == HELIO_ERR_DATA);
        fuzz_expect_sentence(true);
    }
    FUZZ_EXPECT(check_file(data, size) == status);
    FUZZ_EXPECT(fuzz_live_blocks() == 0);
    return 0;
}
