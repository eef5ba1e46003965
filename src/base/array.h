/* array.h: arrays of numbers that begin as zeros. Tested by tests/base/test_array.c. */
#ifndef ARRAY_H
#define ARRAY_H

#include "base/status.h"

/* *values: n zeros, for the caller to free; of n = 0 not NULL either. what: what they are, for the message. Fails with
 * STATUS_MEMORY; *values is NULL then. */
enum status array_doubles(double **values, int n, const char *what);

/* The same for n_arrays arrays of n numbers each; those after the one that fails stay as they are. */
enum status array_many_doubles(double **const *values, int n_arrays, int n, const char *what);

#endif
