// 3D/Matrix.h: 3x3 matrices, by rows.
#ifndef SOLID_3D_MATRIX_H
#define SOLID_3D_MATRIX_H

#include "Point.h"
#include "Quaternion.h"

// A 3x3 matrix: m[i][j] is in row i and column j.
class Matrix {
public:
    // The identity.
    Matrix() { setIdentity(); }
    Matrix(Scalar xx, Scalar xy, Scalar xz, Scalar yx, Scalar yy, Scalar yz, Scalar zx, Scalar zy, Scalar zz) {
        setValue(xx, xy, xz, yx, yy, yz, zx, zy, zz);
    }
    explicit Matrix(const Quaternion& q) { setRotation(q); }

    void setIdentity() { setValue(1, 0, 0, 0, 1, 0, 0, 0, 1); }
    void setValue(Scalar xx, Scalar xy, Scalar xz, Scalar yx, Scalar yy, Scalar yz, Scalar zx, Scalar zy,
                  Scalar zz) {
        row[0].setValue(xx, xy, xz);
        row[1].setValue(yx, yy, yz);
        row[2].setValue(zx, zy, zz);
    }
    // The rotation of a quaternion of any length but 0.
    void setRotation(const Quaternion& q) {
        const Scalar s = 2 / q.length2();
        const Scalar x = q[0] * s, y = q[1] * s, z = q[2] * s;
        setValue(1 - (y * q[1] + z * q[2]), x * q[1] - z * q[3], x * q[2] + y * q[3],
                 x * q[1] + z * q[3], 1 - (x * q[0] + z * q[2]), y * q[2] - x * q[3],
                 x * q[2] - y * q[3], y * q[2] + x * q[3], 1 - (x * q[0] + y * q[1]));
    }
    void setEuler(Scalar yaw, Scalar pitch, Scalar roll) { setRotation(Quaternion(yaw, pitch, roll)); }
    void setScaling(Scalar x, Scalar y, Scalar z) { setValue(x, 0, 0, 0, y, 0, 0, 0, z); }

    Vector& operator[](int i) { return row[i]; }
    const Vector& operator[](int i) const { return row[i]; }
    Vector column(int j) const { return Vector(row[0][j], row[1][j], row[2][j]); }

    // The quaternion of a rotation, of length 1, w at least 0.
    Quaternion getRotation() const {
        // Four times the squares of its coordinates; the largest is safe to divide by.
        const Scalar xx = row[0][0], yy = row[1][1], zz = row[2][2];
        const Scalar squares[4] = {1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz};
        int k = 0;
        for (int i = 1; i < 4; ++i) if (squares[i] > squares[k]) k = i;
        const Scalar d[3] = {row[2][1] - row[1][2], row[0][2] - row[2][0], row[1][0] - row[0][1]};
        Quaternion q(0, 0, 0, 0);
        q[k] = squares[k];
        for (int i = 0; i < 3; ++i) {
            if (k == W) q[i] = d[i];
            else if (i != k) q[i] = row[i][k] + row[k][i];
        }
        if (k != W) q[W] = d[k];
        q.normalize();
        return q[W] < 0 ? Quaternion(-q[0], -q[1], -q[2], -q[3]) : q;
    }

    Matrix& operator*=(const Matrix& m) {
        Matrix p;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) p[i][j] = dot(row[i], m.column(j));
        }
        return *this = p;
    }
    Matrix transpose() const {
        return Matrix(row[0][0], row[1][0], row[2][0], row[0][1], row[1][1], row[2][1], row[0][2], row[1][2],
                      row[2][2]);
    }
    Scalar determinant() const { return triple(row[0], row[1], row[2]); }
    // Of a matrix whose determinant is not 0.
    Matrix inverse() const {
        const Scalar s = 1 / determinant();
        const Vector x = cross(row[1], row[2]) * s, y = cross(row[2], row[0]) * s, z = cross(row[0], row[1]) * s;
        return Matrix(x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]);
    }

private:
    Vector row[3];
};

inline Matrix operator*(const Matrix& a, const Matrix& b) {
    Matrix m(a);
    return m *= b;
}
inline Vector operator*(const Matrix& m, const Vector& v) { return Vector(dot(m[0], v), dot(m[1], v), dot(m[2], v)); }

inline std::ostream& operator<<(std::ostream& os, const Matrix& m) {
    return os << m[0] << '\n' << m[1] << '\n' << m[2] << '\n';
}

#endif
