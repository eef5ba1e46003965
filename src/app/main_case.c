/* main_case.c: inspect cases and results. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "case/case.h"
#include "case/case_keys.h"
#include "case/case_member.h"
#include "case/case_schema.h"
#include "case/case_show.h"
#include "case/sweep_members.h"
#include "model/warnings.h"
#include "output/checkpoint.h"
#include "output/field_file.h"
#include "output/result_info.h"
#include "output/result_kind.h"
#include "output/result_table.h"
#include "run/estimate.h"
#include "run/record.h"
#include "run/simulate.h"
#include "study/study_file.h"
#include "study/study_gather.h"

/* Row i of the list of warnings about a result. */
static int list_warning(int i, struct result_listed *listed) {
    if (i >= N_WARNINGS) return 0;
    *listed = (struct result_listed){warnings_words[i].subject, "", "", warnings_words[i].cause, ""};
    return 1;
}

/* The kinds of files, and the list of warnings. */
static const struct result_kind kinds[] = {
    {"run", "shoal_schema", RESULT_SCHEMA, "case_effective", result_info, result_table_listed},
    {"study", "shoal_study", STUDY_FILE_SCHEMA, "study_case", study_info, study_file_listed},
    {"field", "shoal_field", FIELD_FILE_SCHEMA, "case_effective", field_file_info, field_file_listed},
    {.name = "warning", .listed = list_warning},
};
enum { N_LISTS = sizeof kinds / sizeof *kinds, N_KINDS = N_LISTS - 1 };

void main_print_notes(const struct request *request, const struct case_values *values) {
    if (!request->quiet && *values->notes) fprintf(stderr, "%s\n", values->notes);
}

/* Prepare one case as `shoal run` does, which replaces no file here; its simulation is not run. */
static enum status prepare(const struct case_values *values, struct simulation **simulation) {
    char *const path = record_path(values);
    if (!path) return status_fail(STATUS_MEMORY, "out of memory: a file name");
    const enum status status = simulate_prepare(simulation, values, path, 1);
    free(path);
    return status;
}

/* Seconds in which events are done for an estimate of what a run, or all runs of a study, will take. */
static const double patience = 0.25;

/* What all runs of a case or a study take: times add up, memory does not. */
struct cost {
    double seconds, bytes;
    char reason[256]; /* why there is none, or "" */
};

static void add_estimate(struct cost *cost, struct simulation *simulation, double seconds) {
    struct estimate estimate;
    if (estimate_run(simulation, seconds, &estimate) != STATUS_OK) {
        snprintf(cost->reason, sizeof cost->reason, "%s", status_message());
        return;
    }
    cost->seconds += estimate.seconds;
    cost->bytes = fmax(cost->bytes, estimate.bytes);
}

static void print_cost(const struct cost *cost, const struct case_values *values) {
    static const struct {
        double seconds;
        const char *name;
    } units[] = {{86400, "days"}, {3600, "h"}, {60, "min"}, {0, "s"}};
    if (*cost->reason) {
        printf("    no estimate of its time: %s\n", cost->reason);
        return;
    }
    int i = 0;
    while (cost->seconds < 1.5 * units[i].seconds) i++;
    const double time = cost->seconds / fmax(units[i].seconds, 1);
    printf(
        "    %s about %.2g %s and %.2g MB on this machine%s: estimated from a few events, often within a factor of "
        "two\n",
        values->n_axes > 0 ? "its runs take" : "its run takes", time, units[i].name, 1e-6 * cost->bytes,
        values->n_axes > 0 ? ", one after the other" : "");
}

/* Prepare each member of a study, as `shoal study` will, and estimate what it takes; cost may be NULL. */
static enum status check_members(const struct case_values *study, struct cost *cost) {
    const int n = study->n_axes > 0 ? sweep_n_members(study) : 0;
    for (int m = 0; m < n; m++) {
        struct case_values member;
        struct simulation *simulation = NULL;
        TRY(case_member(&member, study, m));
        const enum status status = simulate_create(&simulation, &member);
        if (status == STATUS_OK && cost) add_estimate(cost, simulation, patience / n);
        simulate_free(simulation);
        case_free(&member);
        TRY(status);
    }
    return STATUS_OK;
}

/* Print the warnings that a run of the case is known to have. */
static void print_warnings(const struct simulation *simulation) {
    char line[WARNING_BYTES];
    for (enum warning w = 0; w < N_WARNINGS; w++) {
        if (!warnings_is_of_case(w)) continue;
        if (warnings_line(w, simulation->school, simulation->state, simulation->diagnostics,
                          simulation->residual->scratch, line)) {
            fprintf(stderr, "shoal: warning: %s\n", line);
        }
    }
}

enum status main_check(const struct request *request) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    struct simulation *simulation = NULL;
    enum status status = prepare(&values, &simulation);
    struct cost cost = {0};
    if (status == STATUS_OK) status = check_members(&values, request->quiet ? NULL : &cost);
    if (status == STATUS_OK) main_print_notes(request, &values);
    if (status == STATUS_OK) print_warnings(simulation);
    if (status == STATUS_OK && !request->quiet) {
        printf("%s: ok: %d fish, %d unknowns, %.6g s in %ld events", request->positional, simulation->school->n_fish,
               simulation->school->n_unknowns, values.time.end, simulation->n_events);
        if (values.n_axes > 0) printf("; %d members", sweep_n_members(&values));
        printf("\n");
        fflush(stdout);
        if (values.n_axes == 0) add_estimate(&cost, simulation, patience);
        print_cost(&cost, &values);
    }
    simulate_free(simulation);
    case_free(&values);
    return status;
}

enum status main_show(const struct request *request) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    char *text = NULL;
    const enum status status = case_show(&values, &text);
    if (status == STATUS_OK) fputs(text, stdout);
    free(text);
    case_free(&values);
    return status;
}

enum status main_keys(const struct request *request) {
    if (request->of_output) {
        result_kind_variables(N_LISTS, kinds, request->json, stdout);
    } else if (request->schema) {
        case_schema(stdout);
    } else {
        case_keys(stdout, request->json);
    }
    return STATUS_OK;
}

enum status main_info(const struct request *request) {
    return main_print_info(request->positional, request->case_only);
}

enum status main_print_info(const char *path, int case_only) {
    if (checkpoint_is(path)) return checkpoint_info(path, case_only, stdout);
    return result_kind_info(N_KINDS, kinds, path, case_only, stdout);
}
