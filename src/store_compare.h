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

/* Write the rows. A file that is there is replaced when the new one is complete. Fails with STATUS_FILE. */
enum status store_compare_write(const char *path, const struct settings *settings, int n,
                                const struct store_compare_row *row, const char *command);

#endif
