/* test_neighbours.c: The boxes that are found to overlap are those that a comparison of all pairs finds. */
#include <stdlib.h>

#include "contact/clearance.h"
#include "school.h"

static double random_number(uint64_t *seed) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double)(*seed >> 11) / 9007199254740992.0;
}

static int overlap(const struct box *a, const struct box *b) {
    int both = 1;
    for (int i = 0; i < 2; i++) both = both && a->low[i] <= b->high[i] && b->low[i] <= a->high[i];
    return both;
}

static void place(struct neighbours *neighbours, double size, uint64_t *seed) {
    for (int i = 0; i < neighbours->n; i++) {
        struct box *const box = &neighbours->box[i];
        for (int c = 0; c < 2; c++) {
            box->low[c] = random_number(seed);
            box->high[c] = box->low[c] + size * random_number(seed);
        }
    }
}

static int check(const struct neighbours *neighbours) {
    int n_pairs = 0;
    for (int i = 0; i < neighbours->n; i++) {
        int at = neighbours->first[i];
        for (int j = 0; j < neighbours->n; j++) {
            if (j == i || !overlap(&neighbours->box[i], &neighbours->box[j])) continue;
            BELOW(at, neighbours->first[i + 1]);
            assert_int_equal(neighbours->other[at++], j);
            n_pairs++;
        }
        assert_int_equal(at, neighbours->first[i + 1]);
    }
    return n_pairs;
}

TEST(overlaps_are_those_of_all_pairs) {
    const struct {
        int n;
        double size;
        int min_pairs;
    } cases[] = {{1, 1, 0}, {2, 10, 0}, {40, 0.01, 0}, {40, 0.3, 10}, {60, 2, 1000}};
    uint64_t seed = 1;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct neighbours *neighbours;
        neighbours = neighbours_create(test_arena(), cases[i].n);
        // independent random positions, and the same positions again
        for (int time = 0; time < 3; time++) {
            place(neighbours, cases[i].size, &seed);
            neighbours_find(neighbours);
            const int n_pairs = check(neighbours);
            AT_LEAST(n_pairs, cases[i].min_pairs);
            neighbours_find(neighbours);
            assert_int_equal(check(neighbours), n_pairs);
        }
    }
}

TEST(boxes_that_share_an_edge_overlap) {
    struct neighbours *neighbours;
    neighbours = neighbours_create(test_arena(), 3);
    neighbours->box[0] = (struct box){{0, 0}, {1, 1}};
    neighbours->box[1] = (struct box){{1, 1}, {2, 2}};
    neighbours->box[2] = (struct box){{2.001, 0}, {3, 2}};
    neighbours_find(neighbours);
    assert_int_equal(neighbours->first[3], 2);
    assert_int_equal(neighbours->other[0], 1);
}
