/* steady_static.h: the equilibrium of bodies that nothing moves, in a stream: `shoal steady` of a case without a beat.
 * doc/steady.md, "Without a beat". Tested by tests/steady/test_steady_static.c and tests/app/test_steady_command.sh. */
#ifndef STEADY_STATIC_H
#define STEADY_STATIC_H

#include "result/steady_values.h"
#include "run/simulate.h"

/* Whether nothing beats: neither a wave, nor a motion. */
int steady_static_applies(const struct school *school);

/* Fails with STATUS_CASE where such bodies can have no equilibrium, with the reason and the remedy. */
enum status steady_static_refuse(const struct school *school);

/* Bring a simulation at its start to its equilibrium, from the shapes in the file from, of another one; or where that
 * is NULL, has other bodies, or leads nowhere, from rest by a stream that grows; and fill *found, whose array of fish
 * is there. Fails with STATUS_SOLVER where there is none, and says up to which stream there is one; with STATUS_MEMORY
 * or STATUS_STOPPED. */
enum status steady_static_find(struct simulation *simulation, const char *from, struct steady_values *found);

#endif
