/* test_linear.c: Linear systems with the Jacobian of a school are solved by blocks or as a whole, with coupled fish,
 * any number of threads, and matrices that are nearly singular. */
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "school.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"
#include "solver/dense_factors.h"
#include "solver/fish_factors.h"
#include "solver/linear.h"

// stirred bodies may cross
#define TIME "contact: {action: warn}\ntime: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"
#define SMALL TIME "defaults: {fish: {nodes: 7}}\n"

/* Six fish close together, of different size, one with a prescribed head; and one far away. */
#define SCHOOL                                                                                                \
    TIME "solver: {coupling_distance: 0.6}\n"                                                                 \
         "defaults: {fish: {force: reactive}}\n"                                                              \
         "fish:\n"                                                                                            \
         "  - {nodes: 7, sheet_points: 13, control: {law: heading, desired_heading: 150}}\n"                  \
         "  - {nodes: 5, sheet_points: 9, length: 0.7, start: {position: [0.2, 0.35]}}\n"                     \
         "  - {nodes: 7, sheet_points: 15, start: {position: [0.1, -0.4]},\n"                                 \
         "     motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"                                       \
         "  - {nodes: 7, sheet_points: 13, start: {position: [1.35, 0]}, control: {law: averaged_heading}}\n" \
         "  - {nodes: 5, sheet_points: 9, start: {position: [1.4, 0.4]}}\n"                                   \
         "  - {nodes: 5, sheet_points: 9, start: {position: [1.35, -0.4]}}\n"                                 \
         "  - {nodes: 5, sheet_points: 9, start: {position: [9, 5]}}\n"

/* Sheets of many points, with and without momenta and prescribed heads; the last one has few. */
#define SHEETS                                                                                                      \
    "wake: {taper: 0.4, taper_beside: 0.1}\n" TIME                                                                  \
    "solver: {coupling_distance: 0.6}\n"                                                                            \
    "defaults: {fish: {nodes: 6, sheet_points: 100}}\n"                                                             \
    "fish:\n"                                                                                                       \
    "  - {force: reactive, control: {law: heading, desired_heading: 150}}\n"                                        \
    "  - {pressure: {span: infinite}, length: 0.7, start: {position: [0.2, 0.35]}}\n"                               \
    "  - {force: reactive, motion: {prescribed: head, heave: 0.1, frequency: 1}, start: {position: [0.1, -0.4]}}\n" \
    "  - {pressure: {span: infinite}, start: {position: [1.35, 0]}, motion: {prescribed: head, "                    \
    "heave: 0.1, frequency: 1}}\n"                                                                                  \
    "  - {force: reactive, sheet_points: 9, start: {position: [1.4, 0.4]}}\n"

// full matrices that have been factorised
static int n_full;

int __real_dense_factors_set_up(struct dense_factors *factors);
int __wrap_dense_factors_set_up(struct dense_factors *factors);
int __wrap_dense_factors_set_up(struct dense_factors *factors) {
#pragma omp atomic
    n_full++;
    return __real_dense_factors_set_up(factors);
}

struct system {
    struct setup setup;
    struct linear *linear;
    int n;
    double *scale, *b, *x; /* (n) */
};

static void jacobian_at(struct system *system, double cj) {
    struct setup *const setup = &system->setup;
    school_ok(residual_jacobian(setup->residual, &residual_run, setup->t, cj, setup->state->y, setup->jacobian));
}

static void build(struct system *system, const char *text, double relative) {
    school_build(&system->setup, text);
    school_stir(&system->setup);
    system->n = system->setup.school->n_unknowns;
    NEW(test_arena(), system->scale, 3 * system->n);
    assert_non_null(system->scale);
    system->b = system->scale + system->n;
    system->x = system->b + system->n;
    for (int i = 0; i < system->n; i++) {
        system->scale[i] = residual_scale(system->setup.school, i);
        system->b[i] = school_random(&system->setup);
    }
    jacobian_at(system, 370);
    const struct linear_tolerance tolerance = {.relative = relative};
    system->linear = linear_create(test_arena(), system->setup.jacobian, system->scale, tolerance);
}

// the same system as one sparse matrix
static void use_klu(struct system *system) {
    system->setup.school->linear = LINEAR_KLU;
    system->linear =
        linear_create(test_arena(), system->setup.jacobian, system->scale, (struct linear_tolerance){.relative = 0});
}

// without the blocks between the fish
static void uncouple(struct system *system) {
    const unsigned char none[49] = {0};  // 7 fish at most
    jacobian_couple(system->setup.jacobian, none, system->setup.residual->couplings.pattern);
    assert_int_equal(system->setup.jacobian->n_couplings, 0);
}

// Gauss with row pivoting on rows scaled to one
static void solve_dense(int n, double *a, double *b) {
    for (int row = 0; row < n; row++) {
        double max = 0;
        for (int j = 0; j < n; j++) max = fmax(max, fabs(a[row * n + j]));
        for (int j = 0; j < n; j++) a[row * n + j] /= max;
        b[row] /= max;
    }
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int row = k + 1; row < n; row++) {
            if (fabs(a[row * n + k]) > fabs(a[pivot * n + k])) pivot = row;
        }
        for (int j = 0; j < n; j++) {
            const double swapped = a[k * n + j];
            a[k * n + j] = a[pivot * n + j];
            a[pivot * n + j] = swapped;
        }
        const double swapped = b[k];
        b[k] = b[pivot];
        b[pivot] = swapped;
        for (int row = k + 1; row < n; row++) {
            const double factor = a[row * n + k] / a[k * n + k];
            if (factor == 0) continue;
            for (int j = k; j < n; j++) a[row * n + j] -= factor * a[k * n + j];
            b[row] -= factor * b[k];
        }
    }
    for (int k = n - 1; k >= 0; k--) {
        for (int j = k + 1; j < n; j++) b[k] -= a[k * n + j] * b[j];
        b[k] /= a[k * n + k];
    }
}

// the distance of x from the solution with the dense matrix, over the size of that; each in units of the scales
static double error_of(const struct system *system) {
    ARENA(arena, NULL, "a dense matrix");
    double *const want = test_copy(system->n, system->b);
    solve_dense(system->n, school_dense_jacobian(arena, system->setup.jacobian), want);
    double size = 0, error = 0;
    for (int i = 0; i < system->n; i++) {
        size = fmax(size, fabs(want[i]) / system->scale[i]);
        error = fmax(error, fabs(system->x[i] - want[i]) / system->scale[i]);
    }
    return error / size;
}

TEST(uncoupled_fish_need_no_iteration) {
    struct system system;
    build(&system, SCHOOL, 1e-3);
    uncouple(&system);
    school_ok(linear_setup(system.linear));
    school_ok(linear_solve(system.linear, system.b, system.x));
    // rounding only, with condition numbers of 1e6
    BELOW(error_of(&system), 1e-9);
    assert_int_equal(linear_count(system.linear).iterations, 0);
    // in place
    school_ok(linear_solve(system.linear, system.b, system.b));
    NEAR_ARRAY(system.n, system.b, system.x, 0, 0);
}

TEST(coupled_fish_are_solved_to_the_tolerance) {
    const double tolerances[] = {1e-1, 1e-3, 1e-6, 1e-10};
    long before = 0;
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        struct system system;
        build(&system, SCHOOL, tolerances[i]);
        AT_LEAST(system.setup.jacobian->n_couplings, 20);
        school_ok(linear_setup(system.linear));
        school_ok(linear_solve(system.linear, system.b, system.x));
        const double error = error_of(&system);
        const struct linear_counts counts = linear_count(system.linear);
        // the error is the residual times the norm of the inverse of a matrix that is close to the identity
        BELOW(error, 10 * tolerances[i]);
        ABOVE(counts.iterations, before);
        BELOW(counts.iterations, 40);
        before = counts.iterations;
    }
}

TEST(klu_solves_the_whole_system_with_all_couplings) {
    const char *const texts[] = {SCHOOL, SHEETS};
    for (int i = 0; i < 2; i++) {
        struct system system;
        build(&system, texts[i], 1e-6);
        AT_LEAST(system.setup.jacobian->n_couplings, i == 0 ? 20 : 2);
        use_klu(&system);
        school_ok(linear_setup(system.linear));
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
        // every entry of the full matrix but the zeros in masked rows of couplings
        struct linear_counts counts = linear_count(system.linear);
        ARENA(arena, NULL, "a dense matrix");
        const double *const full = school_dense_jacobian(arena, system.setup.jacobian);
        long n_non_zeros = 0;
        for (int k = 0; k < system.n * system.n; k++) n_non_zeros += fabs(full[k]) > 0;
        AT_LEAST(counts.jacobian_non_zeros, n_non_zeros);
        AT_MOST(counts.jacobian_non_zeros, jacobian_non_zeros(system.setup.jacobian));
        assert_int_equal(counts.iterations, 0);

        // other values keep the analysis and the pivots; other couplings do not
        jacobian_at(&system, 500);
        school_ok(linear_setup(system.linear));
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
        counts = linear_count(system.linear);
        assert_int_equal(counts.klu.analyses, 1);
        assert_int_equal(counts.klu.factorisations, 1);
        assert_int_equal(counts.klu.refactorisations, 1);
        system.setup.residual->couplings.pattern++;
        uncouple(&system);
        school_ok(linear_setup(system.linear));
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
        assert_int_equal(linear_count(system.linear).klu.analyses, 2);
    }
}

TEST(a_whole_matrix_that_is_singular_is_final_at_first_and_a_retry_later) {
    struct system system;
    build(&system, SCHOOL, 1e-6);
    use_klu(&system);
    const enum status want[] = {STATUS_SOLVER, STATUS_OK, STATUS_RETRY, STATUS_OK};
    for (int i = 0; i < 4; i++) {
        jacobian_at(&system, 370);
        struct sparse *const own = system.setup.jacobian->own[4];
        if (i % 2 == 0) {
            // the column of the last unknown, phi0, becomes zero
            for (int64_t k = own->column_start[own->n - 1]; k < own->column_start[own->n]; k++) own->value[k] = 0;
        }
        assert_int_equal(linear_setup(system.linear), want[i]);
    }
}

TEST(sheets_of_many_points_are_eliminated_by_lapack) {
    // what is masked when initial conditions are sought, too
    for (int masked = 0; masked < 2; masked++) {
        struct system system;
        build(&system, SHEETS, 1e-13);
        const struct school *const school = system.setup.school;
        for (int f = 0; masked && f < school->n_fish; f++) {
            const struct layout *const at = &school->fish[f].at;
            for (int i = at->x; i < at->ax; i++) {
                if (i < at->vx || i >= at->px || at->px == at->ax) sparse_mask(system.setup.jacobian->own[f], i, 1);
            }
        }
        if (masked) jacobian_at(&system, 0);
        n_full = 0;
        school_ok(linear_setup(system.linear));
        // but the one of few points, and those with momenta whose velocities the masked rows of places leave open
        assert_int_equal(n_full, masked ? 2 : 3);
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
    }
}

// the block of a fish becomes the identity, but (e 1; 1 1) for the first unknown and one of the sheet
static void set_pair(struct sparse *own, int sheet, double e) {
    sparse_begin(own);
    for (int i = own->first; i < own->first + own->n; i++) sparse_add(own, i, i, i == own->first ? e : 1);
    sparse_add(own, own->first, sheet, 1);
    sparse_add(own, sheet, own->first, 1);
    sparse_end(own);
}

TEST(a_rod_that_is_nearly_singular_is_not_eliminated_alone) {
    struct system system;
    build(&system, SHEETS, 1e-6);
    uncouple(&system);
    const struct school *const school = system.setup.school;
    struct jacobian *const jacobian = system.setup.jacobian;
    const struct {
        double e;
        int n_full;
    } passes[] = {{0.5, 1}, {1e-5, 1}, {1e-8, 0}, {0.25, 1}};
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
        if (i == 0) sparse_forget(jacobian->own[0]);
        set_pair(jacobian->own[0], school->fish[0].at.gamma + 3, passes[i].e);
        n_full = 0;
        school_ok(linear_setup(system.linear));
        // and two of the others
        assert_int_equal(n_full, 2 + passes[i].n_full);
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
    }
    // another pattern is divided again
    sparse_forget(jacobian->own[0]);
    set_pair(jacobian->own[0], school->fish[0].at.gamma + 4, 0.5);
    n_full = 0;
    school_ok(linear_setup(system.linear));
    assert_int_equal(n_full, 3);
    // without the sheet's inverse nothing has one
    set_pair(jacobian->own[0], school->fish[0].at.gamma + 4, 1);
    assert_int_equal(linear_setup(system.linear), STATUS_RETRY);
}

TEST(a_small_residual_ends_the_iteration) {
    struct system system;
    build(&system, SCHOOL, 1e-6);
    const struct linear_tolerance tolerance = {.relative = 1e-6, .absolute = 1e-3};
    system.linear = linear_create(test_arena(), system.setup.jacobian, system.scale, tolerance);
    school_ok(linear_setup(system.linear));
    // the smaller the right-hand side, the fewer iterations: in the end none
    long fewest = 40;
    for (double size = 1e3; size > 1e-7; size /= 100) {
        for (int i = 0; i < system.n; i++) system.b[i] = size * school_random(&system.setup);
        const long before = linear_count(system.linear).iterations;
        school_ok(linear_solve(system.linear, system.b, system.x));
        const long iterations = linear_count(system.linear).iterations - before;
        AT_MOST(iterations, fewest);
        fewest = iterations;
        // the largest error is several times the root mean square of the residual
        const double error = error_of(&system);
        double largest = 0;
        for (int i = 0; i < system.n; i++) largest = fmax(largest, fabs(system.x[i]) / system.scale[i]);
        BELOW(error, fmax(1e-5, 50 * tolerance.absolute / largest));
    }
    assert_int_equal(fewest, 0);
}

TEST(patterns_are_analysed_once) {
    struct system system;
    build(&system, SCHOOL, 1e-6);
    school_ok(linear_setup(system.linear));
    struct linear_counts counts = linear_count(system.linear);
    assert_int_equal(counts.klu.analyses, 7);
    assert_int_equal(counts.klu.factorisations, 7);
    assert_int_equal(counts.klu.refactorisations, 0);
    // other values, and other couplings
    jacobian_at(&system, 500);
    school_ok(linear_setup(system.linear));
    uncouple(&system);
    jacobian_at(&system, 600);
    school_ok(linear_setup(system.linear));
    counts = linear_count(system.linear);
    assert_int_equal(counts.klu.analyses, 7);
    assert_int_equal(counts.klu.factorisations, 7);
    assert_int_equal(counts.klu.refactorisations, 14);
    // another pattern of one fish
    sparse_mask(system.setup.jacobian->own[4], system.setup.school->fish[4].at.phi0, 1);
    jacobian_at(&system, 600);
    school_ok(linear_setup(system.linear));
    counts = linear_count(system.linear);
    assert_int_equal(counts.klu.analyses, 8);
    assert_int_equal(counts.klu.factorisations, 8);
    school_ok(linear_solve(system.linear, system.b, system.x));
    BELOW(error_of(&system), 1e-4);
}

// write derivatives of impermeability by the circulation shed into the blocks; returns how much they differ
static double replace(struct system *system, const double *by_shed) {
    double change = 0;
    for (int f = 0; f < system->setup.school->n_fish; f++) {
        const struct layout *const at = &system->setup.school->fish[f].at;
        struct sparse *const own = system->setup.jacobian->own[f];
        const int column = at->circulation - at->x, kelvin = at->circulation - 1;
        for (int64_t e = own->column_start[column]; e < own->column_start[column + 1]; e++) {
            const int64_t row = at->x + own->row_index[e];
            const int first = at->full;
            if (row < first || row >= kelvin || sparse_is_masked(own, (int)row)) continue;
            change = fmax(change, fabs(by_shed[row] - own->value[e]));
            own->value[e] = by_shed[row];
        }
    }
    return change;
}

TEST(the_column_of_the_circulation_shed_can_be_updated) {
    static const char *const texts[] = {
        SHEETS, "wake: {taper: 0.4, taper_beside: 0.1}\n" SCHOOL,
        "wake: {taper: 0.4, taper_beside: 0.1}\n"
        "defaults: {fish: {nodes: 5, sheet_points: 9, force: pressure, pressure: {span: infinite}}}\n" TIME
        "solver: {coupling_distance: 0.6}\nfish:\n  - {start: {position: [0, 0]}}\n"
        "  - {start: {position: [0.2, 0.35]}, length: 0.7}\n"
        "  - {start: {position: [0.1, -0.4]}, motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"
        "  - {start: {position: [1.35, 0]}, force: reactive}\n"};
    // uncoupled, coupled, and coupled in one matrix
    for (int variant = 0; variant < 9; variant++) {
        const int coupled = variant % 3;
        struct system system;
        build(&system, texts[variant / 3], 1e-13);
        struct setup *const setup = &system.setup;
        if (!coupled) uncouple(&system);
        if (coupled == 2) use_klu(&system);
        school_ok(linear_setup(system.linear));
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
        // twice: an update takes the place of the last one
        double *const by_shed = test_array(system.n);
        for (int i = 0; i < 2; i++) {
            setup->t += setup->school->interval / 4;
            school_ok(residual_evaluate(setup->residual, &residual_run, setup->t, setup->state->y, setup->state->yp,
                                        setup->value));
            residual_by_shed(setup->residual, setup->state->y, by_shed);
            linear_update_shed(system.linear, by_shed);
        }
        // it is that of the Jacobian that is evaluated now, and another one than that of the factors
        ABOVE(replace(&system, by_shed), 0.01);
        ABOVE(error_of(&system), 1e-5);
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
        jacobian_at(&system, 370);
        // sums over many points are rounded in two ways, and friction depends on them
        AT_MOST(replace(&system, by_shed), (variant / 3 == 1 ? 0 : 4 * DBL_EPSILON));
        // factors of a new matrix have no update
        school_ok(linear_setup(system.linear));
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-9);
    }
}

// a school without couplings whose diagonal blocks are to be filled
static struct jacobian *build_apart(struct system *system) {
    build(system, SCHOOL, 1e-6);
    uncouple(system);
    for (int f = 0; f < 7; f++) sparse_forget(system->setup.jacobian->own[f]);
    return system->setup.jacobian;
}

// fill a diagonal block with 2 x 2 matrices: pivots that are good for some values are bad for others
static void set_pieces(struct sparse *own, double on_diagonal, double above, double below) {
    sparse_begin(own);
    for (int i = own->first; i < own->first + own->n; i++) {
        const int even = (i - own->first) % 2 == 0, partner = even ? i + 1 : i - 1;
        const int alone = partner >= own->first + own->n;
        sparse_add(own, i, i, alone ? 1 : on_diagonal);
        if (!alone) sparse_add(own, i, partner, even ? above : below);
    }
    sparse_end(own);
}

TEST(bad_factors_are_replaced_by_ones_with_other_pivots) {
    struct system system;
    struct jacobian *const jacobian = build_apart(&system);
    // a small change keeps the pivots; a diagonal that falls from 1 to 1e-9 does not: with the old pivots nine of
    // sixteen digits would be lost
    const struct {
        double on_diagonal, beside;
        long factorisations;
    } passes[] = {{1, 0.5, 7}, {0.9, 0.6, 7}, {1e-9, 1, 14}, {2e-9, 1, 14}, {1, 1e-9, 21}};
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
        for (int f = 0; f < 7; f++)
            set_pieces(jacobian->own[f], passes[i].on_diagonal, passes[i].beside, -passes[i].beside);
        school_ok(linear_setup(system.linear));
        assert_int_equal(linear_count(system.linear).klu.factorisations, passes[i].factorisations);
        school_ok(linear_solve(system.linear, system.b, system.x));
        BELOW(error_of(&system), 1e-14);
    }
}

TEST(a_block_that_becomes_nearly_singular_gets_new_pivots) {
    struct system system;
    struct jacobian *const jacobian = build_apart(&system);
    // (1 s; s 1): one pivot falls to 2 (1 - s) while no entry grows
    const struct {
        double s;
        long factorisations;
    } passes[] = {{0.5, 7}, {0.9, 7}, {1 - 1e-5, 14}, {1 - 2e-5, 14}, {1 - 1e-9, 21}};
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
        for (int f = 0; f < 7; f++) set_pieces(jacobian->own[f], 1, passes[i].s, passes[i].s);
        school_ok(linear_setup(system.linear));
        assert_int_equal(linear_count(system.linear).klu.factorisations, passes[i].factorisations);
    }
}

// a block in which a first pivot e makes another entry of its factors grow to 1/e, and a pivot of 2e-9 hides e from the
// reciprocal condition estimate
static void set_growth(struct sparse *own, double e) {
    const double growing[3][3] = {{e, 0, 1}, {1, 1, 0}, {1, 1, 1}};
    const double singular[2][2] = {{1, 1 - 1e-9}, {1 - 1e-9, 1}};
    const int n = own->first;
    sparse_begin(own);
    for (int i = 0; i < 9; i++) sparse_add(own, n + i / 3, n + i % 3, growing[i / 3][i % 3]);
    for (int i = 0; i < 4; i++) sparse_add(own, n + 3 + i / 2, n + 3 + i % 2, singular[i / 2][i % 2]);
    for (int i = n + 5; i < n + own->n; i++) sparse_add(own, i, i, 1);
    sparse_end(own);
}

TEST(a_block_whose_factors_grow_gets_new_pivots) {
    struct system system;
    struct jacobian *const jacobian = build_apart(&system);
    const double e[] = {1, 0.5, 1e-5};
    // six of seven: in the fish with a prescribed head these rows are masked
    const long factorisations[] = {7, 7, 13};
    for (int i = 0; i < 3; i++) {
        for (int f = 0; f < 7; f++) set_growth(jacobian->own[f], e[i]);
        school_ok(linear_setup(system.linear));
        assert_int_equal(linear_count(system.linear).klu.factorisations, factorisations[i]);
    }
}

TEST(a_singular_block_is_final_at_first_and_a_retry_later) {
    struct system system;
    struct jacobian *const jacobian = build_apart(&system);
    const double beside[] = {1, 0.5, 1, 0.5};
    const enum status want[] = {STATUS_SOLVER, STATUS_OK, STATUS_RETRY, STATUS_OK};
    for (int i = 0; i < 4; i++) {
        // (1 1; 1 1) has no inverse
        for (int f = 0; f < 7; f++) set_pieces(jacobian->own[f], 1, f == 5 ? 0.5 : 0.25, f == 5 ? -0.5 : -0.25);
        struct sparse *const own = jacobian->own[5];
        for (int k = 0; k + 1 < own->n; k += 2) {
            for (int64_t e = own->column_start[k]; e < own->column_start[k + 2]; e++) {
                if (own->row_index[e] != k + (e >= own->column_start[k + 1])) own->value[e] = beside[i];
            }
        }
        assert_int_equal(linear_setup(system.linear), want[i]);
        if (want[i] != STATUS_OK) assert_non_null(strstr(status_message(), "fish6"));
    }
}

TEST(a_right_hand_side_without_a_finite_value_asks_for_a_retry) {
    struct system system;
    build(&system, SCHOOL, 1e-6);
    school_ok(linear_setup(system.linear));
    system.b[3] = NAN;
    assert_int_equal(linear_solve(system.linear, system.b, system.x), STATUS_RETRY);
    // zero is the solution for zero
    memset(system.b, 0, (size_t)system.n * sizeof *system.b);
    school_ok(linear_solve(system.linear, system.b, system.x));
    NEAR_ARRAY(system.n, system.x, system.b, 0, 0);
}

// n fish in a square, the text of a case
static void lattice(int n, double along, double beside, const char *solver, char *text, size_t size) {
    const int side = (int)ceil(sqrt(n));
    int length = snprintf(text, size, SMALL "%sfish:\n", solver);
    for (int f = 0; f < n; f++) {
        length += snprintf(text + length, size - (size_t)length, "  - {start: {position: [%g, %g]}}\n",
                           along * (f % side), beside * (f / side));
    }
    BELOW((size_t)length, size);
}

static double milliseconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

TEST(a_school_costs_in_proportion_to_its_couplings) {
    const struct {
        int n;
        double along, beside;
        const char *solver;
    } cases[] = {{4, 1.5, 1.5, ""},
                 {16, 1.5, 1.5, ""},
                 {64, 1.5, 1.5, ""},
                 {144, 1.5, 1.5, ""},
                 {10, 1.3, 0.4, "solver: {coupling_distance: 100}\n"}};
    enum { TIMES = 10 };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static char text[8000];
        lattice(cases[i].n, cases[i].along, cases[i].beside, cases[i].solver, text, sizeof text);
        struct system system;
        build(&system, text, 1e-4);
        school_ok(linear_setup(system.linear));
        double filled = 0, factorised = 0, solved = 0;
        for (int k = 0; k < TIMES; k++) {
            const double start = milliseconds();
            jacobian_at(&system, 370 + k);
            const double full = milliseconds();
            school_ok(linear_setup(system.linear));
            const double ready = milliseconds();
            school_ok(linear_solve(system.linear, system.b, system.x));
            filled += (full - start) / TIMES;
            factorised += (ready - full) / TIMES;
            solved += (milliseconds() - ready) / TIMES;
        }
        const struct linear_counts counts = linear_count(system.linear);
        const double iterations = (double)counts.iterations / TIMES;
        print_message("%d fish, %d couplings: Jacobian %.2f ms, factors %.2f ms, solution %.2f ms, %.1f iterations\n",
                      cases[i].n, system.setup.jacobian->n_couplings, filled, factorised, solved, iterations);
        // at most 2 n pairs of neighbours in a square, each counted twice; more fish need no more iterations
        const int all = cases[i].n * (cases[i].n - 1);
        AT_MOST(system.setup.jacobian->n_couplings, (i == 4 ? all : 4 * cases[i].n));
        AT_LEAST(iterations, 1);
        AT_MOST(iterations, 15);
        assert_int_equal(counts.klu.factorisations, cases[i].n);
    }
}

TEST(threads_change_no_bit) {
    double *first = NULL;
    for (int threads = 1; threads <= 3; threads++) {
        // enough fish that threads share the solutions too
        char solver[40], text[8000];
        snprintf(solver, sizeof solver, "solver: {threads: %d}\n", threads);
        lattice(64, 1.4, 0.5, solver, text, sizeof text);
        struct system system;
        build(&system, text, 1e-6);
        AT_LEAST(system.setup.school->n_unknowns, PARALLEL_UNKNOWNS);
        // with new pivots, then with the same ones
        for (int pass = 0; pass < 2; pass++) {
            jacobian_at(&system, pass == 0 ? 300 : 370);
            school_ok(linear_setup(system.linear));
            school_ok(linear_solve(system.linear, system.b, system.x));
        }
        ABOVE(linear_count(system.linear).iterations, 4);
        if (!first) first = test_copy(system.n, system.x);
        assert_memory_equal(system.x, first, (size_t)system.n * sizeof *first);
    }
}
