/*
 * SOLID/types.h: the types of libsolid.
 *
 * Binary compatible with SOLID 2.0. C89, C99 and later, C++.
 */
#ifndef SOLID_TYPES_H
#define SOLID_TYPES_H

#ifdef __cplusplus
extern "C" {
#endif

/* A number, a point or a vector, a place in a vertex array, a number of things. */
typedef double DtScalar;
typedef DtScalar DtVector[3];
typedef unsigned int DtIndex;
typedef unsigned int DtCount;

/*
 * An object: any pointer of the client's, usually to the structure that stands for the object. It is compared, never
 * followed. NULL is as good as any.
 */
typedef void *DtObjectRef;

/* A shape: made by libsolid, never NULL, never used again for another shape, and nothing to follow. */
typedef void *DtShapeRef;

/* What the vertices of a polytope are. */
typedef enum DtPolyType {
    DT_SIMPLEX,    /* A point, line segment, triangle or tetrahedron. */
    DT_POLYGON,    /* A convex polygon: its vertices as they lie on the boundary. */
    DT_POLYHEDRON  /* A convex polyhedron, solid: the hull of its vertices, in any order. */
} DtPolyType;

/* What a response is told. */
typedef enum DtResponseType {
    DT_NO_RESPONSE,        /* There is no response. */
    DT_SIMPLE_RESPONSE,    /* That the objects collide. */
    DT_SMART_RESPONSE,     /* The closest points of the previous frame. */
    DT_WITNESSED_RESPONSE  /* A common point. */
} DtResponseType;

/* A point of each of two colliding objects. See dtTest. */
typedef struct DtCollData {
    DtVector point1;  /* Of object1, in its local coordinates. */
    DtVector point2;  /* Of object2, in its local coordinates. */
    DtVector normal;  /* Smart response: away from object2, in world coordinates, never zero. Otherwise zero. */
} DtCollData;

/* A response: called by dtTest for a pair of colliding objects. coll_data holds until it returns. */
typedef void (*DtResponse)(void *client_data, DtObjectRef object1, DtObjectRef object2,
                           const DtCollData *coll_data);

#ifdef __cplusplus
}
#endif

#endif
