/* sweep_error.c: see sweep_error.h. */
#include "case/sweep_error.h"

#include <math.h>
#include <string.h>

#include "case/sweep.h"

#define OF_PRESSURE .switch_path = "fish.force", .switch_value = FORCE_PRESSURE
#define OF_LAYER .switch_path = "fish.drag.skin", .switch_value = FRICTION_BOUNDARY_LAYER

/* The table that studies of convergence, error bars and doc/studies.md share. */
const struct sweep_error_key sweep_error_keys[SWEEP_N_ERROR_KEYS] = {
    {"fish.nodes", NULL, SWEEP_POINTS, {1 / 1.5, 1 / 2.0}, 1.4, .order = 2},
    {"fish.sheet_points", NULL, SWEEP_POINTS, {1 / 1.4, 1 / 2.0}, 1.4, .order = 1},
    {"time.shedding_interval", NULL, SWEEP_SPACING, {2, 4}, 0.5, .order = 1},  // of a sheet: see sweep_error_order
    {"solver.rtol", NULL, SWEEP_SPACING, {10, 0}, 0.1, .order = 1},
    {"solver.step", NULL, SWEEP_SPACING, {2, 4}, 0.5, .order = 1},  // of the first order: see sweep_error_order
    {"wake.tolerance", NULL, SWEEP_SPACING, {10, 0}, 0.1, .order = 1},
    {"wake.lifetime", "wake.decay", SWEEP_DURATION, {1 / 2.0, 0}, 2, .order = 1},
    {"wake.smoothing", NULL, SWEEP_MODEL, {0, 0}, 0.5, .order = 1},
    {"sheet.smoothing", NULL, SWEEP_MODEL, {0, 0}, 0.5, .order = 1},
    {"wake.taper", "wake.taper_beside", SWEEP_MODEL, {0, 0}, 0.5, .order = 1},
    {"wake.leg_length", NULL, SWEEP_MODEL, .n_levels = 2, .level = {0.5, 2}, .switch_path = "fish.pressure.span",
     .switch_value = SPAN_FINITE},
    {"fish.force", "fish.drag.skin", SWEEP_MODEL, .n_levels = 2, .level = {FORCE_REACTIVE, FORCE_PRESSURE}},
    {"fish.pressure.span", NULL, SWEEP_MODEL, .n_levels = 2, .level = {SPAN_FINITE, SPAN_INFINITE}, OF_PRESSURE},
    {"fish.pressure.suction_limit", NULL, SWEEP_MODEL, .n_levels = 2, .level = {0.11, 0.25}, OF_PRESSURE},
    {"fish.drag.form", NULL, SWEEP_MODEL, .n_levels = 1, .level = {1}, OF_LAYER},
    {"fish.drag.waving", NULL, SWEEP_MODEL, .n_levels = 2, .level = {1, 2}, OF_LAYER},
    {"fish.drag.transition", NULL, SWEEP_MODEL, .n_levels = 2, .level = {0, 1e8}, OF_LAYER},
    {"fish.drag.normal", NULL, SWEEP_MODEL, .n_levels = 2, .level = {0, 2}},
    {"fish.body.relaxation_time", NULL, SWEEP_MODEL, {4, 0}, 0.25, .order = 1},
    {"fish.body.tail_thickness", NULL, SWEEP_MODEL, {2, 0}, 0.5, .order = 1},
};

#define INPUT .kind = SWEEP_INPUT
#define WITH(path, value) .switch_path = path, .switch_value = value
const struct sweep_error_key sweep_inputs[SWEEP_N_INPUTS] = {
    {"fish.length", INPUT},
    {"fish.body.thickness", INPUT},
    {"fish.body.tail_thickness", INPUT, WITH("fish.body.profile", PROFILE_JOUKOWSKI)},
    {"fish.body.depth", INPUT},
    {"fish.body.density", INPUT},
    {"fish.body.modulus", INPUT},
    {"fish.body.bending_damping", INPUT},
    {"fish.body.stretching_damping", INPUT},
    {"fish.body.relaxation_time", INPUT},
    {"fish.wave.amplitude", INPUT},
    {"fish.wave.constant", INPUT},
    {"fish.wave.linear", INPUT},
    {"fish.wave.quadratic", INPUT},
    {"fish.wave.number", INPUT},
    {"fish.wave.frequency", INPUT},
    {"fish.motion.speed", INPUT},
    {"fish.motion.heave", INPUT},
    {"fish.motion.pitch", INPUT},
    {"fish.motion.frequency", INPUT},
    {"fish.drag.tangential", INPUT, WITH("fish.drag.skin", FRICTION_QUADRATIC)},
    {"fish.drag.transition", INPUT, OF_LAYER},
    {"fish.drag.waving", INPUT, OF_LAYER},
    {"fish.drag.form", INPUT, OF_LAYER},
    {"fish.drag.normal", INPUT},
    {"fish.pressure.suction", INPUT, OF_PRESSURE},
    {"fish.pressure.suction_limit", INPUT, OF_PRESSURE},
    {"fluid.density", INPUT},
    {"fluid.viscosity", INPUT},
    {"wake.smoothing", INPUT},
    {"sheet.smoothing", INPUT},
};

const struct sweep_error_key *sweep_error_find(const char *path) {
    for (int i = 0; i < SWEEP_N_ERROR_KEYS; i++) {
        if (strcmp(sweep_error_keys[i].path, path) == 0) return &sweep_error_keys[i];
    }
    return NULL;
}

/* The last word of the path of a key; the whole path if the row before has this word. */
static const char *short_name(const struct sweep_error_key *key) {
    const char *const last = strrchr(key->path, '.') + 1;
    const bool is_taken = key > sweep_error_keys && strcmp(strrchr(key[-1].path, '.') + 1, last) == 0;
    return is_taken ? key->path : last;
}

double sweep_error_order(const struct case_values *values, const struct sweep_error_key *key) {
    if (strcmp(key->path, "solver.step") == 0) return methods_table[values->solver.method].order;

    // continuous shedding is of second order, but it converges to a wake that is wrong next to the edge
    // (doc/numerics.md, section 5)
    const bool is_interval = strcmp(key->path, "time.shedding_interval") == 0;
    if (is_interval && values->school.wake.shedding == SHEDDING_CONTINUOUS) return 2;
    return key->order > 0 ? key->order : NAN;
}

// ---- reading

bool sweep_error_is_file(const char *against) {
    const char *const ending = strrchr(against, '.');
    return ending && (strcmp(ending, ".yaml") == 0 || strcmp(ending, ".yml") == 0);
}

/* Read the levels of one key: a list of numbers, or default. */
static void read_levels(struct arena *arena, struct sweep_error_levels *levels, const struct yaml_node *node,
                        struct yaml_errors *errors) {
    if (node->kind == YAML_SCALAR && strcmp(node->text, "default") == 0) return;
    bool is_wrong = node->kind != YAML_LIST || node->n < 2, are_wrong_points = false;
    NEW(arena, levels->value, node->n);

    for (int i = 0; i < node->n && !is_wrong; i++) {
        const struct yaml_node *const number = node->entry[i].value;
        is_wrong = number->kind != YAML_SCALAR || !text_number(number->text, &levels->value[i]) ||
                   !(levels->value[i] > 0) || !isfinite(levels->value[i]);
        are_wrong_points |=
            !is_wrong && levels->key->kind == SWEEP_POINTS && fabs(rint(levels->value[i]) - levels->value[i]) > 0;
        for (int j = 0; j < i && !is_wrong; j++) is_wrong = !(fabs(levels->value[j] - levels->value[i]) > 0);
        levels->n++;
    }

    if (is_wrong) {
        yaml_errors_add(errors, node->mark, "error.keys: expects 'default', or at least two different levels above 0");
    } else if (are_wrong_points) {
        yaml_errors_add(errors, node->mark, "error.keys: levels of '%s' are integers", levels->key->path);
    } else if (node->n > SWEEP_ERROR_LEVELS) {
        yaml_errors_add(errors, node->mark, "error.keys: more than %d levels of '%s'", SWEEP_ERROR_LEVELS,
                        levels->key->path);
    }
}

/* Read "keys": default, a list of keys, or a map of levels. A key is "nodes", "fish.nodes" or "fish[*].nodes". */
static void read_keys(struct arena *arena, struct sweep_error *error, const struct yaml_node *keys,
                      struct yaml_errors *errors) {
    if (keys->kind == YAML_SCALAR && strcmp(keys->text, "default") == 0) return;
    if (keys->kind == YAML_SCALAR || keys->n == 0) {
        yaml_errors_add(errors, keys->mark,
                        "error.keys: expects 'default', a list of keys, or levels, as in {nodes: [13, 17, 25, 35]}");
        return;
    }

    NEW(arena, error->levels, keys->n);
    for (int i = 0; i < keys->n; i++) {
        const struct yaml_entry *const entry = &keys->entry[i];
        const bool is_map = keys->kind == YAML_MAP;
        if (!is_map && entry->value->kind != YAML_SCALAR) {
            yaml_errors_add(errors, entry->value->mark, "error.keys: expects the name of a key");
            continue;
        }

        const char *const name = is_map ? entry->key : entry->value->text;
        const struct sweep_error_key *key = NULL;
        struct text known = {.arena = errors->arena};
        for (int k = 0; k < SWEEP_N_ERROR_KEYS && !key; k++) {
            const char *const path = sweep_error_keys[k].path, *const last = strrchr(path, '.') + 1;
            const bool is_of_every = strncmp(path, "fish.", 5) == 0 && strncmp(name, "fish[*].", 8) == 0;
            const bool is_last = strcmp(is_of_every ? name + 8 : name, last) == 0;
            if (is_last || strcmp(name, path) == 0) key = &sweep_error_keys[k];
            text_add(&known, "%s%s", k > 0 ? ", " : "", short_name(&sweep_error_keys[k]));
        }
        if (!key) {
            yaml_errors_add(errors, is_map ? entry->mark : entry->value->mark,
                            "error.keys: '%.60s' is not a numerical key; these are: %s", name, known.text);
            continue;
        }

        for (int j = 0; j < error->n_keys; j++) {
            if (error->levels[j].key != key) continue;
            yaml_errors_add(errors, entry->value->mark, "error.keys: '%s' is there twice", key->path);
        }
        error->levels[error->n_keys].key = key;
        if (is_map) read_levels(arena, &error->levels[error->n_keys], entry->value, errors);
        error->n_keys++;
    }
}

/* Read "against": a map is the text of a case, which case_merge.c has put in the place of the name of a file. */
static void read_against(const struct case_values *values, struct sweep_error *error, const struct yaml_node *node,
                         struct yaml_errors *errors) {
    struct text text = {.arena = values->arena};
    yaml_write_node(&text, node);
    error->against = text.text;
    if (error->within > 0) {
        yaml_errors_add(errors, node->mark, "error.within: refines one case: remove within or against");
    }
    if (node->kind == YAML_MAP) {
        error->against_kind = AGAINST_CASE;
        return;
    }
    if (node->kind == YAML_SCALAR) error->against = arena_text(values->arena, "%s", node->text);
    const char *const equals = strchr(error->against, '=');
    if (node->kind == YAML_SCALAR && equals) {
        error->against_kind = AGAINST_FISH;
        const int first = school_find_fish(&values->school, error->against, (size_t)(equals - error->against));
        if (first >= 0 && school_find_fish(&values->school, equals + 1, strlen(equals + 1)) >= 0) return;
        yaml_errors_add(errors, node->mark, "error.against: '%.60s': expects the names of two fish of this case",
                        error->against);
    } else if (node->kind == YAML_SCALAR && values->n_axes > 0) {
        error->against_kind = AGAINST_POINT;
    } else {
        yaml_errors_add(errors, node->mark,
                        "error.against: expects the file of a case, FISH=FISH, or along a sweep `first` or a value of "
                        "the swept key");
    }
}

bool sweep_error_part(const char *text, double *part) {
    char number[64];
    const size_t length = strlen(text);
    const bool is_percent = length > 1 && text[length - 1] == '%';
    size_t n = length - is_percent;
    while (is_percent && n > 0 && text[n - 1] == ' ') n--;
    if (n >= sizeof number) return false;
    memcpy(number, text, n);
    number[n] = '\0';
    if (!text_number(number, part)) return false;
    if (is_percent) *part /= 100;
    return *part > 0 && isfinite(*part);
}

/* Whether a name is the path of an input or the last words of it: "fish[*].body.modulus", "body.modulus", "modulus". */
static bool is_input(const char *name, const char *path) {
    if (strncmp(name, "fish[*].", 8) == 0) return strncmp(path, "fish.", 5) == 0 && strcmp(name + 8, path + 5) == 0;
    const size_t n = strlen(name), length = strlen(path);
    return n <= length && strcmp(path + length - n, name) == 0 && (n == length || path[length - n - 1] == '.');
}

/* Add an input by its name. */
static void read_input(const struct case_values *values, const char *name, double uncertainty, struct yaml_mark mark,
                       const char *place, struct yaml_errors *errors) {
    struct sweep_error *const error = values->error;
    struct text known = {.arena = errors->arena}, found = {.arena = errors->arena};
    const struct sweep_error_key *key = NULL;

    // fish[follower].wave.amplitude is the number of that fish, fish[*].wave.amplitude that of all in proportion
    const char *const end = strncmp(name, "fish[", 5) == 0 ? strchr(name, ']') : NULL;
    const bool is_of_one = end && end[1] == '.' && name[5] != '*';
    int fish = -1;
    if (is_of_one) {
        int number, length = 0;
        fish = school_find_fish(&values->school, name + 5, (size_t)(end - name - 5));
        const bool is_number = sscanf(name, "fish[%d]%n", &number, &length) == 1 && name + length == end + 1;
        if (fish < 0 && is_number && number >= 0 && number < values->school.n_fish) fish = number;
        if (fish < 0) yaml_errors_add(errors, mark, "%s: '%.60s': there is no such fish", place, name);
        if (fish < 0) return;
    }

    int n_found = 0;
    for (int i = 0; i < SWEEP_N_INPUTS; i++) {
        const char *const path = sweep_inputs[i].path;
        const bool is_of_fish = strncmp(path, "fish.", 5) == 0;
        text_add(&known, "%s%s", i > 0 ? ", " : "", path + (is_of_fish ? 5 : 0));
        if (is_of_one ? !is_of_fish || !is_input(end + 2, path) : !is_input(name, path)) continue;
        text_add(&found, "%s%s", n_found++ > 0 ? " and " : "", path + (is_of_fish ? 5 : 0));
        key = &sweep_inputs[i];
    }
    if (n_found > 1) {
        yaml_errors_add(errors, mark, "%s: '%.60s' is the end of several keys: %s", place, name, found.text);
    } else if (n_found == 0) {
        yaml_errors_add(errors, mark, "%s: '%.60s' is no such number; these are: %s", place, name, known.text);
    }
    if (n_found != 1) return;
    if (is_of_one && values->school.n_fish > 1) {
        struct sweep_error_key *one;
        NEW(values->arena, one, 1);
        *one = *key;
        one->fish = fish;
        one->name = arena_text(values->arena, "fish[%s]%s", values->school.fish[fish].name, key->path + 4);
        key = one;
    }
    for (int i = 0; i < error->n_inputs; i++) {
        if (strcmp(sweep_error_name(error->input[i].key), sweep_error_name(key)) != 0) continue;
        yaml_errors_add(errors, mark, "%s: '%s' is there twice", place, sweep_error_name(key));
    }
    if (error->n_inputs == SWEEP_N_INPUTS) {
        yaml_errors_add(errors, mark, "%s: more than %d keys", place, SWEEP_N_INPUTS);
        return;
    }
    error->input[error->n_inputs++] = (struct sweep_error_input){key, uncertainty};
}

/* Read "sensitivity": true, a key, or a list of keys; and "uncertain": a map of keys and parts of them. */
static void read_inputs(const struct case_values *values, const struct yaml_node *sensitivity,
                        const struct yaml_node *uncertain, struct yaml_errors *errors) {
    struct arena *const arena = values->arena;
    struct sweep_error *const error = values->error;
    static const char of_sensitivity[] = "error.sensitivity", of_uncertain[] = "error.uncertain";
    if (sensitivity && sensitivity->kind == YAML_SCALAR &&
        (strcmp(sensitivity->text, "true") == 0 || strcmp(sensitivity->text, "false") == 0)) {
        error->sensitivity = strcmp(sensitivity->text, "true") == 0;
    } else if (sensitivity) {
        const int n = sensitivity->kind == YAML_LIST ? sensitivity->n : 1;
        error->sensitivity = true;
        NEW(arena, error->input, n > 0 ? n : 1);
        for (int i = 0; i < n; i++) {
            const struct yaml_node *const name =
                sensitivity->kind == YAML_LIST ? sensitivity->entry[i].value : sensitivity;
            if (name->kind != YAML_SCALAR) {
                yaml_errors_add(errors, name->mark, "%s: expects true, a key or a list of keys", of_sensitivity);
            } else {
                read_input(values, name->text, 0, name->mark, of_sensitivity, errors);
            }
        }
        if (n == 0) yaml_errors_add(errors, sensitivity->mark, "%s: expects at least one key", of_sensitivity);
    }
    if (!uncertain) return;
    if (error->sensitivity) {
        yaml_errors_add(errors, uncertain->mark,
                        "%s: is part of the error bar, and sensitivity gives no error bar: remove one of them",
                        of_uncertain);
        return;
    }
    if (error->within > 0) {
        yaml_errors_add(errors, uncertain->mark, "%s: no refinement makes it smaller: remove within or uncertain",
                        of_uncertain);
    }
    if (uncertain->kind != YAML_MAP || uncertain->n == 0) {
        yaml_errors_add(errors, uncertain->mark, "%s: expects a map of keys, as in {modulus: 10%%}", of_uncertain);
        return;
    }
    NEW(arena, error->input, uncertain->n);
    for (int i = 0; i < uncertain->n; i++) {
        const struct yaml_entry *const entry = &uncertain->entry[i];
        double part;
        if (entry->value->kind != YAML_SCALAR || !sweep_error_part(entry->value->text, &part)) {
            yaml_errors_add(errors, entry->value->mark,
                            "%s: the uncertainty of '%.60s' is a part of it above 0, such as 5%% or 0.05", of_uncertain,
                            entry->key);
        } else {
            read_input(values, entry->key, part, entry->mark, of_uncertain, errors);
        }
    }
}

void sweep_error_read(struct case_values *values, const struct yaml_node *root, struct yaml_errors *errors) {
    const struct yaml_node *const map = yaml_tree_find(root, "error");

    // as for a member of such a study
    const bool is_none = map && map->kind == YAML_SCALAR && strcmp(map->text, "none") == 0;
    if (!map || is_none || (map->kind == YAML_MAP && map->n == 0)) return;
    if (map->kind != YAML_MAP) {
        yaml_errors_add(errors, map->mark, "error: expects {of: QUANTITY}");
        return;
    }

    yaml_tree_check_keys(map, "error", "of, within, keys, confirm, models, most, against, sensitivity, uncertain",
                         errors);
    struct sweep_error *const error = NEW(values->arena, values->error, 1);
    if (yaml_tree_find(map, "within")) error->within = yaml_tree_positive(map, "error", "within", 0, errors);
    error->most = yaml_tree_positive(map, "error", "most", SWEEP_ERROR_MOST, errors);
    if (values->n_axes > 0 && error->within > 0) {
        yaml_errors_add(errors, map->mark, "error.within: refines one case: remove within or sweep");
    }
    for (int a = 0; a < values->n_axes; a++) {
        if (!values->sweep[a].refine) continue;
        yaml_errors_add(errors, map->mark, "error: replaces the refined axis sweep[%d]: remove error or refine", a);
    }
    for (int a = 0; a < values->n_axes; a++) {
        if (!values->sweep[a].is_relative) continue;
        yaml_errors_add(errors, map->mark,
                        "error: sweep[%d].relative_to gives no errors: remove it and write error.against", a);
    }
    const struct yaml_node *const of = yaml_tree_find(map, "of"), *const keys = yaml_tree_find(map, "keys"),
                                  *const confirm = yaml_tree_find(map, "confirm"),
                                  *const models = yaml_tree_find(map, "models"),
                                  *const against = yaml_tree_find(map, "against");
    error->confirm = !confirm || yaml_tree_boolean(confirm, "error.confirm", errors);
    error->models = models && yaml_tree_boolean(models, "error.models", errors);
    if (keys) read_keys(values->arena, error, keys, errors);
    if (against) read_against(values, error, against, errors);
    read_inputs(values, yaml_tree_find(map, "sensitivity"), yaml_tree_find(map, "uncertain"), errors);
    if (error->sensitivity && values->n_axes > 0) {
        yaml_errors_add(errors, map->mark, "error.sensitivity: is that of one case: remove sensitivity or sweep");
    }
    if (error->sensitivity && (keys || error->models || error->within > 0)) {
        yaml_errors_add(errors, map->mark,
                        "error.sensitivity: replaces the numerical keys: remove it, or keys, models and within");
    }

    // the quantities
    static const char expected[] = "error.of: expects the name of a quantity, or a list of names";
    if (!of) {
        yaml_errors_add(errors, map->mark, "error.of: is required: a quantity, or a list of quantities");
        return;
    }
    const int n = of->kind == YAML_LIST ? of->n : 1;
    NEW(values->arena, error->of, n);
    for (int i = 0; i < n; i++) {
        const struct yaml_node *const name = of->kind == YAML_LIST ? of->entry[i].value : of;
        if (name->kind == YAML_SCALAR && *name->text) {
            error->of[error->n_of++] = arena_text(values->arena, "%s", name->text);
        } else {
            yaml_errors_add(errors, name->mark, expected);
        }
    }
    if (n == 0) yaml_errors_add(errors, of->mark, expected);
}

void sweep_error_write(struct text *text, const struct sweep_error *error) {
    text_add(text, "{of: [");
    for (int i = 0; i < error->n_of; i++) {
        if (i > 0) text_add(text, ", ");
        yaml_write_scalar(text, error->of[i]);
    }

    text_add(text, "]");
    if (error->within > 0) {
        text_add(text, ", within: ");
        text_add_number(text, error->within);
    }

    if (fabs(error->most - SWEEP_ERROR_MOST) > 0) {
        text_add(text, ", most: ");
        text_add_number(text, error->most);
    }

    if (!error->confirm) text_add(text, ", confirm: false");
    if (error->models) text_add(text, ", models: true");
    if (error->against_kind == AGAINST_CASE) text_add(text, ", against: %s", error->against);
    if (error->against_kind == AGAINST_POINT || error->against_kind == AGAINST_FISH) {
        text_add(text, ", against: ");
        yaml_write_scalar(text, error->against);
    }
    for (int i = 0; i < error->n_keys; i++) {
        text_add(text, "%s%s: ", i == 0 ? ", keys: {" : ", ", short_name(error->levels[i].key));
        if (error->levels[i].n == 0) text_add(text, "default");
        for (int k = 0; k < error->levels[i].n; k++) {
            text_add(text, k > 0 ? ", " : "[");
            text_add_number(text, error->levels[i].value[k]);
        }
        if (error->levels[i].n > 0) text_add(text, "]");
    }

    if (error->n_keys > 0) text_add(text, "}");
    if (error->sensitivity && error->n_inputs == 0) text_add(text, ", sensitivity: true");
    for (int i = 0; i < error->n_inputs; i++) {
        const struct sweep_error_input *const input = &error->input[i];
        const char *const first = error->sensitivity ? ", sensitivity: [" : ", uncertain: {";
        const char *const quote = input->key->name ? "\"" : "";
        text_add(text, "%s%s%s%s", i == 0 ? first : ", ", quote, sweep_error_name(input->key), quote);
        if (error->sensitivity) continue;
        text_add(text, ": ");
        text_add_number(text, input->uncertainty);
    }
    if (error->n_inputs > 0) text_add(text, error->sensitivity ? "]" : "}");
    text_add(text, "}");
}
