/* steady_start.h: the start of a search from the steady state of a similar case. Tested by
 * tests/steady/test_steady_start.c and tests/app/test_steady_command.sh. */
#ifndef STEADY_START_H
#define STEADY_START_H

#include "base/arena.h"
#include "base/status.h"
#include "fish/fish.h"

/* Copy the fish of a school into a new array *fish. Free fish get the speeds of the steady state in the file; free fish
 * other than the first also get the places relative to the first fish. The copies share the memory of the original
 * fish. Fails with STATUS_FILE if a file contains no steady state of this number of fish;
 * *fish is then NULL. */
enum status steady_start_read(struct arena *arena, const char *path, const struct school_parameters *school,
                              struct fish_parameters **fish);

/* Set the positions of the free nodes to the shapes of an equilibrium in a file, relative to the nose and to the
 * prescribed direction, in body lengths. arena: for scratch; y: all unknowns of the school. Fails with STATUS_FILE if
 * the bodies in the file have other numbers of nodes. */
enum status steady_start_shapes(struct arena *arena, const char *path, const struct school *school, double *y);

#endif
