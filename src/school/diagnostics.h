/* diagnostics.h: all quantities that results report but no equation needs, derived from a state. doc/model.md, section
 * 13. Tested by tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_H
#define DIAGNOSTICS_H

#include <stdbool.h>

#include "school/diagnostics_momentum.h"
#include "school/residual.h"
#include "state/state.h"

/* Every fish keeps samples at the events of the last period, from which follow means, the course, and the amplitude of
 * the tail. doc/model.md, section 13. */

/* Add a sample to the history of every fish. Call it at every event, before diagnostics_event. */
void diagnostics_remember(struct residual *residual, struct state *state);

/* Find the course, which is the direction in which the centre of mass has moved over the last period, rad, its rate,
 * rad s-1, and the mean speed, m s-1, over ground or through the water. Without any movement all are 0. Returns false
 * in the first period, then true. */
bool diagnostics_course(const struct history *history, bool through_water, double interval, double *course,
                        double *rate, double *speed);

/* Find what law place sees of the leader, after the first period: the vector from the centre of mass to that of the
 * leader, as a mean over the last period, m, its change in this period, m, and the mean heading of the leader, rad,
 * unwrapped. */
void diagnostics_leader(const struct history *history, double away[2], double change[2], double *heading);

/* The mean of the headings in a history, rad, unwrapped. */
double diagnostics_mean_heading(const struct history *history);

/* Fill the quantities of *to that are over the last period, or since the start while that is shorter. com_velocity and
 * desired_heading of *to are input. */
void diagnostics_period(const struct fish *fish, const struct history *history, double interval,
                        struct diagnostics_fish *to);

struct diagnostics *diagnostics_create(struct arena *arena, const struct school *school);

/* Fill *diagnostics at the event of the state, with the flow at this event. */
void diagnostics_event(struct residual *residual, const struct state *state, struct diagnostics *diagnostics);

#endif
