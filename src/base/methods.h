/* methods.h: the integration methods. */
#ifndef METHODS_H
#define METHODS_H

enum method {
    METHOD_IDA,
    METHOD_EULER,
    METHOD_HEUN,
    METHOD_RK4,
    METHOD_DORMAND_PRINCE,
    METHOD_IMPLICIT_EULER,
    METHOD_TRAPEZOID
};

#endif
