/* Responses: precedence, order, what they are told. */
#include "check.h"

static int a, b, c;
static char of_default, of_a, of_b, of_pair;
static DtShapeRef ball;

static void *told(void) {
    return test() == 1 ? records[0].client_data : NULL;
}

static void precedence(void) {
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    CHECK(test() == 0); /* In the beginning there is none. */
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, &of_default);
    CHECK(told() == &of_default);
    dtSetObjectResponse(&b, record, DT_SIMPLE_RESPONSE, &of_b);
    CHECK(told() == &of_b);
    dtSetObjectResponse(&a, record, DT_SIMPLE_RESPONSE, &of_a);
    CHECK(told() == &of_a);
    dtSetPairResponse(&b, &a, record, DT_SIMPLE_RESPONSE, &of_pair); /* In whichever order. */
    CHECK(told() == &of_pair);
    dtClearPairResponse(&a, &b);
    CHECK(test() == 0);
    dtResetPairResponse(&a, &b);
    CHECK(told() == &of_a);
    dtClearObjectResponse(&a); /* Still goes before b's. */
    CHECK(test() == 0);
    dtResetObjectResponse(&a);
    CHECK(told() == &of_b);
    dtSetObjectResponse(&b, NULL, DT_NO_RESPONSE, NULL);
    CHECK(test() == 0);
    dtResetObjectResponse(&b);
    CHECK(told() == &of_default);
    dtClearDefaultResponse();
    CHECK(test() == 0);
    dtSetPairResponse(&a, &b, record, DT_SIMPLE_RESPONSE, &of_pair);
    CHECK(told() == &of_pair);
    dtResetPairResponse(&b, &a);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
}

/* Before the objects are; and gone with them. */
static void before_and_after(void) {
    dtSetObjectResponse(&a, record, DT_SIMPLE_RESPONSE, &of_a);
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    CHECK(told() == &of_a);
    dtSetPairResponse(&a, &c, record, DT_SIMPLE_RESPONSE, &of_pair);
    dtCreateObject(&c, ball);
    CHECK(test() == 2);
    CHECK(records[0].client_data == &of_a && records[1].client_data == &of_pair);
    dtDeleteObject(&a);
    dtCreateObject(&a, ball);
    CHECK(test() == 0);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteObject(&c);

    /* Of a pair, before either is there, in whichever order they come, and with nothing else defined. */
    dtSetPairResponse(&a, &b, record, DT_SIMPLE_RESPONSE, &of_pair);
    dtCreateObject(&b, ball);
    dtCreateObject(&a, ball);
    CHECK(told() == &of_pair);
    /* It is gone with either of them. */
    dtDeleteObject(&a);
    dtCreateObject(&a, ball);
    CHECK(test() == 0);
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, &of_default);
    CHECK(told() == &of_default);
    dtSetPairResponse(&a, &b, record, DT_SIMPLE_RESPONSE, &of_pair);
    dtDeleteObject(&b);
    dtCreateObject(&b, ball);
    CHECK(told() == &of_default);
    dtClearDefaultResponse();
    CHECK(test() == 0);
    /* Of an object that is there, with nothing else defined. */
    dtSetObjectResponse(&b, record, DT_SIMPLE_RESPONSE, &of_b);
    CHECK(told() == &of_b);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
}

/* Complex objects first, in the callback and in the order of the callbacks; otherwise by creation. */
static void order(void) {
    DtShapeRef complex_ball = dtNewComplexShape();
    dtBegin(DT_POLYHEDRON);
    dtVertex(-1, 0, 0);
    dtVertex(1, 0, 0);
    dtVertex(0, 1, 0);
    dtVertex(0, 0, 1);
    dtEnd();
    dtEndComplexShape();
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    dtCreateObject(&c, ball);
    dtCreateObject(&b, complex_ball);
    dtCreateObject(&a, ball);
    CHECK(test() == 3);
    CHECK(records[0].object1 == &b && records[0].object2 == &c);
    CHECK(records[1].object1 == &b && records[1].object2 == &a);
    CHECK(records[2].object1 == &c && records[2].object2 == &a);
    /* And the response of object1 goes before. */
    dtClearObjectResponse(&c);
    dtSetObjectResponse(&b, record, DT_SIMPLE_RESPONSE, &of_b);
    CHECK(test() == 2 && records[0].client_data == &of_b && records[0].object2 == &c);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteObject(&c);
    dtDeleteShape(complex_ball);
}

/* point1 of object1 and point2 of object2 are one point of the world. */
static void witnessed(void) {
    DtShapeRef triangle = dtNewComplexShape();
    const DtCollData *data = &records[0].data;
    dtBegin(DT_SIMPLEX);
    dtVertex(-1, 0, -1);
    dtVertex(1, 0, -1);
    dtVertex(0, 0, 2);
    dtEnd();
    dtEndComplexShape();
    dtSetDefaultResponse(record, DT_WITNESSED_RESPONSE, NULL);
    dtCreateObject(&a, ball);
    dtTranslate(0, 10.5, 0);
    dtCreateObject(&b, triangle);
    dtTranslate(0, 10, 0);
    CHECK(test() == 1 && records[0].has_data && records[0].object1 == &b);
    CHECK(NEAR(data->point1[0], data->point2[0]) && NEAR(data->point1[2], data->point2[2]));
    CHECK(NEAR(data->point1[1], 0) && NEAR(data->point2[1], -0.5));
    CHECK(data->normal[0] == 0 && data->normal[1] == 0 && data->normal[2] == 0);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(triangle);
}

/* Closest points of the previous frame, and the way from point2 to point1. */
static void smart(void) {
    const DtCollData *data = &records[0].data;
    dtSetDefaultResponse(record, DT_SMART_RESPONSE, NULL);
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    dtTranslate(0, 3, 0);
    CHECK(test() == 0);
    dtProceed();
    place(&b, 0, 1.5, 0);
    CHECK(test() == 1 && test() == 1); /* The same frame, as often as one likes. */
    CHECK(records[0].object1 == &a && records[0].object2 == &b);
    CHECK(NEAR(data->point1[1], 1) && NEAR(data->point2[1], -1));
    CHECK(NEAR(data->normal[1], -1) && NEAR(data->normal[0], 0) && NEAR(data->normal[2], 0));
    /* The points are local to the placements of the previous frame. */
    place(&b, 0, 3, 0);
    dtRotate(1, 0, 0, 0);
    CHECK(test() == 0);
    dtProceed();
    place(&b, 0, 1.5, 0);
    CHECK(test() == 1 && NEAR(data->point2[1], 1) && NEAR(data->normal[1], -1));
    /* When they collided in the previous frame already, the normal is the way out, and the points are the deepest. */
    dtProceed();
    CHECK(test() == 1 && NEAR(data->normal[1], -1) && NEAR(data->normal[0], 0) && NEAR(data->normal[2], 0));
    CHECK(NEAR(data->point1[1], 1) && NEAR(data->point2[1], -1));
    dtDeleteObject(&a);
    dtDeleteObject(&b);

    /* Equal shapes in one place: a way out, and the points at both of its ends. */
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    CHECK(test() == 1);
    CHECK(NEAR(data->normal[0] * data->normal[0] + data->normal[1] * data->normal[1] + data->normal[2] * data->normal[2], 1));
    CHECK(NEAR(data->point1[0], -data->normal[0]) && NEAR(data->point2[0], data->normal[0]));
    CHECK(NEAR(data->point1[1], -data->normal[1]) && NEAR(data->point2[1], data->normal[1]));
    dtDeleteObject(&a);
    dtDeleteObject(&b);

    /* Placing a new object before the first dtProceed is no motion; placing it after that is. */
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    place(&b, 0, 0, 4);
    dtProceed();
    place(&b, 0, 0, 1);
    CHECK(test() == 1 && NEAR(data->normal[2], -2) && NEAR(data->point1[2], 1));
    dtDeleteObject(&a);
    dtDeleteObject(&b);

    /* Without dtProceed the first dtTest after the creation is the previous frame: placing before it is no motion. */
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    place(&b, 0, 0, 4);
    CHECK(test() == 0);
    place(&b, 0, 0, 1);
    CHECK(test() == 1 && NEAR(data->normal[2], -2) && NEAR(data->point1[2], 1));
    dtDeleteObject(&a);
    dtDeleteObject(&b);

    /* And so is the first dtTestObjects of any two, if it is valid. */
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    dtCreateObject(&c, ball);
    place(&c, 0, 9, 0);
    place(&b, 0, 0, 8);
    REFUSED(dtTestObjects(&a, &a), DT_ERROR_OBJECT);
    place(&b, 0, 0, 4);
    record_count = 0;
    dtTestObjects(&a, &c);
    CHECK(record_count == 0);
    place(&b, 0, 0, 1);
    CHECK(test() == 1 && NEAR(data->normal[2], -2) && NEAR(data->point1[2], 1));
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteObject(&c);
}

/* All intersecting primitives count, not the first found: the nearest of the previous frame is the second triangle. */
static void smart_complex(void) {
    static const double v[6 * 3] = {-9, 0, -9, 9, 0, -9, 0, 0, 9, -9, 1, -9, 9, 1, -9, 0, 1, 9};
    const DtCollData *data = &records[0].data;
    DtShapeRef sheets = dtNewComplexShape();
    dtVertexBase(v);
    dtVertexRange(DT_SIMPLEX, 0, 3);
    dtVertexRange(DT_SIMPLEX, 3, 3);
    dtEndComplexShape();
    dtSetDefaultResponse(record, DT_SMART_RESPONSE, NULL);
    dtCreateObject(&a, ball);
    dtTranslate(0, 3, 0);
    dtCreateObject(&b, sheets);
    CHECK(test() == 0);
    dtProceed();
    place(&a, 0, 0.5, 0);
    CHECK(test() == 1 && records[0].object1 == &b);
    CHECK(NEAR(data->point1[1], 1) && NEAR(data->point2[1], -1) && NEAR(data->normal[1], -1));
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteShape(sheets);
}

/* One pair alone. */
static void test_objects(void) {
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    dtCreateObject(&a, ball);
    dtCreateObject(&b, ball);
    dtCreateObject(&c, ball);
    record_count = 0;
    dtTestObjects(&c, &a);
    CHECK(record_count == 1 && records[0].object1 == &a && records[0].object2 == &c);
    dtTranslate(5, 0, 0);
    dtTestObjects(&c, &a);
    CHECK(record_count == 1);
    dtClearPairResponse(&a, &b);
    dtTestObjects(&a, &b);
    CHECK(record_count == 1);
    REFUSED(dtTestObjects(&a, &a), DT_ERROR_OBJECT);
    dtTestObjects(&a, &a);
    CHECK(strstr(dtGetErrorMessage(), "object1 and object2 are both 0x") != NULL);
    REFUSED(dtTestObjects(&a, NULL), DT_ERROR_OBJECT);
    dtDeleteObject(&a);
    dtDeleteObject(&b);
    dtDeleteObject(&c);
}

int main(void) {
    ball = dtSphere(1);
    precedence();
    before_and_after();
    order();
    witnessed();
    smart();
    smart_complex();
    test_objects();
    dtClearDefaultResponse();
    dtDeleteShape(ball);
    return finish();
}
