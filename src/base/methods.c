/* methods.c: the table of the integration methods, and the tableaux of the Runge-Kutta methods among them. */
#include "base/methods.h"

#include <stddef.h>

// clang-format off

static const struct butcher_tableau euler = {
    1, 1, 0,
    (const double[]){0},
    (const double[]){0},
    (const double[]){1},
    NULL,
};

// the second stage serves the embedded method of Heun
static const struct butcher_tableau euler_heun = {
    2, 1, 2,
    (const double[]){0, 1},
    (const double[]){0, 0,
                     1, 0},
    (const double[]){1, 0},
    (const double[]){0.5, 0.5},
};

static const struct butcher_tableau heun_euler = {
    2, 2, 1,
    (const double[]){0, 1},
    (const double[]){0, 0,
                     1, 0},
    (const double[]){0.5, 0.5},
    (const double[]){1, 0},
};

static const struct butcher_tableau classical = {
    4, 4, 0,
    (const double[]){0, 0.5, 0.5, 1},
    (const double[]){0,   0,   0, 0,
                     0.5, 0,   0, 0,
                     0,   0.5, 0, 0,
                     0,   0,   1, 0},
    (const double[]){1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6},
    NULL,
};

// the classical method with Zonneveld's fifth stage
static const struct butcher_tableau zonneveld = {
    5, 4, 3,
    (const double[]){0, 0.5, 0.5, 1, 3.0 / 4},
    (const double[]){0,        0,        0,         0,         0,
                     0.5,      0,        0,         0,         0,
                     0,        0.5,      0,         0,         0,
                     0,        0,        1,         0,         0,
                     5.0 / 32, 7.0 / 32, 13.0 / 32, -1.0 / 32, 0},
    (const double[]){1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6, 0},
    (const double[]){-1.0 / 2, 7.0 / 3, 7.0 / 3, 13.0 / 6, -16.0 / 3},
};

static const struct butcher_tableau dormand_prince = {
    7, 5, 4,
    (const double[]){0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1},
    (const double[]){
        0,              0,               0,              0,            0,               0,         0,
        1.0 / 5,        0,               0,              0,            0,               0,         0,
        3.0 / 40,       9.0 / 40,        0,              0,            0,               0,         0,
        44.0 / 45,      -56.0 / 15,      32.0 / 9,       0,            0,               0,         0,
        19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729, 0,               0,         0,
        9017.0 / 3168,  -355.0 / 33,     46732.0 / 5247, 49.0 / 176,   -5103.0 / 18656, 0,         0,
        35.0 / 384,     0,               500.0 / 1113,   125.0 / 192,  -2187.0 / 6784,  11.0 / 84, 0},
    (const double[]){35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84, 0},
    (const double[]){5179.0 / 57600, 0, 7571.0 / 16695, 393.0 / 640, -92097.0 / 339200, 187.0 / 2100, 1.0 / 40},
};

const struct method_properties methods_table[] = {
    // word           order implicit fixed adaptive tableaux                        help
    {"ida",            5,    true,    false, true, NULL,            NULL,            "BDF of variable order"},
    {"euler",          1,    false,   true,  true, &euler,          &euler_heun,     "Euler's explicit method"},
    {"heun",           2,    false,   true,  true, &heun_euler,     &heun_euler,     "Heun's method"},
    {"rk4",            4,    false,   true,  true, &classical,      &zonneveld,      "classical Runge-Kutta method"},
    {"dormand_prince", 5,    false,   true,  true, &dormand_prince, &dormand_prince, "method of Dormand and Prince"},
    {"implicit_euler", 1,    true,    true,  false, NULL,           NULL,            "Euler's implicit method"},
    {"trapezoid",      2,    true,    true,  false, NULL,           NULL,            "trapezoidal rule"},
    {"imex",           2,    true,    true,  false, NULL,           NULL,            "BDF 2 for the body, extrapolated "
                                                                                     "forces of the fluid"},
    {"verlet",         2,    false,   true,  false, NULL,           NULL,            "velocity Verlet, symplectic; rods "
                                                                                     "without fluid and damping only"},
};

// clang-format on

const int methods_n = sizeof methods_table / sizeof *methods_table;
