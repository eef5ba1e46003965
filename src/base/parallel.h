/* parallel.h: distribution of a loop among threads: chunks, and the choice between one thread and all. Results are
 * independent of both: every sum belongs to one chunk, and the chunks depend on the length of the loop alone. Tested by
 * tests/base/test_parallel.c. */
#ifndef PARALLEL_H
#define PARALLEL_H

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

#endif
