/* member_file.h: reads the final values of a member of a study from its result file. A quantity is the last row of a
 * variable of a result, a number computed from the last rows, or a value of a steady state. Tested by
 * tests/study/test_member_file.c. */
#ifndef MEMBER_FILE_H
#define MEMBER_FILE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"

struct member_file_quantity {
    const char *name, *unit, *long_name;
    bool of_fish, of_xy; /* one value for every fish; for every direction */
    bool is_computed;    /* not the last row of a variable of a result */
    bool of_comparison;  /* NaN except for members of a comparison: compare.h */
    bool of_steady;      /* value of a steady state, not of a row; NaN for runs */
};

/* Quantity number i, from 0; NULL beyond the last. */
const struct member_file_quantity *member_file_quantity(int i);

/* The index of the quantity with this name, -1 if there is none. */
int member_file_quantity_number(const char *name);

/* Status and final values of one member. */
struct member_file {
    int number;         /* of the member; -1: the file belongs to no study */
    const char *status; /* "complete", "failed: reason", "stopped", "running", "missing"; never NULL */
    /* of a member beyond the time limit: t [s], steps, evaluations, Newton iterations, Jacobians, wall time [s];
     * otherwise "" or NULL */
    const char *progress;
    const char *warnings;  /* warnings about the result, one per line, may be ""; NULL only without a result */
    const char *study;     /* merged text of the study, "" without a study */
    const char *effective; /* effective case of the member */
    const char *source;    /* the program and libraries that wrote the file */
    const char *label;     /* of a point of a branch (branch.h): "", "fold" and so on; NULL: no branch */
    const char *file;      /* of a point of a branch: name of the file in the folder */
    double arclength;      /* of a point of a branch: distance along the branch from its first point */
    int n_fish;
    double *value; /* see member_file_value; NaN: unknown                       (n quantities, n_fish, xy) */
};

/* Read a member file into the arena. A run lacks the variables of steady states. Fails with STATUS_FILE (missing or
 * truncated file, variables not written by shoal). */
enum status member_file_read(struct arena *arena, struct member_file *member, const char *path);

/* Allocate the values of a member with n_fish fish, initially NaN. */
void member_file_create_values(struct arena *arena, struct member_file *member, int n_fish);

/* One value; NaN: unknown. fish and xy are 0 if the quantity does not depend on fish or direction. The second function
 * takes the name of a quantity without directions. */
double member_file_value(const struct member_file *member, int quantity, int fish, int xy);
double member_file_number(const struct member_file *member, const char *name, int fish);

/* A value of member m over that of another member; NaN unless both are complete and the other value is not 0. */
double member_file_ratio(const struct member_file *members, int m, int other, int quantity, int fish);

/* Whether the run of the member is complete, or has failed with these words in the message. */
bool member_file_is_complete(const struct member_file *member);
bool member_file_has_failed(const struct member_file *member, const char *words);

/* The address of an existing value. */
double *member_file_place(const struct member_file *member, int quantity, int fish, int xy);

#endif
