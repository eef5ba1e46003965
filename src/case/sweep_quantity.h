/* sweep_quantity.h: the quantities of studies: what a case can expect of the ends of its members, or give as a
 * reference. Tested by tests/case/test_sweep.c and tests/study/test_study_file.c. */
#ifndef SWEEP_QUANTITY_H
#define SWEEP_QUANTITY_H

#include "case/yaml_tree.h"

struct sweep_quantity {
    const char *name;
    int of_fish, of_xy;         /* one value for every fish; a point in the plane */
    const char *unit, *meaning; /* NULL: those of the variable of a result file that has this name */
};

enum {
    SWEEP_NOSE,
    SWEEP_TAIL,
    SWEEP_N_ORDERS = 8, /* of the first ones orders of convergence are observed */
    SWEEP_N_QUANTITIES = 26
};

extern const struct sweep_quantity sweep_quantities[SWEEP_N_QUANTITIES];

/* The number of a quantity among the first n_known; -1 if none of them has this name. */
int sweep_quantity_find(const char *name, int n_known);

/* The same for a name in a case; -1 after adding an error, with path as the place of the name. */
int sweep_quantity_read(const char *name, struct yaml_mark mark, const char *path, int n_known,
                        struct yaml_errors *errors);

/* The same for a name or a list of names under path.of, as a set: bit q is set for quantity q. */
unsigned sweep_quantities_read(const struct yaml_node *of, const char *path, int n_known, struct yaml_errors *errors);

#endif
