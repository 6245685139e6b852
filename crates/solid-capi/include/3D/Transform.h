// 3D/Transform.h: affine transformations.
#ifndef SOLID_3D_TRANSFORM_H
#define SOLID_3D_TRANSFORM_H

#include "Matrix.h"

// An affine transformation: p goes to basis * p + origin. Commands multiply from the right, as dtTranslate and kin do.
class Transform {
public:
    // The identity.
    Transform() {}
    explicit Transform(const Matrix& m, const Point& p = Point()) : basis(m), origin(p) {}
    explicit Transform(const Quaternion& q, const Point& p = Point()) : basis(q), origin(p) {}
    // From a 4x4 matrix by columns, as in OpenGL; the bottom row is ignored.
    explicit Transform(const float m[16]) { setValue(m); }
    explicit Transform(const double m[16]) { setValue(m); }

    void setIdentity() { *this = Transform(); }
    void setValue(const float m[16]) { load(m); }
    void setValue(const double m[16]) { load(m); }
    // For dtLoadMatrixf and dtLoadMatrixd.
    void getValue(float m[16]) const { store(m); }
    void getValue(double m[16]) const { store(m); }

    const Matrix& getBasis() const { return basis; }
    const Point& getOrigin() const { return origin; }
    // Of a transformation that has no scale.
    Quaternion getRotation() const { return basis.getRotation(); }
    void setBasis(const Matrix& m) { basis = m; }
    void setOrigin(const Point& p) { origin = p; }
    void setRotation(const Quaternion& q) { basis.setRotation(q); }

    void translate(const Vector& v) { origin += basis * v; }
    void rotate(const Quaternion& q) { basis *= Matrix(q); }
    void scale(Scalar x, Scalar y, Scalar z) {
        Matrix m;
        m.setScaling(x, y, z);
        basis *= m;
    }

    Point operator()(const Point& p) const { return origin + basis * p; }
    Point operator*(const Point& p) const { return (*this)(p); }
    // Applies t first.
    Transform& operator*=(const Transform& t) {
        origin = (*this)(t.origin);
        basis *= t.basis;
        return *this;
    }
    // Of a transformation that does not flatten.
    Transform inverse() const {
        const Matrix back = basis.inverse();
        return Transform(back, back * -origin);
    }

private:
    template <typename T> void load(const T m[16]) {
        for (int i = 0; i < 3; ++i) {
            basis[i].setValue(m[i], m[4 + i], m[8 + i]);
            origin[i] = m[12 + i];
        }
    }
    template <typename T> void store(T m[16]) const {
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) m[4 * j + i] = T(basis[i][j]);
            m[12 + i] = T(origin[i]);
            m[4 * i + 3] = T(0);
        }
        m[15] = T(1);
    }

    Matrix basis;
    Point origin;
};

inline Transform operator*(const Transform& a, const Transform& b) {
    Transform t(a);
    return t *= b;
}

#endif
