/* steady_setup.c: see steady_setup.h. */
#include "steady_setup.h"

#include <string.h>

#include "steady/steady_modes.h"
#include "steady/steady_search.h"

static void pose(struct steady_setup *setup, const char *text) {
    setup->values = school_values(text);
    setup->simulation = school_simulation(text);
}

void steady_setup_open(struct steady_setup *setup, const char *text) {
    pose(setup, text);
    school_ok(steady_problem_create(&setup->problem, &setup->values.steady, setup->simulation));
}

void steady_setup_multipliers(struct steady_setup *setup) {
    school_ok(steady_multipliers_find(test_arena(), &setup->problem, &setup->multipliers));
}

void steady_setup_find(struct steady_setup *setup, const char *text) {
    steady_setup_open(setup, text);
    school_ok(steady_search_run(&setup->problem));
    steady_setup_multipliers(setup);
}

void steady_setup_beats(struct steady_setup *setup, int n) {
    for (int i = 0; i < n; i++) school_ok(steady_map_beat(&setup->problem.map, NULL, NULL));
}

void steady_setup_fails(const char *text, enum status want, const char *words) {
    struct steady_setup setup;
    pose(&setup, text);
    enum status status = steady_problem_create(&setup.problem, &setup.values.steady, setup.simulation);
    if (status == STATUS_OK) status = steady_search_run(&setup.problem);
    assert_int_equal(status, want);
    if (!strstr(status_message(), words)) fail_msg("\"%s\" is not in \"%s\"", words, status_message());
}
