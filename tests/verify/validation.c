/* validation.c: the section "validation": the cases with foils and a swimmer with force: pressure against an experiment
 * and Navier-Stokes solutions (tests/verify/data). The ratios are the validation, and their bounds are
 * regressions, drawn round the results; only the bounds of two foils side by side contain the error of the source. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "steady/steady_search.h"
#include "verify.h"

static const double pi = 3.14159265358979323846;

// ---- tables of data

enum { MOST_LINES = 64, LINE_BYTES = 256 };

/* A table without comments and heading. */
struct table {
    int n;
    char line[MOST_LINES][LINE_BYTES];
};

static void read_table(const char *path, struct table *table) {
    FILE *const file = fopen(path, "r");
    char line[LINE_BYTES];
    bool has_heading = false;
    table->n = 0;
    while (file && fgets(line, sizeof line, file) && table->n < MOST_LINES) {
        if (line[0] == '#') continue;
        if (has_heading) memcpy(table->line[table->n++], line, sizeof line);
        has_heading = true;
    }
    if (file) fclose(file);
    verify_ok(table->n > 0 ? STATUS_OK : status_fail(STATUS_FILE, "%s: no data", path));
}

// ---- a period of a run

/* The last period of a run of a body of length 1 and depth 1 with the period 1. */
struct period {
    double speed, thrust, power;   /* means, m s-1, N, W */
    double across, along;          /* force of the fluid across the path, and along the path less the mean: rms, N */
    double circulation;            /* the largest less the least circulation that was shed, m2 s-1 */
    double separation_share, edge; /* part with separation at the nose; largest A_0 */
    double imbalance;              /* the energy balance over the work of all periods */
};

/* Run a case of cases/ for a number of periods, with further assignments, and evaluate the last period. The speed of
 * every period is a point of the series of a figure, if given. */
static struct period run_case(const char *name, int n_periods, int n_assignments, const char *const *assignments,
                              const char *figure, const char *series) {
    struct simulation *const simulation = verify_open_case(name, n_assignments, assignments);
    const struct diagnostics_fish *const of = simulation->diagnostics->fish;
    for (int i = 1; i < n_periods; i++) {
        verify_run(simulation, i);
        simulate_measure(simulation);
        if (figure) verify_point(figure, series, i, of->speed);
    }
    struct period period = {0};
    const int n = (int)lround(1 / simulation->school->interval);
    double mean = 0, square[2] = {0, 0}, least = INFINITY, most = -INFINITY;
    for (int i = 1; i <= n; i++) {
        verify_run(simulation, n_periods - 1 + (double)i / n);
        simulate_measure(simulation);
        double force[2];
        for (int k = 0; k < 2; k++) {
            force[k] = of->pressure.pressure[k] + of->pressure.suction[k] + of->resistive_force[k];
            square[k] += force[k] * force[k] / n;
        }
        mean += force[0] / n;
        least = fmin(least, of->shed_circulation);
        most = fmax(most, of->shed_circulation);
    }
    if (figure) verify_point(figure, series, n_periods, of->speed);
    period.speed = of->speed;
    period.thrust = of->mean_thrust;
    period.power = of->mean_power;
    period.across = sqrt(square[1]);
    period.along = sqrt(square[0] - mean * mean);
    period.circulation = most - least;
    period.separation_share = of->separation_share;
    period.edge = of->leading_edge_most;
    period.imbalance = of->energy_balance / (n_periods * of->mean_power);
    return period;
}

// ---- heave and pitch

// the excursion of the trailing edge of a foil that heaves by h and pitches by theta, rad, about a third of the chord
static double excursion(double h, double theta, double lead) {
    enum { N = 720 };
    double most = 0;
    for (int i = 0; i < N; i++) {
        const double t = 2 * pi * i / N;
        most = fmax(most, fabs(h * sin(t) - 2.0 / 3 * sin(theta * sin(t + lead))));
    }
    return 2 * most;
}

/* Chords per period, U/(f c), and pitch, rad, at which St = f A/U has this value. */
struct foil {
    double speed, pitch;
};
static struct foil foil_at(double strouhal, double lead) {
    const double heave = 0.75, incidence = 15 * pi / 180;
    struct foil foil = {2 * heave / strouhal, 0};
    for (int i = 0; i < 100; i++) {
        foil.pitch = atan(2 * pi * heave / foil.speed) - incidence;
        foil.speed = (foil.speed + excursion(heave, foil.pitch, lead) / strouhal) / 2;
    }
    return foil;
}

static struct period run_anderson(const struct foil *foil, int psi, const char *more) {
    char text[4][64];
    snprintf(text[0], sizeof *text, "fish[0].start.speed=%.17g", foil->speed);
    snprintf(text[1], sizeof *text, "fluid.viscosity=%.17g", foil->speed / 4e4);
    snprintf(text[2], sizeof *text, "fish[0].motion.pitch=%.17g", foil->pitch * 180 / pi);
    snprintf(text[3], sizeof *text, "fish[0].motion.pitch_phase=%d", psi);
    const char *const assignments[] = {text[0], text[1], text[2], text[3], more};
    return run_case("foil_anderson.yaml", 4, more ? 5 : 4, assignments, NULL, NULL);
}

static void anderson(void) {
    static const char source[] = "Anderson et al. (1998), experiment";
    static struct table table;
    read_table("tests/verify/data/anderson1998.csv", &table);
    for (int i = 0; i < table.n; i++) {
        int psi;
        double strouhal, thrust, theory, power;
        if (sscanf(table.line[i], "%d,%lf,%lf,%lf,%lf", &psi, &strouhal, &thrust, &theory, &power) != 5) abort();
        if (verify_is_fast() && (psi != 90 || fabs(strouhal - 0.3) > 0.01)) continue;
        const struct foil foil = foil_at(strouhal, psi * pi / 180);
        const double pressure = foil.speed * foil.speed / 2;
        const struct period period = run_anderson(&foil, psi, NULL);
        // with the friction of a plate 0.88 to 1.16; the factor for the thickness takes 0.01. At the smallest St the
        // thrust is a small difference of suction, pressure and friction
        const double least = strouhal > 0.15 ? 0.86 : 0.7, most = strouhal > 0.15 ? 1.17 : 1.3;
        // r: largest velocity of the tail by pitch over the speed; beyond 0.6 a run warns (doc/output.md)
        const double r = foil.pitch * 2 * pi * 2.0 / 3 / foil.speed;
        const char *const name = "foil, psi %d, St %.1f, r %.2f: %s coefficient";
        verify_regression(verify_text(name, psi, strouhal, r, "thrust"), source, thrust, period.thrust / pressure,
                          least, most);
        verify_regression(verify_text(name, psi, strouhal, r, "power"), source, power,
                          period.power / pressure / foil.speed, least, most);
        if (verify_is_fast()) continue;
        const struct period attached = run_anderson(&foil, psi, "fish[0].pressure.suction_limit=0");
        const char *const figure = psi == 90 ? "foil_thrust_90" : "foil_thrust_75";
        verify_point(figure, "experiment", strouhal, thrust);
        verify_point(figure, "published theory", strouhal, theory);
        verify_point(figure, "here", strouhal, period.thrust / pressure);
        verify_point(figure, "all of the suction", strouhal, attached.thrust / pressure);
        verify_point("foil_power", verify_text("experiment, psi %d", psi), strouhal, power);
        verify_point("foil_power", verify_text("psi %d", psi), strouhal, period.power / pressure / foil.speed);
    }
}

// ---- Navier-Stokes

/* A number of the table of Navier-Stokes solutions: mean and spread. */
struct reference {
    double value;
    char source[64];
};
static struct reference reference_of(const struct table *table, const char *flow, const char *quantity) {
    char start[LINE_BYTES];
    const int length = snprintf(start, sizeof start, "%s,%s,", flow, quantity);
    for (int i = 0; i < table->n; i++) {
        double low, high;
        if (strncmp(table->line[i], start, (size_t)length) != 0) continue;
        if (sscanf(table->line[i] + length, "%lf,%lf", &low, &high) != 2) abort();
        struct reference reference = {(low + high) / 2, "Navier-Stokes"};
        if (high > low) snprintf(reference.source, sizeof reference.source, "Navier-Stokes, %g to %g", low, high);
        return reference;
    }
    abort();
}

static void compare_flow(const struct table *table, const char *flow, const char *quantity, const char *text,
                         double obtained, double least, double most) {
    const struct reference reference = reference_of(table, flow, quantity);
    verify_regression(verify_text("%s: %s", flow, text), reference.source, reference.value, obtained, least, most);
}

// the thrust is the difference of a large suction and a large friction: the ratio has the widest range
static void heave(const struct table *table) {
    static const char *const flows[] = {"heave of an ellipse at Re 1000", "heave of an ellipse at Re 4000",
                                        "heave of a NACA 0012 at Re 4000"};
    const double speed = 1.25, pressure = speed * speed / 2, reynolds[] = {1000, 4000, 4000};
    const double least[] = {0.8, 1.0, 0.65}, most[] = {1.0, 1.2, 0.8};
    for (int i = 0; i < 3; i++) {
        char viscosity[64];
        snprintf(viscosity, sizeof viscosity, "fluid.viscosity=%.17g", speed / reynolds[i]);
        const char *const assignments[] = {viscosity, "fish[0].drag.form=1", "fish[0].pressure.suction_limit=0"};
        const struct period period = run_case("foil_heave.yaml", 6, 1, assignments, NULL, NULL);
        compare_flow(table, flows[i], "CT", "thrust coefficient", period.thrust / pressure, least[i], most[i]);
        compare_flow(table, flows[i], "CP", "power coefficient", period.power / pressure / speed, 1.0, 1.18);
        compare_flow(table, flows[i], "CL", "lift coefficient, rms", period.across / pressure, 1.1, 1.3);
        if (i == 0) {
            verify_zero("heave at Re 1000: energy balance of the body over the work", "the limit acts",
                        period.imbalance, 1e-3);
        }
        if (i == 2) continue;
        verify_show(verify_text("%s: part of the period with separation at the nose", flows[i]),
                    verify_text("largest A_0 %.2f", period.edge), period.separation_share);
        if (i == 0) {
            compare_flow(table, flows[i], "circulation", "circulation of a wake vortex over U c",
                         period.circulation / speed, 1.0, 1.3);
        }
        const struct period plate = run_case("foil_heave.yaml", 6, 2, assignments, NULL, NULL);
        if (i == 0) {
            verify_value("heave at Re 1000, friction of a plate: thrust coefficient", "the prototype of the limit",
                         0.087, plate.thrust / pressure, 0.005);
        }
        const struct period attached = run_case("foil_heave.yaml", 6, 3, assignments, NULL, NULL);
        verify_show(verify_text("%s: thrust coefficient of attached flow, friction of a plate", flows[i]), "",
                    attached.thrust / pressure);
        if (verify_is_fast()) return;
    }
}

static void swimmer(const struct table *table) {
    static const char name[] = "swimmer_navier_stokes.yaml", figure[] = "swimmer_speed";
    enum { N_PERIODS = 12 };
    const struct period period = run_case(name, N_PERIODS, 0, NULL, figure, "here");
    compare_flow(table, "swimmer", "speed", "speed, L/T", period.speed, 1.04, 1.12);
    compare_flow(table, "swimmer", "power", "power into the fluid, rho L^4/T^3", period.power, 0.83, 0.91);
    compare_flow(table, "swimmer", "lateral force", "lateral force, rms, rho L^3/T^2", period.across, 0.65, 0.85);
    compare_flow(table, "swimmer", "force along the course", "force along the course, rms, rho L^3/T^2", period.along,
                 1, 1.2);
    compare_flow(table, "swimmer", "circulation", "circulation of a wake vortex, L^2/T", period.circulation, 0.65, 0.8);
    // the reference has the form factor of 0.08 L, the thickness of the outline; the mean over the edge is 0.0785 L
    verify_value("swimmer: speed, L/T", "the prototype of this friction", 0.627, period.speed, 0.01);
    verify_value("swimmer: power into the fluid, rho L^4/T^3", "the prototype of this friction", 0.0201, period.power,
                 3e-4);
    verify_show("swimmer: largest A_0", "", period.edge);
    const char *const plate[] = {"fish[0].drag.skin=laminar"};
    const struct period on_plate = run_case(name, N_PERIODS, 1, plate, figure, "friction of a laminar plate");
    verify_value("swimmer, friction of a laminar plate: speed, L/T", "the prototype", 0.709, on_plate.speed, 0.005);
    verify_value("swimmer, friction of a laminar plate: power, rho L^4/T^3", "the prototype", 0.0153, on_plate.power,
                 1e-4);
    const double lines[] = {0.55, 0.62};
    for (int i = 0; i < 2; i++) {
        for (int t = 0; t <= N_PERIODS; t += N_PERIODS) {
            verify_point(figure, verify_text("Navier-Stokes, %s", i == 0 ? "least" : "most"), t, lines[i]);
        }
    }
}

// ---- live fish

/* How a fish swims: length of its wave, excursion of the tail from side to side and depth of the body in body lengths,
 * and keys of the envelope of the curvature. */
struct gait {
    double wavelength, excursion, depth;
    const char *envelope;
};

/* Lengths that a fish with this gait swims in a beat: the amplitude of the muscle's wave is the one that gives the
 * excursion. The body is so stiff that it takes the muscle's curvature. */
static double gait_stride(const struct gait *gait, double length, double frequency, double normal) {
    double amplitude = 2.6 * gait->excursion / (gait->wavelength * gait->wavelength), stride = NAN;
    for (int i = 0; i < 3; i++) {
        struct verify_search search;
        char text[512];
        snprintf(text, sizeof text,
                 "format: 1\ntime: {end: %.17g, shedding_interval: %.17g}\n"
                 "fish: [{length: %.17g, start: {speed: %.17g}, drag: {normal: %g},\n"
                 "  wave: {frequency: %.17g, wavelength: %.17g, amplitude: %.17g, %s},\n"
                 "  body: {modulus: 1e7, depth: %.17g}}]\n",
                 1 / frequency, 0.02 / frequency, length, 0.6 * length * frequency, normal, frequency, gait->wavelength,
                 amplitude, gait->envelope, gait->depth);
        verify_search_open(&search, text);
        verify_ok(steady_search_run(&search.problem));
        stride = search.problem.map.last[0].speed / (length * frequency);
        amplitude *= gait->excursion / (search.simulation->diagnostics->fish[0].strouhal * stride);
    }
    return stride;
}

/* Rainbow trout of any length that swim steadily: Webb, Kostecki and Stevens, "The effect of size and swimming speed on
 * locomotor kinematics of rainbow trout", Journal of Experimental Biology 109 (1984) 77-95. Lengths in cm, s. The body
 * bends by the default envelope. */
static void trout(void) {
    const double frequencies[] = {4, 5, 6.25}, lengths[] = {10, 20, 40};
    for (int k = 0; k < 3; k++) {
        const double length = lengths[k], slow = 3.19 / cbrt(length); /* the beat frequency is slow + 1.29 V/L, Hz */
        const struct gait gait = {1.43 * pow(length, 0.83) / length, 0.36 * pow(length, 0.74) / length,
                                  0.18 * pow(length, 1.05) / length, "linear: 1, quadratic: 0.2"};
        for (int i = 0; i < 3; i++) {
            const double f = frequencies[i], measured = (f - slow) / 1.29 / f;
            const double stride = gait_stride(&gait, 0.01 * length, f, 1);
            verify_regression(verify_text("trout of %g m, %g Hz: stride, lengths a beat", 0.01 * length, f),
                              "Webb et al. (1984)", measured, stride, 0.9, 1.3);
            verify_point("trout", verify_text("measured, %g m", 0.01 * length), f, measured);
            verify_point("trout", verify_text("here, %g m", 0.01 * length), f, stride);
            if (k == 1) {
                for (int c = 0; c <= 2; c += 2) {
                    verify_show(verify_text("the same, drag.normal %d", c), "",
                                gait_stride(&gait, 0.01 * length, f, c) / measured);
                }
            }
        }
    }
}

/* Mackerel and lamprey, by the waves that Navier-Stokes studies of them prescribe: Borazjani and Sotiropoulos,
 * Journal of Experimental Biology 211 (2008) 1541-1558 and 212 (2009) 576-592, whose abstracts give the Strouhal
 * number at which such fish swim in nature. Excursions along the body, in lengths on each side: mackerel 0.02 -
 * 0.0825 q + 0.1625 q^2 (Videler and Hess 1984), lamprey 0.1 exp(2.18 (q - 1)) (Hultmark et al. 2007); the
 * envelopes of curvature are those of these waves, the mackerel's without the turning of its head. The stride is
 * the excursion over the Strouhal number. */
static void mackerel_and_lamprey(void) {
    static const struct {
        const char *name, *source;
        struct gait gait;
        double length, frequency, strouhal;
    } fish[] = {
        {"mackerel",
         "St 0.25 (Borazjani and Sotiropoulos 2008)",
         {0.95, 0.2, 0.2, "linear: 0, quadratic: 1"},
         0.3,
         5,
         0.25},
        {"lamprey",
         "St 0.45 (Borazjani and Sotiropoulos 2009)",
         {0.642, 0.2, 0.08, "constant: 0.11, linear: 0, quadratic: 0.89"},
         0.25,
         3,
         0.45},
    };
    for (int i = 0; i < 2; i++) {
        struct gait gait = fish[i].gait;
        const double measured = gait.excursion / fish[i].strouhal;
        verify_regression(verify_text("%s: stride, lengths a beat", fish[i].name), fish[i].source, measured,
                          gait_stride(&gait, fish[i].length, fish[i].frequency, 1), 0.8, 1.1);
        for (int k = -1; k <= 1; k += 2) {
            gait.depth = (1 + 0.25 * k) * fish[i].gait.depth;
            verify_show(verify_text("the same, depth %g of its length", gait.depth), "",
                        gait_stride(&gait, fish[i].length, fish[i].frequency, 1) / measured);
        }
    }
}

// ---- two foils

/* Coefficients of power and thrust of the last foil, over rho U^3 c/2 and rho U^2 c/2. Foil 2 is at this place, and
 * ahead by this phase, degree; NAN: foil 1 is alone. */
struct coefficients {
    double power, thrust;
};
static struct coefficients run_foils(double x, double y, int phase) {
    const double speed = 1.25;
    const char *second = "";
    if (!isnan(x)) {
        second = verify_text(", {name: second, start: {position: [%.17g, %.17g]}, motion: {phase: %d}}", x, y, phase);
    }
    struct simulation *const simulation = verify_open(
        "format: 1\ntime: {end: 6, shedding_interval: 0.01, output_interval: 6}\n"
        "fluid: {density: 1, viscosity: 1.25e-3}\ndefaults: {fish: {nodes: 9, force: pressure, "
        "pressure: {span: infinite}, start: {speed: %g}, wave: {amplitude: 0, frequency: 0}, "
        "body: {profile: uniform, thickness: 0.08, depth: 1}, motion: {prescribed: all, heave: 0.125, "
        "pitch: 10, pitch_phase: 90, pivot: 0.33333333, frequency: 1}}}\nfish: [{name: first}%s]\n",
        speed, second);
    verify_run(simulation, 6);
    simulate_measure(simulation);
    const struct diagnostics_fish *const of = &simulation->diagnostics->fish[simulation->school->n_fish - 1];
    return (struct coefficients){of->mean_power / (speed * speed * speed / 2), of->mean_thrust / (speed * speed / 2)};
}

// what foil 1 changes at foil 2: the friction and the thickness of the foil alone cancel
static void two_foils(void) {
    static const char source[] = "Navier-Stokes, Re 1000";
    static struct table table;
    read_table("tests/verify/data/school_navier_stokes.csv", &table);
    const struct coefficients alone = run_foils(NAN, NAN, 0);
    const double power_alone = 0.610;
    double power[2][4], thrust[2][4]; /* foil 2 in line at gap 1, by phase: the reference, here */
    for (int i = 0; i < table.n; i++) {
        char place[16];
        int phase;
        double distance, first, second, first_thrust, change;
        if (sscanf(table.line[i], "%15[^,],%lf,%d,%lf,%lf,%lf,%lf", place, &distance, &phase, &first, &second,
                   &first_thrust, &change) != 7) {
            abort();
        }
        const bool is_beside = strcmp(place, "beside") == 0;
        if (!is_beside && fabs(distance - 1) > 0) continue;
        const struct coefficients of = run_foils(is_beside ? 0 : 1 + distance, is_beside ? distance : 0, phase);
        const double reference[2] = {power_alone * (second - 1), change};
        const double here[2] = {of.power - alone.power, of.thrust - alone.thrust};
        if (is_beside) {
            // 15 %, and the error of the source
            verify_value(verify_text("foils side by side at %g c, %d degrees: change of CP", distance, phase), source,
                         reference[0], here[0], 0.15 * fabs(reference[0]) + 0.06 * power_alone);
            verify_value(verify_text("foils side by side at %g c, %d degrees: change of CT", distance, phase), source,
                         reference[1], here[1], 0.15 * fabs(reference[1]) + 0.015);
            continue;
        }
        for (int k = 0; k < 2; k++) {
            power[k][phase / 90] = k == 0 ? reference[0] : here[0];
            thrust[k][phase / 90] = k == 0 ? reference[1] : here[1];
        }
    }

    // the first harmonic of the phase: amplitude cos(phase - peak)
    for (int q = 0; q < 2; q++) {
        double amplitude[2], peak[2];
        for (int k = 0; k < 2; k++) {
            const double *const of = q == 0 ? power[k] : thrust[k];
            amplitude[k] = hypot(of[0] - of[2], of[1] - of[3]) / 2;
            peak[k] = atan2(of[1] - of[3], of[0] - of[2]) * 180 / pi;
        }
        const char *const name = q == 0 ? "CP" : "CT";
        verify_regression(verify_text("foils in line, gap 1 c: change of %s over the phase, amplitude", name), source,
                          amplitude[0], amplitude[1], 1 / 1.6, 1.6);
        verify_value(verify_text("foils in line, gap 1 c: phase of most %s, degree", name),
                     "Navier-Stokes, Re 1000; the bound is a regression", peak[0], peak[1], 40);
    }
}

void verify_validation(void) {
    static struct table table;
    read_table("tests/verify/data/navier_stokes.csv", &table);
    anderson();
    heave(&table);
    if (verify_is_fast()) return;
    swimmer(&table);
    two_foils();
    trout();
    mackerel_and_lamprey();
}
