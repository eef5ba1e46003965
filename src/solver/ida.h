/* ida.h: variable-order, variable-step BDF by IDA with the analytic Jacobian and KLU. doc/numerics.md. Tested by
 * tests/solver/test_ida.c. */
#ifndef IDA_H
#define IDA_H

#include "solver/integrator.h"

extern const struct integrator ida_integrator;

#endif
