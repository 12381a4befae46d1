/* SPDX-License-Identifier: MIT */
#include "image/image.h"

#include "core/context.h"
#include "core/error.h"
#include "core/file.h"
#include "image/faces.h"
#include "image/pixel_fault.h"

#include <float.h>
#include <inttypes.h>
#include <string.h>

#define FILE_SIZE_LIMIT (UINT64_C(4) << 30) /* bytes */

/* Pixels that any file may have unasked: reading takes up to 28 bytes for each, an environment with its map 24, which
 * stays below 2 GiB. Files that are as large themselves are believed, as 16384 x 8192 maps are in use. */
#define MODEST_PIXELS (UINT64_C(1) << 26)
#define MOST_PIXELS (UINT64_C(1) << 28)

typedef struct image_kind {
    const char *name;
    const char *magic;
    size_t magic_length;
    bool encoded;                                                      /* by the sRGB curve */
    helio_status (*read)(const image_file *file, helio_image **image); /* NULL: not built in */
} image_kind;

static const image_kind KINDS[] = {
#if HELIO_WITH_OPENEXR
    {"OpenEXR", "\x76\x2f\x31\x01", 4, false, exr_read},
#else
    {"OpenEXR", "\x76\x2f\x31\x01", 4, false, NULL},
#endif
    {"Radiance HDR", "#?", 2, false, radiance_read},
    {"PFM", "PF", 2, false, pfm_read},
    {"PFM", "Pf", 2, false, pfm_read},
#if HELIO_WITH_PNG
    {"PNG", "\x89PNG\r\n\x1a\n", 8, true, png_read},
#else
    {"PNG", "\x89PNG\r\n\x1a\n", 8, true, NULL},
#endif
#if HELIO_WITH_JPEG
    {"JPEG", "\xff\xd8\xff", 3, true, jpeg_read},
#else
    {"JPEG", "\xff\xd8\xff", 3, true, NULL},
#endif
};

static const image_kind *find_kind(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < sizeof KINDS / sizeof *KINDS; i++)
        if (size >= KINDS[i].magic_length && memcmp(bytes, KINDS[i].magic, KINDS[i].magic_length) == 0)
            return &KINDS[i];
    return NULL;
}

bool image_is_picture(const unsigned char *bytes, size_t size)
{
    return find_kind(bytes, size) != NULL;
}

helio_status image_decode(const image_file *file, helio_image **image)
{
    if (file->size == 0)
        return fail(HELIO_ERR_DATA, "%s is empty", file->path);
    const image_kind *kind = find_kind(file->bytes, file->size);
    if (kind == NULL)
        return fail(HELIO_ERR_DATA,
                    "%s is not a picture that can be read; give OpenEXR, Radiance HDR, PFM, PNG or JPEG", file->path);
    if (file->texels != NULL && !kind->encoded)
        return fail(HELIO_ERR_DATA, "%s is %s, which cannot be used here; give PNG or JPEG", file->path, kind->name);
    if (file->layer != NULL && strcmp(kind->name, "OpenEXR") != 0)
        return fail(HELIO_ERR_DATA, "%s has no layer '%s': it is %s, and only OpenEXR has layers", file->path,
                    file->layer, kind->name);
    if (kind->read == NULL)
        return fail(HELIO_ERR_UNSUPPORTED, "%s is %s, which this build cannot read; build with it or convert the file",
                    file->path, kind->name);
    HELIO_TRY(kind->read(file, image));
    (*image)->is_encoded = kind->encoded;
    return HELIO_OK;
}

static uint64_t default_max_pixels(uint64_t file_size)
{
    return file_size < MODEST_PIXELS ? MODEST_PIXELS : file_size < MOST_PIXELS ? file_size : MOST_PIXELS;
}

static helio_status read_file(helio_context *context, const char *path, const helio_image_read_desc *desc,
                              helio_image **image)
{
    image_file file = {.context = context, .path = path};
    if (desc != NULL) {
        file.without_alpha = desc->without_alpha;
        file.layer = desc->layer;
    }
    const size_t limit = FILE_SIZE_LIMIT < SIZE_MAX / 2 ? (size_t)FILE_SIZE_LIMIT : SIZE_MAX / 2;
    unsigned char *bytes;
    HELIO_TRY(file_read(context, path, limit, &bytes, &file.size));
    file.bytes = bytes;
    file.max_pixels = desc != NULL && desc->max_pixels != 0 ? desc->max_pixels : default_max_pixels(file.size);
    helio_status status = image_decode(&file, image);
    context_release(context, bytes);
    return status;
}

helio_status helio_image_read(helio_context *context, const char *path, const helio_image_read_desc *desc,
                              helio_image **image)
{
    if (image == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_image_read needs a place for the image");
    *image = NULL;
    if (context == NULL || path == NULL)
        return fail(HELIO_ERR_ARGUMENT, "helio_image_read needs a context and a path");
    if (!faces_are_meant(path, desc != NULL && desc->layout == HELIO_LAYOUT_FACES))
        return read_file(context, path, desc, image);
    face_files files;
    HELIO_TRY(faces_find(path, &files));
    return faces_read(context, &files, desc, image);
}

void helio_image_destroy(helio_context *context, helio_image *image)
{
    if (image == NULL)
        return;
    context_release(context, image->rgb);
    context_release(context, image->alpha);
    context_release(context, image);
}

helio_status image_check_size(const image_file *file, uint64_t width, uint64_t height, uint64_t least_bytes)
{
    if (width == 0 || height == 0)
        return fail(HELIO_ERR_DATA, "%s has no pixels: its size is %" PRIu64 " x %" PRIu64, file->path, width, height);
    uint32_t max_edge = file->max_edge != 0 ? file->max_edge : IMAGE_EDGE_LIMIT;
    if (width > max_edge || height > max_edge)
        return fail(HELIO_ERR_DATA, "%s is too large: %" PRIu64 " x %" PRIu64 " pixels, where %u are allowed each way",
                    file->path, width, height, max_edge);
    if (width * height > file->max_pixels)
        return fail(HELIO_ERR_DATA,
                    "%s is too large: %" PRIu64 " x %" PRIu64 " pixels, where %" PRIu64 " in all are allowed; %s",
                    file->path, width, height, file->max_pixels,
                    file->way_out != NULL ? file->way_out : "if you trust it, raise max_pixels (--max-pixels)");
    if (file->size < least_bytes)
        return fail(HELIO_ERR_DATA,
                    "%s is truncated or damaged: its %zu bytes cannot hold the %" PRIu64 " x %" PRIu64
                    " pixels that it claims",
                    file->path, file->size, width, height);
    return HELIO_OK;
}

static bool allocate_pixels(const image_file *file, helio_image *image, bool alpha)
{
    size_t pixels = (size_t)image->width * image->height;
    if (file->texels != NULL)
        return (*file->texels = context_allocate(file->context, pixels, 4)) != NULL;
    image->rgb = context_allocate(file->context, pixels, 3 * sizeof *image->rgb);
    bool wanted = alpha && !file->without_alpha;
    if (wanted)
        image->alpha = context_allocate(file->context, pixels, sizeof *image->alpha);
    return image->rgb != NULL && (!wanted || image->alpha != NULL);
}

helio_status image_create(const image_file *file, uint64_t width, uint64_t height, bool alpha, uint64_t least_bytes,
                          helio_image **out)
{
    HELIO_TRY(image_check_size(file, width, height, least_bytes));
    helio_image *image = context_allocate(file->context, 1, sizeof *image);
    if (image == NULL)
        return HELIO_ERR_MEMORY;
    image->width = (uint32_t)width;
    image->height = (uint32_t)height;
    if (!allocate_pixels(file, image, alpha)) {
        helio_image_destroy(file->context, image);
        return fail(HELIO_ERR_MEMORY, "no memory for the %" PRIu64 " x %" PRIu64 " pixels of %s", width, height,
                    file->path);
    }
    *out = image;
    return HELIO_OK;
}

void image_count_bad(helio_image *image)
{
    size_t pixels = (size_t)image->width * image->height;
    image->bad = (helio_bad_pixels){0};
    for (size_t i = 0; i < pixels; i++) {
        switch (pixel_fault_of(image->rgb + 3 * i)) {
        case PIXEL_NAN: image->bad.nan++; break;
        case PIXEL_INFINITE: image->bad.infinite++; break;
        case PIXEL_NEGATIVE: image->bad.negative++; break;
        case PIXEL_GOOD: break;
        }
    }
}

void image_make_printable(char *text)
{
    for (; *text != 0; text++)
        if (*text == '\t')
            *text = ' ';
        else if (*text < ' ' || *text > '~')
            *text = '?';
}
