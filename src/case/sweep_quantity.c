/* sweep_quantity.c: the quantities that a case can expect something of. Declared in case.h and case_check.h. */
#include <string.h>

#include "case/case_check.h"

const struct sweep_quantity sweep_quantities[SWEEP_N_QUANTITIES] = {
    {"nose", 1, 1},
    {"tail", 1, 1},
    {"com", 1, 1},
    {"speed", 1, 0},
    {"mean_heading", 1, 0},
    {"shed_circulation", 1, 0},
    {"cost_of_transport", 1, 0},
    {"mean_actuation_power", 1, 0},
    {"lateral_drift", 1, 0},
    {"strouhal", 1, 0},
    {"energy_audit", 1, 0},
    {"steps", 0, 0},
    {"residual_evaluations", 0, 0},
    {"jacobian_evaluations", 0, 0},
    {"wall_time", 0, 0},
};

int sweep_quantity_read(const char *name, struct yaml_mark mark, const char *path, int n_known,
                        struct yaml_errors *errors) {
    struct text known = {0};
    for (int q = 0; q < n_known; q++) {
        if (strcmp(sweep_quantities[q].name, name) != 0) {
            text_add(&known, "%s%s", q > 0 ? ", " : "", sweep_quantities[q].name);
            continue;
        }
        text_free(&known);
        return q;
    }
    yaml_errors_add(errors, mark, "%s: '%.40s' is no quantity; known here: %s", path, name,
                    known.text ? known.text : "");
    text_free(&known);
    return -1;
}

unsigned sweep_quantities_read(const struct yaml_node *of, const char *path, int n_known, struct yaml_errors *errors) {
    char place[64];
    snprintf(place, sizeof place, "%s.of", path);
    unsigned all = 0;
    const int n = of->kind == YAML_LIST ? of->n : 1;
    for (int i = 0; i < n; i++) {
        const struct yaml_node *const name = of->kind == YAML_LIST ? of->entry[i].value : of;
        if (name->kind != YAML_SCALAR) {
            yaml_errors_add(errors, name->mark, "%s: expects the name of a quantity, or a list of names", place);
            continue;
        }
        const int q = sweep_quantity_read(name->text, name->mark, place, n_known, errors);
        if (q >= 0) all |= 1U << q;
    }
    if (n == 0) yaml_errors_add(errors, of->mark, "%s: expects the name of a quantity, or a list of names", place);
    return all;
}

void sweep_words_check(const struct yaml_node *map, const char *path, const char *known, struct yaml_errors *errors) {
    for (int i = 0; i < map->n; i++) {
        const struct yaml_entry *const entry = &map->entry[i];
        const size_t length = strlen(entry->key);
        bool is_known = false;
        for (const char *word = known; *word && !is_known; word += strspn(word, ", ")) {
            const size_t n = strcspn(word, ",");
            is_known = n == length && strncmp(word, entry->key, n) == 0;
            word += n;
        }
        if (is_known) continue;
        yaml_errors_add(errors, entry->mark, "%s.%.40s: unknown key; known here: %s", path, entry->key, known);
    }
}
