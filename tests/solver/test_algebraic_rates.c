/* test_algebraic_rates.c: rates by differences: exact for parabolas, and of the fish that need them only. */
#include "school.h"
#include "solver/algebraic_rates.h"

static const char text[] =
    "time: {end: 1}\n"
    "wake: {shedding: sheet}\nsheet: {curve: smooth}\n"
    "fish: [{nodes: 5, sheet_points: 9, force: pressure}, {nodes: 5, sheet_points: 9, start: {position: [0, 2]}}]\n";

static double parabola(int i, double t) {
    return i + 3 * t - (i % 5) * t * t;
}

static double slope(int i, double t) {
    return 3 - 2 * (i % 5) * t;
}

static void set(struct setup *setup, double t) {
    for (int i = 0; i < setup->school->n_unknowns; i++) {
        setup->state->y[i] = parabola(i, t);
        setup->state->yp[i] = -7;
    }
}

static void rates_of_parabolas_are_exact_from_the_second_step_on(void **state) {
    (void)state;
    struct setup setup;
    school_build(&setup, text);
    const struct fish *fish = setup.school->fish;
    struct algebraic_rates *rates;
    school_ok(algebraic_rates_create(&rates, setup.school));
    const double times[] = {0, 0.1, 0.13, 0.2, 0.35};
    set(&setup, 0);
    algebraic_rates_begin(rates, setup.state);
    for (int n = 1; n < 5; n++) {
        set(&setup, times[n]);
        algebraic_rates_step(rates, times[n], setup.state);
        for (int i = 0; i < setup.school->n_unknowns; i++) {
            const int is_algebraic =
                (i >= fish->at.vx && i < fish->at.px) || (i >= fish->at.gamma && i <= fish->at.circulation);
            const double line = (parabola(i, times[1]) - parabola(i, 0)) / times[1];
            const double want = !is_algebraic ? -7 : n == 1 ? line : slope(i, times[n]);
            NEAR(setup.state->yp[i], want, 1e-11, 0);  // rounding of values of 60 over a step of 0.03
        }
    }
    // what was before a jump does not count
    setup.state->t = 0.4;
    set(&setup, 0.4);
    algebraic_rates_begin(rates, setup.state);
    set(&setup, 0.5);
    algebraic_rates_step(rates, 0.5, setup.state);
    NEAR(setup.state->yp[fish->at.vx], (parabola(fish->at.vx, 0.5) - parabola(fish->at.vx, 0.4)) / 0.1, 1e-11, 0);
    algebraic_rates_free(rates);
    school_clear(&setup);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rates_of_parabolas_are_exact_from_the_second_step_on),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
