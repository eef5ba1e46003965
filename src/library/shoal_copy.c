/* shoal_copy.c: the functions of include/shoal.h that copy runs, in memory and as checkpoints. */
#include <string.h>

#include "case/case.h"
#include "library/handle.h"
#include "result/checkpoint.h"
#include "result/target.h"
#include "run/record.h"
#include "state/state.h"

static enum status clone_run(struct shoal *copy, const void *data) {
    const struct shoal *const run = data;
    copy->result_path = arena_text(copy->arena, "%s", run->result_path);
    TRY(handle_take_up(copy, run->simulation->state, NULL, &run->simulation->totals));
    copy->when_reached = run->when_reached;
    return STATUS_OK;
}

int shoal_clone(struct shoal **copy, struct shoal *run) {
    TRY(handle_need(copy, __func__, "copy"));
    *copy = NULL;
    TRY(handle_check_alive(run, __func__));
    TRY(handle_renew(run));
    return handle_create(copy, run, clone_run, run);
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
    TRY(handle_check_alive(from, __func__));
    TRY(handle_renew(from));

    handle_forget_row(run);
    run->simulation->totals = from->simulation->totals;
    const enum status status = handle_call(run, handle_restore, from->simulation->state);
    run->when_reached = from->when_reached;
    run->has_failed = false;
    if (status != STATUS_OK) handle_fail(run);
    return status;
}

// ---- checkpoints without a result

// no run can have a result file of this name, so `shoal resume` refuses the checkpoint
static const char no_result[] = "(memory)";

/* The path of a checkpoint, and the arena in which it is made, which the caller frees. */
struct saving {
    const char *path;
    struct arena **arena;
};

static enum status save_run(struct shoal *run, const void *data) {
    const struct saving *const saving = data;
    const char *const path = saving->path;
    struct arena *const arena = *saving->arena = arena_create(NULL, path);
    const struct checkpoint checkpoint = {.effective = case_show(arena, &run->shared->values),
                                          .result = no_result,
                                          .places = "",
                                          .totals = run->when_reached,
                                          .wall_time = simulate_wall_time(run->simulation)};
    return checkpoint_write(arena, path, NULL, &checkpoint, run->simulation->state, run->simulation->school);
}

int shoal_save(struct shoal *run, const char *path) {
    TRY(handle_check_alive(run, __func__));
    TRY(handle_need(path, __func__, "path"));
    TRY(target_check(path, TARGET_CHECKPOINT, true));
    TRY(handle_renew(run));
    struct arena *arena = NULL;
    const enum status status = handle_call(run, save_run, &(struct saving){path, &arena});
    arena_free(arena);
    return status;
}

static enum status load_run(struct shoal *run, const void *data) {
    const char *const path = data;
    struct arena *const arena = arena_create(run->arena, path);
    struct checkpoint checkpoint;
    TRY(checkpoint_read(arena, &checkpoint, path));
    const char *const text = checkpoint.effective;
    enum status status = checkpoint_check_program(&checkpoint);
    if (status == STATUS_OK) status = case_parse(&run->shared->values, text, strlen(text), "case", NULL, 0, NULL);
    if (status == STATUS_OK) status = handle_take_up(run, NULL, &checkpoint, &checkpoint.totals);
    if (status == STATUS_FILE) return status_fail(status, "%s: %s", path, status_message());
    TRY(status);
    run->result_path = record_path(run->arena, &run->shared->values);
    arena_free(arena);
    return STATUS_OK;
}

int shoal_load(struct shoal **run, const char *path) {
    TRY(handle_need(run, __func__, "run"));
    *run = NULL;
    TRY(handle_need(path, __func__, "path"));
    return handle_create(run, NULL, load_run, path);
}
