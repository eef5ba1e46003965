/* error_report.c: the plan, the budget, error.csv and the variables of study.nc. */
#include "study/error_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "case/case.h"
#include "case/sweep.h"
#include "result/durable.h"
#include "run/estimate.h"
#include "study/study_print.h"

enum { MOST_FISH = 4, OF_QUANTITY = 4 /* columns */, LEVEL_BYTES = 160, NAME_BYTES = 80, MEANING_BYTES = 200 };

/* Beats of a search from the initial state of a case, from the state of a neighbour, and for the multipliers of a fish;
 * wall time of the events simulated for an estimate, s. */
static const double beats_from_start = 14, beats_from_neighbour = 11, beats_of_multipliers = 32, patience = 2;

static const char *name_of(const struct error_study *study, int q) {
    return member_file_quantity(study->quantity[q])->name;
}

/* Without "steady_". */
static const char *short_name_of(const struct error_study *study, int q) {
    return name_of(study, q) + (strncmp(name_of(study, q), "steady_", 7) == 0 ? 7 : 0);
}

static int report_of_fish(const struct error_study *study, int q) {
    return member_file_quantity(study->quantity[q])->of_fish;
}

static int report_is_error(const struct error_study_key *key) {
    return key->row->kind != SWEEP_MODEL;
}

/* "13 17 [25] 35", from coarse to fine; the stated value in brackets. */
static void write_levels(const struct error_study_key *key, char text[LEVEL_BYTES]) {
    int length = 0;
    *text = '\0';
    for (int i = key->n_levels - 1; i >= 0 && length < LEVEL_BYTES - 1; i--) {
        const int is_stated = i == key->stated;
        length += snprintf(text + length, (size_t)(LEVEL_BYTES - length), "%s%s%.4g%s", length > 0 ? " " : "",
                           is_stated ? "[" : "", key->value[i], is_stated ? "]" : "");
    }
    if (length < LEVEL_BYTES) snprintf(text + length, (size_t)(LEVEL_BYTES - length), "%s", key->unit);
}

// ---- the plan

/* The estimated CPU time of a member, s. */
static enum status report_estimate_member(const struct error_study *study, int m, double seconds, double *duration) {
    struct case_values values;
    struct simulation *simulation = NULL;
    struct estimate estimate;

    TRY(case_member(&values, &study->study, m));
    if (study->is_steady && study->beat > 0) {
        double beats = m == 0 ? beats_from_start : beats_from_neighbour;
        if (m == 0 && values.steady.multipliers != NO) beats += beats_of_multipliers * study->n_fish;
        values.time.end = beats * study->beat;
    }

    enum status status = simulate_create(NULL, &simulation, &values);
    if (status == STATUS_OK) status = estimate_run(simulation, seconds, &estimate);
    simulate_free(simulation);
    case_free(&values);
    *duration = status == STATUS_OK ? estimate.seconds : NAN;

    return status == STATUS_SOLVER ? STATUS_OK : status;
}

static void print_duration(double seconds, FILE *stream) {
    char text[TEXT_DURATION_BYTES];
    text_duration(text, seconds > 0.05 ? seconds : 0.1);
    fputs(text, stream);
}

enum status error_report_plan(const struct error_study *study, int n_processes, FILE *stream) {
    const int n = sweep_n_members(&study->study);
    double sum = 0, longest = 0, *duration;
    enum status status = MEMORY_NEW(duration, n, "the plan of a study");
    for (int m = 0; m < n && status == STATUS_OK; m++) {
        // the time of an equilibrium is negligible
        if (!study->is_static) status = report_estimate_member(study, m, patience / n, &duration[m]);
        sum += duration[m];
        longest = fmax(longest, duration[m]);
    }

    struct text_table table;
    if (status == STATUS_OK) status = text_table_create(&table, 1 + study->n_keys, 4);
    if (status != STATUS_OK) {
        free(duration);
        return status;
    }

    table.n_left = 3;
    const char *const heads[] = {"key", "levels", "members", "time of each, s"};
    for (int c = 0; c < 4; c++) text_table_set(&table, 0, c, "%s", heads[c]);
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        char levels[LEVEL_BYTES];
        struct text members = {0}, times = {0};
        write_levels(key, levels);
        for (int i = key->n_levels - 1; i >= 0 && key->n_levels > 1; i--) {
            text_add(&members, "%s%d", members.length > 0 ? " " : "", key->member[i]);
            text_add(&times, "%s%.2g", times.length > 0 ? " " : "", duration[key->member[i]]);
        }
        text_table_set(&table, 1 + k, 0, "%s", key->row->path);
        text_table_set(&table, 1 + k, 1, "%s", levels);
        text_table_set(&table, 1 + k, 2, "%s", members.text ? members.text : "not varied");
        text_table_set(&table, 1 + k, 3, "%s", times.text ? times.text : "");
        text_free(&members);
        text_free(&times);
    }

    text_table_print(&table, stream);
    text_table_free(&table);
    free(duration);
    fprintf(stream, "%d members, [the case] among them; about ", n);
    print_duration(sum, stream);
    fprintf(stream, " of CPU time, ");
    print_duration(fmax(longest, sum / n_processes), stream);
    fprintf(stream, " with %d at once: estimated from a few events, often within a factor of two\n", n_processes);
    if (!isnan(study->study.error->within)) {
        fprintf(stream,
                "then refined until the errors are below %.3g %% of the values, up to %g times the time of the "
                "case\n",
                100 * study->study.error->within, study->study.error->most);
    }

    return STATUS_OK;
}

// ---- numbers

/* The number of decimals for two significant digits. */
static int decimals_for(double number) {
    if (!(fabs(number) > 0) || !isfinite(number)) return 5;
    const int decimals = 1 - (int)floor(log10(fabs(number)));
    return decimals < 0 ? 0 : decimals > 12 ? 12 : decimals;
}

/* "0.9364 +- 0.0019 m s-1 (0.2 %)" */
static void print_value(const struct error_study *study, int q, int f, FILE *stream) {
    const int place = error_plan_place(study, q, f);
    const double value = study->value[place], error = study->error[place];
    const char *const own_unit = member_file_quantity(study->quantity[q])->unit;
    const char *const unit = strcmp(own_unit, "1") == 0 ? "" : own_unit, *const blank = *unit ? " " : "";

    fprintf(stream, "%s", name_of(study, q));
    if (report_of_fish(study, q)) fprintf(stream, " of %s", study->study.school.fish[f].name);
    if (isnan(value)) {
        fprintf(stream, ": unknown\n");
    } else if (isnan(error)) {
        fprintf(stream, ": %.5g%s%s, error unknown\n", value, blank, unit);
    } else {
        const int decimals = decimals_for(error);
        fprintf(stream, ": %.*f +- %.*f%s%s", decimals, value, decimals, error, blank, unit);
        if (fabs(value) > 0) fprintf(stream, " (%.2g %%)", 100 * error / fabs(value));
        fprintf(stream, "\n");
    }
}

// ---- the table

/* The reason of a flag of a quantity of a fish with its levels, or "". */
static void write_reason(const struct error_study *study, const struct error_study_key *key, int place,
                         char text[ERROR_BUDGET_BYTES]) {
    double size[ERROR_STUDY_LEVELS];
    const struct error_budget_levels levels = error_study_levels(study, key, size);
    error_budget_reason(&levels, &key->part[place], key->value, text);
}

/* The observed order of a quantity, "1.9", or the reason for none in a word. */
static void set_order(const struct text_table *table, int row, int column, const struct error_budget_result *part) {
    if (part->verdict == ERROR_BUDGET_ACCEPTED) {
        text_table_set(table, row, column, "%.1f", part->order);
    } else {
        text_table_set(table, row, column, "%s",
                       part->verdict == ERROR_BUDGET_NONE      ? "none"
                       : part->verdict == ERROR_BUDGET_UNKNOWN ? "unknown"
                                                               : "flagged");
    }
}

/* Describe the effect of the next level of the key with the largest share of the largest relative error: cost and
 * predicted error, where known. */
static void write_next(const struct error_study *study, const struct error_study_next *next,
                       char text[TEXT_CELL_BYTES]) {
    const struct error_study_key *const key = &study->key[next->key];
    int n = snprintf(text, TEXT_CELL_BYTES, "<- spend here");
    if (isnan(next->value)) return;
    const char *const last = strrchr(key->row->path, '.') + 1;
    n += snprintf(text + n, (size_t)(TEXT_CELL_BYTES - n), ": %s %.4g", last, next->value);

    // times of short runs do not tell a smaller factor from 1
    const double least = 1.05;
    if (next->cost > least) n += snprintf(text + n, (size_t)(TEXT_CELL_BYTES - n), ", CPU x %.2g", next->cost);
    const char *const quantity = short_name_of(study, next->place / study->n_fish);
    if (isnan(next->sum)) {
        snprintf(text + n, (size_t)(TEXT_CELL_BYTES - n), ", to find an order of %.40s", quantity);
    } else {
        snprintf(text + n, (size_t)(TEXT_CELL_BYTES - n), ", %.40s +-%.2g %%", quantity, 100 * next->sum);
    }
}

/* Print two digits of a part of the sum, at most one decimal more than the sum and at most five decimals. */
static void report_set_part(const struct text_table *table, int row, int column, double part, double sum) {
    const int most = decimals_for(sum) < 4 ? 5 : decimals_for(sum) + 1, own = decimals_for(part);
    text_table_set(table, row, column, isnan(part) ? "unknown" : "%.*f", own < most ? own : most, part);
}

static void fill_row(const struct error_study *study, const struct text_table *table, int row, int k, int f) {
    const struct error_study_key *const key = &study->key[k];
    char levels[LEVEL_BYTES];
    write_levels(key, levels);
    text_table_set(table, row, 0, "%s", key->row->path);
    text_table_set(table, row, 1, "%s", levels);
    int c = 2;
    for (int q = 0; q < study->n_asked; q++, c += OF_QUANTITY) {
        const int place = error_plan_place(study, q, f);
        if (f > 0 && !report_of_fish(study, q)) continue;
        if (key->n_levels == 1) {
            text_table_set(table, row, c + 1, "not varied");
            continue;
        }
        const double error = key->part[place].error;
        report_set_part(table, row, c, error, study->error[place]);
        set_order(table, row, c + 1, &key->part[place]);
        text_table_number(table, row, c + 2, "%.2f", 100 * error / fabs(study->value[place]));
        text_table_number(table, row, c + 3, "%.0f", study->error[place] > 0 ? 100 * error / study->error[place] : 0);
    }

    if (key->n_levels > 1) text_table_set(table, row, c, "%d levels", key->n_levels < 4 ? key->n_levels : 4);
}

/* Print the share of each key for one fish. */
static enum status report_print_table(const struct error_study *study, const struct error_study_next *next, int f,
                                      FILE *stream) {
    int n_keys = 0, n_moved = 0;
    for (int k = 0; k < study->n_keys; k++) {
        n_keys += report_is_error(&study->key[k]);
        n_moved += study->key[k].stated != study->key[k].first_stated;
    }

    const int n_columns = 4 + OF_QUANTITY * study->n_asked;
    struct text_table table;
    TRY(text_table_create(&table, 3 + n_keys, n_columns));
    table.n_left = 2;
    text_table_set(&table, 0, 0, "key");
    text_table_set(&table, 0, 1, "levels");
    for (int q = 0; q < study->n_asked; q++) {
        const char *const heads[OF_QUANTITY] = {short_name_of(study, q), "order", "%", "share"};
        for (int c = 0; c < OF_QUANTITY; c++) text_table_set(&table, 0, 2 + OF_QUANTITY * q + c, "%s", heads[c]);
    }

    text_table_set(&table, 0, n_columns - 2, "by");
    text_table_set(&table, 0, n_columns - 1, "next");
    int row = 1;
    for (int k = 0; k < study->n_keys; k++) {
        if (!report_is_error(&study->key[k])) continue;
        char words[TEXT_CELL_BYTES] = "";
        if (k == next->key) write_next(study, next, words);
        fill_row(study, &table, row, k, f);
        text_table_set(&table, row++, n_columns - 1, "%s", words);
    }

    if (n_moved > 1) {
        text_table_set(&table, row, 0, "together");
        for (int q = 0; q < study->n_asked; q++) {
            const int place = error_plan_place(study, q, f);
            report_set_part(&table, row, 2 + OF_QUANTITY * q, study->together[place], study->error[place]);
            text_table_number(&table, row, 4 + OF_QUANTITY * q, "%.2f",
                              100 * study->together[place] / fabs(study->value[place]));
        }
        row++;
    }

    text_table_set(&table, row, 0, "sum");
    for (int q = 0; q < study->n_asked; q++) {
        const int place = error_plan_place(study, q, f);
        if (f > 0 && !report_of_fish(study, q)) continue;
        report_set_part(&table, row, 2 + OF_QUANTITY * q, study->error[place], study->error[place]);
        text_table_number(&table, row, 4 + OF_QUANTITY * q, "%.2f",
                          100 * study->error[place] / fabs(study->value[place]));
    }

    table.n_rows = row + 1;
    text_table_print(&table, stream);
    text_table_free(&table);

    return STATUS_OK;
}

/* Print the largest change of a requested quantity by each choice of the model. */
static void print_choices(const struct error_study *study, FILE *stream) {
    int n = 0;
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        if (report_is_error(key) || key->n_levels == 1) continue;
        double most = 0;
        int is_none = 1;
        for (int place = 0; place < study->n_asked * study->n_fish; place++) {
            most = fmax(most, key->part[place].error / fabs(study->value[place]));
            is_none &= key->part[place].verdict == ERROR_BUDGET_NONE;
        }
        char levels[LEVEL_BYTES];
        write_levels(key, levels);
        fprintf(stream, "%s%s (%s) ", n++ > 0 ? "; " : "choices, not in the sum: ", key->row->path, levels);
        if (is_none) {
            fprintf(stream, "none");
        } else {
            fprintf(stream, "%.2g %%", 100 * most);
        }
    }

    if (n > 0) fprintf(stream, "\n");
}

/* Print the reasons of flags, each with its quantity, of fixed keys, and of failed members. */
static void print_reasons(const struct error_study *study, const struct member_file *members, FILE *stream) {
    for (int k = 0; k < study->n_keys; k++) {
        const struct error_study_key *const key = &study->key[k];
        if (key->n_levels == 1) fprintf(stream, "not varied: %s: %s\n", key->row->path, key->objection);
        if (key->n_levels == 1 || !report_is_error(key)) continue;
        for (int place = 0; place < study->n_asked * study->n_fish; place++) {
            const int q = place / study->n_fish, f = place % study->n_fish;
            const struct error_budget_result *const part = &key->part[place];
            const int is_objection = part->verdict == ERROR_BUDGET_OBJECTION;

            // at least 1 % of the error of the quantity, or an unknown error
            if (!error_budget_is_flagged(part->verdict) || part->error < 0.01 * study->error[place]) continue;
            char reason[ERROR_BUDGET_BYTES];
            write_reason(study, key, place, reason);
            fprintf(stream, "flagged: %s: ", key->row->path);
            if (!is_objection) fprintf(stream, "%s", short_name_of(study, q));
            if (!is_objection && report_of_fish(study, q)) fprintf(stream, " of %s", study->study.school.fish[f].name);
            fprintf(stream, "%s%s\n", is_objection ? "" : ": ", reason);
            if (is_objection) break;
        }
    }
    for (int m = 0; m < sweep_n_members(&study->study); m++) {
        if (!member_file_is_complete(&members[m])) fprintf(stream, "member %d: %s\n", m, members[m].status);
    }
}

enum status error_report_print(struct error_study *study, const struct member_file *members, FILE *stream) {
    struct error_study_next next;
    TRY(error_study_find_next(study, members, &next));
    const int n_shown = study->n_fish < MOST_FISH ? study->n_fish : MOST_FISH;
    for (int f = 0; f < n_shown; f++) {
        for (int q = 0; q < study->n_asked; q++) {
            if (f == 0 || report_of_fish(study, q)) print_value(study, q, f, stream);
        }
        TRY(report_print_table(study, &next, f, stream));
        if (f + 1 < n_shown) fprintf(stream, "\n");
    }

    if (n_shown < study->n_fish) {
        fprintf(stream, "The first %d of %d fish; error.csv and study.nc have all.\n", n_shown, study->n_fish);
    }

    fprintf(stream, "noise of a value, of integrator and search: %.1e\n", study->noise);
    print_choices(study, stream);
    print_reasons(study, members, stream);
    if (study->stated > 0) fprintf(stream, "the stated value takes %.2g times the time of the case\n", study->cost);
    if (study->is_reached) return STATUS_OK;
    char words[ERROR_BUDGET_BYTES];
    error_study_say_cost(study, words);

    return status_fail(STATUS_MISSED, "the errors are not within %.3g %% of the values; %s",
                       100 * study->study.error->within, words);
}

// ---- error.csv

enum status error_report_write_csv(const struct error_study *study, const char *path) {
    struct plain_file table;
    TRY(plain_file_open(&table, path, TARGET_TABLE, true, 0666));
    FILE *const file = table.stream;
    fputs(TARGET_TABLE_MARK "\n", file);

    for (int f = 0; f < study->n_fish; f++) {
        for (int q = 0; q < study->n_asked; q++) {
            const int place = error_plan_place(study, q, f);
            const struct member_file_quantity *const quantity = member_file_quantity(study->quantity[q]);
            if (f > 0 && !quantity->of_fish) continue;
            for (int k = -1; k < study->n_keys; k++) {
                const struct error_study_key *const key = k < 0 ? NULL : &study->key[k];
                if (key && key->n_levels == 1) continue;
                char levels[LEVEL_BYTES] = "", reason[ERROR_BUDGET_BYTES] = "";
                if (key) write_levels(key, levels);
                if (key) write_reason(study, key, place, reason);
                const double error = key ? key->part[place].error : study->error[place];
                const char *const verdict = !key                    ? ""
                                            : !report_is_error(key) ? "a choice of the model, not in the sum"
                                            : *reason               ? reason
                                                                    : error_budget_words(key->part[place].verdict);
                fprintf(file, "\"%s\",%s,%s,%.9g,%s,%s,%.3g,%.3g,%.3g,\"%s\"\n",
                        quantity->of_fish ? study->study.school.fish[f].name : "", quantity->name, quantity->unit,
                        study->value[place], key ? key->row->path : "sum", levels, key ? key->part[place].order : NAN,
                        error, 100 * error / fabs(study->value[place]), verdict);
            }
        }
    }

    return plain_file_close(&table, STATUS_OK);
}

// ---- study.nc

/* Variables of each key. */
enum { KEY_NAME, KEY_REASON, KEY_LEVELS, KEY_STATED, KEY_IS_CHOICE, KEY_DESIGN_ORDER, KEY_VALUE, KEY_MEMBER, N_OF_KEY };
static const struct of_key {
    const char *name, *meaning;
    enum netcdf_type type;
    int by_level;
} of_key[N_OF_KEY] = {
    {"key_name", "numerical key that is varied alone", NETCDF_TEXT, 0},
    {"key_reason", "reason why the key is not varied, or empty", NETCDF_TEXT, 0},
    {"key_levels", "levels of the key", NETCDF_INT, 0},
    {"key_stated", "level of the stated value, from 0, the finest", NETCDF_INT, 0},
    {"key_is_choice", "1: choice of the model, not in the sum", NETCDF_INT, 0},
    {"key_design_order", "order that the key has by design; NaN: none", NETCDF_DOUBLE, 0},
    {"key_value", "value of the key at each level, from fine to coarse", NETCDF_DOUBLE, 1},
    {"key_member", "member of each level; -1: none", NETCDF_INT, 1},
};

/* Variables of each quantity: name and meaning include the name of the quantity. */
enum { STATED, BAR, PART, KEY_ORDER, KEY_FLAG, N_OF_QUANTITY };
static const struct of_quantity {
    const char *name, *meaning;
    int by_key, has_unit, is_text;
} of_quantity[N_OF_QUANTITY] = {
    {"stated_%s", "stated value of %s", 0, 1, 0},
    {"bar_%s", "error of the stated value of %s: the sum over the keys", 0, 1, 0},
    {"part_%s", "error of %s by each key, or change by a choice of the model", 1, 1, 0},
    {"key_order_%s", "observed order of %s in each key", 1, 0, 0},
    {"key_flag_%s", "reason why the levels of each key give no order of %s, or empty", 1, 0, 1},
};

int error_report_listed(int i, struct result_listed *listed) {
    static char name[N_OF_QUANTITY][NAME_BYTES], meaning[N_OF_QUANTITY][MEANING_BYTES];
    if (i < N_OF_KEY) {
        const struct of_key *const row = &of_key[i];
        *listed = (struct result_listed){.name = row->name,
                                         .type = row->type == NETCDF_TEXT  ? "char"
                                                 : row->type == NETCDF_INT ? "int"
                                                                           : "double",
                                         .unit = row->type == NETCDF_TEXT                    ? ""
                                                 : row->type == NETCDF_INT || !row->by_level ? "1"
                                                                                             : "of the key",
                                         .meaning = row->meaning};
        snprintf(listed->dimensions, sizeof listed->dimensions, "key%s%s", row->by_level ? ", key_level" : "",
                 row->type == NETCDF_TEXT ? ", text" : "");
        return 1;
    }

    const int k = i - N_OF_KEY;
    if (k >= N_OF_QUANTITY) return 0;
    study_fill_name(name[k], NAME_BYTES, of_quantity[k].name, "Q");
    study_fill_name(meaning[k], MEANING_BYTES, of_quantity[k].meaning, "Q");
    *listed = (struct result_listed){.name = name[k],
                                     .type = of_quantity[k].is_text ? "char" : "double",
                                     .unit = of_quantity[k].has_unit  ? "of Q"
                                             : of_quantity[k].is_text ? ""
                                                                      : "1",
                                     .meaning = meaning[k]};
    snprintf(listed->dimensions, sizeof listed->dimensions, "%sfish%s", of_quantity[k].by_key ? "key, " : "",
             of_quantity[k].is_text ? ", text" : "");

    return 1;
}

void error_report_define(struct netcdf_writer *writer, const struct error_study *study, const int dimensions[2]) {
    const int key = netcdf_define_dimension(writer, "key", (size_t)study->n_keys);
    const int level = netcdf_define_dimension(writer, "key_level", ERROR_STUDY_LEVELS);
    for (int i = 0; i < N_OF_KEY; i++) {
        const struct of_key *const row = &of_key[i];
        const int n = 1 + (row->by_level || row->type == NETCDF_TEXT);
        netcdf_define_variable(writer,
                               &(struct netcdf_variable){.name = row->name,
                                                         .long_name = row->meaning,
                                                         .units = "1",
                                                         .type = row->type,
                                                         .n_dimensions = n,
                                                         .dimension = {key, row->by_level ? level : dimensions[1]},
                                                         .has_gaps = row->type == NETCDF_DOUBLE});
    }

    for (int q = 0; q < study->n_asked; q++) {
        for (int i = 0; i < N_OF_QUANTITY; i++) {
            char name[NAME_BYTES], meaning[MEANING_BYTES];
            study_fill_name(name, sizeof name, of_quantity[i].name, name_of(study, q));
            study_fill_name(meaning, sizeof meaning, of_quantity[i].meaning, name_of(study, q));
            const int by_key = of_quantity[i].by_key, is_text = of_quantity[i].is_text;
            const char *const unit = member_file_quantity(study->quantity[q])->unit;
            netcdf_define_variable(writer, &(struct netcdf_variable){.name = name,
                                                                     .long_name = meaning,
                                                                     .units = of_quantity[i].has_unit ? unit : "1",
                                                                     .type = is_text ? NETCDF_TEXT : NETCDF_DOUBLE,
                                                                     .n_dimensions = 1 + by_key + is_text,
                                                                     .dimension = {by_key ? key : dimensions[0],
                                                                                   dimensions[0], dimensions[1]},
                                                                     .has_gaps = !is_text});
        }
    }
}

static void report_write_key(struct netcdf_writer *writer, const struct error_study *study, int k, size_t n_text,
                             char *text) {
    const struct error_study_key *const key = &study->key[k];
    const size_t start[] = {(size_t)k, 0}, all_text[] = {1, n_text}, one[] = {1, 1};
    const int is_choice = !report_is_error(key);
    const char *const texts[] = {[KEY_NAME] = key->row->path, [KEY_REASON] = key->n_levels == 1 ? key->objection : ""};
    const int *const ints[] = {
        [KEY_LEVELS] = &key->n_levels, [KEY_STATED] = &key->stated, [KEY_IS_CHOICE] = &is_choice};

    for (int i = KEY_NAME; i <= KEY_REASON; i++) {
        memset(text, 0, n_text);
        snprintf(text, n_text, "%s", texts[i]);
        netcdf_write_text(writer, netcdf_number(writer, of_key[i].name), start, all_text, text);
    }

    for (int i = KEY_LEVELS; i <= KEY_IS_CHOICE; i++) {
        netcdf_write_ints(writer, netcdf_number(writer, of_key[i].name), start, one, ints[i]);
    }

    const double design_order = sweep_error_order(&study->study, key->row);
    netcdf_write_doubles(writer, netcdf_number(writer, of_key[KEY_DESIGN_ORDER].name), start, one, &design_order);
    for (int i = 0; i < ERROR_STUDY_LEVELS; i++) {
        const size_t place[] = {(size_t)k, (size_t)i};
        const double value = i < key->n_levels ? key->value[i] : NAN;
        const int member = i < key->n_levels ? key->member[i] : -1;
        netcdf_write_doubles(writer, netcdf_number(writer, of_key[KEY_VALUE].name), place, one, &value);
        netcdf_write_ints(writer, netcdf_number(writer, of_key[KEY_MEMBER].name), place, one, &member);
    }
}

void error_report_write(struct netcdf_writer *writer, const struct error_study *study, size_t n_text, char *text) {
    for (int k = 0; k < study->n_keys; k++) report_write_key(writer, study, k, n_text, text);
    for (int q = 0; q < study->n_asked; q++) {
        char name[N_OF_QUANTITY][NAME_BYTES];
        for (int i = 0; i < N_OF_QUANTITY; i++) {
            study_fill_name(name[i], NAME_BYTES, of_quantity[i].name, name_of(study, q));
        }
        for (int f = 0; f < study->n_fish; f++) {
            const int place = error_plan_place(study, q, f);
            const size_t fish[] = {(size_t)f}, one[] = {1, 1};
            netcdf_write_doubles(writer, netcdf_number(writer, name[STATED]), fish, one, &study->value[place]);
            netcdf_write_doubles(writer, netcdf_number(writer, name[BAR]), fish, one, &study->error[place]);
            for (int k = 0; k < study->n_keys; k++) {
                const struct error_budget_result *const part = &study->key[k].part[place];
                const size_t start[] = {(size_t)k, (size_t)f, 0};
                netcdf_write_doubles(writer, netcdf_number(writer, name[PART]), start, one, &part->error);
                netcdf_write_doubles(writer, netcdf_number(writer, name[KEY_ORDER]), start, one, &part->order);
                memset(text, 0, n_text);
                if (study->key[k].n_levels > 1) write_reason(study, &study->key[k], place, text);
                netcdf_write_text(writer, netcdf_number(writer, name[KEY_FLAG]), start, (size_t[]){1, 1, n_text}, text);
            }
        }
    }
}
