/* progress.c: one line, at most five times a second. */
#include "app/progress.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

void progress_start(struct progress *progress) {
    *progress = (struct progress){.terminal = isatty(STDERR_FILENO), .drawn_at = -1};
}

static void progress_print_run(const struct simulate_progress *now) {
    const double done = now->t / now->end;
    const double left = done > 0 ? now->wall_time * (1 - done) / done : 0;
    fprintf(stderr, "t %8.3f s  %3.0f %%  %4.1f steps/event  %6d vortices  %6.2f x real time  %.0f s left", now->t,
            100 * done, (double)now->steps / (double)now->event, now->n_vortices, now->t / now->wall_time, left);
}

/* True if a line is due; on a terminal the cursor is then at its start. */
static int progress_is_due(struct progress *progress, double part, double wall_time) {
    if (progress->terminal) {
        if (wall_time - progress->drawn_at < 0.2) return 0;
        progress->drawn_at = wall_time;
        progress->drawn = 1;
        fputs("\r", stderr);
        return 1;
    }

    // add 1e-9 so that rounding does not delay a report
    const int tenth = (int)(10 * part + 1e-9);
    if (tenth <= progress->tenth) return 0;
    progress->tenth = tenth;
    return 1;
}

static void progress_end_line(const struct progress *progress) {
    fputs(progress->terminal ? "\033[K" : "\n", stderr);
}

void progress_show(const struct simulate_progress *now, void *data) {
    struct progress *const progress = data;
    if (!progress_is_due(progress, now->t / now->end, now->wall_time)) return;
    progress_print_run(now);
    progress_end_line(progress);
}

void progress_steady(const struct steady_progress *now, void *data) {
    struct progress *const progress = data;
    // few searches take more than 50 beats, so a log reports every fifth beat
    if (!progress_is_due(progress, fmin(1, now->n_beats / 50.0), now->wall_time)) return;
    fprintf(stderr, "beat %4d  speed %8.4f m/s  residual %.1e, target %.0e  %.1f s", now->n_beats, now->speed,
            now->residual, now->tolerance, now->wall_time);
    progress_end_line(progress);
}

void progress_study(const struct study_progress *now, void *data) {
    struct progress *const progress = data;
    if (!progress_is_due(progress, now->part, now->wall_time)) return;
    const double left = now->part > 0 ? now->wall_time * (1 - now->part) / now->part : 0;
    fprintf(stderr, "%d of %d members done, %d failed, %d running  %3.0f %%  %.0f s left", now->n_done, now->n_members,
            now->n_failed, now->n_running, 100 * now->part, left);
    progress_end_line(progress);
}

void progress_end(struct progress *progress) {
    if (progress->drawn) fputs("\r\033[K", stderr);
    progress->drawn = 0;
}
