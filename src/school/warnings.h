/* warnings.h: warns about a result although the integration has succeeded. Each warning is one line, about the fish
 * that has the defect most. Tested by tests/school/test_warnings.c. */
#ifndef WARNINGS_H
#define WARNINGS_H

#include "school/diagnostics.h"

enum warning {
    WARNING_CONTACT,
    WARNING_CROSSING,
    WARNING_DIVERGENCE,
    WARNING_ENERGY,
    WARNING_MOMENTUM,
    WARNING_BEATS,
    WARNING_DRIFT,
    WARNING_EVENTS,
    WARNING_SHEET,
    WARNING_MODES,
    WARNING_EDGE,
    WARNING_CHATTER,
    WARNING_PLACE,
    WARNING_CUSP,
    WARNING_TAIL,
    WARNING_FORCE,
    WARNING_PITCH,
    WARNING_STALL,
    WARNING_WAKE,
    N_WARNINGS
};
enum { WARNING_BYTES = 384 /* of a line */ };

/* What each warning is about and when it appears, for the documents and `shoal keys --output`. */
struct warning_words {
    const char *subject, *cause;
};
extern const struct warning_words warnings_words[N_WARNINGS];

/* The length over which the tail bends at the beat frequency, with the added mass there, m; infinite without a beat or
 * without added mass. doc/numerics.md, section 5. */
double warnings_bending_length(const struct fish *fish);

/* Remember the worst divergence: if the present state has diverged further, replace the worst and its fish. Every event
 * calls this for state->divergence and state->diverged. */
void warnings_divergence(const struct school *school, const struct state *state, double worst[N_DIVERGENCE],
                         long *diverged);

/* Fail with STATUS_SOLVER, naming time and remedy, if a value of the state, or a balance that is defined, is not
 * finite; such a state must not become a row of a result. diagnostics: of the same event as the state. */
enum status warnings_refuse(const struct school *school, const struct state *state,
                            const struct diagnostics *diagnostics);

/* Write the line of a warning, without a line break, and return 1; return 0 if the warning does not apply. diagnostics
 * and the last sums of the residual at bodies must be those of the event of the state. */
int warnings_line(enum warning warning, struct residual *residual, const struct state *state,
                  const struct diagnostics *diagnostics, char line[WARNING_BYTES]);

#endif
