/* compare.h: methods of integration times tolerances (or steps) on one case: error, wall time and counts. Tested by
 * tests/study/test_compare.sh.
 *
 * Each run is a process of its own, one at a time; the repeats go round and round through all runs, so that the noise
 * of the machine hits all alike. The error is the distance of noses and tails, at the end, to those of a reference. */
#ifndef COMPARE_H
#define COMPARE_H

#include <signal.h>
#include <stdio.h>

#include "base/status.h"
#include "case/case.h"

struct compare_options {
    const char *methods; /* "ida2,ida5,rk4": idaN is the implicit method of order N; NULL: all */
    const char *rtols;   /* "1e-3,1e-5"; NULL: 1e-3 to 1e-7 */
    const char *steps;   /* fixed steps for the explicit methods instead of tolerances; NULL: none */
    int repeats;
    double reference_rtol; /* of the reference, which is implicit of order 5 */
    double limit;          /* a run is given up after this wall time, s */
    const char *path;      /* file to write; NULL: none */
    const char *command;
    int quiet;
    const volatile sig_atomic_t *stop; /* may be NULL */
};

/* Run all, print a table and write the file. Fails with STATUS_CASE, STATUS_SOLVER (the reference failed),
 * STATUS_STOPPED, STATUS_FILE or STATUS_MEMORY. */
enum status compare_run(const struct case_values *values, const struct compare_options *options, FILE *stream);

/* Print what the file of a comparison holds. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status compare_info(const char *path, FILE *stream);

#endif
