// 3D/Quaternion.h: orientations as quaternions (x, y, z, w), w the real part.
#ifndef SOLID_3D_QUATERNION_H
#define SOLID_3D_QUATERNION_H

#include "Vector.h"

// A quaternion. For dtRotate: dtRotate(q[X], q[Y], q[Z], q[W]).
class Quaternion {
public:
    // The identity.
    Quaternion() { setValue(0, 0, 0, 1); }
    Quaternion(Scalar x, Scalar y, Scalar z, Scalar w) { setValue(x, y, z, w); }
    // A rotation by an angle in radians about an axis of any length but 0.
    Quaternion(const Vector& axis, Scalar angle) { setRotation(axis, angle); }
    // See setEuler.
    Quaternion(Scalar yaw, Scalar pitch, Scalar roll) { setEuler(yaw, pitch, roll); }
    explicit Quaternion(const float v[4]) { setValue(v[0], v[1], v[2], v[3]); }
    explicit Quaternion(const double v[4]) { setValue(v[0], v[1], v[2], v[3]); }

    void setValue(Scalar x, Scalar y, Scalar z, Scalar w) {
        co[0] = x;
        co[1] = y;
        co[2] = z;
        co[3] = w;
    }
    void setRotation(const Vector& axis, Scalar angle) {
        const Scalar s = std::sin(angle / 2) / axis.length();
        setValue(axis[0] * s, axis[1] * s, axis[2] * s, std::cos(angle / 2));
    }
    // Rolls about z, then pitches about x, then yaws about y; in radians. As a product: yaw * pitch * roll.
    void setEuler(Scalar yaw, Scalar pitch, Scalar roll) {
        const Scalar cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
        const Scalar cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
        const Scalar cr = std::cos(roll / 2), sr = std::sin(roll / 2);
        setValue(cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr, cy * cp * sr - sy * sp * cr,
                 cy * cp * cr + sy * sp * sr);
    }

    Scalar& operator[](int i) { return co[i]; }
    const Scalar& operator[](int i) const { return co[i]; }
    const Scalar* data() const { return co; }

    Scalar length2() const { return sqr(co[0]) + sqr(co[1]) + sqr(co[2]) + sqr(co[3]); }
    Scalar length() const { return std::sqrt(length2()); }
    void normalize() {
        const Scalar s = 1 / length();
        for (int i = 0; i < 4; ++i) co[i] *= s;
    }
    Quaternion normalized() const {
        Quaternion q(*this);
        q.normalize();
        return q;
    }
    // For a rotation, the same the other way round.
    Quaternion conjugate() const { return Quaternion(-co[0], -co[1], -co[2], co[3]); }
    Quaternion inverse() const {
        const Scalar s = 1 / length2();
        return Quaternion(-co[0] * s, -co[1] * s, -co[2] * s, co[3] * s);
    }

    // Applies q first.
    Quaternion& operator*=(const Quaternion& q) {
        setValue(co[3] * q[0] + co[0] * q[3] + co[1] * q[2] - co[2] * q[1],
                 co[3] * q[1] + co[1] * q[3] + co[2] * q[0] - co[0] * q[2],
                 co[3] * q[2] + co[2] * q[3] + co[0] * q[1] - co[1] * q[0],
                 co[3] * q[3] - co[0] * q[0] - co[1] * q[1] - co[2] * q[2]);
        return *this;
    }

    // An orientation, all equally likely, by rand(). (Two points on circles whose squared radii add up to 1.)
    static Quaternion random() {
        const Scalar u = randomScalar(), r = std::sqrt(1 - u), s = std::sqrt(u);
        const Scalar a = SCALAR_2_PI * randomScalar(), b = SCALAR_2_PI * randomScalar();
        return Quaternion(r * std::sin(a), r * std::cos(a), s * std::sin(b), s * std::cos(b));
    }

private:
    Scalar co[4];
};

inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
    Quaternion q(a);
    return q *= b;
}
inline bool operator==(const Quaternion& a, const Quaternion& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}
inline bool operator!=(const Quaternion& a, const Quaternion& b) { return !(a == b); }

inline std::ostream& operator<<(std::ostream& os, const Quaternion& q) {
    return os << q[0] << ' ' << q[1] << ' ' << q[2] << ' ' << q[3];
}

#endif
