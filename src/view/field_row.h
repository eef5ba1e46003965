/* field_row.h: the bodies, sheets and wakes of one row of a result file as a state, for velocity sums */
#ifndef FIELD_ROW_H
#define FIELD_ROW_H

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "fish/fish.h"
#include "state/state.h"

/* Rows are written at events, without nascent vortices, so the row has the positions of all vortices. The rest of the
 * state (velocities, control, works) stays as at the start. */
struct field_row {
    char *effective; /* the case of the result file */
    struct case_values values;
    struct school *school;
    struct state *state; /* time, positions, sheets and wakes of the row */
};

/* Read the row at time *t [s], or without t (NULL) the last row with a wake, of the result file at path; assignments
 * can set solver.threads for the sums. Fails with STATUS_CASE if the file has no such row, or STATUS_FILE. The path
 * must outlive the arena. */
enum status field_row_read(struct arena *arena, struct field_row **row, const char *path, const double *t,
                           int n_assignments, const char *const *assignments);

#endif
