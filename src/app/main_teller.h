/* main_teller.h: common parts of the commands that make one result: reading the case, choosing the path, printing
 * warnings. Tested by tests/app/test_command.sh and tests/app/test_steady_command.sh. */
#ifndef MAIN_TELLER_H
#define MAIN_TELLER_H

#include "app/main_options.h"
#include "app/progress.h"
#include "base/status.h"
#include "case/case_values.h"

struct teller {
    struct progress progress;
    int n_warnings;
    char *path; /* of the result; owned by the command */
};

/* Print and count a warning; clear the progress line first. data: struct teller. */
void main_tell_warning(const char *line, void *data);

/* Fail with STATUS_MISSED if the result has warnings and --strict turns warnings into errors. */
enum status main_refuse_warnings(const struct request *request, const struct teller *teller, const char *path);

/* Read the case of a request, refuse a sweep, print the notes, and call make with the output path of the request or, by
 * default, of the case. */
enum status main_with_case(const struct request *request,
                           enum status (*make)(const struct case_values *values, const struct request *request,
                                               const char *path));

#endif
