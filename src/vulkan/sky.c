/* SPDX-License-Identifier: MIT */
#include "vulkan/sky.h"

#include "core/context.h"
#include "core/error.h"
#include "env/sun_disc.h"

#include <stddef.h>
#include <string.h>

enum {
    THREADS = 128,
    LEAST_SIZE = 64, /* smaller cubes, 300 KB at the most, are sent: their texels are averages over many places */
};
_Static_assert(sizeof(sky_light) == offsetof(struct layout_sky, ground) &&
                   offsetof(sky_light, even) == offsetof(struct layout_sky, even) &&
                   offsetof(sky_light, mie) == offsetof(struct layout_sky, mie),
               "the light goes as it is");
_Static_assert(sizeof(sky_sun_texel) == sizeof(struct layout_sun_texel) &&
                   offsetof(sky_sun_texel, rgb) == offsetof(struct layout_sun_texel, rgb),
               "texels go as they are");

/* ---- life --------------------------------------------------------------------------------- */

void vulkan_sky_begin(helio_device *device, uint32_t cube_size, vulkan_commands *const *uploads, vulkan_sky *sky)
{
    *sky = (vulkan_sky){.device = device, .cube_size = cube_size};
    for (int i = 0; i < SKY_COPIES; i++)
        sky->slots[i].upload = uploads[i];
}

static void release_parts(vulkan_sky *sky)
{
    for (int i = 0; i < SKY_COPIES; i++) {
        buffer_destroy(sky->device, &sky->copies[i].staging);
        buffer_destroy(sky->device, &sky->slots[i].sky);
    }
    pipeline_destroy(sky->device, &sky->fill);
    pipeline_destroy(sky->device, &sky->add_sun);
}

void vulkan_sky_end(vulkan_sky *sky)
{
    if (sky->device == NULL)
        return;
    release_parts(sky);
    *sky = (vulkan_sky){0};
}

/* The staging is where the CPU may read the sky, too. */
static helio_status create_parts(vulkan_sky *sky)
{
    const pipeline_desc fill = {"sky", 1, {THREADS}}, add_sun = {"sun", 1, {THREADS}};
    const uint64_t bytes =
        sizeof(struct layout_sky) + sun_disc_share_limit(sky->cube_size) * sizeof(struct layout_sun_texel);
    for (int i = 0; i < SKY_COPIES; i++) {
        HELIO_TRY(buffer_create(sky->device, BUFFER_READBACK, bytes, 1, "the sky on its way", &sky->copies[i].staging));
        HELIO_TRY(buffer_create(sky->device, BUFFER_SHARED, bytes, 1, "the sky", &sky->slots[i].sky));
    }
    HELIO_TRY(pipeline_create(sky->device, &fill, &sky->fill));
    return pipeline_create(sky->device, &add_sun, &sky->add_sun);
}

static bool has_parts(vulkan_sky *sky, helio_context *context)
{
    if (sky->is_made || sky->is_refused)
        return sky->is_made;
    sky->is_made = create_parts(sky) == HELIO_OK;
    sky->is_refused = !sky->is_made;
    if (sky->is_refused) {
        release_parts(sky);
        context_log(context, HELIO_LOG_INFO, "the CPU makes the cubes of skies: %s", helio_last_error());
    }
    return sky->is_made;
}

/* ---- skies that come ---------------------------------------------------------------------- */

/* Uploads that read the copy may be on their way: they are short, and of the frame before the last. */
static helio_status wait_for_readers(const vulkan_sky *sky, const sky_copy *copy)
{
    for (int i = 0; i < SKY_COPIES; i++)
        if (sky->slots[i].sent == copy)
            HELIO_TRY(commands_wait(sky->slots[i].upload));
    return HELIO_OK;
}

static void copy_sky(const vulkan_sky *sky, const sky_parts *parts, sky_copy *copy)
{
    struct layout_sky head = {.samples = sky_cube_samples(sky->cube_size), .sun_count = (uint32_t)parts->sun_count};
    const size_t sun_bytes = parts->sun_count * sizeof *parts->sun;
    unsigned char *to = copy->staging.mapped;
    memcpy(&head, &parts->light, sizeof parts->light);
    memcpy(head.ground, parts->ground, sizeof head.ground);
    memcpy(to, &head, sizeof head);
    memcpy(to + sizeof head, parts->sun, sun_bytes);
    copy->bytes = sizeof head + sun_bytes;
    copy->parts = *parts;
    copy->parts.sun = (const sky_sun_texel *)(const void *)(to + sizeof head);
}

const sky_parts *vulkan_sky_take(vulkan_sky *sky, helio_context *context, const sky_parts *parts, uint64_t frame)
{
    const uint32_t index = (sky->latest + 1) % SKY_COPIES;
    sky_copy *copy = &sky->copies[index];
    if (sky->cube_size < LEAST_SIZE || !has_parts(sky, context) || wait_for_readers(sky, copy) != HELIO_OK)
        return NULL;
    copy_sky(sky, parts, copy);
    copy->frame = frame;
    sky->latest = index;
    return &copy->parts;
}

bool vulkan_sky_is_here(const vulkan_sky *sky, uint64_t frame)
{
    return sky->is_made && sky->copies[sky->latest].frame == frame;
}

/* ---- a frame ------------------------------------------------------------------------------ */

void vulkan_sky_record_send(vulkan_sky *sky, uint32_t slot)
{
    sky_slot *own = &sky->slots[slot];
    own->sent = &sky->copies[sky->latest];
    commands_copy(own->upload, &own->sent->staging, &own->sky, own->sent->bytes);
}

void vulkan_sky_record_cube(const vulkan_sky *sky, vulkan_commands *commands, uint32_t slot, struct layout_push push)
{
    const sky_slot *own = &sky->slots[slot];
    const uint64_t texels = (uint64_t)CUBE_FACES * sky->cube_size * sky->cube_size;
    const uint64_t suns = own->sent->parts.sun_count;
    push.step[0] = (uint32_t)own->sky.address;
    push.step[1] = (uint32_t)(own->sky.address >> 32);
    commands_label(commands, "sky into cube");
    commands_dispatch(commands, sky->fill, &push, (texels + THREADS - 1) / THREADS);
    commands_barrier(commands);
    if (suns > 0) {
        commands_dispatch(commands, sky->add_sun, &push, (suns + THREADS - 1) / THREADS);
        commands_barrier(commands);
    }
    commands_label_end(commands);
}
