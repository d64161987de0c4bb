#include "base/number.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

/* Exact conversion. A double is m 2^e with an integer m < 2^53. For e < 0 it is m 5^-e 10^e, so that in both cases its
 * decimal digits are those of an integer, stored in base 10^9, lowest limb first. */
enum {
    LIMB_BASE = 1000000000,
    LIMB_DIGITS = 9,
    MAX_LIMBS = 90 /* m 5^1074 < 10^767 is the longest */
};

typedef struct decimal {
    uint32_t limb[MAX_LIMBS];
    int limbs;
    int exponent; /* the value is the integer times 10^exponent */
} decimal;

static void multiply(decimal *d, uint32_t factor)
{
    uint64_t carry = 0;
    for (int i = 0; i < d->limbs; ++i) {
        carry += (uint64_t)d->limb[i] * factor;
        d->limb[i] = (uint32_t)(carry % LIMB_BASE);
        carry /= LIMB_BASE;
    }
    while (carry > 0) {
        d->limb[d->limbs++] = (uint32_t)(carry % LIMB_BASE);
        carry /= LIMB_BASE;
    }
}

static void multiply_power(decimal *d, uint32_t base, int power, uint32_t base_chunk, int chunk)
{
    for (; power >= chunk; power -= chunk) multiply(d, base_chunk);
    for (; power > 0; --power) multiply(d, base);
}

/* value finite and > 0 */
static void decimal_from_double(decimal *d, double value)
{
    int e = 0;
    uint64_t m = (uint64_t)ldexp(frexp(value, &e), 53);
    e -= 53;
    while (m % 2 == 0) {
        m /= 2;
        ++e;
    }
    d->limbs = 0;
    for (; m > 0; m /= LIMB_BASE) d->limb[d->limbs++] = (uint32_t)(m % LIMB_BASE);
    d->exponent = e < 0 ? e : 0;
    if (e >= 0) {
        multiply_power(d, 2, e, 1u << 29, 29);
    } else {
        multiply_power(d, 5, -e, 244140625u, 12); /* 5^12 */
    }
}

/* Writes all digits, highest first. Returns their number. */
static int decimal_digits(const decimal *d, char out[MAX_LIMBS * LIMB_DIGITS])
{
    int count = 0;
    for (int i = d->limbs - 1; i >= 0; --i) {
        uint32_t rest = d->limb[i];
        for (uint32_t unit = LIMB_BASE / 10; unit > 0; unit /= 10) {
            char digit = (char)('0' + rest / unit);
            rest %= unit;
            if (count > 0 || digit != '0') out[count++] = digit;
        }
    }
    return count;
}

static bool rounds_up(const char *digits, int count, int kept)
{
    if (digits[kept] != '5') return digits[kept] > '5';
    for (int i = kept + 1; i < count; ++i) {
        if (digits[i] != '0') return true;
    }
    return (digits[kept - 1] - '0') % 2 == 1; /* a tie goes to the even digit */
}

/* Rounds to `kept` digits. Returns true if rounding carried into a new leading digit, so that the value is "1000...".
 */
static bool round_digits(char *digits, int count, int kept)
{
    bool up = rounds_up(digits, count, kept);
    for (int i = kept - 1; up && i >= 0; --i) {
        up = digits[i] == '9';
        digits[i] = up ? '0' : (char)(digits[i] + 1);
    }
    if (up) digits[0] = '1';
    return up;
}

static size_t put_text(char *text, const char *word)
{
    size_t length = strlen(word);
    memcpy(text, word, length + 1);
    return length;
}

static size_t put_digits(char *text, const char *digits, int count)
{
    memcpy(text, digits, (size_t)count);
    return (size_t)count;
}

/* 1.2345e-07 */
static size_t put_scientific(char *text, const char *digits, int count, int exponent)
{
    size_t n = 0;
    text[n++] = digits[0];
    if (count > 1) {
        text[n++] = '.';
        n += put_digits(text + n, digits + 1, count - 1);
    }
    text[n++] = 'e';
    text[n++] = exponent < 0 ? '-' : '+';
    exponent = exponent < 0 ? -exponent : exponent;
    if (exponent < 10) text[n++] = '0';
    return n + dmb_number_from_u64(text + n, (uint64_t)exponent);
}

/* 0.0012345, 12.345, 123450 */
static size_t put_plain(char *text, const char *digits, int count, int exponent)
{
    size_t n = 0;
    int whole = exponent + 1; /* digits before the decimal mark */
    if (whole <= 0) {
        n += put_text(text, "0.");
        for (int i = whole; i < 0; ++i) text[n++] = '0';
        n += put_digits(text + n, digits, count);
    } else if (whole >= count) {
        n += put_digits(text, digits, count);
        for (int i = count; i < whole; ++i) text[n++] = '0';
    } else {
        n += put_digits(text, digits, whole);
        text[n++] = '.';
        n += put_digits(text + n, digits + whole, count - whole);
    }
    text[n] = '\0';
    return n;
}

size_t dmb_number_from_double(char *text, double value, int digits)
{
    decimal d;
    char all[MAX_LIMBS * LIMB_DIGITS];
    size_t sign = 0;
    int count, exponent;
    if (isnan(value)) return put_text(text, "nan");
    if (signbit(value)) text[sign++] = '-';
    if (isinf(value)) return sign + put_text(text + sign, "inf");
    if (!(fabs(value) > 0.0)) return sign + put_text(text + sign, "0");
    if (digits < 1) digits = 1;
    if (digits > DMB_NUMBER_EXACT) digits = DMB_NUMBER_EXACT;

    decimal_from_double(&d, fabs(value));
    all[0] = '0';
    count = decimal_digits(&d, all);
    exponent = d.exponent + count - 1; /* of the first digit */
    if (count > digits) {
        exponent += round_digits(all, count, digits) ? 1 : 0;
        count = digits;
    }
    while (count > 1 && all[count - 1] == '0') --count;
    if (exponent < -4 || exponent >= digits) return sign + put_scientific(text + sign, all, count, exponent);
    return sign + put_plain(text + sign, all, count, exponent);
}

size_t dmb_number_from_u64(char *text, uint64_t value)
{
    char reversed[DMB_NUMBER_SIZE];
    size_t count = 0;
    do {
        reversed[count++] = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0);
    for (size_t i = 0; i < count; ++i) text[i] = reversed[count - 1 - i];
    text[count] = '\0';
    return count;
}

size_t dmb_number_from_i64(char *text, int64_t value)
{
    if (value >= 0) return dmb_number_from_u64(text, (uint64_t)value);
    text[0] = '-';
    return 1 + dmb_number_from_u64(text + 1, (uint64_t)0 - (uint64_t)value);
}
