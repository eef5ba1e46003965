/* fish_school.c: fluid, fish, the order of the unknowns; check for overlaps at the start. */
#include "fish/fish_school.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathematics.h"
#include "base/memory.h"
#include "fish/fish.h"
#include "fish/fish_motion.h"
#include "fish/shape.h"

// ---- constants of every edge, joint and node: doc/model.md, sections 1, 3 and 9

static enum status body_allocate(struct fish *fish) {
    double **const per_node[] = {&fish->arc, &fish->mass};
    double **const per_edge[] = {
        &fish->thickness,       &fish->depth,          &fish->square,          &fish->cube,
        &fish->axial_stiffness, &fish->axial_damping,  &fish->drag_tangential, &fish->drag_normal,
        &fish->added_mass,      &fish->displaced_mass, &fish->drag_turbulent,  &fish->past_transition};

    double **const per_joint[] = {&fish->bending_stiffness, &fish->bending_damping};
    TRY(MEMORY_ARRAYS(per_node, fish->n_nodes, "the nodes of a fish"));
    TRY(MEMORY_ARRAYS(per_edge, fish->n_edges, "the edges of a fish"));

    return MEMORY_ARRAYS(per_joint, fish->n_joints, "the joints of a fish");
}

/* Fish that share a shape with one of the SHARED fish before them also share the cost of the shape. The search is
 * bounded, so that the set-up grows linearly with the number of fish. */
enum { SHARED = 64 };

static int same_outline(const struct fish_parameters *a, const struct fish_parameters *b) {
    const double of_a[] = {a->length, a->body.thickness, a->body.depth, a->body.tail_thickness},
                 of_b[] = {b->length, b->body.thickness, b->body.depth, b->body.tail_thickness};
    return a->body.profile == PROFILE_JOUKOWSKI && b->body.profile == PROFILE_JOUKOWSKI && a->nodes == b->nodes &&
           a->body.section == b->body.section && memcmp(of_a, of_b, sizeof of_a) == 0;
}

// fish f of an array of fish
static void edges_shape(struct fish *fish, int f, const struct fish_parameters *from) {
    fish->has_mean_section = from->body.section == SECTION_MEAN;
    for (int k = 0; k < fish->n_nodes; k++) fish->arc[k] = k * fish->edge_length;
    int back = 1;
    while (back <= f && back <= SHARED && !same_outline(from, from - back)) back++;
    if (back <= f && back <= SHARED) {
        const size_t size = (size_t)fish->n_edges * sizeof *fish->thickness;
        const struct fish *const other = fish - back;
        memcpy(fish->thickness, other->thickness, size);
        memcpy(fish->depth, other->depth, size);
        memcpy(fish->square, other->square, size);
        memcpy(fish->cube, other->cube, size);
        return;
    }

    for (int k = 0; k < fish->n_edges; k++) {
        const struct profile_edge edge = profile_edge(from, k);
        fish->thickness[k] = edge.h;
        fish->depth[k] = edge.w;
        fish->square[k] = edge.square;
        fish->cube[k] = edge.cube;
    }
}

// clamp of a prescribed head: a joint of half the length of other joints. doc/model.md, section 2
static void head_clamp(struct fish *fish, const struct fish_parameters *from, double stiffness, double refinement) {
    const struct body_parameters *body = &from->body;
    fish->has_clamp = from->motion.prescribed == PRESCRIBED_HEAD && body->section == SECTION_MEAN;
    fish->clamp_stiffness = 2 * stiffness / fish->edge_length;
    fish->clamp_damping = 2 * (body->bending_damping * refinement) + body->relaxation_time * fish->clamp_stiffness;
}

// masses, stiffnesses and damping: doc/model.md, sections 1 and 3
static void body_weigh(struct fish *fish, const struct fish_parameters *from) {
    const struct body_parameters *body = &from->body;
    const double reference = fish->length / (from->reference_nodes - 1), refinement = reference / fish->edge_length;
    double moment_before = 0;
    fish->damping = body->damping;

    for (int k = 0; k < fish->n_edges; k++) {
        const double h = fish->thickness[k], w = fish->depth[k], area = M_PI * h * w / 4;
        const double edge_mass = body->density * area * fish->edge_length;
        fish->mass[k] += edge_mass / 2;
        fish->mass[k + 1] += edge_mass / 2;
        fish->total_mass += edge_mass;
        fish->axial_stiffness[k] = body->modulus * area;
        fish->axial_damping[k] = body->stretching_damping * refinement +
                                 body->relaxation_time * fish->axial_stiffness[k] / fish->edge_length;

        const double moment = body->second_moment == SECOND_MOMENT_ELLIPSE
                                  ? M_PI * w * h * h * h / 64 * fish->cube[k]
                                  : body->density * area * reference * w * w / 12;

        if (k > 0) {
            fish->bending_stiffness[k - 1] = body->modulus * (moment_before + moment) / 2;
            fish->bending_damping[k - 1] = body->bending_damping * refinement +
                                           body->relaxation_time * fish->bending_stiffness[k - 1] / fish->edge_length;
        }

        if (k == 0) head_clamp(fish, from, body->modulus * moment, refinement);
        moment_before = moment;
    }

    fish->tail_stiffness = body->modulus * moment_before;
}

// Blasius' friction of both sides of an edge, over u^(3/2)
static double laminar_friction(const struct fish *fish, int k, const struct fluid_parameters *fluid) {
    const double share = sqrt((k + 1.0) / fish->n_edges) - sqrt((double)k / fish->n_edges);
    return 1.328 * fluid->density * fish->depth[k] * sqrt(fluid->viscosity * fish->length) * share;
}

// friction of a turbulent boundary layer on both sides of an edge, over u^(9/5)
static double turbulent_friction(const struct fish *fish, int k, const struct fluid_parameters *fluid) {
    const double share = pow((k + 1.0) / fish->n_edges, 0.8) - pow((double)k / fish->n_edges, 0.8);
    return 0.074 * fluid->density * fish->depth[k] * pow(fluid->viscosity, 0.2) * pow(fish->length, 0.8) * share;
}

// friction of a boundary layer with transition
static void boundary_layer_set(struct fish *fish, const struct drag_parameters *drag,
                               const struct fluid_parameters *fluid) {
    const double at_transition = fluid->viscosity * drag->transition;
    double largest = 0;
    for (int k = 0; k < fish->n_edges; k++) {
        const double place = fish->length * (k + 0.5) / fish->n_edges, past = place / at_transition;
        fish->drag_turbulent[k] = turbulent_friction(fish, k, fluid);
        fish->past_transition[k] = at_transition > 0 ? past * past : INFINITY;
        largest = fmax(largest, fish->thickness[k] / fish->length);
    }

    fish->form = isnan(drag->form) ? 1 + 2 * largest + 60 * largest * largest * largest * largest : drag->form;
}

/* Whether the sheets of the fish consist of vortex rings: force: pressure with span: finite. */
static int fish_is_strip(const struct fish_parameters *from) {
    return from->force == FORCE_PRESSURE && from->span == SPAN_FINITE;
}

// drag, added mass and added mass shed at the tail: doc/model.md, section 9
static void fluid_forces_set(struct fish *fish, const struct fish_parameters *from,
                             const struct fluid_parameters *fluid) {
    fish->viscosity = fluid->viscosity;
    const struct drag_parameters *drag = &from->drag;
    const int wide = from->added_mass.extent == EXTENT_DEPTH, published = from->force == FORCE_PUBLISHED;
    const double density = fluid->density, reactive = from->force == FORCE_PRESSURE ? 0 : 1;

    for (int k = 0; k < fish->n_edges; k++) {
        const double h = fish->thickness[k], w = fish->depth[k], l = fish->edge_length;
        const double across = wide ? w : h, square = wide ? 1 : fish->square[k];
        fish->drag_tangential[k] = drag->friction == FRICTION_QUADRATIC
                                       ? density * M_PI * drag->tangential * l * (h + w) / (published ? 8 : 4)
                                       : laminar_friction(fish, k, fluid);

        // cross-flow drag: of a strip by the suction at the side edges of a lifting surface of the aspect ratio w/L
        const double ratio = w / fish->length, extent = from->force == FORCE_PRESSURE ? w : across;
        const double share = fish_is_strip(from) ? (3.4 + ratio) / (3.4 + ratio * (2.4 + 0.7 * ratio)) : 1;
        fish->drag_normal[k] = density * drag->normal * l * extent / 2 * share;
        fish->added_mass[k] =
            reactive * M_PI * density * from->added_mass.coefficient * across * across * l / 4 * square;
        fish->displaced_mass[k] = reactive * density * M_PI * h * w / 4 * l;
    }

    fish->force = from->force;
    fish->has_cusp = from->body.profile == PROFILE_JOUKOWSKI && from->body.tail_thickness <= 0;
    fish->friction = drag->friction;
    boundary_layer_set(fish, drag, fluid);
    // added mass shed at the tail
    const double at_tail = wide ? fish->depth[fish->n_edges - 1] : profile_tail_thickness(from);
    fish->tail_added_mass =
        published ? 0 : reactive * M_PI * density * from->added_mass.coefficient * at_tail * at_tail / 4;

    // the published law has 1 m s-1
    const double linear_speed = published ? 1 : drag->linear_speed * fish->length * from->wave.frequency;
    fish->linear_speed = drag->law == DRAG_LINEAR_QUADRATIC ? linear_speed : 0;
}

/* Set all data per node, edge and joint except the gait. Numbers of nodes, length and edge_length of the fish are set.
 * Fails with STATUS_MEMORY. */
static enum status fish_body_set(struct fish *fish, int f, const struct fish_parameters *from,
                                 const struct fluid_parameters *fluid) {
    TRY(body_allocate(fish));
    edges_shape(fish, f, from);
    body_weigh(fish, from);
    fluid_forces_set(fish, from, fluid);
    return STATUS_OK;
}

// ---- cosine points on the polygon or the smooth curve: doc/model.md, sections 6, 15 and 18

// sigma at j intervals of the angle from the nose
static double cosine_place(const struct fish *fish, double j) {
    const int last = fish->n_sheet - 1;
    return j == last ? 1 : (1 - cos(M_PI * j / last)) / 2;
}

// sigma of a control point
static double control_place(const struct fish *fish, int c, enum collocation collocation) {
    if (collocation == COLLOCATION_CHEBYSHEV) return cosine_place(fish, c + 0.5);
    return (cosine_place(fish, c) + cosine_place(fish, c + 1)) / 2;
}

static void sheet_set_on_polygon(struct fish *fish, enum collocation collocation) {
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

static enum status sheet_set_on_smooth_curve(struct fish *fish, const struct school_parameters *parameters) {
    const int last = fish->n_sheet - 1;
    for (int j = 0; j <= last; j++) {
        TRY(status_ask(parameters->stop));
        const double u = cosine_place(fish, j) * fish->n_edges;
        fish->sheet_point[j] = curve_smooth_point(fish->curve, u);
        if (j == 0 || j == last) continue;  // quadrature weight 0
        fish->sheet_slope[j] = curve_smooth_slope(fish->curve, u);
        fish->sheet_weight[j] = fish->length / 2 * sin(M_PI * j / last) * M_PI / last;
    }

    for (int c = 0; c < last; c++) {
        TRY(status_ask(parameters->stop));
        const double u = control_place(fish, c, parameters->sheet.collocation) * fish->n_edges;
        fish->control_point[c] = curve_smooth_point(fish->curve, u);
        fish->control_tangent[c].to = curve_smooth_slope(fish->curve, u);
    }

    fish->tail_tangent.to = curve_smooth_slope(fish->curve, fish->n_edges);
    fish->nose_tangent.to = curve_smooth_slope(fish->curve, 0);
    return STATUS_OK;
}

// add the weights of a point to a matrix by columns
static void add_weights(const struct stencil *point, int row, int n_rows, double *matrix) {
    for (int i = 0; i < point->n; i++) matrix[(long)point->node[i] * n_rows + row] += point->weight[i];
}

static enum status sheet_set_by_node(struct fish *fish) {
    TRY(MEMORY_NEW(fish->sheet_by_node, fish->n_nodes * fish->n_sheet, "the sheet of a fish"));
    for (int j = 0; j < fish->n_sheet; j++) {
        add_weights(&fish->sheet_point[j], j, fish->n_sheet, fish->sheet_by_node);
    }

    for (int i = 0; i < 2; i++) {
        TRY(MEMORY_NEW(fish->control_by_node[i], fish->n_nodes * fish->n_control, "the sheet of a fish"));
        for (int c = 0; c < fish->n_control; c++) {
            const struct tangent *const tangent = &fish->control_tangent[c];
            if (i == 1 && tangent->from.n > 0) continue;
            add_weights(i == 0 ? &fish->control_point[c] : &tangent->to, c, fish->n_control, fish->control_by_node[i]);
        }
    }

    return STATUS_OK;
}

// set E_c, for a sheet with the vortex strength of the wake at the tail
static void end_correction_set(struct fish *fish) {
    const int last = fish->n_sheet - 1;
    const double h = M_PI / last, weight = fish->length / 2 * h * sin(M_PI * (last - 1) / last);
    for (int c = 0; c < fish->n_control; c++) {
        const double place = cosine_place(fish, c + 0.5);
        double quadrature = 0;
        for (int j = 1; j < last; j++) {
            const double sigma = cosine_place(fish, j);
            quadrature += h / 2 * sin(j * h) * sigma / (2 * M_PI * (place - sigma));
        }

        const double exact = (place * log(place / (1 - place)) - 1) / (2 * M_PI);
        fish->end_correction[c] = (exact - quadrature) / weight;
    }
}

// bound vortices and control points: doc/model.md, section 6
static enum status sheet_set(struct fish *fish, const struct school_parameters *parameters) {
    const struct sheet_parameters *const sheet = &parameters->sheet;
    for (int j = 1; j < fish->n_sheet; j++) {
        const double distance = cosine_place(fish, j) - cosine_place(fish, j - 1);
        fish->sheet_weight[j - 1] += distance * fish->length / 2;
        fish->sheet_weight[j] += distance * fish->length / 2;
    }

    // place the points on the line of the body
    const int is_smooth = sheet->curve == BODY_LINE_SMOOTH;
    TRY(curve_create(&fish->curve, fish->n_nodes, is_smooth ? 1 : 2 * fish->n_sheet,
                     is_smooth ? 4 * fish->n_sheet + 1 : 0));

    if (is_smooth) {
        TRY(sheet_set_on_smooth_curve(fish, parameters));
    } else {
        sheet_set_on_polygon(fish, sheet->collocation);
    }

    TRY(sheet_set_by_node(fish));
    if (parameters->wake.shedding == SHEDDING_SHEET) end_correction_set(fish);
    fish->heading_point = curve_polygon_point(fish->curve, 1.0 / 3.0 * fish->n_edges);
    return STATUS_OK;
}

// w and dw/du at u: monotone cubics between edge midpoints, slope 0 at both ends, constant beyond
static void school_strip_depth_at(const struct fish *fish, double u, double *depth, double *slope) {
    const double *const w = fish->depth, from = fmin(fmax(u - 0.5, 0), fish->n_edges - 1);
    const int k = (int)fmin(from, fish->n_edges - 2);
    double tangent[2] = {0, 0};

    for (int end = 0; end < 2; end++) {
        const int i = k + end;
        if (i == 0 || i == fish->n_edges - 1) continue;
        const double before = w[i] - w[i - 1], after = w[i + 1] - w[i];
        if (before * after > 0) tangent[end] = 2 * before * after / (before + after);
    }

    const double q = from - k, rise = w[k + 1] - w[k];
    const double c2 = 3 * rise - 2 * tangent[0] - tangent[1], c3 = tangent[0] + tangent[1] - 2 * rise;
    *depth = w[k] + q * (tangent[0] + q * (c2 + q * c3));
    *slope = u <= 0.5 || u >= fish->n_edges - 0.5 ? 0 : tangent[0] + q * (2 * c2 + 3 * q * c3);
}

static double strip_half(const struct fish *fish, double u) {
    double depth, slope;
    school_strip_depth_at(fish, u, &depth, &slope);
    return depth * depth / 32;
}

// the strip of the sheets of the body: doc/model.md, section 18
static enum status strip_set(struct fish *fish) {
    const int n_points = fish->n_control + fish->n_edges + 1;
    TRY(MEMORY_NEW(fish->sheet_half, fish->n_sheet, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->point_half, n_points, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->control_widening, fish->n_control, "the sheet of a fish"));
    fish->strip_depth = fish->depth[fish->n_edges - 1];
    for (int k = 0; k < fish->n_edges; k++) fish->depth_varies |= fabs(fish->depth[k] - fish->strip_depth) > 0;
    for (int j = 0; j < fish->n_sheet; j++)
        fish->sheet_half[j] = strip_half(fish, cosine_place(fish, j) * fish->n_edges);

    for (int c = 0; c < fish->n_control; c++) {
        double depth, slope;
        school_strip_depth_at(fish, cosine_place(fish, c + 0.5) * fish->n_edges, &depth, &slope);
        fish->point_half[c] = depth * depth / 32;
        fish->control_widening[c] = depth * slope / 16;
    }

    for (int k = 0; k < fish->n_edges; k++) fish->point_half[fish->n_control + k] = strip_half(fish, k + 0.5);
    fish->point_half[n_points - 1] = strip_half(fish, fish->n_edges);
    return STATUS_OK;
}

// integrals over the sheet: of an earlier fish with the same nodes, sheet and densities, or new
static enum status integrals_set(struct fish *fish, int f, const double *density, const volatile sig_atomic_t *stop) {
    for (int back = 1; back <= f && back <= SHARED; back++) {
        const struct fish *const other = fish - back;
        if (!other->integrals || other->n_nodes != fish->n_nodes || other->n_sheet != fish->n_sheet) continue;
        if (memcmp(other->edge_density, density, (size_t)fish->n_edges * sizeof *density) != 0) continue;
        fish->integrals = other->integrals;
        fish->shares_integrals = 1;
        return STATUS_OK;
    }
    return sheet_integrals_create(&fish->integrals, fish->n_nodes, fish->n_sheet, density, stop);
}

// the pressure of the bound sheet: doc/model.md, section 15
static enum status pressure_set(struct fish *fish, int f, const struct fish_parameters *from,
                                const struct school_parameters *parameters, int is_strip) {
    const double density = parameters->fluid.density;
    if (fish->force != FORCE_PRESSURE && !is_strip) return STATUS_OK;
    const double h = M_PI / fish->n_control;
    if (is_strip) TRY(strip_set(fish));
    TRY(MEMORY_NEW(fish->edge_density, fish->n_edges, "the pressure of a fish"));
    double *const per_edge = fish->edge_density;
    for (int k = 0; k < fish->n_edges; k++) per_edge[k] = density * (is_strip ? fish->strip_depth : fish->depth[k]);

    for (int c = 0; c < fish->n_control; c++) {
        fish->control_density[c] = per_edge[(int)(cosine_place(fish, c + 0.5) * fish->n_edges)];
        fish->control_interval[c] = fish->n_edges / 2.0 * sin((c + 0.5) * h) * h;
    }

    fish->fluid_density = density;
    fish->nose_factor = fish->n_control * fish->sheet_weight[0] / (M_PI * fish->length);
    // the unknowns of a strip are circulations times w(s)/w_L
    if (is_strip) fish->nose_factor *= fish->strip_depth / fish->depth[0];
    fish->full_suction = M_PI * (density * fish->depth[0]) * fish->length;
    fish->suction = from->suction * fish->full_suction;
    fish->suction_limit = from->suction_limit;
    return integrals_set(fish, f, per_edge, parameters->stop);
}

/* Set all data per vortex and per control point. Numbers of nodes and points, length and depth of the fish are set.
 * Fails with STATUS_MEMORY. */
static enum status fish_sheet_set(struct fish *fish, int f, const struct school_parameters *parameters, int is_strip) {
    const struct fish_parameters *const from = &parameters->fish[f];

    // reserve the sheet
    double **const per_control[] = {&fish->end_correction, &fish->control_density, &fish->control_interval};
    TRY(MEMORY_NEW(fish->sheet_weight, fish->n_sheet, "the sheet of a fish"));
    TRY(MEMORY_ARRAYS(per_control, fish->n_control, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->sheet_point, fish->n_sheet, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->sheet_slope, fish->n_sheet, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->control_point, fish->n_control, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->control_tangent, fish->n_control, "the sheet of a fish"));

    TRY(sheet_set(fish, parameters));
    return pressure_set(fish, f, from, parameters, is_strip);
}

int fish_sheet_least(const struct fish_parameters *from) {
    if (!fish_is_strip(from)) return 0;
    double depth = from->body.depth * from->length;
    for (int k = 0; from->body.profile == PROFILE_TABLE && k < from->body.depth_table.n; k++) {
        depth = k == 0 ? from->body.depth_table.value[0] : fmin(depth, from->body.depth_table.value[k]);
    }

    const double least = ceil(1 + 5 * from->length / depth * (1 - 1e-9));
    // NaN: the depth was not read
    return isnan(least) ? 0 : (int)fmin(least, 1e9);
}

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
    to->slow = fish->period > 0 ? control->slow * fish->length / fish->period : 0;
    to->course_share = -expm1(-parameters->shedding_interval / control->course_filter);
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

// fish f of an array of fish
static enum status fish_fill(struct fish *fish, int f, const struct school_parameters *parameters) {
    const struct fish_parameters *const from = &parameters->fish[f];
    TRY(memory_copy_string(&fish->name, from->name, "the name of a fish"));
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
    TRY(fish_body_set(fish, f, from, &parameters->fluid));
    TRY(fish_gait_set(fish, from));
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

// the direction of the stream, along x without a stream
static void stream_direction(const struct school *school, double along[2]) {
    const double stream = hypot(school->velocity[0], school->velocity[1]);
    along[0] = stream > 0 ? school->velocity[0] / stream : 1;
    along[1] = stream > 0 ? school->velocity[1] / stream : 0;
}

static void fluid_set(struct school *school, const struct school_parameters *parameters) {
    school->density = parameters->fluid.density;
    school->velocity[0] = parameters->fluid.velocity[0];
    school->velocity[1] = parameters->fluid.velocity[1];
    school->shear = parameters->fluid.shear;

    // the gust blows to the left of the stream, along y without a stream
    double along[2];
    stream_direction(school, along);
    school->gust[0] = -parameters->fluid.gust_amplitude * along[1];
    school->gust[1] = parameters->fluid.gust_amplitude * along[0];
    school->gust_omega = 2 * M_PI * parameters->fluid.gust_frequency;
    school->gust_profile = parameters->fluid.gust_profile;
    if (school->gust_profile != GUST_UNIFORM) {
        memcpy(school->gust_along, along, sizeof along);
        school->gust_omega = 0;
        school->gust_speed = parameters->fluid.gust_speed;
        school->gust_number = school->gust_profile == GUST_SINE ? 2 * M_PI / parameters->fluid.gust_wavelength : 0;
        school->gust_position = parameters->fluid.gust_position;
        school->gust_gradient_distance = parameters->fluid.gust_gradient_distance;
    }

    walls_set(school, parameters);
    school->interval = parameters->shedding_interval;
    find_ratio(school->interval, school->interval_ratio);
    school->lifetime = parameters->wake.lifetime.seconds;
    school->decay = parameters->wake.decay.seconds;
    school->shedding = parameters->wake.shedding;
    school->kutta = parameters->sheet.kutta;
    school->kutta_ramp = parameters->sheet.kutta_ramp;
    school->removed = parameters->wake.removed_circulation;
    for (int f = 0; f < parameters->n_fish; f++) school->finite |= fish_is_strip(&parameters->fish[f]);
    school->wake_tolerance = parameters->wake.tolerance;
    school->wake_merge = parameters->wake.merge;
    school->wake_spare =
        parameters->wake.spare + WAKE_PER_VORTEX * (parameters->wake.vortices.n + parameters->wake.street.n);
    school->contact = parameters->contact.action;
    school->threads = parameters->threads;
    double longest = 0;
    for (int f = 0; f < parameters->n_fish; f++) longest = fmax(longest, parameters->fish[f].length);
    school->coupling_distance = parameters->coupling_distance * longest;
    school->contact_range = parameters->contact.range * longest;
}

// sensors, and the nose of an ellipse of the largest thickness
static enum status sensors_set(struct fish *fish, const struct number_list *sensors) {
    double largest = 0;
    for (int k = 0; k < fish->n_edges; k++) largest = fmax(largest, fish->thickness[k]);
    fish->nose_radius = largest * largest / (2 * fish->length);

    if (sensors->n == 0) return STATUS_OK;
    TRY(MEMORY_NEW(fish->sensor, sensors->n, "the sensors of a fish"));
    memcpy(fish->sensor, sensors->value, (size_t)sensors->n * sizeof *fish->sensor);
    fish->n_sensors = sensors->n;
    return STATUS_OK;
}

// the vortices of a street along a direction, upstream first: the even ones in the row on the left
static void street_set(const struct street_parameters *street, const double along[2], double *vortices) {
    for (int i = 0; i < street->n; i++) {
        const double left = i % 2 == 0 ? 1 : -1, across = left * street->row_distance / 2;
        const double ahead = (i - (street->n - 1) / 2.0) * street->spacing / 2;
        vortices[3 * i] = street->position[0] + ahead * along[0] - across * along[1];
        vortices[3 * i + 1] = street->position[1] + ahead * along[1] + across * along[0];
        vortices[3 * i + 2] = -left * street->circulation;
    }
}

static enum status vortices_set(struct school *school, const struct wake_parameters *wake) {
    const struct number_list *const list = &wake->vortices;
    const int n = list->n + wake->street.n;
    if (n == 0) return STATUS_OK;
    TRY(MEMORY_NEW(school->vortices, 3 * n, "vortices at the start"));
    if (list->n > 0) memcpy(school->vortices, list->value, 3 * (size_t)list->n * sizeof *school->vortices);
    double along[2];
    stream_direction(school, along);
    street_set(&wake->street, along, school->vortices + 3 * (long)list->n);
    school->n_vortices = n;
    return STATUS_OK;
}

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

// find the overlapping fish f and g < f with the least f; sort the boxes along the longer side of the school
static int find_overlap(const struct school *school, const double *y, struct place *place, int *g) {
    const int n = school->n_fish;
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

    int found = n;
    for (int i = 0; i < n; i++) {
        for (int j = i + 1; j < n && place[j].from <= place[i].box.high[axis]; j++) {
            const int first = place[i].fish < place[j].fish ? place[i].fish : place[j].fish;
            const int last = place[i].fish + place[j].fish - first;
            if (last > found || (last == found && first > *g) || box_gap(&place[i].box, &place[j].box) > 0) continue;
            if (fish_distance(&school->fish[last], &school->fish[first], y, 0) > 0) continue;
            found = last;
            *g = first;
        }
    }
    return found;
}

static enum status refuse_overlap(const struct school *school) {
    double *y;
    struct place *place;
    TRY(MEMORY_NEW(y, school->n_unknowns, "the unknowns"));
    enum status status = MEMORY_NEW(place, school->n_fish, "the places of the fish");

    for (int f = 0; f < school->n_fish && status == STATUS_OK; f++) {
        fish_start(&school->fish[f], y);
        if (fish_wall_distance(school, &school->fish[f], y, NULL) > 0) continue;
        status = status_fail(STATUS_CASE,
                             "error: fish[%d] (%s) touches a wall or is outside the fluid at the start: change "
                             "start.position or fluid.walls",
                             f, school->fish[f].name);
    }

    int g = 0;
    const int f = status == STATUS_OK ? find_overlap(school, y, place, &g) : school->n_fish;
    if (f < school->n_fish) {
        status = status_fail(STATUS_CASE,
                             "error: fish[%d] (%s) and fish[%d] (%s) overlap at the start: change start.position of "
                             "one of them",
                             g, school->fish[g].name, f, school->fish[f].name);
    }

    free(place);
    free(y);
    return status;
}

enum status fish_school_create(struct school **school, const struct school_parameters *parameters) {
    struct school *new;
    *school = NULL;
    TRY(MEMORY_NEW(new, 1, "a school"));
    enum status status = MEMORY_NEW(new->fish, parameters->n_fish, "the fish of a school");
    if (status != STATUS_OK) goto failed;
    new->n_fish = parameters->n_fish;
    fluid_set(new, parameters);
    status = vortices_set(new, &parameters->wake);
    for (int f = 0; f < new->n_fish &&status == STATUS_OK; f++) {
        status = fish_fill(&new->fish[f], f, parameters);
        if (status != STATUS_OK) goto failed;
        struct fish *const fish = &new->fish[f];
        if (sensors_set(fish, &parameters->fish[f].sensors) != STATUS_OK) goto failed;
        const int n_momenta = fish->force == FORCE_PRESSURE ? fish->n_nodes : 0;
        fish->at = layout_after(new->n_unknowns, fish->n_nodes, n_momenta, fish->n_sheet);
        const double rate = fish_rate(new, fish);
        fish->friction_speed = 1e-4 * fish->length * rate;
        const double waving = parameters->fish[f].drag.waving;
        fish->waving = !isnan(waving) ? waving : fish_has_wave(fish) ? 1.5 : 1;
        fish->contact_strength = fish->total_mass * fish->length * rate * rate;
        new->n_unknowns = fish->at.end;
    }
    if (status == STATUS_OK) status = refuse_overlap(new);

    // the sheets take most of the time: last, and until a stop
    int is_strip = 0;
    for (int f = 0; f < new->n_fish; f++) is_strip |= fish_is_strip(&parameters->fish[f]);
    for (int f = 0; f < new->n_fish &&status == STATUS_OK; f++) {
        status = fish_sheet_set(&new->fish[f], f, parameters, is_strip);
    }
    if (status != STATUS_OK) goto failed;
    *school = new;
    return STATUS_OK;

failed:
    fish_school_free(new);
    return status;
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
                               fish->sheet_by_node,
                               fish->control_by_node[0],
                               fish->control_by_node[1],
                               fish->end_correction,
                               fish->edge_density,
                               fish->control_density,
                               fish->control_interval,
                               fish->sheet_half,
                               fish->point_half,
                               fish->control_widening,
                               fish->sensor,
                               fish->control.heading_time,
                               fish->control.heading,
                               fish->control.waypoint_x,
                               fish->control.waypoint_y};

        for (size_t i = 0; i < sizeof owned / sizeof *owned; i++) free(owned[i]);
        curve_free(fish->curve);
        if (!fish->shares_integrals) sheet_integrals_free(fish->integrals);
    }

    free(school->vortices);
    free(school->fish);
    free(school);
}
