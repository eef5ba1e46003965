/* study_compare.h: comparison of integration methods and tolerances or steps on one case: error, wall time and counts.
 * Tested by tests/study/test_compare.sh.
 *
 * The comparison is a study with a reference (study_comparison.h) in a temporary folder. The members run one at a time,
 * and each round of repeats runs all settings, so that the noise of the machine affects all settings alike. */
#ifndef STUDY_COMPARE_H
#define STUDY_COMPARE_H

#include <stdio.h>

#include "base/status.h"
#include "base/text.h"
#include "case/case_values.h"
#include "study/study.h"

struct study_compare_options {
    const char
        *methods;      /* "ida2,ida5,rk4": ida with the highest order, or words of solver.method; NULL: all adaptive */
    const char *rtols; /* "1e-3,1e-5"; NULL: 1e-3 to 1e-7 */
    const char *steps; /* fixed steps of all methods but ida, instead of tolerances; NULL: none */
    int repeats;
    double reference_rtol; /* of the reference, ida of order 5 */
    const char *path;      /* file to write, in the format of study.nc; NULL: none */
};

/* Run the comparison, print the table and write the file. Used fields of run: command, limit, progress, stop.
 * STATUS_CASE, STATUS_SOLVER (the reference failed), STATUS_STOPPED, STATUS_FILE or STATUS_MEMORY. */
enum status study_compare(const struct case_values *values, const struct study_compare_options *options,
                          const struct study_options *run, FILE *stream);

/* Add the words accepted in methods. */
void study_compare_words(struct text *text);

#endif
