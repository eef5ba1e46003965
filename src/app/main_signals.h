/* main_signals.h: stop requests by signals and time limits; exits of libraries. Tested by
 * tests/app/test_command.sh and tests/study/test_study.sh. */
#ifndef MAIN_SIGNALS_H
#define MAIN_SIGNALS_H

#include <signal.h>

#include "base/status.h"

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
