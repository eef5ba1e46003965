/* residual_couplings.c: neighbours by boxes, then by the distance of outlines. */
#include "school/residual_couplings.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "contact/clearance.h"
#include "fish/fish_distance.h"
#include "flow/flow_derivative.h"

enum status residual_couplings_fill(struct residual_couplings *couplings, const struct school *school,
                                    struct neighbours *neighbours) {
    const size_t n_fish = (size_t)school->n_fish;
    *couplings =
        (struct residual_couplings){.school = school, .neighbours = neighbours, .reach = school->coupling_distance};
    return MEMORY_NEW(couplings->coupled, n_fish * n_fish, "the couplings of fish");
}

void residual_couplings_free(struct residual_couplings *couplings) {
    free(couplings->coupled);
}

// couple exactly the fish within a distance of each other; returns whether any pair has changed
static int couple_neighbours(struct residual_couplings *couplings, const double *y, double distance) {
    const struct school *school = couplings->school;
    const struct neighbours *const neighbours = couplings->neighbours;
    int changed = 0;
    for (int f = 0; f < school->n_fish; f++) {
        unsigned char *const before = couplings->coupled + (size_t)f * (size_t)school->n_fish;
        int i = neighbours->first[f];
        for (int g = 0; g < school->n_fish; g++) {
            const int overlaps = i < neighbours->first[f + 1] && neighbours->other[i] == g;
            i += overlaps;

            // ordered pair: the same bits for (f, g) and (g, f)
            const int a = f > g ? f : g, b = f > g ? g : f;
            const int couple =
                f == g || (overlaps && fish_distance(&school->fish[a], &school->fish[b], y, distance) <= distance);
            changed |= before[g] != couple;
            before[g] = (unsigned char)couple;
        }
    }
    return changed;
}

enum status residual_couple(struct residual_couplings *couplings, const double *y) {
    const struct school *school = couplings->school;
    for (int f = 0; f < school->n_fish; f++) {
        couplings->neighbours->box[f] = clearance_box(&school->fish[f], couplings->reach, y, y);
    }

    TRY(neighbours_find(couplings->neighbours));
    couplings->pattern += (unsigned)couple_neighbours(couplings, y, couplings->reach);
    return STATUS_OK;
}

// upper bound of all distances between bodies, m
static double extent(const struct school *school, const double *y) {
    struct box all = clearance_box(&school->fish[0], 0, y, y);
    for (int f = 1; f < school->n_fish; f++) {
        all = box_union(all, clearance_box(&school->fish[f], 0, y, y));
    }
    return hypot(all.high[0] - all.low[0], all.high[1] - all.low[1]);
}

// number of values in the blocks of all coupled pairs
static double n_block_values(const struct residual_couplings *couplings) {
    const struct school *school = couplings->school;
    double n = 0;
    for (int f = 0; f < school->n_fish; f++) {
        const unsigned char *const coupled = couplings->coupled + (size_t)f * (size_t)school->n_fish;
        for (int g = 0; g < school->n_fish; g++) {
            if (g != f && coupled[g]) n += (double)flow_n_rows(&school->fish[f]) * flow_n_columns(&school->fish[g]);
        }
    }
    return n;
}

int residual_couple_more(struct residual_couplings *couplings, const double *y) {
    const double max_values = 5e7, before = couplings->reach, all = extent(couplings->school, y);
    const unsigned pattern = couplings->pattern;
    while (!couplings->couples_most && couplings->pattern == pattern && couplings->reach < all) {
        couplings->reach = fmax(2 * couplings->reach, 0.5 * couplings->school->fish[0].length);
        if (residual_couple(couplings, y) == STATUS_OK && n_block_values(couplings) <= max_values) continue;

        // back to the reach before
        couplings->reach = before;
        couplings->couples_most = 1;
        if (residual_couple(couplings, y) == STATUS_OK) return 0;
    }
    return couplings->pattern != pattern;
}

int residual_couple_contacts(struct residual_couplings *couplings, const struct contact *contact) {
    const int n_fish = couplings->school->n_fish;
    int n_contacts = 0;
    for (int f = 0; f < n_fish; f++) {
        const int *other;
        const int n = contact_partners(contact, f, &other);
        for (int i = 0; i < n; i++) {
            unsigned char *const coupled = &couplings->coupled[f * n_fish + other[i]];
            if (!*coupled) couplings->pattern++;
            *coupled = 1;
        }

        n_contacts += n;
    }
    return n_contacts > 0;
}
