/* actions.c: measures what a learner costs without Python, by a fish that is led at every event through
 * include/shoal.h. It prints the CPU time of one action in microseconds, the least of several episodes.
 * tests/bench/actions.py does the same in Python.
 *
 *     actions CASE      CASE has two fish; the second one is led */
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "shoal.h"

static double cpu_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// the observations of velocity, heading, goal, closing and curvature, and the reward of speed and cost
static int look(struct shoal *run) {
    static const char *const names[] = {"com", "com_velocity", "heading", "curvature", "actuation_work"};
    struct shoal_array array;
    int code = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names && code == 0; i++) code = shoal_read(run, names[i], &array);
    return code;
}

static int episode(struct shoal *run, struct shoal *kept, int *n_actions) {
    if (shoal_restore(run, kept) != SHOAL_OK) return 1;
    for (*n_actions = 0; shoal_time(run) < shoal_end(run); ++*n_actions) {
        const double bias = 0.2 * sin(0.1 * *n_actions);
        const double to = fmin(shoal_time(run) + shoal_interval(run), shoal_end(run));
        if (shoal_set(run, 1, "control.bias", 1, &bias) != SHOAL_OK || shoal_advance(run, to) != SHOAL_OK) return 1;
        if (look(run) != SHOAL_OK) return 1;
    }
    return 0;
}

int main(int argc, char **argv) {
    struct shoal *run, *kept;
    double least = INFINITY;
    if (argc != 2 || shoal_open(&kept, argv[1], 0, NULL) || shoal_clone(&run, kept)) return puts(shoal_message()), 1;
    for (int round = 0; round < 3; round++) {
        int n_actions;
        const double start = cpu_time();
        if (episode(run, kept, &n_actions)) return puts(shoal_message()), 1;
        least = fmin(least, 1e6 * (cpu_time() - start) / n_actions);
    }
    printf("%.2f\n", least);
    shoal_close(run);
    shoal_close(kept);
    return 0;
}
