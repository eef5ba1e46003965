/* handle.h: struct shoal, a run of the public interface, and the parts common to the public functions. The functions of
 * include/shoal.h are in shoal.c (the life of a run, reading, result files), shoal_change.c and shoal_copy.c. Tested by
 * tests/library/test_shoal.c and test_handle.c.
 *
 * Public functions request memory in parts only, which handle_call runs within the boundary of memory
 * (base/arena.h). */
#ifndef HANDLE_H
#define HANDLE_H

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

#include "base/arena.h"
#include "case/case.h"
#include "result/checkpoint.h"
#include "result/durable.h"
#include "result/result_file.h"
#include "run/checkpoints.h"
#include "run/record.h"
#include "run/simulate.h"
#include "shoal.h"

/* A case, shared by all copies of a run. */
struct shared {
    struct arena *arena; /* of this struct */
    atomic_int n_users;
    struct case_values values;
};

/* A run in memory: the handle of include/shoal.h. */
struct shoal {
    struct arena *arena; /* of this struct, the simulation and the buffers */
    struct shared *shared;
    struct simulation *simulation;
    struct state *before;                  /* state at the last event, during a step that can be stopped; or NULL */
    bool is_renewed;                       /* the integrator has restarted at this event */
    struct integrator_counts when_reached; /* if is_renewed: the counts before the restart */
    bool is_torn; /* lack of memory has ended a computation; whatever is not state can only be renewed or freed */
    bool has_failed;
    char failure[1024]; /* message of the step that failed */
    struct record record;
    char *record_path;              /* path of the result file */
    struct checkpoints checkpoints; /* beside the result file */
    struct durable_claim claim;
    char *result_path; /* path of the result file by the case */

    /* variables read since the last step */
    bool has_row;
    struct integrator_counts counts;
    struct result_row row;
    void *buffer[RESULT_TABLE_MAX]; /* (largest size of the variable); never moves */
    bool is_filled[RESULT_TABLE_MAX];
};

/* A part of a public function. */
typedef enum status handle_part(struct shoal *run, const void *data);

/* Call a part within the boundary of the library (base/arena.h): every request for memory is made in such a part, and
 * what has to be undone after a lack of memory is undone by the caller. handle_with_netcdf also holds the lock of
 * NetCDF, which has a global list of open files that is not thread-safe. Both fail as the part, or with
 * STATUS_MEMORY. */
enum status handle_call(struct shoal *run, handle_part *part, const void *data);
enum status handle_with_netcdf(struct shoal *run, handle_part *part, const void *data);

/* Create a run with a case that fill reads, or with the case of a run; fill completes the run. Fails as fill, or with
 * STATUS_MEMORY; *run is then NULL. */
enum status handle_create(struct shoal **run, const struct shoal *of, handle_part *fill, const void *data);

/* Release a run without a result file, and the case after the last copy. */
void handle_release(struct shoal *run);

/* The flag of the last shoal_listen of this thread. */
extern _Thread_local const volatile sig_atomic_t *handle_stop;

/* Fail with STATUS_CASE for a NULL pointer, or for an unknown fish. function: name of the public function. */
enum status handle_need(const void *pointer, const char *function, const char *name);
enum status handle_check_fish(const struct shoal *run, int fish, const char *function);

/* Fail with STATUS_SOLVER if a step of the run has failed. */
enum status handle_check_alive(const struct shoal *run, const char *function);

/* Mark the run as failed with the present message. */
void handle_fail(struct shoal *run);

/* The row of the present event. */
const struct result_row *handle_row(struct shoal *run);

/* Invalidate the row and the variables read so far: the event has changed. */
void handle_forget_row(struct shoal *run);

/* Evaluate the residual at the event: velocities of the flow and actuation, input of handle_row. */
enum status handle_evaluate(const struct simulation *simulation);

/* Restart the integrator. On failure the run is marked as failed. */
enum status handle_renew(struct shoal *run);

/* Renew a run that lack of memory has left torn. Fails if a step of the run has failed, or as handle_renew. */
enum status handle_mend(struct shoal *run, const char *function);

/* Copy a state, of a run with the same case, into the run and restart the integrator: a part for handle_call. */
enum status handle_restore(struct shoal *run, const void *state);

/* Create the simulation of a run from a copy of a state, or from a checkpoint. Fails as simulate_take_up or
 * checkpoint_set_state. */
enum status handle_take_up(struct shoal *run, const struct state *from, const struct checkpoint *checkpoint,
                           const struct integrator_counts *totals);

/* Change gait or goal of a fish at an event (doc/model.md, section 11): set the value of a key: "wave.amplitude",
 * "wave.frequency", "control.bias", "control.desired_heading" (one number, in the unit of the case file),
 * "control.offset" (x, y, m) or "control.waypoints" (pairs, m). Fails with STATUS_CASE for an invalid value, or if the
 * control law of the fish ignores the key; the fish is then unchanged. */
enum status handle_set_key(const struct simulation *simulation, int fish, const char *key, int n, const double *values);

#endif
