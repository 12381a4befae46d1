/* SPDX-License-Identifier: MIT
 *
 * One pixel of a frame, for those who want to know where its light comes from. */
#include "core/error.h"
#include "cpu/renderer.h"
#include "env/environment.h"

_Static_assert((int)HELIO_HIT_NOTHING == (int)HIT_NOTHING && (int)HELIO_HIT_OBJECT == (int)HIT_OBJECT &&
                   (int)HELIO_HIT_PLANE == (int)HIT_PLANE && (int)HELIO_HIT_CATCHER == (int)HIT_CATCHER,
               "what is told is what is stored");

uint32_t helio_renderer_steps(const helio_renderer *renderer)
{
    return frame_step_count(renderer);
}

const helio_pools *helio_renderer_pools(const helio_renderer *renderer)
{
    return renderer->pools;
}

static helio_status check_arguments(const helio_renderer *renderer, const helio_frame_desc *desc, uint32_t x,
                                    uint32_t y, uint32_t step, const helio_pixel_step *pixel)
{
    if (renderer == NULL || desc == NULL || pixel == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_renderer_pixel needs a renderer, a desc and a place for the pixel");
    const struct film *film = &renderer->film;
    if (x >= film->width || y >= film->height)
        return fail(HELIO_ERR_ARGUMENT, "pixel %u,%u is outside of the picture of %ux%u pixels", x, y, film->width,
                    film->height);
    if (step >= frame_step_count(renderer))
        return fail(HELIO_ERR_ARGUMENT, "there is no step %u; frames take %u, counted from 0", step,
                    frame_step_count(renderer));
    return HELIO_OK;
}

/* Everything as it is when the renderer comes to that step. */
static helio_status arrive_at_step(helio_renderer *renderer, const helio_frame_desc *desc, uint32_t step,
                                   struct frame *frame)
{
    camera_frame camera;
    HELIO_TRY(camera_frame_create(&desc->camera, (float)renderer->desc.width / (float)renderer->desc.height, &camera));
    if (renderer->tables->frame == 0 || renderer->tables->frame != renderer->desc.environment->frame)
        HELIO_TRY(helio_tables_update(renderer->tables));
    HELIO_TRY(helio_pools_draw(renderer->pools, desc->seed, frame_plan_step(renderer, step).pass));
    *frame = frame_begin(renderer, &camera, desc->seed);
    return frame_begin_step(renderer, frame, step, hits_belong_to(&renderer->hits, &camera));
}

helio_status helio_renderer_pixel(helio_renderer *renderer, const helio_frame_desc *desc, uint32_t x, uint32_t y,
                                  uint32_t step, helio_pixel_step *pixel)
{
    struct frame frame;
    float position_x[TILE], position_y[TILE], direction_x[TILE], direction_y[TILE], direction_z[TILE];
    HELIO_TRY(check_arguments(renderer, desc, x, y, step, pixel));
    HELIO_TRY(arrive_at_step(renderer, desc, step, &frame));
    /* The row of the tile that the pixel is in: rays that are traced side by side with others get the same bits. */
    struct tile row = frame_tile(&frame, y / TILE * frame.tiles_across + x / TILE);
    uint32_t count = row.x1 - row.x0, i = x - row.x0;
    size_t index = (size_t)y * renderer->film.width + x;
    row.y0 = y;
    row.y1 = y + 1;
    if (!hits_belong_to(&renderer->hits, &frame.camera)) {
        renderer->hits.complete = false;
        primary_tile(&frame, row);
    }
    primary_positions(&frame, y, row.x0, count, position_x, position_y);
    primary_directions(&frame, count, position_x, position_y, direction_x, direction_y, direction_z);
    *pixel = (helio_pixel_step){.hit = (helio_hit)renderer->hits.kinds[index], .estimate = frame.estimate};
    pixel->estimate.is_free = pixel->estimate.visibility == NULL; /* as in the picture */
    if (pixel->hit != HELIO_HIT_NOTHING)
        shade_point(&frame, index, (vec3){direction_x[i], direction_y[i], direction_z[i]}, &pixel->point);
    return HELIO_OK;
}
