/* case.c: from a tree to plain values, row by row of the table. */
#include "case/case.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "case/case_merge.h"
#include "case/case_path.h"
#include "case/case_table.h"
#include "case/sweep.h"
#include "case/sweep_error.h"

/* A case being read. */
struct reading {
    struct case_tree tree;
    struct yaml_errors errors;
};

// ---- unknown keys

/* Add errors for the unknown keys of a map and of nested maps. section: path of the map in the table ("": the top);
 * path: path of the map in messages; owner: the fish with the map, or NULL. */
static void check_keys(const struct yaml_node *map, const char *section, const char *path, const char *owner,
                       struct yaml_errors *errors) {
    if (map->kind != YAML_MAP) {
        char shown[64];
        yaml_errors_add(errors, map->mark, "%s: expects a section with keys, got %s", path,
                        yaml_tree_describe(map, shown, sizeof shown));
        return;
    }

    for (int i = 0; i < map->n; i++) {
        const struct yaml_entry *const entry = &map->entry[i];
        const struct yaml_node *const value = entry->value;
        char pattern[128], full[256];
        snprintf(pattern, sizeof pattern, "%s%s%.50s", section, *section ? "." : "", entry->key);
        snprintf(full, sizeof full, "%s%s%.50s", path, *path ? "." : "", entry->key);
        const struct key *const key = case_table_row(pattern);

        if (strcmp(full, "fish") == 0) {
            if (value->kind != YAML_LIST) {
                yaml_errors_add(errors, value->mark, "fish: expects a list; begin the keys of each fish with '- '");
            } else if (value->n > CASE_MAX_FISH) {
                yaml_errors_add(errors, value->mark, "fish: more than %d fish", CASE_MAX_FISH);
            }
            for (int f = 0; value->kind == YAML_LIST && f < value->n && value->n <= CASE_MAX_FISH; f++) {
                char fish[32];
                snprintf(fish, sizeof fish, "fish[%d]", f);
                check_keys(value->entry[f].value, "fish", fish, fish, errors);
            }
        } else if (key && key->type == DEFAULTS) {
            if (value->kind != YAML_MAP) yaml_errors_add(errors, value->mark, "defaults: expects {fish: {...}}");
            for (int k = 0; value->kind == YAML_MAP && k < value->n; k++) {
                const struct yaml_entry *const of = &value->entry[k];
                if (strcmp(of->key, "fish") == 0) {
                    check_keys(of->value, "fish", "defaults.fish", "defaults.fish", errors);
                } else {
                    yaml_errors_add(errors, of->mark, "defaults.%.40s: unknown key; known here: fish", of->key);
                }
            }
        } else if (!key && case_table_is_section(pattern)) {
            check_keys(value, pattern, full, owner, errors);
        } else if (!key) {
            case_path_unknown(errors, entry->mark, full, section, entry->key, owner);
        }
    }
}

// ---- values

/* The number of fields of a key: one for each fish, or one. */
static int n_fields(const struct key *key, const struct case_values *values) {
    if (!case_table_is_value(key)) return 0;
    return case_table_is_of_fish(key) ? values->school.n_fish : 1;
}

static void *field_at(const struct key *key, struct case_values *values, int i) {
    return case_table_field(key, values, case_table_is_of_fish(key) ? &values->school.fish[i] : NULL);
}

/* Read the value of one key of the case or of one fish. The field stays cleared if neither the case nor the table has
 * a value. */
static enum status read_field(struct reading *reading, const struct key *key, int fish, enum preset preset,
                              void *field) {
    struct yaml_errors silent = {0};
    enum status status = STATUS_OK;
    bool is_default;
    const struct yaml_node *const node = case_merge_value(&reading->tree, key->path, fish, &is_default);
    const char *const initial = preset == PRESET_PUBLISHED && key->published ? key->published : key->initial;

    if (node) {
        // errors in defaults.fish have been reported already
        char path[128];
        if (case_table_is_of_fish(key)) {
            snprintf(path, sizeof path, "fish[%d].%s", fish, key->path + 5);
        } else {
            snprintf(path, sizeof path, "%s", key->path);
        }
        status = case_value_read(key, field, node, path, is_default ? &silent : &reading->errors);
    } else if (initial) {
        const struct yaml_source source = {
            .name = "default", .text = initial, .length = strlen(initial), .one_line = true};
        struct yaml_node *standard = NULL;
        status = yaml_tree_read(&standard, &source, &silent);
        if (status == STATUS_OK) status = case_value_read(key, field, standard, key->path, &silent);
        yaml_tree_free(standard);
    } else if (!key->derived) {
        // a section that is written as a value ("time: 3") has been reported already
        char section[80] = "";
        const char *const dot = strrchr(key->path, '.');
        if (dot) snprintf(section, sizeof section, "%.*s", (int)(dot - key->path), key->path);
        const struct yaml_node *const above = yaml_tree_find(reading->tree.root, section);
        if (!above || above->kind == YAML_MAP) {
            yaml_errors_add(&reading->errors, case_merge_mark(&reading->tree, key->path, fish),
                            "%s: is required: %s%s%s", key->path, key->meaning, *key->unit ? ", in " : "", key->unit);
        }
    }

    yaml_errors_free(&silent);
    return status;
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

/* Read the values from the tree. Errors of the case are added to the list; fails with STATUS_MEMORY only. */
static enum status case_read_values(struct reading *reading, struct case_values *values) {
    const struct case_tree *const tree = &reading->tree;
    const int n_before = reading->errors.n, n_fish = case_merge_n_fish(tree);
    check_keys(tree->root, "", "", NULL, &reading->errors);
    const bool are_keys_known = reading->errors.n == n_before;
    if (n_fish == 0 && are_keys_known) {
        yaml_errors_add(&reading->errors, case_merge_mark(tree, "fish", 0),
                        "fish: at least one fish is required; write 'fish:' and on the next line '  - name: first'");
    }

    TRY(MEMORY_NEW(values->school.fish, n_fish, "the fish of the case"));
    values->school.n_fish = n_fish > CASE_MAX_FISH ? 0 : n_fish;
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        for (int i = 0; i < n_fields(key, values); i++) case_value_clear(key, field_at(key, values, i));
    }

    // read the preset first, because the defaults of other keys depend on the preset
    TRY(check_default_values(reading));
    const struct key *const preset = case_table_row("preset");
    TRY(read_field(reading, preset, 0, PRESET_NONE, &values->preset));
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        for (int i = 0; i < n_fields(key, values) && key != preset; i++) {
            TRY(read_field(reading, key, i, values->preset, field_at(key, values, i)));
        }
    }

    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        for (int i = 0; i < n_fields(key, values) && key->derive; i++) {
            TRY(key->derive(&(struct key_place){values, &values->school.fish[i], tree->source[0]->name}));
        }
    }

    TRY(sweep_read(values, tree->root, &reading->errors));
    TRY(sweep_expect_read(values, tree->root, &reading->errors));
    TRY(sweep_error_read(values, tree->root, &reading->errors));

    // skip the relations after an unknown key: a misspelt key has no value
    if (are_keys_known) case_check(values, tree, &reading->errors);
    return STATUS_OK;
}

// ---- the complete case

/* Read the case with one fish, a preset, and no other key. */
static enum status read_initial(struct case_values *values, enum preset preset) {
    char text[96];
    snprintf(text, sizeof text, "{format: 1, preset: %s, time: {end: 1}, fish: [{}]}",
             case_table_word(case_table_row("preset"), (int)preset));
    struct reading reading = {0};
    enum status status = case_merge_read_text(&reading.tree, text, strlen(text), "default", NULL, &reading.errors);
    if (status == STATUS_OK && reading.tree.root) status = case_read_values(&reading, values);
    if (status == STATUS_OK) status = yaml_errors_status(&reading.errors);
    yaml_errors_free(&reading.errors);
    case_merge_free(&reading.tree);
    return status;
}

/* Keep the texts: of the case file, the merged case, and the notes on the values of a case without errors. */
static enum status keep_texts(struct case_values *values, const struct case_tree *tree) {
    const struct yaml_source *const source = tree->source[0];
    TRY(MEMORY_NEW(values->text, source->length + 1, "the text of the case"));
    memcpy(values->text, source->text, source->length);

    // one line for each key at the top, with the name, which may come from the file
    struct text text = {0};
    if (!yaml_tree_find(tree->root, "name")) {
        text_add(&text, "name: ");
        yaml_write_scalar(&text, values->name);
        text_add(&text, "\n");
    }
    for (int i = 0; i < tree->root->n; i++) {
        text_add(&text, "%s: ", tree->root->entry[i].key);
        yaml_write_node(&text, tree->root->entry[i].value);
        text_add(&text, "\n");
    }
    TRY(text_take(&text, &values->merged, "the text of the case"));

    struct case_values initial = {0};
    struct yaml_errors notes = {0};
    enum status status = read_initial(&initial, values->preset);
    if (status == STATUS_OK) {
        case_notes(values, &initial, tree, &notes);
        status = yaml_errors_list(&notes, "note", &values->notes);
    }
    yaml_errors_free(&notes);
    case_free(&initial);
    return status;
}

/* Apply the assignments to the tree, and fill the values from the tree. status: of reading the tree. */
static enum status finish_reading(struct reading *reading, enum status status, struct case_values *values,
                                  int n_assignments, const char *const *assignments) {
    if (status == STATUS_OK && reading->tree.root) {
        for (int i = 0; i < n_assignments && status == STATUS_OK; i++) {
            status = case_merge_assign(&reading->tree, assignments[i], &reading->errors);
        }
        if (status == STATUS_OK) status = case_read_values(reading, values);
        if (status == STATUS_OK && reading->errors.n == 0) status = keep_texts(values, &reading->tree);
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
    return finish_reading(&reading, status, values, n_assignments, assignments);
}

enum status case_parse(struct case_values *values, const char *text, size_t length, const char *origin,
                       const char *folder, int n_assignments, const char *const *assignments) {
    *values = (struct case_values){0};
    struct reading reading = {0};
    const enum status status = case_merge_read_text(&reading.tree, text, length, origin, folder, &reading.errors);
    return finish_reading(&reading, status, values, n_assignments, assignments);
}

void case_free(struct case_values *values) {
    for (int k = 0; k < case_table_n; k++) {
        const struct key *const key = &case_table[k];
        for (int i = 0; i < n_fields(key, values); i++) case_value_free(key, field_at(key, values, i));
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

// ---- the case of a member

/* Read the case of a member and store the number of the member. */
static enum status case_read_member(struct case_values *values, const struct case_values *study, int member,
                                    int n_assignments, char **assignments) {
    const enum status status = case_parse(values, study->merged, strlen(study->merged), study->name, NULL,
                                          n_assignments, (const char *const *)assignments);
    if (status == STATUS_CASE) {
        char *text;
        TRY(sweep_member_text(study, member, &text));
        status_fail(STATUS_CASE, "member %d (%s):\n%s", member, text, status_message());
        free(text);
    }
    TRY(status);

    free(values->text);
    values->member = member;
    enum status copied = memory_copy_string(&values->text, study->text, "the case of a member");
    if (copied == STATUS_OK) copied = memory_copy_string(&values->study, study->merged, "the case of a member");
    if (copied != STATUS_OK) case_free(values);
    return copied;
}

enum status case_member(struct case_values *values, const struct case_values *study, int member) {
    *values = (struct case_values){0};
    int n_keys = 0, n = 0;
    for (int a = 0; a < study->n_axes; a++) n_keys += study->sweep[a].n_keys;
    char **assignments;
    TRY(MEMORY_NEW(assignments, n_keys + 2, "the values of a member"));

    // the assignments of the member, and two that remove the sweep and the errors
    enum status status = STATUS_OK;
    for (int a = 0; a < study->n_axes; a++) {
        const int value = sweep_member_value(study, member, a);
        for (int k = 0; k < study->sweep[a].n_keys && status == STATUS_OK; k++) {
            struct text text = {0};
            sweep_add_assignment(&text, &study->sweep[a], value, k);
            status = text_take(&text, &assignments[n++], "the values of a member");
        }
    }
    for (int i = 0; i < 2 && status == STATUS_OK; i++) {
        const char *const no_study = i == 0 ? "sweep=[]" : "error=none";
        if (i == 1 && !study->error) break;
        status = memory_copy_string(&assignments[n++], no_study, "the values of a member");
    }

    if (status == STATUS_OK) status = case_read_member(values, study, member, n, assignments);
    for (int i = 0; i < n; i++) free(assignments[i]);
    free(assignments);
    return status;
}
