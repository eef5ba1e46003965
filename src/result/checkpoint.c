/* checkpoint.c: first sections for data besides the state, then one section for each row of the table of the state. */
#include "result/checkpoint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/version.h"
#include "result/durable.h"
#include "result/sections.h"
#include "result/target.h"
#include "state/state.h"

// ---- data besides the state: strings and numbers, each a section

#define PLACE(field) offsetof(struct checkpoint, field), sizeof(((struct checkpoint *)0)->field)

static const struct string {
    const char *name;
    size_t offset;
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
    {"residual_evaluations", PLACE(totals.residual_evaluations)},
    {"newton_iterations", PLACE(totals.newton_iterations)},
    {"jacobian_evaluations", PLACE(totals.jacobian_evaluations)},
    {"error_test_failures", PLACE(totals.error_test_failures)},
    {"convergence_failures", PLACE(totals.convergence_failures)},
    {"step_size", PLACE(totals.step_size)},
    {"order", PLACE(totals.order)},
};
enum { N_NUMBERS = sizeof numbers / sizeof *numbers };

static char **string_of(struct checkpoint *checkpoint, int i) {
    return (char **)(void *)((char *)checkpoint + strings[i].offset);
}

static char *checkpoint_number_of(struct checkpoint *checkpoint, int i) {
    return (char *)checkpoint + numbers[i].offset;
}

// ---- writing

enum status checkpoint_write(const char *path, const char *previous, const struct checkpoint *checkpoint,
                             const struct state *state, const struct school *school) {
    char program[VERSION_LENGTH], libraries[VERSION_LENGTH], processor[VERSION_LENGTH];
    snprintf(program, sizeof program, "%s", version_short());
    version_libraries(libraries);
    version_processor(processor);
    struct checkpoint all = *checkpoint;
    all.program = program;
    all.libraries = libraries;
    all.processor = processor;
    struct sections_writer writer;
    sections_start(&writer);

    for (int i = 0; i < N_STRINGS; i++) {
        sections_open(&writer, strings[i].name);
        sections_add(&writer, *string_of(&all, i), strlen(*string_of(&all, i)));
        sections_close(&writer);
    }

    for (int i = 0; i < N_NUMBERS; i++) {
        sections_open(&writer, numbers[i].name);
        sections_add(&writer, checkpoint_number_of(&all, i), numbers[i].size);
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

    enum status status = sections_finish(&writer);
    if (status == STATUS_OK) status = durable_replace(path, previous, writer.bytes, writer.n);
    sections_free(&writer);
    return status;
}

// ---- reading

void checkpoint_free(struct checkpoint *checkpoint) {
    for (int i = 0; i < N_STRINGS; i++) free(*string_of(checkpoint, i));
    free(checkpoint->bytes);
    *checkpoint = (struct checkpoint){0};
}

// Fail on a section that no program can have written.
static enum status unfit(const char *name) {
    return status_fail(STATUS_FILE, "section '%s' is invalid", name);
}

static enum status checkpoint_read_string(struct checkpoint *checkpoint, int i) {
    struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, strings[i].name);
    char *string;
    TRY(MEMORY_NEW(string, section.left + 1, "a checkpoint"));
    sections_take(&section, string, section.left);
    *string_of(checkpoint, i) = string;
    return section.is_short ? unfit(strings[i].name) : STATUS_OK;
}

static enum status checkpoint_read_number(const struct checkpoint *checkpoint, const char *name, void *to,
                                          size_t size) {
    struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, name);
    sections_take(&section, to, size);
    return section.is_short || section.left > 0 ? unfit(name) : STATUS_OK;
}

static enum status checkpoint_read_all(struct checkpoint *checkpoint) {
    TRY(sections_check(checkpoint->bytes, checkpoint->n));
    for (int i = 0; i < N_STRINGS; i++) TRY(checkpoint_read_string(checkpoint, i));
    for (int i = 0; i < N_NUMBERS; i++) {
        TRY(checkpoint_read_number(checkpoint, numbers[i].name, checkpoint_number_of(checkpoint, i), numbers[i].size));
    }
    TRY(checkpoint_read_number(checkpoint, "t", &checkpoint->t, sizeof checkpoint->t));
    if (!isfinite(checkpoint->wall_time)) return unfit("wall_time");
    if (!isfinite(checkpoint->totals.step_size)) return unfit("step_size");
    if (strchr(checkpoint->result, '/') || checkpoint->rows.n_rows < 0) return unfit("result");
    return STATUS_OK;
}

enum status checkpoint_read(struct checkpoint *checkpoint, const char *path) {
    *checkpoint = (struct checkpoint){0};
    TRY(durable_read(path, &checkpoint->bytes, &checkpoint->n));
    const enum status status = checkpoint_read_all(checkpoint);
    if (status == STATUS_OK) return STATUS_OK;
    checkpoint_free(checkpoint);
    return status_fail(status, "%s: cannot be used: %s", path, status_message());
}

enum status checkpoint_check_program(const struct checkpoint *checkpoint) {
    char libraries[VERSION_LENGTH];
    version_libraries(libraries);
    const int is_other_program = strcmp(checkpoint->program, version_short()) != 0;
    if (!is_other_program && strcmp(checkpoint->libraries, libraries) == 0) return STATUS_OK;
    return status_fail(
        STATUS_FILE, "written by %s, but this program is %s: resume with that program, or run the case again",
        is_other_program ? checkpoint->program : checkpoint->libraries, is_other_program ? version_short() : libraries);
}

// the values of one row of the table
static enum status take_row(const struct checkpoint *checkpoint, const struct state_row *row, struct state *state,
                            const struct school *school) {
    struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, row->name);
    for (int f = 0; f < state_table_n_owners(row, school) && !section.is_short; f++) {
        const size_t bytes = state_table_length(row, state, school, f) * state_table_size(row);
        if (bytes > 0) sections_take(&section, state_table_place(row, state, f), bytes);
    }
    return section.is_short || section.left > 0 ? unfit(row->name) : STATUS_OK;
}

// numbers of vortices or of samples that no file of this size can have
static enum status check_numbers(const struct checkpoint *checkpoint, const struct state *state,
                                 const struct school *school) {
    for (int f = 0; f < school->n_fish; f++) {
        const int n_vortices = state->wake[f].n_vortex, n_slots = state->history[f].n_slots;
        if (n_vortices < 0 || (size_t)n_vortices > checkpoint->n / sizeof(double)) return unfit("wake.n_vortex");
        if (n_slots < 0 || (size_t)n_slots > checkpoint->n / sizeof(struct sample)) return unfit("history.n_slots");
    }
    return STATUS_OK;
}

enum status checkpoint_set_state(const struct checkpoint *checkpoint, struct state *state,
                                 const struct school *school) {
    for (int i = 0; i < state_table_n; i++) {
        const struct state_row *const row = &state_table[i];
        if (row->type == STATE_UNKEPT) continue;
        TRY(take_row(checkpoint, row, state, school));
        if (strcmp(row->name, "wake.n_vortex") != 0 && strcmp(row->name, "history.n_slots") != 0) continue;
        TRY(check_numbers(checkpoint, state, school));
        TRY(state_table_make_room(state, school));
    }

    return state_table_check(state, school);
}

// ---- files

enum status checkpoint_check_target(const char *path, const char *result) {
    struct checkpoint there;
    TRY(target_check(path, TARGET_CHECKPOINT, true));
    if (access(path, F_OK) != 0) return STATUS_OK;
    const enum status status = checkpoint_read(&there, path);

    // a damaged one is of no use to anybody
    if (status != STATUS_OK) return status == STATUS_MEMORY ? status : STATUS_OK;
    const bool is_of_result = strcmp(there.result, result) == 0;

    if (!is_of_result) {
        status_fail(STATUS_FILE,
                    "%s is a checkpoint of %s and would be replaced by this run: choose another name with -o", path,
                    there.result);
    }

    checkpoint_free(&there);
    return is_of_result ? STATUS_OK : STATUS_FILE;
}

// ---- summary

static void print_row(const struct checkpoint *checkpoint, const struct state_row *row, FILE *stream) {
    const struct section_reader section = sections_find(checkpoint->bytes, checkpoint->n, row->name);
    fprintf(stream, "  %-24s %10zu  %08x\n", row->name, section.left / state_table_size(row), section.check);
}

static void print_summary(const struct checkpoint *checkpoint, FILE *stream) {
    fprintf(stream, "a run at t = %.10g s; the result is %s, with %ld rows up to this time\n", checkpoint->t,
            checkpoint->result, checkpoint->rows.n_rows);
    fprintf(stream, "made by    %s\n           %s\non         %s\n", checkpoint->program, checkpoint->libraries,
            checkpoint->processor);
    if (*checkpoint->places) fprintf(stream, "places     --checkpoint-at %s\n", checkpoint->places);
    fprintf(stream, "so far     %ld steps, %ld residuals, %ld Jacobians in %.4g s\n\n", checkpoint->totals.steps,
            checkpoint->totals.residual_evaluations, checkpoint->totals.jacobian_evaluations, checkpoint->wall_time);
    fprintf(stream, "  %-24s %10s  %s\n", "state", "values", "checksum");
    for (int i = 0; i < state_table_n; i++) {
        if (state_table[i].type != STATE_UNKEPT) print_row(checkpoint, &state_table[i], stream);
    }
}

enum status checkpoint_info(const char *path, bool case_only, FILE *stream) {
    struct checkpoint checkpoint;
    TRY(checkpoint_read(&checkpoint, path));
    if (case_only) {
        fputs(checkpoint.effective, stream);
    } else {
        fprintf(stream, "%s: ", path);
        print_summary(&checkpoint, stream);
    }

    checkpoint_free(&checkpoint);
    return STATUS_OK;
}
