/* jacobian.c: the blocks of the Jacobian, and products with them. */
#include "school/jacobian.h"

#include <string.h>

#include "base/wide.h"

struct jacobian *jacobian_create(struct arena *arena, const struct school *school) {
    struct jacobian *jacobian;
    NEW(arena, jacobian, 1);
    jacobian->arena = arena;
    jacobian->school = school;
    NEW(arena, jacobian->own, school->n_fish);
    NEW(arena, jacobian->first, school->n_fish + 1);
    for (int f = 0; f < school->n_fish; f++) {
        const struct layout *const at = &school->fish[f].at;
        jacobian->own[f] = sparse_create(arena, at->x, at->end - at->x);
    }
    return jacobian;
}

void jacobian_couple(struct jacobian *jacobian, const unsigned char *coupled, unsigned pattern) {
    const struct school *school = jacobian->school;
    const int n_fish = school->n_fish;
    int n = 0;
    for (int i = 0; i < n_fish * n_fish; i++) n += coupled[i] && i / n_fish != i % n_fish;
    GROW(jacobian->arena, jacobian->coupling, n + 1);

    size_t n_values = 1;
    for (int f = 0, next = 0; f < n_fish; f++) {
        for (int g = 0; g < n_fish; g++) {
            if (g == f || !coupled[f * n_fish + g]) continue;
            const struct coupling_block rows = {flow_n_rows(&school->fish[f]), flow_n_columns(&school->fish[g]), NULL};
            jacobian->coupling[next++] = (struct jacobian_coupling){g, rows};
            n_values += (size_t)rows.n_rows * (size_t)rows.n_columns;
        }
        jacobian->first[f + 1] = next;
    }

    GROW(jacobian->arena, jacobian->values, n_values);
    double *value = jacobian->values;
    for (int i = 0; i < n; i++) {
        struct coupling_block *const rows = &jacobian->coupling[i].rows;
        rows->value = value;
        value += (size_t)rows->n_rows * (size_t)rows->n_columns;
    }

    jacobian->n_couplings = n;
    jacobian->pattern = pattern;
}

void jacobian_multiply_couplings(const struct jacobian *jacobian, int f, const double *unknowns, double *product) {
    const struct school *school = jacobian->school;
    memset(product, 0, (size_t)(school->fish[f].at.end - school->fish[f].at.ax) * sizeof *product);
    for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
        const struct fish *other = &school->fish[jacobian->coupling[i].other];
        const struct coupling_block *rows = &jacobian->coupling[i].rows;

        // the columns of x and y, then those of gamma and circulation, because each group is contiguous in the unknowns
        const int n_places = 2 * other->n_nodes;
        wide_multiply(rows->n_rows, n_places, rows->value, unknowns + other->at.x, product);
        wide_multiply(rows->n_rows, rows->n_columns - n_places, rows->value + (long)n_places * rows->n_rows,
                      unknowns + other->at.gamma, product);
    }
}

long jacobian_non_zeros(const struct jacobian *jacobian) {
    long n = 0;
    for (int f = 0; f < jacobian->school->n_fish; f++) n += (long)jacobian->own[f]->n_nonzeros;
    for (int i = 0; i < jacobian->n_couplings; i++) {
        n += (long)jacobian->coupling[i].rows.n_rows * jacobian->coupling[i].rows.n_columns;
    }
    return n;
}

void jacobian_add(const struct jacobian *jacobian, double factor, int n, const int *row_number,
                  const int *column_number, double *matrix) {
    const struct school *const school = jacobian->school;
    for (int f = 0; f < school->n_fish; f++) {
        const struct sparse *const own = jacobian->own[f];
        for (int c = 0; c < own->n; c++) {
            const int column = column_number[own->first + c];
            for (int64_t k = own->column_start[c]; k < own->column_start[c + 1] && column >= 0; k++) {
                const int row = row_number[own->first + (int)own->row_index[k]];
                if (row >= 0) matrix[(size_t)row + (size_t)n * (size_t)column] += factor * own->value[k];
            }
        }

        for (int i = jacobian->first[f]; i < jacobian->first[f + 1]; i++) {
            const struct coupling_block *const rows = &jacobian->coupling[i].rows;
            const struct fish *const other = &school->fish[jacobian->coupling[i].other];
            for (int c = 0; c < rows->n_columns; c++) {
                const int column = column_number[flow_column(other, c)];
                for (int r = 0; r < rows->n_rows && column >= 0; r++) {
                    const int row = row_number[school->fish[f].at.ax + r];
                    if (row < 0) continue;
                    matrix[(size_t)row + (size_t)n * (size_t)column] +=
                        factor * rows->value[(long)c * rows->n_rows + r];
                }
            }
        }
    }
}
