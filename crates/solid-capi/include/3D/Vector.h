// 3D/Vector.h: vectors.
#ifndef SOLID_3D_VECTOR_H
#define SOLID_3D_VECTOR_H

#include "Scalar.h"

#include <ostream>

// A vector. Packed: an array of these is an array of Scalar[3].
class Vector {
public:
    Vector() { setValue(0, 0, 0); }
    Vector(Scalar x, Scalar y, Scalar z) { setValue(x, y, z); }
    // A DtVector, among others.
    Vector(const float v[3]) { setValue(v[0], v[1], v[2]); }
    Vector(const double v[3]) { setValue(v[0], v[1], v[2]); }

    void setValue(Scalar x, Scalar y, Scalar z) {
        co[0] = x;
        co[1] = y;
        co[2] = z;
    }
    void getValue(float v[3]) const { for (int i = 0; i < 3; ++i) v[i] = float(co[i]); }
    void getValue(double v[3]) const { for (int i = 0; i < 3; ++i) v[i] = co[i]; }

    Scalar& operator[](int i) { return co[i]; }
    const Scalar& operator[](int i) const { return co[i]; }
    const Scalar* data() const { return co; }

    Vector& operator+=(const Vector& v) {
        for (int i = 0; i < 3; ++i) co[i] += v[i];
        return *this;
    }
    Vector& operator-=(const Vector& v) {
        for (int i = 0; i < 3; ++i) co[i] -= v[i];
        return *this;
    }
    Vector& operator*=(Scalar s) {
        for (int i = 0; i < 3; ++i) co[i] *= s;
        return *this;
    }
    Vector& operator/=(Scalar s) {
        for (int i = 0; i < 3; ++i) co[i] /= s;
        return *this;
    }

    // The square of the length.
    Scalar length2() const { return sqr(co[0]) + sqr(co[1]) + sqr(co[2]); }
    Scalar length() const { return std::sqrt(length2()); }
    // Brings the length to 1. The zero vector has no direction: do not ask for one.
    void normalize() { *this /= length(); }
    Vector normalized() const {
        Vector v(*this);
        v.normalize();
        return v;
    }
    // The index of the coordinate of largest magnitude.
    int closestAxis() const {
        const Scalar x = std::fabs(co[0]), y = std::fabs(co[1]), z = std::fabs(co[2]);
        return x >= y ? (x >= z ? X : Z) : (y >= z ? Y : Z);
    }

    // A direction, all equally likely, by rand().
    static Vector random() {
        const Scalar z = 2 * randomScalar() - 1, angle = SCALAR_2_PI * randomScalar();
        const Scalar r = std::sqrt(1 - z * z);
        return Vector(r * std::cos(angle), r * std::sin(angle), z);
    }

private:
    Scalar co[3];
};

inline Vector operator+(const Vector& a, const Vector& b) { return Vector(a[0] + b[0], a[1] + b[1], a[2] + b[2]); }
inline Vector operator-(const Vector& a, const Vector& b) { return Vector(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
inline Vector operator-(const Vector& v) { return Vector(-v[0], -v[1], -v[2]); }
inline Vector operator*(const Vector& v, Scalar s) { return Vector(v[0] * s, v[1] * s, v[2] * s); }
inline Vector operator*(Scalar s, const Vector& v) { return v * s; }
inline Vector operator/(const Vector& v, Scalar s) { return Vector(v[0] / s, v[1] / s, v[2] / s); }
inline bool operator==(const Vector& a, const Vector& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }
inline bool operator!=(const Vector& a, const Vector& b) { return !(a == b); }

inline Scalar dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
    return Vector(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}
// The volume of the parallelepiped on three vectors.
inline Scalar triple(const Vector& a, const Vector& b, const Vector& c) { return dot(a, cross(b, c)); }
// The angle between two vectors, in radians.
inline Scalar angle(const Vector& a, const Vector& b) { return std::atan2(cross(a, b).length(), dot(a, b)); }

inline std::ostream& operator<<(std::ostream& os, const Vector& v) {
    return os << v[0] << ' ' << v[1] << ' ' << v[2];
}

#endif
