/* result_values.h: the values of the variables of the table at one event, as arrays in memory for the result file and
 * the public interface: in C order, unused slots of a fish NaN or zero. Tested by tests/result/test_result_file.c and
 * tests/library/test_shoal.c. */
#ifndef RESULT_VALUES_H
#define RESULT_VALUES_H

#include "result/result_table.h"

/* The length of each dimension for this school, with n_vortex vortices per fish; the length of TIME is 1. */
void result_values_lengths(const struct school *school, int n_vortices, size_t length[RESULT_N_DIMENSIONS]);

/* The number of values of a variable at one event. */
size_t result_values_n(const struct result_variable *variable, const size_t *length);

/* The bytes of one value. */
size_t result_values_size(enum result_type type);

/* Write all values of a variable to a buffer of result_values_n of them. No fish has more vortices than the length. */
void result_values_fill(const struct result_variable *variable, const size_t *length, const struct result_row *row,
                        void *buffer);

#endif
