/* study_folder.h: the folder of a study with its files, from which follows which members still have to run. Tested by
 * tests/study/test_study.sh and test_study_folder.c.
 *
 *     FOLDER/member-0000.nc       result of a member, with the study and the number of the member
 *     FOLDER/member-0000.state    whole state of a steady state from which other searches start
 *     FOLDER/member-0003.failed   reason of the failure of a member
 *     FOLDER/study.nc             final values of the members, gathered from the member files */
#ifndef STUDY_FOLDER_H
#define STUDY_FOLDER_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"
#include "study/study.h"

/* Create the folder unless it exists. Fails with STATUS_FILE. */
enum status study_folder_create(const char *folder);

/* Remove the folder and all files in the folder. */
void study_folder_remove(const char *folder);

#define STUDY_FOLDER_STATE ".state"

/* The path of a file in the folder, or of a member file with an ending such as ".nc". */
char *study_folder_path(struct arena *arena, const char *folder, const char *name);
char *study_folder_member(struct arena *arena, const char *folder, int member, const char *ending);

/* Parse the case of a study; the case of a member. Both are released with the arena. They fail as case_parse and
 * case_member. */
enum status study_folder_parse(struct arena *arena, struct case_values **study, const char *text, const char *origin,
                               int n_assignments, const char *const *assignments);
enum status study_folder_case(struct arena *arena, struct case_values **values, const struct case_values *study,
                              int member);

/* Members that cannot run: the case is not valid, or the search is for a steady state and the case can have none. */
struct study_refusals {
    int n, n_checked, first; /* members that cannot run, of those that were checked; the first of them */
    char reason[4096];       /* of the first */
};

/* Count a checked member. status is the result of its check, of which STATUS_CASE means that it cannot run; any other
 * failure is returned. */
enum status study_refusals_add(struct study_refusals *refusals, const struct case_values *study, int member,
                               enum status status);

/* Fail with STATUS_CASE, with the number of the members that cannot run and the reason of the first, unless all can. */
enum status study_refusals_status(const struct study_refusals *refusals, const struct case_values *study);

/* Write the reason of a failure to the .failed file of a member; NULL: remove the file of an earlier run. A second line
 * becomes the progress of the member. */
void study_folder_set_reason(struct arena *arena, const char *folder, int member, const char *reason);

/* Read the final values of all members in the folder into the arena. An unreadable file counts as a failed member.
 * Fails with STATUS_FILE (a file belongs to another study). */
enum status study_folder_read_members(struct arena *arena, struct member_file **members,
                                      const struct case_values *study, const char *folder);

/* Read the merged case of the study from the first readable member file of the folder. Fails with STATUS_FILE. */
enum status study_folder_find_study(struct arena *arena, const char *folder, const char **text);

// ---- the plan: selection of the unfinished members
//
// A member is finished if the member file is complete and was written by the same case.

struct study_plan {
    int n_members, n_done; /* requested members; finished members among the requested ones */
    int n, *member;        /* numbers of the unfinished members                    (n) */
    int max_threads;       /* largest number of threads of an unfinished member */
};

/* A loop over members before any of them runs: its progress, and the request to stop. */
struct study_watch {
    const struct study_options *options; /* NULL: neither */
    const char *what;                    /* is done to the members: "checked" */
    int n;                               /* members of the loop */
    double started, reported;            /* by CLOCK_MONOTONIC, s */
};

/* After each member of the loop: report, or fail with STATUS_STOPPED. */
enum status study_folder_watch(struct study_watch *watch, int n_checked);

/* Check all members, or a part of them (options->is_part), and list the unfinished members. options->force:
 * remove results of another study, unless this one is refused. Other fields in use: folder, progress, stop. Fails with
 * STATUS_CASE (no such members, or members that cannot run), STATUS_FILE (the folder contains results of another study)
 * or STATUS_STOPPED. */
enum status study_plan_create(struct arena *arena, struct study_plan *plan, const struct case_values *study,
                              const struct study_options *options);

#endif
