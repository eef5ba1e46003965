/* angle.c: angles in radians and degrees. */
#include "base/angle.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double angle_wrap(double angle) {
    return remainder(angle, 2 * pi);
}

double angle_radians(double degrees) {
    return degrees * (pi / 180);
}

double angle_degrees(double radians) {
    return radians * (180 / pi);
}
