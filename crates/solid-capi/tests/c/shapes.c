/* Shapes: what each function makes, asked with a small probe. */
#include "check.h"

static int probe, body;

/* Whether the shape covers the point (x, y, z). */
static int covers(DtShapeRef shape, double x, double y, double z) {
    DtShapeRef point = dtSphere(1e-6);
    int hit;
    dtCreateObject(&body, shape);
    dtCreateObject(&probe, point);
    dtTranslate(x, y, z);
    hit = test() == 1;
    dtDeleteObject(&probe);
    dtDeleteObject(&body);
    dtDeleteShape(point);
    return hit;
}

static void primitives(void) {
    DtShapeRef box = dtBox(2, 4, 6), cone = dtCone(1, 2), cylinder = dtCylinder(1, 2), sphere = dtSphere(1);
    CHECK(box && cone && cylinder && sphere);
    CHECK(box != cone && cone != cylinder && cylinder != sphere);
    /* Full extents. */
    CHECK(covers(box, 0.999, 1.999, 2.999) && !covers(box, 1.001, 0, 0));
    CHECK(!covers(box, 0, 2.001, 0) && !covers(box, 0, 0, 3.001));
    /* The apex above, the base below. */
    CHECK(covers(cone, 0, 0.999, 0) && covers(cone, 0.99, -0.999, 0));
    CHECK(!covers(cone, 0.1, 0.999, 0) && !covers(cone, 0, -1.001, 0) && !covers(cone, 0, 1.001, 0));
    CHECK(covers(cylinder, 0.999, 0.999, 0) && covers(cylinder, 0, -0.999, 0.999));
    CHECK(!covers(cylinder, 0.8, 0, 0.8) && !covers(cylinder, 0, 1.001, 0));
    CHECK(covers(sphere, 0.57, 0.57, 0.57) && !covers(sphere, 0.58, 0.58, 0.58));
    dtDeleteShape(box);
    dtDeleteShape(cone);
    dtDeleteShape(cylinder);
    dtDeleteShape(sphere);
}

/* SOLID 2.0 takes sizes of 0. */
static void flat(void) {
    DtShapeRef point = dtSphere(0), floor = dtBox(20, 0, 20), disc = dtCylinder(1, 0), segment = dtCone(0, 2);
    CHECK(point && floor && disc && segment);
    CHECK(covers(point, 0, 0, 0) && !covers(point, 1e-5, 0, 0));
    CHECK(covers(floor, 9.99, 0, -9.99) && covers(floor, 3, 0, 1) && !covers(floor, 3, 1e-5, 1));
    CHECK(covers(disc, 0.7, 0, 0.7) && !covers(disc, 0, 1e-5, 0) && !covers(disc, 1.001, 0, 0));
    CHECK(covers(segment, 0, 0.99, 0) && covers(segment, 0, -0.99, 0) && !covers(segment, 1e-5, 0, 0));
    dtDeleteShape(point);
    dtDeleteShape(floor);
    dtDeleteShape(disc);
    dtDeleteShape(segment);
}

static const double corners[6 * 3] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 1, 0.5, 0.5, 0.2};

static void solid_pyramid(DtShapeRef shape) {
    CHECK(dtGetError() == DT_NO_ERROR);
    CHECK(covers(shape, 0.5, 0.5, 0.5) && covers(shape, 0.5, 0.5, 0.999) && covers(shape, 0.01, 0.01, 0));
    CHECK(!covers(shape, 0.1, 0.1, 0.9) && !covers(shape, 0.5, 0.5, -0.001));
    dtDeleteShape(shape);
}

/* The same solid, by each of the ways to give vertices. Its interior vertex is welcome. */
static void ways(void) {
    static const DtIndex indices[6] = {5, 4, 3, 2, 1, 0};
    DtShapeRef shape;
    int i;
    shape = dtNewComplexShape();
    dtBegin(DT_POLYHEDRON);
    for (i = 0; i < 6; i++) dtVertex(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]);
    dtEnd();
    dtEndComplexShape();
    solid_pyramid(shape);

    shape = dtNewComplexShape();
    dtVertexBase(corners);
    dtBegin(DT_POLYHEDRON);
    for (i = 0; i < 6; i++) dtVertexIndex((DtIndex)i);
    dtEnd();
    dtEndComplexShape();
    solid_pyramid(shape);

    shape = dtNewComplexShape();
    dtVertexBase(corners);
    dtVertexIndices(DT_POLYHEDRON, 6, indices);
    dtEndComplexShape();
    solid_pyramid(shape);

    /* The array may come after the polytopes; of two the last holds; and vertices of both kinds may meet. */
    shape = dtNewComplexShape();
    dtVertexRange(DT_SIMPLEX, 0, 5);
    dtVertexBase(corners + 3);
    dtVertexBase(corners);
    dtBegin(DT_SIMPLEX);
    dtVertexIndex(2);
    dtVertex(0.5, 0.5, 0.5);
    dtEnd();
    dtEndComplexShape();
    solid_pyramid(shape);
}

/* Points, segments, triangles and polygons, some of them degenerate. */
static void polytopes(void) {
    static const double v[7 * 3] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 5, 5, 5, 7, 7, 7};
    DtShapeRef shape = dtNewComplexShape();
    dtVertexBase(v);
    dtVertexRange(DT_POLYGON, 0, 5); /* Three of them are collinear. */
    dtVertexRange(DT_SIMPLEX, 5, 2);
    dtBegin(DT_SIMPLEX);
    dtVertex(-3, 0, 0);
    dtEnd();
    dtEndComplexShape();
    CHECK(covers(shape, 1, 1e-7, 0) && covers(shape, 1.99, 1.99, 0) && covers(shape, 0.01, 1.5, 0));
    CHECK(!covers(shape, 1, 1, 0.01) && !covers(shape, 2.01, 1, 0));
    CHECK(covers(shape, 6, 6, 6) && !covers(shape, 6, 6, 6.01) && !covers(shape, 8, 8, 8));
    CHECK(covers(shape, -3, 0, 0) && !covers(shape, -3, 0.01, 0));
    dtDeleteShape(shape);
}

/* Only the vertices that are named are read, and the array may lie at any address. */
static void reading(void) {
    static const DtIndex far_out[3] = {1000000, 1000001, 1000002};
    unsigned char bytes[9 * sizeof(double) + 1];
    double triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    DtShapeRef shape;
    memcpy(bytes + 1, triangle, sizeof triangle);
    shape = dtNewComplexShape();
    dtVertexBase(bytes + 1);
    dtVertexRange(DT_SIMPLEX, 0, 3);
    dtEndComplexShape();
    memset(bytes, 0, sizeof bytes); /* It was read. */
    CHECK(covers(shape, 0.25, 0.25, 0));
    dtDeleteShape(shape);

    shape = dtNewComplexShape();
    dtVertexBase((const char *)triangle - 1000000UL * 24);
    dtVertexIndices(DT_SIMPLEX, 3, far_out);
    dtEndComplexShape();
    CHECK(covers(shape, 0.25, 0.25, 0) && !covers(shape, 0.75, 0.75, 0));
    dtDeleteShape(shape);
}

/* A deleted shape lives on in its objects, and its reference is not given out again. */
static void deleted(void) {
    DtShapeRef shape = dtSphere(1), other;
    dtCreateObject(&body, shape);
    dtDeleteShape(shape);
    other = dtSphere(1);
    CHECK(other != shape);
    REFUSED(dtCreateObject(&probe, shape), DT_ERROR_SHAPE);
    REFUSED(dtDeleteShape(shape), DT_ERROR_SHAPE);
    dtCreateObject(&probe, other);
    CHECK(test() == 1);
    dtDeleteObject(&probe);
    dtDeleteObject(&body);
    dtDeleteShape(other);
}

int main(void) {
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    primitives();
    flat();
    ways();
    polytopes();
    reading();
    deleted();
    return finish();
}
