/* fuzz_result.c: any bytes as the file of a run, a study or a field: all that reads such files reads this one. */
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fuzz.h"
#include "result/result_info.h"
#include "result/result_kind.h"
#include "result/result_reader.h"
#include "study/member_file.h"
#include "study/study_file.h"
#include "view/field_file.h"

static char path[64];

static void remove_file(void) {
    unlink(path);
}

// a file of this process in memory
static void write_file(const uint8_t *bytes, size_t n) {
    if (!*path) {
        snprintf(path, sizeof path, "/dev/shm/shoal-fuzz-%ld.nc", (long)getpid());
        atexit(remove_file);
    }
    const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || write(file, bytes, n) != (ssize_t)n || close(file) != 0) abort();
}

// refused, if at all, as a file
static void demand_file(enum status status) {
    if (status == STATUS_OK || status == STATUS_FILE || status == STATUS_CASE) return;
    fprintf(stderr, "refused with status %d: %s\n", status, status_message());
    abort();
}

static void read_rows(void) {
    struct arena *const arena = arena_create(NULL, "a test");
    struct result_reader *reader;
    const enum status status = result_reader_open(arena, &reader, path);
    demand_file(status);
    for (int i = 0; status == STATUS_OK && i < result_table_n; i++) {
        double *values;
        if (result_table[i].type != RESULT_TEXT) result_reader_new(arena, reader, result_table[i].name, 0, &values);
    }
    arena_free(arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n) {
    static FILE *nowhere;
    if (!nowhere) nowhere = fopen("/dev/null", "w");
    if (!nowhere) abort();
    write_file(bytes, n);
    struct arena *const arena = arena_create(NULL, "a test");
    demand_file(netcdf_print(arena, path, result_info, nowhere));
    demand_file(netcdf_print(arena, path, study_info, nowhere));
    demand_file(netcdf_print(arena, path, field_file_info, nowhere));
    struct member_file member;
    demand_file(member_file_read(arena, &member, path));
    arena_free(arena);
    read_rows();
    return 0;
}
