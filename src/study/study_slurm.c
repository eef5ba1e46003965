/* study_slurm.c: a study as an array job of Slurm. */
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "case/case.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "study/study.h"
#include "study/study_folder.h"

enum { MAX_TASKS = 1000 /* Slurm's own default is 1001 */ };

/* A file of the folder and the path of the file. */
struct script {
    struct plain_file file;
    char path[PATH_MAX];
};

/* Open a file of the folder for writing and write the mark of the program. */
static enum status script_open(struct script *script, const char *folder, const char *name, bool is_script) {
    if (snprintf(script->path, sizeof script->path, "%s/%s", folder, name) >= (int)sizeof script->path) {
        return status_fail(STATUS_FILE, "%s: name too long", folder);
    }

    if (access(script->path, F_OK) == 0 && !target_is(script->path, TARGET_SCRIPT)) {
        return status_fail(STATUS_FILE,
                           "%s exists and was not written by shoal study --slurm: remove it, or choose another folder "
                           "with -o",
                           script->path);
    }

    TRY(plain_file_open(&script->file, script->path, TARGET_SCRIPT, true, is_script ? 0777 : 0666));
    fputs(is_script ? "#!/bin/sh\n" TARGET_SCRIPT_MARK "\n" : TARGET_SCRIPT_MARK "\n", script->file.stream);
    return STATUS_OK;
}

static enum status study_slurm_write_array(const struct case_values *study, const char *folder, const char *program,
                                           int n_tasks, int bundle) {
    struct script script;
    TRY(script_open(&script, folder, "array.sbatch", true));
    fprintf(
        script.file.stream,
        "#SBATCH --job-name='%s'\n"
        "#SBATCH --array=0-%d\n"
        "#SBATCH --ntasks=1\n"
        "#SBATCH --cpus-per-task=%d\n"
        "#SBATCH --signal=B:TERM@60\n"
        "#SBATCH --requeue\n"
        "#SBATCH --open-mode=append\n"
        "#SBATCH --output='%s/task-%%a.log'\n"
        "# Each task runs %d of the %d members. One minute before the time limit the members stop with checkpoints,\n"
        "# and the task is requeued and resumes.\n"
        "first=$((SLURM_ARRAY_TASK_ID * %d))\n"
        "last=$((first + %d))\n"
        "[ $last -lt %d ] || last=%d\n"
        "'%s' study '%s/study.yaml' -o '%s' --members $first-$last -j 1 &\n"
        "process=$!\n"
        "trap 'kill -TERM $process' TERM\n"
        "code=0\n"
        "wait $process || code=$?\n"
        "# a signal interrupts wait before the process ends\n"
        "while kill -0 $process 2>/dev/null; do code=0; wait $process || code=$?; done\n"
        "[ $code -ne 75 ] || scontrol requeue $SLURM_JOB_ID\n"
        "exit $code\n",
        study->name, n_tasks - 1, study->school.threads, folder, bundle, sweep_n_members(study), bundle, bundle - 1,
        sweep_n_members(study), sweep_n_members(study) - 1, program, folder, folder);

    return plain_file_close(&script.file, STATUS_OK);
}

enum status study_slurm(struct arena *arena, const struct case_values *study, const char *folder, int bundle,
                        FILE *stream) {
    const int n = sweep_n_members(study);
    if (bundle < 1) bundle = (n + MAX_TASKS - 1) / MAX_TASKS;
    const int n_tasks = (n + bundle - 1) / bundle;
    for (int m = 0; m < n; m++) {
        struct arena *const scratch = arena_create(arena, "a member of a study");
        struct case_values *member;
        TRY(study_folder_case(scratch, &member, study, m));
        arena_free(scratch);
    }

    char place[PATH_MAX], program[PATH_MAX];
    TRY(study_folder_create(folder));
    if (!realpath(folder, place) || !realpath("/proc/self/exe", program)) {
        return status_fail(STATUS_FILE, "%s: cannot resolve the full path: %s", folder, strerror(errno));
    }

    if (strpbrk(place, "'\n\"") || strpbrk(program, "'\n\"") || strpbrk(study->name, "'\n\"")) {
        return status_fail(
            STATUS_CASE,
            "%s: the path of the folder, the path of the program and the name of the case must not contain quotes or "
            "line breaks",
            place);
    }

    struct script script;
    TRY(script_open(&script, place, "study.yaml", false));
    fputs(study->merged, script.file.stream);
    TRY(plain_file_close(&script.file, STATUS_OK));
    TRY(study_slurm_write_array(study, place, program, n_tasks, bundle));

    // the job that gathers the results, and the script that submits both jobs
    TRY(script_open(&script, place, "gather.sbatch", true));
    fprintf(script.file.stream,
            "#SBATCH --job-name='%s-gather'\n"
            "#SBATCH --ntasks=1\n"
            "#SBATCH --output='%s/study.txt'\n"
            "exec '%s' gather '%s'\n",
            study->name, place, program, place);
    TRY(plain_file_close(&script.file, STATUS_OK));
    TRY(script_open(&script, place, "submit.sh", true));
    fprintf(script.file.stream,
            "# Submit the members as an array job, then the job that gathers the results after the last member.\n"
            "set -eu\n"
            "folder='%s'\n"
            "array=$(sbatch --parsable \"$@\" \"$folder/array.sbatch\")\n"
            "gather=$(sbatch --parsable --dependency=\"afterany:$array\" \"$folder/gather.sbatch\")\n"
            "printf '%%s\\n' \"members: job $array; results: job $gather, $folder/study.txt and study.nc\"\n",
            place);
    TRY(plain_file_close(&script.file, STATUS_OK));
    fprintf(stream, "%d member%s in %d task%s; start them with %s/submit.sh\n", n, n == 1 ? "" : "s", n_tasks,
            n_tasks == 1 ? "" : "s", folder);

    return STATUS_OK;
}
