/* test_netcdf.c: NetCDF files are written and renamed in an order that survives a crash, and damaged or foreign files
 * do no harm. */
#include <fcntl.h>
#include <netcdf.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "crafted_file.h"
#include "near.h"
#include "result/netcdf.h"
#include "result/target.h"

// ---- operations on the disk: one line for every fsync and rename

static char deeds[4096];

static void note(const char *deed, const char *path) {
    const char *const slash = strrchr(path, '/');
    const size_t length = strlen(deeds);
    const char *const name = strstr(path, ".part") ? "a part" : slash ? slash + 1 : path;
    snprintf(deeds + length, sizeof deeds - length, "%s %s; ", deed, name);
}

int __real_fsync(int descriptor);
int __wrap_fsync(int descriptor);
int __wrap_fsync(int descriptor) {
    char link_path[64], path[256] = "";
    snprintf(link_path, sizeof link_path, "/proc/self/fd/%d", descriptor);
    ABOVE(readlink(link_path, path, sizeof path - 1), 0);
    struct stat facts;
    assert_int_equal(fstat(descriptor, &facts), 0);
    note(S_ISDIR(facts.st_mode) ? "fsync of folder" : "fsync of", path);
    return __real_fsync(descriptor);
}

int __real_renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags);
int __wrap_renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags);
int __wrap_renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags) {
    note("rename to the new name", to);
    return __real_renameat2(from_folder, from, to_folder, to, flags);
}

int __real_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to);
int __wrap_rename(const char *from, const char *to) {
    note("rename to", to);
    return __real_rename(from, to);
}

// ---- a folder with a file

struct fixture {
    char folder[32], path[64];
};

static int set_up(void **state) {
    static struct fixture f;
    strcpy(f.folder, "/tmp/test_netcdf.XXXXXX");
    assert_non_null(mkdtemp(f.folder));
    snprintf(f.path, sizeof f.path, "%s/a.nc", f.folder);
    *state = &f;
    return 0;
}

static int tear_down(void **state) {
    const struct fixture *const f = *state;
    unlink(f->path);
    assert_int_equal(rmdir(f->folder), 0);  // the folder has no other files
    return 0;
}

static void assert_message(const char *part) {
    if (strstr(status_message(), part) == NULL) fail_msg("\"%s\" is not in \"%s\"", part, status_message());
}

/* One file at a time. */
static struct arena *arena;

static void close_file(void) {
    arena_free(arena);
    arena = NULL;
}

static enum status open_file(struct netcdf_reader *reader, const char *path) {
    arena = arena_create(NULL, "a test");
    const enum status status = netcdf_open(arena, reader, path);
    if (status != STATUS_OK) close_file();
    return status;
}

enum { N_ROWS = 3, N_FISH = 2 };

/* Rows of two variables, one that does not grow, and a string. */
static enum status write_file(const char *path, bool overwrite) {
    struct netcdf_writer writer;
    TRY(netcdf_create(&writer, path, "title of it", "a command"));
    const int time = netcdf_define_dimension(&writer, "time", 0),
              fish = netcdf_define_dimension(&writer, "fish", N_FISH),
              name = netcdf_define_dimension(&writer, "name", 5);
    const int speed = netcdf_define_variable(&writer, &(struct netcdf_variable){.name = "speed",
                                                                                .long_name = "a speed",
                                                                                .units = "m s-1",
                                                                                .type = NETCDF_DOUBLE,
                                                                                .n_dimensions = 2,
                                                                                .dimension = {time, fish}});
    const int steps = netcdf_define_variable(
        &writer,
        &(struct netcdf_variable){
            .name = "steps", .long_name = "steps", .type = NETCDF_INT64, .n_dimensions = 1, .dimension = {time}});
    const int count = netcdf_define_variable(
        &writer,
        &(struct netcdf_variable){
            .name = "count", .long_name = "a count", .type = NETCDF_INT, .n_dimensions = 1, .dimension = {fish}});
    const int names = netcdf_define_variable(
        &writer,
        &(struct netcdf_variable){
            .name = "names", .long_name = "names", .type = NETCDF_TEXT, .n_dimensions = 2, .dimension = {fish, name}});
    netcdf_write_integer(&writer, NETCDF_GLOBAL, "number", 7);
    netcdf_write_integer(&writer, NETCDF_GLOBAL, "shoal_schema", 1);
    netcdf_end_definitions(&writer);
    netcdf_write(&writer, count, NULL, NULL, (int[]){4, 5});
    netcdf_write(&writer, names, NULL, NULL, "first2nd\0\0");
    const enum status status = netcdf_publish(&writer, overwrite);
    for (size_t row = 0; row < N_ROWS && status == STATUS_OK; row++) {
        const double r = (double)row;
        netcdf_write_doubles(&writer, speed, (size_t[]){row, 0}, (size_t[]){1, N_FISH}, (double[]){r, r + 0.5});
        netcdf_write(&writer, steps, (size_t[]){row}, (size_t[]){1}, (long[]){10 + (long)row});
        netcdf_sync(&writer, false);
    }
    const enum status finished = netcdf_finish(&writer);
    return status == STATUS_OK ? finished : status;
}

// ---- writing

TEST_WITH(what_is_written_reads_back, set_up, tear_down) {
    const struct fixture *const f = *state;
    assert_int_equal(write_file(f->path, false), STATUS_OK);
    struct netcdf_reader reader;
    assert_int_equal(open_file(&reader, f->path), STATUS_OK);
    double speed[N_ROWS][N_FISH], steps[N_ROWS], count[N_FISH];
    char names[N_FISH][5], *title;
    int number;
    const struct netcdf_slice all[] = {{"time", 0, N_ROWS}, {"fish", 0, N_FISH}, {NULL}};
    assert_int_equal(netcdf_read_doubles(&reader, "speed", all, &speed[0][0]), STATUS_OK);
    assert_int_equal(netcdf_read_doubles(&reader, "steps", (struct netcdf_slice[]){all[0], {NULL}}, steps), STATUS_OK);
    assert_int_equal(netcdf_read_doubles(&reader, "count", all + 1, count), STATUS_OK);
    const struct netcdf_slice slice[] = {all[1], {"name", 0, 5}, {NULL}};
    assert_int_equal(netcdf_read_text(&reader, "names", slice, &names[0][0]), STATUS_OK);
    assert_int_equal(netcdf_attribute(&reader, "title", &title), STATUS_OK);
    assert_int_equal(netcdf_read_integer(&reader, "number", 0, &number), STATUS_OK);
    assert_true(netcdf_has(&reader, "speed") && !netcdf_has(&reader, "Speed"));
    for (int row = 0; row < N_ROWS; row++) {
        for (int i = 0; i < N_FISH; i++) NEAR(speed[row][i], row + 0.5 * i, 0, 0);
        NEAR(steps[row], 10 + row, 0, 0);
    }
    NEAR(count[1], 5, 0, 0);
    assert_memory_equal(names, "first2nd\0\0", 10);
    assert_string_equal(title, "title of it");
    assert_int_equal(number, 7);
    close_file();
}

TEST_WITH(the_history_of_no_command_is_the_date, set_up, tear_down) {
    const struct fixture *const f = *state;
    struct netcdf_writer writer;
    struct netcdf_reader reader;
    char *history;
    assert_int_equal(netcdf_create(&writer, f->path, "title of it", NULL), STATUS_OK);
    netcdf_write_integer(&writer, NETCDF_GLOBAL, "shoal_schema", 1);
    netcdf_end_definitions(&writer);
    assert_int_equal(netcdf_publish(&writer, false), STATUS_OK);
    assert_int_equal(netcdf_finish(&writer), STATUS_OK);
    assert_int_equal(open_file(&reader, f->path), STATUS_OK);
    assert_int_equal(netcdf_attribute(&reader, "history", &history), STATUS_OK);
    assert_int_equal(strlen(history), strlen("2000-01-01T00:00:00Z"));
    close_file();
}

TEST_WITH(a_file_is_on_disk_before_its_name_and_the_name_before_the_rows, set_up, tear_down) {
    const struct fixture *const f = *state;
    const char *const folder = strrchr(f->folder, '/') + 1;
    char want[512];
    // the rows come within a second of the last fsync; the descriptor still has the name of the opened file
    snprintf(want, sizeof want, "fsync of a part; rename to the new name a.nc; fsync of folder %s; ", folder);
    deeds[0] = '\0';
    assert_int_equal(write_file(f->path, false), STATUS_OK);
    assert_string_equal(deeds, want);

    snprintf(want, sizeof want, "fsync of a part; rename to a.nc; fsync of folder %s; ", folder);
    deeds[0] = '\0';
    assert_int_equal(write_file(f->path, true), STATUS_OK);
    assert_string_equal(deeds, want);
}

TEST_WITH(a_file_that_came_meanwhile_is_not_replaced, set_up, tear_down) {
    const struct fixture *const f = *state;
    assert_int_equal(target_check(f->path, TARGET_NETCDF, false), STATUS_OK);
    assert_int_equal(write_file(f->path, false), STATUS_OK);
    assert_int_equal(write_file(f->path, false), STATUS_FILE);
    assert_message("exists");
    assert_int_equal(target_check(f->path, TARGET_NETCDF, false), STATUS_FILE);
    assert_int_equal(target_check(f->path, TARGET_NETCDF, true), STATUS_OK);
}

TEST_WITH(a_missing_folder_is_named, set_up, tear_down) {
    const struct fixture *const f = *state;
    char path[96];
    snprintf(path, sizeof path, "%s/no/run.nc", f->folder);
    assert_int_equal(target_check(path, TARGET_NETCDF, true), STATUS_FILE);
    assert_message("there is no folder");
    assert_int_equal(write_file(path, true), STATUS_FILE);
    assert_message("there is no folder");
    assert_int_equal(target_check("/no-such-folder.nc", TARGET_NETCDF, true), STATUS_OK);
}

// ---- reading foreign files

static int dimension(int file, const char *name, size_t length) {
    int number;
    assert_int_equal(nc_def_dim(file, name, length, &number), NC_NOERR);
    return number;
}

/* Make a file with a variable v of some type over (a: 2, b: 3, c: 3, d: 1, e: 1), of which it has the first n, and one
 * over (b). */
static void craft(const char *path, nc_type type, int n) {
    int file, variable;
    assert_int_equal(nc_create(path, NC_CLOBBER | NC_64BIT_DATA, &file), NC_NOERR);
    const int dimensions[] = {dimension(file, "a", 2), dimension(file, "b", 3), dimension(file, "c", 3),
                              dimension(file, "d", 1), dimension(file, "e", 1)};
    assert_int_equal(nc_def_var(file, "v", type, n, dimensions, &variable), NC_NOERR);
    assert_int_equal(nc_def_var(file, "only_b", NC_FLOAT, 1, dimensions + 1, &variable), NC_NOERR);
    const int numbers[300] = {0};
    assert_int_equal(nc_put_att_int(file, NC_GLOBAL, "numbers", NC_INT, 300, numbers), NC_NOERR);
    assert_int_equal(nc_put_att_text(file, NC_GLOBAL, "string", 3, "abc"), NC_NOERR);
    assert_int_equal(nc_close(file), NC_NOERR);
}

/* Try to read a (2, 3) of v with a guard after it. */
static enum status read_crafted(const char *path, bool as_text, const struct netcdf_slice *slice) {
    struct netcdf_reader reader;
    assert_int_equal(open_file(&reader, path), STATUS_OK);
    double values[7];
    char text[7];
    memset(values, 0x55, sizeof values);
    memset(text, 0x55, sizeof text);
    const enum status status =
        as_text ? netcdf_read_text(&reader, "v", slice, text) : netcdf_read_doubles(&reader, "v", slice, values);
    assert_memory_equal(&values[6], "UUUUUUUU", sizeof *values);
    assert_int_equal(text[6], 0x55);
    close_file();
    return status;
}

TEST_WITH(only_what_is_expected_is_read, set_up, tear_down) {
    const struct fixture *const f = *state;
    const struct netcdf_slice ab[] = {{"a", 0, 2}, {"b", 0, 3}, {NULL}}, long_b[] = {{"a", 0, 2}, {"b", 1, 3}, {NULL}},
                              ac[] = {{"a", 0, 2}, {"c", 0, 3}, {NULL}}, far_a[] = {{"a", 3, 0}, {"b", 0, 3}, {NULL}},
                              part[] = {{"a", 1, 1}, {"b", 1, 2}, {NULL}};
    const struct {
        nc_type type;
        int n;
        bool as_text;
        const struct netcdf_slice *slice;
        bool is_right;
    } tries[] = {
        {NC_DOUBLE, 2, false, ab, true},      {NC_FLOAT, 2, false, ab, true},      {NC_INT64, 2, false, ab, true},
        {NC_BYTE, 2, false, part, true},      {NC_CHAR, 2, true, ab, true},        {NC_CHAR, 2, false, ab, false},
        {NC_DOUBLE, 2, true, ab, false},      {NC_DOUBLE, 0, false, ab, false},    {NC_DOUBLE, 1, false, ab, false},
        {NC_DOUBLE, 3, false, ab, false},     {NC_DOUBLE, 5, false, ab, false},    {NC_DOUBLE, 2, false, ac, false},
        {NC_DOUBLE, 2, false, long_b, false}, {NC_DOUBLE, 2, false, far_a, false}, {NC_CHAR, 3, true, ab, false},
    };
    for (size_t i = 0; i < sizeof tries / sizeof *tries; i++) {
        craft(f->path, tries[i].type, tries[i].n);
        const enum status status = read_crafted(f->path, tries[i].as_text, tries[i].slice);
        if (status != (tries[i].is_right ? STATUS_OK : STATUS_FILE)) fail_msg("try %zu: %d", i, status);
        if (status == STATUS_FILE) assert_message("variable v was not written by shoal");
        if (status == STATUS_FILE) assert_message(f->path);
        if (tries[i].slice == long_b) assert_message("shoal: numbers over (a[0:2], b[1:4]) are expected");
    }
}

TEST_WITH(attributes_and_lengths_are_checked_too, set_up, tear_down) {
    const struct fixture *const f = *state;
    craft(f->path, NC_DOUBLE, 2);
    struct netcdf_reader reader;
    assert_int_equal(open_file(&reader, f->path), STATUS_OK);
    struct {
        int value, guard;
    } integer = {0, 0x55};
    char *string;
    size_t length;
    assert_int_equal(netcdf_read_integer(&reader, "numbers", 0, &integer.value), STATUS_FILE);
    assert_message("attribute numbers is no integer");
    assert_int_equal(integer.guard, 0x55);
    assert_int_equal(netcdf_read_integer(&reader, "string", 0, &integer.value), STATUS_FILE);
    assert_int_equal(netcdf_read_integer(&reader, "nothing", -3, &integer.value), STATUS_OK);
    assert_int_equal(integer.value, -3);
    assert_int_equal(netcdf_attribute(&reader, "numbers", &string), STATUS_FILE);
    assert_message("attribute numbers is no string");
    assert_null(string);
    assert_int_equal(netcdf_attribute(&reader, "nothing", &string), STATUS_OK);
    assert_string_equal(string, "");
    assert_int_equal(netcdf_read_length(&reader, "b", 3, 3, &length), STATUS_OK);
    assert_int_equal(netcdf_read_length(&reader, "b", 4, 9, &length), STATUS_FILE);
    assert_int_equal(netcdf_read_length(&reader, "b", 0, 2, &length), STATUS_FILE);
    assert_message("dimension b has an invalid length, 3");
    assert_int_equal(netcdf_read_length(&reader, "z", 0, 2, &length), STATUS_FILE);
    assert_message("dimension z is missing");
    double value;
    assert_int_equal(netcdf_read_doubles(&reader, "z", (struct netcdf_slice[]){{NULL}}, &value), STATUS_FILE);
    assert_message("variable z is missing");
    close_file();
}

static enum status try_to_open(const char *path) {
    struct netcdf_reader reader;
    const enum status status = open_file(&reader, path);
    close_file();
    return status;
}

TEST_WITH(what_is_no_file_is_refused, set_up, tear_down) {
    const struct fixture *const f = *state;
    assert_int_equal(try_to_open(f->path), STATUS_FILE);
    assert_message("No such file");
    assert_int_equal(mkfifo(f->path, 0600), 0);
    assert_int_equal(try_to_open(f->path), STATUS_FILE);  // without waiting for a writer
    assert_message("not an ordinary file");
    unlink(f->path);
    assert_int_equal(try_to_open(f->folder), STATUS_FILE);
    assert_message("is a folder");
    FILE *const text = fopen(f->path, "w");
    fputs("CDF\3 and more", text);
    fclose(text);
    assert_int_equal(try_to_open(f->path), STATUS_FILE);
    assert_message("not a NetCDF file");
}

/* Make a file of n_growing variables of 3 bytes a row with some rows, whose last byte is not 0. */
static void write_rows(const char *path, int format, int n_growing) {
    int file, rows, three, variable;
    assert_int_equal(nc_create(path, NC_CLOBBER | format, &file), NC_NOERR);
    assert_int_equal(nc_set_fill(file, NC_NOFILL, NULL), NC_NOERR);
    assert_int_equal(nc_def_dim(file, "rows", NC_UNLIMITED, &rows), NC_NOERR);
    assert_int_equal(nc_def_dim(file, "three", 3, &three), NC_NOERR);
    assert_int_equal(nc_def_var(file, "constant", NC_SHORT, 1, &three, &variable), NC_NOERR);
    assert_int_equal(nc_put_att_text(file, variable, "an_attribute", 5, "value"), NC_NOERR);
    for (int i = 0; i < n_growing; i++) {
        char name[16];
        snprintf(name, sizeof name, "v%d", i);
        assert_int_equal(nc_def_var(file, name, NC_BYTE, 2, (int[]){rows, three}, &variable), NC_NOERR);
    }
    assert_int_equal(nc_enddef(file), NC_NOERR);
    assert_int_equal(nc_put_var_short(file, 0, (short[]){1, 2, 3}), NC_NOERR);
    for (size_t row = 0; row < 5; row++) {
        for (int i = 0; i < n_growing; i++) {
            assert_int_equal(
                nc_put_vara_schar(file, 1 + i, (size_t[]){row, 0}, (size_t[]){1, 3}, (signed char[]){1, 2, 3}),
                NC_NOERR);
        }
    }
    assert_int_equal(nc_close(file), NC_NOERR);
}

/* A truncated file of five rows with so many growing variables of three bytes each: the file has the whole rows, or is
 * refused if a value that does not grow, or a part of the header, is missing. */
static void cut_everywhere(const char *path, int n_growing) {
    const off_t whole = length_of_data(path), per_row = n_growing == 1 ? 3 : 4 * n_growing,
                first = n_growing == 0 ? whole : whole - 4 * per_row - (4 * (n_growing - 1) + 3),
                constants = n_growing == 0 ? whole : first - 2 /* that fill up */;
    for (off_t length = whole - 1; length >= 0; length--) {
        assert_int_equal(truncate(path, length), 0);
        struct netcdf_reader reader;
        const enum status status = open_file(&reader, path);
        if ((status == STATUS_OK) != (length >= constants)) fail_msg("%d growing, %ld bytes", n_growing, (long)length);
        if (length == constants - 1) assert_message("the end of the file is missing");
        if (status != STATUS_OK) continue;
        size_t n_rows, want = 0;
        for (off_t end = whole; want < 5 && end - (4 - (off_t)want) * per_row <= length; want++) continue;
        assert_int_equal(netcdf_read_length(&reader, "rows", 0, 100, &n_rows), STATUS_OK);
        assert_int_equal(n_rows, want);
        assert_int_equal(reader.n_missing, 5 - want);
        // missing values are not read as zeros
        double values[15];
        const struct netcdf_slice all[] = {{"rows", 0, want}, {"three", 0, 3}, {NULL}},
                                  more[] = {{"rows", 0, want + 1}, {"three", 0, 3}, {NULL}};
        if (want > 0) assert_int_equal(netcdf_read_doubles(&reader, "v0", all, values), STATUS_OK);
        if (want > 0) NEAR(values[3 * want - 1], 3, 0, 0);
        assert_int_equal(netcdf_read_doubles(&reader, "v0", more, values), STATUS_FILE);
        close_file();
        struct netcdf_rows rows;
        assert_int_equal(netcdf_read_rows(path, &rows), STATUS_OK);
        assert_int_equal(rows.n, want);
        assert_int_equal(rows.n_counted, 5);
        assert_int_equal(rows.begin_of_rows, first);
    }
}

TEST_WITH(a_file_that_was_cut_anywhere_has_its_whole_rows, set_up, tear_down) {
    const struct fixture *const f = *state;
    const int formats[] = {0, NC_64BIT_OFFSET, NC_64BIT_DATA};
    for (int i = 0; i < 3; i++) {
        for (int n_growing = 0; n_growing < 3; n_growing++) {
            write_rows(f->path, formats[i], n_growing);
            assert_int_equal(try_to_open(f->path), STATUS_OK);
            cut_everywhere(f->path, n_growing);
        }
    }
}

/* Put another number of rows into the header of a file with 64-bit sizes. */
static void count_rows(const char *path, uint64_t n) {
    const int file = open(path, O_WRONLY);
    unsigned char bytes[8];
    for (int i = 0; i < 8; i++) bytes[i] = (unsigned char)(n >> (56 - 8 * i));
    assert_int_equal(pwrite(file, bytes, 8, 4), 8);
    close(file);
}

TEST_WITH(a_header_that_counts_more_rows_than_there_are_does_not_count, set_up, tear_down) {
    const struct fixture *const f = *state;
    const uint64_t counts[] = {6, 0x7900000000, UINT64_MAX};
    for (int n_growing = 0; n_growing < 3; n_growing++) {
        for (int i = 0; i < 3; i++) {
            struct netcdf_reader reader;
            size_t n_rows;
            write_rows(f->path, NC_64BIT_DATA, n_growing);
            count_rows(f->path, counts[i]);
            if (open_file(&reader, f->path) != STATUS_OK) continue;  // NetCDF does not take each of them
            const int code = netcdf_read_length(&reader, "rows", 0, SIZE_MAX, &n_rows);
            assert_int_equal(code, STATUS_OK);
            assert_int_equal(n_rows, n_growing > 0 ? 5 : 0);
            close_file();
        }
    }
}

/* A pseudo-random number below n. */
static size_t random_below(size_t n) {
    static uint64_t seed = 1;
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(seed >> 33) % n;
}

TEST_WITH(no_damage_of_a_header_does_harm, set_up, tear_down) {
    const struct fixture *const f = *state;
    enum { N_DAMAGES = 20000, MAX_BYTES = 8192 };
    static unsigned char whole[MAX_BYTES], damaged[MAX_BYTES];
    assert_int_equal(write_file(f->path, false), STATUS_OK);
    FILE *const file = fopen(f->path, "rb");
    const size_t size = fread(whole, 1, MAX_BYTES, file);
    fclose(file);
    assert_in_range(size, 1000, MAX_BYTES - 1);
    const int descriptor = open(f->path, O_WRONLY);
    const size_t header = 1200;  // bytes that are not the space kept for more attributes
    int n_read = 0;
    for (int i = 0; i < N_DAMAGES; i++) {
        memcpy(damaged, whole, size);
        static const unsigned char bytes[] = {0, 1, 2, 0x7f, 0x80, 0xff};
        for (size_t n = 1 + random_below(3); n > 0; n--) {
            unsigned char *const byte = &damaged[4 + random_below(header - 4)];
            const unsigned flipped = *byte ^ 1u << random_below(8);
            *byte = random_below(2) ? bytes[random_below(6)] : (unsigned char)flipped;
        }
        assert_int_equal(pwrite(descriptor, damaged, size, 0), size);
        struct netcdf_reader reader;
        if (open_file(&reader, f->path) != STATUS_OK) continue;
        double speed[N_ROWS * N_FISH];
        char names[N_FISH * 5], *title;
        const struct netcdf_slice all[] = {{"time", 0, N_ROWS}, {"fish", 0, N_FISH}, {NULL}};
        const struct netcdf_slice of_names[] = {all[1], {"name", 0, 5}, {NULL}};
        n_read += netcdf_read_doubles(&reader, "speed", all, speed) == STATUS_OK;
        netcdf_read_text(&reader, "names", of_names, names);
        netcdf_attribute(&reader, "title", &title);
        close_file();
    }
    close(descriptor);
    // most bytes belong to strings
    assert_in_range(n_read, 1, N_DAMAGES - 1);
}
