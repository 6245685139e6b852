/* The headers, each alone and twice, in every dialect; and the layout that binaries rely on. */
#include <SOLID/types.h>
#include <SOLID/types.h>
#include <SOLID/error.h>
#include <SOLID/solid.h>
#include <SOLID/error.h>
#include <SOLID/solid.h>

#include <stddef.h>

#define HOLDS(name, condition) typedef char name[(condition) ? 1 : -1]

HOLDS(scalar_is_double, sizeof(DtScalar) == sizeof(double));
HOLDS(data_has_no_gaps, sizeof(DtCollData) == 9 * sizeof(double));
HOLDS(point1_is_first, offsetof(DtCollData, point1) == 0);
HOLDS(point2_is_second, offsetof(DtCollData, point2) == 3 * sizeof(double));
HOLDS(normal_is_third, offsetof(DtCollData, normal) == 6 * sizeof(double));
HOLDS(simplex_is_0, DT_SIMPLEX == 0);
HOLDS(polygon_is_1, DT_POLYGON == 1);
HOLDS(polyhedron_is_2, DT_POLYHEDRON == 2);
HOLDS(none_is_0, DT_NO_RESPONSE == 0);
HOLDS(simple_is_1, DT_SIMPLE_RESPONSE == 1);
HOLDS(smart_is_2, DT_SMART_RESPONSE == 2);
HOLDS(witnessed_is_3, DT_WITNESSED_RESPONSE == 3);
HOLDS(enums_are_ints, sizeof(DtPolyType) == sizeof(int) && sizeof(DtResponseType) == sizeof(int));

int main(void) {
    return dtTest() != 0 || dtGetError() != DT_NO_ERROR;
}
