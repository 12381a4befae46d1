/* SPDX-License-Identifier: MIT */
#include "samples_pixel.h"

#include "message.h"

#include <inttypes.h>

/* Does the object cover the pixel, and all others up to so many away? */
static bool is_inside(const helio_picture *picture, uint32_t x, uint32_t y, uint32_t margin)
{
    if (x < margin || y < margin || picture->width - x <= margin || picture->height - y <= margin)
        return false;
    for (uint32_t row = y - margin; row <= y + margin; row++)
        for (uint32_t column = x - margin; column <= x + margin; column++)
            if (picture->object[(size_t)row * picture->width + column] < 1.0f)
                return false;
    return true;
}

/* The nearest one inside of the object. */
static bool find_nearest(const helio_picture *picture, uint32_t margin, uint32_t *x, uint32_t *y)
{
    double nearest = -1;
    const double column = *x, row = *y;
    for (uint32_t j = 0; j < picture->height; j++)
        for (uint32_t i = 0; i < picture->width; i++) {
            double distance = (i - column) * (i - column) + (j - row) * (j - row);
            if ((nearest >= 0 && distance >= nearest) || !is_inside(picture, i, j, margin))
                continue;
            nearest = distance;
            *x = i;
            *y = j;
        }
    return nearest >= 0;
}

/* Better not right at an edge. */
static bool find_object(const render_job *job, uint32_t *x, uint32_t *y)
{
    enum { MARGIN = 3 };
    const helio_picture picture = helio_renderer_picture(job->renderer);
    return find_nearest(&picture, MARGIN, x, y) || find_nearest(&picture, 0, x, y);
}

int samples_pixel_choose(render_job *job, bool is_asked_for, uint64_t index, uint32_t *x, uint32_t *y)
{
    static const char *const words[] = {"the background", "the object", "the ground",
                                        "the ground that catches shadows"};
    const helio_frame_desc frame = render_job_frame(job, index);
    helio_pixel_step pixel;
    if (helio_renderer_pixel(job->renderer, &frame, *x, *y, 0, &pixel) != HELIO_OK)
        return message_failure("%s", helio_last_error());
    if (pixel.hit == HELIO_HIT_OBJECT)
        return EXIT_CODE_OK;
    uint32_t column = *x, row = *y;
    if (!find_object(job, &column, &row))
        return message_failure("no pixel of the picture shows the object; give another --camera");
    if (is_asked_for)
        return message_failure("pixel %" PRIu32 ",%" PRIu32 " shows %s, not the object; try --pixel %" PRIu32
                               ",%" PRIu32,
                               *x, *y, words[pixel.hit], column, row);
    *x = column;
    *y = row;
    return EXIT_CODE_OK;
}
