/* study_file.h: the file study.nc, which is gathered from the member files of a study. Tested by
 * tests/study/test_study_file.c. */
#ifndef STUDY_FILE_H
#define STUDY_FILE_H

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"
#include "result/result_kind.h"
#include "study/error_report.h"
#include "study/member_file.h"
#include "study/study_orders.h"

enum { STUDY_FILE_SCHEMA = 1 /* attribute shoal_study */ };

/* Write study.nc: all members of the study, values of the swept keys, all quantities, the orders and, unless errors is
 * NULL, the error budget. The complete new file replaces an existing file. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status study_file_write(struct arena *arena, const char *path, const struct case_values *study,
                             const struct member_file *member, const struct study_orders *orders,
                             const struct error_study *errors, const char *command);

/* Read study.nc: the study and the *n_members members, without the effective cases. The caller frees the study with
 * case_free and the members with study_folder_free_members. On STATUS_FILE or STATUS_MEMORY the caller owns nothing. */
enum status study_file_read(const char *path, struct case_values *study, struct member_file **members, int *n_members);

/* Row i, from 0, of the list of variables; 0 beyond the last row. */
int study_file_listed(int i, struct result_listed *listed);

#endif
