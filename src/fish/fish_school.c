/* fish_school.c: fluid, fish, the order of the unknowns; check for overlaps at the start. */
#include "fish/fish_school.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"
#include "fish/fish_body.h"
#include "fish/fish_distance.h"
#include "fish/fish_gait.h"
#include "fish/fish_sheet.h"
#include "fish/fish_start.h"

static void motion_set(struct fish *fish, const struct fish_parameters *from) {
    fish->start_position[0] = from->start_position[0];
    fish->start_position[1] = from->start_position[1];
    fish->start_heading = angle_radians(from->start_heading);
    fish->start_speed = from->start_speed;
    fish->load_tip[0] = from->load_tip[0];
    fish->load_tip[1] = from->load_tip[1];

    fish->motion =
        (struct motion){.prescribed = from->motion.prescribed,
                        .surge = from->motion.surge,
                        .is_held = from->motion.prescribed != PRESCRIBED_NONE && from->motion.surge == SURGE_GIVEN,
                        .speed = from->motion.speed,
                        .heave = from->motion.heave,
                        .pitch = angle_radians(from->motion.pitch),
                        .pitch_phase = angle_radians(from->motion.pitch_phase),
                        .omega = 2 * M_PI * from->motion.frequency,
                        .phase = angle_radians(from->motion.phase),
                        .pivot = from->motion.pivot * from->length};

    const int given = fish->motion.prescribed != PRESCRIBED_NONE && from->motion.frequency > 0;
    fish->frequency = given ? from->motion.frequency : from->wave.frequency;
    fish->period = fish->frequency > 0 ? 1 / fish->frequency : 0;
}

static enum status control_set(struct fish *fish, const struct fish_parameters *from,
                               const struct school_parameters *parameters) {
    const struct control_parameters *control = &from->control;
    struct control_law_data *to = &fish->control;
    to->law = control->law;
    to->bias = control->bias;
    to->gain = control->gain;
    to->damping = control->damping;
    to->limit = control->limit;
    to->feedforward = control->feedforward;
    to->filter_share = -expm1(-parameters->shedding_interval / control->filter);
    to->rate = control->rate;
    to->ramp = control->ramp;
    to->acceptance_radius = control->acceptance_radius * fish->length;
    to->n_headings = control->desired_heading.n;
    TRY(MEMORY_NEW(to->heading_time, to->n_headings, "the desired headings"));
    TRY(MEMORY_NEW(to->heading, to->n_headings, "the desired headings"));

    for (int i = 0; i < to->n_headings; i++) {
        to->heading_time[i] = control->desired_heading.value[2 * i];
        to->heading[i] = angle_radians(control->desired_heading.value[2 * i + 1]);
    }

    to->n_waypoints = control->waypoints.n;
    TRY(MEMORY_NEW(to->waypoint_x, to->n_waypoints, "the waypoints"));
    TRY(MEMORY_NEW(to->waypoint_y, to->n_waypoints, "the waypoints"));

    for (int i = 0; i < to->n_waypoints; i++) {
        to->waypoint_x[i] = control->waypoints.value[2 * i];
        to->waypoint_y[i] = control->waypoints.value[2 * i + 1];
    }

    // rho_f w L^2 (L f)^2
    const double beat_speed = fish->length * from->wave.frequency;
    to->torque_scale = parameters->fluid.density * from->body.depth * fish->length * fish->length * fish->length *
                       beat_speed * beat_speed;

    return STATUS_OK;
}

static enum status fish_fill(struct fish *fish, const struct school_parameters *parameters,
                             const struct fish_parameters *from) {
    fish->name = strdup(from->name);
    if (!fish->name) return status_fail(STATUS_MEMORY, "out of memory: the name of a fish");
    fish->n_nodes = from->nodes;
    fish->n_edges = from->nodes - 1;
    fish->n_joints = from->nodes - 2;
    fish->n_sheet = from->sheet_points;
    fish->n_control = from->sheet_points - 1;
    fish->length = from->length;
    fish->edge_length = fish->length / fish->n_edges;
    fish->smoothing = parameters->wake.smoothing * fish->length;
    fish->sheet_smoothing = parameters->sheet.smoothing * fish->length;
    fish->taper = parameters->wake.taper * fish->length;
    fish->taper_beside = parameters->wake.taper_beside * fish->length;
    TRY(fish_body_set(fish, from, &parameters->fluid));
    TRY(fish_gait_set(fish, from));
    TRY(fish_sheet_set(fish, from, parameters));
    motion_set(fish, from);

    return control_set(fish, from, parameters);
}

static struct layout layout_after(int first, int n_nodes, int n_momenta, int n_sheet) {
    struct layout at = {.x = first};
    at.y = at.x + n_nodes;
    at.vx = at.y + n_nodes;
    at.vy = at.vx + n_nodes;
    at.px = at.vy + n_nodes;
    at.py = at.px + n_momenta;
    at.ax = at.py + n_momenta;
    at.ay = at.ax + n_nodes;
    at.gamma = at.ay + n_nodes;
    at.circulation = at.gamma + n_sheet;
    at.phi0 = at.circulation + 1;
    at.end = at.phi0 + 1;

    return at;
}

// a single wall bounds the fluid on the side of the first nose at the start
static void walls_set(struct school *school, const struct school_parameters *parameters) {
    const struct number_list *const walls = &parameters->fluid.walls;
    school->walls.n = walls->n;
    for (int i = 0; i < walls->n; i++) {
        school->walls.y[i] = walls->value[i];
        school->walls.inward[i] = i == 0 ? 1 : -1;
    }

    if (walls->n == 1 && parameters->fish[0].start_position[1] < walls->value[0]) school->walls.inward[0] = -1;
}

static void fluid_set(struct school *school, const struct school_parameters *parameters) {
    school->density = parameters->fluid.density;
    school->velocity[0] = parameters->fluid.velocity[0];
    school->velocity[1] = parameters->fluid.velocity[1];
    school->shear = parameters->fluid.shear;

    // the gust blows to the left of the stream, along y without a stream
    const double stream = hypot(school->velocity[0], school->velocity[1]);
    const double along[2] = {stream > 0 ? school->velocity[0] / stream : 1,
                             stream > 0 ? school->velocity[1] / stream : 0};
    school->gust[0] = -parameters->fluid.gust_amplitude * along[1];
    school->gust[1] = parameters->fluid.gust_amplitude * along[0];
    school->gust_omega = 2 * M_PI * parameters->fluid.gust_frequency;
    walls_set(school, parameters);
    school->interval = parameters->shedding_interval;
    school->lifetime = parameters->wake.lifetime.seconds;
    school->decay = parameters->wake.decay.seconds;
    school->shedding = parameters->wake.shedding;
    school->kutta = parameters->sheet.kutta;
    school->kutta_ramp = parameters->sheet.kutta_ramp;
    school->removed = parameters->wake.removed_circulation;
    for (int f = 0; f < parameters->n_fish; f++) school->finite |= fish_is_strip(&parameters->fish[f]);
    school->wake_tolerance = parameters->wake.tolerance;
    school->wake_merge = parameters->wake.merge;
    school->wake_spare = parameters->wake.spare;
    school->contact = parameters->contact.action;
    school->rtol = parameters->rtol;
    school->threads = parameters->threads;
    double longest = 0;
    for (int f = 0; f < parameters->n_fish; f++) longest = fmax(longest, parameters->fish[f].length);
    school->coupling_distance = parameters->coupling_distance * longest;
    school->contact_range = parameters->contact.range * longest;
}

static enum status refuse_overlap(const struct school *school) {
    double *y;
    TRY(MEMORY_NEW(y, school->n_unknowns, "the unknowns"));
    enum status status = STATUS_OK;

    for (int f = 0; f < school->n_fish && status == STATUS_OK; f++) {
        fish_start(&school->fish[f], y);
        if (fish_wall_distance(school, &school->fish[f], y, NULL) <= 0) {
            status = status_fail(STATUS_CASE,
                                 "error: fish[%d] (%s) touches a wall or is outside the fluid at the start: change "
                                 "start.position or fluid.walls",
                                 f, school->fish[f].name);
        }

        for (int g = 0; g < f && status == STATUS_OK; g++) {
            if (fish_distance(&school->fish[f], &school->fish[g], y, 0) <= 0) {
                status = status_fail(STATUS_CASE,
                                     "error: fish[%d] (%s) and fish[%d] (%s) overlap at the start: change "
                                     "start.position of one of them",
                                     g, school->fish[g].name, f, school->fish[f].name);
            }
        }
    }

    free(y);
    return status;
}

enum status fish_school_create(struct school **school, const struct school_parameters *parameters) {
    struct school *new = calloc(1, sizeof *new);
    *school = NULL;
    if (!new) goto no_memory;
    new->fish = calloc((size_t)parameters->n_fish, sizeof *new->fish);
    if (!new->fish) goto no_memory;
    new->n_fish = parameters->n_fish;
    fluid_set(new, parameters);
    for (int f = 0; f < new->n_fish; f++) {
        if (fish_fill(&new->fish[f], parameters, &parameters->fish[f]) != STATUS_OK) goto failed;
        struct fish *const fish = &new->fish[f];
        const int n_momenta = fish->force == FORCE_PRESSURE ? fish->n_nodes : 0;
        fish->at = layout_after(new->n_unknowns, fish->n_nodes, n_momenta, fish->n_sheet);
        const double rate = fish_rate(new, fish);
        fish->friction_speed = 1e-4 * fish->length * rate;
        const double waving = parameters->fish[f].drag.waving;
        fish->waving = !isnan(waving) ? waving : fish_has_wave(fish) ? 1.5 : 1;
        fish->contact_strength = fish->total_mass * fish->length * rate * rate;
        new->n_unknowns = fish->at.end;
    }
    const enum status overlap = refuse_overlap(new);
    if (overlap != STATUS_OK) {
        fish_school_free(new);
        return overlap;
    }
    *school = new;
    return STATUS_OK;

no_memory:
    status_fail(STATUS_MEMORY, "out of memory: a school of %d fish", parameters->n_fish);
failed:
    fish_school_free(new);
    return STATUS_MEMORY;
}

void fish_school_free(struct school *school) {
    if (!school) return;
    for (int f = 0; f < school->n_fish; f++) {
        struct fish *fish = &school->fish[f];
        void *const owned[] = {fish->name,
                               fish->arc,
                               fish->mass,
                               fish->thickness,
                               fish->depth,
                               fish->square,
                               fish->cube,
                               fish->axial_stiffness,
                               fish->axial_damping,
                               fish->bending_stiffness,
                               fish->bending_damping,
                               fish->wave_amplitude,
                               fish->wave_phase,
                               fish->harmonic,
                               fish->drag_tangential,
                               fish->drag_turbulent,
                               fish->past_transition,
                               fish->drag_normal,
                               fish->added_mass,
                               fish->displaced_mass,
                               fish->sheet_weight,
                               fish->sheet_point,
                               fish->sheet_slope,
                               fish->control_point,
                               fish->control_tangent,
                               fish->end_correction,
                               fish->control_density,
                               fish->control_interval,
                               fish->sheet_half,
                               fish->point_half,
                               fish->control_widening,
                               fish->control.heading_time,
                               fish->control.heading,
                               fish->control.waypoint_x,
                               fish->control.waypoint_y};

        for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
        curve_free(fish->curve);
        sheet_integrals_free(fish->integrals);
    }

    free(school->fish);
    free(school);
}
