/* fish.h: the constant data of fish and school, and the layout of the unknowns of each fish in the vector of all
 * unknowns. doc/model.md, sections 1, 6 and 10. Built by fish_school.h. Tested by tests/fish/test_fish.c.
 *
 * Body: nodes 0 (nose) .. N-1 (tail), edge k from node k to k+1, joint j at node j+1.
 *
 *     node 0    edge 0    node 1    edge 1    node 2            node N-1
 *        o-----------------o-----------------o--- ... ---o--------o
 *      nose              joint 0           joint 1     joint N-3  tail
 *
 * Sheet: bound vortices j = 0 .. M-1 at the cosine points, control points c = 0 .. M-2 between the vortices.
 *
 *        x--o--x---o---x----o----x ...  x--o--x          x vortex, o control point
 *
 * Unknowns: fish after fish, per fish in this order (struct layout gives the first index of each):
 *
 *     | x (N) y (N) | vx (N) vy (N) | px (N) py (N) | ax (N) ay (N) | gamma (M) | circulation (1) | phi0 (1) |
 *
 * The slices px, py exist with force: pressure only (force/pressure.h); otherwise px, py are empty.
 */
#ifndef FISH_H
#define FISH_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/parallel.h"
#include "fish/parameters.h"
#include "fish/shape.h"
#include "fish/sheet_integrals.h"

/* First index of each slice in the vector of all unknowns, and one past the last. The equations have the same layout:
 * rows x, y: dx/dt - v; vx, vy: dv/dt - a; ax, ay: law of motion; sheet: M - 1 times impermeability, then Kelvin;
 * shed: Kutta; phi0: control law. With force: pressure vx, vy: velocity by momentum; px, py: dp/dt - a.
 *
 * Three more places, which depend on the force too:
 *
 *     second     px, or vx without momenta: the pairs whose rate is the acceleration a
 *     full       ax where the sheet loads the body, else gamma: the first row that depends on the whole sheet and,
 *                through it, on all positions; the rows before are sparse
 *     rated      circulation where the sheet loads the body, else gamma: one past the last bound strength whose rate
 *                acts */
struct layout {
    int x, y, vx, vy, px, py, ax, ay, gamma, circulation, phi0, end;
    int second, full, rated;
};

/* A straight rigid motion given in time: doc/model.md, section 5. Angles in rad. */
struct motion {
    enum prescribed prescribed;
    enum surge surge;          /* free: the heading is along x, and prescribed nodes move in x by the forces */
    bool is_held;              /* the motion along the heading is prescribed: surge given, prescribed not none */
    double speed;              /* m s-1 */
    double heave;              /* m */
    double pitch, pitch_phase; /* rad */
    double omega, phase;       /* rad s-1, rad */
    double pivot;              /* m from the nose */
};

/* Control of heading and place: doc/model.md, section 11. Angles in rad. */
struct control_law_data {
    enum control_law law;
    double bias, gain, damping, limit, feedforward;
    double rate;                     /* s-1 */
    double ramp;                     /* of a change from outside, s */
    int n_headings;                  /* table of desired headings, linear in time */
    double *heading_time;            /* s                                           (n_headings) */
    double *heading;                 /* rad                                         (n_headings) */
    int n_waypoints;                 /* visited in order; n_waypoints > 0 replaces the table */
    double *waypoint_x, *waypoint_y; /* m                                        (n_waypoints) */
    double acceptance_radius;        /* m */
    double torque_scale;             /* N m: unit of the feedforward moment */
    double filter_share;             /* weight of the newest moment in the moving mean: 1 - exp(-Dt/T_f) */
    double slow;                     /* u_0 of law course, m s-1 */
    double course_share;             /* weight of the newest rate in the filtered rate: 1 - exp(-Dt/T_c) */

    /* law place */
    int leader;             /* index of the fish whose place counts */
    double nose_offset[2];  /* of the nose from that of the leader, at the leader's first heading, m */
    double offset[2];       /* the same of the centres of mass of straight bodies, m */
    double frame;           /* the leader's heading at the start */
    double gains[2];        /* of the amplitude: by the distance, 1, and by its change in a period, 1 */
    double amplitude_limit; /* largest relative change of the amplitude */
    double lookahead;       /* body lengths */
    double hold_time;       /* periods */
};

struct fish {
    char *name;
    struct layout at;

    int n_nodes, n_edges, n_joints, n_sheet, n_control; /* N, N-1, N-2, M, M-1 */
    double length;                                      /* m */
    double edge_length;                                 /* natural length of every edge, m */
    double frequency;                                   /* of the beat, Hz; 0: none */
    double period;                                      /* averaging period, s; 0: no means */
    double total_mass;                                  /* kg */
    double wake_part;                                   /* lifetime of its wake over that of the school */

    double *arc;               /* arc coordinate of the nodes, m                          (n_nodes) */
    double *mass;              /* kg                                                      (n_nodes) */
    double *thickness;         /* thickness across the plane of motion h, m               (n_edges) */
    double *depth;             /* extent out of that plane w, m                           (n_edges) */
    double *square, *cube;     /* mean of h^2 over thickness^2, of h^3 over thickness^3   (n_edges) */
    bool has_mean_section;     /* means over an edge, otherwise means of both nodes (fish.body.section) */
    double *axial_stiffness;   /* E A, N                                         (n_edges) */
    double *axial_damping;     /* d_s, kg s-1                                    (n_edges) */
    double *bending_stiffness; /* E I, N m2                                      (n_joints) */
    double *bending_damping;   /* d_b, N m s                                    (n_joints) */
    enum damping damping;      /* of the rate of curvature minus natural curvature, or of curvature alone */
    double tail_stiffness;     /* E I of the last edge, N m2 */
    bool has_clamp;            /* prescribed head: a joint at the nose holds the direction of edge 0 */
    double clamp_stiffness;    /* 2 E I/lbar, N m */
    double clamp_damping;      /* N m s */

    double amplitude;       /* A; 0: no change from outside */
    double *wave_amplitude; /* A (lbar/l_ref) (c0 + c1 sigma + c2 sigma^2)        (n_joints) */
    double *wave_phase;     /* beta sigma + phase, rad                            (n_joints) */
    int n_harmonics;        /* of a table instead of the wave: natural turning angles over the phase, rad */
    double *harmonic;       /* cosine and sine of each harmonic from 0 on         (n_joints, n_harmonics, 2) */
    double omega;           /* rad s-1 */
    double ramp;            /* s */

    enum force force;
    double *drag_tangential; /* c_t, kg m-1; Blasius' factor of other friction laws, kg m-0.5 s-0.5        (n_edges) */
    double *drag_normal;     /* c_n, kg m-1                                       (n_edges) */
    double *added_mass;      /* mu, kg                                            (n_edges) */
    double *displaced_mass;  /* rho_f A lbar, kg                                  (n_edges) */
    double tail_added_mass;  /* m_L, kg m-1; 0: no momentum shed at the tail */
    bool has_cusp;           /* whether the outline ends in a cusp: joukowski with tail thickness 0 */
    double linear_speed;     /* V1 of the drag law v (V1 + |v|), m s-1; 0: v |v| */
    enum friction friction;
    double friction_speed;   /* u0 of laminar friction and of a boundary layer, m s-1 */
    double *drag_turbulent;  /* c_T of a boundary layer, kg m-0.8 s-0.2           (n_edges) */
    double *past_transition; /* (x_k/(nu Re_t))^2: 1/(transition speed)^2, s2 m-2                         (n_edges) */
    double form, waving;     /* K_form, K_w of a boundary layer */

    /* force: pressure */
    double fluid_density;        /* kg m-3 */
    double full_suction;         /* pi rho_f w L: of the nose, over velocity squared, kg m-1 */
    double suction;              /* full_suction S, kg m-1 */
    double suction_limit;        /* A_c; 0: none */
    double nose_factor;          /* (M-1) ds_0/(pi L): qhat over the unknown at the nose, 1 */
    double *edge_density;        /* density of the fluid times depth, kg m-2         (n_edges) */
    double *control_density;     /* density of the fluid times depth, kg m-2         (n_control) */
    double *control_interval;    /* u of the interval around a control point, 1      (n_control) */
    struct tangent nose_tangent; /* the direction of the body at the nose */
    int n_sensors;
    double *sensor;                    /* fractions of the length                                  (n_sensors) */
    double viscosity;                  /* kinematic, of the fluid, m2 s-1 */
    double nose_radius;                /* h^2/(2 L) with the largest thickness h, m */
    struct sheet_integrals *integrals; /* shared by equal sheets; NULL with other forces, unless there are rings */

    /* rings: section 18 */
    double strip_depth;       /* w_L, depth of the last edge, m; 0: sheets of infinite span */
    bool depth_varies;        /* whether the depth varies along the body */
    double *sheet_half;       /* b^2/2 at the bound vortices, b = w/4, m2                  (n_sheet) */
    double *point_half;       /* b^2/2 at the points of the flow (flow.h), m2   (n_control + n_edges + 1) */
    double *control_widening; /* b db/du at control points, m2                             (n_control) */

    double *sheet_weight;            /* ds_j: circulation over unknown, m           (n_sheet) */
    struct curve *curve;             /* line of the body, which holds the stencils below */
    struct stencil *sheet_point;     /* the bound vortices                          (n_sheet) */
    struct stencil *sheet_slope;     /* X' at the vortices, per edge; empty: length of an edge   (n_sheet) */
    struct stencil *control_point;   /* positions of the impermeability condition            (n_control) */
    struct tangent *control_tangent; /* direction of the body at the control points             (n_control) */
    struct tangent tail_tangent;     /* direction of the body at the tail */
    /* weights of the points above as full matrices, by columns: bound vortices (n_nodes, n_sheet); control points, and
     * tangents there, X' of a smooth curve (n_nodes, n_control); wide_product has the bits of fish_mean */
    double *sheet_by_node, *control_by_node[2];
    double *end_correction;       /* E_c of shedding: sheet, else 0, m-1              (n_control) */
    struct stencil heading_point; /* the body point at a third of the length */

    double smoothing;    /* delta of the free vortices, m */
    double taper;        /* distance from the tail over which the smoothing for its own body grows from 0 to delta, m */
    double taper_beside; /* the same for vortices beside the body, m */
    double leg_length;   /* length s of the legs of its wake far behind the tail, m2; 0: sheets of infinite span */
    double sheet_smoothing; /* of the bound sheet, for other bodies and wakes, m */

    double contact_strength; /* contact force that accelerates the body by one length per beat within a beat, N */

    double start_position[2]; /* of the nose, m */
    double start_heading;     /* rad */
    double start_speed;       /* m s-1 */
    double load_tip[2];       /* N */
    struct motion motion;
    struct control_law_data control;
};

/* Impermeable straight walls along x. */
struct walls {
    int n;            /* 0, 1, or 2: a channel, the lower one first */
    double y[2];      /* m */
    double inward[2]; /* 1: the fluid is above the wall; -1: below */
};

/* The distance of a point at height y from the nearest wall, m: negative outside; INFINITY without walls. */
double fish_walls_distance(const struct walls *walls, double y);

/* Vortices of a wake that a vortex from outside takes: markers of a sheet, src/wake/wake.c. */
enum { WAKE_PER_VORTEX = 3 };

/* Constants of a run. */
struct school {
    struct arena *arena; /* of everything below */
    int n_fish;
    struct fish *fish;
    int n_unknowns;

    double density;             /* of the fluid, kg m-3 */
    double velocity[2], shear;  /* m s-1, s-1 */
    double gust[2], gust_omega; /* amplitude in x and y, m s-1; rad s-1, 0 for a travelling gust */

    /* travelling gust: direction and speed of travel, m s-1; rad m-1; m */
    enum gust_profile gust_profile;
    double gust_along[2], gust_speed, gust_number, gust_position, gust_gradient_distance;

    struct walls walls;

    double interval;          /* between two events, s */
    double interval_ratio[2]; /* the interval as a ratio of two integers, such as 1 and 50, or interval and 1 */
    double lifetime, decay;   /* of a free vortex, s */
    enum shedding shedding;
    enum kutta kutta;
    enum removed_circulation removed;
    bool finite;           /* whether the sheets are vortex rings: some fish has force: pressure with span: finite */
    double wake_tolerance; /* estimated error of the velocity of the wakes at the bodies, lengths per beat; 0: none */

    double wake_spacing; /* of old markers at most, over the smoothing: wake/stretch.h; 0: none is dropped */
    int wake_spare;      /* vortices of each wake that may be added from outside: wake_add_vortex, wake_break */
    int n_vortices;      /* vortices in the fluid at the start, in the wake of the first fish */
    double *vortices;    /* position, m, and circulation, m2 s-1, of each                    (n_vortices, 3) */

    enum contact_action contact; /* of bodies with a gap below contact_range */
    double contact_range;        /* m */
    double coupling_distance;    /* m */
    enum linear_systems linear;  /* of systems with the Jacobian of the school */
    int threads;
};

/* The number of threads of a loop over the unknowns of all fish: one or all. */
static inline int fish_threads(const struct school *school) {
    return parallel_threads(school->threads, school->n_fish, school->n_unknowns, PARALLEL_UNKNOWNS);
}

/* The time of an event, s: the double nearest to the multiple of the decimal or rational interval of the case, 0.7 and
 * not 7 * 0.1. */
static inline double fish_event_time(const struct school *school, long event) {
    // a product of integers below 2^53 is exact, so the quotient has the only rounding
    return (double)event * school->interval_ratio[0] / school->interval_ratio[1];
}

static inline void fish_tail(const struct fish *fish, const double *y, double place[2]) {
    place[0] = y[fish->at.x + fish->n_nodes - 1];
    place[1] = y[fish->at.y + fish->n_nodes - 1];
}

/* sum of weight * value over the nodes of the point. */
static inline double fish_mean(const struct stencil *point, const double *value) {
    double mean = 0;
    for (int i = 0; i < point->n; i++) mean += point->weight[i] * value[point->node[i]];
    return mean;
}

/* Mass-weighted mean of a value of the nodes (n_nodes). */
double fish_mass_mean(const struct fish *fish, const double *value);

/* Length of a vector, unit vector t, and unit normal n = E3 x t. */
struct direction {
    double length, t[2], n[2];
};
struct direction fish_direction_of(const double vector[2]);

/* The vector along the body at the node positions in y. */
struct direction fish_direction(const struct fish *fish, const struct tangent *tangent, const double *y);

/* Whether the velocity of its own wake acts at the edge midpoints of the fish: not with force: reactive. doc/model.md,
 * section 9. */
static inline bool fish_feels_own_wake(const struct fish *fish) {
    return fish->force != FORCE_REACTIVE;
}

/* Whether the bound sheet loads the body, as its pressure does: the law of motion then depends on the whole sheet. */
static inline bool fish_is_loaded_by_sheet(const struct fish *fish) {
    return fish->at.full < fish->at.gamma;
}

/* Whether the muscle drives the body with a wave. */
bool fish_has_wave(const struct fish *fish);

/* The first fish that beats; NULL: none. */
const struct fish *fish_first_beating(const struct school *school);

/* The beat frequency, or the frequency of the prescribed motion; without a frequency, the speed of the fish or of the
 * stream in lengths per second; 1 without motion. Rate times length is the velocity scale. */
double fish_rate(const struct school *school, const struct fish *fish);

/* Distances of the outlines of bodies from points, walls and other bodies. The outline of a body is
 * the union of all edges, widened by half the edge thickness. */

/* Distance of the point p from the outline of a body at the node positions in y, negative inside, m. */
double fish_point_distance(const struct fish *fish, const double *y, const double p[2]);

/* Distance of the outline of a body at the node positions in y from the nearest wall, negative beyond the wall, m;
 * INFINITY without walls. wall: index of the wall, or NULL. */
double fish_wall_distance(const struct school *school, const struct fish *fish, const double *y, int *wall);

/* Distance between the outlines of two bodies at the node positions in y, 0 at contact, m. A distance above the limit
 * may be returned as a larger one or INFINITY: edges are compared only if their distance can be below the limit. */
double fish_distance(const struct fish *a, const struct fish *b, const double *y, double limit);

#endif
