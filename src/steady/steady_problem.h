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
    double *pinned;    /* (n_pins) */
    double *scratch;   /* (4 n_unknowns) */
    double *jacobian;  /* of a formation: derivatives of the change per beat by the unknowns, in the scales of the
                         unknowns, by columns; NULL: not evaluated yet (n_unknowns, n_unknowns) */
    bool is_near;      /* the simulation began with the whole state of a neighbour */
    double multiplier; /* of a disturbance of the speed of the only fish, as a neighbour has it: the result is
                          extrapolated with it; NAN: unknown */
    double recent[STEADY_RECENT]; /* speed of the first fish in the last beats, beat n at n % STEADY_RECENT, m s-1 */
    /* called after each beat of the search; may be NULL */
    void (*progress)(const struct steady_problem *problem, void *data);
    void *data;
};

/* STATUS_CASE, with the reason and the remedy, if fish that beat can have no steady state: fish in a shear or beside a
 * wall, fish that change heading, or several fish that are no formation. */
enum status steady_problem_refuse(const struct case_steady *settings, const struct school *school);

/* Pose the problem for a simulation at the initial state, in the arena of the simulation. Fails as
 * steady_problem_refuse and steady_map_refuse. */
enum status steady_problem_create(struct steady_problem *problem, const struct case_steady *settings,
                                  struct simulation *simulation);

/* Advance the search by one beat. Fails with STATUS_SOLVER and the reason after settings->beats beats, or as
 * steady_map_beat. */
enum status steady_problem_beat(struct steady_problem *problem);

/* Read the unknowns, over the scales                                                             (n_unknowns) */
void steady_problem_read(const struct steady_problem *problem, double *value);

/* Set the unknowns to these values, over the scales. Fails as steady_map_add.                    (n_unknowns) */
enum status steady_problem_put(struct steady_problem *problem, const double *to);

/* The largest change between the last two beats, as steady_map_residual. With a multiplier, the change of the speed is
 * that part which a slow disturbance does not explain, whose changes in two beats have this ratio. This is the residual
 * of the extrapolated result, in which the disturbance has decayed. */
double steady_problem_residual(const struct steady_problem *problem);

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

#endif
