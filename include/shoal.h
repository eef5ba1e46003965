/* shoal.h: run cases from another program. Link with `pkg-config --libs shoal`.
 *
 *     struct shoal *run;
 *     if (shoal_open(&run, "case.yaml", 0, NULL) != 0) puts(shoal_message());
 *     while (shoal_time(run) < shoal_end(run) && shoal_step(run) == 0) ...
 *     shoal_close(run);
 *
 * Functions that can fail return 0 on success and a negative number on failure; shoal_message then says why, in the
 * words that the program would print. A run belongs to one thread at a time. */
#ifndef SHOAL_H
#define SHOAL_H

#ifdef __cplusplus
extern "C" {
#endif

struct shoal; /* a run in memory */

/* Read a case, apply assignments such as "fish[0].wave.frequency=1.2", and make the state at t = 0 consistent.
 * On failure *run is NULL. */
int shoal_open(struct shoal **run, const char *case_path, int n_assignments, const char *const *assignments);

/* Release a run. Accepts NULL. */
void shoal_close(struct shoal *run);

/* Go on to the next event, one shedding interval later. After a failure the run can only be read and closed. */
int shoal_step(struct shoal *run);

/* Time of the last event and of the end of the case, s. */
double shoal_time(const struct shoal *run);
double shoal_end(const struct shoal *run);

/* Number of fish; of nodes, and of free vortices, of one fish (numbered from 0). */
int shoal_n_fish(const struct shoal *run);
int shoal_n_nodes(const struct shoal *run, int fish);
int shoal_n_vortices(const struct shoal *run, int fish);

/* Copy positions of the nodes, nose to tail, or of the free vortices, oldest first, into arrays of those lengths, m;
 * circulation in m2 s-1. */
void shoal_nodes(const struct shoal *run, int fish, double *x, double *y);
void shoal_vortices(const struct shoal *run, int fish, double *x, double *y, double *circulation);

/* The message of the last failure in this thread. */
const char *shoal_message(void);

/* "shoal 0.1.0 (commit ...)" */
const char *shoal_version(void);

#ifdef __cplusplus
}
#endif

#endif
