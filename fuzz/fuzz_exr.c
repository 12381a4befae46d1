/* SPDX-License-Identifier: MIT
 *
 * Files that start as OpenEXR does. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (fuzz_starts_with(data, size, "\x76\x2f\x31\x01", 4))
        fuzz_read_image(data, size);
    return 0;
}
