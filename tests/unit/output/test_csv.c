/* The recorder's table as text: every number comes back, in any locale, and a disk that refuses is told of. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drillmbd/ask.h"
#include "drillmbd/scene.h"

enum { ROWS = 6, OUTPUTS = 3, WIDTH = 1 + OUTPUTS };

static const double values[ROWS * WIDTH] = {
    0.0,
    1.0,
    -2.5,
    1e300,
    0.1,
    0.2,
    0.30000000000000004,
    -0.0,
    1e-3,
    DBL_MIN,
    DBL_MAX,
    DBL_EPSILON,
    4.9e-324,
    -1e-310,
    3.141592653589793,
    2.718281828459045,
    1e22,
    123456789.25,
    1.0 / 3.0,
    -7.0 / 11.0,
    1e5,
    1e16,
    1e17,
    9007199254740993.0,
};

static dmb_output outputs[OUTPUTS];
static double table[ROWS * WIDTH];

static dmb_recorder recorder(void)
{
    dmb_recorder r = dmb_recorder_default();
    const dmb_id string = {3u << 24, 1}, drive = {6u << 24 | 2u, 1};
    memcpy(table, values, sizeof table);
    memset(outputs, 0, sizeof outputs);
    outputs[0].place = dmb_station(string, 99, 0.5);
    outputs[0].quantity = DMB_OUTPUT_VELOCITY_Z;
    outputs[1].place = dmb_station(drive, 0, 0.0);
    outputs[1].quantity = DMB_OUTPUT_DRIVE_FORCE;
    outputs[2].quantity = DMB_OUTPUT_ENERGY_ERROR;
    r.output_count = OUTPUTS;
    r.outputs = outputs;
    r.table = table;
    r.capacity = r.row_count = ROWS;
    return r;
}

static char *file_name(void)
{
    static char name[64];
    const char *folder = getenv("TMPDIR");
    snprintf(name, sizeof name, "%.40s/dmb_csv_XXXXXX", folder != NULL ? folder : "/tmp");
    return name;
}

static char *temporary(void)
{
    char *name = file_name();
    FILE *file;
    snprintf(name + strlen(name) - 6, 7, "%06u", (unsigned)(rand() % 1000000));
    file = fopen(name, "wb");
    assert_non_null(file);
    fclose(file);
    return name;
}

static void read_back(const char *name, char *text, size_t size)
{
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    const size_t length = fread(text, 1, size - 1, file);
    text[length] = '\0';
    assert_int_equal(fclose(file), 0);
    assert_int_equal(remove(name), 0);
}

static void numbers_come_back(void **state)
{
    (void)state;
    static char text[1 << 16];
    const dmb_recorder r = recorder();
    char *name = temporary(), *at;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, name), DMB_OK);
    read_back(name, text, sizeof text);
    at = strchr(text, '\n');
    assert_non_null(at);
    at++;
    for (size_t i = 0; i < ROWS * WIDTH; i++) {
        char *end;
        const double back = strtod(at, &end);
        assert_memory_equal(&back, &values[i], sizeof back);
        assert_int_equal(*end, (i + 1) % WIDTH == 0 ? '\n' : ',');
        at = end + 1;
    }
    assert_int_equal(*at, '\0');
}

static void header_names_and_units(void **state)
{
    (void)state;
    static char text[1 << 16];
    dmb_recorder r = recorder();
    char *name = temporary();
    r.row_count = 0;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, name), DMB_OK);
    read_back(name, text, sizeof text);
    assert_string_equal(text, "time [s],velocity_z of string 0 pipe 99 at 0.5 [m/s],drive_force of drive 2 [N or N m],"
                              "energy_error [-]\n");
}

/* Ids of all kinds, and of none, have a word in the header. */
static void header_has_a_word_for_each_kind(void **state)
{
    (void)state;
    static char text[1 << 16];
    const char *const words[32] = {
        [DMB_PART_TIME_FUNCTION] = "time function",
        [DMB_PART_WALL] = "wall",
        [DMB_PART_STRING] = "string",
        [DMB_PART_BODY] = "body",
        [DMB_PART_BIT] = "bit",
        [DMB_PART_DRIVE] = "drive",
        [DMB_PART_LOAD] = "load",
        [DMB_PART_JOINT] = "joint",
        [DMB_PART_COUPLING] = "coupling",
        [DMB_PART_CONSTRAINT] = "constraint",
        [DMB_PART_SPRING] = "spring",
        [DMB_PART_FORCE] = "force",
        [DMB_PART_STABILISER] = "stabiliser",
        [DMB_PART_STUCK] = "stuck",
        [DMB_PART_INPUT] = "input",
        [DMB_PART_EVENT] = "event",
    };
    for (uint32_t kind = 0; kind < 32; kind++) {
        dmb_recorder r = recorder();
        char *name = temporary(), expected[64];
        const dmb_id part = {kind << 24 | 7u, 1};
        r.row_count = 0;
        outputs[1].place.part = part;
        assert_int_equal(dmb_recorder_write_csv(&r, NULL, name), DMB_OK);
        read_back(name, text, sizeof text);
        snprintf(expected, sizeof expected, ",drive_force of %s 7 ", words[kind] != NULL ? words[kind] : "part");
        if (kind != DMB_PART_STRING) assert_non_null(strstr(text, expected));
    }
}

/* With a comma as the host's decimal mark the file keeps its points. */
static void locale_does_not_matter(void **state)
{
    (void)state;
    static char plain[1 << 16], foreign[1 << 16];
    static const char *const names[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "de_DE.utf8"};
    const dmb_recorder r = recorder();
    char *name = temporary();
    int set = 0;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, name), DMB_OK);
    read_back(name, plain, sizeof plain);
    for (size_t i = 0; i < sizeof names / sizeof names[0] && !set; i++) set = setlocale(LC_ALL, names[i]) != NULL;
    name = temporary();
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, name), DMB_OK);
    read_back(name, foreign, sizeof foreign);
    setlocale(LC_ALL, "C");
    assert_string_equal(plain, foreign);
}

static void failures_are_told(void **state)
{
    (void)state;
    const dmb_recorder r = recorder();
    FILE *full = fopen("/dev/full", "wb");
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "/nonexistent/folder/x.csv"), DMB_ERR_IO);
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, ""), DMB_ERR_IO);
    if (full == NULL) return;
    fclose(full);
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "/dev/full"), DMB_ERR_IO);
}

static void bad_recorders_are_refused(void **state)
{
    (void)state;
    dmb_recorder r = recorder();
    assert_int_equal(dmb_recorder_write_csv(NULL, NULL, "x"), DMB_ERR_NULL);
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, NULL), DMB_ERR_NULL);
    r.outputs = NULL;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_NULL);
    r = recorder(), r.table = NULL;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_NULL);
    r = recorder(), r.output_count = 0;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_VALUE);
    r = recorder(), r.output_count = 4097;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_VALUE);
    r = recorder(), r.row_count = ROWS + 1;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_VALUE);
    r = recorder(), r.capacity = UINT64_MAX;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_VALUE);
    r = recorder(), r.interval = -1.0;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_VALUE);
    r = recorder(), r.interval = (double)NAN;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_NOT_FINITE);
    r = recorder(), r.struct_size = 7;
    assert_int_equal(dmb_recorder_write_csv(&r, NULL, "x"), DMB_ERR_STRUCT_SIZE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_come_back),
        cmocka_unit_test(header_names_and_units),
        cmocka_unit_test(header_has_a_word_for_each_kind),
        cmocka_unit_test(locale_does_not_matter),
        cmocka_unit_test(failures_are_told),
        cmocka_unit_test(bad_recorders_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
