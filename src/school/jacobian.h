/* jacobian.h: the Jacobian of the whole school by blocks: a sparse one for every fish, and dense ones for the fish that
 * it couples to. doc/numerics.md, section 6. Tested by tests/school/test_jacobian.c.
 *
 *            unknowns of    fish 0       fish 1       fish 2
 *     equations of fish 0 | own 0      | rows 0 by 1 |            |      fish 0 and 1 are coupled;
 *                  fish 1 | rows 1 by 0| own 1       |            |      rows: ax ... circulation by x, y, gamma,
 *                  fish 2 |            |             | own 2      |      circulation only (struct coupling_block) */
#ifndef JACOBIAN_H
#define JACOBIAN_H

#include "base/sparse.h"
#include "base/status.h"
#include "fish/fish.h"
#include "flow/flow_derivative.h"

/* How the equations of one fish change with the unknowns of another. */
struct jacobian_coupling {
    int other;
    struct coupling_block rows; /* its values lie in jacobian->values */
};

struct jacobian {
    const struct school *school;
    struct sparse **own; /* of each fish; rows and columns are added by their numbers in the school   (n_fish) */

    /* couplings, fish by fish: those of fish f are first[f] .. first[f + 1] - 1 */
    unsigned pattern; /* of the residual that they were made for */
    int *first;       /* (n_fish + 1) */
    int n_couplings;
    int has_contacts;                   /* whether forces between fish that touch are in it */
    struct jacobian_coupling *coupling; /* (n_couplings) */
    double *values;
};

/* A Jacobian without couplings. Fails with STATUS_MEMORY; jacobian_free accepts NULL. */
enum status jacobian_create(struct jacobian **jacobian, const struct school *school);
void jacobian_free(struct jacobian *jacobian);

/* Hold the blocks of the pairs (f, g), f != g, for which coupled[f n_fish + g] is not 0. Fails with STATUS_MEMORY;
 * there are no couplings then. */
enum status jacobian_couple(struct jacobian *jacobian, const unsigned char *coupled, unsigned pattern);

/* Set the rows of the couplings of fish f to zero that are masked in its own block. */
void jacobian_mask_couplings(struct jacobian *jacobian, int f);

/* product = what the couplings of fish f make of all unknowns: its equations from ax to the end. */
void jacobian_multiply_couplings(const struct jacobian *jacobian, int f, const double *unknowns, double *product);

#endif
