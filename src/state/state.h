/* state.h: the state of a run, that is every value that changes and that a resumed run needs; whatever is not here can
 * be computed again. Tested by tests/state/test_state.c. */
#ifndef STATE_H
#define STATE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/status.h"
#include "control/control.h"
#include "fish/fish.h"
#include "wake/wake.h"

/* Kinds of work: sum of all powers; actuation (muscle); forces of the fluid, in the frame of the water; internal
 * damping; prescribed motion and loads, and prescribed motion and loads in the frame of the water. */
enum work { WORK_ALL, WORK_ACTUATION, WORK_FLUID, WORK_DAMPING, WORK_DRIVING, WORK_DRIVING_ON_WATER, N_WORKS };

/* Values of one fish at the events of the last period, for means over the period: a ring of samples. */
struct sample {
    double com[2], tail[2]; /* m */
    double velocity[2];     /* centre of mass, m s-1 */
    double friction[2];     /* friction on the body, N */
    double force[2];        /* force of the fluid on the body, with friction, N */
    double stream[2];       /* external flow at the centre of mass, m s-1 */
    double drifted[2];      /* time integral of stream since the start, m */
    double speed;           /* mean speed through the water over the last period, m s-1; NaN in the first period */
    double heading;         /* rad, unwrapped */
    double leading_edge;    /* A_0; NaN unless force: pressure */
    double bias;            /* phi0 */
    double leader[2];       /* law place: centre of mass of the leader, m; other laws: 0 */
    double leader_heading;  /* law place: rad, unwrapped; other laws: 0 */
    double work[N_WORKS];   /* since the start, J */
};
struct history {
    int capacity;          /* samples of one period plus 1; 1 without a period */
    int n, last;           /* number of samples; slot of the newest sample */
    int n_slots;           /* grows with the samples up to capacity + 1: the slot of a new sample is free */
    struct sample *sample; /* (n_slots) */
};

/* The energy balance of one fish: work since the start, integrated over the steps of the integrator. */
struct energy_balance {
    double initial_energy;    /* J */
    double work[N_WORKS];     /* J */
    double t[2];              /* times of the last two steps, s; [0] is the newer step */
    double power[2][N_WORKS]; /* powers at t, W */
    int n;                    /* number of valid entries of t and power */
    /* with strain damping: strains of the rod, and stresses at the last two steps                (rod_n_strains) */
    double *strain, *stress, *stress_before;
};

/* The momentum balance of one fish: doc/model.md, section 13. Triples: x, y, and angular about the origin. */
struct momentum_balance {
    double lost[3];        /* circulation lost since the start: sums of G x, G y [m3 s-1], G |x|^2 [m4 s-1] */
    double external[3];    /* impulse of the external forces since the start, N s, N m s */
    double force[2][3];    /* external forces at the times energy_balance.t, N, N m */
    double images[3];      /* forces of images in walls, or of a travelling gust, at the last event, N, N m */
    double legs[3];        /* momentum that the lengths s of legs have taken since the start, N s, N m s */
    double leg_rate[3];    /* the rate of this loss at the last event, N, N m */
    double first_body[3];  /* momentum of the body at the start, N s, N m s */
    double first_fluid[3]; /* impulse of the vortices at the start, N s, N m s */
    double first_given[3]; /* momentum of the prescribed nodes with added mass at the start, N s, N m s */
};

/* The closest approach of two bodies since the start, at and between the steps of the integrator. */
struct closest {
    double distance; /* m; 0: contact; INFINITY: a single fish */
    double t;        /* time of the closest approach, s */
    int fish[2];     /* numbers of the two fish */
    double before_t; /* time of the last step, s */
    double *before;  /* unknowns at before_t; only positions are used       (n_unknowns) */
};

/* Values of the worst divergence: size over the limit of the warning (school/warnings.h), 0: none; time, s; speed of a
 * node or of a vortex, m s-1; circulation shed, or of a vortex, m2 s-1. */
enum divergence { DIVERGENCE_SIZE, DIVERGENCE_T, DIVERGENCE_SPEED, DIVERGENCE_CIRCULATION, N_DIVERGENCE };

/* Values of the worst place in a faded wake: the part of the velocity of other fish's wakes that decay has taken, 0:
 * none; time, s; number of fish that miss too much at this time (school/warnings.h). */
enum fading { FADING_PART, FADING_T, FADING_FISH, N_FADING };

enum { STATE_PAST = 4 };

struct state {
    struct arena *arena;               /* of all arrays and of the state itself */
    double t;                          /* time of the last event, s */
    long event;                        /* number of the last event, 0 at the start */
    double *y, *yp;                    /* unknowns and rates of the unknowns               (n_unknowns) */
    long n_past;                       /* valid rows of past */
    double *past;                      /* unknowns at the last events, newest first        (STATE_PAST, n_unknowns) */
    struct wake *wake;                 /* (n_fish) */
    struct control_memory *control;    /* (n_fish) */
    struct history *history;           /* (n_fish) */
    struct energy_balance *balance;    /* (n_fish) */
    struct momentum_balance *momentum; /* (n_fish) */
    struct closest *closest;           /* (1) */
    bool has_crossed;                  /* whether a body has crossed itself at an event */
    long crossed;                      /* the first fish with such a self-crossing */
    double crossed_t;                  /* time of this event, s */
    long diverged;                     /* the fish with the worst divergence at an event so far */
    double divergence[N_DIVERGENCE];
    long faded; /* the fish in the most faded wake so far */
    double fading[N_FADING];
};

/* Create the state before the start, in an arena of its own: bodies at the start positions, all other values zero. The
 * state is released with the parent arena, or by state_free, which accepts NULL. */
struct state *state_create(struct arena *parent, const struct school *school);
void state_free(struct state *state);

/* Rates of algebraic unknowns at an event, before the event changes an unknown: the slope of the quartic through the
 * unknowns at this event and the last STATE_PAST events, of fewer after state_begin_rates. Sets yp of velocities and
 * bound strengths of fish with force: pressure, and of the shed circulation of all fish unless differential. Within an
 * interval the rates grow from event to event with the nascent stretch, and jump back: doc/numerics.md, section 3. */
void state_find_rates(struct state *state, const struct school *school, bool shed_is_algebraic);

/* Discard the events before a jump; the next rates begin with the present unknowns. */
void state_begin_rates(struct state *state, const struct school *school);

/* A number that changes with every change of any wake, and how many of the changes were of velocities alone. */
unsigned long state_wake_version(const struct state *state, const struct school *school);
unsigned long state_wake_turns(const struct state *state, const struct school *school);

/* Make room for the next sample of every fish. */
void state_reserve(struct state *state, const struct school *school);

/* Remove the newest sample of a history. */
void state_forget_newest(struct history *history);

/* Add a sample to a history with room for the sample; a full history drops the oldest sample. */
void state_remember(struct history *history, const struct sample *sample);

/* The sample that is age events old, 0 the newest; age < history->n. */
const struct sample *state_recall(const struct history *history, int age);

/* ---- the table of every field, with place and length. Code that writes, reads, copies or compares a state loops over
 * this table: a new field of struct state, or of a struct owned by struct state, is a new row. tests/state/test_state.c
 * fails for a field without a row. */

/* The struct that contains a field: the state, a struct of every fish, or the closest approach. */
enum state_owner {
    STATE_ITSELF,
    STATE_WAKE,
    STATE_CONTROL,
    STATE_HISTORY,
    STATE_BALANCE,
    STATE_MOMENTUM,
    STATE_CLOSEST
};

enum state_type {
    STATE_REAL,    /* double */
    STATE_INTEGER, /* int */
    STATE_COUNT,   /* long */
    STATE_FLAG,    /* bool */
    STATE_UNKEPT   /* property of the memory, not of the state: neither copied nor written */
};

/* The length of an array: unknowns, unknowns of STATE_PAST events, vortices of a wake, samples, strains of a rod. */
enum state_length { STATE_NO_ARRAY, STATE_UNKNOWNS, STATE_PASTS, STATE_VORTICES, STATE_SAMPLES, STATE_STRAINS };

struct state_row {
    const char *name; /* "y", "wake.x" */
    enum state_owner owner;
    enum state_type type;
    size_t offset;            /* offset of the field in the owner, bytes */
    size_t bytes;             /* size of the field: the values, or, with length, the address of an array */
    enum state_length length; /* of the array */
};

/* The row of an array follows the row with the length of the array. */
extern const struct state_row state_table[];
extern const int state_table_n;

/* The number of instances of a field in a state: 1, or n_fish. */
int state_table_n_owners(const struct state_row *row, const struct school *school);

/* For the values of fish f: number of values, size of a value in bytes, address of the values
 * to read or to write. */
size_t state_table_length(const struct state_row *row, const struct state *state, const struct school *school, int f);
size_t state_table_size(const struct state_row *row);
const void *state_table_values(const struct state_row *row, const struct state *state, int f);
void *state_table_place(const struct state_row *row, struct state *state, int f);

/* Resize the arrays of all wakes to n_vortex, and the samples to n_slots. Code that reads a state calls this function
 * between the numbers and the arrays. */
void state_table_make_room(struct state *state, const struct school *school);

/* Copy a state into another state of the same school. The wake versions increase, so that struct flow evaluates wakes
 * again. Without samples, these stay where they are: keep a state before an event, and return to this state after at
 * most one further sample of each fish. After a lack of memory the target can only be freed. */
void state_table_copy(struct state *to, const struct state *from, const struct school *school, bool with_samples);

/* Fail with STATUS_FILE if a number that serves as an index is out of range for the school, if the time differs from
 * the time of the event, or if a value that is always defined is not finite. */
enum status state_table_check(const struct state *state, const struct school *school);

#endif
