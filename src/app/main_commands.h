/* main_commands.h: the commands of the program. Each of them gets the parsed command line, prints results to stdout and
 * progress to stderr, and can fail with any status. Tested by tests/app/test_command.sh and tests/study.
 *
 *     main_run.c      run, resume, demo, steady
 *     main_branch.c   steady --threshold and --continue
 *     main_study.c    study, error, gather, compare
 *     main_check.c    check
 *     main_case.c     show, new, keys, info
 *     main_view.c     view, export, field */
#ifndef MAIN_COMMANDS_H
#define MAIN_COMMANDS_H

#include <signal.h>

#include "app/main_options.h"
#include "base/status.h"
#include "case/case_values.h"

enum status main_run(const struct request *request);
enum status main_resume(const struct request *request);
enum status main_demo(const struct request *request);
enum status main_steady(const struct request *request);
enum status main_branch(const struct request *request);
enum status main_study(const struct request *request);
enum status main_error(const struct request *request);
enum status main_gather(const struct request *request);
enum status main_compare(const struct request *request);
enum status main_field(const struct request *request);
enum status main_check(const struct request *request);
enum status main_show(const struct request *request);
enum status main_new(const struct request *request);
enum status main_keys(const struct request *request);
enum status main_info(const struct request *request);
enum status main_view(const struct request *request);
enum status main_export(const struct request *request);

/* Read the case of a request, with the assignments, into the arena of the request. Fails as case_read. */
enum status main_read_case(const struct request *request, struct case_values *values);

/* Print a summary of a file of shoal, all of it, or only the case in the file. Fails with STATUS_FILE or
 * STATUS_MEMORY. */
enum main_info { MAIN_INFO_SUMMARY, MAIN_INFO_ALL, MAIN_INFO_CASE };
enum status main_print_info(struct arena *arena, const char *path, enum main_info part);

#endif
