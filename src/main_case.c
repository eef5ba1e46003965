/* main_case.c: looking at cases and at results. Declared in main.h. */
#include <stdlib.h>

#include "compare.h"
#include "fish.h"
#include "main.h"
#include "settings.h"
#include "store.h"
#include "study.h"

/* Check the case of each member of a study, as `shoal study` will. */
static enum status check_members(const struct settings *study) {
    for (int m = 0; study->n_axes > 0 && m < settings_n_members(study); m++) {
        struct settings member;
        TRY(settings_member(&member, study, m));
        settings_free(&member);
    }
    return STATUS_OK;
}

enum status main_check(const struct request *request) {
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    struct school *school = NULL;
    enum status status = fish_school_create(&school, &settings);
    if (status == STATUS_OK) status = check_members(&settings);
    if (status == STATUS_OK && !request->quiet) {
        printf("%s: ok: %d fish, %d unknowns, %.6g s in %.0f events", request->positional, school->n_fish,
               school->n_unknowns, settings.time.end, settings.time.end / settings.time.shedding_interval);
        if (settings.n_axes > 0) printf("; %d members", settings_n_members(&settings));
        printf("\n");
    }
    fish_school_free(school);
    settings_free(&settings);
    return status;
}

enum status main_show(const struct request *request) {
    struct settings settings;
    TRY(settings_read(&settings, request->positional, request->n_assignments, request->assignments));
    char *text = NULL;
    const enum status status = settings_show(&settings, &text);
    if (status == STATUS_OK) fputs(text, stdout);
    free(text);
    settings_free(&settings);
    return status;
}

enum status main_keys(const struct request *request) {
    if (request->of_output) {
        store_variables(stdout, request->json);
    } else {
        settings_keys(stdout, request->json);
    }
    return STATUS_OK;
}

enum status main_info(const struct request *request) {
    enum store_kind kind;
    TRY(store_info(request->positional, request->case_only, stdout, &kind));
    if (request->case_only) return STATUS_OK;
    if (kind == STORE_STUDY) return study_info(request->positional, stdout);
    return kind == STORE_COMPARISON ? compare_info(request->positional, stdout) : STATUS_OK;
}
