/* jacobian.h: the Jacobian of the whole school. It consists of one sparse block for each fish, and of one dense block
 * for each pair of fish that are coupled. doc/numerics.md, section 6. Tested by tests/school/test_jacobian.c.
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

/* How the equations of one fish depend on the unknowns of another. */
struct jacobian_coupling {
    int other;
    struct coupling_block rows; /* rows.value points into jacobian->values */
};

struct jacobian {
    struct arena *arena;
    const struct school *school;
    struct sparse **own; /* of each fish; rows and columns are numbered as in the school           (n_fish) */

    /* the couplings, fish after fish: those of fish f are first[f] .. first[f + 1] - 1 */
    unsigned pattern; /* couplings.pattern of the residual when jacobian_couple was called */
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

/* Set product to the couplings of fish f times the unknowns (n_unknowns), for the rows of fish f from ax to the end. */
void jacobian_multiply_couplings(const struct jacobian *jacobian, int f, const double *unknowns, double *product);

/* Number of entries in all blocks. */
long jacobian_non_zeros(const struct jacobian *jacobian);

/* Add factor times the Jacobian to a full matrix of order n, column after column. row_number and column_number say
 * where each equation and each unknown goes; -1: nowhere (n_unknowns). */
void jacobian_add(const struct jacobian *jacobian, double factor, int n, const int *row_number,
                  const int *column_number, double *matrix);

#endif
