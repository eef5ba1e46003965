/* fuzz_checkpoint.c: Any bytes are tried as a checkpoint. They are either refused or read into the state of the case in
 * them. Few changes get past the checksums, so every input is tried a second time with checksums that fit. */
#include <string.h>
#include <zlib.h>

#include "case/case.h"
#include "fish/fish.h"
#include "fish/fish_school.h"
#include "fuzz.h"
#include "result/checkpoint.h"
#include "result/sections.h"
#include "state/state.h"

enum {
    SIZE_AT = 16, /* in the header of all: the bytes of the file, then the checksum (sections.h) */
    CHECK_AT = 24,
    HEADER = 28,
    SECTION = SECTIONS_NAME + 8, /* the header of a section */
    CHECK = 4
};

static void set_check(uint8_t *bytes, size_t n) {
    const uint32_t check = (uint32_t)crc32_z(0, bytes, n);
    memcpy(bytes + n, &check, sizeof check);
}

// sizes and checksums as they should be for the bytes there are
static void repair(uint8_t *bytes, size_t n) {
    if (n < HEADER) return;
    const uint64_t all = n;
    memcpy(bytes + SIZE_AT, &all, sizeof all);
    set_check(bytes, CHECK_AT);
    for (size_t at = HEADER; n - at >= SECTION + CHECK;) {
        const uint64_t room = n - at - SECTION - CHECK;
        uint64_t size;
        memcpy(&size, bytes + at + SECTIONS_NAME, sizeof size);
        if (size > room) size = room;
        memcpy(bytes + at + SECTIONS_NAME, &size, sizeof size);
        set_check(bytes + at, SECTION + (size_t)size);
        at += SECTION + (size_t)size + CHECK;
    }
}

static bool is_small(const struct school_parameters *school) {
    int n = 0;
    for (int f = 0; f < school->n_fish; f++) n += school->fish[f].nodes + school->fish[f].sheet_points;
    return n < 200;
}

// the state of the case that a checkpoint holds
static void read_state(const struct checkpoint *checkpoint) {
    struct case_values values;
    const char *const text = checkpoint->effective;
    enum status status = case_parse(&values, text, strlen(text), "fuzz", NULL, 0, NULL);
    fuzz_demand_refusal(status);
    if (status != STATUS_OK) return;
    struct school *school = NULL;
    struct state *state = NULL;
    if (is_small(&values.school) && (status = fish_school_create(NULL, &school, &values.school)) == STATUS_OK) {
        state = state_create(NULL, school);
        status = checkpoint_set_state(checkpoint, state, school);
    }
    fuzz_demand_refusal(status);
    state_free(state);
    fish_school_free(school);
    case_free(&values);
}

static void try(const uint8_t *bytes, size_t n) {
    fuzz_write(bytes, n);
    struct arena *const arena = arena_create(NULL, "a test");
    fuzz_demand_refusal(checkpoint_info(arena, fuzz_path, CHECKPOINT_STATE, fuzz_nowhere()));
    struct checkpoint checkpoint;
    const enum status status = checkpoint_read(arena, &checkpoint, fuzz_path);
    fuzz_demand_refusal(status);
    if (status == STATUS_OK) {
        fuzz_demand_refusal(checkpoint_check_program(&checkpoint));
        read_state(&checkpoint);
    }
    arena_free(arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n) {
    try(bytes, n);
    uint8_t *const repaired = malloc(n + 1);
    if (!repaired) abort();
    memcpy(repaired, bytes, n);
    repair(repaired, n);
    try(repaired, n);
    free(repaired);
    return 0;
}
