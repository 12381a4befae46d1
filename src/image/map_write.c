/* SPDX-License-Identifier: MIT */
#include "core/context.h"
#include "core/error.h"
#include "image/image.h"
#include "image/map.h"
#include "image/picture.h"

#include <math.h>

static const float GREATEST_HALF = 65504;

typedef helio_status (*map_writer)(helio_context *context, file_writer *writer, const helio_map *map,
                                   const helio_map_write_desc *desc);

static helio_status pfm_write_map(helio_context *context, file_writer *writer, const helio_map *map,
                                  const helio_map_write_desc *desc)
{
    (void)desc;
    return pfm_write_pixels(context, writer, &(picture_pixels){map->width, map->height, map->rgb, 3, NULL});
}

#if HELIO_WITH_PNG
static helio_status png_write_map(helio_context *context, file_writer *writer, const helio_map *map,
                                  const helio_map_write_desc *desc)
{
    const helio_picture_write_desc tones = {.exposure = desc->exposure, .tonemap = desc->tonemap};
    return png_write_pixels(context, writer, &(picture_pixels){map->width, map->height, map->rgb, 3, NULL}, &tones);
}
#endif

typedef struct map_format {
    const char *extension;
    map_writer write; /* NULL: not built in */
} map_format;

static const map_format FORMATS[] = {
#if HELIO_WITH_OPENEXR
    {"exr", exr_write_map},
#else
    {"exr", NULL},
#endif
    {"hdr", radiance_write_map},
    {"pfm", pfm_write_map},
#if HELIO_WITH_PNG
    {"png", png_write_map},
#else
    {"png", NULL},
#endif
};

/* Of files in a folder that was named in place of a pattern. */
static const map_format *folder_format(void)
{
    return FORMATS[0].write != NULL ? &FORMATS[0] : &FORMATS[1];
}

static helio_status find_format(const char *path, helio_layout layout, const map_format **format)
{
    if (path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "a map needs a path to be written to");
    *format = NULL;
    if (layout == HELIO_LAYOUT_FACES) {
        HELIO_TRY(map_faces_check(path));
        if (map_faces_is_folder(path))
            *format = folder_format();
    }
    for (size_t i = 0; *format == NULL && i < sizeof FORMATS / sizeof *FORMATS; i++)
        if (file_has_extension(path, FORMATS[i].extension))
            *format = &FORMATS[i];
    if (*format == NULL)
        return fail(HELIO_ERR_ARGUMENT, "%s ends in none of .exr, .hdr, .pfm and .png, so its kind is unknown", path);
    if ((*format)->write == NULL)
        return fail(HELIO_ERR_UNSUPPORTED, "%s cannot be written: this build has no .%s; use .hdr or .pfm", path,
                    (*format)->extension);
    return HELIO_OK;
}

helio_status helio_map_check_path(const char *path, helio_layout layout)
{
    const map_format *format;
    return find_format(path, layout, &format);
}

static helio_status check_half(const char *path, const helio_map *map)
{
    size_t numbers = 3 * (size_t)map->width * map->height;
    float greatest = 0;
    for (size_t i = 0; i < numbers; i++)
        greatest = fmaxf(greatest, fabsf(map->rgb[i]));
    if (greatest > GREATEST_HALF)
        return fail(HELIO_ERR_DATA,
                    "%s cannot hold radiance of %g in half floats, which end at %g; write floats, or "
                    "scale the map",
                    path, (double)greatest, (double)GREATEST_HALF);
    return HELIO_OK;
}

static helio_status check_map(const char *path, const helio_map *map, const helio_map_write_desc *desc,
                              const map_format *format)
{
    if (map->rgb == NULL)
        return fail(HELIO_ERR_ARGUMENT, "the map for %s has no pixels: rgb is NULL", path);
    if (map->width == 0 || map->height == 0 || map->width > IMAGE_EDGE_LIMIT || map->height > IMAGE_EDGE_LIMIT)
        return fail(HELIO_ERR_ARGUMENT, "the map for %s is %u x %u pixels; each must be 1 to %d", path, map->width,
                    map->height, IMAGE_EDGE_LIMIT);
    if (map->layout == HELIO_LAYOUT_AUTO)
        return fail(HELIO_ERR_ARGUMENT, "the map for %s has no layout; say which", path);
    if (map->layout == HELIO_LAYOUT_FACES && map->height != UINT64_C(6) * map->width)
        return fail(HELIO_ERR_ARGUMENT, "the six faces for %s are %u x %u pixels; they must be a strip of 1:6", path,
                    map->width, map->height);
    if (!isfinite(desc->exposure))
        return fail(HELIO_ERR_ARGUMENT, "the exposure for %s is no finite number", path);
    if ((unsigned)desc->tonemap > HELIO_TONEMAP_REINHARD)
        return fail(HELIO_ERR_ARGUMENT, "tone map %d for %s is unknown; use HELIO_TONEMAP_CLIP or _REINHARD",
                    (int)desc->tonemap, path);
    return desc->half && format == &FORMATS[0] ? check_half(path, map) : HELIO_OK;
}

static helio_status write_one(helio_context *context, const char *path, const helio_map *map,
                              const helio_map_write_desc *desc, const map_format *format)
{
    file_writer writer;
    HELIO_TRY(file_writer_open(&writer, path));
    helio_status status = format->write(context, &writer, map, desc);
    if (status == HELIO_OK)
        return file_writer_commit(&writer);
    file_writer_abandon(&writer);
    return status;
}

/* The files of six faces on their way. */
typedef struct face_files {
    char paths[MAP_FACES][MAP_PATH_SIZE];
    file_writer writers[MAP_FACES];
} face_files;

static helio_status fill_files(helio_context *context, const char *path, const helio_map *map,
                               const helio_map_write_desc *desc, const map_format *format, face_files *files)
{
    helio_map face = {.width = map->width, .height = map->width, .rgb = map->rgb}; /* no map by itself */
    for (int i = 0; i < MAP_FACES; i++, face.rgb += 3 * (size_t)map->width * map->width) {
        HELIO_TRY(map_faces_path(path, i, format->extension, files->paths[i]));
        HELIO_TRY(file_writer_open(&files->writers[i], files->paths[i]));
        HELIO_TRY(format->write(context, &files->writers[i], &face, desc));
    }
    for (int i = 0; i < MAP_FACES; i++)
        HELIO_TRY(file_writer_commit(&files->writers[i]));
    return HELIO_OK;
}

static helio_status write_faces(helio_context *context, const char *path, const helio_map *map,
                                const helio_map_write_desc *desc, const map_format *format)
{
    HELIO_TRY(map_faces_make_folder(path));
    face_files *files = context_allocate(context, 1, sizeof *files);
    if (files == NULL)
        return HELIO_ERR_MEMORY;
    helio_status status = fill_files(context, path, map, desc, format, files);
    for (int i = 0; i < MAP_FACES; i++)
        file_writer_abandon(&files->writers[i]); /* those that are still open */
    context_release(context, files);
    return status;
}

helio_status helio_map_write(helio_context *context, const char *path, const helio_map *map,
                             const helio_map_write_desc *given)
{
    if (context == NULL || map == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_map_write needs a context and a map");
    const helio_map_write_desc desc = given ? *given : (helio_map_write_desc){0};
    const map_format *format;
    HELIO_TRY(find_format(path, map->layout, &format));
    HELIO_TRY(check_map(path, map, &desc, format));
    if (map->layout == HELIO_LAYOUT_FACES)
        return write_faces(context, path, map, &desc, format);
    return write_one(context, path, map, &desc, format);
}
