/* steady_map.h: a simulation as a map from one beat to the next: of a few slow quantities of its fish, which can be
 * read and changed where a beat ends; all else runs along. doc/steady.md. Tested by
 * tests/steady/test_steady.c. */
#ifndef STEADY_MAP_H
#define STEADY_MAP_H

#include "result/steady_values.h"
#include "run/simulate.h"
#include "school/rigid.h"

/* The slow quantities of a fish: velocity through the water along its heading and to the left of it, rate of turning;
 * heading, and place ahead of the first fish and to its left, seen from that one; circulation that it has shed. The
 * heading of the first fish counts from the one that the first law of control wants, and all fish turn with it, around
 * the first. What is added to the circulation has been shed infinitely long ago. */
enum steady_quantity {
    STEADY_SPEED,
    STEADY_SLIP,
    STEADY_TURN,
    STEADY_HEADING,
    STEADY_AHEAD,
    STEADY_ASIDE,
    STEADY_SHED
};

struct steady_unknown {
    int fish;
    enum steady_quantity quantity;
};

/* How a fish can move as a whole. */
enum steady_freedom {
    STEADY_HELD,   /* its motion is given */
    STEADY_SURGES, /* only along its heading: motion.surge: free */
    STEADY_SWIMS   /* freely */
};
enum steady_freedom steady_map_freedom(const struct fish *fish);

/* The sums of one beat. */
struct steady_beat {
    double speed;                              /* m s-1 */
    double place[2];                           /* at its end, ahead of the first fish and to its left, m */
    double turn;                               /* rad */
    double force[2], thrust;                   /* means, N */
    double rms_thrust;                         /* N */
    double actuation, damping, driving, fluid; /* means, W */
    double rms_power;                          /* of actuation and driving together, W */
};

struct steady_map {
    struct simulation *simulation;
    int is_formation;                  /* whether places count in the residual */
    int steered;                       /* the first fish with a law of control; -1: none has */
    long events;                       /* in a beat */
    double period;                     /* s */
    int n_beats;                       /* so far */
    struct steady_beat *last, *before; /* the last two beats                                  (n_fish) */
};

/* The map of a simulation, which stays its owner's. Fails with STATUS_CASE where the case has no beat that all of it
 * repeats, with the remedy, or with STATUS_MEMORY; steady_map_free takes a zeroed map. */
enum status steady_map_create(struct steady_map *map, struct simulation *simulation);
void steady_map_free(struct steady_map *map);

/* Go on by a beat. row, if any, is called at each event. Fails as simulate_step or row. */
enum status steady_map_beat(struct steady_map *map, enum status (*row)(void *data), void *data);

/* The largest change from the last beat but one to the last: of the speed in lengths per beat; of a tenth of the turn
 * in full circles, or of the whole where a fish has a steering bias; of a formation, of the places in lengths; of a
 * fish that is held, of thrust and power over their root mean squares. */
double steady_map_residual(const struct steady_map *map);

/* The unit in which a quantity is measured: lengths per beat, rad per beat, rad, lengths, squares of them per beat; in
 * m s-1, s-1, rad, m, m2 s-1. */
double steady_map_scale(const struct steady_map *map, struct steady_unknown unknown);

/* What the quantities are now, in SI units                                                        (n) */
void steady_map_read(const struct steady_map *map, int n, const struct steady_unknown *unknown, double *value);

/* Add to them; the state is then consistent again, and the integration has begun again. Fails with STATUS_SOLVER, as
 * where bodies overlap then, or with STATUS_MEMORY. */
enum status steady_map_add(struct steady_map *map, int n, const struct steady_unknown *unknown, const double *add);

/* Keep the state, and return to it; both begin the integration again. *state is made where it is NULL; state_free
 * releases it. Fail with STATUS_MEMORY or STATUS_SOLVER. */
enum status steady_map_save(struct steady_map *map, struct state **state);
enum status steady_map_return(struct steady_map *map, const struct state *state);

#endif
