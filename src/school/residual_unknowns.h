/* residual_unknowns.h: fish, node, name and scale of every unknown. doc/model.md, section 10;
 * doc/numerics.md, section 3. Tested by tests/school/test_residual.c. */
#ifndef RESIDUAL_UNKNOWNS_H
#define RESIDUAL_UNKNOWNS_H

#include "fish/fish.h"

/* The kind of an unknown, for tolerances, names in messages, and the choice of algebraic equations. */
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

/* The vector component of an unknown of a node: 0: x, 1: y. */
int residual_component(enum unknown kind);

/* Fish, kind and index of unknown i. */
struct unknown_place residual_place(const struct school *school, int i);

/* The scale of unknown i, in the unit of the unknown; error tolerances are relative to the scale. */
double residual_scale(const struct school *school, int i);

/* The factor on the scale of unknown i for methods that do not damp the vibrations of a stiff body: velocities and
 * momenta then have the scale 0.1 L f, about the scale of positions times 2 pi f; the scale without this factor never
 * limits the step. 1 for other unknowns. */
double residual_undamped(const struct school *school, int i);

#endif
