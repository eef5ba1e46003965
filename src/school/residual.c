/* residual.c: evaluates the equations, in the order of doc/model.md, section 10. Their derivatives are in
 * residual_jacobian.c. */
#include "school/residual.h"

#include <math.h>

#include "base/mathematics.h"
#include "base/parallel.h"
#include "body/rod.h"
#include "contact/clearance.h"
#include "fish/fish.h"
#include "fish/fish_motion.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_derivative.h"
#include "force/pressure.h"
#include "state/impulse.h"

// ---- unknowns by slices of the layout

struct unknown_place residual_place(const struct school *school, int i) {
    // by bisection, the first fish with at.end above i
    int f = 0, last = school->n_fish - 1;
    while (f < last) {
        const int middle = (f + last) / 2;
        if (i >= school->fish[middle].at.end) {
            f = middle + 1;
        } else {
            last = middle;
        }
    }

    // the slice that contains i, searched from the last one to the first
    const struct layout *at = &school->fish[f].at;
    const struct {
        int first;
        enum unknown kind;
        int component;
        const char *name;
    } slices[] = {{at->phi0, UNKNOWN_PHI0, 0, "phi0"},
                  {at->circulation, UNKNOWN_CIRCULATION, 0, "circulation"},
                  {at->gamma, UNKNOWN_GAMMA, 0, "gamma"},
                  {at->ay, UNKNOWN_AY, 1, "ay"},
                  {at->ax, UNKNOWN_AX, 0, "ax"},
                  {at->py, UNKNOWN_PY, 1, "py"},
                  {at->px, UNKNOWN_PX, 0, "px"},
                  {at->vy, UNKNOWN_VY, 1, "vy"},
                  {at->vx, UNKNOWN_VX, 0, "vx"},
                  {at->y, UNKNOWN_Y, 1, "y"},
                  {at->x, UNKNOWN_X, 0, "x"}};

    int s = 0;
    while (i < slices[s].first) s++;
    return (struct unknown_place){.fish = f,
                                  .index = i - slices[s].first,
                                  .kind = slices[s].kind,
                                  .component = slices[s].component,
                                  .name = slices[s].name};
}

double residual_scale(const struct school *school, int i) {
    const struct unknown_place place = residual_place(school, i);
    const struct fish *fish = &school->fish[place.fish];
    const double f = fish_rate(school, fish);
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

double residual_undamped(const struct school *school, int i) {
    const enum unknown kind = residual_place(school, i).kind;
    return kind >= UNKNOWN_VX && kind <= UNKNOWN_PY ? 1.0 / 3000 : 1;
}

const struct residual_mode residual_run = {.shed = SHED_BY_LAW};

// ---- neighbours, first by boxes and then by the distance of outlines

void residual_couple(struct residual_couplings *couplings, const double *y) {
    const struct school *school = couplings->school;
    for (int f = 0; f < school->n_fish; f++) {
        couplings->neighbours->box[f] = clearance_box(&school->fish[f], couplings->reach, y, y);
    }

    neighbours_find(couplings->neighbours);

    // of the fish whose boxes overlap, couple exactly those within the reach
    const struct neighbours *const neighbours = couplings->neighbours;
    bool has_changed = false;
    for (int f = 0; f < school->n_fish; f++) {
        unsigned char *const before = couplings->coupled + (size_t)f * (size_t)school->n_fish;
        int i = neighbours->first[f];
        for (int g = 0; g < school->n_fish; g++) {
            const bool overlaps = i < neighbours->first[f + 1] && neighbours->other[i] == g;
            i += overlaps;

            // always in the same order, so that (f, g) and (g, f) have the same bits
            const struct fish *const a = &school->fish[f > g ? f : g], *const b = &school->fish[f > g ? g : f];
            const bool couple = f == g || (overlaps && fish_distance(a, b, y, couplings->reach) <= couplings->reach);
            has_changed |= before[g] != couple;
            before[g] = couple;
        }
    }
    couplings->pattern += has_changed;
}

int residual_couple_more(struct residual_couplings *couplings, const double *y) {
    const struct school *const school = couplings->school;
    const double max_values = 5e7, before = couplings->reach;
    const unsigned pattern = couplings->pattern;

    // no two bodies are farther apart than this
    struct box all = clearance_box(&school->fish[0], 0, y, y);
    for (int f = 1; f < school->n_fish; f++) all = box_union(all, clearance_box(&school->fish[f], 0, y, y));
    const double extent = hypot(all.high[0] - all.low[0], all.high[1] - all.low[1]);

    while (!couplings->couples_most && couplings->pattern == pattern && couplings->reach < extent) {
        couplings->reach = fmax(2 * couplings->reach, 0.5 * school->fish[0].length);
        residual_couple(couplings, y);

        // how many values the blocks of all coupled pairs have
        double n = 0;
        for (int f = 0; f < school->n_fish; f++) {
            const unsigned char *const coupled = couplings->coupled + (size_t)f * (size_t)school->n_fish;
            for (int g = 0; g < school->n_fish; g++) {
                if (g != f && coupled[g]) n += (double)flow_n_rows(&school->fish[f]) * flow_n_columns(&school->fish[g]);
            }
        }
        if (n <= max_values) continue;

        // too many: return to the reach before
        couplings->reach = before;
        couplings->couples_most = 1;
        residual_couple(couplings, y);
        return 0;
    }
    return couplings->pattern != pattern;
}

struct residual *residual_create(struct arena *arena, const struct school *school, const struct state *state) {
    struct residual *created;
    NEW(arena, created, 1);
    created->school = school;
    created->state = state;
    NEW(arena, created->joints, school->n_fish);
    NEW(arena, created->force, school->n_fish);
    NEW(arena, created->scratch, school->n_unknowns);

    int n_joints = 0, most_points = 0, most_columns = 0, most_rows = 0;
    bool has_edges = false;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        force_model_create(arena, fish, &created->force[f]);
        created->joints[f] = (struct range){n_joints, fish->n_joints};
        n_joints += fish->n_joints;
        const int points = flow_n_points(fish), columns = flow_n_columns(fish), rows = flow_n_rows(fish);
        if (points > most_points) most_points = points;
        if (columns > most_columns) most_columns = columns;
        if (rows > most_rows) most_rows = rows;
        has_edges |= fish->depth_varies;
    }

    NEW(arena, created->muscle.curvature, n_joints);
    NEW(arena, created->muscle.rate, n_joints);
    NEW(arena, created->muscle.curvature_by_phi0, n_joints);
    NEW(arena, created->muscle.rate_by_phi0, n_joints);

    created->flow = flow_create(arena, school);

    // each thread has a block that fits any pair of fish
    NEW(arena, created->jacobian_scratch, school->threads);
    for (int i = 0; i < school->threads; i++) {
        struct jacobian_scratch *const scratch = &created->jacobian_scratch[i];
        NEW(arena, scratch->block.u, most_points * most_columns);
        NEW(arena, scratch->block.v, most_points * most_columns);
        if (created->flow->kernel->has_legs) NEW(arena, scratch->block.div, most_points * most_columns);
        if (created->flow->kernel->has_legs && has_edges)
            NEW(arena, scratch->block.edge, 2 * most_points * most_columns);
        NEW(arena, scratch->rows.value, most_rows * most_columns);
        NEW(arena, scratch->by_phi0_rate, most_rows);
    }

    // the partners of each fish, by contact and by couplings in the Jacobian
    created->neighbours = neighbours_create(arena, school->n_fish);
    created->couplings = (struct residual_couplings){
        .school = school, .neighbours = created->neighbours, .reach = school->coupling_distance};
    NEW(arena, created->couplings.coupled, (size_t)school->n_fish * (size_t)school->n_fish);
    created->contact = contact_create(arena, school);
    residual_couple(&created->couplings, state->y);
    return created;
}

static enum bound_sheet_law sheet_law(const struct school *school, const struct residual_mode *mode) {
    if (mode->shed == SHED_IS_GIVEN) return BOUND_SHEET_FROZEN;
    if (mode->shed == SHED_IS_FAR) return BOUND_SHEET_EDGE;
    if (school->shedding == SHEDDING_IMPULSIVE && !(mode->shed == SHED_BY_IMPULSE && school->kutta == KUTTA_EDGE)) {
        return BOUND_SHEET_FROZEN;
    }
    return school->kutta == KUTTA_EDGE ? BOUND_SHEET_EDGE : BOUND_SHEET_RATE;
}

enum bound_sheet_law residual_sheet_law(const struct residual *residual, const struct residual_mode *mode) {
    return sheet_law(residual->school, mode);
}

bool residual_shed_is_algebraic(const struct residual *residual) {
    return residual_sheet_law(residual, &residual_run) == BOUND_SHEET_EDGE;
}

double residual_kutta_rate(const struct residual *residual, int f, const double *y) {
    const int first = residual->flow->points[f].first;
    return bound_sheet_shedding_rate(&residual->school->fish[f], residual->flow->u + first, residual->flow->v + first,
                                     y);
}

double residual_shed_rate(const struct residual *residual, const struct residual_mode *mode, int f, const double *y) {
    return residual_sheet_law(residual, mode) == BOUND_SHEET_RATE ? residual_kutta_rate(residual, f, y) : 0;
}

double residual_lost(const struct residual *residual, int f, double t) {
    const struct school *school = residual->school;
    const struct state *state = residual->state;
    return school->removed == REMOVED_DROPPED
               ? impulse_lost_circulation(&state->wake[f], school, state->t, t - state->t)
               : 0;
}

struct actuation residual_muscle(const struct residual *residual, int f) {
    return actuation_from(&residual->muscle, residual->joints[f].first);
}

struct actuation residual_actuate(struct residual *residual, int f, double t, const double *y) {
    const struct fish *fish = &residual->school->fish[f];
    const struct state *const state = residual->state;
    const struct actuation muscle = residual_muscle(residual, f);
    const double phi0_rate = control_rate(fish, &state->control[f], t, t - state->t, y);
    actuation_find(fish, control_gait(fish, &state->control[f], t, t - state->t), y[fish->at.phi0], phi0_rate, &muscle);
    return muscle;
}

// bring the force of the fluid on fish f up to date; yp: NULL without the rates
static void update_force(const struct residual *residual, int f, const double *y, const double *yp) {
    const struct fluid_force *const force = &residual->force[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    if (force->model->update) force->model->update(force, &flow, y, yp);
}

// residual_forces, if the force of the fluid is up to date
static void forces_on_nodes(const struct residual *residual, int f, const double *y, double *value) {
    const struct fish *fish = &residual->school->fish[f];
    const struct fluid_force *const force = &residual->force[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    contact_residual(residual->contact, f, y, value);
    force->model->residual(force, &flow, y, value);
    value[fish->at.ax + fish->n_nodes - 1] -= fish->load_tip[0];
    value[fish->at.ay + fish->n_nodes - 1] -= fish->load_tip[1];
}

void residual_forces(const struct residual *residual, int f, const double *y, double *value) {
    update_force(residual, f, y, NULL);
    forces_on_nodes(residual, f, y, value);
}

// the rows ax, ay without the forces of residual_forces
static void residual_of_body(const struct residual *residual, const struct actuation *muscle, int f, const double *y,
                             double *value) {
    const struct fish *fish = &residual->school->fish[f];
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] = fish->mass[k] * y[fish->at.ax + k];
        value[fish->at.ay + k] = fish->mass[k] * y[fish->at.ay + k];
    }
    rod_residual(fish, muscle, y, value);
    rod_clamp_residual(fish, residual->flow->t, y, value);
}

void residual_balance(const struct residual *residual, int f, const double *y, double *value) {
    const struct actuation muscle = residual_muscle(residual, f);
    residual_of_body(residual, &muscle, f, y, value);
    residual_forces(residual, f, y, value);
}

static void evaluate_fish(struct residual *residual, const struct residual_mode *mode, int f, double t, const double *y,
                          const double *yp, double *value) {
    const struct school *school = residual->school;
    const struct state *state = residual->state;
    const struct fish *fish = &school->fish[f];
    const double *const u = residual->flow->u + residual->flow->points[f].first;
    const double *const v = residual->flow->v + residual->flow->points[f].first;

    // dx/dt = v, and the rows of velocity and momentum
    const struct fluid_force *const force = &residual->force[f];
    for (int i = 0; i < 2 * fish->n_nodes; i++) {
        if (fish_is_prescribed(fish, i % fish->n_nodes, i / fish->n_nodes)) continue;
        value[fish->at.x + i] = yp[fish->at.x + i] - y[fish->at.vx + i];
    }
    update_force(residual, f, y, NULL);
    force->model->motion_residual(force, mode->velocities_are_given, y, yp, value);

    // equation of motion, divided by the node masses
    const struct actuation muscle = residual_actuate(residual, f, t, y);
    residual_of_body(residual, &muscle, f, y, value);
    if (mode->forces) {
        for (int i = fish->at.ax; i < fish->at.ax + 2 * fish->n_nodes; i++) value[i] -= mode->forces[i];
    } else {
        forces_on_nodes(residual, f, y, value);
    }
    for (int k = 0; k < fish->n_nodes; k++) {
        value[fish->at.ax + k] /= fish->mass[k];
        value[fish->at.ay + k] /= fish->mass[k];
    }

    // where nodes are prescribed, position, velocity and acceleration are given, and the law of motion yields the
    // reaction
    double heave[3];
    control_heave(fish, &state->control[f], t, heave);
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, heave, k, t, position, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            if (!fish_is_prescribed(fish, k, i)) continue;
            const int node = i * fish->n_nodes + k;
            value[fish->at.x + node] = y[fish->at.x + node] - position[i];
            value[fish->at.vx + node] = y[fish->at.vx + node] - velocity[i];
            value[fish->at.ax + node] = y[fish->at.ax + node] - acceleration[i];
        }
    }

    // impermeability, Kelvin, Kutta
    bound_sheet_residual(fish, residual_lost(residual, f, t), u, v, y, value);
    bound_sheet_kutta_residual(fish, residual_sheet_law(residual, mode), u, v, y, yp, value);

    control_residual(fish, &state->control[f], t, t - state->t, y, value);
}

enum status residual_evaluate(struct residual *residual, const struct residual_mode *mode, double t, const double *y,
                              const double *yp, double *value) {
    TRY(contact_find(residual->contact, residual->state, t, y));
    flow_velocity(residual->flow, residual->state, t, y, mode->shed == SHED_IS_FAR);

    const struct school *school = residual->school;
    const int threads = fish_threads(school);
    if (threads == 1) {
        for (int f = 0; f < school->n_fish; f++) evaluate_fish(residual, mode, f, t, y, yp, value);
    } else {
#pragma omp parallel for num_threads(threads) schedule(static)
        for (int f = 0; f < school->n_fish; f++) evaluate_fish(residual, mode, f, t, y, yp, value);
    }

    // if there is one, name the first equation without a finite value
    int i = 0;
    while (i < school->n_unknowns && isfinite(value[i])) i++;
    if (i == school->n_unknowns) return STATUS_OK;
    const struct unknown_place place = residual_place(school, i);
    return status_fail(STATUS_RETRY, "the equation for %s[%d] of fish %s has no finite value at t = %g s", place.name,
                       place.index, school->fish[place.fish].name, t);
}

void residual_reaction(const struct residual *residual, int f, const double *y, const double *yp, double *value) {
    const struct fluid_force *const force = &residual->force[f];
    residual_balance(residual, f, y, value);
    if (force->model->add_momentum_rate) force->model->add_momentum_rate(force, y, yp, value);
}

bool residual_is_differential(const struct school *school, const struct residual_mode *mode, int i) {
    const struct unknown_place place = residual_place(school, i);
    const struct fish *fish = &school->fish[place.fish];
    const bool is_given = fish_is_prescribed(fish, place.index, place.component);

    // of a free node, positions are differential, and so are either its velocities or its momenta
    switch (place.kind) {
        case UNKNOWN_X:
        case UNKNOWN_Y: return !is_given;
        case UNKNOWN_VX:
        case UNKNOWN_VY: return !is_given && (fish->at.second == fish->at.vx || mode->velocities_are_given);
        case UNKNOWN_PX:
        case UNKNOWN_PY: return !is_given && !mode->velocities_are_given;
        case UNKNOWN_CIRCULATION: return sheet_law(school, mode) != BOUND_SHEET_EDGE;
        default: return false;
    }
}

void residual_kinds(const struct residual *residual, const struct residual_mode *mode, double *kind) {
    for (int i = 0; i < residual->school->n_unknowns; i++) {
        kind[i] = residual_is_differential(residual->school, mode, i);
    }
}
