/* Libraries that are loaded when a call first needs them, and then stay: a program that only steps never has them in
 * its memory. Nothing is kept here between calls, so nothing is shared between threads: opening what is loaded already
 * takes the loader some microseconds. */
#ifndef DMB_MATH_BRIDGE_LOAD_H
#define DMB_MATH_BRIDGE_LOAD_H

#include <stddef.h>

typedef void (*dmb_foreign)(void);

/* The functions of these names in the library of that SONAME; 0 where it or one of them is not there. */
int dmb_foreign_load(const char *soname, size_t count, const char *const *names, dmb_foreign *functions);

#endif
