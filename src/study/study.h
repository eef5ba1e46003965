/* study.h: all members of a study, each in a process of its own, and what becomes of them. Tested by
 * tests/study/test_study.sh.
 *
 *     FOLDER/member-0000.nc       the result of each member; it holds the study and the member's number
 *     FOLDER/member-0003.failed   why a member failed
 *     FOLDER/study.nc             what the members ended with; made from their files
 *
 * A member is finished when its file is complete and was made by the same case. The next call on the same folder goes
 * on: finished members are passed over, all others run again. */
#ifndef STUDY_H
#define STUDY_H

#include <signal.h>
#include <stdio.h>

#include "base/status.h"
#include "case/case.h"
#include "study/study_file.h"

/* How far it is. */
struct study_progress {
    int n_members; /* that this call is about */
    int n_done;    /* finished, also before this call */
    int n_failed, n_running;
    double part;      /* of this call's work */
    double wall_time; /* of this call, s */
};

struct study_options {
    const char *folder;
    const char *command; /* command line, for the files' history */
    int n_processes;     /* at once; 0: the usable processors, shared by the threads of the members */
    int first, last;     /* members to run; last -1: all, and then the results are gathered and printed */
    int force;           /* remove the results of another study from the folder */
    void (*progress)(const struct study_progress *progress, void *data); /* may be NULL */
    void *data;
    const volatile sig_atomic_t *stop; /* may be NULL */
};

/* Run what is not finished, gather, print the table. Fails with STATUS_CASE (a member is no valid case: nothing has
 * run), STATUS_FILE (the folder holds something else), STATUS_STOPPED, STATUS_SOLVER (some members failed) or
 * STATUS_MISSED (another order than the case expects). */
enum status study_run(const struct case_values *study, const struct study_options *options, FILE *stream);

/* Make study.nc and the table from the files of a folder alone. Fails as study_run does. */
enum status study_gather(const char *folder, const char *command, FILE *stream);

/* Print what a study.nc holds: axes, members and orders. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status study_info(const char *path, FILE *stream);

/* Write what a cluster needs into the folder: study.yaml (the whole study in one file), array.sbatch (its members, bundle
 * of them a task; 0: one, or so many that there are no more than 1000 tasks), gather.sbatch, and submit.sh that submits
 * both. Fails with STATUS_CASE or STATUS_FILE. */
enum status study_slurm(const struct case_values *study, const char *folder, int bundle, FILE *stream);

/* ---- shared by the files of the study only */

/* The path of a file in the folder, or of a member's with an ending such as ".nc"; NULL: out of memory. The caller frees
 * it. */
char *study_path(const char *folder, const char *name);
char *study_member_path(const char *folder, int member, const char *ending);

/* The end of all members in the folder. A file that cannot be read counts as a member that failed. The caller frees
 * them with study_members_free. Fails with STATUS_FILE (a file belongs to another study) or STATUS_MEMORY. */
enum status study_members_read(struct member_file **members, const struct case_values *study, const char *folder);
void study_members_free(struct member_file *members, int n);

/* Write study.nc, print the table and the orders. */
enum status study_report(const struct case_values *study, const char *folder, const char *command, FILE *stream);

/* What three or more levels of a refinement say. sizes: from coarse to fine, falling; values: one point for each size;
 * reference: the exact value, from which orders then are observed with two levels each; NULL: none is given. */
struct study_file_order study_order(int n, const double *sizes, const double (*values)[2], const double *reference);

/* Errors and orders along the axis that is refined; without such an axis there are no groups. The caller frees them with
 * study_file_orders_free, also after a failure. Fails with STATUS_MEMORY. */
enum status study_orders_create(struct study_file_orders *orders, const struct case_values *study,
                                const struct member_file *members);

/* Print them. Fails with STATUS_MISSED when a quantity of a fish has another order than the axis expects, or with
 * STATUS_MEMORY. */
enum status study_orders_print(const struct case_values *study, const struct study_file_orders *orders, FILE *stream);

/* Print what the case expects of its members, and what is. Fails with STATUS_MISSED when a statement does not hold. */
enum status study_expect(const struct case_values *study, const struct member_file *members, FILE *stream);

/* Whether a member has failed as the case expects it to. */
int study_expects_failure(const struct case_values *study, const struct member_file *members, int member);

/* A table of texts that is filled cell by cell and printed in columns, aligned to the right but for the last one. */
enum { STUDY_CELL_BYTES = 32 };
struct study_table {
    int n_rows, n_columns;
    char (*cell)[STUDY_CELL_BYTES]; /* (n_rows, n_columns) */
};

/* Fails with STATUS_MEMORY. */
enum status study_table_create(struct study_table *table, int n_rows, int n_columns);
void study_table_free(struct study_table *table);

/* Fill a cell (printf format; what is too long is cut). */
void study_table_set(const struct study_table *table, int row, int column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));

/* The same for a number, "-" where it is none. */
void study_table_number(const struct study_table *table, int row, int column, const char *format, double number);
void study_table_print(const struct study_table *table, FILE *stream);

/* Print the members with what they set and how they ended, in columns. */
enum status study_print(const struct case_values *study, const struct member_file *members, FILE *stream);

#endif
