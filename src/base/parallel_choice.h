/* parallel_choice.h: the number of threads of a run's steps, all or one, and the processors of these threads.
 * Tested by tests/base/test_parallel_choice.c.
 *
 * If another program uses a core, a shared loop waits milliseconds for the thread on that core, and a run on all
 * threads is slower than a run on one. The load by other programs is unknown, so the run measures: a short window of
 * steps is a trial of the other choice, and the faster choice is taken. Trials repeat after pauses; the pause doubles
 * after each trial without a change. Results are independent of the choice.
 *
 *     | steps, all threads | trial, one | steps, all threads                | trial, one | steps, one ...
 *        pause 0.1 s                       pause 0.2 s                       faster: the new choice */
#ifndef PARALLEL_CHOICE_H
#define PARALLEL_CHOICE_H

#include <stdbool.h>

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
