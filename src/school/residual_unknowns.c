/* residual_unknowns.c: unknowns by slices of the layout. */
#include "school/residual_unknowns.h"

#include "force/pressure.h"

int residual_component(enum unknown kind) {
    return kind == UNKNOWN_Y || kind == UNKNOWN_VY || kind == UNKNOWN_PY || kind == UNKNOWN_AY;
}

struct unknown_place residual_place(const struct school *school, int i) {
    // bisection: the first fish with at.end above i
    int f = 0, last = school->n_fish - 1;
    while (f < last) {
        const int middle = (f + last) / 2;
        if (i >= school->fish[middle].at.end) {
            f = middle + 1;
        } else {
            last = middle;
        }
    }

    // the slice that contains i, from the last slice to the first
    const struct layout *at = &school->fish[f].at;
    const struct {
        int first;
        enum unknown kind;
        const char *name;
    } slices[] = {{at->phi0, UNKNOWN_PHI0, "phi0"},
                  {at->circulation, UNKNOWN_CIRCULATION, "circulation"},
                  {at->gamma, UNKNOWN_GAMMA, "gamma"},
                  {at->ay, UNKNOWN_AY, "ay"},
                  {at->ax, UNKNOWN_AX, "ax"},
                  {at->py, UNKNOWN_PY, "py"},
                  {at->px, UNKNOWN_PX, "px"},
                  {at->vy, UNKNOWN_VY, "vy"},
                  {at->vx, UNKNOWN_VX, "vx"},
                  {at->y, UNKNOWN_Y, "y"},
                  {at->x, UNKNOWN_X, "x"}};

    int s = 0;
    while (i < slices[s].first) s++;
    return (struct unknown_place){
        .fish = f, .index = i - slices[s].first, .kind = slices[s].kind, .name = slices[s].name};
}

double residual_scale(const struct school *school, int i) {
    const struct unknown_place place = residual_place(school, i);
    const struct fish *fish = &school->fish[place.fish];
    const double f = fish_rate(school, fish);
    const double length = fish->length;

    switch (place.kind) {
        case UNKNOWN_X:
        case UNKNOWN_Y: return 0.01 * length;
        case UNKNOWN_VX:
        case UNKNOWN_VY: return 300 * length * f;
        case UNKNOWN_PX:
        case UNKNOWN_PY: return 300 * length * f * pressure_momentum_ratio(fish, place.index);
        case UNKNOWN_AX:
        case UNKNOWN_AY: return 1e5 * length * f * f;
        case UNKNOWN_GAMMA: return 3 * length * f;
        case UNKNOWN_CIRCULATION: return length * length * f;
        case UNKNOWN_PHI0: return 1;
    }
    return 1;
}

double residual_undamped(const struct school *school, int i) {
    const enum unknown kind = residual_place(school, i).kind;
    return kind >= UNKNOWN_VX && kind <= UNKNOWN_PY ? 1.0 / 3000 : 1;
}
