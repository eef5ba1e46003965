/* residual.c: the equations in the order of doc/model.md, section 10, and their derivatives in the same order. */
#include "model/residual.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/ramp.h"
#include "model/actuation.h"
#include "model/bound_sheet.h"
#include "model/clamp.h"
#include "model/clearance.h"
#include "model/fish_distance.h"
#include "model/fish_prescribed.h"
#include "model/flow_at_bodies.h"
#include "model/fluid_force.h"
#include "model/rod.h"

static enum status allocate(struct residual *residual) {
    const struct school *school = residual->school;
    const size_t n_fish = (size_t)school->n_fish;
    int n_joints = 0, most_points = 0, most_columns = 0, most_rows = 0;
    residual->joints = calloc(n_fish, sizeof *residual->joints);
    residual->coupled = calloc(n_fish * n_fish, sizeof *residual->coupled);
    residual->pressure = calloc(n_fish, sizeof *residual->pressure);
    if (!residual->joints || !residual->coupled || !residual->pressure) goto no_memory;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        if (fish_has_momentum(fish)) TRY(pressure_create(&residual->pressure[f], fish));
        const int points = flow_n_points(fish), columns = flow_n_columns(fish);
        residual->joints[f] = (struct range){n_joints, fish->n_joints};
        n_joints += fish->n_joints;
        if (points > most_points) most_points = points;
        if (columns > most_columns) most_columns = columns;
        if (flow_n_rows(fish) > most_rows) most_rows = flow_n_rows(fish);
    }
    const size_t n_columns = (size_t)most_columns, n_block = (size_t)most_points * n_columns;
    residual->jacobian_scratch = calloc((size_t)school->threads, sizeof *residual->jacobian_scratch);
    for (int i = 0; residual->jacobian_scratch && i < school->threads; i++) {
        struct jacobian_scratch *const jacobian_scratch = &residual->jacobian_scratch[i];
        jacobian_scratch->block.u = calloc(n_block, sizeof(double));
        jacobian_scratch->block.v = calloc(n_block, sizeof(double));
        jacobian_scratch->rows.value = calloc((size_t)most_rows * n_columns, sizeof(double));
        if (!jacobian_scratch->block.u || !jacobian_scratch->block.v || !jacobian_scratch->rows.value) goto no_memory;
    }
    residual->scratch = calloc((size_t)school->n_unknowns, sizeof(double));
    residual->natural_curvature = calloc((size_t)n_joints, sizeof(double));
    residual->curvature_by_phi0 = calloc((size_t)n_joints, sizeof(double));
    if (!residual->natural_curvature || !residual->curvature_by_phi0 || !residual->scratch ||
        !residual->jacobian_scratch) {
        goto no_memory;
    }
    TRY(neighbours_create(&residual->neighbours, school->n_fish));
    TRY(contact_create(&residual->contact, school));
    return flow_create(&residual->flow, school);

no_memory:
    return status_fail(STATUS_MEMORY, "out of memory: the equations of %d fish", school->n_fish);
}

enum status residual_create(struct residual **residual, const struct school *school, const struct state *state) {
    *residual = NULL;
    struct residual *const new = calloc(1, sizeof *new);
    if (!new) return status_fail(STATUS_MEMORY, "out of memory: the equations");
    new->school = school;
    new->state = state;
    new->reach = school->coupling_distance;
    enum status status = allocate(new);
    if (status == STATUS_OK) status = residual_couple(new, state->y);
    if (status != STATUS_OK) {
        residual_free(new);
        return status;
    }
    *residual = new;
    return STATUS_OK;
}

void residual_free(struct residual *residual) {
    if (!residual) return;
    flow_free(residual->flow);
    for (int f = 0; residual->pressure && f < residual->school->n_fish; f++) pressure_free(residual->pressure[f]);
    free(residual->pressure);
    contact_free(residual->contact);
    neighbours_free(residual->neighbours);
    free(residual->joints);
    free(residual->coupled);
    free(residual->natural_curvature);
    free(residual->curvature_by_phi0);
    free(residual->scratch);
    for (int i = 0; residual->jacobian_scratch && i < residual->school->threads; i++) {
        free(residual->jacobian_scratch[i].block.u);
        free(residual->jacobian_scratch[i].block.v);
        free(residual->jacobian_scratch[i].rows.value);
    }
    free(residual->jacobian_scratch);
    free(residual);
}

// couple what is within a distance of each other, in place of what was coupled; returns whether that is a change
static int couple_neighbours(struct residual *residual, const double *y, double distance) {
    const struct school *school = residual->school;
    const struct neighbours *const neighbours = residual->neighbours;
    int changed = 0;
    for (int f = 0; f < school->n_fish; f++) {
        unsigned char *const before = residual->coupled + (size_t)f * (size_t)school->n_fish;
        int i = neighbours->first[f];
        for (int g = 0; g < school->n_fish; g++) {
            const int overlaps = i < neighbours->first[f + 1] && neighbours->other[i] == g;
            i += overlaps;
            // the distance is the same in either direction, to the bit
            const int a = f > g ? f : g, b = f > g ? g : f;
            const int couple =
                f == g || (overlaps && fish_distance(&school->fish[a], &school->fish[b], y, distance) <= distance);
            changed |= before[g] != couple;
            before[g] = (unsigned char)couple;
        }
    }
    return changed;
}

enum status residual_couple(struct residual *residual, const double *y) {
    const struct school *school = residual->school;
    for (int f = 0; f < school->n_fish; f++) {
        residual->neighbours->box[f] = clearance_box(&school->fish[f], residual->reach, y, y);
    }
    TRY(neighbours_find(residual->neighbours));
    residual->pattern += (unsigned)couple_neighbours(residual, y, residual->reach);
    return STATUS_OK;
}

// the distance beyond which no two bodies are apart
static double extent(const struct school *school, const double *y) {
    struct box all = clearance_box(&school->fish[0], 0, y, y);
    for (int f = 1; f < school->n_fish; f++) {
        const struct box box = clearance_box(&school->fish[f], 0, y, y);
        for (int i = 0; i < 2; i++) {
            all.low[i] = fmin(all.low[i], box.low[i]);
            all.high[i] = fmax(all.high[i], box.high[i]);
        }
    }
    return hypot(all.high[0] - all.low[0], all.high[1] - all.low[1]);
}

// the numbers in the blocks of all pairs that couple
static double n_block_values(const struct residual *residual) {
    const struct school *school = residual->school;
    double n = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const unsigned char *const coupled = residual->coupled + (size_t)f * (size_t)school->n_fish;
        for (int g = 0; g < school->n_fish; g++) {
            if (g != f && coupled[g]) n += (double)flow_n_rows(&school->fish[f]) * flow_n_columns(&school->fish[g]);
        }
    }
    return n;
}

int residual_couple_more(struct residual *residual, const double *y) {
    const double max_values = 5e7, before = residual->reach, all = extent(residual->school, y);
    const unsigned pattern = residual->pattern;
    while (!residual->couples_most && residual->pattern == pattern && residual->reach < all) {
        residual->reach = fmax(2 * residual->reach, 0.5 * residual->school->fish[0].length);
        if (residual_couple(residual, y) == STATUS_OK && n_block_values(residual) <= max_values) continue;
        residual->reach = before;
        residual->couples_most = 1;
        if (residual_couple(residual, y) == STATUS_OK) return 0;
    }
    return residual->pattern != pattern;
}

static enum bound_sheet_law law_of(const struct residual *residual) {
    const struct school *school = residual->school;
    if (residual->shed_now == SHED_IS_GIVEN) return BOUND_SHEET_FROZEN;
    if (school->shedding == SHEDDING_IMPULSIVE &&
        !(residual->shed_now == SHED_BY_IMPULSE && school->kutta == KUTTA_EDGE)) {
        return BOUND_SHEET_FROZEN;
    }
    return school->kutta == KUTTA_EDGE ? BOUND_SHEET_EDGE : BOUND_SHEET_RATE;
}

int residual_shed_is_algebraic(const struct residual *residual) {
    return law_of(residual) == BOUND_SHEET_EDGE;
}

double residual_kutta_rate(const struct residual *residual, int f, double t, const double *y) {
    const int first = residual->flow->points[f].first;
    return bound_sheet_shedding_rate(&residual->school->fish[f], ramp_value(t, residual->school->kutta_ramp),
                                     residual->flow->u + first, residual->flow->v + first, y);
}

double residual_shed_rate(const struct residual *residual, int f, double t, const double *y) {
    return law_of(residual) == BOUND_SHEET_RATE ? residual_kutta_rate(residual, f, t, y) : 0;
}

double residual_lost(const struct residual *residual, int f, double t) {
    const struct school *school = residual->school;
    const struct state *state = residual->state;
    return school->removed == REMOVED_DROPPED ? wake_lost(&state->wake[f], school, state->t, t - state->t) : 0;
}

enum status residual_contact(struct residual *residual, double t, const double *y) {
    return contact_find(residual->contact, residual->state, t, y);
}

void residual_muscle(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const int first = residual->joints[f].first;
    const struct fish_gait gait = control_gait(fish, &residual->state->control[f], t);
    actuation_curvature(fish, gait, y[fish->at.phi0], residual->natural_curvature + first,
                        residual->curvature_by_phi0 + first);
}

// the rows of a node whose motion is given: its place, velocity and acceleration are the given ones
static void drive(const struct fish *fish, double t, const double *y, double *value) {
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, k, t, position, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            if (!fish_is_prescribed(fish, k, i)) continue;
            const int node = i * fish->n_nodes + k;
            value[fish->at.x + node] = y[fish->at.x + node] - position[i];
            value[fish->at.vx + node] = y[fish->at.vx + node] - velocity[i];
            value[fish->at.ax + node] = y[fish->at.ax + node] - acceleration[i];
        }
    }
}

// rows ax, ay: m a less all forces, N
static void balance(const struct residual *residual, int f, const double *y, double *value) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] = fish->mass[k] * y[fish->at.ax + k];
        value[fish->at.ay + k] = fish->mass[k] * y[fish->at.ay + k];
    }
    rod_residual(fish, residual->natural_curvature + residual->joints[f].first, y, value);
    clamp_residual(fish, residual->flow->t, y, value);
    contact_residual(residual->contact, f, y, value);
    fluid_force_residual(fish, &flow, y, value);
    if (residual->pressure[f]) {
        pressure_update(residual->pressure[f], &flow, y);
        pressure_residual(residual->pressure[f], value);
    }
    value[fish->at.ax + fish->n_nodes - 1] -= fish->load_tip[0];
    value[fish->at.ay + fish->n_nodes - 1] -= fish->load_tip[1];
}

// dx/dt = v and dv/dt = a; with momenta dp/dt = a
static void kinematics(const struct fish *fish, const double *y, const double *yp, double *value) {
    const int second = fish_has_momentum(fish) ? fish->at.px : fish->at.vx;
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        value[fish->at.x + i] = yp[fish->at.x + i] - y[fish->at.vx + i];
        // nothing is asked of velocities that are given
        value[fish->at.vx + i] = 0;
        value[second + i] = yp[second + i] - y[fish->at.ax + i];
    }
}

static void evaluate_fish(struct residual *residual, int f, double t, const double *y, const double *yp,
                          double *value) {
    const struct school *school = residual->school;
    const struct state *state = residual->state;
    const struct fish *fish = &school->fish[f];
    const double *const u = residual->flow->u + residual->flow->points[f].first;
    const double *const v = residual->flow->v + residual->flow->points[f].first;

    kinematics(fish, y, yp, value);
    // the law of motion, per mass
    residual_muscle(residual, f, t, y);
    balance(residual, f, y, value);
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] /= fish->mass[k];
        value[fish->at.ay + k] /= fish->mass[k];
    }
    if (residual->pressure[f]) pressure_momentum_residual(residual->pressure[f], residual->at_start, y, value);
    drive(fish, t, y, value);
    // impermeability, Kelvin, Kutta
    bound_sheet_residual(fish, residual_lost(residual, f, t), u, v, y, value);
    bound_sheet_kutta_residual(fish, law_of(residual), ramp_value(t, school->kutta_ramp), u, v, y, yp, value);
    // the control law
    control_residual(fish, &state->control[f], t, t - state->t, y, value);
}

enum status residual_evaluate(struct residual *residual, double t, const double *y, const double *yp, double *value) {
    TRY(residual_contact(residual, t, y));
    TRY(flow_velocity(residual->flow, residual->state, t, y));
    const struct school *school = residual->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) evaluate_fish(residual, f, t, y, yp, value);
    for (int i = 0; i < residual->school->n_unknowns; i++) {
        if (!isfinite(value[i])) {
            const struct unknown_place place = residual_place(residual->school, i);
            return status_fail(STATUS_RETRY, "the equation for %s[%d] of fish %s has no finite value at t = %g s",
                               place.name, place.index, residual->school->fish[place.fish].name, t);
        }
    }
    return STATUS_OK;
}

void residual_balance(const struct residual *residual, int f, const double *y, double *value) {
    balance(residual, f, y, value);
}

void residual_reaction(const struct residual *residual, int f, const double *y, const double *yp, double *value) {
    const struct fish *fish = &residual->school->fish[f];
    struct pressure *const pressure = residual->pressure[f];
    balance(residual, f, y, value);
    if (!pressure) return;
    pressure_update_rate(pressure, y, yp);
    for (int i = 0; i < 2 * fish->n_nodes; i++) value[fish->at.ax + i] += pressure->momentum_rate[i];
}

// the equations of fish f by what moves with fish g and comes through the velocity of the fluid
static void flow_jacobian(const struct residual *residual, int f, int g, double t, const double *y,
                          struct influence_block *block, struct coupling_block *rows) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    rows->n_rows = flow_n_rows(fish);
    rows->n_columns = flow_n_columns(&residual->school->fish[g]);
    memset(rows->value, 0, (size_t)rows->n_rows * (size_t)rows->n_columns * sizeof *rows->value);
    flow_derivative(residual->flow, f, g, block);
    fluid_force_flow_jacobian(fish, &flow, block, y, rows);
    if (residual->pressure[f]) pressure_flow_jacobian(residual->pressure[f], block, rows);
    if (residual->pressure[f] && f == g) pressure_own_jacobian(residual->pressure[f], y, rows);
    bound_sheet_flow_jacobian(fish, block, y, rows);
    if (law_of(residual) == BOUND_SHEET_RATE) {
        bound_sheet_kutta_flow_jacobian(fish, ramp_value(t, residual->school->kutta_ramp), block, y, rows);
    }
}

// add the rows of a fish by its own unknowns to its block: those entries that may differ from zero. The midpoint of an
// edge feels the nodes of that edge and, through the nascent vortex, the tail and the circulation shed; the pressure
// everything, and so does an edge that has walls beside it, through the images of the body.
static void add_own(const struct residual *residual, const struct fish *fish, const struct coupling_block *rows,
                    struct sparse *own) {
    const int n_nodes = fish->n_nodes, n_places = 2 * n_nodes;
    const int rate = law_of(residual) == BOUND_SHEET_RATE;
    for (int c = 0; c < rows->n_columns; c++) {
        const double *const value = rows->value + (long)c * rows->n_rows;
        const int column = flow_column(fish, c), node = c % n_nodes;
        const int feels_all = fish_has_momentum(fish) || residual->school->walls.n > 0;
        const int is_shed = c == rows->n_columns - 1, is_sheet = c >= n_places && !is_shed && !feels_all;
        const int all = is_shed || node == n_nodes - 1 || feels_all;
        const int first = all || node == 0 ? 0 : node - 1, last = all || node == n_nodes - 2 ? n_nodes - 1 : node + 1;
        for (int k = first; !is_sheet && k <= last; k++) {
            sparse_add(own, fish->at.ax + k, column, value[k]);
            sparse_add(own, fish->at.ay + k, column, value[n_nodes + k]);
        }
        for (int k = 0; k < fish->n_control; k++) sparse_add(own, fish->at.gamma + k, column, value[n_places + k]);
        if (rate) sparse_add(own, fish->at.circulation, column, value[fish->at.circulation - fish->at.ax]);
    }
}

// with momenta the rows of given ones are those of pressure_momentum_row
static void kinematics_jacobian(const struct residual *residual, const struct fish *fish, double cj,
                                struct sparse *own) {
    const int has_momentum = fish_has_momentum(fish), n = fish->n_nodes;
    const int second = has_momentum ? fish->at.px : fish->at.vx;
    for (int i = 0; i < 2 * n; i++) {
        sparse_add(own, fish->at.x + i, fish->at.x + i, cj);
        sparse_add(own, fish->at.x + i, fish->at.vx + i, -1);
        if (!has_momentum || pressure_momentum_row(fish, residual->at_start, i / n, i % n) != second + i) {
            sparse_add(own, second + i, second + i, cj);
            sparse_add(own, second + i, fish->at.ax + i, -1);
        }
        sparse_add(own, fish->at.ax + i, fish->at.ax + i, 1);
    }
}

// the derivatives of one fish's equations, in the order of evaluate_fish
static enum status fish_jacobian(struct residual *residual, int f, double t, double cj, const double *y,
                                 struct jacobian_scratch *jacobian_scratch, struct jacobian *jacobian) {
    const struct school *school = residual->school;
    const struct fish *fish = &school->fish[f];
    struct sparse *const own = jacobian->own[f];
    const double *const u = residual->flow->u + residual->flow->points[f].first;
    const double *const v = residual->flow->v + residual->flow->points[f].first;
    const int joints = residual->joints[f].first;

    sparse_begin(own);
    kinematics_jacobian(residual, fish, cj, own);
    residual_muscle(residual, f, t, y);
    rod_jacobian(fish, residual->natural_curvature + joints, residual->curvature_by_phi0 + joints, y, own);
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    clamp_jacobian(fish, t, y, own);
    fluid_force_jacobian(fish, &flow, y, own);
    if (residual->pressure[f]) {
        pressure_update(residual->pressure[f], &flow, y);
        pressure_momentum_jacobian(residual->pressure[f], residual->at_start, y, own);
        pressure_jacobian(residual->pressure[f], own);
    }
    bound_sheet_jacobian(fish, u, v, y, own);
    bound_sheet_kutta_jacobian(fish, law_of(residual), ramp_value(t, school->kutta_ramp), cj, u, v, y, own);
    control_jacobian(fish, &residual->state->control[f], t, t - residual->state->t, y, own);

    // what comes through the velocity of the fluid: by the fish's own unknowns, and by those of the fish it couples to
    flow_jacobian(residual, f, f, t, y, &jacobian_scratch->block, &jacobian_scratch->rows);
    contact_jacobian(residual->contact, f, f, y, &jacobian_scratch->rows);
    add_own(residual, fish, &jacobian_scratch->rows, own);
    for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
        struct jacobian_coupling *const coupling = &jacobian->coupling[i];
        flow_jacobian(residual, f, coupling->other, t, y, &jacobian_scratch->block, &coupling->rows);
        contact_jacobian(residual->contact, f, coupling->other, y, &coupling->rows);
    }
    jacobian_mask_couplings(jacobian, f);
    return sparse_end(own);
}

// fish in contact couple, however far the coupling reaches; returns whether there are any
static int couple_contacts(struct residual *residual) {
    const int n_fish = residual->school->n_fish;
    int n_contacts = 0;
    for (int f = 0; f < n_fish; f++) {
        const int *other;
        const int n = contact_partners(residual->contact, f, &other);
        for (int i = 0; i < n; i++) {
            unsigned char *const coupled = &residual->coupled[f * n_fish + other[i]];
            if (!*coupled) residual->pattern++;
            *coupled = 1;
        }
        n_contacts += n;
    }
    return n_contacts > 0;
}

enum status residual_jacobian(struct residual *residual, double t, double cj, const double *y,
                              struct jacobian *jacobian) {
    const struct school *school = residual->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_MATRICES);
    TRY(residual_contact(residual, t, y));
    jacobian->has_contacts = couple_contacts(residual);
    TRY(flow_gradient(residual->flow, residual->state, t, y));
    if (jacobian->pattern != residual->pattern) {
        TRY(jacobian_couple(jacobian, residual->coupled, residual->pattern));
    }
    int n_failed = 0;
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        struct jacobian_scratch *const jacobian_scratch = &residual->jacobian_scratch[omp_get_thread_num()];
        if (fish_jacobian(residual, f, t, cj, y, jacobian_scratch, jacobian) != STATUS_OK) {
#pragma omp atomic
            n_failed++;
        }
    }
    // the thread that failed had the message
    return n_failed == 0 ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: the Jacobian of %d fish", n_failed);
}

void residual_by_shed(struct residual *residual, const double *y, double *value) {
    const struct school *school = residual->school;
    const int threads = parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        struct jacobian_scratch *const scratch = &residual->jacobian_scratch[omp_get_thread_num()];
        flow_nascent_influence(residual->flow, f, &scratch->block);
        scratch->rows.n_rows = flow_n_rows(fish);
        scratch->rows.n_columns = 1;
        memset(scratch->rows.value, 0, (size_t)scratch->rows.n_rows * sizeof *scratch->rows.value);
        bound_sheet_flow_jacobian(fish, &scratch->block, y, &scratch->rows);
        const int first = fish_has_momentum(fish) ? fish->at.ax : fish->at.gamma;
        if (residual->pressure[f]) {
            const struct flow_at_body flow = flow_at_body(residual->flow, f);
            fluid_force_flow_jacobian(fish, &flow, &scratch->block, y, &scratch->rows);
            pressure_flow_jacobian(residual->pressure[f], &scratch->block, &scratch->rows);
        }
        memcpy(value + first, scratch->rows.value + (first - fish->at.ax),
               (size_t)(fish->at.gamma + fish->n_control - first) * sizeof *value);
    }
}

// of the unknowns of a node, which alternate
static int component_of(enum unknown kind) {
    return kind == UNKNOWN_Y || kind == UNKNOWN_VY || kind == UNKNOWN_PY || kind == UNKNOWN_AY;
}

void residual_mask(const struct residual *residual, struct jacobian *jacobian) {
    for (int f = 0; f < residual->school->n_fish; f++) {
        const struct fish *fish = &residual->school->fish[f];
        for (int row = fish->at.x; row < fish->at.end; row++) {
            const struct unknown_place place = residual_place(residual->school, row);
            const int moves = place.kind <= UNKNOWN_AY && place.kind != UNKNOWN_PX && place.kind != UNKNOWN_PY;
            sparse_mask(jacobian->own[f], row,
                        moves && fish_is_prescribed(fish, place.index, component_of(place.kind)));
        }
    }
}

struct unknown_place residual_place(const struct school *school, int i) {
    int f = 0;
    while (i >= school->fish[f].at.end) f++;
    const struct layout *at = &school->fish[f].at;
    const struct {
        int first;
        enum unknown kind;
        const char *name;
    } slices[] = {{at->phi0, UNKNOWN_PHI0, "phi0"},
                  {at->circulation, UNKNOWN_CIRCULATION, "circulation"},
                  {at->gamma, UNKNOWN_GAMMA, "gamma"},
                  {at->ay, UNKNOWN_AY, "ay"},
                  {at->ax, UNKNOWN_AX, "ax"},
                  {at->py, UNKNOWN_PY, "py"},
                  {at->px, UNKNOWN_PX, "px"},
                  {at->vy, UNKNOWN_VY, "vy"},
                  {at->vx, UNKNOWN_VX, "vx"},
                  {at->y, UNKNOWN_Y, "y"},
                  {at->x, UNKNOWN_X, "x"}};
    int s = 0;
    while (i < slices[s].first) s++;
    return (struct unknown_place){
        .fish = f, .index = i - slices[s].first, .kind = slices[s].kind, .name = slices[s].name};
}

// of a node that moves by its forces: places and velocities, or momenta in their place
static int is_differential(const struct residual *residual, const struct unknown_place *place) {
    const int has_momentum = fish_has_momentum(&residual->school->fish[place->fish]);
    switch (place->kind) {
        case UNKNOWN_X:
        case UNKNOWN_Y: return 1;
        case UNKNOWN_VX:
        case UNKNOWN_VY: return !has_momentum || residual->at_start;
        case UNKNOWN_PX:
        case UNKNOWN_PY: return !residual->at_start;
        default: return 0;
    }
}

void residual_kinds(const struct residual *residual, double *kind) {
    for (int i = 0; i < residual->school->n_unknowns; i++) {
        const struct unknown_place place = residual_place(residual->school, i);
        const struct fish *fish = &residual->school->fish[place.fish];
        const int is_given = fish_is_prescribed(fish, place.index, component_of(place.kind));
        kind[i] = 0;
        if (!is_given && is_differential(residual, &place)) kind[i] = 1;
        if (place.kind == UNKNOWN_CIRCULATION && !residual_shed_is_algebraic(residual)) kind[i] = 1;
    }
}

double residual_scale(const struct residual *residual, int i) {
    const struct unknown_place place = residual_place(residual->school, i);
    const struct fish *fish = &residual->school->fish[place.fish];
    const double f = fish_rate(residual->school, fish);
    const double length = fish->length;
    switch (place.kind) {
        case UNKNOWN_X:
        case UNKNOWN_Y: return 0.01 * length;
        case UNKNOWN_VX:
        case UNKNOWN_VY: return 300 * length * f;
        case UNKNOWN_PX:
        case UNKNOWN_PY: return 300 * length * f * pressure_momentum_ratio(fish, place.index);
        case UNKNOWN_AX:
        case UNKNOWN_AY: return 1e5 * length * f * f;
        case UNKNOWN_GAMMA: return 3 * length * f;
        case UNKNOWN_CIRCULATION: return length * length * f;
        case UNKNOWN_PHI0: return 1;
    }
    return 1;
}

double residual_undamped(const struct residual *residual, int i) {
    const enum unknown kind = residual_place(residual->school, i).kind;
    return kind >= UNKNOWN_VX && kind <= UNKNOWN_PY ? 1.0 / 3000 : 1;
}
