/* ode_rhs.c: sheets, flow, control and accelerations in this order, each by a linear solution or a formula. */
#include "solver/ode_rhs.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "body/rod.h"
#include "fish/fish_motion.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"
#include "force/bound_sheet.h"

/* The rows and columns of one fish in the dense system: strengths (including the shed circulation if the Kutta
 * condition at the edge makes it an unknown), then, with momenta, the velocities of the nodes, x and y. */
struct ode_slices {
    int strengths, velocities, end;
};

struct ode_rhs {
    struct residual *residual;
    double *no_sheets; /* the unknowns with sheets and nascent vortices set to no strength    (n_unknowns) */
    struct influence_block *influence; /* of the vortices of fish g on the points of fish f     (n_fish, n_fish) */

    /* the dense system of all sheets, column after column: for each fish strengths and, with momenta, velocities */
    int n;
    struct ode_slices *at; /*                                                                       (n_fish) */
    double *matrix,
        *solution;     /* solution: before the solution the right-hand side                              (n, n), (n) */
    lapack_int *pivot; /*                                                                           (n) */

    /* lower band of the mass matrix of one fish with its added mass, column after column; right-hand side, or a
     * momentum */
    double *band, *force;
};

enum {
    BANDWIDTH = 4
}; /* of the mass matrix if x and y of a node are neighbouring rows: the diagonal and three below */

struct ode_rhs *ode_rhs_create(struct arena *arena, struct residual *residual) {
    const struct school *const school = residual->school;
    const size_t n_fish = (size_t)school->n_fish;
    int max_nodes = 0;
    struct ode_rhs *d;
    NEW(arena, d, 1);
    d->residual = residual;
    NEW(arena, d->at, n_fish);
    NEW(arena, d->influence, n_fish * n_fish);
    NEW(arena, d->no_sheets, school->n_unknowns);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct ode_slices *const at = &d->at[f];
        at->strengths = d->n;
        at->velocities = at->strengths + fish->n_sheet + (residual_shed_is_algebraic(residual) ? 1 : 0);
        at->end = d->n = at->velocities + fish->at.second - fish->at.vx;
        if (fish->n_nodes > max_nodes) max_nodes = fish->n_nodes;
        for (int g = 0; g < school->n_fish; g++) {
            struct influence_block *const block = &d->influence[f * school->n_fish + g];
            const size_t size = (size_t)residual->flow->points[f].n * (size_t)(school->fish[g].n_sheet + 1);
            NEW(arena, block->u, size);
            NEW(arena, block->v, size);
        }
    }
    NEW(arena, d->matrix, (size_t)d->n * (size_t)d->n);
    NEW(arena, d->pivot, d->n);
    NEW(arena, d->solution, d->n);
    NEW(arena, d->band, 2 * max_nodes * BANDWIDTH);
    NEW(arena, d->force, 2 * max_nodes);
    return d;
}

static double *entry(const struct ode_rhs *d, int row, int column) {
    return &d->matrix[(long)column * d->n + row];
}

// fill the rows of fish f and the right-hand side, which is minus the residual with all unknown strengths zero
static void assemble_fish(struct ode_rhs *d, int f, double t, const double *y, double *rhs) {
    const struct residual *residual = d->residual;
    const struct school *const school = residual->school;
    const struct fish *fish = &school->fish[f];
    const bool edge = residual_shed_is_algebraic(residual);
    const struct ode_slices at = d->at[f];
    const bool has_velocities = at.end > at.velocities;
    const int first = residual->flow->points[f].first, row = at.strengths, last = fish->n_sheet - 1;

    // Kelvin's theorem, and the condition at the edge
    const int kelvin = row + fish->n_control, kutta = row + fish->n_sheet;
    rhs[kelvin] =
        residual_lost(residual, f, t) - (edge ? residual->state->wake[f].shed_before : y[fish->at.circulation]);
    for (int j = 0; j < fish->n_sheet; j++) *entry(d, kelvin, row + j) = fish->sheet_weight[j];
    if (edge) {
        *entry(d, kelvin, kutta) = 1;
        *entry(d, kutta, row + last) = fish->sheet_weight[last];
        rhs[kutta] = 0;
    }

    // impermeability: the end corrections of the own sheet, own velocities, and the vortices of all fish
    double *const value = residual->scratch;
    bound_sheet_residual(fish, residual_lost(residual, f, t), residual->flow->u + first, residual->flow->v + first,
                         d->no_sheets, value);
    for (int c = 0; c < fish->n_control; c++) {
        const struct direction body = fish_direction(fish, &fish->control_tangent[c], y);
        const double *const normal = body.n;
        rhs[row + c] = -value[fish->at.gamma + c];
        for (int j = last - 1; j <= last; j++) *entry(d, row + c, row + j) += bound_sheet_end_correction(fish, c, j);

        const struct stencil *const point = &fish->control_point[c];
        for (int m = 0; m < 2 * point->n && has_velocities; m++) {
            const int i = m / point->n, k = m % point->n, column = at.velocities + i * fish->n_nodes + point->node[k];
            *entry(d, row + c, column) -= point->weight[k] * normal[i];
        }

        for (int g = 0; g < school->n_fish; g++) {
            const struct fish *const other = &school->fish[g];
            const struct influence_block *const block = &d->influence[f * school->n_fish + g];
            const double known = edge ? 0 : y[other->at.circulation] - residual->state->wake[g].shed_before;
            for (int j = 0; j <= other->n_sheet; j++) {
                const long at_point = (long)j * block->n_points + c;
                const double along = normal[0] * block->u[at_point] + normal[1] * block->v[at_point];
                const int column = d->at[g].strengths + j;
                if (column < d->at[g].velocities) *entry(d, row + c, column) += along;
                if (j == other->n_sheet) rhs[row + c] -= known * along;
            }
        }
    }

    // the equations of the velocities: m v + I = m p, or the prescribed velocity
    for (int m = 0; m < at.end - at.velocities; m++) {
        const int i = m / fish->n_nodes, k = m % fish->n_nodes;
        *entry(d, at.velocities + m, at.velocities + m) = 1;
        rhs[at.velocities + m] = y[(fish_is_prescribed(fish, k, i) ? fish->at.vx : fish->at.px) + m];
    }
    for (int j = 0; j < fish->n_sheet && has_velocities; j++) {
        residual->force[f].model->momentum_by_strength(fish, j, y + fish->at.x, d->force);
        for (int m = 0; m < 2 * fish->n_nodes; m++) {
            const int i = m / fish->n_nodes, k = m % fish->n_nodes;
            if (fish_is_prescribed(fish, k, i)) continue;
            *entry(d, at.velocities + m, row + j) = d->force[m] / fish->mass[k];
        }
    }
}

// solve for the strengths of bound vortices and, with the edge condition, of nascent ones; with momenta also for
// velocities
static enum status solve_sheets(struct ode_rhs *d, double t, double *y) {
    const struct residual *residual = d->residual;
    const struct school *school = residual->school;
    const struct state *state = residual->state;

    // the velocity of the fluid without sheets and nascent vortices, and what each of these adds per strength
    memcpy(d->no_sheets, y, (size_t)school->n_unknowns * sizeof *y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        memset(d->no_sheets + fish->at.gamma, 0, (size_t)fish->n_sheet * sizeof *y);
        d->no_sheets[fish->at.circulation] = state->wake[f].shed_before;
        memset(d->no_sheets + fish->at.vx, 0, (size_t)(d->at[f].end - d->at[f].velocities) * sizeof *y);
    }
    flow_velocity(residual->flow, state, t, d->no_sheets, false);
    for (int i = 0; i < school->n_fish * school->n_fish; i++) {
        const int f = i / school->n_fish, g = i % school->n_fish;
        flow_derivative(residual->flow, f, g, COLUMNS_OF_STRENGTHS, &d->influence[i]);
    }

    memset(d->matrix, 0, (size_t)d->n * (size_t)d->n * sizeof *d->matrix);
    for (int f = 0; f < school->n_fish; f++) assemble_fish(d, f, t, y, d->solution);
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, d->n, 1, d->matrix, d->n, d->pivot, d->solution, d->n) != 0) {
        return status_fail(STATUS_RETRY, "the system of the bound sheets has no finite solution at t = %g s", t);
    }
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        const struct ode_slices at = d->at[f];
        memcpy(y + fish->at.gamma, d->solution + at.strengths, (size_t)fish->n_sheet * sizeof *y);
        if (residual_shed_is_algebraic(residual)) {
            y[fish->at.circulation] = state->wake[f].shed_before + d->solution[at.strengths + fish->n_sheet];
        }
        memcpy(y + fish->at.vx, d->solution + at.velocities, (size_t)(at.end - at.velocities) * sizeof *y);
    }
    return STATUS_OK;
}

// add the velocity of the sheets and nascent vortices at the points
static void add_sheets(struct ode_rhs *d, const double *y) {
    const struct school *school = d->residual->school;
    struct flow *const flow = d->residual->flow;
    for (int f = 0; f < school->n_fish; f++) {
        for (int g = 0; g < school->n_fish; g++) {
            const struct fish *other = &school->fish[g];
            const struct influence_block *block = &d->influence[f * school->n_fish + g];
            const double nascent = y[other->at.circulation] - d->residual->state->wake[g].shed_before;
            for (int p = 0; p < block->n_points; p++) {
                const long last = (long)other->n_sheet * block->n_points + p;
                double u = nascent * block->u[last], v = nascent * block->v[last];
                for (int j = 0; j < other->n_sheet; j++) {
                    const long at = (long)j * block->n_points + p;
                    u += block->u[at] * y[other->at.gamma + j];
                    v += block->v[at] * y[other->at.gamma + j];
                }
                flow->u[flow->points[f].first + p] += u;
                flow->v[flow->points[f].first + p] += v;
            }
        }
    }
}

// an entry of the mass matrix, whose row is not above its column; rows 2 k and 2 k + 1 are x and y of node k
static double *mass_entry(double *band, int row, int column) {
    return &band[BANDWIDTH * column + row - column];
}

// find the accelerations, and the momenta of nodes whose velocity is given
static enum status find_accelerations(struct ode_rhs *d, int f, double t, double *y) {
    const struct fish *fish = &d->residual->school->fish[f];
    const lapack_int n = 2 * fish->n_nodes;
    double *const value = d->residual->scratch, *const band = d->band, *const force = d->force;

    // without acceleration the balance is minus the forces
    memset(y + fish->at.ax, 0, (size_t)n * sizeof *y);
    residual_balance(d->residual, f, y, value);
    for (int i = 0; i < n; i++) force[i] = -value[(i % 2 == 0 ? fish->at.ax : fish->at.ay) + i / 2];

    // the mass of the nodes, and the added mass of each edge across its direction
    memset(band, 0, (size_t)n * BANDWIDTH * sizeof *band);
    for (int i = 0; i < n; i++) *mass_entry(band, i, i) = fish->mass[i / 2];
    for (int k = 0; k < fish->n_edges; k++) {
        const double e[2] = {y[fish->at.x + k + 1] - y[fish->at.x + k], y[fish->at.y + k + 1] - y[fish->at.y + k]};
        const double length = sqrt(e[0] * e[0] + e[1] * e[1]), normal[2] = {-e[1] / length, e[0] / length};
        for (int row = 0; row < 4; row++) {
            for (int column = 0; column <= row; column++) {
                *mass_entry(band, 2 * k + row, 2 * k + column) +=
                    fish->added_mass[k] * normal[row % 2] * normal[column % 2] / 4;
            }
        }
    }

    // where an acceleration is prescribed, its row and column become those of the identity
    double heave[3];
    control_heave(fish, &d->residual->state->control[f], t, heave);
    for (int given = 0; given < 2 * fish_n_prescribed(fish); given++) {
        if (!fish_is_prescribed(fish, given / 2, given % 2)) continue;
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, heave, given / 2, t, position, velocity, acceleration);
        for (int other = given - BANDWIDTH + 1; other < given + BANDWIDTH; other++) {
            if (other < 0 || other >= n) continue;
            double *const of_pair = other > given ? mass_entry(band, other, given) : mass_entry(band, given, other);
            if (!fish_is_prescribed(fish, other / 2, other % 2)) force[other] -= *of_pair * acceleration[given % 2];
            *of_pair = 0;
        }
        *mass_entry(band, given, given) = 1;
        force[given] = acceleration[given % 2];
    }
    if (LAPACKE_dpbsv(LAPACK_COL_MAJOR, 'L', n, BANDWIDTH - 1, 1, band, BANDWIDTH, force, n) != 0) {
        return status_fail(STATUS_RETRY, "the accelerations of fish %s have no finite solution at t = %g s", fish->name,
                           t);
    }
    for (int i = 0; i < n; i++) y[(i % 2 == 0 ? fish->at.ax : fish->at.ay) + i / 2] = force[i];

    // the momenta of prescribed nodes; residual_balance has updated the momenta of the fluid
    const double *const momentum = d->residual->force[f].momentum;
    for (int m = 0; m < fish->at.ax - fish->at.px; m++) {
        const int k = m % fish->n_nodes;
        if (!fish_is_prescribed(fish, k, m / fish->n_nodes)) continue;
        y[fish->at.px + m] = y[fish->at.vx + m] + momentum[m] / fish->mass[k];
    }
    return STATUS_OK;
}

enum status ode_rhs_rates(struct ode_rhs *d, double t, double *y, double *yp) {
    const struct school *school = d->residual->school;
    const struct state *const state = d->residual->state;
    for (int f = 0; f < school->n_fish; f++) {
        double heave[3];
        control_heave(&school->fish[f], &state->control[f], t, heave);
        fish_prescribe(&school->fish[f], heave, 0, t, y);
    }
    for (int i = 0; i < school->n_unknowns; i++) {
        if (!isfinite(y[i])) return status_fail(STATUS_RETRY, "unknown %d is not finite at t = %g s", i, t);
    }
    for (int f = 0; f < school->n_fish; f++) {
        if (!rod_is_torn(&school->fish[f], y)) continue;
        return status_fail(STATUS_RETRY, "fish %s is torn at t = %g s", school->fish[f].name, t);
    }
    TRY(contact_find(d->residual->contact, state, t, y));
    TRY(solve_sheets(d, t, y));

    // the velocity of rings has a divergence, which the influence leaves out
    const bool has_legs = d->residual->flow->kernel->has_legs;
    if (has_legs) flow_velocity(d->residual->flow, state, t, y, false);
    if (!has_legs) add_sheets(d, y);

    memset(yp, 0, (size_t)school->n_unknowns * sizeof *yp);
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *at = &school->fish[f].at;
        const struct fish *const fish = &school->fish[f];
        const size_t size = 2 * (size_t)fish->n_nodes * sizeof *y;

        // the control law is phi0 minus a value that does not depend on phi0
        y[at->phi0] = 0;
        control_residual(fish, &state->control[f], t, t - state->t, y, d->residual->scratch);
        y[at->phi0] = -d->residual->scratch[at->phi0];

        residual_actuate(d->residual, f, t, y);
        TRY(find_accelerations(d, f, t, y));
        memcpy(yp + at->x, y + at->vx, size);
        memcpy(yp + at->second, y + at->ax, size);
        yp[at->circulation] =
            residual_shed_is_algebraic(d->residual) ? 0 : residual_shed_rate(d->residual, &residual_run, f, y);
        if (!isfinite(y[at->ax]) || !isfinite(y[at->ay])) {
            return status_fail(STATUS_RETRY, "the nose of fish %s has no finite acceleration at t = %g s", fish->name,
                               t);
        }
    }
    return STATUS_OK;
}
