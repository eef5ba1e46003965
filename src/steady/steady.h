/* steady.h: from a case to the file of its steady state: the search, its multipliers, and the last beats; of a case
 * without a beat its equilibrium.
 * doc/steady.md. Tested by tests/steady/test_steady.c and tests/app/test_steady_command.sh. */
#ifndef STEADY_H
#define STEADY_H

#include <signal.h>

#include "base/status.h"
#include "case/case.h"

/* What a search tells after every beat. */
struct steady_progress {
    int n_beats, max_beats;
    double t; /* s */
    double residual, tolerance;
    double speed; /* of the first fish, m s-1 */
    double wall_time;
};

struct steady_options {
    const char *path;    /* of the result file */
    const char *from;    /* result of a steady state with whose speeds and places this one starts; NULL: the case's */
    int overwrite;       /* replace one that exists */
    const char *command; /* command line, for the file's history */
    void (*progress)(const struct steady_progress *progress, void *data); /* may be NULL */
    void (*warn)(const char *line, void *data);                           /* may be NULL */
    void *data;
    const volatile sig_atomic_t *stop; /* the search stops once this is not 0; may be NULL */
};

/* Find the steady state of a case, and write its result file. Where the search fails with STATUS_SOLVER, STATUS_CONTACT
 * or STATUS_STOPPED the file has no rows, and says why; an earlier result, which it would replace, stays. Fails with
 * STATUS_CASE where the case can have no steady state, with STATUS_FILE or STATUS_MEMORY; there is no file then. */
enum status steady_run(const struct case_values *values, const struct steady_options *options);

#endif
