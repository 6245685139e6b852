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

    // Members, so that an array beside a point or a vector is taken for a Vector, and for nothing else.
    Point operator+(const Vector& v) const { return Vector(*this) += v; }
    Point operator-(const Vector& v) const { return Vector(*this) -= v; }
    Vector operator-(const Point& q) const { return Vector(*this) -= q; }
    Vector operator-(const float q[3]) const { return Vector(*this) -= q; }
    Vector operator-(const double q[3]) const { return Vector(*this) -= q; }
};

inline Scalar distance2(const Point& p, const Point& q) { return (p - q).length2(); }
inline Scalar distance(const Point& p, const Point& q) { return (p - q).length(); }

#endif
