/* steady_formation.c: Newton's method for all slow quantities of a formation. */
#include "steady/steady_formation.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "solver/newton.h"

/* Largest change of a slow quantity in one step, in lengths and in the other scales; largest change since the start,
 * beyond which Newton's method has failed. */
static const double longest_step = 0.25, farthest = 1.5;

/* Difference increment of the Jacobian, in the scale of the quantity. */
static const double difference = 0.01;

/* BEATS: largest number of beats of an evaluation. Every beat begins with the same slow quantities, so that the wake
 * converges to the wake of these quantities; the last beat gives the value. An evaluation ends early if the changes in
 * two successive beats differ by at most settled times the change. COLUMN_BEATS: beats of a column of the Jacobian,
 * which repeat the last beats of an evaluation. */
enum { BEATS = 5, COLUMN_BEATS = 2 };
static const double settled = 0.3;

/* Shortest step that updates the Jacobian: the memory of the wake dominates the change after a shorter step. */
static const double telling_step = 0.05;

/* Evaluate the Jacobian again after SLOW_STEPS successive steps that each leave more than least_progress times the
 * change. */
enum { SLOW_STEPS = 2 };
static const double least_progress = 0.7;

/* Time step of the implicit Euler method, as a fraction of the number of beats per length of motion. */
static const double patience = 1 / 3.0;

/* All values in the scales of the quantities. */
struct formation {
    struct arena *arena;
    struct steady_problem *problem;
    double tolerance;
    double *start;      /*                                                (n_unknowns) */
    double *u, *change; /* unknowns and change of the last evaluation     (n_unknowns) */
    double *before;     /* change in the previous beat                    (n_unknowns) */
    double *held;       /* unknowns for a column of the Jacobian          (n_unknowns) */
    double *step;       /* between the last two evaluations               (n_unknowns) */
    double *made_at;    /* unknowns at the last difference Jacobian       (n_unknowns) */
    double *matrix;     /* Jacobian, owned by the problem                 (n_unknowns, n_unknowns) */
    double last_norm;   /* norm of the change before the last step */
    bool has_value, has_matrix;
    int n_slow;
    bool follows;   /* implicit Euler steps instead of Newton steps */
    int most_beats; /* beats of the whole search after which Newton's method stops */
    struct state *begun, *reached;
    struct state *late[COLUMN_BEATS]; /* states before each of the last beats */
};

static double euclidean_norm(int n, const double *value) {
    double square = 0;
    for (int i = 0; i < n; i++) square += value[i] * value[i];
    return sqrt(square);
}

// the maximum norm of to - from
static double largest_distance(int n, const double *from, const double *to) {
    double most = 0;
    for (int i = 0; i < n; i++) most = larger(most, fabs(to[i] - from[i]));
    return most;
}

// ---- evaluations

static enum status beat_from(struct formation *formation, const double *u, double *change) {
    struct steady_problem *const problem = formation->problem;
    TRY(steady_problem_put(problem, u));
    TRY(steady_problem_beat(problem));
    steady_problem_read(problem, change);
    for (int i = 0; i < problem->n_unknowns; i++) change[i] -= u[i];
    return STATUS_OK;
}

static enum status formation_value(void *data, const double *u, double *change) {
    struct formation *const formation = data;
    const struct steady_problem *const problem = formation->problem;
    const int n = problem->n_unknowns;
    const size_t bytes = (size_t)n * sizeof *u;

    // Newton's method can separate the fish until the interaction vanishes, make the fish overlap, or oscillate
    const double most = largest_distance(n, formation->start, u);
    if (!formation->follows && (most > farthest || problem->map.n_beats >= formation->most_beats)) {
        return status_fail(
            STATUS_SOLVER,
            "no formation in %d beats: Newton's method moves a fish by %.2g lengths, limit %g, or needs more than half "
            "of steady.beats: start nearer to the formation, or increase steady.beats",
            problem->map.n_beats, most, farthest);
    }

    // repeat beats with the same initial values until the wake has converged
    for (int i = 0; i < BEATS; i++) {
        // keep the states before the last COLUMN_BEATS beats
        struct state *const oldest = formation->late[0];
        memmove(formation->late, formation->late + 1, (COLUMN_BEATS - 1) * sizeof oldest);
        formation->late[COLUMN_BEATS - 1] = oldest;
        steady_map_save(formation->arena, problem->map.simulation, &formation->late[COLUMN_BEATS - 1]);
        TRY(beat_from(formation, u, change));
        const double moved = largest_distance(n, formation->before, change);
        memcpy(formation->before, change, bytes);

        // the wake at the first evaluation belongs to other values
        const int fewest = formation->has_matrix ? COLUMN_BEATS : COLUMN_BEATS + 1;
        if (i + 1 >= fewest && moved <= fmax(settled * euclidean_norm(n, change), formation->tolerance)) break;
    }

    // Broyden's update: the smallest change of the Jacobian that reproduces the last step
    for (int i = 0; i < n; i++) formation->step[i] = u[i] - formation->u[i];
    const double length = euclidean_norm(n, formation->step);
    const bool is_updated = formation->has_value && formation->has_matrix && length >= telling_step;
    for (int i = 0; i < n && is_updated; i++) {
        double missing = change[i] - formation->change[i];
        for (int j = 0; j < n; j++) missing -= formation->matrix[i + j * n] * formation->step[j];
        for (int j = 0; j < n; j++) {
            formation->matrix[i + j * n] += missing / length * (formation->step[j] / length);
        }
    }

    formation->has_value = true;
    memcpy(formation->u, u, bytes);
    memcpy(formation->change, change, bytes);
    return STATUS_OK;
}

// ---- the Jacobian

static enum status formation_jacobian(void *data, double *matrix) {
    struct formation *const formation = data;
    struct steady_problem *const problem = formation->problem;
    struct simulation *const simulation = problem->map.simulation;
    const int n = problem->n_unknowns;
    const double now = euclidean_norm(n, formation->change);

    // keep a Jacobian with progress
    formation->n_slow = now > least_progress * formation->last_norm ? formation->n_slow + 1 : 0;
    const bool is_elsewhere = largest_distance(n, formation->made_at, formation->u) > telling_step;
    const bool is_new = !formation->has_matrix || (formation->n_slow >= SLOW_STEPS && is_elsewhere);

    // each column repeats the last beats of the evaluation with an increment of one quantity
    if (is_new) {
        memcpy(formation->held, formation->u, (size_t)n * sizeof *formation->held);
        memcpy(formation->made_at, formation->u, (size_t)n * sizeof *formation->made_at);
        steady_map_save(formation->arena, simulation, &formation->reached);
        for (int j = 0; j < n; j++) {
            double *const column = formation->matrix + j * n;
            TRY(steady_map_return(simulation, formation->late[0]));
            formation->held[j] += difference;
            for (int i = 0; i < COLUMN_BEATS; i++) TRY(beat_from(formation, formation->held, column));
            formation->held[j] = formation->u[j];
            for (int i = 0; i < n; i++) column[i] = (column[i] - formation->change[i]) / difference;
        }
        formation->has_matrix = true;
        formation->n_slow = 0;
        TRY(steady_map_return(simulation, formation->reached));
    }

    // every place must change the beat
    for (int j = 0; j < n && is_new; j++) {
        const enum steady_quantity quantity = problem->unknown[j].quantity;
        if (quantity != STEADY_AHEAD && quantity != STEADY_ASIDE) continue;
        TRY(steady_reason_check(problem, euclidean_norm(n, formation->matrix + j * n)));
    }
    formation->last_norm = now;
    memcpy(matrix, formation->matrix, (size_t)n * (size_t)n * sizeof *matrix);

    // implicit Euler step of du/dn = change, n: number of beats
    for (int i = 0; i < n && formation->follows; i++) matrix[i + i * n] -= now / patience;
    return STATUS_OK;
}

// ---- the search

static enum status formation_newton(struct formation *formation) {
    const struct steady_problem *const problem = formation->problem;
    const int n = problem->n_unknowns;
    double *scale, *u;
    NEW(formation->arena, scale, n);
    NEW(formation->arena, u, n);
    for (int i = 0; i < n; i++) scale[i] = longest_step;
    steady_problem_read(problem, u);
    memcpy(formation->start, u, (size_t)n * sizeof *u);
    memcpy(formation->made_at, u, (size_t)n * sizeof *u);
    formation->has_value = false;
    const struct newton newton = {.n = n,
                                  .scale = scale,
                                  .tolerance = formation->tolerance / longest_step,
                                  .max_step = 1,
                                  .reuse = 1,
                                  .max_iterations = problem->settings->beats,
                                  .value = formation_value,
                                  .jacobian = formation_jacobian,
                                  .data = formation};

    return newton_solve(formation->arena, &newton, u);
}

enum status steady_formation_solve(struct steady_problem *problem, double tolerance) {
    struct arena *const owner = problem->map.simulation->arena;
    ARENA(arena, owner, "a formation");
    const int n = problem->n_unknowns;
    const bool is_new = !problem->jacobian;
    if (is_new) NEW(owner, problem->jacobian, (size_t)n * (size_t)n);
    struct formation formation = {
        .arena = arena, .problem = problem, .tolerance = tolerance, .matrix = problem->jacobian, .has_matrix = !is_new};
    NEW(arena, formation.start, n);
    NEW(arena, formation.u, n);
    NEW(arena, formation.change, n);
    NEW(arena, formation.before, n);
    NEW(arena, formation.held, n);
    NEW(arena, formation.step, n);
    NEW(arena, formation.made_at, n);

    struct steady_map *const map = &problem->map;
    const int most_beats = problem->settings->beats;
    formation.most_beats = (map->n_beats + most_beats) / 2;
    steady_map_save(arena, map->simulation, &formation.begun);
    enum status status = formation_newton(&formation);
    if (status != STATUS_SOLVER || formation.last_norm <= 0) return status;

    // follow the solution from the start
    TRY(steady_map_return(map->simulation, formation.begun));
    if (map->n_beats < most_beats) {
        formation.follows = true;
        formation.has_matrix = false;
        status = formation_newton(&formation);
        if (status != STATUS_SOLVER) return status;
        // the motion from the start explains more than the motion from the last iterate
        TRY(steady_map_return(map->simulation, formation.begun));
    }
    return map->n_beats < most_beats ? steady_reason_find(problem) : status;
}
