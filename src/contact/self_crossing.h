/* self_crossing.h: test for a body that crosses itself, which is unphysical. A body does not repel itself
 * (doc/model.md, section 16), so a limp body may cross itself. Tested by tests/contact/test_self_crossing.c.
 *
 *     crossed line          crossed outline        folded: the radius of a bend is less than half the thickness
 *        ___                   .-----.
 *       /   \                 ( (===. )                 _
 *       \___/____              '-'===================  | |\
 *           \                                          | '-`====
 */
#ifndef SELF_CROSSING_H
#define SELF_CROSSING_H

#include "state/state.h"

/* Whether the centre line or the outline of a fish crosses itself. The outline follows both sides of the nodes at half
 * the thickness and ends in a point at nose and tail. The cost is linear in n_nodes unless the body turns by more than
 * half a turn. scratch: (4 n_nodes). */
int self_crossing(const struct fish *fish, const double *y, double *scratch);

/* Record the first crossing of any body in state->crossed and state->crossed_t. scratch: (n_unknowns). */
void self_crossing_remember(const struct school *school, struct state *state, double *scratch);

#endif
