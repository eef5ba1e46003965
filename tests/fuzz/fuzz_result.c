/* fuzz_result.c: Any bytes are tried as the file of a run, a study or a field, by everything that reads such files. */
#include "fuzz.h"
#include "result/result_info.h"
#include "result/result_kind.h"
#include "result/result_reader.h"
#include "study/member_file.h"
#include "study/study_file.h"
#include "view/field_file.h"

static void read_rows(void) {
    struct arena *const arena = arena_create(NULL, "a test");
    struct result_reader *reader;
    const enum status status = result_reader_open(arena, &reader, fuzz_path);
    fuzz_demand_refusal(status);
    for (int i = 0; status == STATUS_OK && i < result_table_n; i++) {
        double *values;
        if (result_table[i].type != RESULT_TEXT) result_reader_new(arena, reader, result_table[i].name, 0, &values);
    }
    arena_free(arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n) {
    fuzz_write(bytes, n);
    struct arena *const arena = arena_create(NULL, "a test");
    fuzz_demand_refusal(netcdf_print(arena, fuzz_path, result_info, fuzz_nowhere()));
    fuzz_demand_refusal(netcdf_print(arena, fuzz_path, study_info, fuzz_nowhere()));
    fuzz_demand_refusal(netcdf_print(arena, fuzz_path, field_file_info, fuzz_nowhere()));
    struct member_file member;
    fuzz_demand_refusal(member_file_read(arena, &member, fuzz_path));
    arena_free(arena);
    read_rows();
    return 0;
}
