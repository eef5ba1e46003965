/* diagnostics_momentum.h: the impulse of the fluid, external forces, and the momentum balance over the steps of the
 * integrator. doc/model.md, section 13. Tested by tests/school/test_diagnostics_momentum.c. */
#ifndef DIAGNOSTICS_MOMENTUM_H
#define DIAGNOSTICS_MOMENTUM_H

#include "base/mathematics.h"
#include "force/force_model.h"
#include "school/residual.h"
#include "state/state.h"

/* What results report about a state, as plain values. doc/model.md, section 13. */

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
    double friction_power, cross_flow_power; /* powers of the drag along and across the body, W */
    double contact_power;                    /* power received for this half of the contacts, W */
    double energy_balance;                   /* J */
    double actuation_work;                   /* work of the muscle since the start, J */
    /* forces on the body, N, and moments about the centre of mass, N m; friction and cross-flow are the parts of the
     * resistive force along and across the body */
    double resistive_force[2], friction_force[2], cross_flow_force[2], reactive_force[2], constraint_force[2];
    double contact_force[2]; /* force of all bodies in contact, N */
    /* x, y, N s, and angular about the origin, N m s: impulse of all vortices including those that are lost; impulse of
     * the lost ones; momentum that the lengths s of legs take; impulse of the external forces */
    double fluid_impulse[3], lost_impulse[3], leg_impulse[3], external_impulse[3];
    double resistive_moment, friction_moment, reactive_moment, constraint_moment;
    struct pressure_forces pressure; /* force: pressure, else 0 */
    double leading_edge_most;        /* largest magnitude of A_0 over the last period; NaN unless force: pressure */
    double bias_reversals;           /* reversals of the steering bias of a control law in the last period */
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
    double towed_efficiency;         /* drag of the towed straight body times speed over the power transferred to the
                                      * fluid, last period; NaN for a held body */
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

/* The forces on a fish by kind, among them the constraint forces of prescribed motion. doc/model.md, section 13. */

/* Fill the forces and moments of *to, for the unknowns y and the time t of the last residual evaluated; to->com is
 * input. */
void diagnostics_forces(struct residual *residual, int f, double t, const double *y, struct diagnostics_fish *to);

/* The total force of the fluid on a body, N, which is the sum of resistive and reactive force, pressure and suction. */
void diagnostics_fluid_force(const double resistive[2], const double reactive[2],
                             const struct pressure_forces *pressure, double force[2]);

/* The forces of the fluid on fish f, with moments about a point. */
struct fluid_forces diagnostics_fluid(struct residual *residual, int f, const double about[2], const double *y);

/* Add the impulse of the external forces in the step that ended at t to the momentum balance of fish f, as
 * diagnostics_step adds works. n: number of values for the quadrature; times: the newest one first. n = 0: only store
 * the forces as the first values. */
void diagnostics_momentum_step(struct residual *residual, struct state *state, int f, double t, const double *y, int n,
                               const double times[3]);

/* Add what has happened since the last event: the impulse of images in walls, and the momentum taken by legs of rings.
 * Call it at every event, after the velocities of all wakes and the residual have been evaluated. */
void diagnostics_momentum_event(struct residual *residual, struct state *state);

/* Start all momentum balances with the present state. */
void diagnostics_momentum_start(struct residual *residual, struct state *state);

/* Whether there is a momentum balance, because all fish have a reaction and, in a fluid, strips of one depth. */
bool diagnostics_momentum_is_defined(const struct school *school);

/* Fill the impulses of all fish, and the momentum balance of the school, at the event of the state. */
void diagnostics_momentum(struct residual *residual, const struct state *state, struct diagnostics *diagnostics);

#endif
