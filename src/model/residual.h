/* residual.h: the equations of the whole school as one residual F(t, y, y') = 0, and its Jacobian. doc/model.md,
 * section 10. Tested by tests/model/test_residual.c. */
#ifndef RESIDUAL_H
#define RESIDUAL_H

#include "base/status.h"
#include "model/contact.h"
#include "model/flow.h"
#include "model/flow_derivative.h"
#include "model/jacobian.h"
#include "model/pressure.h"
#include "model/state.h"

/* What determines the circulation that has been shed: the law of the case; Kutta's condition, while an impulsive event
 * is solved; nothing, it is given: before the first marker of a free sheet is born. */
enum shed_now { SHED_BY_LAW, SHED_BY_IMPULSE, SHED_IS_GIVEN };

/* What the equations need besides the unknowns; workspace that holds nothing a restart would miss. */
struct residual {
    const struct school *school;
    const struct state *state; /* wakes, control memory, time of the last event */
    struct flow *flow;
    struct contact *contact;
    enum shed_now shed_now;        /* what determines the circulation shed */
    int at_start;                  /* whether the velocities are given, and momenta follow from them */
    struct pressure **pressure;    /* of each fish; NULL where its force is another one   (n_fish) */
    unsigned pattern;              /* changes whenever coupled does */
    struct neighbours *neighbours; /* workspace                                         (n_fish) */
    double reach;                  /* fish couple whose outlines are no further apart, m */
    int couples_most;              /* no memory for more */
    unsigned char *coupled; /* whether the Jacobian holds the block of fish g in the rows of fish f (n_fish, n_fish) */

    /* natural curvature of the joints of all fish and its derivative with respect to phi0, as last evaluated */
    struct range *joints;      /* of each fish                                   (n_fish) */
    double *natural_curvature; /* dimensionless, doc/model.md section 4          (joints of all fish) */
    double *curvature_by_phi0;
    struct jacobian_scratch *jacobian_scratch; /* scratch of each thread                          (threads) */
    double *scratch;                           /* for those who read the results                   (n_unknowns) */
};

/* Scratch of the derivatives through the flow, large enough for any pair of fish. */
struct jacobian_scratch {
    struct influence_block block;
    struct coupling_block rows;
};

/* What an unknown is: for tolerances, names in messages, and which equations are algebraic. */
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
    const char *name; /* "x", "sheet", ... */
};

/* The state is read at every evaluation; it must outlive the residual. Fails with STATUS_MEMORY; residual_free accepts
 * NULL. */
enum status residual_create(struct residual **residual, const struct school *school, const struct state *state);
void residual_free(struct residual *residual);

/* Decide which fish couple in the Jacobian, from the positions in y. Fails with STATUS_MEMORY; then they are those that
 * were. */
enum status residual_couple(struct residual *residual, const double *y);

/* Couple fish that are further apart than so far, from the positions in y and from now on: twice as far, and again,
 * until there are more. Returns whether there are; not beyond 400 MB of blocks, or without memory. */
int residual_couple_more(struct residual *residual, const double *y);

/* value = F(t, y, yp). Returns STATUS_RETRY where a value is not finite, or bodies touch that repel each other. */
enum status residual_evaluate(struct residual *residual, double t, const double *y, const double *yp, double *value);

/* jacobian = dF/dy + cj dF/dyp, with the blocks of the coupled fish; fish in contact couple from now on. Fails with
 * STATUS_MEMORY, and as residual_evaluate where bodies touch. */
enum status residual_jacobian(struct residual *residual, double t, double cj, const double *y,
                              struct jacobian *jacobian);

/* The derivatives of impermeability at the control points of every fish by the circulation that it has shed itself, in
 * the rows of those equations of value (n_unknowns), and with force: pressure those of the law of motion; the others
 * stay as they are. With the flow of the last evaluation, at the unknowns y. They are what changes most from step to
 * step where the nascent stretch of a free sheet grows. */
void residual_by_shed(struct residual *residual, const double *y, double *value);

/* Parts of an evaluation, for who solves the equations one after another: the contacts, which can fail as
 * residual_evaluate does; and the natural curvature of fish f for the phi0
 * in y. */
enum status residual_contact(struct residual *residual, double t, const double *y);
void residual_muscle(struct residual *residual, int f, double t, const double *y);

/* The rows ax, ay of fish f in N, before given motions replace them: m a less all forces. With the fluid's velocity and
 * the natural curvature and the contacts of the last evaluation. */
void residual_balance(const struct residual *residual, int f, const double *y, double *value);

/* The same rows with the whole force of the fluid: what else acts on the nodes, the reactions of prescribed ones. For
 * the rates yp. */
void residual_reaction(const struct residual *residual, int f, const double *y, const double *yp, double *value);

/* What Kutta's condition in its rate form gives for fish f, m2 s-2. With the fluid's velocity of the last
 * evaluation. */
double residual_kutta_rate(const struct residual *residual, int f, double t, const double *y);

/* The rate of the circulation shed by fish f where that is a differential unknown: as above, or 0 between impulses. */
double residual_shed_rate(const struct residual *residual, int f, double t, const double *y);

/* Circulation that no longer counts in Kelvin's equation of fish f, m2 s-1. */
double residual_lost(const struct residual *residual, int f, double t);

/* Mask the rows of the Jacobian whose equation is a given motion, and no others. */
void residual_mask(const struct residual *residual, struct jacobian *jacobian);

/* kind[i] = 1 where unknown i is differential, 0 where it is algebraic                           (n_unknowns) */
void residual_kinds(const struct residual *residual, double *kind);

/* The scale of unknown i, in its unit: what the error tolerance is relative to. */
double residual_scale(const struct residual *residual, int i);

/* The factor on the scale of unknown i for methods that do not damp the vibrations of a stiff body: velocities then
 * have the scale 0.1 L f, about that of the positions times 2 pi f, instead of one that never binds; 1 for other
 * unknowns. */
double residual_undamped(const struct residual *residual, int i);

/* Where unknown i belongs. */
struct unknown_place residual_place(const struct school *school, int i);

/* Whether the circulation shed by a fish is algebraic now. */
int residual_shed_is_algebraic(const struct residual *residual);

#endif
