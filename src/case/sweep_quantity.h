/* sweep_quantity.h: the quantities of studies, for expectations and references. Tested by tests/case/test_sweep.c
 * and tests/study/test_study_file.c. */
#ifndef SWEEP_QUANTITY_H
#define SWEEP_QUANTITY_H

#include <stdbool.h>
#include <stdint.h>

#include "case/yaml_tree.h"

struct sweep_quantity {
    const char *name;
    bool of_fish, of_xy;        /* one value for every fish; a point in the plane */
    const char *unit, *meaning; /* NULL: as of the variable of a result file with this name */
    bool of_steady;             /* of a steady state, or of an equilibrium */
};

enum {
    SWEEP_NOSE,
    SWEEP_TAIL,
    SWEEP_STEADY_SPEED = 8,
    SWEEP_N_ORDERS = 20, /* of the first ones orders of convergence are observed: of runs or of steady states */
    SWEEP_N_QUANTITIES = 43
};

extern const struct sweep_quantity sweep_quantities[SWEEP_N_QUANTITIES];

/* The number of a quantity among the first n_known; -1 after adding an error, with path as the place of the name. */
int sweep_quantity_read(const char *name, struct yaml_mark mark, const char *path, int n_known,
                        struct yaml_errors *errors);

/* The same for a name or a list of names under path.of, as a set: bit q is set for quantity q. */
uint64_t sweep_quantities_read(const struct yaml_node *of, const char *path, int n_known, struct yaml_errors *errors);

#endif
