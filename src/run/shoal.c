/* shoal.c: the public interface, a thin cover of a simulation. */
#include "shoal.h"

#include <stdlib.h>
#include <string.h>

#include "base/version.h"
#include "case/case.h"
#include "case/sweep_members.h"
#include "run/simulate.h"

struct shoal {
    struct case_values values;
    struct simulation *simulation;
};

static enum status open_run(struct shoal *run, const char *case_path, int n_assignments,
                            const char *const *assignments) {
    TRY(case_read(&run->values, case_path, n_assignments, assignments));
    TRY(sweep_refuse(&run->values));
    return simulate_create(&run->simulation, &run->values);
}

int shoal_open(struct shoal **run, const char *case_path, int n_assignments, const char *const *assignments) {
    *run = NULL;
    struct shoal *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "out of memory: a run");
    const enum status status = open_run(new, case_path, n_assignments, assignments);
    if (status != STATUS_OK) {
        shoal_close(new);
        return status;
    }
    *run = new;
    return STATUS_OK;
}

void shoal_close(struct shoal *run) {
    if (!run) return;
    simulate_free(run->simulation);
    case_free(&run->values);
    free(run);
}

int shoal_step(struct shoal *run) {
    return simulate_step(run->simulation);
}

double shoal_time(const struct shoal *run) {
    return run->simulation->state->t;
}

double shoal_end(const struct shoal *run) {
    return run->values.time.end;
}

int shoal_n_fish(const struct shoal *run) {
    return run->simulation->school->n_fish;
}

int shoal_n_nodes(const struct shoal *run, int fish) {
    return run->simulation->school->fish[fish].n_nodes;
}

int shoal_n_vortices(const struct shoal *run, int fish) {
    return run->simulation->state->wake[fish].n_vortex;
}

void shoal_nodes(const struct shoal *run, int fish, double *x, double *y) {
    const struct fish *const from = &run->simulation->school->fish[fish];
    memcpy(x, run->simulation->state->y + from->at.x, (size_t)from->n_nodes * sizeof *x);
    memcpy(y, run->simulation->state->y + from->at.y, (size_t)from->n_nodes * sizeof *y);
}

void shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation) {
    const struct wake *const wake = &run->simulation->state->wake[fish];
    const size_t size = (size_t)wake->n_vortex * sizeof *x;
    if (size == 0) return;
    memcpy(x, wake->x, size);
    memcpy(y, wake->y, size);
    for (int i = 0; i < wake->n_vortex; i++) circulation[i] = wake_circulation(wake, i);
}

const char *shoal_message(void) {
    return status_message();
}

const char *shoal_version(void) {
    return version_short();
}
