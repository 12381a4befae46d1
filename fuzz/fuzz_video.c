/* SPDX-License-Identifier: MIT
 *
 * Any bytes as a video file, read to its end or for some frames, over damage too. */
#include "fuzz.h"

#include <heliostat/video.h>

enum { MOST_CALLS = 16 };

static void read_frames(helio_video_reader *reader)
{
    for (int call = 0; call < MOST_CALLS; call++) {
        helio_video_frame frame = {0};
        if (helio_video_next(reader, &frame) != HELIO_OK) {
            fuzz_expect_sentence(true);
            FUZZ_EXPECT(frame.rgb == NULL);
            continue;
        }
        if (frame.rgb == NULL)
            return;
        FUZZ_EXPECT((uint64_t)frame.width * frame.height <= FUZZ_MAX_PIXELS);
        double sum = 0;
        for (size_t i = 0; i < (size_t)3 * frame.width * frame.height; i++)
            sum += (double)frame.rgb[i];
        FUZZ_EXPECT(sum == sum || frame.bad.nan + frame.bad.infinite > 0);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const helio_video_read_desc desc = {.max_pixels = FUZZ_MAX_PIXELS};
    helio_video_reader *reader;
    size_t before = fuzz_live_blocks();
    if (helio_video_open(fuzz_context(), fuzz_file(data, size), &desc, &reader) == HELIO_OK) {
        read_frames(reader);
        helio_video_close(reader);
    } else {
        fuzz_expect_sentence(true);
        FUZZ_EXPECT(reader == NULL);
    }
    FUZZ_EXPECT(fuzz_live_blocks() == before);
    return 0;
}
