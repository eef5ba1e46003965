/* test_sparse.c: A sparse matrix records its pattern in the first pass and replays it in later ones, masks rows, and
 * forgets a pattern that no longer holds. */
#include <stdlib.h>

#include "base/sparse.h"
#include "school.h"

// 3 x 3, added out of order and twice at (0, 2):   2 .  7      the values times factor
//                                                  . .  3
//                                                  4 5  .
static void fill(struct sparse *matrix, double factor) {
    sparse_begin(matrix);
    sparse_add(matrix, 2, 0, 4 * factor);
    sparse_add(matrix, 0, 2, 1 * factor);
    sparse_add(matrix, 1, 2, 3 * factor);
    sparse_add(matrix, 0, 0, 2 * factor);
    sparse_add(matrix, 2, 1, 5 * factor);
    sparse_add(matrix, 0, 2, 6 * factor);
    sparse_end(matrix);
}

TEST(first_pass_and_replays_give_the_same_columns) {
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 0, 3);
    const unsigned version = matrix->version;
    for (int pass = 1; pass <= 3; pass++) {
        fill(matrix, pass);
        assert_int_equal(matrix->n_nonzeros, 5);
        const int64_t start[] = {0, 2, 3, 5}, row[] = {0, 2, 2, 0, 1};
        const double value[] = {2.0 * pass, 4.0 * pass, 5.0 * pass, 7.0 * pass, 3.0 * pass};
        assert_memory_equal(matrix->column_start, start, sizeof start);
        assert_memory_equal(matrix->row_index, row, sizeof row);
        NEAR_ARRAY(5, matrix->value, value, 0, 0);
        // one pattern for all values
        assert_int_equal(matrix->version, version + 1);
    }
}

TEST(forget_records_another_pattern) {
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 0, 3);
    fill(matrix, 1);
    const unsigned version = matrix->version;
    sparse_forget(matrix);
    sparse_begin(matrix);
    sparse_add(matrix, 1, 1, 8);
    sparse_end(matrix);
    assert_int_equal(matrix->n_nonzeros, 1);
    assert_int_equal(matrix->row_index[0], 1);
    NEAR(matrix->value[0], 8, 0, 0);
    assert_int_not_equal(matrix->version, version);
}

TEST(masked_rows_are_those_of_the_identity) {
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 0, 3);
    // masked, masked again, not masked: each change is another pattern
    const struct {
        int masked, n_nonzeros;
        double want[9];
    } passes[] = {{1, 2, {1, 0, 0, 3, 0, 0, 0, 0, 0}},
                  {1, 2, {1, 0, 0, 3, 0, 0, 0, 0, 0}},
                  {0, 3, {2, 9, 0, 3, 0, 0, 0, 0, 0}},
                  {1, 2, {1, 0, 0, 3, 0, 0, 0, 0, 0}}};
    for (size_t i = 0; i < sizeof passes / sizeof *passes; i++) {
        const unsigned version = matrix->version;
        const int changes = i == 0 || passes[i].masked != passes[i - 1].masked;
        sparse_mask(matrix, 0, passes[i].masked);
        assert_int_equal(sparse_is_masked(matrix, 0), passes[i].masked);
        sparse_begin(matrix);
        sparse_add(matrix, 0, 0, 2);
        sparse_add(matrix, 1, 0, 3);
        sparse_add(matrix, 0, 1, 9);
        sparse_end(matrix);
        assert_int_equal(matrix->version - version, changes);
        double *const dense = school_dense(test_arena(), matrix);
        NEAR_ARRAY(9, dense, passes[i].want, 0, 0);
        assert_int_equal(matrix->n_nonzeros, passes[i].n_nonzeros);
    }
}

TEST(rows_and_columns_may_begin_with_any_number) {
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 70, 2);
    sparse_mask(matrix, 71, 1);
    for (int pass = 0; pass < 2; pass++) {
        sparse_begin(matrix);
        sparse_add(matrix, 70, 71, 5);
        sparse_add(matrix, 71, 70, 6);
        sparse_end(matrix);
        const int64_t start[] = {0, 0, 2}, row[] = {0, 1};
        const double value[] = {5, 1};
        assert_memory_equal(matrix->column_start, start, sizeof start);
        assert_memory_equal(matrix->row_index, row, sizeof row);
        NEAR_ARRAY(2, matrix->value, value, 0, 0);
    }
}

TEST(many_random_additions_equal_a_dense_sum) {
    enum { N = 40, N_ADDITIONS = 5000 };
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 0, N);
    for (int pass = 0; pass < 2; pass++) {
        struct setup random = {.seed = 3};
        static double want[N * N];
        for (int i = 0; i < N * N; i++) want[i] = 0;
        sparse_begin(matrix);
        for (int i = 0; i < N_ADDITIONS; i++) {
            const int row = (int)(N * (school_random(&random) + 1) / 2), column = (i * i + 3 * i) % N;
            const double value = school_random(&random);
            sparse_add(matrix, row, column, value);
            want[row * N + column] += value;
        }
        sparse_end(matrix);
        double *const dense = school_dense(test_arena(), matrix);
        // the additions to one entry keep the order: every bit is equal
        NEAR_ARRAY(N * N, dense, want, 0, 0);
    }
    for (int column = 0; column < N; column++) {
        for (int64_t i = matrix->column_start[column] + 1; i < matrix->column_start[column + 1]; i++) {
            ABOVE(matrix->row_index[i], matrix->row_index[i - 1]);
        }
    }
}

TEST(an_empty_pass_is_an_empty_matrix) {
    struct sparse *matrix;
    matrix = sparse_create(test_arena(), 0, 2);
    sparse_begin(matrix);
    sparse_end(matrix);
    assert_int_equal(matrix->n_nonzeros, 0);
    assert_int_equal(matrix->column_start[2], 0);
}
