/* trace.c: the format of the lines. */
#include "solver/trace.h"

#include <errno.h>
#include <stdio.h>

#include "base/text.h"
#include "school/residual.h"

struct trace {
    const char *path;
    FILE *file;
    int error; /* of the first line that was not written; 0: none */
};

static void release_trace(void *object) {
    struct trace *const trace = object;
    if (trace->file) fclose(trace->file);
}

enum status trace_create(struct arena *arena, struct trace **created, const char *path, bool overwrite) {
    struct trace *trace;
    NEW(arena, trace, 1);
    trace->path = arena_text(arena, "%s", path);
    trace->file = fopen(path, overwrite ? "w" : "wx");
    if (!trace->file) {
        return errno == EEXIST ? status_fail(STATUS_FILE, "--trace %s: the file exists: replace it with --force", path)
                               : status_fail(STATUS_FILE, "--trace %s: %s", path, strerror(errno));
    }
    arena_defer(arena, release_trace, trace);
    fputs(
        "event,t,step,order,result,iterations,jacobians,age,cj_ratio,gmres,norms,differential_norms,rates,"
        "unknown,fish,correction\n",
        trace->file);
    // write whole lines, so that the file of a run that ends early can be read
    setvbuf(trace->file, NULL, _IOLBF, BUFSIZ);
    *created = trace;
    return STATUS_OK;
}

// the values of all corrections, separated by blanks; a bar before the first one with a new Jacobian
static void trace_list(FILE *file, const struct trace_attempt *attempt, const double *value) {
    const int n = attempt->n_corrections < TRACE_MOST_CORRECTIONS ? attempt->n_corrections : TRACE_MOST_CORRECTIONS;
    for (int i = 0; i < n; i++) {
        fprintf(file, "%s%.3g", i == 0 ? "" : attempt->is_first[i] ? " | " : " ", value[i]);
    }
    fputc(',', file);
}

void trace_write(struct trace *trace, const struct school *school, const struct trace_attempt *attempt,
                 enum trace_result result) {
    static const char *const words[] = {"accepted", "error_test", "newton", "no_value"};
    FILE *const file = trace->file;
    int n_jacobians = 0;
    for (int i = 0; i < attempt->n_corrections && i < TRACE_MOST_CORRECTIONS; i++) {
        n_jacobians += attempt->is_first[i] && (i > 0 || attempt->age == 0);
    }
    fprintf(file, "%ld,%.10g,%.6g,%d,%s,%d,%d,%d,%.4g,%ld,", attempt->event, attempt->t, attempt->step, attempt->order,
            words[result], attempt->n_corrections, n_jacobians, attempt->age, attempt->cj_ratio, attempt->gmres);
    trace_list(file, attempt, attempt->norm);
    trace_list(file, attempt, attempt->differential);
    trace_list(file, attempt, attempt->rate);
    if (attempt->n_corrections == 0) {
        fputs(",,\n", file);
        if (ferror(file) && trace->error == 0) trace->error = errno;
        return;
    }

    const struct unknown_place place = residual_place(school, attempt->worst);
    fprintf(file, "%s[%d],", place.name, place.index);
    text_print_csv(file, school->fish[place.fish].name);
    fprintf(file, ",%.3g\n", attempt->worst_correction);
    if (ferror(file) && trace->error == 0) trace->error = errno;
}

enum status trace_close(struct trace *trace) {
    if (fclose(trace->file) != 0 && trace->error == 0) trace->error = errno;
    trace->file = NULL;
    return trace->error == 0 ? STATUS_OK
                             : status_fail(STATUS_FILE, "--trace %s: %s", trace->path, strerror(trace->error));
}
