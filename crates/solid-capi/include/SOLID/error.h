/*
 * SOLID/error.h: what was wrong with a call. An extension: SOLID 2.0 had nothing like it.
 *
 * Each thread has its own. An error stays until dtClearError or the next one.
 *
 *     dtClearError();
 *     shape = dtSphere(-1.0);
 *     if (dtGetError() != DT_NO_ERROR) puts(dtGetErrorMessage());
 *     // dtSphere: radius is -1.0; it must be from 0 to 1e100
 */
#ifndef SOLID_ERROR_H
#define SOLID_ERROR_H

#ifdef __cplusplus
extern "C" {
#endif

typedef enum DtError {
    DT_NO_ERROR,
    DT_ERROR_NULL,      /* A pointer is NULL that must not be. */
    DT_ERROR_VALUE,     /* A number is not finite or out of range, or a placement would be flat. */
    DT_ERROR_ENUM,      /* A DtPolyType or DtResponseType that there is not. */
    DT_ERROR_SHAPE,     /* An unknown shape, one that is not finished, or one that does not deform. */
    DT_ERROR_OBJECT,    /* An unknown object, one that there is already, or a pair of one object with itself. */
    DT_ERROR_ORDER,     /* A call out of order: nothing was begun, something was begun already, no current object. */
    DT_ERROR_EMPTY,     /* A shape without a polytope, or a polytope without a vertex. */
    DT_ERROR_LIMIT,     /* Too much: indices, memory, calls of dtTest within one another. */
    DT_ERROR_INTERNAL   /* A mistake of libsolid. Please report it. */
} DtError;

/* The code of this thread's last wrong call since dtClearError; DT_NO_ERROR if there was none. */
DtError dtGetError(void);

/*
 * The same in words, with the function, the argument, its value and its limit; "" if there was none. It holds until this
 * thread's next wrong call or dtClearError.
 */
const char *dtGetErrorMessage(void);

/* Forgets this thread's last wrong call. */
void dtClearError(void);

#ifdef __cplusplus
}
#endif

#endif
