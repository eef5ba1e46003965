/* summation.h: what many vortices cause at many points: every vortex at every point, or by the tree where that is faster and
 * a tolerance allows it. doc/performance.md. Tested by tests/test_summation.c. */
#ifndef SUMMATION_H
#define SUMMATION_H

#include "status.h"
#include "vortices.h"

struct summation; /* workspace, kept for the next sum */

/* Fails with STATUS_MEMORY; summation_free accepts NULL. */
enum status summation_create(struct summation **summation);
void summation_free(struct summation *summation);

/* Whether the tree is the faster way for so many vortices and targets, and the tolerance not 0. */
int summation_by_tree(const struct vortices *vortices, int n_targets, double tolerance);

/* Add to the targets what all vortices cause, by the tree. The error of the velocity at a target is at most a tenth of
 * the tolerance, times the velocity that the vortices would cause there if nothing cancelled, sum |Gamma| / (2 pi
 * sqrt(r^2 + e^2)), which is up to some ten lengths per beat in a school. The same bits for any number of threads.
 * Fails with STATUS_MEMORY. */
enum status summation_induce(struct summation *summation, const struct vortices *vortices, double tolerance,
                             int threads, const struct induced *at);

#endif
