/* integrator_table.h: which integrator carries out which method. Tested by tests/solver/test_integrator_table.c. */
#ifndef INTEGRATOR_TABLE_H
#define INTEGRATOR_TABLE_H

#include "solver/integrator.h"

/* The integrator of a method: that of its name in enum method, or runge_kutta for the rows of the table of methods
 * without a name. */
const struct integrator *integrator_of(enum method method);

#endif
