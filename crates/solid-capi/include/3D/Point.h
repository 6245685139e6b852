// 3D/Point.h: points.
#ifndef SOLID_3D_POINT_H
#define SOLID_3D_POINT_H

#include "Vector.h"

// A point. Packed: an array of these is a vertex array for dtVertexBase.
class Point : public Vector {
public:
    Point() {}
    Point(Scalar x, Scalar y, Scalar z) : Vector(x, y, z) {}
    // A DtVector, among others.
    Point(const float v[3]) : Vector(v) {}
    Point(const double v[3]) : Vector(v) {}
    // The point whose position vector is v.
    Point(const Vector& v) : Vector(v) {}
};

inline Point operator+(const Point& p, const Vector& v) { return Point(p[0] + v[0], p[1] + v[1], p[2] + v[2]); }
inline Point operator-(const Point& p, const Vector& v) { return Point(p[0] - v[0], p[1] - v[1], p[2] - v[2]); }
inline Vector operator-(const Point& p, const Point& q) { return Vector(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }
// Or either of the two before would do.
inline Vector operator-(const Vector& v, const Point& p) { return Vector(v[0] - p[0], v[1] - p[1], v[2] - p[2]); }

inline Scalar distance2(const Point& p, const Point& q) { return (p - q).length2(); }
inline Scalar distance(const Point& p, const Point& q) { return (p - q).length(); }

#endif
