/* study_expect.h: expectations of a case on the results of the members. Tested by tests/study/test_study.sh. */
#ifndef STUDY_EXPECT_H
#define STUDY_EXPECT_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

/* Print the expectations and the actual values. Fails with STATUS_MISSED if an expectation is not met. */
enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Whether the failure of a member is expected. */
int study_expects_failure(const struct case_values *study, const struct member_file *members, int member);

#endif
