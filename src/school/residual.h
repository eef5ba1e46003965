/* residual.h: the equations of the whole school as one residual F(t, y, y') = 0; its derivatives: residual_jacobian.h.
 * doc/model.md, section 10. Tested by tests/school/test_residual.c. */
#ifndef RESIDUAL_H
#define RESIDUAL_H

#include "base/status.h"
#include "body/actuation.h"
#include "contact/contact.h"
#include "flow/flow.h"
#include "flow/flow_derivative.h"
#include "force/bound_sheet.h"
#include "force/pressure.h"
#include "school/residual_couplings.h"
#include "school/residual_unknowns.h"
#include "state/state.h"

/* What determines the circulation that has been shed: the law of the case; Kutta's condition, while an impulsive event
 * is solved; nothing, it is given: before the first marker of a free sheet is born; Kutta's condition, while all of it
 * is infinitely far away (wake_leave_behind): in an equilibrium. */
enum shed_now { SHED_BY_LAW, SHED_BY_IMPULSE, SHED_IS_GIVEN, SHED_IS_FAR };

/* What the equations need besides the unknowns; workspace that holds nothing a restart would miss. */
struct residual {
    const struct school *school;
    const struct state *state; /* wakes, control memory, time of the last event */
    struct flow *flow;
    struct contact *contact;
    enum shed_now shed_now;              /* what determines the circulation shed */
    int at_start;                        /* whether the velocities are given, and momenta follow from them */
    struct pressure **pressure;          /* of each fish; NULL where its force is another one   (n_fish) */
    struct neighbours *neighbours;       /* workspace                                         (n_fish) */
    struct residual_couplings couplings; /* which blocks of other fish the Jacobian has */

    struct range *joints;    /* of each fish                                     (n_fish) */
    struct actuation muscle; /* what they are asked for, as last evaluated       (joints of all fish) */
    struct jacobian_scratch *jacobian_scratch; /* scratch of each thread                          (threads) */
    double *scratch; /* for those who read the results; of fish f: its own slices    (n_unknowns) */
};

/* Scratch of the derivatives through the flow, large enough for any pair of fish. */
struct jacobian_scratch {
    struct influence_block block;
    struct coupling_block rows;
};

/* The state is read at every evaluation; it must outlive the residual. Fails with STATUS_MEMORY; residual_free accepts
 * NULL. */
enum status residual_create(struct residual **residual, const struct school *school, const struct state *state);
void residual_free(struct residual *residual);

/* value = F(t, y, yp). Returns STATUS_RETRY where a value is not finite, or bodies touch that repel each other. */
enum status residual_evaluate(struct residual *residual, double t, const double *y, const double *yp, double *value);

/* Parts of an evaluation, for who solves the equations one after another: the contacts, which can fail as
 * residual_evaluate does; and what the muscle of fish f asks of its joints for the phi0 in y, which is returned. */
enum status residual_contact(struct residual *residual, double t, const double *y);
struct actuation residual_muscle(struct residual *residual, int f, double t, const double *y);

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

/* kind[i] = 1 where unknown i is differential, 0 where it is algebraic                           (n_unknowns) */
void residual_kinds(const struct residual *residual, double *kind);

/* What determines the circulation shed by a fish now, and whether it is algebraic. */
enum bound_sheet_law residual_sheet_law(const struct residual *residual);
int residual_shed_is_algebraic(const struct residual *residual);

#endif
