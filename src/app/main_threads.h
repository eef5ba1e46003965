/* main_threads.h: where the threads of a run wait, and on which processors. Tested by tests/app/test_command.sh. */
#ifndef MAIN_THREADS_H
#define MAIN_THREADS_H

/* Let threads that wait for others spin for microseconds only and then sleep. OpenMP's own choice is to spin for
 * milliseconds: where threads share a core, with each other or with other programs, each of the thousands of short
 * loops of a run then lasts that long. OpenMP reads its choice when the program is loaded, so this starts the program
 * again with GOMP_SPINCOUNT, unless that or OMP_WAIT_POLICY is set. */
void main_wait_briefly(char **argv);

/* Give each thread its own part of the processors that this process may use: a thread that has slept is easily woken on
 * the core of the one that woke it, and stays there. Where there are more threads than processors, or the environment
 * says where threads go (OMP_PROC_BIND, OMP_PLACES), nothing happens. */
void main_spread_threads(int threads);

#endif
