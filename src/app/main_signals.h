/* main_signals.h: what signals do to the program. Tested by tests/app/test_command.sh and tests/study/test_study.sh. */
#ifndef MAIN_SIGNALS_H
#define MAIN_SIGNALS_H

#include <signal.h>

/* Open /dev/null in the place of standard input, output and error where the program was started without them: the next
 * file would take their number, and what is printed would go into it. */
void main_open_standard(void);

/* Wait for our own processes even where the program that started us ignores the ends of its own. */
void main_reset_signals(void);

/* From here on a first SIGINT or SIGTERM asks the work to stop; a second one ends the program at once. */
void main_catch_signals(void);

/* The number of that signal; 0 before. */
const volatile sig_atomic_t *main_stop_signal(void);

#endif
