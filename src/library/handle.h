/* handle.h: a run of the public interface: what it holds, and what all of its functions check and do. The functions of
 * include/shoal.h are in shoal.c (the life of a run, its files), shoal_change.c, shoal_copy.c and shoal_read.c. Tested
 * by tests/library/test_shoal.c. */
#ifndef HANDLE_H
#define HANDLE_H

#include <pthread.h>
#include <stdatomic.h>

#include "case/case.h"
#include "result/result_lock.h"
#include "result/result_values.h"
#include "run/checkpoints.h"
#include "run/record.h"
#include "run/simulate.h"
#include "shoal.h"

/* NetCDF keeps a list of open files that threads must not change together. */
extern pthread_mutex_t handle_netcdf_lock;

/* A case, which all copies of a run share. */
struct shared {
    atomic_int n_users;
    struct case_values values;
};

/* A run in memory: what include/shoal.h hands out. */
struct shoal {
    struct shared *shared;
    struct simulation *simulation;
    int is_renewed;                        /* the integration has begun again at this event */
    struct integrator_counts when_reached; /* if so: the counts with which the event was reached */
    int has_failed;
    char failure[1024]; /* message of the step that failed */
    struct record record;
    char *record_path;              /* where it is written */
    struct checkpoints checkpoints; /* beside it */
    struct result_lock lock;
    char *result_path; /* where the case wants it */

    /* what has been read since the last step */
    int has_row;
    struct integrator_counts counts;
    struct result_row row;
    void *buffer[RESULT_TABLE_MAX]; /* of each variable read so far; stays where it is */
    unsigned char is_filled[RESULT_TABLE_MAX];
};

/* A run without a case and without a simulation. Fails with STATUS_MEMORY; *run is then NULL. */
enum status handle_create(struct shoal **run);

/* Fail with STATUS_CASE unless a pointer, or a fish, is there. function: the public one, for the message. */
enum status handle_need(const void *pointer, const char *function, const char *name);
enum status handle_check_fish(const struct shoal *run, int fish, const char *function);

/* Whether a step of the run has failed; there is a message then. */
int handle_has_failed(const struct shoal *run, const char *function);

/* From now on the run has failed with the present message. */
void handle_fail(struct shoal *run);

/* The row of the present event. */
const struct result_row *handle_row(struct shoal *run);

/* What has been read is that of another event. */
void handle_forget_row(struct shoal *run);

/* Find the velocity of the fluid and the muscle at the event, which a row is made of. */
enum status handle_evaluate(const struct simulation *simulation);

/* Begin the integration again. A run for which that fails has failed. */
enum status handle_renew(struct shoal *run);

#endif
