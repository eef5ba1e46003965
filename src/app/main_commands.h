/* main_commands.h: the commands of the program. Each of them gets the parsed command line, prints results to stdout and
 * progress to stderr, and can fail with any status. Tested by tests/app/test_command.sh and tests/study.
 *
 *     main_run.c      run, resume, demo, steady
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

// ---- main_signals.c: stop requests by signals and time limits; exits of libraries. Tested by
// tests/app/test_command.sh and tests/study/test_study.sh.

/* Prepare the process. Open /dev/null for each of standard input, output and error that is closed: otherwise the next
 * file would get the descriptor, and printed text would go into that file. Restore the default action of SIGCHLD.
 * Ignore SIGXFSZ and SIGPIPE: a write beyond the limit of a file size, or to a closed pipe, is then an error of the
 * write. Turn a call of exit before main_exit into exit code 4 with a message, and remove the part of a result: some
 * libraries call exit if threads or memory run out. main_exit returns the exit code of main. */
void main_prepare(void);
int main_exit(int code);

/* Let SIGPIPE end the program, as usual, if standard output is a closed pipe; not after main_catch_signals, where a
 * closed pipe is an error. */
void main_end_by_pipe(void);

/* Let SIGINT, SIGTERM, SIGHUP, SIGUSR1 and SIGXCPU request a stop; a second SIGINT ends the program at once. Signals
 * that the parent process ignores stay ignored. */
void main_catch_signals(void);

/* Let the same signals end a command that does not catch them without a part of a file. */
void main_leave_no_part(void);

/* Request a stop after a wall time "HH:MM:SS" (--max-wall). Fails with STATUS_CASE for any other text. */
enum status main_limit_wall_time(const char *text);

/* Request a stop after this CPU time [s]. */
void main_limit_processor_time(double seconds);

/* The number of the last stop signal; SIGALRM or SIGPROF after a time limit; 0 without a stop request. */
const volatile sig_atomic_t *main_stop_signal(void);

#endif
