/* shared_vector.h: vectors of SUNDIALS whose operations on single elements are shared by the threads of the school.
 * Each element has the bits that the serial vector of SUNDIALS gives it, and norms are summed in its order. Tested by
 * tests/solver/test_shared_vector.c. */
#ifndef SHARED_VECTOR_H
#define SHARED_VECTOR_H

#include "base/status.h"
#include "model/fish.h"
#include "solver/sundials.h"

/* Create a vector of the unknowns of a school, which must outlive it and its clones. The values are not copied, and the
 * vector does not own them. Fails with STATUS_MEMORY. SUNDIALS does not ask whether a clone could be made:
 * sundials_adapter_context sees to the memory of all. */
enum status shared_vector_create(N_Vector *vector, SUNContext context, const struct school *school, double *values);

#endif
