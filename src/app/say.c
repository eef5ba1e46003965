/* say.c: see say.h. */
#define _DEFAULT_SOURCE  // winsize
#include "app/say.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/text.h"

void say_line(FILE *stream, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (length < 0) return;

    // without memory for the whole line print the beginning
    char beginning[1024], *const line = malloc((size_t)length + 1);
    va_start(arguments, format);
    vsnprintf(line ? line : beginning, line ? (size_t)length + 1 : sizeof beginning, format, arguments);
    va_end(arguments);
    text_print_clean(stream, line ? line : beginning);
    if (!line && (size_t)length >= sizeof beginning) fputc('\n', stream);
    free(line);
}

enum status say_begin(struct say_page *page) {
    *page = (struct say_page){0};
    page->stream = open_memstream(&page->text, &page->n);
    return page->stream ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: text to print");
}

enum status say_end(struct say_page *page, FILE *stream, enum status status) {
    const bool failed = fclose(page->stream) != 0;
    if (page->text && stream) text_print_clean(stream, page->text);
    free(page->text);
    *page = (struct say_page){0};
    return status == STATUS_OK && failed ? status_fail(STATUS_MEMORY, "out of memory: text to print") : status;
}

// ---- one line, at most five times a second

enum { PART_BYTES = 48 };

void say_progress_start(struct progress *progress) {
    *progress = (struct progress){.terminal = isatty(STDERR_FILENO), .drawn_at = -1};
}

/* Print the parts of a line, beginning with the most important one: in a log all of them, on a terminal as many as fit
 * into its width, without the last column, where some terminals begin a new line. */
static void progress_print(struct progress *progress, int n, char part[][PART_BYTES]) {
    struct winsize size;
    const int columns = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
    const int width = progress->terminal ? columns - 1 : INT_MAX;
    int column = 0;
    if (progress->terminal) fputc('\r', stderr);

    for (int i = 0; i < n; i++) {
        const int length = (int)strlen(part[i]), gap = i > 0 ? 2 : 0;
        if (i > 0 && column + gap + length > width) break;
        fprintf(stderr, "%*s%.*s", gap, "", width, part[i]);
        column += gap + length;
    }

    fputs(progress->terminal ? "\033[K" : "\n", stderr);
}

/* True if a line is due. */
static bool progress_is_due(struct progress *progress, double part, double wall_time) {
    if (progress->terminal) {
        if (wall_time - progress->drawn_at < 0.2) return 0;
        progress->drawn_at = wall_time;
        progress->drawn = 1;
        return 1;
    }

    // add 1e-9 so that rounding does not delay a report
    const int tenth = (int)(10 * part + 1e-9);
    if (tenth <= progress->tenth) return 0;
    progress->tenth = tenth;
    return 1;
}

void say_progress_run(const struct simulate_progress *now, void *data) {
    struct progress *const progress = data;
    const double done = now->t / now->end;
    if (!progress_is_due(progress, done, now->wall_time)) return;
    char part[6][PART_BYTES];
    snprintf(part[0], PART_BYTES, "t %8.3f s", now->t);
    snprintf(part[1], PART_BYTES, "%3.0f %%", 100 * done);
    snprintf(part[2], PART_BYTES, "%.0f s left", done > 0 ? now->wall_time * (1 - done) / done : 0);
    snprintf(part[3], PART_BYTES, "%6.2f x real time", now->t / now->wall_time);
    snprintf(part[4], PART_BYTES, "%4.1f steps/event", (double)now->steps / fmax(1, (double)now->event));
    snprintf(part[5], PART_BYTES, "%6d vortices", now->n_vortices);
    progress_print(progress, 6, part);
}

void say_progress_steady(const struct steady_progress *now, void *data) {
    struct progress *const progress = data;
    // few searches take more than 50 beats, so a log reports every fifth beat
    if (!progress_is_due(progress, fmin(1, now->n_beats / 50.0), now->wall_time)) return;
    char part[4][PART_BYTES];
    snprintf(part[0], PART_BYTES, "beat %4d", now->n_beats);
    snprintf(part[1], PART_BYTES, "residual %.1e, target %.0e", now->residual, now->tolerance);
    snprintf(part[2], PART_BYTES, "%.1f s", now->wall_time);
    snprintf(part[3], PART_BYTES, "speed %8.4f m/s", now->speed);
    progress_print(progress, 4, part);
}

void say_progress_study(const struct study_progress *now, void *data) {
    struct progress *const progress = data;
    if (progress->terminal && (now->checked ? now->n_checked == now->n_members : now->n_running == 0)) {
        say_progress_end(progress);  // a report follows, or the members run
        return;
    }
    if (progress->checked != now->checked) progress->tenth = 0;
    progress->checked = now->checked;
    if (!progress_is_due(progress, now->part, now->wall_time)) return;
    char part[5][PART_BYTES];
    if (now->checked) {
        snprintf(part[0], PART_BYTES, "%d of %d members %s", now->n_checked, now->n_members, now->checked);
        progress_print(progress, 1, part);
        return;
    }
    snprintf(part[0], PART_BYTES, "%d of %d members done", now->n_done, now->n_members);
    snprintf(part[1], PART_BYTES, "%3.0f %%", 100 * now->part);
    snprintf(part[2], PART_BYTES, "%.0f s left", now->part > 0 ? now->wall_time * (1 - now->part) / now->part : 0);
    snprintf(part[3], PART_BYTES, "%d failed", now->n_failed);
    snprintf(part[4], PART_BYTES, "%d running", now->n_running);
    progress_print(progress, 5, part);
}

void say_progress_end(struct progress *progress) {
    if (progress->drawn) fputs("\r\033[K", stderr);
    progress->drawn = 0;
    progress->drawn_at = -1;
}
