/* branch.c: pseudo-arclength continuation of steady states in one key. */
#include "study/branch.h"

#include <glob.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mathematics.h"
#include "base/text.h"
#include "case/case.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "result/result_row.h"
#include "result/target.h"
#include "run/simulate.h"
#include "solver/newton.h"
#include "study/convergence.h"
#include "study/member_file.h"
#include "study/study_file.h"
#include "study/study_folder.h"

/* A point of the branch has n + 1 coordinates: the n slow quantities over their scales, and the part of the way from
 * FROM to TO that the key has come.
 *
 * first_step: first step of the arclength. longest: largest step of a slow quantity and of the key. shortest: a step
 * that fails although it is this short ends the branch. A step grows after a correction with at most EASY
 * evaluations and shrinks after one with at least HARD. */
static const double first_step = 0.1, longest = 0.3, shortest = 1e-3, grows = 1.6, shrinks = 0.6;
enum { EASY = 4, HARD = 7, CORRECTIONS = 10, MOST_POINTS = 300 };

/* Increment of a difference, in a coordinate; a shorter step says less about the Jacobian than the noise. */
static const double difference = 0.01, telling = 2e-3;

/* Largest step of Newton's method, in a coordinate. */
static const double longest_correction = 0.25;

/* LOCATIONS: most points for the location of a fold or of a loss of stability. A complex multiplier turns by at least
 * this angle, rad. */
enum { LOCATIONS = 8 };
static const double least_angle = 1e-3;

static const char fold[] = "fold"; /* a label */

struct point {
    double *x;                 /* (n + 1) */
    double arclength;          /* sum of the distances between the points up to here */
    double size, error, angle; /* largest multiplier: absolute value, its error; angle in a beat, rad */
    const char *label;         /* "": ordinary */
    const char *file;          /* name of the file in the folder */
    struct member_file member;
};

struct branch {
    const struct branch_options *options;
    struct arena *arena;
    const char *key;
    double from, to;
    int n;        /* slow quantities */
    int n_states; /* files */
    int n_points;
    struct point **point; /* in the order of the branch                              (n_points) */
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

static double key_at(const struct branch *branch, const double *x) {
    return branch->from + x[branch->n] * (branch->to - branch->from);
}

static double excess(const struct point *point) {
    return point->size - 1;
}

__attribute__((format(printf, 2, 3))) static void tell(const struct branch *branch, const char *format, ...) {
    if (!branch->options->note) return;
    char line[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    branch->options->note(line, branch->options->data);
}

// ---- the case along the key

/* The case with one value of the key, or with a sweep over the values of all points: into the arena of the values. */
static enum status read_case(const struct branch *branch, struct case_values *values, const char *assignment) {
    const struct branch_options *const options = branch->options;
    const int n = options->n_assignments;
    const char **all;
    NEW(branch->arena, all, n + 1);
    if (n > 0) memcpy(all, options->assignments, (size_t)n * sizeof *all);
    all[n] = assignment;
    return case_read(values, options->case_path, n + 1, all);
}

static enum status read_case_at(const struct branch *branch, struct case_values *values, double value) {
    return read_case(branch, values, arena_text(branch->arena, "%s=%.12g", branch->key, value));
}

// ---- the correction: Newton's method for the changes in a beat and the plane

/* The change in a beat at a point, with Broyden's update of the Jacobian. */
static enum status evaluate(struct branch *branch, const double *x, double *change) {
    const int n = branch->n;
    struct case_values values;
    TRY(read_case_at(branch, &values, key_at(branch, x)));
    const enum status status = steady_change(&values, n, x, change, branch->options->stop);
    case_free(&values);
    TRY(status);
    branch->n_evaluations++;

    const double way = distance(n + 1, x, branch->last), square = way * way;
    for (int i = 0; i < n && branch->has_last && way > telling; i++) {
        double missing = change[i] - branch->last_change[i];
        for (int j = 0; j <= n; j++) missing -= branch->matrix[i + j * n] * (x[j] - branch->last[j]);
        for (int j = 0; j <= n; j++) branch->matrix[i + j * n] += missing / square * (x[j] - branch->last[j]);
    }
    memcpy(branch->last, x, (size_t)(n + 1) * sizeof *x);
    memcpy(branch->last_change, change, (size_t)n * sizeof *change);
    branch->has_last = true;
    return STATUS_OK;
}

static enum status corrected_value(void *data, const double *x, double *value) {
    struct branch *const branch = data;
    const int n = branch->n;
    TRY(evaluate(branch, x, value));
    value[n] = 0;
    for (int j = 0; j <= n; j++) value[n] += branch->border[j] * (x[j] - branch->anchor[j]);
    return STATUS_OK;
}

static enum status corrected_jacobian(void *data, double *matrix) {
    const struct branch *const branch = data;
    const int n = branch->n;
    for (int j = 0; j <= n; j++) {
        memcpy(matrix + j * (n + 1), branch->matrix + j * n, (size_t)n * sizeof *matrix);
        matrix[n + j * (n + 1)] = branch->border[j];
    }
    return STATUS_OK;
}

/* Move the point x onto the branch, in the plane through x normal to a vector. */
static enum status correct(struct branch *branch, double *x, const double *normal) {
    const int n = branch->n;
    double *scale;
    ARENA(scratch, branch->arena, "a correction");
    NEW(scratch, scale, n + 1);
    for (int j = 0; j <= n; j++) scale[j] = longest_correction;
    memcpy(branch->border, normal, (size_t)(n + 1) * sizeof *normal);
    memcpy(branch->anchor, x, (size_t)(n + 1) * sizeof *x);
    branch->n_evaluations = 0;
    const struct newton newton = {.n = n + 1,
                                  .scale = scale,
                                  .tolerance = branch->tolerance / longest_correction,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = CORRECTIONS,
                                  .value = corrected_value,
                                  .jacobian = corrected_jacobian,
                                  .data = branch};
    return newton_solve(scratch, &newton, x);
}

/* The Jacobian by differences at a point. */
static enum status find_jacobian(struct branch *branch, const double *x) {
    const int n = branch->n;
    ARENA(scratch, branch->arena, "a Jacobian");
    double *at, *base, *change;
    NEW(scratch, at, n + 1);
    NEW(scratch, base, n);
    NEW(scratch, change, n);
    branch->has_last = false;
    TRY(evaluate(branch, x, base));
    for (int j = 0; j <= n; j++) {
        // of the key towards TO
        memcpy(at, x, (size_t)(n + 1) * sizeof *x);
        at[j] += difference;
        branch->has_last = false;
        TRY(evaluate(branch, at, change));
        for (int i = 0; i < n; i++) branch->matrix[i + j * n] = (change[i] - base[i]) / difference;
    }
    branch->has_last = false;
    return STATUS_OK;
}

// ---- points

/* Write study.nc: the members in the order of the branch. */
static enum status write_study(const struct branch *branch) {
    ARENA(arena, branch->arena, "the study of a branch");
    struct text list = {.arena = arena};
    struct member_file *member;
    NEW(arena, member, branch->n_points);
    text_add(&list, "sweep=[{key: \"%s\", steady: true, values: [", branch->key);
    for (int i = 0; i < branch->n_points; i++) {
        const struct point *const point = branch->point[i];
        text_add(&list, "%s%.12g", i > 0 ? ", " : "", key_at(branch, point->x));
        member[i] = point->member;
        member[i].number = i;
        member[i].label = point->label;
        member[i].file = point->file;
        member[i].arclength = point->arclength;
    }
    text_add(&list, "]}]");
    struct case_values study;
    struct convergence_orders orders;
    TRY(read_case(branch, &study, list.text));
    convergence_orders_create(arena, &orders, &study, member);
    const enum status status = study_file_write(arena, study_folder_path(arena, branch->options->folder, "study.nc"),
                                                &study, member, &orders, NULL, branch->options->command);
    case_free(&study);
    return status;
}

/* Compute the steady state at a point, from a search (x NULL) or held, with its multipliers, write its file, and insert
 * the point into the branch as number at. */
static enum status add_point(struct branch *branch, int at, const double *x) {
    const struct branch_options *const options = branch->options;
    struct point *point;
    struct case_values values;
    NEW(branch->arena, point, 1);
    point->label = "";
    point->file = arena_text(branch->arena, "state-%03d.nc", branch->n_states);
    const char *const path = study_folder_path(branch->arena, options->folder, point->file);
    struct steady_point found = {.arena = branch->arena}, held = {.n = branch->n, .value = (double *)(uintptr_t)x};
    TRY(read_case_at(branch, &values, x ? key_at(branch, x) : branch->from));
    const struct steady_options search = {.path = path,
                                          .from = x ? NULL : options->start,
                                          .overwrite = true,
                                          .judges_stability = true,
                                          .hold = x ? &held : NULL,
                                          .found = &found,
                                          .command = options->command,
                                          .progress = options->progress,
                                          .data = options->data,
                                          .stop = options->stop};
    const bool has_multipliers = values.steady.multipliers != NO;
    branch->tolerance = values.steady.tolerance;
    const enum status status = !has_multipliers
                                   ? status_fail(STATUS_CASE,
                                                 "a branch needs the multipliers: set steady.multipliers to "
                                                 "true")
                                   : steady_run(&values, &search);
    case_free(&values);
    if (status != STATUS_OK) {
        unlink(path);
        return status;
    }
    if (found.n == 0) {
        unlink(path);
        return status_fail(STATUS_CASE,
                           "the steady state of this case has no slow quantities, and so no multipliers: all fish are "
                           "held, or the bodies have no beat");
    }

    TRY(member_file_read(branch->arena, &point->member, path));
    branch->n = found.n;
    NEW(branch->arena, point->x, found.n + 1);
    if (!x) {
        memcpy(point->x, found.value, (size_t)found.n * sizeof *found.value);
    } else {
        memcpy(point->x, x, (size_t)(found.n + 1) * sizeof *x);
    }
    point->size = hypot(found.real, found.imaginary);
    point->error = found.error;
    point->angle = atan2(fabs(found.imaginary), found.real);
    branch->n_states++;
    GROW(branch->arena, branch->point, branch->n_points + 1);
    memmove(branch->point + at + 1, branch->point + at, (size_t)(branch->n_points - at) * sizeof *branch->point);
    branch->point[at] = point;
    branch->n_points++;
    for (int i = at; i < branch->n_points; i++) {
        struct point *const *const p = branch->point + i;
        p[0]->arclength = i == 0 ? 0 : p[-1]->arclength + distance(branch->n + 1, p[-1]->x, p[0]->x);
    }

    char period[64] = "";
    if (point->angle > least_angle) snprintf(period, sizeof period, ", period %.3g beats", 2 * M_PI / point->angle);
    tell(branch, "%s = %.6g: largest multiplier %.4f +- %.2g%s", branch->key, key_at(branch, point->x), point->size,
         point->error, period);
    return write_study(branch);
}

// ---- folds and losses of stability

/* What the crossing of the multiplier is called. */
static const char *crossing_of(const struct point *point) {
    if (point->angle < least_angle) return "multiplier +1";
    return M_PI - point->angle < least_angle ? "period doubling" : "Neimark-Sacker";
}

/* Add a point at an arclength between points number at and at + 1: at first on the parabola through these and a
 * neighbour, then moved onto the branch in the plane normal to their distance. */
static enum status add_between(struct branch *branch, int at, double arclength) {
    ARENA(scratch, branch->arena, "a point between");
    const int size = branch->n + 1, others = branch->n_points - 3;
    const int first = at < others ? at : others > 0 ? others : 0, n = branch->n_points < 3 ? 2 : 3;
    const struct point *const a = branch->point[at], *const b = branch->point[at + 1];
    double *x, *side;
    NEW(scratch, x, size);
    NEW(scratch, side, size);
    for (int i = first; i < first + n; i++) {
        double part = 1;
        for (int k = first; k < first + n; k++) {
            const double from = branch->point[k]->arclength;
            if (k != i) part *= (arclength - from) / (branch->point[i]->arclength - from);
        }
        for (int j = 0; j < size; j++) x[j] += part * branch->point[i]->x[j];
    }
    for (int j = 0; j < size; j++) side[j] = (b->x[j] - a->x[j]) / distance(size, a->x, b->x);
    TRY(correct(branch, x, side));
    return add_point(branch, at + 1, x);
}

/* Locate the fold near point number at, where the key comes farther than at both neighbours: by parabolas. */
static enum status locate_fold(struct branch *branch, int at) {
    const int k = branch->n;
    const double side = branch->point[at]->x[k] - branch->point[at - 1]->x[k];
    for (int i = 0; i < LOCATIONS; i++) {
        const struct point *const a = branch->point[at - 1], *const b = branch->point[at],
                                  *const c = branch->point[at + 1];
        const double before = b->arclength - a->arclength, after = c->arclength - b->arclength;
        const double slope_before = (b->x[k] - a->x[k]) / before, slope_after = (c->x[k] - b->x[k]) / after;

        // the vertex of the parabola, from b, and what the key gains up to there
        const double bend = (slope_after - slope_before) / (before + after);
        const double slope = slope_before + bend * before, way = -slope / (2 * bend);
        if (fabs(slope * way / 2) <= branch->tolerance) break;
        TRY(add_between(branch, way < 0 ? at - 1 : at, b->arclength + way));
        const int added = way < 0 ? at : at + 1, old = way < 0 ? at + 1 : at;
        at = (branch->point[added]->x[k] - branch->point[old]->x[k]) * side > 0 ? added : old;
    }
    branch->point[at]->label = fold;
    return write_study(branch);
}

/* Locate the crossing of 1 by the largest multiplier between points number at and at + 1: by secants, with half of the
 * weight of an end that stays twice (Illinois). */
static enum status locate_crossing(struct branch *branch, int at) {
    double low = excess(branch->point[at]), high = excess(branch->point[at + 1]);
    int stays = 0, crossing = -1;
    for (int i = 0; i < LOCATIONS && crossing < 0; i++) {
        const struct point *const a = branch->point[at], *const b = branch->point[at + 1];
        if (fabs(b->x[branch->n] - a->x[branch->n]) <= branch->tolerance) break;
        const double part = fmin(fmax(low / (low - high), 0.05), 0.95);
        TRY(add_between(branch, at, a->arclength + part * (b->arclength - a->arclength)));
        const struct point *const now = branch->point[at + 1];
        if (fabs(excess(now)) <= now->error / 4) crossing = at + 1;
        const bool is_before = excess(now) * excess(a) > 0;
        if (is_before) {
            at++;
            low = excess(now);
            if (stays > 0) high /= 2;
        } else {
            high = excess(now);
            if (stays < 0) low /= 2;
        }
        stays = is_before ? 1 : -1;
    }

    // the end that is nearer
    if (crossing < 0) crossing = fabs(excess(branch->point[at])) < fabs(excess(branch->point[at + 1])) ? at : at + 1;
    branch->point[crossing]->label = crossing_of(branch->point[crossing]);
    return write_study(branch);
}

/* Locate all folds, then all crossings of 1. At a fold a real multiplier is 1, within its error. */
static enum status locate_all(struct branch *branch) {
    const int k = branch->n;
    for (int i = 1; i + 1 < branch->n_points; i++) {
        struct point *const *const p = branch->point + i;
        const bool is_fold = (p[0]->x[k] - p[-1]->x[k]) * (p[1]->x[k] - p[0]->x[k]) < 0;
        bool is_known = false;
        for (int j = i - 1; j <= i + 1; j++) is_known |= branch->point[j]->label == fold;
        if (is_fold && !is_known) TRY(locate_fold(branch, i));
    }
    for (int i = 0; i + 1 < branch->n_points; i++) {
        const struct point *const a = branch->point[i], *const b = branch->point[i + 1];
        bool is_near = false;
        for (int j = i - 1; j <= i + 2; j++) {
            is_near |= j >= 0 && j < branch->n_points && branch->point[j]->label == fold;
        }
        const bool is_real = fmin(a->angle, b->angle) < least_angle;
        if (!(excess(a) * excess(b) < 0) || (is_near && is_real)) continue;
        const int n_before = branch->n_points;
        TRY(locate_crossing(branch, i));
        i += branch->n_points - n_before;
    }
    return STATUS_OK;
}

// ---- the branch

/* Whether the way from one point to another leaves the range of the key; the other point is then moved to the end of
 * the range. The first step may not leave it at FROM. */
static bool cut_at_end(const struct branch *branch, const double *from, double *x) {
    const int k = branch->n;
    if (x[k] < 1 && (x[k] > 0 || branch->n_points == 1)) return false;
    const double end = x[k] >= 1 ? 1 : 0, part = (end - from[k]) / (x[k] - from[k]);
    for (int j = 0; j < k; j++) x[j] = from[j] + part * (x[j] - from[j]);
    x[k] = end;
    return true;
}

/* Follow the branch from its first point: predictions along the last step, corrections in the plane normal to it. */
static enum status follow(struct branch *branch) {
    TRY(add_point(branch, 0, NULL));
    const int n = branch->n, size = n + 1;
    double *x, *way, *along;
    NEW(branch->arena, branch->matrix, n * size);
    NEW(branch->arena, branch->last, size);
    NEW(branch->arena, branch->last_change, n);
    NEW(branch->arena, branch->border, size);
    NEW(branch->arena, branch->anchor, size);
    NEW(branch->arena, x, size);
    NEW(branch->arena, way, size);
    NEW(branch->arena, along, size);
    along[n] = way[n] = 1;

    // a search leaves the tolerance, and the wake of its last steps; the branch begins where held quantities stay
    const struct point *now = branch->point[0];
    TRY(find_jacobian(branch, now->x));
    TRY(correct(branch, branch->point[0]->x, along));
    TRY(newton_tangent(branch->arena, n, branch->matrix, way));

    double step = first_step;
    for (bool is_end = false; !is_end;) {
        if (branch->n_points == MOST_POINTS) {
            return status_fail(STATUS_SOLVER, "the branch does not end within %d states", MOST_POINTS);
        }

        // no coordinate moves too far
        double most = 0;
        for (int j = 0; j < size; j++) most = larger(most, fabs(way[j]));
        const double length = fmin(step, longest / most);
        for (int j = 0; j < size; j++) x[j] = now->x[j] + length * way[j];
        is_end = cut_at_end(branch, now->x, x);
        enum status status = correct(branch, x, is_end ? along : way);
        const int n_evaluations = branch->n_evaluations;
        if (status == STATUS_OK && !is_end && cut_at_end(branch, now->x, x)) {
            is_end = true;
            status = correct(branch, x, along);
        }

        // a correction that is longer than the step leads to another branch
        if (status == STATUS_OK && distance(size, now->x, x) > 2 * length) {
            status = status_fail(STATUS_SOLVER, "the correction leads away from the branch");
        }
        if (status == STATUS_OK) status = add_point(branch, branch->n_points, x);
        if (status == STATUS_SOLVER || status == STATUS_CONTACT) {
            if (length / 2 < shortest) return status;
            tell(branch, "%s = %.6g: the step is halved, because %s", branch->key, key_at(branch, x), status_message());
            step = length / 2;
            is_end = false;
            TRY(find_jacobian(branch, now->x));
            continue;
        }
        TRY(status);
        const struct point *const next = branch->point[branch->n_points - 1];
        const double moved = distance(size, now->x, next->x);
        for (int j = 0; j < size && moved > 0; j++) way[j] = (next->x[j] - now->x[j]) / moved;
        now = next;
        step = n_evaluations <= EASY ? length * grows : n_evaluations >= HARD ? length * shrinks : length;
    }
    return STATUS_OK;
}

/* The reason of a failure, and how far the branch came. */
static enum status fail_with_branch(const struct branch *branch, enum status status) {
    char reason[2048];
    snprintf(reason, sizeof reason, "%s", status_message());
    if (branch->n_points == 0) return status_fail(status, "%s", reason);
    if (status == STATUS_STOPPED) {
        snprintf(reason, sizeof reason, "stopped %s", simulate_stopped_by(branch->options->stop));
    }
    const struct point *const last = branch->point[branch->n_points - 1];
    const int n = branch->n_points;
    return status_fail(
        status, "%s; %d steady state%s found, %s %s = %.6g with the largest multiplier %.4f +- %.2g: %s/study.nc",
        reason, n, n > 1 ? "s were" : " was", n > 1 ? "up to" : "at", branch->key, key_at(branch, last->x), last->size,
        last->error, branch->options->folder);
}

// ---- the report

static void print_table(const struct branch *branch, FILE *stream) {
    const char *const dot = strrchr(branch->key, '.');
    const int n_fish = branch->point[0]->member.n_fish;
    fprintf(stream, "%12s  %10s", dot ? dot + 1 : branch->key, "speed m/s");
    if (n_fish > 1) fprintf(stream, "  %21s", "place of the last, m");
    fprintf(stream, "  %20s  %9s  %s\n", "largest multiplier", "period", "");
    for (int i = 0; i < branch->n_points; i++) {
        const struct point *const point = branch->point[i];
        const int place = member_file_quantity_number("steady_place");
        fprintf(stream, "%12.6g  %10.5g", key_at(branch, point->x),
                member_file_number(&point->member, "steady_speed", 0));
        if (n_fish > 1) {
            fprintf(stream, "  %10.4f %10.4f", member_file_value(&point->member, place, n_fish - 1, 0),
                    member_file_value(&point->member, place, n_fish - 1, 1));
        }
        fprintf(stream, "  %9.4f +- %7.2g", point->size, point->error);
        if (point->angle > least_angle)
            fprintf(stream, "  %9.3g", 2 * M_PI / point->angle);
        else
            fprintf(stream, "  %9s", "-");
        fprintf(stream, "  %s%s%s\n", steady_verdict(point->size, point->error), *point->label ? ", " : "",
                point->label);
    }
}

static void print_json(const struct branch *branch, FILE *stream) {
    text_print_member(stream, "{", "key", branch->key);
    fprintf(stream, ", \"points\": [");
    for (int i = 0; i < branch->n_points; i++) {
        const struct point *const point = branch->point[i];
        fprintf(stream,
                "%s\n  {\"value\": %.12g, \"arclength\": %.9g, \"multiplier\": %.9g, \"error\": %.3g, \"angle\": %.6g",
                i > 0 ? "," : "", key_at(branch, point->x), point->arclength, point->size, point->error, point->angle);
        text_print_member(stream, ", ", "label", point->label);
        text_print_member(stream, ", ", "file", point->file);
        fprintf(stream, "}");
    }
    fprintf(stream, "]}\n");
}

// ---- the folder

/* Remove the files of an earlier branch. study: path of its study.nc */
static void remove_earlier(const struct branch *branch, const char *study) {
    glob_t found;
    const char *const pattern = study_folder_path(branch->arena, branch->options->folder, "state-[0-9][0-9][0-9].nc");
    if (glob(pattern, GLOB_NOSORT, NULL, &found) == 0) {
        for (size_t i = 0; i < found.gl_pathc; i++) {
            if (target_is(found.gl_pathv[i], TARGET_NETCDF)) unlink(found.gl_pathv[i]);
        }
        globfree(&found);
    }
    if (target_is(study, TARGET_NETCDF)) unlink(study);
}

enum status branch_follow(const struct branch_options *options, FILE *stream) {
    ARENA(arena, NULL, "a branch");
    struct branch *branch;
    NEW(arena, branch, 1);
    branch->options = options;
    branch->arena = arena;
    branch->key = options->key;
    branch->from = options->from;
    branch->to = options->to;

    // a key that does not vary continuously, or a case that cannot be read, creates no folder
    struct case_values values;
    TRY(read_case(
        branch, &values,
        arena_text(arena, "sweep=[{key: \"%s\", values: [%.12g, %.12g]}]", branch->key, branch->from, branch->to)));
    const enum key_type type = case_table_row(values.sweep[0].key[0].row)->type;
    case_free(&values);
    if (type != REAL && type != DURATION) {
        return status_fail(STATUS_CASE,
                           "--continue: %s is %s, which has no values in between: compare its values in a study, with "
                           "`steady: true` on the axis",
                           branch->key, type == INTEGER ? "an integer" : "not a number");
    }
    enum status status = STATUS_OK;
    for (int end = 1; end >= 0 && status == STATUS_OK; end--) {
        TRY(read_case_at(branch, &values, end ? branch->to : branch->from));
        status = sweep_refuse(&values);
        if (status == STATUS_OK) status = steady_refuse(&values);
        case_free(&values);
    }
    TRY(status);

    // another call may be writing its branch into this folder
    const char *const study = study_folder_path(arena, options->folder, "study.nc");
    struct durable_claim claim;
    if (access(study, F_OK) == 0 && !options->force) {
        return status_fail(STATUS_FILE, "%s exists: replace the branch with --force, or choose another folder with -o",
                           study);
    }
    TRY(study_folder_create(options->folder));
    TRY(durable_claim_take(&claim, study));
    remove_earlier(branch, study);
    status = follow(branch);
    if (status == STATUS_OK) status = locate_all(branch);
    if (status != STATUS_OK) {
        status = fail_with_branch(branch, status);
    } else if (options->as_json) {
        print_json(branch, stream);
    } else {
        fprintf(stream, "%s/study.nc\n\n", options->folder);
        print_table(branch, stream);
    }
    durable_claim_release(&claim);
    return status;
}
