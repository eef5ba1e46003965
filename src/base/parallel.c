/* parallel.c: chunks, and the decision between one thread and all. */
#include "base/parallel.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 16 };

int parallel_n_chunks(int n) {
    return (n + CHUNK - 1) / CHUNK;
}

struct range parallel_chunk(int i, int n) {
    const int first = i * CHUNK, rest = n - first;
    return (struct range){first, rest < CHUNK ? rest : CHUNK};
}

int parallel_threads(int threads, int n, double work, double min_work) {
    return n > 1 && work >= min_work ? threads : 1;
}

void parallel_for(int threads, int n, parallel_body *body, void *data) {
    if (threads == 1) {
        for (int i = 0; i < n; i++) body(data, i);
        return;
    }
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) body(data, i);
}

// a thread that waits until all threads have started
static void *thread_wait(void *lock) {
    pthread_mutex_lock(lock);
    pthread_mutex_unlock(lock);
    return NULL;
}

enum status parallel_try_threads(int threads) {
    pthread_t *const started = calloc((size_t)threads, sizeof *started);
    if (!started) return status_fail(STATUS_MEMORY, "out of memory: %d threads", threads);
    pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&lock);
    int n = 0, code = 0;

    while (n < threads - 1 && code == 0) {
        code = pthread_create(&started[n], NULL, thread_wait, &lock);
        n += code == 0;
    }

    pthread_mutex_unlock(&lock);
    for (int i = 0; i < n; i++) pthread_join(started[i], NULL);
    free(started);
    if (code == 0) return STATUS_OK;

    return status_fail(STATUS_MEMORY,
                       "%d of %d threads can be started (%s): reduce --threads or raise the memory limit", n + 1,
                       threads, strerror(code));
}
