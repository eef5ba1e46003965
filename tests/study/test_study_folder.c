/* test_study_folder.c: For every state in which the folder of a study can be, the right members run again. */
#include <stdlib.h>
#include <sys/stat.h>

#include "case/case.h"
#include "crafted_file.h"
#include "study/study.h"
#include "study/study_folder.h"

static const char case_text[] =
    "format: 1\nname: small\ntime: {end: 0.02, shedding_interval: 0.02}\nfish: [{force: reactive, nodes: 5, "
    "sheet_points: 6}]\n"
    "sweep: [{key: solver.rtol, values: [1e-3, 1e-4, 1e-5]}]\n";

/* A folder in which all three members have run. */
struct fixture {
    struct arena *arena;
    struct case_values study;
    char folder[64], member[3][96];
};

static int set_up(void **state) {
    struct fixture *const f = calloc(1, sizeof *f);
    f->arena = arena_create(NULL, "a test");
    strcpy(f->folder, "/tmp/shoal-plan-XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    for (int m = 0; m < 3; m++) snprintf(f->member[m], sizeof f->member[m], "%s/member-%04d.nc", f->folder, m);
    assert_int_equal(case_parse(&f->study, case_text, strlen(case_text), "swimmer.yaml", NULL, 0, NULL), STATUS_OK);
    const struct study_options options = {.folder = f->folder, .command = "test", .n_processes = 2};
    int n_failed;
    assert_int_equal(study_run(&f->study, &options, &n_failed), STATUS_OK);
    assert_int_equal(n_failed, 0);
    *state = f;
    return 0;
}

static int tear_down(void **state) {
    struct fixture *const f = *state;
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", f->folder);
    assert_int_equal(system(command), 0);
    case_free(&f->study);
    arena_free(f->arena);
    free(f);
    return 0;
}

/* Replace a text attribute of the file of a member. */
static void set_attribute(const char *path, const char *name, const char *text) {
    int file;
    assert_int_equal(nc_open(path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_put_att_text(file, NC_GLOBAL, name, strlen(text), text), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
}

static enum status create_plan(const struct fixture *f, struct study_plan *plan, const struct case_values *study,
                               int first, int last, bool force) {
    const struct study_options options = {
        .folder = f->folder, .is_part = last >= 0, .first = first, .last = last, .force = force};
    return study_plan_create(f->arena, plan, study, &options);
}

/* Member 1 alone is to be run. */
static void assert_one_to_run(const struct fixture *f) {
    struct study_plan plan;
    assert_int_equal(create_plan(f, &plan, &f->study, 0, -1, 0), STATUS_OK);
    assert_int_equal(plan.n_members, 3);
    assert_int_equal(plan.n_done, 2);
    assert_int_equal(plan.n, 1);
    assert_int_equal(plan.member[0], 1);
}

static void assert_refused(const struct fixture *f, const struct case_values *study, const char *words) {
    struct study_plan plan;
    assert_int_equal(create_plan(f, &plan, study, 0, -1, 0), STATUS_FILE);
    if (!strstr(status_message(), words)) fail_msg("'%s' is not in '%s'", words, status_message());
}

TEST_WITH(finished_members_are_not_run_again, set_up, tear_down) {
    const struct fixture *const f = *state;
    struct study_plan plan;
    assert_int_equal(create_plan(f, &plan, &f->study, 0, -1, 0), STATUS_OK);
    assert_int_equal(plan.n, 0);
    assert_int_equal(plan.n_done, 3);
}

TEST_WITH(missing_and_cut_members_run_again, set_up, tear_down) {
    const struct fixture *const f = *state;
    assert_int_equal(truncate(f->member[1], 3000), 0);
    assert_one_to_run(f);
    assert_int_equal(unlink(f->member[1]), 0);
    assert_one_to_run(f);
}

TEST_WITH(members_that_are_not_complete_run_again, set_up, tear_down) {
    const struct fixture *const f = *state;
    set_attribute(f->member[1], "run_status", "stopped");
    assert_one_to_run(f);
}

TEST_WITH(members_of_a_changed_case_run_again, set_up, tear_down) {
    const struct fixture *const f = *state;
    // the same text of the study, but other defaults: those of another version of the program
    set_attribute(f->member[1], "case_effective", "format: 1\n");
    assert_one_to_run(f);
}

TEST_WITH(members_of_another_study_are_refused_unless_forced, set_up, tear_down) {
    const struct fixture *const f = *state;
    set_attribute(f->member[1], "study_case", "format: 1\n");
    assert_refused(f, &f->study, f->member[1]);
    struct study_plan plan;
    assert_int_equal(access(f->member[1], F_OK), 0);
    assert_int_equal(create_plan(f, &plan, &f->study, 0, -1, 1), STATUS_OK);
    assert_int_equal(plan.n, 1);
    assert_int_equal(plan.member[0], 1);

    // if the member fails, the folder has no result of the other study
    assert_int_not_equal(access(f->member[1], F_OK), 0);
}

TEST_WITH(force_keeps_all_results_if_the_study_is_refused, set_up, tear_down) {
    const struct fixture *const f = *state;
    struct study_plan plan;
    struct case_values refused;
    const char *const assignment =
        "sweep=[{key: solver.rtol, values: [1e-3, 1e-4]}, {key: time.end, values: [0.02, 0.03]}]";
    set_attribute(f->member[1], "study_case", "format: 1\n");
    assert_int_equal(case_parse(&refused, case_text, strlen(case_text), "swimmer.yaml", NULL, 1, &assignment),
                     STATUS_OK);
    assert_int_equal(create_plan(f, &plan, &refused, 0, -1, 1), STATUS_CASE);
    for (int m = 0; m < 3; m++) assert_int_equal(access(f->member[m], F_OK), 0);
    case_free(&refused);
}

TEST_WITH(the_state_from_which_a_study_starts_is_not_removed, set_up, tear_down) {
    const struct fixture *const f = *state;
    const struct study_options options = {.folder = f->folder, .force = true, .from = f->member[1]};
    struct study_plan plan;
    for (int m = 0; m < 2; m++) set_attribute(f->member[m], "study_case", "format: 1\n");
    assert_int_equal(study_plan_create(f->arena, &plan, &f->study, &options), STATUS_FILE);
    assert_non_null(strstr(status_message(), "is the file that is read"));
    for (int m = 0; m < 3; m++) assert_int_equal(access(f->member[m], F_OK), 0);
}

TEST_WITH(force_runs_the_members_of_another_program_again, set_up, tear_down) {
    const struct fixture *const f = *state;
    struct study_plan plan;
    set_attribute(f->member[1], "source", "shoal 0.0.1 (commit 0123456789ab), SUNDIALS 6.4.1");
    for (int force = 0; force < 2; force++) {
        assert_int_equal(create_plan(f, &plan, &f->study, 0, -1, force), STATUS_OK);
        assert_int_equal(plan.n, force);
        assert_int_equal(plan.n_done, 3 - force);
        if (force) assert_int_equal(plan.member[0], 1);
    }
}

TEST_WITH(a_member_in_the_place_of_another_is_refused, set_up, tear_down) {
    const struct fixture *const f = *state;
    size_t n;
    char *const bytes = read_bytes(f->member[0], &n);
    write_bytes(f->member[1], n, bytes);
    assert_refused(f, &f->study, f->member[1]);
}

TEST_WITH(members_beyond_the_last_are_refused_or_removed, set_up, tear_down) {
    const struct fixture *const f = *state;
    char path[96];
    snprintf(path, sizeof path, "%s/member-0003.nc", f->folder);
    struct study_plan plan;
    write_bytes(path, 4, "else");
    assert_refused(f, &f->study, path);
    // a file that shoal did not write stays
    assert_int_equal(create_plan(f, &plan, &f->study, 0, -1, 1), STATUS_FILE);
    assert_int_equal(access(path, F_OK), 0);
    size_t n;
    char *const bytes = read_bytes(f->member[0], &n);
    write_bytes(path, n, bytes);
    assert_refused(f, &f->study, path);
    assert_int_equal(create_plan(f, &plan, &f->study, 0, -1, 1), STATUS_OK);
    assert_int_not_equal(access(path, F_OK), 0);
    assert_int_equal(access(f->member[2], F_OK), 0);
}

TEST_WITH(a_part_is_about_its_members_only, set_up, tear_down) {
    const struct fixture *const f = *state;
    assert_int_equal(unlink(f->member[0]), 0);
    assert_int_equal(unlink(f->member[2]), 0);
    struct study_plan plan;
    assert_int_equal(create_plan(f, &plan, &f->study, 1, 2, 0), STATUS_OK);
    assert_int_equal(plan.n_members, 2);
    assert_int_equal(plan.n, 1);
    assert_int_equal(plan.member[0], 2);
    const int wrong[][2] = {{-1, 1}, {2, 1}, {0, 3}};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(create_plan(f, &plan, &f->study, wrong[i][0], wrong[i][1], 0), STATUS_CASE);
        assert_non_null(strstr(status_message(), "the study has members 0 to 2"));
    }
}
