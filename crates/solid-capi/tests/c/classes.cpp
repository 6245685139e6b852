// The classes of 3D/, alone and with the library; and that exceptions pass through dtTest.
#include <3D/Matrix.h>
#include <3D/Point.h>
#include <3D/Quaternion.h>
#include <3D/Scalar.h>
#include <3D/Transform.h>
#include <3D/Vector.h>

#include "check.h"

static bool same(const Vector& a, const Vector& b) { return (a - b).length() < 1e-12; }
static bool same(const Quaternion& a, const Quaternion& b) {
    return std::fabs(a[X] * b[X] + a[Y] * b[Y] + a[Z] * b[Z] + a[W] * b[W]) > 1 - 1e-12;
}

static void vectors() {
    const Vector x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    CHECK(cross(x, y) == z && dot(x, y) == 0 && triple(x, y, z) == 1);
    CHECK(NEAR(angle(x, x + y), radians(45)) && NEAR(degrees(SCALAR_PI), 180));
    CHECK((2 * x + y * 3 - z / 2 == Vector(2, 3, -0.5)) && -x != x);
    CHECK(Vector(3, 0, 4).length() == 5 && same(Vector(3, 0, 4).normalized(), Vector(0.6, 0, 0.8)));
    CHECK(Vector(1, -5, 3).closestAxis() == Y);
    const Point p(1, 2, 3), q(1, 2, 7);
    CHECK(distance(p, q) == 4 && q - p == Vector(0, 0, 4) && (p + z)[Z] == 4 && (p - z)[Z] == 2);
    CHECK(sizeof(Point) == 3 * sizeof(double));
    Vector sum;
    for (int i = 0; i < 1000; ++i) {
        const Vector v = Vector::random();
        CHECK(NEAR(v.length(), 1));
        sum += v;
    }
    CHECK(sum.length() < 150);
}

static void quaternions() {
    const Vector x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    Quaternion q(z * 7, SCALAR_HALF_PI);
    CHECK(NEAR(q.length(), 1) && same(Matrix(q) * x, y));
    q.setRotation(x, SCALAR_HALF_PI);
    CHECK(same(Matrix(q) * y, z));
    // Yaw about y, pitch about x, roll about z.
    CHECK(same(Quaternion(0.5, 0, 0), Quaternion(y, 0.5)));
    CHECK(same(Quaternion(0, 0.5, 0), Quaternion(x, 0.5)));
    CHECK(same(Quaternion(0, 0, 0.5), Quaternion(z, 0.5)));
    CHECK(same(Quaternion(0.1, 0.2, 0.3), Quaternion(y, 0.1) * Quaternion(x, 0.2) * Quaternion(z, 0.3)));
    q.setEuler(0.1, 0.2, 0.3);
    CHECK(same(q, Quaternion(0.1, 0.2, 0.3)));
    CHECK(same(q * q.inverse(), Quaternion()) && same(q.conjugate(), q.inverse()));
    for (int i = 0; i < 1000; ++i) {
        const Quaternion r = Quaternion::random();
        CHECK(NEAR(r.length(), 1));
        CHECK(same(Matrix(r).getRotation(), r));
        CHECK(same(Matrix(r * q) * x, Matrix(r) * (Matrix(q) * x)));
        CHECK(NEAR(Matrix(r).determinant(), 1));
        CHECK(same(Matrix(r).inverse() * y, Matrix(r).transpose() * y));
    }
}

static void transforms() {
    Transform t;
    t.translate(Vector(1, 2, 3));
    t.rotate(Quaternion(Vector(0, 0, 1), SCALAR_HALF_PI));
    t.scale(2, 1, 1);
    CHECK(same(t(Point(1, 0, 0)), Point(1, 4, 3)));
    CHECK(same(t.inverse()(Point(1, 4, 3)), Point(1, 0, 0)));
    CHECK(same((t * t.inverse())(Point(5, 6, 7)), Point(5, 6, 7)));
    double m[16];
    float f[16];
    t.getValue(m);
    t.getValue(f);
    CHECK(NEAR(m[1], 2) && m[12] == 1 && m[15] == 1 && m[3] == 0);
    CHECK(same(Transform(m)(Point(3, 1, 2)), t(Point(3, 1, 2))));
    CHECK((Transform(f)(Point(3, 1, 2)) - t(Point(3, 1, 2))).length() < 1e-5);
}

// The commands of the library do what the classes do.
static void together() {
    static int a, b;
    const Point vertices[3] = {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
    DtShapeRef triangle = dtNewComplexShape();
    dtVertexBase(vertices);
    dtVertexRange(DT_POLYGON, 0, 3);
    dtEndComplexShape();
    DtShapeRef point = dtSphere(1e-9);
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, 0);
    dtCreateObject(&a, triangle);
    dtCreateObject(&b, point);
    for (int i = 0; i < 100; ++i) {
        const Quaternion q = Quaternion::random();
        const Vector v = Vector::random() * 3;
        Transform t;
        t.translate(v);
        t.rotate(q);
        t.scale(1, -2, 3);
        dtSelectObject(&a);
        if (i % 2) {
            dtLoadIdentity();
            dtTranslate(v[X], v[Y], v[Z]);
            dtRotate(q[X], q[Y], q[Z], q[W]);
            dtScale(1, -2, 3);
        } else {
            double m[16];
            t.getValue(m);
            dtLoadMatrixd(m);
        }
        const Point inside = t(Point(0.2, 0.3, 0)), outside = t(Point(0.6, 0.6, 0));
        place(&b, inside[X], inside[Y], inside[Z]);
        CHECK(test() == 1);
        place(&b, outside[X], outside[Y], outside[Z]);
        CHECK(test() == 0);
    }
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(triangle);
    dtDeleteShape(point);
}

static void throws(void*, DtObjectRef, DtObjectRef, const DtCollData*) { throw 42; }

static void exceptions() {
    static int a, b;
    DtShapeRef ball = dtSphere(1);
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    dtSetDefaultResponse(throws, DT_SMART_RESPONSE, 0);
    for (int i = 0; i < 100; ++i) { // More often than dtTest may nest.
        int caught = 0;
        try {
            if (i % 2) dtTest(); else dtTestObjects(&a, &b);
        } catch (int thrown) {
            caught = thrown;
        }
        CHECK(caught == 42);
    }
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, 0);
    CHECK(test() == 1);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(ball);
}

int main() {
    vectors();
    quaternions();
    transforms();
    together();
    exceptions();
    return finish();
}
