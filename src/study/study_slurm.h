/* study_slurm.h: a study as an array job of Slurm. Tested by tests/slurm/test_slurm.sh and
 * tests/study/test_study.sh. */
#ifndef STUDY_SLURM_H
#define STUDY_SLURM_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"

/* Write what a cluster needs into the folder: study.yaml (the whole study in one file), array.sbatch (its members,
 * bundle of them a task; 0: one, or so many that there are no more than 1000 tasks), gather.sbatch, and submit.sh that
 * submits both. Fails with STATUS_CASE or STATUS_FILE. */
enum status study_slurm(const struct case_values *study, const char *folder, int bundle, FILE *stream);

#endif
