/* main_teller.c: read the case of a command; print and count the warnings on the result. */
#include "app/main_teller.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/main_commands.h"
#include "app/say.h"
#include "case/case.h"
#include "case/sweep.h"
#include "run/record.h"

void main_tell_warning(const char *line, void *data) {
    struct teller *const teller = data;
    teller->n_warnings++;
    progress_end(&teller->progress);
    say_line(stderr, "shoal: warning: %s\n", line);
}

enum status main_refuse_warnings(const struct request *request, const struct teller *teller, const char *path) {
    if (!request->strict || teller->n_warnings == 0) return STATUS_OK;
    return status_fail(STATUS_MISSED, "%s: with --strict its %d warning%s", path, teller->n_warnings,
                       teller->n_warnings > 1 ? "s are errors" : " is an error");
}

enum status main_with_case(const struct request *request,
                           enum status (*make)(const struct case_values *values, const struct request *request,
                                               const char *path)) {
    struct case_values values;
    TRY(case_read(&values, request->positional, request->n_assignments, request->assignments));
    enum status status = sweep_refuse(&values);
    main_print_notes(request, &values);
    if (status == STATUS_OK) {
        char *const path = request->output ? strdup(request->output) : record_path(&values);
        status = path ? make(&values, request, path) : status_fail(STATUS_MEMORY, "out of memory: a file name");
        free(path);
    }
    case_free(&values);
    return status;
}
