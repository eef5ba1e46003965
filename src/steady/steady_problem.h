/* steady_problem.h: unknowns of a steady state (the slow quantities of a case), beats of the search, and the search.
 * doc/steady.md. Tested by tests/steady/test_steady.c and test_steady_formation.c. */
#ifndef STEADY_PROBLEM_H
#define STEADY_PROBLEM_H

#include "case/case_values.h"
#include "steady/steady_map.h"

enum { STEADY_RECENT = 16 };

struct steady_problem {
    struct steady_map map;
    const struct case_steady *settings;
    int n_unknowns; /* slow quantities of the case                                 (n_unknowns) */
    struct steady_unknown *unknown;
    bool solves_speed; /* the first fish has a speed to solve for; without a formation no other fish has one */
    int n_pins; /* unknowns fixed during the solution for the speed of the first fish: all speeds equal this speed,
                         places and headings of a formation equal the initial values (n_pins) */
    struct steady_unknown *pin;
    double *pinned;   /* (n_pins) */
    double *scratch;  /* (4 n_unknowns) */
    double *jacobian; /* of a formation: derivatives of the change per beat by the unknowns, in the scales of the
                         unknowns, by columns; NULL: not evaluated yet (n_unknowns, n_unknowns) */
    double recent[STEADY_RECENT]; /* speed of the first fish in the last beats, beat n at n % STEADY_RECENT, m s-1 */
    /* called after each beat of the search; may be NULL */
    void (*progress)(const struct steady_problem *problem, void *data);
    void *data;
};

/* Pose the problem for a simulation at the initial state, in the arena of the simulation. Fails with STATUS_CASE and
 * the reason if the case can have no steady state. */
enum status steady_problem_create(struct steady_problem *problem, const struct case_steady *settings,
                                  struct simulation *simulation);

/* Advance the search by one beat. Fails with STATUS_SOLVER and the reason after settings->beats beats, or as
 * steady_map_beat. */
enum status steady_problem_beat(struct steady_problem *problem);

/* Read the unknowns, over the scales                                                             (n_unknowns) */
void steady_problem_read(const struct steady_problem *problem, double *value);

/* Set the unknowns to these values, over the scales. Fails as steady_map_add.                    (n_unknowns) */
enum status steady_problem_put(struct steady_problem *problem, const double *to);

/* Set all pinned speeds to this speed, m s-1, and all other pins to the initial values. Fails as steady_map_add. */
enum status steady_problem_put_pins(struct steady_problem *problem, double speed);

// ---- why no formation was found, from the free motion of the fish

/* Release all fish for some beats and fail with STATUS_SOLVER and the observed motion: two fish within contact.range of
 * each other; else the fish with the fastest drift relative to the first fish; else no drift. Or fail as
 * steady_map_beat. These beats are not counted. */
enum status steady_reason_find(struct steady_problem *problem);

/* Check that interaction determines the places of a formation: fail with STATUS_SOLVER if a displacement of 0.25
 * lengths changes a beat by less than the tolerance. in_a_length: change per length of displacement, for example the
 * distance between 1 and the nearest multiplier. */
enum status steady_reason_check(const struct steady_problem *problem, double in_a_length);

// ---- steady_formation.c: Newton's method for all slow quantities of a formation, with a difference Jacobian

/* Solve for values of all slow quantities that one beat changes by at most the tolerance, in the scales of the
 * quantities, near the current values. If Newton's method fails, restart and follow the motion of the fish in time
 * (implicit Euler steps). Fails with STATUS_SOLVER, or as steady_problem_beat. */
enum status steady_formation_solve(struct steady_problem *problem, double tolerance);

// ---- steady_search.c: the search for the fixed point of the map from beat to beat

/* Advance the simulation to a state that repeats with the beat. Fails with STATUS_SOLVER and the reason after
 * steady.beats beats (for a formation: the motion of the released fish), or as simulate_step. */
enum status steady_search_run(struct steady_problem *problem);

/* Take the step way of steady_multipliers_find to the fixed point (n_unknowns), or a Newton step if way is NULL; then
 * advance the simulation to a state that repeats with the beat. Fails as steady_search_run. */
enum status steady_search_correct(struct steady_problem *problem, const double *way);

// ---- steady_start.c: the start of a search from the steady state of a similar case. Tested by
// tests/steady/test_steady_start.c and tests/app/test_steady_command.sh.

/* Copy the fish of a school into a new array *fish. Free fish get the speeds of the steady
 * state in the file; free fish other than the first also get the places relative to the first fish. The copies share
 * the memory of the original fish. Fails with STATUS_FILE if the file contains no steady state of this number of fish;
 * *fish is then NULL. */
enum status steady_start_read(struct arena *arena, const char *path, const struct school_parameters *school,
                              struct fish_parameters **fish);

/* Set the positions of the free nodes to the shapes of an equilibrium in a file, relative to the nose and to the
 * prescribed direction, in body lengths. arena: for scratch; y: all unknowns of the school. Fails with STATUS_FILE if
 * the bodies in the file have other numbers of nodes. */
enum status steady_start_shapes(struct arena *arena, const char *path, const struct school *school, double *y);

// ---- steady_static.c: the equilibrium of passive bodies in a stream: `shoal steady` of a case without a beat.
// Tested by tests/steady/test_steady_static.c and tests/app/test_steady_command.sh.

/* Whether no fish beats, neither by a wave nor by prescribed motion. */
bool steady_static_applies(const struct school *school);

/* STATUS_CASE, with the reason and the remedy, if the bodies can have no equilibrium. */
enum status steady_static_refuse(const struct school *school);

/* Bring a simulation from the initial state to the equilibrium and fill *found; the caller allocates found->fish. Start
 * from the shapes of another equilibrium in the file from. If from is NULL, has other bodies or gives no solution,
 * increase the stream in steps from rest. Fails with STATUS_SOLVER if no equilibrium exists; the message gives the
 * largest stream with an equilibrium. Fails also with STATUS_STOPPED. */
enum status steady_static_find(struct simulation *simulation, const char *from, struct steady_values *found);

// ---- steady_modes.c: growth and decay of small disturbances: modes of the bodies for an equilibrium, multipliers for
// a beat. Tested by tests/steady/test_steady_modes.c, test_steady.c and the section "elastic" of `make verify`.

/* Fill the exponents of an equilibrium; the state of the simulation is restored on success. Hold the bodies while a
 * wake of zero strength is convected downstream, then find the modes with solver/modes.h. No exponents with
 * pressure.span: finite, if the state jumps at events (wake.shedding: impulsive), without a stream, or without
 * shedding. Fails with STATUS_SOLVER or STATUS_STOPPED. */
enum status steady_modes_find(struct simulation *simulation, struct steady_values *found);

/* Fill the exponents of a beat from the multipliers and the period, s. */
void steady_modes_of_multipliers(struct steady_values *found, double period);

/* Floquet multipliers: factors by which small disturbances of the slow quantities grow in a beat, by falling absolute
 * value. */
struct steady_multipliers {
    int n;                    /* n_unknowns */
    double *real, *imaginary; /* 0: the disturbance has decayed below the noise          (n) */
    double *error;            /* of the absolute value: noise and size of the differences, memory of the wake  (n) */
    double *mode;             /* real and imaginary parts of the unknowns, over the scales and over the largest
                                    (n multipliers, n unknowns, 2) */
    double amplification;     /* largest norm of the unknowns, over the scales, within 32 beats after a unit change
                                    of one unknown */
    double *way;              /* step to the fixed point of the linearised map, over the scales of the unknowns (n) */
    int n_beats;              /* simulated */
};

/* Find the multipliers at the current state of the simulation. arena: of the arrays. The state is restored on success.
 * Fails with STATUS_SOLVER, STATUS_CONTACT or STATUS_STOPPED. */
enum status steady_multipliers_find(struct arena *arena, struct steady_problem *problem,
                                    struct steady_multipliers *found);

#endif
