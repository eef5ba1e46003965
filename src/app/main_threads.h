/* main_threads.h: where the threads of a run wait, and on which processors. Tested by tests/app/test_command.sh. */
#ifndef MAIN_THREADS_H
#define MAIN_THREADS_H

/* Before main begins, threads that wait for others are told to spin for microseconds only and then to sleep, unless
 * GOMP_SPINCOUNT or OMP_WAIT_POLICY say how. OpenMP's own choice is to spin for milliseconds: where threads share a
 * core, with each other or with other programs, each of the thousands of short loops of a run then lasts that long.
 * OpenMP reads the environment when it is loaded; it is a part of the program (Makefile: static_gomp), so that a
 * function of ours can come first. Where it is not, it keeps its choice. */

/* Give each thread its own part of the processors that this process may use: a thread that has slept is easily woken on
 * the core of the one that woke it, and stays there. Where there are more threads than processors, or the environment
 * says where threads go (OMP_PROC_BIND, OMP_PLACES), nothing happens. */
void main_spread_threads(int threads);

#endif
