/* fish_body.h: from the parameters of a fish to the constants of edges and joints: shape, masses, stiffness,
 * damping, drag and added mass. doc/model.md, sections 1, 3 and 9. Tested by tests/fish/test_fish.c. */
#ifndef FISH_BODY_H
#define FISH_BODY_H

#include "base/status.h"
#include "fish/fish.h"

/* Set all data per node, edge and joint except the gait. Numbers of nodes, length and edge_length of the fish are set.
 * Fails with STATUS_MEMORY. */
enum status fish_body_set(struct fish *fish, const struct fish_parameters *from, const struct fluid_parameters *fluid);

#endif
