/* sparse.c: records the order of additions in the first pass and replays it in all later ones. */
#include "base/sparse.h"

#include <string.h>

struct sparse *sparse_create(struct arena *arena, int first, int n) {
    struct sparse *matrix;
    NEW(arena, matrix, 1);
    *matrix = (struct sparse){.arena = arena, .first = first, .n = n, .recording = true};
    NEW(arena, matrix->masked, n);
    NEW(arena, matrix->column_start, n + 1);
    NEW(arena, matrix->value, 1);
    return matrix;
}

void sparse_mask(struct sparse *matrix, int row, int masked) {
    unsigned char *const here = &matrix->masked[row - matrix->first];
    if (*here != masked) matrix->recording = true;
    *here = (unsigned char)masked;
}

void sparse_record(struct sparse *matrix, int row, int column, double value) {
    if (matrix->n_entries == matrix->capacity) {
        matrix->capacity = matrix->capacity > 0 ? 2 * matrix->capacity : 1024;
        GROW(matrix->arena, matrix->entry_row, matrix->capacity);
        GROW(matrix->arena, matrix->entry_column, matrix->capacity);
        GROW(matrix->arena, matrix->slot, matrix->capacity);
    }

    // while recording, the array of slots holds the values
    const int64_t i = matrix->n_entries++;
    matrix->entry_row[i] = row;
    matrix->entry_column[i] = column;
    memcpy(&matrix->slot[i], &value, sizeof value);
}

void sparse_begin(struct sparse *matrix) {
    matrix->next = 0;
    if (matrix->recording) {
        matrix->n_entries = 0;
    } else {
        memset(matrix->value, 0, (size_t)(matrix->n_nonzeros + 1) * sizeof *matrix->value);
    }

    // the first entries of every pass are the ones of the masked rows
    matrix->n_masked = 0;
    for (int row = matrix->first; row < matrix->first + matrix->n; row++) {
        if (!sparse_is_masked(matrix, row)) continue;
        sparse_add(matrix, row, row, 1);
        matrix->n_masked++;
    }
}

// sort the indices of the entries of unmasked rows by column, then row, by two counting sorts; returns the number of
// entries
static int64_t entries_sort(const struct sparse *matrix, int64_t *order, int64_t *by_row, int64_t *count) {
    const int64_t n = matrix->n;
    int64_t n_kept = 0;
    memset(count, 0, (size_t)(n + 1) * sizeof *count);
    for (int64_t i = 0; i < matrix->n_entries; i++) count[matrix->entry_row[i] - matrix->first + 1]++;
    for (int64_t r = 0; r < n; r++) count[r + 1] += count[r];
    for (int64_t i = 0; i < matrix->n_entries; i++) by_row[count[matrix->entry_row[i] - matrix->first]++] = i;
    for (int64_t i = 0; i < matrix->n_entries; i++) {
        const int64_t entry = by_row[i];
        const bool is_kept = entry < matrix->n_masked || !sparse_is_masked(matrix, matrix->entry_row[entry]);
        if (is_kept) by_row[n_kept++] = entry;
    }

    memset(count, 0, (size_t)(n + 1) * sizeof *count);
    for (int64_t i = 0; i < n_kept; i++) count[matrix->entry_column[by_row[i]] - matrix->first + 1]++;
    for (int64_t c = 0; c < n; c++) count[c + 1] += count[c];
    for (int64_t i = 0; i < n_kept; i++) {
        order[count[matrix->entry_column[by_row[i]] - matrix->first]++] = by_row[i];
    }
    return n_kept;
}

void sparse_end(struct sparse *matrix) {
    if (!matrix->recording) {
        assert(matrix->next == matrix->n_entries);
        return;
    }

    // sort the recorded entries
    struct arena *const scratch = arena_create(matrix->arena, "the entries of a Jacobian");
    const size_t n_entries = (size_t)matrix->n_entries + 1;
    int64_t *order, *by_row, *count;
    double *recorded;
    NEW(scratch, order, n_entries);
    NEW(scratch, by_row, n_entries);
    NEW(scratch, count, matrix->n + 1);
    NEW(scratch, recorded, n_entries);
    const int64_t n_sorted = entries_sort(matrix, order, by_row, count);
    if (matrix->n_entries > 0) memcpy(recorded, matrix->slot, (size_t)matrix->n_entries * sizeof *recorded);

    // assign a position in the compressed columns to every distinct entry, and a slot to every recorded addition
    GROW(matrix->arena, matrix->row_index, n_entries);
    GROW(matrix->arena, matrix->value, n_entries + 1);
    memset(matrix->value, 0, (n_entries + 1) * sizeof *matrix->value);
    int64_t n_nonzeros = 0;
    int row = -1, column = -1;
    memset(matrix->column_start, 0, ((size_t)matrix->n + 1) * sizeof *matrix->column_start);
    for (int64_t i = 0; i < matrix->n_entries; i++) matrix->slot[i] = -1;
    for (int64_t i = 0; i < n_sorted; i++) {
        const int64_t entry = order[i];
        if (matrix->entry_row[entry] - matrix->first != row || matrix->entry_column[entry] - matrix->first != column) {
            row = matrix->entry_row[entry] - matrix->first;
            column = matrix->entry_column[entry] - matrix->first;
            matrix->row_index[n_nonzeros++] = row;
            matrix->column_start[column + 1]++;
        }
        matrix->slot[entry] = n_nonzeros - 1;
    }
    for (int c = 0; c < matrix->n; c++) matrix->column_start[c + 1] += matrix->column_start[c];
    matrix->n_nonzeros = n_nonzeros;

    // add in recorded order, as in a replay: recording and replay give the same bits
    for (int64_t i = 0; i < matrix->n_entries; i++) {
        if (matrix->slot[i] < 0) matrix->slot[i] = n_nonzeros;
        matrix->value[matrix->slot[i]] += recorded[i];
    }
    matrix->recording = false;
    matrix->version++;
    arena_free(scratch);
}
