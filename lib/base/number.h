/* Numbers as text, independent of the locale of the host: the decimal mark is '.'. */
#ifndef DMB_BASE_NUMBER_H
#define DMB_BASE_NUMBER_H

#include <stddef.h>
#include <stdint.h>

enum {
    DMB_NUMBER_EXACT = 17, /* significant digits that reproduce every double exactly */
    DMB_NUMBER_SIZE = 32   /* [byte] sufficient for any number written here, end mark included */
};

/* Each function writes into text, an array of DMB_NUMBER_SIZE bytes, and returns the length. */

/* Writes as printf's "%.<digits>g" in the C locale, correctly rounded (ties to even), with 1 .. 17 digits; "nan", "inf"
 * and "-inf" for values that are not finite. Exact arithmetic, about a microsecond. */
size_t dmb_number_from_double(char *text, double value, int digits);

/* Decimal digits. */
size_t dmb_number_from_u64(char *text, uint64_t value);
size_t dmb_number_from_i64(char *text, int64_t value);

#endif
