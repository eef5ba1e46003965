/* branch.h: follows a branch of steady states along a key, for `shoal steady --continue`, by pseudo-arclength
 * continuation (Keller 1977) through folds, and locates each fold and each loss of stability. doc/steady.md. Tested
 * by tests/study/test_branch.sh and tests/solver/test_newton.c.
 *
 *     FOLDER/state-000.nc   steady state, as of `shoal steady`, in the order in which they were found
 *     FOLDER/study.nc       all of them in the order of the branch, written again after each of them */
#ifndef BRANCH_H
#define BRANCH_H

#include <signal.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "steady/steady.h"

struct branch_options {
    const char *case_path;
    int n_assignments;
    const char *const *assignments;
    const char *key; /* as --set takes it */
    double from, to;
    const char *start; /* steady state that the first search starts from; NULL: none */
    bool as_json;      /* print the result as JSON */
    const char *folder;
    bool force;          /* replace the branch of an earlier call */
    const char *command; /* command line, for the history attribute of the files */
    void (*progress)(const struct steady_progress *progress, void *data); /* may be NULL */
    void (*note)(const char *line, void *data);                           /* a line about each state; may be NULL */
    void *data;
    const volatile sig_atomic_t *stop;
};

/* Follow the branch from FROM to TO, or to FROM again after a fold, and print what was found to stream. Fails with
 * STATUS_CASE (no such key, or no steady state with multipliers), STATUS_FILE, STATUS_SOLVER or STATUS_CONTACT (no
 * steady state near the last one), or STATUS_STOPPED; the message then says how far the branch came,
 * and the folder contains it. */
enum status branch_follow(const struct branch_options *options, FILE *stream);

#endif
