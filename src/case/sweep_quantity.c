/* sweep_quantity.c: the table of quantities that a study can report. */
#include "case/sweep_quantity.h"

#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "case/sweep.h"

const struct sweep_quantity sweep_quantities[SWEEP_N_QUANTITIES] = {
    {"nose", 1, 1, "m", "position of the nose at the end", 0},
    {"tail", 1, 1, "m", "position of the tail at the end", 0},
    {"com", 1, 1, NULL, NULL, 0},
    {"speed", 1, 0, NULL, NULL, 0},
    {"mean_heading", 1, 0, "degree", "mean of the heading over the last period", 0},
    {"shed_circulation", 1, 0, NULL, NULL, 0},
    {"cost_of_transport", 1, 0, NULL, NULL, 0},
    {"mean_actuation_power", 1, 0, NULL, NULL, 0},
    {"steady_speed", 1, 0, NULL, NULL, 1},
    {"steady_turn", 1, 0, NULL, NULL, 1},
    {"steady_thrust", 1, 0, NULL, NULL, 1},
    {"steady_cost_of_transport", 1, 0, NULL, NULL, 1},
    {"steady_efficiency", 1, 0, NULL, NULL, 1},
    {"steady_towed_efficiency", 1, 0, NULL, NULL, 1},
    {"steady_strouhal", 1, 0, NULL, NULL, 1},
    {"steady_actuation_power", 1, 0, NULL, NULL, 1},
    {"steady_fluid_power", 1, 0, NULL, NULL, 1},
    {"steady_drag", 1, 0, NULL, NULL, 1},
    {"steady_lift", 1, 0, NULL, NULL, 1},
    {"steady_deflection", 1, 0, NULL, NULL, 1},
    {"strouhal", 1, 0, NULL, NULL, 0},
    {"lateral_drift", 1, 0, "m", "displacement of the centre of mass across the first heading, to the left", 0},
    {"efficiency", 1, 0, NULL, NULL, 0},
    {"towed_efficiency", 1, 0, NULL, NULL, 0},
    {"mean_thrust", 1, 0, NULL, NULL, 0},
    {"mean_power", 1, 0, NULL, NULL, 0},
    {"energy_balance", 1, 0, NULL, NULL, 0},
    {"steps", 0, 0, NULL, NULL, 0},
    {"newton_iterations", 0, 0, NULL, NULL, 0},
    {"residual_evaluations", 0, 0, NULL, NULL, 0},
    {"jacobian_evaluations", 0, 0, NULL, NULL, 0},
    {"wall_time", 0, 0, NULL, NULL, 0},
    {"nose_error", 1, 0, "1", "distance of the nose from the reference of a comparison, in body lengths", 0},
    {"tail_error", 1, 0, "1", "distance of the tail from the reference of a comparison, in body lengths", 0},
    {"power_error", 1, 0, "1",
     "error of the work of the muscle, or of mean_power without a muscle, relative to the reference of a comparison",
     0},
    {"evaluations_to_end", 0, 0, "1",
     "residual evaluations of a comparison, extrapolated to the end after a time limit", 0},
    {"wall_time_to_end", 0, 0, "s", "wall time of a comparison, extrapolated to the end after a time limit", 0},
    {"beat_time", 0, 0, "s", "wall time of a beat of the search for a steady state", 1},
    {"steady_stiffness", 0, 0, NULL, NULL, 1},
    {"steady_power", 1, 0, NULL, NULL, 1},
    {"steady_growth", 0, 0, NULL, NULL, 1},
    {"steady_multiplier", 0, 0, "1", "absolute value of the largest Floquet multiplier", 1},
    {"steady_multiplier_error", 0, 0, "1", "error of the largest Floquet multiplier", 1},
};

int sweep_quantity_read(const char *name, struct yaml_mark mark, const char *path, int n_known,
                        struct yaml_errors *errors) {
    for (int q = 0; q < n_known; q++) {
        if (strcmp(sweep_quantities[q].name, name) == 0) return q;
    }
    struct text known = {.arena = errors->arena};
    for (int q = 0; q < n_known; q++) text_add(&known, "%s%s", q > 0 ? ", " : "", sweep_quantities[q].name);
    yaml_errors_add(errors, mark, "%s: '%.40s' is not a quantity; known quantities: %s", path, name, known.text);
    return -1;
}

uint64_t sweep_quantities_read(const struct yaml_node *of, const char *path, int n_known, struct yaml_errors *errors) {
    char place[64];
    snprintf(place, sizeof place, "%s.of", path);
    uint64_t all = 0;
    const int n = of->kind == YAML_LIST ? of->n : 1;

    for (int i = 0; i < n; i++) {
        const struct yaml_node *const name = of->kind == YAML_LIST ? of->entry[i].value : of;
        if (name->kind != YAML_SCALAR) {
            yaml_errors_add(errors, name->mark, "%s: expects the name of a quantity, or a list of names", place);
            continue;
        }
        const int q = sweep_quantity_read(name->text, name->mark, place, n_known, errors);
        if (q >= 0) all |= UINT64_C(1) << q;
    }

    if (n == 0) yaml_errors_add(errors, of->mark, "%s: expects the name of a quantity, or a list of names", place);
    return all;
}
