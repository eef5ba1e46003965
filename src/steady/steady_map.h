/* steady_map.h: a simulation seen as a map from one beat to the next. At the end of a beat the slow quantities of the
 * fish can be read and changed; the fast ones follow by themselves. doc/steady.md. Tested by
 * tests/steady/test_steady.c. */
#ifndef STEADY_MAP_H
#define STEADY_MAP_H

#include <stdbool.h>

#include "result/result_row.h"
#include "run/simulate.h"
#include "school/rigid.h"

/* The slow quantities of a fish: velocity relative to the water along the heading and to the left, rate of turning;
 * heading, and place ahead and to the left of the first fish, in the frame of the first fish; shed circulation. The
 * heading of the first fish is relative to the desired heading of the first control law. A change of this heading
 * rotates the whole school about the first fish. Added circulation counts as shed infinitely long ago. The integrals of
 * control law place: of the amplitude and of the course. */
enum steady_quantity {
    STEADY_SPEED,
    STEADY_SLIP,
    STEADY_TURN,
    STEADY_HEADING,
    STEADY_AHEAD,
    STEADY_ASIDE,
    STEADY_HOLD_ALONG,
    STEADY_HOLD_ACROSS,
    STEADY_SHED
};

struct steady_unknown {
    int fish;
    enum steady_quantity quantity;
};

/* Freedom of the motion of a whole fish. */
enum steady_freedom {
    STEADY_HELD,   /* prescribed motion */
    STEADY_SURGES, /* free along the heading only (motion.surge: free) */
    STEADY_SWIMS   /* free */
};
enum steady_freedom steady_map_freedom(const struct fish *fish);

/* Means and end values of one beat. */
struct steady_beat {
    double speed;                              /* m s-1 */
    double place[2];                           /* centre of mass ahead and to the left of the first fish, m */
    double end_place[2];                       /* the same at the end of the beat, along the heading at the end, m */
    double heading;                            /* mean, rad */
    double turn;                               /* rad */
    double force[2], thrust;                   /* means, N */
    double rms_thrust;                         /* N */
    double actuation, damping, driving, fluid; /* means, W */
    double rms_power;                          /* of the sum of actuation and driving power, W */
};

struct steady_map {
    struct simulation *simulation;
    bool is_formation; /* the residual includes places */
    bool is_steered;   /* whether a fish has a control law other than place; the first one */
    int steered;
    long events;                       /* per beat */
    double period;                     /* s */
    int n_beats;                       /* beats since the start */
    struct steady_beat *last, *before; /* the last two beats                                  (n_fish) */
};

/* STATUS_CASE, with the reason and the remedy, if the whole case does not repeat with one beat. */
enum status steady_map_refuse(const struct school *school);

/* Create the map of a simulation, in the arena of the simulation. Fails as steady_map_refuse. */
enum status steady_map_create(struct steady_map *map, struct simulation *simulation);

/* Advance by one beat; call row, unless NULL, after each event. Fails as simulate_step or row. */
enum status steady_map_beat(struct steady_map *map, enum status (*row)(void *data), void *data);

/* The largest change between the last two beats: speed in lengths per beat; turn in full circles, divided by ten unless
 * the fish has a steering bias; places of a formation in lengths; thrust and power of a held fish over the root mean
 * squares. */
double steady_map_residual(const struct steady_map *map);

/* The scale of a quantity (length per beat, rad per beat, rad, length, square length per beat) in m s-1, s-1, rad, m,
 * m2 s-1. */
double steady_map_scale(const struct steady_map *map, struct steady_unknown unknown);

/* Read the current values of the quantities, SI units                                             (n) */
void steady_map_read(const struct steady_map *map, int n, const struct steady_unknown *unknown, double *value);

/* Add increments to the quantities, solve for a consistent state and restart the integration. Fails with STATUS_SOLVER,
 * also if bodies overlap. */
enum status steady_map_add(struct steady_map *map, int n, const struct steady_unknown *unknown, const double *add);

/* Save the state; return to a saved state and restart the integration. steady_map_save creates *state in the arena, a
 * child of the arena of the simulation, if NULL. steady_map_return fails with STATUS_SOLVER. */
void steady_map_save(struct arena *arena, const struct simulation *simulation, struct state **state);
enum status steady_map_return(struct simulation *simulation, const struct state *state);

#endif
