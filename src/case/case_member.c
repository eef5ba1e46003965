/* case_member.c: the study's case, read once more with the assignments of the member. */
#include "case/case_member.h"

#include <stdlib.h>
#include <string.h>

#include "case/case.h"
#include "case/sweep_members.h"

/* Fill the assignments of a member, and one assignment that removes the sweep or the errors; returns the number of
 * assignments, or -1 if out of memory. */
static int fill_assignments(const struct case_values *study, int member, char **assignments) {
    int n = 0;
    for (int a = 0; a < study->n_axes; a++) {
        const int value = sweep_member_value(study, member, a);
        for (int k = 0; k < study->sweep[a].n_keys; k++) {
            struct text text = {0};
            sweep_add_assignment(&text, &study->sweep[a], value, k);
            assignments[n] = text.text;
            if (text.failed) {
                text_free(&text);
                return -1;
            }
            n++;
        }
    }

    assignments[n] = strdup(study->error ? "error=none" : "sweep=[]");
    return assignments[n] ? n + 1 : -1;
}

/* Read the case of a member and store the number of the member. */
static enum status read_member(struct case_values *values, const struct case_values *study, int member,
                               int n_assignments, char **assignments) {
    const enum status status = case_parse(values, study->merged, strlen(study->merged), study->name, NULL,
                                          n_assignments, (const char *const *)assignments);

    if (status == STATUS_CASE) {
        char *text;
        TRY(sweep_member_text(study, member, &text));
        status_fail(STATUS_CASE, "member %d (%s):\n%s", member, text, status_message());
        free(text);
        return STATUS_CASE;
    }

    TRY(status);
    free(values->text);
    values->text = strdup(study->text);
    values->study = strdup(study->merged);
    values->member = member;
    if (values->text && values->study) return STATUS_OK;
    case_free(values);
    return status_fail(STATUS_MEMORY, "out of memory: the case of member %d", member);
}

enum status case_member(struct case_values *values, const struct case_values *study, int member) {
    *values = (struct case_values){0};
    int n_keys = 0;
    for (int a = 0; a < study->n_axes; a++) n_keys += study->sweep[a].n_keys;
    char **const assignments = calloc((size_t)n_keys + 1, sizeof *assignments);
    const int n = assignments ? fill_assignments(study, member, assignments) : -1;
    const enum status status = n < 0 ? status_fail(STATUS_MEMORY, "out of memory: the values of member %d", member)
                                     : read_member(values, study, member, n, assignments);
    for (int i = 0; assignments && i <= n_keys; i++) free(assignments[i]);
    free(assignments);
    return status;
}
