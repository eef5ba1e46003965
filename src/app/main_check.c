/* main_check.c: shoal check: the warnings of a run at its start, its first events, and an estimate of its cost. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/main_commands.h"
#include "app/main_signals.h"
#include "app/say.h"
#include "base/parallel.h"
#include "base/text.h"
#include "case/case.h"
#include "case/sweep.h"
#include "result/target.h"
#include "run/estimate.h"
#include "run/record.h"
#include "school/warnings.h"

/* CPU time of the command, and the part for estimates [s]; the remainder is for simulate_start. */
static const double time_limit = 0.4, patience = 0.25;

/* The findings on all members of a study; a case without a sweep has one member. */
struct checked {
    const struct request *request;
    const struct case_values *values;
    int n_members;          /* 1 without a sweep */
    int n_fish, n_unknowns; /* of the last school; n_unknowns 0: no school yet */
    int n_estimated, n_failed, n_warned[N_WARNINGS], first_warned[N_WARNINGS], first_failed;
    double seconds, bytes; /* sum and maximum over the estimated members */
    char failure[512], warning[N_WARNINGS][WARNING_BYTES];
};

static int is_study(const struct checked *checked) {
    return checked->values->n_axes > 0;
}

// Find the warnings of a run that are known at the start.
static void check_warnings(struct checked *checked, int member, struct simulation *simulation) {
    char line[WARNING_BYTES];
    simulate_measure(simulation);

    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->school, simulation->state, simulation->diagnostics,
                           simulation->residual->scratch, line))
            continue;
        if (checked->n_warned[w]++ > 0) continue;
        checked->first_warned[w] = member;
        snprintf(checked->warning[w], sizeof checked->warning[w], "%s", line);
    }
}

static void check_print_warnings(const struct checked *checked) {
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        const int n = checked->n_warned[w];
        if (n == 0) continue;
        fprintf(stderr, "shoal: warning: ");
        if (is_study(checked)) fprintf(stderr, "member %d", checked->first_warned[w]);
        if (n > 1) fprintf(stderr, " and %d other%s", n - 1, n > 2 ? "s" : "");
        say_line(stderr, "%s%s\n", is_study(checked) ? ": " : "", checked->warning[w]);
    }
}

// A failed member is a result of a study; a failed run without a sweep is an error.
static enum status check_estimate_member(struct checked *checked, int member, struct simulation *simulation) {
    struct estimate estimate;
    const enum status status = estimate_run(simulation, patience / checked->n_members, &estimate);

    if (status == STATUS_OK) {
        // an estimate from part of an event counts only if no member has completed an event
        if (estimate.n_events == 0 && checked->n_estimated > 0) return STATUS_OK;
        checked->n_estimated++;
        checked->seconds += estimate.seconds;
        checked->bytes = fmax(checked->bytes, estimate.bytes);
        return STATUS_OK;
    }

    if (!is_study(checked) || status == STATUS_MEMORY) return status;
    if (checked->n_failed++ == 0) {
        checked->first_failed = member;
        snprintf(checked->failure, sizeof checked->failure, "%s", status_message());
    }

    return STATUS_OK;
}

// Start a member as `shoal run` does. Once the CPU time is spent, the start ends after the checks of the bodies.
static enum status check_start(struct checked *checked, int member, const struct case_values *values) {
    struct simulation *simulation = NULL;
    enum status status = simulate_start(NULL, &simulation, values, main_stop_signal());
    if (status == STATUS_STOPPED) return STATUS_OK;
    TRY(status);
    if (checked->n_unknowns == 0) checked->n_unknowns = simulation->school->n_unknowns;
    check_warnings(checked, member, simulation);
    status = check_estimate_member(checked, member, simulation);
    simulate_free(simulation);
    return status;
}

static int common_divisor(int a, int b) {
    return b == 0 ? a : common_divisor(b, a % b);
}

// Check all members in steps of the golden ratio, so that the first members sample the entire sweep.
static enum status check_members(struct checked *checked) {
    const int n = checked->n_members;
    int step = (int)fmax(1, round(0.618 * n));
    while (common_divisor(n, step) > 1) step++;

    for (int i = 0, m = 0; i < n; i++, m = (m + step) % n) {
        struct case_values member;
        TRY(case_member(&member, checked->values, m));
        const enum status status = check_start(checked, m, &member);
        case_free(&member);
        TRY(status);
    }

    return STATUS_OK;
}

static enum status check_case(struct checked *checked) {
    const struct case_values *const values = checked->values;
    TRY(parallel_try_threads(values->school.threads));
    if (is_study(checked)) return check_members(checked);
    const char *const path = record_path(checked->request->arena, values);
    enum status status = target_check(path, TARGET_NETCDF, true);
    if (status == STATUS_OK) status = check_start(checked, 0, values);

    // an existing output file is no error of the case: only note
    if (status == STATUS_OK && !checked->request->quiet && target_check(path, TARGET_NETCDF, false) != STATUS_OK) {
        say_line(stderr, "shoal: note: %s\n", status_message());
    }
    return status;
}

// ---- printing

static void print_cost(const struct checked *checked) {
    if (checked->n_failed > 0) {
        say_line(stdout, "    %d of %d members %s in the first events; member %d: %s\n", checked->n_failed,
                 checked->n_members, checked->n_failed == 1 ? "fails" : "fail", checked->first_failed,
                 checked->failure);
    }

    if (checked->n_estimated == 0) {
        say_line(stdout, "    no estimate of the run time: %s\n",
                 checked->n_failed > 0 ? "all estimated members failed" : "the first evaluation takes too long");
        return;
    }

    char duration[TEXT_DURATION_BYTES];
    // of the members that were not examined, as many are expected to fail as of the examined members
    const int n_examined = checked->n_estimated + checked->n_failed;
    text_duration(duration, checked->seconds * checked->n_members / n_examined);
    printf("    %s about %s and %.2g MB on this machine%s: estimated from a few events",
           is_study(checked) ? "the runs take" : "the run takes", duration, 1e-6 * checked->bytes,
           is_study(checked) ? ", one after the other" : "");
    if (n_examined < checked->n_members)
        printf(" of %d member%s", checked->n_estimated, checked->n_estimated == 1 ? "" : "s");
    printf(", often within a factor of two\n");
}

static void print_verdict(const struct checked *checked) {
    const struct case_values *const values = checked->values;
    say_line(stdout, "%s: ok: %d fish, ", checked->request->positional, values->school.n_fish);
    if (checked->n_unknowns > 0) printf("%d unknowns, ", checked->n_unknowns);
    printf("%.6g s in %ld events", values->time.end, lround(values->time.end / values->school.shedding_interval));
    if (is_study(checked)) printf("; %d members", checked->n_members);
    printf("\n");
    print_cost(checked);
}

enum status main_check(const struct request *request) {
    struct case_values values;
    main_limit_processor_time(time_limit);
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    struct checked checked = {
        .request = request, .values = &values, .n_members = values.n_axes > 0 ? sweep_n_members(&values) : 1};
    const enum status status = check_case(&checked);

    if (status == STATUS_OK) {
        main_print_notes(request, &values);
        check_print_warnings(&checked);
        if (!request->quiet) print_verdict(&checked);
    }

    case_free(&values);
    return status;
}
