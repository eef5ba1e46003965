/* diagnostics_history.h: samples of every fish at the events of the last period, and what is stated over it: means,
 * course, amplitude of the tail. doc/model.md, section 13. Tested by tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_HISTORY_H
#define DIAGNOSTICS_HISTORY_H

#include "school/diagnostics_values.h"
#include "school/residual.h"
#include "state/state.h"

/* Take a sample of every fish into its history; at every event, before diagnostics_event. */
void diagnostics_remember(struct residual *residual, struct state *state);

/* The direction in which the centre of mass has gone in the last period, rad, and the rate at which that direction
 * changes, rad s-1. Returns whether there is one: not before a whole period has passed, nor where it has not moved. */
int diagnostics_course(const struct history *history, double *course, double *rate);

/* Mean of the headings in a history, rad, unwrapped. */
double diagnostics_mean_heading(const struct history *history);

/* What *to, whose com_velocity and desired_heading are known, states over the last period, or since the start where
 * that is less. */
void diagnostics_period(const struct fish *fish, const struct history *history, double interval,
                        struct diagnostics_fish *to);

#endif
