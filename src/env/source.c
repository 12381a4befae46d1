/* SPDX-License-Identifier: MIT */
#include <heliostat/source.h>

#include "core/context.h"
#include "core/error.h"
#include "core/name_list.h"
#include "env/environment.h"
#include "env/source_files.h"
#include "env/source_memory.h"
#include "env/source_queue.h"
#include "image/image.h"
#include "image/png_animation.h"
#include "image/video_reader.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DEFAULT_QUEUE = 2, MAX_QUEUE = 16, DEFAULT_DAY_FRAMES = 240, MAX_DAY_FRAMES = 1000000 };

#define DEFAULT_FPS 24.0
#define MAX_FPS 1e4

struct helio_source {
    helio_context *context;
    char *label;
    source_specification specification; /* points into label */
    helio_source_desc desc;             /* with defaults resolved */
    helio_source_info info;
    source_files files;    /* found when they are first asked for */
    source_memory *memory; /* of the frames */
    source_queue queue;
    bool is_at_end;
    helio_sky *sky; /* made when the first sky is applied, for cubes up to sky_size */
    uint32_t sky_size;
};

/* ---- names ---- */

static const char *const ON_MISSING_NAMES[] = {"stop", "skip", "hold"};
static const name_list ON_MISSING = NAME_LIST("choice for missing frames", ON_MISSING_NAMES);

const char *helio_on_missing_name(helio_on_missing value)
{
    return name_list_get(&ON_MISSING, (int)value);
}

helio_status helio_on_missing_parse(const char *name, helio_on_missing *value)
{
    int found;
    HELIO_TRY(name_list_find(&ON_MISSING, value ? name : NULL, &found));
    *value = (helio_on_missing)found;
    return HELIO_OK;
}

helio_status helio_source_check(const char *text, helio_source_kind *kind)
{
    source_specification specification;
    HELIO_TRY(source_specification_parse(text, &specification));
    if (kind != NULL)
        *kind = specification.kind;
    return HELIO_OK;
}

/* ---- opening ---- */

static helio_status resolve_desc(const helio_source_desc *given, helio_source_desc *desc)
{
    *desc = given ? *given : (helio_source_desc){0};
    HELIO_TRY(name_list_check(&ON_MISSING, (int)desc->on_missing));
    if (desc->queue > MAX_QUEUE)
        return fail(HELIO_ERR_ARGUMENT, "a source cannot read %u frames ahead; use 1 to %d", desc->queue, MAX_QUEUE);
    if (desc->frames > MAX_DAY_FRAMES)
        return fail(HELIO_ERR_ARGUMENT, "a day cannot have %u frames; use 1 to %d", desc->frames, MAX_DAY_FRAMES);
    if (!(desc->fps >= 0 && desc->fps <= MAX_FPS))
        return fail(HELIO_ERR_ARGUMENT, "%g frames a second cannot be; use a number above 0, at most %g", desc->fps,
                    MAX_FPS);
    if (desc->has_frames && desc->first > desc->last)
        return fail(HELIO_ERR_ARGUMENT, "frames %u..%u are none; give the first one first", desc->first, desc->last);
    desc->queue = desc->queue ? desc->queue : DEFAULT_QUEUE;
    desc->frames = desc->frames ? desc->frames : DEFAULT_DAY_FRAMES;
    desc->fps = desc->fps > 0 ? desc->fps : DEFAULT_FPS;
    return HELIO_OK;
}

static bool is_path(helio_source_kind kind)
{
    return kind == HELIO_SOURCE_FILE || kind == HELIO_SOURCE_SEQUENCE || kind == HELIO_SOURCE_VIDEO;
}

static size_t read_bytes(const void *descriptor, uint64_t at, unsigned char *bytes, size_t size)
{
    ssize_t count = pread(*(const int *)descriptor, bytes, size, (off_t)at);
    return count > 0 ? (size_t)count : 0;
}

typedef enum file_look {
    LOOKS_UNKNOWN,
    LOOKS_LIKE_PICTURE,   /* of a kind that can be read */
    LOOKS_LIKE_ANIMATION, /* a PNG file of several pictures, which FFmpeg can play */
} file_look;

/* By how the file begins. */
static file_look find_look(const char *path)
{
    unsigned char bytes[16];
    int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return LOOKS_UNKNOWN;
    file_look look = LOOKS_UNKNOWN;
    if (image_is_picture(bytes, read_bytes(&descriptor, 0, bytes, sizeof bytes)))
        look = LOOKS_LIKE_PICTURE;
    if (look == LOOKS_LIKE_PICTURE && png_animation_frames(read_bytes, &descriptor) > 1 && video_reader_plays_png())
        look = LOOKS_LIKE_ANIMATION;
    close(descriptor);
    return look;
}

/* What there is decides about what the name may mean. */
static helio_status look_at_file(source_specification *s)
{
    struct stat status;
    bool exists = stat(s->path, &status) == 0;
    if (!exists && s->is_wrong_pattern)
        return fail(HELIO_ERR_ARGUMENT,
                    "there is no file %s, and it is no pattern either; write one %%d, such as %%04d, for numbers, or "
                    "one %%s for six faces",
                    s->path);
    if (!exists && s->kind == HELIO_SOURCE_VIDEO)
        return fail(HELIO_ERR_IO, "%s cannot be opened: %s", s->path, strerror(errno));
    if (!exists)
        return HELIO_OK;
    source_specification_take_as_file(s);
    file_look look = S_ISREG(status.st_mode) ? find_look(s->path) : LOOKS_UNKNOWN;
    if (look != LOOKS_UNKNOWN) {
        s->is_surely_video = look == LOOKS_LIKE_ANIMATION;
        s->kind = s->is_surely_video ? HELIO_SOURCE_VIDEO : HELIO_SOURCE_FILE;
    } else if (S_ISREG(status.st_mode) && status.st_size > 0 && !source_specification_is_picture(s)) {
        s->kind = HELIO_SOURCE_VIDEO;
    }
    return HELIO_OK;
}

/* A file that seemed to be neither picture nor video: the latter was the last chance. What is wrong with it as a video
 * begins with its path, which shall not be said twice. */
static helio_status open_video(const source_opening *opening, bool is_known, source_reader **reader)
{
    helio_status status = source_video_open(opening, reader);
    if (status == HELIO_OK || status == HELIO_ERR_MEMORY || status == HELIO_ERR_ARGUMENT || is_known)
        return status;
    const char *path = opening->specification->path, *sentence = helio_last_error();
    size_t length = strlen(path);
    if (strncmp(sentence, path, length) != 0 || sentence[length] != ' ')
        return status;
    return fail(HELIO_ERR_DATA, "%s is no picture of a kind that is known here, and it%s", path, sentence + length);
}

static helio_status open_reader(helio_source *source, source_reader **reader)
{
    source_opening opening = {.context = source_memory_context(source->memory),
                              .desc = &source->desc,
                              .specification = &source->specification,
                              .stopping = &source->queue.stopping,
                              .info = &source->info};
    switch (source->specification.kind) {
    case HELIO_SOURCE_SEQUENCE: return source_sequence_open(&opening, reader);
    case HELIO_SOURCE_VIDEO: return open_video(&opening, source->specification.is_surely_video, reader);
    case HELIO_SOURCE_DEVICE: return source_video_open(&opening, reader);
    case HELIO_SOURCE_CONSTANT: return source_constant_open(&opening, reader);
    case HELIO_SOURCE_CALLBACK: return source_callback_open(&opening, reader);
    case HELIO_SOURCE_SKY:
    case HELIO_SOURCE_SKY_DAY: return source_sky_open(&opening, reader);
    case HELIO_SOURCE_FILE: break;
    }
    return source_file_open(&opening, reader);
}

/* Whether pixels come from disk or a decoder, frame after frame: that is what a thread is for. */
static bool needs_thread(helio_source_kind kind)
{
    return kind == HELIO_SOURCE_SEQUENCE || kind == HELIO_SOURCE_VIDEO || kind == HELIO_SOURCE_DEVICE;
}

/* A source without anything but its label and its desc. */
static helio_status create_source(helio_context *context, const char *label, const helio_source_desc *given,
                                  helio_source **out)
{
    helio_source_desc desc;
    HELIO_TRY(resolve_desc(given, &desc));
    helio_source *source = context_allocate(context, 1, sizeof *source);
    if (source == NULL)
        return HELIO_ERR_MEMORY;
    source->context = context;
    source->desc = desc;
    source->label = context_allocate(context, strlen(label) + 1, 1);
    if (source->label == NULL) {
        helio_source_close(source);
        return HELIO_ERR_MEMORY;
    }
    strcpy(source->label, label);
    *out = source;
    return HELIO_OK;
}

static helio_status find_specification(helio_source *source)
{
    HELIO_TRY(source_specification_parse(source->label, &source->specification));
    return is_path(source->specification.kind) ? look_at_file(&source->specification) : HELIO_OK;
}

static helio_status start_source(helio_source *source)
{
    helio_source_kind kind = source->specification.kind;
    source->info = (helio_source_info){.kind = kind, .label = source->label, .fps = source->desc.fps};
    bool threaded = needs_thread(kind);
    HELIO_TRY(source_memory_create(source->context, threaded, &source->memory));
    HELIO_TRY(source_queue_create(&source->queue, source->context, threaded ? source->desc.queue : 0));
    source_reader *reader;
    HELIO_TRY(open_reader(source, &reader));
    source->info.is_dynamic = source->info.frame_count != 1;
    source_queue_start(&source->queue, reader);
    return HELIO_OK;
}

/* status: of what was done with the new source so far. */
static helio_status finish_opening(helio_source *source, helio_status status, helio_source **out)
{
    if (status == HELIO_OK)
        status = start_source(source);
    if (status == HELIO_OK)
        *out = source;
    else
        helio_source_close(source);
    return status;
}

helio_status helio_source_open(helio_context *context, const char *text, const helio_source_desc *desc,
                               helio_source **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || text == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_source_open needs a context, a specification and a place for the result");
    helio_source *source;
    HELIO_TRY(create_source(context, text, desc, &source));
    return finish_opening(source, find_specification(source), out);
}

helio_status helio_source_open_callback(helio_context *context, const char *label, helio_source_callback callback,
                                        void *user, const helio_source_desc *desc, helio_source **out)
{
    if (out != NULL)
        *out = NULL;
    if (context == NULL || callback == NULL || out == NULL)
        return fail(HELIO_ERR_ARGUMENT,
                    "helio_source_open_callback needs a context, a callback and a place for the result");
    helio_source *source;
    HELIO_TRY(create_source(context, label != NULL ? label : "callback", desc, &source));
    source->specification = (source_specification){.kind = HELIO_SOURCE_CALLBACK,
                                                   .text = source->label,
                                                   .path = source->label,
                                                   .callback = callback,
                                                   .user = user};
    return finish_opening(source, HELIO_OK, out);
}

void helio_source_close(helio_source *source)
{
    if (source == NULL)
        return;
    source_queue_destroy(&source->queue, source->context);
    source_memory_destroy(source->memory);
    helio_sky_destroy(source->sky);
    source_files_release(source->context, &source->files);
    context_release(source->context, source->label);
    context_release(source->context, source);
}

/* ---- frames ---- */

helio_source_info helio_source_get_info(const helio_source *source)
{
    return source->info;
}

helio_status helio_source_check_output(helio_source *source, const char *path)
{
    if (source == NULL || path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_source_check_output needs a source and a path");
    if (!source->files.is_complete)
        HELIO_TRY(source_files_find(source->context, &source->specification, &source->desc, &source->files));
    if (source_files_has(&source->files, &source->specification, &source->desc, path))
        return fail(HELIO_ERR_ARGUMENT, "%s would replace an input of %s", path, source->label);
    return HELIO_OK;
}

/* Nothing will come any more: neither thread nor memory is needed. */
static void finish(helio_source *source)
{
    source->is_at_end = true;
    source_queue_stop(&source->queue);
    source_memory_trim(source->memory);
}

helio_status helio_source_next(helio_source *source, helio_source_frame *frame)
{
    if (source == NULL || frame == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_source_next needs a source and a place for the frame");
    if (source->is_at_end) {
        *frame = (helio_source_frame){.name = source->label};
        return HELIO_OK;
    }
    const source_slot *slot = source_queue_next(&source->queue);
    if (slot->status != HELIO_OK) {
        finish(source);
        return fail(slot->status, "%s", slot->error);
    }
    if (source_slot_is_end(slot)) {
        finish(source);
        *frame = (helio_source_frame){.name = source->label};
        return HELIO_OK;
    }
    *frame = slot->frame;
    if (frame->rgb != NULL)
        frame->pixels.data = frame->rgb;
    return HELIO_OK;
}

static helio_status apply_sky(helio_source *source, const helio_sky_desc *desc, helio_environment *environment,
                              helio_environment_info *info)
{
    uint32_t size = helio_environment_cube_size(environment);
    if (source->sky == NULL || source->sky_size < size) {
        helio_sky *sky;
        HELIO_TRY(helio_sky_create(source->context, size, &sky));
        helio_sky_destroy(source->sky);
        source->sky = sky;
        source->sky_size = size;
    }
    return helio_sky_update(source->sky, desc, environment, info);
}

/* Says so where maps of another kind were expected. */
static helio_status reshape(const helio_source *source, const helio_source_frame *frame, helio_environment *environment)
{
    const environment_map *map = &environment->map;
    uint32_t width = map->width, height = map->height;
    helio_layout layout = map->layout;
    helio_status status = helio_environment_reshape(environment, frame->width, frame->height, frame->layout);
    if (status != HELIO_OK)
        return fail(status, "%s: %s", frame->name, helio_last_error());
    bool is_new = map->width != width || map->height != height || map->layout != layout;
    if (is_new && width > 0)
        context_log(source->context, HELIO_LOG_INFO, "%s has %u x %u pixels, layout %s, after %u x %u, %s", frame->name,
                    frame->width, frame->height, helio_layout_name(map->layout), width, height,
                    helio_layout_name(layout));
    return HELIO_OK;
}

helio_status helio_source_apply(helio_source *source, const helio_source_frame *frame, helio_environment *environment,
                                helio_environment_info *info)
{
    if (source == NULL || frame == NULL || environment == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_source_apply needs a source, a frame and an environment");
    if (frame->sky != NULL)
        return apply_sky(source, frame->sky, environment, info);
    if (frame->pixels.data == NULL)
        return fail(HELIO_ERR_ARGUMENT, "%s has come to its end: there is no frame to apply", source->label);
    HELIO_TRY(reshape(source, frame, environment));
    return helio_environment_update_pixels(environment, &frame->pixels, info);
}
