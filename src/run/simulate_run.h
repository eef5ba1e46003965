/* simulate_run.h: takes a case, or a checkpoint, to its end, and writes rows and checkpoints on the way when they are
 * due. This is what `shoal run` and `shoal resume` call. doc/reliability.md. Tested by tests/run/test_simulate.c and
 * tests/run/test_resume.sh. */
#ifndef SIMULATE_RUN_H
#define SIMULATE_RUN_H

#include <signal.h>
#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case.h"

struct trace;

/* How far a run is; reported after every event, and in between after every 100 steps of the integrator. */
struct simulate_progress {
    double t, end;
    long event; /* the last one */
    /* totals of the integrator */
    long steps, evaluations, newton_iterations, jacobians;
    int n_vortices; /* of all fish */
    double wall_time;
};

struct simulate_options {
    const char *path;    /* of the result file */
    bool overwrite;      /* replace an existing result */
    const char *command; /* the command line, for the attribute history */
    /* times of checkpoints besides those of time.checkpoint_interval, s, such as "0.3,1.25"; each must be the time of
     * an event. NULL: none */
    const char *checkpoint_at;
    /* called with the case and the path of the result before the simulation starts; if it fails, the run is cancelled;
     * may be NULL */
    enum status (*begin)(const struct case_values *values, const char *path, void *data);
    void (*progress)(const struct simulate_progress *progress, void *data); /* may be NULL */
    /* called with each warning: about a damaged checkpoint at the start, about the result before the run returns; may
     * be NULL */
    void (*warn)(const char *line, void *data);
    /* called with each note for the user, such as that the checkpoint is from another processor; may be NULL */
    void (*note)(const char *line, void *data);
    void *data;
    struct trace *trace; /* gets a line for each step that ida attempts (solver/trace.h); NULL: no trace */
    /* once *stop is not 0, the run stops with a checkpoint; SIGALRM means that --max-wall has elapsed; may be NULL */
    const volatile sig_atomic_t *stop;
};

/* Run a case and write its result. After STATUS_SOLVER, STATUS_CONTACT and STATUS_STOPPED the file contains all rows up
 * to that time; after STATUS_STOPPED there is a checkpoint too. Fails with STATUS_FILE also if the path holds an
 * unfinished result of this case, or if another run is writing the file. */
enum status simulate_run(const struct case_values *values, const struct simulate_options *options);

/* Whether a case (effective) has an unfinished result with a checkpoint, or previous checkpoint, that this program can
 * use. *t: its time, s. arena: for scratch. */
bool simulate_can_resume(struct arena *arena, const char *result, const char *checkpoint, const char *effective,
                         double *t);

/* What a resumed run changes about its case. */
struct simulate_changes {
    int n_assignments;
    const char *const *assignments; /* to solver.threads, which changes no result, and to time.end */
    bool has_other_end;             /* time.end is assigned */
};

/* Resume a run from a checkpoint and append to its result; path and overwrite of the options are not used. With another
 * end a new result is written, which takes over the rows of the old one, even if that was complete. If the checkpoint
 * cannot be used, the previous one is. Fails as simulate_run does, and with STATUS_FILE if neither can be used. */
enum status simulate_resume(const char *checkpoint, const struct simulate_changes *changes,
                            const struct simulate_options *options);

#endif
