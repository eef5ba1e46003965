/* ode_rhs.c: sheets, flow, control, accelerations, each by a linear solve or a formula. */
#include "solver/ode_rhs.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

#include "body/rod.h"
#include "fish/fish_motion.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"
#include "force/bound_sheet.h"

struct ode_rhs {
    struct residual *residual;
    double *no_sheets; /* the unknowns with sheets and nascent vortices of no strength    (n_unknowns) */
    struct influence_block *influence; /* of the vortices of fish g on the points of fish f     (n_fish, n_fish) */

    /* the dense system of all sheets, column after column: strengths and, with momenta, velocities of each fish */
    int n;
    int *first;                /* row and column of the first unknown of each fish                      (n_fish) */
    double *matrix, *solution; /* solution: initially the right-hand side                          (n, n), (n) */
    lapack_int *pivot;         /*                                                                           (n) */

    /* lower band of the mass matrix of one fish with added mass, column after column; right-hand side, or a momentum */
    double *band, *force;
};

enum { BANDWIDTH = 4 }; /* of the mass matrix with x and y of a node in neighbouring rows: diagonal and three below */

// with the Kutta condition at the edge the shed circulation is an unknown
static int n_strengths(const struct residual *residual, const struct fish *fish) {
    return fish->n_sheet + (residual_shed_is_algebraic(residual) ? 1 : 0);
}

// with momenta the velocities are unknowns of the system of the sheets
static int n_velocities(const struct fish *fish) {
    return fish_has_momentum(fish) ? 2 * fish->n_nodes : 0;
}

// row and column of component i of the velocity of node k
static int velocity_at(const struct ode_rhs *d, int f, int i, int k) {
    const struct fish *fish = &d->residual->school->fish[f];
    return d->first[f] + n_strengths(d->residual, fish) + i * fish->n_nodes + k;
}

struct ode_rhs *ode_rhs_create(struct arena *arena, struct residual *residual) {
    const struct school *const school = residual->school;
    const size_t n_fish = (size_t)school->n_fish;
    int max_nodes = 0;
    struct ode_rhs *d;
    NEW(arena, d, 1);
    d->residual = residual;
    NEW(arena, d->first, n_fish);
    NEW(arena, d->influence, n_fish * n_fish);
    NEW(arena, d->no_sheets, school->n_unknowns);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        d->first[f] = d->n;
        d->n += n_strengths(residual, fish) + n_velocities(fish);
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

// the velocity of the fluid without sheets and nascent vortices, and the influence of sheets and nascent vortices
static enum status update_flow(struct ode_rhs *d, double t, const double *y) {
    const struct school *school = d->residual->school;
    const struct state *state = d->residual->state;
    memcpy(d->no_sheets, y, (size_t)school->n_unknowns * sizeof *y);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        memset(d->no_sheets + fish->at.gamma, 0, (size_t)fish->n_sheet * sizeof *y);
        d->no_sheets[fish->at.circulation] = state->wake[f].shed_before;
        memset(d->no_sheets + fish->at.vx, 0, (size_t)n_velocities(fish) * sizeof *y);
    }
    TRY(flow_velocity(d->residual->flow, state, t, d->no_sheets));
    for (int f = 0; f < school->n_fish; f++) {
        for (int g = 0; g < school->n_fish; g++) {
            flow_influence(d->residual->flow, f, g, &d->influence[f * school->n_fish + g]);
        }
    }
    return STATUS_OK;
}

// the influence of vortex j on point p, along a direction
static double along(const struct influence_block *block, int j, int p, const double direction[2]) {
    const long at = (long)j * block->n_points + p;
    return direction[0] * block->u[at] + direction[1] * block->v[at];
}

static double *entry(const struct ode_rhs *d, int row, int column) {
    return &d->matrix[(long)column * d->n + row];
}

// the own rows of fish f, and the right-hand side: minus the residual with all unknown strengths zero
static void assemble_own(struct ode_rhs *d, int f, double t, const double *y, double *rhs) {
    const struct residual *residual = d->residual;
    const struct fish *fish = &residual->school->fish[f];
    const int edge = residual_shed_is_algebraic(residual);
    const int first = residual->flow->points[f].first, row = d->first[f], last = fish->n_sheet - 1;
    const double shed = edge ? residual->state->wake[f].shed_before : y[fish->at.circulation];
    double *const value = residual->scratch;
    bound_sheet_residual(fish, residual_lost(residual, f, t), residual->flow->u + first, residual->flow->v + first,
                         d->no_sheets, value);
    for (int c = 0; c < fish->n_control; c++) {
        rhs[row + c] = -value[fish->at.gamma + c];
        for (int j = last - 1; j <= last; j++) *entry(d, row + c, row + j) += bound_sheet_end_correction(fish, c, j);
    }
    const int kelvin = row + fish->n_control;
    rhs[kelvin] = residual_lost(residual, f, t) - shed;
    for (int j = 0; j < fish->n_sheet; j++) *entry(d, kelvin, row + j) = fish->sheet_weight[j];
    if (edge) {
        *entry(d, kelvin, row + fish->n_sheet) = 1;
        *entry(d, row + fish->n_sheet, row + last) = fish->sheet_weight[last];
        rhs[row + fish->n_sheet] = 0;
    }
}

// impermeability at the own velocities, and the equations of the velocities: m v + I = m p, or the prescribed motion
static void assemble_velocities(struct ode_rhs *d, int f, const double *y, double *rhs) {
    const struct fish *fish = &d->residual->school->fish[f];
    for (int c = 0; c < fish->n_control; c++) {
        double normal[2];
        bound_sheet_normal(fish, c, y, normal);
        const struct stencil *const point = &fish->control_point[c];
        for (int m = 0; m < 2 * point->n; m++) {
            const int i = m / point->n, at = m % point->n;
            *entry(d, d->first[f] + c, velocity_at(d, f, i, point->node[at])) -= point->weight[at] * normal[i];
        }
    }
    for (int m = 0; m < 2 * fish->n_nodes; m++) {
        const int i = m / fish->n_nodes, k = m % fish->n_nodes, row = velocity_at(d, f, i, k);
        const int is_given = fish_is_prescribed(fish, k, i);
        *entry(d, row, row) = 1;
        rhs[row] = y[(is_given ? fish->at.vx : fish->at.px) + m];
    }
    for (int j = 0; j < fish->n_sheet; j++) {
        pressure_momentum_by_strength(fish, j, y + fish->at.x, d->force);
        for (int m = 0; m < 2 * fish->n_nodes; m++) {
            const int i = m / fish->n_nodes, k = m % fish->n_nodes;
            if (fish_is_prescribed(fish, k, i)) continue;
            *entry(d, velocity_at(d, f, i, k), d->first[f] + j) = d->force[m] / fish->mass[k];
        }
    }
}

// the vortices of fish g in the equations for the control points of fish f
static void assemble_influence(struct ode_rhs *d, int f, int g, const double *y, double *rhs) {
    const struct residual *residual = d->residual;
    const struct fish *fish = &residual->school->fish[f], *other = &residual->school->fish[g];
    const struct influence_block *block = &d->influence[f * residual->school->n_fish + g];
    const int edge = residual_shed_is_algebraic(residual);
    const double known = edge ? 0 : y[other->at.circulation] - residual->state->wake[g].shed_before;
    for (int c = 0; c < fish->n_control; c++) {
        double normal[2];
        bound_sheet_normal(fish, c, y, normal);
        for (int j = 0; j < n_strengths(residual, other); j++) {
            *entry(d, d->first[f] + c, d->first[g] + j) += along(block, j, c, normal);
        }
        rhs[d->first[f] + c] -= known * along(block, other->n_sheet, c, normal);
    }
}

// rows of a fish: control points, Kelvin's theorem, optional edge condition; columns: bound vortices and, with the edge
// condition, the nascent vortex
static enum status solve_sheets(struct ode_rhs *d, double t, double *y) {
    const struct residual *residual = d->residual;
    const struct school *school = residual->school;
    memset(d->matrix, 0, (size_t)d->n * (size_t)d->n * sizeof *d->matrix);
    for (int f = 0; f < school->n_fish; f++) {
        assemble_own(d, f, t, y, d->solution);
        if (fish_has_momentum(&school->fish[f])) assemble_velocities(d, f, y, d->solution);
        for (int g = 0; g < school->n_fish; g++) assemble_influence(d, f, g, y, d->solution);
    }
    if (LAPACKE_dgesv(LAPACK_COL_MAJOR, d->n, 1, d->matrix, d->n, d->pivot, d->solution, d->n) != 0) {
        return status_fail(STATUS_RETRY, "the system of the bound sheets has no finite solution at t = %g s", t);
    }
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        memcpy(y + fish->at.gamma, d->solution + d->first[f], (size_t)fish->n_sheet * sizeof *y);
        if (residual_shed_is_algebraic(residual)) {
            y[fish->at.circulation] = residual->state->wake[f].shed_before + d->solution[d->first[f] + fish->n_sheet];
        }
        memcpy(y + fish->at.vx, d->solution + velocity_at(d, f, 0, 0), (size_t)n_velocities(fish) * sizeof *y);
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

// an entry of the mass matrix, row not above column; rows 2 k and 2 k + 1 are x and y of node k
static double *mass_entry(double *band, int row, int column) {
    return &band[BANDWIDTH * column + row - column];
}

static void assemble_mass(const struct fish *fish, const double *y, double *band) {
    memset(band, 0, 2 * (size_t)fish->n_nodes * BANDWIDTH * sizeof *band);
    for (int k = 0; k < fish->n_nodes; k++) {
        for (int i = 2 * k; i < 2 * k + 2; i++) *mass_entry(band, i, i) = fish->mass[k];
    }
    for (int k = 0; k < fish->n_edges; k++) {
        const double e[2] = {y[fish->at.x + k + 1] - y[fish->at.x + k], y[fish->at.y + k + 1] - y[fish->at.y + k]};
        const double length = sqrt(e[0] * e[0] + e[1] * e[1]), n[2] = {-e[1] / length, e[0] / length};
        for (int row = 0; row < 4; row++) {
            for (int column = 0; column <= row; column++) {
                *mass_entry(band, 2 * k + row, 2 * k + column) += fish->added_mass[k] * n[row % 2] * n[column % 2] / 4;
            }
        }
    }
}

// replace rows and columns of prescribed accelerations by rows and columns of the identity
static void fix_given(const struct fish *fish, double t, double *band, double *force) {
    const int n = 2 * fish->n_nodes;
    for (int given = 0; given < 2 * fish_n_prescribed(fish); given++) {
        if (!fish_is_prescribed(fish, given / 2, given % 2)) continue;
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, given / 2, t, position, velocity, acceleration);
        for (int other = given - BANDWIDTH + 1; other < given + BANDWIDTH; other++) {
            if (other < 0 || other >= n) continue;
            double *const entry = other > given ? mass_entry(band, other, given) : mass_entry(band, given, other);
            if (!fish_is_prescribed(fish, other / 2, other % 2)) force[other] -= *entry * acceleration[given % 2];
            *entry = 0;
        }
        *mass_entry(band, given, given) = 1;
        force[given] = acceleration[given % 2];
    }
}

static enum status find_accelerations(struct ode_rhs *d, int f, double t, double *y) {
    const struct fish *fish = &d->residual->school->fish[f];
    double *const value = d->residual->scratch;
    // without acceleration the balance is minus the forces
    memset(y + fish->at.ax, 0, 2 * (size_t)fish->n_nodes * sizeof *y);
    residual_balance(d->residual, f, y, value);
    for (int k = 0; k < fish->n_nodes; k++) {
        d->force[2 * k] = -value[fish->at.ax + k];
        d->force[2 * k + 1] = -value[fish->at.ay + k];
    }
    assemble_mass(fish, y, d->band);
    fix_given(fish, t, d->band, d->force);
    const lapack_int n = 2 * fish->n_nodes;
    if (LAPACKE_dpbsv(LAPACK_COL_MAJOR, 'L', n, BANDWIDTH - 1, 1, d->band, BANDWIDTH, d->force, n) != 0) {
        return status_fail(STATUS_RETRY, "the accelerations of fish %s have no finite solution at t = %g s", fish->name,
                           t);
    }
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.ax + k] = d->force[2 * k];
        y[fish->at.ay + k] = d->force[2 * k + 1];
    }
    return STATUS_OK;
}

// the momenta of nodes whose velocity is given, after find_accelerations, which updates the pressure
static void find_given_momenta(const struct ode_rhs *d, int f, double *y) {
    const struct fish *fish = &d->residual->school->fish[f];
    const struct pressure *const pressure = d->residual->pressure[f];
    for (int m = 0; m < 2 * fish->n_nodes && pressure; m++) {
        const int k = m % fish->n_nodes;
        if (fish_is_prescribed(fish, k, m / fish->n_nodes)) {
            y[fish->at.px + m] = y[fish->at.vx + m] + pressure->momentum[m] / fish->mass[k];
        }
    }
}

static void find_phi0(struct ode_rhs *d, int f, double t, double *y) {
    const struct state *state = d->residual->state;
    const struct fish *fish = &d->residual->school->fish[f];
    double *const value = d->residual->scratch;
    // the control law is phi0 minus a value independent of phi0
    y[fish->at.phi0] = 0;
    control_residual(fish, &state->control[f], t, t - state->t, y, value);
    y[fish->at.phi0] = -value[fish->at.phi0];
}

enum status ode_rhs_rates(struct ode_rhs *d, double t, double *y, double *yp) {
    const struct school *school = d->residual->school;
    for (int f = 0; f < school->n_fish; f++) fish_prescribe(&school->fish[f], 0, t, y);
    for (int i = 0; i < school->n_unknowns; i++) {
        if (!isfinite(y[i])) return status_fail(STATUS_RETRY, "unknown %d is not finite at t = %g s", i, t);
    }
    for (int f = 0; f < school->n_fish; f++) {
        if (!rod_is_torn(&school->fish[f], y)) continue;
        return status_fail(STATUS_RETRY, "fish %s is torn at t = %g s", school->fish[f].name, t);
    }
    TRY(residual_contact(d->residual, t, y));
    TRY(update_flow(d, t, y));
    TRY(solve_sheets(d, t, y));

    // the velocity of rings has a divergence, which the influence omits
    const int has_legs = d->residual->flow->kernel->has_legs;
    if (has_legs) TRY(flow_velocity(d->residual->flow, d->residual->state, t, y));
    if (!has_legs) add_sheets(d, y);

    memset(yp, 0, (size_t)school->n_unknowns * sizeof *yp);
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *at = &school->fish[f].at;
        const size_t size = 2 * (size_t)school->fish[f].n_nodes * sizeof *y;
        find_phi0(d, f, t, y);
        residual_muscle(d->residual, f, t, y);
        TRY(find_accelerations(d, f, t, y));
        find_given_momenta(d, f, y);
        memcpy(yp + at->x, y + at->vx, size);
        memcpy(yp + (fish_has_momentum(&school->fish[f]) ? at->px : at->vx), y + at->ax, size);
        yp[at->circulation] = residual_shed_is_algebraic(d->residual) ? 0 : residual_shed_rate(d->residual, f, t, y);
        if (!isfinite(y[at->ax]) || !isfinite(y[at->ay])) {
            return status_fail(STATUS_RETRY, "the nose of fish %s has no finite acceleration at t = %g s",
                               school->fish[f].name, t);
        }
    }
    return STATUS_OK;
}
