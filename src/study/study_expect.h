/* study_expect.h: what a case expects of the ends of its members. Tested by tests/study/test_study.sh. */
#ifndef STUDY_EXPECT_H
#define STUDY_EXPECT_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

/* Print what the case expects of its members, and what is. Fails with STATUS_MISSED when a statement does not hold. */
enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Whether a member has failed as the case expects it to. */
int study_expects_failure(const struct case_values *study, const struct member_file *members, int member);

#endif
