/* test_key_results.c: all variables after two intervals with each key changed, against tests/data/key_results.tsv, as
 * tests/library/test_results.c compares longer runs. After an intended change:
 *
 *     build/tests/extra/test_key_results --write
 */
#include <stdio.h>
#include <string.h>

#include "case/case.h"
#include "case/case_table.h"
#include "near.h"
#include "result_entry.h"
#include "shoal.h"

static const char key_table[] = "tests/data/key_results.tsv";

/* The runs have rtol 1e-8: with fused multiplications the sums change by less than 1e-11. On another processor the
 * integrator may choose another step. */
#ifdef __x86_64__
static const double of_keys = 1e-7;
#else
static const double of_keys = 1e-5;
#endif

/* Two intervals of a school in which most keys act. In place of %: sheet points and forces of fish 0, 1 and 2, and
 * what only some forces allow. */
static const char school[] =
    "format: 1\ntime: {end: 0.02, shedding_interval: 0.01}\nsolver: {rtol: 1e-8}\n" BODY
    "fluid: {velocity: [0.2, -0.1]%s}\nwake: {lifetime: 0.3, decay: 0.295}\noutput: {forces: edges}\n"
    "fish: [{nodes: 5, sheet_points: %d, wave: {phase: 20, ramp: 0}, start: {heading: 170, speed: 0.8}%s},\n"
    "    {nodes: 6, sheet_points: %d, length: 0.8, wave: {frequency: 2, phase: 50, ramp: 0.1},\n"
    "     start: {position: [0.2, 0.6], speed: 0.6}%s},\n"
    "    {nodes: 5, sheet_points: %d, start: {position: [0.1, -0.7], heading: 180, speed: 0.5}, wave: {frequency: 3},\n"
    "     motion: {prescribed: head, heave: 0.05, pitch: 8, pitch_phase: 80, frequency: 3, phase: 20, pivot: "
    "0.1}%s}]\n";
#define REACTIVE ", force: reactive"
#define PLANE ", force: pressure, pressure: {span: infinite}"
#define TAPERED(thicknesses, depths) \
    ", body: {profile: table, thickness_table: " thicknesses ", depth_table: " depths "}"
static const char *const school_parts[][4] = {
    {", viscosity: 2e-6, gust: {amplitude: 0.15, frequency: 2.2}", REACTIVE, PLANE ", sensors: [0.2, 0.7]", REACTIVE},
    // the rows that begin with r, p, f
    {"", REACTIVE, REACTIVE, REACTIVE},
    {"", PLANE, PLANE, PLANE},
    {"", TAPERED("[0.06, 0.11, 0.08, 0.04]", "[0.12, 0.2, 0.18, 0.24]"),
     TAPERED("[0.05, 0.1, 0.09, 0.07, 0.04]", "[0.22, 0.3, 0.25, 0.2, 0.1]") ", sensors: [0.2, 0.7]",
     TAPERED("[0.08, 0.09, 0.07, 0.05]", "[0.1, 0.15, 0.25, 0.2]")},
};

#define SINE "fluid.gust.amplitude=0.1; fluid.gust.profile=sine; fluid.gust.wavelength=0.7"
#define STEP "fluid.gust.amplitude=0.1; fluid.gust.profile=step; fluid.gust.gradient_distance=0.3"
#define STREET "wake.street.vortices=6; wake.street.spacing=0.3; wake.street.circulation=0.02"
#define BESIDE "wake.vortices=[[1.2, -0.12, 0.05], [0.8, -0.1, -0.04]]"
#define LINEAR "fish[0].drag.law=linear_quadratic"
#define AVERAGED "fish[0].control.law=averaged_heading; fish[0].control.desired_heading=150"
#define COURSE "fish[0].control.law=course; fish[0].control.desired_heading=150"
#define HEADING "fish[0].control.law=heading; fish[0].control.desired_heading=150"
#define FED HEADING "; fish[0].control.feedforward=0.5"
#define ALL "fish[2].motion.prescribed=all"
#define NEAR_ "fish[1].start.position=[0.05, 0.25]"

/* Assignments to this school. No two rows give the same results: each key acts. */
static const char *const assignments[] = {
    "fluid.density=900",
    "fluid.viscosity=3e-6",
    "fluid.velocity=[0.3, -0.1]",
    "fluid.velocity=[0.2, 0.1]",
    "fluid.shear=0.5; fish[1].sensors=[]",
    "fluid.gust.amplitude=0.2",
    "fluid.gust.frequency=3",
    "p " SINE,
    "p " SINE "; fluid.gust.speed=0.5",
    "p " SINE "; fluid.gust.position=0.1",
    "p fluid.gust.amplitude=0.1; fluid.gust.profile=sine; fluid.gust.wavelength=0.9",
    "p " STEP,
    "p " STEP "; fluid.gust.position=0.1",
    "p " STEP "; fluid.gust.speed=0.5",
    "p fluid.gust.amplitude=0.1; fluid.gust.profile=step; fluid.gust.gradient_distance=0.4",
    "r fluid.velocity=[0.2, 0]; fluid.walls=[-1.2]",
    "r fluid.velocity=[0.2, 0]; fluid.walls=[-1.2, 1.4]",
    "wake.smoothing=0.15",
    "p " BESIDE,
    "p " BESIDE "; wake.taper=0.4",
    "p " BESIDE "; wake.taper_beside=0.2",
    "wake.lifetime=0.4",
    "wake.decay=0.2",
    "wake.lifetime=0.02; wake.decay=0.015",
    "wake.lifetime=0.02; wake.decay=0.015; wake.removed_circulation=dropped",
    "fish[1].wake_lifetime=0.8; wake.lifetime=0.02; wake.decay=0.015",
    "r wake.shedding=continuous",
    "r wake.shedding=continuous; sheet.kutta=rate",
    "r wake.shedding=impulsive",
    "p wake.vortices=[[0.5, 0.4, 0.05]]",
    "p " STREET,
    "p " STREET "; wake.street.row_distance=0.2",
    "p " STREET "; wake.street.position=[0.1, 0.2]",
    "p wake.street.vortices=6; wake.street.spacing=0.4; wake.street.circulation=0.02",
    "p wake.street.vortices=6; wake.street.spacing=0.3; wake.street.circulation=0.03",
    "sheet.smoothing=0.08",
    "r sheet.curve=polygon",
    "r wake.shedding=continuous; sheet.collocation=midpoint",
    NEAR_ "; contact.range=0.1",
    NEAR_ "; contact.range=0.12",
    NEAR_ "; contact.range=0.1; contact.action=warn",
    "r solver.method=rk4; solver.step=1e-3; fish[*].body.modulus=1e4",
    "r solver.method=heun; solver.step=2.5e-3; fish[*].body.modulus=1e4",
    "time.shedding_interval=0.005",
    "fish[0].length=1.1",
    "fish[1].length=0.9",
    "fish[0].nodes=6",
    "fish[0].reference_nodes=9",
    "fish[0].sheet_points=15",
    "fish[1].sheet_points=17",
    "fish[0].body.profile=uniform",
    "fish[0].body.profile=table; fish[0].body.thickness_table=[0.05, 0.1, 0.08, 0.04]; "
    "fish[0].body.depth_table=[0.16, 0.2, 0.18, 0.22]",
    "fish[1].body.profile=uniform; fish[1].body.thickness=0.1",
    "fish[0].body.thickness=0.15",
    "fish[0].body.tail_thickness=0.06",
    "fish[0].body.depth=0.3",
    "fish[1].body.depth=0.3",
    "fish[0].body.section=nodes",
    "fish[0].body.density=1100",
    "fish[0].body.modulus=8e5",
    "fish[0].body.second_moment=published",
    "fish[0].body.bending_damping=0.3",
    "fish[0].body.stretching_damping=700",
    "fish[0].body.relaxation_time=0.03",
    "fish[0].body.damping=curvature",
    "fish[0].wave.amplitude=0.5",
    "fish[0].wave.constant=0.1",
    "fish[0].wave.linear=0.8",
    "fish[0].wave.quadratic=0.4",
    "fish[0].wave.number=-5",
    "fish[0].wave.wavelength=0.9",
    "fish[0].wave.table=[[0.1, 0.3, -0.2, 0], [0.5, 0.1, -0.4, 0.2], [0.6, 1, -0.7, 0.1]]",
    "fish[0].wave.frequency=1.5",
    "fish[0].wave.phase=40",
    "fish[0].wave.ramp=0.3",
    "fish[0].force=published",
    "fish[0].force=published; fish[0].added_mass.extent=thickness",
    "fish[0].force=published; fish[0].added_mass.coefficient=1.5; " LINEAR,
    "fish[0].force=pressure; fish[0].pressure.span=infinite",
    "",
    "r ",
    "p ",
    "fish[1].pressure.span=finite",
    "fish[*].force=pressure; fish[*].pressure.span=finite; fluid.shear=0.1; fish[1].sensors=[]",
    "fish[1].pressure.suction=0.7",
    "fish[1].pressure.suction_limit=0.02",
    "fish[1].pressure.suction_limit=0.03",
    "fish[1].sensors=[0.2, 0.6]",
    "fish[0].drag.tangential=6e-3",
    "fish[0].drag.skin=laminar",
    "fish[0].drag.skin=boundary_layer",
    "fish[0].drag.skin=boundary_layer; fish[0].drag.form=1.8",
    "fish[1].drag.transition=1e5",
    "fish[1].drag.transition=0",
    "fish[1].drag.skin=laminar",
    "fish[1].drag.waving=1.2",
    "fish[1].drag.form=1.3",
    "fish[1].drag.normal=0.4",
    "fish[0].drag.normal=0.7",
    LINEAR,
    LINEAR "; fish[0].drag.linear_speed=0.4",
    "fish[0].added_mass.coefficient=1.2",
    "fish[0].added_mass.extent=thickness",
    "fish[0].start.position=[0.05, 0.02]",
    "fish[0].start.heading=165",
    "fish[0].start.speed=0.7",
    "fish[0].load.tip=[0.3, -0.4]",
    "fish[1].load.tip=[0.3, -0.4]",
    ALL,
    ALL "; fish[2].motion.surge=free",
    "p " ALL "; fish[2].motion.surge=free",
    "fish[2].motion.surge=free",
    "p fish[2].motion.surge=free",
    "fish[2].motion.speed=0.6",
    "fish[2].motion.heave=0.07",
    "fish[2].motion.pitch=12",
    "fish[2].motion.pitch_phase=60",
    "fish[2].motion.frequency=2",
    "fish[2].motion.phase=50",
    "fish[2].motion.pivot=0.3",
    HEADING,
    HEADING "; fish[0].control.gain=0.7",
    HEADING "; fish[0].control.limit=0.3",
    FED,
    FED "; fish[0].control.filter=0.3",
    FED "; fish[0].control.filter=0",
    AVERAGED,
    AVERAGED "; fish[0].control.rate=0.1",
    AVERAGED "; fish[0].control.limit=0.01",
    COURSE,
    "fish[0].control.waypoints=[[-1, -1], [-2, -3]]",
    "fish[0].control.waypoints=[[-1, -1], [-2, -3]]; fish[0].control.acceptance_radius=3",
    "fish[0].control.bias=0.2",
    "r preset=published; fish[*].force=published",
    "f ",
    "f fluid.density=900; fluid.viscosity=3e-6",
    "f wake.leg_length=1.5",
    "f fluid.velocity=[0.3, 0.2]",
    "f fluid.velocity=[1.5, 0.6]",
    "f fluid.velocity=[-1.2, 0.1]",
    "f fluid.velocity=[0.2, 0]; fluid.walls=[-1.2, 1.4]",
    "f fluid.shear=0.5; fish[1].sensors=[]",
    "f fluid.gust.amplitude=0.2; fluid.gust.frequency=3",
    "f " SINE "; fluid.gust.speed=0.5; fish[1].sensors=[]",
    "f " STEP "; fluid.gust.speed=0.5; fish[1].sensors=[]",
    "f fish[1].start.position=[0.05, 0.16]",
    "f wake.lifetime=0.02; wake.decay=0.015",
    "f fish[1].start.position=[0.05, 0.16]; contact.range=0.1",
    "f fish[1].start.position=[0.05, 0.16]; contact.range=0.1; fluid.velocity=[0.2, 0]; fluid.walls=[-1.2, 0.27]",
    "f solver.method=trapezoid; solver.step=2.5e-3",
    "f solver.method=implicit_euler; solver.step=2.5e-3",
    // tight, because the step of another version of SUNDIALS differs
    "f solver.method=dormand_prince; solver.rtol=1e-10; fish[*].body.modulus=1e4",
    "f solver.method=rk4; solver.step=5e-4; fish[*].body.modulus=1e4",
    "f fish[1].length=0.9; fish[0].sheet_points=57",
    "f fish[1].body.depth_table=[0.22, 0.3, 0.25, 0.2, 0.15]",
    "f fish[1].body.depth_table=[0.26, 0.3, 0.25, 0.2, 0.1]",
    "f fish[1].body.section=nodes; fish[1].body.density=1100",
    "f fish[1].body.damping=curvature; fish[1].body.bending_damping=0.3",
    "f fish[1].force=reactive; fish[1].sensors=[]",
    "f fish[1].force=reactive; fish[1].sensors=[]; fish[1].drag.normal=0.6; fish[1].added_mass.coefficient=1.2",
    "f fish[*].pressure.span=infinite",
    "f fish[0].pressure.suction=0.7; fish[1].pressure.suction_limit=0.03",
    "f fish[1].drag.skin=laminar",
    "f fish[1].drag.skin=boundary_layer; fish[1].drag.transition=1e5",
    "f fish[1].drag.waving=1.2; fish[1].drag.form=1.3; fish[1].drag.normal=0.4",
    "f fish[*].start.heading=40",
    "f fish[*].start.heading=200; fish[0].start.speed=-0.4; fish[1].start.speed=1.5",
    "f fish[0].wave.constant=1; fish[0].wave.amplitude=0.8; fish[1].load.tip=[0.3, -0.4]",
    "f " ALL,
    "f fish[2].motion.surge=free; fish[2].motion.pivot=0.3; fish[2].motion.pitch=30",
    "f " COURSE "; fish[0].control.limit=0.2",
    "f fish[0].control.bias=0.4; fish[1].control.law=heading; fish[1].control.desired_heading=100",
};
enum { N_ASSIGNMENTS = sizeof assignments / sizeof *assignments, MAX_ASSIGNED = 6 };

/* Keys without influence on two intervals: files, limits and machines, steady states, what only a program uses, and
 * the law that holds a place, which begins after a beat (tests/control/test_control.c). */
static const char keys_elsewhere[] =
    " format name include time.end time.output_interval time.checkpoint_interval time.checkpoint_wall wake.tolerance "
    "wake.spare_vortices solver.rtol solver.order solver.error_test solver.coupling_distance solver.linear "
    "solver.threads "
    "solver.max_steps output.file "
    "output.precision output.forces output.wake_interval steady.tolerance steady.beats steady.output_beats "
    "steady.formation steady.multipliers defaults fish.name fish.control.damping fish.control.slow "
    "fish.control.course_filter fish.control.ramp fish.control.of fish.control.offset "
    "fish.control.amplitude_gain fish.control.amplitude_damping fish.control.amplitude_limit "
    "fish.control.lookahead fish.control.hold_time sweep expect error ";

/* The kind of the school of a row: 1, 2 and 3 for rows that begin with r, p and f, else 0. */
static int school_kind(const char *row) {
    static const char letters[] = "rpf";
    const char *const letter = *row && row[1] == ' ' ? strchr(letters, *row) : NULL;
    return letter ? (int)(letter - letters) + 1 : 0;
}

/* Sums over all variables at the start and after two intervals. Each variable is divided by its scale, so that each
 * counts as much as any other; without scales the sizes of the variables become the scales. */
static void sum_variables(const char *row, double scale[MAX_VARIABLES][2], int finds_scales, double sum[2]) {
    char words[500], text[2000], *list[MAX_ASSIGNED], *rest = words;
    const int kind = school_kind(row), more = kind == 3 ? 28 : 0;  // a finite span needs more points
    const char *const *const part = school_parts[kind];
    snprintf(text, sizeof text, school, part[0], 25 + more, part[1], 27 + more, part[2], 23 + more, part[3]);
    snprintf(words, sizeof words, "%s", row + (kind > 0 ? 2 : 0));
    int n = 0;
    for (char *word; (word = strtok_r(rest, ";", &rest));) {
        assert_in_range(n, 0, MAX_ASSIGNED - 1);
        list[n++] = word + strspn(word, " ");
    }

    struct shoal *run;
    if (shoal_open_text(&run, text, NULL, n, (const char *const *)list) != SHOAL_OK) {
        fail_msg("%s: %s", row, shoal_message());
    }
    for (int end = 0; end < 2; end++) {
        sum[end] = 0;
        if (shoal_advance(run, end * shoal_end(run)) != SHOAL_OK) fail_msg("%s: %s", row, shoal_message());
        for (int i = 0; shoal_variable(i); i++) {
            const char *const name = shoal_variable(i);
            struct shoal_array array;
            if (is_left_out(name) || strncmp(name, "steady_", 7) == 0) continue;
            assert_int_equal(shoal_read(run, name, &array), SHOAL_OK);
            if (array.type == SHOAL_CHAR) continue;
            assert_in_range(i, 0, MAX_VARIABLES - 1);
            const struct entry entry = entry_of(run, name);
            // a power of 2: the size itself would hide a factor on the variable
            if (finds_scales) scale[i][end] = entry.size > 1e-5 ? exp2(round(log2(entry.size))) : 1;
            sum[end] += (1 + 0.5 * sin(1.7 * i)) * entry.sum / scale[i][end];
        }
    }
    shoal_close(run);
}

static void sum_assignments(double sum[N_ASSIGNMENTS][2]) {
    static double scale[4][MAX_VARIABLES][2];
    static const char *const unchanged[] = {"", "r ", "p ", "f "};
    double unused[2];
    for (int kind = 0; kind < 4; kind++) sum_variables(unchanged[kind], scale[kind], 1, unused);
    for (int i = 0; i < N_ASSIGNMENTS; i++)
        sum_variables(assignments[i], scale[school_kind(assignments[i])], 0, sum[i]);
}

static int write_key_table(void) {
    static double sum[N_ASSIGNMENTS][2];
    sum_assignments(sum);
    FILE *const file = fopen(key_table, "w");
    assert_non_null(file);
    fputs("# Sums at the start and after two intervals, for each row of tests/extra/test_key_results.c --write\n",
          file);
    for (int i = 0; i < N_ASSIGNMENTS; i++) fprintf(file, "%.14g %.14g\n", sum[i][0], sum[i][1]);
    return fclose(file);
}

TEST(every_key_has_its_results) {
    for (int i = 0; i < case_table_n; i++) {
        const char *const path = case_table[i].path;
        char text[100];
        int n = 0;
        snprintf(text, sizeof text, " %s ", path);
        if (strstr(keys_elsewhere, text)) continue;
        if (case_table_is_of_fish(&case_table[i])) {
            snprintf(text, sizeof text, "].%s=", path + strlen("fish."));
        } else {
            snprintf(text, sizeof text, "%s=", path);
        }
        for (int k = 0; k < N_ASSIGNMENTS; k++) n += strstr(assignments[k], text) != NULL;
        if (n == 0) fail_msg("no assignment to %s", path);
    }

    static double sum[N_ASSIGNMENTS][2];
    sum_assignments(sum);
    int n_wrong = 0;
    for (int i = 0; i < N_ASSIGNMENTS; i++) {
        for (int k = 0; k < i; k++) {
            if (fabs(sum[i][0] - sum[k][0]) + fabs(sum[i][1] - sum[k][1]) > 10 * of_keys) continue;
            n_wrong++;
            print_error("no difference between %s and %s\n", assignments[i], assignments[k]);
        }
    }
    FILE *const file = fopen(key_table, "r");
    assert_non_null(file);
    char line[256];
    int n = 0;
    double worst = 0;
    while (fgets(line, sizeof line, file)) {
        double want[2];
        if (sscanf(line, "%lf %lf", &want[0], &want[1]) != 2) continue;
        assert_in_range(n, 0, N_ASSIGNMENTS - 1);
        for (int end = 0; end < 2; end++) {
            // some rows have forces that the unchanged school lacks
            const double off = fabs(sum[n][end] - want[end]) / fmax(1, fabs(want[end]) / 100);
            worst = fmax(worst, off);
            if (off <= of_keys) continue;
            n_wrong++;
            print_error("%s: %s: %.10g becomes %.10g\n", assignments[n], end ? "two intervals" : "start", want[end],
                        sum[n][end]);
        }
        n++;
    }
    fclose(file);
    print_message("%d assignments, largest difference %.1e\n", n, worst);
    assert_int_equal(n, N_ASSIGNMENTS);
    assert_int_equal(n_wrong, 0);
}

int main(int argc, char **argv) {
    return argc > 1 && strcmp(argv[1], "--write") == 0 ? write_key_table() : near_run();
}
