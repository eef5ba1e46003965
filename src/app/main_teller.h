/* main_teller.h: what the commands that make one result share: how they get its case and its path, and what they tell
 * about it. Tested by tests/app/test_command.sh and tests/app/test_steady_command.sh. */
#ifndef MAIN_TELLER_H
#define MAIN_TELLER_H

#include "app/main_options.h"
#include "app/progress.h"
#include "base/status.h"
#include "case/case_values.h"

struct teller {
    struct progress progress;
    int n_warnings;
    char *path; /* of the result; owned by who sets it */
};

/* Print a warning below the progress, and count it; data: the teller. */
void main_tell_warning(const char *line, void *data);

/* Fail with STATUS_MISSED where there were warnings about a result, and --strict makes them errors. */
enum status main_refuse_warnings(const struct request *request, const struct teller *teller, const char *path);

/* Read the case of a request, which must not be a study, print its notes, and make its result with the function, which
 * gets the path that the request or the case names. */
enum status main_with_case(const struct request *request,
                           enum status (*make)(const struct case_values *values, const struct request *request,
                                               const char *path));

#endif
