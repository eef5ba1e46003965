/* residual_unknowns.h: what each of all unknowns is: of which fish and node, its name, and its scale. doc/model.md,
 * section 10; doc/numerics.md, section 3. Tested by tests/school/test_residual.c. */
#ifndef RESIDUAL_UNKNOWNS_H
#define RESIDUAL_UNKNOWNS_H

#include "fish/fish.h"

/* What an unknown is: for tolerances, names in messages, and which equations are algebraic. */
enum unknown {
    UNKNOWN_X,
    UNKNOWN_Y,
    UNKNOWN_VX,
    UNKNOWN_VY,
    UNKNOWN_PX,
    UNKNOWN_PY,
    UNKNOWN_AX,
    UNKNOWN_AY,
    UNKNOWN_GAMMA,
    UNKNOWN_CIRCULATION,
    UNKNOWN_PHI0
};
struct unknown_place {
    int fish, index; /* index: node or point of the sheet */
    enum unknown kind;
    const char *name; /* "x", "sheet", ... */
};

/* The component of the vector of a node that the unknown is: 0: x, 1: y. */
int residual_component(enum unknown kind);

/* Where unknown i belongs. */
struct unknown_place residual_place(const struct school *school, int i);

/* The scale of unknown i, in its unit: what the error tolerance is relative to. */
double residual_scale(const struct school *school, int i);

/* The factor on the scale of unknown i for methods that do not damp the vibrations of a stiff body: velocities then
 * have the scale 0.1 L f, about that of the positions times 2 pi f, instead of one that never binds; 1 for other
 * unknowns. */
double residual_undamped(const struct school *school, int i);

#endif
