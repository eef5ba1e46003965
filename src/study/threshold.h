/* threshold.h: the value of a key at which a steady state loses its stability, for `shoal steady --threshold`. The
 * largest multiplier is computed at a few values of the key, which a bracketing secant chooses. doc/steady.md,
 * section "Thresholds". Tested by tests/study/test_threshold.c and tests/app/test_threshold_command.sh. */
#ifndef THRESHOLD_H
#define THRESHOLD_H

#include <signal.h>
#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "steady/steady.h"

// ---- the secants

/* The stability of the steady state at one value of the key. */
struct threshold_point {
    double value;    /* of the key */
    double excess;   /* of the modulus of the largest multiplier over 1; without a beat the growth rate, s-1 */
    double error;    /* of the excess; 0: unknown */
    double period;   /* of the oscillation that grows, beats, or without a beat s; 0: it grows steadily */
    bool is_failure; /* the search found no steady state here; excess is NaN */
};

/* A search for the zero of the excess between two values of a key. */
struct threshold_search {
    double from, to;

    /* Fill excess, error and period at point->value. nearest: the points found so far whose values are nearest, NULL
     * if there is none. Of its failures, STATUS_SOLVER and STATUS_CONTACT mean that there is no steady state here. */
    enum status (*find)(void *data, struct threshold_point *point, const struct threshold_point *const nearest[2]);
    void *data;
    int n;
    struct threshold_point *point; /* in the order of the search                                         (n) */
};

struct threshold {
    double value;                          /* of the key where the excess is 0 */
    double bar;                            /* of the value: the sum of the next two */
    double by_error;                       /* error of the excess over the slope */
    double by_secant;                      /* length of the last secant */
    double slope;                          /* of the excess over the key */
    bool has_beat;                         /* stability by multipliers; false: by growth rates */
    const char *unit;                      /* of the key */
    struct threshold_point nearest;        /* the point with the smallest excess */
    struct threshold_point below_above[2]; /* the points on either side of the threshold that are nearest to it */
};

/* Find the threshold. arena: of the points. Fails with STATUS_SOLVER if the excess has one sign between the ends, if
 * its errors hide the threshold, if the excess jumps there, or if there is no steady state on the way; otherwise as
 * find. The points stay. */
enum status threshold_solve(struct arena *arena, struct threshold_search *search, struct threshold *found);

// ---- a case

struct threshold_options {
    const char *key; /* path of the key, as --set takes it */
    double from, to;
    const char *origin;  /* name of the case in messages */
    const char *folder;  /* of the results: member-0000.nc, ... and study.nc, which is written after every search */
    const char *start;   /* steady state that the first search starts from; NULL: the start of the case */
    const char *command; /* command line, for the history attribute of the files */
    bool force;          /* replace the results of another search */
    void (*progress)(const struct steady_progress *progress, void *data); /* may be NULL */
    void (*note)(const char *line, void *data);                           /* one line after every search; may be NULL */
    void (*warn)(const char *line, void *data);                           /* may be NULL */
    void *data;
    const volatile sig_atomic_t *stop; /* may be NULL */
};

/* Find the threshold of a case. Finished searches of an earlier call with the same case and folder are not repeated.
 * *search holds the points in the arena. Fails with STATUS_CASE (not a number that varies continuously, a case
 * without a steady state, nothing that could be unstable), STATUS_FILE, STATUS_STOPPED, STATUS_MEMORY, or as
 * threshold_solve; the message says what was found. */
enum status threshold_run(struct arena *arena, const struct case_values *values,
                          const struct threshold_options *options, struct threshold_search *search,
                          struct threshold *found);

#endif
