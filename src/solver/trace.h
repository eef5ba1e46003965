/* trace.h: writes a file with one line for each step that ida attempts, for `shoal run --trace`. It answers why a run
 * is slow: which unknown converges badly, and which step failed. The lines are comma-separated under a header, as
 * pandas.read_csv reads them. doc/numerics.md, section 7. Tested by tests/app/test_trace.sh. */
#ifndef TRACE_H
#define TRACE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "fish/fish.h"

struct trace;

/* How an attempted step ended: the error test passed or failed, Newton's iteration did not converge, or the equations
 * or a linear system had no finite value. */
enum trace_result { TRACE_ACCEPTED, TRACE_ERROR_TEST, TRACE_NEWTON, TRACE_NO_VALUE };

/* The corrections of one attempt, made with an old Jacobian and then perhaps with a new one. */
enum { TRACE_MOST_CORRECTIONS = 64 };

struct trace_attempt {
    long event;        /* number of the event at the end of the interval */
    double t, step;    /* end and size of the attempted step, s */
    int order;         /* of BDF */
    int age;           /* how many solutions this Jacobian has served before; 0: it was evaluated in this attempt */
    double cj_ratio;   /* leading coefficient of the step over the one of the Jacobian */
    long gmres;        /* iterations of GMRES */
    int n_corrections; /* the first TRACE_MOST_CORRECTIONS are kept */
    bool is_first[TRACE_MOST_CORRECTIONS]; /* the first one with its Jacobian */
    /* over all unknowns, and over the differential ones if these are tested (else NaN), in tolerances */
    double norm[TRACE_MOST_CORRECTIONS], differential[TRACE_MOST_CORRECTIONS];
    double rate[TRACE_MOST_CORRECTIONS]; /* of the norm since the first correction with this Jacobian, there NaN */
    int worst;                           /* the unknown with the largest last correction, if there was a correction */
    double worst_correction;             /* in tolerances */
};

/* Create the file with its header. overwrite: replace a file that exists. Fails with STATUS_FILE. */
enum status trace_create(struct arena *arena, struct trace **trace, const char *path, bool overwrite);

/* Append a line. */
void trace_write(struct trace *trace, const struct school *school, const struct trace_attempt *attempt,
                 enum trace_result result);

/* Close the file. Fails with STATUS_FILE if any line could not be written. */
enum status trace_close(struct trace *trace);

#endif
