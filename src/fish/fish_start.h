/* fish_start.h: the initial state of a fish: natural shape, or straight shape of a prescribed motion, and a uniform
 * velocity. doc/model.md, sections 4 and 5. Tested by tests/fish/test_fish.c. */
#ifndef FISH_START_H
#define FISH_START_H

#include "fish/fish.h"

/* Write the positions and velocities of the nodes at the start into the vector of all unknowns. */
void fish_start(const struct fish *fish, double *y);

#endif
