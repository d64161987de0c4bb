/* Numbers as text, the same whatever the locale of the host: '.' is the decimal mark. */
#ifndef DMB_BASE_NUMBER_H
#define DMB_BASE_NUMBER_H

#include <stddef.h>
#include <stdint.h>

enum {
    DMB_NUMBER_EXACT = 17, /* significant digits that give every double back when read */
    DMB_NUMBER_SIZE = 32   /* [byte] holds any number written here, end mark included */
};

/* Each writes into text, which has room for DMB_NUMBER_SIZE bytes, and returns the length. */

/* As printf's "%.<digits>g" in the C locale, correctly rounded (ties to even), with 1 .. 17 digits; "nan", "inf" and
 * "-inf" for what is not finite. Exact arithmetic, about a microsecond. */
size_t dmb_number_from_double(char *text, double value, int digits);

/* Decimal digits. */
size_t dmb_number_from_u64(char *text, uint64_t value);
size_t dmb_number_from_i64(char *text, int64_t value);

#endif
