/* steady_values.h: what a search for a steady state (steady/steady.h) found: the variables steady_... of its result. */
#ifndef STEADY_VALUES_H
#define STEADY_VALUES_H

/* A fish has at most so many slow quantities, and multipliers. */
enum { STEADY_QUANTITIES = 6 };

/* One fish: means over the last beat, of a case without a beat values of its equilibrium. */
struct steady_fish {
    double speed;      /* of the centre of mass through the water, m s-1 */
    double turn;       /* of the heading in a beat, degree */
    double place[2];   /* of its centre of mass ahead of that of the first fish and to the left of that, m */
    double force[2];   /* of the fluid on it, N */
    double thrust;     /* of the fluid on it, along its heading, N */
    double drag, lift; /* along the stream that it meets, and to the left of that, N; without a beat only, */
    double deflection; /* and of its tail, to the left of the heading of a stiff body, m; else NaN */
    double actuation_power, damping_power, constraint_power; /* W */
    double fluid_power;                                      /* that goes into the fluid, W */
    double cost_of_transport;                                /* m s-2 */
    double efficiency, strouhal;
};

struct steady_values {
    int n_beats;              /* that the search took, those of the multipliers not counted */
    int n_multiplier_beats;   /* and those */
    double residual;          /* the largest change from one beat to the next, relative: doc/steady.md; without a beat
                                 the largest equation that is left, over its scale */
    double stiffness;         /* static, over that at rest; NaN with a beat, or where nothing bends */
    double error;             /* estimate of how far that is from the fixed point; NaN without multipliers */
    int n_multipliers;        /* 0: none were asked for, or there is no slow quantity */
    double *real, *imaginary; /* by falling absolute value                         (n_multipliers) */
    int n_exponents;      /* of small disturbances, of a pair one: of the multipliers, or without a beat of the modes
                                 of the bodies */
    double *rate, *omega; /* growth rate, s-1, and angular frequency, rad s-1, by falling rate (n_exponents) */
    double growth, growth_frequency; /* of the first, s-1 and Hz; NaN: there is none */
    struct steady_fish *fish;        /* (n_fish) */
};

#endif
