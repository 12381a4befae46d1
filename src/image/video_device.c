/* SPDX-License-Identifier: MIT */
#include "image/video_device.h"

#include "core/error.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

#include <libavdevice/avdevice.h>

#define TEXT_OF(x) #x
#define LIBRARY_OF_MAJOR(major) "libavdevice.so." TEXT_OF(major)

static const char LIBRARY[] = LIBRARY_OF_MAJOR(LIBAVDEVICE_VERSION_MAJOR);

static pthread_once_t once = PTHREAD_ONCE_INIT;
static bool is_loaded;

/* Never unloaded: FFmpeg keeps lists of its devices. */
static void load(void)
{
    void *library = dlopen(LIBRARY, RTLD_NOW), *symbol = library ? dlsym(library, "avdevice_register_all") : NULL;
    void (*register_all)(void);
    if (symbol == NULL)
        return;
    memcpy(&register_all, &symbol, sizeof register_all); /* C knows no conversion from data to functions */
    register_all();
    is_loaded = true;
}

helio_status video_device_find(const char *name, const AVInputFormat **device)
{
    pthread_once(&once, load);
    if (!is_loaded)
        return fail(HELIO_ERR_UNSUPPORTED,
                    "%s, FFmpeg's library for devices, was not found, so %s cannot be used; "
                    "install it, or give a file",
                    LIBRARY, name);
    const AVInputFormat *found = av_find_input_format(name);
    bool is_device = found && found->priv_class && AV_IS_INPUT_DEVICE(found->priv_class->category);
    if (!is_device)
        return fail(HELIO_ERR_UNSUPPORTED, "the FFmpeg here has no device called %s; it may have v4l2 and lavfi", name);
    *device = found;
    return HELIO_OK;
}
