/* test_jacobian.c: Tests the Jacobian as a matrix of blocks: the pairs that are coupled, products with a vector, and
 * threads. */
#include <stdlib.h>
#include <string.h>

#include "fish/fish_motion.h"
#include "flow/flow_derivative.h"
#include "school.h"
#include "school/jacobian.h"
#include "school/residual.h"
#include "school/residual_jacobian.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

/* Five fish: the first three close together, of different size, one of them with a prescribed head, two far away. */
#define FIVE(threads)                                                                                      \
    TIME "solver: {coupling_distance: 0.6, threads: " #threads                                             \
         "}\n"                                                                                             \
         "defaults: {fish: {body: {depth: 1}}}\n"                                                          \
         "fish:\n"                                                                                         \
         "  - {nodes: 7, sheet_points: 13, control: {law: heading, desired_heading: 150}}\n"               \
         "  - {nodes: 5, sheet_points: 9, length: 0.7, start: {position: [0.2, 0.5]}}\n"                   \
         "  - {nodes: 7, sheet_points: 15, force: reactive, start: {position: [0.1, -0.6]},\n"             \
         "     motion: {prescribed: head, heave: 0.1, frequency: 1}}\n"                                    \
         "  - {nodes: 7, sheet_points: 13, start: {position: [8, 0]}, control: {law: averaged_heading}}\n" \
         "  - {nodes: 5, sheet_points: 10, start: {position: [9, 5]}}\n"

static void build(struct setup *setup, const char *text) {
    school_build(setup, text);
    school_stir(setup);
    school_ok(residual_jacobian(setup->residual, &residual_run, setup->t, 37, setup->state->y, setup->jacobian));
}

TEST(blocks_are_those_of_the_coupled_fish) {
    struct setup setup;
    build(&setup, FIVE(1));
    const struct jacobian *jacobian = setup.jacobian;
    int n = 0;
    for (int f = 0; f < 5; f++) {
        assert_int_equal(jacobian->first[f], n);
        for (int g = 0; g < 5; g++) {
            if (g == f || !setup.residual->couplings.coupled[5 * f + g]) continue;
            assert_int_equal(jacobian->coupling[n].other, g);
            assert_int_equal(jacobian->coupling[n].rows.n_rows, flow_n_rows(&setup.school->fish[f]));
            assert_int_equal(jacobian->coupling[n++].rows.n_columns, flow_n_columns(&setup.school->fish[g]));
        }
    }
    assert_int_equal(jacobian->n_couplings, n);
    // 0 with 1 and 2
    assert_true(setup.residual->couplings.coupled[1] && setup.residual->couplings.coupled[2]);
    assert_int_equal(jacobian->first[4] - jacobian->first[3], 0);
    AT_LEAST(n, 4);
    AT_MOST(n, 6);
}

// fish that come into contact between two evaluations are coupled, however short the coupling distance
TEST(contact_couples) {
    struct setup setup = setup_of(TIME
                                  "solver: {coupling_distance: 0}\n"
                                  "defaults: {fish: {nodes: 7, body: {profile: uniform, thickness: 0.1}}}\n"
                                  "fish: [{}, {start: {position: [0, 0.3]}}, {start: {position: [0, 9]}}]\n");
    for (int are_near = 0; are_near < 2; are_near++) {
        const struct fish *const fish = &setup.school->fish[1];
        for (int k = 0; k < fish->n_nodes && are_near; k++) setup.state->y[fish->at.y + k] -= 0.185;
        school_ok(residual_jacobian(setup.residual, &residual_run, setup.t, 37, setup.state->y, setup.jacobian));
        assert_int_equal(setup.jacobian->has_contacts, are_near);
        assert_int_equal(setup.jacobian->n_couplings, 2 * are_near);
    }
}

TEST(couplings_multiply_as_the_whole_matrix_without_its_diagonal_blocks) {
    struct setup setup;
    build(&setup, FIVE(1));
    const int n = setup.school->n_unknowns;
    double *const dense = school_dense_jacobian(test_arena(), setup.jacobian), *const vector = test_array(2 * n);
    for (int i = 0; i < n; i++) vector[i] = school_random(&setup);
    double *const product = vector + n, largest = 0;
    for (int f = 0; f < 5; f++) {
        const struct layout *at = &setup.school->fish[f].at;
        jacobian_multiply_couplings(setup.jacobian, f, vector, product);
        for (int row = at->x; row < at->end; row++) {
            double want = 0;
            for (int column = 0; column < n; column++) {
                if (column < at->x || column >= at->end) want += dense[(size_t)(row * n + column)] * vector[column];
            }
            // no other row has entries of other fish
            NEAR(row < at->ax ? 0 : product[row - at->ax], want, 1e-11, 1e-11);
            largest = fmax(largest, fabs(want));
        }
    }
    ABOVE(largest, 1e-2);
}

TEST(masked_rows_have_no_couplings) {
    struct setup setup;
    build(&setup, FIVE(1));
    const struct layout *at = &setup.school->fish[2].at;
    const struct coupling_block *rows = &setup.jacobian->coupling[setup.jacobian->first[2]].rows;
    // the nose; the third node is free
    for (int c = 0; c < rows->n_columns; c++) {
        const double *const column = rows->value + c * rows->n_rows;
        for (int k = 0; k < fish_n_prescribed(&setup.school->fish[2]); k++) {
            NEAR(column[k], 0, 0, 0);
            NEAR(column[at->ay - at->ax + k], 0, 0, 0);
        }
    }
    ABOVE(fabs(rows->value[2]), 0);
}

TEST(threads_change_no_bit) {
    struct setup one, more;
    build(&one, FIVE(1));
    double *const want = school_dense_jacobian(test_arena(), one.jacobian);
    const size_t size = (size_t)one.school->n_unknowns * (size_t)one.school->n_unknowns * sizeof *want;
    const char *const texts[] = {FIVE(2), FIVE(3)};
    for (int i = 0; i < 2; i++) {
        build(&more, texts[i]);
        // large enough for threads
        AT_LEAST(more.school->n_unknowns, PARALLEL_MATRICES);
        // recorded, then replayed
        for (int pass = 0; pass < 2; pass++) {
            double *const got = school_dense_jacobian(test_arena(), more.jacobian);
            assert_memory_equal(got, want, size);
            school_ok(residual_jacobian(more.residual, &residual_run, more.t, 37, more.state->y, more.jacobian));
        }
    }
}
