/* study.c: runs the members of a study in parallel processes. */
#define _DEFAULT_SOURCE  // MAP_ANONYMOUS
#include "study/study.h"

#include <errno.h>
#include <fcntl.h>
#include <omp.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/arena.h"
#include "base/parallel.h"
#include "case/case.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "result/target.h"
#include "run/checkpoints.h"
#include "run/simulate.h"
#include "run/simulate_run.h"
#include "steady/steady.h"
#include "study/study_folder.h"

enum { REASON_BYTES = 2048 };

/* Report of a process to the study, in shared memory. */
struct report {
    double part;                   /* completed part of the run, 0 to 1 */
    double t;                      /* s */
    struct simulate_progress last; /* of a run */
    char reason[REASON_BYTES];
};

/* A slot for one process at a time. */
struct job {
    pid_t process; /* 0: none */
    int member;
    double started; /* by CLOCK_MONOTONIC, s */
    bool is_late;   /* stopped after study_options.limit */
    struct report *report;
};

struct study {
    struct arena *arena;
    const struct case_values *values;
    const struct study_options *options;
    char *lock_path; /* FOLDER/study.lock */
    int lock;        /* descriptor with a lock on the range of the members; -1: none */
    int n_jobs;
    struct job *job;       /* (n_jobs) */
    struct report *report; /* shared memory                                        (n_jobs) */
    struct study_plan plan;
    int n_next; /* index in the plan of the next member to start */
    struct study_progress progress;
    double started; /* by CLOCK_MONOTONIC, s */
    bool is_stopping;
    bool is_masked;             /* SIGCHLD is blocked */
    sigset_t mask;              /* before */
    const struct job *required; /* failed required member; NULL: none */
};

static bool is_stopped(const struct study *study) {
    return study->options->stop && *study->options->stop;
}

// ---- one member, in a separate process

static void member_report_progress(const struct simulate_progress *now, void *data) {
    struct report *const report = data;
    report->part = now->t / now->end;
    report->t = now->t;
    report->last = *now;
}

static void member_report_beats(const struct steady_progress *now, void *data) {
    struct report *const report = data;
    report->part = (double)now->n_beats / now->max_beats;
    report->t = now->t;
}

/* Run a member, resume the member from a checkpoint, or find the steady state of the member: the boundary of the
 * process (base/arena.h). */
static enum status run_member(const struct study *study, const struct job *job) {
    MEMORY_BOUNDARY(STATUS_MEMORY);
    struct arena *const arena = study->arena;
    const char *const folder = study->options->folder, *const command = study->options->command;
    const char *const path = study_folder_member(arena, folder, job->member, ".nc");
    struct case_values *values;
    TRY(study_folder_case(arena, &values, study->values, job->member));
    TRY(parallel_start_threads(values->school.threads));

    // a steady state starts from the steady state of the preceding member, if any
    if (sweep_is_steady(study->values)) {
        const int before = sweep_member_before(study->values, job->member);
        const struct sweep_neighbours *const near = sweep_member_neighbours(study->values, job->member);
        const char *result[SWEEP_NEIGHBOURS];
        for (int i = 0; near && i < near->n; i++) result[i] = study_folder_member(arena, folder, near->value[i], ".nc");
        const struct steady_neighbours neighbours = {
            .state = study_folder_member(arena, folder, before < 0 ? 0 : before, STUDY_FOLDER_STATE),
            .n = near ? near->n : 0,
            .result = result,
            .weight = near ? near->weight : NULL};
        const bool is_start = sweep_member_is_start(study->values, job->member);
        struct steady_options search = {
            .path = path,
            .from = before < 0 ? study->options->from : study_folder_member(arena, folder, before, ".nc"),
            .neighbours = near ? &neighbours : NULL,
            .state = is_start ? study_folder_member(arena, folder, job->member, STUDY_FOLDER_STATE) : NULL,
            .overwrite = 1,
            .command = command,
            .progress = member_report_beats,
            .data = job->report,
            .stop = study->options->stop};
        enum status status = steady_run(values, &search);

        // a neighbour failed, or leads nowhere: start from the speeds and places of the preceding member
        if (near && (status == STATUS_FILE || status == STATUS_SOLVER)) {
            search.neighbours = NULL;
            status = steady_run(values, &search);
        }
        if (status != STATUS_FILE || before < 0) return status;

        // the preceding member failed or has not run: start from the initial values of the case
        search.from = NULL;
        return steady_run(values, &search);
    }

    const struct simulate_options options = {.path = path,
                                             .overwrite = 1,
                                             .command = command,
                                             .progress = member_report_progress,
                                             .data = job->report,
                                             .stop = study->options->stop};
    const char *const effective = case_show(arena, values);
    double t;
    const char *const checkpoint = checkpoints_path(arena, path);
    if (!simulate_can_resume(arena, path, checkpoint, effective, &t)) return simulate_run(values, &options);
    return simulate_resume(checkpoint, &(struct simulate_changes){0}, &options);
}

static enum status member_start(struct study *study, struct job *job) {
    job->member = study->plan.member[study->n_next++];
    job->is_late = false;
    job->started = clock_seconds(CLOCK_MONOTONIC);
    *job->report = (struct report){0};
    const pid_t parent = getpid();
    fflush(NULL);

    // block all signals until the member is ready
    sigset_t all, before;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &before);
    const pid_t process = fork();
    if (process == 0) {
        // the members stop if the study is killed
        prctl(PR_SET_PDEATHSIG, SIGTERM);

        // a study that is stopping has no signal handlers any more
        if (is_stopped(study) || getppid() != parent) _exit(status_exit_code(STATUS_STOPPED));

        // keep the handler after the first SIGINT: a second one, which the whole process group gets, is meant for the
        // study
        struct sigaction action;
        sigaction(SIGINT, NULL, &action);
        action.sa_flags &= ~(int)SA_RESETHAND;
        sigaction(SIGINT, &action, NULL);
        sigprocmask(SIG_SETMASK, &study->mask, NULL);
        const enum status status = run_member(study, job);
        if (status != STATUS_OK) snprintf(job->report->reason, REASON_BYTES, "%s", status_message());
        durable_remove_parts();
        _exit(status_exit_code(status));
    }

    sigprocmask(SIG_SETMASK, &before, NULL);
    if (process < 0) return status_fail(STATUS_FILE, "cannot start a process: %s: use fewer with -j", strerror(errno));
    job->process = process;
    return STATUS_OK;
}

// ---- all members

/* Record the outcome of a member. */
static void member_finish(struct study *study, struct job *job, int outcome) {
    job->process = 0;
    const int code = WIFEXITED(outcome) ? WEXITSTATUS(outcome) : -1;
    if (code == status_exit_code(STATUS_STOPPED) && !job->is_late) return;
    if (code == 0) {
        study->progress.n_done++;
        study_folder_set_reason(study->arena, study->options->folder, job->member, NULL);
        return;
    }

    study->progress.n_failed++;
    if (job->member < study->options->n_required) study->required = job;
    if (job->is_late) {
        // the second line is for a comparison of methods
        const struct simulate_progress *const last = &job->report->last;
        snprintf(job->report->reason, REASON_BYTES, "too slow: at t = %.4g s after %.3g s\n%.9g %ld %ld %ld %ld %.6g",
                 job->report->t, clock_seconds(CLOCK_MONOTONIC) - job->started, last->t, last->steps, last->evaluations,
                 last->newton_iterations, last->jacobians, last->wall_time);
    } else if (WIFSIGNALED(outcome)) {
        snprintf(job->report->reason, REASON_BYTES, "killed by signal %d (%s)", WTERMSIG(outcome),
                 strsignal(WTERMSIG(outcome)));
    }

    if (*job->report->reason == '\0') {
        snprintf(job->report->reason, REASON_BYTES,
                 "a library ended the process with exit code %d: use more memory or fewer threads", code);
    }

    study_folder_set_reason(study->arena, study->options->folder, job->member, job->report->reason);
}

/* Start members until all members have ended. */
static enum status run_until_all_end(struct study *study) {
    sigset_t ended;
    sigemptyset(&ended);
    sigaddset(&ended, SIGCHLD);
    const struct timespec patience = {.tv_nsec = 200000000};
    const double limit = study->options->limit;
    enum status status = STATUS_OK;

    for (;;) {
        // ask processes to stop, but only once: all of them at the end of the study, and those beyond the time limit
        const bool is_end = !study->is_stopping && (is_stopped(study) || study->required || status != STATUS_OK);
        for (int j = 0; j < study->n_jobs; j++) {
            struct job *const job = &study->job[j];
            const bool is_late = limit > 0 && !job->is_late && clock_seconds(CLOCK_MONOTONIC) - job->started > limit;
            if (!job->process || !(is_end || is_late)) continue;
            if (is_late) job->is_late = true;
            kill(job->process, SIGTERM);
        }
        study->is_stopping |= is_end;

        // a member that starts from the result of a running member waits
        for (int j = 0; j < study->n_jobs && !study->is_stopping && status == STATUS_OK; j++) {
            if (study->job[j].process || study->n_next == study->plan.n) continue;
            const int next = study->plan.member[study->n_next], before = sweep_member_before(study->values, next);
            const struct sweep_neighbours *const near = sweep_member_neighbours(study->values, next);
            bool waits = false;
            for (int k = 0; k < study->n_jobs; k++) {
                if (!study->job[k].process) continue;
                waits |= study->job[k].member == before;
                for (int i = 0; near && i < near->n; i++) waits |= study->job[k].member == near->value[i];
            }
            if (!waits) status = member_start(study, &study->job[j]);
        }

        // report the progress: a member is done after the end of the process
        struct study_progress *const progress = &study->progress;
        const double almost = 0.99;
        progress->wall_time = clock_seconds(CLOCK_MONOTONIC) - study->started;
        progress->n_running = 0;
        double work = study->n_next;
        for (int j = 0; j < study->n_jobs; j++) {
            if (!study->job[j].process) continue;
            progress->n_running++;
            work += almost * study->job[j].report->part - 1;
        }
        progress->part = study->plan.n > 0 ? work / study->plan.n : 1;
        if (study->options->progress) study->options->progress(progress, study->options->data);
        if (progress->n_running == 0) return status;

        // collect ended processes
        sigtimedwait(&ended, NULL, &patience);
        for (int j = 0; j < study->n_jobs; j++) {
            int outcome;
            const pid_t process = study->job[j].process;
            if (process && waitpid(process, &outcome, WNOHANG) == process) {
                member_finish(study, &study->job[j], outcome);
            }
        }
    }
}

/* Lock the members, so that no other study runs the same members in the folder. */
static enum status lock_members(struct study *study) {
    const struct study_options *const options = study->options;
    TRY(study_folder_create(options->folder));
    const uint64_t n = options->is_part ? (uint64_t)(options->last - options->first + 1) : 0;
    const uint64_t first = options->is_part ? (uint64_t)options->first : 0;
    study->lock_path = arena_text(study->arena, "%s/study.lock", options->folder);

    // another study may remove the file between opening and locking
    for (;;) {
        study->lock = open(study->lock_path, O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
        if (study->lock < 0) return target_failed(study->lock_path, errno, strerror(errno));
        const int code = durable_lock(study->lock, first, n);
        if (code != EAGAIN && durable_has_name(study->lock, study->lock_path)) return STATUS_OK;
        close(study->lock);
        study->lock = -1;
        if (code != EAGAIN) continue;
        return status_fail(STATUS_FILE,
                           "%s: another study runs some of the same members: wait until it has ended, or choose "
                           "another name with -o",
                           options->folder);
    }
}

static enum status plan_and_run(struct study *study) {
    const struct study_options *const options = study->options;

    // a refused plan creates no folder
    const bool exists = access(options->folder, F_OK) == 0;
    if (exists) TRY(lock_members(study));
    TRY(study_plan_create(study->arena, &study->plan, study->values, options));
    study->progress.n_members = study->plan.n_members;
    study->progress.n_done = study->plan.n_done;
    if (!exists) TRY(lock_members(study));

    // simultaneous members: usable processors over threads per member
    int n = options->n_processes != 0 ? options->n_processes : omp_get_num_procs() / study->plan.max_threads;
    if (n < 1) n = 1;
    study->n_jobs = n < study->plan.n ? n : study->plan.n;
    if (study->n_jobs == 0) return STATUS_OK;

    // the processes report in shared memory
    const size_t size = (size_t)study->n_jobs * sizeof *study->report;
    NEW(study->arena, study->job, study->n_jobs);
    void *const shared = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) arena_lack(study->arena, (double)size);
    study->report = shared;
    for (int j = 0; j < study->n_jobs; j++) study->job[j].report = &study->report[j];

    // a blocked signal stays pending, so the end of a process is never missed
    sigset_t ended;
    sigemptyset(&ended);
    sigaddset(&ended, SIGCHLD);
    sigprocmask(SIG_BLOCK, &ended, &study->mask);
    study->is_masked = true;
    TRY(run_until_all_end(study));
    if (study->required) {
        const char *const reason = study->required->report->reason;
        return status_fail(STATUS_SOLVER, "member %d failed: %.*s", study->required->member, (int)strcspn(reason, "\n"),
                           reason);
    }

    if (!is_stopped(study)) return STATUS_OK;
    return status_fail(STATUS_STOPPED, "stopped %s: %d of %d members are finished; repeat the command to continue",
                       simulate_stopped_by(study->options->stop), study->progress.n_done, study->progress.n_members);
}

enum status study_run(const struct case_values *values, const struct study_options *options, int *n_failed) {
    struct arena *const arena = arena_create(NULL, "the processes of a study");
    struct study study = {.arena = arena, .values = values, .options = options, .lock = -1};
    study.started = clock_seconds(CLOCK_MONOTONIC);
    const enum status status = plan_and_run(&study);

    // after a lack of memory, members may still run
    for (int j = 0; j < study.n_jobs && study.job; j++) {
        if (!study.job[j].process) continue;
        kill(study.job[j].process, SIGTERM);
        waitpid(study.job[j].process, NULL, 0);
    }
    if (study.is_masked) sigprocmask(SIG_SETMASK, &study.mask, NULL);
    *n_failed = study.progress.n_failed;
    if (study.report) munmap(study.report, (size_t)study.n_jobs * sizeof *study.report);

    // remove the empty lock file unless other studies hold locks
    struct stat facts;
    if (study.lock >= 0) {
        const bool is_last = durable_lock(study.lock, 0, 0) != EAGAIN;
        if (is_last && fstat(study.lock, &facts) == 0 && facts.st_size == 0) unlink(study.lock_path);
        close(study.lock);
    }

    arena_free(arena);
    return status;
}
