/* state.h: the state of a run: every value that changes and that a resumed run needs. Tested by
 * tests/state/test_state.c. */
#ifndef STATE_H
#define STATE_H

#include <stddef.h>

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
    double work[N_WORKS];   /* since the start, J */
};
struct history {
    int capacity;          /* samples of one period plus 1; 1 without a period */
    int n, last;           /* number of samples; index of the newest sample */
    struct sample *sample; /* (capacity) */
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
    double legs[3];        /* loss rate by the lengths s of legs at the last event; units of lost, per s */
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

struct state {
    double t;                          /* time of the last event, s */
    long event;                        /* number of the last event, 0 at the start */
    double *y, *yp;                    /* unknowns and rates of the unknowns               (n_unknowns) */
    struct wake *wake;                 /* (n_fish) */
    struct control_memory *control;    /* (n_fish) */
    struct history *history;           /* (n_fish) */
    struct energy_balance *balance;    /* (n_fish) */
    struct momentum_balance *momentum; /* (n_fish) */
    struct closest *closest;           /* (1) */
    long crossed;                      /* the first fish with a self-crossing at an event, or -1 */
    double crossed_t;                  /* time of this event, s */
};

/* Create the state before the start: bodies at the start positions, all other values zero. Fails with STATUS_MEMORY. */
enum status state_create(struct state **state, const struct school *school);

/* Release the state with all arrays. Accepts NULL. */
void state_free(struct state *state, const struct school *school);

/* A number that changes with every change of any wake. */
unsigned long state_wake_version(const struct state *state, const struct school *school);

/* Add a sample to a history; a full history drops the oldest sample. */
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
    STATE_UNKEPT   /* property of the memory, not of the state: neither copied nor written */
};

struct state_row {
    const char *name; /* "y", "wake.x" */
    enum state_owner owner;
    enum state_type type;
    size_t offset; /* offset of the field in the owner, bytes */
    size_t bytes;  /* size of the field: the values, or, with length, the address of an array */
    size_t (*length)(const struct state *state, const struct school *school,
                     int f); /* length of the array; NULL: no array */
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

/* Resize the arrays of all wakes to n_vortex. Code that reads a state calls this function between the numbers and the
 * arrays. Fails with STATUS_MEMORY. */
enum status state_table_make_room(struct state *state, const struct school *school);

/* Copy a state into another state of the same school. The wake versions increase, so that struct flow evaluates wakes
 * again. Fails with STATUS_MEMORY; the target can then only be freed. */
enum status state_table_copy(struct state *to, const struct state *from, const struct school *school);

/* Fail with STATUS_FILE if a number that serves as an index is out of range for the school, if the time differs from
 * the time of the event, or if a value that is always defined is not finite. */
enum status state_table_check(const struct state *state, const struct school *school);

#endif
