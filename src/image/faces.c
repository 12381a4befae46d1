/* SPDX-License-Identifier: MIT */
#include "image/faces.h"

#include "core/error.h"
#include "core/file.h"
#include "image/face_names.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define MOST_PIXELS (UINT64_C(1) << 28) /* of an environment map */

/* ---- names ---- */

/* What is searched for in a folder. */
typedef struct face_search {
    bool any;                    /* names that end in that of a face, else by a pattern: */
    bool digits;                 /* also count as names of faces */
    unsigned pictures;           /* by their extensions, that are there */
    char before[FACE_NAME_SIZE]; /* its %s */
    const char *after;
} face_search;

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash != NULL ? slash + 1 : path;
}

static bool has_picture_extension(const char *name)
{
    static const char *const extensions[] = {"exr", "hdr", "pic", "rgbe", "pfm", "png", "jpg", "jpeg"};
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++)
        if (file_has_extension(name, extensions[i]))
            return true;
    return false;
}

bool faces_is_named_like_one(const char *path)
{
    size_t begin, end;
    return face_names_find_last(base_name(path), false, &begin, &end) >= 0;
}

bool faces_are_meant(const char *path, bool one_of_six)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return strstr(path, "%s") != NULL;
    return S_ISDIR(status.st_mode) || (one_of_six && faces_is_named_like_one(path));
}

/* The face that a file shows, or -1. */
static int match(const face_search *search, const char *name)
{
    size_t begin, end, length = strlen(name);
    if (search->any)
        return has_picture_extension(name) ? face_names_find_last(name, search->digits, &begin, &end) : -1;
    size_t before = strlen(search->before), after = strlen(search->after);
    if (length < before + after || strncmp(name, search->before, before) != 0 ||
        strcmp(name + length - after, search->after) != 0)
        return -1;
    return face_names_find(name + before, length - before - after, search->digits);
}

static helio_status fail_as_too_long(const char *path)
{
    return fail(HELIO_ERR_ARGUMENT, "the path %.60s... is too long for six files; shorten it", path);
}

/* What path means, and its folder. search->after points into path. */
static helio_status find_search(const char *path, face_files *files, face_search *search)
{
    struct stat status;
    bool exists = stat(path, &status) == 0;
    *search = (face_search){.any = exists && S_ISDIR(status.st_mode)};
    const char *name = search->any ? path + strlen(path) : base_name(path), *percent = strstr(name, "%s");
    const char *slash = search->any && name > path && name[-1] != '/' ? "/" : "";
    if (snprintf(files->folder, sizeof files->folder, "%.*s%s", (int)(name - path), path, slash) >= FACE_FOLDER_SIZE)
        return fail_as_too_long(path);
    if (search->any)
        return HELIO_OK;
    size_t begin = 0, end = 0;
    if (exists) {
        face_names_find_last(name, false, &begin, &end);
    } else if (percent != NULL && strstr(percent + 2, "%s") == NULL) {
        begin = (size_t)(percent - name);
        end = begin + 2;
        search->digits = true;
    } else {
        return fail(HELIO_ERR_ARGUMENT, "%s needs one %%s, in the file's name, for the name of the face", path);
    }
    if (begin >= FACE_NAME_SIZE)
        return fail_as_too_long(path);
    memcpy(search->before, name, begin);
    search->before[begin] = 0;
    search->after = name + end;
    return HELIO_OK;
}

static helio_status take(const face_search *search, const char *name, face_files *files)
{
    int face = match(search, name);
    if (face < 0)
        return HELIO_OK;
    char *place = files->names[face];
    if (place[0] != 0)
        return fail(HELIO_ERR_DATA,
                    "%s%s and %s are both the same face of the cube; move one away, or tell which six are meant by a "
                    "pattern such as %ssky_%%s.exr",
                    files->folder, place, name, files->folder);
    if (strlen(name) >= FACE_NAME_SIZE)
        return fail_as_too_long(name);
    strcpy(place, name);
    return HELIO_OK;
}

static helio_status search_folder(const char *path, face_search *search, face_files *files)
{
    DIR *folder = opendir(files->folder[0] != 0 ? files->folder : ".");
    if (folder == NULL)
        return fail(HELIO_ERR_IO, "the folder of %s cannot be opened: %s", path, strerror(errno));
    helio_status status = HELIO_OK;
    search->pictures = 0;
    for (const struct dirent *entry; status == HELIO_OK && (entry = readdir(folder)) != NULL;) {
        search->pictures += has_picture_extension(entry->d_name);
        status = take(search, entry->d_name, files);
    }
    closedir(folder);
    return status;
}

/* The first face that has no file, or FACE_COUNT; none: is there a file at all? */
static int find_lack(const face_files *files, bool *none)
{
    int lack = FACE_COUNT;
    *none = true;
    for (int face = FACE_COUNT - 1; face >= 0; face--) {
        lack = files->names[face][0] == 0 ? face : lack;
        *none = *none && files->names[face][0] == 0;
    }
    return lack;
}

static helio_status fail_for_lack(const char *path, const face_search *search, const face_files *files, int lack)
{
    const char *usual = face_names_usual(lack);
    if (!search->any)
        return fail(HELIO_ERR_IO, "%s lacks one of the six faces of a cube: a picture named %s", path, usual);
    return fail(
        HELIO_ERR_IO,
        "%s lacks one of the six faces of a cube: a picture named %s; for other names give a pattern with %%s in "
        "the place of the face's name or number, such as %ssky_%%s.exr",
        path, usual, files->folder);
}

helio_status faces_find(const char *path, face_files *files)
{
    face_search search;
    bool none;
    memset(files, 0, sizeof *files);
    HELIO_TRY(find_search(path, files, &search));
    HELIO_TRY(search_folder(path, &search, files));
    int lack = find_lack(files, &none);
    if (search.any && none && search.pictures == FACE_COUNT) { /* and nothing else: then numbers may be meant */
        search.digits = true;
        HELIO_TRY(search_folder(path, &search, files));
        lack = find_lack(files, &none);
    }
    return lack == FACE_COUNT ? HELIO_OK : fail_for_lack(path, &search, files, lack);
}

/* ---- pictures ---- */

static helio_status read_face(helio_context *context, const face_files *files, int face,
                              const helio_image_read_desc *desc, helio_image **image)
{
    char path[FACE_FOLDER_SIZE + FACE_NAME_SIZE];
    snprintf(path, sizeof path, "%s%s", files->folder, files->names[face]);
    const helio_image_read_desc own = {.max_pixels = desc != NULL ? desc->max_pixels : 0, .without_alpha = true};
    HELIO_TRY(helio_image_read(context, path, &own, image));
    if ((*image)->width == (*image)->height)
        return HELIO_OK;
    helio_status status = fail(HELIO_ERR_DATA, "%s is not square: %u x %u pixels, where a face of a cube is wanted",
                               path, (*image)->width, (*image)->height);
    helio_image_destroy(context, *image);
    *image = NULL;
    return status;
}

/* Puts a face into its place. Makes the strip if there is none yet. */
static helio_status add_face(helio_context *context, const face_files *files, int face, uint64_t max_pixels,
                             const helio_image *picture, helio_image **strip)
{
    uint32_t size = picture->width;
    if (*strip == NULL) {
        char what[FACE_FOLDER_SIZE + FACE_NAME_SIZE + 64];
        snprintf(what, sizeof what, "%s%s with the five other faces", files->folder, files->names[face]);
        const image_file file = {.context = context, .path = what, .max_pixels = max_pixels};
        HELIO_TRY(image_create(&file, size, UINT64_C(6) * size, false, 0, strip));
        (*strip)->layout = HELIO_LAYOUT_STRIP;
        (*strip)->is_encoded = picture->is_encoded;
    }
    if ((*strip)->width != size)
        return fail(HELIO_ERR_DATA, "%s%s has %u x %u pixels, and %s has %u x %u; all six faces must have one size",
                    files->folder, files->names[face], size, size, files->names[0], (*strip)->width, (*strip)->width);
    size_t numbers = (size_t)3 * size * size;
    memcpy((*strip)->rgb + (size_t)face * numbers, picture->rgb, numbers * sizeof(float));
    (*strip)->bad.nan += picture->bad.nan;
    (*strip)->bad.infinite += picture->bad.infinite;
    (*strip)->bad.negative += picture->bad.negative;
    return HELIO_OK;
}

helio_status faces_read(helio_context *context, const face_files *files, const helio_image_read_desc *desc,
                        helio_image **image)
{
    uint64_t max_pixels = desc != NULL && desc->max_pixels != 0 ? desc->max_pixels : MOST_PIXELS;
    helio_image *strip = NULL;
    for (int face = 0; face < FACE_COUNT; face++) {
        helio_image *picture = NULL;
        helio_status status = read_face(context, files, face, desc, &picture);
        if (status == HELIO_OK)
            status = add_face(context, files, face, max_pixels, picture, &strip);
        helio_image_destroy(context, picture);
        if (status != HELIO_OK) {
            helio_image_destroy(context, strip);
            return status;
        }
    }
    *image = strip;
    return HELIO_OK;
}
