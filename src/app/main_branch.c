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
#include "result/result_row.h"
#include "study/branch.h"
#include "study/member_file.h"

/* What the searches report to. */
struct branch_teller {
    struct progress progress; /* first, as say_progress_steady expects */
    struct arena *arena;
    int n_warnings;
    char **warning; /* those that have been told                              (n_warnings) */
};

static void branch_note(const char *line, void *data) {
    struct branch_teller *const teller = data;
    say_progress_end(&teller->progress);
    say_line(stderr, "%s\n", line);
    say_progress_start(&teller->progress);
}

/* Most warnings of a state are those of its neighbours: each is told once. */
static void branch_warn(const char *line, void *data) {
    struct branch_teller *const teller = data;
    for (int i = 0; i < teller->n_warnings; i++) {
        if (strcmp(teller->warning[i], line) == 0) return;
    }
    GROW(teller->arena, teller->warning, teller->n_warnings + 1);
    teller->warning[teller->n_warnings++] = arena_text(teller->arena, "%s", line);
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

// ---- what was found

/* The value with its bar, which has two digits, and its unit. */
static const char *text_of_threshold(struct arena *arena, const struct branch *branch,
                                     const struct branch_threshold *found) {
    const int digits = found->bar > 0 ? (int)fmin(12, fmax(0, 1 - floor(log10(found->bar)))) : 6;
    const bool has_unit = *branch->unit && strcmp(branch->unit, "1") != 0;
    return arena_text(arena, "%.*f +- %.*f%s%s", digits, found->value, digits, found->bar, has_unit ? " " : "",
                      has_unit ? branch->unit : "");
}

/* ", with a period of 4.2 beats" */
static const char *period_of(struct arena *arena, const struct branch *branch, double period) {
    if (period <= 0) return "";
    return arena_text(arena, ", with a period of %.3g %s", period, branch->has_beat ? "beats" : "s");
}

static void print_threshold(struct arena *arena, const struct branch *branch, const char *key, FILE *stream) {
    const struct branch_threshold *const found = branch->threshold;
    fprintf(stream, "\n  threshold: %s = %s\n", key, text_of_threshold(arena, branch, found));
    if (found->is_fold) {
        fprintf(stream, "  a fold: the steady states of this branch end there, and an unstable branch comes back\n");
    } else {
        fprintf(stream, "  unstable %s it: a disturbance %s%s (%s)\n", found->is_unstable_above ? "above" : "below",
                found->period > 0 ? "oscillates" : "grows steadily", period_of(arena, branch, found->period),
                found->nearest->label);
    }
    fprintf(stream, "  the bar is ");
    if (found->by_error > 0) fprintf(stream, "%.3g by the error of the multiplier, ", found->by_error);
    fprintf(stream, "%.3g by the secant", found->by_secant);
    if (branch->has_beat) fprintf(stream, ", %.3g by the state", found->by_state);
    if (!isnan(found->by_interval)) fprintf(stream, ", %.3g by the interval", found->by_interval);
    if (!isnan(found->by_bodies)) fprintf(stream, ", %.3g by the nodes and sheets", found->by_bodies);
    fprintf(stream, "\n");
    if (isnan(found->by_interval + found->by_bodies)) {
        fprintf(stream,
                "  it does not say what a shorter interval or finer bodies change: repeat the command with them\n");
    }
}

static void print_table(struct arena *arena, const struct branch *branch, const char *key, FILE *stream) {
    const char *const dot = strrchr(key, '.');
    const int n_fish = branch->point[0]->member.n_fish, place = member_file_quantity_number("steady_place");
    const bool has_beat = branch->has_beat, has_places = has_beat && n_fish > 1;
    fprintf(stream, "\n%12s", dot ? dot + 1 : key);
    if (has_beat) fprintf(stream, "  %10s", "speed m/s");
    if (has_places) fprintf(stream, "  %21s", "place of the last, m");
    fprintf(stream, "  %20s  %9s\n", has_beat ? "largest multiplier" : "growth, s-1",
            has_beat ? "period" : "period, s");
    for (int i = 0; i < branch->n_points; i++) {
        const struct branch_point *const point = branch->point[i];
        fprintf(stream, "%12.6g", point->value);
        if (has_beat) fprintf(stream, "  %10.5g", member_file_number(&point->member, "steady_speed", 0));
        if (has_places) {
            fprintf(stream, "  %10.4f %10.4f", member_file_value(&point->member, place, n_fish - 1, 0),
                    member_file_value(&point->member, place, n_fish - 1, 1));
        }
        if (has_beat) {
            fprintf(stream, "  %9.4f +- %7.2g", 1 + point->excess, point->error);
        } else {
            fprintf(stream, "  %+20.4g", point->excess);
        }
        fprintf(stream, "  %9s", point->period > 0 ? arena_text(arena, "%.3g", point->period) : "-");
        fprintf(stream, "  %s%s%s\n", steady_verdict(point->excess, point->error), *point->label ? ", " : "",
                point->label);
    }

    for (int i = 0, n = 0; i < branch->n_thresholds; i++) {
        const struct branch_threshold *const found = &branch->threshold[i];
        if (isnan(found->bar)) continue;
        const char *const side = found->is_unstable_above ? ": unstable above it" : ": unstable below it";
        fprintf(stream, "%s%s at %s = %s%s%s\n", n++ == 0 ? "\n" : "", found->nearest->label, key,
                text_of_threshold(arena, branch, found), found->is_fold ? "" : side,
                period_of(arena, branch, found->period));
    }
}

static void print_json_threshold(const struct branch_threshold *found, FILE *stream) {
    fprintf(stream,
            "\"threshold\": %.12g, \"bar\": %.6g, \"by_error\": %.6g, \"by_secant\": %.6g, \"by_state\": %.6g,\n  ",
            found->value, found->bar, found->by_error, found->by_secant, found->by_state);
    if (!isnan(found->by_interval)) fprintf(stream, "\"by_interval\": %.6g, ", found->by_interval);
    if (!isnan(found->by_bodies)) fprintf(stream, "\"by_bodies\": %.6g, ", found->by_bodies);
    if (!isnan(found->slope)) fprintf(stream, "\"slope\": %.6g, ", found->slope);
    fprintf(stream, "\"unstable\": \"%s\", ", found->is_unstable_above ? "above" : "below");
    text_print_member(stream, "", "kind", found->nearest->label);
    fprintf(stream, ", \"period\": %.6g", found->period);
}

static void print_json(const struct branch *branch, const char *key, const char *file, bool to_threshold,
                       FILE *stream) {
    text_print_member(stream, "{", "file", file);
    text_print_member(stream, ",\n  ", "key", key);
    if (to_threshold) {
        fprintf(stream, ",\n  ");
        print_json_threshold(branch->threshold, stream);
    } else {
        fprintf(stream, ",\n  \"thresholds\": [");
        for (int i = 0, n = 0; i < branch->n_thresholds; i++) {
            if (isnan(branch->threshold[i].bar)) continue;
            fprintf(stream, "%s\n  {", n++ > 0 ? "," : "");
            print_json_threshold(&branch->threshold[i], stream);
            fprintf(stream, "}");
        }
        fprintf(stream, "]");
    }
    fprintf(stream, ",\n  \"points\": [");
    for (int i = 0; i < branch->n_points; i++) {
        const struct branch_point *const point = branch->point[i];
        char value[TEXT_NUMBER_BYTES];
        text_of_number(value, point->value);
        fprintf(stream, "%s\n  {\"value\": %s, \"arclength\": %.9g, \"%s\": %.9g, \"error\": %.3g, \"period\": %.6g",
                i > 0 ? "," : "", value, point->arclength, branch->has_beat ? "multiplier" : "growth",
                branch->has_beat ? 1 + point->excess : point->excess, point->error, point->period);
        text_print_member(stream, ", ", "label", point->label);
        text_print_member(stream, ", ", "file", point->file);
        fprintf(stream, "}");
    }
    fprintf(stream, "]}\n");
}

// ---- the command

enum status main_branch(const struct request *request) {
    struct arena *const arena = request->arena;
    const bool to_threshold = request->threshold;
    struct case_values values;
    struct branch_options options = {.option = to_threshold ? "--threshold" : "--continue",
                                     .to_threshold = to_threshold,
                                     .origin = request->positional,
                                     .start = request->from,
                                     .command = request->command_line,
                                     .force = request->force,
                                     .progress = request->quiet ? NULL : say_progress_steady,
                                     .note = request->quiet ? NULL : branch_note,
                                     .warn = branch_warn,
                                     .stop = main_stop_signal()};
    struct branch *branch;
    struct branch_teller teller = {.arena = arena};
    if (to_threshold && request->follow) {
        return status_fail(STATUS_CASE, "--continue and --threshold exclude each other: give one");
    }
    if (request->trace) {
        return status_fail(STATUS_CASE, "--trace records one search: leave out %s", options.option);
    }
    TRY(read_way(arena, options.option, to_threshold ? request->threshold : request->follow, &options.key,
                 &options.from, &options.to));
    TRY(main_read_case(request, &values));
    if (!request->quiet && *values.notes) say_line(stderr, "%s\n", values.notes);
    TRY(sweep_refuse(&values));
    options.folder = request->output ? request->output
                                     : arena_text(arena, "%s-%s", values.name, to_threshold ? "threshold" : "branch");
    options.data = &teller;
    TRY(parallel_start_threads(values.school.threads));
    if (request->max_wall) TRY(main_limit_wall_time(request->max_wall));
    main_catch_signals();

    say_progress_start(&teller.progress);
    const enum status status = branch_follow(arena, &values, &options, &branch);
    say_progress_end(&teller.progress);
    TRY(status);

    const char *const file = arena_text(arena, "%s/study.nc", options.folder);
    struct say_page page;
    TRY(say_begin(&page));
    if (request->json) {
        print_json(branch, options.key, file, to_threshold, page.stream);
    } else {
        fprintf(page.stream, "%s\n", file);
        (to_threshold ? print_threshold : print_table)(arena, branch, options.key, page.stream);
    }
    TRY(say_end(&page, request->quiet && !request->json ? NULL : stdout, status));
    if (!request->strict || teller.n_warnings == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%s: with --strict its %d warning%s", file, teller.n_warnings,
                       teller.n_warnings > 1 ? "s are errors" : " is an error");
}
