/* What the test programs share. */
#ifndef CHECK_H
#define CHECK_H

#include <SOLID/error.h>
#include <SOLID/solid.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                                  \
    do {                                                                                  \
        if (!(condition)) {                                                               \
            fprintf(stderr, "%s:%d: not so: %s (last error: %s)\n", __FILE__, __LINE__,   \
                    #condition, dtGetErrorMessage());                                     \
            failures++;                                                                   \
        }                                                                                 \
    } while (0)

/* The call is refused with the code. */
#define REFUSED(call, code)                                                               \
    do {                                                                                  \
        dtClearError();                                                                   \
        call;                                                                             \
        CHECK(dtGetError() == (code));                                                    \
        CHECK(dtGetErrorMessage()[0] != '\0');                                            \
        dtClearError();                                                                   \
    } while (0)

#define NEAR(x, y) (fabs((x) - (y)) < 1e-9)

/* The callbacks of a test. */
#define RECORDS_MAX 64
typedef struct Record {
    void *client_data;
    void *object1;
    void *object2;
    int has_data;
    DtCollData data;
} Record;
static Record records[RECORDS_MAX];
static unsigned record_count = 0;

static void record(void *client_data, DtObjectRef object1, DtObjectRef object2, const DtCollData *data) {
    if (record_count < RECORDS_MAX) {
        Record *r = &records[record_count];
        r->client_data = client_data;
        r->object1 = object1;
        r->object2 = object2;
        r->has_data = data != NULL;
        if (data) r->data = *data;
    }
    record_count++;
}

/* Tests, with the callbacks recorded. */
static DtCount test(void) {
    record_count = 0;
    return dtTest();
}

static void place(void *object, double x, double y, double z) {
    dtSelectObject(object);
    dtLoadIdentity();
    dtTranslate(x, y, z);
}

/* What main returns. */
static int finish(void) {
    CHECK(dtGetError() == DT_NO_ERROR);
    dtClearError();
    if (failures) fprintf(stderr, "%d failures\n", failures);
    return failures != 0;
}

#endif
