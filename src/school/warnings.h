/* warnings.h: what is wrong with a result although the integration succeeded. A warning is one line, about the fish for
 * which it is worst. Tested by tests/school/test_warnings.c. */
#ifndef WARNINGS_H
#define WARNINGS_H

#include "school/diagnostics.h"

enum warning {
    WARNING_CONTACT,
    WARNING_CROSSING,
    WARNING_DIVERGENCE,
    WARNING_ENERGY,
    WARNING_MOMENTUM,
    WARNING_DRIFT,
    WARNING_EVENTS,
    WARNING_SHEET,
    WARNING_MODES,
    WARNING_EDGE,
    WARNING_CUSP,
    WARNING_TAIL,
    WARNING_FORCE,
    N_WARNINGS
};
enum { WARNING_BYTES = 384 /* of a line */ };

/* What each of them is about, and its cause: for the documents and `shoal keys --output`. */
struct warning_words {
    const char *subject, *cause;
};
extern const struct warning_words warnings_words[N_WARNINGS];

/* Whether a warning depends on the case alone, so that it is known before a run. */
int warnings_is_of_case(enum warning warning);

/* The length over which the beat bends a tail in the water that leaves there, m; infinite where nothing does. */
double warnings_bending_length(const struct fish *fish);

/* Write the line of a warning, without a line break, and return 1; or return 0 where there is no cause for it. The
 * diagnostics are those of the state. scratch: (n_unknowns). */
int warnings_line(enum warning warning, const struct school *school, const struct state *state,
                  const struct diagnostics *diagnostics, double *scratch, char line[WARNING_BYTES]);

#endif
