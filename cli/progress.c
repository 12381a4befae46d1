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

enum { LINE_SIZE = 192, BAR_WIDTH = 20, LEAST_BAR = 4 };
static const double REFRESH_MS = 100;

/* Of lines that stay: half a minute, and of long work a tenth of what has passed, so that a night leaves some dozens.
 */
static const double LOG_MS = 30e3, LOG_SHARE = 0.1;

void progress_format_time(double milliseconds, char text[16])
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

/* " [###...]", as long as it may be beside the rest of the line; "" where it would be too short to tell much. */
static void format_bar(double done, size_t rest, char bar[BAR_WIDTH + 4])
{
    size_t columns = message_line_width(), around = strlen(" []");
    size_t width = columns > rest + around ? columns - rest - around : 0;
    width = width < BAR_WIDTH ? width : BAR_WIDTH;
    bar[0] = 0;
    if (width < LEAST_BAR)
        return;
    strcpy(bar, " [");
    memset(bar + 2, '.', width);
    memset(bar + 2, '#', (size_t)(done * (double)width));
    strcpy(bar + 2 + width, "]");
}

static void draw(const progress_line *line, double done)
{
    const char *const parts[] = {line->left, line->speed, line->past};
    size_t columns = message_line_width(), length = strlen(line->head), count = 0;
    for (; count < 3 && length + strlen(parts[count]) <= columns; count++)
        length += strlen(parts[count]);
    char bar[BAR_WIDTH + 4] = "", text[LINE_SIZE];
    if (done >= 0)
        format_bar(done, length, bar);
    snprintf(text, LINE_SIZE, "%s%s", line->head, bar);
    for (size_t i = 0; i < count; i++)
        strcat(text, parts[i]);
    message_draw_line(text);
}

/* The first part follows a bar there. */
static void log_line(const progress_line *line)
{
    message_note("%s%s%s%s%s", line->head, line->left[0] != 0 ? "," : "", line->left, line->speed, line->past);
}

static void show_picture(progress_bar *progress, double elapsed, double done)
{
    progress_line line = {.speed = ""};
    char past[16], left[16] = "?", rate[32];
    progress_format_time(elapsed, past);
    format_rate(done * progress->pixels / elapsed * 1e3, rate);
    if (done > 0)
        progress_format_time(elapsed / done - elapsed, left);
    snprintf(line.head, sizeof line.head, "rendering %.0f %%", floor(done * 100));
    snprintf(line.left, sizeof line.left, " %s left", left);
    if (progress->pixels > 0)
        snprintf(line.speed, sizeof line.speed, ", %s", rate);
    snprintf(line.past, sizeof line.past, ", %s elapsed", past);
    progress_show(progress, &line, done);
}

/* Frames that were there already take no time, so speed is that of the others. */
static void show_sequence(progress_bar *progress, double elapsed, double done)
{
    progress_line line = {.left = ""};
    char past[16], left[16] = "?";
    double rendered = (double)progress->rendered + done, passed = (double)progress->passed + done;
    double fps = rendered / elapsed * 1e3, total = (double)progress->total;
    progress_format_time(elapsed, past);
    if (progress->total == 0) {
        snprintf(line.head, sizeof line.head, "frame %" PRIu64, progress->passed + 1);
        snprintf(line.speed, sizeof line.speed, ", %.3g frames/s", fps);
        snprintf(line.past, sizeof line.past, ", %s elapsed", past);
        progress_show(progress, &line, -1);
        return;
    }
    if (fps > 0)
        progress_format_time(fmax(total - passed, 0) / fps * 1e3, left);
    uint64_t number = progress->passed < progress->total ? progress->passed + 1 : progress->total;
    snprintf(line.head, sizeof line.head, "frame %" PRIu64 " of %" PRIu64, number, progress->total);
    snprintf(line.left, sizeof line.left, " %.3g frames/s", fps);
    snprintf(line.speed, sizeof line.speed, ", %s left", left);
    line.past[0] = 0;
    progress_show(progress, &line, fmin(passed / total, 1));
}

void progress_start(progress_bar *progress, uint64_t total, double pixels, bool hidden)
{
    double now = machine_milliseconds();
    bool is_terminal = isatty(STDERR_FILENO);
    *progress = (progress_bar){.visible = !hidden && is_terminal,
                               .is_logged = !hidden && !is_terminal,
                               .started = now,
                               .drawn = now,
                               .pixels = pixels,
                               .total = total};
}

void progress_pass(progress_bar *progress, bool is_rendered)
{
    progress->passed++;
    progress->rendered += is_rendered;
}

bool progress_is_due(const progress_bar *progress)
{
    double pause = fmax(LOG_MS, LOG_SHARE * (progress->drawn - progress->started));
    return (progress->visible || progress->is_logged) &&
           machine_milliseconds() - progress->drawn >= (progress->visible ? REFRESH_MS : pause);
}

void progress_show(progress_bar *progress, const progress_line *line, double done)
{
    if (progress->visible)
        draw(line, done);
    else if (progress->is_logged)
        log_line(line);
    progress->drawn = machine_milliseconds();
}

bool progress_update(void *user, float done)
{
    progress_bar *progress = user;
    if (progress_is_due(progress)) {
        double elapsed = machine_milliseconds() - progress->started, part = fmin(fmax((double)done, 0), 1);
        if (progress->total == 1)
            show_picture(progress, elapsed, part);
        else
            show_sequence(progress, elapsed, part);
    }
    return interrupt_signal() == 0;
}

void progress_end(progress_bar *progress)
{
    if (progress->visible)
        message_clear_line();
    progress->visible = progress->is_logged = false;
}
