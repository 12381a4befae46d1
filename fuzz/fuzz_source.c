/* SPDX-License-Identifier: MIT
 *
 * What may follow --env. Nothing is read. */
#include "fuzz.h"

#include <heliostat/source.h>

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size);
    helio_source_kind kind = HELIO_SOURCE_FILE;
    helio_status status = helio_source_check(text, &kind);
    FUZZ_EXPECT(status == HELIO_OK || (status == HELIO_ERR_ARGUMENT && helio_last_error()[0] != 0));
    FUZZ_EXPECT(kind >= HELIO_SOURCE_FILE && kind <= HELIO_SOURCE_SKY_DAY);
    free(text);
    return 0;
}
