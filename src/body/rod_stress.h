/* rod_stress.h: the stresses of a rod from the balance of momentum, and the strains that follow from them by the law of
 * its material, for the powers and energies of section 13. doc/model.md, section 13; doc/numerics.md, section 9. Tested
 * by tests/body/test_rod_stress.c.
 *
 * In a stiff body strains are tiny, and stiffness times an error of the places is a moment that is not there. The
 * accelerations do not have that error. What is behind a joint, and nothing else holds, says its moment:
 *
 *     node k ==M_k==> node k+1 ---- ... ---- node N-1        M_k dkappa/dphi = - sum over j > k: (x_j - x_k) x r_j
 *
 * with r_j = m_j a_j less all forces on the node but those of the rod. */
#ifndef ROD_STRESS_H
#define ROD_STRESS_H

#include "fish/fish.h"

/* Make the stresses that the strains of the places give (rod_strains) those of the balance; residue: m a less all
 * forces, those of the rod too, N, in the rows ax, ay. Where a node behind a joint or an edge has a prescribed motion
 * its stress stays. */
void rod_stress_balance(const struct fish *fish, const double *residue, const double *y, double *stress);

/* Go on by a step of h seconds: strains that obey stress = stiffness strain + damping dstrain/dt, for stresses that are
 * the parabola through those before the step before, of g seconds, before this step, and now. g = 0: the line through
 * the last two. */
void rod_stress_creep(const struct fish *fish, double h, double g, const double *oldest, const double *before,
                      const double *now, double *strain);

/* The rates of the strains at this moment, as rod_strains has them. */
void rod_stress_rates(const struct fish *fish, const double *strain, const double *stress, double *rate);

#endif
