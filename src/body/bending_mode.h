/* bending_mode.h: how fast a body swings by itself. Tested by tests/body/test_bending_mode.c. */
#ifndef BENDING_MODE_H
#define BENDING_MODE_H

#include "fish/fish.h"

/* Frequency of the slowest bending mode of a body in the fluid, straight and small, Hz: free at both ends, or held at
 * the head where its motion is prescribed. With force: pressure in the fluid that a straight sheet moves, with nothing
 * shed. scratch: (6 n_nodes). */
double bending_mode_frequency(const struct fish *fish, double *scratch);

#endif
