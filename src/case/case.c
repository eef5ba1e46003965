/* case.c: from a tree to plain values, row by row of the table. */
#include "case/case.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body/bending_mode.h"
#include "case/case_check.h"
#include "case/case_merge.h"
#include "case/case_notes.h"
#include "case/case_path.h"
#include "case/case_table.h"
#include "case/case_times.h"
#include "case/case_value.h"
#include "case/sweep.h"
#include "case/sweep_error.h"
#include "case/sweep_expect.h"
#include "case/yaml_write.h"
#include "fish/fish_school.h"
#include "fish/fish_sheet.h"

/* A case being read. */
struct reading {
    struct case_tree tree;
    struct yaml_errors errors;
};

static enum status case_out_of_memory(void) {
    return status_fail(STATUS_MEMORY, "out of memory: the values of the case");
}

// ---- unknown keys

/* Add errors for the unknown keys of a map and of nested maps. section: path of the map in the table ("": the top);
 * path: path of the map in messages; owner: the fish with the map, or NULL. */
static void check_keys(const struct yaml_node *map, const char *section, const char *path, const char *owner,
                       struct yaml_errors *errors);

/* Require a node to be a map with known keys. */
static void check_map(const struct yaml_node *node, const char *section, const char *path, const char *owner,
                      struct yaml_errors *errors) {
    char shown[64];
    if (node->kind == YAML_MAP) {
        check_keys(node, section, path, owner, errors);
    } else {
        yaml_errors_add(errors, node->mark, "%s: expects a section with keys, got %s", path,
                        yaml_tree_describe(node, shown, sizeof shown));
    }
}

static void check_school(const struct yaml_node *node, struct yaml_errors *errors) {
    if (node->kind != YAML_LIST) {
        yaml_errors_add(errors, node->mark, "fish: expects a list; begin the keys of each fish with '- '");
        return;
    }

    if (node->n > CASE_MAX_FISH) {
        yaml_errors_add(errors, node->mark, "fish: more than %d fish", CASE_MAX_FISH);
        return;
    }

    for (int i = 0; i < node->n; i++) {
        char path[32];
        snprintf(path, sizeof path, "fish[%d]", i);
        check_map(node->entry[i].value, "fish", path, path, errors);
    }
}

static void check_defaults(const struct yaml_node *node, struct yaml_errors *errors) {
    if (node->kind != YAML_MAP) {
        yaml_errors_add(errors, node->mark, "defaults: expects {fish: {...}}");
        return;
    }

    for (int i = 0; i < node->n; i++) {
        const struct yaml_entry *const entry = &node->entry[i];
        if (strcmp(entry->key, "fish") == 0) {
            check_map(entry->value, "fish", "defaults.fish", "defaults.fish", errors);
        } else {
            yaml_errors_add(errors, entry->mark, "defaults.%.40s: unknown key; known here: fish", entry->key);
        }
    }
}

static void check_keys(const struct yaml_node *map, const char *section, const char *path, const char *owner,
                       struct yaml_errors *errors) {
    for (int i = 0; i < map->n; i++) {
        const struct yaml_entry *const entry = &map->entry[i];
        char pattern[128], full[256];
        snprintf(pattern, sizeof pattern, "%s%s%.50s", section, *section ? "." : "", entry->key);
        snprintf(full, sizeof full, "%s%s%.50s", path, *path ? "." : "", entry->key);
        const struct key *const key = case_table_row(pattern);
        if (strcmp(full, "fish") == 0) {
            check_school(entry->value, errors);
        } else if (key && key->type == DEFAULTS) {
            check_defaults(entry->value, errors);
        } else if (!key && case_table_is_section(pattern)) {
            check_map(entry->value, pattern, full, owner, errors);
        } else if (!key) {
            case_path_unknown(errors, entry->mark, full, section, entry->key, owner);
        }
    }
}

// ---- values

/* Read the default of a key. */
static enum status read_default(const struct key *key, const char *text, void *field) {
    const struct yaml_source source = {"default", (char *)text, strlen(text), 0, true};
    struct yaml_errors none = {0};
    struct yaml_node *node = NULL;
    enum status status = yaml_tree_read(&node, &source, &none);
    if (status == STATUS_OK) status = case_value_read(key, field, node, key->path, &none);
    yaml_tree_free(node);
    yaml_errors_free(&none);
    return status;
}

/* True if the section of a key is written as a value ("time: 3"): that has been reported already. */
static bool is_under_value(const struct case_tree *tree, const struct key *key) {
    char section[80] = "";
    const char *const dot = strrchr(key->path, '.');
    if (dot) snprintf(section, sizeof section, "%.*s", (int)(dot - key->path), key->path);
    const struct yaml_node *const node = yaml_tree_find(tree->root, section);
    return node && node->kind != YAML_MAP;
}

/* Read the value of one key of the case or of one fish; the field stays cleared if neither the case nor the table has
 * one. */
static enum status read_key(struct reading *reading, const struct key *key, int fish, enum preset preset, void *field) {
    bool is_default;
    const struct yaml_node *const node = case_merge_value(&reading->tree, key->path, fish, &is_default);

    if (node) {
        // errors in defaults.fish have been reported already
        struct yaml_errors silent = {0};
        char path[128];
        if (case_table_is_of_fish(key)) {
            snprintf(path, sizeof path, "fish[%d].%s", fish, key->path + 5);
        } else {
            snprintf(path, sizeof path, "%s", key->path);
        }
        const enum status status = case_value_read(key, field, node, path, is_default ? &silent : &reading->errors);
        yaml_errors_free(&silent);
        return status;
    }

    const char *const initial = preset == PRESET_PUBLISHED && key->published ? key->published : key->initial;
    if (initial) return read_default(key, initial, field);

    if (!key->derived && !is_under_value(&reading->tree, key)) {
        yaml_errors_add(&reading->errors, case_merge_mark(&reading->tree, key->path, fish), "%s: is required: %s%s%s",
                        key->path, key->meaning, *key->unit ? ", in " : "", key->unit);
    }

    return STATUS_OK;
}

/* Check each value under defaults.fish by reading the value once. */
static enum status check_default_values(struct reading *reading) {
    const struct yaml_node *const defaults = yaml_tree_find(reading->tree.root, "defaults.fish");
    struct fish_parameters scratch;
    enum status status = STATUS_OK;

    for (int k = 0; k < case_table_n && status == STATUS_OK; k++) {
        const struct key *const key = &case_table[k];
        if (!case_table_is_of_fish(key)) continue;
        const struct yaml_node *const node = yaml_tree_find(defaults, key->path + 5);
        if (!node) continue;
        void *const field = case_table_field(key, NULL, &scratch);
        char path[128];
        snprintf(path, sizeof path, "defaults.%s", key->path);
        case_value_clear(key, field);
        status = case_value_read(key, field, node, path, &reading->errors);
        case_value_free(key, field);
    }

    return status;
}

/* Mark all values as not read. */
static void clear(struct case_values *values) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (!case_table_is_of_fish(key)) case_value_clear(key, case_table_field(key, values, NULL));
        for (int i = 0; i < values->school.n_fish && case_table_is_of_fish(key); i++) {
            case_value_clear(key, case_table_field(key, values, &values->school.fish[i]));
        }
    }
}

/* Read every key of the table. */
static enum status read_keys(struct reading *reading, struct case_values *values) {
    const struct key *const preset = case_table_row("preset");
    TRY(read_key(reading, preset, 0, PRESET_NONE, &values->preset));

    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (key == preset || !case_table_is_value(key)) continue;
        if (!case_table_is_of_fish(key)) {
            TRY(read_key(reading, key, 0, values->preset, case_table_field(key, values, NULL)));
            continue;
        }
        for (int i = 0; i < values->school.n_fish; i++) {
            TRY(read_key(reading, key, i, values->preset, case_table_field(key, values, &values->school.fish[i])));
        }
    }

    return STATUS_OK;
}

// ---- derived defaults, described in the table

/* Replace a value that was not read by the default. */
static void derive(double *value, double standard) {
    if (isnan(*value)) *value = standard;
}

static enum status derive_fish(struct fish_parameters *fish, int index) {
    const double period = fish->wave.frequency > 0 ? 1 / fish->wave.frequency : 0;
    if (fish->sheet_points == 0) {
        const int usual = fish->nodes > 17 ? 2 * fish->nodes - 1 : 33, of_depth = fish_sheet_least(fish);
        fish->sheet_points = usual > of_depth ? usual : of_depth;
    }
    derive(&fish->body.tail_thickness, fish->body.profile == PROFILE_JOUKOWSKI ? 0.04 : 0);
    const double beat = case_times_beat(fish);
    derive(&fish->body.relaxation_time, beat > 0 ? 0.02 / beat : 0);
    derive(&fish->wave.ramp, period);
    const bool has_pressure = fish->force == FORCE_PRESSURE;
    if ((int)fish->drag.skin < 0) fish->drag.skin = has_pressure ? SKIN_BOUNDARY_LAYER : SKIN_QUADRATIC;
    derive(&fish->drag.normal, has_pressure ? 0 : 1);
    if (!isnan(fish->wave.wavelength)) fish->wave.number = -2 * 3.14159265358979323846 / fish->wave.wavelength;
    fish->wave.wavelength = NAN;
    derive(&fish->control.filter, period);
    derive(&fish->control.ramp, period > 0 ? period / 2 : 1);
    derive(&fish->motion.speed, fish->start_speed);
    if ((int)fish->control.law < 0) fish->control.law = fish->control.waypoints.n > 0 ? CONTROL_COURSE : CONTROL_NONE;

    if (!fish->name) {
        char name[32];
        snprintf(name, sizeof name, "fish%d", index + 1);
        if (!(fish->name = strdup(name))) return case_out_of_memory();
    }

    if (fish->control.desired_heading.n == 0) {
        double *const pair = calloc(2, sizeof *pair);
        if (!pair) return case_out_of_memory();
        pair[1] = fish->start_heading;
        fish->control.desired_heading = (struct number_list){.n = 1, .value = pair};
    }

    return STATUS_OK;
}

/* The name of a file without folders and ending. */
static char *stem(const char *path) {
    const char *const slash = strrchr(path, '/');
    const char *const from = slash ? slash + 1 : path;
    const char *const dot = strrchr(from, '.');
    const size_t length = dot && dot > from ? (size_t)(dot - from) : strlen(from);
    return length > 0 ? strndup(from, length) : strdup("case");
}

/* Whether the stiffness of every body is damped enough for the order 3: doc/numerics.md, section 3. */
static bool are_damped(const struct school_parameters *school) {
    for (int i = 0; i < school->n_fish; i++) {
        const struct fish_parameters *const fish = &school->fish[i];
        const double periods = fish->body.relaxation_time * case_times_beat(fish);
        if (!(periods > 0.001 * (1 - 1e-9))) return false;
    }
    return true;
}

/* True if the slowest bending mode of a fish is below 0.6 of the beat frequency. */
static enum status is_soft(const struct school_parameters *parameters, int index, bool *soft) {
    struct school_parameters alone = *parameters;
    alone.n_fish = 1;
    alone.fish = &parameters->fish[index];
    struct school *school;
    TRY(fish_school_create(&school, &alone));
    const struct fish *const fish = &school->fish[0];
    double *const scratch = calloc(6 * (size_t)fish->n_nodes, sizeof *scratch);
    if (scratch) *soft = bending_mode_frequency(fish, scratch) < 0.6 * fish->frequency;
    free(scratch);
    fish_school_free(school);
    return scratch ? STATUS_OK : case_out_of_memory();
}

/* The default of solver.order (doc/numerics.md, section 3); the values must be checked. */
static enum status derive_order(struct case_values *values) {
    const struct school_parameters *const school = &values->school;
    if (values->solver.order > 0) return STATUS_OK;
    values->solver.order = 2;
    if (!are_damped(school)) return STATUS_OK;
    bool soft = true;
    for (int i = 0; i < school->n_fish && soft; i++) TRY(is_soft(school, i, &soft));
    values->solver.order = soft ? 5 : 3;
    return STATUS_OK;
}

/* The longest period of a beat in the school, s; 0 where no fish beats. */
static double longest_period(const struct school_parameters *school) {
    double longest = 0;
    for (int i = 0; i < school->n_fish; i++) {
        const struct fish_parameters *const fish = &school->fish[i];
        const int is_given = fish->motion.prescribed > PRESCRIBED_NONE && fish->motion.frequency > 0;
        const double frequency = is_given ? fish->motion.frequency : fish->wave.frequency;
        if (frequency > 0) longest = fmax(longest, 1 / frequency);
    }
    return longest;
}

static void derive_wake(struct school_parameters *school) {
    struct wake_parameters *const wake = &school->wake;
    const double period = longest_period(school);
    if (isnan(wake->lifetime.seconds) && period > 0) derive(&wake->lifetime.beats, 3);
    derive(&wake->lifetime.seconds, wake->lifetime.beats * period);
    derive(&wake->lifetime.seconds, 2);
    if (isnan(wake->decay.seconds) && period > 0) derive(&wake->decay.beats, 0.75 * wake->lifetime.beats);
    derive(&wake->decay.seconds, wake->decay.beats * period);
    derive(&wake->decay.seconds, 0.75 * wake->lifetime.seconds);
    const bool is_sheet = wake->shedding == SHEDDING_SHEET;
    derive(&wake->taper, is_sheet ? 0.6 : 0);
    derive(&wake->taper_beside, is_sheet ? 0.07 : 0);
    derive(&wake->tolerance, school->rtol / 100);
}

static enum status derive_all(struct case_values *values, const char *origin) {
    case_times_derive(values);
    derive(&values->time.output_interval, 10 * values->school.shedding_interval);
    derive_wake(&values->school);
    derive(&values->output.wake_interval, values->time.output_interval);
    if (!values->name && !(values->name = stem(origin))) return case_out_of_memory();
    for (int i = 0; i < values->school.n_fish; i++) TRY(derive_fish(&values->school.fish[i], i));
    return STATUS_OK;
}

// ---- the complete case

/* Read the values from the tree. Errors of the case are added to the list; fails with STATUS_MEMORY only. */
static enum status fill_case(struct reading *reading, struct case_values *values) {
    const struct case_tree *const tree = &reading->tree;
    const int n_before = reading->errors.n;
    check_keys(tree->root, "", "", NULL, &reading->errors);
    const bool are_keys_known = reading->errors.n == n_before;

    values->school.n_fish = case_merge_n_fish(tree);
    if (values->school.n_fish > CASE_MAX_FISH) values->school.n_fish = 0;
    values->school.fish = calloc((size_t)values->school.n_fish + 1, sizeof *values->school.fish);

    if (!values->school.fish) {
        values->school.n_fish = 0;
        return case_out_of_memory();
    }

    clear(values);
    if (case_merge_n_fish(tree) == 0 && are_keys_known) {
        yaml_errors_add(&reading->errors, case_merge_mark(tree, "fish", 0),
                        "fish: at least one fish is required; write 'fish:' and on the next line '  - name: first'");
    }

    TRY(check_default_values(reading));
    TRY(read_keys(reading, values));
    TRY(derive_all(values, tree->source[0]->name));
    TRY(sweep_read(values, tree->root, &reading->errors));
    TRY(sweep_expect_read(values, tree->root, &reading->errors));
    TRY(sweep_error_read(values, tree->root, &reading->errors));

    // skip the relations after an unknown key: it can be a misspelt key, whose value is then missing
    if (are_keys_known) case_check(values, tree, &reading->errors);
    return reading->errors.n > n_before ? STATUS_OK : derive_order(values);
}

/* Keep the text of the case file. */
static enum status keep_text(struct case_values *values, const struct yaml_source *source) {
    values->text = malloc(source->length + 1);
    if (!values->text) return case_out_of_memory();
    memcpy(values->text, source->text, source->length);
    values->text[source->length] = '\0';
    return STATUS_OK;
}

/* Keep the merged case, one line for each key at the top, with the name, which may come from the file. */
static enum status keep_merged(struct case_values *values, const struct yaml_node *root) {
    struct text text = {0};
    if (!yaml_tree_find(root, "name")) {
        text_add(&text, "name: ");
        yaml_write_scalar(&text, values->name);
        text_add(&text, "\n");
    }

    for (int i = 0; i < root->n; i++) {
        text_add(&text, "%s: ", root->entry[i].key);
        yaml_write_node(&text, root->entry[i].value);
        text_add(&text, "\n");
    }

    values->merged = text.text;
    if (!text.failed) return STATUS_OK;
    text_free(&text);
    values->merged = NULL;
    return case_out_of_memory();
}

/* Keep the notes on the values of a case without errors. */
static enum status keep_notes(struct case_values *values, const struct case_tree *tree) {
    struct yaml_errors notes = {0};
    case_notes(values, tree, &notes);
    values->notes = yaml_errors_list(&notes, "note");
    yaml_errors_free(&notes);
    return values->notes ? STATUS_OK : case_out_of_memory();
}

/* Apply the assignments to the tree, and fill the values from the tree. status: of reading the tree. */
static enum status finish(struct reading *reading, enum status status, struct case_values *values, int n_assignments,
                          const char *const *assignments) {
    if (status == STATUS_OK && reading->tree.root) {
        for (int i = 0; i < n_assignments && status == STATUS_OK; i++) {
            status = case_merge_assign(&reading->tree, assignments[i], &reading->errors);
        }
        if (status == STATUS_OK) status = fill_case(reading, values);
        if (status == STATUS_OK) status = keep_text(values, reading->tree.source[0]);
        if (status == STATUS_OK && reading->errors.n == 0) status = keep_merged(values, reading->tree.root);
        if (status == STATUS_OK && reading->errors.n == 0) status = keep_notes(values, &reading->tree);
    }

    if (status == STATUS_OK) status = yaml_errors_status(&reading->errors);
    if (status != STATUS_OK) case_free(values);
    yaml_errors_free(&reading->errors);
    case_merge_free(&reading->tree);
    return status;
}

enum status case_read(struct case_values *values, const char *path, int n_assignments, const char *const *assignments) {
    *values = (struct case_values){0};
    struct reading reading = {0};
    const enum status status = case_merge_read_file(&reading.tree, path, &reading.errors);
    return finish(&reading, status, values, n_assignments, assignments);
}

enum status case_parse(struct case_values *values, const char *text, size_t length, const char *origin,
                       const char *folder, int n_assignments, const char *const *assignments) {
    *values = (struct case_values){0};
    struct reading reading = {0};
    const enum status status = case_merge_read_text(&reading.tree, text, length, origin, folder, &reading.errors);
    return finish(&reading, status, values, n_assignments, assignments);
}

void case_free(struct case_values *values) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        if (!case_table_is_value(key)) continue;
        if (!case_table_is_of_fish(key)) case_value_free(key, case_table_field(key, values, NULL));
        for (int i = 0; i < values->school.n_fish && case_table_is_of_fish(key); i++) {
            case_value_free(key, case_table_field(key, values, &values->school.fish[i]));
        }
    }

    sweep_error_free(values);
    sweep_expect_free(values);
    sweep_free(values);
    free(values->school.fish);
    free(values->text);
    free(values->merged);
    free(values->notes);
    free(values->study);
    *values = (struct case_values){0};
}
