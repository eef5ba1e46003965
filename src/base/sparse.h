/* sparse.h: a square sparse matrix that is filled by adding values, always in the same order. This makes filling it as
 * fast as filling an array: nobody searches for a row. Tested by tests/base/test_sparse.c.
 *
 * The first pass after sparse_forget records the row and the column of every addition, and sparse_end builds the
 * compressed columns from the record. Later passes replay it: the i-th addition goes directly to the recorded slot. The
 * order of additions must not depend on values; without NDEBUG, every addition of a replay is compared with the record.
 *
 *     sparse_begin -> sparse_add, sparse_add, ... -> sparse_end -> column_start, row_index, value */
#ifndef SPARSE_H
#define SPARSE_H

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/arena.h"

struct sparse {
    struct arena *arena;
    int first; /* index of the first row and column, in additions */
    int n;     /* order */

    /* the matrix in compressed columns, indices from 0; rows ascend within a column */
    int64_t n_nonzeros;
    int64_t *column_start; /* (n + 1) */
    int64_t *row_index;    /* (n_nonzeros) */
    double *value;         /* (n_nonzeros + 1); the last collects additions to masked rows */
    unsigned version;      /* incremented with every new pattern */

    /* the record */
    bool recording;
    int n_masked; /* number of ones of masked rows, which are the first entries */
    int64_t n_entries, capacity, next;
    int *entry_row, *entry_column; /* (n_entries) */
    int64_t *slot;                 /* (n_entries) */
    unsigned char *masked;         /* (n) */
};

/* An empty matrix of order n that records at its first pass. */
struct sparse *sparse_create(struct arena *arena, int first, int n);

/* Forget the pattern: the next pass records a new one. */
static inline void sparse_forget(struct sparse *matrix) {
    matrix->recording = true;
}

/* A masked row is a row of the identity: additions to it are ignored. After a change the next pass records. */
void sparse_mask(struct sparse *matrix, int row, int masked);
static inline bool sparse_is_masked(const struct sparse *matrix, int row) {
    return matrix->masked[row - matrix->first];
}

/* Start a pass: all values become zero, except the ones of masked rows. */
void sparse_begin(struct sparse *matrix);

/* Add a value to one entry; while recording, by sparse_record. */
void sparse_record(struct sparse *matrix, int row, int column, double value);
static inline void sparse_add(struct sparse *matrix, int row, int column, double value) {
    if (matrix->recording) {
        sparse_record(matrix, row, column, value);
        return;
    }
    const int64_t i = matrix->next++;
    assert(i < matrix->n_entries && matrix->entry_row[i] == row && matrix->entry_column[i] == column);
    matrix->value[matrix->slot[i]] += value;
}

/* End a pass. */
void sparse_end(struct sparse *matrix);

#endif
