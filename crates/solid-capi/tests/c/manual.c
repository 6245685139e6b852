/* The programs of appendix B, with what the manual says of them. */
#include "check.h"

static DtScalar vertices[5 * 3] = {1.0, 0.0, 1.0, 1.0, 0.0, -1.0, -1.0, 0.0, -1.0, -1.0, 0.0, 1.0, 0.0, 1.27, 0.0};
static int object1, object2;

/* B.2: the facets of a pyramid by value. */
static DtShapeRef by_value(void) {
    DtShapeRef pyramid = dtNewComplexShape();
    int i;
    dtBegin(DT_SIMPLEX);
    dtVertex(1.0, 0.0, 1.0);
    dtVertex(1.0, 0.0, -1.0);
    dtVertex(-1.0, 0.0, -1.0);
    dtVertex(-1.0, 0.0, 1.0);
    dtEnd();
    for (i = 0; i < 4; i++) {
        const DtScalar *p = vertices + 3 * i, *q = vertices + 3 * ((i + 1) % 4);
        dtBegin(DT_SIMPLEX);
        dtVertex(p[0], p[1], p[2]);
        dtVertex(q[0], q[1], q[2]);
        dtVertex(0.0, 1.27, 0.0);
        dtEnd();
    }
    dtEndComplexShape();
    return pyramid;
}

static DtShapeRef by_index(void) {
    DtShapeRef pyramid = dtNewComplexShape();
    DtIndex i;
    dtVertexBase(vertices);
    dtBegin(DT_SIMPLEX);
    dtVertexIndex(0);
    dtVertexIndex(1);
    dtVertexIndex(2);
    dtVertexIndex(3);
    dtEnd();
    for (i = 0; i < 4; i++) {
        dtBegin(DT_SIMPLEX);
        dtVertexIndex(i);
        dtVertexIndex((i + 1) % 4);
        dtVertexIndex(4);
        dtEnd();
    }
    dtEndComplexShape();
    return pyramid;
}

static DtShapeRef by_indices(void) {
    DtIndex facet0[4] = {0, 1, 2, 3};
    DtIndex sides[4][3] = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    DtShapeRef pyramid = dtNewComplexShape();
    int i;
    dtVertexBase(vertices);
    dtVertexIndices(DT_SIMPLEX, 4, facet0);
    for (i = 0; i < 4; i++) dtVertexIndices(DT_SIMPLEX, 3, sides[i]);
    dtEndComplexShape();
    return pyramid;
}

static DtShapeRef by_range(void) {
    DtShapeRef pyramid = dtNewComplexShape();
    dtVertexBase(vertices);
    dtVertexRange(DT_POLYHEDRON, 0, 5);
    dtEndComplexShape();
    return pyramid;
}

static int hits(double x, double y, double z) {
    place(&object2, x, y, z);
    return test() == 1;
}

/* On its surface all four are the same; only the polyhedron is solid. */
static void pyramid(DtShapeRef shape, int solid) {
    DtShapeRef point = dtSphere(0.001);
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    dtCreateObject(&object1, shape);
    dtCreateObject(&object2, point);
    CHECK(hits(0, 1.27, 0) && hits(0.9, 0, 0.9) && hits(0, 0, 0) && hits(0.5, 0.635, 0) && hits(0, 0.635, -0.5));
    CHECK(!hits(0, 1.28, 0) && !hits(0.5, 0.7, 0) && !hits(0, -0.01, 0));
    CHECK(hits(0, 0.5, 0) == solid);
    dtDeleteObject(&object1);
    dtDeleteObject(&object2);
    dtDeleteShape(shape);
    dtDeleteShape(point);
}

/* B.3: a hammer and a nail. dtRotate(0, 0, 1, 0) turns by 180 degrees about z. */
static void hammer_and_nail(void) {
    DtShapeRef hammer = dtBox(1, 2, 1), nail = dtCylinder(0.1, 1);
    dtSetDefaultResponse(record, DT_WITNESSED_RESPONSE, NULL);
    dtCreateObject(&object1, hammer);
    dtCreateObject(&object2, nail);

    dtSelectObject(&object1);
    dtLoadIdentity();
    dtTranslate(0, 1, 1);
    dtRotate(0, 0, 1, 0);

    dtSelectObject(&object2);
    dtLoadIdentity();
    dtTranslate(0, 1, 0);
    dtRotate(0, 0, 0, 1);

    CHECK(test() == 0);
    dtTranslate(0, 0, 0.5);
    CHECK(test() == 1);
    {
        /* global(point1) == global(point2). */
        const DtScalar *p = records[0].data.point1, *q = records[0].data.point2;
        CHECK(NEAR(-p[0], q[0]) && NEAR(1 - p[1], 1 + q[1]) && NEAR(1 + p[2], 0.5 + q[2]));
    }
    dtDeleteObject(&object1);
    dtDeleteObject(&object2);
    dtDeleteShape(hammer);
    dtDeleteShape(nail);
}

/* B.4.1: placements are changed until the objects are disjoint; then dtProceed, and the normal is never zero. */
static int contacts;
static double height, speed;

static void bounce(void *client_data, DtObjectRef floor, DtObjectRef ball, const DtCollData *coll_data) {
    const DtScalar *n = coll_data->normal;
    (void)client_data, (void)floor, (void)ball;
    CHECK(n[1] != 0 && fabs(n[0]) < 1e-6 * fabs(n[1]) && fabs(n[2]) < 1e-6 * fabs(n[1]));
    CHECK(n[1] < 0); /* Away from object2, the ball, which is above. */
    speed = fabs(speed);
    contacts++;
}

static void simulation(void) {
    DtShapeRef floor = dtBox(10, 1, 10), ball = dtSphere(0.5);
    int frame;
    dtClearDefaultResponse();
    dtCreateObject(&object1, floor);
    dtCreateObject(&object2, ball);
    dtSetPairResponse(&object1, &object2, bounce, DT_SMART_RESPONSE, NULL);
    height = 3;
    speed = 0;
    place(&object2, 0, height, 0);
    CHECK(dtTest() == 0);
    dtProceed();
    for (frame = 0; frame < 500; frame++) {
        double before = height;
        speed -= 0.01;
        height += 0.1 * speed;
        place(&object2, 0, height, 0);
        while (dtTest() > 0) {
            height = before + 0.1 * speed;
            place(&object2, 0, height, 0);
        }
        dtProceed();
    }
    CHECK(contacts > 3);
    dtDeleteObject(&object1);
    dtDeleteObject(&object2);
    dtDeleteShape(floor);
    dtDeleteShape(ball);
}

int main(void) {
    pyramid(by_value(), 0);
    pyramid(by_index(), 0);
    pyramid(by_indices(), 0);
    pyramid(by_range(), 1);
    hammer_and_nail();
    simulation();
    return finish();
}
