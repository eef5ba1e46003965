/* progress.c: one line, at most five times a second. */
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

void progress_start(struct progress *progress) {
    *progress = (struct progress){.terminal = isatty(STDERR_FILENO), .drawn_at = -1};
}

static void print_line(const struct simulate_progress *now) {
    const double done = now->t / now->end;
    const double left = done > 0 ? now->wall_time * (1 - done) / done : 0;
    fprintf(stderr, "t %8.3f s  %3.0f %%  %4.1f steps/event  %6d vortices  %6.2f x real time  %.0f s left", now->t,
            100 * done, (double)now->steps / (double)now->event, now->n_vortices, now->t / now->wall_time, left);
}

void progress_show(const struct simulate_progress *now, void *data) {
    struct progress *const progress = data;
    if (progress->terminal) {
        if (now->wall_time - progress->drawn_at < 0.2) return;
        progress->drawn_at = now->wall_time;
        progress->drawn = 1;
        fputs("\r", stderr);
        print_line(now);
        fputs("\033[K", stderr);
        return;
    }
    // a little over, so that a whole tenth is not missed by rounding
    const int tenth = (int)(10 * now->t / now->end + 1e-9);
    if (tenth <= progress->tenth) return;
    progress->tenth = tenth;
    print_line(now);
    fputs("\n", stderr);
}

void progress_end(struct progress *progress) {
    if (progress->drawn) fputs("\r\033[K", stderr);
    progress->drawn = 0;
}
