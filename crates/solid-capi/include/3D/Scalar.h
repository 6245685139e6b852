// 3D/Scalar.h: numbers. C++98 and later; all of 3D/ is inline, there is nothing to link.
#ifndef SOLID_3D_SCALAR_H
#define SOLID_3D_SCALAR_H

#include <cmath>
#include <cstdlib>

typedef double Scalar;

// Names of coordinates: v[X], q[W].
enum { X, Y, Z, W };

const Scalar SCALAR_PI = 3.14159265358979323846;
const Scalar SCALAR_2_PI = 2 * SCALAR_PI;
const Scalar SCALAR_HALF_PI = SCALAR_PI / 2;
const Scalar DEGS_PER_RAD = 180 / SCALAR_PI;
const Scalar RADS_PER_DEG = SCALAR_PI / 180;

// Angles from degrees to radians and back.
inline Scalar radians(Scalar degrees) { return degrees * RADS_PER_DEG; }
inline Scalar degrees(Scalar radians) { return radians * DEGS_PER_RAD; }

inline Scalar sqr(Scalar x) { return x * x; }

// A random number from [0, 1), by rand().
inline Scalar randomScalar() { return std::rand() / (RAND_MAX + Scalar(1)); }
// The same, as SOLID 2.0 calls it.
inline Scalar rnd() { return randomScalar(); }

#endif
