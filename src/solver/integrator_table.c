/* integrator_table.c: the table. */
#include "solver/integrator_table.h"

#include "solver/ida.h"
#include "solver/one_step.h"
#include "solver/runge_kutta.h"
#include "solver/verlet.h"

// of the methods without a tableau for runge_kutta
static const struct integrator *const own[] = {
    [METHOD_IDA] = &ida_integrator,
    [METHOD_IMPLICIT_EULER] = &one_step_integrator,
    [METHOD_TRAPEZOID] = &one_step_integrator,
    [METHOD_VERLET] = &verlet_integrator,
};

const struct integrator *integrator_of(enum method method) {
    return methods_table[method].fixed ? &runge_kutta_integrator : own[method];
}
