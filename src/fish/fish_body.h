/* fish_body.h: the constants of every edge, joint and node of a fish. doc/model.md, sections 1, 3 and 9. Tested by
 * tests/fish/test_fish.c. */
#ifndef FISH_BODY_H
#define FISH_BODY_H

#include "base/arena.h"
#include "fish/fish.h"

/* Set all data per node, edge and joint, except the gait, of fish f, an element of the array of all fish. Numbers of
 * nodes, length and edge_length of the fish are set. */
void fish_body_set(struct arena *arena, struct fish *fish, int f, const struct fish_parameters *from,
                   const struct fluid_parameters *fluid);

#endif
