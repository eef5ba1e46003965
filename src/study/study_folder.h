/* study_folder.h: the folder of a study, and the files in it. Tested by tests/study/test_study.sh.
 *
 *     FOLDER/member-0000.nc       the result of each member; it holds the study and the member's number
 *     FOLDER/member-0003.failed   why a member failed
 *     FOLDER/study.nc             what the members ended with; made from their files */
#ifndef STUDY_FOLDER_H
#define STUDY_FOLDER_H

#include <stdio.h>

#include "base/status.h"
#include "case/case_values.h"
#include "study/member_file.h"

/* Make the folder unless it is there. Fails with STATUS_FILE. */
enum status study_folder_create(const char *folder);

/* Remove the folder with all files in it. */
void study_folder_remove(const char *folder);

/* The path of a file in the folder, or of a member's with an ending such as ".nc"; NULL: out of memory. The caller
 * frees it. */
char *study_folder_path(const char *folder, const char *name);
char *study_folder_member(const char *folder, int member, const char *ending);

/* Keep the reason of a failure next to the result of a member; NULL: remove that of an earlier run. Fails with
 * STATUS_MEMORY. */
enum status study_folder_set_reason(const char *folder, int member, const char *reason);

/* The ends of all members in the folder. A file that cannot be read counts as a member that failed. The caller frees
 * them with study_folder_free_members. Fails with STATUS_FILE (a file belongs to another study) or STATUS_MEMORY. */
enum status study_folder_read_members(struct member_file **members, const struct case_values *study,
                                      const char *folder);
void study_folder_free_members(struct member_file *members, int n);

/* The merged case of the study that the first readable member of the folder belongs to. The caller frees *text. Fails
 * with STATUS_FILE. */
enum status study_folder_find_study(const char *folder, char **text);

#endif
