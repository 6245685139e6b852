/* Frames: caching may be toggled at any time and changes nothing. */
#include "check.h"

#define COUNT 12
static int objects[COUNT];
static DtShapeRef shapes[4];

/* The number of collisions of all frames. */
static unsigned long run(int caching) {
    unsigned long sum = 0;
    int frame, i;
    for (i = 0; i < COUNT; i++) dtCreateObject(&objects[i], shapes[i % 4]);
    for (frame = 0; frame < 500; frame++) {
        for (i = 0; i < COUNT; i++) {
            double t = 0.02 * frame * (1 + 0.1 * i) + i;
            place(&objects[i], 3 * sin(t), 3 * cos(1.3 * t), 3 * sin(0.7 * t + 1));
            dtRotate(sin(t), 0, cos(t), 1);
        }
        if (caching == 2 && frame % 7 == 0) dtDisableCaching();
        if (caching == 2 && frame % 7 == 3) dtEnableCaching();
        sum = 31 * sum + test();
        dtProceed();
    }
    for (i = 0; i < COUNT; i++) dtDeleteObject(&objects[i]);
    return sum;
}

int main(void) {
    unsigned long cached, uncached, toggled;
    dtSetDefaultResponse(record, DT_SIMPLE_RESPONSE, NULL);
    shapes[0] = dtSphere(1);
    shapes[1] = dtCone(1, 2);
    shapes[2] = dtCylinder(1, 2);
    shapes[3] = dtBox(1, 2, 3);
    cached = run(1); /* The default. */
    dtDisableCaching();
    uncached = run(0);
    dtEnableCaching();
    toggled = run(2);
    CHECK(cached != 0 && cached == uncached && cached == toggled);
    dtDeleteShape(shapes[0]);
    dtDeleteShape(shapes[1]);
    dtDeleteShape(shapes[2]);
    dtDeleteShape(shapes[3]);
    return finish();
}
