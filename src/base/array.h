/* array.h: arrays of numbers, initially 0. Tested by tests/base/test_array.c. */
#ifndef ARRAY_H
#define ARRAY_H

#include "base/status.h"

/* Allocate n zeros in *values, to be freed by the caller; not NULL for n = 0. what: name of the values in the message.
 * Fails with STATUS_MEMORY; *values is then NULL. */
enum status array_doubles(double **values, int n, const char *what);

/* The same for n_arrays arrays of n numbers each; arrays after a failed allocation are unchanged. */
enum status array_many_doubles(double **const *values, int n_arrays, int n, const char *what);

#endif
