/* diagnostics_values.h: quantities derived from a state for results, as plain values. doc/model.md, section 13. */
#ifndef DIAGNOSTICS_VALUES_H
#define DIAGNOSTICS_VALUES_H

#include "base/mathematics.h"
#include "force/pressure.h"

/* One fish at one event. */
struct diagnostics_fish {
    double com[2], com_velocity[2]; /* centre of mass, m, m s-1 */
    double speed,
        ground_speed;       /* of the centre of mass over the last period, through the water and over ground, m s-1 */
    double drift;           /* change of speed from one period to the next / speed; NaN before the second period */
    double heading;         /* degree, unwrapped */
    double desired_heading; /* degree */
    double heading_error;   /* course through the water in the last period minus desired heading, degree */
    double phi0;
    double wave_amplitude, wave_frequency;                    /* present values: with ramp and shoal_set; rad, Hz */
    double swept_vortices;                                    /* free vortices of any fish inside the outline */
    double shed_circulation;                                  /* m2 s-1 */
    double shedding_rate;                                     /* m2 s-2 */
    double kinetic_energy, bending_energy, stretching_energy; /* J */
    double contact_energy;                                    /* half the energy of the contacts, J */
    double added_mass_energy;                                 /* kinetic energy of the added mass, J */
    double actuation_power, damping_power, drag_power, added_mass_power, wake_power, constraint_power; /* W */
    double friction_power; /* power of the drag along the body, W */
    double contact_power;  /* power received for this half of the contacts, W */
    double energy_balance; /* J */
    double actuation_work; /* work of the muscle since the start, J */
    /* forces on the body, N, and moments about the centre of mass, N m; friction: resistive force along the body */
    double resistive_force[2], friction_force[2], reactive_force[2], constraint_force[2];
    double contact_force[2]; /* force of all bodies in contact, N */
    /* x, y, N s, and angular about the origin, N m s: impulse of all vortices including lost vortices; impulse of lost
     * vortices; impulse of the external forces */
    double fluid_impulse[3], lost_impulse[3], external_impulse[3];
    double resistive_moment, friction_moment, reactive_moment, constraint_moment;
    struct pressure_forces pressure; /* force: pressure, else 0 */
    double leading_edge_most;        /* largest magnitude of A_0 over the last period; NaN unless force: pressure */
    double separation_share;         /* fraction of the last period with A_0 above the suction limit */
    double thrust;                   /* force of the fluid along the heading; prescribed motion: along the travel, N */
    double mean_thrust;              /* mean force of the fluid along the path, N, last period: 0 in steady swimming */
    double mean_power;               /* mean power of muscle and drive, W, over the last period */
    double mean_actuation_power;     /* mean power of the muscle, W, over the last period */
    double cost_of_transport;        /* mean power of muscle, prescribed motion and loads / (mass speed), m s-2 */
    double cost_of_transport_fluid;  /* part of the cost of transport transferred to the fluid, m s-2 */
    double cost_of_transport_body;   /* part of the cost of transport dissipated by damping, m s-2 */
    double efficiency;               /* held body: mean_thrust times speed over mean_power; else friction times speed
                                      * over the power transferred to the fluid, last period */
    double strouhal;                 /* frequency times peak-to-peak amplitude of the tail over speed */
};

/* The school at one event. */
struct diagnostics {
    double t;
    struct diagnostics_fish *fish; /*                                                       (n_fish) */
    struct box *body, *wake;       /* scratch: boxes of each body and of the free vortices  (n_fish) */
    double total_circulation;      /* m2 s-1 */
    double momentum_balance[3];    /* balance of momentum, N s, and of angular momentum, N m s; NaN without reaction */
    double momentum_size;          /* largest term of the momentum balance, N s */
    double least_distance;         /* between two bodies, m; NaN for one fish */
    double polarisation;           /* length of the mean unit vector of the headings */
};

#endif
