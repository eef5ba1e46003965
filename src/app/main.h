/* main.h: what the files of the command line share. Tested by tests/app/test_command.sh.
 *
 *     main.c          chooses a command, catches signals, prints errors
 *     main_options.c  what may stand behind a command, and its help
 *     main_run.c      run, demo
 *     main_case.c     check, show, keys, info
 *     main_study.c    study, gather, compare
 *     main_threads.c  where threads wait and run
 */
#ifndef MAIN_H
#define MAIN_H

#include <signal.h>
#include <stdio.h>

#include "base/status.h"

/* Options without a letter of their own. */
enum option_code {
    OPTION_SET = 256,
    OPTION_THREADS,
    OPTION_FORCE,
    OPTION_JSON,
    OPTION_OUTPUT,
    OPTION_CASE,
    OPTION_MEMBERS,
    OPTION_METHODS,
    OPTION_RTOL,
    OPTION_STEPS,
    OPTION_REPEATS,
    OPTION_REFERENCE,
    OPTION_LIMIT,
    OPTION_SLURM,
    OPTION_BUNDLE
};

/* What the command line says. A text is NULL where its option is not given. */
struct request {
    const char *command_line;
    const char *output;
    int quiet, verbose, force, json, of_output, case_only;
    int n_assignments;
    const char **assignments; /* the texts of --set */
    char threads[64];         /* --threads as an assignment */
    const char *processes, *members;
    const char *methods, *rtols, *steps, *repeats, *reference_rtol, *limit, *bundle;
    int slurm;
    const char *positional;
};

/* One command: its name, what follows it, one sentence, the codes of its options, and the function that does it. */
struct command {
    const char *name, *positional, *summary;
    int options[16]; /* 0 at the end */
    enum status (*run)(const struct request *request);
};

/* Let threads that wait for others spin for microseconds only and then sleep. OpenMP's own choice is to spin for
 * milliseconds: where threads share a core, with each other or with other programs, each of the thousands of short loops
 * of a run then lasts that long. OpenMP reads its choice when the program is loaded, so this starts the program again, with
 * GOMP_SPINCOUNT; whoever has set that or OMP_WAIT_POLICY keeps what he chose. */
void main_wait_briefly(char **argv);

/* Give each thread its own part of the processors that this process may use: a thread that has slept is easily woken on
 * the core of the one that woke it, and stays there. Where there are more threads than processors, or the environment
 * says where threads go (OMP_PROC_BIND, OMP_PLACES), nothing happens. */
void main_spread_threads(int threads);

/* Read the options of a command, argv[0] being its name, into *request, whose assignments have room for argc texts.
 * Returns -1 once the help of the command has been printed; else 0, and *status is STATUS_CASE where they are wrong. */
int main_parse(const struct command *command, int argc, char **argv, struct request *request, enum status *status);

/* Fail with STATUS_CASE: the problem (a printf format with one %s for the word) and where the help is; command may be
 * NULL. */
enum status main_usage(const struct command *command, const char *format, const char *word);

/* From here on a first SIGINT or SIGTERM asks the work to stop. */
void main_catch_signals(void);

/* Where its number then stands; 0 before. */
const volatile sig_atomic_t *main_stop_signal(void);

/* Print what a file of shoal holds, or the case in it alone. Fails with STATUS_FILE or STATUS_MEMORY. */
enum status main_print_info(const char *path, int case_only);

/* The commands. */
enum status main_run(const struct request *request);
enum status main_demo(const struct request *request);
enum status main_check(const struct request *request);
enum status main_show(const struct request *request);
enum status main_keys(const struct request *request);
enum status main_info(const struct request *request);
enum status main_study(const struct request *request);
enum status main_gather(const struct request *request);
enum status main_compare(const struct request *request);

#endif
