/* test_page.c: Tests the page of a result, and the reader of results under it. tests/extra/test_view.sh tests what a
 * browser shows of it. */
#include <sys/stat.h>

#include "crafted_file.h"
#include "result/result_reader.h"
#include "result_fixture.h"
#include "study/study_folder.h"
#include "view/page.h"

// ---- the reader

TEST_WITH(the_reader_gives_what_was_written, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 3);
    struct result_reader *reader;
    assert_int_equal(result_reader_open(test_arena(), &reader, f->path), STATUS_OK);
    assert_int_equal(reader->length[TIME], 3);
    assert_string_equal(reader->title, "result");
    assert_string_equal(reader->run_status, "complete");
    assert_string_equal(reader->name[0], "leader");
    assert_string_equal(reader->name[1], "suédois");
    assert_int_equal(reader->n_nodes[1], 7);
    assert_int_equal(reader->n_sheet[0], 7);
    assert_int_equal(result_reader_n(reader, "x"), N_FISH * 7 * 2);
    double time, *x;
    assert_int_equal(result_reader_row(reader, "time", 2, &time), STATUS_OK);
    NEAR(time, 1, 0, 0);
    assert_int_equal(result_reader_new(test_arena(), reader, "x", 1, &x), STATUS_OK);
    const struct fish *const second = &f->school->fish[1];
    NEAR(x[2 * 7 + 1], f->state->y[second->at.y], 0, 0);
    assert_true(isnan(x[2 * 5]));  // the leader has five nodes
    bool has_wake = false;
    assert_int_equal(result_reader_has_wake(reader, 0, &has_wake), STATUS_OK);
    assert_true(has_wake);
}

static void cannot_be_read(const char *path, const char *part) {
    ARENA(arena, NULL, "a reader");
    struct result_reader *reader;
    assert_int_equal(result_reader_open(arena, &reader, path), STATUS_FILE);
    assert_message(path);
    assert_message(part);
}

/* Give the file of a fixture an attribute. */
static void put_attribute(const struct fixture *f, const char *name, int value) {
    int file;
    assert_int_equal(nc_open(f->path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_put_att_int(file, NC_GLOBAL, name, NC_INT, 1, &value), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
}

TEST_WITH(the_reader_refuses_other_files, set_up, tear_down) {
    struct fixture *f = *state;
    cannot_be_read(f->path, "No such file");
    struct netcdf_rows rows;
    write_file(f, 3);
    assert_int_equal(netcdf_read_rows(f->path, &rows), STATUS_OK);
    assert_int_equal(truncate(f->path, (off_t)(rows.begin_of_rows + rows.bytes / 2)), 0);
    cannot_be_read(f->path, "none of the 3 rows is complete: copy the file again");
    unlink(f->path);
    write_file(f, 0);
    cannot_be_read(f->path, "has not written a row yet");
    put_attribute(f, "shoal_schema", RESULT_SCHEMA + 1);
    cannot_be_read(f->path, "use the program that wrote the file");
    put_attribute(f, "shoal_schema", 0);
    cannot_be_read(f->path, "not the result of a run");
    put_attribute(f, "shoal_study", 1);
    cannot_be_read(f->path, "the file of a study: give the file of one run");
}

static void set_text(const struct fixture *f, const char *name, const char *text) {
    int file;
    assert_int_equal(nc_open(f->path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_put_att_text(file, NC_GLOBAL, name, strlen(text), text), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
}

/* Readers need variables only: the text of a case, with names that look like keys, is not searched. */
TEST_WITH(sections_and_forces_are_those_of_the_fish_whatever_their_names, set_up, tear_down) {
    struct fixture *f = *state;
    f->school->fish[0].has_mean_section = 0;
    f->school->fish[1].has_mean_section = 1;
    // nothing has force: pressure, the first fish, the last fish
    for (int with_pressure = -1; with_pressure < 2; with_pressure++) {
        struct result_reader *reader;
        for (int i = 0; i < 2; i++) f->school->fish[i].force = i == with_pressure ? FORCE_PRESSURE : FORCE_REACTIVE;
        write_file(f, 1);
        set_text(f, "case_effective", "  - name: section: mean\n    section: mean\n    force: pressure\n");
        assert_int_equal(result_reader_open(test_arena(), &reader, f->path), STATUS_OK);
        assert_false(reader->has_mean_section[0]);
        assert_true(reader->has_mean_section[1]);
        assert_int_equal(reader->has_pressure, with_pressure >= 0);
        unlink(f->path);
    }
}

TEST_WITH(an_outline_needs_its_edges, set_up, tear_down) {
    struct fixture *f = *state;
    int file, edge, fish, number;
    write_file(f, 1);
    assert_int_equal(nc_open(f->path, NC_WRITE, &file), NC_NOERR);
    assert_int_equal(nc_redef(file), NC_NOERR);
    assert_int_equal(nc_inq_dimid(file, "edge", &number), NC_NOERR);
    assert_int_equal(nc_rename_dim(file, number, "gone"), NC_NOERR);
    assert_int_equal(nc_inq_varid(file, "edge_thickness", &number), NC_NOERR);
    assert_int_equal(nc_rename_var(file, number, "no_height"), NC_NOERR);
    assert_int_equal(nc_inq_dimid(file, "fish", &fish), NC_NOERR);
    assert_int_equal(nc_def_dim(file, "edge", 5, &edge), NC_NOERR);
    assert_int_equal(nc_def_var(file, "edge_thickness", NC_DOUBLE, 2, (int[]){fish, edge}, &number), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
    // the second fish has 7 nodes and needs 6 edges
    cannot_be_read(f->path, "variable n_nodes has an invalid value, 7, for a fish");
}

// ---- the page

/* The path of the page of a fixture. */
static const char *page_of(const struct fixture *f) {
    static char path[64];
    snprintf(path, sizeof path, "%s/run.html", f->folder);
    return path;
}

static enum status new_page(const char *from, const char *to, bool overwrite) {
    ARENA(arena, NULL, "a page");
    return page_write(arena, from, to, overwrite);
}

TEST_WITH(a_page_is_whole_or_not_there, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 3);
    const char *const page = page_of(f);
    assert_int_equal(new_page(f->path, page, false), STATUS_OK);
    size_t n;
    char *const bytes = read_bytes(page, &n);
    assert_memory_equal(bytes, "<!DOCTYPE html>", 15);
    assert_memory_equal(bytes + n - 8, "</html>\n", 8);

    assert_int_equal(new_page(f->path, page, false), STATUS_FILE);
    assert_message("exists");
    assert_int_equal(new_page(f->path, page, true), STATUS_OK);
    unlink(page);
    assert_int_equal(new_page(f->path, "/no/such/run.html", false), STATUS_FILE);
    assert_message("no folder /no/such");
    assert_int_equal(new_page("/no/such/run.nc", page, false), STATUS_FILE);
    struct stat facts;
    assert_int_not_equal(stat(page, &facts), 0);
}

TEST_WITH(variables_that_do_not_fit_are_refused, set_up, tear_down) {
    struct fixture *f = *state;
    write_file(f, 3);
    size_t n;
    char *const bytes = read_bytes(f->path, &n), name[NC_MAX_NAME + 1];
    const char *const page = page_of(f);
    int n_refused = 0;
    for (int i = 0; name_of_variable(f->path, i, name); i++) {
        for (enum craft how = MISSING; how < N_CRAFTS; how += MORE_DIMENSIONS) {
            craft_variable(f->path, name, how);
            const enum status status = new_page(f->path, page, true);
            if (status == STATUS_FILE) {
                assert_message(f->path);
                n_refused++;
            } else {
                assert_int_equal(status, STATUS_OK);
            }
            unlink(page);
            write_bytes(f->path, n, bytes);
        }
    }
    // 17 variables are read in three ways, three of them without a dimension that could be too long
    AT_LEAST(n_refused, 17 * 3 - 3);
}
