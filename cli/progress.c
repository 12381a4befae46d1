/* SPDX-License-Identifier: MIT */
#include "progress.h"

#include "interrupt.h"
#include "machine.h"
#include "message.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { LINE_SIZE = 128, BAR_WIDTH = 20 };
static const double REFRESH_MS = 100;

static void format_time(double milliseconds, char text[16])
{
    double seconds = fmin(floor(milliseconds / 1e3 + 0.5), 359999);
    unsigned whole = (unsigned)seconds;
    if (whole >= 3600)
        snprintf(text, 16, "%u:%02u:%02u", whole / 3600, whole / 60 % 60, whole % 60);
    else
        snprintf(text, 16, "%u:%02u", whole / 60, whole % 60);
}

static void format_rate(double per_second, char text[32])
{
    bool millions = per_second >= 1e6, thousands = per_second >= 1e3;
    double scale = millions ? 1e6 : thousands ? 1e3 : 1;
    snprintf(text, 32, "%.3g %spixels/s", fmin(per_second / scale, 999999), millions ? "M" : thousands ? "k" : "");
}

static void format_bar(double done, char bar[BAR_WIDTH + 1])
{
    memset(bar, '.', BAR_WIDTH);
    memset(bar, '#', (size_t)(done * BAR_WIDTH));
    bar[BAR_WIDTH] = 0;
}

static void format_picture(const progress_bar *progress, double elapsed, double done, char line[LINE_SIZE])
{
    char bar[BAR_WIDTH + 1], past[16], left[16] = "?", rate[32];
    format_bar(done, bar);
    format_time(elapsed, past);
    format_rate(done * progress->pixels / elapsed * 1e3, rate);
    if (done > 0)
        format_time(elapsed / done - elapsed, left);
    snprintf(line, LINE_SIZE, "rendering [%s] %3.0f %%  %s elapsed, %s left, %s", bar, floor(done * 100), past, left,
             rate);
}

/* Frames that were there already take no time, so speed is that of the others. */
static void format_sequence(const progress_bar *progress, double elapsed, double done, char line[LINE_SIZE])
{
    char bar[BAR_WIDTH + 1], past[16], left[16] = "?";
    double rendered = (double)progress->rendered + done, passed = (double)progress->passed + done;
    double fps = rendered / elapsed * 1e3;
    format_time(elapsed, past);
    if (progress->total == 0) {
        snprintf(line, LINE_SIZE, "frame %" PRIu64 ", %.3g frames/s, %s elapsed", progress->passed + 1, fps, past);
        return;
    }
    double total = (double)progress->total;
    format_bar(fmin(passed / total, 1), bar);
    if (fps > 0)
        format_time(fmax(total - passed, 0) / fps * 1e3, left);
    uint64_t number = progress->passed < progress->total ? progress->passed + 1 : progress->total;
    snprintf(line, LINE_SIZE, "frame %" PRIu64 " of %" PRIu64 " [%s] %.3g frames/s, %s left", number, progress->total,
             bar, fps, left);
}

static void draw(const progress_bar *progress, double elapsed, double done)
{
    char line[LINE_SIZE];
    if (progress->total == 1)
        format_picture(progress, elapsed, done, line);
    else
        format_sequence(progress, elapsed, done, line);
    message_draw_line(line);
}

void progress_start(progress_bar *progress, uint64_t total, double pixels, bool hidden)
{
    double now = machine_milliseconds();
    *progress = (progress_bar){
        .visible = !hidden && isatty(STDERR_FILENO), .started = now, .drawn = now, .pixels = pixels, .total = total};
}

void progress_pass(progress_bar *progress, bool is_rendered)
{
    progress->passed++;
    progress->rendered += is_rendered;
}

bool progress_update(void *user, float done)
{
    progress_bar *progress = user;
    double now = machine_milliseconds();
    if (progress->visible && now - progress->drawn >= REFRESH_MS) {
        draw(progress, now - progress->started, fmin(fmax((double)done, 0), 1));
        progress->drawn = now;
    }
    return interrupt_signal() == 0;
}

void progress_end(progress_bar *progress)
{
    if (progress->visible)
        message_clear_line();
    progress->visible = false;
}
