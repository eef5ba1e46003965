/* main_threads.c: where the threads of a run wait, and on which processors. */
// for the sets of processors, which are Linux's own
#define _GNU_SOURCE
#include "app/main_threads.h"

#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>

// of all functions that run before main, one of the first: OpenMP's has no priority
__attribute__((constructor(101))) static void wait_briefly(void) {
    if (!getenv("OMP_WAIT_POLICY")) setenv("GOMP_SPINCOUNT", "4000", 0);
}

// part k of n of the processors in a set: neighbours stay together
static cpu_set_t part_of(const cpu_set_t *all, int k, int n) {
    const int count = CPU_COUNT(all);
    cpu_set_t part;
    CPU_ZERO(&part);
    int i = 0;
    for (size_t cpu = 0; cpu < CPU_SETSIZE; cpu++) {
        if (!CPU_ISSET(cpu, all)) continue;
        if ((long)i * n / count == k) CPU_SET(cpu, &part);
        i++;
    }
    return part;
}

void main_spread_threads(int threads) {
    cpu_set_t all;
    if (threads < 2 || getenv("OMP_PROC_BIND") || getenv("OMP_PLACES")) return;
    if (sched_getaffinity(0, sizeof all, &all) != 0 || CPU_COUNT(&all) < threads) return;
#pragma omp parallel num_threads(threads)
    {
        // if this fails, the system chooses
        const cpu_set_t part = part_of(&all, omp_get_thread_num(), omp_get_num_threads());
        pthread_setaffinity_np(pthread_self(), sizeof part, &part);
    }
}
