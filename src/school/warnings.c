/* warnings.c: the size of every defect of a result, relative to the limit of the warning, and the message. */
#include "school/warnings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "body/rod.h"

/* Input of a warning about one fish. */
struct subject {
    const struct school *school;
    const struct state *state;
    const struct diagnostics *diagnostics;
    double *scratch;
    const struct fish *fish;
    int f;
    double size; /* of struct kind */
};

/* The size of a defect without degrees. */
static const double always = 2;

/* A kind of warning about a single fish: size of the defect, above 1 a warning, and message. */
struct kind {
    double (*size)(const struct subject *subject);
    void (*say)(const struct subject *subject, const char *who, char line[WARNING_BYTES]);
};

// ---- energy

// the largest work, J
static double largest_work(const struct subject *subject) {
    const double *const work = subject->state->balance[subject->f].work;
    double max = 0;
    for (int i = 0; i < N_WORKS; i++) max = larger(max, fabs(work[i]));
    return max;
}

static double energy_size(const struct subject *subject) {
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    const double energy = now->kinetic_energy + now->bending_energy + now->stretching_energy;
    const double balance = fabs(now->energy_balance), rounding = 1e-12 * energy;
    double work = largest_work(subject);

    // the works are small in the first beat: include the energy of the body, and of one length per beat
    if (subject->state->t < subject->fish->period) {
        const double speed = subject->fish->length / subject->fish->period;
        work = larger(work, larger(energy, subject->fish->total_mass * speed * speed));
    }
    if (!isfinite(balance) || isnan(work)) return INFINITY;
    return balance > rounding && work > 0 ? balance / (0.01 * work) : 0;
}

static void energy_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(
        line, WARNING_BYTES,
        "energy balance of %s: residual %.2g J for %.2g J of work: reduce solver.rtol or solver.step; if the residual "
        "remains, the case is outside the range of the model",
        who, subject->diagnostics->fish[subject->f].energy_balance, largest_work(subject));
}

// ---- divergence

// upper bound of the speeds prescribed by the case, m s-1: sum for one fish of beat, motion, start, external flow, and
// free acceleration by the load; the largest sum of all fish
static double case_speed(const struct school *school, const struct state *state) {
    double most = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double beat = 2 * 3.14159265358979323846 * fish->length * fish_rate(school, fish);
        const double motion = fish->motion.omega * (fabs(fish->motion.heave) + fabs(fish->motion.pitch) * fish->length);
        const double load = hypot(fish->load_tip[0], fish->load_tip[1]) * state->t / fish->total_mass;
        const double stream = hypot(school->velocity[0], school->velocity[1]) +
                              hypot(school->gust[0], school->gust[1]) +
                              fabs(school->shear * fish_mass_mean(fish, state->y + fish->at.y));
        most = larger(most, beat + motion + load + stream + fabs(fish->start_speed) + fabs(fish->motion.speed));
    }
    return most;
}

// the circulation of a foil is about 3 L U, and a tail may be several times faster than the body: 100 is no physical
// result
static const double most_of_case = 100;

// replace the worst divergence and its fish by a worse divergence of the present state
static void divergence_find(const struct school *school, const struct state *state, double worst[N_DIVERGENCE],
                            long *diverged) {
    const double limit = most_of_case * case_speed(school, state);
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct wake *const wake = &state->wake[f];
        const double *const vx = state->y + fish->at.vx, *const vy = state->y + fish->at.vy;

        // the circulation of a marker is the circulation shed until the birth
        double speed = 0, circulation = fabs(state->y[fish->at.circulation]);
        for (int k = 0; k < fish->n_nodes; k++) speed = larger(speed, hypot(vx[k], vy[k]));
        for (int i = 0; i < wake->n_vortex; i++) circulation = larger(circulation, fabs(wake->circulation[i]));

        // a value that is not finite is above every limit; a body at rest without a beat has no limit
        const double most = larger(speed, circulation / fish->length);
        const double size = !isfinite(most) || !isfinite(limit) ? INFINITY : limit > 0 ? most / limit : 0;
        if (!(size > worst[DIVERGENCE_SIZE])) continue;
        const double now[N_DIVERGENCE] = {size, state->t, speed, circulation};
        memcpy(worst, now, sizeof now);
        *diverged = f;
    }
}

void warnings_remember(const struct school *school, struct state *state) {
    divergence_find(school, state, state->divergence, &state->diverged);
}

static int divergence_line(const struct school *school, const struct state *state, char line[WARNING_BYTES]) {
    double worst[N_DIVERGENCE];
    long diverged = state->diverged;
    memcpy(worst, state->divergence, sizeof worst);
    divergence_find(school, state, worst, &diverged);
    if (!(worst[DIVERGENCE_SIZE] > 1)) return 0;

    snprintf(line, WARNING_BYTES,
             "%.40s has diverged: at t = %.4g s node speed %.2g m/s, circulation %.2g m2/s, more than %g times the "
             "speeds of the case: reduce solver.rtol, solver.step or time.shedding_interval, or stiffen the body",
             school->fish[diverged].name, worst[DIVERGENCE_T], worst[DIVERGENCE_SPEED], worst[DIVERGENCE_CIRCULATION],
             most_of_case);
    return 1;
}

// ---- means over a beat

// two beats, up to the rounding error of the time
static double beats_size(const struct subject *subject) {
    const struct fish *const fish = subject->fish;
    const double needed = (1 - 1e-9) * 2 * fish->period;
    const int beats = fish_has_wave(fish) || fish->motion.omega > 0;
    return beats && subject->state->t > 0 ? needed / subject->state->t : 0;
}

static void beats_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    const double period = subject->fish->period;
    snprintf(line, WARNING_BYTES,
             "the run has %.3g beats of %s: means and powers are not those of a cycle; increase time.end to at least "
             "%.4g s",
             subject->state->t / period, who, 2 * period);
}

// ---- drift of the speed

static double drift_size(const struct subject *subject) {
    const double drift = subject->diagnostics->fish[subject->f].drift;
    if (!(subject->school->density > 0) || isnan(drift)) return 0;
    return fabs(drift) / 0.01;
}

static void drift_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "the speed of %s changes by %.1f %% from one beat to the next: the means are not steady; increase "
             "time.end or use "
             "`shoal steady`",
             who, 100 * subject->diagnostics->fish[subject->f].drift);
}

// ---- resolution

enum { MIN_EVENTS = 20 /* in a beat */ };

static double events_size(const struct subject *subject) {
    const double period = subject->fish->period;

    // tolerate the rounding error of the quotient
    return period > 0 ? (1 - 1e-9) * MIN_EVENTS * subject->school->interval / period : 0;
}

static void events_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "a beat of %s has only %.3g events: reduce time.shedding_interval to %.3g s for %d events", who,
             subject->fish->period / subject->school->interval, subject->fish->period / MIN_EVENTS, MIN_EVENTS);
}

// The sheet needs M - 1 >= 3.2/sqrt(U Dt/L). The warning begins at 0.9 of this number, because the error grows slowly
// (0.25 % of the circulation at 0.63), and only at nearly steady speed: every fish that starts from rest is slow.
static double sheet_needs(const struct subject *subject) {
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    return 3.2 / sqrt(now->speed * subject->school->interval / subject->fish->length);
}

static double sheet_size(const struct subject *subject) {
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    if (subject->school->shedding != SHEDDING_SHEET || !(now->speed > 0)) return 0;
    // an equilibrium has no shedding
    if (subject->state->wake[subject->f].n_vortex == 0) return 0;

    const double nearly = 0.1;
    if (subject->fish->period > 0 && !(fabs(now->drift) < nearly)) return 0;

    // a fish that needs more points does not swim
    const double most = 1000;
    return sheet_needs(subject) < most ? 0.9 * sheet_needs(subject) / (subject->fish->n_sheet - 1) : 0;
}

static void sheet_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "%s swims %.2g lengths in a shedding_interval, too short for %d sheet_points: use %.0f sheet_points or a "
             "longer "
             "time.shedding_interval",
             who, subject->diagnostics->fish[subject->f].speed * subject->school->interval / subject->fish->length,
             subject->fish->n_sheet, ceil(sheet_needs(subject)) + 1);
}

// ---- the slowest bending mode

static double modes_size(const struct subject *subject) {
    const struct fish *const fish = subject->fish;
    return fish_has_wave(fish) ? fish->frequency / bending_mode_frequency(fish, subject->scratch) : 0;
}

static void modes_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "the slowest bending mode of %s has %.2g Hz, below the beat frequency %.3g Hz: the shape differs from the "
             "natural "
             "curvature and depends on many modes: compare with twice the nodes",
             who, bending_mode_frequency(subject->fish, subject->scratch), subject->fish->frequency);
}

// ---- the leading edge

// only at nearly steady speed, as for the sheet: at low speed after a start the circulations are large for the speed
static double edge_size(const struct subject *subject) {
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    const double most = 0.1, nearly = 0.1;
    if (subject->fish->period > 0 && !(fabs(now->drift) < nearly)) return 0;
    return subject->fish->suction > 0 ? now->separation_share / most : 0;
}

static void edge_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    snprintf(line, WARNING_BYTES,
             "the flow separates at the nose of %s for %.0f %% of the last period (A_0 up to %.2g, "
             "pressure.suction_limit %.3g): thrust and efficiency depend on this limit, compare with 0.11 and 0.25",
             who, 100 * now->separation_share, now->leading_edge_most, subject->fish->suction_limit);
}

// ---- the controller

// a bias that follows the beat or its second harmonic reverses up to four times in a period
static double chatter_size(const struct subject *subject) {
    const double most = 4;
    return subject->diagnostics->fish[subject->f].bias_reversals / most;
}

static void chatter_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "the steering bias of %s reverses %.0f times in a period, faster than the beat: reduce control.damping "
             "(%.3g) or "
             "control.gain (%.3g)",
             who, subject->diagnostics->fish[subject->f].bias_reversals, subject->fish->control.damping,
             subject->fish->control.gain);
}

// ---- the tail

// whether forces of the fluid bend the tail
static int tail_bends(const struct subject *subject) {
    return subject->school->density > 0 && subject->fish->motion.prescribed != PRESCRIBED_ALL;
}

static double cusp_size(const struct subject *subject) {
    return tail_bends(subject) && subject->fish->has_cusp ? always : 0;
}

static void cusp_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    (void)subject;
    snprintf(line, WARNING_BYTES,
             "the tail of %s ends in a cusp: results do not converge with the number of nodes (doc/numerics.md, "
             "section 5); set "
             "body.tail_thickness",
             who);
}

double warnings_bending_length(const struct fish *fish) {
    const double omega = 2 * 3.14159265358979323846 * fish->frequency;
    return pow(fish->tail_stiffness / (fish->tail_added_mass * omega * omega), 0.25);
}

static double tail_size(const struct subject *subject) {
    const struct fish *const fish = subject->fish;
    const int beats = fish_has_wave(fish) || (fish->motion.prescribed == PRESCRIBED_HEAD && fish->motion.omega > 0);
    if (!tail_bends(subject) || !beats || fish->has_cusp || !(fish->tail_added_mass > 0)) return 0;
    return 2 * fish->edge_length / warnings_bending_length(fish);
}

static void tail_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject->fish;
    snprintf(
        line, WARNING_BYTES,
        "the edges of %s, %.2g m, are longer than half the bending length of the tail, %.2g m: use at least %.0f nodes",
        who, fish->edge_length, warnings_bending_length(fish),
        ceil(2 * fish->length / warnings_bending_length(fish)) + 1);
}

// ---- the published force

static double force_size(const struct subject *subject) {
    return subject->school->density > 0 && subject->fish->force == FORCE_PUBLISHED ? always : 0;
}

static void force_say(const struct subject *subject, const char *who, char line[WARNING_BYTES]) {
    (void)subject;
    snprintf(line, WARNING_BYTES,
             "the published force on %s does not follow from an energy and can create energy: accuracy warnings are "
             "suppressed; compare with 'force: reactive'",
             who);
}

// ---- all of them

static const struct kind kinds[N_WARNINGS] = {
    [WARNING_ENERGY] = {energy_size, energy_say}, [WARNING_BEATS] = {beats_size, beats_say},
    [WARNING_DRIFT] = {drift_size, drift_say},    [WARNING_EVENTS] = {events_size, events_say},
    [WARNING_SHEET] = {sheet_size, sheet_say},    [WARNING_MODES] = {modes_size, modes_say},
    [WARNING_EDGE] = {edge_size, edge_say},       [WARNING_CHATTER] = {chatter_size, chatter_say},
    [WARNING_CUSP] = {cusp_size, cusp_say},       [WARNING_TAIL] = {tail_size, tail_say},
    [WARNING_FORCE] = {force_size, force_say},
};

// accuracy warnings are suppressed for the published force
static int applies_to_force(enum warning warning, const struct fish *fish) {
    return fish->force != FORCE_PUBLISHED || warning == WARNING_FORCE;
}

const struct warning_words warnings_words[N_WARNINGS] = {
    [WARNING_CONTACT] = {"bodies touch, cross or come near",
                         "at or between steps of the integrator; near: gap below contact.range without "
                         "'contact.action: repel'; see closest_approach"},
    [WARNING_CROSSING] = {"a body crosses itself",
                          "centre line or outline, at an event; contact forces do not act within a body"},
    [WARNING_DIVERGENCE] = {"a fish has diverged",
                            "at an event a node speed, or the circulation of the wake over the length, is above "
                            "100 times the speeds of the case"},
    [WARNING_ENERGY] =
        {"the energy balance is open",
         "energy_balance is more than 1 % of the largest work of muscle, fluid, damping, prescribed motion and all "
         "forces; in the first beat, also more than 1 % of the energy of the body and of one length per beat"},
    [WARNING_MOMENTUM] =
        {"the momentum balance is open",
         "momentum_balance is more than 1 % of the largest sum over all fish of: momentum, change of the impulse of "
         "the vortices, external_impulse; not in the first beat, or, without beat, in the first length"},
    [WARNING_BEATS] = {"few beats", "the run is shorter than two beats: means and powers are not those of a cycle"},
    [WARNING_DRIFT] = {"the speed changes", "drift is more than 1 %: means over the last beat are not steady"},
    [WARNING_EVENTS] = {"few events", "fewer than 20 in a beat"},
    [WARNING_SHEET] =
        {"few sheet points",
         "'shedding: sheet' and n_sheet - 1 < 0.9 x 3.2/sqrt(U Dt/L), with a change of speed below 10 % per "
         "beat"},
    [WARNING_MODES] = {"slow modes", "the slowest bending mode of a body in the fluid is slower than the beat"},
    [WARNING_EDGE] = {"separation at the nose",
                      "separation_share is above 0.1, with a change of speed below 10 % per beat"},
    [WARNING_CHATTER] = {"a controller chatters",
                         "the steering bias of a law reverses more than four times in the last period, by at least 1 % "
                         "of control.limit"},
    [WARNING_CUSP] = {"a cusp", "a Joukowski body that bends, with 'tail_thickness: 0'"},
    [WARNING_TAIL] =
        {"few nodes at the tail",
         "two edges are longer than (EI/(m_L omega^2))^(1/4), with EI of the last edge and omega of the beat"},
    [WARNING_FORCE] = {"the published force",
                       "may create energy; the other warnings for this fish are contact, crossing and divergence"},
};

static int contact_line(const struct school *school, const struct closest *closest, char line[WARNING_BYTES]) {
    const int repel = school->contact == CONTACT_REPEL;
    const char *const a = school->fish[closest->fish[0]].name, *const b = school->fish[closest->fish[1]].name;
    if (closest->distance <= 0) {
        snprintf(line, WARNING_BYTES,
                 "the bodies of %.40s and %.40s touch or cross at t = %.4g s: later results are invalid%s", a, b,
                 closest->t, repel ? "" : "; set contact.action: repel");
        return 1;
    }
    if (repel || closest->distance >= school->contact_range) return 0;
    snprintf(line, WARNING_BYTES,
             "%.40s and %.40s come within %.3g m of each other at t = %.4g s, less than contact.range", a, b,
             closest->distance, closest->t);
    return 1;
}

static int crossing_line(const struct school *school, const struct state *state, char line[WARNING_BYTES]) {
    if (state->crossed < 0) return 0;
    snprintf(
        line, WARNING_BYTES,
        "the body of %.40s crosses itself at t = %.4g s: later results are invalid; use a stiffer body or a smaller "
        "wave.amplitude",
        school->fish[state->crossed].name, state->crossed_t);
    return 1;
}

// the momentum balance of the school
static int momentum_line(const struct school *school, const struct state *state, const struct diagnostics *diagnostics,
                         char line[WARNING_BYTES]) {
    const double balance = hypot(diagnostics->momentum_balance[0], diagnostics->momentum_balance[1]);

    // the longest beat; without beat, the time of one length
    double period = 0;
    for (int f = 0; f < school->n_fish; f++) period = fmax(period, 1 / fish_rate(school, &school->fish[f]));

    const int is_open =
        isfinite(balance) ? balance > 0.01 * diagnostics->momentum_size : diagnostics_momentum_is_defined(school);
    if (state->t < period || !is_open) return 0;
    snprintf(line, WARNING_BYTES,
             "momentum balance: residual %.2g N s for %.2g N s: reduce time.shedding_interval, increase sheet_points, "
             "or start "
             "without a jump of the velocity",
             balance, diagnostics->momentum_size);
    return 1;
}

enum status warnings_refuse(const struct school *school, const struct state *state,
                            const struct diagnostics *diagnostics) {
    const char *const remedy =
        "reduce solver.rtol, solver.step or time.shedding_interval, or stiffen the body; the rows before are kept";

    if (state_table_check(state, school) != STATUS_OK) {
        return status_fail(STATUS_SOLVER, "the run has diverged at t = %.10g s: %s: %s", state->t, status_message(),
                           remedy);
    }

    for (int f = 0; f < school->n_fish; f++) {
        const double balance = diagnostics->fish[f].energy_balance;
        if (isfinite(balance)) continue;
        return status_fail(STATUS_SOLVER, "the run has diverged at t = %.10g s: the energy balance of %s is %g J: %s",
                           state->t, school->fish[f].name, balance, remedy);
    }

    for (int i = 0; i < 3 && diagnostics_momentum_is_defined(school); i++) {
        const double balance = diagnostics->momentum_balance[i];
        if (isfinite(balance)) continue;
        return status_fail(STATUS_SOLVER, "the run has diverged at t = %.10g s: the momentum balance is %g N%s s: %s",
                           state->t, balance, i < 2 ? "" : " m", remedy);
    }

    return STATUS_OK;
}

int warnings_line(enum warning warning, const struct school *school, const struct state *state,
                  const struct diagnostics *diagnostics, double *scratch, char line[WARNING_BYTES]) {
    if (warning == WARNING_CONTACT) return contact_line(school, state->closest, line);
    if (warning == WARNING_CROSSING) return crossing_line(school, state, line);
    if (warning == WARNING_DIVERGENCE) return divergence_line(school, state, line);
    if (warning == WARNING_MOMENTUM) return momentum_line(school, state, diagnostics, line);

    // the fish with the largest size
    struct subject worst = {.size = 1};
    int n = 0;
    for (int f = 0; f < school->n_fish; f++) {
        struct subject subject = {school, state, diagnostics, scratch, &school->fish[f], f, 0};
        if (!applies_to_force(warning, subject.fish)) continue;
        subject.size = kinds[warning].size(&subject);
        if (!(subject.size > 1)) continue;

        n++;
        if (subject.size > worst.size) worst = subject;
    }
    if (n == 0) return 0;

    char who[96];
    snprintf(who, sizeof who, n > 1 ? "%.40s (the worst of %d fish)" : "%.40s", worst.fish->name, n);
    kinds[warning].say(&worst, who, line);
    return 1;
}
