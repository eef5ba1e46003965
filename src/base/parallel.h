/* parallel.h: distribution of a loop among threads: chunks, and the choice between one thread and all. Results are
 * independent of both: every sum belongs to one chunk, and the chunks depend on the length of the loop alone. Tested by
 * tests/base/test_parallel.c. */
#ifndef PARALLEL_H
#define PARALLEL_H

#include <stdbool.h>

#include "base/status.h"

/* The elements first .. first + n - 1 of an array. */
struct range {
    int first, n;
};

/* An array of n elements is cut into chunks of 16, two of the widest vectors; the last chunk may be shorter. */
int parallel_n_chunks(int n);
struct range parallel_chunk(int i, int n);

/* The minimum work of a loop for which several threads are faster than one: starting threads and waiting for the last
 * thread takes some microseconds. Measured by `make bench`. */
enum {
    PARALLEL_INTERACTIONS = 15000, /* velocities of one vortex at one point */
    PARALLEL_VORTICES = 4000,      /* free vortices that are placed at one time */
    PARALLEL_BOXES = 64,           /* boxes of a tree with shifted expansions */
    PARALLEL_SORTED = 2000,        /* points that are divided among the boxes of one level */
    PARALLEL_ELEMENTS = 4000,      /* results of sums of two vectors */
    PARALLEL_UNKNOWNS = 500,       /* unknowns in a loop over fish that multiplies or solves */
    PARALLEL_MATRICES = 200        /* unknowns in a loop over fish that fills or factorises matrices */
};

/* Check that this number of threads can be started: OpenMP ends the program on failure. Fails with STATUS_MEMORY. */
enum status parallel_try_threads(int threads);

/* The number of threads to use for a loop of n iterations with this much work in total: one or all. */
int parallel_threads(int threads, int n, double work, double min_work);

/* Call body(data, i) for i = 0 .. n - 1, consecutive i per thread. For very short loops: with one thread the caller
 * makes all calls, without the quarter of a microsecond of a parallel region. */
typedef void parallel_body(void *data, int i);
void parallel_for(int threads, int n, parallel_body *body, void *data);

/* The number of threads of a run's steps, all or one, and the processors of these threads.
 *
 * If another program uses a core, a shared loop waits milliseconds for the thread on that core, and a run on all
 * threads is slower than a run on one. The load by other programs is unknown, so the run measures: a short window of
 * steps is a trial of the other choice, and the faster choice is taken. Trials repeat after pauses; the pause doubles
 * after each trial without a change. Results are independent of the choice.
 *
 *     | steps, all threads | trial, one | steps, all threads                | trial, one | steps, one ...
 *        pause 0.1 s                       pause 0.2 s                       faster: the new choice */

/* Consecutive steps. */
struct parallel_window {
    int n_steps;
    double time, processor_time; /* in total: wall clock time, CPU time of the stepping thread [s] */
};

/* All zeros: all threads. */
struct parallel_choice {
    bool is_one;                           /* the choice: one thread */
    bool is_trial, is_retry;               /* the present window tries the other choice, for the second time */
    int part;                              /* of the processors, where steps on one thread begin */
    struct parallel_window window, before; /* the present window; the last window of the choice */
    double pause, rest;                    /* between two trials, until the next trial [s] */
    double start, processor_start;         /* clocks at the begin of the present step [s] */
    int levels;                            /* nested parallel regions outside the steps */
};

/* Add a step with wall time and CPU time [s]; returns whether the next step takes one thread. */
bool parallel_choice_note(struct parallel_choice *choice, double time, double processor_time);

/* Begin and end a step of a run with this number of threads, both on the same thread. In between, parallel loops take
 * the threads of the choice. */
void parallel_choice_begin(struct parallel_choice *choice, int threads);
void parallel_choice_end(struct parallel_choice *choice, int threads);

/* Bind each thread of the process to a separate part of the available processors: the scheduler often wakes a sleeping
 * thread on the core of the waking thread and keeps the thread there. A run on one thread may use all processors; a
 * trial of one thread that waited for a processor is repeated on another part. No effect if the process has fewer
 * processors than threads, or if the environment places threads (OMP_PROC_BIND, OMP_PLACES). Only for the program: the
 * library does not move the threads of a caller. */
void parallel_choice_spread(int threads);

#endif
