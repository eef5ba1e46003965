/* study_slurm.h: a study as an array job of Slurm. Tested by tests/slurm/test_slurm.sh and
 * tests/study/test_study.sh. */
#ifndef STUDY_SLURM_H
#define STUDY_SLURM_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"

/* Write the files for a cluster into the folder: study.yaml (the whole study in one file), array.sbatch (the members,
 * bundle members per task; bundle 0: the fewest members per task with at most 1000 tasks), gather.sbatch, and
 * submit.sh, which submits both jobs. Fails with STATUS_CASE or STATUS_FILE. */
enum status study_slurm(const struct case_values *study, const char *folder, int bundle, FILE *stream);

#endif
