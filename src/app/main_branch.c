/* main_branch.c: shoal steady --threshold and --continue: steady states along a key. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/say.h"
#include "base/parallel.h"
#include "base/text.h"
#include "case/sweep.h"
#include "study/branch.h"
#include "study/threshold.h"

/* What the searches report to. */
struct branch_teller {
    struct progress progress; /* first, as say_progress_steady expects */
    int n_warnings;
};

static void branch_note(const char *line, void *data) {
    struct branch_teller *const teller = data;
    say_progress_end(&teller->progress);
    say_line(stderr, "%s\n", line);
    say_progress_start(&teller->progress);
}

static void branch_warn(const char *line, void *data) {
    struct branch_teller *const teller = data;
    teller->n_warnings++;
    say_progress_end(&teller->progress);
    say_line(stderr, "shoal: warning: %s\n", line);
}

/* Split KEY=FROM:TO. */
static enum status read_way(struct arena *arena, const char *option, const char *text, const char **key, double *from,
                            double *to) {
    const char *const equal = strchr(text, '='), *const colon = equal ? strchr(equal, ':') : NULL;
    if (equal && colon && equal > text) {
        *key = arena_text(arena, "%.*s", (int)(equal - text), text);
        const char *const first = arena_text(arena, "%.*s", (int)(colon - equal - 1), equal + 1);
        if (text_number(first, from) && text_number(colon + 1, to) && isfinite(*from) && isfinite(*to) &&
            fabs(*from - *to) > 0) {
            return STATUS_OK;
        }
    }
    return status_fail(STATUS_CASE,
                       "%s %s: expects KEY=FROM:TO with two different numbers, such as fish[*].motion.heave=0.2:0.1",
                       option, text);
}

/* How a disturbance grows beyond the threshold. */
static const char *kind_of(const struct threshold_point *point, bool has_beat) {
    if (!has_beat) return point->period > 0 ? "flutter" : "divergence";
    return point->period <= 0 ? "real" : point->period <= 2 ? "period doubling" : "Neimark-Sacker";
}

static void print_json(const struct threshold_search *search, const struct threshold *found, const char *key,
                       const char *file) {
    const bool has_beat = found->has_beat;
    const struct threshold_point *const unstable = &found->below_above[found->below_above[1].excess > 0];
    text_print_member(stdout, "{", "file", file);
    text_print_member(stdout, ",\n  ", "key", key);
    printf(",\n  \"threshold\": %.12g,\n  \"bar\": %.3g,\n  \"by_error\": %.3g,\n  \"by_secant\": %.3g,\n",
           found->value, found->bar, found->by_error, found->by_secant);
    printf("  \"slope\": %.6g,\n  \"unstable\": \"%s\",\n", found->slope,
           found->below_above[1].excess > 0 ? "above" : "below");
    text_print_member(stdout, "  ", "kind", kind_of(unstable, has_beat));
    printf(",\n  \"period\": %.6g,\n  \"points\": [", unstable->period);
    for (int i = 0; i < search->n; i++) {
        const struct threshold_point *const point = &search->point[i];
        char value[TEXT_NUMBER_BYTES];
        text_of_number(value, point->value);
        printf("%s\n    {\"value\": %s, ", i > 0 ? "," : "", value);
        if (point->is_failure) {
            printf("\"%s\": null}", has_beat ? "multiplier" : "growth");
        } else if (has_beat) {
            printf("\"multiplier\": %.9g, \"error\": %.3g, \"period\": %.6g}", 1 + point->excess, point->error,
                   point->period);
        } else {
            printf("\"growth\": %.9g, \"period\": %.6g}", point->excess, point->period);
        }
    }
    printf("]}\n");
}

static void print_threshold(const struct threshold *found, const char *key, const char *file) {
    const bool has_beat = found->has_beat, is_one = strcmp(found->unit, "1") == 0 || !*found->unit;
    const struct threshold_point *const unstable = &found->below_above[found->below_above[1].excess > 0];
    char value[64], bar[64], period[64] = "";
    // two digits of the bar
    const int digits = (int)fmin(12, fmax(0, 1 - floor(log10(found->bar))));
    snprintf(value, sizeof value, "%.*f", digits, found->value);
    snprintf(bar, sizeof bar, "%.*f", digits, found->bar);
    if (unstable->period > 0) {
        snprintf(period, sizeof period, ", with a period of %.3g %s", unstable->period, has_beat ? "beats" : "s");
    }
    say_line(stdout, "%s\n\n  threshold: %s = %s +- %s%s%s\n", file, key, value, bar, is_one ? "" : " ",
             is_one ? "" : found->unit);
    say_line(stdout, "  unstable %s it: a disturbance %s%s (%s)\n",
             found->below_above[1].excess > 0 ? "above" : "below",
             unstable->period > 0 ? "oscillates" : "grows steadily", period, kind_of(unstable, has_beat));
    if (found->by_error > 0) {
        say_line(stdout, "  the bar is %.2g by the error of the multiplier and %.2g by the secant\n", found->by_error,
                 found->by_secant);
    } else {
        say_line(stdout, "  the bar is that of the secant only: growth rates have no error\n");
    }
}

enum status main_threshold(const struct request *request) {
    struct arena *const arena = request->arena;
    struct case_values values;
    struct threshold_options options = {.origin = request->positional,
                                        .start = request->from,
                                        .command = request->command_line,
                                        .force = request->force,
                                        .progress = request->quiet ? NULL : say_progress_steady,
                                        .note = request->quiet ? NULL : branch_note,
                                        .warn = branch_warn,
                                        .stop = main_stop_signal()};
    struct threshold_search search;
    struct threshold found;
    struct branch_teller teller = {.n_warnings = 0};
    if (request->follow) return status_fail(STATUS_CASE, "--continue and --threshold exclude each other: give one");
    if (request->trace) return status_fail(STATUS_CASE, "--trace records one search: leave out --threshold");
    TRY(read_way(arena, "--threshold", request->threshold, &options.key, &options.from, &options.to));
    TRY(main_read_case(request, &values));
    if (!request->quiet && *values.notes) say_line(stderr, "%s\n", values.notes);
    TRY(sweep_refuse(&values));
    options.folder = request->output ? request->output : arena_text(arena, "%s-threshold", values.name);
    options.data = &teller;
    TRY(parallel_start_threads(values.school.threads));
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();

    say_progress_start(&teller.progress);
    const enum status status = threshold_run(arena, &values, &options, &search, &found);
    say_progress_end(&teller.progress);
    TRY(status);

    const char *const file = arena_text(arena, "%s/study.nc", options.folder);
    if (request->json) {
        print_json(&search, &found, options.key, file);
    } else if (!request->quiet) {
        print_threshold(&found, options.key, file);
    }
    if (!request->strict || teller.n_warnings == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%s: with --strict its %d warning%s", file, teller.n_warnings,
                       teller.n_warnings > 1 ? "s are errors" : " is an error");
}

enum status main_continue(const struct request *request) {
    struct arena *const arena = request->arena;
    struct case_values values;
    struct branch_options options = {.case_path = request->positional,
                                     .n_assignments = request->n_assignments,
                                     .assignments = request->assignments,
                                     .start = request->from,
                                     .as_json = request->json,
                                     .force = request->force,
                                     .command = request->command_line,
                                     .progress = request->quiet ? NULL : say_progress_steady,
                                     .note = request->quiet ? NULL : branch_note,
                                     .stop = main_stop_signal()};
    struct branch_teller teller = {.n_warnings = 0};
    if (request->trace) return status_fail(STATUS_CASE, "--trace records one search: leave out --continue");
    if (request->strict) return status_fail(STATUS_CASE, "--strict is for one state: leave out --continue");
    TRY(read_way(arena, "--continue", request->follow, &options.key, &options.from, &options.to));
    TRY(main_read_case(request, &values));
    if (!request->quiet && *values.notes) say_line(stderr, "%s\n", values.notes);
    TRY(sweep_refuse(&values));
    options.folder = request->output ? request->output : arena_text(arena, "%s-branch", values.name);
    options.data = &teller;
    TRY(parallel_start_threads(values.school.threads));
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();

    struct say_page page;
    say_progress_start(&teller.progress);
    TRY(say_begin(&page));
    const enum status status = branch_follow(&options, page.stream);
    say_progress_end(&teller.progress);
    return say_end(&page, request->quiet && !request->json ? NULL : stdout, status);
}
