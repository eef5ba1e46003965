/* fish_body.c: constants of every edge, joint and node. */
#include "fish/fish_body.h"

#include <math.h>

#include "base/memory.h"
#include "fish/profile.h"

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

static void edges_shape(struct fish *fish, const struct fish_parameters *from) {
    fish->has_mean_section = from->body.section == SECTION_MEAN;
    for (int k = 0; k < fish->n_nodes; k++) fish->arc[k] = k * fish->edge_length;
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

// drag, added mass and added mass shed at the tail: doc/model.md, section 9
static void fluid_forces_set(struct fish *fish, const struct fish_parameters *from,
                             const struct fluid_parameters *fluid) {
    const struct drag_parameters *drag = &from->drag;
    const int wide = from->added_mass.extent == EXTENT_DEPTH, published = from->force == FORCE_PUBLISHED;
    const double density = fluid->density, reactive = from->force == FORCE_PRESSURE ? 0 : 1;

    for (int k = 0; k < fish->n_edges; k++) {
        const double h = fish->thickness[k], w = fish->depth[k], l = fish->edge_length;
        const double across = wide ? w : h, square = wide ? 1 : fish->square[k];
        fish->drag_tangential[k] = drag->skin == SKIN_QUADRATIC
                                       ? density * M_PI * drag->tangential * l * (h + w) / (published ? 8 : 4)
                                       : laminar_friction(fish, k, fluid);

        fish->drag_normal[k] = density * drag->normal * l * across / 2;
        fish->added_mass[k] =
            reactive * M_PI * density * from->added_mass.coefficient * across * across * l / 4 * square;
        fish->displaced_mass[k] = reactive * density * M_PI * h * w / 4 * l;
    }

    fish->force = from->force;
    fish->has_cusp = from->body.profile == PROFILE_JOUKOWSKI && from->body.tail_thickness <= 0;
    fish->skin = drag->skin;
    boundary_layer_set(fish, drag, fluid);
    // added mass shed at the tail
    const double at_tail = wide ? fish->depth[fish->n_edges - 1] : profile_tail_thickness(from);
    fish->tail_added_mass =
        published ? 0 : reactive * M_PI * density * from->added_mass.coefficient * at_tail * at_tail / 4;

    // the published law has 1 m s-1
    const double linear_speed = published ? 1 : drag->linear_speed * fish->length * from->wave.frequency;
    fish->linear_speed = drag->law == DRAG_LINEAR_QUADRATIC ? linear_speed : 0;
}

enum status fish_body_set(struct fish *fish, const struct fish_parameters *from, const struct fluid_parameters *fluid) {
    TRY(body_allocate(fish));
    edges_shape(fish, from);
    body_weigh(fish, from);
    fluid_forces_set(fish, from, fluid);
    return STATUS_OK;
}
