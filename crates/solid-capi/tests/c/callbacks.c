/* Responses that change everything while dtTest runs. */
#include "check.h"

static int objects[40];
static DtShapeRef ball, triangle;
static double vertices[9] = {-1, 0, -1, 1, 0, -1, 0, 0, 1};
static unsigned calls, depth, deepest;

static void create(int count, DtShapeRef shape) {
    int i;
    for (i = 0; i < count; i++) dtCreateObject(&objects[i], shape);
}

static void delete_all(void) {
    int i;
    for (i = 0; i < 40; i++) dtDeleteObject(&objects[i]); /* Some are not there. */
    dtClearError();
    dtClearDefaultResponse();
    calls = 0;
}

/* What moved away is not met by later pairs. */
static void throw_away(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)points;
    calls++;
    place(object2, 100.0 * calls, 0, 0);
}

static void delete_both(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)points;
    calls++;
    dtDeleteObject(object1);
    dtDeleteObject(object2);
}

/* Objects created in a test take part in the next one only. */
static void breed(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)object2, (void)points;
    calls++;
    dtCreateObject(&objects[10 + calls], ball);
}

/* The same reference, a new object. */
static void replace(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)points;
    calls++;
    dtDeleteObject(object2);
    dtCreateObject(object2, ball);
}

static void silence(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)object2, (void)points;
    calls++;
    dtClearDefaultResponse();
}

static void nest(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)object2, (void)points;
    calls++;
    if (depth < 1) {
        depth++;
        CHECK(dtTest() == 3);
        depth--;
    }
}

/* Without end, but for the limit. */
static void nest_for_ever(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)object2, (void)points;
    calls++;
    depth++;
    if (depth > deepest) deepest = depth;
    dtTest();
    depth--;
}

static void deform(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    (void)data, (void)object1, (void)object2, (void)points;
    calls++;
    vertices[1] = vertices[4] = vertices[7] = 50.0;
    dtChangeVertexBase(triangle, vertices);
    dtDeleteShape(triangle);
}

/* Building, caching, frames: everything is allowed. */
static void everything(void *data, DtObjectRef object1, DtObjectRef object2, const DtCollData *points) {
    DtShapeRef shape = dtNewComplexShape();
    (void)data, (void)points;
    calls++;
    dtBegin(DT_SIMPLEX);
    dtVertex(calls, 0, 0);
    dtEnd();
    dtEndComplexShape();
    dtDeleteShape(shape);
    dtDisableCaching();
    dtEnableCaching();
    dtSetTolerance(1e-3);
    dtProceed();
    dtTestObjects(object1, &shape); /* Unknown. */
    dtSetPairResponse(object1, object2, record, DT_SMART_RESPONSE, NULL);
    CHECK(points == NULL);
}

int main(void) {
    ball = dtSphere(1);

    create(5, ball);
    dtSetDefaultResponse(throw_away, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 4 && calls == 4 && dtTest() == 0);
    delete_all();

    create(5, ball);
    dtSetDefaultResponse(delete_both, DT_SMART_RESPONSE, NULL);
    CHECK(dtTest() == 2 && calls == 2 && dtTest() == 0);
    delete_all();

    create(3, ball);
    dtSetDefaultResponse(breed, DT_WITNESSED_RESPONSE, NULL);
    CHECK(dtTest() == 3 && calls == 3);
    dtClearDefaultResponse();
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    CHECK(test() == 15); /* Six in one place. */
    delete_all();

    create(3, ball);
    dtSetDefaultResponse(replace, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 2); /* (0, 1), (0, 2); 1 and 2 are new by then. */
    CHECK(dtGetError() == DT_NO_ERROR);
    delete_all();

    create(3, ball);
    dtSetDefaultResponse(silence, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 1);
    delete_all();

    create(3, ball);
    dtSetDefaultResponse(nest, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 3 && calls == 3 + 3 * 3);
    delete_all();

    create(2, ball);
    dtSetDefaultResponse(nest_for_ever, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 1 && deepest == 64 && dtGetError() == DT_ERROR_LIMIT);
    delete_all();
    create(2, ball);
    dtSetDefaultResponse(nest_for_ever, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 1 && depth == 0); /* It works again. */
    delete_all();
    create(3, ball);
    dtSetDefaultResponse(nest_for_ever, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 3 && calls == 64 * 3); /* Once so deep, no other pair nests again. */
    delete_all();

    triangle = dtNewComplexShape();
    dtVertexBase(vertices);
    dtVertexRange(DT_SIMPLEX, 0, 3);
    dtEndComplexShape();
    create(2, triangle);
    dtCreateObject(&objects[2], ball);
    dtSetDefaultResponse(deform, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 1); /* Both triangles went up, out of the ball: two pairs of three are gone. */
    CHECK(dtGetError() == DT_NO_ERROR);
    delete_all();

    create(3, ball);
    dtSetDefaultResponse(everything, DT_SIMPLE_RESPONSE, NULL);
    CHECK(dtTest() == 3 && calls == 3 && dtGetError() == DT_ERROR_OBJECT);
    dtClearError();
    CHECK(test() == 3 && records[2].has_data);
    delete_all();

    dtDeleteShape(ball);
    return finish();
}
