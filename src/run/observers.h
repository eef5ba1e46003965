/* observers.h: what is recorded at the events of a run: balances of energy and momentum, histories, and what warnings
 * need. None of it changes the water or the unknowns. The control laws read the histories. doc/model.md, section 13.
 * Tested by tests/school/test_diagnostics.c and tests/school/test_diagnostics_momentum.c. */
#ifndef OBSERVERS_H
#define OBSERVERS_H

#include "run/event.h"
#include "school/residual.h"
#include "state/state.h"

struct observers;
struct observers *observers_create(struct arena *arena, const struct school *school);

/* Before event_water: the rates of the algebraic unknowns, the impulse that wakes lose by decay in the interval, and
 * the energies, in case the event makes the unknowns jump. */
void observers_before(struct observers *observers, struct residual *residual, struct state *state);

/* After event_water or event_start: the impulse that the wakes lost, the momentum balance, the samples of the
 * histories, self-crossings and divergence; once a beat of the fastest fish, how much of the wakes has faded. */
void observers_after(struct residual *residual, struct state *state, const struct event *event);

/* After event_control: the integrals over the steps of the integrator begin anew where unknowns or powers jump. */
void observers_jump(const struct observers *observers, struct residual *residual, struct state *state,
                    const struct event *event);

#endif
