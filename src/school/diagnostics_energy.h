/* diagnostics_energy.h: energies and powers of a fish at one instant, and their balance over the steps of the
 * integrator. doc/model.md, section 13; doc/numerics.md, section 9. Tested by tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_ENERGY_H
#define DIAGNOSTICS_ENERGY_H

#include "school/residual.h"
#include "state/state.h"

/* Powers of one fish, W, from the unknowns, the rates of the state, and the fluid's velocity in the last residual
 * evaluated. */
struct diagnostics_power {
    double actuation, damping, drag, friction, added_mass, wake, pressure, suction, driving,
        contact;                       /* friction: of drag */
    double on_water, driving_on_water; /* of all forces of the fluid together, and of the driving forces, in the frame
                                          of the external flow at the centre of mass */
};
struct diagnostics_power diagnostics_power(struct residual *residual, int f, double t, const double *y);

/* Energies of one fish, J; contact: its half of what contacts store. */
struct diagnostics_energies {
    double kinetic, bending, stretching, contact;
};
struct diagnostics_energies diagnostics_energies(struct residual *residual, int f, double t, const double *y);

/* The sum of these. */
double diagnostics_energy(struct residual *residual, int f, double t, const double *y);

/* Add the powers of the step that ended at t to the energy balances, by the quadratic through the last three steps, and
 * bring the closest approach of two bodies up to date. */
void diagnostics_step(struct residual *residual, struct state *state, double t, const double *y);

/* Start the energy balances and the record of the closest approach: at the first event, when the state is
 * consistent. The record of bodies that cross themselves has begun with the event. */
void diagnostics_start(struct residual *residual, struct state *state);

/* Start all of them again at a later event; the works go on, so that means over a period do not notice. */
void diagnostics_restart(struct residual *residual, struct state *state);

/* At an event at which powers of fish f jump and its state does not, say because its bias takes another rate: the next
 * step's integral begins with the powers as they are now. */
void diagnostics_begin(struct residual *residual, struct state *state, int f);

/* Before and after a jump of the state: the energy that the jump brings counts as work done, and no later step reaches
 * back over it. A bias that jumps, for one, changes the natural curvature and with it the energy of bending. */
void diagnostics_before_jump(struct residual *residual, struct state *state);
void diagnostics_after_jump(struct residual *residual, struct state *state);

#endif
