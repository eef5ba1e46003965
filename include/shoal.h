/* shoal.h: run cases from another program. Compile and link with `pkg-config --cflags --libs shoal`.
 *
 *     struct shoal *run;
 *     if (shoal_open(&run, "case.yaml", 0, NULL) != SHOAL_OK) puts(shoal_message());
 *     while (shoal_time(run) < shoal_end(run) && shoal_step(run) == SHOAL_OK) {
 *         struct shoal_array com;
 *         if (shoal_read(run, "com", &com) == SHOAL_OK) printf("%g\n", ((const double *)com.values)[0]);
 *     }
 *     shoal_close(run);
 *
 * On failure a function of type int returns a negative status, and a function of type double returns NaN;
 * shoal_message returns the message that the command shoal would print. Arguments are checked: NULL, an unknown fish,
 * and a number that is not finite return SHOAL_USAGE and leave the run unchanged.
 *
 * A program may have several runs in several threads; each run belongs to one thread at a time. The bits of a run do
 * not depend on other runs. After a fork the child may use the runs that were between two calls; every step in the
 * child uses one thread, because OpenMP threads do not survive a fork. The library never prints, never ends the
 * program, and never changes locale, signals or environment. */
#ifndef SHOAL_H
#define SHOAL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

struct shoal; /* a run in memory */

enum shoal_status {
    SHOAL_OK = 0,
    SHOAL_USAGE = -1,  /* a wrong argument, a wrong case, a step past the end of the run */
    SHOAL_FILE = -2,   /* a file cannot be read or written */
    SHOAL_MEMORY = -3, /* out of memory */
    SHOAL_SOLVER = -4, /* the integration failed, or a contact of bodies with contact.action: stop */
    SHOAL_STOPPED = -5 /* the call was stopped: shoal_listen */
};

/* ---- the life of a run ---- */

/* Read a case, apply assignments such as "fish[0].wave.frequency=1.2", and make the state at t = 0 consistent.
 * assignments may be NULL if n_assignments is 0. On failure *run is NULL. */
int shoal_open(struct shoal **run, const char *case_path, int n_assignments, const char *const *assignments);

/* Open a run from the text of a case. folder: folder of included files; NULL: the working directory. */
int shoal_open_text(struct shoal **run, const char *text, const char *folder, int n_assignments,
                    const char *const *assignments);

/* Stop later calls of shoal_open, shoal_open_text, shoal_load, shoal_clone, shoal_step and shoal_advance in this thread
 * once *stop is not 0: these calls then return SHOAL_STOPPED within a second. After shoal_step and shoal_advance the
 * run is at the last event that it has reached and can continue; the integrator restarts there, as after shoal_clone. A
 * run that shoal_clone could not copy is unchanged. Another thread or a signal handler sets *stop, which must outlive
 * the calls. NULL: no stop. */
void shoal_listen(const volatile int *stop);

/* Release a run; close an open result file. Accepts NULL. */
void shoal_close(struct shoal *run);

/* Advance to the next event, one shedding interval later; SHOAL_USAGE at the end of the case. After a failed
 * integration the run can only be read, restored and closed. */
int shoal_step(struct shoal *run);

/* Advance to the first event at or after time t, s; no-op if the run is already there. A time before the last event is
 * SHOAL_USAGE. */
int shoal_advance(struct shoal *run, double t);

/* Copy a run at the last event, without the result file; run and copy continue independently with the same bits. Both
 * integrators restart from the state, without the history of earlier steps: shoal_clone changes the later results of
 * the run within the tolerance. On failure *copy is NULL. */
int shoal_clone(struct shoal **copy, struct shoal *run);

/* Set a run to the state of from, earlier or later: run and from must be copies of one another by shoal_clone, directly
 * or through other copies. A failed run can step again. The run must not write a result file. */
int shoal_restore(struct shoal *run, struct shoal *from);

/* shoal_save: write a run at the last event, with the complete case, as a checkpoint without a result file.
 * shoal_load: open a run from a checkpoint of shoal_save, shoal_checkpoint or `shoal run`. Both runs continue with the
 * same bits, as after shoal_clone; the loaded run writes no result file and is no copy for shoal_restore. shoal_save
 * replaces a checkpoint, but no other file. shoal_load returns SHOAL_FILE for a checkpoint of another version of shoal
 * or of another version of the libraries. On failure *run is NULL. */
int shoal_save(struct shoal *run, const char *path);
int shoal_load(struct shoal **run, const char *path);

/* Time of the last event, time of the last event of the case, and time between two events, s. */
double shoal_time(const struct shoal *run);
double shoal_end(const struct shoal *run);
double shoal_interval(const struct shoal *run);

/* Set the value of a key of one fish at the last event: "wave.amplitude", "wave.frequency" (Hz; the phase of the beat
 * is continuous), "control.bias", "motion.heave" (m), "control.desired_heading" (degree), one number each,
 * "control.offset" (x, y, m) or "control.waypoints" (pairs, m). The change is smooth within control.ramp; the
 * integrator does not restart. Means over a period keep the period of the case. */
int shoal_set(struct shoal *run, int fish, const char *key, int n, const double *values);

/* Copy positions, m, and velocities, m s-1, of the nodes of a fish, nose to tail: (n_nodes, 2). Either may be NULL. */
int shoal_state(struct shoal *run, int fish, double *position, double *velocity);

/* Set positions and velocities at the last event; NULL: unchanged. Bound sheets, forces and velocities of vortices are
 * evaluated again, and the integrator restarts. Nodes with prescribed motion keep the prescribed motion. The balances
 * count the changes of energy and momentum as external work and external impulse. New positions restart the means over
 * a period and the closest approach; with wake.shedding: sheet the wake then continues at the new tail and uses 1 of
 * wake.spare_vortices. The length of every edge must be within a factor 2 of the length at rest, and bodies must not
 * overlap. On failure the run is unchanged. */
int shoal_set_state(struct shoal *run, int fish, const double *position, const double *velocity);

/* Add a free vortex at (x, y), m, with this circulation, m2 s-1, to the wake of a fish at the last event. The vortex
 * moves, decays and is removed like a vortex that this fish sheds now. The opposite circulation is infinitely far away.
 * The momenta of bodies and of the added mass are unchanged, so the momentum balance holds with the impulse of the
 * vortex as the only external impulse (lost_impulse, with the opposite sign). The vortex uses 3 of wake.spare_vortices
 * with wake.shedding: sheet, else 1. On failure the run is unchanged. */
int shoal_add_vortex(struct shoal *run, int fish, double x, double y, double circulation);

/* ---- values of a run at the last event ---- */

enum shoal_type { SHOAL_DOUBLE, SHOAL_INT, SHOAL_LONG, SHOAL_CHAR };

/* The values of a variable, in C order: an array of double, int, long or char with these dimensions. Unused slots of a
 * fish with fewer nodes, vortices, ... than the largest count hold NaN; a name shorter than the longest name is padded
 * with zeros. */
struct shoal_array {
    const void *values;
    enum shoal_type type;
    int n_dimensions;
    size_t shape[4];
    const char *dimension[4]; /* "fish", "node", "edge", "joint", "sheet", "sensor", "vortex", "xy", "name", "wall" */
    const char *unit, *long_name;
};

/* Read a variable by name: every variable of doc/output.md, without the dimension time. The length of the dimension
 * vortex is the length of the longest wake. The array belongs to the run and is valid until the next step. On failure
 * *array is all zeros. */
int shoal_read(struct shoal *run, const char *name, struct shoal_array *array);

/* The name of variable i, from 0; NULL beyond the last variable. */
const char *shoal_variable(int i);

/* Velocity (n, 2), m s-1, and vorticity (n), s-1, of the flow at n points (n, 2), m: external flow, all wakes and all
 * bodies, with full smoothing, as induced on another body; NaN beyond walls. vorticity may be NULL. */
int shoal_flow(struct shoal *run, int n, const double *points, double *velocity, double *vorticity);

/* Number of fish; number of nodes, and of free vortices, of one fish (numbered from 0). */
int shoal_n_fish(const struct shoal *run);
int shoal_n_nodes(const struct shoal *run, int fish);
int shoal_n_vortices(const struct shoal *run, int fish);

/* Copy positions of the nodes, nose to tail, m: (shoal_n_nodes); or positions, m, and circulations, m2 s-1, of the free
 * vortices, oldest first: (shoal_n_vortices). */
int shoal_nodes(const struct shoal *run, int fish, double *x, double *y);
int shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation);

/* ---- files ---- */

/* The default path of the result file: output.file, else the name of the case with .nc. NULL on failure. */
const char *shoal_result_path(const struct shoal *run);

/* Begin a result file: one row for each event, from the present event, at a multiple of time.output_interval, and one
 * row for the end. overwrite: replace an existing result of shoal; without overwrite an existing file is an error. A
 * file in use by another run, of any process, is an error. The file belongs to the process that called shoal_write:
 * in a fork of this process the run continues without the file, and the first shoal_step, shoal_checkpoint or
 * shoal_write_end returns SHOAL_FILE. If a row cannot be written, shoal_step completes the step, returns SHOAL_FILE,
 * and the run continues without the file. */
int shoal_write(struct shoal *run, const char *path, int overwrite);

/* Write a checkpoint beside the result file: RESULT.ckpt for RESULT.nc. `shoal resume` continues with the bits of this
 * run, unless the run is changed by a later shoal_set, shoal_set_state or shoal_add_vortex. The integrator restarts, as
 * in shoal_clone. shoal_step writes the checkpoints of time.checkpoint_interval. */
int shoal_checkpoint(struct shoal *run);

/* Close the result file; the status in the file is "stopped" before the end of the run. No-op without a file. */
int shoal_write_end(struct shoal *run);

/* ---- the library ---- */

/* The message of the last failure in this thread. */
const char *shoal_message(void);

/* "shoal 0.1.0 (commit ...)" */
const char *shoal_version(void);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif
