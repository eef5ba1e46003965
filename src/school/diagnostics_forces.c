/* diagnostics_forces.c: forces of the fluid, of contacts, of constraints. */
#include "school/diagnostics_forces.h"

#include <math.h>
#include <string.h>

#include "body/clamp.h"
#include "control/control.h"
#include "fish/fish_prescribed.h"
#include "flow/flow_at_bodies.h"
#include "force/fluid_force.h"

// constraint forces: reactions of prescribed nodes; moment of the reactions plus the moment of the clamp
static void find_constraint(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to) {
    const struct fish *fish = &residual->school->fish[f];
    double *const reaction = residual->scratch;
    to->constraint_force[0] = to->constraint_force[1] = 0;
    to->constraint_moment = clamp_moment(fish, t, y);
    if (fish->motion.prescribed == PRESCRIBED_NONE) return;

    residual_reaction(residual, f, y, residual->state->yp, reaction);
    for (int k = 0; k < fish_n_prescribed(fish); k++) {
        const double along_x = fish_is_prescribed(fish, k, 0) ? reaction[fish->at.ax + k] : 0;
        const double force[2] = {along_x, reaction[fish->at.ay + k]};
        const double arm[2] = {y[fish->at.x + k] - to->com[0], y[fish->at.y + k] - to->com[1]};
        for (int i = 0; i < 2; i++) to->constraint_force[i] += force[i];
        to->constraint_moment += arm[0] * force[1] - arm[1] * force[0];
    }
}

struct pressure_forces diagnostics_pressure(struct residual *residual, int f, const double about[2], const double *y) {
    struct pressure *const pressure = residual->pressure[f];
    if (!pressure) return (struct pressure_forces){.leading_edge_a0 = NAN};

    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    pressure_update(pressure, &flow, y);
    pressure_update_rate(pressure, y, residual->state->yp);
    return pressure_sum(pressure, about, y);
}

void diagnostics_fluid_force(const double resistive[2], const double reactive[2],
                             const struct pressure_forces *pressure, double force[2]) {
    for (int i = 0; i < 2; i++) force[i] = resistive[i] + reactive[i] + pressure->pressure[i] + pressure->suction[i];
}

/* The direction of the thrust: heading of a free fish; of prescribed motion the direction of travel, of a held body
 * through the water without the gust. doc/model.md, section 13. */
static void thrust_direction(const struct school *school, const struct fish *fish, const double com[2], const double *y,
                             double direction[2]) {
    const int is_prescribed = fish->motion.prescribed != PRESCRIBED_NONE;
    const double heading = is_prescribed ? fish->start_heading : control_heading(fish, y);
    direction[0] = cos(heading);
    direction[1] = sin(heading);
    if (!fish->motion.is_held) return;

    const double travel[2] = {fish->motion.speed * direction[0] - school->velocity[0] - school->shear * com[1],
                              fish->motion.speed * direction[1] - school->velocity[1]};
    const double speed = hypot(travel[0], travel[1]);
    for (int i = 0; i < 2 && speed > 0; i++) direction[i] = travel[i] / speed;
}

void diagnostics_forces(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to) {
    const struct fish *fish = &residual->school->fish[f];
    const struct flow_at_body flow = flow_at_body(residual->flow, f);
    const struct fluid_forces forces = fluid_force_sum(fish, &flow, to->com, y);
    double ahead[2];
    thrust_direction(residual->school, fish, to->com, y, ahead);

    // total force of the fluid, for the thrust
    to->pressure = diagnostics_pressure(residual, f, to->com, y);
    double force[2];
    diagnostics_fluid_force(forces.resistive, forces.reactive, &to->pressure, force);

    to->thrust = 0;
    for (int i = 0; i < 2; i++) {
        to->resistive_force[i] = forces.resistive[i];
        to->friction_force[i] = forces.friction[i];
        to->reactive_force[i] = forces.reactive[i];
        to->thrust += force[i] * ahead[i];
    }
    to->resistive_moment = forces.resistive_moment;
    to->friction_moment = forces.friction_moment;
    to->reactive_moment = forces.reactive_moment;

    const struct contact_forces contact = contact_forces(residual->contact, f, y);
    memcpy(to->contact_force, contact.force, sizeof to->contact_force);
    find_constraint(residual, f, t, y, to);
}
