/* bending_mode.h: lowest natural frequency of a body. Tested by tests/body/test_bending_mode.c. */
#ifndef BENDING_MODE_H
#define BENDING_MODE_H

#include "fish/fish.h"

/* Frequency of the slowest bending mode of a body in the fluid, Hz, linearised about the straight body: free at both
 * ends, or clamped at a prescribed head. With force: pressure, the added mass is the flow around a straight sheet
 * without shedding. scratch: (6 n_nodes). */
double bending_mode_frequency(const struct fish *fish, double *scratch);

#endif
