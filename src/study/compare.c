/* compare.c: a list of runs, gone through several times. */
#define _DEFAULT_SOURCE  // MAP_ANONYMOUS
#include "study/compare.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/text.h"
#include "case/sweep_members.h"
#include "run/simulate.h"
#include "study/compare_file.h"

enum { MOST_RUNS = 200, MOST_REPEATS = 99, REASON_BYTES = 512, WORD_BYTES = 32 };

static const char all_methods[] = "ida2,ida5,euler,heun,rk4,dormand_prince";
static const char all_rtols[] = "1e-3,1e-4,1e-5,1e-6,1e-7";

/* What a process hands back; in memory that both see. The places follow: nose and tail of every fish, x and y. */
struct outcome {
    int code; /* exit code */
    char reason[REASON_BYTES];
    double t, wall_time;
    struct integrator_counts counts;
    double place[];
};

/* One run of the list. */
struct run {
    char method[WORD_BYTES], value[WORD_BYTES]; /* as given: "ida5", "1e-6" */
    int is_step;                                /* the value is a step, not a tolerance */
    int n_done, is_over;                        /* repeats so far; it failed, no more of them */
    double wall_time[MOST_REPEATS];
    struct outcome *outcome; /* of the last repeat; owned */
};

struct compare {
    const struct case_values *values;
    const struct compare_options *options;
    size_t outcome_bytes;
    struct outcome *shared;
    struct run reference, check; /* the second has ten times the tolerance: how good is the reference? */
    int n;
    struct run run[MOST_RUNS];
};

// ---- the list

/* Take the next word from a list with commas; 0 at its end. */
static int next_word(const char **list, char word[WORD_BYTES]) {
    if (!*list || **list == '\0') return 0;
    const size_t length = strcspn(*list, ",");
    snprintf(word, WORD_BYTES, "%.*s", (int)(length < WORD_BYTES ? length : WORD_BYTES - 1), *list);
    *list += length + ((*list)[length] == ',');
    return 1;
}

/* True for "ida" and a digit. */
static int is_implicit(const char *method) {
    return strncmp(method, "ida", 3) == 0;
}

static enum status check_method(const char *method) {
    static const char *const known[] = {"ida1", "ida2", "ida3",           "ida4",           "ida5",     "euler",
                                        "heun", "rk4",  "dormand_prince", "implicit_euler", "trapezoid"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(method, known[i]) == 0) return STATUS_OK;
    }
    return status_fail(
        STATUS_CASE,
        "--methods: '%s' is unknown: choose from ida1 to ida5 (implicit, of this order), euler, heun, rk4, "
        "dormand_prince, and with --steps implicit_euler and trapezoid",
        method);
}

static enum status add_runs(struct compare *compare, const char *method, const char *values, int is_step) {
    char value[WORD_BYTES];
    while (next_word(&values, value)) {
        if (compare->n == MOST_RUNS) return status_fail(STATUS_CASE, "more than %d runs to compare", MOST_RUNS);
        struct run *const run = &compare->run[compare->n++];
        snprintf(run->method, sizeof run->method, "%s", method);
        snprintf(run->value, sizeof run->value, "%s", value);
        run->is_step = is_step;
    }
    return STATUS_OK;
}

static enum status make_list(struct compare *compare) {
    const struct compare_options *const options = compare->options;
    const char *methods = options->methods ? options->methods : all_methods;
    char method[WORD_BYTES];
    while (next_word(&methods, method)) {
        TRY(check_method(method));
        const int with_steps = options->steps && !is_implicit(method);
        const char *const rtols = options->rtols ? options->rtols : all_rtols;
        TRY(add_runs(compare, method, with_steps ? options->steps : rtols, with_steps));
    }
    if (compare->n == 0) return status_fail(STATUS_CASE, "nothing to compare: --methods, --rtol and --steps are lists");
    snprintf(compare->reference.method, WORD_BYTES, "ida5");
    snprintf(compare->reference.value, WORD_BYTES, "%g", options->reference_rtol);
    compare->check = compare->reference;
    snprintf(compare->check.value, WORD_BYTES, "%g", 10 * options->reference_rtol);
    return STATUS_OK;
}

/* The case of a run. */
static enum status case_of(const struct compare *compare, const struct run *run, struct case_values *values) {
    char method[64], value[64], step[64] = "solver.step=0", order[64] = "solver.order=2";
    snprintf(method, sizeof method, "solver.method=%s", is_implicit(run->method) ? "ida" : run->method);
    if (is_implicit(run->method)) snprintf(order, sizeof order, "solver.order=%s", run->method + 3);
    snprintf(value, sizeof value, "%s=%s", run->is_step ? "solver.step" : "solver.rtol", run->value);
    const char *const assignments[] = {method, step, order, value};
    const char *const text = compare->values->merged;
    TRY(case_parse(values, text, strlen(text), compare->values->name, NULL, 4, assignments));
    const enum status status = sweep_refuse(values);
    if (status != STATUS_OK) case_free(values);
    return status;
}

/* All cases are checked before anything runs. */
static enum status check_list(const struct compare *compare) {
    struct case_values values;
    TRY(case_of(compare, &compare->check, &values));
    case_free(&values);
    for (int i = 0; i < compare->n; i++) {
        TRY(case_of(compare, &compare->run[i], &values));
        case_free(&values);
    }
    return STATUS_OK;
}

// ---- one run, in its own process

/* Noses and tails as they are. */
static void note_places(const struct simulation *simulation, double *place) {
    const double *const y = simulation->state->y;
    for (int f = 0; f < simulation->school->n_fish; f++) {
        const struct fish *const fish = &simulation->school->fish[f];
        const int nodes[2] = {0, fish->n_nodes - 1};
        for (int i = 0; i < 2; i++) {
            *place++ = y[fish->at.x + nodes[i]];
            *place++ = y[fish->at.y + nodes[i]];
        }
    }
}

static enum status integrate(const struct compare *compare, struct simulation *simulation) {
    while (simulation->state->event < simulation->n_events) {
        if (compare->options->stop && *compare->options->stop) return status_fail(STATUS_STOPPED, "stopped");
        if (simulate_wall_time(simulation) > compare->options->limit) {
            return status_fail(STATUS_SOLVER, "too slow: at t = %.4g s after %.3g s", simulation->state->t,
                               simulate_wall_time(simulation));
        }
        TRY(simulate_step(simulation));
    }
    return STATUS_OK;
}

static enum status run_here(const struct compare *compare, const struct run *run) {
    struct outcome *const to = compare->shared;
    struct case_values values;
    struct simulation *simulation = NULL;
    TRY(case_of(compare, run, &values));
    enum status status = simulate_create(&simulation, &values);
    if (status == STATUS_OK) {
        status = integrate(compare, simulation);
        to->wall_time = simulate_wall_time(simulation);
        to->t = simulation->state->t;
        simulation->integrator->count(simulation->solver, &to->counts);
        note_places(simulation, to->place);
    }
    simulate_free(simulation);
    case_free(&values);
    return status;
}

/* Run once, wait, and keep what came out. */
static enum status run_once(struct compare *compare, struct run *run) {
    memset(compare->shared, 0, compare->outcome_bytes);
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM);
        const enum status status = run_here(compare, run);
        if (status != STATUS_OK) snprintf(compare->shared->reason, REASON_BYTES, "%s", status_message());
        _exit(status_exit_code(status));
    }
    int ended = 0;
    if (child < 0) return status_fail(STATUS_FILE, "cannot start a process");
    while (waitpid(child, &ended, 0) != child) {  // a signal to us: the process has it too, or gets it here
        if (compare->options->stop && *compare->options->stop) kill(child, SIGTERM);
    }
    if (compare->options->stop && *compare->options->stop) return status_fail(STATUS_STOPPED, "stopped by a signal");
    compare->shared->code = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
    if (WIFSIGNALED(ended)) {
        snprintf(compare->shared->reason, REASON_BYTES, "killed by signal %d", WTERMSIG(ended));
    }
    if (!run->outcome) run->outcome = malloc(compare->outcome_bytes);
    if (!run->outcome) return status_fail(STATUS_MEMORY, "out of memory: a run");
    memcpy(run->outcome, compare->shared, compare->outcome_bytes);
    run->wall_time[run->n_done++] = run->outcome->wall_time;
    run->is_over = run->outcome->code != 0;
    return STATUS_OK;
}

// ---- all runs

static enum status run_reference(struct compare *compare, struct run *run) {
    TRY(run_once(compare, run));
    if (run->outcome->code == 0) return STATUS_OK;
    return status_fail(STATUS_SOLVER, "the reference, %s with rtol %s, failed: %s; see --reference-rtol and --limit",
                       run->method, run->value, run->outcome->reason);
}

static enum status run_all(struct compare *compare) {
    TRY(run_reference(compare, &compare->reference));
    TRY(run_reference(compare, &compare->check));
    for (int repeat = 0; repeat < compare->options->repeats; repeat++) {
        for (int i = 0; i < compare->n; i++) {
            if (!compare->run[i].is_over) TRY(run_once(compare, &compare->run[i]));
        }
        if (!compare->options->quiet) {
            fprintf(stderr, "repeat %d of %d done\n", repeat + 1, compare->options->repeats);
        }
    }
    return STATUS_OK;
}

// ---- the results

/* The largest distance, in body lengths, of noses (end 0) or tails (end 1) to those of the reference. */
static double error_of(const struct compare *compare, const struct run *run, int end) {
    if (run->outcome->code != 0) return NAN;
    double most = 0;
    for (int f = 0; f < compare->values->school.n_fish; f++) {
        const double *const got = run->outcome->place + 4 * f + 2 * end;
        const double *const want = compare->reference.outcome->place + 4 * f + 2 * end;
        most = fmax(most, hypot(got[0] - want[0], got[1] - want[1]) / compare->values->school.fish[f].length);
    }
    return most;
}

static int ascending(const void *a, const void *b) {
    const double *const one = a, *const other = b;
    return (*one > *other) - (*one < *other);
}

static void fill_row(const struct compare *compare, struct run *run, struct compare_file_row *row) {
    const struct integrator_counts *const counts = &run->outcome->counts;
    double value = NAN;
    text_number(run->value, &value);
    qsort(run->wall_time, (size_t)run->n_done, sizeof *run->wall_time, ascending);
    *row = (struct compare_file_row){
        .rtol = run->is_step ? NAN : value,
        .step = run->is_step ? value : NAN,
        .nose_error = error_of(compare, run, 0),
        .tail_error = error_of(compare, run, 1),
        .wall_time = (run->wall_time[(run->n_done - 1) / 2] + run->wall_time[run->n_done / 2]) / 2,
        .steps = (double)counts->steps,
        .evaluations = (double)counts->residual_evaluations,
        .newton_iterations = (double)counts->newton_iterations,
        .jacobians = (double)counts->jacobian_evaluations,
        // each Newton iteration solves one
        .linear_solves = (double)(counts->newton_iterations + counts->linear_solves)};
    snprintf(row->method, sizeof row->method, "%s", run->method);
    snprintf(row->status, sizeof row->status, "%s", run->outcome->code == 0 ? "complete" : run->outcome->reason);
}

/* A number in a column, "-" where it is none. */
static void print_number(FILE *stream, const char *format, double number) {
    char text[32];
    snprintf(text, sizeof text, format, number);
    fprintf(stream, "  %8s", isnan(number) ? "-" : text);
}

static void print(const struct compare_file_reference *reference, int n, const struct compare_file_row *row,
                  FILE *stream) {
    fprintf(stream, "Reference: ida5, rtol %g; with ten times that it is off by %.1e (nose) and %.1e (tail) lengths.\n",
            reference->rtol, reference->nose_error, reference->tail_error);
    fprintf(stream, "%-14s  %8s  %8s  %8s  %8s  %8s  %9s  %9s  %8s  %9s  %8s  %9s  %s\n", "method", "rtol", "step",
            "nose", "tail", "wall", "steps", "evaluat.", "Newton", "Jacobians", "solves", "us/eval.", "status");
    fprintf(stream, "%-14s  %8s  %8s  %8s  %8s  %8s\n", "", "", "s", "lengths", "lengths", "s");
    for (int i = 0; i < n; i++) {
        const struct compare_file_row *const r = &row[i];
        fprintf(stream, "%-14s", r->method);
        print_number(stream, "%.6g", r->rtol);
        print_number(stream, "%.6g", r->step);
        print_number(stream, "%.1e", r->nose_error);
        print_number(stream, "%.1e", r->tail_error);
        // a long reason stands whole in the file
        const int n_status = (int)strcspn(r->status, ":;");
        fprintf(stream, "  %8.3f  %9.0f  %9.0f  %8.0f  %9.0f  %8.0f  %9.1f  %.*s\n", r->wall_time, r->steps,
                r->evaluations, r->newton_iterations, r->jacobians, r->linear_solves,
                r->evaluations > 0 ? 1e6 * r->wall_time / r->evaluations : 0, n_status, r->status);
    }
}

static enum status report(struct compare *compare, FILE *stream) {
    struct compare_file_row *const row = calloc((size_t)compare->n, sizeof *row);
    if (!row) return status_fail(STATUS_MEMORY, "out of memory: %d rows", compare->n);
    for (int i = 0; i < compare->n; i++) fill_row(compare, &compare->run[i], &row[i]);
    const struct compare_file_reference reference = {.rtol = compare->options->reference_rtol,
                                                     .nose_error = error_of(compare, &compare->check, 0),
                                                     .tail_error = error_of(compare, &compare->check, 1)};
    print(&reference, compare->n, row, stream);
    const struct compare_options *const options = compare->options;
    const enum status status = options->path ? compare_file_write(options->path, compare->values, &reference,
                                                                  compare->n, row, options->command)
                                             : STATUS_OK;
    free(row);
    return status;
}

static enum status compare_all(struct compare *compare, FILE *stream) {
    if (compare->options->repeats < 1 || compare->options->repeats > MOST_REPEATS) {
        return status_fail(STATUS_CASE, "--repeats: expects 1 to %d", MOST_REPEATS);
    }
    TRY(make_list(compare));
    TRY(check_list(compare));
    compare->outcome_bytes = sizeof *compare->shared + 4 * (size_t)compare->values->school.n_fish * sizeof(double);
    compare->shared = mmap(NULL, compare->outcome_bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (compare->shared == MAP_FAILED) {
        compare->shared = NULL;
        return status_fail(STATUS_MEMORY, "out of memory: a run");
    }
    TRY(run_all(compare));
    return report(compare, stream);
}

enum status compare_run(const struct case_values *values, const struct compare_options *options, FILE *stream) {
    struct compare *const compare = calloc(1, sizeof *compare);
    if (!compare) return status_fail(STATUS_MEMORY, "out of memory: a comparison");
    compare->values = values;
    compare->options = options;
    const enum status status = compare_all(compare, stream);
    if (compare->shared) munmap(compare->shared, compare->outcome_bytes);
    for (int i = 0; i < compare->n; i++) free(compare->run[i].outcome);
    free(compare->reference.outcome);
    free(compare->check.outcome);
    free(compare);
    return status;
}

enum status compare_info(const char *path, FILE *stream) {
    struct compare_file_reference reference;
    struct compare_file_row *row;
    int n;
    TRY(compare_file_read(path, &reference, &n, &row));
    fprintf(stream, "\n");
    print(&reference, n, row, stream);
    free(row);
    return STATUS_OK;
}
