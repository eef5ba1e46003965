/* steady_search.h: the search for the fixed point of the map from beat to beat, and how the map behaves around it.
 * doc/steady.md. Tested by tests/run/test_steady.c. */
#ifndef STEADY_SEARCH_H
#define STEADY_SEARCH_H

#include "case/case_values.h"
#include "run/steady_map.h"

struct steady_search {
    struct steady_map map;
    const struct case_values *values;
    int n_unknowns; /* the slow quantities of the case                           (n_unknowns) */
    struct steady_unknown *unknown;
    /* told after each beat of the search; may be NULL */
    void (*progress)(const struct steady_search *search, void *data);
    void *data;

    int n_speeds; /* of the fish that are not held: what is solved for first   (n_speeds) */
    struct steady_unknown *speed;
    double *scale; /* of the unknowns that are solved for                       (n_unknowns) */
    double *from,
        *change;   /* where they were last, and how they changed in the beat that followed; scratch  (3 n_unknowns) */
    double *slope; /* change by value                                           (n_unknowns) */
    struct state *kept;
};

/* Prepare the search from a simulation at its start, which stays its owner's. Fails with STATUS_CASE where the case can
 * have no steady state, with the reason, or with STATUS_MEMORY; steady_search_free takes what is left. */
enum status steady_search_create(struct steady_search *search, const struct case_values *values,
                                 struct simulation *simulation);
void steady_search_free(struct steady_search *search);

/* Go on until the simulation repeats itself from beat to beat. Fails with STATUS_SOLVER and the reason where it does
 * not within steady.beats, or as simulate_step. */
enum status steady_search_run(struct steady_search *search);

/* The multipliers of the slow quantities at the state where the simulation is, which stays there. real, imaginary
 * (n_unknowns); *n_beats: what it took. Fails with STATUS_SOLVER or STATUS_MEMORY. */
enum status steady_search_multipliers(struct steady_search *search, double *real, double *imaginary, int *n_beats);

#endif
