/* store_compare.h: the file of a comparison of methods: what each run cost and how far it was off. */
#ifndef STORE_COMPARE_H
#define STORE_COMPARE_H

#include "settings.h"
#include "status.h"

struct store_compare_row {
    char method[32];               /* "ida2": implicit of order 2; or an explicit method */
    char status[512];              /* "complete", or why it ended early */
    double rtol, step;             /* NaN: not what was varied */
    double nose_error, tail_error; /* of the fish that is off most at the end, in its lengths; NaN: unknown */
    double wall_time;              /* median, s */
    double steps, evaluations, newton_iterations, jacobians, linear_solves;
};

/* What all are compared with: the implicit method of order 5. */
struct store_compare_reference {
    double rtol;
    double nose_error, tail_error; /* with ten times that tolerance, against it: how good it is, in lengths */
};

/* Write the rows. A file that is there is replaced when the new one is complete. Fails with STATUS_FILE. */
enum status store_compare_write(const char *path, const struct settings *settings,
                                const struct store_compare_reference *reference, int n,
                                const struct store_compare_row *row, const char *command);

/* Read them back; the caller frees *row. Fails with STATUS_FILE or STATUS_MEMORY; *row is then NULL. */
enum status store_compare_read(const char *path, struct store_compare_reference *reference, int *n,
                               struct store_compare_row **row);

/* Row i, from 0, of the reference of its variables; 0 beyond the last. */
struct store_listed;
int store_compare_listed(int i, struct store_listed *listed);

/* ---- shared by the files of the store only */

enum { STORE_COMPARE_SCHEMA = 1 /* attribute shoal_compare */ };

#endif
