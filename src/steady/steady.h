/* steady.h: computes the steady state of a case and writes its result, for `shoal steady`: the search, the multipliers,
 * and the last beats. For a case without a beat this is an equilibrium. doc/steady.md. Tested by
 * tests/steady/test_steady.c and tests/app/test_steady_command.sh. */
#ifndef STEADY_H
#define STEADY_H

#include <signal.h>
#include <stdbool.h>

#include "base/status.h"
#include "case/case.h"

/* Progress of a search, reported after every beat. */
struct steady_progress {
    int n_beats, max_beats;
    double t; /* s */
    double residual, tolerance;
    double speed; /* of the first fish, m s-1 */
    double wall_time;
};

struct trace;

/* A steady state as a point: the slow quantities of the case over their scales (steady_map.h), at the end of a beat,
 * and its stability. An equilibrium has no slow quantities. */
struct steady_point {
    struct arena *arena; /* set by the caller: of value */
    int n;
    double *value; /* (n) */
    bool has_beat;
    /* the largest multiplier, and the error of its absolute value; of an equilibrium the rate and the angular frequency
     * of the mode that grows most, s-1, whose error is 0. NaN: unknown */
    double real, imaginary, error;
};

/* Steady states of cases that differ from this one in one number. The search starts from the whole state of the first
 * (steady_neighbour.h), with the slow quantities that follow from the results of all of them. */
struct steady_neighbours {
    const char *state; /* file of the state of the first neighbour, as steady_options.state has written it */
    int n;
    const char *const *result; /* (n) */
    const double *weight;      /* of a result in an extrapolation to this case; their sum is 1         (n) */
};

struct steady_options {
    const char *path; /* of the result file */
    const char *from; /* steady result that supplies the initial speeds and positions; NULL: values of the case */
    const struct steady_neighbours *neighbours; /* neighbours to start from, instead of `from`; NULL: none */
    const char *state;                          /* file that gets the whole state, for neighbours; NULL: none */
    int overwrite;                              /* replace an existing result */
    bool judges_stability;           /* the caller asks for the stability: no warning if the state is unstable */
    const struct steady_point *hold; /* hold these slow quantities until the wake has settled, instead of a search, and
                                        take the result for the steady state; NULL: search */
    struct steady_point *found;      /* gets the steady state; may be NULL */
    const char *command;             /* command line, for the history attribute of the file; may be NULL */
    void (*progress)(const struct steady_progress *progress, void *data); /* may be NULL */
    void (*warn)(const char *line, void *data);                           /* may be NULL */
    void *data;
    struct trace *trace;               /* gets a line for each step that ida attempts; NULL: none */
    const volatile sig_atomic_t *stop; /* a nonzero value stops the search; may be NULL */
};

/* STATUS_CASE, with the reason and the remedy, if a case can have no steady state, without a run: several frequencies,
 * events or gusts that do not divide the beat, free fish that are no formation, bodies without an equilibrium. */
enum status steady_refuse(const struct case_values *values);

/* Find the steady state of a case and write the result file. If the search fails with STATUS_SOLVER, STATUS_CONTACT or
 * STATUS_STOPPED, the file contains the reason and no rows, unless an earlier result exists, which is kept. Without a
 * file: STATUS_CASE if the case can have no steady state, STATUS_FILE, STATUS_MEMORY. */
enum status steady_run(const struct case_values *values, const struct steady_options *options);

/* The change in a beat of the slow quantities of a case, over their scales, if they are held at these values until
 * the wake has settled: 0 for a steady state. value, change: (n). Fails with STATUS_CASE (no steady state, or
 * another number of slow quantities), STATUS_SOLVER, STATUS_CONTACT or STATUS_STOPPED. */
enum status steady_change(const struct case_values *values, int n, const double *value, double *change,
                          const volatile sig_atomic_t *stop);

#endif
