/* diagnostics_forces.h: the forces on a fish by name, and the forces that hold a prescribed one. doc/model.md, section
 * 13. Tested by tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_FORCES_H
#define DIAGNOSTICS_FORCES_H

#include "school/diagnostics_values.h"
#include "school/residual.h"

/* The forces and moments of *to, whose com is known, at the unknowns y and time t of the last residual evaluated. */
void diagnostics_forces(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to);

/* All that the fluid does to a body, N: resistive and reactive force, pressure and suction. */
void diagnostics_fluid_force(const double resistive[2], const double reactive[2],
                             const struct pressure_forces *pressure, double force[2]);

/* The forces that come from the pressure, moments about a point; all 0, and no A_0, with other forces. */
struct pressure_forces diagnostics_pressure(struct residual *residual, int f, const double about[2], const double *y);

#endif
