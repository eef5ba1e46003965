/* state.h: all that changes during a run and that a later run needs to continue, and nothing else. Tested by
 * tests/state/test_state.c. */
#ifndef STATE_H
#define STATE_H

#include "base/status.h"
#include "control/control.h"
#include "fish/fish.h"
#include "wake/wake.h"

/* The works that are kept: of all powers; of the muscle; of all forces of the fluid, in the frame of the water; of the
 * internal damping; of prescribed motion and loads, and the same in the frame of the water. */
enum work { WORK_ALL, WORK_ACTUATION, WORK_FLUID, WORK_DAMPING, WORK_DRIVING, WORK_DRIVING_ON_WATER, N_WORKS };

/* What one fish did at the events of the last period, for means over it: a ring of samples. */
struct sample {
    double com[2], tail[2]; /* m */
    double velocity[2];     /* of the centre of mass, m s-1 */
    double friction[2];     /* on the body, N */
    double force[2];        /* of the fluid on the body, friction included, N */
    double stream[2];       /* the external flow there, m s-1, */
    double drifted[2];      /* and its integral since the start, m */
    double speed;           /* through the water over the last period, m s-1; NaN before a whole one has passed */
    double heading;         /* rad, unwrapped */
    double leading_edge;    /* A_0; NaN unless force: pressure */
    double work[N_WORKS];   /* since the start, J */
};
struct history {
    int capacity;          /* samples in one period and one more; 1 where there is no period */
    int n, last;           /* how many there are; where the newest one is */
    struct sample *sample; /* (capacity) */
};

/* The energy balance of one fish: the work done since the start, summed over the integrator's own steps. */
struct energy_balance {
    double initial_energy;    /* J */
    double work[N_WORKS];     /* J */
    double t[2];              /* the last two steps: times, s; [0] is the newer */
    double power[2][N_WORKS]; /* and powers, W */
    int n;                    /* how many of those there are */
    /* with damping of the strain: the strains of the rod, and the stresses at the last two steps  (rod_n_strains) */
    double *strain, *stress, *stress_before;
};

/* The balance of momentum of one fish: doc/model.md, section 13. Triples: x, y, and angular about the origin. */
struct momentum_balance {
    double lost[3];        /* of the circulation lost since the start: sums of G x, G y [m3 s-1], G |x|^2 [m4 s-1] */
    double external[3];    /* impulse of the external forces since the start, N s, N m s */
    double force[2][3];    /* these forces at the last two steps, whose times the energy balance has, N, N m */
    double images[3];      /* those of images in walls at the last event, N, N m */
    double legs[3];        /* what the lengths s of legs cost per time at the last event, as lost, per s */
    double first_body[3];  /* momentum of the body at the start, N s, N m s, */
    double first_fluid[3]; /* impulse of its vortices then, */
    double first_given[3]; /* and momentum of its prescribed nodes, with that of the fluid that moves with them */
};

/* The closest that two bodies have come to each other, at any step of the integrator or between two of them. */
struct closest {
    double distance; /* m; 0: they have touched; INFINITY: there is one fish only */
    double t;        /* when, s */
    int fish[2];     /* their numbers */
    double before_t; /* the last step: its time, s, */
    double *before;  /* and the unknowns, of which positions are used       (n_unknowns) */
};

struct state {
    double t;                          /* time of the last event, s */
    long event;                        /* its number, 0 at the start */
    double *y, *yp;                    /* the unknowns and their rates                     (n_unknowns) */
    struct wake *wake;                 /* (n_fish) */
    struct control_memory *control;    /* (n_fish) */
    struct history *history;           /* (n_fish) */
    struct energy_balance *balance;    /* (n_fish) */
    struct momentum_balance *momentum; /* (n_fish) */
    struct closest *closest;           /* (1) */
    long crossed;                      /* the first fish whose body has crossed itself at an event, or -1; and */
    double crossed_t;                  /* when, s */
};

/* The state before the start: bodies placed, everything else zero. Fails with STATUS_MEMORY. */
enum status state_create(struct state **state, const struct school *school);

/* Release the state and all that it owns. Accepts NULL. */
void state_free(struct state *state, const struct school *school);

/* Changes whenever a vortex of any wake does. */
unsigned long state_wake_version(const struct state *state, const struct school *school);

/* Add a sample to a history; the oldest one falls out when it is full. */
void state_remember(struct history *history, const struct sample *sample);

/* The sample that is age events old, 0 the newest; age < history->n. */
const struct sample *state_recall(const struct history *history, int age);

#endif
