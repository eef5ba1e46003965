/* rod_stress.h: the stresses of a rod from the balance of momentum, and the strains from the material law, for the
 * powers and energies of section 13. doc/model.md, section 13; doc/numerics.md, section 9. Tested by
 * tests/body/test_rod_stress.c.
 *
 * In a stiff body strains are tiny, and stiffness times a position error gives a spurious moment. Accelerations do not
 * have this error. The momentum balance of the free part of the body behind a joint gives the moment of the joint:
 *
 *     node k ==M_k==> node k+1 ---- ... ---- node N-1        M_k dkappa/dphi = - sum over j > k: (x_j - x_k) x r_j
 *
 * with r_j = m_j a_j minus all forces on the node except the rod forces. */
#ifndef ROD_STRESS_H
#define ROD_STRESS_H

#include "fish/fish.h"

/* Correct the stresses of rod_strains, computed from positions, to the stresses of the momentum balance; residue: m a
 * minus all forces including the rod forces, N, in the rows ax, ay. The stress of a joint or edge is unchanged if a
 * node behind has a prescribed motion. */
void rod_stress_balance(const struct fish *fish, const double *residue, const double *y, double *stress);

/* Advance the strains by a step of h seconds: stress = stiffness strain + damping dstrain/dt. The stress is the
 * parabola through oldest, before and now; the step from oldest to before took g seconds. g = 0: the line through
 * before and now. */
void rod_stress_creep(const struct fish *fish, double h, double g, const double *oldest, const double *before,
                      const double *now, double *strain);

/* The rates of the strains from strains and stresses, as in rod_strains. */
void rod_stress_rates(const struct fish *fish, const double *strain, const double *stress, double *rate);

#endif
