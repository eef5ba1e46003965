/* test_branch_walk.c: Tests the walk along a branch on models whose states and multipliers are formulas, so that each
 * test can say what goes wrong where. test_branch.sh has branches of plates. */
#define steady_run model_run
#define steady_change model_change
#define steady_refuse model_refuse
#define member_file_read model_read
#define study_file_write model_write
#include <stdio.h>
#include <stdlib.h>

#include "near.h"
#include "study/branch.c"

/* One slow quantity u, whose change in a beat is change(u, key); the multiplier exceeds 1 by excess(u, key). */
static struct model {
    double start; /* u of the state at FROM */
    double (*change)(double u, double key), (*excess)(double u, double key);
    bool touches; /* a second evaluation at a state near the threshold meets a contact */
    double per_second,
        per_panel; /* excess by the shedding interval, s-1, and by the width of the panels of the sheet */
    double moves_per_second, moves_per_panel; /* the states at another u and key: by the same two */
    bool no_finer_bodies;                     /* a state with more than 25 nodes is not found */
    bool to_threshold;
    double last; /* u of the last state */
} model;

static double key_of(const struct case_values *values) {
    return values->school.fish[0].motion.heave;
}

enum status model_refuse(const struct case_values *values) {
    (void)values;
    return STATUS_OK;
}

enum status model_change(const struct case_values *values, int n, const double *value, double *change,
                         const volatile sig_atomic_t *stop) {
    (void)stop;
    const struct fish_parameters *const fish = &values->school.fish[0];
    const double key = key_of(values), moves = model.moves_per_second * values->school.shedding_interval +
                                               model.moves_per_panel / (fish->sheet_points - 1);
    assert_int_equal(n, 1);
    if (model.no_finer_bodies && fish->nodes > 25) return status_fail(STATUS_SOLVER, "no state");
    if (model.touches && fabs(value[0] - model.last) <= 0 && fabs(model.excess(value[0], key)) < 0.01) {
        return status_fail(STATUS_CONTACT, "a and b touch");
    }
    change[0] = model.change(value[0] - moves, key - moves);
    return STATUS_OK;
}

enum status model_run(const struct case_values *values, const struct steady_options *options) {
    const double u = options->hold ? options->hold->value[0] : model.start;
    const struct fish_parameters *const fish = &values->school.fish[0];
    if (model.no_finer_bodies && fish->nodes > 25) return status_fail(STATUS_SOLVER, "no state");
    struct steady_point *const found = options->found;
    found->n = 1;
    found->has_beat = true;
    NEW(found->arena, found->value, 1);
    found->value[0] = model.last = u;
    found->real = 1 + model.excess(u, key_of(values)) + model.per_second * values->school.shedding_interval +
                  model.per_panel / (fish->sheet_points - 1);
    found->imaginary = 0;
    found->error = 1e-4;
    return STATUS_OK;
}

enum status model_read(struct arena *arena, struct member_file *member, const char *path) {
    (void)path;
    *member = (struct member_file){.status = "complete", .n_fish = 1};
    member_file_create_values(arena, member, 1);
    return STATUS_OK;
}

enum status model_write(struct arena *arena, const char *path, const struct case_values *study,
                        const struct member_file *members, const struct convergence_orders *orders,
                        const struct error_sweep *error, const char *command) {
    (void)arena, (void)path, (void)study, (void)members, (void)orders, (void)error, (void)command;
    return STATUS_OK;
}

/* Follow the branch of the model while the heave goes from one value to another. */
static enum status follow_model(struct arena *arena, double from, double to, struct branch **branch) {
    static const char text[] =
        "format: 1\ntime: {end: 1, shedding_interval: 0.05}\nsteady: {tolerance: 1e-6}\n"
        "fish: [{motion: {prescribed: all, surge: free, heave: 0.15, frequency: 1}}]\n";
    struct case_values values;
    char folder[] = "/tmp/test_branch.XXXXXX";
    assert_int_equal(case_parse(&values, text, strlen(text), "model", ".", 0, NULL), STATUS_OK);
    arena_move(values.arena, arena);
    assert_non_null(mkdtemp(folder));
    const struct branch_options options = {.option = "--continue",
                                           .key = "fish[0].motion.heave",
                                           .from = from,
                                           .to = to,
                                           .origin = "model",
                                           .to_threshold = model.to_threshold,
                                           .folder = folder};
    const enum status status = branch_follow(arena, &values, &options, branch);
    study_folder_remove(folder);
    return status;
}

/* The state moves with the key. */
static double change_of_line(double u, double key) {
    return key - u;
}

static double excess_of_line(double u, double key) {
    (void)u;
    return key - 0.6;
}

/* Two states that meet at a key of 0.5. */
static double change_of_fold(double u, double key) {
    return key - 0.5 - u * u;
}

static double excess_of_fold(double u, double key) {
    (void)key;
    return -u / 2;
}

/* The fold is at u = 0.005 where the interval and the panels move it. */
static double excess_of_moved_fold(double u, double key) {
    (void)key;
    return -(u - 0.005) / 2;
}

/* The only threshold of a model while the heave goes from one value to another. */
static struct branch_threshold only_threshold(struct model of, double from, double to) {
    struct branch *branch;
    ARENA(arena, NULL, "a test");
    model = of;
    assert_int_equal(follow_model(arena, from, to, &branch), STATUS_OK);
    assert_int_equal(branch->n_thresholds, 1);
    return branch->threshold[0];
}

TEST(a_threshold_has_its_value_and_slope) {
    const struct branch_threshold found =
        only_threshold((struct model){.start = 0.4, .change = change_of_line, .excess = excess_of_line}, 0.4, 0.9);
    NEAR(found.value, 0.6, found.bar, 0);
    NEAR(found.slope, 1, 1e-6, 0);
    assert_true(found.is_unstable_above);
}

TEST(the_bar_of_a_threshold_contains_that_of_a_fine_discretisation) {
    // at an interval of 0.05 s and 48 panels the threshold is lower by 0.01, and higher by 0.005
    struct model of = {.start = 0.4,
                       .change = change_of_line,
                       .excess = excess_of_line,
                       .per_second = 0.2,
                       .per_panel = -0.24,
                       .to_threshold = true};
    const struct branch_threshold found = only_threshold(of, 0.4, 0.9);
    NEAR(found.value, 0.595, 3e-4, 0);
    // the errors are of first order; those of the multipliers, 1e-4, explain 1e-4/0.01 of them
    NEAR(found.by_interval, 0.01, 2e-4, 0);
    NEAR(found.by_bodies, 0.005, 2e-4, 0);
    NEAR(found.bar, found.by_error + found.by_secant + found.by_state + 0.015, 4e-4, 0);

    of.no_finer_bodies = true;
    const struct branch_threshold less = only_threshold(of, 0.4, 0.9);
    assert_true(isnan(less.by_bodies));
    NEAR(less.bar, found.bar - 0.005, 4e-4, 0);
}

TEST(a_contact_during_the_finer_correction_keeps_the_threshold) {
    const struct branch_threshold found = only_threshold(
        (struct model){.start = 0.4, .change = change_of_line, .excess = excess_of_line, .touches = true}, 0.4, 0.9);
    NEAR(found.value, 0.6, found.bar, 0);

    // the part of the state is then the tolerance, of the way from 0.4 to 0.9
    NEAR(found.by_state, 0.5e-6, 1e-12, 0);
}

/* Beyond a key of 0.7 nothing is left that could grow. */
static double excess_that_ends(double u, double key) {
    (void)u;
    return key > 0.7 ? NAN : -1;
}

TEST(a_branch_ends_where_no_growth_can_be_followed) {
    struct branch *branch;
    ARENA(arena, NULL, "a test");
    model = (struct model){.start = 0.4, .change = change_of_line, .excess = excess_that_ends};
    assert_int_equal(follow_model(arena, 0.4, 0.9, &branch), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "the state has no mode whose growth could be followed; "));
    ABOVE(branch->n_points, 1);
}

TEST(a_fold_has_no_slope_over_the_key) {
    const struct branch_threshold found =
        only_threshold((struct model){.start = 0.5, .change = change_of_fold, .excess = excess_of_fold}, 0.75, 0.25);
    assert_true(found.is_fold);
    assert_false(found.is_unstable_above);

    // the states are known to the tolerance, and so is the key where they turn
    NEAR(found.value, 0.5, 1e-6, 0);
    assert_true(isnan(found.slope));
}

TEST(the_bar_of_a_fold_contains_that_of_a_fine_discretisation) {
    // at an interval of 0.05 s and 48 panels the fold is higher by 0.01, and lower by 0.005
    struct model of = {.start = 0.5,
                       .change = change_of_fold,
                       .excess = excess_of_moved_fold,
                       .moves_per_second = 0.2,
                       .moves_per_panel = -0.24,
                       .to_threshold = true};
    const struct branch_threshold found = only_threshold(of, 0.75, 0.25);
    assert_true(found.is_fold);
    NEAR(found.value, 0.505, 1e-5, 0);
    NEAR(found.by_interval, 0.01, 1e-4, 0);
    NEAR(found.by_bodies, 0.005, 1e-4, 0);
    NEAR(found.bar, found.by_error + found.by_secant + found.by_state + 0.015, 2e-4, 0);

    of.no_finer_bodies = true;
    const struct branch_threshold less = only_threshold(of, 0.75, 0.25);
    assert_true(isnan(less.by_bodies));
    NEAR(less.bar, found.bar - 0.005, 2e-4, 0);
}
