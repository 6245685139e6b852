/* Wrong calls: refused, reported, and nothing changed. */
#include "check.h"

static int a, b;
static double nan_value, infinite;

static void sizes(void) {
    REFUSED(CHECK(dtBox(-1, 1, 1) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtBox(1, nan_value, 1) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtBox(1, 1, 1e101) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtCone(nan_value, 1) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtCone(1, -1) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtCylinder(1, infinite) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtCylinder(-1, 1) == NULL), DT_ERROR_VALUE);
    REFUSED(CHECK(dtSphere(-1) == NULL), DT_ERROR_VALUE);
    CHECK(dtSphere(-1) == NULL && !strcmp(dtGetErrorMessage(), "dtSphere: radius is -1.0; it must be from 0 to 1e100"));
    dtClearError();
    CHECK(dtGetError() == DT_NO_ERROR && dtGetErrorMessage()[0] == '\0');
    /* Far beyond what the original takes. */
    {
        DtShapeRef huge = dtSphere(1e99);
        CHECK(huge != NULL);
        dtDeleteShape(huge);
    }
}

static void building(void) {
    static const double v[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const DtIndex indices[3] = {0, 1, 2}, beyond[3] = {0, 1, 4294967295U};
    double bad[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    DtShapeRef shape, second;
    /* Nothing was begun. */
    REFUSED(dtEnd(), DT_ERROR_ORDER);
    REFUSED(dtBegin(DT_SIMPLEX), DT_ERROR_ORDER);
    REFUSED(dtVertex(0, 0, 0), DT_ERROR_ORDER);
    REFUSED(dtVertexBase(v), DT_ERROR_ORDER);
    REFUSED(dtVertexIndex(0), DT_ERROR_ORDER);
    REFUSED(dtVertexIndices(DT_SIMPLEX, 3, indices), DT_ERROR_ORDER);
    REFUSED(dtVertexRange(DT_SIMPLEX, 0, 3), DT_ERROR_ORDER);
    REFUSED(dtEndComplexShape(), DT_ERROR_ORDER);

    shape = dtNewComplexShape();
    CHECK(shape != NULL);
    REFUSED(CHECK(dtNewComplexShape() == NULL), DT_ERROR_ORDER);
    REFUSED(dtCreateObject(&a, shape), DT_ERROR_SHAPE); /* Not ended. */
    REFUSED(dtChangeVertexBase(shape, v), DT_ERROR_SHAPE);
    REFUSED(dtEnd(), DT_ERROR_ORDER);
    REFUSED(dtVertex(0, 0, 0), DT_ERROR_ORDER);
    REFUSED(dtVertexIndex(0), DT_ERROR_ORDER);
    REFUSED(dtVertexBase(NULL), DT_ERROR_NULL);
    REFUSED(dtBegin((DtPolyType)3), DT_ERROR_ENUM);
    REFUSED(dtBegin((DtPolyType)-1), DT_ERROR_ENUM);
    REFUSED(dtVertexIndices((DtPolyType)7, 3, indices), DT_ERROR_ENUM);
    REFUSED(dtVertexIndices(DT_SIMPLEX, 0, indices), DT_ERROR_EMPTY);
    REFUSED(dtVertexIndices(DT_SIMPLEX, 3, NULL), DT_ERROR_NULL);
    REFUSED(dtVertexIndices(DT_SIMPLEX, 3, beyond), DT_ERROR_LIMIT);
    REFUSED(dtVertexRange((DtPolyType)7, 0, 3), DT_ERROR_ENUM);
    REFUSED(dtVertexRange(DT_POLYGON, 5, 0), DT_ERROR_EMPTY);
    REFUSED(dtVertexRange(DT_POLYGON, 5, 4294967295U), DT_ERROR_LIMIT);
    REFUSED(dtVertexRange(DT_POLYGON, 0, 4294967295U), DT_ERROR_LIMIT);
    REFUSED(dtVertexRange(DT_POLYGON, 4294967295U, 1), DT_ERROR_LIMIT);
    dtBegin(DT_SIMPLEX);
    REFUSED(dtBegin(DT_SIMPLEX), DT_ERROR_ORDER);
    REFUSED(dtVertexIndices(DT_SIMPLEX, 3, indices), DT_ERROR_ORDER);
    REFUSED(dtVertexRange(DT_SIMPLEX, 0, 3), DT_ERROR_ORDER);
    REFUSED(dtVertex(nan_value, 0, 0), DT_ERROR_VALUE);
    REFUSED(dtVertex(0, 1e101, 0), DT_ERROR_VALUE);
    REFUSED(dtVertex(0, 0, -infinite), DT_ERROR_VALUE);
    REFUSED(dtVertexIndex(134217728U), DT_ERROR_LIMIT);
    REFUSED(dtEnd(), DT_ERROR_EMPTY); /* Ended, and left out. */
    REFUSED(dtEnd(), DT_ERROR_ORDER);
    dtVertexBase(v);
    dtVertexIndices(DT_SIMPLEX, 3, indices);
    dtEndComplexShape(); /* After all that a good shape. */
    dtCreateObject(&a, shape);
    dtDeleteObject(&a);
    dtDeleteShape(shape);

    /* Ending gives up what cannot be made, and the next shape can be begun. */
    shape = dtNewComplexShape();
    REFUSED(dtEndComplexShape(), DT_ERROR_EMPTY);
    REFUSED(dtCreateObject(&a, shape), DT_ERROR_SHAPE);
    second = dtNewComplexShape();
    CHECK(second != NULL && second != shape);
    dtBegin(DT_SIMPLEX);
    dtVertex(0, 0, 0);
    REFUSED(dtEndComplexShape(), DT_ERROR_ORDER);
    shape = dtNewComplexShape();
    dtVertexRange(DT_SIMPLEX, 0, 3);
    REFUSED(dtEndComplexShape(), DT_ERROR_ORDER); /* No array. */
    bad[4] = nan_value;
    shape = dtNewComplexShape();
    dtVertexBase(bad);
    dtVertexRange(DT_SIMPLEX, 0, 3);
    dtEndComplexShape();
    CHECK(dtGetError() == DT_ERROR_VALUE && strstr(dtGetErrorMessage(), "vertex 1 of the array") != NULL);
    dtClearError();
    /* Deleting gives up, too. */
    shape = dtNewComplexShape();
    dtDeleteShape(shape);
    CHECK(dtGetError() == DT_NO_ERROR);
    REFUSED(dtEndComplexShape(), DT_ERROR_ORDER);
    /* A flat polyhedron and one of a single point: the original exits. */
    shape = dtNewComplexShape();
    dtVertexBase(v);
    dtVertexRange(DT_POLYHEDRON, 0, 3);
    dtVertexRange(DT_POLYHEDRON, 0, 1);
    dtEndComplexShape();
    CHECK(dtGetError() == DT_NO_ERROR);
    dtDeleteShape(shape);
}

static void references(void) {
    DtShapeRef ball = dtSphere(1);
    REFUSED(dtDeleteShape(NULL), DT_ERROR_SHAPE);
    REFUSED(dtDeleteShape(&a), DT_ERROR_SHAPE);
    REFUSED(dtCreateObject(&a, NULL), DT_ERROR_NULL);
    REFUSED(dtCreateObject(&a, &a), DT_ERROR_SHAPE);
    REFUSED(dtSelectObject(&a), DT_ERROR_OBJECT);
    REFUSED(dtDeleteObject(&a), DT_ERROR_OBJECT);
    REFUSED(dtTestObjects(&a, &b), DT_ERROR_OBJECT);
    REFUSED(dtSetPairResponse(&a, &a, record, DT_SIMPLE_RESPONSE, NULL), DT_ERROR_OBJECT);
    REFUSED(dtClearPairResponse(&a, &a), DT_ERROR_OBJECT);
    REFUSED(dtResetPairResponse(&a, &a), DT_ERROR_OBJECT);
    dtResetPairResponse(&a, &b); /* Nothing to take back is nothing wrong. */
    dtResetObjectResponse(&a);
    CHECK(dtGetError() == DT_NO_ERROR);
    dtDeleteShape(ball);
}

static void placements(void) {
    double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    float f[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    DtShapeRef ball = dtSphere(1);
    dtCreateObject(&b, ball);
    dtCreateObject(&a, ball);
    dtTranslate(1.5, 0, 0);
    REFUSED(dtTranslate(nan_value, 0, 0), DT_ERROR_VALUE);
    REFUSED(dtTranslate(0, infinite, 0), DT_ERROR_VALUE);
    REFUSED(dtTranslate(0, 0, 1e101), DT_ERROR_VALUE);
    REFUSED(dtRotate(0, 0, 0, 0), DT_ERROR_VALUE);
    REFUSED(dtRotate(0, 0, nan_value, 1), DT_ERROR_VALUE);
    REFUSED(dtRotate(0, infinite, 0, 1), DT_ERROR_VALUE);
    REFUSED(dtScale(0, 1, 1), DT_ERROR_VALUE);
    REFUSED(dtScale(1, nan_value, 1), DT_ERROR_VALUE);
    REFUSED(dtScale(1, 1, 1e101), DT_ERROR_VALUE);
    REFUSED(dtLoadMatrixd(NULL), DT_ERROR_NULL);
    REFUSED(dtLoadMatrixf(NULL), DT_ERROR_NULL);
    REFUSED(dtMultMatrixd(NULL), DT_ERROR_NULL);
    REFUSED(dtMultMatrixf(NULL), DT_ERROR_NULL);
    m[5] = nan_value;
    f[14] = (float)infinite;
    REFUSED(dtLoadMatrixd(m), DT_ERROR_VALUE);
    REFUSED(dtMultMatrixd(m), DT_ERROR_VALUE);
    REFUSED(dtLoadMatrixf(f), DT_ERROR_VALUE);
    REFUSED(dtMultMatrixf(f), DT_ERROR_VALUE);
    m[5] = 1;
    m[15] = nan_value; /* Ignored. */
    dtMultMatrixd(m);
    CHECK(dtGetError() == DT_NO_ERROR);
    /* It is still where it was. */
    dtSetDefaultResponse(record, DT_WITNESSED_RESPONSE, NULL);
    CHECK(test() == 1);
    CHECK(NEAR(records[0].data.point1[0] - records[0].data.point2[0], 1.5));
    dtClearDefaultResponse();
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(ball);
}

static void responses(void) {
    DtShapeRef ball = dtSphere(1);
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, &a);
    REFUSED(dtSetDefaultResponse(NULL, DT_SIMPLE_RESPONSE, NULL), DT_ERROR_NULL);
    REFUSED(dtSetDefaultResponse(record, (DtResponseType)4, NULL), DT_ERROR_ENUM);
    REFUSED(dtSetDefaultResponse(record, (DtResponseType)-1, NULL), DT_ERROR_ENUM);
    REFUSED(dtSetObjectResponse(&a, NULL, DT_SMART_RESPONSE, NULL), DT_ERROR_NULL);
    REFUSED(dtSetObjectResponse(&a, record, (DtResponseType)4, NULL), DT_ERROR_ENUM);
    REFUSED(dtSetPairResponse(&a, &b, NULL, DT_WITNESSED_RESPONSE, NULL), DT_ERROR_NULL);
    REFUSED(dtSetPairResponse(&a, &b, record, (DtResponseType)4, NULL), DT_ERROR_ENUM);
    CHECK(test() == 1 && records[0].client_data == &a);
    REFUSED(dtSetTolerance(nan_value), DT_ERROR_VALUE);
    REFUSED(dtSetTolerance(-1), DT_ERROR_VALUE);
    dtSetTolerance(1e-6);
    dtSetTolerance(0);
    dtClearDefaultResponse();
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(ball);
}

int main(void) {
    infinite = HUGE_VAL;
    nan_value = infinite - infinite;
    sizes();
    building();
    references();
    placements();
    responses();
    return finish();
}
