/* SPDX-License-Identifier: MIT
 *
 * How fast a device copies its own memory: what other work is compared with. */
#include "core/clock.h"
#include "core/error.h"
#include "vulkan/commands.h"

enum { REPEATS = 5 };

static helio_status copy_once(vulkan_commands *commands, const vulkan_buffer *from, const vulkan_buffer *to,
                              double *milliseconds)
{
    HELIO_TRY(commands_begin(commands));
    const uint32_t start = commands_mark(commands);
    commands_copy(commands, from, to, from->bytes);
    const uint32_t end = commands_mark(commands);
    const double started = clock_seconds();
    HELIO_TRY(commands_submit(commands));
    HELIO_TRY(commands_wait(commands));
    const double by_host = 1e3 * (clock_seconds() - started), by_device = commands_milliseconds(commands, start, end);
    *milliseconds = by_device > 0.0 ? by_device : by_host;
    return HELIO_OK;
}

static helio_status measure(vulkan_commands *commands, const vulkan_buffer *from, const vulkan_buffer *to,
                            double *milliseconds)
{
    double least = 0.0;
    for (int i = 0; i < REPEATS; i++) {
        double once;
        HELIO_TRY(copy_once(commands, from, to, &once));
        least = i == 0 || once < least ? once : least;
    }
    *milliseconds = least;
    return HELIO_OK;
}

helio_status helio_device_measure_copy(helio_device *device, uint64_t bytes, double *milliseconds)
{
    vulkan_buffer from = {0}, to = {0};
    vulkan_commands commands;
    if (device == NULL || milliseconds == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_device_measure_copy needs a device and a place for the time");
    HELIO_TRY(commands_create(device, false, &commands));
    helio_status status = buffer_create(device, BUFFER_ON_DEVICE, bytes, 1, "what is copied", &from);
    if (status == HELIO_OK)
        status = buffer_create(device, BUFFER_ON_DEVICE, bytes, 1, "the copy", &to);
    if (status == HELIO_OK)
        status = measure(&commands, &from, &to, milliseconds);
    commands_destroy(&commands);
    buffer_destroy(device, &from);
    buffer_destroy(device, &to);
    return status;
}
