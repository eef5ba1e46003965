/* compare.h: compares integration methods, with several tolerances or steps, by error, wall time and counts. Tested by
 * tests/study/test_compare.c and test_compare_command.sh.
 *
 * A comparison is a study with a reference in a temporary folder. Its members run one at a time, and each round of
 * repeats runs all settings, so that the noise of the machine affects them alike.
 *
 * The only axis sets solver.method, solver.order, solver.rtol and solver.step, in this order. Member 0 is the
 * reference, member 1 tells the error of the reference, and further members with equal values are repeats. */
#ifndef COMPARE_H
#define COMPARE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "base/text.h"
#include "case/case_values.h"
#include "study/member_file.h"

enum { COMPARE_N_REFERENCES = 2 };

struct compare_options {
    const char
        *methods;      /* "ida,ida5,rk4": words of solver.method, or ida with this highest order; NULL: all adaptive */
    const char *rtols; /* "1e-3,1e-5"; NULL: 1e-3 to 1e-7 */
    const char *steps; /* fixed steps of all methods but ida, instead of tolerances; NULL: none */
    int repeats;
    double reference_rtol; /* of the reference, ida of order 5 */
    const char *path;      /* file to write, in the format of study.nc; NULL: none */
};

/* Create the study of a comparison, the case with a sweep of the references and all rounds of repeats; only the last
 * row is written. Fails with STATUS_CASE. study_compare runs the study. */
enum status compare_create(struct arena *arena, struct case_values **study, const struct case_values *values,
                           const struct compare_options *options);

/* Add the words accepted in methods. */
void compare_words(struct text *text);

/* Whether a study is a comparison. */
bool compare_is(const struct case_values *study);

/* Set the quantities of a comparison for each member: nose_error and tail_error, the final distance from the reference
 * in body lengths; power_error, the relative error of the muscle work; evaluations_to_end and wall_time_to_end. Of a
 * member beyond the time limit, time and counts become those that it reached, and the last two are extrapolated from
 * them in proportion to time. Other studies are unchanged. */
void compare_fill(const struct case_values *study, const struct member_file *members);

/* Print a row for each setting: largest errors over the fish, median and half range of the wall times of the repeats,
 * solver counts, with a ~ where they are extrapolated. Print the cost of each method at a common error, and the reasons
 * of failed members. */
void compare_print(struct arena *arena, const struct case_values *study, const struct member_file *members,
                   FILE *stream);

#endif
