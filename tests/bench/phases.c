/* phases.c: measures where the time of a run goes, and how it grows with the school, for `make bench`.
 *
 * phases CASES           single_free and diamond, with one thread and with two: time per event, simulated time per
 *                          second of wall clock, the ratio to the lower bound, the parts of the time
 * phases CASES --schools schools of 1 to 1024 fish with full wakes: time and memory per event, on one thread and on
 *       two in turn
 * phases CASES --schools THREADS N... the same for other schools and more threads
 * phases CASES --finite-schools ... the same with `pressure.span: finite`
 *
 * Schools take turns, event by event, and the ratios use the least times, because other processes slow down some
 * events, on one core or both, but hardly ever all of them.
 *
 * CASES is the folder of the cases. The linker wraps the functions below in a clock, which is not in the program. The
 * lower bound is the CPU time of all pairwise interactions of an event at the best rate of one core in the same run;
 * the ratio uses the CPU time of all threads, which depends least on the load of the machine:
 *
 *     wake on wake (n^2), sheets on wake (n M), wake on bodies once (n P), sheets on bodies at every residual (P M)
 *
 * with n vortices, M bound vortices and P points of bodies of the whole school, all by direct sums: a school that is
 * summed by the tree can be faster. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "flow/flow_at_bodies.h"
#include "result/result_file.h"
#include "run/simulate.h"
#include "run/simulate_run.h"
#include "school/residual.h"
#include "solver/linear.h"

static double read_clock(clockid_t id) {
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static double now(void) {
    return read_clock(CLOCK_MONOTONIC);
}

/* CPU time of all threads together, or of the working thread: depends least on the load of the machine, so all numbers
 * except "wall ms" and "x real" use the CPU time. */
static clockid_t cpu_clock = CLOCK_PROCESS_CPUTIME_ID;
static double cpu_time(void) {
    return read_clock(cpu_clock);
}

// ---- the clock

enum { WAKE, RESIDUAL, JACOBIAN, LINEAR, DIAGNOSTICS, OUTPUT, N_PHASES };
static const char *const phase_name[N_PHASES] = {"wake", "residual", "Jacobian", "linear", "diagnostics", "output"};
static struct seen {
    double time[N_PHASES];
    double interactions; /* of the lower bound */
    struct integrator_counts counts;
} seen;

static void add_time(int phase, double since) {
    seen.time[phase] += cpu_time() - since;
}

#define TIMED(phase, name, parameters, arguments)           \
    enum status __real_##name parameters;                   \
    enum status __wrap_##name parameters;                   \
    enum status __wrap_##name parameters {                  \
        const double since = cpu_time();                    \
        const enum status status = __real_##name arguments; \
        add_time(phase, since);                             \
        return status;                                      \
    }
TIMED(JACOBIAN, residual_jacobian,
      (struct residual * residual, const struct residual_mode *mode, double t, double cj, const double *y,
       struct jacobian *jacobian),
      (residual, mode, t, cj, y, jacobian))

// the integrator finds the linear solver in a table of functions
__typeof__(linear_sundials_create) __real_linear_sundials_create, __wrap_linear_sundials_create;
static int (*true_setup)(SUNLinearSolver, SUNMatrix);
static int (*true_solve)(SUNLinearSolver, SUNMatrix, N_Vector, N_Vector, sunrealtype);

static int timed_setup(SUNLinearSolver solver, SUNMatrix matrix) {
    const double since = cpu_time();
    const int code = true_setup(solver, matrix);
    add_time(LINEAR, since);
    return code;
}

static int timed_solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, sunrealtype tolerance) {
    const double since = cpu_time();
    const int code = true_solve(solver, matrix, x, b, tolerance);
    add_time(LINEAR, since);
    return code;
}

struct linear_sundials __wrap_linear_sundials_create(struct sundials_context *context, const struct jacobian *jacobian,
                                                     const double *scale, struct linear_tolerance tolerance) {
    const struct linear_sundials made = __real_linear_sundials_create(context, jacobian, scale, tolerance);
    true_setup = made.solver->ops->setup;
    true_solve = made.solver->ops->solve;
    made.solver->ops->setup = timed_setup;
    made.solver->ops->solve = timed_solve;
    return made;
}

void __real_linear_update_shed(struct linear *linear, const double *value);
void __wrap_linear_update_shed(struct linear *linear, const double *value);
void __wrap_linear_update_shed(struct linear *linear, const double *value) {
    const double since = cpu_time();
    __real_linear_update_shed(linear, value);
    add_time(LINEAR, since);
}

static double n_bound(const struct school *school) {
    double n = 0;
    for (int f = 0; f < school->n_fish; f++) n += school->fish[f].n_sheet;
    return n;
}

void __real_flow_at_wake(struct flow *flow, const struct state *state);
void __wrap_flow_at_wake(struct flow *flow, const struct state *state);
void __wrap_flow_at_wake(struct flow *flow, const struct state *state) {
    const double since = cpu_time();
    __real_flow_at_wake(flow, state);
    add_time(WAKE, since);
    double n = 0;
    for (int f = 0; f < flow->school->n_fish; f++) n += state->wake[f].n_vortex;
    seen.interactions += n * (n + n_bound(flow->school) + flow->n_points);
}

__typeof__(residual_evaluate) __real_residual_evaluate, __wrap_residual_evaluate;
enum status __wrap_residual_evaluate(struct residual *residual, const struct residual_mode *mode, double t,
                                     const double *y, const double *yp, double *value) {
    const double since = cpu_time();
    const enum status status = __real_residual_evaluate(residual, mode, t, y, yp, value);
    add_time(RESIDUAL, since);
    seen.interactions += residual->flow->n_points * n_bound(residual->school);
    return status;
}

void __real_diagnostics_step(const struct residual *residual, struct state *state, double t, const double *y);
void __wrap_diagnostics_step(const struct residual *residual, struct state *state, double t, const double *y);
void __wrap_diagnostics_step(const struct residual *residual, struct state *state, double t, const double *y) {
    const double since = cpu_time();
    __real_diagnostics_step(residual, state, t, y);
    add_time(DIAGNOSTICS, since);
}

enum status __real_result_file_row(struct result_file *result, const struct result_row *row);
enum status __wrap_result_file_row(struct result_file *result, const struct result_row *row);
enum status __wrap_result_file_row(struct result_file *result, const struct result_row *row) {
    const double since = cpu_time();
    const enum status status = __real_result_file_row(result, row);
    add_time(OUTPUT, since);
    seen.counts = *row->counts;
    return status;
}

static void must(enum status status) {
    if (status == STATUS_OK) return;
    fprintf(stderr, "phases: %s\n", status_message());
    exit(status_exit_code(status));
}

// interactions per second of wakes on themselves, with the size of the wakes of the diamond, on one core
static double best_rate(void) {
    enum { N = 1600, RUNS = 20 };
    struct arena *const arena = arena_create(NULL, "vortices");
    struct sources vortices = {.arena = arena};
    static double u[N], v[N];
    sources_append(&vortices, N);
    const struct kernel_pair pair = kernel_infinite.own(0, 0.04);
    const struct targets at = {.n = N, .x = vortices.x, .y = vortices.y, .u = u, .v = v};
    for (int i = 0; i < N; i++) {
        vortices.x[i] = 0.01 * (i % 400);
        vortices.y[i] = i / 400 + 0.2 * sin(0.03 * i);
        vortices.q[i] = 0.01 * cos(0.03 * i);
    }
    double best = 0;
    for (int run = 0; run < RUNS; run++) {
        const double since = now();
        kernel_induce_mutual(&pair, &vortices, &at, &vortices, &at);
        best = fmax(best, (double)N * N / (now() - since));
    }
    arena_free(arena);
    return best;
}

// MB that the process holds now
static double memory(void) {
    long pages = 0;
    FILE *const file = fopen("/proc/self/statm", "r");
    if (!file || fscanf(file, "%*d %ld", &pages) != 1) abort();
    fclose(file);
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / (1 << 20);
}

static void read_case(struct case_values *values, const char *text, int threads) {
    char assignment[64];
    snprintf(assignment, sizeof assignment, "solver.threads=%d", threads);
    const char *const assignments[] = {assignment};
    must(case_parse(values, text, strlen(text), "bench.yaml", NULL, 1, assignments));
}

static void print_head(void) {
    printf("%-12s %7s %8s %8s %8s %8s %8s %7s ", "", "threads", "vortices", "wall ms", "cpu ms", "x real", "x bound",
           "memory");
    for (int i = 0; i < N_PHASES; i++) printf(" %13s", phase_name[i]);
    printf(" %8s\n%-12s %7s %8s %8s %8s %8s %8s %7s  %% of the CPU time\n", "rest", "", "", "", "/event", "/event",
           "time", "", "MB");
}

static void print_row(const char *name, int threads, int n_vortices, long n_events, double interval, double wall,
                      double cpu, double megabytes) {
    const double rate = best_rate();
    printf("%-12s %7d %8d %8.3f %8.3f %8.3g %8.2f %7.0f ", name, threads, n_vortices, 1e3 * wall / (double)n_events,
           1e3 * cpu / (double)n_events, (double)n_events * interval / wall, cpu * rate / seen.interactions, megabytes);
    double rest = 1;
    for (int i = 0; i < N_PHASES; i++) {
        if (i != OUTPUT && !(seen.time[i] > 0)) {
            fprintf(stderr, "phases: no time of '%s' was measured; wrap what is called from another file\n",
                    phase_name[i]);
            exit(1);
        }
        printf(" %13.1f", 100 * seen.time[i] / cpu);
        rest -= seen.time[i] / cpu;
    }
    printf(" %8.1f\n", 100 * rest);
    fflush(stdout);
}

// ---- whole runs with output

static void whole_run(const char *cases, const char *name, int threads) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.yaml", cases, name);
    char assignment[64];
    snprintf(assignment, sizeof assignment, "solver.threads=%d", threads);
    const char *const assignments[] = {assignment};
    struct case_values values;
    must(case_read(&values, path, 1, assignments));
    memset(&seen, 0, sizeof seen);
    const struct simulate_options options = {.path = "phases.nc", .overwrite = 1, .command = "phases"};
    const double since = now(), cpu_since = cpu_time();
    must(simulate_run(&values, &options));
    const double wall = now() - since, cpu = cpu_time() - cpu_since, interval = values.school.shedding_interval;
    const long n_events = lround(values.time.end / interval);
    const int n_vortices = values.school.n_fish * (int)fmin(values.school.wake.lifetime / interval, (double)n_events);
    print_row(name, threads, n_vortices, n_events, interval, wall, cpu, memory());
    case_free(&values);
    remove("phases.nc");
}

// ---- schools

// rows a length apart, fish in a row three lengths, every second row shifted and in antiphase
static char *school_text(int n_fish, bool is_finite) {
    const size_t size = 512 + 128 * (size_t)n_fish;
    char *const text = malloc(size);
    if (!text) abort();
    int used = snprintf(text, size,
                        "format: 1\nname: school\ntime: {end: 3, shedding_interval: 0.01, output_interval: 1}\n"
                        "defaults: {fish: {control: {law: heading}%s}}\nfish:\n",
                        is_finite ? ", force: pressure, pressure: {span: finite}" : "");
    const int columns = (int)ceil(sqrt(n_fish));
    for (int f = 0; f < n_fish; f++) {
        const int row = f / columns, odd = row % 2;
        used += snprintf(text + used, size - (size_t)used, "  - {start: {position: [%g, %d]}, wave: {phase: %d}}\n",
                         3 * (f % columns) + 1.5 * odd, row, 180 * odd);
    }
    return text;
}

enum { EVENTS = 40 };

struct school_run {
    struct case_values values;
    struct simulation *simulation;
    double megabytes;
    struct measured {
        struct seen seen;
        double wall[EVENTS], cpu[EVENTS];
    } on[2]; /* on one thread, on all */
};

// bring a school to wakes of a whole lifetime
static void school_begin(struct school_run *run, int n_fish, bool is_finite, int threads) {
    const double before = memory();
    char *const text = school_text(n_fish, is_finite);
    read_case(&run->values, text, threads);
    free(text);
    must(simulate_start(NULL, &run->simulation, &run->values, NULL));
    const long full = lround(run->values.school.wake.lifetime / run->values.school.shedding_interval);
    while (run->simulation->state->event < full) must(simulate_step(run->simulation));
    run->megabytes = memory() - before;
}

// one event; no result depends on the number of threads
static void school_event(struct school_run *run, int all, int threads, int event) {
    struct measured *const on = &run->on[all];
    run->simulation->school->threads = all ? threads : 1;
    cpu_clock = all ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_THREAD_CPUTIME_ID;  // the others may still wait for work
    seen = on->seen;
    const double since = now(), cpu_since = cpu_time();
    must(simulate_step(run->simulation));
    on->wall[event] = now() - since;
    on->cpu[event] = cpu_time() - cpu_since;
    on->seen = seen;
    run->simulation->school->threads = threads;
}

// the time of an undisturbed event
static double least(const double *value) {
    double found = value[0];
    for (int i = 1; i < EVENTS; i++) found = fmin(found, value[i]);
    return found;
}

static double sum(const double *value) {
    double total = 0;
    for (int i = 0; i < EVENTS; i++) total += value[i];
    return total;
}

static void school_end(struct school_run *run, int n_fish, int threads) {
    char name[32];
    snprintf(name, sizeof name, "%d fish", n_fish);
    int n_vortices = 0;
    for (int f = 0; f < n_fish; f++) n_vortices += run->simulation->state->wake[f].n_vortex;
    for (int all = 0; all < 2; all++) {
        const struct measured *const on = &run->on[all];
        seen = on->seen;
        print_row(name, all ? threads : 1, n_vortices, EVENTS, run->values.school.shedding_interval, sum(on->wall),
                  sum(on->cpu), run->megabytes);
    }
    simulate_free(run->simulation);
    case_free(&run->values);
}

static void schools(int threads, int n, const int *n_fish, bool is_finite) {
    struct school_run *const run = calloc((size_t)n, sizeof *run);
    if (!run) abort();
    for (int i = 0; i < n; i++) school_begin(&run[i], n_fish[i], is_finite, threads);
    for (int event = 0; event < EVENTS; event++) {
        for (int i = 0; i < n; i++) {
            for (int all = 0; all < 2; all++) school_event(&run[i], all, threads, event);
        }
    }
    for (int i = 0; i < n; i++) school_end(&run[i], n_fish[i], threads);
    for (int i = 0; i < n; i++) {
        printf("%d fish are %.2f times as fast on %d threads as on one\n", n_fish[i],
               least(run[i].on[0].wall) / least(run[i].on[1].wall), threads);
    }
    for (int i = 1; i < n; i++) {
        const double growth = least(run[i].on[0].cpu) / least(run[i - 1].on[0].cpu);
        printf("%d fish take %.1f times the CPU time per event of %d: the number of fish to the power %.2f\n",
               n_fish[i], growth, n_fish[i - 1], log(growth) / log((double)n_fish[i] / n_fish[i - 1]));
    }
    free(run);
}

int main(int argc, char **argv) {
    enum { MOST = 16 };
    int n_fish[MOST] = {1, 4, 16, 64, 256, 1024}, n = 6, threads = 2;
    const bool is_finite = argc > 2 && strcmp(argv[2], "--finite-schools") == 0;
    if (argc < 2 || argc == 4 || argc > 4 + MOST || (argc > 2 && !is_finite && strcmp(argv[2], "--schools") != 0)) {
        fputs("usage: phases CASES [--schools|--finite-schools [THREADS N...]]\n", stderr);
        return 2;
    }
    if (argc > 4) {
        threads = atoi(argv[3]);
        n = argc - 4;
        for (int i = 0; i < n; i++) n_fish[i] = atoi(argv[4 + i]);
    }
    print_head();
    if (argc > 2) {
        schools(threads, n, n_fish, is_finite);
        return 0;
    }
    const char *const names[] = {"single_free", "diamond"};
    for (int i = 0; i < 2; i++) {
        for (threads = 1; threads <= 2; threads++) whole_run(argv[1], names[i], threads);
    }
    return 0;
}
