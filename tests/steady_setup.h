/* steady_setup.h: What the tests of steady states share: the problem of a case, from its text to what the search finds.
 * */
#ifndef STEADY_SETUP_H
#define STEADY_SETUP_H

#include "school.h"
#include "steady/steady_modes.h"
#include "steady/steady_problem.h"

// coarse, so that a beat takes some milliseconds: 20 events, 7 nodes, 13 points of the sheet
#define COARSE "time: {end: 1, shedding_interval: 0.05, output_interval: 0.05}\n"
#define FISH "nodes: 7, sheet_points: 13, force: reactive"

struct steady_setup {
    struct case_values values;
    struct simulation *simulation;
    struct steady_problem problem;
    struct steady_multipliers multipliers;
};

/* Pose the problem of a case. Fails the test with the message where there is one. */
void steady_setup_open(struct steady_setup *setup, const char *text);

/* The same, and find its steady state, and the multipliers. */
void steady_setup_find(struct steady_setup *setup, const char *text);
void steady_setup_multipliers(struct steady_setup *setup);

/* Go on by some beats to which nothing is added. */
void steady_setup_beats(struct steady_setup *setup, int n);

/* The problem of a case is refused, or its search fails, with these words. */
void steady_setup_fails(const char *text, enum status want, const char *words);

#endif
