/* study_orders.h: a study of convergence: the orders observed along the axis that is refined. Tested by
 * tests/study/test_study_file.c. */
#ifndef STUDY_ORDERS_H
#define STUDY_ORDERS_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"
#include "study/study_file_orders.h"

/* What three or more levels of a refinement say. sizes: from coarse to fine, falling; values: one point for each size;
 * reference: the exact value, from which orders then are observed with two levels each; NULL: none is given. */
struct study_file_order study_order(int n, const double *sizes, const double (*values)[2], const double *reference);

/* Errors and orders along the axis that is refined; without such an axis there are no groups. The caller frees them
 * with study_file_orders_free, also after a failure. Fails with STATUS_MEMORY. */
enum status study_orders_create(struct study_file_orders *orders, const struct case_values *study,
                                const struct member_file *members);

/* Print them. Fails with STATUS_MISSED when a quantity of a fish has another order than the axis expects, or with
 * STATUS_MEMORY. */
enum status study_orders_print(const struct case_values *study, const struct study_file_orders *orders, FILE *stream);

#endif
