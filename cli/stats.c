/* SPDX-License-Identifier: MIT */
#include "stats.h"

#include "machine.h"
#include "message.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* JSON has no word for what is not finite. */
static json_t *number(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *whole(uint64_t value)
{
    return json_integer((json_int_t)value);
}

static json_t *frame_object(const stats_frame *frame)
{
    json_t *bad = json_pack("{so so so so}", "nan", whole(frame->nan), "inf", whole(frame->infinite), "negative",
                            whole(frame->negative), "out_of_gamut", whole(frame->out_of_gamut));
    json_t *object = json_object();
    json_object_set_new(object, "index", whole(frame->index));
    json_object_set_new(object, "source_ms", number(frame->source_ms));
    json_object_set_new(object, "cube_ms", number(frame->cube_ms));
    json_object_set_new(object, "tables_ms", number(frame->tables_ms));
    json_object_set_new(object, "pools_ms", number(frame->pools_ms));
    json_object_set_new(object, "primary_ms", number(frame->primary_ms));
    json_object_set_new(object, "shade_ms", number(frame->shade_ms));
    json_object_set_new(object, "write_ms", number(frame->write_ms));
    json_object_set_new(object, "total_ms", number(frame->total_ms));
    json_object_set_new(object, "samples", whole(frame->samples));
    json_object_set_new(object, "samples_useful", whole(frame->samples_useful));
    json_object_set_new(object, "bad_texels", bad);
    json_object_set_new(object, "flux", number(frame->flux));
    return object;
}

static json_t *summary_object(const stats_frame *frames, size_t count, const stats_summary *summary)
{
    double milliseconds = 0, samples = 0;
    for (size_t i = 0; i < count; i++) {
        milliseconds += frames[i].total_ms;
        samples += (double)frames[i].samples;
    }
    double seconds = fmax(milliseconds, 1e-6) / 1e3;
    char processor[256];
    machine_processor(processor, sizeof processor);

    json_t *object = json_object();
    json_object_set_new(object, "frames", whole(count));
    json_object_set_new(object, "fps", number((double)count / seconds));
    json_object_set_new(object, "samples_per_second", number(samples / seconds));
    json_object_set_new(object, "strategy", json_string(summary->strategy));
    json_object_set_new(object, "spp", whole(summary->spp));
    json_object_set_new(object, "passes", whole(summary->passes));
    json_object_set_new(object, "ev", number(summary->ev));
    json_object_set_new(object, "size", json_pack("[oo]", whole(summary->width), whole(summary->height)));
    json_object_set_new(object, "backend", json_string("cpu"));
    json_object_set_new(object, "device", json_string(processor));
    json_object_set_new(object, "isa", json_string(summary->isa));
    json_object_set_new(object, "threads", whole(summary->threads));
    return object;
}

/* Opens a new file beside path; its name stays within temporary. */
static FILE *open_temporary(const char *path, char *temporary, size_t size)
{
    const char *slash = strrchr(path, '/');
    int directory_length = slash ? (int)(slash - path) + 1 : 0;
    int length =
        snprintf(temporary, size, "%.*s.%s.%ld", directory_length, path, path + directory_length, (long)getpid());
    if (length < 0 || (size_t)length >= size) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    int descriptor = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return descriptor < 0 ? NULL : fdopen(descriptor, "w");
}

static int write_object(const char *path, const json_t *object)
{
    char temporary[4096];
    FILE *stream = open_temporary(path, temporary, sizeof temporary);
    if (stream == NULL)
        return message_failure("%s cannot be written: %s; give --stats another FILE", path, strerror(errno));
    bool good = json_dumpf(object, stream, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) == 0;
    good = fputc('\n', stream) != EOF && good;
    good = fclose(stream) == 0 && good;
    if (good && rename(temporary, path) == 0)
        return EXIT_CODE_OK;
    int code = message_failure("%s cannot be written: %s; give --stats another FILE", path, strerror(errno));
    unlink(temporary);
    return code;
}

int stats_write(const char *path, const stats_frame *frames, size_t count, const stats_summary *summary)
{
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(list, frame_object(&frames[i]));
    json_t *object = json_object();
    json_object_set_new(object, "frames", list);
    json_object_set_new(object, "summary", summary_object(frames, count, summary));
    int code = object == NULL ? message_failure("%s cannot be written: no memory", path) : write_object(path, object);
    json_decref(object);
    return code;
}
