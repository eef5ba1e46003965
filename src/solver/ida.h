/* ida.h: BDF of variable order and step by IDA, with the analytic Jacobian and our own linear and nonlinear solvers.
 * doc/numerics.md. Tested by tests/solver/test_ida.c. */
#ifndef IDA_H
#define IDA_H

#include "solver/integrator.h"

extern const struct integrator ida_integrator;

#endif
