/* SPDX-License-Identifier: MIT
 *
 * What a process that imports a mesh hands back: any bytes in the shared memory, in the layout of mesh_receipt.c. */
#include "fuzz.h"

#include "scene/mesh_receipt.h"

#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64 };

/* The arrays lie where mesh_receipt_open() says: reading them to their ends is what the address sanitizer watches. */
static void create_mesh(const mesh_receipt *receipt)
{
    helio_mesh *mesh = (helio_mesh *)receipt;
    helio_status status = helio_mesh_create(fuzz_context(), &receipt->desc, &mesh);
    FUZZ_EXPECT((status == HELIO_OK) == (mesh != NULL));
    if (status != HELIO_OK) {
        FUZZ_EXPECT(status == HELIO_ERR_DATA || status == HELIO_ERR_ARGUMENT);
        fuzz_expect_sentence(true);
    }
    helio_mesh_destroy(fuzz_context(), mesh);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char *memory = NULL;
    FUZZ_EXPECT(posix_memalign((void **)&memory, ALIGNMENT, size > 0 ? size : 1) == 0);
    if (size > 0)
        memcpy(memory, data, size);
    mesh_receipt receipt;
    helio_status status = mesh_receipt_open(fuzz_context(), memory, size, &receipt);
    if (status == HELIO_OK) {
        create_mesh(&receipt);
        mesh_receipt_close(fuzz_context(), &receipt);
    } else {
        FUZZ_EXPECT(status == HELIO_ERR_DATA);
        fuzz_expect_sentence(true);
    }
    FUZZ_EXPECT(fuzz_live_blocks() == 0);
    free(memory);
    return 0;
}
