/* test_case_check.c: Implausible values are noted where they stand, and no others are. The default shedding interval
 * follows from the beat, and times are rounded to it. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case/case_table.h"
#include "case_fixture.h"

/* The notes on the minimal case with one assignment are these words ("": there are none). */
static void notes_are(const char *assignment, const char *want) {
    struct case_values values = parse_with(minimal, assignment, NULL, NULL);
    const bool is_right = *want ? strstr(values.notes, want) != NULL : *values.notes == '\0';
    if (!is_right) fail_msg("the notes on %s are\n%s\nwithout %s", assignment, values.notes, want);
}

TEST(a_usual_case_has_no_notes) {
    notes_are("fish[0].wave.phase=90", "");
    notes_are("fish[0].start.heading=3", "");
    notes_are("fish[0].start.heading=0", "");
    notes_are("fish[0].body.modulus=1e4", "");
    notes_are("fish[0]={length: 30, body: {modulus: 1e3}}", "");
    notes_are("fish[0]={length: 1e-3, body: {modulus: 1e12}}", "");
    notes_are("fish[0].start.heading=6.545", "");  // 25/12 pi is more than a turn
    // a fish that is towed has no wave
    notes_are("fish[0]={wave: {number: 6, frequency: 0}, body: {relaxation_time: 0}}", "");
}

TEST(a_key_that_switches_other_defaults_is_noted_with_them) {
    // the keys of the row, and the keys that follow from these
    notes_are("wake.shedding=continuous",
              "--set wake.shedding=continuous: note: wake.shedding: changes the defaults of other keys: wake.taper 0, "
              "wake.taper_beside 0, fish.force reactive, fish.pressure.span infinite, fish.drag.skin quadratic");
    notes_are("fish[0].force=reactive",
              "note: fish[0].force: changes the defaults of other keys: fish.pressure.span infinite, fish.drag.skin "
              "quadratic");
    notes_are("fish[0].pressure.span=infinite",
              "fish[0].pressure.span: changes the defaults of other keys: fish.drag.normal 0");
    notes_are("fish[0].motion.prescribed=head",
              "fish[0].motion.prescribed: changes the defaults of other keys: fish.drag.normal 0");
    notes_are("sheet.curve=polygon", "note: sheet.curve: changes the defaults of other keys: fish.force reactive, ");
    notes_are("fish[0].control.waypoints=[[1, 1]]",
              "fish[0].control.waypoints: changes the defaults of other keys: fish.control.law course");
    notes_are("fish[0].wave.frequency=0",
              "fish[0].wave.frequency: changes the defaults of other keys: fish.body.relaxation_time 0");

    // a written key has no default
    notes_are("fish[0]={force: reactive, pressure: {span: infinite}, drag: {skin: quadratic}}", "");
    notes_are("fish[0]={force: reactive, pressure: {span: infinite}}",
              "fish[0].force: changes the defaults of other keys: fish.drag.skin quadratic");

    // the usual value, another number, and the preset change nothing else
    notes_are("wake.shedding=sheet", "");
    notes_are("fish[0].force=pressure", "");
    notes_are("fish[0].wave.frequency=2", "");
    notes_are("preset=published", "");
}

TEST(a_key_that_fish_share_is_noted_once_with_the_defaults_that_follow) {
    static const char text[] =
        "format: 1\ntime: {end: 3}\ndefaults: {fish: {force: reactive}}\nfish: [{}, {drag: {skin: quadratic}}, {}]\n";
    struct case_values values = parse(text);
    const char *const first = strstr(values.notes, ":3:26: note: fish[0].force");
    assert_non_null(first);
    assert_non_null(strstr(first, "fish.drag.skin quadratic\n"));
    assert_null(strstr(first, "fish[2]"));
}

/* The rows of the table decide: a default with a condition on another key is in the note, whatever the key. */
TEST(every_default_that_follows_another_key_names_keys_of_the_table) {
    int n = 0;
    for (int k = 0; k < case_table_n; k++) {
        for (int i = 0; case_table[k].follows && case_table[k].follows[i]; i++, n++) {
            if (!case_table_row(case_table[k].follows[i])) fail_msg("%s: no key", case_table[k].follows[i]);
            assert_true(case_table[k].derive || case_table[k].choice.of);
        }
    }
    ABOVE(n, 0);
}

/* Derived defaults are rounded to the decimal. */
TEST(the_derived_filter_of_a_period_is_no_given_key) {
    struct case_values values = parse_with(minimal, "fish[0].wave.frequency=1.0001", NULL, NULL);
    NEAR(values.school.fish[0].control.filter, 1 / 1.0001, 0, 1e-14);
    NEAR(values.school.fish[0].control.course_filter, 0.25 / 1.0001, 0, 1e-14);
}

TEST(an_angle_in_radians_is_noted) {
    notes_are("fish[0].start.heading=3.14159",
              "--set fish[0].start.heading=3.14159: note: fish[0].start.heading: 3.14159 is in degrees; if radians are "
              "meant, write 180");
    notes_are("fish[0].start.heading=-1.571", "write -90");
    notes_are("fish[0].wave.phase=0.7854", "write 45");
    notes_are("fish[0].wave.phase=0.2618", "write 15");
    notes_are("fish[0].wave.phase=-1.0472", "write -60");
    notes_are("fish[0].motion={prescribed: head, pitch: 0.5236, frequency: 1}",
              "fish[0].motion.pitch: 0.5236 is in degrees");
    notes_are("fish[0].motion={prescribed: head, pitch: 5, frequency: 1, pitch_phase: 1.5708}", "write 90");
    notes_are("fish[0].motion={prescribed: head, pitch: 5, frequency: 1, phase: 6.2832}", "write 360");
    notes_are("fish[0].control={law: course, desired_heading: [[0, 180], [1, 2.3562]]}", "write 135");
}

TEST(a_body_like_no_other_is_noted) {
    notes_are("fish[0].length=50", "fish[0].length: 50 m is longer than any swimmer; the unit is metres");
    notes_are("fish[0].length=1e-4", "fish[0].length: 0.0001 m is shorter than any swimmer");
    notes_are("fish[0].body.modulus=1", "fish[0].body.modulus: 1 Pa is softer than jelly");
    notes_are("fish[0].body.modulus=1e13", "1e+13 Pa is stiffer than diamond");
}

TEST(a_fluid_without_friction_is_noted) {
    notes_are("fluid.viscosity=0",
              "--set fluid.viscosity=0: note: fluid.viscosity: 0 removes the friction of the skin");
    notes_are("fluid.viscosity=1e-9", "");
    notes_are("fluid={density: 0, viscosity: 0}", "");
}

TEST(few_nodes_under_pressure_are_noted) {
    notes_are("fish[0]={nodes: 9, force: pressure}", "fish[0].nodes: 9: with force pressure, fewer than 17 nodes");
    notes_are("fish[0]={nodes: 17, force: pressure}", "");
    notes_are("fish[0]={nodes: 9, force: reactive, pressure: {span: infinite}, drag: {skin: quadratic}}", "");
    // a rigid plate has no shape to resolve
    notes_are("fish[0]={nodes: 9, force: pressure, drag: {normal: 0}, motion: {prescribed: all}}", "");
}

TEST(a_wave_that_travels_forwards_is_noted) {
    notes_are("fish[0].wave.number=6", "fish[0].wave.number: 6: the wave travels from tail to head");
}

TEST(a_value_that_fish_share_is_noted_once) {
    static const char text[] =
        "format: 1\ntime: {end: 3}\nfluid: {viscosity: 0}\n"
        "defaults: {fish: {length: 50, body: {modulus: 1}}}\nfish: [{}, {}, {drag: {skin: quadratic}}]\n";
    struct case_values values = parse(text);
    const char *const first = strstr(values.notes, ":4:27: note: fish[0].length");
    assert_non_null(first);
    assert_null(strstr(first, "fish[1]"));
    assert_non_null(strstr(first, ":4:47: note: fish[0].body.modulus"));
    // of two fish of three
    assert_non_null(strstr(values.notes, ":3:20: note: fluid.viscosity: 0 removes the friction of the skin"));
}

// ---- the default shedding interval

// the values of a case with this text behind its format
static struct case_values read_case(const char *text) {
    char whole[1024];
    const int length = snprintf(whole, sizeof whole, "format: 1\n%s", text);
    struct case_values values;
    if (case_parse(&values, whole, (size_t)length, "test", ".", 0, NULL) != STATUS_OK) fail_msg("%s", status_message());
    return kept(values);
}

static void interval_is(const char *text, double interval) {
    struct case_values values = read_case(text);
    NEAR(values.school.shedding_interval, interval, 0, 1e-15);
}

TEST(the_fastest_beat_has_a_hundred_events) {
    interval_is("time: {end: 1}\nfish: [{}]\n", 0.01);
    interval_is("time: {end: 1}\nfish: [{wave: {frequency: 4}}]\n", 0.0025);
    interval_is("time: {end: 1}\nfish: [{wave: {frequency: 2}}, {wave: {frequency: 5}, start: {position: [0, 2]}}]\n",
                0.002);
    // the frequency of a prescribed motion, where there is one
    interval_is("time: {end: 1}\nfish: [{motion: {prescribed: head, heave: 0.1, frequency: 0.5}}]\n", 0.02);
    interval_is("time: {end: 1}\nfish: [{motion: {prescribed: all}, wave: {frequency: 2}}]\n", 0.005);
    interval_is("time: {end: 1}\nfish: [{wave: {frequency: 0}}]\n", 0.01);
    // given, or of the article
    interval_is("time: {end: 1, shedding_interval: 0.05}\nfish: [{wave: {frequency: 4}}]\n", 0.05);
    interval_is("preset: published\ntime: {end: 1}\nfish: [{wave: {frequency: 4}}]\n", 0.01);
}

TEST(times_that_do_not_fit_the_default_are_rounded_and_noted) {
    // a period of 0.7 s: 2 s are 285.7 events
    struct case_values values = read_case(
        "time: {end: 2, output_interval: 0.1, checkpoint_interval: 0.352}\noutput: {wake_interval: 0.5}\n"
        "fish: [{wave: {frequency: 1.4285714285714286}}]\n");
    NEAR(values.school.shedding_interval, 0.007, 0, 1e-15);
    NEAR(values.time.end, 286 * 0.007, 0, 1e-14);
    NEAR(values.time.output_interval, 14 * 0.007, 0, 1e-14);
    NEAR(values.time.checkpoint_interval, 50 * 0.007, 0, 1e-14);
    NEAR(values.output.wake_interval, 5 * 14 * 0.007, 0, 1e-14);
    assert_non_null(strstr(values.notes, "time.end: 2 s is not an integer multiple"));
    assert_non_null(
        strstr(values.notes, "rounded to 2.002 s; time.shedding_interval is 1/100 of the fastest beat by default"));
    assert_non_null(strstr(values.notes, "rounded to 0.098 s"));
    assert_non_null(
        strstr(values.notes, "output.wake_interval: 0.5 s is not an integer multiple of time.output_interval"));
}

TEST(times_that_fit_stay_to_the_bit) {
    struct case_values values = read_case(
        "time: {end: 2, output_interval: 0.1}\nfish: [{wave: {frequency: 1.1, phase: 20}}, {name: b, start: {position: "
        "[0, 2]}, wave: {frequency: 4}}]\n");
    NEAR(values.time.end, 2, 0, 0);
    NEAR(values.time.output_interval, 0.1, 0, 0);
    assert_string_equal(values.notes, "");
    // nothing is less than one interval
    values = read_case("time: {end: 0.001, output_interval: 1e-5}\nfish: [{}]\n");
    NEAR(values.time.end, 0.01, 0, 0);
    NEAR(values.time.output_interval, 0.01, 0, 0);
    NEAR(values.output.wake_interval, 0.01, 0, 0);
}

static void is_refused(const char *text, const char *message) {
    char whole[512];
    struct case_values values;
    snprintf(whole, sizeof whole, "format: 1\n%s", text);
    const enum status status = case_parse(&values, whole, strlen(whole), "test", ".", 0, NULL);
    if (status == STATUS_OK) case_free(&values);
    if (status != (message ? STATUS_CASE : STATUS_OK)) {
        fail_msg("%s\nstatus %d %s", text, (int)status, message ? "" : status_message());
    }
    if (message && !strstr(status_message(), message)) fail_msg("%s\nwithout %s", status_message(), message);
}

// a number at a bound of its key is out of range where the bound is open, and one just beyond always
TEST(every_bound_of_every_key_is_kept_and_shown) {
    int n = 0;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        const bool is_of_fish = strncmp(key->path, "fish.", 5) == 0;
        if ((key->type != REAL && key->type != INTEGER) || strcmp(key->path, "format") == 0) continue;
        for (int end = 0; end < 2; end++) {
            const double bound = end == 0 ? key->bounds.min : key->bounds.max;
            const bool is_open = end == 0 ? key->bounds.is_min_open : key->bounds.is_max_open;
            if (isinf(bound)) continue;
            const double step = key->type == INTEGER ? 1 : fmax(fabs(bound), 1e-3) * 1e-9;
            for (int beyond = 0; beyond < 2; beyond++) {
                char assignment[256], message[256];
                snprintf(assignment, sizeof assignment, "%s%s=%.17g", is_of_fish ? "fish[0]" : "",
                         is_of_fish ? key->path + 4 : key->path, bound + (end == 0 ? -1 : 1) * beyond * step);
                snprintf(message, sizeof message, "%s%s: must be", is_of_fish ? "fish[0]" : "",
                         is_of_fish ? key->path + 4 : key->path);
                struct case_values values;
                const enum status status =
                    case_parse(&values, minimal, strlen(minimal), "test", ".", 1, (const char *const[]){assignment});
                if (status == STATUS_OK) {
                    struct case_values again = parse(case_show(test_arena(), &values));
                    are_equal(&values, &again);
                    case_free(&values);
                }
                const bool is_refused = status != STATUS_OK && strstr(status_message(), message);
                if (is_refused != (beyond || is_open)) fail_msg("%s: %d %s", assignment, (int)status, status_message());
                n++;
            }
        }
    }
    ABOVE(n, 150);
}

// a case just inside of each limit, and one just outside
TEST(longer_strings_than_a_key_allows_are_refused) {
    int n = 0;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (key->type != STRING || isinf(key->bounds.max) || !(key->bounds.max < 4000)) continue;
        const bool is_of_fish = strncmp(key->path, "fish.", 5) == 0;
        for (int more = 0; more < 2; more++) {
            char assignment[4200];
            const int start = snprintf(assignment, sizeof assignment, "%s%s=", is_of_fish ? "fish[0]" : "",
                                       is_of_fish ? key->path + 4 : key->path);
            const int length = (int)key->bounds.max + more;
            memset(assignment + start, 'a', (size_t)length);
            assignment[start + length] = '\0';
            struct case_values values;
            const enum status status =
                case_parse(&values, minimal, strlen(minimal), "test", ".", 1, (const char *const[]){assignment});
            if (status == STATUS_OK) case_free(&values);
            const bool is_refused = status != STATUS_OK && strstr(status_message(), "longer than");
            if (is_refused != more) fail_msg("%s: %d bytes: %s", key->path, length, status_message());
            n++;
        }
    }
    AT_LEAST(n, 4);
}

TEST(limits_are_where_the_messages_say) {
#define SHORT "time: {end: 1, shedding_interval: 0.01}\n"
#define FINITE(points) SHORT "fish: [{nodes: 5, sheet_points: " points ", force: pressure, pressure: {span: finite}}]\n"
#define BETWEEN(wake) SHORT "fluid: {walls: [-1, 3]}\nwake: {" wake "}\nfish: [{pressure: {span: infinite}}]\n"
#define STREET "street: {vortices: 4, spacing: 1, circulation: 1, row_distance: 0.5, position: "
#define GUST(gust) \
    SHORT "fluid: {velocity: [1, 0], gust: {amplitude: 0.1, profile: " gust "}}\nfish: [{sensors: [0.5]}]\n"
#define WITHOUT_BEAT(keys) SHORT "fish: [{wave: {frequency: 0}, " keys "}]\n"
#define STEPPED(step) SHORT "solver: {method: rk4, step: " step "}\nfish: [{}]\n"
#define BENT(keys) SHORT "fish: [{nodes: 7, " keys ", quadratic: 0}}]\n"
#define FLUID(keys) SHORT "fluid: {" keys "}\nfish: [{}]\n"
#define RIPPLE(points)                                                                    \
    SHORT                                                                                 \
    "fluid: {velocity: [1, 0], gust: {amplitude: 0.1, profile: sine, wavelength: 0.2}}\n" \
    "fish: [{length: 0.5, nodes: 9, sheet_points: " points ", pressure: {span: infinite}}]\n"
#define PAIR(keys, first, second) SHORT keys "\nfish: [{" first "}, {start: {position: [0, 2]}, " second "}]\n"
#define LAW(law) SHORT "fish: [{control: {law: " law "}}]\n"
#define SWEPT(axis) SHORT "fish: [{}]\nsweep: [{" axis "}]\n"
#define TEN ", values: [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]}"
#define TENS                                                                                                 \
    SHORT "fish: [{}]\nsweep: [{key: solver.order" TEN ", {key: solver.max_steps" TEN ", {key: time.end" TEN \
          ", {key: wake.lifetime" TEN ", {key: 'fish[0].length'" TEN
#define EXPECTED(of) SWEPT("key: solver.order, values: [1, 2]") "expect: [{of: " of "}]\n"
    static const struct {
        const char *inside, *outside, *message;
    } limits[] = {
        {SHORT "fish: [{length: 0.5, start: {position: [0, -4.99e5]}}]\n",
         SHORT "fish: [{length: 0.5, start: {position: [0, -5.01e5]}}]\n",
         "start.position: -501000 m is 1.002e+06 body"},
        {SHORT "fish: [{length: 2, start: {position: [1.99e6, 0]}}]\n",
         SHORT "fish: [{length: 2, start: {position: [2.01e6, 0]}}]\n", "start.position: 2.01e+06 m is 1.005e+06 body"},
        {SHORT "fish: [{length: 0.5, motion: {prescribed: all, heave: 4.99e5, frequency: 1}}]\n",
         SHORT "fish: [{length: 0.5, motion: {prescribed: all, heave: 5.01e5, frequency: 1}}]\n",
         "motion.heave: 501000"},
        {SHORT "fluid: {walls: [-1.99e6]}\nfish: [{}, {length: 2, start: {position: [0, 9]}}]\n",
         SHORT "fluid: {walls: [-2.01e6]}\nfish: [{}, {length: 2, start: {position: [0, 9]}}]\n",
         "fluid.walls: -2.01e+06 m is 1.005e+06 body lengths"},
        {"time: {end: 1e6, shedding_interval: 1}\nwake: {lifetime: 100}\nfish: [{wave: {frequency: 999}}]\n",
         "time: {end: 1e6, shedding_interval: 1}\nwake: {lifetime: 100}\nfish: [{wave: {frequency: 1001}}]\n",
         "1.001e+09 cycles until"},
        {"time: {end: 999e6, shedding_interval: 1}\nwake: {lifetime: 100}\nfish: [{wave: {frequency: 0.5}}]\n",
         "time: {end: 1001e6, shedding_interval: 1}\nwake: {lifetime: 100}\nfish: [{wave: {frequency: 0.5}}]\n",
         "1.001e+09 events; the maximum is 1e+09"},
        {"time: {end: 1e6, shedding_interval: 0.01}\nwake: {lifetime: 99990}\nfish: [{}]\n",
         "time: {end: 1e6, shedding_interval: 0.01}\nwake: {lifetime: 100010}\nfish: [{}]\n",
         "1.0001e+07 vortices in the wake of a fish"},
        {"time: {end: 99990, shedding_interval: 0.01}\nwake: {lifetime: 1e9}\nfish: [{}]\n",
         "time: {end: 100010, shedding_interval: 0.01}\nwake: {lifetime: 1e9}\nfish: [{}]\n",
         "1.0001e+07 vortices in the wake of a fish"},
        {SHORT "wake: {lifetime: 2, decay: 2}\nfish: [{}]\n", SHORT "wake: {lifetime: 1.99, decay: 2}\nfish: [{}]\n",
         "wake.decay: 2 s is longer than wake.lifetime, 1.99 s"},
        {SHORT "wake: {lifetime: 0.01, decay: 0}\nfish: [{}]\n",
         SHORT "wake: {lifetime: 0.0099, decay: 0}\nfish: [{}]\n", "wake.lifetime: 0.0099 s is less than"},
        {"time: {end: 2.0000000019, shedding_interval: 0.01}\nfish: [{}]\n",
         "time: {end: 2.0000000021, shedding_interval: 0.01}\nfish: [{}]\n",
         "time.end: 2 s is not an integer multiple"},
        {SHORT "fish: [{nodes: 5, wave: {table: [[12.566, -1], [1, 1]]}}]\n",
         SHORT "fish: [{nodes: 5, wave: {table: [[1, 1], [1, -12.567]]}}]\n", "turns a joint by up to 3.14 rad"},
        {SHORT "fish: [{}]\nsweep: [{key: time.shedding_interval, values: [0.01, 0.02]}]\n",
         SHORT "fish: [{}]\nsweep: [{key: time.shedding_interval, values: [0.01, 0.0200001]}]\n",
         "value 0.0200001 of time.shedding_interval does not divide time.end, 1 s"},
        {SHORT "fish: [{}]\nsweep: [{keys: [time.shedding_interval, time.end], values: [[0.01, 1], [0.03, 0.9]]}]\n",
         SHORT
         "fish: [{}]\nsweep: [{keys: [time.shedding_interval, 'fish[0].nodes'], values: [[0.01, 9], [0.03, 9]]}]\n",
         "{keys: [time.shedding_interval, time.end], values: [[0.03, 0.99], ...]}"},
        {SHORT
         "fish: [{nodes: 7, control: {bias: 2}, wave: {amplitude: 0.5, constant: 1, linear: 0, quadratic: 0, table: "
         "[[12.8, -1], [1, 1]]}}]\n",
         SHORT "fish: [{nodes: 7, control: {bias: 2.1}, wave: {amplitude: 0.5, constant: 1, linear: 0, quadratic: 0, "
               "table: [[12.8, -1], [1, 1]]}}]\n",
         "turns a joint by up to 3.18 rad"},
        {SHORT
         "fish: [{nodes: 7, control: {bias: 1}, wave: {amplitude: 1.55, constant: 1, linear: 0, quadratic: 0}}]\n",
         SHORT "fish: [{nodes: 7, control: {bias: 1}, wave: {amplitude: 1.6, constant: 1, linear: 0, quadratic: 0}}]\n",
         "turns a joint by up to 3.2 rad"},
        {FINITE("26"), FINITE("25"), "a span of 0.2 lengths needs at least 26 points"},
        {SHORT "fish: [{nodes: 9, sheet_points: 17, force: pressure, pressure: {span: infinite}}]\n",
         SHORT "fish: [{nodes: 9, sheet_points: 16, force: pressure, pressure: {span: infinite}}]\n",
         "of 9 nodes needs at least 17 points, not 16"},
        {SHORT "fluid: {walls: [-1, 1]}\nfish: [{pressure: {span: infinite}}]\n",
         SHORT "fluid: {walls: [-1, -1]}\nfish: [{}]\n", "the second wall must be above the first; -1 is not above -1"},
        {BETWEEN("vortices: [[0, -0.99, 1]]"), BETWEEN("vortices: [[0, -1, 1]]"), "vortex 1 is beyond a wall"},
        {BETWEEN("vortices: [[0, 2.99, 1]]"), BETWEEN("vortices: [[0, 3, 1]]"), "vortex 1 is beyond a wall"},
        {BETWEEN(STREET "[5, -0.74]}"), BETWEEN(STREET "[5, -0.76]}"), "a row of the street is beyond a wall"},
        {BETWEEN(STREET "[5, 2.74]}"), BETWEEN(STREET "[5, 2.76]}"), "a row of the street is beyond a wall"},
        {GUST("uniform, frequency: 1"), GUST("sine, wavelength: 2"), "needs a stream with a potential"},
        {GUST("uniform, frequency: 2"), GUST("step, gradient_distance: 1"), "needs a stream with a potential"},
        {WITHOUT_BEAT("motion: {prescribed: all, heave: 1, phase: 90}"),
         WITHOUT_BEAT("motion: {prescribed: all, heave: 1, phase: 180}"), "motion.heave: has no effect with"},
        {WITHOUT_BEAT("force: reactive, drag: {law: linear_quadratic, linear_speed: 0}"),
         WITHOUT_BEAT("force: reactive, drag: {law: linear_quadratic, linear_speed: 1}"), "in lengths per beat"},
        {WITHOUT_BEAT("control: {law: heading}"), WITHOUT_BEAT("control: {law: course}"), "law: needs wave.frequency"},
        {WITHOUT_BEAT("force: reactive, control: {law: heading}"),
         WITHOUT_BEAT("force: reactive, control: {law: heading, feedforward: 1}"), "above 0, or feedforward: 0"},
        {SHORT "fluid: {density: 0}\nfish: [{force: reactive, control: {law: heading}}]\n",
         SHORT "fluid: {density: 0}\nfish: [{force: reactive, control: {law: heading, feedforward: 1}}]\n",
         "needs fluid.density above 0, or feedforward: 0"},
        {SHORT "wake: {shedding: sheet}\nsheet: {kutta: edge}\nfish: [{}]\n",
         SHORT "wake: {shedding: sheet}\nsheet: {kutta: rate}\nfish: [{}]\n", "strength that vanishes at the tail"},
        {SHORT "wake: {lifetime: 3, decay: 1 beats}\nfish: [{}]\n",
         SHORT "wake: {lifetime: 3, decay: 1 beats}\nfish: [{wave: {frequency: 0}}]\n",
         "wake.decay: is in beats, but no fish beats"},
        {SHORT "fish: [{control: {law: heading, desired_heading: [[0, 10], [1e-9, 20]]}}]\n",
         SHORT "fish: [{control: {law: heading, desired_heading: [[-1e-9, 10], [1, 20]]}}]\n",
         "the first time must be at least 0 s"},
        {SHORT "fish: [{control: {law: heading, desired_heading: [[0, 10], [1, 20]]}}]\n",
         SHORT "fish: [{control: {law: heading, desired_heading: [[1, 10], [1, 20]]}}]\n",
         "the times must increase; 1 follows 1"},
        {STEPPED("0.01"), STEPPED("0.03"), "the nearest divisor is 0.01"},
        {"time: {end: 0.01, shedding_interval: 0.01}\nfish: [{}]\n",
         "time: {end: 0.0099, shedding_interval: 0.01}\nfish: [{}]\n", "0.0099 s is less than time.shedding_interval"},
        {STEPPED("0.003333333333333"), STEPPED("0.0033334"), "0.0033334 s does not divide"},
        {BENT("control: {bias: -1}, wave: {amplitude: -1.55, constant: 1, linear: 0"),
         BENT("control: {bias: -1}, wave: {amplitude: -1.6, constant: 1, linear: 0"), "turns a joint by up to 3.2 rad"},
        {BENT("control: {law: heading, limit: 1}, wave: {amplitude: 1.55, constant: 1, linear: 0"),
         BENT("control: {law: heading, limit: 1}, wave: {amplitude: 1.6, constant: 1, linear: 0"), "up to 3.2 rad"},
        {SHORT "fish: [{nodes: 7, wave: {amplitude: 4.5, constant: 0, linear: 0, quadratic: 1}}]\n",
         SHORT "fish: [{nodes: 7, wave: {amplitude: 4.55, constant: 0, linear: 0, quadratic: 1}}]\n", "up to 3.16 rad"},
        {SHORT "fish: [{start: {heading: 180}, motion: {prescribed: all, heave: 0.1, frequency: 1, surge: free}}]\n",
         SHORT "fish: [{start: {heading: 90}, motion: {prescribed: all, heave: 0.1, frequency: 1, surge: free}}]\n",
         "0 or 180 degrees, not 90"},
        {FLUID("walls: [-1], velocity: [-0.5, 0]"), FLUID("walls: [-1], velocity: [0.5, -1e-9]"), "flows through"},
        {FLUID("walls: [-1], gust: {amplitude: 0}"), FLUID("walls: [-1], gust: {amplitude: -1, frequency: 1}"),
         "the gust flows through fluid.walls"},
        {FLUID("gust: {profile: sine, speed: -10, wavelength: 1.01e-8}"),
         FLUID("gust: {profile: sine, speed: -10, wavelength: 0.99e-8}"),
         "fluid.gust.wavelength: 1.0101e+09 cycles until time.end"},
        {RIPPLE("31"), RIPPLE("30"), "changes within 0.1 m needs at least 31 points, not 30"},
        {PAIR("fluid: {gust: {amplitude: 0, profile: step, speed: 1}}", "force: reactive", "force: reactive"),
         PAIR("fluid: {gust: {amplitude: 1, profile: step, speed: 1}}", "", "force: reactive"), "needs a gust that is"},
        {PAIR("wake: {vortices: [[9, 9, 1]]}", "pressure: {span: infinite}", "force: reactive"),
         PAIR("wake: {vortices: [[9, 9, 1]]}", "force: reactive", "pressure: {span: infinite}"), "of the first fish"},
        {PAIR("wake: {vortices: [[9, 9, 1]]}", "pressure: {span: infinite}", "pressure: {span: infinite}"),
         PAIR("wake: {vortices: [[9, 9, 1]]}", "pressure: {span: infinite}", "pressure: {span: finite}"), "not a ring"},
        {PAIR("", "force: reactive", "pressure: {span: finite}}, {start: {position: [0, 4]}, pressure: {span: finite}"),
         PAIR("", "force: reactive",
              "pressure: {span: finite}}, {start: {position: [0, 4]}, pressure: {span: infinite}"),
         "fish[2].pressure.span: fish[1] has another span"},
        {LAW("course, slow: 2"), LAW("heading, slow: 2"), "control.slow: has no effect with 'law: heading'"},
        {LAW("course, course_filter: 3"), LAW("heading, course_filter: 3"), "course_filter: has no effect with"},
        {LAW("averaged_heading, rate: 3"), LAW("heading, rate: 3"), "rate: has no effect with"},
        {WITHOUT_BEAT("control: {law: heading}"), WITHOUT_BEAT("control: {law: averaged_heading}"), "needs wave.freq"},
        {SHORT "fish: [{motion: {prescribed: head, frequency: 1}}]\n",
         SHORT "fish: [{motion: {prescribed: head, frequency: 1.0e-310}}]\n",
         "fish[0].motion.frequency: the default of wake.lifetime would be inf"},
        {SHORT "fish: [{nodes: 4, body: {profile: table, thickness_table: [1, 1, 1], depth_table: [1, 1, 1]}}]\n",
         SHORT "fish: [{nodes: 4, body: {profile: table, thickness_table: [1, 1, 1], depth_table: [1e-6, 1, 1]}}]\n",
         "fish[0].body.depth_table: the default of fish.sheet_points would be"},
        {SWEPT("key: solver.order, values: [1]"), SWEPT("key: format, values: [1]"), "'format' cannot be swept"},
        {SWEPT("key: 'fish[*].nodes', values: [9, 13, 17], refine: true"),
         SWEPT("key: 'fish[*].drag.normal', values: [1, 2, 3], refine: true"), "drag.normal' is not a resolution"},
        {TENS "]\n", TENS ", {key: 'fish[0].nodes', values: [9, 13]}]\n", "sweep: 200000 members or more"},
        {EXPECTED("speed, spread: 0, ratio: 1"), EXPECTED("speed, spread: 0, ratio: 0.999"),
         "ratio: expects a number from 1"},
        {EXPECTED("speed, least: 1"), EXPECTED("nose, least: 1"), "nose is a point"},
        {EXPECTED("speed, ratio: 1"), EXPECTED("nose, ratio: 1"), "nose is a point"},
        {SHORT "fish: [{}]\nerror: {of: speed, keys: [nodes, rtol]}\n",
         SHORT "fish: [{}]\nerror: {of: speed, keys: [nodes, rtol, rtol]}\n", "'solver.rtol' is there twice"}};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        is_refused(limits[i].inside, NULL);
        is_refused(limits[i].outside, limits[i].message);
    }
}

TEST(a_school_beyond_any_memory_is_refused) {
    static const struct {
        const char *keys, *message;
        int n_most; /* fish that are accepted */
    } limits[] = {
        {"time: {end: 1e5, shedding_interval: 0.01}\nwake: {lifetime: 1e5}\n", "the wakes of 106 fish take 1 TB", 105},
        {"time: {end: 1}\ndefaults: {fish: {sheet_points: 10000}}\n", "the sheets of 313 fish take 1 TB", 312}};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        for (int n = limits[i].n_most; n <= limits[i].n_most + 1; n++) {
            struct text text = {.arena = test_arena()};
            text_add(&text, "format: 1\n%sfish: [", limits[i].keys);
            for (int f = 0; f < n; f++) text_add(&text, "{start: {position: [0, %d]}}, ", f);
            text_add(&text, "]\n");
            struct case_values values;
            const enum status status = case_parse(&values, text.text, text.length, "cases/x.yaml", NULL, 0, NULL);
            assert_int_equal(status, n == limits[i].n_most ? STATUS_OK : STATUS_CASE);
            if (status != STATUS_OK) assert_non_null(strstr(status_message(), limits[i].message));
            case_free(&values);
        }
    }
}

TEST(times_that_do_not_fit_a_given_interval_are_errors) {
    static const char text[] = "format: 1\ntime: {end: 2, shedding_interval: 0.007}\nfish: [{}]\n";
    struct case_values values;
    assert_int_equal(case_parse(&values, text, sizeof text - 1, "test", ".", 0, NULL), STATUS_CASE);
    assert_non_null(strstr(status_message(), "time.end: 2 s is not an integer multiple of time.shedding_interval"));
}
