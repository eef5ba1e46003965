/* residual.h: the equations of the whole school as one residual F(t, y, y') = 0, and its derivatives. Every solver
 * works with this pair and knows nothing else of the model. doc/model.md, section 10. Tested by
 * tests/school/test_residual.c. */
#ifndef RESIDUAL_H
#define RESIDUAL_H

#include <signal.h>
#include <stdbool.h>

#include "base/status.h"
#include "body/rod.h"
#include "contact/clearance.h"
#include "contact/contact.h"
#include "fish/fish.h"
#include "flow/flow.h"
#include "flow/flow_derivative.h"
#include "force/bound_sheet.h"
#include "force/force_model.h"
#include "school/jacobian.h"
#include "state/state.h"

/* The unknowns: which fish and which node each belongs to, its name and its scale. doc/model.md, section 10;
 * doc/numerics.md, section 3. */

/* The kinds of unknowns, for tolerances, for names in messages, and to tell which equations are algebraic. */
enum unknown {
    UNKNOWN_X,
    UNKNOWN_Y,
    UNKNOWN_VX,
    UNKNOWN_VY,
    UNKNOWN_PX,
    UNKNOWN_PY,
    UNKNOWN_AX,
    UNKNOWN_AY,
    UNKNOWN_GAMMA,
    UNKNOWN_CIRCULATION,
    UNKNOWN_PHI0
};
struct unknown_place {
    int fish, index; /* index: node or point of the sheet */
    enum unknown kind;
    int component;    /* if it belongs to a node: 0 is x, 1 is y */
    const char *name; /* "x", "sheet", ... */
};

/* Find fish, kind and index of unknown i. */
struct unknown_place residual_place(const struct school *school, int i);

/* The scale of unknown i, in its unit. Error tolerances are relative to it. */
double residual_scale(const struct school *school, int i);

/* A factor on the scale of unknown i, for methods that do not damp the vibrations of a stiff body. Velocities and
 * momenta then have the scale 0.1 L f, which is about the scale of positions times 2 pi f; without the factor their
 * scale never limits the step. 1 for all other unknowns. */
double residual_undamped(const struct school *school, int i);

/* The pairs of fish that have a coupling block in the Jacobian, because their outlines are closer than the reach or in
 * contact. doc/numerics.md, section 6. */

struct residual_couplings {
    const struct school *school;
    struct neighbours *neighbours; /* workspace of the residual                         (n_fish) */
    unsigned pattern;              /* changes with every change of coupled */
    double reach;                  /* fish couple if their outlines are at most this far apart, m */
    int couples_most;              /* the limit of memory has been reached */
    /* whether the Jacobian has the block of fish g in the rows of fish f        (n_fish, n_fish) */
    unsigned char *coupled;
};

/* Couple fish by the positions in y. */
void residual_couple(struct residual_couplings *couplings, const double *y);

/* Double the reach until more fish couple at the positions in y, and keep it. Returns whether more fish couple: 0 if
 * their blocks would exceed 400 MB. */
int residual_couple_more(struct residual_couplings *couplings, const double *y);

/* How the equations are evaluated. In a run everything here is zero. */
struct residual_mode {
    /* Which equation determines the circulation shed. In a run it is the law of the case. While an impulsive event is
     * solved it is the Kutta condition. Before the first marker of a free sheet the circulation is given. In an
     * equilibrium it is the Kutta condition with all shed circulation infinitely far away (wake_leave_behind). */
    enum shed_now { SHED_BY_LAW, SHED_BY_IMPULSE, SHED_IS_GIVEN, SHED_IS_FAR } shed;
    bool velocities_are_given; /* the momenta are the unknowns instead */

    /* For methods that extrapolate forces: all forces on the nodes but those of the body, N, in the rows ax, ay; they
     * replace those of contacts and fluid. Or NULL                                                     (n_unknowns) */
    const double *forces;
};
extern const struct residual_mode residual_run;

/* What the equations need besides the unknowns, and workspace, which is not part of the state. */
struct residual {
    const struct school *school;
    const struct state *state; /* wakes, control memory, time of the last event */
    struct flow *flow;
    struct contact *contact;
    struct fluid_force *force;           /* of the fluid on each fish                         (n_fish) */
    struct neighbours *neighbours;       /* workspace                                         (n_fish) */
    struct residual_couplings couplings; /* pairs of fish with a block in the Jacobian */
    struct range *joints;                /* of each fish                                     (n_fish) */
    struct actuation muscle;             /* actuation at the last evaluation                 (joints of all fish) */
    struct jacobian_scratch *jacobian_scratch; /* for each thread (threads) */
    double *scratch;                           /* for diagnostics; fish f uses its own slices (n_unknowns) */
    const volatile sig_atomic_t *stop; /* once *stop is not 0, residual_jacobian and initial_conditions_solve fail with
                                          STATUS_STOPPED; may be NULL */
};

/* Workspace of the derivatives. Those through the flow have room for any pair of fish; the last is how the law of
 * motion depends on the rate of phi0                                                               (2 n_nodes) */
struct jacobian_scratch {
    struct influence_block block;
    struct coupling_block rows;
    double *by_phi0_rate;
};

/* Create the residual; it reads the state in every evaluation, so the state must outlive it. */
struct residual *residual_create(struct arena *arena, const struct school *school, const struct state *state);

/* Set value = F(t, y, yp). Returns STATUS_RETRY if a value is not finite, or if repelling bodies touch. */
enum status residual_evaluate(struct residual *residual, const struct residual_mode *mode, double t, const double *y,
                              const double *yp, double *value);

/* Evaluate the actuation of the joints of fish f for the phi0 in y, keep it for the equations of the body that are
 * evaluated next, and return it. residual_muscle returns what is kept. */
struct actuation residual_actuate(struct residual *residual, int f, double t, const double *y);
struct actuation residual_muscle(const struct residual *residual, int f);

/* Set the rows ax, ay of fish f in N, without prescribed motion: m a minus all forces. Uses the flow velocity, the
 * natural curvature and the contacts of the last evaluation. */
void residual_balance(const struct residual *residual, int f, const double *y, double *value);

/* Subtract from the rows ax, ay of value, as residual_balance does, all forces on fish f but those of the body itself,
 * N. */
void residual_forces(const struct residual *residual, int f, const double *y, double *value);

/* Set the rows as residual_balance does and add the rate of the added momentum for the rates yp: these are the
 * reactions of prescribed nodes, N. */
void residual_reaction(const struct residual *residual, int f, const double *y, const double *yp, double *value);

/* The shedding rate of fish f by the rate form of the Kutta condition, m2 s-2, with the flow velocity of the last
 * evaluation. */
double residual_kutta_rate(const struct residual *residual, int f, const double *y);

/* The rate at which the circulation shed by fish f changes if it is a differential unknown: residual_kutta_rate, or 0
 * between impulses. */
double residual_shed_rate(const struct residual *residual, const struct residual_mode *mode, int f, const double *y);

/* The circulation that has been removed from the wake and is dropped from Kelvin's equation of fish f, m2 s-1. */
double residual_lost(const struct residual *residual, int f, double t);

/* Whether unknown i is differential, that is, whether its rate occurs in the equations. */
bool residual_is_differential(const struct school *school, const struct residual_mode *mode, int i);

/* Set kind[i] to 1 if unknown i is differential, to 0 if it is algebraic                                (n_unknowns) */
void residual_kinds(const struct residual *residual, const struct residual_mode *mode, double *kind);

/* Which equation determines the circulation shed, and whether it is algebraic in a run. */
enum bound_sheet_law residual_sheet_law(const struct residual *residual, const struct residual_mode *mode);
bool residual_shed_is_algebraic(const struct residual *residual);

#endif
