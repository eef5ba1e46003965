/* fish_school.c: sets the constants of the fluid and of all fish, gives each unknown its place, and refuses fish that
 * overlap at the start. */
#include "fish/fish_school.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "fish/fish_body.h"
#include "fish/fish_gait.h"
#include "fish/fish_motion.h"
#include "fish/fish_sheet.h"

// ---- fluid and wakes

/* A number as a ratio of two integers that rounds to exactly this number: with a decimal denominator, else the first
 * convergent of the continued fraction; without a ratio of small integers the number and 1. */
static void find_ratio(double number, double ratio[2]) {
    const double most = 1e9;  // times an event below 2^53
    for (double q = 1; q <= 1e15; q *= 10) {
        const double p = round(number * q);
        if (p > most) break;
        ratio[0] = p;
        ratio[1] = q;
        if (p / q == number) return;
    }

    double p[2] = {1, 0}, q[2] = {0, 1}, rest = number;
    while (p[0] <= most && q[0] <= most) {
        const double whole = floor(rest);
        for (int i = 0; i < 2; i++) {
            double *const of = i == 0 ? p : q;
            const double next = whole * of[0] + of[1];
            of[1] = of[0];
            of[0] = next;
        }
        ratio[0] = p[0];
        ratio[1] = q[0];
        if (p[0] / q[0] == number) return;
        rest = 1 / (rest - whole);
    }

    ratio[0] = number;
    ratio[1] = 1;
}

// the fluid: stream, gust, walls, and the vortices at the start
static void fluid_set(struct school *school, const struct school_parameters *parameters) {
    const struct fluid_parameters *const fluid = &parameters->fluid;
    school->density = fluid->density;
    school->velocity[0] = fluid->velocity[0];
    school->velocity[1] = fluid->velocity[1];
    school->shear = fluid->shear;

    // the gust blows to the left of the stream; without a stream along y
    const double stream = hypot(school->velocity[0], school->velocity[1]);
    const double along[2] = {stream > 0 ? school->velocity[0] / stream : 1,
                             stream > 0 ? school->velocity[1] / stream : 0};
    school->gust[0] = -fluid->gust_amplitude * along[1];
    school->gust[1] = fluid->gust_amplitude * along[0];
    school->gust_omega = 2 * M_PI * fluid->gust_frequency;
    school->gust_profile = fluid->gust_profile;
    if (school->gust_profile != GUST_UNIFORM) {
        memcpy(school->gust_along, along, sizeof along);
        school->gust_omega = 0;
        school->gust_speed = fluid->gust_speed;
        school->gust_number = school->gust_profile == GUST_SINE ? 2 * M_PI / fluid->gust_wavelength : 0;
        school->gust_position = fluid->gust_position;
        school->gust_gradient_distance = fluid->gust_gradient_distance;
    }

    // a single wall bounds the fluid on the side of the first nose at the start
    school->walls.n = fluid->walls.n;
    for (int i = 0; i < fluid->walls.n; i++) {
        const bool is_below = fluid->walls.n == 1 && parameters->fish[0].start_position[1] < fluid->walls.value[0];
        school->walls.y[i] = fluid->walls.value[i];
        school->walls.inward[i] = i == 0 && !is_below ? 1 : -1;
    }

    // vortices of the list, then of a street along the stream, upstream first: the even ones in the row on the left
    const struct number_list *const list = &parameters->wake.vortices;
    const struct street_parameters *const street = &parameters->wake.street;
    school->n_vortices = list->n + street->n;
    NEW(school->arena, school->vortices, 3 * school->n_vortices);
    if (list->n > 0) memcpy(school->vortices, list->value, 3 * (size_t)list->n * sizeof *school->vortices);
    for (int i = 0; i < street->n; i++) {
        double *const vortex = school->vortices + 3 * (list->n + i);
        const double left = i % 2 == 0 ? 1 : -1, across = left * street->row_distance / 2;
        const double ahead = (i - (street->n - 1) / 2.0) * street->spacing / 2;
        vortex[0] = street->position[0] + ahead * along[0] - across * along[1];
        vortex[1] = street->position[1] + ahead * along[1] + across * along[0];
        vortex[2] = -left * street->circulation;
    }
}

// events, shedding, contacts, and the numerical parameters of the school
static void wake_set(struct school *school, const struct school_parameters *parameters) {
    const struct wake_parameters *const wake = &parameters->wake;
    school->interval = parameters->shedding_interval;
    find_ratio(school->interval, school->interval_ratio);
    school->lifetime = wake->lifetime;
    school->decay = wake->decay;
    school->shedding = wake->shedding;
    school->kutta = parameters->sheet.kutta;
    school->removed = wake->removed_circulation;
    school->wake_tolerance = wake->tolerance;
    school->wake_spacing = 0.6;
    school->wake_spare = wake->spare + WAKE_PER_VORTEX * school->n_vortices;
    school->contact = parameters->contact.action;
    school->threads = parameters->threads;

    double longest = 0;
    for (int f = 0; f < parameters->n_fish; f++) {
        school->finite |= fish_is_strip(&parameters->fish[f]);
        longest = fmax(longest, parameters->fish[f].length);
    }
    school->coupling_distance = parameters->coupling_distance * longest;
    school->linear = parameters->linear;
    school->contact_range = parameters->contact.range * longest;
}

// ---- fish

// the control law: doc/model.md, section 11
static void control_set(struct arena *arena, struct fish *fish, const struct fish_parameters *from,
                        const struct school_parameters *parameters) {
    const struct control_parameters *const control = &from->control;
    struct control_law_data *const to = &fish->control;
    to->law = control->law;
    to->bias = control->bias;
    to->gain = control->gain;
    to->damping = control->damping;
    to->limit = control->limit;
    to->feedforward = control->feedforward;
    to->filter_share = -expm1(-parameters->shedding_interval / control->filter);
    to->slow = fish->period > 0 ? control->slow * fish->length / fish->period : 0;
    to->course_share = -expm1(-parameters->shedding_interval / control->course_filter);
    to->rate = control->rate;
    to->ramp = control->ramp;
    to->acceptance_radius = control->acceptance_radius * fish->length;
    to->n_headings = control->desired_heading.n;
    NEW(arena, to->heading_time, to->n_headings);
    NEW(arena, to->heading, to->n_headings);
    for (int i = 0; i < to->n_headings; i++) {
        to->heading_time[i] = control->desired_heading.value[2 * i];
        to->heading[i] = angle_radians(control->desired_heading.value[2 * i + 1]);
    }

    // law place; the centre of mass of a straight body lies behind the nose
    if (control->law == CONTROL_PLACE) to->leader = school_find_fish(parameters, control->of, strlen(control->of));
    to->gains[0] = control->amplitude_gain;
    to->gains[1] = control->amplitude_damping;
    to->amplitude_limit = control->amplitude_limit;
    to->lookahead = control->lookahead;
    to->hold_time = control->hold_time;
    memcpy(to->nose_offset, control->offset, sizeof to->nose_offset);

    to->n_waypoints = control->waypoints.n;
    NEW(arena, to->waypoint_x, to->n_waypoints);
    NEW(arena, to->waypoint_y, to->n_waypoints);
    for (int i = 0; i < to->n_waypoints; i++) {
        to->waypoint_x[i] = control->waypoints.value[2 * i];
        to->waypoint_y[i] = control->waypoints.value[2 * i + 1];
    }

    // rho_f w L^2 (L f)^2
    const double beat_speed = fish->length * from->wave.frequency;
    to->torque_scale = parameters->fluid.density * from->body.depth * fish->length * fish->length * fish->length *
                       beat_speed * beat_speed;
}

// everything but the sheet and the unknowns of fish f: sizes, body, gait, motion, control, sensors
static void fish_fill(const struct school *school, int f, const struct school_parameters *parameters) {
    struct arena *const arena = school->arena;
    struct fish *const fish = &school->fish[f];
    const struct fish_parameters *const from = &parameters->fish[f];
    const struct motion_parameters *const motion = &from->motion;
    fish->name = arena_text(arena, "%s", from->name);
    fish->n_nodes = from->nodes;
    fish->n_edges = from->nodes - 1;
    fish->n_joints = from->nodes - 2;
    fish->n_sheet = from->sheet_points;
    fish->wake_part = from->wake_lifetime;
    fish->n_control = from->sheet_points - 1;
    fish->length = from->length;
    fish->edge_length = fish->length / fish->n_edges;
    fish->smoothing = parameters->wake.smoothing * fish->length;
    fish->sheet_smoothing = parameters->sheet.smoothing * fish->length;
    fish->taper = parameters->wake.taper * fish->length;
    fish->taper_beside = parameters->wake.taper_beside * fish->length;
    fish_body_set(arena, fish, f, from, &parameters->fluid);
    fish_gait_set(arena, fish, from);

    // start and prescribed motion
    const bool is_prescribed = motion->prescribed != PRESCRIBED_NONE;
    memcpy(fish->start_position, from->start_position, sizeof fish->start_position);
    memcpy(fish->load_tip, from->load_tip, sizeof fish->load_tip);
    fish->start_heading = angle_radians(from->start_heading);
    fish->start_speed = from->start_speed;
    fish->motion = (struct motion){.prescribed = motion->prescribed,
                                   .surge = motion->surge,
                                   .is_held = is_prescribed && motion->surge == SURGE_GIVEN,
                                   .speed = motion->speed,
                                   .heave = motion->heave,
                                   .pitch = angle_radians(motion->pitch),
                                   .pitch_phase = angle_radians(motion->pitch_phase),
                                   .omega = 2 * M_PI * motion->frequency,
                                   .phase = angle_radians(motion->phase),
                                   .pivot = motion->pivot * from->length};
    fish->frequency = fish_parameters_frequency(from);
    fish->period = fish->frequency > 0 ? 1 / fish->frequency : 0;
    control_set(arena, fish, from, parameters);

    // sensors
    fish->n_sensors = from->sensors.n;
    NEW(arena, fish->sensor, fish->n_sensors);
    for (int i = 0; i < fish->n_sensors; i++) fish->sensor[i] = from->sensors.value[i];

    // scales of the velocity
    const double rate = fish_rate(school, fish);
    fish->friction_speed = 1e-4 * fish->length * rate;
    fish->waving = from->drag.has_waving ? from->drag.waving : fish_has_wave(fish) ? 1.5 : 1;
    fish->contact_strength = fish->total_mass * fish->length * rate * rate;
}

// the offsets of law place between centres of mass of straight bodies that point where the leader does
static void places_set(struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        struct control_law_data *const control = &school->fish[f].control;
        if (control->law != CONTROL_PLACE) continue;
        const struct fish *const leader = &school->fish[control->leader];
        const double behind = fish_mass_mean(fish, fish->arc) - fish_mass_mean(leader, leader->arc);
        control->frame = leader->start_heading;
        control->offset[0] = control->nose_offset[0] - behind * cos(control->frame);
        control->offset[1] = control->nose_offset[1] - behind * sin(control->frame);
    }
}

// ---- overlaps at the start

// the box around a fish at the start
struct place {
    int fish;
    double from; /* lower side of the box along the axis of the sort */
    struct box box;
};

static int by_place(const void *a, const void *b) {
    const double one = ((const struct place *)a)->from, other = ((const struct place *)b)->from;
    return (one > other) - (one < other);
}

// the overlapping fish f and g < f with the least f, or f = n_fish; group: fish of other groups do not count, or NULL
static void find_overlap(const struct school *school, struct arena *scratch, const double *y, const int *group,
                         int *found_f, int *found_g) {
    const int n = school->n_fish;
    struct place *place;
    NEW(scratch, place, n);

    // sort the boxes along the longer side of the school
    struct box all = box_around(0, NULL, NULL);
    for (int f = 0; f < n; f++) {
        const struct fish *const fish = &school->fish[f];
        double half = 0;
        for (int k = 0; k < fish->n_edges; k++) half = fmax(half, fish->thickness[k] / 2);
        place[f].fish = f;
        place[f].box = box_widen(box_around(fish->n_nodes, y + fish->at.x, y + fish->at.y), half);
        all = box_union(all, place[f].box);
    }
    const int axis = all.high[1] - all.low[1] > all.high[0] - all.low[0];
    for (int f = 0; f < n; f++) place[f].from = place[f].box.low[axis];
    qsort(place, (size_t)n, sizeof *place, by_place);

    // compare the fish whose boxes overlap
    int f = n, g = 0;
    for (int i = 0; i < n; i++) {
        for (int j = i + 1; j < n && place[j].from <= place[i].box.high[axis]; j++) {
            const int first = place[i].fish < place[j].fish ? place[i].fish : place[j].fish;
            const int last = place[i].fish + place[j].fish - first;
            if (group && group[last] != group[first]) continue;
            if (last > f || (last == f && first > g) || box_gap(&place[i].box, &place[j].box) > 0) continue;
            if (fish_distance(&school->fish[last], &school->fish[first], y, 0) > 0) continue;
            f = last;
            g = first;
        }
    }

    *found_f = f;
    *found_g = g;
}

// fail if a fish is not between the walls, or if fish overlap
static enum status refuse_overlap(const struct school *school, struct arena *scratch) {
    const int n = school->n_fish;
    double *y;
    NEW(scratch, y, school->n_unknowns);
    for (int f = 0; f < n; f++) {
        fish_start(&school->fish[f], y);
        if (fish_wall_distance(school, &school->fish[f], y, NULL) > 0) continue;
        return status_fail(STATUS_CASE,
                           "error: fish[%d] (%s) touches a wall or is outside the fluid at the start: change "
                           "start.position or fluid.walls",
                           f, school->fish[f].name);
    }

    int f, g;
    find_overlap(school, scratch, y, NULL, &f, &g);
    if (f == n) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "error: fish[%d] (%s) and fish[%d] (%s) overlap at the start: change start.position of one of "
                       "them",
                       g, school->fish[g].name, f, school->fish[f].name);
}

enum status fish_school_places(const struct school *school, const double *offset) {
    const int n = school->n_fish;
    bool has_places = false;
    for (int f = 0; f < n; f++) has_places |= school->fish[f].control.law == CONTROL_PLACE;
    if (!has_places) return STATUS_OK;

    // straight bodies at their places, as seen from the fish that leads each group
    ARENA(scratch, NULL, "the places of a school");
    double *y;
    int *group;
    NEW(scratch, y, school->n_unknowns);
    NEW(scratch, group, n);
    for (int f = 0; f < n; f++) {
        struct fish fish = school->fish[f];
        int last = f;
        double way[2] = {0, 0};
        while (school->fish[last].control.law == CONTROL_PLACE) {
            const struct control_law_data *const control = &school->fish[last].control;
            for (int d = 0; d < 2; d++) way[d] += offset ? offset[2 * last + d] : control->nose_offset[d];
            last = control->leader;
        }
        group[f] = last;
        for (int d = 0; d < 2; d++) fish.start_position[d] = school->fish[last].start_position[d] + way[d];
        if (last != f) fish.start_heading = school->fish[last].start_heading;
        fish_start(&fish, y);
    }

    int f, g;
    find_overlap(school, scratch, y, group, &f, &g);
    if (f == n) return STATUS_OK;
    if (school->fish[f].control.law != CONTROL_PLACE) {
        const int swap = f;
        f = g;
        g = swap;
    }
    return status_fail(STATUS_CASE, "fish[%d] (%s) would hold its place on top of fish[%d] (%s): change control.offset",
                       f, school->fish[f].name, g, school->fish[g].name);
}

enum status fish_school_create(struct arena *parent, struct school **school,
                               const struct school_parameters *parameters) {
    *school = NULL;
    struct arena *const arena = arena_create(parent, "a school");
    struct school *created;
    NEW(arena, created, 1);
    NEW(arena, created->fish, parameters->n_fish);
    created->arena = arena;
    created->n_fish = parameters->n_fish;
    fluid_set(created, parameters);
    wake_set(created, parameters);
    for (int f = 0; f < created->n_fish; f++) fish_fill(created, f, parameters);
    places_set(created);

    // the slices of the unknowns, fish after fish
    for (int f = 0; f < created->n_fish; f++) {
        const struct fish *const fish = &created->fish[f];
        const bool is_loaded = fish->force == FORCE_PRESSURE;  // by the sheet
        const int n = fish->n_nodes, n_momenta = is_loaded ? n : 0;
        struct layout *const at = &created->fish[f].at;
        at->x = created->n_unknowns;
        at->y = at->x + n;
        at->vx = at->y + n;
        at->vy = at->vx + n;
        at->px = at->vy + n;
        at->py = at->px + n_momenta;
        at->ax = at->py + n_momenta;
        at->ay = at->ax + n;
        at->gamma = at->ay + n;
        at->circulation = at->gamma + fish->n_sheet;
        at->phi0 = at->circulation + 1;
        at->end = created->n_unknowns = at->phi0 + 1;
        at->second = is_loaded ? at->px : at->vx;
        at->full = is_loaded ? at->ax : at->gamma;
        at->rated = is_loaded ? at->circulation : at->gamma;
    }

    struct arena *const scratch = arena_create(arena, "the start of a school");
    enum status status = refuse_overlap(created, scratch);
    arena_free(scratch);
    if (status == STATUS_OK && fish_school_places(created, NULL) != STATUS_OK) {
        status = status_fail(STATUS_CASE, "error: %s", status_message());
    }

    // the sheets take most of the time: last, and until a stop
    for (int f = 0; f < created->n_fish && status == STATUS_OK; f++) {
        status = fish_sheet_set(arena, &created->fish[f], f, parameters, created->finite);
    }

    if (status == STATUS_OK) {
        *school = created;
    } else {
        arena_free(arena);
    }
    return status;
}

void fish_school_free(struct school *school) {
    if (school) arena_free(school->arena);
}
