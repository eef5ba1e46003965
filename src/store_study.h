/* store_study.h: what a study reads from the files of its members, and the file study.nc that it makes of them. Tested
 * by tests/test_study.c.
 *
 * A quantity is what a variable of a result file holds in its last row, or what is computed from the last rows. */
#ifndef STORE_STUDY_H
#define STORE_STUDY_H

#include "settings.h"
#include "status.h"

struct store_quantity {
    const char *name, *unit, *long_name;
    int of_fish, of_xy; /* one value for every fish; for every direction */
};

/* Quantity number i, from 0; NULL beyond the last. */
const struct store_quantity *store_quantity(int i);

/* The number of a quantity of this name, which must exist. */
int store_quantity_number(const char *name);

/* The end of one member. */
struct store_member {
    int number;      /* of the member; -1: the file belongs to no study */
    char *status;    /* "complete", "failed: why", "stopped", "running", "missing"; never NULL */
    char *study;     /* merged text of the study, "" where there is none */
    char *effective; /* its complete case */
    int n_fish;
    char **fish_name; /* (n_fish) */
    double *value;    /* see store_member_value; NaN: unknown                       (n quantities, n_fish, xy) */
};

/* Read the file of a member. Fails with STATUS_FILE (missing, no NetCDF, cut off) or STATUS_MEMORY; *member then owns
 * nothing. */
enum status store_member_read(struct store_member *member, const char *path);

/* Release what a member owns and zero it. */
void store_member_free(struct store_member *member);

/* One value; NaN where the member has none. fish and xy are 0 where the quantity does not depend on them. */
double store_member_value(const struct store_member *member, int quantity, int fish, int xy);

/* Write study.nc: the members (as many as the study has), what each of them set, and all quantities. A file that is
 * there is replaced when the new one is complete. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status store_study_write(const char *path, const struct settings *study, const struct store_member *member,
                              const char *command);

#endif
