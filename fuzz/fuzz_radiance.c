/* SPDX-License-Identifier: MIT
 *
 * Files that start as Radiance HDR does. */
#include "fuzz.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (fuzz_starts_with(data, size, "#?", 2))
        fuzz_read_image(data, size);
    return 0;
}
