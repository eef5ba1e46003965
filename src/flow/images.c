/* images.c: one image for a single wall, and Gauss rules that replace the infinite sums of images in a channel. */
#include "flow/images.h"

#include <string.h>

#include "base/mathematics.h"
#include "flow/flow.h"

// ---- sums over k = 1, 2, .. of a function that is analytic for Re k > 0 and decays like 1/k^2

enum {
    RULE_NODES = 8,   // of every Gauss rule
    RULE_PANELS = 8,  // at most; panel i has the terms 4^i < k <= 4^(i+1)
    RULE_REST = 4     // nodes of the integral beyond the last term
};

/* Nodes, which lie between the terms of a sum over k, and their weights. */
struct rule {
    int n;
    double node[(RULE_PANELS + 2) * RULE_NODES], weight[(RULE_PANELS + 2) * RULE_NODES];
};

// depth: in channel widths. At distances between H and w an image acts like a point vortex, beyond w like a ring, so a
// deeper fish needs more panels.
static struct rule rule_of_channel(struct arena *arena, double depth) {
    int n_panels = 0, first = 1;
    for (; n_panels < RULE_PANELS && first < depth / 8; n_panels++) first *= 4;
    const int last = first < 256 ? 1000 : 4 * first;
    struct rule rule = {.n = 1, .node = {1}, .weight = {1}};
    double *scratch;
    NEW(arena, scratch, 4 * (last + RULE_REST));

    // panels of the terms from < k <= 4 from; a panel of many terms is replaced by the Gauss rule of its sum
    for (int i = 0, from = 1; i < n_panels; i++, from *= 4) {
        const int n = 3 * from;
        double *const k = scratch, *const weight = scratch + n;
        for (int j = 0; j < n; j++) {
            k[j] = from + 1 + j;
            weight[j] = 1;
        }

        if (n > RULE_NODES) {
            quadrature_of_sum(n, k, weight, scratch + 2 * n, RULE_NODES, rule.node + rule.n, rule.weight + rule.n);
        } else {
            memcpy(rule.node + rule.n, k, (size_t)n * sizeof *k);
            memcpy(rule.weight + rule.n, weight, (size_t)n * sizeof *k);
        }
        rule.n += n > RULE_NODES ? RULE_NODES : n;
    }

    // all terms k > first, by the Gauss rule of the sum over (first/k)^2 f(first/k); terms beyond last become an
    // integral
    const int n = last - first + RULE_REST;
    double *const t = scratch, *const weight = scratch + n, top = first / (last + 0.5);
    quadrature_legendre(RULE_REST, t, weight);
    for (int i = 0; i < RULE_REST; i++) {
        t[i] *= top;
        weight[i] *= first * top;
    }

    for (int i = RULE_REST; i < n; i++) {
        t[i] = first / (double)(first + 1 + i - RULE_REST);
        weight[i] = t[i] * t[i];
    }

    double *const node = rule.node + rule.n, *const of_node = rule.weight + rule.n;
    quadrature_of_sum(n, t, weight, scratch + 2 * n, RULE_NODES, node, of_node);
    for (int i = 0; i < RULE_NODES; i++) {
        of_node[i] /= node[i] * node[i];
        node[i] = first / node[i];
    }
    rule.n += RULE_NODES;
    return rule;
}

int images_find(struct arena *arena, const struct walls *walls, double depth, struct image **image) {
    *image = NULL;
    if (walls->n == 0) return 0;
    struct rule rule = {.n = 0};
    const double width = walls->n == 2 ? walls->y[1] - walls->y[0] : 0;
    if (walls->n == 2) {
        struct arena *const scratch = arena_create(arena, "the images of a channel");
        rule = rule_of_channel(scratch, depth / width);
        arena_free(scratch);
    }
    const int n_images = walls->n == 2 ? 4 * rule.n : walls->n;
    NEW(arena, *image, n_images);

    if (walls->n == 1) **image = (struct image){-1, 2 * walls->y[0], 1};
    for (int i = 0; i < rule.n; i++) {
        // the images are symmetric about the middle of the channel
        const double sum = walls->y[0] + walls->y[1], shift = 2 * rule.node[i] * width, weight = rule.weight[i];
        struct image *const to = *image + 4L * i;
        to[0] = (struct image){-1, sum - (shift - width), weight};
        to[1] = (struct image){-1, sum + (shift - width), weight};
        to[2] = (struct image){1, shift, weight};
        to[3] = (struct image){1, -shift, weight};
    }
    return n_images;
}

void images_write(const struct sources *sources, int n_images, const struct image *image, struct sources *images) {
    images->n = 0;
    sources_append(images, n_images * sources->n);
    for (int k = 0; k < n_images; k++) {
        const double weight = image[k].weight, reversed = image[k].sign * weight;
        const int first = k * sources->n;
        for (int i = 0; i < sources->n; i++) {
            images->x[first + i] = sources->x[i];
            images->y[first + i] = image[k].sign * sources->y[i] + image[k].shift;
            images->q[first + i] = reversed * sources->q[i];
            images->dx[first + i] = reversed * sources->dx[i];
            images->dy[first + i] = weight * sources->dy[i];
        }

        const size_t size = (size_t)sources->n * sizeof(double);
        if (sources->n == 0) continue;
        memcpy(images->half + first, sources->half, size);
        memcpy(images->leg + first, sources->leg, size);
        memcpy(images->square + first, sources->square, size);
    }
}
