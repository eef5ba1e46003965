/* fuzz_case.c: Any text is tried as a case file. It is either refused with a place, or shown, and what is shown must
 * show itself. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case/case.h"
#include "case/sweep.h"
#include "fuzz.h"

enum { MAX_MEMBERS = 8 };

static void demand(int holds, const char *what) {
    if (holds) return;
    fprintf(stderr, "%s; the last message: %s\n", what, status_message());
    abort();
}

// show(show(x)) = show(x)
static void compare(const struct case_values *values) {
    const char *const text = case_show(values->arena, values);
    struct case_values again;
    demand(case_parse(&again, text, strlen(text), "shown", NULL, 0, NULL) == STATUS_OK, "what is shown is refused");
    const char *const repeated = case_show(again.arena, &again);
    demand(strcmp(text, repeated) == 0, "what is shown shows something else");
    case_free(&again);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t n) {
    struct case_values values;
    const enum status status = case_parse(&values, (const char *)bytes, n, "fuzz", NULL, 0, NULL);
    if (status == STATUS_OK) {
        compare(&values);
        const int n_members = values.n_axes > 0 ? sweep_n_members(&values) : 0;
        for (int m = 0; m < n_members && m < MAX_MEMBERS; m++) {
            struct case_values member;
            if (case_member(&member, &values, m) != STATUS_OK) continue;
            compare(&member);
            case_free(&member);
        }
        case_free(&values);
    } else {
        // an include may be missing; all else has a line and a column
        demand(status == STATUS_CASE || status == STATUS_FILE, "a case is refused with another status");
        demand(strstr(status_message(), "fuzz:") != NULL, "a case is refused without its place");
        demand(strstr(status_message(), "error: ") != NULL, "a case is refused without a reason");
    }
    return 0;
}
