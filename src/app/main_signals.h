/* main_signals.h: what signals do to the program. Tested by tests/app/test_command.sh and tests/study/test_study.sh. */
#ifndef MAIN_SIGNALS_H
#define MAIN_SIGNALS_H

#include <signal.h>

#include "base/status.h"

/* Open /dev/null in the place of standard input, output and error where the program was started without them: the next
 * file would take their number, and what is printed would go into it. */
void main_open_standard(void);

/* Wait for our own processes even where the program that started us ignores the ends of its own. */
void main_reset_signals(void);

/* From here on SIGINT, SIGTERM, SIGHUP, SIGUSR1 and SIGXCPU ask the work to stop; a second SIGINT ends the program at
 * once. What the program that started us has ignored stays ignored. */
void main_catch_signals(void);

/* Ask the work to stop after this time, "HH:MM:SS" (--max-wall). Fails with STATUS_CASE where it is none. */
enum status main_limit_wall_time(const char *text);

/* Ask the work to stop once it has used this time of the processor, s. */
void main_limit_processor_time(double seconds);

/* From here to main_exit an exit is that of a library, which ends the program where it finds no threads or memory: the
 * exit code becomes 4, with a message. main_exit returns the exit code of main. */
void main_guard_exit(void);
int main_exit(int code);

/* The number of the last of these signals, SIGALRM or SIGPROF where the time is over; 0 before. */
const volatile sig_atomic_t *main_stop_signal(void);

#endif
