/* sweep_members.c: counting through the axes, the last one fastest. */
#include "case/sweep_members.h"

#include <stdlib.h>

enum status sweep_refuse(const struct case_values *values) {
    if (values->n_axes == 0) return STATUS_OK;
    return status_fail(STATUS_CASE,
                       "error: sweep: `shoal run` runs one case; this case has a sweep of %d ax%cs: use `shoal study`, "
                       "or remove the sweep with --set 'sweep=[]'",
                       values->n_axes, values->n_axes == 1 ? 'i' : 'e');
}

int sweep_n_members(const struct case_values *study) {
    int n = 1;
    for (int a = 0; a < study->n_axes; a++) n *= study->sweep[a].n_values;
    return n;
}

int sweep_member_value(const struct case_values *study, int member, int axis) {
    for (int a = study->n_axes - 1; a > axis; a--) member /= study->sweep[a].n_values;
    return member % study->sweep[axis].n_values;
}

int sweep_is_steady(const struct case_values *study) {
    int is_steady = 0;
    for (int a = 0; a < study->n_axes; a++) is_steady |= study->sweep[a].steady;
    return is_steady;
}

int sweep_member_before(const struct case_values *study, int member) {
    int stride = 1;
    for (int a = study->n_axes - 1; a >= 0; a--) {
        const struct sweep_axis *const axis = &study->sweep[a];
        const int value = sweep_member_value(study, member, a), before = axis->before ? axis->before[value] : value - 1;
        if (axis->steady) return before >= 0 ? member - (value - before) * stride : -1;
        stride *= study->sweep[a].n_values;
    }
    return -1;
}

void sweep_add_assignment(struct text *text, const struct sweep_axis *axis, int value, int k) {
    text_add(text, "%s=%s", axis->key[k].path, axis->value[value * axis->n_keys + k]);
}

enum status sweep_member_text(const struct case_values *study, int member, char **text) {
    struct text list = {0};
    text_add(&list, "%s", "");

    for (int a = 0; a < study->n_axes; a++) {
        const int value = sweep_member_value(study, member, a);
        for (int k = 0; k < study->sweep[a].n_keys; k++) {
            if (list.length > 0) text_add(&list, ", ");
            sweep_add_assignment(&list, &study->sweep[a], value, k);
        }
    }

    *text = list.text;
    if (!list.failed) return STATUS_OK;
    text_free(&list);
    *text = NULL;
    return status_fail(STATUS_MEMORY, "out of memory: the values of a member");
}
