/* fish.c: from the parameters of a school to the constant data of every fish. */
#include "model/fish.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/angle.h"
#include "base/ramp.h"
#include "model/profile.h"

static const double pi = 3.14159265358979323846;

double fish_mean(const struct stencil *point, const double *value) {
    double mean = 0;
    for (int i = 0; i < point->n; i++) mean += point->weight[i] * value[point->node[i]];
    return mean;
}

double fish_mass_mean(const struct fish *fish, const double *value) {
    double sum = 0;
    for (int k = 0; k < fish->n_nodes; k++) sum += fish->mass[k] * value[k];
    return sum / fish->total_mass;
}

struct direction fish_direction(const struct fish *fish, const struct tangent *tangent, const double *y) {
    const double *const x = y + fish->at.x, *const z = y + fish->at.y;
    const double e[2] = {fish_mean(&tangent->to, x) - fish_mean(&tangent->from, x),
                         fish_mean(&tangent->to, z) - fish_mean(&tangent->from, z)};
    struct direction direction = {.length = sqrt(e[0] * e[0] + e[1] * e[1])};
    direction.t[0] = e[0] / direction.length;
    direction.t[1] = e[1] / direction.length;
    direction.n[0] = -direction.t[1];
    direction.n[1] = direction.t[0];
    return direction;
}

static enum status doubles(double **values, int n) {
    *values = calloc((size_t)(n > 0 ? n : 1), sizeof **values);
    return *values ? STATUS_OK : status_fail(STATUS_MEMORY, "out of memory: %d numbers of a fish", n);
}

static enum status fish_allocate(struct fish *fish) {
    TRY(doubles(&fish->arc, fish->n_nodes));
    TRY(doubles(&fish->mass, fish->n_nodes));
    double **const per_edge[] = {
        &fish->thickness,     &fish->depth,           &fish->square,      &fish->cube,       &fish->axial_stiffness,
        &fish->axial_damping, &fish->drag_tangential, &fish->drag_normal, &fish->added_mass, &fish->displaced_mass};
    for (size_t i = 0; i < sizeof per_edge / sizeof *per_edge; i++) TRY(doubles(per_edge[i], fish->n_edges));
    double **const per_joint[] = {&fish->bending_stiffness, &fish->bending_damping, &fish->wave_amplitude,
                                  &fish->wave_phase};
    for (size_t i = 0; i < sizeof per_joint / sizeof *per_joint; i++) TRY(doubles(per_joint[i], fish->n_joints));
    TRY(doubles(&fish->sheet_weight, fish->n_sheet));
    TRY(doubles(&fish->end_correction, fish->n_control));
    TRY(doubles(&fish->control_density, fish->n_control));
    TRY(doubles(&fish->control_interval, fish->n_control));
    fish->sheet_point = calloc((size_t)fish->n_sheet, sizeof *fish->sheet_point);
    fish->sheet_slope = calloc((size_t)fish->n_sheet, sizeof *fish->sheet_slope);
    fish->control_point = calloc((size_t)fish->n_control, sizeof *fish->control_point);
    fish->control_tangent = calloc((size_t)fish->n_control, sizeof *fish->control_tangent);
    if (!fish->sheet_point || !fish->sheet_slope || !fish->control_point || !fish->control_tangent) {
        return status_fail(STATUS_MEMORY, "out of memory: %d points of a sheet", fish->n_sheet);
    }
    return STATUS_OK;
}

static void shape_edges(struct fish *fish, const struct fish_parameters *from) {
    for (int k = 0; k < fish->n_nodes; k++) fish->arc[k] = k * fish->edge_length;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct profile_edge edge = profile_edge(from, k);
        fish->thickness[k] = edge.h;
        fish->depth[k] = edge.w;
        fish->square[k] = edge.square;
        fish->cube[k] = edge.cube;
    }
}

// what holds a prescribed head: a joint of half the length of the others. doc/model.md, section 2
static void clamp_head(struct fish *fish, const struct fish_parameters *from, double stiffness, double refinement) {
    const struct body_parameters *body = &from->body;
    fish->has_clamp = from->motion.prescribed == PRESCRIBED_HEAD && body->section == SECTION_MEAN;
    fish->clamp_stiffness = 2 * stiffness / fish->edge_length;
    fish->clamp_damping = 2 * (body->bending_damping * refinement) + body->relaxation_time * fish->clamp_stiffness;
}

// masses, stiffnesses and damping: doc/model.md, sections 1 and 3
static void weigh_body(struct fish *fish, const struct fish_parameters *from) {
    const struct body_parameters *body = &from->body;
    const double reference = fish->length / (from->reference_nodes - 1), refinement = reference / fish->edge_length;
    double moment_before = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const double h = fish->thickness[k], w = fish->depth[k], area = pi * h * w / 4;
        const double edge_mass = body->density * area * fish->edge_length;
        fish->mass[k] += edge_mass / 2;
        fish->mass[k + 1] += edge_mass / 2;
        fish->total_mass += edge_mass;
        fish->axial_stiffness[k] = body->modulus * area;
        fish->axial_damping[k] = body->stretching_damping * refinement +
                                 body->relaxation_time * fish->axial_stiffness[k] / fish->edge_length;
        const double moment = body->second_moment == SECOND_MOMENT_ELLIPSE
                                  ? pi * w * h * h * h / 64 * fish->cube[k]
                                  : body->density * area * reference * w * w / 12;
        if (k > 0) {
            fish->bending_stiffness[k - 1] = body->modulus * (moment_before + moment) / 2;
            fish->bending_damping[k - 1] = body->bending_damping * refinement +
                                           body->relaxation_time * fish->bending_stiffness[k - 1] / fish->edge_length;
        }
        if (k == 0) clamp_head(fish, from, body->modulus * moment, refinement);
        moment_before = moment;
    }
}

// Fourier coefficients, over the phase, of the table's curvature at a joint, as a turning angle
static void set_harmonics(const struct fish *fish, const struct number_list *table, int joint) {
    const double place = (joint + 1.0) / fish->n_edges * (table->n - 1), unit = fish->edge_length / fish->length;
    const int row = place < table->n - 2 ? (int)place : table->n - 2, n = table->width;
    const double *const low = &table->value[row * n], *const high = low + n;
    double *const to = &fish->harmonic[2 * joint * fish->n_harmonics];
    for (int m = 0; m < fish->n_harmonics; m++) {
        // the mean, and the highest harmonic of an even number of values, count once
        const double weight = (m == 0 || 2 * m == n ? 1.0 : 2.0) / n * unit;
        for (int j = 0; j < n; j++) {
            const double value = low[j] + (place - row) * (high[j] - low[j]), angle = 2 * pi * m * j / n;
            to[2 * m] += weight * value * cos(angle);
            if (2 * m < n) to[2 * m + 1] += weight * value * sin(angle);
        }
    }
}

static enum status set_table(struct fish *fish, const struct number_list *table) {
    if (table->n == 0) return STATUS_OK;
    fish->n_harmonics = table->width / 2 + 1;
    TRY(doubles(&fish->harmonic, 2 * fish->n_joints * fish->n_harmonics));
    for (int joint = 0; joint < fish->n_joints; joint++) set_harmonics(fish, table, joint);
    return STATUS_OK;
}

static void set_wave(struct fish *fish, const struct fish_parameters *from) {
    const struct wave_parameters *wave = &from->wave;
    const double reference = fish->length / (from->reference_nodes - 1);
    for (int joint = 0; joint < fish->n_joints; joint++) {
        const double sigma = (joint + 1.0) / fish->n_edges;
        fish->wave_amplitude[joint] = wave->amplitude * (fish->edge_length / reference) *
                                      (wave->constant + wave->linear * sigma + wave->quadratic * sigma * sigma);
        // a table has its own phase along the body
        fish->wave_phase[joint] = (wave->table.n > 0 ? 0 : wave->number * sigma) + angle_radians(wave->phase);
    }
    fish->omega = 2 * pi * wave->frequency;
    fish->ramp = wave->ramp;
    fish->amplitude = wave->amplitude;
}

// Blasius' friction of both sides of an edge, over u^(3/2)
static double laminar_friction(const struct fish *fish, int k, const struct fluid_parameters *fluid) {
    const double share = sqrt((k + 1.0) / fish->n_edges) - sqrt((double)k / fish->n_edges);
    return 1.328 * fluid->density * fish->depth[k] * sqrt(fluid->viscosity * fish->length) * share;
}

// drag, added mass and what leaves at the tail: doc/model.md, section 9
static void set_fluid_forces(struct fish *fish, const struct fish_parameters *from,
                             const struct fluid_parameters *fluid) {
    const struct drag_parameters *drag = &from->drag;
    const int wide = drag->extent == EXTENT_DEPTH, published = from->force == FORCE_PUBLISHED;
    const double density = fluid->density, reactive = from->force == FORCE_PRESSURE ? 0 : 1;
    for (int k = 0; k < fish->n_edges; k++) {
        const double h = fish->thickness[k], w = fish->depth[k], l = fish->edge_length;
        const double across = wide ? w : h, square = wide ? 1 : fish->square[k];
        fish->drag_tangential[k] = drag->skin == SKIN_LAMINAR
                                       ? laminar_friction(fish, k, fluid)
                                       : density * pi * drag->tangential * l * (h + w) / (published ? 8 : 4);
        fish->drag_normal[k] = density * drag->normal * l * across / 2;
        fish->added_mass[k] = reactive * pi * density * drag->added_mass * across * across * l / 4 * square;
        fish->displaced_mass[k] = reactive * density * pi * h * w / 4 * l;
    }
    fish->force = from->force;
    fish->skin = drag->skin;
    const double at_tail = wide ? fish->depth[fish->n_edges - 1] : profile_tail_thickness(from);
    fish->tail_added_mass = published ? 0 : reactive * pi * density * drag->added_mass * at_tail * at_tail / 4;
    // the published law has 1 m s-1
    const double linear_speed = published ? 1 : drag->linear_speed * fish->length * from->wave.frequency;
    fish->linear_speed = drag->law == DRAG_LINEAR_QUADRATIC ? linear_speed : 0;
}

// sigma at j intervals of the angle from the nose
static double cosine_place(const struct fish *fish, double j) {
    const int last = fish->n_sheet - 1;
    return j == last ? 1 : (1 - cos(pi * j / last)) / 2;
}

// sigma of a control point
static double control_place(const struct fish *fish, int c, enum collocation collocation) {
    if (collocation == COLLOCATION_CHEBYSHEV) return cosine_place(fish, c + 0.5);
    return (cosine_place(fish, c) + cosine_place(fish, c + 1)) / 2;
}

static void place_sheet_on_polygon(struct fish *fish, enum collocation collocation) {
    for (int j = 0; j < fish->n_sheet; j++) {
        fish->sheet_point[j] = curve_polygon_point(fish->curve, cosine_place(fish, j) * fish->n_edges);
    }
    for (int c = 0; c < fish->n_control; c++) {
        const struct stencil *const a = &fish->sheet_point[c], *const b = &fish->sheet_point[c + 1];
        fish->control_point[c] = collocation == COLLOCATION_CHEBYSHEV
                                     ? curve_polygon_point(fish->curve, cosine_place(fish, c + 0.5) * fish->n_edges)
                                     : curve_polygon_middle(fish->curve, a, b);
        fish->control_tangent[c] = (struct tangent){.from = *a, .to = *b};
    }
    fish->tail_tangent = fish->control_tangent[fish->n_control - 1];
}

static void place_sheet_on_smooth_curve(struct fish *fish, enum collocation collocation) {
    const int last = fish->n_sheet - 1;
    for (int j = 0; j <= last; j++) {
        const double u = cosine_place(fish, j) * fish->n_edges;
        fish->sheet_point[j] = curve_smooth_point(fish->curve, u);
        if (j == 0 || j == last) continue;  // where the quadrature has no weight
        fish->sheet_slope[j] = curve_smooth_slope(fish->curve, u);
        fish->sheet_weight[j] = fish->length / 2 * sin(pi * j / last) * pi / last;
    }
    for (int c = 0; c < last; c++) {
        const double u = control_place(fish, c, collocation) * fish->n_edges;
        fish->control_point[c] = curve_smooth_point(fish->curve, u);
        fish->control_tangent[c].to = curve_smooth_slope(fish->curve, u);
    }
    fish->tail_tangent.to = curve_smooth_slope(fish->curve, fish->n_edges);
    fish->nose_tangent.to = curve_smooth_slope(fish->curve, 0);
}

// E_c, for a sheet whose strength at the tail is that of the wake
static void correct_end(struct fish *fish) {
    const int last = fish->n_sheet - 1;
    const double h = pi / last, weight = fish->length / 2 * h * sin(pi * (last - 1) / last);
    for (int c = 0; c < fish->n_control; c++) {
        const double place = cosine_place(fish, c + 0.5);
        double quadrature = 0;
        for (int j = 1; j < last; j++) {
            const double sigma = cosine_place(fish, j);
            quadrature += h / 2 * sin(j * h) * sigma / (2 * pi * (place - sigma));
        }
        const double exact = (place * log(place / (1 - place)) - 1) / (2 * pi);
        fish->end_correction[c] = (exact - quadrature) / weight;
    }
}

// bound vortices and control points: doc/model.md, section 6
static enum status place_sheet(struct fish *fish, const struct wake_parameters *wake) {
    for (int j = 1; j < fish->n_sheet; j++) {
        const double distance = cosine_place(fish, j) - cosine_place(fish, j - 1);
        fish->sheet_weight[j - 1] += distance * fish->length / 2;
        fish->sheet_weight[j] += distance * fish->length / 2;
    }
    const int is_smooth = wake->curve == BODY_LINE_SMOOTH;
    TRY(curve_create(&fish->curve, fish->n_nodes, is_smooth ? 1 : 2 * fish->n_sheet,
                     is_smooth ? 4 * fish->n_sheet + 1 : 0));
    if (is_smooth) {
        place_sheet_on_smooth_curve(fish, wake->collocation);
    } else {
        place_sheet_on_polygon(fish, wake->collocation);
    }
    if (wake->shedding == SHEDDING_SHEET) correct_end(fish);
    fish->heading_point = curve_polygon_point(fish->curve, 1.0 / 3.0 * fish->n_edges);
    return STATUS_OK;
}

// the pressure of the bound sheet: doc/model.md, section 15
static enum status set_pressure(struct fish *fish, const struct fish_parameters *from, double density) {
    if (fish->force != FORCE_PRESSURE) return STATUS_OK;
    const double h = pi / fish->n_control;
    double *per_edge;
    TRY(doubles(&per_edge, fish->n_edges));
    for (int k = 0; k < fish->n_edges; k++) per_edge[k] = density * fish->depth[k];
    for (int c = 0; c < fish->n_control; c++) {
        fish->control_density[c] = per_edge[(int)(cosine_place(fish, c + 0.5) * fish->n_edges)];
        fish->control_interval[c] = fish->n_edges / 2.0 * sin((c + 0.5) * h) * h;
    }
    fish->fluid_density = density;
    const double first = fish->sheet_weight[0] * fish->n_control;
    fish->suction = from->suction * per_edge[0] * first * first / (pi * fish->length);
    const enum status status = sheet_integrals_create(&fish->integrals, fish->n_nodes, fish->n_sheet, per_edge);
    free(per_edge);
    return status;
}

static void set_motion(struct fish *fish, const struct fish_parameters *from) {
    fish->start_position[0] = from->start_position[0];
    fish->start_position[1] = from->start_position[1];
    fish->start_heading = angle_radians(from->start_heading);
    fish->start_speed = from->start_speed;
    fish->load_tip[0] = from->load_tip[0];
    fish->load_tip[1] = from->load_tip[1];
    fish->motion = (struct motion){.prescribed = from->motion.prescribed,
                                   .surge = from->motion.surge,
                                   .speed = from->motion.speed,
                                   .heave = from->motion.heave,
                                   .pitch = angle_radians(from->motion.pitch),
                                   .pitch_phase = angle_radians(from->motion.pitch_phase),
                                   .omega = 2 * pi * from->motion.frequency,
                                   .phase = angle_radians(from->motion.phase),
                                   .pivot = from->motion.pivot * from->length};
    const int given = fish->motion.prescribed != PRESCRIBED_NONE && from->motion.frequency > 0;
    fish->frequency = given ? from->motion.frequency : from->wave.frequency;
    fish->period = fish->frequency > 0 ? 1 / fish->frequency : 0;
}

static enum status set_control(struct fish *fish, const struct fish_parameters *from,
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
    TRY(doubles(&to->heading_time, to->n_headings));
    TRY(doubles(&to->heading, to->n_headings));
    for (int i = 0; i < to->n_headings; i++) {
        to->heading_time[i] = control->desired_heading.value[2 * i];
        to->heading[i] = angle_radians(control->desired_heading.value[2 * i + 1]);
    }
    to->n_waypoints = control->waypoints.n;
    TRY(doubles(&to->waypoint_x, to->n_waypoints));
    TRY(doubles(&to->waypoint_y, to->n_waypoints));
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
    fish->sheet_smoothing = parameters->wake.sheet_smoothing * fish->length;
    fish->taper = parameters->wake.taper * fish->length;
    fish->taper_beside = parameters->wake.taper_beside * fish->length;
    TRY(fish_allocate(fish));
    shape_edges(fish, from);
    weigh_body(fish, from);
    set_wave(fish, from);
    TRY(set_table(fish, &from->wave.table));
    set_fluid_forces(fish, from, &parameters->fluid);
    TRY(place_sheet(fish, &parameters->wake));
    TRY(set_pressure(fish, from, parameters->fluid.density));
    set_motion(fish, from);
    return set_control(fish, from, parameters);
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

// of one wall the fluid is where the first nose begins
static void set_walls(struct school *school, const struct school_parameters *parameters) {
    const struct number_list *const walls = &parameters->fluid.walls;
    school->walls.n = walls->n;
    for (int i = 0; i < walls->n; i++) {
        school->walls.y[i] = walls->value[i];
        school->walls.inward[i] = i == 0 ? 1 : -1;
    }
    if (walls->n == 1 && parameters->fish[0].start_position[1] < walls->value[0]) school->walls.inward[0] = -1;
}

static void set_fluid(struct school *school, const struct school_parameters *parameters) {
    school->density = parameters->fluid.density;
    school->velocity[0] = parameters->fluid.velocity[0];
    school->velocity[1] = parameters->fluid.velocity[1];
    school->shear = parameters->fluid.shear;
    // the gust blows to the left of the stream, along y where there is none
    const double stream = hypot(school->velocity[0], school->velocity[1]);
    const double along[2] = {stream > 0 ? school->velocity[0] / stream : 1,
                             stream > 0 ? school->velocity[1] / stream : 0};
    school->gust[0] = -parameters->fluid.gust_amplitude * along[1];
    school->gust[1] = parameters->fluid.gust_amplitude * along[0];
    school->gust_omega = 2 * pi * parameters->fluid.gust_frequency;
    set_walls(school, parameters);
    school->interval = parameters->shedding_interval;
    school->lifetime = parameters->wake.lifetime;
    school->decay = parameters->wake.decay;
    school->shedding = parameters->wake.shedding;
    school->kutta = parameters->wake.kutta;
    school->kutta_ramp = parameters->wake.kutta_ramp;
    school->removed = parameters->wake.dissipated_circulation;
    school->wake_tolerance = parameters->wake.tolerance;
    school->wake_merge = parameters->wake.merge;
    school->contact = parameters->contact.action;
    school->rtol = parameters->rtol;
    school->threads = parameters->threads;
    double longest = 0;
    for (int f = 0; f < parameters->n_fish; f++) longest = fmax(longest, parameters->fish[f].length);
    school->coupling_distance = parameters->coupling_distance * longest;
    school->contact_range = parameters->contact.range * longest;
}

static enum status refuse_overlap(const struct school *school) {
    double *y = calloc((size_t)school->n_unknowns, sizeof *y);
    if (!y) return status_fail(STATUS_MEMORY, "out of memory: %d unknowns", school->n_unknowns);
    enum status status = STATUS_OK;
    for (int f = 0; f < school->n_fish && status == STATUS_OK; f++) {
        fish_start(&school->fish[f], y);
        if (fish_wall_distance(school, &school->fish[f], y) <= 0) {
            status = status_fail(STATUS_CASE,
                                 "error: fish[%d] (%s) touches a wall or is beyond it at the start: change "
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

static void set_contact(const struct school *school, struct fish *fish) {
    const double rate = fish_rate(school, fish);
    fish->contact_strength = fish->total_mass * fish->length * rate * rate;
}

enum status fish_school_create(struct school **school, const struct school_parameters *parameters) {
    struct school *new = calloc(1, sizeof *new);
    *school = NULL;
    if (!new) goto no_memory;
    new->fish = calloc((size_t)parameters->n_fish, sizeof *new->fish);
    if (!new->fish) goto no_memory;
    new->n_fish = parameters->n_fish;
    set_fluid(new, parameters);
    for (int f = 0; f < new->n_fish; f++) {
        if (fish_fill(&new->fish[f], parameters, &parameters->fish[f]) != STATUS_OK) goto failed;
        struct fish *const fish = &new->fish[f];
        const int n_momenta = fish->force == FORCE_PRESSURE ? fish->n_nodes : 0;
        fish->at = layout_after(new->n_unknowns, fish->n_nodes, n_momenta, fish->n_sheet);
        fish->friction_speed = 1e-4 * fish->length * fish_rate(new, fish);
        new->n_unknowns = fish->at.end;
        set_contact(new, fish);
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

int fish_has_momentum(const struct fish *fish) {
    return fish->at.px < fish->at.ax;
}

double fish_rate(const struct school *school, const struct fish *fish) {
    if (fish->frequency > 0) return fish->frequency;
    const double drift = hypot(school->velocity[0], school->velocity[1]);
    const double speed = fmax(fmax(fabs(fish->start_speed), fabs(fish->motion.speed)), drift);
    return speed > 0 ? speed / fish->length : 1;
}

int fish_n_prescribed(const struct fish *fish) {
    switch (fish->motion.prescribed) {
        case PRESCRIBED_NONE: return 0;
        case PRESCRIBED_HEAD: return fish->has_clamp ? 1 : 2;
        case PRESCRIBED_ALL: return fish->n_nodes;
    }
    return 0;
}

int fish_is_prescribed(const struct fish *fish, int k, int i) {
    return k < fish_n_prescribed(fish) && (i == 1 || fish->motion.surge == SURGE_GIVEN);
}

// angle of the heading of the prescribed motion, its rate and the rate of that
static void prescribed_heading(const struct fish *fish, double t, double heading[3]) {
    const struct motion *motion = &fish->motion;
    const double omega = motion->omega, angle = omega * t + motion->phase, pitch_angle = angle + motion->pitch_phase;
    heading[0] = fish->start_heading + motion->pitch * sin(pitch_angle);
    heading[1] = motion->pitch * omega * cos(pitch_angle);
    heading[2] = -omega * omega * motion->pitch * sin(pitch_angle);
}

void fish_prescribed_direction(const struct fish *fish, double t, double direction[2], double *rate) {
    double heading[3];
    prescribed_heading(fish, t, heading);
    direction[0] = -cos(heading[0]);
    direction[1] = -sin(heading[0]);
    *rate = heading[1];
}

void fish_prescribed_node(const struct fish *fish, int k, double t, double position[2], double velocity[2],
                          double acceleration[2]) {
    const struct motion *motion = &fish->motion;
    const double ahead[2] = {cos(fish->start_heading), sin(fish->start_heading)}, left[2] = {-ahead[1], ahead[0]};
    const double omega = motion->omega;
    const double angle = omega * t + motion->phase;
    const double heave = motion->heave * sin(angle), heave_rate = motion->heave * omega * cos(angle);
    const double heave_change = -omega * omega * heave;
    double heading[3];
    prescribed_heading(fish, t, heading);
    const double rate = heading[1], rate_change = heading[2];
    const double along[2] = {cos(heading[0]), sin(heading[0])}, across[2] = {-along[1], along[0]};
    const double arm = motion->pivot - fish->arc[k];
    for (int i = 0; i < 2; i++) {
        position[i] =
            fish->start_position[i] + (motion->speed * t - motion->pivot) * ahead[i] + heave * left[i] + arm * along[i];
        velocity[i] = motion->speed * ahead[i] + heave_rate * left[i] + arm * rate * across[i];
        acceleration[i] = heave_change * left[i] + arm * (rate_change * across[i] - rate * rate * along[i]);
    }
}

void fish_prescribe(const struct fish *fish, int at_start, double t, double *y) {
    const int n = at_start ? fish->n_nodes : fish_n_prescribed(fish);
    for (int k = 0; k < n; k++) {
        double position[2], velocity[2], acceleration[2];
        fish_prescribed_node(fish, k, t, position, velocity, acceleration);
        for (int i = 0; i < 2; i++) {
            if (!at_start && !fish_is_prescribed(fish, k, i)) continue;
            y[fish->at.x + i * fish->n_nodes + k] = position[i];
            y[fish->at.vx + i * fish->n_nodes + k] = velocity[i];
        }
    }
}

struct fish_gait fish_own_gait(const struct fish *fish, double t) {
    return (struct fish_gait){.amplitude = ramp_value(t, fish->ramp),
                              .amplitude_rate = ramp_rate(t, fish->ramp),
                              .angle = fish->omega * t,
                              .omega = fish->omega};
}

struct fish_demand fish_demand(const struct fish *fish, int j, const struct fish_gait *gait) {
    const double phase = fish->wave_phase[j] + gait->angle;
    if (fish->n_harmonics == 0) return (struct fish_demand){.sine = sin(phase), .sine_rate = gait->omega * cos(phase)};
    const double *const harmonic = &fish->harmonic[2 * j * fish->n_harmonics];
    struct fish_demand demand = {.sine = 0};
    for (int m = 0; m < fish->n_harmonics; m++) {
        const double c = cos(m * phase), s = sin(m * phase), a = harmonic[2 * m], b = harmonic[2 * m + 1];
        demand.angle += a * c + b * s;
        demand.angle_rate += m * gait->omega * (b * c - a * s);
    }
    return demand;
}

double fish_natural_angle(const struct fish *fish, int j, const struct fish_gait *gait, double phi0) {
    const struct fish_demand demand = fish_demand(fish, j, gait);
    const double angle = gait->amplitude * fish->wave_amplitude[j] * (demand.sine + phi0);
    return fish->n_harmonics == 0 ? angle : angle + gait->amplitude * demand.angle;
}

double fish_largest_turn(const struct fish *fish, double amplitude, double bias) {
    double largest = 0;
    for (int j = 0; j < fish->n_joints; j++) {
        double beat = fish->n_harmonics == 0 ? fabs(fish->wave_amplitude[j]) : 0;
        const double *const harmonic = &fish->harmonic[2 * j * fish->n_harmonics];
        for (int m = 0; m < fish->n_harmonics; m++) beat += hypot(harmonic[2 * m], harmonic[2 * m + 1]);
        largest = fmax(largest, fabs(amplitude) * (beat + fabs(fish->wave_amplitude[j] * bias)));
    }
    return largest;
}

void fish_start(const struct fish *fish, double *y) {
    double *const x = y + fish->at.x, *const z = y + fish->at.y;
    if (fish->motion.prescribed != PRESCRIBED_NONE) {
        // the free nodes downstream of a prescribed head start with its rigid motion
        fish_prescribe(fish, 1, 0, y);
        return;
    }
    // the bias of a controlled fish is not known yet: its pose is that of zero bias
    const double bias = fish->control.law == CONTROL_NONE ? fish->control.bias : 0;
    const struct fish_gait gait = fish_own_gait(fish, 0);
    double angle = fish->start_heading - pi;
    x[0] = fish->start_position[0];
    z[0] = fish->start_position[1];
    for (int k = 0; k < fish->n_edges; k++) {
        if (k > 0) angle += fish_natural_angle(fish, k - 1, &gait, bias);
        x[k + 1] = x[k] + fish->edge_length * cos(angle);
        z[k + 1] = z[k] + fish->edge_length * sin(angle);
    }
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = fish->start_speed * cos(fish->start_heading);
        y[fish->at.vy + k] = fish->start_speed * sin(fish->start_heading);
    }
}

// distance of the point p from the segment a b
static double point_to_segment(const double p[2], const double a[2], const double b[2]) {
    const double e[2] = {b[0] - a[0], b[1] - a[1]}, r[2] = {p[0] - a[0], p[1] - a[1]};
    const double square = e[0] * e[0] + e[1] * e[1];
    double q = square > 0 ? (r[0] * e[0] + r[1] * e[1]) / square : 0;
    q = fmin(1, fmax(0, q));
    return hypot(r[0] - q * e[0], r[1] - q * e[1]);
}

double fish_point_distance(const struct fish *fish, const double *y, const double p[2]) {
    double min = INFINITY;
    for (int k = 0; k < fish->n_edges; k++) {
        const double a[2] = {y[fish->at.x + k], y[fish->at.y + k]};
        const double b[2] = {y[fish->at.x + k + 1], y[fish->at.y + k + 1]};
        min = fmin(min, point_to_segment(p, a, b) - fish->thickness[k] / 2);
    }
    return min;
}

double fish_wall_distance(const struct school *school, const struct fish *fish, const double *y) {
    double min = INFINITY;
    for (int k = 0; k < fish->n_nodes; k++) {
        // the thicker one of the edges that meet at the node
        const double before = k > 0 ? fish->thickness[k - 1] : 0, after = k < fish->n_edges ? fish->thickness[k] : 0;
        min = fmin(min, images_distance(&school->walls, y[fish->at.y + k]) - fmax(before, after) / 2);
    }
    return min;
}

static double cross(const double a[2], const double b[2], const double c[2]) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double segment_to_segment(const double a[2], const double b[2], const double c[2], const double d[2]) {
    if (cross(a, b, c) * cross(a, b, d) < 0 && cross(c, d, a) * cross(c, d, b) < 0) return 0;
    return fmin(fmin(point_to_segment(a, c, d), point_to_segment(b, c, d)),
                fmin(point_to_segment(c, a, b), point_to_segment(d, a, b)));
}

// the gap between two intervals, negative where they overlap; each the extent of some numbers and a margin
static double gap(int n, const double *x, double margin, int m, const double *y, double other_margin) {
    double low = x[0], high = x[0], other_low = y[0], other_high = y[0];
    for (int i = 1; i < n; i++) {
        low = x[i] < low ? x[i] : low;
        high = x[i] > high ? x[i] : high;
    }
    for (int i = 1; i < m; i++) {
        other_low = y[i] < other_low ? y[i] : other_low;
        other_high = y[i] > other_high ? y[i] : other_high;
    }
    return fmax(other_low - high, low - other_high) - margin - other_margin;
}

static double max_half_thickness(const struct fish *fish) {
    double max = 0;
    for (int k = 0; k < fish->n_edges; k++) max = fmax(max, fish->thickness[k] / 2);
    return max;
}

double fish_distance(const struct fish *a, const struct fish *b, const double *y, double limit) {
    // the boxes around the bodies exclude most pairs of a school
    const double margin = max_half_thickness(a), other = max_half_thickness(b);
    if (gap(a->n_nodes, y + a->at.x, margin, b->n_nodes, y + b->at.x, other) > limit ||
        gap(a->n_nodes, y + a->at.y, margin, b->n_nodes, y + b->at.y, other) > limit) {
        return INFINITY;
    }
    double min = INFINITY;
    for (int i = 0; i < a->n_edges; i++) {
        const double p[2] = {y[a->at.x + i], y[a->at.y + i]}, q[2] = {y[a->at.x + i + 1], y[a->at.y + i + 1]};
        const double length = fabs(q[0] - p[0]) + fabs(q[1] - p[1]);
        for (int j = 0; j < b->n_edges; j++) {
            const double r[2] = {y[b->at.x + j], y[b->at.y + j]}, s[2] = {y[b->at.x + j + 1], y[b->at.y + j + 1]};
            const double thickness = (a->thickness[i] + b->thickness[j]) / 2;
            // no point of an edge is further from its first node than it is long
            const double reach = min + thickness + length + fabs(s[0] - r[0]) + fabs(s[1] - r[1]);
            const double dx = r[0] - p[0], dy = r[1] - p[1];
            if (dx * dx + dy * dy > reach * reach) continue;
            min = fmin(min, segment_to_segment(p, q, r, s) - thickness);
        }
    }
    return fmax(0, min);
}
