/* parallel_choice.h: whether the steps of a run share their loops among all threads or take one. Tested by
 * tests/base/test_parallel_choice.c.
 *
 * Where another program uses a core, a loop that is shared waits for the thread on that core, for milliseconds: the run
 * is slower than on one thread. No rule knows what other programs do, so a run tries: a short window of steps with the
 * other choice, which it takes if these steps are faster. A trial is repeated after a pause, which grows from trial to
 * trial without a change. Results do not depend on the choice.
 *
 *     | steps, all threads          | trial, one | steps, all threads                 | trial | one ...
 *                           pause ->                                 twice the pause ->          faster: taken */
#ifndef PARALLEL_CHOICE_H
#define PARALLEL_CHOICE_H

#include <stdbool.h>

/* Consecutive steps: number and total time, s. */
struct parallel_window {
    int n_steps;
    double time;
};

/* All zeros: share loops. */
struct parallel_choice {
    bool is_one;                           /* the choice: one thread */
    bool is_trial;                         /* the present window tries the other choice */
    struct parallel_window window, before; /* the present one; the last one with the choice */
    double pause, rest;                    /* between two trials, and until the next one, s */

    /* of the step that runs */
    double start; /* s */
    int levels;   /* nested parallel regions before the step */
    struct parallel_places *places;
};

/* Take the time of a step into account; returns whether the next step takes one thread. */
bool parallel_choice_note(struct parallel_choice *choice, double time);

/* Begin and end a step of a run with this number of threads; both on the same thread. In between, its parallel loops
 * take one thread where that is the choice, and it may use the processors of all of them. */
void parallel_choice_begin(struct parallel_choice *choice, int threads);
void parallel_choice_end(struct parallel_choice *choice, int threads);

/* Release what begin has allocated. */
void parallel_choice_clear(struct parallel_choice *choice);

#endif
