/* member_file.h: what a study reads from the result of a member. Tested by tests/study/test_member_file.c.
 *
 * A quantity is what a variable of a result holds in its last row, what is computed from the last rows, or a value of a
 * steady state. */
#ifndef MEMBER_FILE_H
#define MEMBER_FILE_H

#include "base/status.h"

struct member_file_quantity {
    const char *name, *unit, *long_name;
    int of_fish, of_xy; /* one value for every fish; for every direction */
    int is_computed;    /* not the last row of a variable of a result */
    int of_comparison;  /* NaN but for the members of a comparison: study_comparison.h */
    int of_steady;      /* NaN but for members that are steady states; not of a row */
};

/* Quantity number i, from 0; NULL beyond the last. */
const struct member_file_quantity *member_file_quantity(int i);

/* The number of a quantity of this name, which must exist; the number of all. */
int member_file_quantity_number(const char *name);
int member_file_n_quantities(void);

/* The end of one member. */
struct member_file {
    int number;      /* of the member; -1: the file belongs to no study */
    char *status;    /* "complete", "failed: why", "stopped", "running", "missing"; never NULL */
    char *warnings;  /* about its result, a line each, "" where there is none; NULL only where there is no result */
    char *study;     /* merged text of the study, "" where there is none */
    char *effective; /* its complete case */
    int n_fish;
    double *value; /* see member_file_value; NaN: unknown                       (n quantities, n_fish, xy) */
};

/* Read the file of a member. A variable that gives a quantity may be missing, as in the file of an earlier version.
 * Fails with STATUS_FILE (no file, not a whole one, other variables than shoal writes) or STATUS_MEMORY; *member then
 * owns nothing. */
enum status member_file_read(struct member_file *member, const char *path);

/* Make room for the values of a member with n_fish, NaN at first. Fails with STATUS_MEMORY. */
enum status member_file_create_values(struct member_file *member, int n_fish);

/* Release what a member owns and zero it. */
void member_file_free(struct member_file *member);

/* One value; NaN where the member has none. fish and xy are 0 where the quantity does not depend on them. */
double member_file_value(const struct member_file *member, int quantity, int fish, int xy);

/* Where that value is; it must exist. */
double *member_file_place(const struct member_file *member, int quantity, int fish, int xy);

#endif
