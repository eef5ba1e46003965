/* multipliers.h: the eigenvalues of a linear map of which only images are known, and its fixed point. Tested by
 * tests/solver/test_multipliers.c. */
#ifndef MULTIPLIERS_H
#define MULTIPLIERS_H

#include "base/status.h"

/* The eigenvalues of the map of n dimensions that takes the columns of before to those of after best, in the sense of
 * least squares; both (n, n_columns), column after column, n_columns >= n. By falling absolute value, of a pair the
 * one above the real axis first; 0 in directions in which the columns of before have less than 3 % of the largest.
 * way: from where x -> A x + b changes x by change to its fixed point, (I - A) way = change (n); 0 where 1 is an
 * eigenvalue, and no point is fixed. Fails with STATUS_SOLVER where all columns are 0, or with STATUS_MEMORY. */
enum status multipliers_of(int n, int n_columns, const double *before, const double *after, const double *change,
                           double *real, double *imaginary, double *way);

#endif
