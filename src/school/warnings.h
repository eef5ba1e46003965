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

/* A warning: what it is about and when it appears, for the documents and `shoal keys --output`; and a function that
 * writes the line and returns the size of the defect, of which more than 1 is a warning. The function is either about a
 * fish, whose name in the line is who, or about the school. */
struct warning_subject;
struct warning_row {
    const char *subject, *cause;
    double (*of_fish)(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]);
    double (*of_school)(const struct warning_subject *subject, char line[WARNING_BYTES]);
};
extern const struct warning_row warnings_table[N_WARNINGS];

/* The length over which the tail bends at the beat frequency, with the added mass there, m; infinite without a beat or
 * without added mass. doc/numerics.md, section 5. */
double warnings_bending_length(const struct fish *fish);

/* Remember the worst divergence: if the present state has diverged further, replace the worst and its fish. Every event
 * calls this for state->divergence and state->diverged. */
void warnings_divergence(const struct school *school, const struct state *state, double worst[N_DIVERGENCE],
                         long *diverged);

/* Remember the most faded wake: if at the event of the state a fish misses more of the velocity of other fish's wakes,
 * because they decay, than the worst so far, replace the worst and its fish. A run calls this once a beat for
 * state->fading and state->faded, because a follower may have left the wake again when the run ends. */
void warnings_fading(struct residual *residual, const struct state *state, double worst[N_FADING], long *faded);

/* Fail with STATUS_SOLVER, naming time and remedy, if a value of the state, or a balance that is defined, is not
 * finite; such a state must not become a row of a result. diagnostics: of the same event as the state. */
enum status warnings_refuse(const struct school *school, const struct state *state,
                            const struct diagnostics *diagnostics);

/* Write the line of a warning, without a line break, and return true; return false if the warning does not apply.
 * diagnostics and the last sums of the residual at bodies must be those of the event of the state. */
bool warnings_line(enum warning warning, struct residual *residual, const struct state *state,
                   const struct diagnostics *diagnostics, char line[WARNING_BYTES]);

#endif
