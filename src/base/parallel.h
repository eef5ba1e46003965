/* parallel.h: distributes a loop among threads, and reads clocks. Results do not depend on the number of threads,
 * because every sum belongs to one chunk and the chunks depend only on the length of the loop. Tested by
 * tests/base/test_parallel.c.
 *
 * At its end even a parallel region of one thread wakes the threads that wait, with a system call of up to a
 * microsecond; an if clause does not help (libgomp 12). Regions that are entered in every step, residual or Jacobian
 * are therefore skipped if there is only one thread:
 *
 *     if (threads == 1) {
 *         for (int f = 0; f < n_fish; f++) evaluate_fish(residual, f, t, y);
 *     } else {
 *     #pragma omp parallel for num_threads(threads) schedule(static)
 *         for (int f = 0; f < n_fish; f++) evaluate_fish(residual, f, t, y);
 *     } */
#ifndef PARALLEL_H
#define PARALLEL_H

#include <time.h>

#include "base/status.h"

/* The elements first .. first + n - 1 of an array. */
struct range {
    int first, n;
};

/* An array of n elements is cut into chunks of 16, two of the widest vectors; the last chunk may be shorter. */
enum { PARALLEL_CHUNK = 16 };
static inline int parallel_n_chunks(int n) {
    return (n + PARALLEL_CHUNK - 1) / PARALLEL_CHUNK;
}
static inline struct range parallel_chunk(int i, int n) {
    const int first = i * PARALLEL_CHUNK, rest = n - first;
    return (struct range){first, rest < PARALLEL_CHUNK ? rest : PARALLEL_CHUNK};
}

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

/* The number of threads to use for a loop of n iterations with this much work in total: one or all. */
static inline int parallel_threads(int threads, int n, double work, double min_work) {
    return n > 1 && work >= min_work ? threads : 1;
}

/* Start this number of threads, which OpenMP keeps, before rows are written: OpenMP ends the program on failure. Fails
 * with STATUS_MEMORY if a trial fails. */
enum status parallel_start_threads(int threads);

/* The time of a clock, s: CLOCK_MONOTONIC, or CLOCK_THREAD_CPUTIME_ID for the CPU time of this thread. */
double clock_seconds(clockid_t clock);

#endif
