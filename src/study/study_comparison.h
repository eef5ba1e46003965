/* study_comparison.h: a study that compares integration methods. Tested by tests/study/test_study_comparison.c and
 * tests/study/test_compare.sh.
 *
 * The single axis sets solver.method, solver.order, solver.rtol and solver.step, in this order. Member 0 is the
 * reference; member 1 gives the error of the reference; further members with equal values are repeats. */
#ifndef STUDY_COMPARISON_H
#define STUDY_COMPARISON_H

#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

enum { STUDY_COMPARISON_N_REFERENCES = 2 };

/* Whether a study is a comparison. */
int study_comparison_is(const struct case_values *study);

/* Set nose_error, tail_error and power_error of each member of a comparison: final distance of nose and tail from the
 * reference, in body lengths, and relative error of the muscle work. Other studies are unchanged. */
void study_comparison_fill_errors(const struct case_values *study, const struct member_file *members);

/* Print a row for each setting: largest errors over the fish, median and half range of the wall times of the repeats,
 * solver counts. Print the cost of each method at a common error, and the reasons of failed members. Fails with
 * STATUS_MEMORY. */
enum status study_comparison_print(struct arena *arena, const struct case_values *study,
                                   const struct member_file *members, FILE *stream);

#endif
