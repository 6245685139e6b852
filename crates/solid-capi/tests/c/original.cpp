// The classes of 3D/ as programs written for SOLID 2.0 use them, beside all of the standard library's names.
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include <3D/Basic.h>
#include <3D/Matrix.h>
#include <3D/Point.h>
#include <3D/Quaternion.h>
#include <3D/Transform.h>
#include <SOLID/solid.h>

#include "check.h"

using namespace std;

static Point first;
static Vector out;

// What a response is told are arrays.
static void part(void*, DtObjectRef, DtObjectRef, const DtCollData* data) {
    Point p = data->point1;
    Vector n = data->normal;
    first = data->point1;
    first = p + n * 0.0;
    out = n;
}

static Vector moved(const Vector& v) { return v; }
static Point moved(const Point& p) { return p + Vector(1, 0, 0); }
static Scalar height(const Point& p) { return p[Y]; }

static void points_and_vectors() {
    const Point p(1, 2, 3), q(3, 2, 1);
    const Vector v(0, 4, 0);
    const double s = 0.5;
    Point mid = (p + s * v + q) * 0.5;
    CHECK(mid == Point(2, 3, 2));
    mid = v * 2.0;
    mid += v;
    CHECK(mid == Point(0, 12, 0) && height(v) == 4);
    const float array[3] = {1, 2, 3};
    const Point same = array;
    CHECK(same == p && distance(p, array) == 0 && distance2(p, same) == 0);
    // What was no question stays none.
    CHECK(p - q == Vector(-2, 0, 2) && p - v == Point(1, -2, 3) && v - p == Vector(-1, 2, -3) && v - v == Vector());
    CHECK(v + p == p + v && -p == -1 * p && p / 2 == p * 0.5);
    CHECK(moved(v) == v && moved(p) == Point(2, 2, 3));
    CHECK((s > 0 ? p : v) == p && (s > 0 ? v : p) == v);
    vector<Point> all(3, p);
    all[1] = q;
    CHECK(accumulate(all.begin(), all.end(), Point()) == Point(5, 6, 7));
    CHECK(distance(all.begin(), all.end()) == 3 && count(all.begin(), all.end(), q) == 1);
    const Transform t(Matrix(), v);
    CHECK(t(p) == p + v && t * p == t(p) && t.inverse()(v) == Point());
}

// An array of either type is a Vector, on either side.
template <class T> static void arrays() {
    const T a[3] = {1, 2, 3};
    const Point p(3, 2, 1);
    const Vector v(0, 4, 0);
    CHECK(p - a == Vector(2, 0, -2) && a - p == Vector(-2, 0, 2) && p + a == Point(4, 4, 4) && a + p == p + a);
    CHECK(v - a == Vector(-1, 2, -3) && a - v == Vector(1, -2, 3) && v + a == Vector(1, 6, 3) && a + v == v + a);
    Point q = p - a;
    Vector w = p - a;
    CHECK(q == w && q - a == w - a);
    q -= a;
    w += a;
    CHECK(q == Point(1, -2, -5) && w == p && moved(p + v) == p + v + Vector(1, 0, 0) && moved(p - v) == p - v + Vector(1, 0, 0));
}

static void arithmetic() {
    CHECK(NEAR(rads(180), SCALAR_PI) && NEAR(degs(TWO_PI), 360));
    CHECK(sgn(-3) == -1 && sgn(0) == 0 && sgn(0.1) == 1 && eqz(1e-11) && eqz(0) && !eqz(-0.1));
    const Scalar a = 1, b = 2;
    const float c = 1, d = 2;
    CHECK(min(a, b) == a && max(a, b) == b && min(1.0, b) == 1 && max(1, 2.5) == 2.5 && min(c, d) == c && max(1, 2) == 2);
    CHECK(min(1u, 2u) == 1 && min<double>(a, 2) == a && std::max(a, b) == b && max(b, a, greater<double>()) == a);
    int some[3] = {3, 1, 2};
    sort(some, some + 3);
    CHECK(*min_element(some, some + 3) == 1);
    srand(7);
    for (int i = 0; i < 1000; ++i) {
        const Scalar x = rnd();
        CHECK(x >= 0 && x < 1);
    }
}

static void responses() {
    static int a, b;
    DtShapeRef ball = dtSphere(1);
    dtSetDefaultResponse(part, DT_SMART_RESPONSE, 0);
    dtCreateObject(&a, ball);
    place(&a, 3, 0, 0);
    dtCreateObject(&b, ball);
    CHECK(dtTest() == 0);
    dtProceed();
    place(&a, 1.5, 0, 0);
    CHECK(dtTest() == 1 && NEAR(first[X], -1) && NEAR(out[X], 1));
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(ball);
}

int main() {
    points_and_vectors();
    arrays<float>();
    arrays<double>();
    arithmetic();
    responses();
    return finish();
}
