/* diagnostics.h: all derived quantities of a state, for results. doc/model.md, section 13. Tested by
 * tests/school/test_diagnostics.c. */
#ifndef DIAGNOSTICS_H
#define DIAGNOSTICS_H

#include "school/diagnostics_values.h"
#include "school/residual.h"
#include "state/state.h"

/* Fails with STATUS_MEMORY. diagnostics_free accepts NULL. */
enum status diagnostics_create(struct diagnostics **diagnostics, const struct school *school);
void diagnostics_free(struct diagnostics *diagnostics);

/* Fill *diagnostics at the event of the state; the residual must have been evaluated at this event. */
void diagnostics_event(struct residual *residual, const struct state *state, struct diagnostics *diagnostics);

#endif
