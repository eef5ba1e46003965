/* steady_start.h: the start of a search from the steady state of a similar case. Tested by
 * tests/app/test_steady_command.sh. */
#ifndef STEADY_START_H
#define STEADY_START_H

#include "base/status.h"
#include "fish/fish.h"
#include "fish/parameters.h"

/* Copy the fish of a school into a new array *fish, which the caller frees, and give those that are free the speeds of
 * a steady state, and all of these but the first fish the places that they have there, as that one sees them. The
 * copies share what the fish own. Fails with STATUS_FILE where the file holds no steady state of so many fish, or with
 * STATUS_MEMORY; *fish is then NULL. */
enum status steady_start_read(const char *path, const struct school_parameters *school, struct fish_parameters **fish);

/* Put the nodes that are free where they have been in an equilibrium without a beat, as seen from the nose and the
 * direction that is given there, and in lengths; y: all unknowns of the school. Fails with STATUS_FILE where the file
 * holds no such bodies, with as many nodes, or with STATUS_MEMORY. */
enum status steady_start_shapes(const char *path, const struct school *school, double *y);

#endif
