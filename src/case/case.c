/* case.c: turns a tree into plain values, row by row of the table of keys. */
#include "case/case.h"

#include <stdio.h>
#include <string.h>

#include "case/case_check.h"
#include "case/case_merge.h"
#include "case/case_path.h"
#include "case/case_table.h"
#include "case/case_value.h"
#include "case/sweep.h"
#include "case/sweep_error.h"
#include "case/sweep_expect.h"

/* A case being read. The tree and the errors have an arena of their own. */
struct reading {
    struct case_values *values;
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

/* Read a node into the field of a key; false if it is no such value. A time in beats is kept apart until the
 * frequencies are known. */
static bool read_field(struct reading *reading, const struct key *key, int fish, const struct yaml_node *node,
                       const char *path, struct yaml_errors *errors) {
    struct case_values *const values = reading->values;
    void *const field = case_table_field(key, values, &values->school.fish[fish]);
    struct duration duration = {0};
    const bool is_time = key->type == DURATION;
    if (!case_value_read(values->arena, key, is_time ? &duration : field, node, path, errors)) return false;
    if (duration.is_in_beats) {
        case_table_add_beats(values, (struct case_beats){key, fish, duration.time, false});
        return true;
    }
    if (is_time) *(double *)field = duration.time;
    *case_table_state(values, key, fish) = KEY_WITH_VALUE;
    return true;
}

/* Read the value of one key, of the case or of each fish: what the case has, or else the default of the table, which
 * also stands in for a value that cannot be read. */
static void read_key(struct reading *reading, const struct key *key) {
    struct case_values *const values = reading->values;
    const struct case_tree *const tree = &reading->tree;
    const bool is_of_fish = case_table_is_of_fish(key);
    struct yaml_errors silent = {.arena = tree->arena};
    char path[128];

    // a value under defaults.fish, whose errors are reported once
    const struct yaml_node *const defaults = yaml_tree_find(tree->root, "defaults.fish");
    const struct yaml_node *const shared = is_of_fish ? yaml_tree_find(defaults, key->path + 5) : NULL;
    if (shared) {
        struct fish_parameters scratch;
        struct duration duration;
        void *const field = key->type == DURATION ? (void *)&duration : case_table_field(key, NULL, &scratch);
        snprintf(path, sizeof path, "defaults.%s", key->path);
        case_value_read(tree->arena, key, field, shared, path, &reading->errors);
    }

    // the default of the table
    const char *const initial = values->preset == PRESET_PUBLISHED && key->published ? key->published : key->initial;
    const struct yaml_source source = {
        .name = "default", .text = initial, .length = initial ? strlen(initial) : 0, .one_line = true};
    struct yaml_node *standard = NULL;
    if (initial) yaml_tree_read(tree->arena, &standard, &source, &silent);

    for (int i = 0; i < case_table_n_fields(key, values); i++) {
        bool is_default, is_read = true;
        const struct yaml_node *const node = case_merge_value(tree, key->path, i, &is_default);
        if (node) {
            snprintf(path, sizeof path, "%s", key->path);
            if (is_of_fish) snprintf(path, sizeof path, "fish[%d].%s", i, key->path + 5);
            is_read = read_field(reading, key, i, node, path, is_default ? &silent : &reading->errors);
        }
        if (standard && !(node && is_read)) read_field(reading, key, i, standard, key->path, &silent);
        if (!is_read) *case_table_state(values, key, i) = KEY_MISREAD;
        if (!node && !standard && !key->derived) {
            // a section that is written as a value ("time: 3") has been reported already
            char section[80] = "";
            const char *const dot = strrchr(key->path, '.');
            if (dot) snprintf(section, sizeof section, "%.*s", (int)(dot - key->path), key->path);
            const struct yaml_node *const above = yaml_tree_find(tree->root, section);
            if (above && above->kind != YAML_MAP) continue;
            yaml_errors_add(&reading->errors, case_merge_mark(tree, key->path, i), "%s: is required: %s%s%s", key->path,
                            key->meaning, *key->unit ? ", in " : "", key->unit);
        }
    }
}

/* Read the values from the tree. */
static void read_values(struct reading *reading) {
    struct case_values *const values = reading->values;
    const struct case_tree *const tree = &reading->tree;
    const int n_before = reading->errors.n, n_fish = case_merge_n_fish(tree);
    check_keys(tree->root, "", "", NULL, &reading->errors);
    const bool are_keys_known = reading->errors.n == n_before;
    if (n_fish == 0 && are_keys_known) {
        yaml_errors_add(&reading->errors, case_merge_mark(tree, "fish", 0),
                        "fish: at least one fish is required; write 'fish:' and on the next line '  - name: first'");
    }

    // read the preset first, because the defaults of other keys depend on the preset
    NEW(values->arena, values->school.fish, n_fish);
    values->school.n_fish = n_fish > CASE_MAX_FISH ? 0 : n_fish;
    NEW(values->arena, values->state, case_table_n * (n_fish > 1 ? n_fish : 1));
    const struct key *const preset = case_table_row("preset");
    read_key(reading, preset);
    for (int k = 0; k < case_table_n; k++) {
        if (&case_table[k] != preset) read_key(reading, &case_table[k]);
    }

    case_table_derive(values, tree->source[0]->name);
    sweep_read(values, tree->root, &reading->errors);
    sweep_expect_read(values, tree->root, &reading->errors);
    sweep_error_read(values, tree->root, &reading->errors);

    // skip the relations after an unknown key: a misspelt key has no value
    if (are_keys_known) case_check(values, tree, &reading->errors);
}

// ---- the complete case

/* Keep the texts: of the case file, the merged case, and the notes on the values of a case without errors. */
static void keep_texts(const struct reading *reading) {
    struct case_values *const values = reading->values;
    const struct case_tree *const tree = &reading->tree;
    const struct yaml_source *const source = tree->source[0];
    NEW(values->arena, values->text, source->length + 1);
    memcpy(values->text, source->text, source->length);

    // one line for each key at the top, with the name, which may come from the file
    struct text name = {.arena = values->arena}, merged = name, common = name;
    if (!yaml_tree_find(tree->root, "name")) {
        text_add(&name, "name: ");
        yaml_write_scalar(&name, values->name);
        text_add(&name, "\n");
        text_add(&merged, "%s", name.text);
        text_add(&common, "%s", name.text);
    }
    for (int i = 0; i < tree->root->n; i++) {
        const char *const key = tree->root->entry[i].key;
        struct text line = {.arena = values->arena};
        text_add(&line, "%s: ", key);
        yaml_write_node(&line, tree->root->entry[i].value);
        text_add(&line, "\n");
        text_add(&merged, "%s", line.text);
        if (strcmp(key, "sweep") != 0 && strcmp(key, "error") != 0) text_add(&common, "%s", line.text);
    }
    values->merged = merged.text;
    values->common = common.text;

    // the notes compare with a case of one fish and the same preset, without other keys
    struct case_values initial = {.arena = tree->arena};
    struct reading of_initial = {&initial, {.arena = tree->arena}, {.arena = tree->arena}};
    const char *const least = arena_text(tree->arena, "{format: 1, preset: %s, time: {end: 1}, fish: [{}]}",
                                         case_table_word(case_table_row("preset"), (int)values->preset));
    case_merge_read(&of_initial.tree, "default", least, strlen(least), NULL, &of_initial.errors);
    read_values(&of_initial);
    struct yaml_errors notes = {.arena = tree->arena};
    case_notes(values, &initial, tree, &notes);
    values->notes = yaml_errors_list(values->arena, &notes, "note");
}

/* Read a case from a file, or from a text that is not NULL. */
static enum status read_case(struct case_values *values, const char *origin, const char *text, size_t length,
                             const char *folder, int n_assignments, const char *const *assignments) {
    values->arena = arena_create(NULL, "the case");
    struct arena *const arena = arena_create(values->arena, "reading the case");
    struct reading reading = {values, {.arena = arena}, {.arena = arena}};
    TRY(case_merge_read(&reading.tree, origin, text, length, folder, &reading.errors));

    if (reading.tree.root) {
        for (int i = 0; i < n_assignments; i++) case_merge_assign(&reading.tree, assignments[i], &reading.errors);
        const char *const place = arena_text(arena, "%s%s", !text ? origin : folder ? folder : "", text ? "/" : "");
        case_merge_against(&reading.tree, text && !folder ? "" : place, &reading.errors);
        read_values(&reading);
        if (reading.errors.n == 0) keep_texts(&reading);
    }
    const enum status status = yaml_errors_status(&reading.errors);
    arena_free(arena);
    return status;
}

enum status case_parse(struct case_values *values, const char *text, size_t length, const char *origin,
                       const char *folder, int n_assignments, const char *const *assignments) {
    *values = (struct case_values){0};
    const enum status status = read_case(values, origin, text, length, folder, n_assignments, assignments);
    if (status != STATUS_OK) case_free(values);
    return status;
}

enum status case_read(struct case_values *values, const char *path, int n_assignments, const char *const *assignments) {
    return case_parse(values, NULL, 0, path, NULL, n_assignments, assignments);
}

void case_free(struct case_values *values) {
    arena_free(values->arena);
    *values = (struct case_values){0};
}

// ---- the case of a member

enum status case_member(struct case_values *values, const struct case_values *study, int member) {
    *values = (struct case_values){0};
    struct arena *const arena = arena_create(study->arena, "a member of a study");
    int n_keys = 0, n = 0;
    for (int a = 0; a < study->n_axes; a++) n_keys += study->sweep[a].n_keys;
    const char **assignments;
    NEW(arena, assignments, n_keys + 1);
    for (int a = 0; a < study->n_axes; a++) {
        const int value = sweep_member_value(study, member, a);
        for (int k = 0; k < study->sweep[a].n_keys; k++) {
            struct text text = {.arena = arena};
            if (sweep_add_assignment(&text, &study->sweep[a], value, k)) assignments[n++] = text.text;
        }
    }

    // without a sweep, a member expects nothing
    assignments[n++] = "sweep=[]";

    // a member of an error study may be one of the other case
    const struct sweep_axis *const first = study->n_axes > 0 ? &study->sweep[0] : NULL;
    const bool is_other = first && first->is_against && first->is_against[sweep_member_value(study, member, 0)];
    const char *const text = is_other ? study->error->against : study->common;
    const enum status status = case_parse(values, text, strlen(text), study->name, NULL, n, assignments);
    if (status == STATUS_CASE) {
        status_fail(STATUS_CASE, "member %d (%s):\n%s", member, sweep_member_text(arena, study, member),
                    status_message());
    }
    arena_free(arena);
    if (status != STATUS_OK) return status;
    values->member = member;
    values->text = arena_text(values->arena, "%s", study->text);
    values->study = arena_text(values->arena, "%s", study->merged);
    return STATUS_OK;
}
