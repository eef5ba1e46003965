/* study_slurm.h: a study as an array job of Slurm. Tested by tests/slurm/test_slurm.sh. */
#ifndef STUDY_SLURM_H
#define STUDY_SLURM_H

#include <stdbool.h>
#include <stdio.h>

#include "study/study.h"

/* Write the files of an array job of Slurm into the folder: study.yaml (the whole study in one file),
 * array.sbatch (the members, bundle members per task; bundle 0: the fewest members per task with at most 1000 tasks),
 * gather.sbatch, and submit.sh, which submits both jobs. The tasks take n_processes, limit and force of the options,
 * the job that gathers takes strict. A folder that study_plan_create refuses gets no script. Fails with STATUS_CASE,
 * STATUS_FILE or STATUS_STOPPED. */
enum status study_slurm(struct arena *arena, const struct case_values *study, const struct study_options *options,
                        int bundle, bool strict, FILE *stream);

#endif
