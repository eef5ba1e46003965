/* diagnostics_values.h: what is derived from a state for the user, as plain values. doc/model.md, section 13. */
#ifndef DIAGNOSTICS_VALUES_H
#define DIAGNOSTICS_VALUES_H

#include "base/box.h"
#include "force/pressure.h"

/* One fish at one event. */
struct diagnostics_fish {
    double com[2], com_velocity[2]; /* centre of mass, m, m s-1 */
    double speed,
        ground_speed;       /* of the centre of mass over the last period, through the water and over ground, m s-1 */
    double drift;           /* of the speed: change from one period to the next, over it; NaN before the second */
    double heading;         /* degree, unwrapped */
    double desired_heading; /* degree */
    double heading_error;   /* of the way through the water over the last period, against it, degree */
    double phi0;
    double wave_amplitude, wave_frequency;                    /* now: ramped, and as set from outside; rad, Hz */
    double swept_vortices;                                    /* free vortices of any fish inside its outline */
    double shed_circulation;                                  /* m2 s-1 */
    double shedding_rate;                                     /* m2 s-2 */
    double kinetic_energy, bending_energy, stretching_energy; /* J */
    double contact_energy;                                    /* half of what its contacts store, J */
    double added_mass_energy;                                 /* of the fluid that the body accelerates, J */
    double actuation_power, damping_power, drag_power, added_mass_power, wake_power, constraint_power; /* W */
    double friction_power; /* of the part of the drag along the body, W */
    double contact_power;  /* what it is given for its half of the contacts, W */
    double energy_balance; /* J */
    double actuation_work; /* put in by the muscle since the start, J */
    /* on the body, N, and about the centre of mass, N m; friction: the part of the resistive force along the body */
    double resistive_force[2], friction_force[2], reactive_force[2], constraint_force[2];
    double contact_force[2]; /* of all bodies that it touches, N */
    /* x, y, N s, and angular about the origin, N m s: of all vortices, with those that are lost; of these; of the
     * external forces */
    double fluid_impulse[3], lost_impulse[3], external_impulse[3];
    double resistive_moment, friction_moment, reactive_moment, constraint_moment;
    struct pressure_forces pressure; /* force: pressure, else 0 */
    double leading_edge_most;        /* the largest magnitude of A_0 over the last period; NaN with other forces */
    double separation_share;         /* part of the last period in which A_0 is above its limit */
    double thrust;                   /* forces of the fluid along the heading, N */
    double mean_thrust;          /* all forces of the fluid along the way, N, over the last period: 0 when it swims */
    double mean_power;           /* that the motion takes for thrust and wake, W, over the last period */
    double thrust_efficiency;    /* mean thrust times speed over that power */
    double mean_actuation_power; /* of the muscle, W, over the last period */
    double cost_of_transport;    /* mean power of muscle, prescribed motion and loads over mass and speed, m s-2: */
    double cost_of_transport_fluid; /* the part that goes into the fluid, */
    double cost_of_transport_body;  /* and the part that damping takes */
    double efficiency;              /* friction times speed over the power that goes into the fluid, over a period */
    double strouhal;                /* frequency times peak-to-peak of the tail over speed */
};

/* The school at one event. */
struct diagnostics {
    double t;
    struct diagnostics_fish *fish; /*                                                       (n_fish) */
    struct box *body, *wake;       /* scratch: around each body, around its free vortices   (n_fish) */
    double total_circulation;      /* m2 s-1 */
    double momentum_balance[3];    /* balance of momentum, N s, and of angular momentum, N m s; NaN without reaction */
    double momentum_size;          /* of the largest term of this balance, N s */
    double least_distance;         /* between two bodies, m; NaN for one fish */
    double polarisation;           /* length of the mean unit vector of the headings */
};

#endif
