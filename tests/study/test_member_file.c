/* test_member_file.c: Tests what the last row of a member says, and what is computed from all its rows. */
#include "crafted_file.h"
#include "result_fixture.h"
#include "study/member_file.h"

/* Rows at uneven times. Fish 0 has a period of 0.5 s, which ends in the last four rows, fish 1 one of 1 s, longer than
 * the run. */
enum { N_ROWS = 5 };
static const double row_time[N_ROWS] = {0, 0.3, 0.4, 0.7, 0.8};
static const double heading[N_ROWS] = {150, 10, 20, 50, 90};

static void read_member(struct fixture *f, struct member_file *member) {
    struct result_file *const file = create(f);
    for (int i = 0; i < N_ROWS; i++) {
        for (int fish = 0; fish < N_FISH; fish++) {
            f->of_fish[fish].heading = heading[i];
            f->of_fish[fish].com[0] = 1 + 3 * row_time[i] * (fish + 1);
            f->of_fish[fish].com[1] = 2 + 5 * row_time[i];
        }
        assert_int_equal(append(f, file, row_time[i], 0), STATUS_OK);
    }
    assert_int_equal(result_file_close(file, "complete"), STATUS_OK);
    assert_int_equal(member_file_read(test_arena(), member, f->path), STATUS_OK);
}

static double value(const struct member_file *member, const char *quantity, int fish, int xy) {
    return member_file_value(member, member_file_quantity_number(quantity), fish, xy);
}

TEST_WITH(quantities_of_the_table_are_those_of_the_last_row, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    read_member(f, &member);
    assert_string_equal(member.status, "complete");
    assert_string_equal(member.effective, EFFECTIVE);
    NEAR(value(&member, "heading", 1, 0), 90, 0, 0);
    NEAR(value(&member, "com", 1, 0), 1 + 3 * 0.8 * 2, 0, 1e-15);
    NEAR(value(&member, "com", 0, 1), 2 + 5 * 0.8, 0, 1e-15);
    NEAR(value(&member, "speed", 1, 0), f->of_fish[1].speed, 0, 0);
    NEAR(value(&member, "steps", 0, 0), 21, 0, 0);
    assert_true(isnan(value(&member, "speed", N_FISH, 0)));  // no such fish
}

/* A member whose header counts rows that are not there, or that has no rows to count, is not finished. */
TEST_WITH(a_member_that_lacks_rows_is_refused, set_up, tear_down) {
    struct fixture *const f = *state;
    const unsigned char count[8] = {0, 0, 0, 0x79};
    for (int has_rows = 0; has_rows < 2; has_rows++) {
        struct member_file member;
        if (has_rows) {
            read_member(f, &member);
        } else {
            int file, number;
            assert_int_equal(nc_create(f->path, NC_CLOBBER | NC_64BIT_DATA, &file), NC_NOERR);
            assert_int_equal(nc_put_att_int(file, NC_GLOBAL, "shoal_schema", NC_INT, 1, (int[]){1}), NC_NOERR);
            nc_def_dim(file, "time", NC_UNLIMITED, &number);
            nc_def_dim(file, "fish", 2, &number);
            nc_def_dim(file, "node", 5, &number);
            assert_int_equal(nc_close(file), NC_NOERR);
        }
        FILE *const file = fopen(f->path, "r+");
        fseek(file, 4, SEEK_SET);
        assert_int_equal(fwrite(count, 1, 8, file), 8);
        fclose(file);
        assert_int_equal(member_file_read(test_arena(), &member, f->path), STATUS_FILE);
        assert_message("the end of the file is missing");
        unlink(f->path);
    }
}

TEST_WITH(a_steady_state_has_its_own_values, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    struct steady_fish fish[N_FISH] = {{.drag = 3, .force = {4, 5}}, {.drag = 6, .force = {7, 8}}};
    const struct steady_values values = {.stiffness = 0.5, .growth = -0.25, .fish = fish};
    write_steady(f, 1, &(double){0}, &values);
    assert_int_equal(member_file_read(test_arena(), &member, f->path), STATUS_OK);
    NEAR(value(&member, "steady_drag", 1, 0), 6, 0, 0);
    NEAR(value(&member, "steady_force", 0, 1), 5, 0, 0);
    NEAR(value(&member, "steady_stiffness", 0, 0), 0.5, 0, 0);
    NEAR(value(&member, "steady_growth", 0, 0), -0.25, 0, 0);
    NEAR(value(&member, "speed", 1, 0), f->of_fish[1].speed, 0, 0);
    unlink(f->path);
    read_member(f, &member);
    assert_true(isnan(value(&member, "steady_drag", 1, 0)));
}

TEST_WITH(beats_of_a_search_are_those_of_search_multipliers_and_rows, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    struct steady_fish fish[N_FISH] = {{.drag = 3}, {.drag = 6}};
    const struct steady_values values = {.n_beats = 5, .n_multiplier_beats = 7, .fish = fish};
    write_steady(f, 2, (double[]){3, 3.75}, &values);
    assert_int_equal(member_file_read(test_arena(), &member, f->path), STATUS_OK);
    // rows of 0.75 s at 2 Hz; 28 s
    NEAR(value(&member, "beat_time", 0, 0), 28 / (5 + 7 + 1.5), 0, 1e-14);
}

TEST_WITH(nose_and_tail_are_the_ends_of_each_body, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    read_member(f, &member);
    for (int fish = 0; fish < N_FISH; fish++) {
        const struct fish *const of = &f->school->fish[fish];
        const double *const y = f->state->y;
        NEAR(value(&member, "nose", fish, 0), y[of->at.x], 0, 0);
        NEAR(value(&member, "nose", fish, 1), y[of->at.y], 0, 0);
        NEAR(value(&member, "tail", fish, 0), y[of->at.x + of->n_nodes - 1], 0, 0);
        NEAR(value(&member, "tail", fish, 1), y[of->at.y + of->n_nodes - 1], 0, 0);
    }
}

TEST_WITH(lateral_drift_is_to_the_left_of_the_first_heading, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    read_member(f, &member);
    // left of 150 degrees is (-sin 150, cos 150); the fish go 3 and 6 m/s along x and 5 along y
    NEAR(value(&member, "lateral_drift", 0, 0), (-0.5 * 3 - sqrt(0.75) * 5) * 0.8, 0, 1e-14);
    NEAR(value(&member, "lateral_drift", 1, 0), (-0.5 * 6 - sqrt(0.75) * 5) * 0.8, 0, 1e-14);
}

TEST_WITH(mean_heading_is_that_of_trapezoids_over_the_last_period, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    read_member(f, &member);
    const double last_three = 0.1 * 15 + 0.3 * 35 + 0.1 * 70;
    NEAR(value(&member, "mean_heading", 0, 0), last_three / 0.5, 0, 1e-14);
    // the whole run
    NEAR(value(&member, "mean_heading", 1, 0), (0.3 * 80 + last_three) / 0.8, 0, 1e-14);
}

TEST_WITH(a_member_without_rows_has_no_values, set_up, tear_down) {
    struct fixture *const f = *state;
    write_file(f, 0);
    struct member_file member;
    assert_int_equal(member_file_read(test_arena(), &member, f->path), STATUS_OK);
    assert_true(isnan(value(&member, "speed", 0, 0)));
    assert_true(isnan(value(&member, "mean_heading", 1, 0)));
}

// ---- files that are not whole, or not ours

TEST_WITH(a_member_that_was_cut_is_refused, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    read_member(f, &member);
    size_t n;
    char *const bytes = read_bytes(f->path, &n);
    while (n > 0 && bytes[n - 1] == 0) n--;  // the last value, 28, ends with zeros
    // the header with its status is whole in most of them
    for (size_t length = n - 1; length > 0; length -= length < 97 ? length : 97) {
        write_bytes(f->path, length, bytes);
        if (member_file_read(test_arena(), &member, f->path) != STATUS_FILE)
            fail_msg("%zu of %zu bytes are a member", length, n);
        assert_message(f->path);
        assert_null(member.status);
    }
}

/* Whether a member cannot be read without this variable. */
static bool is_needed(const char *name) {
    static const char *const needed[] = {"time", "x", "n_nodes", "heading", "com", "frequency"};
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++)
        if (strcmp(needed[i], name) == 0) return true;
    return false;
}

static bool is_quantity(const char *name) {
    for (int q = 0; member_file_quantity(q); q++)
        if (strcmp(member_file_quantity(q)->name, name) == 0) return true;
    return false;
}

TEST_WITH(a_variable_that_does_not_fit_is_refused, set_up, tear_down) {
    struct fixture *const f = *state;
    struct member_file member;
    read_member(f, &member);
    size_t n;
    char *const bytes = read_bytes(f->path, &n), name[NC_MAX_NAME + 1];
    int n_refused = 0;
    for (int i = 0; name_of_variable(f->path, i, name); i++) {
        for (enum craft how = 0; how < N_CRAFTS; how++) {
            craft_variable(f->path, name, how);
            const enum status status = member_file_read(test_arena(), &member, f->path);
            const bool must_fail = is_needed(name) || (is_quantity(name) && how != MISSING);
            if (status != STATUS_FILE && must_fail) fail_msg("%s, %d: not refused", name, how);
            if (status == STATUS_FILE) {
                assert_message(f->path);
                n_refused++;
            } else {
                assert_int_equal(status, STATUS_OK);
                if (is_quantity(name)) assert_true(isnan(value(&member, name, 0, 0)));
            }
            write_bytes(f->path, n, bytes);
        }
    }
    ABOVE(n_refused, 150);
}

TEST_WITH(a_body_cannot_have_more_nodes_than_there_are_places, set_up, tear_down) {
    struct fixture *const f = *state;
    const int wrong[] = {8, 0, -1, 2147483647};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_file(f, 2);
        int file;
        assert_int_equal(nc_open(f->path, NC_WRITE, &file), NC_NOERR);
        assert_int_equal(nc_put_var1_int(file, number_of(file, "n_nodes"), (size_t[]){1}, &wrong[i]), NC_NOERR);
        nc_close(file);
        struct member_file member;
        assert_int_equal(member_file_read(test_arena(), &member, f->path), STATUS_FILE);
        assert_message("nodes");
        unlink(f->path);
    }
}
