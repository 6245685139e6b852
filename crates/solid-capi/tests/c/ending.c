/* Shapes are deleted at the end of the program, too, when what the library keeps for the thread is gone. */
#include "check.h"

static int body, probe;
static DtShapeRef mesh, ball;

/* A triangle in the plane z = 0, around the origin. */
static DtShapeRef triangle(void) {
    DtShapeRef shape = dtNewComplexShape();
    if (!shape) return shape;
    dtBegin(DT_SIMPLEX);
    dtVertex(-1, -1, 0);
    dtVertex(1, -1, 0);
    dtVertex(0, 1, 0);
    dtEnd();
    dtEndComplexShape();
    return shape;
}

/* Whether an object of the shape is there: none can be made of a shape that is deleted. */
static int is_there(DtShapeRef shape) {
    DtCount collisions;
    dtCreateObject(&body, shape);
    collisions = test();
    dtDeleteObject(&body);
    return collisions == 1;
}

static void at_exit(void) {
    DtShapeRef box = dtBox(1, 1, 1);
    CHECK(is_there(mesh) && is_there(box));
    dtDeleteShape(mesh);
    dtDeleteShape(box);
    CHECK(!is_there(mesh) && !is_there(box));
    dtDeleteShape(triangle()); /* NULL, where nothing is built any more. */
    dtDeleteObject(&probe);
    dtDeleteShape(ball);
    if (failures) abort();
}

int main(void) {
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    mesh = triangle();
    ball = dtSphere(0.1);
    dtCreateObject(&probe, ball);
    CHECK(is_there(mesh));
    if (atexit(at_exit) != 0) abort();
    return finish();
}
