/* fish_body.c: sets the constants of every edge, joint and node. doc/model.md, sections 1, 3 and 9. */
#include "fish/fish_body.h"

#include <math.h>
#include <string.h>

#include "fish/fish_school.h"
#include "fish/shape.h"

// masses, stiffnesses and damping: doc/model.md, sections 1 and 3
static void body_weigh(struct fish *fish, const struct fish_parameters *from) {
    const struct body_parameters *const body = &from->body;
    const double reference = fish->length / (from->reference_nodes - 1), refinement = reference / fish->edge_length;
    double moment_before = 0;
    fish->damping = body->damping;

    for (int k = 0; k < fish->n_edges; k++) {
        // an edge: mass and stretching
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
            // the joint before the edge: bending
            fish->bending_stiffness[k - 1] = body->modulus * (moment_before + moment) / 2;
            fish->bending_damping[k - 1] = body->bending_damping * refinement +
                                           body->relaxation_time * fish->bending_stiffness[k - 1] / fish->edge_length;
        } else {
            // clamp of a prescribed head, a joint of half the length of other joints: doc/model.md, section 2
            fish->has_clamp = from->motion.prescribed == PRESCRIBED_HEAD && body->section == SECTION_MEAN;
            fish->clamp_stiffness = 2 * (body->modulus * moment) / fish->edge_length;
            fish->clamp_damping =
                2 * (body->bending_damping * refinement) + body->relaxation_time * fish->clamp_stiffness;
        }
        moment_before = moment;
    }

    fish->tail_stiffness = body->modulus * moment_before;
}

// drag, added mass and added mass shed at the tail: doc/model.md, section 9
static void body_fluid_set(struct fish *fish, const struct fish_parameters *from,
                           const struct fluid_parameters *fluid) {
    const struct drag_parameters *const drag = &from->drag;
    const bool wide = from->added_mass.extent == EXTENT_DEPTH, published = from->force == FORCE_PUBLISHED;
    const double density = fluid->density, reactive = from->force == FORCE_PRESSURE ? 0 : 1;
    const double at_transition = fluid->viscosity * drag->transition, l = fish->edge_length;
    double thickest = 0, largest = 0, surface = 0;
    fish->viscosity = fluid->viscosity;
    fish->force = from->force;
    fish->has_cusp = from->body.profile == PROFILE_JOUKOWSKI && from->body.tail_thickness <= 0;
    fish->friction = drag->friction;
    enum { N_ANGLES = 32 };
    double cosine_square[N_ANGLES];
    for (int i = 0; i < N_ANGLES; i++) {
        const double along = cos(M_PI / 2 * (i + 0.5) / N_ANGLES);
        cosine_square[i] = along * along;
    }

    for (int k = 0; k < fish->n_edges; k++) {
        const double h = fish->thickness[k], w = fish->depth[k];
        const double across = wide ? w : h, square = wide ? 1 : fish->square[k];
        const double from_nose = (double)k / fish->n_edges, to_nose = (k + 1.0) / fish->n_edges;

        // friction of both sides of the edge: quadratic, or Blasius' law over u^(3/2)
        fish->drag_tangential[k] =
            drag->friction == FRICTION_QUADRATIC
                ? density * M_PI * drag->tangential * l * (h + w) / (published ? 8 : 4)
                : 1.328 * density * w * sqrt(fluid->viscosity * fish->length) * (sqrt(to_nose) - sqrt(from_nose));

        // a turbulent boundary layer, over u^(9/5), past the transition
        fish->drag_turbulent[k] = 0.074 * density * w * pow(fluid->viscosity, 0.2) * pow(fish->length, 0.8) *
                                  (pow(to_nose, 0.8) - pow(from_nose, 0.8));
        const double past = fish->length * (k + 0.5) / fish->n_edges / at_transition;
        fish->past_transition[k] = at_transition > 0 ? past * past : INFINITY;

        // cross-flow drag: of a strip by the suction at the side edges of a lifting surface of the aspect ratio w/L
        const double ratio = w / fish->length, extent = from->force == FORCE_PRESSURE ? w : across;
        const double share = fish_is_strip(from) ? (3.4 + ratio) / (3.4 + ratio * (2.4 + 0.7 * ratio)) : 1;
        fish->drag_normal[k] = density * drag->normal * l * extent / 2 * share;
        fish->added_mass[k] =
            reactive * M_PI * density * from->added_mass.coefficient * across * across * l / 4 * square;
        fish->displaced_mass[k] = reactive * density * M_PI * h * w / 4 * l;
        thickest = fmax(thickest, h);

        // S of an ellipse by the midpoint rule for its perimeter
        largest = fmax(largest, fmin(sqrt(h * w), 2 * h) / fish->length);
        for (int i = 0; i < N_ANGLES; i++) {
            surface +=
                M_PI / 2 * sqrt(cosine_square[i] + h / w * (h / w) * (1 - cosine_square[i])) / N_ANGLES / fish->n_edges;
        }
    }

    // form factor, and the nose of an ellipse of the largest thickness
    const double plane = thickest / fish->length;
    const double of_fish = surface * (1 + 1.5 * pow(largest, 1.5) + 7 * pow(largest, 3));
    const double of_wing = 1 + 2 * plane + 60 * pow(plane, 4);
    fish->form = drag->has_form ? drag->form : fish_is_strip(from) ? of_fish : of_wing;
    fish->nose_radius = thickest * thickest / (2 * fish->length);

    // added mass shed at the tail
    const double at_tail = wide ? fish->depth[fish->n_edges - 1] : profile_tail_thickness(from);
    fish->tail_added_mass =
        published ? 0 : reactive * M_PI * density * from->added_mass.coefficient * at_tail * at_tail / 4;

    // the published law has 1 m s-1
    const double linear_speed = published ? 1 : drag->linear_speed * fish->length * from->wave.frequency;
    fish->linear_speed = drag->law == DRAG_LINEAR_QUADRATIC ? linear_speed : 0;
}

void fish_body_set(struct arena *arena, struct fish *fish, int f, const struct fish_parameters *from,
                   const struct fluid_parameters *fluid) {
    double **const per_edge[] = {
        &fish->thickness,       &fish->depth,          &fish->square,          &fish->cube,
        &fish->axial_stiffness, &fish->axial_damping,  &fish->drag_tangential, &fish->drag_normal,
        &fish->added_mass,      &fish->displaced_mass, &fish->drag_turbulent,  &fish->past_transition};
    for (size_t i = 0; i < sizeof per_edge / sizeof *per_edge; i++) NEW(arena, *per_edge[i], fish->n_edges);
    NEW(arena, fish->arc, fish->n_nodes);
    NEW(arena, fish->mass, fish->n_nodes);
    NEW(arena, fish->bending_stiffness, fish->n_joints);
    NEW(arena, fish->bending_damping, fish->n_joints);
    fish->has_mean_section = from->body.section == SECTION_MEAN;
    for (int k = 0; k < fish->n_nodes; k++) fish->arc[k] = k * fish->edge_length;

    // thickness and depth of the edges: of one of the last fish with the same Joukowski outline, or of the profile
    const struct fish *same = NULL;
    const double outline[] = {from->length, from->body.thickness, from->body.depth, from->body.tail_thickness};
    for (int back = 1; back <= f && back <= FISH_SHARED && !same; back++) {
        const struct fish_parameters *const other = from - back;
        const double its[] = {other->length, other->body.thickness, other->body.depth, other->body.tail_thickness};
        const bool are_joukowski = from->body.profile == PROFILE_JOUKOWSKI && other->body.profile == PROFILE_JOUKOWSKI;
        if (!are_joukowski || other->nodes != from->nodes || other->body.section != from->body.section) continue;
        if (memcmp(outline, its, sizeof outline) == 0) same = fish - back;
    }
    for (int k = 0; k < fish->n_edges; k++) {
        const struct profile_edge edge =
            same ? (struct profile_edge){.h = same->thickness[k], same->depth[k], same->square[k], same->cube[k]}
                 : profile_edge(from, k);
        fish->thickness[k] = edge.h;
        fish->depth[k] = edge.w;
        fish->square[k] = edge.square;
        fish->cube[k] = edge.cube;
    }
    body_weigh(fish, from);
    body_fluid_set(fish, from, fluid);
}
