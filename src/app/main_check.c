/* main_check.c: shoal check runs the first events of a case and reports its warnings and an estimate of its cost. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

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
#include "run/simulate.h"
#include "school/warnings.h"
#include "steady/steady.h"
#include "study/study_folder.h"

/* The CPU time of the command, and the part of it that is for estimates [s]; the rest is for simulate_start. */
static const double time_limit = 0.4, patience = 0.25;

/* The findings on all members of a study; a case without a sweep has one member. */
struct checked {
    const struct request *request;
    const struct case_values *values;
    bool is_study;
    int n_members;          /* 1 without a sweep */
    int n_checked;          /* members whose cases have been checked, a sample of a long sweep */
    int n_fish, n_unknowns; /* of the last school; n_unknowns 0: no school yet */
    int n_estimated, n_failed, n_warned[N_WARNINGS], first_warned[N_WARNINGS], first_failed;
    double seconds, bytes; /* sum and maximum over the estimated members */
    char failure[512], warning[N_WARNINGS][WARNING_BYTES];
};

/* Start a member as `shoal run` does, and estimate its cost. Once the CPU time is spent, the start ends after the
 * checks of the bodies. */
static enum status check_start(struct checked *checked, int member, const struct case_values *values) {
    struct simulation *simulation = NULL;
    enum status status = simulate_start(checked->request->arena, &simulation, values, main_stop_signal());
    if (status == STATUS_STOPPED) return STATUS_OK;
    TRY(status);
    if (checked->n_unknowns == 0) checked->n_unknowns = simulation->school->n_unknowns;

    // the warnings of a run that are known at the start
    char line[WARNING_BYTES];
    simulate_measure(simulation);
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_line(w, simulation->residual, simulation->state, simulation->diagnostics, line)) continue;
        if (checked->n_warned[w]++ > 0) continue;
        checked->first_warned[w] = member;
        snprintf(checked->warning[w], sizeof checked->warning[w], "%s", line);
    }

    // an estimate from part of an event counts only if no member has completed an event
    struct estimate estimate;
    status = estimate_run(simulation, patience / checked->n_members, &estimate);
    if (status == STATUS_OK && (estimate.n_events > 0 || checked->n_estimated == 0)) {
        checked->n_estimated++;
        checked->seconds += estimate.seconds;
        checked->bytes = fmax(checked->bytes, estimate.bytes);
    }
    simulate_free(simulation);

    // a failed member is a result of a study; a failed run without a sweep is an error
    if (status == STATUS_OK || !checked->is_study || status == STATUS_MEMORY) return status;
    if (checked->n_failed++ == 0) {
        checked->first_failed = member;
        snprintf(checked->failure, sizeof checked->failure, "%s", status_message());
    }
    return STATUS_OK;
}

/* Check the case of a member and, unless the time is over, its start. */
static enum status check_member(struct checked *checked, struct study_refusals *refusals, int member, bool starts) {
    struct case_values values;
    enum status status = case_member(&values, checked->values, member);
    if (status == STATUS_OK && sweep_is_steady(checked->values)) status = steady_refuse(&values);
    if (status == STATUS_OK && starts) status = check_start(checked, member, &values);
    TRY(study_refusals_add(refusals, checked->values, member, status));
    case_free(&values);
    return STATUS_OK;
}

static int common_divisor(int a, int b) {
    return b == 0 ? a : common_divisor(b, a % b);
}

/* Print warnings, and unless quiet the verdict with the cost. */
static void print_findings(const struct checked *checked) {
    const struct case_values *const values = checked->values;
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        const int n = checked->n_warned[w];
        if (n == 0) continue;
        fprintf(stderr, "shoal: warning: ");
        if (checked->is_study) fprintf(stderr, "member %d", checked->first_warned[w]);
        if (n > 1) fprintf(stderr, " and %d other%s", n - 1, n > 2 ? "s" : "");
        say_line(stderr, "%s%s\n", checked->is_study ? ": " : "", checked->warning[w]);
    }
    if (checked->request->quiet) return;

    say_line(stdout, "%s: ok: %d fish, ", checked->request->positional, values->school.n_fish);
    if (checked->n_unknowns > 0) printf("%d unknowns, ", checked->n_unknowns);
    printf("%.6g s in %ld events", values->time.end, lround(values->time.end / values->school.shedding_interval));
    if (checked->is_study) printf("; %d members", checked->n_members);
    if (checked->n_checked < checked->n_members) printf(", of which a sample of %d is checked", checked->n_checked);
    printf("\n");
    if (checked->n_failed > 0) {
        say_line(stdout, "    %d of %d members %s in the first events; member %d: %s\n", checked->n_failed,
                 checked->n_checked, checked->n_failed == 1 ? "fails" : "fail", checked->first_failed,
                 checked->failure);
    }
    if (checked->n_estimated == 0) {
        say_line(stdout, "    no estimate of the run time: %s\n",
                 checked->n_failed > 0 ? "all estimated members failed" : "the first evaluation takes too long");
        return;
    }

    char duration[TEXT_DURATION_BYTES];
    const double megabytes = 1e-6 * checked->bytes;
    text_duration(duration,
                  estimate_of_study(checked->seconds, checked->n_estimated, checked->n_failed, checked->n_members));
    printf("    %s about %s and %.*f MB on this machine%s: estimated from a few events",
           checked->is_study ? "the runs take" : "the run takes", duration, megabytes < 10, megabytes,
           checked->is_study ? ", one after the other" : "");
    if (checked->n_estimated + checked->n_failed < checked->n_members)
        printf(" of %d member%s", checked->n_estimated, checked->n_estimated == 1 ? "" : "s");
    printf(", often within a factor of two\n");
}

enum status main_check(const struct request *request) {
    struct case_values values;
    main_limit_processor_time(time_limit);
    TRY(main_read_case(request, &values));
    const int n = sweep_n_members(&values);
    struct checked checked = {.request = request, .values = &values, .is_study = values.n_axes > 0, .n_members = n};
    TRY(parallel_start_threads(values.school.threads));
    const char *const path = record_path(request->arena, &values);
    if (!checked.is_study) {
        TRY(target_check(path, TARGET_NETCDF, true));
        TRY(check_start(&checked, 0, &values));
    }

    // check the members in steps of the golden ratio, so that those within the time limit sample the entire sweep
    int step = (int)fmax(1, round(0.618 * n));
    while (common_divisor(n, step) > 1) step++;
    checked.n_checked = !checked.is_study;
    struct study_refusals refusals = {0};
    int m = 0;
    for (; checked.is_study && checked.n_checked < n; m = (m + step) % n) {
        if (checked.n_checked > 0 && *main_stop_signal()) break;
        checked.n_checked++;
        TRY(check_member(&checked, &refusals, m, true));
    }

    // the cases of the other members: all of a short sweep, as many of a long one as the time permits
    const double begun = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    for (; checked.is_study && refusals.n_checked < n; m = (m + step) % n) {
        if (clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - begun > time_limit) break;
        TRY(check_member(&checked, &refusals, m, false));
    }
    TRY(study_refusals_status(&refusals, &values));

    // an existing output file is no error of the case: only note
    if (!checked.is_study && !request->quiet && target_check(path, TARGET_NETCDF, false) != STATUS_OK) {
        say_line(stderr, "shoal: note: %s\n", status_message());
    }
    if (!request->quiet && *values.notes) say_line(stderr, "%s\n", values.notes);
    print_findings(&checked);
    return STATUS_OK;
}
