/* SPDX-License-Identifier: MIT */
#include <heliostat/device.h>

const char *helio_device_kind_name(helio_device_kind kind)
{
    switch (kind) {
    case HELIO_DEVICE_DISCRETE: return "discrete";
    case HELIO_DEVICE_INTEGRATED: return "integrated";
    case HELIO_DEVICE_VIRTUAL: return "virtual";
    case HELIO_DEVICE_SOFTWARE: return "software";
    case HELIO_DEVICE_OTHER: return "other";
    }
    return "other";
}
