/* sparse.h: a sparse matrix that is filled by adding values in a fixed order. Tested by tests/test_sparse.c.
 *
 * The first pass after sparse_forget records which (row, column) every addition meets; sparse_end compiles the
 * compressed columns from it. Later passes replay: the i-th addition goes straight to its slot. So the order of the
 * additions must not depend on values; built without NDEBUG, every replayed addition is compared with the recorded one.
 *
 *     sparse_begin -> sparse_add, sparse_add, ... -> sparse_end -> column_start, row_index, value
 */
#ifndef SPARSE_H
#define SPARSE_H

#include <stdint.h>

#include "status.h"

struct sparse {
    int n; /* rows and columns */

    /* the matrix in compressed columns; rows rise inside a column */
    int64_t n_nonzeros;
    int64_t *column_start; /* (n + 1) */
    int64_t *row_index;    /* (n_nonzeros) */
    double *value;         /* (n_nonzeros + 1); the last takes what falls into masked rows */
    unsigned version;      /* changes with every new pattern */

    /* the record */
    int recording, out_of_memory;
    int64_t n_entries, capacity, next;
    int *entry_row, *entry_column; /* (n_entries) */
    int64_t *slot;                 /* (n_entries) */
    unsigned char *masked;         /* rows that take nothing                        (n) */
};

/* An empty matrix of order n that records at its first pass. Fails with STATUS_MEMORY. */
enum status sparse_create(struct sparse **matrix, int n);

/* Release the matrix. Accepts NULL. */
void sparse_free(struct sparse *matrix);

/* Forget the pattern: the next pass records a new one. */
void sparse_forget(struct sparse *matrix);

/* Let all additions to a row fall away but those of sparse_add_unmasked; before the recording pass only. */
void sparse_mask(struct sparse *matrix, int row);

/* Start a pass: all values are zero. */
void sparse_begin(struct sparse *matrix);

/* Add to one entry. */
void sparse_add(struct sparse *matrix, int row, int column, double value);

/* Add to one entry of a row that may be masked. */
void sparse_add_unmasked(struct sparse *matrix, int row, int column, double value);

/* End a pass. Fails with STATUS_MEMORY; the next pass then records again. */
enum status sparse_end(struct sparse *matrix);

/* product = matrix * vector, both (n). */
void sparse_multiply(const struct sparse *matrix, const double *vector, double *product);

#endif
