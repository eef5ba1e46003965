/* jacobian.h: the Jacobian of the whole school by blocks: one sparse block per fish, one dense block per coupled pair
 * of fish. doc/numerics.md, section 6. Tested by tests/school/test_jacobian.c.
 *
 *            unknowns of    fish 0       fish 1       fish 2
 *     equations of fish 0 | own 0      | rows 0 by 1 |            |      fish 0 and 1 are coupled;
 *                  fish 1 | rows 1 by 0| own 1       |            |      rows: ax ... circulation by x, y, gamma,
 *                  fish 2 |            |             | own 2      |      circulation only (struct coupling_block) */
#ifndef JACOBIAN_H
#define JACOBIAN_H

#include "base/sparse.h"
#include "fish/fish.h"
#include "flow/flow_derivative.h"

/* Derivatives of the equations of one fish by the unknowns of another fish. */
struct jacobian_coupling {
    int other;
    struct coupling_block rows; /* rows.value points into jacobian->values */
};

struct jacobian {
    struct arena *arena;
    const struct school *school;
    struct sparse **own; /* of each fish; rows and columns are numbered as in the school           (n_fish) */

    /* couplings, fish by fish: fish f has the couplings first[f] .. first[f + 1] - 1 */
    unsigned pattern; /* couplings.pattern of the residual at jacobian_couple */
    int *first;       /* (n_fish + 1) */
    int n_couplings;
    bool has_contacts;                  /* whether the couplings contain contact forces */
    struct jacobian_coupling *coupling; /* (n_couplings) */
    double *values;                     /* of all couplings */
};

/* A Jacobian without couplings. */
struct jacobian *jacobian_create(struct arena *arena, const struct school *school);

/* Allocate the blocks of the pairs (f, g), f != g, for which coupled[f n_fish + g] is not 0. */
void jacobian_couple(struct jacobian *jacobian, const unsigned char *coupled, unsigned pattern);

/* product = couplings of fish f times unknowns (n_unknowns): the rows of fish f from ax to the end. */
void jacobian_multiply_couplings(const struct jacobian *jacobian, int f, const double *unknowns, double *product);

/* Number of entries in all blocks. */
long jacobian_non_zeros(const struct jacobian *jacobian);

/* Add factor times the Jacobian to a full matrix of order n, column after column; row_number, column_number: place of
 * each equation and unknown in the matrix, -1: none (n_unknowns). */
void jacobian_add(const struct jacobian *jacobian, double factor, int n, const int *row_number,
                  const int *column_number, double *matrix);

#endif
