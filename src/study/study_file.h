/* study_file.h: the file study.nc, which a study makes from the files of its members. Tested by
 * tests/study/test_study_file.c. */
#ifndef STUDY_FILE_H
#define STUDY_FILE_H

#include "base/status.h"
#include "case/case.h"
#include "result/result_kind.h"
#include "study/error_report.h"
#include "study/member_file.h"
#include "study/study_orders.h"

enum { STUDY_FILE_SCHEMA = 1 /* attribute shoal_study */ };

/* Write study.nc: the members (as many as the study has), what each of them set, all quantities, and the orders, or
 * where errors is not NULL the error budget. A file that is there is replaced when the new one is complete. Fails with
 * STATUS_FILE or STATUS_MEMORY. */
enum status study_file_write(const char *path, const struct case_values *study, const struct member_file *member,
                             const struct study_orders *orders, const struct error_study *errors, const char *command);

/* Read it back: the study, and its *n_members members as far as the file has them (effective is empty). The caller
 * frees them with case_free and, each, member_file_free. Fails with STATUS_FILE or STATUS_MEMORY; nothing is then
 * owned. */
enum status study_file_read(const char *path, struct case_values *study, struct member_file **members, int *n_members);

/* Row i, from 0, of the list of its variables; 0 beyond the last. */
int study_file_listed(int i, struct result_listed *listed);

#endif
