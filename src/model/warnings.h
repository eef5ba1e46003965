/* warnings.h: what is wrong with a result although the integration succeeded. A warning is one line, about the fish for
 * which it is worst. Tested by tests/model/test_warnings.c.
 *
 *     contact   two bodies touch or cross, or are nearer than contact.range and do not repel each other
 *     energy    the energy balance is open by more than 1 % of the work
 *     drift     the speed changes by more than 1 % from beat to beat: means over a beat are not steady
 *     events    fewer than 20 events in a beat
 *     sheet     shedding: sheet with a stretch U Dt too short for the bound vortices at the tail (doc/model.md, 8)
 *     modes     the slowest bending mode is slower than the beat
 *     edge      force: pressure with A_0 above 0.2 at the leading edge: a real flow separates there */
#ifndef WARNINGS_H
#define WARNINGS_H

#include "model/diagnostics.h"

enum warning {
    WARNING_CONTACT,
    WARNING_ENERGY,
    WARNING_DRIFT,
    WARNING_EVENTS,
    WARNING_SHEET,
    WARNING_MODES,
    WARNING_EDGE,
    N_WARNINGS
};
enum { WARNING_BYTES = 384 /* of a line */ };

/* Write the line of a warning, without a line break, and return 1; or return 0 where there is no cause for it. The
 * diagnostics are those of the state. scratch: (n_unknowns). */
int warnings_line(enum warning warning, const struct school *school, const struct state *state,
                  const struct diagnostics *diagnostics, double *scratch, char line[WARNING_BYTES]);

#endif
