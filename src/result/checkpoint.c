/* checkpoint.c: a checkpoint begins with sections for what is not the state; then one section follows for each row of
 * the table of the state. */
#include "result/checkpoint.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#include "base/version.h"
#include "result/durable.h"
#include "result/sections.h"
#include "result/target.h"
#include "state/state.h"

// ---- data besides the state: strings and numbers, each a section

#define PLACE(field) offsetof(struct checkpoint, field), sizeof(((struct checkpoint *)0)->field)

static const struct string {
    const char *name;
    size_t offset; /* of a const char * */
} strings[] = {
    {"program", offsetof(struct checkpoint, program)},     {"libraries", offsetof(struct checkpoint, libraries)},
    {"processor", offsetof(struct checkpoint, processor)}, {"case", offsetof(struct checkpoint, effective)},
    {"result", offsetof(struct checkpoint, result)},       {"places", offsetof(struct checkpoint, places)},
};
enum { N_STRINGS = sizeof strings / sizeof *strings };

static const struct number {
    const char *name;
    size_t offset, size;
} numbers[] = {
    {"rows", PLACE(rows.n_rows)},
    {"rows.check", PLACE(rows.check)},
    {"wall_time", PLACE(wall_time)},
    {"steps", PLACE(totals.steps)},
    {"steps_of_order", PLACE(totals.steps_of_order)},
    {"residual_evaluations", PLACE(totals.residual_evaluations)},
    {"newton_iterations", PLACE(totals.newton_iterations)},
    {"jacobian_evaluations", PLACE(totals.jacobian_evaluations)},
    {"klu_analyses", PLACE(totals.klu_analyses)},
    {"klu_factorisations", PLACE(totals.klu_factorisations)},
    {"klu_refactorisations", PLACE(totals.klu_refactorisations)},
    {"gmres_iterations", PLACE(totals.gmres_iterations)},
    {"error_test_failures", PLACE(totals.error_test_failures)},
    {"convergence_failures", PLACE(totals.convergence_failures)},
    {"initial_iterations", PLACE(totals.initial_iterations)},
    {"jacobian_non_zeros", PLACE(totals.jacobian_non_zeros)},
    {"factor_non_zeros", PLACE(totals.factor_non_zeros)},
    {"step_size", PLACE(totals.step_size)},
    {"order", PLACE(totals.order)},
};
enum { N_NUMBERS = sizeof numbers / sizeof *numbers };

// The place of an entry of the tables in a checkpoint.
static void *checkpoint_place(struct checkpoint *checkpoint, size_t offset) {
    return (char *)checkpoint + offset;
}

// ---- writing

enum status checkpoint_write(struct arena *arena, const char *path, const char *previous,
                             const struct checkpoint *checkpoint, const struct state *state,
                             const struct school *school) {
    struct arena *const scratch = arena_create(arena, "a checkpoint");
    char program[VERSION_LENGTH], libraries[VERSION_LENGTH], processor[VERSION_LENGTH];
    snprintf(program, sizeof program, "%s", version_short());
    version_libraries(libraries);
    version_processor(processor);
    struct checkpoint all = *checkpoint;
    all.program = program;
    all.libraries = libraries;
    all.processor = processor;
    struct sections_writer writer;
    sections_start(scratch, &writer);

    for (int i = 0; i < N_STRINGS; i++) {
        const char *const string = *(const char **)checkpoint_place(&all, strings[i].offset);
        sections_open(&writer, strings[i].name);
        sections_add(&writer, string, strlen(string));
        sections_close(&writer);
    }

    for (int i = 0; i < N_NUMBERS; i++) {
        sections_open(&writer, numbers[i].name);
        sections_add(&writer, checkpoint_place(&all, numbers[i].offset), numbers[i].size);
        sections_close(&writer);
    }

    // write the state, row by row of the table
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT) continue;
        sections_open(&writer, row->name);
        for (int f = 0; f < state_table_n_owners(row, school); f++) {
            const size_t bytes = state_table_length(row, state, school, f) * state_table_size(row);
            sections_add(&writer, state_table_values(row, state, f), bytes);
        }
        sections_close(&writer);
    }

    sections_finish(&writer);
    const enum status status = durable_replace(path, previous, writer.bytes, writer.n);
    arena_free(scratch);
    return status;
}

// ---- reading

// Fail on a section that no program can have written.
static enum status unfit(const char *name) {
    return status_fail(STATUS_FILE, "section '%s' is invalid", name);
}

static enum status checkpoint_read_all(struct arena *arena, struct checkpoint *checkpoint) {
    TRY(sections_check(checkpoint->bytes, checkpoint->n));

    for (int i = 0; i < N_STRINGS; i++) {
        char *string;
        struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, strings[i].name);
        NEW(arena, string, section.left + 1);
        sections_take(&section, string, section.left);
        *(const char **)checkpoint_place(checkpoint, strings[i].offset) = string;
        if (section.is_short) return unfit(strings[i].name);
    }

    // the numbers, and the time from the state
    for (int i = 0; i <= N_NUMBERS; i++) {
        const struct number number = i < N_NUMBERS ? numbers[i] : (struct number){"t", PLACE(t)};
        struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, number.name);
        sections_take(&section, checkpoint_place(checkpoint, number.offset), number.size);
        if (section.is_short || section.left > 0) return unfit(number.name);
    }

    if (!isfinite(checkpoint->wall_time)) return unfit("wall_time");
    if (!isfinite(checkpoint->totals.step_size)) return unfit("step_size");
    if (strchr(checkpoint->result, '/') || checkpoint->rows.n_rows < 0) return unfit("result");
    return STATUS_OK;
}

enum status checkpoint_read(struct arena *arena, struct checkpoint *checkpoint, const char *path) {
    *checkpoint = (struct checkpoint){0};
    TRY(durable_read(arena, path, &checkpoint->bytes, &checkpoint->n));
    const enum status status = checkpoint_read_all(arena, checkpoint);
    return status == STATUS_OK ? status : status_fail(status, "%s: cannot be used: %s", path, status_message());
}

enum status checkpoint_check_program(const struct checkpoint *checkpoint) {
    char libraries[VERSION_LENGTH];
    version_libraries(libraries);
    const bool is_other_program = strcmp(checkpoint->program, version_short()) != 0;
    if (!is_other_program && strcmp(checkpoint->libraries, libraries) == 0) return STATUS_OK;
    return status_fail(
        STATUS_FILE, "written by %s, but this program is %s: resume with that program, or run the case again",
        is_other_program ? checkpoint->program : checkpoint->libraries, is_other_program ? version_short() : libraries);
}

enum status checkpoint_set_state(const struct checkpoint *checkpoint, struct state *state,
                                 const struct school *school) {
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT) continue;

        // the values of all owners
        struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, row->name);
        for (int f = 0; f < state_table_n_owners(row, school) && !section.is_short; f++) {
            const size_t bytes = state_table_length(row, state, school, f) * state_table_size(row);
            if (bytes > 0) sections_take(&section, state_table_place(row, state, f), bytes);
        }
        if (section.is_short || section.left > 0) return unfit(row->name);

        // refuse numbers of vortices or of samples that no file of this size can have
        if (strcmp(row->name, "wake.n_vortex") != 0 && strcmp(row->name, "history.n_slots") != 0) continue;
        for (int f = 0; f < school->n_fish; f++) {
            const int n_vortices = state->wake[f].n_vortex, n_slots = state->history[f].n_slots;
            if (n_vortices < 0 || (size_t)n_vortices > checkpoint->n / sizeof(double)) return unfit("wake.n_vortex");
            if (n_slots < 0 || (size_t)n_slots > checkpoint->n / sizeof(struct sample)) return unfit("history.n_slots");
        }
        state_table_make_room(state, school);
    }

    return state_table_check(state, school);
}

// ---- files

enum status checkpoint_check_target(struct arena *arena, const char *path, const char *result) {
    struct checkpoint there;
    TRY(target_check(path, TARGET_CHECKPOINT, true));

    // a damaged one is of no use to anybody
    struct arena *const scratch = arena_create(arena, path);
    bool is_other = access(path, F_OK) == 0 && checkpoint_read(scratch, &there, path) == STATUS_OK;
    if (is_other) is_other = strcmp(there.result, result) != 0;
    if (is_other) {
        status_fail(STATUS_FILE,
                    "%s is a checkpoint of %s and would be replaced by this run: choose another name with -o", path,
                    there.result);
    }
    arena_free(scratch);
    return is_other ? STATUS_FILE : STATUS_OK;
}

enum status checkpoint_info(struct arena *arena, const char *path, enum checkpoint_part part, FILE *stream) {
    struct checkpoint all;
    TRY(checkpoint_read(arena, &all, path));
    if (part == CHECKPOINT_CASE) {
        fputs(all.effective, stream);
        return STATUS_OK;
    }

    fprintf(stream, "%s: a run at t = %.10g s; the result is %s, with %ld rows up to this time\n", path, all.t,
            all.result, all.rows.n_rows);
    fprintf(stream, "made by    %s\n           %s\non         %s\n", all.program, all.libraries, all.processor);
    if (*all.places) fprintf(stream, "places     --checkpoint-at %s\n", all.places);
    fprintf(stream, "so far     %ld steps, %ld residuals, %ld Jacobians in %.4g s\n", all.totals.steps,
            all.totals.residual_evaluations, all.totals.jacobian_evaluations, all.wall_time);
    if (part != CHECKPOINT_STATE) return STATUS_OK;

    // the state
    fprintf(stream, "\n  %-24s %10s  %s\n", "state", "values", "checksum");
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT) continue;
        const struct section_reader section = sections_find(all.bytes, all.n, row->name);
        fprintf(stream, "  %-24s %10zu  %08x\n", row->name, section.left / state_table_size(row), section.check);
    }

    return STATUS_OK;
}
