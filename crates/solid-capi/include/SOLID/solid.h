/*
 * SOLID/solid.h: collision detection of three-dimensional objects in motion and under deformation.
 *
 * Source and binary compatible with SOLID 2.0. C89, C99 and later, C++.
 *
 * Wrong calls. A call with a wrong argument, or out of order, changes nothing, never crashes, and returns NULL or 0. What
 * was wrong is told by SOLID/error.h, and printed to stderr when the environment variable SOLID_ERRORS is set (and not
 * empty or 0). The two exceptions: dtEnd and dtEndComplexShape always end what was begun.
 *
 * Numbers. Coordinates and entries of placements are finite and at most 1e100 in magnitude; sizes are at least 0 and at
 * most 1e100. Answers are right beyond 1e-12 of the size of the two objects and their distance, in any unit of length;
 * within it objects touch, and objects that touch collide. Points, segments and triangles are decided against each other
 * exactly, where their rounded coordinates are: what touches on paper may be apart by the rounding of its placement.
 *
 * Threads. Any function may be called from any thread while that runs. Objects, shapes and responses are common to all
 * threads. The current object is the one that the calling thread created or selected last; a thread that never did so
 * has the one that any thread created or selected last. A complex shape is built by one thread. Responses run on the
 * thread that called dtTest, without any lock held. Two threads that call dtTest at the same time both make the callbacks.
 *
 * Callbacks. A response may call every function of this library: see dtTest.
 */
#ifndef SOLID_SOLID_H
#define SOLID_SOLID_H

#include "types.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Shapes ---------------------------------------------------------------------------------------------------- */

/* A box centred at the origin, along the axes, by its full sizes. */
DtShapeRef dtBox(DtScalar x, DtScalar y, DtScalar z);

/* A cone on the axis y, centred at the origin: the apex is at y = height / 2, the base at y = -height / 2. */
DtShapeRef dtCone(DtScalar radius, DtScalar height);

/* A cylinder on the axis y, centred at the origin. */
DtShapeRef dtCylinder(DtScalar radius, DtScalar height);

/* A ball centred at the origin. */
DtShapeRef dtSphere(DtScalar radius);

/*
 * Begins a complex shape: the union of the polytopes that are given from here to dtEndComplexShape. The reference can be
 * used once the shape is ended. Between them, this thread can begin no other complex shape: NULL is returned then. So it may
 * be where the thread is ending: in destructors of C++ globals and of thread-specific data.
 */
DtShapeRef dtNewComplexShape(void);

/*
 * Ends the complex shape. The vertex array is read here, once, and exactly those of its vertices that a polytope names; it
 * is not needed afterwards.
 * When no shape can be made (no polytope, no vertex array for the indices, a vertex that is not finite, a polytope not
 * ended), construction ends all the same, and the reference is unknown from then on.
 */
void dtEndComplexShape(void);

/*
 * Begins and ends a polytope, given by dtVertex and dtVertexIndex between them. A polytope of any type is the convex hull of
 * its vertices, and any number of them above 0 will do. dtEnd without a vertex is an error: no polytope is added.
 */
void dtBegin(DtPolyType type);
void dtEnd(void);

/* A vertex of the polytope by its coordinates. */
void dtVertex(DtScalar x, DtScalar y, DtScalar z);

/*
 * The vertex array of the complex shape: three DtScalar for each vertex, without gaps. There is one for each shape; of two
 * calls the last holds. It must stay readable until dtEndComplexShape.
 */
void dtVertexBase(const void *base);

/* A vertex of the polytope by its place in the vertex array, at most 134217727, as everywhere. */
void dtVertexIndex(DtIndex index);

/* A polytope by count places in the vertex array. They are copied. */
void dtVertexIndices(DtPolyType type, DtCount count, const DtIndex *indices);

/* A polytope of the count vertices from the place first on. */
void dtVertexRange(DtPolyType type, DtIndex first, DtCount count);

/*
 * Deforms a complex shape that has a vertex array, and so every object of it: the array is read again, at once, from base,
 * which may be a new address or the same with new contents. dtTest sees the new vertices, smart response the old ones
 * until dtProceed.
 */
void dtChangeVertexBase(DtShapeRef shape, const void *base);

/*
 * Deletes a shape. Its reference is unknown from then on. Objects of it stay as they are, and keep what they need of it.
 * Deleting a complex shape that is being built, on the thread that builds it, gives it up.
 */
void dtDeleteShape(DtShapeRef shape);

/* ---- Objects --------------------------------------------------------------------------------------------------- */

/*
 * Creates an object, an instance of a shape, at the origin, and makes it the current object. It is an error when there is
 * an object of this reference already: delete that first.
 */
void dtCreateObject(DtObjectRef object, DtShapeRef shape);

/* Deletes an object with its response and the responses of its pairs. If it was current, no object is. */
void dtDeleteObject(DtObjectRef object);

/* Makes an object the current one. An unknown reference is an error, and the current object stays. */
void dtSelectObject(DtObjectRef object);

/*
 * Place the current object: absolutely by dtLoadIdentity and dtLoadMatrix, and relative to its placement so far, in its own
 * coordinates, by the others, as OpenGL does. Matrices are 4x4, by columns; the bottom row is ignored. dtRotate takes a
 * quaternion, w the real part, of any length but 0. Negative scales mirror. A placement that would be flat (a scale of 0)
 * is an error.
 */
void dtLoadIdentity(void);
void dtLoadMatrixf(const float *m);
void dtLoadMatrixd(const double *m);
void dtMultMatrixf(const float *m);
void dtMultMatrixd(const double *m);
void dtTranslate(DtScalar x, DtScalar y, DtScalar z);
void dtRotate(DtScalar x, DtScalar y, DtScalar z, DtScalar w);
void dtScale(DtScalar x, DtScalar y, DtScalar z);

/* ---- Responses ------------------------------------------------------------------------------------------------- */

/*
 * The response for a pair of objects is the one defined for the pair, in whichever order; else the one defined for object1;
 * else the one for object2; else the default. (Which of the two is object1: see dtTest.) Set and Clear define a response;
 * Clear defines it as none, and so does DT_NO_RESPONSE, for which response may be NULL. Reset takes the definition back.
 * Responses may be defined before the objects exist; deleting an object takes them back. In the beginning the default is none.
 */
void dtSetDefaultResponse(DtResponse response, DtResponseType type, void *client_data);
void dtClearDefaultResponse(void);
void dtSetObjectResponse(DtObjectRef object, DtResponse response, DtResponseType type, void *client_data);
void dtClearObjectResponse(DtObjectRef object);
void dtResetObjectResponse(DtObjectRef object);
void dtSetPairResponse(DtObjectRef object1, DtObjectRef object2, DtResponse response, DtResponseType type,
                       void *client_data);
void dtClearPairResponse(DtObjectRef object1, DtObjectRef object2);
void dtResetPairResponse(DtObjectRef object1, DtObjectRef object2);

/* ---- Frames ---------------------------------------------------------------------------------------------------- */

/*
 * Calls the response of every pair of objects that collide, and returns how many it called.
 *
 * Order. Of a pair, an object of a complex shape is object1 and the other object2; otherwise object1 is the one that was
 * created first. Pairs come by object1, then by object2: objects of complex shapes first, then by creation.
 *
 * coll_data. Simple response: NULL.
 * Witnessed: point1 and point2 are a common point, each local to its object; normal is zero.
 * Smart: point1 and point2 are the closest points in the previous frame, local to the placements of that frame; normal is
 * the world position of point1 less that of point2, so it points away from object2. The previous frame is what was at the
 * last dtProceed; for an object created since, what was at the first dtTest or dtTestObjects after its creation. When they
 * collided there already, point1 and point2 are the points of each that were deepest in the other, and normal is a vector of
 * length 1: the way on which object1 would have left object2 soonest. It is never zero. Where many ways are as short, as for
 * equal balls in one place, it is one of them. Of complex shapes, all pairs of primitives that collide now are looked at: the
 * answer is of the pair that was nearest in the previous frame, or deepest.
 *
 * Within a response, every function may be called. Changes hold at once. A pair is examined as things are when its turn
 * comes: what moves, is deformed, deleted or given another response is seen by the pairs that come later, and each pair comes
 * at most once. Objects created during a dtTest take part from the next one on. dtTest in a response is a test of its own, of all
 * objects; more than 64 within one another are an error, and so is then every further one within the first. A response may
 * leave dtTest by a C++ exception; longjmp is not supported.
 */
DtCount dtTest(void);

/* Calls the response of these two objects if they collide, as dtTest would. From SOLID 2.1. */
void dtTestObjects(DtObjectRef object1, DtObjectRef object2);

/* Ends the frame: what is now is the previous frame of smart response. */
void dtProceed(void);

/*
 * Let dtTest use what earlier ones found out, or not, at any time. On in the beginning. It saves time and changes no
 * answer.
 */
void dtEnableCaching(void);
void dtDisableCaching(void);

/*
 * The relative error allowed in the closest points, at least 0: 1e-6 in SOLID 2.0. Every answer here is as good as it gets
 * whatever is set, so this has no effect.
 */
void dtSetTolerance(DtScalar tolerance);

#ifdef __cplusplus
}
#endif

#endif
