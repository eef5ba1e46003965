/* threshold.c: finds the value of a key at which the largest multiplier has modulus 1. */
#include "study/threshold.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/mathematics.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "run/simulate.h"
#include "study/member_file.h"
#include "study/study_file.h"
#include "study/study_folder.h"

// ---- the secants

/* The first step on the way to the other end, over the whole way: the places of a formation change with the key, and a
 * search that starts too far away fails only after steady.beats beats. Then the shortest step, and the most points. */
static const double first_step = 0.25, shortest_step = 1.0 / 64;
enum { MOST_POINTS = 60 };

/* The secants end if the last one is shorter than this part of the error by the multiplier, or of the whole way. */
static const double part_of_error = 0.25, part_of_way = 1e-4;

/* A secant steeper than this multiple of the first one may cross a jump between two branches: then bisections follow
 * until the sides are neighbours, between which the excess may still change by this part of its first change. */
static const double steep = 20, part_of_jump = 0.01;

/* A bisection also follows if one side stays so often. */
enum { MOST_STAYS = 3 };

/* Two points give a slope if their excesses differ by this multiple of the larger error. */
static const double distinct = 4;

static enum status find_point(struct arena *arena, struct threshold_search *search, double value) {
    const struct threshold_point *nearest[2] = {NULL};
    for (int i = 0; i < search->n; i++) {
        const struct threshold_point *const other = &search->point[i];
        const double away = fabs(other->value - value);
        if (other->is_failure) continue;
        if (!nearest[0] || away < fabs(nearest[0]->value - value)) {
            nearest[1] = nearest[0];
            nearest[0] = other;
        } else if (!nearest[1] || away < fabs(nearest[1]->value - value)) {
            nearest[1] = other;
        }
    }
    struct threshold_point point = {.value = value};
    const enum status status = search->find(search->data, &point, nearest);
    if (status == STATUS_SOLVER || status == STATUS_CONTACT) {
        point = (struct threshold_point){.value = value, .excess = NAN, .is_failure = true};
    } else {
        TRY(status);
    }
    GROW(arena, search->point, search->n + 1);
    search->point[search->n++] = point;
    return status;
}

/* Walk from one end to the other until the excess changes its sign; double the step after a success and halve it after
 * a failure. The last two points that were found enclose the threshold. */
static enum status find_sides(struct arena *arena, struct threshold_search *search, struct threshold_point side[2]) {
    const double way = search->to - search->from;
    double at = 0, step = first_step, failed = INFINITY;
    TRY(find_point(arena, search, search->from));
    side[0] = search->point[0];

    while (at < 1) {
        const double next = smaller(1, at + step);
        const enum status status = find_point(arena, search, next < 1 ? search->from + next * way : search->to);
        if (status == STATUS_SOLVER || status == STATUS_CONTACT) {
            failed = next;
            step = (failed - at) / 2;
            if (step < shortest_step) return status;
            continue;
        }
        TRY(status);
        at = next;
        step = smaller(2 * step, (failed - at) / 2);
        side[1] = search->point[search->n - 1];
        if ((side[0].excess > 0) != (side[1].excess > 0)) return STATUS_OK;
        side[0] = side[1];
    }

    const struct threshold_point *const first = &search->point[0];
    const double nearer = smaller(fabs(first->excess) - first->error, fabs(side[0].excess) - side[0].error);
    return status_fail(STATUS_SOLVER, "no threshold between the ends: the state is %s at both%s",
                       first->excess > 0 ? "unstable" : "stable",
                       fabs(first->excess - side[0].excess) <= 0 ? ", and the key has no effect on it"
                       : nearer <= 0 ? "; at one end 1 is within the error of the multiplier: move this end outwards"
                                     : "");
}

/* The slope of the excess near a value: from the two nearest points that differ by more than their errors. NaN: no two
 * points do. */
static double slope_near(const struct threshold_search *search, double value) {
    double slope = NAN, least = INFINITY;
    for (int i = 0; i < search->n; i++) {
        for (int j = 0; j < i; j++) {
            const struct threshold_point *const a = &search->point[i], *const b = &search->point[j];
            const double away = larger(fabs(a->value - value), fabs(b->value - value));
            const double rise = a->excess - b->excess;
            if (a->is_failure || b->is_failure || away >= least) continue;
            if (!(fabs(rise) > distinct * larger(a->error, b->error))) continue;
            least = away;
            slope = rise / (a->value - b->value);
        }
    }
    return slope;
}

enum status threshold_solve(struct arena *arena, struct threshold_search *search, struct threshold *found) {
    struct threshold_point side[2];
    TRY(find_sides(arena, search, side));

    // secants between the two sides; the weight of a side that stays twice is halved (Illinois)
    const double shortest = part_of_way * fabs(search->to - search->from);
    const double first_change = fabs(side[1].excess - side[0].excess);
    const double first_slope = first_change / fabs(side[1].value - side[0].value);
    double weight[2] = {1, 1};
    int stayed = -1, n_stays = 0;
    for (;;) {
        const int near = fabs(side[1].excess) < fabs(side[0].excess);
        const double width = side[1].value - side[0].value, change = side[1].excess - side[0].excess;
        const bool is_distinct = fabs(change) > distinct * larger(side[0].error, side[1].error);
        const bool is_steep = is_distinct && fabs(change / width) > steep * first_slope;
        const bool are_neighbours = fabs(width) <= shortest;
        if (are_neighbours && is_distinct && fabs(change) > part_of_jump * first_change) {
            return status_fail(STATUS_SOLVER,
                               "no threshold: the stability jumps between %.6g and %.6g, where the states on the two "
                               "sides are of different branches",
                               side[0].value, side[1].value);
        }

        // judge the secant without the weights
        found->value = side[near].value - side[near].excess * width / change;
        found->slope = slope_near(search, found->value);
        found->by_error = side[near].error / fabs(found->slope);
        found->by_secant = fabs(found->value - side[near].value);
        found->nearest = side[near];
        if (isnan(found->slope)) {
            return status_fail(STATUS_SOLVER,
                               "undecided: the multipliers differ by less than their errors: move the ends apart, or "
                               "reduce the errors");
        }
        const bool is_near = found->by_secant <= larger(part_of_error * found->by_error, shortest);
        if (is_near && (are_neighbours || !is_steep)) break;
        if (search->n >= MOST_POINTS) {
            return status_fail(STATUS_SOLVER, "no threshold after %d searches: the excess changes too irregularly",
                               search->n);
        }

        const double low = weight[0] * side[0].excess, high = weight[1] * side[1].excess;
        const bool bisects = is_steep || n_stays >= MOST_STAYS;
        TRY(find_point(arena, search,
                       bisects ? side[0].value + width / 2 : side[0].value - low * width / (high - low)));
        const struct threshold_point now = search->point[search->n - 1];
        const int replaced = (now.excess > 0) != (side[0].excess > 0);
        side[replaced] = now;
        weight[replaced] = 1;
        n_stays = stayed == !replaced && !bisects ? n_stays + 1 : 0;
        if (stayed == !replaced) weight[!replaced] /= 2;
        stayed = !replaced;
    }

    found->bar = found->by_error + found->by_secant;
    found->below_above[0] = side[side[0].value > side[1].value];
    found->below_above[1] = side[side[0].value < side[1].value];
    return STATUS_OK;
}

// ---- a case

struct threshold_case {
    struct arena *arena;
    const struct case_values *values;
    const struct threshold_options *options;
    struct threshold_search *search;
    bool has_beat;              /* stability by multipliers; false: by growth rates */
    struct text list;           /* values of the key, separated by commas */
    struct member_file *member; /* of every point                                                 (search->n) */
};

/* Assign the key. */
static enum status case_at(const struct threshold_case *problem, double value, struct case_values **values) {
    struct text assignment = {.arena = problem->arena};
    text_add(&assignment, "%s=", problem->options->key);
    text_add_number(&assignment, value);
    const char *const assignments[] = {assignment.text};
    return study_folder_parse(problem->arena, values, problem->values->merged, problem->options->origin, 1,
                              assignments);
}

/* The study of all points so far and of one more value. */
static enum status study_with(const struct threshold_case *problem, const char *list, struct case_values **study) {
    const char *const assignment =
        arena_text(problem->arena, "sweep=[{key: \"%s\", values: [%s], steady: true}]", problem->options->key, list);
    const char *const assignments[] = {assignment};
    return study_folder_parse(problem->arena, study, problem->values->merged, problem->options->origin, 1, assignments);
}

/* Read the largest multiplier, or the growth rate, of a result. */
static enum status read_point(struct threshold_case *problem, const char *path, struct threshold_point *point) {
    ARENA(arena, problem->arena, path);
    struct netcdf_reader reader;
    TRY(netcdf_open(arena, &reader, path));
    const struct netcdf_slice slice[] = {{"multiplier", 0, 1}, {"xy", 0, 2}, {NULL}};
    const struct netcdf_slice one[] = {{"multiplier", 0, 1}, {NULL}}, whole[] = {{NULL}};
    double frequency = 0, pair[2];
    TRY(netcdf_read_doubles(&reader, "steady_multiplier", slice, pair));
    problem->has_beat = isfinite(pair[0]);
    if (problem->has_beat) {
        TRY(netcdf_read_doubles(&reader, "steady_multiplier_error", one, &point->error));
        point->excess = hypot(pair[0], pair[1]) - 1;
        frequency = fabs(atan2(pair[1], pair[0])) / (2 * M_PI);
    } else {
        TRY(netcdf_read_doubles(&reader, "steady_growth", whole, &point->excess));
        TRY(netcdf_read_doubles(&reader, "steady_growth_frequency", whole, &frequency));
        point->error = 0;
    }
    point->period = frequency > 0 ? 1 / frequency : 0;
    if (isfinite(point->excess)) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "--threshold: nothing in this case can be unstable: with a beat, a fish must be free to swim; "
                       "without a beat, the modes need pressure.span: infinite, a stream, and shedding");
}

/* Whether the folder has the result of this search already. *is_other: a result of something else is there. */
static bool is_finished(const struct threshold_case *problem, const char *path, const struct case_values *values,
                        bool *is_other) {
    struct member_file member = {.status = ""};
    *is_other = false;
    if (access(path, F_OK) != 0) return false;
    if (member_file_read(problem->arena, &member, path) != STATUS_OK) return false;
    *is_other = strcmp(member.effective, case_show(problem->arena, values)) != 0;
    return !*is_other && member_file_is_complete(&member) && !problem->options->force;
}

/* Write study.nc with all points so far. */
static enum status write_points(const struct threshold_case *problem, int n) {
    const struct convergence_orders none = {0};
    struct case_values *study;
    TRY(study_with(problem, problem->list.text, &study));
    for (int i = 0; i < n; i++) {
        if (!problem->member[i].value)
            member_file_create_values(problem->arena, &problem->member[i], study->school.n_fish);
    }
    return study_file_write(problem->arena, study_folder_path(problem->arena, problem->options->folder, "study.nc"),
                            study, problem->member, &none, NULL, problem->options->command);
}

/* The member of a point. */
static const char *member_of(const struct threshold_case *problem, const struct threshold_point *point) {
    return study_folder_member(problem->arena, problem->options->folder, (int)(point - problem->search->point), ".nc");
}

static enum status find_state(void *data, struct threshold_point *point,
                              const struct threshold_point *const nearest[2]) {
    struct threshold_case *const problem = data;
    const struct threshold_options *const options = problem->options;
    struct arena *const arena = problem->arena;
    const int number = problem->search->n;
    const char *const path = study_folder_member(arena, options->folder, number, ".nc");
    struct case_values *values;
    bool is_other;
    TRY(case_at(problem, point->value, &values));

    // search, unless an earlier call has done so
    enum status status = STATUS_OK;
    if (!is_finished(problem, path, values, &is_other)) {
        if (is_other && !options->force) {
            return status_fail(STATUS_FILE,
                               "%s is a result of another search: choose another folder with -o, or replace the "
                               "results with --force",
                               path);
        }
        unlink(path);

        // extrapolate the start from the two nearest states
        const char *const from = nearest[0] ? member_of(problem, nearest[0]) : options->start;
        const char *const before = nearest[1] ? member_of(problem, nearest[1]) : NULL;
        const double ratio = before ? (point->value - nearest[0]->value) / (nearest[0]->value - nearest[1]->value) : 0;
        const struct steady_options search = {.path = path,
                                              .from = from,
                                              .before = before,
                                              .ratio = ratio,
                                              .overwrite = 1,
                                              .command = options->command,
                                              .progress = options->progress,
                                              .warn = options->warn,
                                              .data = options->data,
                                              .judges_stability = true,
                                              .stop = options->stop};
        status = steady_run(values, &search);
    }
    if (status == STATUS_OK) status = read_point(problem, path, point);
    if (status != STATUS_OK && status != STATUS_SOLVER && status != STATUS_CONTACT) return status;

    // a row of study.nc, also for a value without a steady state
    char reason[2048] = "";
    if (status != STATUS_OK) snprintf(reason, sizeof reason, "%s", status_message());
    GROW(arena, problem->member, number + 1);
    struct member_file *const member = &problem->member[number];
    *member = (struct member_file){.status = arena_text(arena, "failed: %s", reason), .number = number};
    if (status == STATUS_OK) TRY(member_file_read(arena, member, path));
    text_add(&problem->list, "%s", number > 0 ? ", " : "");
    text_add_number(&problem->list, point->value);
    TRY(write_points(problem, number + 1));

    if (options->note && status == STATUS_OK) {
        const char *const period =
            point->period > 0 ? arena_text(arena, ", period %.3g %s", point->period, problem->has_beat ? "beats" : "s")
                              : "";
        options->note(
            problem->has_beat
                ? arena_text(arena, "%s = %.6g: largest multiplier %.4f +- %.4f%s", options->key, point->value,
                             1 + point->excess, point->error, period)
                : arena_text(arena, "%s = %.6g: growth %+.4g s-1%s", options->key, point->value, point->excess, period),
            options->data);
    } else if (options->note) {
        options->note(arena_text(arena, "%s = %.6g: no steady state%s: %s", options->key, point->value,
                                 nearest[0] ? ", the step is halved" : "", reason),
                      options->data);
    }
    return status == STATUS_OK ? status : status_fail(status, "%s", reason);
}

/* The message of a failure, with what was found before: the points with the smallest and the largest excess. */
static enum status fail_with_points(const struct threshold_case *problem, enum status status) {
    const struct threshold_search *const search = problem->search;
    const struct threshold_options *const options = problem->options;
    char reason[2048];
    snprintf(reason, sizeof reason, "%s", status_message());
    if (status == STATUS_STOPPED) {
        snprintf(reason, sizeof reason, "stopped %s; repeat the command to continue",
                 simulate_stopped_by(options->stop));
    }

    struct text list = {.arena = problem->arena};
    int n = 0;
    for (int i = 0; i < search->n; i++) {
        const struct threshold_point *const point = &search->point[i];
        if (point->is_failure) continue;
        text_add(&list, "%s%.6g: ", n++ > 0 ? ", at " : "at ", point->value);
        if (problem->has_beat) {
            text_add(&list, "%.4f +- %.4f", 1 + point->excess, point->error);
        } else {
            text_add(&list, "%+.4g s-1", point->excess);
        }
    }
    if (n == 0) return status_fail(status, "%s", reason);
    return status_fail(status, "%s\n  found so far, %s over %s: %s (%s/study.nc)", reason,
                       problem->has_beat ? "largest multiplier" : "growth", options->key, list.text, options->folder);
}

/* Refuse a key that is not a number which varies continuously, and a case without a steady state at either end. */
static enum status refuse(const struct threshold_case *problem, const char **unit) {
    const struct threshold_options *const options = problem->options;
    struct case_values *study, *end;
    struct text list = {.arena = problem->arena};
    text_add_number(&list, options->from);
    text_add(&list, ", ");
    text_add_number(&list, options->to);
    TRY(study_with(problem, list.text, &study));
    const struct sweep_key *const key = &study->sweep[0].key[0];
    const enum key_type type = case_table_row(key->row)->type;
    *unit = key->unit;
    if (type != REAL && type != DURATION) {
        return status_fail(STATUS_CASE,
                           "--threshold: %s is %s, which has no values in between: compare its values in a study, with "
                           "`steady: true` on the axis",
                           options->key, type == INTEGER ? "an integer" : "not a number");
    }
    if (problem->values->steady.multipliers == NO) {
        return status_fail(STATUS_CASE, "--threshold needs the multipliers: set steady.multipliers to true");
    }
    TRY(case_at(problem, options->from, &end));
    TRY(steady_refuse(end));
    TRY(case_at(problem, options->to, &end));
    return steady_refuse(end);
}

enum status threshold_run(struct arena *arena, const struct case_values *values,
                          const struct threshold_options *options, struct threshold_search *search,
                          struct threshold *found) {
    struct threshold_case problem = {
        .arena = arena, .values = values, .options = options, .search = search, .list = {.arena = arena}};
    *search = (struct threshold_search){.from = options->from, .to = options->to, .find = find_state, .data = &problem};
    if (!isfinite(options->from) || !isfinite(options->to) || fabs(options->from - options->to) <= 0) {
        return status_fail(STATUS_CASE, "--threshold: FROM and TO are two different numbers");
    }
    TRY(refuse(&problem, &found->unit));
    TRY(study_folder_create(options->folder));
    const enum status status = threshold_solve(arena, search, found);
    found->has_beat = problem.has_beat;
    return status == STATUS_OK || status == STATUS_MEMORY ? status : fail_with_points(&problem, status);
}
