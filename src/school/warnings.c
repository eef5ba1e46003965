/* warnings.c: measures every defect of a result in units of the limit of its warning, and words the message. */
#include "school/warnings.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mathematics.h"
#include "body/bending_mode.h"
#include "body/rod.h"
#include "flow/flow_at_bodies.h"
#include "force/force_model.h"

/* One fish, and everything that warnings about it read. */
struct subject {
    const struct school *school;
    const struct state *state;
    const struct diagnostics *diagnostics;
    double *scratch;
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

// ---- warnings about one fish: the size of the defect, of which more than 1 is a warning, and the line

double warnings_bending_length(const struct fish *fish) {
    const double omega = 2 * M_PI * fish->frequency;
    return pow(fish->tail_stiffness / (fish->tail_added_mass * omega * omega), 0.25);
}

// whether forces of the fluid bend the tail
static bool tail_bends(const struct subject *subject) {
    return subject->school->density > 0 && subject->school->fish[subject->f].motion.prescribed != PRESCRIBED_ALL;
}

// warnings about the solution
static double solution_warning(enum warning warning, const struct subject *subject, const char *who,
                               char line[WARNING_BYTES]) {
    const struct fish *const fish = &subject->school->fish[subject->f];
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    const double *const works = subject->state->balance[subject->f].work;
    const double t = subject->state->t, period = fish->period;
    const double balance = fabs(now->energy_balance);
    double energy = now->kinetic_energy + now->bending_energy + now->stretching_energy, work = 0;

    switch (warning) {
        case WARNING_ENERGY:
            for (int i = 0; i < N_WORKS; i++) work = larger(work, fabs(works[i]));
            snprintf(line, WARNING_BYTES,
                     "energy balance of %s: residual %.2g J for %.2g J of work: reduce solver.rtol or solver.step; if "
                     "the residual remains, the case is outside the range of the model",
                     who, now->energy_balance, work);

            // in the first beat the works are small, so include the energy of the body and that of one length per beat
            if (t < period) {
                const double speed = fish->length / period;
                work = larger(work, larger(energy, fish->total_mass * speed * speed));
            }
            if (!isfinite(balance) || isnan(work)) return INFINITY;
            return balance > 1e-12 * energy && work > 0 ? balance / (0.01 * work) : 0;

        case WARNING_DRIFT:
            snprintf(line, WARNING_BYTES,
                     "the speed of %s changes by %.1f %% from one beat to the next: the means are not steady; increase "
                     "time.end or use `shoal steady`",
                     who, 100 * now->drift);
            return subject->school->density > 0 && !isnan(now->drift) ? fabs(now->drift) / 0.01 : 0;

        case WARNING_EDGE:
            snprintf(line, WARNING_BYTES,
                     "the flow separates at the nose of %s for %.0f %% of the last period (A_0 up to %.2g, "
                     "pressure.suction_limit %.3g): thrust and efficiency depend on this limit, compare with 0.11 and "
                     "0.25",
                     who, 100 * now->separation_share, now->leading_edge_most, fish->suction_limit);

            // at low speed after a start the circulations are large compared with the speed
            if (period > 0 && !(fabs(now->drift) < nearly_steady)) return 0;
            return fish->suction > 0 ? now->separation_share / 0.1 : 0;

        case WARNING_CHATTER:
            snprintf(line, WARNING_BYTES,
                     "the steering bias of %s reverses %.0f times in a period, faster than the beat: reduce "
                     "control.damping (%.3g) or control.gain (%.3g)",
                     who, now->bias_reversals, fish->control.damping, fish->control.gain);

            // a bias that follows the beat or its second harmonic reverses up to four times in a period
            return now->bias_reversals / 4;

        case WARNING_PLACE:
            snprintf(line, WARNING_BYTES,
                     "%s needs %.2g times its amplitude to hold its place, the limit of control.amplitude_limit "
                     "(%.3g), where it loses the place: choose another control.offset, or another amplitude or "
                     "frequency of %s or of its leader",
                     who, 1 + subject->state->control[subject->f].drive, fish->control.amplitude_limit, who);

            // 0.98 is the hyperbolic tangent of 2.3
            if (fish->control.law != CONTROL_PLACE) return 0;
            return fabs(subject->state->control[subject->f].drive) / (0.98 * fish->control.amplitude_limit);

        case WARNING_STALL:
            snprintf(line, WARNING_BYTES,
                     "%s stalls: the flow separates at the nose for %.0f %% of the period (limit 50 %%), and the speed "
                     "changes by %.0f %% from one beat to the next (limit 10 %%): outside the range of the model; "
                     "reduce the angle of attack, by less heave or more pitch, or prescribe the speed",
                     who, 100 * now->separation_share, 100 * now->drift);
            if (fish->motion.prescribed == PRESCRIBED_NONE || !(fish->suction > 0)) return 0;
            return smaller(fabs(now->drift) / nearly_steady, now->separation_share / 0.5);

        default: return 0;
    }
}

// warnings about times, points and nodes: too few of them
static double resolution_warning(enum warning warning, const struct subject *subject, const char *who,
                                 char line[WARNING_BYTES]) {
    const struct fish *const fish = &subject->school->fish[subject->f];
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    const double t = subject->state->t, period = fish->period, interval = subject->school->interval;
    const double lengths = now->speed * interval / fish->length, n_points = 3.2 / sqrt(lengths);
    const double bending_length = warnings_bending_length(fish);
    const bool has_wave = fish_has_wave(fish), has_motion = fish->motion.omega > 0;

    switch (warning) {
        case WARNING_BEATS:
            snprintf(line, WARNING_BYTES,
                     "the run has %.3g beat%s of %s: means and powers are not those of a cycle; increase time.end to "
                     "at least %.4g s",
                     t / period, fabs(t / period - 1) < 0.005 ? "" : "s", who, 2 * period);
            return (has_wave || has_motion) && t > 0 ? rounded * 2 * period / t : 0;

        case WARNING_EVENTS:
            snprintf(line, WARNING_BYTES,
                     "a beat of %s has only %.3g event%s: reduce time.shedding_interval to %.3g s for %d events", who,
                     period / interval, fabs(period / interval - 1) < 0.005 ? "" : "s", period / MIN_EVENTS,
                     MIN_EVENTS);
            return period > 0 ? rounded * MIN_EVENTS * interval / period : 0;

        case WARNING_SHEET:
            snprintf(line, WARNING_BYTES,
                     "%s swims %.2g lengths in a shedding_interval, too short for %d sheet_points: use %.0f "
                     "sheet_points or a longer time.shedding_interval",
                     who, lengths, fish->n_sheet, ceil(n_points) + 1);

            // Only at nearly steady speed, because every fish that starts from rest is slow at first; an equilibrium
            // sheds nothing.
            if (subject->school->shedding != SHEDDING_SHEET || !(now->speed > 0)) return 0;
            if (subject->state->wake[subject->f].n_vortex == 0) return 0;
            if (period > 0 && !(fabs(now->drift) < nearly_steady)) return 0;

            // The sheet needs M - 1 >= 3.2/sqrt(U Dt/L) points. The warning begins at 0.9 of this, because the error
            // grows slowly (0.25 % of the circulation at 0.63). A fish that would need 1000 points does not swim.
            return n_points < 1000 ? 0.9 * n_points / (fish->n_sheet - 1) : 0;

        case WARNING_TAIL:
            snprintf(line, WARNING_BYTES,
                     "the edges of %s, %.2g m, are longer than half the bending length of the tail, %.2g m: use at "
                     "least %.0f nodes",
                     who, fish->edge_length, bending_length, ceil(2 * fish->length / bending_length) + 1);
            if (!(has_wave || (fish->motion.prescribed == PRESCRIBED_HEAD && has_motion))) return 0;
            if (!tail_bends(subject) || fish->has_cusp || !(fish->tail_added_mass > 0)) return 0;
            return 2 * fish->edge_length / bending_length;

        default: return 0;
    }
}

// warnings about the model of the case
static double model_warning(enum warning warning, const struct subject *subject, const char *who,
                            char line[WARNING_BYTES]) {
    const struct fish *const fish = &subject->school->fish[subject->f];
    const struct diagnostics_fish *const now = &subject->diagnostics->fish[subject->f];
    const struct motion *const motion = &fish->motion;
    double slowest = 0;

    // largest speed of the tail by pitch, and speed through the water
    const double tail = fabs(motion->pitch) * motion->omega * fabs(fish->length - motion->pivot);
    const double held = hypot(motion->speed * cos(fish->start_heading) - subject->school->velocity[0],
                              motion->speed * sin(fish->start_heading) - subject->school->velocity[1]);
    const double travel = motion->is_held ? held : now->speed;

    switch (warning) {
        case WARNING_MODES:
            if (!fish_has_wave(fish)) return 0;
            slowest = bending_mode_frequency(fish, subject->scratch);
            snprintf(line, WARNING_BYTES,
                     "the slowest bending mode of %s has %.2g Hz, below the beat frequency %.3g Hz: the shape differs "
                     "from the natural curvature and depends on many modes: compare with twice the nodes",
                     who, slowest, fish->frequency);
            return fish->frequency / slowest;

        case WARNING_CUSP:
            snprintf(line, WARNING_BYTES,
                     "the tail of %s ends in a cusp: results do not converge with the number of nodes "
                     "(doc/numerics.md, section 5); set body.tail_thickness",
                     who);
            return tail_bends(subject) && fish->has_cusp ? always : 0;

        case WARNING_FORCE:
            snprintf(line, WARNING_BYTES,
                     "the published force on %s does not follow from an energy and can create energy: accuracy "
                     "warnings are suppressed; compare with 'force: reactive'",
                     who);
            return subject->school->density > 0 && force_model_of(fish)->is_for_comparison ? always : 0;

        case WARNING_PITCH:
            snprintf(line, WARNING_BYTES,
                     "the pitch moves the tail of %s at %.2g of its speed through the water (limit 0.6): beyond the "
                     "theory of attached flow, the power is up to twice too large; reduce motion.pitch or "
                     "motion.frequency, or move motion.pivot towards the tail",
                     who, tail / travel);

            // only at nearly steady speed
            if (motion->prescribed != PRESCRIBED_ALL || !(subject->school->density > 0)) return 0;
            if (!motion->is_held && !(fabs(now->drift) < nearly_steady)) return 0;
            return travel > 0 ? tail / travel / 0.6 : 0;

        default: return 0;
    }
}

/* Which function judges a warning about a single fish; NULL: the warning is about the school. */
static double (*const of_fish[N_WARNINGS])(enum warning, const struct subject *, const char *, char *) = {
    [WARNING_ENERGY] = solution_warning,   [WARNING_BEATS] = resolution_warning, [WARNING_DRIFT] = solution_warning,
    [WARNING_EVENTS] = resolution_warning, [WARNING_SHEET] = resolution_warning, [WARNING_MODES] = model_warning,
    [WARNING_EDGE] = solution_warning,     [WARNING_CHATTER] = solution_warning, [WARNING_PLACE] = solution_warning,
    [WARNING_CUSP] = model_warning,        [WARNING_TAIL] = resolution_warning,  [WARNING_FORCE] = model_warning,
    [WARNING_PITCH] = model_warning,       [WARNING_STALL] = solution_warning,
};

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

const struct warning_words warnings_words[N_WARNINGS] = {
    [WARNING_CONTACT] = {"bodies touch, cross or come near",
                         "at or between steps of the integrator; near: gap below contact.range without "
                         "'contact.action: repel'; see closest_approach"},
    [WARNING_CROSSING] = {"a body crosses itself",
                          "centre line or outline, at an event; contact forces do not act within a body"},
    [WARNING_DIVERGENCE] = {"a fish has diverged",
                            "at an event the speed of a node or of a vortex, or the circulation of the wake over the "
                            "length, is above 100 times the speeds of the case"},
    [WARNING_ENERGY] =
        {"the energy balance is open",
         "energy_balance is more than 1 % of the largest work of muscle, fluid, damping, prescribed motion and all "
         "forces; in the first beat, also more than 1 % of the energy of the body and of one length per beat"},
    [WARNING_MOMENTUM] =
        {"the momentum balance is open",
         "momentum_balance is more than 1 % of the largest sum over all fish of: momentum, change of the impulse of "
         "the vortices, external_impulse; in the first beat, or, without beat, in the first length, more than 20 % of "
         "this sum or of the momentum at one length per beat"},
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
    [WARNING_PLACE] = {"a place out of reach",
                       "law place changes the amplitude by more than 98 % of control.amplitude_limit"},
    [WARNING_CUSP] = {"a cusp", "a Joukowski body that bends, with 'tail_thickness: 0'"},
    [WARNING_TAIL] =
        {"few nodes at the tail",
         "two edges are longer than (EI/(m_L omega^2))^(1/4), with EI of the last edge and omega of the beat"},
    [WARNING_FORCE] = {"the published force",
                       "may create energy; the other warnings for this fish are contact, crossing and divergence"},
    [WARNING_PITCH] = {"fast pitch", "prescribed pitch moves the tail at more than 0.6 of the speed through the water"},
    [WARNING_STALL] = {"a stalled foil", "prescribed motion, drift above 0.1 and separation_share above 0.5"},
    [WARNING_WAKE] =
        {"a faded wake",
         "at the end, a body lies within a quarter of its length of decaying markers or vortices of another "
         "fish, and the decay takes more than 5 % of the velocity that the wakes of other fish induce there"},
};

// the name of the worst of n fish
enum { WHO_BYTES = 96 };
static void name_worst(const struct school *school, int worst, int n, char who[WHO_BYTES]) {
    snprintf(who, WHO_BYTES, n > 1 ? "%.40s (the worst of %d fish)" : "%.40s", school->fish[worst].name, n);
}

// At most this part of the velocity of wakes at a body may be lost by decay.
static const double most_decayed = 0.05;

// write the line of a warning about the school, if it applies
static bool school_warning(enum warning warning, struct residual *residual, const struct state *state,
                           const struct diagnostics *diagnostics, char line[WARNING_BYTES]) {
    const struct school *const school = residual->school;
    const struct closest *const closest = state->closest;
    const bool repel = school->contact == CONTACT_REPEL;
    const double balance = hypot(diagnostics->momentum_balance[0], diagnostics->momentum_balance[1]);
    double worst[N_DIVERGENCE], period = 0, usual = 0, limit = 0.01 * diagnostics->momentum_size;
    double *const lost = residual->scratch;
    char who[WHO_BYTES];
    int n = 0, worst_fish = 0;
    long diverged = state->diverged;

    switch (warning) {
        case WARNING_CONTACT:
            if (closest->distance > 0 && (repel || closest->distance >= school->contact_range)) return false;
            const char *const a = school->fish[closest->fish[0]].name, *const b = school->fish[closest->fish[1]].name;
            if (closest->distance <= 0) {
                snprintf(line, WARNING_BYTES,
                         "the bodies of %.40s and %.40s touch or cross at t = %.4g s: later results are invalid%s", a,
                         b, closest->t, repel ? "" : "; set contact.action: repel");
            } else {
                snprintf(line, WARNING_BYTES,
                         "%.40s and %.40s come within %.3g m of each other at t = %.4g s, less than contact.range", a,
                         b, closest->distance, closest->t);
            }
            return true;

        case WARNING_CROSSING:
            if (!state->has_crossed) return false;
            snprintf(line, WARNING_BYTES,
                     "the body of %.40s crosses itself at t = %.4g s: later results are invalid; use a stiffer body or "
                     "a smaller wave.amplitude",
                     school->fish[state->crossed].name, state->crossed_t);
            return true;

        case WARNING_DIVERGENCE:
            memcpy(worst, state->divergence, sizeof worst);
            warnings_divergence(school, state, worst, &diverged);
            if (!(worst[DIVERGENCE_SIZE] > 1)) return false;
            snprintf(
                line, WARNING_BYTES,
                "%.40s has diverged: at t = %.4g s a node or vortex has %.2g m/s, circulation %.2g m2/s, over %g times "
                "the speeds of the case: reduce solver.rtol, solver.step or time.shedding_interval, or stiffen "
                "the body",
                school->fish[diverged].name, worst[DIVERGENCE_T], worst[DIVERGENCE_SPEED],
                worst[DIVERGENCE_CIRCULATION], most_of_case);
            return true;

        case WARNING_MOMENTUM:
            // In the longest beat (without a beat, in the time of one length) all terms are small, and a start with a
            // jump leaves up to 0.12: include the momentum that all bodies have at one length per beat.
            for (int f = 0; f < school->n_fish; f++) {
                const struct fish *const fish = &school->fish[f];
                const double rate = fish_rate(school, fish);
                period = fmax(period, 1 / rate);
                usual += fish->total_mass * fish->length * rate;
            }
            if (state->t < period) limit = 0.2 * fmax(usual, diagnostics->momentum_size);
            if (isfinite(balance) ? !(balance > limit) : !diagnostics_momentum_is_defined(school)) return false;
            snprintf(line, WARNING_BYTES,
                     "momentum balance: residual %.2g N s for %.2g N s: reduce time.shedding_interval, increase "
                     "sheet_points, or start without a jump of the velocity",
                     balance, diagnostics->momentum_size);
            return true;

        case WARNING_WAKE:
            flow_find_decayed(residual->flow, state, lost);
            for (int f = 0; f < school->n_fish; f++) {
                if (force_model_of(&school->fish[f])->is_for_comparison) lost[f] = 0;
                n += lost[f] > most_decayed;
                if (lost[f] > lost[worst_fish]) worst_fish = f;
            }
            name_worst(school, worst_fish, n, who);
            snprintf(
                line, WARNING_BYTES,
                "%s lies in the decaying part of another wake: %.0f %% of the velocity of wakes is lost there (limit "
                "%.0f %%): increase wake.lifetime (%.4g s), or reduce wake.decay (%.4g s)",
                who, 100 * lost[worst_fish], 100 * most_decayed, school->lifetime, school->decay);
            return n > 0;

        default: return false;
    }
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

int warnings_line(enum warning warning, struct residual *residual, const struct state *state,
                  const struct diagnostics *diagnostics, char line[WARNING_BYTES]) {
    const struct school *const school = residual->school;
    if (!of_fish[warning]) return school_warning(warning, residual, state, diagnostics, line);

    // find the fish with the largest defect; for a model that reproduces an article, warnings about accuracy are
    // suppressed
    struct subject subject = {school, state, diagnostics, residual->scratch, 0};
    double most = 1;
    int n = 0, worst = 0;
    for (subject.f = 0; subject.f < school->n_fish; subject.f++) {
        if (force_model_of(&school->fish[subject.f])->is_for_comparison && warning != WARNING_FORCE) continue;
        const double size = of_fish[warning](warning, &subject, "", line);
        if (!(size > 1)) continue;

        n++;
        if (size > most) worst = subject.f;
        most = larger(most, size);
    }
    if (n == 0) return 0;

    char who[WHO_BYTES];
    subject.f = worst;
    name_worst(school, worst, n, who);
    of_fish[warning](warning, &subject, who, line);
    return 1;
}
