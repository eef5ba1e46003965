/* diagnostics_forces.h: the forces on a fish by kind, and the constraint forces of prescribed motion. doc/model.md,
 * section 13. Tested by tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_FORCES_H
#define DIAGNOSTICS_FORCES_H

#include "school/diagnostics_values.h"
#include "school/residual.h"

/* Fill forces and moments of *to at the unknowns y and time t of the last residual evaluated; to->com is input. */
void diagnostics_forces(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to);

/* The total force of the fluid on a body, N: resistive and reactive force, pressure and suction. */
void diagnostics_fluid_force(const double resistive[2], const double reactive[2],
                             const struct pressure_forces *pressure, double force[2]);

/* The forces of the pressure, moments about a point; with other force models all 0, and A_0 NaN. */
struct pressure_forces diagnostics_pressure(struct residual *residual, int f, const double about[2], const double *y);

#endif
