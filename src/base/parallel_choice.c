/* parallel_choice.c: trials, and the processors of a thread that works alone. */
#ifdef __linux__
// for the sets of processors
#define _GNU_SOURCE
#include <sched.h>
#endif
#include <math.h>
#include <omp.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/parallel_choice.h"

/* A window is long enough for several turns of other programs on a core. */
static const double window_time = 0.02;
enum { WINDOW_STEPS = 3 };

/* The first pause, the longest one, and how much longer than its trial a pause is at least: a trial on one thread may
 * take twice as long on an idle machine. A change of the choice has to be worth it. */
static const double first_pause = 0.1, last_pause = 5, pause_of_trials = 30, worth = 0.95;

static double mean(const struct parallel_window *window) {
    return window->time / window->n_steps;
}

// the pause after a trial
static void rest(struct parallel_choice *choice, bool is_change) {
    const double next = is_change ? first_pause : fmin(2 * choice->pause, last_pause);
    choice->pause = next;
    choice->rest = fmax(next, pause_of_trials * choice->window.time);
}

bool parallel_choice_note(struct parallel_choice *choice, double time) {
    struct parallel_window *const window = &choice->window;
    window->n_steps++;
    window->time += time;
    choice->rest -= time;
    if (window->n_steps >= WINDOW_STEPS && window->time >= window_time) {
        if (choice->is_trial) {
            const bool is_faster = mean(window) < worth * mean(&choice->before);
            if (is_faster) choice->is_one = !choice->is_one;
            rest(choice, is_faster);
            choice->is_trial = false;
        } else {
            choice->before = *window;
            if (choice->pause <= 0) choice->pause = choice->rest = first_pause;
            choice->is_trial = choice->rest <= 0;
        }
        *window = (struct parallel_window){0};
    }
    return choice->is_one != choice->is_trial;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// ---- processors: threads that were given processors of their own keep to them while they share work

#ifdef __linux__

struct parallel_places {
    cpu_set_t own, all; /* of this thread, and of all its team */
    double time,
        delay;       /* when this thread was looked at last, and how long it had waited for its processors by then, s */
    bool is_delayed; /* it has waited a tenth of the time since */
};

static void find_places(struct parallel_choice *choice, int threads) {
    choice->places = calloc(1, sizeof *choice->places);
    struct parallel_places *const places = choice->places;
    if (!places) return;
    sched_getaffinity(0, sizeof places->own, &places->own);
    cpu_set_t *const own = calloc((size_t)threads, sizeof *own);
    if (!own) return;
#pragma omp parallel num_threads(threads)
    sched_getaffinity(0, sizeof *own, &own[omp_get_thread_num()]);
    for (int i = 0; i < threads; i++) CPU_OR(&places->all, &places->all, &own[i]);
    free(own);
}

// whether something else runs on the processors of this thread; a system that does not say: no
static void look_at_delay(struct parallel_choice *choice) {
    struct parallel_places *const places = choice->places;
    if (!places) return;
    FILE *const file = fopen("/proc/thread-self/schedstat", "r");
    if (!file) return;
    double delay = 0;
    if (fscanf(file, "%*d %lf", &delay) != 1) delay = 0;
    fclose(file);
    const double time = now();
    delay *= 1e-9;
    places->is_delayed = delay - places->delay > 0.25 * (time - places->time);
    places->time = time;
    places->delay = delay;
}

// A thread that begins to work alone leaves a processor that others use at once: the system would take its time. If a
// call fails, the thread stays where it is.
static void move(const struct parallel_choice *choice, bool is_one) {
    const struct parallel_places *const places = choice->places;
    if (!places) return;
    if (is_one && places->is_delayed) {
        cpu_set_t others = places->all;
        CPU_CLR((size_t)sched_getcpu(), &others);
        sched_setaffinity(0, sizeof others, &others);
    }
    sched_setaffinity(0, sizeof(cpu_set_t), is_one ? &places->all : &places->own);
}

#else

static void find_places(struct parallel_choice *choice, int threads) {
    (void)choice, (void)threads;
}

static void look_at_delay(struct parallel_choice *choice) {
    (void)choice;
}

static void move(const struct parallel_choice *choice, bool is_one) {
    (void)choice, (void)is_one;
}

#endif

void parallel_choice_begin(struct parallel_choice *choice, int threads) {
    if (threads == 1) return;
    if (!choice->places) find_places(choice, threads);
    choice->levels = omp_get_max_active_levels();
    // no parallel region is active then
    if (choice->is_one != choice->is_trial) omp_set_max_active_levels(0);
    choice->start = now();
}

void parallel_choice_end(struct parallel_choice *choice, int threads) {
    if (threads == 1) return;
    const bool was_one = choice->is_one != choice->is_trial;
    omp_set_max_active_levels(choice->levels);
    const bool is_one = parallel_choice_note(choice, now() - choice->start);
    if (choice->window.n_steps == 0) look_at_delay(choice);
    if (is_one != was_one) move(choice, is_one);
}

void parallel_choice_clear(struct parallel_choice *choice) {
    free(choice->places);
    *choice = (struct parallel_choice){0};
}
