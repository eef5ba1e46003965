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
 * A function that returns int returns a negative number when it fails, one that returns double then returns NaN;
 * shoal_message says why, in the words that the program would print. Arguments are checked: a NULL, a fish that is not
 * there, or a number that is not finite is SHOAL_USAGE, and nothing has changed.
 *
 * A program may have many runs, in several threads; each run belongs to one thread at a time. A run gives the same bits
 * whatever the other ones do. After a fork the child may use its copies of the runs that were between two calls; there
 * the thread that forked steps them with one thread, because OpenMP has lost the others. Nothing prints, ends the
 * program, or changes its locale, its signals, or its environment. */
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
    SHOAL_USAGE = -1,  /* a wrong argument, a wrong case, a step past the end */
    SHOAL_FILE = -2,   /* a file cannot be read or written */
    SHOAL_MEMORY = -3, /* out of memory */
    SHOAL_SOLVER = -4  /* the integration failed, or bodies met and the case asks to stop then */
};

/* ---- the life of a run ---- */

/* Read a case, apply assignments such as "fish[0].wave.frequency=1.2", and make the state at t = 0 consistent.
 * assignments may be NULL where there are none. On failure *run is NULL. */
int shoal_open(struct shoal **run, const char *case_path, int n_assignments, const char *const *assignments);

/* The same from the text of a case. folder: where its includes are looked up; NULL: the working directory. */
int shoal_open_text(struct shoal **run, const char *text, const char *folder, int n_assignments,
                    const char *const *assignments);

/* Release a run; a result file that is still written is closed. Accepts NULL. */
void shoal_close(struct shoal *run);

/* Go on to the next event, one shedding interval later. Not past the end of the case. When the integration has failed,
 * the run can only be read and closed. */
int shoal_step(struct shoal *run);

/* Advance to the first event at or after time t, s; no-op if the run is already there. A time before the last event is
 * SHOAL_USAGE. */
int shoal_advance(struct shoal *run, double t);

/* A copy of a run at its last event, without its result file; run and copy go on with the same bits, each by itself.
 * Both begin their integration again there, so that nothing but the state counts: a run goes on a little differently,
 * within the tolerance, after it has been copied. On failure *copy is NULL. */
int shoal_clone(struct shoal **copy, struct shoal *run);

/* Put a run back, or forward, to where from is: one must be a copy of the other, or of a copy. A run that has failed is
 * whole again. It must not write a result file. */
int shoal_restore(struct shoal *run, struct shoal *from);

/* Write a run at its last event, with its complete case, as a checkpoint of its own, and open a run from such a file or
 * from a checkpoint of shoal_checkpoint or `shoal run`. Both go on with the same bits, as after shoal_clone; the opened
 * run writes no result file and is no copy for shoal_restore. shoal_save replaces a checkpoint, but no other file.
 * A checkpoint of another version of shoal, or of the libraries, is SHOAL_FILE. On failure *run is NULL. */
int shoal_save(struct shoal *run, const char *path);
int shoal_load(struct shoal **run, const char *path);

/* Time of the last event, time of the last event of the case, and time between two events, s. */
double shoal_time(const struct shoal *run);
double shoal_end(const struct shoal *run);
double shoal_interval(const struct shoal *run);

/* Set, at the last event, what a key of the case has given so far to a fish: "wave.amplitude", "wave.frequency" (Hz;
 * the phase of the beat is continuous), "control.bias", "control.desired_heading" (degree), each one number, or
 * "control.waypoints", pairs in m. The change is made within control.ramp, and smoothly: the integrator does not start
 * again. Means over a period stay those of the period of the case. */
int shoal_set(struct shoal *run, int fish, const char *key, int n, const double *values);

/* Positions, m, and velocities, m s-1, of the nodes of a fish, nose to tail: (n_nodes, 2). Either may be NULL. */
int shoal_state(struct shoal *run, int fish, double *position, double *velocity);

/* Set them at the last event; NULL: as they are. Bound sheets, forces and the velocities of vortices follow, and the
 * integration begins again. Nodes with a prescribed motion keep it. Balances count what this changes as work and
 * impulse from outside; where positions are given, means over a period and the closest approach begin again, and with
 * wake.shedding: sheet the wake continues at the new tail, for which wake.spare_vortices needs 1. Edges must be from
 * half to twice as long as at rest, bodies must not overlap. On failure nothing has changed. */
int shoal_set_state(struct shoal *run, int fish, const double *position, const double *velocity);

/* Add a free vortex at (x, y), m, of this circulation, m2 s-1, at the last event. It belongs to the wake of a fish: it
 * moves, fades and is removed like the vortices that this fish sheds now. Its opposite is infinitely far away. The
 * momenta of bodies and of the fluid that moves with them stay, so that the momentum balance holds with the impulse of
 * the vortex as the only one from outside (lost_impulse, with the other sign). wake.spare_vortices needs 3 for it with
 * wake.shedding: sheet, else 1. On failure nothing has changed. */
int shoal_add_vortex(struct shoal *run, int fish, double x, double y, double circulation);

/* ---- what a run is at its last event ---- */

enum shoal_type { SHOAL_DOUBLE, SHOAL_INT, SHOAL_LONG, SHOAL_CHAR };

/* The values of a variable, in C order: an array of double, int, long or char with these dimensions. Slots beyond what
 * a fish has hold NaN; a name that is shorter than the longest ends with zeros. */
struct shoal_array {
    const void *values;
    enum shoal_type type;
    int n_dimensions;
    size_t shape[4];
    const char *dimension[4]; /* "fish", "node", "edge", "joint", "sheet", "vortex", "xy", "name", "wall" */
    const char *unit, *long_name;
};

/* Read a variable of result files by its name: all of doc/output.md, without the dimension time; the dimension vortex
 * is as long as the longest wake. The array belongs to the run and holds until the next step. On failure *array is all
 * zeros. */
int shoal_read(struct shoal *run, const char *name, struct shoal_array *array);

/* The name of variable i, from 0; NULL beyond the last. */
const char *shoal_variable(int i);

/* Velocity (n, 2), m s-1, and vorticity (n), s-1, of the fluid at the n points (n, 2), m: the external flow, all wakes
 * and all bodies, as a small body there would feel them. vorticity may be NULL. */
int shoal_flow(struct shoal *run, int n, const double *points, double *velocity, double *vorticity);

/* Number of fish; of nodes, and of free vortices, of one fish (numbered from 0). */
int shoal_n_fish(const struct shoal *run);
int shoal_n_nodes(const struct shoal *run, int fish);
int shoal_n_vortices(const struct shoal *run, int fish);

/* Copy positions of the nodes, nose to tail, or of the free vortices, oldest first, into arrays of those lengths, m;
 * circulation in m2 s-1. */
int shoal_nodes(const struct shoal *run, int fish, double *x, double *y);
int shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation);

/* ---- files ---- */

/* The path that the case names for its result: output.file, or the name of the case with .nc. NULL on failure. */
const char *shoal_result_path(const struct shoal *run);

/* Write a result file from now on: each event from this one that is a multiple of time.output_interval, and the end.
 * overwrite: replace a result of shoal that exists, else that is an error. A result that another run writes is an
 * error, whether that run is of this process or of another one. The file belongs to the process that began it: in a
 * fork of it the run continues without the file, and the first step, checkpoint or end there returns SHOAL_FILE. When a
 * row cannot be written, shoal_step returns SHOAL_FILE; the step is made, and the run goes on without the file. */
int shoal_write(struct shoal *run, const char *path, int overwrite);

/* Write a checkpoint beside the result file, RESULT.ckpt for RESULT.nc, from which `shoal resume` goes on with the bits
 * of this run as long as nothing more is set. The run begins its integration again there, as a copied one does.
 * Checkpoints of time.checkpoint_interval are written by shoal_step. */
int shoal_checkpoint(struct shoal *run);

/* Close the result file; where the run is not at its end, the file says "stopped". Nothing to do without a file. */
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
