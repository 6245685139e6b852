/* Objects: references, the current object, placements. */
#include "check.h"

static int a, b;
static DtShapeRef ball, brick;

/* Where the object's point (x, y, z) is in the world: asked by a witnessed collision with a tiny ball. */
static int at(double x, double y, double z) {
    DtShapeRef point = dtSphere(1e-6);
    int probe, hit;
    dtCreateObject(&probe, point);
    dtTranslate(x, y, z);
    hit = test() == 1;
    dtDeleteObject(&probe);
    dtDeleteShape(point);
    return hit;
}

static void placements(void) {
    static const double matrix[16] = {0, 1, 0, 9, -1, 0, 0, 9, 0, 0, 1, 9, 10, 20, 30, 9};
    static const float matrixf[16] = {0, 1, 0, 9, -1, 0, 0, 9, 0, 0, 1, 9, 10, 20, 30, 9};
    DtShapeRef arrow = dtNewComplexShape(); /* A segment from the origin to (3, 0, 0). */
    double half = sqrt(0.5);
    dtBegin(DT_SIMPLEX);
    dtVertex(0, 0, 0);
    dtVertex(3, 0, 0);
    dtEnd();
    dtEndComplexShape();
    dtCreateObject(&a, arrow);
    CHECK(at(2.99, 0, 0) && !at(0, 2.99, 0));
    dtSelectObject(&a);
    /* As in OpenGL the last command is applied to the points first. */
    dtTranslate(10, 0, 0);
    dtRotate(0, 0, half, half); /* 90 degrees about z. */
    CHECK(at(10, 2.99, 0) && !at(12, 0, 0));
    dtSelectObject(&a);
    dtTranslate(1, 0, 0);
    CHECK(at(10, 3.99, 0) && at(10, 1.01, 0) && !at(10, 0.9, 0));
    dtSelectObject(&a);
    dtScale(2, 1, 1);
    CHECK(at(10, 6.99, 0));
    dtSelectObject(&a);
    dtLoadIdentity();
    CHECK(at(2.99, 0, 0));
    /* Columns; the bottom row is ignored. */
    dtSelectObject(&a);
    dtLoadMatrixd(matrix);
    CHECK(at(10, 22.99, 30) && at(10, 20, 30));
    dtSelectObject(&a);
    dtLoadMatrixf(matrixf);
    CHECK(at(10, 22.99, 30));
    dtSelectObject(&a);
    dtMultMatrixd(matrix); /* Again, in its own coordinates. */
    CHECK(at(-10, 30, 60) && at(-12.99, 30, 60));
    dtSelectObject(&a);
    dtLoadIdentity();
    dtMultMatrixf(matrixf);
    CHECK(at(10, 22.99, 30));
    /* In the coordinates that are scaled already. */
    dtSelectObject(&a);
    dtLoadIdentity();
    dtScale(1, 2, 1);
    dtRotate(0, 0, half, half);
    CHECK(at(0, 5.99, 0) && !at(2, 0, 0));
    dtSelectObject(&a);
    dtMultMatrixd(matrix);
    CHECK(at(-20, 20, 30) && at(-22.99, 20, 30));
    /* Any quaternion but zero; mirroring. */
    dtSelectObject(&a);
    dtLoadIdentity();
    dtRotate(0, 0, -5e200, 5e200);
    CHECK(at(0, -2.99, 0));
    dtSelectObject(&a);
    dtLoadIdentity();
    dtScale(-1, 1, 1);
    CHECK(at(-2.99, 0, 0) && !at(2.99, 0, 0));
    dtDeleteObject(&a);
    dtDeleteShape(arrow);
}

static void current(void) {
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    CHECK(test() == 1);
    dtTranslate(5, 0, 0); /* b, the last created. */
    CHECK(test() == 0);
    dtSelectObject(&a);
    dtTranslate(5, 0, 0);
    CHECK(test() == 1);
    REFUSED(dtSelectObject(&ball), DT_ERROR_OBJECT); /* a stays the current one. */
    dtTranslate(5, 0, 0);
    CHECK(test() == 0);
    dtDeleteObject(&a);
    REFUSED(dtTranslate(1, 0, 0), DT_ERROR_ORDER);
    REFUSED(dtLoadIdentity(), DT_ERROR_ORDER);
    dtCreateObject(&a, ball);
    dtTranslate(5, 0, 0);
    CHECK(test() == 1);
    /* Deleting another object leaves the current one. */
    dtDeleteObject(&b);
    dtTranslate(1, 0, 0);
    dtDeleteObject(&a);
}

static void references(void) {
    dtCreateObject(NULL, ball);
    dtCreateObject((void *)-1, brick);
    CHECK(test() == 1 && records[0].object1 == NULL && records[0].object2 == (void *)-1);
    /* A second object of the same reference is refused, and leaves the first as it is. */
    dtTranslate(0.5, 0, 0);
    REFUSED(dtCreateObject(NULL, brick), DT_ERROR_OBJECT);
    CHECK(test() == 1);
    dtDeleteObject(NULL);
    CHECK(test() == 0);
    REFUSED(dtDeleteObject(NULL), DT_ERROR_OBJECT);
    dtDeleteObject((void *)-1);
}

/* Answers do not depend on the unit of length. */
static void units(void) {
    int exponent;
    for (exponent = -90; exponent <= 90; exponent += 6) {
        double unit = pow(10, exponent);
        DtShapeRef shape = dtBox(unit, unit, unit);
        dtCreateObject(&a, shape);
        dtCreateObject(&b, shape);
        dtTranslate(0.999999 * unit, 0, 0);
        CHECK(test() == 1);
        dtTranslate(0.000002 * unit, 0, 0);
        CHECK(test() == 0);
        dtDeleteObject(&a);
        dtDeleteObject(&b);
        dtDeleteShape(shape);
    }
}

/* Touching counts as colliding. */
static void touching(void) {
    dtCreateObject(&a, brick);
    dtCreateObject(&b, brick);
    dtTranslate(1, 0, 0);
    CHECK(test() == 1);
    dtTranslate(1e-9, 0, 0);
    CHECK(test() == 0);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
}

int main(void) {
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    ball = dtSphere(1);
    brick = dtBox(1, 1, 1);
    placements();
    current();
    references();
    units();
    touching();
    dtDeleteShape(ball);
    dtDeleteShape(brick);
    return finish();
}
