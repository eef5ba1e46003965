/* client.c: a program that uses the installed library as a reader of shoal.h would. It swims, meets every kind of
 * error, and sees that locale, signals and environment stay as they were. Built and run by test_library.sh. */
#include <locale.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shoal.h"

extern char **environ;

static int n_handlers(void) {
    int n = 0;
    for (int number = 1; number < SIGRTMIN; number++) {
        struct sigaction action;
        n += sigaction(number, NULL, &action) == 0 && action.sa_handler != SIG_DFL;
    }
    return n;
}

static int n_variables(void) {
    int n = 0;
    while (environ[n]) n++;
    return n;
}

int main(int argc, char **argv) {
    const char *const assignments[] = {"time.end=0.04", "fish[0].nodes=9"};
    const char *const locale = setlocale(LC_ALL, "");
    const int n_handlers_before = n_handlers(), n_variables_before = n_variables();
    struct shoal *run;
    struct shoal_array x;
    double flow[2], vorticity, here[2] = {2, 1};
    if (argc != 2 || shoal_open(&run, argv[1], 2, assignments) != SHOAL_OK) return puts(shoal_message()), 1;
    while (shoal_time(run) < shoal_end(run) && shoal_step(run) == SHOAL_OK) continue;
    if (shoal_step(run) != SHOAL_USAGE || shoal_n_nodes(run, 99) >= 0) return puts("unchecked"), 1;
    if (shoal_read(run, "x", &x) != SHOAL_OK || shoal_flow(run, 1, here, flow, &vorticity)) return 1;
    printf("%zu %s, nose at %.17g, flow %.17g\n", x.shape[1], x.dimension[1], ((const double *)x.values)[0], flow[0]);
    shoal_close(run);
    if (shoal_open(&run, argv[1], 1, (const char *const[]){"solver.max_steps=1"})) return 1;
    if (shoal_step(run) != SHOAL_SOLVER || !strstr(shoal_message(), "solver.max_steps")) return 1;
    shoal_close(run);
    if (shoal_open(&run, "/no/such/case.yaml", 0, NULL) != SHOAL_FILE || run) return 1;
    if (strcmp(locale, setlocale(LC_ALL, NULL)) != 0 || n_handlers() != n_handlers_before) return 1;
    return n_variables() != n_variables_before;
}
