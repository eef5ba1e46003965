/* result_values.c: copy values from the structs of a run to the slots of an array. */
#include "result/result_values.h"

#include <math.h>
#include <string.h>

void result_values_lengths(const struct school *school, int n_vortices, size_t length[RESULT_N_DIMENSIONS]) {
    for (int d = 0; d < RESULT_N_DIMENSIONS; d++) length[d] = 1;
    length[FISH] = (size_t)school->n_fish;
    length[VORTEX] = (size_t)n_vortices;
    length[XY] = 2;
    length[WALL] = (size_t)school->walls.n;
    length[MULTIPLIER] = STEADY_QUANTITIES * (size_t)school->n_fish;

    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *fish = &school->fish[f];
        for (enum result_dimension d = NODE; d <= CONTROL; d++) {
            const size_t of_fish = (size_t)result_table_length(fish, d);
            if (of_fish > length[d]) length[d] = of_fish;
        }
        const size_t n_name = strlen(fish->name);
        if (n_name > length[NAME]) length[NAME] = n_name;
    }
}

size_t result_values_n(const struct result_variable *variable, const size_t *length) {
    size_t n = 1;
    for (const enum result_dimension *d = variable->dimension; *d != NONE; d++) n *= length[*d];
    return n;
}

size_t result_values_size(enum result_type type) {
    switch (type) {
        case RESULT_INTEGER: return sizeof(int);
        case RESULT_COUNT: return sizeof(long);
        case RESULT_TEXT: return sizeof(char);
        default: return sizeof(double);
    }
}

/* Write the n_slots values of the school or of fish f. */
static void fill_slots(const struct result_variable *variable, const struct result_row *row, int f, size_t n_slots,
                       void *slots) {
    if (variable->gather) {
        variable->gather(row, f, slots);
        return;
    }

    const char *value = result_table_owner(row, variable->owner, f);
    if (!value) return;
    value += variable->offset;
    size_t n = n_slots;

    if (variable->is_pointer) {
        memcpy(&value, value, sizeof(const char *));
        const enum result_dimension last = variable->dimension[1];
        n = last == NAME ? strlen(value) : (size_t)result_table_length(&row->school->fish[f], last);
    }

    memcpy(slots, value, n * result_values_size(variable->type));
}

void result_values_fill(const struct result_variable *variable, const size_t *length, const struct result_row *row,
                        void *buffer) {
    const size_t n = result_values_n(variable, length), size = result_values_size(variable->type);
    memset(buffer, 0, n * size);
    if (variable->type == RESULT_REAL || variable->type == RESULT_BULK) {
        for (size_t k = 0; k < n; k++) ((double *)buffer)[k] = NAN;
    }
    const size_t n_fish = result_table_has(variable, FISH) ? length[FISH] : 1;
    const size_t n_owners = variable->owner == OF_AXIS ? length[XY] : n_fish, n_slots = n / n_owners;
    for (size_t f = 0; f < n_owners; f++) {
        fill_slots(variable, row, (int)f, n_slots, (char *)buffer + f * n_slots * size);
    }
}
