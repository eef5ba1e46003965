/* study_compare.h: methods of integration times tolerances or steps on one case: error, wall time and counts. Tested by
 * tests/study/test_compare.sh.
 *
 * This is a study with a reference (study_comparison.h) in a folder of its own, which is removed at the end. Its
 * members run one at a time, and the repeats follow each other round after round, so that the noise of the machine hits
 * all alike. */
#ifndef STUDY_COMPARE_H
#define STUDY_COMPARE_H

#include <stdio.h>

#include "base/status.h"
#include "base/text.h"
#include "case/case_values.h"
#include "study/study.h"

struct study_compare_options {
    const char
        *methods;      /* "ida2,ida5,rk4": ida with its highest order, or words of solver.method; NULL: all adaptive */
    const char *rtols; /* "1e-3,1e-5"; NULL: 1e-3 to 1e-7 */
    const char *steps; /* fixed steps of all methods but ida, instead of tolerances; NULL: none */
    int repeats;
    double reference_rtol; /* of the reference, which is ida of order 5 */
    const char *path;      /* file to write, as study.nc; NULL: none */
};

/* Run all, print the table and write the file. run: command, limit, progress and stop are used. Fails with STATUS_CASE,
 * STATUS_SOLVER (the reference failed), STATUS_STOPPED, STATUS_FILE or STATUS_MEMORY. */
enum status study_compare(const struct case_values *values, const struct study_compare_options *options,
                          const struct study_options *run, FILE *stream);

/* Add the words that methods may have. */
void study_compare_words(struct text *text);

#endif
