/* SPDX-License-Identifier: MIT */
#include "image/picture.h"

#include "core/error.h"
#include "image/image.h"
#include "image/tonemap.h"

typedef helio_status (*picture_writer)(helio_context *context, file_writer *writer, const helio_picture *picture,
                                       const helio_picture_write_desc *desc);

typedef struct picture_format {
    const char *extension;
    picture_writer write; /* NULL: not built in */
    bool shows;           /* holds what a screen shows, not radiance */
} picture_format;

static const picture_format FORMATS[] = {
#if HELIO_WITH_OPENEXR
    {"exr", exr_write, false},
#else
    {"exr", NULL, false},
#endif
    {"pfm", pfm_write, false},
#if HELIO_WITH_PNG
    {"png", png_write, true},
#else
    {"png", NULL, true},
#endif
};

/* NULL if the extension is none of ours. */
static const picture_format *find_format(const char *path)
{
    for (size_t i = 0; path != NULL && i < sizeof FORMATS / sizeof *FORMATS; i++)
        if (file_has_extension(path, FORMATS[i].extension))
            return &FORMATS[i];
    return NULL;
}

static helio_status fail_with_format(const char *path, const picture_format *format)
{
    if (path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "a picture needs a path to be written to");
    if (format == NULL)
        return fail(HELIO_ERR_ARGUMENT, "%s ends in none of .exr, .pfm and .png, so its kind is unknown", path);
    return fail(HELIO_ERR_UNSUPPORTED, "%s cannot be written: this build has no .%s; use .pfm", path,
                format->extension);
}

helio_status helio_picture_check_path(const char *path)
{
    const picture_format *format = find_format(path);
    return format != NULL && format->write != NULL ? HELIO_OK : fail_with_format(path, format);
}

static helio_status check_picture(const char *path, const picture_format *format, const helio_picture *picture,
                                  const helio_picture_write_desc *desc)
{
    const bool is_there = picture->rgba != NULL || (format->shows && picture->shown != NULL);
    if (!is_there)
        return fail(HELIO_ERR_ARGUMENT, "the picture for %s has no pixels: rgba is NULL", path);
    if (picture->width == 0 || picture->height == 0 || picture->width > IMAGE_EDGE_LIMIT ||
        picture->height > IMAGE_EDGE_LIMIT)
        return fail(HELIO_ERR_ARGUMENT, "the picture for %s is %u x %u pixels; each must be 1 to %d", path,
                    picture->width, picture->height, IMAGE_EDGE_LIMIT);
    return tonemap_check(desc, path);
}

helio_status helio_picture_write(helio_context *context, const char *path, const helio_picture *picture,
                                 const helio_picture_write_desc *given)
{
    if (context == NULL || picture == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_picture_write needs a context and a picture");
    helio_picture_write_desc desc = given ? *given : (helio_picture_write_desc){0};
    const picture_format *format = find_format(path);
    if (format == NULL || format->write == NULL)
        return fail_with_format(path, format);
    HELIO_TRY(check_picture(path, format, picture, &desc));

    file_writer writer;
    HELIO_TRY(file_writer_open(&writer, path));
    helio_status status = format->write(context, &writer, picture, &desc);
    if (status == HELIO_OK)
        return file_writer_commit(&writer);
    file_writer_abandon(&writer);
    return status;
}
