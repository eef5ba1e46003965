/* parameters.h: the parameters of a school as a case file gives them: angles in degrees, lengths in metres or in
 * fractions of the body length, as the comments say. fish_school.h converts them to the constants of the equations.
 * doc/cases.md explains each of them under its key. */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <signal.h>
#include <stdbool.h>
#include <string.h>

enum shedding { SHEDDING_CONTINUOUS, SHEDDING_IMPULSIVE, SHEDDING_SHEET };
enum kutta { KUTTA_EDGE, KUTTA_RATE };
enum body_line { BODY_LINE_SMOOTH, BODY_LINE_POLYGON };
enum collocation { COLLOCATION_CHEBYSHEV, COLLOCATION_MIDPOINT };
enum removed_circulation { REMOVED_RETAINED, REMOVED_DROPPED };
enum profile { PROFILE_JOUKOWSKI, PROFILE_UNIFORM, PROFILE_TABLE };
enum section { SECTION_MEAN, SECTION_NODES };
enum damping { DAMPING_STRAIN, DAMPING_CURVATURE };
enum second_moment { SECOND_MOMENT_ELLIPSE, SECOND_MOMENT_PUBLISHED };
enum span { SPAN_FINITE, SPAN_INFINITE };
enum force { FORCE_REACTIVE, FORCE_PUBLISHED, FORCE_PRESSURE };
enum drag_law { DRAG_QUADRATIC, DRAG_LINEAR_QUADRATIC };
enum friction { FRICTION_QUADRATIC, FRICTION_LAMINAR, FRICTION_BOUNDARY_LAYER };
enum extent { EXTENT_THICKNESS, EXTENT_DEPTH };
enum prescribed { PRESCRIBED_NONE, PRESCRIBED_HEAD, PRESCRIBED_ALL };
/* Solution of systems with the Jacobian of the school: fish by fish, with GMRES for their couplings, or as one sparse
 * matrix (solver/linear.h). */
enum linear_systems { LINEAR_BLOCKS, LINEAR_KLU };
enum contact_action { CONTACT_REPEL, CONTACT_WARN, CONTACT_STOP };
enum gust_profile { GUST_UNIFORM, GUST_SINE, GUST_STEP };
enum surge { SURGE_GIVEN, SURGE_FREE };
enum control_law { CONTROL_NONE, CONTROL_HEADING, CONTROL_AVERAGED_HEADING, CONTROL_COURSE, CONTROL_PLACE };

/* A list of numbers, of pairs (then 2 n numbers, pair after pair), or of rows (width n numbers, row after row). Owned
 * by the enclosing structure. */
struct number_list {
    int n;
    double *value;
    int width; /* of a list of rows, or of pairs in place of numbers: numbers per row */
};

struct fluid_parameters {
    double density;        /* kg m-3 */
    double viscosity;      /* kinematic, m2 s-1 */
    double velocity[2];    /* m s-1 */
    double shear;          /* s-1 */
    double gust_amplitude; /* m s-1 */
    double gust_frequency; /* Hz */
    enum gust_profile gust_profile;
    double gust_wavelength, gust_speed, gust_position, gust_gradient_distance; /* m, m s-1 */
    struct number_list walls; /* heights of walls along x: none, one, or two in ascending order, m */
};

/* A vortex street at the start: two staggered rows of opposite circulation. */
struct street_parameters {
    int n;                                     /* vortices of both rows; 0: no street */
    double spacing, row_distance, position[2]; /* m */
    double circulation;                        /* m2 s-1 */
};

struct wake_parameters {
    double smoothing;           /* fraction of the body length */
    double taper, taper_beside; /* fractions of the body length */
    double leg_length;          /* factor of the length of the legs of vortex rings */
    double lifetime, decay;     /* s */
    enum shedding shedding;
    enum removed_circulation removed_circulation;
    double tolerance;            /* lengths per beat; 0: exact */
    int spare;                   /* vortices of each wake that may be added from outside */
    struct number_list vortices; /* in the fluid at the start: rows of position [m] and circulation [m2 s-1] */
    struct street_parameters street;
};

struct sheet_parameters {
    double smoothing; /* fraction of the body length */
    enum body_line curve;
    enum collocation collocation;
    enum kutta kutta;
};

struct body_parameters {
    enum profile profile;
    double thickness, depth; /* fractions of the body length; the depth is the span, out of the plane of motion */
    double tail_thickness;   /* fraction of the body length: profile joukowski only */
    struct number_list thickness_table, depth_table; /* m, one value per edge, or of width 2 pairs (distance from the
                                                        nose over the length, m): profile table only */
    enum section section;                            /* of an edge: mean over the edge, or mean of both nodes */
    double density;                                  /* kg m-3 */
    double modulus;                                  /* Pa */
    enum second_moment second_moment;
    double bending_damping;    /* N m s, per joint of a body of reference_nodes: doc/model.md, section 3 */
    double stretching_damping; /* N s m-1, per edge of a body of reference_nodes */
    double relaxation_time;    /* s */
    enum damping damping;      /* internal damping of bending acts on the rate of strain or of curvature */
};

struct wave_parameters {
    double amplitude, constant, linear, quadratic;
    double number, wavelength; /* rad; body lengths, another form of number that a case may give */
    struct number_list
        table;        /* rows from nose to tail of natural curvature times length, over the phase; none: empty */
    double frequency; /* Hz */
    double phase;     /* degree */
    double ramp;      /* s */
};

struct drag_parameters {
    double tangential, normal;
    enum friction friction;    /* law of the tangential drag */
    double transition;         /* Reynolds number of the distance from the nose; 0: turbulent from the nose on */
    bool has_waving, has_form; /* whether these factors are given */
    double waving;             /* factor of laminar friction; by default 1.5 with a wave, else 1 */
    double form;               /* factor of all friction; by default by the largest thickness */
    enum drag_law law;
    double linear_speed; /* lengths per beat: force reactive, law linear_quadratic */
};

struct added_mass_parameters {
    double coefficient;
    enum extent extent; /* of the body in added mass and normal drag */
};

struct motion_parameters {
    enum prescribed prescribed;
    enum surge surge;          /* motion along the heading */
    double speed;              /* m s-1; surge free: at the start */
    double heave;              /* m */
    double pitch, pitch_phase; /* degree */
    double frequency;          /* Hz */
    double phase;              /* degree */
    double pivot;              /* fraction of the body length from the nose */
};

struct control_parameters {
    enum control_law law;
    double bias;
    struct number_list desired_heading; /* pairs (s, degree) */
    struct number_list waypoints;       /* pairs (m, m) */
    double acceptance_radius;           /* body lengths */
    double gain, damping, limit, feedforward;
    double slow;          /* body lengths per period: law course */
    double course_filter; /* s: law course */
    double filter;        /* s */
    double rate;          /* s-1 */
    double ramp;          /* s */

    /* law place */
    char *of;                                                  /* name of the leader */
    double offset[2];                                          /* of the nose from that of the leader, m */
    double amplitude_gain, amplitude_damping, amplitude_limit; /* per length; beats per length; 1 */
    double lookahead;                                          /* body lengths */
    double hold_time;                                          /* periods */
};

struct fish_parameters {
    char *name;
    double length; /* m */
    int nodes, reference_nodes, sheet_points;
    double wake_lifetime; /* fraction of wake.lifetime */
    struct body_parameters body;
    struct wave_parameters wave;
    enum force force;           /* of the fluid on the body */
    enum span span;             /* force: pressure: span model of the sheet strip */
    double suction;             /* force: pressure: fraction of the leading-edge suction */
    double suction_limit;       /* force: pressure: largest leading-edge parameter with attached flow; 0: no limit */
    struct number_list sensors; /* force: pressure: fractions of the body length with the pressure in the result */
    struct drag_parameters drag;
    struct added_mass_parameters added_mass;
    double start_position[2]; /* m */
    double start_heading;     /* degree */
    double start_speed;       /* m s-1 */
    double load_tip[2];       /* N */
    struct motion_parameters motion;
    struct control_parameters control;
};

/* Whether a prescribed motion sets the beat. */
static inline bool fish_parameters_move(const struct fish_parameters *fish) {
    return fish->motion.prescribed != PRESCRIBED_NONE && fish->motion.frequency > 0;
}

/* The frequency of the beat, that is of the prescribed motion or else of the wave of the muscle, Hz; 0: no beat. */
static inline double fish_parameters_frequency(const struct fish_parameters *fish) {
    return fish_parameters_move(fish) ? fish->motion.frequency : fish->wave.frequency;
}

struct contact_parameters {
    enum contact_action action;
    double range; /* body lengths of the longest fish */
};

struct school_parameters {
    struct fluid_parameters fluid;
    struct wake_parameters wake;
    struct sheet_parameters sheet;
    struct contact_parameters contact;
    double shedding_interval; /* s */
    double coupling_distance; /* body lengths of the longest fish */
    enum linear_systems linear;
    int threads;
    int n_fish;
    struct fish_parameters *fish;      /* (n_fish) */
    const volatile sig_atomic_t *stop; /* the set-up of a school ends once *stop is not 0; may be NULL */
};

/* The fish with a name, which has so many bytes; -1: none. */
static inline int school_find_fish(const struct school_parameters *school, const char *name, size_t length) {
    for (int f = 0; f < school->n_fish; f++) {
        const char *const own = school->fish[f].name;
        if (own && strncmp(own, name, length) == 0 && own[length] == '\0') return f;
    }
    return -1;
}

#endif
