// 3D/Basic.h: functions of numbers, by the names that they have in SOLID 2.0. The other headers do without, since a program may have
// its own min, max or EPSILON.
#ifndef SOLID_3D_BASIC_H
#define SOLID_3D_BASIC_H

#include "Scalar.h"

const Scalar TWO_PI = SCALAR_2_PI;
const Scalar EPSILON = 1e-10;

// Angles from degrees to radians and back.
inline Scalar rads(Scalar degrees) { return radians(degrees); }
inline Scalar degs(Scalar radians) { return degrees(radians); }

// The sign: -1, 0 or 1.
inline int sgn(Scalar x) { return (x > 0) - (x < 0); }
// Whether a number is 0, or nearly so in a unit of length of about its data's size.
inline bool eqz(Scalar x) { return std::fabs(x) <= EPSILON; }

// Beside those of <algorithm>, which compare numbers of other types.
inline Scalar min(Scalar a, Scalar b) { return b < a ? b : a; }
inline Scalar max(Scalar a, Scalar b) { return a < b ? b : a; }

#endif
