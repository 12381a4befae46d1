/* SPDX-License-Identifier: MIT */
#include "progress.h"

#include "interrupt.h"
#include "machine.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { LINE_WIDTH = 78, BAR_WIDTH = 20 };
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

static void draw(const progress_bar *progress, double elapsed, double done)
{
    char bar[BAR_WIDTH + 1], past[16], left[16], rate[32], line[128];
    size_t full = (size_t)(done * BAR_WIDTH);
    memset(bar, '.', BAR_WIDTH);
    memset(bar, '#', full);
    bar[BAR_WIDTH] = 0;
    format_time(elapsed, past);
    format_rate(done * progress->pixels / elapsed * 1e3, rate);
    if (done > 0)
        format_time(elapsed / done - elapsed, left);
    else
        strcpy(left, "?");
    snprintf(line, sizeof line, "rendering [%s] %3.0f %%  %s elapsed, %s left, %s", bar, floor(done * 100), past, left,
             rate);
    /* Padded to full width, so that nothing of a longer line stays behind it. */
    fprintf(stderr, "\r%-*.*s", LINE_WIDTH, LINE_WIDTH, line);
    fflush(stderr);
}

void progress_start(progress_bar *progress, double pixels, bool hidden)
{
    double now = machine_milliseconds();
    progress->visible = !hidden && isatty(STDERR_FILENO);
    progress->pixels = pixels;
    progress->started = now;
    progress->drawn = now;
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
    if (progress->visible && progress->drawn > progress->started) {
        fprintf(stderr, "\r%*s\r", LINE_WIDTH, "");
        fflush(stderr);
    }
    progress->visible = false;
}
