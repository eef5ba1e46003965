/* angle.h: angles in radians and degrees. Tested by tests/base/test_angle.c. */
#ifndef ANGLE_H
#define ANGLE_H

/* The angle [rad] minus an integer number of turns, in [-pi, pi]. */
double angle_wrap(double angle);

/* Radians of an angle in degrees, and back. */
double angle_radians(double degrees);
double angle_degrees(double radians);

#endif
