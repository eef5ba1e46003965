/* result_table.c: the table of variables; a new variable is a new row. */
#include "result/result_table.h"

#include <stdio.h>

// ---- the table

#define IN_SCHOOL(field) .owner = OF_SCHOOL, .offset = offsetof(struct school, field)
#define IN_FISH(field) .owner = OF_FISH, .offset = offsetof(struct fish, field)
#define ARRAY_IN_FISH(field) IN_FISH(field), .is_pointer = true
#define IN_STATE(field) .owner = OF_STATE, .offset = offsetof(struct state, field)
#define IN_WAKE(field) .owner = OF_WAKE, .offset = offsetof(struct wake, field)
#define IN_DIAGNOSTICS(field) .owner = OF_DIAGNOSTICS, .offset = offsetof(struct diagnostics, field)
#define IN_FISH_DIAGNOSTICS(field) .owner = OF_DIAGNOSTICS_FISH, .offset = offsetof(struct diagnostics_fish, field)
#define IN_COUNTS(field) .owner = OF_COUNTS, .offset = offsetof(struct integrator_counts, field)
#define IN_ROW(field) .owner = OF_ROW, .offset = offsetof(struct result_row, field)
#define IN_STEADY(field) .of_steady = true, .owner = OF_STEADY, .offset = offsetof(struct steady_values, field)
#define IN_STEADY_FISH(field) .of_steady = true, .owner = OF_STEADY_FISH, .offset = offsetof(struct steady_fish, field)
#define OF_BODY(name) .gather = result_row_body, .part = PART_##name
#define OF_SHEET(name) .gather = result_row_sheet, .part = PART_##name
#define OF_WAKES(name) .gather = result_row_wake, .part = PART_##name
#define OF_SIDES(name) .gather = result_row_sides, .part = PART_##name
#define OF_EDGES(name) .gather = result_row_edges, .part = PART_##name
#define OF_EQUATIONS(name) .gather = result_row_equations, .part = PART_##name
#define OF_STEADY_STATE(name) .gather = result_row_steady, .part = PART_##name

// clang-format off
const struct result_variable result_table[] = {
    // constants
    {"fish",                  {FISH, NAME},           RESULT_TEXT,    "",       ARRAY_IN_FISH(name),
     .long_name = "name of the fish: coordinate of the dimension fish"},
    {"xy",                    {XY, NAME},             RESULT_TEXT,    "",       .owner = OF_AXIS, .is_pointer = true,
     .long_name = "x or y: coordinate of the dimension xy"},
    {"n_nodes",               {FISH},                 RESULT_INTEGER, "1",      IN_FISH(n_nodes),
     .long_name = "number of nodes"},
    {"n_edges",               {FISH},                 RESULT_INTEGER, "1",      IN_FISH(n_edges),
     .long_name = "number of edges"},
    {"n_joints",              {FISH},                 RESULT_INTEGER, "1",      IN_FISH(n_joints),
     .long_name = "number of joints"},
    {"n_sheet",               {FISH},                 RESULT_INTEGER, "1",      IN_FISH(n_sheet),
     .long_name = "number of bound vortices"},
    {"body_length",           {FISH},                 RESULT_REAL,    "m",      IN_FISH(length),
     .long_name = "body length"},
    {"edge_length",           {FISH},                 RESULT_REAL,    "m",      IN_FISH(edge_length),
     .long_name = "rest length of every edge"},
    {"body_mass",             {FISH},                 RESULT_REAL,    "kg",     IN_FISH(total_mass),
     .long_name = "mass of the body"},
    {"frequency",             {FISH},                 RESULT_REAL,    "Hz",     IN_FISH(frequency),
     .long_name = "beat frequency of the case"},
    {"bias",                  {FISH},                 RESULT_REAL,    "1",      IN_FISH(control.bias),
     .long_name = "steering bias of the case, without a control law"},
    {"wake_smoothing",        {FISH},                 RESULT_REAL,    "m",      IN_FISH(smoothing),
     .long_name = "smoothing radius of the free vortices"},
    {"sheet_smoothing",       {FISH},                 RESULT_REAL,    "m",      IN_FISH(sheet_smoothing),
     .long_name = "smoothing radius of the bound vortices"},
    {"node_arc",              {FISH, NODE},           RESULT_REAL,    "m",      ARRAY_IN_FISH(arc),
     .long_name = "arc coordinate of the nodes, from the nose"},
    {"node_mass",             {FISH, NODE},           RESULT_REAL,    "kg",     ARRAY_IN_FISH(mass),
     .long_name = "mass of the nodes"},
    {"edge_thickness",           {FISH, EDGE},           RESULT_REAL,    "m",      ARRAY_IN_FISH(thickness),
     .long_name = "thickness of the body in the plane of motion"},
    {"edge_depth",            {FISH, EDGE},           RESULT_REAL,    "m",      ARRAY_IN_FISH(depth),
     .long_name = "depth (span) of the body, out of the plane of motion"},
    {"mean_section",          {FISH},                 RESULT_INTEGER, "1",      IN_FISH(has_mean_section),
     .flags = "mean_of_both_nodes mean_over_edge", .long_name = "edge_thickness and edge_depth"},
    {"fluid_force",           {FISH},                 RESULT_INTEGER, "1",      IN_FISH(force),
     .flags = "reactive published pressure", .long_name = "force"},
    {"is_held",               {FISH},                 RESULT_INTEGER, "1",      IN_FISH(motion.is_held),
     .flags = "swims given", .long_name = "motion along the heading (motion.surge)"},
    {"edge_arc",              {FISH, EDGE},           RESULT_REAL,    "m",      OF_BODY(EDGE_ARC),
     .long_name = "arc coordinate of the middles of the edges"},
    {"joint_arc",             {FISH, JOINT},          RESULT_REAL,    "m",      OF_BODY(JOINT_ARC),
     .long_name = "arc coordinate of the joints"},
    {"sheet_arc",             {FISH, SHEET},          RESULT_REAL,    "m",      OF_SHEET(SHEET_ARC),
     .long_name = "arc coordinate of the bound vortices, from the nose"},
    {"control_arc",           {FISH, CONTROL},        RESULT_REAL,    "m",      OF_SHEET(CONTROL_ARC),
     .long_name = "arc coordinate of the control points, from the nose"},
    {"sensor_place",          {FISH, SENSOR},         RESULT_REAL,    "1",      ARRAY_IN_FISH(sensor),
     .long_name = "place of the sensors: distance from the nose over the length; in the files of cases with sensors"},
    {"sheet_weight",          {FISH, SHEET},          RESULT_REAL,    "m",      ARRAY_IN_FISH(sheet_weight),
     .long_name = "natural length of body per bound vortex"},
    {"fluid_density",         {NONE},                 RESULT_REAL,    "kg m-3", IN_SCHOOL(density),
     .long_name = "density of the fluid"},
    {"shedding_interval",     {NONE},                 RESULT_REAL,    "s",      IN_SCHOOL(interval),
     .long_name = "time between the release of two vortices"},
    {"wake_lifetime",         {NONE},                 RESULT_REAL,    "s",      IN_SCHOOL(lifetime),
     .long_name = "age at which a free vortex is removed"},
    {"wake_part",             {FISH},                 RESULT_REAL,    "1",      IN_FISH(wake_part),
     .long_name = "lifetime of the wake of the fish over wake_lifetime"},
    {"wake_decay",             {NONE},                 RESULT_REAL,    "s",      IN_SCHOOL(decay),
     .long_name = "time before removal over which a free vortex decays"},
    {"wall_y",                {WALL},                 RESULT_REAL,    "m",      IN_SCHOOL(walls.y),
     .long_name = "y of the walls, the lower one first; with fluid.walls only"},

    // a steady state: means over the last beat
    {"steady_beats",          {NONE},                 RESULT_INTEGER, "1",      IN_STEADY(n_beats),
     .long_name = "beats of the search for the steady state"},
    {"steady_multiplier_beats", {NONE},               RESULT_INTEGER, "1",      IN_STEADY(n_multiplier_beats),
     .long_name = "beats simulated for the multipliers"},
    {"steady_residual",       {NONE},                 RESULT_REAL,    "1",      IN_STEADY(residual),
     .long_name = "change per beat of the speed, in lengths per beat, or of other quantities; without a beat the "
                  "largest scaled residual"},
    {"steady_stiffness",      {NONE},                 RESULT_REAL,    "1",      IN_STEADY(stiffness),
     .long_name = "determinant of the static stiffness of an equilibrium, over the value at rest; below 0 the "
                  "bodies diverge"},
    {"steady_error",          {NONE},                 RESULT_REAL,    "1",      IN_STEADY(error),
     .long_name = "estimated distance from the steady state, in lengths per beat"},
    {"steady_multiplier",     {MULTIPLIER, XY},       RESULT_REAL,    "1",
     .of_steady = true, .owner = OF_STEADY, OF_STEADY_STATE(MULTIPLIER),
     .long_name = "Floquet multipliers of the slow quantities, real and imaginary parts"},
    {"steady_multiplier_error", {MULTIPLIER},         RESULT_REAL,    "1",
     .of_steady = true, .owner = OF_STEADY, OF_STEADY_STATE(MULTIPLIER_ERROR),
     .long_name = "error of the absolute values of the multipliers: noise of the wake, size of the disturbances"},
    {"steady_mode",           {MULTIPLIER, FISH, SLOW, XY}, RESULT_REAL, "1",
     .of_steady = true, .owner = OF_STEADY, OF_STEADY_STATE(MODE),
     .long_name = "disturbance that grows by a multiplier: change of speed, slip, turn, heading, place ahead and place "
                  "aside in units of length and beat, and of the amplitude and the course that law place adds, over "
                  "the largest; real and imaginary parts"},
    {"steady_amplification",  {NONE},                 RESULT_REAL,    "1",      IN_STEADY(amplification),
     .long_name = "largest factor by which a disturbance of one slow quantity grows within 32 beats"},
    {"steady_growth",         {NONE},                 RESULT_REAL,    "s-1",    IN_STEADY(growth),
     .long_name = "growth rate of the least stable disturbance; unstable above 0"},
    {"steady_growth_frequency", {NONE},               RESULT_REAL,    "Hz",     IN_STEADY(growth_frequency),
     .long_name = "frequency of the oscillation, with a beat in addition to the beat frequency; 0: none"},
    {"steady_exponent",       {MULTIPLIER, XY},       RESULT_REAL,    "s-1",
     .of_steady = true, .owner = OF_STEADY, OF_STEADY_STATE(EXPONENT),
     .long_name = "growth rates and angular frequencies of disturbances: logarithms of multipliers over the beat, "
                  "or modes without a beat"},
    {"steady_speed",          {FISH},                 RESULT_REAL,    "m s-1",  IN_STEADY_FISH(speed),
     .long_name = "speed through the water"},
    {"steady_turn",           {FISH},                 RESULT_REAL,    "degree", IN_STEADY_FISH(turn),
     .long_name = "change of the heading in a beat"},
    {"steady_place",          {FISH, XY},             RESULT_REAL,    "m",      IN_STEADY_FISH(place),
     .long_name = "mean of the centre of mass relative to the first fish over the last beat: ahead, and to the left"},
    {"steady_force",          {FISH, XY},             RESULT_REAL,    "N",      IN_STEADY_FISH(force),
     .long_name = "force of the fluid on the body"},
    {"steady_thrust",         {FISH},                 RESULT_REAL,    "N",      IN_STEADY_FISH(thrust),
     .long_name = "mean_thrust of the last beat, or thrust at equilibrium"},
    {"steady_drag",           {FISH},                 RESULT_REAL,    "N",      IN_STEADY_FISH(drag),
     .long_name = "force of the fluid along the stream, without a beat"},
    {"steady_lift",           {FISH},                 RESULT_REAL,    "N",      IN_STEADY_FISH(lift),
     .long_name = "force of the fluid to the left of the stream, without a beat"},
    {"steady_deflection",     {FISH},                 RESULT_REAL,    "m",      IN_STEADY_FISH(deflection),
     .long_name = "displacement of the tail to the left, without a beat"},
    {"steady_actuation_power", {FISH},                RESULT_REAL,    "W",      IN_STEADY_FISH(actuation_power),
     .long_name = "power of the muscle"},
    {"steady_constraint_power",  {FISH},                 RESULT_REAL,    "W",      IN_STEADY_FISH(constraint_power),
     .long_name = "power of the forces on prescribed nodes, and of loads"},
    {"steady_damping_power",  {FISH},                 RESULT_REAL,    "W",      IN_STEADY_FISH(damping_power),
     .long_name = "power of the internal damping"},
    {"steady_fluid_power",    {FISH},                 RESULT_REAL,    "W",      IN_STEADY_FISH(fluid_power),
     .long_name = "power into the fluid"},
    {"steady_power",          {FISH},                 RESULT_REAL,    "W",      IN_STEADY_FISH(power),
     .long_name = "mean_power of the last beat"},
    {"steady_cost_of_transport", {FISH},              RESULT_REAL,    "m s-2",  IN_STEADY_FISH(cost_of_transport),
     .long_name = "mean power of muscle and drive over mass and speed, relative to the water"},
    {"steady_efficiency",     {FISH},                 RESULT_REAL,    "1",      IN_STEADY_FISH(efficiency),
     .long_name = "efficiency of the last beat"},
    {"steady_towed_efficiency", {FISH},               RESULT_REAL,    "1",      IN_STEADY_FISH(towed_efficiency),
     .long_name = "towed_efficiency of the last beat"},
    {"steady_strouhal",       {FISH},                 RESULT_REAL,    "1",      IN_STEADY_FISH(strouhal),
     .long_name = "Strouhal number"},

    // the bodies and the fluid
    {"time",                  {TIME},                 RESULT_REAL,    "s",      IN_STATE(t),
     .long_name = "time"},
    {"x",                     {TIME, FISH, NODE, XY}, RESULT_BULK,    "m",      OF_BODY(POSITION),
     .long_name = "position of the nodes, nose first"},
    {"v",                     {TIME, FISH, NODE, XY}, RESULT_BULK,    "m s-1",  OF_BODY(VELOCITY),
     .long_name = "velocity of the nodes"},
    {"a",                     {TIME, FISH, NODE, XY}, RESULT_BULK,    "m s-2",  OF_BODY(ACCELERATION),
     .long_name = "acceleration of the nodes"},
    {"natural_curvature",     {TIME, FISH, JOINT},    RESULT_BULK,    "m-1",    OF_BODY(NATURAL_CURVATURE),
     .long_name = "natural curvature of the joints, 2 tan(angle/2)/edge_length"},
    {"curvature",             {TIME, FISH, JOINT},    RESULT_BULK,    "m-1",    OF_BODY(CURVATURE),
     .long_name = "curvature of the joints, 2 tan(angle/2)/edge_length"},
    {"sheet_x",               {TIME, FISH, SHEET, XY},RESULT_BULK,    "m",      OF_SHEET(SHEET_POSITION),
     .long_name = "position of the bound vortices"},
    {"sheet_strength",        {TIME, FISH, SHEET},    RESULT_BULK,    "m s-1",  OF_SHEET(SHEET_STRENGTH),
     .long_name = "strength of the bound vortices: circulation per length of body"},
    {"wake_count",            {TIME, FISH},           RESULT_INTEGER, "1",      IN_WAKE(n_vortex),
     .long_name = "number of free vortices"},
    {"wake_x",                {TIME, FISH, VORTEX, XY},RESULT_BULK,    "m",      OF_WAKES(WAKE_POSITION),
     .long_name = "position of the free vortices, oldest first"},
    {"wake_circulation",      {TIME, FISH, VORTEX},   RESULT_BULK,    "m2 s-1", OF_WAKES(WAKE_CIRCULATION),
     .long_name = "circulation of the free vortices, without decay"},
    {"wake_birth",            {TIME, FISH, VORTEX},   RESULT_BULK,    "s",      OF_WAKES(WAKE_BIRTH),
     .long_name = "time of release of the free vortices"},

    // derived quantities of each fish
    {"com",                   {TIME, FISH, XY},       RESULT_REAL,    "m",      IN_FISH_DIAGNOSTICS(com),
     .long_name = "position of the centre of mass"},
    {"com_velocity",          {TIME, FISH, XY},       RESULT_REAL,    "m s-1",  IN_FISH_DIAGNOSTICS(com_velocity),
     .long_name = "velocity of the centre of mass"},
    {"speed",                 {TIME, FISH},           RESULT_REAL,    "m s-1",  IN_FISH_DIAGNOSTICS(speed),
     .long_name = "mean speed through the water over the last period"},
    {"ground_speed",          {TIME, FISH},           RESULT_REAL,    "m s-1",  IN_FISH_DIAGNOSTICS(ground_speed),
     .long_name = "mean speed over ground over the last period"},
    {"drift",                 {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(drift),
     .long_name = "relative change of the speed between the last two periods"},
    {"heading",               {TIME, FISH},           RESULT_REAL,    "degree", IN_FISH_DIAGNOSTICS(heading),
     .long_name = "heading, from the x axis towards the y axis, unwrapped"},
    {"desired_heading",       {TIME, FISH},           RESULT_REAL,    "degree", IN_FISH_DIAGNOSTICS(desired_heading),
     .long_name = "desired heading of the control law"},
    {"heading_error",         {TIME, FISH},           RESULT_REAL,    "degree", IN_FISH_DIAGNOSTICS(heading_error),
     .long_name = "direction of the path through the water over the last period, less desired_heading"},
    {"phi0",                  {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(phi0),
     .long_name = "steering bias of the gait: positive turns right"},
    {"bias_reversals",        {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(bias_reversals),
     .long_name = "reversals of the steering bias of a control law in the last period"},
    {"wave_amplitude",        {TIME, FISH},           RESULT_REAL,    "rad",    IN_FISH_DIAGNOSTICS(wave_amplitude),
     .long_name = "current amplitude of the wave"},
    {"wave_frequency",        {TIME, FISH},           RESULT_REAL,    "Hz",     IN_FISH_DIAGNOSTICS(wave_frequency),
     .long_name = "current frequency of the beat"},
    {"swept_vortices",        {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(swept_vortices),
     .long_name = "free vortices of any fish inside the outline of the body"},
    {"shed_circulation",      {TIME, FISH},           RESULT_REAL,    "m2 s-1", IN_FISH_DIAGNOSTICS(shed_circulation),
     .long_name = "total circulation shed since the start"},
    {"shedding_rate",         {TIME, FISH},           RESULT_REAL,    "m2 s-2", IN_FISH_DIAGNOSTICS(shedding_rate),
     .long_name = "rate at which circulation is shed"},
    {"kinetic_energy",        {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(kinetic_energy),
     .long_name = "kinetic energy of the body"},
    {"bending_energy",        {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(bending_energy),
     .long_name = "elastic energy of bending"},
    {"stretching_energy",     {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(stretching_energy),
     .long_name = "elastic energy of stretching"},
    {"contact_energy",        {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(contact_energy),
     .long_name = "half of the potential energy of contacts"},
    {"added_mass_energy",     {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(added_mass_energy),
     .long_name = "kinetic energy of the accelerated fluid"},
    {"actuation_power",       {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(actuation_power),
     .long_name = "power of the muscle on the body"},
    {"damping_power",         {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(damping_power),
     .long_name = "power of the internal damping"},
    {"drag_power",            {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(drag_power),
     .long_name = "power of the drag on the body"},
    {"friction_power",        {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(friction_power),
     .long_name = "part of drag_power: of the drag along the body"},
    {"cross_flow_power",      {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(cross_flow_power),
     .long_name = "part of drag_power: of the drag across the body"},
    {"pressure_power",        {TIME, FISH},           RESULT_REAL,    "W",
     IN_FISH_DIAGNOSTICS(pressure.pressure_power),
     .long_name = "power on the body of the pressure; 0 unless force: pressure"},
    {"suction_power",         {TIME, FISH},           RESULT_REAL,    "W",
     IN_FISH_DIAGNOSTICS(pressure.suction_power),
     .long_name = "power on the body of the suction at the leading edge; 0 unless force: pressure"},
    {"separation_power",      {TIME, FISH},           RESULT_REAL,    "W",
     IN_FISH_DIAGNOSTICS(pressure.separation_power),
     .long_name = "power lost to separated flow: suction of attached flow less suction_power"},
    {"added_mass_power",      {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(added_mass_power),
     .long_name = "power of the accelerated fluid on the body, without the tail flux"},
    {"wake_power",            {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(wake_power),
     .long_name = "power of the tail flux on the body"},
    {"constraint_power",      {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(constraint_power),
     .long_name = "power of the forces on prescribed nodes, and of loads"},
    {"contact_power",         {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(contact_power),
     .long_name = "power of contact forces on the body and into contact_energy"},
    {"energy_balance",          {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(energy_balance),
     .long_name = "change of energy less the integral of all powers: error of the integration"},
    {"actuation_work",        {TIME, FISH},           RESULT_REAL,    "J",      IN_FISH_DIAGNOSTICS(actuation_work),
     .long_name = "work of the muscle on the body since the start"},
    {"mean_actuation_power",  {TIME, FISH},           RESULT_REAL,    "W",
     IN_FISH_DIAGNOSTICS(mean_actuation_power),
     .long_name = "mean power of the muscle, over the last period"},
    {"cost_of_transport",     {TIME, FISH},           RESULT_REAL,    "m s-2",  IN_FISH_DIAGNOSTICS(cost_of_transport),
     .long_name = "mean power of muscle and drive over mass and speed, relative to the water, over the last period"},
    {"cost_of_transport_fluid",{TIME, FISH},           RESULT_REAL,    "m s-2",
     IN_FISH_DIAGNOSTICS(cost_of_transport_fluid),
     .long_name = "part of cost_of_transport: into the fluid"},
    {"cost_of_transport_body",{TIME, FISH},           RESULT_REAL,    "m s-2",
     IN_FISH_DIAGNOSTICS(cost_of_transport_body),
     .long_name = "part of cost_of_transport: by internal damping"},
    {"efficiency",            {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(efficiency),
     .long_name = "mean_thrust times speed over mean_power of a held body, else friction times speed over power "
                  "into the fluid, over the last period"},
    {"towed_efficiency",      {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(towed_efficiency),
     .long_name = "quasi-propulsive: drag of the towed straight body times speed over power into the fluid, over the "
                  "last period; NaN for a held body"},
    {"mean_thrust",           {TIME, FISH},           RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(mean_thrust),
     .long_name = "mean force of the fluid along the path over the last period: 0 in steady swimming"},
    {"mean_power",            {TIME, FISH},           RESULT_REAL,    "W",      IN_FISH_DIAGNOSTICS(mean_power),
     .long_name = "mean power of muscle and drive over the last period; held body: without the work of the thrust"},
    {"strouhal",              {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(strouhal),
     .long_name = "Strouhal number: frequency times peak-to-peak tail motion over speed"},

    // forces on the body by name
    {"resistive_force",       {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(resistive_force),
     .long_name = "drag on the body"},
    {"reactive_force",        {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(reactive_force),
     .long_name = "reactive force, with tail flux and pressure gradient of the external flow"},
    {"friction_force",        {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(friction_force),
     .long_name = "part of resistive_force: the drag along the body"},
    {"cross_flow_force",      {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(cross_flow_force),
     .long_name = "part of resistive_force: the drag across the body"},
    {"pressure_force",        {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(pressure.pressure),
     .long_name = "force of the pressure jump across the bound sheet; 0 unless force: pressure"},
    {"suction_force",         {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(pressure.suction),
     .long_name = "suction at the leading edge; 0 unless force: pressure"},
    {"separation_force",      {TIME, FISH, XY},       RESULT_REAL,    "N",
     IN_FISH_DIAGNOSTICS(pressure.separation),
     .long_name = "suction of attached flow less suction_force"},
    {"added_momentum",        {TIME, FISH, XY},       RESULT_REAL,    "N s",    IN_FISH_DIAGNOSTICS(pressure.momentum),
     .long_name = "added momentum of the body; 0 unless force: pressure"},
    {"constraint_force",      {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(constraint_force),
     .long_name = "force on prescribed nodes; 0 for a free fish"},
    {"contact_force",         {TIME, FISH, XY},       RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(contact_force),
     .long_name = "force of the bodies in contact"},
    {"thrust",                {TIME, FISH},           RESULT_REAL,    "N",      IN_FISH_DIAGNOSTICS(thrust),
     .long_name = "force of the fluid along the heading, or with prescribed motion along the direction of travel "
                  "through the water"},
    {"resistive_moment",      {TIME, FISH},           RESULT_REAL,    "N m",    IN_FISH_DIAGNOSTICS(resistive_moment),
     .long_name = "moment of the drag about the centre of mass"},
    {"reactive_moment",       {TIME, FISH},           RESULT_REAL,    "N m",    IN_FISH_DIAGNOSTICS(reactive_moment),
     .long_name = "moment of the reactive force about the centre of mass"},
    {"friction_moment",       {TIME, FISH},           RESULT_REAL,    "N m",    IN_FISH_DIAGNOSTICS(friction_moment),
     .long_name = "part of resistive_moment: of the drag along the body"},
    {"pressure_moment",       {TIME, FISH},           RESULT_REAL,    "N m",
     IN_FISH_DIAGNOSTICS(pressure.pressure_moment),
     .long_name = "moment of the pressure about the centre of mass"},
    {"suction_moment",        {TIME, FISH},           RESULT_REAL,    "N m",
     IN_FISH_DIAGNOSTICS(pressure.suction_moment),
     .long_name = "moment of the suction about the centre of mass"},
    {"added_momentum_moment", {TIME, FISH},           RESULT_REAL,    "N m s",
     IN_FISH_DIAGNOSTICS(pressure.momentum_moment),
     .long_name = "moment of the added momentum about the centre of mass"},
    {"constraint_moment",     {TIME, FISH},           RESULT_REAL,    "N m",    IN_FISH_DIAGNOSTICS(constraint_moment),
     .long_name = "moment of constraint_force about the centre of mass"},

    // momentum of the fluid, and external forces
    {"fluid_impulse",         {TIME, FISH, XY},       RESULT_REAL,    "N s",    IN_FISH_DIAGNOSTICS(fluid_impulse),
     .long_name = "impulse of bound, free and lost vortices; NaN for a varying depth"},
    {"fluid_angular_impulse", {TIME, FISH},           RESULT_REAL,    "N m s",  IN_FISH_DIAGNOSTICS(fluid_impulse[2]),
     .long_name = "angular impulse of the vortices about the origin"},
    {"lost_impulse",          {TIME, FISH, XY},       RESULT_REAL,    "N s",    IN_FISH_DIAGNOSTICS(lost_impulse),
     .long_name = "part of fluid_impulse: of decayed and removed circulation"},
    {"lost_angular_impulse",  {TIME, FISH},           RESULT_REAL,    "N m s",  IN_FISH_DIAGNOSTICS(lost_impulse[2]),
     .long_name = "part of fluid_angular_impulse: of decayed and removed circulation"},
    {"leg_impulse",           {TIME, FISH, XY},       RESULT_REAL,    "N s",    IN_FISH_DIAGNOSTICS(leg_impulse),
     .long_name = "momentum that the growing lengths of the legs of rings take; NaN without reaction"},
    {"leg_angular_impulse",   {TIME, FISH},           RESULT_REAL,    "N m s",  IN_FISH_DIAGNOSTICS(leg_impulse[2]),
     .long_name = "angular momentum about the origin, like leg_impulse"},
    {"external_impulse",      {TIME, FISH, XY},       RESULT_REAL,    "N s",    IN_FISH_DIAGNOSTICS(external_impulse),
     .long_name = "impulse of drag, contacts, loads, constraint, separation, walls, stream; NaN without reaction"},
    {"external_angular_impulse",{TIME, FISH},         RESULT_REAL,    "N m s",
     IN_FISH_DIAGNOSTICS(external_impulse[2]),
     .long_name = "angular impulse about the origin, like external_impulse"},

    {"edge_resistive_force",  {TIME, FISH, EDGE, XY}, RESULT_BULK,    "N",
     OF_EDGES(EDGE_RESISTIVE_FORCE), .forces = OUTPUT_FORCES_EDGES,
     .long_name = "drag on every edge; with output.forces: edges only"},
    {"edge_reactive_force",   {TIME, FISH, EDGE, XY}, RESULT_BULK,    "N",
     OF_EDGES(EDGE_REACTIVE_FORCE), .forces = OUTPUT_FORCES_EDGES,
     .long_name = "reactive force on every edge, the last with the tail flux; with output.forces: edges only"},

    {"edge_pressure_force",   {TIME, FISH, EDGE, XY}, RESULT_BULK,    "N",
     OF_EDGES(EDGE_PRESSURE_FORCE), .forces = OUTPUT_FORCES_EDGES,
     .long_name = "force of the pressure on every edge; with output.forces: edges only"},
    {"pressure",              {TIME, FISH, CONTROL},  RESULT_BULK,    "Pa",     OF_SHEET(PRESSURE),
     .long_name = "pressure jump at control points, right side of the body less left side; NaN unless force: pressure"},
    {"sensor_pressure_left",  {TIME, FISH, SENSOR},   RESULT_REAL,    "Pa",
     OF_SHEET(SENSOR_LEFT),
     .long_name = "pressure on the left side of the body at the sensors, less the pressure of the undisturbed stream"},
    {"sensor_pressure_right", {TIME, FISH, SENSOR},   RESULT_REAL,    "Pa",
     OF_SHEET(SENSOR_RIGHT),
     .long_name = "pressure on the right side of the body at the sensors, less the pressure of the undisturbed stream"},
    {"left_friction",         {TIME, FISH, XY},       RESULT_REAL,    "N",
     OF_SIDES(LEFT_FRICTION), .forces = OUTPUT_FORCES_SIDES,
     .long_name = "laminar friction on the left side by Thwaites' method; with output.forces: sides only"},
    {"right_friction",        {TIME, FISH, XY},       RESULT_REAL,    "N",
     OF_SIDES(RIGHT_FRICTION), .forces = OUTPUT_FORCES_SIDES,
     .long_name = "laminar friction on the right side; with output.forces: sides only"},
    {"left_separation",       {TIME, FISH},           RESULT_REAL,    "1",
     OF_SIDES(LEFT_SEPARATION), .forces = OUTPUT_FORCES_SIDES,
     .long_name = "separation of the laminar boundary layer on the left: distance from the nose over the length; NaN: "
                  "none; with output.forces: sides only"},
    {"right_separation",      {TIME, FISH},           RESULT_REAL,    "1",
     OF_SIDES(RIGHT_SEPARATION), .forces = OUTPUT_FORCES_SIDES,
     .long_name = "left_separation of the right side; with output.forces: sides only"},
    {"friction_ratio",        {TIME, FISH},           RESULT_REAL,    "1",
     OF_SIDES(FRICTION_RATIO), .forces = OUTPUT_FORCES_SIDES,
     .long_name = "friction of both sides along the body over that of the law that acts; with output.forces: sides "
                  "only"},
    {"leading_edge_a0",       {TIME, FISH},           RESULT_REAL,    "1",
     IN_FISH_DIAGNOSTICS(pressure.leading_edge_a0),
     .long_name = "leading-edge suction parameter A_0 of the flow past the nose; NaN unless force: pressure"},
    {"leading_edge_most",     {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(leading_edge_most),
     .long_name = "largest magnitude of leading_edge_a0 over the last period"},
    {"separation_share",      {TIME, FISH},           RESULT_REAL,    "1",      IN_FISH_DIAGNOSTICS(separation_share),
     .long_name = "part of the last period with leading_edge_a0 above pressure.suction_limit in magnitude"},

    // the school and the solver
    {"total_circulation",     {TIME},                 RESULT_REAL,    "m2 s-1", IN_DIAGNOSTICS(total_circulation),
     .long_name = "sum of all circulation: zero but for rounding"},
    {"momentum_balance",        {TIME, XY},             RESULT_REAL,    "N s",    IN_DIAGNOSTICS(momentum_balance),
     .long_name = "change of momentum and fluid_impulse of the school, less external_impulse; NaN with "
                  "force: reactive, or with different or varying depths of infinite span"},
    {"angular_momentum_balance",{TIME},                 RESULT_REAL,    "N m s",  IN_DIAGNOSTICS(momentum_balance[2]),
     .long_name = "angular momentum balance about the origin, like momentum_balance"},
    {"least_distance",        {TIME},                 RESULT_REAL,    "m",      IN_DIAGNOSTICS(least_distance),
     .long_name = "smallest distance between two bodies"},
    {"polarisation",          {TIME},                 RESULT_REAL,    "1",      IN_DIAGNOSTICS(polarisation),
     .long_name = "length of the mean unit vector of the headings"},
    {"differential_unknowns", {FISH},                 RESULT_REAL,    "1",      OF_EQUATIONS(DIFFERENTIAL),
     .long_name = "number of unknowns whose rates occur in the equations"},
    {"algebraic_unknowns",    {FISH},                 RESULT_REAL,    "1",      OF_EQUATIONS(ALGEBRAIC),
     .long_name = "number of all other unknowns"},
    {"steps",                 {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(steps),
     .long_name = "steps of the integrator since the start"},
    {"steps_of_order",        {TIME, ORDER},          RESULT_COUNT,   "1",      IN_COUNTS(steps_of_order),
     .long_name = "steps of order 1, 2, ... since the start"},
    {"residual_evaluations",  {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(residual_evaluations),
     .long_name = "evaluations of the residual since the start"},
    {"newton_iterations",     {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(newton_iterations),
     .long_name = "Newton iterations since the start"},
    {"jacobian_evaluations",  {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(jacobian_evaluations),
     .long_name = "evaluations of the Jacobian since the start"},
    {"klu_analyses",          {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(klu_analyses),
     .long_name = "sparsity patterns analysed by KLU since the start"},
    {"klu_factorisations",    {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(klu_factorisations),
     .long_name = "factorisations by KLU with new pivots since the start"},
    {"klu_refactorisations",  {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(klu_refactorisations),
     .long_name = "factorisations by KLU with the pivots of an earlier one since the start"},
    {"gmres_iterations",      {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(gmres_iterations),
     .long_name = "iterations of GMRES for coupled fish since the start"},
    {"error_test_failures",   {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(error_test_failures),
     .long_name = "steps rejected by the error test since the start"},
    {"convergence_failures",  {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(convergence_failures),
     .long_name = "steps rejected by Newton's iteration since the start"},
    {"initial_iterations",    {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(initial_iterations),
     .long_name = "iterations of KINSOL for consistent states since the start, each with a Jacobian and its factors"},
    {"jacobian_non_zeros",    {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(jacobian_non_zeros),
     .long_name = "entries of the last Jacobian, with the couplings of fish"},
    {"factor_non_zeros",      {TIME},                 RESULT_COUNT,   "1",      IN_COUNTS(factor_non_zeros),
     .long_name = "entries of the factors of the last Jacobian"},
    {"step_size",             {TIME},                 RESULT_REAL,    "s",      IN_COUNTS(step_size),
     .long_name = "size of the last step of the integrator"},
    {"order",                 {TIME},                 RESULT_INTEGER, "1",      IN_COUNTS(order),
     .long_name = "order of the last step"},
    {"wall_time",             {TIME},                 RESULT_REAL,    "s",      IN_ROW(wall_time),
     .long_name = "wall-clock time since the start of the run"},
};
// clang-format on
const int result_table_n = sizeof result_table / sizeof *result_table;
_Static_assert(FORCE_REACTIVE == 0 && FORCE_PUBLISHED == 1 && FORCE_PRESSURE == 2 && sizeof(enum force) == sizeof(int),
               "fluid_force is stored unchanged");
_Static_assert(sizeof result_table / sizeof *result_table <= RESULT_TABLE_MAX, "raise RESULT_TABLE_MAX");

// ---- look-ups ----

const char *result_table_dimension(enum result_dimension dimension) {
    static const char *const name[] = {"",      "time",    "fish",   "node",         "edge", "joint",
                                       "sheet", "control", "vortex", "xy",           "name", "multiplier",
                                       "slow",  "wall",    "sensor", "order_of_step"};
    return name[dimension];
}

bool result_table_has(const struct result_variable *variable, enum result_dimension dimension) {
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++)
        if (*d == dimension) return true;
    return false;
}

int result_table_length(const struct fish *fish, enum result_dimension dimension) {
    switch (dimension) {
        case NODE: return fish->n_nodes;
        case EDGE: return fish->n_edges;
        case JOINT: return fish->n_joints;
        case SHEET: return fish->n_sheet;
        case CONTROL: return fish->n_control;
        case SENSOR: return fish->n_sensors;
        default: return 1;
    }
}

const void *result_table_owner(const struct result_row *row, enum result_owner owner, int f) {
    static const char *const axis_name[] = {"x", "y"};
    switch (owner) {
        case OF_SCHOOL: return row->school;
        case OF_FISH: return &row->school->fish[f];
        case OF_STATE: return row->state;
        case OF_WAKE: return &row->state->wake[f];
        case OF_DIAGNOSTICS: return row->diagnostics;
        case OF_DIAGNOSTICS_FISH: return &row->diagnostics->fish[f];
        case OF_COUNTS: return row->counts;
        case OF_AXIS: return &axis_name[f];
        case OF_STEADY: return row->steady;
        case OF_STEADY_FISH: return row->steady ? &row->steady->fish[f] : NULL;
        default: return row;
    }
}

// ---- the list of variables

int result_table_listed(int i, struct result_listed *listed) {
    static const char *const types[] = {"double", "double or float", "int", "int64", "char"};
    if (i >= result_table_n) return 0;
    const struct result_variable *const variable = &result_table[i];
    *listed = (struct result_listed){variable->name, variable->unit, types[variable->type], variable->long_name, "",
                                     variable->flags};
    size_t length = 0;

    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        length += (size_t)snprintf(listed->dimensions + length, sizeof listed->dimensions - length, "%s%s",
                                   length > 0 ? ", " : "", result_table_dimension(*d));
    }

    return 1;
}
