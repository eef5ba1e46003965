/* shoal_copy.c: functions of include/shoal.h that copy runs, in memory and as checkpoints. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "case/case.h"
#include "library/handle.h"
#include "result/checkpoint.h"
#include "result/target.h"
#include "run/record.h"
#include "state/state.h"

static enum status copy_state(struct state *state, const struct school *school, const void *from) {
    state_table_copy(state, from, school, true);
    return STATUS_OK;
}

int shoal_clone(struct shoal **copy, struct shoal *run) {
    TRY(handle_need(copy, __func__, "copy"));
    *copy = NULL;
    TRY(handle_need(run, __func__, "run"));
    if (handle_has_failed(run, __func__)) return STATUS_SOLVER;
    TRY(handle_renew(run));

    struct shoal *new;
    TRY(MEMORY_NEW(new, 1, "a run"));
    new->shared = run->shared;
    atomic_fetch_add(&new->shared->n_users, 1);
    new->claim.descriptor[0] = new->claim.descriptor[1] = -1;

    const enum status status = handle_take_up(new, copy_state, run->simulation->state, &run->simulation->totals);
    new->when_reached = run->when_reached;
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
        return status_fail(STATUS_CASE, "%s: the run already writes %s: call shoal_write_end first", __func__,
                           run->record_path);
    }
    if (handle_has_failed(from, __func__)) return STATUS_SOLVER;
    TRY(handle_renew(from));

    handle_forget_row(run);
    run->simulation->totals = from->simulation->totals;
    state_table_copy(run->simulation->state, from->simulation->state, run->simulation->school, true);
    const enum status status = handle_renew(run);
    run->when_reached = from->when_reached;
    run->has_failed = 0;
    if (status != STATUS_OK) handle_fail(run);
    return status;
}

// ---- checkpoints without a result

// no run can have a result file of this name, so `shoal resume` refuses the checkpoint
static const char no_result[] = "(memory)";

int shoal_save(struct shoal *run, const char *path) {
    TRY(handle_need(run, __func__, "run"));
    TRY(handle_need(path, __func__, "path"));
    if (handle_has_failed(run, __func__)) return STATUS_SOLVER;
    TRY(target_check(path, TARGET_CHECKPOINT, true));

    TRY(handle_renew(run));
    struct case_values *const values = &run->shared->values;
    const struct checkpoint checkpoint = {.effective = case_show(values->arena, values),
                                          .result = no_result,
                                          .places = "",
                                          .totals = run->when_reached,
                                          .wall_time = simulate_wall_time(run->simulation)};

    return checkpoint_write(run->arena, path, NULL, &checkpoint, run->simulation->state, run->simulation->school);
}

static enum status load_state(struct state *state, const struct school *school, const void *from) {
    return checkpoint_set_state(from, state, school);
}

static enum status load_checkpoint(struct arena **arena, struct shoal *run, const char *path) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    struct checkpoint checkpoint;
    *arena = arena_create(NULL, path);
    TRY(checkpoint_read(*arena, &checkpoint, path));
    const char *const text = checkpoint.effective;
    enum status status = checkpoint_check_program(&checkpoint);
    if (status == STATUS_OK) status = case_parse(&run->shared->values, text, strlen(text), "case", NULL, 0, NULL);
    if (status == STATUS_OK) status = handle_take_up(run, load_state, &checkpoint, &checkpoint.totals);
    return status == STATUS_FILE ? status_fail(status, "%s: %s", path, status_message()) : status;
}

int shoal_load(struct shoal **run, const char *path) {
    TRY(handle_need(run, __func__, "run"));
    *run = NULL;
    TRY(handle_need(path, __func__, "path"));

    struct shoal *new;
    struct arena *arena = NULL;
    TRY(handle_create(&new));
    const enum status status = load_checkpoint(&arena, new, path);
    arena_free(arena);

    if (status == STATUS_OK) {
        *run = new;
        return STATUS_OK;
    }
    shoal_close(new);
    return status;
}
