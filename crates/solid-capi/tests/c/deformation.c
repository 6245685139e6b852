/* Deformation: section B.5. */
#include "check.h"

static int sheet, ball, other;

static DtShapeRef make_sheet(const double *vertices) {
    DtShapeRef shape = dtNewComplexShape();
    dtVertexBase(vertices);
    dtVertexRange(DT_SIMPLEX, 0, 3);
    dtVertexRange(DT_SIMPLEX, 1, 3);
    dtEndComplexShape();
    return shape;
}

static void set_height(double *vertices, double y) {
    int i;
    for (i = 0; i < 4; i++) {
        vertices[3 * i] = i % 2 ? 5 : -5;
        vertices[3 * i + 1] = y;
        vertices[3 * i + 2] = i / 2 ? 5 : -5;
    }
}

/* The array is read when it is named, not in between; every object of the shape changes. */
static void in_place(void) {
    double vertices[12];
    DtShapeRef shape, small = dtSphere(1);
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    set_height(vertices, 0);
    shape = make_sheet(vertices);
    dtCreateObject(&sheet, shape);
    dtCreateObject(&ball, small);
    CHECK(test() == 1);
    set_height(vertices, 2);
    CHECK(test() == 1);
    dtChangeVertexBase(shape, vertices);
    CHECK(test() == 0);
    dtCreateObject(&other, shape); /* As it is now. */
    dtTranslate(0, -2, 0);
    CHECK(test() == 1 && records[0].object1 == &other && records[0].object2 == &ball);
    set_height(vertices, 0);
    dtChangeVertexBase(shape, vertices);
    CHECK(test() == 1 && records[0].object1 == &sheet);
    /* An object that is no more is not missed. */
    dtDeleteObject(&other);
    dtChangeVertexBase(shape, vertices);
    CHECK(dtGetError() == DT_NO_ERROR && test() == 1);
    dtCreateObject(&other, shape);
    dtTranslate(0, -2, 0);
    CHECK(test() == 1 && records[0].object1 == &sheet);
    /* A bad array changes nothing. */
    vertices[7] = HUGE_VAL;
    REFUSED(dtChangeVertexBase(shape, vertices), DT_ERROR_VALUE);
    CHECK(test() == 1);
    REFUSED(dtChangeVertexBase(shape, NULL), DT_ERROR_NULL);
    REFUSED(dtChangeVertexBase(small, vertices), DT_ERROR_SHAPE);
    REFUSED(dtChangeVertexBase(NULL, vertices), DT_ERROR_SHAPE);
    /* A deleted shape cannot be deformed, and its objects stay as they are. */
    dtDeleteShape(shape);
    set_height(vertices, 2);
    REFUSED(dtChangeVertexBase(shape, vertices), DT_ERROR_SHAPE);
    CHECK(test() == 1);
    dtDeleteObject(&sheet);
    dtDeleteObject(&ball);
    dtDeleteObject(&other);
    dtDeleteShape(small);
}

/* Double buffering: smart response sees the buffer of the previous frame. */
static void double_buffered(void) {
    double buffers[2][12];
    const DtCollData *data = &records[0].data;
    DtShapeRef shape, small = dtSphere(1);
    int frame, current = 0;
    dtSetDefaultResponse(record, DT_SMART_RESPONSE, NULL);
    set_height(buffers[0], -3);
    shape = make_sheet(buffers[0]);
    dtCreateObject(&sheet, shape);
    dtCreateObject(&ball, small);
    CHECK(test() == 0);
    dtProceed();
    for (frame = 0; frame < 6; frame++) {
        double y = frame % 3 == 2 ? -0.5 : -3 + 0.5 * (frame % 3);
        current = 1 - current;
        set_height(buffers[current], y);
        dtChangeVertexBase(shape, buffers[current]);
        if (y == -0.5) {
            /* The previous frame has -2.5: a gap of 1.5 below the ball. */
            CHECK(test() == 1 && test() == 1);
            CHECK(NEAR(data->point1[1], -2.5) && NEAR(data->point2[1], -1) && NEAR(data->normal[1], -1.5));
            set_height(buffers[current], -3);
            dtChangeVertexBase(shape, buffers[current]);
        }
        CHECK(test() == 0);
        dtProceed();
    }
    dtDeleteObject(&sheet);
    dtDeleteObject(&ball);
    dtDeleteShape(shape);
    dtDeleteShape(small);
}

static void set_cube(double *vertices, double x, double y) {
    int i;
    for (i = 0; i < 8; i++) {
        vertices[3 * i] = i & 1 ? x + 1 : x - 1;
        vertices[3 * i + 1] = i & 2 ? y + 1 : y - 1;
        vertices[3 * i + 2] = i & 4 ? 1 : -1;
    }
}

/* Smart response looks at the primitives that collide now, also in the first frame in which a single polyhedron deforms: not at the nearer
   one of the previous frame. */
static void first_deformation(void) {
    double fixed[2 * 8 * 3], moving[8 * 3];
    const DtCollData *data = &records[0].data;
    DtShapeRef two = dtNewComplexShape(), one;
    set_cube(fixed, 0, 0);
    set_cube(fixed + 8 * 3, 10, 0);
    dtVertexBase(fixed);
    dtVertexRange(DT_POLYHEDRON, 0, 8);
    dtVertexRange(DT_POLYHEDRON, 8, 8);
    dtEndComplexShape();
    one = dtNewComplexShape();
    set_cube(moving, 0, 0);
    dtVertexBase(moving);
    dtVertexRange(DT_POLYHEDRON, 0, 8);
    dtEndComplexShape();
    dtSetDefaultResponse(record, DT_SMART_RESPONSE, NULL);
    dtCreateObject(&sheet, two);
    dtCreateObject(&other, one);
    dtTranslate(10, 3, 0);
    CHECK(test() == 0);
    dtProceed();
    set_cube(moving, -10, -3);
    dtChangeVertexBase(one, moving);
    CHECK(test() == 1);
    CHECK(NEAR(data->normal[0], -8) && NEAR(data->normal[1], -1) && NEAR(data->normal[2], 0));
    dtDeleteObject(&sheet);
    dtDeleteObject(&other);
    dtDeleteShape(two);
    dtDeleteShape(one);
}

/* A single polyhedron, and a shape with vertices of both kinds. */
static void polyhedra(void) {
    double vertices[4 * 3] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    DtShapeRef shape = dtNewComplexShape(), point = dtSphere(1e-3), fixed;
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    dtVertexBase(vertices);
    dtVertexRange(DT_POLYHEDRON, 0, 4);
    dtEndComplexShape();
    dtCreateObject(&sheet, shape);
    dtCreateObject(&ball, point);
    dtTranslate(0.1, 0.1, 2);
    CHECK(test() == 0);
    vertices[11] = 4;
    dtChangeVertexBase(shape, vertices);
    CHECK(test() == 1 && records[0].object1 == &sheet);
    vertices[11] = 1;
    dtChangeVertexBase(shape, vertices);
    CHECK(test() == 0);
    dtDeleteObject(&sheet);
    dtDeleteShape(shape);

    shape = dtNewComplexShape();
    dtVertexBase(vertices);
    dtBegin(DT_SIMPLEX);
    dtVertexIndex(0);
    dtVertex(0.1, 0.1, 2);
    dtEnd();
    dtEndComplexShape();
    dtCreateObject(&sheet, shape);
    CHECK(test() == 1);
    vertices[0] = -100;
    dtChangeVertexBase(shape, vertices);
    CHECK(test() == 1); /* The vertex by value stayed. */
    dtDeleteObject(&sheet);
    dtDeleteShape(shape);

    fixed = dtNewComplexShape();
    dtBegin(DT_SIMPLEX);
    dtVertex(0, 0, 0);
    dtEnd();
    dtEndComplexShape();
    REFUSED(dtChangeVertexBase(fixed, vertices), DT_ERROR_SHAPE); /* It has no array. */
    dtDeleteShape(fixed);
    dtDeleteObject(&ball);
    dtDeleteShape(point);
}

int main(void) {
    in_place();
    double_buffered();
    first_deformation();
    polyhedra();
    return finish();
}
