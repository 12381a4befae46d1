/* SPDX-License-Identifier: MIT */
#include "reference_run.h"

#include "interrupt.h"
#include "json_file.h"
#include "machine.h"
#include "message.h"
#include "narrow_light.h"
#include "output_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <unistd.h>

/* Before so many passes their spread says too little to stop by it. */
enum { LEAST_PASSES_FOR_ERROR = 8 };

/* A checkpoint may take this part of the time, at most. */
static const double SAVE_SHARE = 0.05;

/* ---- when to stop ----------------------------------------------------------------------- */

static uint64_t least_pieces(const reference_run *run)
{
    uint64_t pass = run->info.piece_spp, passes = (run->plan->spp + pass - 1) / pass;
    return passes > 2 ? passes : 2;
}

static double elapsed_ms(const reference_run *run)
{
    return machine_milliseconds() - run->started;
}

static bool is_done(const reference_run *run)
{
    const reference_plan *plan = run->plan;
    uint64_t pieces = run->info.pieces;
    if (plan->method == HELIO_REFERENCE_QUADRATURE)
        return run->info.complete;
    return pieces >= 2 && ((plan->spp > 0 && pieces >= least_pieces(run)) ||
                           (plan->seconds > 0 && elapsed_ms(run) >= plan->seconds * 1e3) ||
                           (plan->error > 0 && pieces >= LEAST_PASSES_FOR_ERROR && run->error <= plan->error));
}

/* Milliseconds until is_done(), as far as can be told; infinite where nothing tells. pieces: with what is done of the
 * one in progress. */
static double estimate_left(const reference_run *run, double pieces)
{
    const reference_plan *plan = run->plan;
    double elapsed = elapsed_ms(run), each = elapsed / fmax(pieces - (double)run->resumed, 1e-9), left = HUGE_VAL;
    if (plan->method == HELIO_REFERENCE_QUADRATURE)
        return ((double)run->info.piece_count - pieces) * each;
    if (plan->spp > 0)
        left = fmax((double)least_pieces(run) - pieces, 0) * each;
    if (plan->seconds > 0)
        left = fmin(left, fmax(plan->seconds * 1e3 - elapsed, 0));
    if (plan->error > 0 && isfinite(run->error)) { /* it falls with the root of the passes */
        double ratio = run->error / plan->error, wanted = (double)run->info.pieces * ratio * ratio;
        left = fmin(left, fmax(fmax(wanted, LEAST_PASSES_FOR_ERROR) - pieces, 0) * each);
    }
    return left;
}

/* ---- progress --------------------------------------------------------------------------- */

static void describe_error(const reference_run *run, const char *before, char text[32])
{
    text[0] = 0;
    if (isfinite(run->error))
        snprintf(text, 32, "%s%.3g", before, run->error);
}

static void show(reference_run *run, double pieces)
{
    progress_line line;
    char past[16], left_text[16] = "?", error[32];
    double left = estimate_left(run, pieces), elapsed = elapsed_ms(run), done = 0;
    if (isfinite(left) && pieces > 0) {
        double each = elapsed / fmax(pieces - (double)run->resumed, 1e-9), all = pieces + left / each;
        done = fmin(pieces / all, 1);
        progress_format_time(left, left_text);
    }
    progress_format_time(elapsed, past);
    describe_error(run, ", error ", error);
    snprintf(line.head, sizeof line.head, "reference %.0f %%", floor(done * 100));
    snprintf(line.left, sizeof line.left, " %s left", left_text);
    snprintf(line.speed, sizeof line.speed, "%s", error);
    if (run->plan->method == HELIO_REFERENCE_QUADRATURE)
        snprintf(line.past, sizeof line.past, ", %s elapsed", past);
    else
        snprintf(line.past, sizeof line.past, ", %" PRIu64 " spp", run->info.spp);
    progress_show(&run->job->progress, &line, done);
}

static bool on_progress(void *user, float done)
{
    reference_run *run = user;
    if (progress_is_due(&run->job->progress))
        show(run, (double)run->info.pieces + (double)done);
    return interrupt_signal() == 0;
}

/* ---- checkpoints ------------------------------------------------------------------------ */

/* A disk that is full for a while is no reason to stop. */
static void save(reference_run *run)
{
    run->saved = machine_milliseconds();
    bool is_good = helio_reference_save(run->reference, run->checkpoint) == HELIO_OK;
    run->save_cost = machine_milliseconds() - run->saved;
    run->is_saved |= is_good;
    if (!is_good && !run->has_warned)
        message_warning("%s; what is computed now would be lost with the program", helio_last_error());
    run->has_warned = !is_good;
}

static bool is_save_due(const reference_run *run)
{
    double past = machine_milliseconds() - run->saved;
    return past >= run->plan->save_ms && past * SAVE_SHARE >= run->save_cost;
}

/* Work of hours should not be lost by one word that was forgotten. */
static int check_checkpoint(const reference_run *run)
{
    const char *const inputs[] = {run->job->plan.mesh, NULL};
    int code = output_file_check("out", run->checkpoint, run->job->source, inputs);
    if (code != EXIT_CODE_OK || run->plan->resume || access(run->checkpoint, F_OK) != 0)
        return code;
    return message_failure("%s holds what an earlier run has left unfinished; go on with it by --resume, or remove it",
                           run->checkpoint);
}

static int resume(reference_run *run)
{
    if (!run->plan->resume || access(run->checkpoint, F_OK) != 0)
        return EXIT_CODE_OK;
    if (helio_reference_resume(run->reference, run->checkpoint) != HELIO_OK)
        return message_failure("%s", helio_last_error());
    run->info = helio_reference_get_info(run->reference);
    run->error = helio_reference_error(run->reference);
    run->resumed = run->info.pieces;
    run->is_saved = true;
    return EXIT_CODE_OK;
}

/* ---- light that is hardly ever met ------------------------------------------------------- */

/* What samples have not met they cannot know of: until they have met a sun some hundred times, both the picture and its
 * standard errors are too small. Cosine samples meet light from S sr with a chance of S / pi at most. */
static void warn_of_narrow_light(const reference_run *run)
{
    const double share = 0.1, least_meetings = 100;
    bool is_blind = run->plan->method == HELIO_REFERENCE_SAMPLING && run->plan->render.strategy[0] == 'c';
    double solid_angle = narrow_light_solid_angle(run->job->environment, share);
    double meetings = (double)run->info.spp * solid_angle / 3.14159265;
    if (is_blind && run->info.pieces > 0 && solid_angle > 0 && meetings < least_meetings)
        message_warning("a tenth of the light comes from %.2g sr, which %" PRIu64
                        " cosine samples meet %.2g times or less: the errors of %s are larger than they seem; "
                        "--strategy face+brdf aims at such light",
                        solid_angle, run->info.spp, meetings, run->out);
}

/* ---- the work --------------------------------------------------------------------------- */

static int create(reference_run *run, uint64_t index)
{
    helio_reference_desc desc = {
        .renderer = render_job_describe(run->job),
        .camera = run->job->camera,
        .method = run->plan->method,
        .seed = render_job_frame(run->job, index).seed,
    };
    if (run->plan->method == HELIO_REFERENCE_QUADRATURE)
        desc.tolerance = run->plan->error;
    if (helio_reference_create(run->job->context, &desc, &run->reference) != HELIO_OK)
        return message_failure("%s", helio_last_error());
    run->info = helio_reference_get_info(run->reference);
    return EXIT_CODE_OK;
}

static bool is_hopeless(const reference_run *run)
{
    return run->plan->method == HELIO_REFERENCE_SAMPLING && run->plan->error > 0 && run->info.pieces >= 2 &&
           isnan(run->error);
}

static int advance(reference_run *run)
{
    helio_reference_info info;
    if (helio_reference_advance(run->reference, on_progress, run, &info) != HELIO_OK)
        return message_failure("%s", helio_last_error());
    if (info.stopped)
        return EXIT_CODE_OK;
    run->info = info;
    run->samples += info.samples;
    run->error = helio_reference_error(run->reference);
    run->is_saved = false;
    if (is_hopeless(run))
        return message_failure("no pixel of %s shows the object, so --error has nothing to go by; give --spp or --time",
                               run->out);
    if (is_save_due(run))
        save(run);
    return EXIT_CODE_OK;
}

static int write_picture(reference_run *run, float exposure)
{
    const render_plan *plan = &run->job->plan;
    const helio_picture_write_desc desc = {.exposure = exposure, .tonemap = plan->tonemap, .alpha = plan->alpha};
    const helio_picture picture = helio_reference_picture(run->reference);
    if (helio_picture_write(run->job->context, run->out, &picture, &desc) == HELIO_OK)
        return EXIT_CODE_OK;
    message_failure("%s%s%s", helio_last_error(), run->is_saved ? "; --resume goes on from " : "",
                    run->is_saved ? run->checkpoint : "");
    return EXIT_CODE_FAILED;
}

static void describe(const reference_run *run, char text[128])
{
    char error[32];
    describe_error(run, run->plan->method == HELIO_REFERENCE_QUADRATURE ? ", error below " : ", error ", error);
    if (run->plan->method == HELIO_REFERENCE_SAMPLING)
        snprintf(text, 128, "%" PRIu64 " spp%s", run->info.spp, error);
    else if (run->info.complete)
        snprintf(text, 128, "complete%s", error);
    else
        snprintf(text, 128, "%.0f %% of it", floor(100 * (double)run->info.pieces / (double)run->info.piece_count));
}

/* One sentence about a signal. */
static int tell_stop(const reference_run *run)
{
    char text[128];
    describe(run, text);
    if (run->info.pieces == 0)
        message_failure("stopped; nothing was written to %s", run->out);
    else
        message_failure("stopped; %s written to %s%s%s", text, run->out,
                        run->is_saved ? "; --resume goes on from " : "", run->is_saved ? run->checkpoint : "");
    return EXIT_CODE_SIGNAL + interrupt_signal();
}

static int finish(reference_run *run, float exposure)
{
    bool is_whole = is_done(run);
    if (!run->is_saved && (!is_whole || run->plan->keep_checkpoint) && run->info.pieces > 0)
        save(run);
    int code = run->info.pieces > 0 ? write_picture(run, exposure) : EXIT_CODE_OK;
    if (code != EXIT_CODE_OK)
        return code;
    warn_of_narrow_light(run);
    if (!is_whole)
        return tell_stop(run);
    if (!run->plan->keep_checkpoint)
        unlink(run->checkpoint);
    return EXIT_CODE_OK;
}

static void tell_success(const reference_run *run)
{
    char text[128], time[16];
    const uint32_t *size = run->plan->render.size;
    describe(run, text);
    progress_format_time(run->seconds * 1e3, time);
    printf("%s: %" PRIu32 "x%" PRIu32 ", %s, %s, %s\n", run->out, size[0], size[1], reference_plan_name(run->plan),
           text, time);
}

static int compute(reference_run *run, float exposure)
{
    int code = resume(run);
    while (code == EXIT_CODE_OK && interrupt_signal() == 0 && !is_done(run))
        code = advance(run);
    progress_end(&run->job->progress);
    run->seconds = elapsed_ms(run) / 1e3;
    return code == EXIT_CODE_OK ? finish(run, exposure) : code;
}

int reference_run_frame(reference_run *run, uint64_t index, const char *out, float exposure)
{
    const cli_options *options = &run->plan->render;
    *run = (reference_run){.plan = run->plan, .job = run->job, .error = (double)NAN};
    snprintf(run->out, sizeof run->out, "%s", out);
    if (snprintf(run->checkpoint, sizeof run->checkpoint, "%s.checkpoint", out) >= (int)sizeof run->checkpoint)
        return message_usage("--out takes a shorter name than %s, as .checkpoint is put behind it", out);
    int code = check_checkpoint(run);
    if (code == EXIT_CODE_OK)
        code = create(run, index);
    run->started = run->saved = machine_milliseconds();
    progress_start(&run->job->progress, 1, 0, options->quiet);
    if (code == EXIT_CODE_OK)
        code = compute(run, exposure);
    progress_end(&run->job->progress);
    helio_reference_destroy(run->reference);
    run->reference = NULL;
    if (code == EXIT_CODE_OK && !options->quiet && !json_file_is_printed(options->stats))
        tell_success(run);
    return code;
}
