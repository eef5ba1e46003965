/* study_compare.c: write the sweep of a comparison and run the study. */
#define _DEFAULT_SOURCE  // mkdtemp
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/memory.h"
#include "base/methods.h"
#include "case/case.h"
#include "case/sweep.h"
#include "study/study_comparison.h"
#include "study/study_folder.h"
#include "study/study_gather.h"

enum { MAX_REPEATS = 99, WORD_BYTES = 32 };

static const char standard_rtols[] = "1e-3,1e-4,1e-5,1e-6,1e-7";

// ---- lists with commas

/* Take the next word of a list; 0 at the end. */
static int list_next_word(const char **list, char word[WORD_BYTES]) {
    if (**list == '\0') return 0;
    const size_t length = strcspn(*list, ",");
    snprintf(word, WORD_BYTES, "%.*s", (int)(length < WORD_BYTES ? length : WORD_BYTES - 1), *list);
    *list += length + ((*list)[length] == ',');
    return 1;
}

void study_compare_words(struct text *text) {
    text_add(text, "ida1 to ida%d (ida with this highest order)", methods_table[METHOD_IDA].order);
    for (int i = 0; i < methods_n; i++) {
        if (i != METHOD_IDA && methods_table[i].has_adaptive_steps) text_add(text, ", %s", methods_table[i].word);
    }
    const char *before = "; with --steps also";
    for (int i = 0; i < methods_n; i++) {
        if (methods_table[i].has_adaptive_steps) continue;
        text_add(text, "%s %s", before, methods_table[i].word);
        before = ",";
    }
}

/* Find the method with this word: row of the table of methods, or -1, and order. */
static int find_method(const char *word, int *order) {
    const struct method_properties *const ida = &methods_table[METHOD_IDA];
    const size_t n = strlen(ida->word);
    if (strncmp(word, ida->word, n) == 0 && strlen(word) == n + 1) {
        *order = word[n] - '0';
        return *order >= 1 && *order <= ida->order ? METHOD_IDA : -1;
    }

    for (int i = 0; i < methods_n; i++) {
        if (i == METHOD_IDA || strcmp(methods_table[i].word, word) != 0) continue;
        *order = methods_table[i].order;
        return i;
    }

    return -1;
}

// ---- the sweep

/* Add one member: a value for each of the four keys. */
static void sweep_add_member(struct text *sweep, int method, int order, const char *rtol, const char *step) {
    const int is_first = sweep->text && sweep->text[sweep->length - 1] == '[';
    text_add(sweep, "%s[%s, %d, %s, %s]", is_first ? "" : ", ", methods_table[method].word, order, rtol, step);
}

/* Add a method with each tolerance or step. rtol: tolerance of members with fixed steps. */
static enum status sweep_add_method(struct text *sweep, const char *word, const struct study_compare_options *options,
                                    const char *rtol) {
    int order;
    const int method = find_method(word, &order);
    if (method < 0) {
        struct text known = {0};
        study_compare_words(&known);
        status_fail(STATUS_CASE, "--methods: '%s' is unknown: choose from %s", word, known.text ? known.text : "");
        text_free(&known);
        return STATUS_CASE;
    }

    const int by_step = options->steps && method != METHOD_IDA;
    if (!by_step && !methods_table[method].has_adaptive_steps) {
        return status_fail(STATUS_CASE,
                           "--methods: %s takes fixed steps only: give them with --steps, or omit the method", word);
    }

    const char *list = by_step ? options->steps : options->rtols ? options->rtols : standard_rtols;
    char value[WORD_BYTES];
    while (list_next_word(&list, value)) {
        double number;
        if (!text_number(value, &number)) {
            return status_fail(STATUS_CASE, "%s: '%s' is not a number", by_step ? "--steps" : "--rtol", value);
        }
        sweep_add_member(sweep, method, order, by_step ? rtol : value, by_step ? value : "0");
    }

    return STATUS_OK;
}

/* Write the assignment of the sweep: the references and all rounds of repeats. */
static enum status add_sweep(struct text *sweep, const struct case_values *values,
                             const struct study_compare_options *options) {
    struct text standard = {0}, rtol = {0};

    // all methods with adaptive steps
    text_add(&standard, "ida2,ida%d", methods_table[METHOD_IDA].order);
    for (int i = 0; i < methods_n; i++) {
        if (i != METHOD_IDA && methods_table[i].has_adaptive_steps) text_add(&standard, ",%s", methods_table[i].word);
    }
    text_add_number(&rtol, values->solver.rtol);
    enum status status = STATUS_OK;
    if (standard.failed || rtol.failed) status = memory_check(NULL, "a comparison");
    text_add(sweep, "sweep=[{keys: [solver.method, solver.order, solver.rtol, solver.step], values: [");

    // the reference, and a second reference with ten times the tolerance
    for (int i = 0; i < STUDY_COMPARISON_N_REFERENCES; i++) {
        struct text number = {0};
        text_add_number(&number, (i == 0 ? 1 : 10) * options->reference_rtol);
        sweep_add_member(sweep, METHOD_IDA, methods_table[METHOD_IDA].order, number.text ? number.text : "", "0");
        sweep->failed = sweep->failed || number.failed;
        text_free(&number);
    }

    for (int repeat = 0; repeat < options->repeats; repeat++) {
        char word[WORD_BYTES];
        const char *methods = options->methods ? options->methods : standard.text;
        while (status == STATUS_OK && list_next_word(&methods, word))
            status = sweep_add_method(sweep, word, options, rtol.text);
    }

    text_add(sweep, "]}]");
    text_free(&standard);
    text_free(&rtol);

    return status;
}

/* Create the study: the case with the sweep. Only the last row is written. */
static enum status create_study(struct case_values *study, const struct case_values *values,
                                const struct study_compare_options *options) {
    struct text sweep = {0}, row = {0}, wake = {0};
    text_add(&row, "time.output_interval=");
    text_add_number(&row, values->time.end);
    text_add(&wake, "output.wake_interval=");
    text_add_number(&wake, values->time.end);
    enum status status = add_sweep(&sweep, values, options);
    if (status == STATUS_OK && (sweep.failed || row.failed || wake.failed)) {
        status = memory_check(NULL, "a comparison");
    }

    if (status == STATUS_OK) {
        const char *const assignments[] = {sweep.text, row.text, wake.text};
        status = case_parse(study, values->merged, strlen(values->merged), values->name, NULL, 3, assignments);
    }

    text_free(&sweep);
    text_free(&row);
    text_free(&wake);
    if (status != STATUS_OK || study_comparison_is(study)) return status;
    case_free(study);

    return status_fail(STATUS_CASE, "nothing to compare: --methods, --rtol and --steps are lists");
}

// ---- the run

/* Run all members in a folder, then report. */
static enum status compare_run_in_folder(const char *folder, const struct case_values *study,
                                         const struct study_compare_options *options, const struct study_options *run,
                                         FILE *stream) {
    const struct study_options all = {.folder = folder,
                                      .command = run->command,
                                      .n_processes = 1,
                                      .last = -1,
                                      .n_required = STUDY_COMPARISON_N_REFERENCES,
                                      .limit = run->limit,
                                      .progress = run->progress,
                                      .data = run->data,
                                      .stop = run->stop};
    MEMORY_BOUNDARY(STATUS_MEMORY);
    int n_failed;
    const enum status status = study_run(study, &all, &n_failed);

    if (status == STATUS_SOLVER) {
        return status_fail(STATUS_SOLVER, "the reference, %s; see --reference-rtol and --limit", status_message());
    }

    if (status == STATUS_STOPPED) return status_fail(STATUS_STOPPED, "stopped by a signal");
    TRY(status);
    const enum status reported = study_report(study, folder, options->path, run->command, 0, stream, stream);

    // a method that fails on a case is a valid result
    return reported == STATUS_SOLVER ? STATUS_OK : reported;
}

enum status study_compare(const struct case_values *values, const struct study_compare_options *options,
                          const struct study_options *run, FILE *stream) {
    if (options->repeats < 1 || options->repeats > MAX_REPEATS) {
        return status_fail(STATUS_CASE, "--repeats: expects 1 to %d", MAX_REPEATS);
    }

    TRY(sweep_refuse(values));
    const char *const place = getenv("TMPDIR");
    char folder[PATH_MAX];
    snprintf(folder, sizeof folder, "%s/shoal-compare-XXXXXX", place && *place ? place : "/tmp");
    struct case_values study;
    TRY(create_study(&study, values, options));
    enum status status = STATUS_OK;
    if (mkdtemp(folder)) {
        status = compare_run_in_folder(folder, &study, options, run, stream);
        study_folder_remove(folder);
    } else {
        status = status_fail(STATUS_FILE, "%s: cannot create this folder (%s): set TMPDIR to another folder", folder,
                             strerror(errno));
    }

    case_free(&study);
    return status;
}
