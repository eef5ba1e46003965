/* diagnostics.h: all derived quantities of a state, for results. doc/model.md, section 13. Tested by
 * tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_H
#define DIAGNOSTICS_H

#include <stdbool.h>

#include "school/diagnostics_momentum.h"
#include "school/residual.h"
#include "state/state.h"

/* Samples of every fish at the events of the last period, and quantities over the period: means,
 * course, amplitude of the tail. doc/model.md, section 13. */

/* Add a sample to the history of every fish; call at every event, before diagnostics_event. */
void diagnostics_remember(struct residual *residual, struct state *state);

/* Course: direction of the displacement of the centre of mass over the last period, rad, rate of the course, rad s-1,
 * and mean speed, m s-1; without displacement all are 0. Returns false in the first period, else true. */
bool diagnostics_course(const struct history *history, double interval, double *course, double *rate, double *speed);

/* Mean of the headings in a history, rad, unwrapped. */
double diagnostics_mean_heading(const struct history *history);

/* Fill the quantities of *to over the last period, or since the start within the first period; com_velocity and
 * desired_heading of *to are input. */
void diagnostics_period(const struct fish *fish, const struct history *history, double interval,
                        struct diagnostics_fish *to);

struct diagnostics *diagnostics_create(struct arena *arena, const struct school *school);

/* Fill *diagnostics at the event of the state, with the flow at this event. */
void diagnostics_event(struct residual *residual, const struct state *state, struct diagnostics *diagnostics);

#endif
