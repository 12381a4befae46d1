/* SPDX-License-Identifier: MIT */
#include "study_csv.h"

#include "message.h"
#include "output_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Quoted, as materials hold commas. */
static void write_text(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text != 0; text++)
        fprintf(stream, *text == '"' ? "\"\"" : "%c", *text);
    fputc('"', stream);
}

static void write_number(FILE *stream, double value)
{
    if (isfinite(value))
        fprintf(stream, ",%.9g", value);
    else
        fputc(',', stream);
}

static void write_cell(FILE *stream, const study_record *record, size_t index)
{
    const study_plan *plan = record->plan;
    study_point point = study_plan_point(plan, index);
    write_text(stream, plan->environments[point.environment].name);
    fputc(',', stream);
    write_text(stream, plan->materials[point.material].name);
    fprintf(stream, ",%s,%u", plan->strategies[point.strategy].name, plan->spp[point.spp]);
    for (int i = 0; i < STUDY_NUMBERS; i++)
        write_number(stream, study_number_of(&record->cells[index], &study_numbers[i]));
    write_number(stream, record->cells[index].exposure);
    fputc('\n', stream);
}

int study_csv_write(const study_record *record, const char *path)
{
    char temporary[4096];
    FILE *stream = output_file_open(path, temporary, sizeof temporary);
    if (stream == NULL)
        return message_failure("%s cannot be written: %s", path, strerror(errno));
    fputs("environment,material,strategy,spp", stream);
    for (int i = 0; i < STUDY_NUMBERS; i++)
        fprintf(stream, ",%s", study_numbers[i].name);
    fputs(",exposure\n", stream);
    for (size_t i = 0; i < study_plan_count(record->plan); i++)
        if (record->cells[i].is_done)
            write_cell(stream, record, i);
    return output_file_finish(stream, temporary, path);
}
