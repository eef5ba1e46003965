/* jacobian.c: allocation of blocks, masks, and products with couplings. */
#include "school/jacobian.h"

#include <stdlib.h>
#include <string.h>

#include "vortex/kernel.h"

enum status jacobian_create(struct jacobian **jacobian, const struct school *school) {
    *jacobian = NULL;
    struct jacobian *const new = calloc(1, sizeof *new);
    if (!new) goto no_memory;

    new->school = school;
    new->own = calloc((size_t)school->n_fish, sizeof *new->own);
    new->first = calloc((size_t)school->n_fish + 1, sizeof *new->first);
    if (!new->own || !new->first) goto no_memory;

    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *at = &school->fish[f].at;
        if (sparse_create(&new->own[f], at->x, at->end - at->x) != STATUS_OK) goto no_memory;
    }
    *jacobian = new;
    return STATUS_OK;

no_memory:
    jacobian_free(new);
    return status_fail(STATUS_MEMORY, "out of memory: a Jacobian of %d fish", school->n_fish);
}

void jacobian_free(struct jacobian *jacobian) {
    if (!jacobian) return;
    for (int f = 0; jacobian->own && f < jacobian->school->n_fish; f++) sparse_free(jacobian->own[f]);
    free(jacobian->own);
    free(jacobian->first);
    free(jacobian->coupling);
    free(jacobian->values);
    free(jacobian);
}

static size_t block_size(const struct coupling_block *rows) {
    return (size_t)rows->n_rows * (size_t)rows->n_columns;
}

enum status jacobian_couple(struct jacobian *jacobian, const unsigned char *coupled, unsigned pattern) {
    const struct school *school = jacobian->school;
    const int n_fish = school->n_fish;
    int n = 0;
    for (int i = 0; i < n_fish * n_fish; i++) n += coupled[i] && i / n_fish != i % n_fish;

    // release the old blocks
    free(jacobian->coupling);
    free(jacobian->values);
    jacobian->values = NULL;
    jacobian->n_couplings = 0;
    memset(jacobian->first, 0, ((size_t)n_fish + 1) * sizeof *jacobian->first);

    // list the couplings, fish by fish
    jacobian->coupling = calloc((size_t)n + 1, sizeof *jacobian->coupling);
    if (!jacobian->coupling) goto no_memory;

    size_t n_values = 1;
    for (int f = 0, next = 0; f < n_fish; f++) {
        for (int g = 0; g < n_fish; g++) {
            if (g == f || !coupled[f * n_fish + g]) continue;
            const struct coupling_block rows = {flow_n_rows(&school->fish[f]), flow_n_columns(&school->fish[g]), NULL};
            jacobian->coupling[next++] = (struct jacobian_coupling){g, rows};
            n_values += block_size(&rows);
        }
        jacobian->first[f + 1] = next;
    }

    // place the blocks in one array
    jacobian->values = calloc(n_values, sizeof *jacobian->values);
    if (!jacobian->values) goto no_memory;

    double *value = jacobian->values;
    for (int i = 0; i < n; i++) {
        jacobian->coupling[i].rows.value = value;
        value += block_size(&jacobian->coupling[i].rows);
    }

    jacobian->n_couplings = n;
    jacobian->pattern = pattern;
    return STATUS_OK;

no_memory:
    memset(jacobian->first, 0, ((size_t)n_fish + 1) * sizeof *jacobian->first);
    return status_fail(STATUS_MEMORY, "out of memory: %d coupling blocks of the Jacobian", n);
}

void jacobian_mask_couplings(struct jacobian *jacobian, int f) {
    const struct layout *at = &jacobian->school->fish[f].at;
    for (int row = at->ax; row < at->phi0; row++) {
        if (!sparse_is_masked(jacobian->own[f], row)) continue;
        for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
            const struct coupling_block *rows = &jacobian->coupling[i].rows;
            for (long c = 0; c < rows->n_columns; c++) rows->value[c * rows->n_rows + (row - at->ax)] = 0;
        }
    }
}

void jacobian_multiply_couplings(const struct jacobian *jacobian, int f, const double *unknowns, double *product) {
    const struct school *school = jacobian->school;
    memset(product, 0, (size_t)(school->fish[f].at.end - school->fish[f].at.ax) * sizeof *product);
    for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
        const struct fish *other = &school->fish[jacobian->coupling[i].other];
        const struct coupling_block *rows = &jacobian->coupling[i].rows;

        // columns of x and y, then of gamma and circulation: each group is contiguous in the unknowns
        const int n_places = 2 * other->n_nodes;
        kernel_multiply(rows->n_rows, n_places, rows->value, unknowns + other->at.x, product);
        kernel_multiply(rows->n_rows, rows->n_columns - n_places, rows->value + (long)n_places * rows->n_rows,
                        unknowns + other->at.gamma, product);
    }
}
