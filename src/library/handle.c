/* handle.c: checks of a run, the row of an event, and the restart of the integrator. */
#include "library/handle.h"

#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

pthread_mutex_t handle_netcdf_lock = PTHREAD_MUTEX_INITIALIZER;

// ---- forks: the parent takes the lock before a fork; the child runs without OpenMP threads, which a fork loses

static void lock_netcdf(void) {
    pthread_mutex_lock(&handle_netcdf_lock);
}

static void unlock_netcdf(void) {
    pthread_mutex_unlock(&handle_netcdf_lock);
}

static void begin_child(void) {
    pthread_mutex_unlock(&handle_netcdf_lock);
    omp_set_max_active_levels(0);
}

static void expect_forks(void) {
    pthread_atfork(lock_netcdf, unlock_netcdf, begin_child);
}

static pthread_once_t forks_once = PTHREAD_ONCE_INIT;

enum status handle_create(struct shoal **run) {
    pthread_once(&forks_once, expect_forks);

    *run = calloc(1, sizeof **run);
    if (*run) (*run)->shared = calloc(1, sizeof *(*run)->shared);
    if (*run && (*run)->shared) {
        atomic_init(&(*run)->shared->n_users, 1);
        (*run)->lock.descriptor = -1;
        return STATUS_OK;
    }

    free(*run);
    *run = NULL;
    return status_fail(STATUS_MEMORY, "out of memory: a run");
}

enum status handle_need(const void *pointer, const char *function, const char *name) {
    return pointer ? STATUS_OK : status_fail(STATUS_CASE, "%s: %s is NULL", function, name);
}

enum status handle_check_fish(const struct shoal *run, int fish, const char *function) {
    TRY(handle_need(run, function, "run"));

    const int n = run->simulation->school->n_fish;
    if (fish >= 0 && fish < n) return STATUS_OK;
    return status_fail(STATUS_CASE, "%s: there is no fish %d: this run has %d fish, numbered from 0", function, fish,
                       n);
}

int handle_has_failed(const struct shoal *run, const char *function) {
    if (run->has_failed) status_fail(STATUS_SOLVER, "%s: the run has failed before: %s", function, run->failure);
    return run->has_failed;
}

void handle_fail(struct shoal *run) {
    run->has_failed = 1;
    snprintf(run->failure, sizeof run->failure, "%s", status_message());
}

const struct result_row *handle_row(struct shoal *run) {
    if (!run->has_row) simulate_row(run->simulation, &run->counts, &run->row);
    if (run->is_renewed) run->counts = run->when_reached;
    run->has_row = 1;
    return &run->row;
}

void handle_forget_row(struct shoal *run) {
    run->has_row = 0;
    run->is_renewed = 0;
    memset(run->is_filled, 0, sizeof run->is_filled);
}

enum status handle_evaluate(const struct simulation *simulation) {
    const struct state *const state = simulation->state;
    return residual_evaluate(simulation->residual, state->t, state->y, state->yp, simulation->residual->scratch);
}

enum status handle_renew(struct shoal *run) {
    if (run->is_renewed) return STATUS_OK;
    run->has_row = 0;

    // a restart that ran out of memory leaves no solver
    if (run->simulation->solver) run->simulation->integrator->count(run->simulation->solver, &run->when_reached);

    enum status status = simulate_renew(run->simulation);
    if (status == STATUS_OK) status = handle_evaluate(run->simulation);
    if (status == STATUS_OK) {
        run->is_renewed = 1;
        return STATUS_OK;
    }
    handle_fail(run);
    return status;
}
