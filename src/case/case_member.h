/* case_member.h: the case of one member of a study. Tested by tests/case/test_sweep.c. */
#ifndef CASE_MEMBER_H
#define CASE_MEMBER_H

#include "base/status.h"
#include "case/case_values.h"

/* Fill *values with the case of one member: the case of the study with the values of the member assigned as by --set,
 * without a sweep. Fails with STATUS_CASE, naming the member, or with STATUS_MEMORY. Free with case_free. */
enum status case_member(struct case_values *values, const struct case_values *study, int member);

#endif
