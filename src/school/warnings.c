/* warnings.c: the table of the warnings. Each has a function that measures a defect of a result in units of its limit,
 * and words the message. */
#include "school/warnings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "body/bending_mode.h"
#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "force/force_model.h"

/* Everything that warnings read, and one fish, for those about a fish. */
struct warning_subject {
    struct residual *residual;
    const struct school *school;
    const struct state *state;
    const struct diagnostics *diagnostics;
    int f;
};

/* The size of a defect that is either there or not. */
static const double always = 2;

/* The least number of events in a beat, and the largest change of the speed from beat to beat in nearly steady
 * swimming. */
enum { MIN_EVENTS = 20 };
static const double nearly_steady = 0.1;

/* Leaves one part in a thousand million for the rounding error of a time or a quotient. */
static const double rounded = 1 - 1e-9;

/* What most warnings about a fish read: its constants and its row of the result. */
static const struct fish *subject_fish(const struct warning_subject *subject) {
    return &subject->school->fish[subject->f];
}

static const struct diagnostics_fish *subject_row(const struct warning_subject *subject) {
    return &subject->diagnostics->fish[subject->f];
}

// ---- warnings about the solution of one fish

static double energy_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const struct diagnostics_fish *const now = subject_row(subject);
    const double *const works = subject->state->balance[subject->f].work;
    const double balance = fabs(now->energy_balance);
    const double energy = now->kinetic_energy + now->bending_energy + now->stretching_energy;
    double work = 0;
    for (int i = 0; i < N_WORKS; i++) work = larger(work, fabs(works[i]));
    snprintf(line, WARNING_BYTES,
             "energy balance of %s: residual %.2g J for %.2g J of work: reduce solver.rtol or solver.step; if "
             "the residual remains, the case is outside the range of the model",
             who, now->energy_balance, work);

    // in the first beat the works are small, so include the energy of the body and that of one length per beat
    if (subject->state->t < fish->period) {
        const double speed = fish->length / fish->period;
        work = larger(work, larger(energy, fish->total_mass * speed * speed));
    }
    if (!isfinite(balance) || isnan(work)) return INFINITY;
    return balance > 1e-12 * energy && work > 0 ? balance / (0.01 * work) : 0;
}

static double drift_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct diagnostics_fish *const now = subject_row(subject);
    snprintf(line, WARNING_BYTES,
             "the speed of %s changes by %.1f %% from one beat to the next: the means are not steady; increase "
             "time.end or use `shoal steady`",
             who, 100 * now->drift);
    return subject->school->density > 0 && !isnan(now->drift) ? fabs(now->drift) / 0.01 : 0;
}

static double edge_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const struct diagnostics_fish *const now = subject_row(subject);
    snprintf(line, WARNING_BYTES,
             "the flow separates at the nose of %s for %.0f %% of the last period (A_0 up to %.2g, "
             "pressure.suction_limit %.3g): thrust and efficiency depend on this limit, compare with 0.11 and "
             "0.25",
             who, 100 * now->separation_share, now->leading_edge_most, fish->suction_limit);

    // at low speed after a start the circulations are large compared with the speed
    if (fish->period > 0 && !(fabs(now->drift) < nearly_steady)) return 0;
    return fish->suction > 0 ? now->separation_share / 0.1 : 0;
}

static double chatter_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const struct diagnostics_fish *const now = subject_row(subject);
    snprintf(line, WARNING_BYTES,
             "the steering bias of %s reverses %.0f times in a period, faster than the beat: reduce "
             "control.damping (%.3g) or control.gain (%.3g)",
             who, now->bias_reversals, fish->control.damping, fish->control.gain);

    // a bias that follows the beat or its second harmonic reverses up to four times in a period
    return now->bias_reversals / 4;
}

static double place_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const double drive = subject->state->control[subject->f].drive;
    snprintf(line, WARNING_BYTES,
             "%s needs %.2g times its amplitude to hold its place, the limit of control.amplitude_limit "
             "(%.3g), where it loses the place: choose another control.offset, or another amplitude or "
             "frequency of %s or of its leader",
             who, 1 + drive, fish->control.amplitude_limit, who);

    // 0.98 is the hyperbolic tangent of 2.3
    if (fish->control.law != CONTROL_PLACE) return 0;
    return fabs(drive) / (0.98 * fish->control.amplitude_limit);
}

static double stall_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const struct diagnostics_fish *const now = subject_row(subject);
    snprintf(line, WARNING_BYTES,
             "%s stalls: the flow separates at the nose for %.0f %% of the period (limit 50 %%), and the speed "
             "changes by %.0f %% from one beat to the next (limit 10 %%): outside the range of the model; "
             "reduce the angle of attack, by less heave or more pitch, or prescribe the speed",
             who, 100 * now->separation_share, 100 * now->drift);
    if (fish->motion.prescribed == PRESCRIBED_NONE || !(fish->suction > 0)) return 0;
    return smaller(fabs(now->drift) / nearly_steady, now->separation_share / 0.5);
}

// ---- warnings about one fish with too few times, points or nodes

static double beats_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const double t = subject->state->t, period = fish->period;
    snprintf(line, WARNING_BYTES,
             "the run has %.3g beat%s of %s: means and powers are not those of a cycle; increase time.end to "
             "at least %.4g s",
             t / period, fabs(t / period - 1) < 0.005 ? "" : "s", who, 2 * period);
    return (fish_has_wave(fish) || fish->motion.omega > 0) && t > 0 ? rounded * 2 * period / t : 0;
}

static double events_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const double period = subject_fish(subject)->period, interval = subject->school->interval;
    snprintf(line, WARNING_BYTES,
             "a beat of %s has only %.3g event%s: reduce time.shedding_interval to %.3g s for %d events", who,
             period / interval, fabs(period / interval - 1) < 0.005 ? "" : "s", period / MIN_EVENTS, MIN_EVENTS);
    return period > 0 ? rounded * MIN_EVENTS * interval / period : 0;
}

static double sheet_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const struct diagnostics_fish *const now = subject_row(subject);
    const double lengths = now->speed * subject->school->interval / fish->length, n_points = 3.2 / sqrt(lengths);
    snprintf(line, WARNING_BYTES,
             "%s swims %.2g lengths in a shedding_interval, too short for %d sheet_points: use %.0f "
             "sheet_points or a longer time.shedding_interval",
             who, lengths, fish->n_sheet, ceil(n_points) + 1);

    // Only at nearly steady speed, because every fish that starts from rest is slow at first; an equilibrium
    // sheds nothing.
    if (subject->school->shedding != SHEDDING_SHEET || !(now->speed > 0)) return 0;
    if (subject->state->wake[subject->f].n_vortex == 0) return 0;
    if (fish->period > 0 && !(fabs(now->drift) < nearly_steady)) return 0;

    // The sheet needs M - 1 >= 3.2/sqrt(U Dt/L) points. The warning begins at 0.9 of this, because the error
    // grows slowly (0.25 % of the circulation at 0.63). A fish that would need 1000 points does not swim.
    return n_points < 1000 ? 0.9 * n_points / (fish->n_sheet - 1) : 0;
}

double warnings_bending_length(const struct fish *fish) {
    const double omega = 2 * M_PI * fish->frequency;
    return pow(fish->tail_stiffness / (fish->tail_added_mass * omega * omega), 0.25);
}

// whether forces of the fluid bend the tail
static bool tail_bends(const struct warning_subject *subject) {
    return subject->school->density > 0 && subject_fish(subject)->motion.prescribed != PRESCRIBED_ALL;
}

static double tail_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const double bending_length = warnings_bending_length(fish);
    snprintf(line, WARNING_BYTES,
             "the edges of %s, %.2g m, are longer than half the bending length of the tail, %.2g m: use at "
             "least %.0f nodes",
             who, fish->edge_length, bending_length, ceil(2 * fish->length / bending_length) + 1);
    const bool is_driven = fish->motion.prescribed == PRESCRIBED_HEAD && fish->motion.omega > 0;
    if (!fish_has_wave(fish) && !is_driven) return 0;
    if (!tail_bends(subject) || fish->has_cusp || !(fish->tail_added_mass > 0)) return 0;
    return 2 * fish->edge_length / bending_length;
}

// ---- warnings about the model of one fish

static double modes_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    if (!fish_has_wave(fish)) return 0;
    const double slowest = bending_mode_frequency(fish, subject->residual->scratch);
    snprintf(line, WARNING_BYTES,
             "the slowest bending mode of %s has %.2g Hz, below the beat frequency %.3g Hz: the shape differs "
             "from the natural curvature and depends on many modes: compare with twice the nodes",
             who, slowest, fish->frequency);
    return fish->frequency / slowest;
}

static double cusp_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "the tail of %s ends in a cusp: results do not converge with the number of nodes "
             "(doc/numerics.md, section 5); set body.tail_thickness",
             who);
    return tail_bends(subject) && subject_fish(subject)->has_cusp ? always : 0;
}

static double force_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    snprintf(line, WARNING_BYTES,
             "the published force on %s does not follow from an energy and can create energy: accuracy "
             "warnings are suppressed; compare with 'force: reactive'",
             who);
    return subject->school->density > 0 && force_model_of(subject_fish(subject))->is_for_comparison ? always : 0;
}

static double pitch_warning(const struct warning_subject *subject, const char *who, char line[WARNING_BYTES]) {
    const struct fish *const fish = subject_fish(subject);
    const struct diagnostics_fish *const now = subject_row(subject);
    const struct motion *const motion = &fish->motion;

    // largest speed of the tail by pitch, and speed through the water
    const double tail = fabs(motion->pitch) * motion->omega * fabs(fish->length - motion->pivot);
    const double held = hypot(motion->speed * cos(fish->start_heading) - subject->school->velocity[0],
                              motion->speed * sin(fish->start_heading) - subject->school->velocity[1]);
    const double travel = motion->is_held ? held : now->speed;
    snprintf(line, WARNING_BYTES,
             "the pitch moves the tail of %s at %.2g of its speed through the water (limit 0.6): beyond the "
             "theory of attached flow, the power is up to twice too large; reduce motion.pitch or "
             "motion.frequency, or move motion.pivot towards the tail",
             who, tail / travel);

    // only at nearly steady speed
    if (motion->prescribed != PRESCRIBED_ALL || !(subject->school->density > 0)) return 0;
    if (!motion->is_held && !(fabs(now->drift) < nearly_steady)) return 0;
    return travel > 0 ? tail / travel / 0.6 : 0;
}

// ---- divergence

// The circulation of a foil is about 3 L U, and a tail may be several times faster than the body: 100 is no physical
// result.
static const double most_of_case = 100;

void warnings_divergence(const struct school *school, const struct state *state, double worst[N_DIVERGENCE],
                         long *diverged) {
    // An upper bound of the speeds that the case prescribes. For one fish it is the sum over beat, motion, start,
    // external flow and free acceleration by the load; the largest one counts.
    double of_case = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double beat = 2 * M_PI * fish->length * fish_rate(school, fish);
        const double motion = fish->motion.omega * (fabs(fish->motion.heave) + fabs(fish->motion.pitch) * fish->length);
        const double load = hypot(fish->load_tip[0], fish->load_tip[1]) * state->t / fish->total_mass;
        const double stream = hypot(school->velocity[0], school->velocity[1]) +
                              hypot(school->gust[0], school->gust[1]) +
                              fabs(school->shear * fish_mass_mean(fish, state->y + fish->at.y));
        of_case = larger(of_case, beat + motion + load + stream + fabs(fish->start_speed) + fabs(fish->motion.speed));
    }

    const double limit = most_of_case * of_case;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const struct wake *const wake = &state->wake[f];
        const double *const vx = state->y + fish->at.vx, *const vy = state->y + fish->at.vy;

        // the circulation of a marker is the circulation shed until the birth
        double speed = 0, circulation = fabs(state->y[fish->at.circulation]);
        for (int k = 0; k < fish->n_nodes; k++) speed = larger(speed, hypot(vx[k], vy[k]));
        for (int i = 0; i < wake->n_vortex; i++) {
            speed = larger(speed, hypot(wake->u[i], wake->v[i]));
            circulation = larger(circulation, fabs(wake->circulation[i]));
        }

        // a value that is not finite exceeds every limit; a body at rest without a beat has no limit
        const double most = larger(speed, circulation / fish->length);
        const double size = !isfinite(most) || !isfinite(limit) ? INFINITY : limit > 0 ? most / limit : 0;
        if (!(size > worst[DIVERGENCE_SIZE])) continue;
        const double now[N_DIVERGENCE] = {size, state->t, speed, circulation};
        memcpy(worst, now, sizeof now);
        *diverged = f;
    }
}

// the name of the worst of n fish
enum { WHO_BYTES = 96 };
static void name_worst(const struct school *school, int worst, int n, char who[WHO_BYTES]) {
    snprintf(who, WHO_BYTES, n > 1 ? "%.40s (the worst of %d fish)" : "%.40s", school->fish[worst].name, n);
}

// ---- warnings about the school

static double contact_warning(const struct warning_subject *subject, char line[WARNING_BYTES]) {
    const struct school *const school = subject->school;
    const struct state *const state = subject->state;
    const struct closest *const closest = state->closest;
    const bool repel = school->contact == CONTACT_REPEL;
    if (closest->distance > 0 && (repel || closest->distance >= school->contact_range)) return 0;
    const char *const a = school->fish[closest->fish[0]].name, *const b = school->fish[closest->fish[1]].name;
    if (closest->distance <= 0) {
        snprintf(line, WARNING_BYTES,
                 "the bodies of %.40s and %.40s touch or cross at t = %.4g s: later results are invalid%s", a, b,
                 closest->t, repel ? "" : "; set contact.action: repel");
    } else {
        snprintf(line, WARNING_BYTES,
                 "%.40s and %.40s come within %.3g m of each other at t = %.4g s, less than contact.range", a, b,
                 closest->distance, closest->t);
    }
    return always;
}

static double crossing_warning(const struct warning_subject *subject, char line[WARNING_BYTES]) {
    const struct school *const school = subject->school;
    const struct state *const state = subject->state;
    if (!state->has_crossed) return 0;
    snprintf(line, WARNING_BYTES,
             "the body of %.40s crosses itself at t = %.4g s: later results are invalid; use a stiffer body or "
             "a smaller wave.amplitude",
             school->fish[state->crossed].name, state->crossed_t);
    return always;
}

static double divergence_warning(const struct warning_subject *subject, char line[WARNING_BYTES]) {
    const struct school *const school = subject->school;
    const struct state *const state = subject->state;
    double worst[N_DIVERGENCE];
    long diverged = state->diverged;
    memcpy(worst, state->divergence, sizeof worst);
    warnings_divergence(school, state, worst, &diverged);
    if (!(worst[DIVERGENCE_SIZE] > 1)) return 0;
    snprintf(line, WARNING_BYTES,
             "%.40s has diverged: at t = %.4g s a node or vortex has %.2g m/s, circulation %.2g m2/s, over %g times "
             "the speeds of the case: reduce solver.rtol, solver.step or time.shedding_interval, or stiffen "
             "the body",
             school->fish[diverged].name, worst[DIVERGENCE_T], worst[DIVERGENCE_SPEED], worst[DIVERGENCE_CIRCULATION],
             most_of_case);
    return always;
}

static double momentum_warning(const struct warning_subject *subject, char line[WARNING_BYTES]) {
    const struct school *const school = subject->school;
    const struct diagnostics *const diagnostics = subject->diagnostics;
    const double balance = hypot(diagnostics->momentum_balance[0], diagnostics->momentum_balance[1]);
    double period = 0, usual = 0, limit = 0.01 * diagnostics->momentum_size;

    // In the longest beat (without a beat, in the time of one length) all terms are small, and a start with a
    // jump leaves up to 0.12: include the momentum that all bodies have at one length per beat.
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double rate = fish_rate(school, fish);
        period = fmax(period, 1 / rate);
        usual += fish->total_mass * fish->length * rate;
    }
    if (subject->state->t < period) limit = 0.2 * fmax(usual, diagnostics->momentum_size);
    if (isfinite(balance) ? !(balance > limit) : !diagnostics_momentum_is_defined(school)) return 0;
    snprintf(line, WARNING_BYTES,
             "momentum balance: residual %.2g N s for %.2g N s: reduce time.shedding_interval, increase "
             "sheet_points, or start without a jump of the velocity",
             balance, diagnostics->momentum_size);
    return always;
}

// At most this part of the velocity of wakes at a body may be lost by decay.
static const double most_decayed = 0.05;

void warnings_fading(struct residual *residual, const struct state *state, double worst[N_FADING], long *faded) {
    const struct school *const school = residual->school;
    double *const lost = residual->scratch;
    int n = 0, most = 0;
    flow_find_decayed(residual->flow, state, lost);
    for (int f = 0; f < school->n_fish; f++) {
        if (force_model_of(&school->fish[f])->is_for_comparison) lost[f] = 0;
        n += lost[f] > most_decayed;
        if (lost[f] > lost[most]) most = f;
    }
    if (!(lost[most] > worst[FADING_PART])) return;
    const double now[N_FADING] = {lost[most], state->t, n};
    memcpy(worst, now, sizeof now);
    *faded = most;
}

static double wake_warning(const struct warning_subject *subject, char line[WARNING_BYTES]) {
    const struct school *const school = subject->school;
    const struct state *const state = subject->state;
    double worst[N_FADING];
    long faded = state->faded;
    memcpy(worst, state->fading, sizeof worst);
    warnings_fading(subject->residual, state, worst, &faded);
    char name[WHO_BYTES];
    name_worst(school, (int)faded, (int)worst[FADING_FISH], name);
    snprintf(line, WARNING_BYTES,
             "%s lies in the decaying part of another wake at t = %.4g s: %.0f %% of the velocity of wakes is lost "
             "there (limit %.0f %%): increase wake.lifetime (%.4g s), or reduce wake.decay (%.4g s)",
             name, worst[FADING_T], 100 * worst[FADING_PART], 100 * most_decayed, school->lifetime, school->decay);
    return worst[FADING_PART] > most_decayed ? always : 0;
}

// ---- the table, in the order in which a result lists its warnings

const struct warning_row warnings_table[N_WARNINGS] = {
    [WARNING_CONTACT] = {"bodies touch, cross or come near",
                         "at or between steps of the integrator; near: gap below contact.range without "
                         "'contact.action: repel'; see closest_approach",
                         .of_school = contact_warning},
    [WARNING_CROSSING] = {"a body crosses itself",
                          "centre line or outline, at an event; contact forces do not act within a body",
                          .of_school = crossing_warning},
    [WARNING_DIVERGENCE] = {"a fish has diverged",
                            "at an event the speed of a node or of a vortex, or the circulation of the wake over the "
                            "length, is above 100 times the speeds of the case",
                            .of_school = divergence_warning},
    [WARNING_ENERGY] =
        {"the energy balance is open",
         "energy_balance is more than 1 % of the largest work of muscle, fluid, damping, prescribed motion and all "
         "forces; in the first beat, also more than 1 % of the energy of the body and of one length per beat",
         .of_fish = energy_warning},
    [WARNING_MOMENTUM] =
        {"the momentum balance is open",
         "momentum_balance is more than 1 % of the largest sum over all fish of: momentum, change of the impulse of "
         "the vortices, external_impulse; in the first beat, or, without beat, in the first length, more than 20 % of "
         "this sum or of the momentum at one length per beat",
         .of_school = momentum_warning},
    [WARNING_BEATS] = {"few beats", "the run is shorter than two beats: means and powers are not those of a cycle",
                       .of_fish = beats_warning},
    [WARNING_DRIFT] = {"the speed changes", "drift is more than 1 %: means over the last beat are not steady",
                       .of_fish = drift_warning},
    [WARNING_EVENTS] = {"few events", "fewer than 20 in a beat", .of_fish = events_warning},
    [WARNING_SHEET] =
        {"few sheet points",
         "'shedding: sheet' and n_sheet - 1 < 0.9 x 3.2/sqrt(U Dt/L), with a change of speed below 10 % per "
         "beat",
         .of_fish = sheet_warning},
    [WARNING_MODES] = {"slow modes", "the slowest bending mode of a body in the fluid is slower than the beat",
                       .of_fish = modes_warning},
    [WARNING_EDGE] = {"separation at the nose",
                      "separation_share is above 0.1, with a change of speed below 10 % per beat",
                      .of_fish = edge_warning},
    [WARNING_CHATTER] = {"a controller chatters",
                         "the steering bias of a law reverses more than four times in the last period, by at least 1 % "
                         "of control.limit",
                         .of_fish = chatter_warning},
    [WARNING_PLACE] = {"a place out of reach",
                       "law place changes the amplitude by more than 98 % of control.amplitude_limit",
                       .of_fish = place_warning},
    [WARNING_CUSP] = {"a cusp", "a Joukowski body that bends, with 'tail_thickness: 0'", .of_fish = cusp_warning},
    [WARNING_TAIL] =
        {"few nodes at the tail",
         "two edges are longer than (EI/(m_L omega^2))^(1/4), with EI of the last edge and omega of the beat",
         .of_fish = tail_warning},
    [WARNING_FORCE] = {"the published force",
                       "may create energy; the other warnings for this fish are contact, crossing and divergence",
                       .of_fish = force_warning},
    [WARNING_PITCH] = {"fast pitch", "prescribed pitch moves the tail at more than 0.6 of the speed through the water",
                       .of_fish = pitch_warning},
    [WARNING_STALL] = {"a stalled foil", "prescribed motion, drift above 0.1 and separation_share above 0.5",
                       .of_fish = stall_warning},
    [WARNING_WAKE] =
        {"a faded wake",
         "at the end, or at an event once a beat, a body lies within a quarter of its length of decaying "
         "markers or vortices of another fish, and the decay takes more than 5 % of the velocity that the wakes of "
         "other fish induce there",
         .of_school = wake_warning},
};

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

bool warnings_line(enum warning warning, struct residual *residual, const struct state *state,
                   const struct diagnostics *diagnostics, char line[WARNING_BYTES]) {
    const struct warning_row *const row = &warnings_table[warning];
    const struct school *const school = residual->school;
    struct warning_subject subject = {residual, school, state, diagnostics, 0};
    if (row->of_school) return row->of_school(&subject, line) > 1;

    // find the fish with the largest defect; for a model that reproduces an article, warnings about accuracy are
    // suppressed
    double most = 1;
    int n = 0, worst = 0;
    for (subject.f = 0; subject.f < school->n_fish; subject.f++) {
        if (force_model_of(subject_fish(&subject))->is_for_comparison && warning != WARNING_FORCE) continue;
        const double size = row->of_fish(&subject, "", line);
        if (!(size > 1)) continue;

        n++;
        if (size > most) worst = subject.f;
        most = larger(most, size);
    }
    if (n == 0) return false;

    char who[WHO_BYTES];
    subject.f = worst;
    name_worst(school, worst, n, who);
    row->of_fish(&subject, who, line);
    return true;
}
