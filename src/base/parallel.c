/* parallel.c: chunks, the decision between one thread and all, and the processors of the threads. */
// for sets of processors, available on Linux only
#define _GNU_SOURCE
#include "base/parallel.h"

#include <math.h>
#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"

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
    pthread_t *started;
    TRY(MEMORY_NEW(started, threads, "threads"));
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

// ---- the number of threads of steps: trials

/* A window lasts several time slices of other programs on a core. */
static const double window_time = 0.02;
enum { WINDOW_STEPS = 3 };

/* The first and the longest pause [s]; the shortest pause in units of the trial time, because one thread on an idle
 * machine takes up to `threads` times as long; the ratio of times below which the choice changes; the share of a trial
 * without a processor above which the trial moves to other processors. */
static const double first_pause = 0.1, last_pause = 5, pause_of_trials = 30, worth = 0.95, waiting = 0.2;

static double mean_time(const struct parallel_window *window) {
    return window->time / window->n_steps;
}

// the pause after a trial
static void pause_begin(struct parallel_choice *choice, bool is_change) {
    choice->pause = is_change ? first_pause : fmin(2 * choice->pause, last_pause);
    choice->rest = fmax(choice->pause, pause_of_trials * choice->window.time);
}

// Whether a trial of one thread waited for a processor, so that another part of the processors deserves a second trial.
static bool trial_is_repeated(const struct parallel_choice *choice) {
    const struct parallel_window *const window = &choice->window;
    return !choice->is_one && !choice->is_retry && window->time - window->processor_time > waiting * window->time;
}

bool parallel_choice_note(struct parallel_choice *choice, double time, double processor_time) {
    struct parallel_window *const window = &choice->window;
    window->n_steps++;
    window->time += time;
    window->processor_time += processor_time;
    choice->rest -= time;

    if (window->n_steps >= WINDOW_STEPS && window->time >= window_time) {
        if (choice->is_trial) {
            const bool is_faster = mean_time(window) < worth * mean_time(&choice->before);
            choice->is_retry = !is_faster && trial_is_repeated(choice);
            if (choice->is_retry) {
                choice->part++;
            } else {
                if (is_faster) choice->is_one = !choice->is_one;
                pause_begin(choice, is_faster);
                choice->is_trial = false;
            }
        } else {
            choice->before = *window;
            if (choice->pause <= 0) choice->pause = choice->rest = first_pause;
            choice->is_trial = choice->rest <= 0;
        }

        *window = (struct parallel_window){0};
    }

    return choice->is_one != choice->is_trial;
}

// ---- processors

#ifdef __linux__

/* Set by parallel_choice_spread: all processors of the process, divided among this number of threads; 0: not divided.
 * Placement belongs to the process, hence static. */
static cpu_set_t all_processors;
static int n_parts;

// part k of the processors; neighbours stay together
static cpu_set_t part_of_processors(int k) {
    const int count = CPU_COUNT(&all_processors);
    cpu_set_t part;
    CPU_ZERO(&part);
    int i = 0;

    for (size_t cpu = 0; cpu < CPU_SETSIZE; cpu++) {
        if (!CPU_ISSET(cpu, &all_processors)) continue;
        if ((long)i * n_parts / count == k) CPU_SET(cpu, &part);
        i++;
    }

    return part;
}

// Move the calling thread to part k at once. If a call fails, the system chooses.
static void move_to_part(int k) {
    const cpu_set_t part = part_of_processors(k);
    pthread_setaffinity_np(pthread_self(), sizeof part, &part);
}

void parallel_choice_spread(int threads) {
    if (threads < 2 || getenv("OMP_PROC_BIND") || getenv("OMP_PLACES")) return;
    if (n_parts == 0 && sched_getaffinity(0, sizeof all_processors, &all_processors) != 0) return;
    if (CPU_COUNT(&all_processors) < threads) return;
    n_parts = threads;
#pragma omp parallel num_threads(threads)
    move_to_part(omp_get_thread_num());
}

// Place the calling thread, the first of its team, for steps on one thread or on all.
static void place_thread(const struct parallel_choice *choice, bool is_one) {
    if (n_parts == 0) return;
    // begin on the part of the last trial: the scheduler takes longer than a window to leave a shared core
    move_to_part(is_one ? choice->part % n_parts : 0);
    if (is_one) pthread_setaffinity_np(pthread_self(), sizeof all_processors, &all_processors);
}

#else

void parallel_choice_spread(int threads) {
    (void)threads;
}

static void place_thread(const struct parallel_choice *choice, bool is_one) {
    (void)choice, (void)is_one;
}

#endif

// ---- steps

static double seconds(clockid_t clock) {
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void parallel_choice_begin(struct parallel_choice *choice, int threads) {
    if (threads == 1) return;
    choice->levels = omp_get_max_active_levels();
    // zero levels: parallel regions take one thread
    if (choice->is_one != choice->is_trial) omp_set_max_active_levels(0);
    choice->start = seconds(CLOCK_MONOTONIC);
    choice->processor_start = seconds(CLOCK_THREAD_CPUTIME_ID);
}

void parallel_choice_end(struct parallel_choice *choice, int threads) {
    if (threads == 1) return;
    const bool was_one = choice->is_one != choice->is_trial;
    const int part = choice->part;
    omp_set_max_active_levels(choice->levels);
    const bool is_one = parallel_choice_note(choice, seconds(CLOCK_MONOTONIC) - choice->start,
                                             seconds(CLOCK_THREAD_CPUTIME_ID) - choice->processor_start);
    if (is_one != was_one || choice->part != part) place_thread(choice, is_one);
}
