/* branch.c: pseudo-arclength continuation of steady states in one key. */
#include "study/branch.h"

#include <glob.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/mathematics.h"
#include "base/text.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "result/target.h"
#include "run/simulate.h"
#include "solver/newton.h"
#include "steady/steady_start.h"
#include "study/convergence.h"
#include "study/member_file.h"
#include "study/study_file.h"
#include "study/study_folder.h"
#include "study/threshold.h"

/* first_step: first step of the arclength. longest: largest step of the key. shortest: a step that fails although it
 * is this short ends the branch. A step grows after a correction with at most EASY evaluations and shrinks after one
 * with at least HARD. bends: a correction longer than this part of the step may lead to another branch. */
static const double first_step = 0.1, longest = 0.3, shortest = 1e-3, grows = 1.6, shrinks = 0.6, bends = 0.3;
enum { EASY = 4, HARD = 7, CORRECTIONS = 10, MOST_POINTS = 300 };

/* Increment of a difference, in a coordinate; a shorter step says less about the Jacobian than the noise. */
static const double difference = 0.01, telling = 2e-3;

/* Largest step of Newton's method, in a coordinate. */
static const double longest_correction = 0.25;

/* LOCATIONS: most points for the location of a fold. A complex multiplier turns by at least this angle, rad. */
enum { LOCATIONS = 8 };
static const double least_angle = 1e-3;

/* The walk to a threshold ends where the excess is this multiple of its error. */
static const double certain = 2;

/* A secant this short in the arclength ends the search for a threshold. */
static const double shortest_secant = 1e-4;

/* Least distance of the three states near a fold at which a finer branch is compared; the tolerance of the states would
 * show in a parabola through closer ones. */
static const double least_spacing = 0.02;

static const char fold[] = "fold"; /* a label */

/* Of the states: that of the case, or a finer one, which says what the discretisation adds to a bar. */
enum discretisation { GIVEN, HALF_INTERVAL, FINER_BODIES };

struct walk {
    const struct branch_options *options;
    const struct case_values *values;
    enum discretisation discretisation;
    struct arena *arena;
    struct branch *branch;
    int n; /* slow quantities */
    double tolerance;
    // the correction
    double *matrix;             /* Jacobian of the changes                              (n, n + 1) */
    double *last, *last_change; /* point of the last evaluation, and its change */
    bool has_last;
    double *border, *anchor; /* the correction stays in the plane through the anchor normal to the border (n + 1) */
    int n_evaluations;
};

static double distance(int n, const double *a, const double *b) {
    double square = 0;
    for (int i = 0; i < n; i++) square += (a[i] - b[i]) * (a[i] - b[i]);
    return sqrt(square);
}

static double key_at(const struct walk *walk, const double *x) {
    const struct branch_options *const options = walk->options;
    const double part = x[walk->n];
    return fabs(part - 1) <= 0 ? options->to : options->from + part * (options->to - options->from);
}

__attribute__((format(printf, 2, 3))) static void tell(const struct walk *walk, const char *format, ...) {
    if (!walk->options->note) return;
    char line[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    walk->options->note(line, walk->options->data);
}

/* "largest multiplier 0.9033 +- 0.005", "growth +0.12 s-1". */
static const char *stability_of(struct arena *arena, const struct branch *branch, const struct branch_point *point) {
    if (!branch->has_beat) return arena_text(arena, "growth %+.4g s-1", point->excess);
    return arena_text(arena, "largest multiplier %.4f +- %.2g", 1 + point->excess, point->error);
}

// ---- the case along the key

/* The case with more assignments, released with the arena. */
static enum status case_with(const struct walk *walk, struct arena *arena, struct case_values **values, int n,
                             const char *const *assignments) {
    return study_folder_parse(arena, values, walk->values->merged, walk->options->origin, n, assignments);
}

/* The case at a value of the key: as it is, with half the shedding interval, or with twice as many edges and panels of
 * the sheets of all fish. */
static enum status case_at(const struct walk *walk, struct arena *arena, struct case_values **values, double value) {
    const struct school_parameters *const school = &walk->values->school;
    struct text key = {.arena = arena}, interval = {.arena = arena};
    const char **assignments;
    int n = 0;
    NEW(arena, assignments, 2 + 2 * school->n_fish);
    if (walk->discretisation == HALF_INTERVAL) {
        text_add(&interval, "time.shedding_interval=");
        text_add_number(&interval, school->shedding_interval / 2);
        assignments[n++] = interval.text;
    }
    for (int f = 0; f < school->n_fish && walk->discretisation == FINER_BODIES; f++) {
        const struct fish_parameters *const fish = &school->fish[f];
        assignments[n++] = arena_text(arena, "fish[%d].nodes=%d", f, 2 * fish->nodes - 1);
        assignments[n++] = arena_text(arena, "fish[%d].sheet_points=%d", f, 2 * fish->sheet_points - 1);
    }
    text_add(&key, "%s=", walk->options->key);
    text_add_number(&key, value);
    assignments[n++] = key.text;
    return case_with(walk, arena, values, n, assignments);
}

/* The study of some values of the key. list: numbers, separated by commas. */
static enum status study_with(const struct walk *walk, struct arena *arena, struct case_values **study,
                              const char *list) {
    const char *const assignment =
        arena_text(arena, "sweep=[{key: \"%s\", steady: true, values: [%s]}]", walk->options->key, list);
    return case_with(walk, arena, study, 1, &assignment);
}

// ---- the correction: Newton's method for the changes in a beat and the plane

/* The change in a beat at a point, with Broyden's update of the Jacobian. */
static enum status evaluate(struct walk *walk, const double *x, double *change) {
    const int n = walk->n;
    struct case_values *values;
    ARENA(scratch, walk->arena, "an evaluation");
    TRY(case_at(walk, scratch, &values, key_at(walk, x)));
    TRY(steady_change(values, n, x, change, walk->options->stop));
    walk->n_evaluations++;

    const double way = distance(n + 1, x, walk->last), square = way * way;
    for (int i = 0; i < n && walk->has_last && way > telling; i++) {
        double missing = change[i] - walk->last_change[i];
        for (int j = 0; j <= n; j++) missing -= walk->matrix[i + j * n] * (x[j] - walk->last[j]);
        for (int j = 0; j <= n; j++) walk->matrix[i + j * n] += missing / square * (x[j] - walk->last[j]);
    }
    memcpy(walk->last, x, (size_t)(n + 1) * sizeof *x);
    memcpy(walk->last_change, change, (size_t)n * sizeof *change);
    walk->has_last = true;
    return STATUS_OK;
}

static enum status corrected_value(void *data, const double *x, double *value) {
    struct walk *const walk = data;
    const int n = walk->n;
    TRY(evaluate(walk, x, value));
    value[n] = 0;
    for (int j = 0; j <= n; j++) value[n] += walk->border[j] * (x[j] - walk->anchor[j]);
    return STATUS_OK;
}

static enum status corrected_jacobian(void *data, double *matrix) {
    const struct walk *const walk = data;
    const int n = walk->n;
    for (int j = 0; j <= n; j++) {
        memcpy(matrix + j * (n + 1), walk->matrix + j * n, (size_t)n * sizeof *matrix);
        matrix[n + j * (n + 1)] = walk->border[j];
    }
    return STATUS_OK;
}

/* Move the point x onto the branch, in the plane through x normal to a vector. Without slow quantities this is x. */
static enum status correct(struct walk *walk, double *x, const double *normal) {
    const int n = walk->n;
    double *scale;
    if (n == 0) return STATUS_OK;
    ARENA(scratch, walk->arena, "a correction");
    NEW(scratch, scale, n + 1);
    for (int j = 0; j <= n; j++) scale[j] = longest_correction;
    memcpy(walk->border, normal, (size_t)(n + 1) * sizeof *normal);
    memcpy(walk->anchor, x, (size_t)(n + 1) * sizeof *x);
    walk->n_evaluations = 0;
    const struct newton newton = {.n = n + 1,
                                  .scale = scale,
                                  .tolerance = walk->tolerance / longest_correction,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = CORRECTIONS,
                                  .value = corrected_value,
                                  .jacobian = corrected_jacobian,
                                  .data = walk};
    return newton_solve(scratch, &newton, x);
}

/* The Jacobian by differences at a point. */
static enum status find_jacobian(struct walk *walk, const double *x) {
    const int n = walk->n;
    double *at, *base, *change;
    if (n == 0) return STATUS_OK;
    ARENA(scratch, walk->arena, "a Jacobian");
    NEW(scratch, at, n + 1);
    NEW(scratch, base, n);
    NEW(scratch, change, n);
    walk->has_last = false;
    TRY(evaluate(walk, x, base));
    for (int j = 0; j <= n; j++) {
        // of the key towards TO
        memcpy(at, x, (size_t)(n + 1) * sizeof *x);
        at[j] += difference;
        walk->has_last = false;
        TRY(evaluate(walk, at, change));
        for (int i = 0; i < n; i++) walk->matrix[i + j * n] = (change[i] - base[i]) / difference;
    }
    walk->has_last = false;
    return STATUS_OK;
}

// ---- points

/* Write study.nc: the members in the order of the branch. */
static enum status write_study(const struct walk *walk) {
    const struct branch *const branch = walk->branch;
    const struct convergence_orders none = {0};
    ARENA(arena, walk->arena, "the study of a branch");
    struct text list = {.arena = arena};
    struct member_file *member;
    struct case_values *study;
    NEW(arena, member, branch->n_points);
    for (int i = 0; i < branch->n_points; i++) {
        const struct branch_point *const point = branch->point[i];
        if (i > 0) text_add(&list, ", ");
        text_add_number(&list, point->value);
        member[i] = point->member;
        member[i].number = i;
        member[i].label = point->label;
        member[i].file = point->file;
        member[i].arclength = point->arclength;
    }
    TRY(study_with(walk, arena, &study, list.text));
    return study_file_write(arena, study_folder_path(arena, walk->options->folder, "study.nc"), study, member, &none,
                            NULL, walk->options->command);
}

/* The point whose state supplies the start of number at: its neighbour on the branch. */
static const char *start_of(const struct walk *walk, int at) {
    const struct branch *const branch = walk->branch;
    if (branch->n_points == 0) return walk->options->start;
    return study_folder_path(walk->arena, walk->options->folder, branch->point[at > 0 ? at - 1 : 0]->file);
}

static double excess_of(const struct steady_point *found) {
    return found->has_beat ? hypot(found->real, found->imaginary) - 1 : found->real;
}

/* Compute the steady state at a point with its stability: x NULL: at FROM, by a search; otherwise with the slow
 * quantities held, or, of an equilibrium, from its neighbour. Write its file and insert the point as number at. */
static enum status add_point(struct walk *walk, int at, const double *x, double arclength) {
    const struct branch_options *const options = walk->options;
    struct arena *const arena = walk->arena;
    struct branch *const branch = walk->branch;
    struct branch_point *point;
    struct case_values *values;
    NEW(arena, point, 1);
    ARENA(scratch, arena, "a state");
    point->label = "";
    point->file = arena_text(arena, "state-%03d.nc", branch->n_points);
    point->arclength = arclength;
    point->value = x ? key_at(walk, x) : options->from;
    const char *const path = study_folder_path(arena, options->folder, point->file);
    struct steady_point found = {.arena = arena}, held = {.n = walk->n, .value = (double *)(uintptr_t)x};
    const bool is_held = x && walk->n > 0;
    const struct steady_options search = {.path = path,
                                          .from = is_held ? NULL : start_of(walk, at),
                                          .overwrite = true,
                                          .judges_stability = true,
                                          .hold = is_held ? &held : NULL,
                                          .found = &found,
                                          .command = options->command,
                                          .progress = options->progress,
                                          .warn = options->warn,
                                          .data = options->data,
                                          .stop = options->stop};
    TRY(case_at(walk, scratch, &values, point->value));
    enum status status = steady_run(values, &search);
    if (status == STATUS_OK && !isfinite(found.real) && branch->n_points > 0) {
        status = status_fail(STATUS_SOLVER, "%s = %.6g: the state has no mode whose growth could be followed",
                             options->key, point->value);
    } else if (status == STATUS_OK && !isfinite(found.real)) {
        status = status_fail(STATUS_CASE,
                             "%s: nothing in this case can be unstable: with a beat, a fish must be free to swim; "
                             "without a beat, the modes need pressure.span: infinite, a stream, and shedding",
                             options->option);
    }
    if (status != STATUS_OK) {
        char reason[2048];
        snprintf(reason, sizeof reason, "%s", status_message());
        unlink(path);
        return status_fail(status, "%s", reason);
    }

    TRY(member_file_read(arena, &point->member, path));
    walk->n = found.n;
    walk->tolerance = values->steady.tolerance;
    branch->has_beat = found.has_beat;
    NEW(arena, point->x, found.n + 1);
    if (x) {
        memcpy(point->x, x, (size_t)(found.n + 1) * sizeof *x);
    } else if (found.n > 0) {
        memcpy(point->x, found.value, (size_t)found.n * sizeof *found.value);
    }

    // an angle per beat, or of an equilibrium per second
    const double angle = found.has_beat ? atan2(fabs(found.imaginary), found.real) : fabs(found.imaginary);
    point->excess = excess_of(&found);
    point->error = found.error;
    point->period = angle > least_angle ? 2 * M_PI / angle : 0;
    GROW(arena, branch->point, branch->n_points + 1);
    memmove(branch->point + at + 1, branch->point + at, (size_t)(branch->n_points - at) * sizeof *branch->point);
    branch->point[at] = point;
    branch->n_points++;
    tell(walk, "%s = %.6g: %s%s", options->key, point->value, stability_of(scratch, branch, point),
         point->period <= 0 ? ""
                            : arena_text(scratch, ", period %.3g %s", point->period, branch->has_beat ? "beats" : "s"));
    return write_study(walk);
}

// ---- between the points

/* A coordinate at an arclength on the parabola through the three points of the branch that are nearest to it, or on the
 * line through two. */
static double parabola(const struct branch *branch, double arclength, int coordinate) {
    int first = 0;
    const int n = branch->n_points < 3 ? 2 : 3;
    while (first + n < branch->n_points &&
           fabs(branch->point[first + n]->arclength - arclength) < fabs(branch->point[first]->arclength - arclength)) {
        first++;
    }
    double value = 0;
    for (int i = first; i < first + n; i++) {
        const struct branch_point *const point = branch->point[i];
        double part = 1;
        for (int k = first; k < first + n; k++) {
            const double from = branch->point[k]->arclength;
            if (k != i) part *= (arclength - from) / (point->arclength - from);
        }
        value += part * point->x[coordinate];
    }
    return value;
}

/* Move x onto the branch in the plane normal to the distance of two points. */
static enum status correct_between(struct walk *walk, double *x, const struct branch_point *a,
                                   const struct branch_point *b) {
    ARENA(scratch, walk->arena, "the way between two points");
    const int size = walk->n + 1;
    double *way;
    NEW(scratch, way, size);
    for (int j = 0; j < size; j++) way[j] = (b->x[j] - a->x[j]) / distance(size, a->x, b->x);
    return correct(walk, x, way);
}

/* Add a point at an arclength between points number at and at + 1: at first on the parabola, then moved onto the
 * branch. */
static enum status add_between(struct walk *walk, int at, double arclength) {
    ARENA(scratch, walk->arena, "a point between");
    const struct branch *const branch = walk->branch;
    double *x;
    NEW(scratch, x, walk->n + 1);
    for (int j = 0; j <= walk->n; j++) x[j] = parabola(branch, arclength, j);
    TRY(correct_between(walk, x, branch->point[at], branch->point[at + 1]));
    return add_point(walk, at + 1, x, arclength);
}

/* The vertex of the parabola through three points: how far it is from the second one, and what it gains over it. */
static double vertex(const double *at, const double *value, double *gain) {
    const double before = at[1] - at[0], after = at[2] - at[1];
    const double slope_before = (value[1] - value[0]) / before, slope_after = (value[2] - value[1]) / after;
    const double bend = (slope_after - slope_before) / (before + after);
    const double slope = slope_before + bend * before, way = -slope / (2 * bend);
    *gain = slope * way / 2;
    return way;
}

/* Locate the fold near point number at, where the key comes farther than at both neighbours: by parabolas. */
static enum status locate_fold(struct walk *walk, int at) {
    struct branch *const branch = walk->branch;
    const int k = walk->n;
    const double side = branch->point[at]->x[k] - branch->point[at - 1]->x[k];
    for (int i = 0; i < LOCATIONS; i++) {
        const struct branch_point *const *const p = (const struct branch_point *const *)branch->point + at;
        const double arclength[] = {p[-1]->arclength, p[0]->arclength, p[1]->arclength};
        const double key[] = {p[-1]->x[k], p[0]->x[k], p[1]->x[k]};
        double gain;
        const double way = vertex(arclength, key, &gain);
        if (fabs(gain) <= walk->tolerance) break;
        TRY(add_between(walk, way < 0 ? at - 1 : at, arclength[1] + way));
        const int added = way < 0 ? at : at + 1, old = way < 0 ? at + 1 : at;
        at = (branch->point[added]->x[k] - branch->point[old]->x[k]) * side > 0 ? added : old;
    }
    branch->point[at]->label = fold;
    return write_study(walk);
}

// ---- thresholds

static const char *kind_of(const struct branch *branch, const struct branch_point *point) {
    if (!branch->has_beat) return point->period > 0 ? "flutter" : "divergence";
    if (point->period <= 0) return "multiplier +1";
    return M_PI - 2 * M_PI / point->period < least_angle ? "period doubling" : "Neimark-Sacker";
}

static enum status find_between(void *data, struct threshold_point *point) {
    struct walk *const walk = data;
    const struct branch *const branch = walk->branch;
    int at = 0;
    while (at < branch->n_points - 2 && branch->point[at + 1]->arclength <= point->at) at++;
    TRY(add_between(walk, at, point->at));
    point->excess = branch->point[at + 1]->excess;
    point->error = branch->point[at + 1]->error;
    return STATUS_OK;
}

static bool is_unstable(const struct branch_point *point) {
    return point->excess > 0;
}

/* The number of the first point from number at on after which the stability changes; -1: there is none. */
static int next_change(const struct branch *branch, int at) {
    for (; at + 1 < branch->n_points; at++) {
        if (is_unstable(branch->point[at]) != is_unstable(branch->point[at + 1])) return at;
    }
    return -1;
}

/* Whether the key turns back near a point: among the two points before it and the two after it. */
static bool turns_near(const struct walk *walk, int at) {
    const struct branch *const branch = walk->branch;
    const int k = walk->n, first = at > 2 ? at - 2 : 0;
    double last = 0;
    for (int i = first; i < at + 2 && i + 1 < branch->n_points; i++) {
        const double step = branch->point[i + 1]->x[k] - branch->point[i]->x[k];
        if (step * last < 0) return true;
        last = step;
    }
    return false;
}

/* How far the key of a point moves if the point is corrected to a tenth of the tolerance; where noise or a contact
 * prevents this, the tolerance. */
static enum status find_error_of_key(struct walk *walk, int at, double *error) {
    const struct branch *const branch = walk->branch;
    const int k = walk->n;
    const struct branch_point *const before = branch->point[at > 0 ? at - 1 : 0], *const point = branch->point[at];
    const struct branch_point *const after = branch->point[at + 1 < branch->n_points ? at + 1 : at];
    ARENA(scratch, walk->arena, "a finer correction");
    double *x;
    NEW(scratch, x, k + 1);
    memcpy(x, point->x, (size_t)(k + 1) * sizeof *x);
    const double tolerance = walk->tolerance;
    walk->tolerance = tolerance / 10;
    const enum status status = correct_between(walk, x, before, after);
    walk->tolerance = tolerance;
    const bool is_coarse = status == STATUS_SOLVER || status == STATUS_CONTACT;
    *error = fabs(walk->options->to - walk->options->from) * (is_coarse ? tolerance : fabs(x[k] - point->x[k]));
    return is_coarse ? STATUS_OK : status;
}

/* Whether a finer state that is not found leaves a part of the bar unknown, instead of ending the search. */
static bool is_unknown(enum status status) {
    return status != STATUS_OK && status != STATUS_STOPPED && status != STATUS_FILE;
}

/* How far a threshold moves with a finer discretisation: twice the change of the excess that the errors do not explain,
 * over the slope, because the change is half of an error of first order. NaN: no finer state. */
static enum status find_discretisation(struct walk *walk, const struct branch_point *point, double slope,
                                       double *error) {
    struct arena *const arena = walk->arena;
    const struct branch_options *const options = walk->options;
    ARENA(scratch, arena, "a finer state");
    const char *const path = study_folder_path(scratch, options->folder, "finer.nc");
    const bool has_other_nodes = walk->discretisation == FINER_BODIES && walk->n == 0;
    struct steady_point found = {.arena = scratch};
    struct case_values *values;
    enum status status = case_at(walk, scratch, &values, point->value);
    if (status == STATUS_OK) {
        // the shape of an equilibrium is of its own nodes
        status = steady_run(
            values, &(struct steady_options){
                        .path = path,
                        .from = has_other_nodes ? NULL : study_folder_path(scratch, options->folder, point->file),
                        .overwrite = true,
                        .judges_stability = true,
                        .found = &found,
                        .command = options->command,
                        .progress = options->progress,
                        .data = options->data,
                        .stop = options->stop});
        unlink(path);
    }
    if (is_unknown(status)) return STATUS_OK;
    TRY(status);
    if (!isfinite(found.real)) return STATUS_OK;
    const double change = fabs(excess_of(&found) - point->excess), noise = hypot(found.error, point->error);
    *error = change > noise ? 2 * sqrt(change * change - noise * noise) / fabs(slope) : 0;
    return STATUS_OK;
}

/* The last point before number at, or with a way of 1 the first one behind it, at a distance of at least least_spacing;
 * beyond the ends -1 or n_points. */
static int spaced_point(const struct branch *branch, int at, int way) {
    const double arclength = branch->point[at]->arclength;
    while (at >= 0 && at < branch->n_points && fabs(branch->point[at]->arclength - arclength) < least_spacing)
        at += way;
    return at;
}

/* How far a fold near point number at moves with a finer discretisation: three states of the branch are moved onto the
 * finer one, all in planes normal to the way from the first to the last. The extremes of the key on the two parabolas
 * differ by half of an error of first order. NaN: no finer states. */
static enum status find_discretisation_of_fold(struct walk *walk, int at, double *error) {
    const struct branch *const branch = walk->branch;
    const int k = walk->n, size = k + 1, behind = spaced_point(branch, at, 1);
    const int last = behind < branch->n_points ? behind : branch->n_points - 1, middle = spaced_point(branch, last, -1);
    const int first = middle < 0 ? -1 : spaced_point(branch, middle, -1);
    if (first < 0) return STATUS_OK;

    ARENA(scratch, walk->arena, "a finer fold");
    const struct branch_point *const points[] = {branch->point[first], branch->point[middle], branch->point[last]};
    double *x, along[3], key[3], finer_key[3], gain, finer_gain;
    NEW(scratch, x, size);
    walk->has_last = false;
    for (int i = 0; i < 3; i++) {
        memcpy(x, points[i]->x, (size_t)size * sizeof *x);
        const enum status status = correct_between(walk, x, points[0], points[2]);
        if (is_unknown(status)) return STATUS_OK;
        TRY(status);
        along[i] = 0;
        for (int j = 0; j < size; j++) along[i] += (points[2]->x[j] - points[0]->x[j]) * x[j];
        key[i] = points[i]->x[k];
        finer_key[i] = x[k];
    }
    vertex(along, key, &gain);
    vertex(along, finer_key, &finer_gain);
    *error = 2 * fabs(walk->options->to - walk->options->from) * fabs(finer_key[1] + finer_gain - key[1] - gain);
    return STATUS_OK;
}

/* The parts of a bar that the discretisation adds, for the threshold at point number at. Unknown ones stay NaN. */
static enum status find_discretisations(struct walk *walk, int at, struct branch_threshold *threshold) {
    const struct branch_point *const point = walk->branch->point[at];
    double *const part[] = {[HALF_INTERVAL] = &threshold->by_interval, [FINER_BODIES] = &threshold->by_bodies};
    enum status status = STATUS_OK;
    for (enum discretisation finer = HALF_INTERVAL; finer <= FINER_BODIES && status == STATUS_OK; finer++) {
        walk->discretisation = finer;
        status = point->label == fold ? find_discretisation_of_fold(walk, at, part[finer])
                                      : find_discretisation(walk, point, threshold->slope, part[finer]);
    }
    walk->discretisation = GIVEN;
    walk->has_last = false;
    return status;
}

/* Locate the change of stability between points number at and at + 1. If this fails with STATUS_SOLVER or
 * STATUS_CONTACT, the nearer of the points found so far has the label, and the threshold no bar. */
static enum status locate_threshold(struct walk *walk, int at) {
    struct branch *const branch = walk->branch;
    struct arena *const arena = walk->arena;
    struct threshold_search search = {
        .shortest = shortest_secant, .find = find_between, .data = walk, .n = branch->n_points};
    struct threshold found = {.by_error = NAN, .by_secant = NAN, .slope = NAN};
    const double from = branch->point[at]->arclength, to = branch->point[at + 1]->arclength;
    const double first_value = branch->point[at]->value, last_value = branch->point[at + 1]->value;
    NEW(arena, search.point, search.n);
    for (int i = 0; i < search.n; i++) {
        const struct branch_point *const point = branch->point[i];
        search.point[i] =
            (struct threshold_point){.at = point->arclength, .excess = point->excess, .error = point->error};
    }
    const enum status status = threshold_solve(arena, &search, at, at + 1, &found);
    if (status != STATUS_OK && status != STATUS_SOLVER && status != STATUS_CONTACT) return status;
    char reason[2048];
    snprintf(reason, sizeof reason, "%s", status_message());

    // the point of the least excess between the two ends, and the unstable one that is nearest to it
    int nearest = -1;
    for (int i = at; branch->point[i]->arclength <= to; i++) {
        if (nearest < 0 || fabs(branch->point[i]->excess) < fabs(branch->point[nearest]->excess)) nearest = i;
        if (i + 1 == branch->n_points) break;
    }
    struct branch_point *const point = branch->point[nearest];
    const struct branch_point *unstable = point;
    for (int way = 0; way <= 1 && !is_unstable(unstable); way++) {
        const int next = nearest + (way ? 1 : -1);
        if (next >= 0 && next < branch->n_points) unstable = branch->point[next];
    }

    const int k = walk->n;
    const double way = walk->options->to - walk->options->from;
    struct branch_threshold threshold = {.nearest = point,
                                         .value = point->value,
                                         .bar = NAN,
                                         .by_interval = NAN,
                                         .by_bodies = NAN,
                                         .slope = NAN,
                                         .period = unstable->period};
    point->label = turns_near(walk, nearest) && unstable->period <= 0 ? fold : kind_of(branch, unstable);
    if (status == STATUS_OK) {
        // from the arclength to the key, which turns at a fold
        const double parts[] = {found.by_error, found.by_secant}, key = parabola(branch, found.at, k);
        double bars[2];
        for (int i = 0; i < 2; i++) {
            const double less = parabola(branch, found.at - parts[i], k) - key;
            const double more = parabola(branch, found.at + parts[i], k) - key;
            bars[i] = fabs(way) * larger(fabs(less), fabs(more));
        }
        const double rate = (parabola(branch, to, k) - parabola(branch, from, k)) / (to - from) * way;
        threshold.value = walk->options->from + key * way;
        threshold.by_error = bars[0];
        threshold.by_secant = bars[1];
        TRY(find_error_of_key(walk, nearest, &threshold.by_state));
        // at a fold the excess has no slope over the key, which stands still
        if (point->label != fold) threshold.slope = found.slope / rate;
        if (walk->options->to_threshold) TRY(find_discretisations(walk, nearest, &threshold));
        const double by_interval = isnan(threshold.by_interval) ? 0 : threshold.by_interval;
        const double by_bodies = isnan(threshold.by_bodies) ? 0 : threshold.by_bodies;
        threshold.bar = threshold.by_error + threshold.by_secant + threshold.by_state + by_interval + by_bodies;
    }
    threshold.is_fold = point->label == fold;
    threshold.is_unstable_above = is_unstable(branch->point[at]) == (branch->point[at]->value > threshold.value);
    if (threshold.is_fold) {
        // all states near a fold are on one side of it
        const double before = first_value - threshold.value, after = last_value - threshold.value;
        threshold.is_unstable_above = (fabs(before) > fabs(after) ? before : after) < 0;
    }
    GROW(arena, branch->threshold, branch->n_thresholds + 1);
    branch->threshold[branch->n_thresholds++] = threshold;
    TRY(write_study(walk));
    return status == STATUS_OK ? status : status_fail(status, "%s", reason);
}

/* Locate all changes of stability, then the folds that are none: there a multiplier other than the largest passes 1. */
static enum status locate_all(struct walk *walk) {
    struct branch *const branch = walk->branch;
    const int k = walk->n;
    for (int at = next_change(branch, 0); at >= 0; at = next_change(branch, at + 1)) {
        const struct branch_point *const b = branch->point[at + 1];
        const enum status status = locate_threshold(walk, at);
        if (status == STATUS_SOLVER || status == STATUS_CONTACT) {
            tell(walk, "the change of stability near %s = %.6g has no bar: %s", walk->options->key, b->value,
                 status_message());
        } else {
            TRY(status);
        }
        while (branch->point[at + 1] != b) at++;
    }
    for (int i = 1; i + 1 < branch->n_points; i++) {
        struct branch_point *const *const p = branch->point + i;
        const bool turns = (p[0]->x[k] - p[-1]->x[k]) * (p[1]->x[k] - p[0]->x[k]) < 0;
        bool is_known = false;
        for (int j = i > 2 ? i - 2 : 0; j <= i + 2 && j < branch->n_points; j++) {
            is_known |= branch->point[j]->label == fold;
        }
        if (turns && !is_known) TRY(locate_fold(walk, i));
    }
    return STATUS_OK;
}

// ---- the branch

/* Whether the way from one point to another leaves the range of the key; the other point is then moved to the end of
 * the range. The first step may not leave it at FROM. */
static bool cut_at_end(const struct walk *walk, const double *from, double *x) {
    const int k = walk->n;
    if (x[k] < 1 && (x[k] > 0 || walk->branch->n_points == 1)) return false;
    const double end = x[k] >= 1 ? 1 : 0, part = (end - from[k]) / (x[k] - from[k]);
    for (int j = 0; j < k; j++) x[j] = from[j] + part * (x[j] - from[j]);
    x[k] = end;
    return true;
}

/* Follow the branch from its first point: predictions along the last step, corrections in the plane normal to it. */
static enum status follow(struct walk *walk) {
    struct branch *const branch = walk->branch;
    struct arena *const arena = walk->arena;
    TRY(add_point(walk, 0, NULL, 0));
    const int n = walk->n, size = n + 1;
    double *x, *predicted, *way, *along;
    NEW(arena, walk->matrix, n * size);
    NEW(arena, walk->last, size);
    NEW(arena, walk->last_change, n);
    NEW(arena, walk->border, size);
    NEW(arena, walk->anchor, size);
    NEW(arena, x, size);
    NEW(arena, predicted, size);
    NEW(arena, way, size);
    NEW(arena, along, size);
    along[n] = way[n] = 1;

    // a search leaves the tolerance, and the wake of its last steps; the branch begins where held quantities stay
    const struct branch_point *now = branch->point[0];
    TRY(find_jacobian(walk, now->x));
    TRY(correct(walk, branch->point[0]->x, along));
    if (n > 0) TRY(newton_tangent(arena, n, walk->matrix, way));

    double step = first_step;
    for (bool is_end = false; !is_end;) {
        if (branch->n_points == MOST_POINTS) {
            return status_fail(STATUS_SOLVER, "the branch does not end within %d states", MOST_POINTS);
        }

        const double length = fabs(way[n]) * step > longest ? longest / fabs(way[n]) : step;
        for (int j = 0; j < size; j++) x[j] = now->x[j] + length * way[j];
        is_end = cut_at_end(walk, now->x, x);
        memcpy(predicted, x, (size_t)size * sizeof *x);
        enum status status = correct(walk, x, is_end ? along : way);
        const int n_evaluations = walk->n_evaluations;
        if (status == STATUS_OK && !is_end && cut_at_end(walk, now->x, x)) {
            is_end = true;
            status = correct(walk, x, along);
        }

        const double moved = distance(size, now->x, x), corrected = distance(size, predicted, x);
        if (status == STATUS_OK && length > shortest && corrected > larger(bends * length, 10 * walk->tolerance)) {
            status = status_fail(STATUS_SOLVER, "the branch bends too much, or the correction leads to another one");
        }
        if (status == STATUS_OK) status = add_point(walk, branch->n_points, x, now->arclength + moved);
        if (status == STATUS_SOLVER || status == STATUS_CONTACT) {
            if (length / 2 < shortest) return status;
            tell(walk, "%s = %.6g: the step is halved, because %s", walk->options->key, key_at(walk, x),
                 status_message());
            step = length / 2;
            is_end = false;
            TRY(find_jacobian(walk, now->x));
            continue;
        }
        TRY(status);
        for (int j = 0; j < size && moved > 0; j++) way[j] = (x[j] - now->x[j]) / moved;
        now = branch->point[branch->n_points - 1];
        step = n_evaluations <= EASY ? length * grows : n_evaluations >= HARD ? length * shrinks : length;

        // beyond a threshold go on until the state has the other stability for certain
        if (walk->options->to_threshold && next_change(branch, 0) >= 0 && fabs(now->excess) > certain * now->error)
            break;
    }
    return STATUS_OK;
}

/* The first threshold of a branch that ends there, or why there is none. */
static enum status locate_first(struct walk *walk) {
    const struct branch *const branch = walk->branch;
    const int at = next_change(branch, 0);
    if (at >= 0) return locate_threshold(walk, at);
    const struct branch_point *const first = branch->point[0], *const last = branch->point[branch->n_points - 1];
    const double nearer = smaller(fabs(first->excess) - first->error, fabs(last->excess) - last->error);
    return status_fail(STATUS_SOLVER, "no threshold between the ends: the state is %s at both%s",
                       is_unstable(first) ? "unstable" : "stable",
                       fabs(first->excess - last->excess) <= 0 ? ", and the key has no effect on it"
                       : nearer <= 0 ? "; at one end 1 is within the error of the multiplier: move this end outwards"
                                     : "");
}

/* The reason of a failure, and how far the branch came. */
static enum status fail_with_branch(const struct walk *walk, enum status status) {
    const struct branch *const branch = walk->branch;
    const char *const folder = walk->options->folder;
    const int n = branch->n_points;
    ARENA(scratch, walk->arena, "a message");
    const char *reason = arena_text(scratch, "%s", status_message());
    if (n == 0) return status;
    const struct branch_point *const last = branch->point[n - 1];
    if (status == STATUS_STOPPED) {
        reason = arena_text(scratch, "stopped %s; --from %s/%s goes on from the last state",
                            simulate_stopped_by(walk->options->stop), folder, last->file);
    }
    // the errors of a case end with a line of the case
    return status_fail(status, "%s%s%d steady state%s found, %s %s = %.6g with the %s: %s/study.nc", reason,
                       strchr(reason, '\n') ? "\n" : "; ", n, n > 1 ? "s were" : " was", n > 1 ? "up to" : "at",
                       walk->options->key, last->value, stability_of(scratch, branch, last), folder);
}

// ---- the folder

/* Remove the files of an earlier branch, unless one of them is the start of this one. study: path of its study.nc */
static enum status remove_earlier(const struct walk *walk, const char *study) {
    glob_t found = {0};
    enum status status = STATUS_OK;
    const char *const pattern = study_folder_path(walk->arena, walk->options->folder, "state-[0-9][0-9][0-9].nc");
    const char *const start = walk->options->start;
    if (glob(pattern, GLOB_NOSORT, NULL, &found) != 0) found.gl_pathc = 0;
    for (size_t i = 0; i < found.gl_pathc && start && status == STATUS_OK; i++) {
        status = target_refuse_input(found.gl_pathv[i], start);
    }
    for (size_t i = 0; i < found.gl_pathc && status == STATUS_OK; i++) {
        if (target_is(found.gl_pathv[i], TARGET_NETCDF)) unlink(found.gl_pathv[i]);
    }
    globfree(&found);
    if (status == STATUS_OK && target_is(study, TARGET_NETCDF)) unlink(study);
    return status;
}

/* Refuse a key that does not vary continuously, a case without a steady state or without its stability at either end,
 * and a start that is no steady state: before a folder is created, or an earlier branch removed. */
static enum status refuse(struct walk *walk) {
    const struct branch_options *const options = walk->options;
    ARENA(scratch, walk->arena, "the ends");
    struct case_values *values, *from, *to;
    struct text list = {.arena = scratch};
    text_add_number(&list, options->from);
    text_add(&list, ", ");
    text_add_number(&list, options->to);
    const enum status status = study_with(walk, scratch, &values, list.text);
    if (status == STATUS_CASE) {
        // the message on one end of the way, where it has one, names the key as the user did
        TRY(case_at(walk, scratch, &from, options->from));
        TRY(case_at(walk, scratch, &to, options->to));
    }
    TRY(status);
    const struct sweep_key *const key = &values->sweep[0].key[0];
    const enum key_type type = case_table_row(key->row)->type;
    walk->branch->unit = arena_text(walk->arena, "%s", key->unit);
    if (type != REAL && type != DURATION) {
        return status_fail(STATUS_CASE,
                           "%s: %s is %s, which has no values in between: compare its values in a study, with "
                           "`steady: true` on the axis",
                           options->option, options->key, type == INTEGER ? "an integer" : "not a number");
    }
    if (walk->values->steady.multipliers == NO) {
        return status_fail(STATUS_CASE, "%s needs the multipliers: set steady.multipliers to true", options->option);
    }
    TRY(case_at(walk, scratch, &to, options->to));
    TRY(steady_refuse(to));
    TRY(case_at(walk, scratch, &from, options->from));
    TRY(steady_refuse(from));
    struct fish_parameters *fish;
    return options->start ? steady_start_read(scratch, options->start, &from->school, &fish) : STATUS_OK;
}

enum status branch_follow(struct arena *arena, const struct case_values *values, const struct branch_options *options,
                          struct branch **branch) {
    struct walk *walk;
    NEW(arena, walk, 1);
    NEW(arena, *branch, 1);
    *walk = (struct walk){.options = options, .values = values, .arena = arena, .branch = *branch};
    TRY(refuse(walk));

    // another call may be writing its branch into this folder
    const char *const study = study_folder_path(arena, options->folder, "study.nc");
    struct durable_claim claim;
    if (access(study, F_OK) == 0 && !options->force) {
        return status_fail(STATUS_FILE, "%s exists: replace it with --force, or choose another folder with -o", study);
    }
    TRY(study_folder_create(options->folder));
    TRY(durable_claim_take(&claim, study));
    enum status status = remove_earlier(walk, study);
    if (status == STATUS_OK) status = follow(walk);
    if (status == STATUS_OK) status = options->to_threshold ? locate_first(walk) : locate_all(walk);
    if (status != STATUS_OK) fail_with_branch(walk, status);
    durable_claim_release(&claim);
    return status;
}
