/* linear.c: factors of the diagonal blocks with GMRES for the couplings, or factors of the whole matrix. */
#include "solver/linear.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "solver/dense_factors.h"
#include "solver/fish_factors.h"
#include "solver/sundials.h"

/* During contact GMRES has to be more accurate: the forces between two bodies cancel only to the accuracy of the
 * solution, and what remains changes the total momentum. */
static const double contact_relative = 1e-9;

/* GMRES takes at most this many iterations; Newton's iteration then judges what it has reached. */
enum { MAX_ITERATIONS = 40 };

/* The diagonal block of one fish. */
struct block {
    struct fish_factors *factors;
    /* the effect of changing the column of the shed circulation since the last set-up: z = D^-1 change, divided by one
     * plus the element of z for that circulation                                                  (unknowns of the
     * fish) */
    bool is_updated;
    double *update;
};

/* The Jacobian as one sparse matrix, which KLU factorises, together with the changed columns of the shed circulations.
 * If C are the changes of these columns and E the unit vectors that select them (Woodbury),
 *
 *     (J + C E^T)^-1 b = x - Z K^-1 E^T x,   J x = b,   J Z = C,   K = 1 + E^T Z     of order n_fish */
struct whole {
    struct sparse_factors *factors;
    struct sparse_columns columns;
    int64_t *next;                /* of each column: where the next entry goes                          (n_unknowns) */
    unsigned couplings, *version; /* patterns of the couplings and of each block in columns             (n_fish) */
    bool is_set_up, is_updated;   /* was set up at least once; has an update since the last set-up */
    double *z;                    /* Z, column after column                                     (n_fish, n_unknowns) */
    struct dense_factors k;       /* factors of K */
    double *shed;                 /* E^T x, then K^-1 E^T x                                             (n_fish) */
};

struct linear {
    struct arena *arena;
    const struct jacobian *jacobian;
    struct linear_tolerance tolerance;
    struct whole *whole; /* NULL: by blocks */
    struct block *block; /* by blocks                                                                   (n_fish) */
    long solves, iterations;
    /* GMRES, with more than one fish: solution, right-hand side, 1/(sqrt(n_unknowns) scale) */
    struct sundials_context context;
    N_Vector x, b, weights;
    SUNLinearSolver gmres;
    double *weight, *right;   /* values of weights and b      (n_unknowns) */
    enum status failure;      /* of the product */
    enum status *of_callback; /* of the solver of SUNDIALS: status of the last set-up or solution */
};

static struct whole *whole_create(struct arena *arena, const struct school *school) {
    struct whole *whole;
    NEW(arena, whole, 1);
    whole->factors = sparse_factors_create(arena);
    whole->columns.n = school->n_unknowns;
    NEW(arena, whole->columns.start, school->n_unknowns + 1);
    NEW(arena, whole->next, school->n_unknowns);
    NEW(arena, whole->version, school->n_fish);
    NEW(arena, whole->z, (size_t)school->n_fish * (size_t)school->n_unknowns);
    NEW(arena, whole->shed, school->n_fish);
    whole->k = dense_factors_create(arena, school->n_fish);
    return whole;
}

static void gmres_create(struct linear *linear);

struct linear *linear_create(struct arena *arena, const struct jacobian *jacobian, const double *scale,
                             struct linear_tolerance tolerance) {
    const struct school *const school = jacobian->school;
    struct linear *linear;
    NEW(arena, linear, 1);
    linear->arena = arena;
    linear->jacobian = jacobian;
    linear->tolerance = tolerance;
    NEW(arena, linear->weight, school->n_unknowns);
    for (int i = 0; i < school->n_unknowns; i++) linear->weight[i] = 1 / (sqrt(school->n_unknowns) * scale[i]);
    if (school->linear == LINEAR_KLU) {
        linear->whole = whole_create(arena, school);
        return linear;
    }
    NEW(arena, linear->block, school->n_fish);
    for (int f = 0; f < school->n_fish; f++) {
        linear->block[f].factors = fish_factors_create(arena, &school->fish[f], jacobian->own[f]);
        NEW(arena, linear->block[f].update, jacobian->own[f]->n);
    }
    if (school->n_fish > 1) gmres_create(linear);
    return linear;
}

// ---- the whole matrix

/* Call put for every entry of the Jacobian, in ascending rows of a column. Entries of couplings in masked rows are zero
 * and are left out. */
static void whole_each(struct whole *whole, const struct jacobian *jacobian,
                       void (*put)(struct whole *whole, int64_t column, int64_t row, double value)) {
    const struct school *const school = jacobian->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct sparse *const own = jacobian->own[f];
        for (int c = 0; c < own->n; c++) {
            for (int64_t k = own->column_start[c]; k < own->column_start[c + 1]; k++) {
                put(whole, own->first + c, own->first + own->row_index[k], own->value[k]);
            }
        }
        for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
            const struct coupling_block *const rows = &jacobian->coupling[i].rows;
            const struct fish *const other = &school->fish[jacobian->coupling[i].other];
            for (int c = 0; c < rows->n_columns; c++) {
                const int column = flow_column(other, c);
                for (int r = 0; r < rows->n_rows; r++) {
                    const int row = school->fish[f].at.ax + r;
                    if (!sparse_is_masked(own, row)) put(whole, column, row, rows->value[(long)c * rows->n_rows + r]);
                }
            }
        }
    }
}

static void whole_count_entry(struct whole *whole, int64_t column, int64_t row, double value) {
    (void)row, (void)value;
    whole->columns.start[column + 1]++;
}

static void whole_place_entry(struct whole *whole, int64_t column, int64_t row, double value) {
    const int64_t at = whole->next[column]++;
    whole->columns.row[at] = row;
    whole->columns.value[at] = value;
}

static enum status whole_setup(struct linear *linear) {
    const struct jacobian *const jacobian = linear->jacobian;
    const struct school *const school = jacobian->school;
    struct whole *const whole = linear->whole;
    struct sparse_columns *const columns = &whole->columns;
    whole->is_updated = false;

    // count the entries of each column again if the pattern of a block or the couplings have changed
    bool is_new = columns->version == 0 || whole->couplings != jacobian->pattern;
    for (int f = 0; f < school->n_fish; f++) is_new |= whole->version[f] != jacobian->own[f]->version;
    if (is_new) {
        memset(columns->start, 0, ((size_t)columns->n + 1) * sizeof *columns->start);
        whole_each(whole, jacobian, whole_count_entry);
        for (int c = 0; c < columns->n; c++) columns->start[c + 1] += columns->start[c];
        GROW(linear->arena, columns->row, columns->start[columns->n]);
        GROW(linear->arena, columns->value, columns->start[columns->n]);
        for (int f = 0; f < school->n_fish; f++) whole->version[f] = jacobian->own[f]->version;
        whole->couplings = jacobian->pattern;
        columns->version++;
    }
    memcpy(whole->next, columns->start, (size_t)columns->n * sizeof *whole->next);
    whole_each(whole, jacobian, whole_place_entry);

    const bool is_regular = sparse_factors_set_up(whole->factors, columns);
    if (sparse_factors_lack_memory(whole->factors)) return status_fail(STATUS_MEMORY, "out of memory: KLU");
    if (!is_regular) return status_fail(whole->is_set_up ? STATUS_RETRY : STATUS_SOLVER, "the Jacobian is singular");
    whole->is_set_up = true;
    return STATUS_OK;
}

static void whole_solve(const struct linear *linear, double *x) {
    const struct school *const school = linear->jacobian->school;
    struct whole *const whole = linear->whole;
    sparse_factors_solve(whole->factors, 1, x);
    if (!whole->is_updated) return;
    for (int f = 0; f < school->n_fish; f++) whole->shed[f] = x[school->fish[f].at.circulation];
    dense_factors_solve(&whole->k, whole->shed);
    for (int f = 0; f < school->n_fish; f++) {
        const double *const z = whole->z + (size_t)f * (size_t)school->n_unknowns;
        for (int i = 0; i < school->n_unknowns; i++) x[i] -= whole->shed[f] * z[i];
    }
}

// ---- by blocks

enum status linear_setup(struct linear *linear) {
    if (linear->whole) return whole_setup(linear);
    const struct jacobian *jacobian = linear->jacobian;
    const struct school *school = jacobian->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_MATRICES);
    for (int f = 0; f < school->n_fish; f++) {
        // a new pattern needs memory, which must not be requested inside a parallel region
        fish_factors_prepare(linear->block[f].factors);
        linear->block[f].is_updated = false;
    }

    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) fish_factors_set_up(linear->block[f].factors);
    } else {
#pragma omp parallel for num_threads(threads) schedule(dynamic)
        for (int f = 0; f < school->n_fish; f++) fish_factors_set_up(linear->block[f].factors);
    }
    for (int f = 0; f < school->n_fish; f++) {
        const enum status status = fish_factors_status(linear->block[f].factors);
        if (status == STATUS_OK) continue;
        if (status == STATUS_MEMORY) return status;
        return status_fail(status, "the Jacobian of fish %s is singular", school->fish[f].name);
    }
    return STATUS_OK;
}

// replace x by D^-1 x for one fish; x begins with the first unknown of the fish
static void solve_block(const struct linear *linear, int f, double *x) {
    const struct layout *at = &linear->jacobian->school->fish[f].at;
    struct block *const block = &linear->block[f];
    const int n = at->end - at->x;
    fish_factors_solve(block->factors, x);
    if (!block->is_updated) return;
    const double shed = x[at->circulation - at->x];
    for (int i = 0; i < n; i++) x[i] -= shed * block->update[i];
}

/* The operands of a product or a solution that runs fish by fish. */
struct operation {
    struct linear *linear;
    const double *from;
    double *to;
};

static void for_each_fish(void (*of_fish)(const struct operation *of, int f), struct operation operation) {
    const struct school *const school = operation.linear->jacobian->school;
    const int threads = fish_threads(school);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) of_fish(&operation, f);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) of_fish(&operation, f);
    }
}

// how the column of the circulation shed by fish f changes, in the rows of its block; derivative: the new ones
// (n_unknowns)
static void find_change(const struct jacobian *jacobian, int f, const double *derivative, double *change) {
    const struct fish *fish = &jacobian->school->fish[f];
    const struct sparse *const own = jacobian->own[f];
    const int column = fish->at.circulation - fish->at.x, end = fish->at.gamma + fish->n_control - fish->at.x;
    const int first = fish->at.full - fish->at.x;
    memset(change, 0, (size_t)own->n * sizeof *change);
    for (int i = first; i < end; i++) {
        if (!sparse_is_masked(own, fish->at.x + i)) change[i] = derivative[fish->at.x + i];
    }
    for (int64_t i = own->column_start[column]; i < own->column_start[column + 1]; i++) {
        const int64_t row = own->row_index[i];
        if (row >= first && row < end) change[row] -= own->value[i];
    }
}

static void update_shed(const struct operation *of, int f) {
    const struct jacobian *const jacobian = of->linear->jacobian;
    const struct sparse *const own = jacobian->own[f];
    struct block *const block = &of->linear->block[f];
    const int column = jacobian->school->fish[f].at.circulation - jacobian->school->fish[f].at.x;
    double *const change = block->update;
    find_change(jacobian, f, of->from, change);
    block->is_updated = false;
    solve_block(of->linear, f, change);
    const double divisor = 1 + change[column];
    for (int i = 0; i < own->n; i++) change[i] /= divisor;
    block->is_updated = true;
}

static void whole_update_shed(struct linear *linear, const double *value) {
    const struct school *const school = linear->jacobian->school;
    struct whole *const whole = linear->whole;
    const size_t n = (size_t)school->n_unknowns;
    memset(whole->z, 0, (size_t)school->n_fish * n * sizeof *whole->z);
    for (int f = 0; f < school->n_fish; f++) {
        find_change(linear->jacobian, f, value, whole->z + (size_t)f * n + school->fish[f].at.x);
    }
    sparse_factors_solve(whole->factors, school->n_fish, whole->z);
    for (int f = 0; f < school->n_fish; f++) {
        for (int g = 0; g < school->n_fish; g++) {
            const double by_g = whole->z[(size_t)g * n + (size_t)school->fish[f].at.circulation];
            whole->k.value[f + (long)g * whole->k.stride] = (f == g) + by_g;
        }
    }
    dense_factors_set_up(&whole->k);
    whole->is_updated = true;
}

void linear_update_shed(struct linear *linear, const double *value) {
    if (linear->whole) {
        whole_update_shed(linear, value);
        return;
    }
    for_each_fish(update_shed, (struct operation){linear, value, NULL});
}

// x = D^-1 b with the diagonal blocks D; both may be the same array
static void uncoupled_solve(const struct operation *of, int f) {
    const struct layout *at = &of->linear->jacobian->school->fish[f].at;
    const int n = at->end - at->x;
    if (of->to != of->from) memcpy(of->to + at->x, of->from + at->x, (size_t)n * sizeof *of->to);
    solve_block(of->linear, f, of->to + at->x);
}

// product = v + D^-1 C v, where C are the coupling blocks
static void coupled_multiply(const struct operation *of, int f) {
    const struct jacobian *jacobian = of->linear->jacobian;
    const struct layout *at = &jacobian->school->fish[f].at;
    double *const product = of->to;
    memset(product + at->x, 0, (size_t)(at->ax - at->x) * sizeof *product);
    jacobian_multiply_couplings(jacobian, f, of->from, product + at->ax);
    solve_block(of->linear, f, product + at->x);
    for (int i = at->x; i < at->end; i++) product[i] += of->from[i];
}

static int gmres_multiply(void *data, N_Vector v, N_Vector product) {
    struct linear *const linear = data;
    for_each_fish(coupled_multiply, (struct operation){linear, N_VGetArrayPointer(v), N_VGetArrayPointer(product)});
    return 0;
}

static void release_gmres(void *object) {
    const struct linear *const linear = object;
    if (linear->gmres) SUNLinSolFree(linear->gmres);
}

/* The operator of GMRES, 1 + D^-1 C, includes the preconditioner; x is set for each solution. Norms and dot products
 * are sums over all unknowns, so they use one thread. A run of 16 close fish takes 2.4 % more instructions with
 * SUNLinSol_SPGMR than with a GMRES without the vectors of SUNDIALS (callgrind); for 64 and 256 fish the difference is
 * within the noise. */
static void gmres_create(struct linear *linear) {
    struct arena *const arena = linear->arena;
    const int n = linear->jacobian->school->n_unknowns;
    NEW(arena, linear->right, n);
    sundials_context_create(&linear->context, arena, n, 1, &linear->failure);
    linear->x = sundials_context_vector(&linear->context, linear->right);
    linear->b = sundials_context_vector(&linear->context, linear->right);
    linear->weights = sundials_context_vector(&linear->context, linear->weight);

    sundials_context_reserve(&linear->context, MAX_ITERATIONS + 8);

    linear->gmres =
        arena_take(arena, SUNLinSol_SPGMR(linear->x, SUN_PREC_NONE, MAX_ITERATIONS, linear->context.context));
    arena_defer(arena, release_gmres, linear);
    if (SUNLinSolSetATimes(linear->gmres, linear, gmres_multiply) != SUN_SUCCESS ||
        SUNLinSolSetScalingVectors(linear->gmres, linear->weights, linear->weights) != SUN_SUCCESS) {
        arena_lack(arena, 0);
    }
    if (SUNLinSolInitialize(linear->gmres) != SUN_SUCCESS) {
        linear->gmres = NULL;  // SUNDIALS has freed the solver
        arena_lack(arena, 0);
    }
}

enum status linear_solve(struct linear *linear, const double *b, double *x) {
    const struct jacobian *const jacobian = linear->jacobian;
    const int n = jacobian->school->n_unknowns;
    linear->solves++;
    if (linear->whole) {
        if (x != b) memcpy(x, b, (size_t)n * sizeof *x);
        whole_solve(linear, x);
    } else {
        for_each_fish(uncoupled_solve, (struct operation){linear, b, x});
    }

    // x is now the solution without couplings, from which GMRES starts
    if (!linear->whole && jacobian->n_couplings > 0) {
        N_VSetArrayPointer(x, linear->x);
        const double start = N_VWL2Norm(linear->x, linear->weights);
        const double limit = jacobian->has_contacts
                                 ? contact_relative * start
                                 : fmax(linear->tolerance.relative * start, linear->tolerance.absolute);
        if (start > limit && isfinite(start)) {
            memcpy(linear->right, x, (size_t)n * sizeof *x);
            N_VConst(0, linear->x);
            SUNLinSolSetZeroGuess(linear->gmres, SUNTRUE);
            const int code = SUNLinSolSolve(linear->gmres, NULL, linear->x, linear->b, limit);
            linear->iterations += SUNLinSolNumIters(linear->gmres);
            // a reduced residual is good enough here, because Newton's iteration judges the solution
            if (code != SUN_SUCCESS && code != SUNLS_RES_REDUCED) {
                return status_fail(STATUS_RETRY, "GMRES has found no solution");
            }
        }
    }

    for (int i = 0; i < n; i++) {
        if (!isfinite(x[i])) return status_fail(STATUS_RETRY, "a linear system has no finite solution");
    }
    return STATUS_OK;
}

struct linear_counts linear_count(const struct linear *linear) {
    struct linear_counts counts = {.solves = linear->solves, .iterations = linear->iterations};
    if (linear->whole) {
        sparse_factors_count(linear->whole->factors, &counts.klu);
        counts.factor_non_zeros = sparse_factors_non_zeros(linear->whole->factors);
        if (counts.factor_non_zeros > 0)
            counts.jacobian_non_zeros = (long)linear->whole->columns.start[linear->whole->columns.n];
        return counts;
    }
    for (int f = 0; f < linear->jacobian->school->n_fish; f++) {
        fish_factors_count(linear->block[f].factors, &counts.klu);
        counts.factor_non_zeros += fish_factors_non_zeros(linear->block[f].factors);
    }
    if (counts.factor_non_zeros > 0) counts.jacobian_non_zeros = jacobian_non_zeros(linear->jacobian);
    return counts;
}

// ---- matrix and linear solver of SUNDIALS: empty shells around the functions above

static SUNMatrix_ID matrix_id(SUNMatrix matrix) {
    (void)matrix;
    return SUNMATRIX_CUSTOM;
}

// nothing to do: residual_jacobian sets the values to zero
static int matrix_zero(SUNMatrix matrix) {
    (void)matrix;
    return SUN_SUCCESS;
}

static SUNLinearSolver_Type solver_type(SUNLinearSolver solver) {
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static int solver_setup(SUNLinearSolver solver, SUNMatrix matrix) {
    (void)matrix;
    struct linear *const linear = solver->content;
    *linear->of_callback = linear_setup(linear);
    return *linear->of_callback;
}

static int solver_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance) {
    (void)matrix, (void)tolerance;
    struct linear *const linear = solver->content;
    *linear->of_callback = linear_solve(linear, N_VGetArrayPointer(b), N_VGetArrayPointer(x));
    return *linear->of_callback;
}

static void release_shell(void *solver) {
    SUNLinSolFreeEmpty(solver);
}

struct linear_sundials linear_sundials_create(struct sundials_context *context, const struct jacobian *jacobian,
                                              const double *scale, struct linear_tolerance tolerance) {
    struct linear_sundials made = {.linear = linear_create(context->arena, jacobian, scale, tolerance)};
    made.linear->of_callback = context->failure;
    made.matrix = sundials_own(context->arena, sundials_release_matrix, SUNMatNewEmpty(context->context));
    made.solver = sundials_own(context->arena, release_shell, SUNLinSolNewEmpty(context->context));
    made.matrix->ops->getid = matrix_id;
    made.matrix->ops->zero = matrix_zero;
    made.solver->content = made.linear;
    made.solver->ops->gettype = solver_type;
    made.solver->ops->setup = solver_setup;
    made.solver->ops->solve = solver_solve;
    return made;
}
