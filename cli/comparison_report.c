/* SPDX-License-Identifier: MIT */
#include "comparison_report.h"

#include "json_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define METRIC(name, meaning, ...)                                                                                     \
    {                                                                                                                  \
#name, meaning, offsetof(helio_comparison_info, name), __VA_ARGS__                                             \
    }

const comparison_metric comparison_metrics[COMPARISON_METRICS] = {
    METRIC(lab_mean, "mean difference in CIE 1976 L*a*b*", false, false),
    METRIC(de2000_mean, "mean difference by CIEDE2000", false, false),
    METRIC(rmse, "root mean square error of radiance", false, false),
    METRIC(relmse, "mean square error in relation to the reference", false, false),
    METRIC(psnr, "dB, of what is shown", true, false),
    METRIC(flip, "mean LDR-FLIP, 0 to 1", false, false),
    METRIC(flicker, "relmse of what changes from frame to frame", false, true),
    METRIC(flicker_rmse, "root mean square of that change", false, true),
};

double comparison_metric_value(const comparison_metric *metric, const helio_comparison_info *info)
{
    double value;
    memcpy(&value, (const char *)info + metric->offset, sizeof value);
    return value;
}

double comparison_metric_mean(const comparison_metric *metric, const comparison_report *report)
{
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < report->count; i++) {
        double value = comparison_metric_value(metric, &report->frames[i].info);
        if (isnan(value))
            continue;
        sum += metric->is_decibel ? pow(10, -value / 10) : value;
        count++;
    }
    if (count == 0)
        return (double)NAN;
    double mean = sum / (double)count;
    return metric->is_decibel ? -10 * log10(mean) : mean;
}

static uint64_t total_of(const comparison_report *report, size_t offset)
{
    uint64_t sum = 0, value;
    for (size_t i = 0; i < report->count; i++) {
        memcpy(&value, (const char *)&report->frames[i].info + offset, sizeof value);
        sum += value;
    }
    return sum;
}

/* ---- text ---------------------------------------------------------------------------------- */

enum { LABEL_WIDTH = 14, COLUMN_WIDTH = 12 };

static const char *mask_words(mask_origin origin)
{
    static const char *const words[] = {"--mask", "object.A of the picture", "object.A of the reference", "all pixels"};
    return words[origin];
}

static void print_subject(const comparison_report *report)
{
    uint64_t pixels = total_of(report, offsetof(helio_comparison_info, pixels));
    uint64_t skipped = total_of(report, offsetof(helio_comparison_info, skipped));
    printf("%s against %s\n", report->picture, report->reference);
    printf("  %-*s%" PRIu64 " of %" PRIu64 " (%s)", LABEL_WIDTH, "pixels", pixels,
           (uint64_t)report->width * report->height * report->count, mask_words(report->frames[0].mask_origin));
    if (skipped > 0)
        printf("; %" PRIu64 " more are NaN or infinite", skipped);
    if (report->is_sequence)
        printf("; %zu frame%s", report->count, report->count == 1 ? "" : "s");
    printf("\n  %-*sat %+.2f stops%s, tone map %s, white D65; FLIP from %g pixels per degree\n", LABEL_WIDTH, "shown",
           (double)report->exposure, report->has_auto_exposure ? " (auto)" : "", report->tonemap,
           report->pixels_per_degree);
}

static void print_frames(const comparison_report *report)
{
    printf("  %-*s", LABEL_WIDTH, "frame");
    for (int m = 0; m < COMPARISON_METRICS; m++)
        printf(" %*s", COLUMN_WIDTH, comparison_metrics[m].name);
    printf("\n");
    for (size_t i = 0; i < report->count; i++) {
        printf("  %-*" PRIu64, LABEL_WIDTH, report->frames[i].number);
        for (int m = 0; m < COMPARISON_METRICS; m++) {
            double value = comparison_metric_value(&comparison_metrics[m], &report->frames[i].info);
            if (isnan(value))
                printf(" %*s", COLUMN_WIDTH, "-");
            else
                printf(" %*.5g", COLUMN_WIDTH, value);
        }
        printf("\n");
    }
}

void comparison_report_print(const comparison_report *report)
{
    print_subject(report);
    for (int m = 0; m < COMPARISON_METRICS; m++) {
        const comparison_metric *metric = &comparison_metrics[m];
        double value = comparison_metric_mean(metric, report);
        if (!isnan(value))
            printf("  %-*s%-*.5g%s\n", LABEL_WIDTH, metric->name, COLUMN_WIDTH, value, metric->meaning);
    }
    if (report->is_sequence)
        print_frames(report);
}

/* ---- JSON ---------------------------------------------------------------------------------- */

static json_t *bad_object(const helio_bad_pixels *bad)
{
    return json_pack("{so so so}", "nan", json_whole(bad->nan), "inf", json_whole(bad->infinite), "negative",
                     json_whole(bad->negative));
}

static json_t *mask_object(const compared_frame *frame)
{
    json_t *object = json_object();
    json_object_set_new(object, "from", json_string(mask_words(frame->mask_origin)));
    json_object_set_new(object, "file", json_text(frame->mask));
    return object;
}

/* What pictures and frames of sequences have in common. */
static void describe_frame(json_t *object, const compared_frame *frame)
{
    json_object_set_new(object, "mask", mask_object(frame));
    json_object_set_new(object, "bad_pixels",
                        json_pack("{so so}", "picture", bad_object(&frame->info.picture_bad), "reference",
                                  bad_object(&frame->info.reference_bad)));
}

static json_t *frame_object(const compared_frame *frame)
{
    json_t *object = json_object();
    json_object_set_new(object, "index", json_whole(frame->number));
    json_object_set_new(object, "picture", json_text(frame->picture));
    json_object_set_new(object, "reference", json_text(frame->reference));
    for (int m = 0; m < COMPARISON_METRICS; m++)
        json_object_set_new(object, comparison_metrics[m].name,
                            json_number(comparison_metric_value(&comparison_metrics[m], &frame->info)));
    json_object_set_new(object, "pixels", json_whole(frame->info.pixels));
    json_object_set_new(object, "skipped", json_whole(frame->info.skipped));
    json_object_set_new(object, "flicker_pixels", json_whole(frame->info.flicker_pixels));
    describe_frame(object, frame);
    return object;
}

static json_t *viewing_object(const comparison_report *report)
{
    json_t *object = json_object();
    json_object_set_new(object, "exposure", json_number((double)report->exposure));
    json_object_set_new(object, "exposure_is_auto", json_boolean(report->has_auto_exposure));
    json_object_set_new(object, "tonemap", json_string(report->tonemap));
    json_object_set_new(object, "white", json_string("D65"));
    json_object_set_new(object, "pixels_per_degree", json_number(report->pixels_per_degree));
    return object;
}

static json_t *report_object(const comparison_report *report)
{
    json_t *object = json_object(), *frames = json_array();
    json_object_set_new(object, "picture", json_text(report->picture));
    json_object_set_new(object, "reference", json_text(report->reference));
    json_object_set_new(object, "size", json_pack("[oo]", json_whole(report->width), json_whole(report->height)));
    json_object_set_new(object, "viewing", viewing_object(report));
    for (int m = 0; m < COMPARISON_METRICS; m++)
        if (report->is_sequence || !comparison_metrics[m].is_of_changes)
            json_object_set_new(object, comparison_metrics[m].name,
                                json_number(comparison_metric_mean(&comparison_metrics[m], report)));
    json_object_set_new(object, "pixels", json_whole(total_of(report, offsetof(helio_comparison_info, pixels))));
    json_object_set_new(object, "skipped", json_whole(total_of(report, offsetof(helio_comparison_info, skipped))));
    for (size_t i = 0; i < report->count && report->is_sequence; i++)
        json_array_append_new(frames, frame_object(&report->frames[i]));
    if (report->is_sequence)
        json_object_set(object, "frames", frames);
    else
        describe_frame(object, &report->frames[0]);
    json_decref(frames);
    return object;
}

int comparison_report_write_json(const char *path, const comparison_report *report)
{
    json_t *object = report_object(report);
    int code = json_file_write_or_print("json", path, object);
    json_decref(object);
    return code;
}
