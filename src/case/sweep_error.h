/* sweep_error.h: what an error estimate varies: the numerical keys, the choices of the model and the inputs, which have
 * sensitivities; and what a case asks for. Tested by tests/case/test_sweep.c.
 *
 *     error: {of: [steady_speed, steady_cost_of_transport], within: 0.01, keys: default, confirm: true, models: false}
 *     error: {of: steady_cost_of_transport, against: alone.yaml}     or first, 1e5, follower=leader
 *     error: {of: steady_cost_of_transport, sensitivity: true}           or [modulus, "fish[follower].wave.amplitude"]
 *     error: {of: steady_cost_of_transport, uncertain: {modulus: 20%, drag.transition: 0.5}}
 *
 * How it is evaluated: study/error_plan.h and doc/studies.md. */
#ifndef SWEEP_ERROR_H
#define SWEEP_ERROR_H

#include "base/text.h"
#include "case/case_values.h"
#include "case/yaml_tree.h"

// ---- keys

enum sweep_error_kind {
    SWEEP_POINTS,   /* a number of points n: grid spacing 1/(n - 1) */
    SWEEP_SPACING,  /* the value is the grid spacing, or a tolerance */
    SWEEP_DURATION, /* the larger the better: 1/duration is the grid spacing */
    SWEEP_MODEL,    /* a choice of the model, varied with `models`; the change is printed and is not an error */
    SWEEP_INPUT     /* a number of the case, varied for the derivative of a quantity */
};

/* A numerical key, a choice of the model, or an input. */
struct sweep_error_key {
    const char *path;      /* of the table of keys */
    const char *companion; /* another key that is changed in proportion; NULL: none */
    enum sweep_error_kind kind;
    double coarser[2], finer; /* levels: the base value times these; 0: none */
    double order;             /* design order; 0: none. See sweep_error_order */
    int n_levels;             /* a choice: levels that do not depend on the base value, numbers of words among them */
    double level[2];          /* (n_levels) */
    const char *switch_path;  /* the key that must have the value of the switch; NULL: none */
    int switch_value;
    const char *name; /* of an input of one fish: "fish[follower].wave.amplitude"; NULL: of all fish in proportion */
    int fish;         /* that fish */
};

/* How a key is called: its name, or its path. */
static inline const char *sweep_error_name(const struct sweep_error_key *key) {
    return key->name ? key->name : key->path;
}

enum { SWEEP_N_ERROR_KEYS = 20 };
extern const struct sweep_error_key sweep_error_keys[SWEEP_N_ERROR_KEYS];

/* The inputs of the model: body, gait, drag, fluid, smoothing and limits of suction. */
enum { SWEEP_N_INPUTS = 30 };
extern const struct sweep_error_key sweep_inputs[SWEEP_N_INPUTS];

/* The row of a key by the path in the table of keys, such as "fish.nodes"; NULL: not in the table. */
const struct sweep_error_key *sweep_error_find(const char *path);

/* The design order of a key in this case; NaN: none. */
double sweep_error_order(const struct case_values *values, const struct sweep_error_key *key);

// ---- settings of a case

enum { SWEEP_ERROR_LEVELS = 9 /* at most so many given levels of a key, without the level of the case */ };

/* The levels of a key. */
struct sweep_error_levels {
    const struct sweep_error_key *key;
    int n;         /* 0: all keys of the table */
    double *value; /* (n) */
};

#define SWEEP_ERROR_MOST 16.0 /* the default of most */

/* What the quantities of a case are compared with. */
enum sweep_against {
    AGAINST_NOTHING,
    AGAINST_POINT, /* the first point along the first axis of the sweep, or the point with a value of its first key */
    AGAINST_FISH,  /* another fish of the same run: "follower=leader" */
    AGAINST_CASE   /* another case */
};

/* A number of the case whose influence is asked for. */
struct sweep_error_input {
    const struct sweep_error_key *key;
    double uncertainty; /* of the number, as a part of it; 0: only the sensitivity is asked for */
};

struct sweep_error {
    int n_of;
    char **of;     /* names of quantities of a result or of a steady state     (n_of) */
    double within; /* refine until the error is below this part of the value; 0: do not refine */
    double most;   /* refine to members of at most this many times the cost of the case */
    bool confirm;  /* with a finer level of each key */
    bool models;   /* with all choices of the model */
    enum sweep_against against_kind;
    char *against; /* "first" or a value, two names, or the text of the other case; NULL: nothing */
    int n_keys;
    struct sweep_error_levels *levels; /* of the keys that are varied; none: of all     (n_keys) */
    bool sensitivity;                  /* only the derivatives of the quantities by the inputs */
    int n_inputs;
    struct sweep_error_input *input; /* none with sensitivity: all     (n_inputs) */
};

/* Read a part of a number: "5%", "5 %" or "0.05"; false unless it is above 0 and finite. */
bool sweep_error_part(const char *text, double *part);

/* Whether the text of `against` names the file of a case: it ends in .yaml or .yml. */
bool sweep_error_is_file(const char *against);

/* Read `error` of a case. */
void sweep_error_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors);

/* Add "{of: [steady_speed], within: 0.01}": all that is not a default. */
void sweep_error_write(struct text *text, const struct sweep_error *error);

#endif
