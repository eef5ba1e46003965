/* simulate_run.h: run of a case from the start, or from a checkpoint, to the end; rows and checkpoints that are due are
 * written. doc/reliability.md. Tested by tests/run/test_simulate.c and tests/run/test_resume.sh. */
#ifndef SIMULATE_RUN_H
#define SIMULATE_RUN_H

#include <signal.h>
#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"

struct trace;

/* Progress of a run, reported after every event, and after every 100 steps of the integrator in between. */
struct simulate_progress {
    double t, end;
    long event; /* the last one */
    /* of the integrator, in total */
    long steps, evaluations, newton_iterations, jacobians;
    int n_vortices; /* of all fish */
    double wall_time;
};

struct simulate_options {
    const char *path;    /* of the result file */
    bool overwrite;      /* replace an existing result */
    const char *command; /* command line, for the history attribute */
    /* times of checkpoints in addition to time.checkpoint_interval, s: "0.3,1.25"; NULL: none. Each time must be the
     * time of an event */
    const char *checkpoint_at;
    /* called with the case and the path of the result before the simulation starts; a failure cancels the run; may be
     * NULL */
    enum status (*begin)(const struct case_values *values, const char *path, void *data);
    void (*progress)(const struct simulate_progress *progress, void *data); /* may be NULL */
    /* called with each warning: about the result before the run returns, about a damaged checkpoint at the start; may
     * be NULL */
    void (*warn)(const char *line, void *data);
    /* called with each note for the user, such as another processor at the checkpoint; may be NULL */
    void (*note)(const char *line, void *data);
    void *data;
    struct trace *trace; /* gets a line for each step that ida attempts (solver/trace.h); NULL: none */
    /* the run stops with a checkpoint when *stop is not 0; SIGALRM: --max-wall has elapsed; may be NULL */
    const volatile sig_atomic_t *stop;
};

/* Run a case and write the result file. On STATUS_SOLVER, STATUS_CONTACT and STATUS_STOPPED the file contains all rows
 * up to the failure or stop; after STATUS_STOPPED a checkpoint exists as well. Fails with STATUS_FILE also if the path
 * holds an unfinished result of the case, or if another run writes the file. */
enum status simulate_run(const struct case_values *values, const struct simulate_options *options);

/* Whether a case (effective) has an unfinished result with a usable checkpoint, or previous checkpoint, of this
 * program; *t: time of the checkpoint, s. arena: for scratch. */
bool simulate_can_resume(struct arena *arena, const char *result, const char *checkpoint, const char *effective,
                         double *t);

/* Changes to the case of a resumed run. */
struct simulate_changes {
    int n_assignments;
    const char *const *assignments; /* to solver.threads, which changes no result, and to time.end */
    bool has_other_end;             /* time.end is assigned */
};

/* Resume a run from a checkpoint and append to the result of the checkpoint; path and overwrite of the options are not
 * used. With another end, a new result is written with the rows of the old result, which may be complete. If the
 * checkpoint cannot be used, the previous checkpoint is used. Fails as simulate_run, and with STATUS_FILE if neither
 * checkpoint can be used. */
enum status simulate_resume(const char *checkpoint, const struct simulate_changes *changes,
                            const struct simulate_options *options);

#endif
