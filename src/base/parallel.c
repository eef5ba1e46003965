/* parallel.c: how threads start, and the clocks. */
#include "base/parallel.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

// a thread that waits until all threads have started
static void *thread_wait(void *lock) {
    pthread_mutex_lock(lock);
    pthread_mutex_unlock(lock);
    return NULL;
}

enum status parallel_start_threads(int threads) {
    pthread_t *const started = calloc((size_t)threads, sizeof *started);
    pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&lock);
    int n = 0, code = started ? 0 : ENOMEM;

    while (n < threads - 1 && code == 0) {
        code = pthread_create(&started[n], NULL, thread_wait, &lock);
        n += code == 0;
    }

    pthread_mutex_unlock(&lock);
    for (int i = 0; i < n; i++) pthread_join(started[i], NULL);
    free(started);
    if (code != 0) {
        return status_fail(STATUS_MEMORY,
                           "%d of %d threads can be started (%s): reduce --threads or raise the memory limit", n + 1,
                           threads, strerror(code));
    }

#pragma omp parallel num_threads(threads)
    {}
    return STATUS_OK;
}

double clock_seconds(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
