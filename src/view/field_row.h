/* field_row.h: the bodies, sheets and wakes of one row of a result file as a state, of which the velocity of the fluid
 * can be summed. Tested by tests/view/test_field_file.c.
 *
 * Rows are written at events: there is no nascent vortex then, and every vortex is where its row says. The rest of the
 * state (velocities, control, works) stays as at the start. */
#ifndef FIELD_ROW_H
#define FIELD_ROW_H

#include "base/status.h"
#include "case/case_values.h"
#include "fish/fish.h"
#include "state/state.h"

struct field_row {
    char *effective; /* the case of the result file */
    struct case_values values;
    struct school *school;
    struct state *state; /* its time, places, sheets and wakes are those of the row */
};

/* Read the row at time t [s], NaN: the last one with its wake, of the result file at path; assignments of
 * solver.threads may change how sums are made. Fails with STATUS_CASE where the file has no such row, STATUS_FILE or
 * STATUS_MEMORY; *row then owns nothing. */
enum status field_row_read(struct field_row *row, const char *path, double t, int n_assignments,
                           const char *const *assignments);

/* Release what a row owns and zero it. */
void field_row_free(struct field_row *row);

#endif
