/* shoal_copy.c: the part of include/shoal.h that copies runs in memory. */
#include <stdlib.h>
#include <string.h>

#include "fish/fish_school.h"
#include "library/handle.h"
#include "state/state_table.h"

static enum status copy_simulation(struct shoal *copy, const struct shoal *run) {
    const struct simulation *const from = run->simulation;
    const struct case_values *const values = &copy->shared->values;
    struct school *school;
    struct state *state;
    TRY(fish_school_create(&school, &values->school));
    enum status status = state_create(&state, school);
    if (status == STATUS_OK) status = state_table_copy(state, from->state, school);
    if (status != STATUS_OK) {
        state_free(state, school);
        fish_school_free(school);
        return status;
    }
    TRY(simulate_take_up(&copy->simulation, values, school, state, &from->totals));
    return handle_evaluate(copy->simulation);
}

int shoal_clone(struct shoal **copy, struct shoal *run) {
    TRY(handle_need(copy, __func__, "copy"));
    *copy = NULL;
    TRY(handle_need(run, __func__, "run"));
    if (handle_has_failed(run, __func__)) return STATUS_SOLVER;
    TRY(handle_renew(run));
    struct shoal *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "out of memory: a run");
    new->shared = run->shared;
    atomic_fetch_add(&new->shared->n_users, 1);
    new->is_renewed = 1;
    new->lock.descriptor = -1;
    new->when_reached = run->when_reached;
    new->result_path = strdup(run->result_path);
    const enum status status =
        new->result_path ? copy_simulation(new, run) : status_fail(STATUS_MEMORY, "out of memory: a path");
    if (status == STATUS_OK) {
        *copy = new;
    } else {
        shoal_close(new);
    }
    return status;
}

int shoal_restore(struct shoal *run, struct shoal *from) {
    TRY(handle_need(run, __func__, "run"));
    TRY(handle_need(from, __func__, "from"));
    if (run == from) return STATUS_OK;
    if (run->shared != from->shared) {
        return status_fail(STATUS_CASE, "%s: the two runs are not copies of one another", __func__);
    }
    if (run->record.file) {
        return status_fail(STATUS_CASE, "%s: the run writes %s: end that with shoal_write_end", __func__,
                           run->record_path);
    }
    if (handle_has_failed(from, __func__)) return STATUS_SOLVER;
    TRY(handle_renew(from));
    handle_forget_row(run);
    run->simulation->totals = from->simulation->totals;
    enum status status = state_table_copy(run->simulation->state, from->simulation->state, run->simulation->school);
    if (status == STATUS_OK) status = handle_renew(run);
    run->when_reached = from->when_reached;
    run->has_failed = 0;
    if (status != STATUS_OK) handle_fail(run);
    return status;
}
