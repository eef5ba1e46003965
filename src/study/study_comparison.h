/* study_comparison.h: a study that compares methods of integration. Tested by tests/study/test_study_comparison.c and
 * tests/study/test_compare.sh.
 *
 * Its one axis sets solver.method, solver.order, solver.rtol and solver.step, in this order. The first member is the
 * reference; the second tells how good that is; of all others those with the same values are repeats. */
#ifndef STUDY_COMPARISON_H
#define STUDY_COMPARISON_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

enum { STUDY_COMPARISON_N_REFERENCES = 2 };

/* Whether a study is a comparison. */
int study_comparison_is(const struct case_values *study);

/* Set nose_error, tail_error and power_error of each member of a comparison: the distance of nose and tail, at the end,
 * from those of the reference, in body lengths, and the relative error of the work of the muscle. In other studies
 * nothing happens. */
void study_comparison_fill_errors(const struct case_values *study, const struct member_file *members);

/* Print a row for each setting: the largest errors of a fish, the median of the wall times of the repeats and half of
 * their range, the counts of the solver; the cost of each method at one error; and why members failed. Fails with
 * STATUS_MEMORY. */
enum status study_comparison_print(const struct case_values *study, const struct member_file *members, FILE *stream);

#endif
