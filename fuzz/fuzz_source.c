/* SPDX-License-Identifier: MIT
 *
 * What may follow --env. Nothing is read. */
#include "fuzz.h"
#include "messages.h"

#include "environment_source.h"
#include "message.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = fuzz_text(data, size);
    environment_source *source = malloc(sizeof *source);
    FUZZ_EXPECT(source != NULL);
    messages_take();
    int code = environment_source_parse(text, source);
    size_t sentences = messages_take();
    FUZZ_EXPECT(code == EXIT_CODE_OK ? sentences == 0 : sentences == 1);
    if (code == EXIT_CODE_OK) {
        FUZZ_EXPECT(source->path[0] == 0 || strcmp(source->path, text) == 0);
        for (int c = 0; c < 3; c++)
            FUZZ_EXPECT(source->constant[c] >= 0.0f && source->constant[c] <= 1e12f);
    }
    free(source);
    free(text);
    return 0;
}
