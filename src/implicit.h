/* implicit.h: variable-order, variable-step BDF by IDA with the analytic Jacobian and KLU. doc/numerics.md. Tested by
 * tests/test_implicit.c. */
#ifndef IMPLICIT_H
#define IMPLICIT_H

#include "integrator.h"

extern const struct integrator implicit_ida;

#endif
