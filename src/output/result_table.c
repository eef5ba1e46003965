/* result_table.c: the table of variables. */
#include "output/result_table.h"

#include <string.h>

#include "model/bound_sheet.h"
#include "model/rod.h"

// ---- values that have to be put together ----

static void interleave(int n, const double *x, const double *y, double *slots) {
    for (int i = 0; i < n; i++) {
        slots[2 * i] = x[i];
        slots[2 * i + 1] = y[i];
    }
}

static void copy(int n, const double *value, double *slots) {
    for (int i = 0; i < n; i++) slots[i] = value[i];
}

static void gather_position(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    interleave(fish->n_nodes, row->state->y + fish->at.x, row->state->y + fish->at.y, slots);
}

static void gather_velocity(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    interleave(fish->n_nodes, row->state->y + fish->at.vx, row->state->y + fish->at.vy, slots);
}

static void gather_acceleration(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    interleave(fish->n_nodes, row->state->y + fish->at.ax, row->state->y + fish->at.ay, slots);
}

static void gather_curvature(const struct result_row *row, int f, double *slots) {
    rod_curvature(&row->school->fish[f], row->state->y, slots);
}

static void gather_natural_curvature(const struct result_row *row, int f, double *slots) {
    const struct range joints = row->residual->joints[f];
    copy(joints.n, row->residual->natural_curvature + joints.first, slots);
}

static void gather_sheet_position(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int j = 0; j < fish->n_sheet; j++) {
        slots[2 * j] = fish_mean(&fish->sheet_point[j], row->state->y + fish->at.x);
        slots[2 * j + 1] = fish_mean(&fish->sheet_point[j], row->state->y + fish->at.y);
    }
}

static void gather_sheet_strength(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int j = 0; j < fish->n_sheet; j++) slots[j] = bound_sheet_strength(fish, j, row->state->y);
}

static void gather_sheet_arc(const struct result_row *row, int f, double *slots) {
    const struct fish *fish = &row->school->fish[f];
    for (int j = 0; j < fish->n_sheet; j++) slots[j] = fish_mean(&fish->sheet_point[j], fish->arc);
}

static void gather_wake_position(const struct result_row *row, int f, double *slots) {
    const struct wake *wake = &row->state->wake[f];
    if (row->with_wake) interleave(wake->n_vortex, wake->x, wake->y, slots);
}

static void gather_wake_circulation(const struct result_row *row, int f, double *slots) {
    const struct wake *wake = &row->state->wake[f];
    for (int i = 0; row->with_wake && i < wake->n_vortex; i++) slots[i] = wake_circulation(wake, i);
}

static void gather_wake_birth(const struct result_row *row, int f, double *slots) {
    const struct wake *wake = &row->state->wake[f];
    if (row->with_wake) copy(wake->n_vortex, wake->birth, slots);
}

// ---- the table ----

#define IN_SCHOOL(field) .owner = OF_SCHOOL, .offset = offsetof(struct school, field)
#define IN_FISH(field) .owner = OF_FISH, .offset = offsetof(struct fish, field)
#define ARRAY_IN_FISH(field) IN_FISH(field), .is_pointer = true
#define IN_STATE(field) .owner = OF_STATE, .offset = offsetof(struct state, field)
#define IN_WAKE(field) .owner = OF_WAKE, .offset = offsetof(struct wake, field)
#define IN_DIAGNOSTICS(field) .owner = OF_DIAGNOSTICS, .offset = offsetof(struct diagnostics, field)
#define OF_EACH_FISH(field) .owner = OF_DIAGNOSTICS_FISH, .offset = offsetof(struct diagnostics_fish, field)
#define IN_COUNTS(field) .owner = OF_COUNTS, .offset = offsetof(struct integrator_counts, field)
#define IN_ROW(field) .owner = OF_ROW, .offset = offsetof(struct result_row, field)
#define GATHERED(function) .gather = function

// clang-format off
const struct result_variable result_table[] = {
    // what does not change
    {"fish_name",             {FISH, NAME},           RESULT_TEXT,    "",        "name of the fish", ARRAY_IN_FISH(name)},
    {"n_nodes",               {FISH},                 RESULT_INTEGER, "1",       "number of nodes", IN_FISH(n_nodes)},
    {"n_edges",               {FISH},                 RESULT_INTEGER, "1",       "number of edges", IN_FISH(n_edges)},
    {"n_joints",              {FISH},                 RESULT_INTEGER, "1",       "number of joints", IN_FISH(n_joints)},
    {"n_sheet",               {FISH},                 RESULT_INTEGER, "1",       "number of bound vortices", IN_FISH(n_sheet)},
    {"body_length",           {FISH},                 RESULT_REAL,    "m",       "body length", IN_FISH(length)},
    {"edge_length",           {FISH},                 RESULT_REAL,    "m",       "natural length of every edge", IN_FISH(edge_length)},
    {"body_mass",             {FISH},                 RESULT_REAL,    "kg",      "mass of the body", IN_FISH(total_mass)},
    {"frequency",             {FISH},                 RESULT_REAL,    "Hz",      "frequency of the beat", IN_FISH(frequency)},
    {"bias",                  {FISH},                 RESULT_REAL,    "1",       "bias of the gait that the case gives, for a fish without a control law", IN_FISH(control.bias)},
    {"wake_smoothing",        {FISH},                 RESULT_REAL,    "m",       "smoothing radius of the free vortices", IN_FISH(smoothing)},
    {"sheet_smoothing",       {FISH},                 RESULT_REAL,    "m",       "smoothing radius of the bound vortices seen from elsewhere", IN_FISH(sheet_smoothing)},
    {"node_arc",              {FISH, NODE},           RESULT_REAL,    "m",       "arc coordinate of the nodes, from the nose", ARRAY_IN_FISH(arc)},
    {"node_mass",             {FISH, NODE},           RESULT_REAL,    "kg",      "mass of the nodes", ARRAY_IN_FISH(mass)},
    {"edge_height",           {FISH, EDGE},           RESULT_REAL,    "m",       "thickness of the body in the plane of motion", ARRAY_IN_FISH(thickness)},
    {"edge_width",            {FISH, EDGE},           RESULT_REAL,    "m",       "extent of the body out of the plane of motion", ARRAY_IN_FISH(depth)},
    {"sheet_arc",             {FISH, SHEET},          RESULT_REAL,    "m",       "arc coordinate of the bound vortices, from the nose", GATHERED(gather_sheet_arc)},
    {"sheet_weight",          {FISH, SHEET},          RESULT_REAL,    "m",       "natural length of body of a bound vortex: circulation over strength where nothing is stretched", ARRAY_IN_FISH(sheet_weight)},
    {"fluid_density",         {NONE},                 RESULT_REAL,    "kg m-3",  "density of the fluid", IN_SCHOOL(density)},
    {"shedding_interval",     {NONE},                 RESULT_REAL,    "s",       "time between the release of two vortices", IN_SCHOOL(interval)},
    {"wake_lifetime",         {NONE},                 RESULT_REAL,    "s",       "age at which a free vortex is removed", IN_SCHOOL(lifetime)},
    {"wake_fade",             {NONE},                 RESULT_REAL,    "s",       "last part of its life in which a free vortex fades out", IN_SCHOOL(decay)},

    // the bodies and the fluid
    {"time",                  {TIME},                 RESULT_REAL,    "s",       "time", IN_STATE(t)},
    {"x",                     {TIME, FISH, NODE, XY}, RESULT_BULK,    "m",       "position of the nodes, nose first", GATHERED(gather_position)},
    {"v",                     {TIME, FISH, NODE, XY}, RESULT_BULK,    "m s-1",   "velocity of the nodes", GATHERED(gather_velocity)},
    {"a",                     {TIME, FISH, NODE, XY}, RESULT_BULK,    "m s-2",   "acceleration of the nodes", GATHERED(gather_acceleration)},
    {"natural_curvature",     {TIME, FISH, JOINT},    RESULT_BULK,    "1",       "natural curvature of the joints, 2 tan(angle/2): the shape the muscle asks for", GATHERED(gather_natural_curvature)},
    {"curvature",             {TIME, FISH, JOINT},    RESULT_BULK,    "1",       "curvature of the joints, 2 tan(angle/2)", GATHERED(gather_curvature)},
    {"sheet_x",               {TIME, FISH, SHEET, XY}, RESULT_BULK,   "m",       "position of the bound vortices", GATHERED(gather_sheet_position)},
    {"sheet_strength",        {TIME, FISH, SHEET},    RESULT_BULK,    "m s-1",   "strength of the bound vortices: circulation per length of body", GATHERED(gather_sheet_strength)},
    {"wake_count",            {TIME, FISH},           RESULT_INTEGER, "1",       "number of free vortices", IN_WAKE(n_vortex)},
    {"wake_x",                {TIME, FISH, VORTEX, XY}, RESULT_BULK,  "m",       "position of the free vortices, oldest first", GATHERED(gather_wake_position)},
    {"wake_circulation",      {TIME, FISH, VORTEX},   RESULT_BULK,    "m2 s-1",  "circulation of the free vortices, without fading", GATHERED(gather_wake_circulation)},
    {"wake_birth",            {TIME, FISH, VORTEX},   RESULT_BULK,    "s",       "time of release of the free vortices", GATHERED(gather_wake_birth)},

    // derived quantities of each fish
    {"com",                   {TIME, FISH, XY},       RESULT_REAL,    "m",       "position of the centre of mass", OF_EACH_FISH(com)},
    {"com_velocity",          {TIME, FISH, XY},       RESULT_REAL,    "m s-1",   "velocity of the centre of mass", OF_EACH_FISH(com_velocity)},
    {"speed",                 {TIME, FISH},           RESULT_REAL,    "m s-1",   "speed of the centre of mass over the last period", OF_EACH_FISH(speed)},
    {"heading",               {TIME, FISH},           RESULT_REAL,    "degree",  "heading, from the x axis towards the y axis, unwrapped", OF_EACH_FISH(heading)},
    {"desired_heading",       {TIME, FISH},           RESULT_REAL,    "degree",  "heading that the control law asks for", OF_EACH_FISH(desired_heading)},
    {"phi0",                  {TIME, FISH},           RESULT_REAL,    "1",       "bias of the gait: positive turns right", OF_EACH_FISH(phi0)},
    {"shed_circulation",      {TIME, FISH},           RESULT_REAL,    "m2 s-1",  "all circulation shed since the start", OF_EACH_FISH(shed_circulation)},
    {"shedding_rate",         {TIME, FISH},           RESULT_REAL,    "m2 s-2",  "rate at which circulation is shed", OF_EACH_FISH(shedding_rate)},
    {"kinetic_energy",        {TIME, FISH},           RESULT_REAL,    "J",       "kinetic energy of the body", OF_EACH_FISH(kinetic_energy)},
    {"bending_energy",        {TIME, FISH},           RESULT_REAL,    "J",       "elastic energy of bending", OF_EACH_FISH(bending_energy)},
    {"stretching_energy",     {TIME, FISH},           RESULT_REAL,    "J",       "elastic energy of stretching", OF_EACH_FISH(stretching_energy)},
    {"added_mass_energy",     {TIME, FISH},           RESULT_REAL,    "J",       "kinetic energy of the fluid that the body accelerates", OF_EACH_FISH(added_mass_energy)},
    {"actuation_power",       {TIME, FISH},           RESULT_REAL,    "W",       "power that the muscle puts into the body", OF_EACH_FISH(actuation_power)},
    {"damping_power",         {TIME, FISH},           RESULT_REAL,    "W",       "power of the internal damping", OF_EACH_FISH(damping_power)},
    {"drag_power",            {TIME, FISH},           RESULT_REAL,    "W",       "power of the drag on the body", OF_EACH_FISH(drag_power)},
    {"added_mass_power",      {TIME, FISH},           RESULT_REAL,    "W",       "power on the body of the fluid that it accelerates, without what leaves at the tail", OF_EACH_FISH(added_mass_power)},
    {"wake_power",            {TIME, FISH},           RESULT_REAL,    "W",       "power on the body of what leaves at the tail", OF_EACH_FISH(wake_power)},
    {"driving_power",         {TIME, FISH},           RESULT_REAL,    "W",       "power of the forces that hold driven nodes to their motion, and of loads", OF_EACH_FISH(driving_power)},
    {"energy_audit",          {TIME, FISH},           RESULT_REAL,    "J",       "energy less its first value less the integral of all powers: the error of integration", OF_EACH_FISH(energy_audit)},
    {"actuation_work",        {TIME, FISH},           RESULT_REAL,    "J",       "work that the muscle has put into the body since the start", OF_EACH_FISH(actuation_work)},
    {"cost_of_transport",     {TIME, FISH},           RESULT_REAL,    "m s-2",   "mean actuation power over mass and speed, over the last period", OF_EACH_FISH(cost_of_transport)},
    {"strouhal",              {TIME, FISH},           RESULT_REAL,    "1",       "Strouhal number: frequency times peak-to-peak motion of the tail over speed", OF_EACH_FISH(strouhal)},

    // the school and the solver
    {"total_circulation",     {TIME},                 RESULT_REAL,    "m2 s-1",  "sum of all bound, free and dissipated circulation: zero but for rounding", IN_DIAGNOSTICS(total_circulation)},
    {"least_distance",        {TIME},                 RESULT_REAL,    "m",       "least distance between two bodies", IN_DIAGNOSTICS(least_distance)},
    {"polarisation",          {TIME},                 RESULT_REAL,    "1",       "length of the mean unit vector of the headings", IN_DIAGNOSTICS(polarisation)},
    {"steps",                 {TIME},                 RESULT_COUNT,   "1",       "steps of the integrator since the start", IN_COUNTS(steps)},
    {"residual_evaluations",  {TIME},                 RESULT_COUNT,   "1",       "evaluations of the residual since the start", IN_COUNTS(residual_evaluations)},
    {"newton_iterations",     {TIME},                 RESULT_COUNT,   "1",       "Newton iterations since the start", IN_COUNTS(newton_iterations)},
    {"jacobian_evaluations",  {TIME},                 RESULT_COUNT,   "1",       "evaluations of the Jacobian since the start", IN_COUNTS(jacobian_evaluations)},
    {"error_test_failures",   {TIME},                 RESULT_COUNT,   "1",       "steps refused by the error test since the start", IN_COUNTS(error_test_failures)},
    {"convergence_failures",  {TIME},                 RESULT_COUNT,   "1",       "steps refused because Newton did not converge since the start", IN_COUNTS(convergence_failures)},
    {"step_size",             {TIME},                 RESULT_REAL,    "s",       "last step of the integrator", IN_COUNTS(step_size)},
    {"order",                 {TIME},                 RESULT_INTEGER, "1",       "order of the last step", IN_COUNTS(order)},
    {"wall_time",             {TIME},                 RESULT_REAL,    "s",       "time the run has taken so far", IN_ROW(wall_time)},
};
// clang-format on
const int result_table_n = sizeof result_table / sizeof *result_table;
_Static_assert(sizeof result_table / sizeof *result_table <= RESULT_TABLE_MAX, "raise RESULT_TABLE_MAX");

// ---- look-ups ----

const char *result_table_dimension(enum result_dimension dimension) {
    static const char *const name[] = {"", "time", "fish", "node", "edge", "joint", "sheet", "vortex", "xy", "name"};
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
        default: return 1;
    }
}

const void *result_table_owner(const struct result_row *row, enum result_owner owner, int f) {
    switch (owner) {
        case OF_SCHOOL: return row->school;
        case OF_FISH: return &row->school->fish[f];
        case OF_STATE: return row->state;
        case OF_WAKE: return &row->state->wake[f];
        case OF_DIAGNOSTICS: return row->diagnostics;
        case OF_DIAGNOSTICS_FISH: return &row->diagnostics->fish[f];
        case OF_COUNTS: return row->counts;
        default: return row;
    }
}

// ---- the list of variables

static const char *type_name(enum result_type type) {
    static const char *const name[] = {"double", "double or float", "int", "int64", "char"};
    return name[type];
}

int result_table_listed(int i, struct result_listed *listed) {
    if (i >= result_table_n) return 0;
    const struct result_variable *const variable = &result_table[i];
    *listed =
        (struct result_listed){variable->name, variable->unit, type_name(variable->type), variable->long_name, ""};
    size_t length = 0;
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) {
        length += (size_t)snprintf(listed->dimensions + length, sizeof listed->dimensions - length, "%s%s",
                                   length > 0 ? ", " : "", result_table_dimension(*d));
    }
    return 1;
}
