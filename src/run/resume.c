/* resume.c: checks of a checkpoint and its result before a run is resumed. */
#include "run/resume.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "result/netcdf.h"
#include "run/checkpoints.h"

// ---- the checkpoint

// the result is in the folder of the checkpoint
static enum status resume_find_result(struct resume *resume, const char *path) {
    const char *const slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash + 1 - path) : 0, size = length + strlen(resume->checkpoint.result) + 1;
    resume->result = malloc(size);
    if (!resume->result) return status_fail(STATUS_MEMORY, "out of memory: a file name");
    snprintf(resume->result, size, "%.*s%s", (int)length, path, resume->checkpoint.result);
    return STATUS_OK;
}

static enum status resume_check(struct resume *resume, const char *path) {
    const struct checkpoint *const checkpoint = &resume->checkpoint;
    const enum status status = checkpoint_check_program(checkpoint);
    if (status != STATUS_OK) return status_fail(status, "%s: cannot be used: %s", path, status_message());
    if (!resume->result) TRY(resume_find_result(resume, path));
    if (!resume->lock.path) TRY(result_lock_take(&resume->lock, resume->result));
    return result_mark_check(resume->result, &checkpoint->rows, checkpoint->effective, &resume->checksum,
                             &resume->is_complete);
}

static enum status resume_try(struct resume *resume, const char *path) {
    TRY(checkpoint_read(&resume->checkpoint, path));
    const enum status status = resume_check(resume, path);
    if (status != STATUS_OK) checkpoint_free(&resume->checkpoint);
    return status;
}

enum status resume_open(struct resume *resume, const char *path) {
    *resume = (struct resume){.lock = {.descriptor = -1}};
    const enum status status = resume_try(resume, path);
    if (status != STATUS_FILE) return status;
    char reason[4096];
    snprintf(reason, sizeof reason, "%s", status_message());

    // fall back to the previous checkpoint
    char *const previous = checkpoints_previous(path);
    if (!previous) return status_fail(STATUS_MEMORY, "out of memory: a file name");
    if (access(previous, F_OK) == 0 && resume_try(resume, previous) == STATUS_OK) {
        const size_t size = strlen(reason) + strlen(previous) + 32;
        resume->note = malloc(size);
        if (resume->note) snprintf(resume->note, size, "%s; resuming from %s", reason, previous);
    }

    free(previous);
    return resume->note ? STATUS_OK : status_fail(STATUS_FILE, "%s", reason);
}

void resume_close(struct resume *resume) {
    checkpoint_free(&resume->checkpoint);
    result_lock_release(&resume->lock);
    free(resume->result);
    free(resume->note);
    *resume = (struct resume){.lock = {.descriptor = -1}};
}

// ---- the case

// the text of the case file and the study of the case, which the complete case does not contain
static enum status resume_read_origin(const struct resume *resume, struct case_values *values) {
    struct netcdf_reader reader;
    char *study = NULL;
    TRY(netcdf_open(&reader, resume->result));

    free(values->text);
    values->text = NULL;
    enum status status = netcdf_read_string(&reader, "case_text", &values->text);
    if (status == STATUS_OK) status = netcdf_read_string(&reader, "study_case", &study);
    if (status == STATUS_OK) status = netcdf_read_integer(&reader, "study_member", 0, &values->member);
    netcdf_close(&reader);

    if (study && *study) {
        values->study = study;
    } else {
        free(study);
    }

    return status;
}

enum status resume_case(const struct resume *resume, int n_assignments, const char *const *assignments,
                        struct case_values *values) {
    const char *const text = resume->checkpoint.effective;
    TRY(case_parse(values, text, strlen(text), resume->checkpoint.result, NULL, n_assignments, assignments));
    const enum status status = resume_read_origin(resume, values);
    if (status != STATUS_OK) case_free(values);
    return status;
}

// ---- a result that a new run would replace

static int result_is_unfinished(const char *result, const char *path, const char *effective, double *t) {
    struct checkpoint checkpoint;
    struct result_checksum checksum;
    int is_complete = 1;
    if (checkpoint_read(&checkpoint, path) != STATUS_OK) return 0;
    *t = checkpoint.t;
    const int is_good = strcmp(checkpoint.effective, effective) == 0 &&
                        checkpoint_check_program(&checkpoint) == STATUS_OK &&
                        result_mark_check(result, &checkpoint.rows, effective, &checksum, &is_complete) == STATUS_OK;
    checkpoint_free(&checkpoint);
    return is_good && !is_complete;
}

int resume_is_possible(const char *result, const char *checkpoint, const char *effective, double *t) {
    char *const previous = checkpoints_previous(checkpoint);
    const int is_possible = result_is_unfinished(result, checkpoint, effective, t) ||
                            (previous && result_is_unfinished(result, previous, effective, t));
    free(previous);
    return is_possible;
}
