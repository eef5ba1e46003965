/* flow_derivative.h: how the velocity at the points of one fish depends on the unknowns of another (or of itself), as a
 * dense block for each pair. doc/model.md, sections 6 to 9; doc/numerics.md, section 6. Tested by
 * tests/flow/test_flow.c. */
#ifndef FLOW_DERIVATIVE_H
#define FLOW_DERIVATIVE_H

#include "flow/flow.h"

/* The derivative of those equations of fish f that contain the velocity of the fluid, by the unknowns of fish g that
 * cause it. Row r is the equation at.ax + r of fish f, so the rows are ax, ay, gamma, circulation. */
struct coupling_block {
    int n_rows, n_columns;
    double *value; /* (n_columns, n_rows) */
};

/* The unknown of column c of the block of fish other. */
int flow_column(const struct fish *other, int c);

/* How many rows of a fish contain the velocity of the fluid, and how many columns the block of fish other has. */
int flow_n_rows(const struct fish *fish);
int flow_n_columns(const struct fish *other);

/* Fill block with the derivative of the velocity at the points of fish f by unknowns of fish g. This is either by all
 * of them, after flow_gradient, or by the strengths of the bound vortices and the circulation shed (n_sheet, 1), or by
 * the latter alone, with the positions of the last velocity. */
enum flow_columns { COLUMNS_OF_ALL, COLUMNS_OF_STRENGTHS, COLUMN_OF_SHED };
void flow_derivative(const struct flow *flow, int f, int g, enum flow_columns columns, struct influence_block *block);

#endif
