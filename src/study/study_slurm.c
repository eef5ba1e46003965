/* study_slurm.c: runs a study as an array job of Slurm. */
#include "study/study_slurm.h"

#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
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

/* A path in a pattern of sbatch: each % twice. */
static char *pattern_of(struct arena *arena, const char *path) {
    struct text text = {.arena = arena};
    for (const char *c = path; *c; c++) text_add(&text, *c == '%' ? "%%%%" : "%c", *c);
    return text.text;
}

/* options: with the full path of the folder */
static enum status study_slurm_write_array(struct arena *arena, const struct case_values *study,
                                           const struct study_options *options, const char *program, int n_tasks,
                                           int bundle) {
    const char *const folder = options->folder;
    const int n_processes = options->n_processes > 0 ? options->n_processes : 1;
    struct text more = {.arena = arena};
    text_add(&more, "-j %d", n_processes);
    if (options->limit > 0) {
        text_add(&more, " --limit ");
        text_add_number(&more, options->limit);
    }
    if (options->force) text_add(&more, " --force");
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
        "'%s' study '%s/study.yaml' -o '%s' --members $first-$last %s &\n"
        "process=$!\n"
        "trap 'kill -TERM $process' TERM\n"
        "code=0\n"
        "wait $process || code=$?\n"
        "# a signal interrupts wait before the process ends\n"
        "while kill -0 $process 2>/dev/null; do code=0; wait $process || code=$?; done\n"
        "[ $code -ne 75 ] || scontrol requeue $SLURM_JOB_ID\n"
        "exit $code\n",
        study->name, n_tasks - 1, n_processes * study->school.threads, pattern_of(arena, folder), bundle,
        sweep_n_members(study), bundle, bundle - 1, sweep_n_members(study), sweep_n_members(study) - 1, program, folder,
        folder, more.text);

    return plain_file_close(&script.file, STATUS_OK);
}

enum status study_slurm(struct arena *arena, const struct case_values *study, const struct study_options *options,
                        int bundle, bool strict, FILE *stream) {
    const char *const folder = options->folder;
    const int n = sweep_n_members(study);
    if (bundle < 1) bundle = (n + MAX_TASKS - 1) / MAX_TASKS;
    const int n_tasks = (n + bundle - 1) / bundle;
    struct study_plan plan;
    TRY(study_plan_create(arena, &plan, study, options));

    char place[PATH_MAX], program[PATH_MAX];
    TRY(study_folder_create(folder));
    if (!realpath(folder, place) || !realpath("/proc/self/exe", program)) {
        return status_fail(STATUS_FILE, "%s: cannot resolve the full path: %s", folder, strerror(errno));
    }

    static const char special[] = "'\n\"\\";
    if (strpbrk(place, special) || strpbrk(program, special) || strpbrk(study->name, special)) {
        return status_fail(
            STATUS_CASE,
            "%s: the path of the folder, the path of the program and the name of the case must not contain quotes, "
            "backslashes or line breaks",
            place);
    }

    struct script script;
    TRY(script_open(&script, place, "study.yaml", false));
    fputs(study->merged, script.file.stream);
    TRY(plain_file_close(&script.file, STATUS_OK));
    struct study_options of_tasks = *options;
    of_tasks.folder = place;
    TRY(study_slurm_write_array(arena, study, &of_tasks, program, n_tasks, bundle));

    // the job that gathers the results, and the script that submits both jobs
    TRY(script_open(&script, place, "gather.sbatch", true));
    fprintf(script.file.stream,
            "#SBATCH --job-name='%s-gather'\n"
            "#SBATCH --ntasks=1\n"
            "#SBATCH --output='%s/study.txt'\n"
            "exec '%s' gather '%s'%s\n",
            study->name, pattern_of(arena, place), program, place, strict ? " --strict" : "");
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
    if (plan.n_done > 0) fprintf(stream, "%d members are finished and will not run again; ", plan.n_done);
    fprintf(stream, "%d member%s in %d task%s; start them with %s/submit.sh\n", n, n == 1 ? "" : "s", n_tasks,
            n_tasks == 1 ? "" : "s", folder);

    return STATUS_OK;
}
