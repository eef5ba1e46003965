/* checkpoint.h: the file from which a stopped run continues (doc/reliability.md). It holds everything about a run that
 * the result file lacks, and the table of the state (state/state.h) drives how it is written, read and summarised.
 * Tested by tests/result/test_checkpoint.c. */
#ifndef CHECKPOINT_H
#define CHECKPOINT_H

#include <stdbool.h>
#include <stdio.h>

#include "base/arena.h"
#include "base/status.h"
#include "result/result_file.h"
#include "solver/integrator.h"
#include "state/state.h"

/* The data of a checkpoint besides the state. */
struct checkpoint {
    const char *program, *libraries, *processor; /* that wrote the checkpoint */
    const char *effective;                       /* the complete case (case_show) */
    const char *result;                          /* name of the result file, which is in the same folder */
    const char *places;                          /* additional times of checkpoints, s: "0.3,1.25", or "" */
    struct result_mark rows;                     /* the rows of the result before the checkpoint */
    struct integrator_counts totals;
    double wall_time; /* since the start of the run, s */
    double t;         /* of the state, s */
    unsigned char *bytes;
    size_t n; /* the whole file, after checkpoint_read */
};

/* Write the checkpoint of a state, as durable_replace does. Uses effective, result, places, rows, totals and wall_time
 * of *checkpoint. arena: for scratch. Fails with STATUS_FILE. */
enum status checkpoint_write(struct arena *arena, const char *path, const char *previous,
                             const struct checkpoint *checkpoint, const struct state *state,
                             const struct school *school);

/* Read a checkpoint, which is a part of the arena. Fails with STATUS_FILE and the reason for a file that is no
 * checkpoint, incomplete or of another format. */
enum status checkpoint_read(struct arena *arena, struct checkpoint *checkpoint, const char *path);

/* Fail with STATUS_FILE unless this program, with these libraries, made the checkpoint. */
enum status checkpoint_check_program(const struct checkpoint *checkpoint);

/* Set a state of the case of the checkpoint. Fails with STATUS_FILE if a section is invalid; the state
 * can then only be freed. */
enum status checkpoint_set_state(const struct checkpoint *checkpoint, struct state *state, const struct school *school);

/* Fail with STATUS_FILE if the file at path is anything but a checkpoint of the result of this name. arena: for
 * scratch. */
enum status checkpoint_check_target(struct arena *arena, const char *path, const char *result);

/* Print a summary of a checkpoint in five lines, this and a line for each variable of the state, or only the case in
 * the checkpoint. arena: for scratch. Fails as checkpoint_read. */
enum checkpoint_part { CHECKPOINT_SUMMARY, CHECKPOINT_STATE, CHECKPOINT_CASE };
enum status checkpoint_info(struct arena *arena, const char *path, enum checkpoint_part part, FILE *stream);

#endif
