/* start.c: the section "start" shows that the equations have index 1 and that the start is consistent, for all options.
 *
 * The equations have index 1 if the matrix of the algebraic equations by the algebraic unknowns is nonsingular. Rows
 * and columns have the units of accelerations, velocities, circulations and numbers; each row, then each column, is
 * divided by the largest entry before the condition number is computed, so units do not affect the condition number.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "solver/linear.h"
#include "solver/sundials.h"
#include "verify.h"

// ---- dense matrices, row after row

static void *allocate(int n, size_t size) {
    void *const memory = calloc((size_t)n, size);
    if (!memory) abort();
    return memory;
}

static void equilibrate(int n, double *a) {
    for (int by_column = 0; by_column < 2; by_column++) {
        const int along = by_column ? n : 1, across = by_column ? 1 : n;
        for (int i = 0; i < n; i++) {
            double most = 0;
            for (int k = 0; k < n; k++) most = fmax(most, fabs(a[i * across + k * along]));
            for (int k = 0; k < n && most > 0; k++) a[i * across + k * along] /= most;
        }
    }
}

static double one_norm(int n, const double *a) {
    double norm = 0;
    for (int column = 0; column < n; column++) {
        double sum = 0;
        for (int row = 0; row < n; row++) sum += fabs(a[row * n + column]);
        norm = fmax(norm, sum);
    }
    return norm;
}

// bring the largest entry of a column, from row c on, to the diagonal in both matrices; return the entry
static double pivot(int n, int c, double *a, double *b) {
    int best = c;
    for (int row = c + 1; row < n; row++) {
        if (fabs(a[row * n + c]) > fabs(a[best * n + c])) best = row;
    }
    for (int k = 0; k < n; k++) {
        const double of_a = a[c * n + k], of_b = b[c * n + k];
        a[c * n + k] = a[best * n + k];
        b[c * n + k] = b[best * n + k];
        a[best * n + k] = of_a;
        b[best * n + k] = of_b;
    }
    return a[c * n + c];
}

// 1/(|A| |A^-1|) in the norm of column sums, 0 where A is singular: the inverse by elimination; A is overwritten
static double reciprocal_condition(int n, double *a) {
    equilibrate(n, a);
    const double norm = one_norm(n, a);
    double *const inverse = allocate(n * n, sizeof *inverse);
    for (int i = 0; i < n; i++) inverse[i * n + i] = 1;
    int singular = 0;
    for (int c = 0; c < n && !singular; c++) {
        const double diagonal = pivot(n, c, a, inverse);
        singular = diagonal == 0;
        for (int row = 0; row < n && !singular; row++) {
            const double factor = a[row * n + c] / diagonal;
            if (row == c || factor == 0) continue;
            for (int k = c; k < n; k++) a[row * n + k] -= factor * a[c * n + k];
            for (int k = 0; k < n; k++) inverse[row * n + k] -= factor * inverse[c * n + k];
        }
    }
    for (int row = 0; row < n; row++) {
        for (int k = 0; k < n && !singular; k++) inverse[row * n + k] /= a[row * n + row];
    }
    const double result = singular ? 0 : 1 / (norm * one_norm(n, inverse));
    free(inverse);
    return result;
}

// ---- one state

// a matrix of the algebraic unknowns alone
struct algebraic {
    int n;
    int *place;  // index of every unknown in the matrix, -1: differential   (n_unknowns)
    double *matrix;
};

static void set(const struct algebraic *algebraic, int row, int column, double value) {
    const int i = algebraic->place[row], j = algebraic->place[column];
    if (i >= 0 && j >= 0) algebraic->matrix[i * algebraic->n + j] = value;
}

// the rows of fish f
static void copy_rows(const struct jacobian *jacobian, int f, const struct algebraic *to) {
    const struct sparse *const own = jacobian->own[f];
    for (int column = 0; column < own->n; column++) {
        for (int64_t i = own->column_start[column]; i < own->column_start[column + 1]; i++) {
            set(to, own->first + (int)own->row_index[i], own->first + column, own->value[i]);
        }
    }
    for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
        const struct fish *const other = &jacobian->school->fish[jacobian->coupling[i].other];
        const struct coupling_block *const rows = &jacobian->coupling[i].rows;
        for (int c = 0; c < rows->n_columns; c++) {
            for (int r = 0; r < rows->n_rows; r++) {
                set(to, jacobian->school->fish[f].at.ax + r, flow_column(other, c), rows->value[c * rows->n_rows + r]);
            }
        }
    }
}

// the algebraic rows and columns of the Jacobian of a state
static double *algebraic_matrix(struct simulation *simulation, const struct residual_mode *mode, int *n) {
    const int n_unknowns = simulation->school->n_unknowns;
    double *const kind = allocate(n_unknowns, sizeof *kind);
    struct algebraic algebraic = {.place = allocate(n_unknowns, sizeof(int))};
    struct jacobian *const jacobian = jacobian_create(simulation->arena, simulation->school);
    residual_kinds(simulation->residual, mode, kind);
    for (int i = 0; i < n_unknowns; i++) algebraic.place[i] = kind[i] > 0 ? -1 : algebraic.n++;
    residual_mask(simulation->residual, jacobian);
    if (residual_jacobian(simulation->residual, mode, simulation->state->t, 0, simulation->state->y, jacobian) !=
        STATUS_OK) {
        abort();
    }
    algebraic.matrix = allocate(algebraic.n * algebraic.n, sizeof(double));
    for (int f = 0; f < simulation->school->n_fish; f++) copy_rows(jacobian, f, &algebraic);
    free(kind);
    free(algebraic.place);
    *n = algebraic.n;
    return algebraic.matrix;
}

static double condition_of(struct simulation *simulation, const struct residual_mode *mode) {
    int n;
    double *const matrix = algebraic_matrix(simulation, mode, &n);
    const double reciprocal = reciprocal_condition(n, matrix);
    free(matrix);
    return reciprocal;
}

// the largest value of any equation at a state: in the unit of the equation, and over the scale of the unknown
struct value {
    double plain, scaled;
};
static struct value largest_value(struct simulation *simulation) {
    const int n = simulation->school->n_unknowns;
    double *const value = allocate(n, sizeof *value);
    struct value most = {0};
    if (residual_evaluate(simulation->residual, &residual_run, simulation->state->t, simulation->state->y,
                          simulation->state->yp, value) != STATUS_OK) {
        abort();
    }
    for (int i = 0; i < n; i++) {
        most.plain = fmax(most.plain, fabs(value[i]));
        most.scaled = fmax(most.scaled, fabs(value[i]) / residual_scale(simulation->residual->school, i));
    }
    free(value);
    return most;
}

// ---- all options

// one option: place of the key in the case, and words of the key
static const struct option {
    int n;
    const char *words[3];
} options[] = {
    {2, {"collocation: chebyshev", "collocation: midpoint"}},
    {2, {"kutta: edge", "kutta: rate"}},
    {2, {"shedding: continuous", "shedding: impulsive"}},
    {2, {"second_moment: ellipse", "second_moment: published"}},
    {3,
     {"profile: joukowski", "profile: uniform",
      "profile: table, thickness_table: [0.1, 0.2, 0.15, 0.05], depth_table: [0.2, 0.3, 0.25, 0.1]"}},
    {2, {"law: quadratic", "law: linear_quadratic"}},
    {2, {"extent: thickness", "extent: depth"}},
    {3, {"law: none", "law: heading, desired_heading: 150", "law: averaged_heading, desired_heading: 150"}},
    {3,
     {"prescribed: none", "prescribed: head, heave: 0.1, frequency: 1",
      "prescribed: all, heave: 0.1, pitch: 10, frequency: 1"}},
};
enum { N_OPTIONS = sizeof options / sizeof *options };

// options of the default model
static const struct option second[] = {
    {3, {"shedding: sheet", "shedding: continuous", "shedding: continuous"}},  // the third with midpoints
    {2, {"curve: smooth", "curve: polygon"}},
    {2, {"section: mean", "section: nodes"}},
    {2, {"force: reactive", "force: published"}},
    {2, {"extent: thickness", "extent: depth"}},
    {3, {"law: none", "law: heading, desired_heading: 150", "law: course, desired_heading: 150"}},
    {3,
     {"prescribed: none", "prescribed: head, heave: 0.1, frequency: 1",
      "prescribed: all, heave: 0.1, pitch: 10, frequency: 1"}},
};
enum { N_SECOND = sizeof second / sizeof *second };

// the worst results
struct worst {
    int n;
    double condition, impulse; /* least reciprocal condition number: between events, at an impulsive one */
    double value, scaled;      /* largest value of an equation */
};

// the case that takes the given choice of every option; a wave that is there at once and a flow leave no term out
static struct simulation *open_choice(const int *choice) {
    const char *word[N_OPTIONS];
    for (int i = 0; i < N_OPTIONS; i++) word[i] = options[i].words[choice[i]];
    return verify_open(
        VERIFY_ARTICLE
        "format: 1\ntime: {end: 1, shedding_interval: 0.01}\n"
        "fluid: {velocity: [0.3, -0.2], shear: 0.2, gust: {amplitude: 0.1, frequency: 1}}\n"
        "sheet: {%s, %s}\nwake: {%s}\nfish:\n  - nodes: 5\n    sheet_points: 9\n    wave: {ramp: 0}\n"
        "    body: {%s, %s}\n    drag: {%s}\n    added_mass: {%s}\n    control: {%s}\n    motion: {%s}\n",
        word[0], word[1], word[2], word[3], word[4], word[5], word[6], word[7], word[8]);
}

static struct simulation *open_second(const int *choice) {
    const char *word[N_SECOND];
    for (int i = 0; i < N_SECOND; i++) word[i] = second[i].words[choice[i]];
    return verify_open(
        "format: 1\ntime: {end: 1, shedding_interval: 0.01}\n"
        "fluid: {velocity: [0.3, -0.2], shear: 0.2, gust: {amplitude: 0.1, frequency: 1}}\n"
        "wake: {%s}\nsheet: {%s, collocation: %s}\nfish:\n  - nodes: 5\n    sheet_points: 9\n    wave: {ramp: 0}\n"
        "    body: {%s}\n    %s\n    added_mass: {%s}\n    control: {%s}\n    motion: {%s}\n    start: {speed: 1}\n",
        word[0], word[1], choice[0] == 2 ? "midpoint" : "chebyshev", word[2], word[3], word[4], word[5], word[6]);
}

// the state after simulate_start; frees the simulation
static void examine(struct simulation *simulation, struct worst *worst) {
    const struct school *const school = simulation->school;
    const struct value value = largest_value(simulation);
    worst->value = fmax(worst->value, value.plain);
    worst->scaled = fmax(worst->scaled, value.scaled);
    worst->condition = fmin(worst->condition, condition_of(simulation, &residual_run));
    // an impulsive event with kutta: edge solves for the circulation shed, too
    if (school->shedding == SHEDDING_IMPULSIVE) {
        const struct residual_mode impulse = {.shed = SHED_BY_IMPULSE};
        worst->impulse = fmin(worst->impulse, condition_of(simulation, &impulse));
    }
    worst->n++;
    simulate_free(simulation);
}

static void choose(int number, int n_options, const struct option *from, int *choice) {
    for (int i = 0; i < n_options; i++) {
        choice[i] = number % from[i].n;
        number /= from[i].n;
    }
}

static int number_of_choices(int n_options, const struct option *from) {
    int n = 1;
    for (int i = 0; i < n_options; i++) n *= from[i].n;
    return n;
}

static void all_options(void) {
    struct worst worst = {.condition = 1, .impulse = 1};
    int choice[N_OPTIONS];
    for (int number = 0; number < number_of_choices(N_OPTIONS, options); number++) {
        choose(number, N_OPTIONS, options, choice);
        examine(open_choice(choice), &worst);
    }
    for (int number = 0; number < number_of_choices(N_SECOND, second); number++) {
        choose(number, N_SECOND, second, choice);
        examine(open_second(choice), &worst);
    }
    // and nearby fish, coupled in the Jacobian
    for (int number = 0; number < 8; number++) {
        choose(number, 3, options, choice);
        examine(verify_open(VERIFY_ARTICLE
                            "format: 1\ntime: {end: 1, shedding_interval: 0.01}\nsheet: {%s, %s}\nwake: {%s}\n"
                            "defaults: {fish: {nodes: 5, sheet_points: 9, wave: {ramp: 0}, control: {law: heading}}}\n"
                            "fish:\n  - start: {position: [0, 0]}\n  - start: {position: [0.2, 0.3]}\n",
                            options[0].words[choice[0]], options[1].words[choice[1]], options[2].words[choice[2]]),
                &worst);
    }
    static const char source[] =
        "product of collocation, kutta, shedding, second_moment, profile, drag law, extent, control law, prescribed; "
        "of the default model shedding, curve, collocation, section, force, extent, control law, prescribed; two fish";
    verify_show("combinations of options", source, worst.n);
    // nonsingular, and so far from singular that the solution keeps twelve of sixteen digits
    verify_zero("largest condition number, rows and columns equilibrated", source, 1 / worst.condition, 1e4);
    verify_zero("largest condition number at an impulsive event", source, 1 / worst.impulse, 1e4);
    verify_zero("largest value of F over the scale", source, worst.scaled, 1e-10);
    verify_zero("largest value of F, SI units", "in SI units", worst.value, 1e-10);
}

// the condition number as sheet and body are refined
static void refinement(void) {
    static const int points[4] = {11, 21, 41, 81};
    static const char *const rules[2] = {"chebyshev", "midpoint"};
    for (int i = 0; i < 8; i++) {
        struct simulation *const simulation =
            verify_open(VERIFY_ARTICLE
                        "format: 1\ntime: {end: 1, shedding_interval: 0.01}\nsheet: {collocation: %s}\n"
                        "fish:\n  - {nodes: %d, sheet_points: %d, control: {law: heading}}\n",
                        rules[i / 4], (points[i % 4] + 1) / 2, points[i % 4]);
        const double condition = 1 / condition_of(simulation, &residual_run);
        verify_point("condition of the start", rules[i / 4], points[i % 4], condition);
        char name[80];
        snprintf(name, sizeof name, "condition number, %s, M = %d", rules[i / 4], points[i % 4]);
        verify_show(name, "free fish with heading control", condition);
        simulate_free(simulation);
    }
}

// ---- IDACalcIC

// data of the callbacks
struct correction {
    struct simulation *simulation;
    struct jacobian *jacobian;
    struct linear_sundials linear;
    enum status failure;
};

static int value_callback(sunrealtype t, N_Vector y, N_Vector yp, N_Vector value, void *data) {
    const struct correction *const correction = data;
    return residual_evaluate(correction->simulation->residual, &residual_run, t, N_VGetArrayPointer(y),
                             N_VGetArrayPointer(yp), N_VGetArrayPointer(value));
}

static int jacobian_callback(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp, N_Vector value, SUNMatrix matrix,
                             void *data, N_Vector scratch1, N_Vector scratch2, N_Vector scratch3) {
    (void)yp, (void)value, (void)matrix, (void)scratch1, (void)scratch2, (void)scratch3;
    struct correction *const correction = data;
    return residual_jacobian(correction->simulation->residual, &residual_run, t, cj, N_VGetArrayPointer(y),
                             correction->jacobian);
}

// let IDACalcIC find the algebraic unknowns and the rates, y and yp, from the given values; return its code
static int calculate(struct simulation *simulation, double *y, double *yp, double *kind, double *tolerance) {
    const int n = simulation->school->n_unknowns;
    struct correction correction = {.simulation = simulation};
    const struct linear_tolerance linear_tolerance = {.relative = 1e-10};
    double *const values[4] = {y, yp, kind, tolerance};
    struct sundials_context context;
    N_Vector vector[4];
    struct arena *const arena = arena_create(simulation->arena, "IDACalcIC");
    sundials_context_create(&context, arena, n, 1, &correction.failure);
    for (int i = 0; i < 4; i++) vector[i] = sundials_context_vector(&context, values[i]);
    correction.jacobian = jacobian_create(arena, simulation->school);
    correction.linear = linear_sundials_create(&context, correction.jacobian, tolerance, linear_tolerance);
    residual_mask(simulation->residual, correction.jacobian);
    void *ida = IDACreate(context.context);
    int code = IDAInit(ida, value_callback, simulation->state->t, vector[0], vector[1]);
    if (code == 0) code = IDASetErrHandlerFn(ida, sundials_context_message, &correction.failure);
    if (code == 0) code = IDASetUserData(ida, &correction);
    if (code == 0) code = IDASVtolerances(ida, 0, vector[3]);
    if (code == 0) code = IDASetId(ida, vector[2]);
    if (code == 0) code = IDASetLinearSolver(ida, correction.linear.solver, correction.linear.matrix);
    if (code == 0) code = IDASetJacFn(ida, jacobian_callback);
    if (code == 0) code = IDACalcIC(ida, IDA_YA_YDP_INIT, simulation->state->t + simulation->school->interval);
    if (code == 0) code = IDAGetConsistentIC(ida, vector[0], vector[1]);
    IDAFree(&ida);
    arena_free(arena);
    return code;
}

// discard accelerations, circulations, bias and all rates of a started simulation; the largest difference, over the
// scales, between the results of IDACalcIC and KINSOL
static double disagreement(struct simulation *simulation) {
    const int n = simulation->school->n_unknowns;
    double *const work = allocate(4 * n, sizeof *work), *const y = work, *const yp = work + n;
    double *const kind = work + 2 * n, *const tolerance = work + 3 * n;
    residual_kinds(simulation->residual, &residual_run, kind);
    for (int i = 0; i < n; i++) {
        // nodes need positions, also the nodes of a prescribed head
        const int given = kind[i] > 0 || residual_place(simulation->school, i).kind < UNKNOWN_AX;
        y[i] = given ? simulation->state->y[i] : 0;
        tolerance[i] = 1e-12 * residual_scale(simulation->residual->school, i);
    }
    const int code = calculate(simulation, y, yp, kind, tolerance);
    double most = code == 0 ? 0 : INFINITY;
    for (int i = 0; i < n; i++) {
        const double scale = residual_scale(simulation->residual->school, i);
        most = fmax(most, fabs(y[i] - simulation->state->y[i]) / scale);
        // the rates of algebraic unknowns are free
        if (kind[i] > 0) most = fmax(most, fabs(yp[i] - simulation->state->yp[i]) / scale);
    }
    free(work);
    simulate_free(simulation);
    return most;
}

static void second_opinion(void) {
    static const struct {
        const char *name, *keys, *fish, *model;
    } cases[] = {
        {"defaults", "", "", ""},
        {"article's model", "", "", VERIFY_ARTICLE},
        {"kutta: rate", "sheet: {kutta: rate}\n", "", VERIFY_ARTICLE},
        {"impulsive, between events", "wake: {shedding: impulsive}\n", "", VERIFY_ARTICLE},
        {"prescribed head", "", "motion: {prescribed: head, heave: 0.1, frequency: 1}", VERIFY_ARTICLE},
        {"prescribed head, default model", "", "motion: {prescribed: head, heave: 0.1, frequency: 1}", ""},
        {"law: heading", "", "control: {law: heading, desired_heading: 150}", VERIFY_ARTICLE},
        {"law: averaged_heading", "", "control: {law: averaged_heading, desired_heading: 150}", VERIFY_ARTICLE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct simulation *const simulation =
            verify_open("%sformat: 1\ntime: {end: 1, shedding_interval: 0.01}\n%sfish:\n  - {%s%swave: {ramp: 0}}\n",
                        cases[i].model, cases[i].keys, cases[i].fish, cases[i].fish[0] ? ", " : "");
        char name[80];
        snprintf(name, sizeof name, "IDACalcIC less KINSOL over scale, %s", cases[i].name);
        verify_zero(name, "SUNDIALS' own consistent start, from zero", disagreement(simulation), 1e-10);
    }
}

void verify_start(void) {
    all_options();
    refinement();
    second_opinion();
}
