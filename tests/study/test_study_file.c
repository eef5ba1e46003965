/* test_study_file.c: Tests the orders, extrapolated values and errors in study.nc, and their tables. test_study.sh
 * tests what the processes of a study do. */
#include <netcdf.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "case/sweep_quantity.h"
#include "case_fixture.h"
#include "crafted_file.h"
#include "study/convergence.h"
#include "study/study.h"
#include "study/study_file.h"
#include "study/study_folder.h"
#include "study/study_print.h"

TEST(a_given_value_gives_the_order_with_two_levels_each) {
    // from fine to coarse; errors of order 2 about (3, -1), but for the finest level: that of a sum of orders 2 and 1
    const double sizes[] = {0.1, 0.2, 0.4}, exact[] = {3, -1};
    const double errors[] = {0.02, 0.04, 0.16};
    double values[3][2];
    for (int i = 0; i < 3; i++) {
        values[i][0] = 3 + 0.6 * errors[i];
        values[i][1] = -1 + 0.8 * errors[i];
    }
    const struct convergence_result order = convergence_judge_exact(3, sizes, (const double(*)[2])values, exact);
    NEAR(order.coarse_order, 2, 0, 1e-12);
    NEAR(order.order, 1, 0, 1e-12);
    NEAR(order.error, 0.02, 0, 1e-12);
    assert_int_equal(order.verdict, CONVERGENCE_ACCEPTED);
    // without the given value the same levels look otherwise: a ratio of differences of 6
    NEAR(convergence_order(sizes, (const double(*)[2])values), log2(6), 0, 1e-9);
    const double same[][2] = {{1, 0}, {1.1, 0}, {1.4, 0}}, one[] = {1, 0};
    assert_true(isnan(convergence_judge_exact(3, sizes, same, one).order));
    const double missing[][2] = {{1.01, 0}, {1.1, 0}, {NAN, 0}};
    assert_int_equal(convergence_judge_exact(3, sizes, missing, one).verdict, CONVERGENCE_UNKNOWN);
}

static const char of_two_orders[] =
    "format: 1\ntime: {end: 1, shedding_interval: 0.1}\nfish: [{}, {}]\nsweep:\n"
    "  - {key: solver.order, values: [1, 2]}\n"
    "  - {key: time.shedding_interval, values: [0.05, 0.1, 0.025], refine: true, reference: {speed: 5}}\n";

/* The limit of value i of a member of two fish: of all speeds 5, of any two other values different ones. */
static double limit_of(int i) {
    return i / 4 == member_file_quantity_number("speed") ? 5 : 5 + 0.01 * i;
}

/* The member of a study whose quantities are their limits + 0.3 h^p, p = 1, 1.2 for solver.order 1, 2. */
static void make_member(struct member_file *member, const struct case_values *study, int m) {
    double h = NAN;
    text_number(study->sweep[1].value[sweep_member_value(study, m, 1)], &h);
    int n = 0;
    while (member_file_quantity(n)) n++;
    n *= 2 * study->school.n_fish;
    *member = (struct member_file){.number = m, .n_fish = study->school.n_fish, .status = "complete"};
    NEW(test_arena(), member->value, n);
    for (int i = 0; i < n; i++)
        member->value[i] = limit_of(i) + 0.3 * pow(h, 1 + 0.2 * sweep_member_value(study, m, 0));
}

/* A value of a variable of an open file. */
static double value_of(int file, const char *name, size_t i, size_t j, size_t k) {
    int variable;
    double value;
    assert_int_equal(nc_inq_varid(file, name, &variable), NC_NOERR);
    assert_int_equal(nc_get_var1_double(file, variable, (size_t[]){i, j, k}, &value), NC_NOERR);
    return value;
}

static enum status read_study(const char *path, struct case_values **study, struct member_file **members) {
    struct netcdf_reader *reader;
    NEW(test_arena(), reader, 1);
    TRY(netcdf_open(test_arena(), reader, path));
    return study_file_read(reader, study, members, &(int){0});
}

/* A study with six members, and the observed orders, in a new file. */
static struct case_values write_study(char *path, struct member_file member[6]) {
    const struct case_values study = parse(of_two_orders);
    for (int m = 0; m < 6; m++) make_member(&member[m], &study, m);
    struct convergence_orders orders;
    convergence_orders_create(test_arena(), &orders, &study, member);
    close(mkstemp(path));
    assert_int_equal(study_file_write(test_arena(), path, &study, member, &orders, NULL, "test"), STATUS_OK);
    return study;
}

TEST(orders_are_kept_in_study_nc) {
    struct case_values *again;
    struct member_file member[6], *read;
    char path[] = "/tmp/shoal-study-XXXXXX";
    const struct case_values study = write_study(path, member);

    int file, variable;
    assert_int_equal(nc_open(path, NC_NOWRITE, &file), NC_NOERR);
    for (size_t g = 0; g < 2; g++) {
        const double p = 1 + 0.2 * (double)g, e = 0.3 * pow(0.025, p);
        NEAR(value_of(file, "group_member", g, 0, 0), 3 * (double)g, 0, 0);
        for (size_t f = 0; f < 2; f++) {
            NEAR(value_of(file, "order_nose", g, f, 0), p, 1e-6, 0);
            NEAR(value_of(file, "order_speed", g, f, 0), p, 1e-6, 0);
            NEAR(value_of(file, "order_before_speed", g, f, 0), p, 1e-6, 0);
            assert_true(isnan(value_of(file, "order_before_nose", g, f, 0)));
            const int nose = member_file_quantity_number("nose");
            NEAR(value_of(file, "limit_nose", g, f, 1), limit_of(4 * nose + 2 * (int)f + 1), 1e-9, 0);
            // the design order is 1, and the error that of the finest difference; or it is known
            NEAR(value_of(file, "error_tail", g, f, 0), 1.25 * sqrt(2) * (0.3 * pow(0.05, p) - e), 0, 1e-9);
            NEAR(value_of(file, "error_speed", g, f, 0), e, 0, 1e-9);
            // errors from coarse to fine: from the finest, and from the given value
            NEAR(value_of(file, "difference_com", g, f, 0), sqrt(2) * (0.3 * pow(0.1, p) - e), 0, 1e-9);
            assert_true(isnan(value_of(file, "difference_com", g, f, 2)));
            NEAR(value_of(file, "difference_speed", g, f, 2), e, 0, 1e-9);
        }
    }
    for (size_t m = 0; m < 6; m++) NEAR(value_of(file, "member", m, 0, 0), (double)m, 0, 0);
    NEAR(value_of(file, "level_value", 0, 0, 0), 0.1, 0, 0);
    NEAR(value_of(file, "level_size", 2, 0, 0), 0.025, 0, 0);
    char unit[8] = "";
    assert_int_equal(nc_inq_varid(file, "error_mean_actuation_power", &variable), NC_NOERR);
    assert_int_equal(nc_get_att_text(file, variable, "units", unit), NC_NOERR);
    assert_string_equal(unit, "W");
    nc_close(file);

    assert_int_equal(read_study(path, &again, &read), STATUS_OK);
    assert_string_equal(again->merged, study.merged);
    for (int m = 0; m < 6; m++) {
        assert_string_equal(read[m].status, "complete");
        // all quantities but those of comparisons and of steady states
        for (int q = 0; member_file_quantity(q); q++) {
            const struct member_file_quantity *const quantity = member_file_quantity(q);
            if (quantity->of_comparison || quantity->of_steady) continue;
            for (int i = 0; i < (quantity->of_fish ? 2 : 1) * (1 + quantity->of_xy); i++) {
                const int f = i / (1 + quantity->of_xy), k = i % (1 + quantity->of_xy);
                NEAR(member_file_value(&read[m], q, f, k), member_file_value(&member[m], q, f, k), 0, 0);
            }
        }
    }
    // what is not whole is refused
    assert_int_equal(nc_open(path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_rename_var(file, 1, "state"), NC_NOERR);
    nc_close(file);
    struct case_values *none;
    struct member_file *nobody;
    assert_int_equal(read_study(path, &none, &nobody), STATUS_FILE);
    assert_non_null(strstr(status_message(), "write study.nc again"));
    unlink(path);
}

TEST(a_study_nc_that_does_not_fit_is_refused) {
    struct member_file member[6];
    char path[] = "/tmp/shoal-study-XXXXXX";
    write_study(path, member);
    size_t n;
    char *const bytes = read_bytes(path, &n), name[NC_MAX_NAME + 1];
    for (int i = 0; name_of_variable(path, i, name); i++) {
        for (enum craft how = 0; how < N_CRAFTS; how++) {
            craft_variable(path, name, how);
            struct case_values *again;
            struct member_file *read;
            bool is_read = strcmp(name, "status") == 0 && how != LONG_DIMENSION;
            for (int q = 0; member_file_quantity(q) && how != MISSING; q++) {
                is_read = is_read || strcmp(member_file_quantity(q)->name, name) == 0;
            }
            const enum status status = read_study(path, &again, &read);
            if (is_read && status != STATUS_FILE) fail_msg("%s, %d: not refused", name, how);
            if (status == STATUS_FILE) {
                assert_non_null(strstr(status_message(), path));
            } else {
                assert_int_equal(status, STATUS_OK);
            }
            write_bytes(path, n, bytes);
        }
    }
    unlink(path);
}

/* The printed orders of nose and tail, of values 5 + 0.3 h in both directions. */
static void is_table(const char *text, double expected, const char *met) {
    char want[2048];
    snprintf(
        want, sizeof want,
        "\nRefinement of time.shedding_interval: differences from the finest level; observed order of the next "
        "coarser and of the\nfinest levels, Richardson's extrapolation, and the error of the finest level "
        "(doc/studies.md)\n"
        "difference of   fish  unit       0.1      0.05  0.025  coarse order  order  extrapolated       error  by\n"
        "         nose  fish1     m  3.18e-02  1.06e-02      -             -   1.00             5  5  1.3e-02  3 "
        "levels\n%s: order of nose of fish1 is 1.00, expected %g +- 0.1\n",
        met, expected);
    if (strcmp(text, want) != 0) fail_msg("%s\ninstead of\n%s", text, want);
}

/* The printed orders of the members of a study, until the end of the test. */
static const char *print_orders(const struct case_values *study, const struct member_file *member, enum status want) {
    struct convergence_orders orders;
    char *printed;
    size_t size;
    convergence_orders_create(test_arena(), &orders, study, member);
    FILE *const stream = open_memstream(&printed, &size);
    assert_int_equal(study_print_orders(test_arena(), study, &orders, stream), want);
    fclose(stream);
    arena_defer(test_arena(), free, printed);
    return printed;
}

// values 5 + 0.3 h
TEST(an_order_is_met_within_its_bounds_on_both_sides) {
    static const struct {
        double order;
        enum status want;
    } cases[] = {{0.89, STATUS_MISSED}, {0.91, STATUS_OK}, {1.09, STATUS_OK}, {1.11, STATUS_MISSED}};
    for (int i = 0; i < 4; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "format: 1\ntime: {end: 1, shedding_interval: 0.1}\nfish: [{}]\n"
                 "sweep: [{key: time.shedding_interval, values: [0.05, 0.1, 0.025], refine: true, expect: {order: %g, "
                 "within: 0.1, of: nose}}]\n",
                 cases[i].order);
        const struct case_values study = parse(text);
        struct member_file member[3];
        for (int m = 0; m < 3; m++) {
            static const double h[] = {0.05, 0.1, 0.025};
            member[m] = (struct member_file){.number = m, .status = "complete"};
            member_file_create_values(test_arena(), &member[m], 1);
            const int nose = member_file_quantity_number("nose");
            for (int k = 0; k < 2; k++) *member_file_place(&member[m], nose, 0, k) = 5 + 0.3 * h[m];
        }
        const char *const printed = print_orders(&study, member, cases[i].want);
        is_table(printed, cases[i].order, cases[i].want == STATUS_OK ? "met" : "MISSED");
    }
}

// differences of 2e-3 are noise where the search is 1e-3 from the fixed point, known or ten times the residual
TEST(differences_below_the_error_of_a_search_are_noise) {
    static const double errors[][2] = {{1e-3, 1e-9}, {NAN, 1e-4}, {1e-5, 1e-3}};
    for (int i = 0; i < 3; i++) {
        static const char text[] =
            "format: 1\ntime: {end: 1, shedding_interval: 0.1}\nfish: [{}]\n"
            "sweep: [{key: time.shedding_interval, values: [0.1, 0.05, 0.025], refine: true, steady: true}]\n";
        const struct case_values study = parse(text);
        struct member_file member[3];
        for (int m = 0; m < 3; m++) {
            static const double speeds[] = {1.002, 1.001, 1};
            static const char *const names[] = {"steady_speed", "steady_error", "steady_residual"};
            const double values[] = {speeds[m], errors[i][0], errors[i][1]};
            member[m] = (struct member_file){.number = m, .status = "complete"};
            member_file_create_values(test_arena(), &member[m], 1);
            for (int k = 0; k < 3; k++) {
                *member_file_place(&member[m], member_file_quantity_number(names[k]), 0, 0) = values[k];
            }
        }
        const char *const printed = print_orders(&study, member, STATUS_OK);
        if (!strstr(printed, "steady_speed") || (strstr(printed, "noise") != NULL) != (i < 2)) fail_msg("%s", printed);
    }
}

TEST(levels_of_points_are_their_distances_from_coarse_to_fine) {
    static const char text[] =
        "format: 1\ntime: {end: 1}\nfish: [{}]\nsweep: [{key: \"fish[*].nodes\", values: [9, 5, 17], refine: true}]\n";
    const struct case_values study = parse(text);
    const struct member_file missing[3] = {{.status = ""}, {.status = ""}, {.status = ""}};
    struct convergence_orders orders;
    convergence_orders_create(test_arena(), &orders, &study, missing);
    assert_int_equal(orders.n_levels, 3);
    const double sizes[] = {1.0 / 4, 1.0 / 8, 1.0 / 16};
    const int levels[] = {1, 0, 2};
    NEAR_ARRAY(3, orders.grid_spacing, sizes, 0, 0);
    assert_memory_equal(orders.level, levels, sizeof levels);
}

TEST(quantities_of_a_case_are_those_of_a_study) {
    for (int q = 0; q < SWEEP_N_QUANTITIES; q++) {
        // the look-up would run beyond the last one
        const struct member_file_quantity *const quantity =
            member_file_quantity(member_file_quantity_number(sweep_quantities[q].name));
        assert_non_null(quantity);
        assert_int_equal(quantity->of_fish, sweep_quantities[q].of_fish);
        assert_int_equal(quantity->of_xy, sweep_quantities[q].of_xy);
    }
    assert_string_equal(sweep_quantities[SWEEP_NOSE].name, "nose");
    assert_string_equal(sweep_quantities[SWEEP_TAIL].name, "tail");
}
