/* diagnostics_energy.h: the energies and powers of a fish at one instant, and the energy balance, which adds up the
 * work over the steps of the integrator. doc/model.md, section 13; doc/numerics.md, section 9. Tested by
 * tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_ENERGY_H
#define DIAGNOSTICS_ENERGY_H

#include "school/residual.h"
#include "state/state.h"

/* The powers of one fish, W, from the unknowns, the rates of the state, and the flow velocity of the last evaluation of
 * the residual. friction is a part of drag; all other powers of the first two lines add up to the total power. */
struct diagnostics_power {
    double actuation, damping, drag, friction, added_mass, wake, pressure, suction, driving, contact; /* W */
    double on_water,
        driving_on_water; /* power of all forces of the fluid, and of the driving forces, in the frame of the
                                          external flow at the centre of mass */
};
struct diagnostics_power diagnostics_power(struct residual *residual, int f, double t, const double *y);

/* The energies of one fish, J; contact is half the energy of its contacts. */
struct diagnostics_energies {
    double kinetic, bending, stretching, contact;
};
struct diagnostics_energies diagnostics_energies(struct residual *residual, int f, double t, const double *y);

/* Their sum, J. */
double diagnostics_energy(struct residual *residual, int f, double t, const double *y);

/* After a step of the integrator to time t, add the work of the step to the energy balances, by the quadratic through
 * the powers of the last three steps, and update the closest approach of two bodies. */
void diagnostics_step(struct residual *residual, struct state *state, double t, const double *y);

/* Start the energy balances and the record of the closest approach at the first event, from a consistent state. The
 * record of self-crossings stays as it is. */
void diagnostics_start(struct residual *residual, struct state *state);

/* Restart energy balances, momentum balances, closest approach and self-crossings at a later event. Works are kept, so
 * that means over a period remain valid. */
void diagnostics_restart(struct residual *residual, struct state *state);

/* At an event where the powers of fish f jump although its state is continuous (the bias has a new rate), let the
 * integral of the next step begin with the present powers. */
void diagnostics_begin(struct residual *residual, struct state *state, int f);

/* Call these before and after a jump of the state. The energy of the jump then counts as work, and quadratures of later
 * steps and rates at later events begin after it. A jump of the bias is an example: it changes the natural curvature
 * and thereby the bending energy. */
void diagnostics_before_jump(struct residual *residual, struct state *state);
void diagnostics_after_jump(struct residual *residual, struct state *state);

#endif
