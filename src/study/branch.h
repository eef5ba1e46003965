/* branch.h: follows a branch of steady states along a key, for `shoal steady --continue` and `--threshold`: by
 * pseudo-arclength continuation (Keller 1977) through folds. Each fold and each loss of stability is located. An
 * equilibrium has no slow quantities; its branch has the key as its only coordinate. doc/steady.md. Tested by
 * tests/study/test_branch.sh and test_branch_walk.c, by tests/app/test_threshold_command.sh and by
 * tests/solver/test_newton.c.
 *
 *     FOLDER/state-000.nc   steady state, as of `shoal steady`, in the order in which they were found
 *     FOLDER/study.nc       all of them in the order of the branch, written again after each of them */
#ifndef BRANCH_H
#define BRANCH_H

#include <signal.h>
#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "steady/steady.h"
#include "study/member_file.h"

struct branch_options {
    const char *option; /* "--continue" or "--threshold", for messages */
    const char *key;    /* as --set takes it */
    double from, to;
    bool to_threshold;   /* end at the first loss or return of stability; without one fail */
    const char *origin;  /* name of the case in messages */
    const char *start;   /* steady state that the first search starts from; NULL: the start of the case */
    const char *folder;  /* of the files */
    bool force;          /* replace the branch of an earlier call */
    const char *command; /* command line, for the history attribute of the files; may be NULL */
    void (*progress)(const struct steady_progress *progress, void *data); /* may be NULL */
    void (*note)(const char *line, void *data);                           /* a line about each state; may be NULL */
    void (*warn)(const char *line, void *data);                           /* may be NULL */
    void *data;
    const volatile sig_atomic_t *stop; /* may be NULL */
};

struct branch_point {
    double *x;         /* the n slow quantities over their scales, and the part of the way from FROM to TO  (n + 1) */
    double arclength;  /* distance along the branch from its first point */
    double value;      /* of the key */
    double excess;     /* of the modulus of the largest multiplier over 1; of an equilibrium its growth rate, s-1 */
    double error;      /* of the excess; 0: unknown */
    double period;     /* of the oscillation of a disturbance, beats; of an equilibrium s; 0: it does not oscillate */
    const char *label; /* "": ordinary */
    const char *file;  /* name of the file in the folder */
    struct member_file member;
};

/* A loss or return of stability. */
struct branch_threshold {
    const struct branch_point *nearest; /* the point with this label */
    double value;                       /* of the key where the excess is 0 */
    double bar;                         /* of the value: the sum of the next five; NaN: the errors hide it */
    double by_error;                    /* error of the excess over the slope */
    double by_secant;                   /* length of the last secant */
    double by_state;                    /* what a tenth of steady.tolerance changes at the nearest point */
    double by_interval;     /* twice what half the shedding interval changes; NaN: unknown, not in the bar */
    double by_bodies;       /* the same with twice as many edges and panels of the sheet */
    double slope;           /* of the excess over the key; NaN: at a fold, or the errors hide it */
    double period;          /* of the nearest unstable point */
    bool is_fold;           /* the key turns back there */
    bool is_unstable_above; /* whether the state is unstable, or at a fold gone, at larger values of the key */
};

struct branch {
    bool has_beat;    /* stability by multipliers; false: by growth rates */
    const char *unit; /* of the key */
    int n_points;
    struct branch_point **point; /* in the order of the branch                                      (n_points) */
    int n_thresholds;
    struct branch_threshold *threshold; /* in the order in which they were found                      (n_thresholds) */
};

/* Follow the branch from FROM to TO, or to FROM again after a fold. values: the case. *branch: in the arena, NULL
 * before anything is computed. Fails with STATUS_CASE (no such key, a case without a steady state or without a
 * stability), STATUS_FILE, STATUS_SOLVER or STATUS_CONTACT (no steady state near the last one, or no threshold), or
 * STATUS_STOPPED; the message then says how far the branch came, and the folder contains it. */
enum status branch_follow(struct arena *arena, const struct case_values *values, const struct branch_options *options,
                          struct branch **branch);

#endif
