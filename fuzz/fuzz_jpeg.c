/* SPDX-License-Identifier: MIT
 *
 * Files that start as JPEG does, as maps and as textures of a mesh. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!fuzz_starts_with(data, size, "\xff\xd8\xff", 3))
        return 0;
    fuzz_read_image(data, size);
    fuzz_decode_texture(data, size);
    return 0;
}
