/* test_lacking_memory.c: a run ends with a message at each allocation that fails, and leaves no memory behind. */
#include <string.h>

#include "failing_malloc.h"
#include "school.h"

// control laws with lists; a wake that grows from its first size
static const char *const plain =
    "  - {nodes: 5, sheet_points: 7, control: {law: heading, waypoints: [[-3, 1]]}}\n"
    "  - {nodes: 4, sheet_points: 5, start: {position: [0, 2]}, control: {law: heading, desired_heading: [[0, 180], "
    "[1, 90]]}}\n";

// rings, and couplings that need GMRES
static const char *const pressure =
    "  - {nodes: 5, sheet_points: 21}\n"
    "  - {nodes: 5, sheet_points: 21, start: {position: [0, 0.4]}}\n";

static enum status make_and_step(struct arena *arena, struct simulation **simulation,
                                 const struct case_values *values) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    TRY(simulate_create(arena, simulation, values));
    for (int i = 0; i < 18; i++) TRY(simulate_step(*simulation));
    return simulate_renew(*simulation);
}

// let one allocation fail, the first ones one by one, later ones at growing distances
static void sweep(const char *solver, const char *fish, int least) {
    struct case_values values;
    char text[2000];
    snprintf(text, sizeof text, "%ssolver: {%s}\ntime: {end: 1, shedding_interval: 0.02}\nfish:\n%s",
             fish == pressure ? SCHOOL_DEFAULTS : "", solver, fish);
    school_settings(&values, text);
    int n = 0;
    enum status status = STATUS_MEMORY;
    while (status != STATUS_OK) {
        const int n_before = n_live;
        struct arena *const arena = arena_create(NULL, "a test");
        struct simulation *simulation = NULL;
        status_clear();
        n_until_failure = n;
        status = make_and_step(arena, &simulation, &values);
        n_until_failure = -1;
        if (status != STATUS_OK) {
            assert_int_equal(status, STATUS_MEMORY);
            assert_non_null(strstr(status_message(), "out of memory: "));
        }
        simulate_free(simulation);
        arena_free(arena);
        if (n_live != n_before) print_error("allocation %d: %s\n", n, status_message());
        assert_int_equal(n_live, n_before);
        n += 1 + n / 50;
    }
    assert_in_range(n, least, 10000);
    case_free(&values);
}

TEST(every_allocation_of_a_run_may_fail) {
    sweep("method: ida", plain, 300);
    sweep("method: ida", pressure, 400);
    sweep("method: rk4", plain, 200);
    sweep("method: trapezoid, step: 0.01", plain, 200);
}
