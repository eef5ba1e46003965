/* flow_derivative.h: derivatives of the velocity at the points of one fish by the unknowns of another fish, as a dense
 * block for each pair. doc/model.md, sections 6 to 9; doc/numerics.md, section 6. Tested by tests/flow/test_flow.c. */
#ifndef FLOW_DERIVATIVE_H
#define FLOW_DERIVATIVE_H

#include "flow/flow.h"

/* Derivative of the equations of fish f that contain the velocity of the fluid with respect to the same unknowns of
 * fish g, column by column: row r is the equation at.ax + r of fish f, so the rows are ax, ay, gamma, circulation. */
struct coupling_block {
    int n_rows, n_columns;
    double *value; /* (n_columns, n_rows) */
};

/* The unknown of column c of the block of fish other. */
int flow_column(const struct fish *other, int c);

/* Number of rows of a fish that contain the velocity of the fluid, and number of columns of the block of fish other. */
int flow_n_rows(const struct fish *fish);
int flow_n_columns(const struct fish *other);

/* Fill block with the derivative of the velocity at the points of fish f by the unknowns of fish g. After
 * flow_gradient. */
void flow_derivative(const struct flow *flow, int f, int g, struct influence_block *block);

/* Fill block with the velocity at the points of fish f induced by each bound vortex of unit strength and by a nascent
 * vortex of unit circulation of fish g: columns gamma (M_g), circulation (1). Positions: as at the last velocity. */
void flow_influence(const struct flow *flow, int f, int g, struct influence_block *block);

/* Fill a block of one column with the velocity at the points of fish f induced by its nascent vortex or stretch of
 * unit circulation. Positions: as at the last velocity. */
void flow_nascent_influence(const struct flow *flow, int f, struct influence_block *block);

#endif
