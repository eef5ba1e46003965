/* third_kernel.h: A kernel that is no part of the program, with finite span and b doubled for all pairs. Tree, images,
 * Jacobian and field must work with it as with any other. */
#ifndef THIRD_KERNEL_H
#define THIRD_KERNEL_H

#include "flow/kernel.h"

static struct kernel third;

static struct kernel_pair third_own(double depth, double square) {
    return (struct kernel_pair){.kernel = &third, .span = depth / 2, .factor = 4, .square = square};
}

static struct kernel_pair third_other(double depth, double square) {
    return (struct kernel_pair){.kernel = &third, .span = depth, .factor = 16, .square = square};
}

static const struct kernel *third_kernel(void) {
    third = kernel_finite;
    third.own = third_own;
    third.other = third_other;
    return &third;
}

#endif
