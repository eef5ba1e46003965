/* residual.h: the equations of the whole school as one residual F(t, y, y') = 0, and its derivatives.
 * doc/model.md, section 10. Tested by tests/school/test_residual.c. */
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

/* Fish, node, name and scale of every unknown. doc/model.md, section 10;
 * doc/numerics.md, section 3. */

/* The kind of an unknown, for tolerances, names in messages, and the choice of algebraic equations. */
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
    int component;    /* of an unknown of a node: 0: x, 1: y */
    const char *name; /* "x", "sheet", ... */
};

/* Fish, kind and index of unknown i. */
struct unknown_place residual_place(const struct school *school, int i);

/* The scale of unknown i, in the unit of the unknown; error tolerances are relative to the scale. */
double residual_scale(const struct school *school, int i);

/* The factor on the scale of unknown i for methods that do not damp the vibrations of a stiff body: velocities and
 * momenta then have the scale 0.1 L f, about the scale of positions times 2 pi f; the scale without this factor never
 * limits the step. 1 for other unknowns. */
double residual_undamped(const struct school *school, int i);

/* Pairs of fish with a coupling block in the Jacobian: outlines closer than the reach, or in
 * contact. doc/numerics.md, section 6. */

struct residual_couplings {
    const struct school *school;
    struct neighbours *neighbours; /* workspace of the residual                         (n_fish) */
    unsigned pattern;              /* changes with every change of coupled */
    double reach;                  /* fish couple if the distance of the outlines is at most this, m */
    int couples_most;              /* memory limit reached */
    unsigned char *coupled; /* whether the Jacobian holds the block of fish g in the rows of fish f (n_fish, n_fish) */
};

/* Couple fish by the positions in y. */
void residual_couple(struct residual_couplings *couplings, const double *y);

/* Double the reach until more fish couple at the positions in y; the new reach is kept. Returns whether more fish
 * couple: 0 if the blocks would exceed 400 MB. */
int residual_couple_more(struct residual_couplings *couplings, const double *y);

/* How the equations are evaluated: all zero in a run. */
struct residual_mode {
    /* The equation for the circulation shed: the law of the case; the Kutta condition, during the solution of an
     * impulsive event; a given circulation, before the first marker of a free sheet; the Kutta condition with all shed
     * circulation infinitely far away (wake_leave_behind), in an equilibrium. */
    enum shed_now { SHED_BY_LAW, SHED_BY_IMPULSE, SHED_IS_GIVEN, SHED_IS_FAR } shed;
    bool velocities_are_given; /* momenta are solved for */

    /* forces on the nodes besides those of the body, N, in the rows ax, ay, in place of those of contacts and fluid,
     * for methods that extrapolate them; or NULL                                                      (n_unknowns) */
    const double *forces;
};
extern const struct residual_mode residual_run;

/* Input of the equations besides the unknowns, and workspace; the workspace is not part of the state. */
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
    struct jacobian_scratch *jacobian_scratch; /* scratch of each thread                          (threads) */
    double *scratch;                   /* scratch of diagnostics; fish f uses the slices of fish f     (n_unknowns) */
    const volatile sig_atomic_t *stop; /* once *stop is not 0, residual_jacobian and initial_conditions_solve fail with
                                          STATUS_STOPPED; may be NULL */
};

/* Scratch of the derivatives: through the flow, large enough for any pair of fish; of the law of motion by the rate of
 * phi0                                                                                              (2 n_nodes) */
struct jacobian_scratch {
    struct influence_block block;
    struct coupling_block rows;
    double *by_phi0_rate;
};

/* Every evaluation reads the state, which must outlive the residual. */
struct residual *residual_create(struct arena *arena, const struct school *school, const struct state *state);

/* value = F(t, y, yp). Returns STATUS_RETRY if a value is not finite, or if repelling bodies touch. */
enum status residual_evaluate(struct residual *residual, const struct residual_mode *mode, double t, const double *y,
                              const double *yp, double *value);

/* Evaluate the actuation of the joints of fish f for the phi0 in y; and the actuation of the last evaluation. */
void residual_actuate(struct residual *residual, int f, double t, const double *y);
struct actuation residual_muscle(const struct residual *residual, int f);

/* The rows ax, ay of fish f in N, without prescribed motion: m a minus all forces. Uses flow velocity, natural
 * curvature and contacts of the last evaluation. */
void residual_balance(const struct residual *residual, int f, const double *y, double *value);

/* Subtract the forces on fish f besides those of the body, N, from the rows ax, ay of value, as residual_balance does.
 */
void residual_forces(const struct residual *residual, int f, const double *y, double *value);

/* The rows of residual_balance plus the rate of the added momentum, for the rates yp: the reactions of prescribed
 * nodes, N. */
void residual_reaction(const struct residual *residual, int f, const double *y, const double *yp, double *value);

/* The shedding rate of fish f by the rate form of the Kutta condition, m2 s-2. Uses the flow velocity of the last
 * evaluation. */
double residual_kutta_rate(const struct residual *residual, int f, const double *y);

/* The rate of the circulation shed by fish f as a differential unknown: residual_kutta_rate, or 0 between impulses. */
double residual_shed_rate(const struct residual *residual, const struct residual_mode *mode, int f, const double *y);

/* Removed circulation that is dropped from the Kelvin equation of fish f, m2 s-1. */
double residual_lost(const struct residual *residual, int f, double t);

/* Whether unknown i is differential: whether its rate occurs in the equations. */
bool residual_is_differential(const struct school *school, const struct residual_mode *mode, int i);

/* kind[i] = 1 if unknown i is differential, 0 if algebraic                                      (n_unknowns) */
void residual_kinds(const struct residual *residual, const struct residual_mode *mode, double *kind);

/* The equation for the circulation shed, and whether this equation is algebraic in a run. */
enum bound_sheet_law residual_sheet_law(const struct residual *residual, const struct residual_mode *mode);
int residual_shed_is_algebraic(const struct residual *residual);

// ---- residual_jacobian.c: the derivatives of the residual. doc/numerics.md, section 6.

/* jacobian = dF/dy + cj dF/dyp, with the blocks of the coupled fish; fish in contact couple from this call on. Fails
 * as residual_evaluate if bodies touch. */
enum status residual_jacobian(struct residual *residual, const struct residual_mode *mode, double t, double cj,
                              const double *y, struct jacobian *jacobian);

/* Set the derivatives of impermeability at the control points of every fish by the circulation shed by the same fish,
 * in the impermeability rows of value (n_unknowns), and where the sheet loads the body those of the equation of motion.
 * All other rows are unchanged. Uses the flow of the last evaluation, at the unknowns y. While the nascent
 * stretch of a free sheet grows, these derivatives change more from step to step than all others. */
void residual_by_shed(struct residual *residual, const double *y, double *value);

/* Mask the rows of prescribed motion in the Jacobian, and unmask all other rows. */
void residual_mask(const struct residual *residual, struct jacobian *jacobian);

#endif
