/* diagnostics_momentum.c: the impulses of bodies and fluid, the external forces, and what is left of the momentum
 * balance. */
#include "school/diagnostics_momentum.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"
#include "body/rod.h"
#include "control/control.h"
#include "fish/fish_motion.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "flow/flow_external.h"
#include "flow/flow_leg_rate.h"
#include "force/force_model.h"
#include "state/impulse.h"
#include "state/state.h"

// ---- forces of the fluid, of contacts, of constraints

struct fluid_forces diagnostics_fluid(struct residual *residual, int f, const double about[2], const double *y) {
    const struct fluid_force *const force = &residual->force[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    if (force->model->update) force->model->update(force, &flow, y, residual->state->yp);
    return force->model->forces(force, &flow, about, y);
}

void diagnostics_fluid_force(const double resistive[2], const double reactive[2],
                             const struct pressure_forces *pressure, double force[2]) {
    for (int i = 0; i < 2; i++) force[i] = resistive[i] + reactive[i] + pressure->pressure[i] + pressure->suction[i];
}

void diagnostics_forces(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to) {
    const struct school *const school = residual->school;
    const struct fish *fish = &school->fish[f];
    const bool is_prescribed = fish->motion.prescribed != PRESCRIBED_NONE;

    const struct fluid_forces forces = diagnostics_fluid(residual, f, to->com, y);
    memcpy(to->resistive_force, forces.resistive, sizeof forces.resistive);
    memcpy(to->friction_force, forces.friction, sizeof forces.friction);
    memcpy(to->reactive_force, forces.reactive, sizeof forces.reactive);
    for (int i = 0; i < 2; i++) to->cross_flow_force[i] = forces.resistive[i] - forces.friction[i];
    to->resistive_moment = forces.resistive_moment;
    to->friction_moment = forces.friction_moment;
    to->reactive_moment = forces.reactive_moment;
    to->pressure = forces.pressure;

    // The thrust points along the heading of a free fish. For prescribed motion it points along the travel, and for a
    // held body along its travel through the water without the gust. doc/model.md, section 13.
    const double heading = is_prescribed ? fish->start_heading : control_heading(fish, y);
    double ahead[2] = {cos(heading), sin(heading)}, force[2];
    if (fish->motion.is_held) {
        const double travel[2] = {fish->motion.speed * ahead[0] - school->velocity[0] - school->shear * to->com[1],
                                  fish->motion.speed * ahead[1] - school->velocity[1]};
        const double speed = hypot(travel[0], travel[1]);
        for (int i = 0; i < 2 && speed > 0; i++) ahead[i] = travel[i] / speed;
    }
    diagnostics_fluid_force(forces.resistive, forces.reactive, &to->pressure, force);
    to->thrust = force[0] * ahead[0] + force[1] * ahead[1];

    // constraint forces are the reactions of prescribed nodes; their moment includes that of the clamp
    const struct contact_terms contact = contact_terms(residual->contact, f, y);
    memcpy(to->contact_force, contact.force, sizeof to->contact_force);
    to->constraint_force[0] = to->constraint_force[1] = 0;
    to->constraint_moment = rod_clamp_terms(fish, t, y).moment;
    if (!is_prescribed) return;
    double *const reaction = residual->scratch;
    residual_reaction(residual, f, y, residual->state->yp, reaction);
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        const double along_x = fish_is_prescribed(fish, k, 0) ? reaction[fish->at.ax + k] : 0;
        const double of_node[2] = {along_x, reaction[fish->at.ay + k]};
        const double arm[2] = {y[fish->at.x + k] - to->com[0], y[fish->at.y + k] - to->com[1]};
        for (int i = 0; i < 2; i++) to->constraint_force[i] += of_node[i];
        to->constraint_moment += arm[0] * of_node[1] - arm[1] * of_node[0];
    }
}

/* Whether the momentum of a fish and of the fluid can balance. It can if the body takes the momentum of its vortices
 * and the depth is constant along the body, or if there is no fluid. */
static bool diagnostics_has_reaction(const struct school *school, const struct fish *fish) {
    return !(school->density > 0) || (force_model_of(fish)->has_balance && impulse_depth(fish) > 0);
}

// ---- momentum of a body, impulse of its vortices

// add a momentum, or a force, at a point together with its moment about the origin
static void add_with_moment(double sum[3], double x, double y, double along_x, double along_y) {
    sum[0] += along_x;
    sum[1] += along_y;
    sum[2] += x * along_y - y * along_x;
}

// the added momentum of component i of node k
static double added_momentum(const struct residual *residual, int f, int i, int k) {
    return residual->force[f].momentum[i * residual->school->fish[f].n_nodes + k];
}

// add the nascent vortex, or stretch, of a fish
static void add_nascent(struct impulse_moments *sum, const struct flow *flow, const struct state *state, int f,
                        double tau, const double tail[2]) {
    const struct wake *const wake = &state->wake[f];
    double at[2];
    if (flow_has_free_sheets(flow)) {
        sheet_newest(wake, flow->school->interval, tau, tail, at);
        impulse_add_stretch(sum, flow->fish[f].nascent, tail, at);
    } else {
        wake_nascent(wake, tau, tail, at);
        impulse_add(sum, flow->fish[f].nascent, at[0], at[1]);
    }
}

/* The momenta of a fish at the event of the state: of the body, of the fluid (the impulse of all vortices), and of the
 * prescribed components of nodes, with added momentum. */
struct momenta {
    double body[3], fluid[3], given[3];
};

static struct momenta momenta_of(struct residual *residual, const struct state *state, int f) {
    const struct fish *const fish = &residual->school->fish[f];
    const struct fluid_force *const force = &residual->force[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    const double *const y = state->y, factor = residual->school->density * impulse_depth(fish);
    struct momenta of = {.body = {0}};
    if (force->model->update) force->model->update(force, &flow, y, residual->state->yp);
    for (int k = 0; k < fish->n_nodes; k++) {
        add_with_moment(of.body, y[fish->at.x + k], y[fish->at.y + k], fish->mass[k] * y[fish->at.vx + k],
                        fish->mass[k] * y[fish->at.vy + k]);
    }

    // the wake, and the bound sheet
    struct impulse_moments wake = impulse_of_wake(&state->wake[f], residual->school, state->t, 0);
    double tail[2];
    fish_tail(fish, y, tail);
    add_nascent(&wake, residual->flow, state, f, 0, tail);
    impulse_of(&wake, factor, of.fluid);
    force->model->add_impulse(force, &residual->flow->fish[f].own, factor, y, of.fluid);

    // prescribed nodes
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        double of_node[2] = {0, 0};
        for (int i = 0; i < 2; i++) {
            if (!fish_is_prescribed(fish, k, i)) continue;
            of_node[i] = fish->mass[k] * y[fish->at.vx + i * fish->n_nodes + k] + added_momentum(residual, f, i, k);
        }
        add_with_moment(of.given, y[fish->at.x + k], y[fish->at.y + k], of_node[0], of_node[1]);
    }
    return of;
}

// ---- external forces

// all external forces except those of images; call it after diagnostics_power
static void external_force(struct residual *residual, int f, double t, const double *y, double force[3]) {
    const struct school *const school = residual->school;
    const struct state *const state = residual->state;
    const struct flow *const flow = residual->flow;
    const struct fish *const fish = &school->fish[f];
    const struct flow_at_body at_body = flow_at_body(flow, f);
    const struct fluid_force *const on_fish = &residual->force[f];
    const struct fluid_forces fluid = on_fish->model->forces(on_fish, &at_body, (const double[2]){0, 0}, y);
    const struct contact_terms contact = contact_terms(residual->contact, f, y);

    double tail[2];
    fish_tail(fish, y, tail);
    for (int i = 0; i < 2; i++) force[i] = fluid.resistive[i] + contact.force[i];
    force[2] = fluid.resistive_moment + contact.moment + rod_clamp_terms(fish, t, y).moment;
    add_with_moment(force, tail[0], tail[1], fish->load_tip[0], fish->load_tip[1]);

    const double *const separation = fluid.pressure.separation;
    add_with_moment(force, y[fish->at.x], y[fish->at.y], -separation[0], -separation[1]);

    // The constraint forces of prescribed nodes are m a minus all forces, without the rate of the momentum of these
    // nodes, because momenta.given is its integral.
    double *const balance = residual->scratch;
    if (fish_n_prescribed(fish) > 0) residual_balance(residual, f, y, balance);
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        double of_node[2] = {0, 0}, momentum[2] = {0, 0};
        for (int i = 0; i < 2; i++) {
            const int node = i * fish->n_nodes + k;
            if (!fish_is_prescribed(fish, k, i)) continue;
            of_node[i] = balance[fish->at.ax + node] - fish->mass[k] * y[fish->at.ax + node];
            momentum[i] = fish->mass[k] * y[fish->at.vx + node] + added_momentum(residual, f, i, k);
        }
        add_with_moment(force, y[fish->at.x + k], y[fish->at.y + k], of_node[0], of_node[1]);

        // moment of the momentum rate = rate of the moment minus velocity x momentum
        force[2] -= y[fish->at.vx + k] * momentum[1] - y[fish->at.vy + k] * momentum[0];
    }

    // The external flow, without a travelling gust, acts on all vortices of the fish. Its velocity is linear in the
    // position, so the moments of free, nascent and bound vortices suffice.
    double u, v, gust[2];
    flow_external(school, t, 0, 0, &u, &v);
    flow_external_gust(school, t, 0, 0, &gust[0], &gust[1]);
    u -= gust[0];
    v -= gust[1];
    if (!(fabs(u) + fabs(v) + fabs(school->shear) > 0) || !on_fish->model->add_moments) return;
    struct impulse_moments sum = impulse_of_wake(&state->wake[f], school, state->t, t - state->t);
    add_nascent(&sum, flow, state, f, t - state->t, tail);
    const int first = flow->points[f].first;
    on_fish->model->add_moments(on_fish, flow->x + first, flow->y + first, &sum);
    const double factor = school->density * impulse_depth(fish);
    force[0] += factor * v * sum.circulation;
    force[1] -= factor * (u * sum.circulation + school->shear * sum.y);
    force[2] -= factor * (u * sum.x + v * sum.y + school->shear * sum.product);
}

// ---- images

// add the force of velocities on n circulations
static void add_force_of(const double *u, const double *v, int n, const double *x, const double *y,
                         const double *circulation, double factor, double force[3]) {
    for (int i = 0; i < n; i++) {
        force[0] += factor * circulation[i] * v[i];
        force[1] -= factor * circulation[i] * u[i];
        force[2] -= factor * circulation[i] * (x[i] * u[i] + y[i] * v[i]);
    }
}

// add the force of velocities on sources, and of the divergence on the legs
static void add_force_on_sources(const double *u, const double *v, const double *div, const struct sources *sources,
                                 double factor, double force[3]) {
    add_force_of(u, v, sources->n, sources->x, sources->y, sources->q, factor, force);
    for (int i = 0; i < sources->n; i++) {
        add_with_moment(force, sources->x[i], sources->y[i], factor * div[i] * sources->dy[i],
                        -factor * div[i] * sources->dx[i]);
    }
}

void diagnostics_momentum_event(struct residual *residual, struct state *state) {
    const struct school *const school = residual->school;
    struct flow *const flow = residual->flow;
    const double half = school->interval / 2;
    bool has_reaction = false;

    for (int f = 0; f < school->n_fish; f++) has_reaction |= diagnostics_has_reaction(school, &school->fish[f]);

    // there are walls or a travelling gust, never both
    const bool has_walls = school->walls.n > 0, has_gust = school->gust_profile != GUST_UNIFORM;
    if (!has_reaction || !(school->density > 0)) return;
    if (has_walls) flow_images(flow, state);
    if (flow->kernel->has_legs) flow_leg_boxes(flow);
    const double work = (double)flow->kernel->cost * flow->n_points * flow->n_markers;
    const int threads = parallel_threads(school->threads, school->n_fish, work, PARALLEL_INTERACTIONS);
#pragma omp parallel for num_threads(threads) schedule(dynamic)
    for (int f = 0; f < school->n_fish; f++) {
        if (!diagnostics_has_reaction(school, &school->fish[f])) continue;

        // the momentum that legs of different lengths s take, by trapezoids
        struct momentum_balance *const momentum = &state->momentum[f];
        const double factor = school->density * impulse_depth(&school->fish[f]);
        double rate[3], image[3];
        flow_leg_rate(flow, state, f, rate, image);
        for (int i = 0; i < 3; i++) {
            const double taken = factor * (rate[i] + image[i]);
            if (state->event > 0) momentum->legs[i] += half * (momentum->leg_rate[i] + taken);
            momentum->leg_rate[i] = taken;
        }
        if (!has_walls && !has_gust) continue;

        // the force of images, or of a travelling gust, on the sheet and the wake of the fish
        const struct sources *const all[] = {&flow->fish[f].body, &flow->fish[f].markers};
        const int point = flow->points[f].first, marker = flow->wake_range[f].first;
        double now[3] = {0};
        for (int i = 0; i < 3; i++) now[i] = factor * image[i];
        if (has_walls) {
            add_force_on_sources(flow->image_u + point, flow->image_v + point, flow->image_div + point, all[0], factor,
                                 now);
            add_force_on_sources(flow->wake_image_u + marker, flow->wake_image_v + marker,
                                 flow->wake_image_div + marker, all[1], factor, now);
        }
        for (int i = 0; i < 2 && !has_walls; i++) {
            for (int j = 0; j < all[i]->n; j++) {
                double u, v;
                flow_external_gust(school, flow->t, all[i]->x[j], all[i]->y[j], &u, &v);
                add_force_of(&u, &v, 1, all[i]->x + j, all[i]->y + j, all[i]->q + j, factor, now);
            }
        }

        for (int i = 0; i < 3; i++) {
            if (state->event > 0) momentum->external[i] += half * (momentum->images[i] + now[i]);
            momentum->images[i] = now[i];
        }
    }
}

// ---- the balance

void diagnostics_momentum_step(struct residual *residual, struct state *state, int f, double t, const double *y, int n,
                               const double times[3]) {
    struct momentum_balance *const momentum = &state->momentum[f];
    if (!diagnostics_has_reaction(residual->school, &residual->school->fish[f])) return;

    double newest[3];
    external_force(residual, f, t, y, newest);
    for (int i = 0; i < 3; i++) {
        const double force[3] = {newest[i], momentum->force[0][i], momentum->force[1][i]};
        if (n > 0) momentum->external[i] += quadrature_newest(n, times, force);
        momentum->force[1][i] = force[1];
        momentum->force[0][i] = force[0];
    }
}

void diagnostics_momentum_start(struct residual *residual, struct state *state) {
    for (int f = 0; f < residual->school->n_fish; f++) {
        struct momentum_balance *const momentum = &state->momentum[f];
        memset(momentum->lost, 0, sizeof momentum->lost);
        memset(momentum->legs, 0, sizeof momentum->legs);
        memset(momentum->external, 0, sizeof momentum->external);
        if (!diagnostics_has_reaction(residual->school, &residual->school->fish[f])) continue;

        const struct momenta of = momenta_of(residual, state, f);
        memcpy(momentum->first_body, of.body, sizeof of.body);
        memcpy(momentum->first_fluid, of.fluid, sizeof of.fluid);
        memcpy(momentum->first_given, of.given, sizeof of.given);
    }
}

bool diagnostics_momentum_is_defined(const struct school *school) {
    // forces between rings of different depths are equal and opposite, but forces between strips are not
    const double depth = impulse_depth(&school->fish[0]);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        if (!diagnostics_has_reaction(school, fish)) return false;
        if (!(school->density > 0) || school->finite) continue;
        if (fabs(impulse_depth(fish) - depth) > 1e-12 * depth) return false;
    }
    return true;
}

void diagnostics_momentum(struct residual *residual, const struct state *state, struct diagnostics *diagnostics) {
    const struct school *const school = residual->school;
    double *const balance = diagnostics->momentum_balance;
    memset(balance, 0, sizeof diagnostics->momentum_balance);

    // the sizes of the terms of the balance, and what the momenta of all bodies would be at one length per beat
    double of_bodies = 0, of_fluid = 0, external = 0, usual = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct momentum_balance *const momentum = &state->momentum[f];
        const struct fish *const fish = &school->fish[f];
        struct diagnostics_fish *const to = &diagnostics->fish[f];
        struct momenta of = momenta_of(residual, state, f);
        double lost[3];
        const struct impulse_moments gone = {
            .x = momentum->lost[0], .y = momentum->lost[1], .square = momentum->lost[2]};
        impulse_of(&gone, school->density * impulse_depth(fish), lost);

        // fill the impulses of the fish, and add the fish to the balance
        const bool has_reaction = diagnostics_has_reaction(school, fish);
        for (int i = 0; i < 3; i++) {
            to->fluid_impulse[i] = of.fluid[i] + lost[i];
            to->lost_impulse[i] = lost[i];
            to->leg_impulse[i] = has_reaction ? momentum->legs[i] : NAN;
            to->external_impulse[i] =
                has_reaction ? momentum->external[i] + of.given[i] - momentum->first_given[i] : NAN;
            of.fluid[i] -= momentum->first_fluid[i];
            balance[i] += of.body[i] - momentum->first_body[i] + of.fluid[i] + lost[i] + momentum->legs[i] -
                          to->external_impulse[i];
        }
        of_bodies += hypot(of.body[0], of.body[1]);
        of_fluid += hypot(of.fluid[0], of.fluid[1]);
        external += hypot(to->external_impulse[0], to->external_impulse[1]);
        usual += fish->total_mass * fish->length * fish_rate(school, fish);
    }

    const double rounding = 1e-6;
    diagnostics->momentum_size = fmax(rounding * usual, fmax(of_bodies, fmax(of_fluid, external)));
    for (int i = 0; i < 3 && !diagnostics_momentum_is_defined(school); i++) balance[i] = NAN;
}
