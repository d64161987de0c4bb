/* The files for ParaView: well-formed XML, arrays as long as they say, indices that exist, points where the sim is. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"

enum { TEXT_MAX = 1 << 22, DEPTH_MAX = 16 };

static char text[TEXT_MAX];

static const char *written(int32_t status, const char *name)
{
    FILE *file;
    if (status != DMB_OK) fail_msg("writing: %s", dmb_status_name(status));
    file = fopen(name, "rb");
    assert_non_null(file);
    const size_t length = fread(text, 1, TEXT_MAX - 1, file);
    assert_true(length < TEXT_MAX - 1);
    text[length] = '\0';
    fclose(file);
    remove(name);
    return text;
}

static const char *file_name(void)
{
    static char name[128];
    const char *folder = getenv("TMPDIR");
    snprintf(name, sizeof name, "%.90s/dmb_vtk_%p.vtp", folder != NULL ? folder : "/tmp", (void *)&name);
    return name;
}

/* Tags open and close in order, attributes are quoted, nothing but blanks stands outside the root. */
static void check_well_formed(const char *xml)
{
    char open[DEPTH_MAX][32];
    int depth = 0, roots = 0;
    const char *at = xml;
    assert_int_equal(strncmp(at, "<?xml", 5), 0);
    at = strstr(at, "?>") + 2;
    for (; *at != '\0'; at++) {
        if (depth == 0 && *at != '<') assert_true(*at == '\n');
        assert_true(*at != '&' && *at != '>');
        if (*at != '<') continue;
        const char *end = strchr(at, '>');
        assert_non_null(end);
        size_t length = strcspn(at + 1, " >");
        int quotes = 0;
        for (const char *c = at; c < end; c++) quotes += *c == '"';
        assert_int_equal(quotes % 2, 0);
        assert_true(length < 32);
        if (at[1] == '/') {
            assert_true(depth > 0);
            depth--;
            assert_int_equal(strncmp(at + 2, open[depth], length - 1), 0);
            assert_int_equal(strlen(open[depth]), length - 1);
        } else {
            assert_true(depth < DEPTH_MAX);
            roots += depth == 0;
            memcpy(open[depth], at + 1, length);
            open[depth++][length] = '\0';
        }
        at = end;
    }
    assert_int_equal(depth, 0);
    assert_int_equal(roots, 1);
}

static long attribute(const char *name)
{
    char pattern[64];
    snprintf(pattern, sizeof pattern, "%s=\"", name);
    const char *at = strstr(text, pattern);
    assert_non_null(at);
    return strtol(at + strlen(pattern), NULL, 10);
}

/* Numbers of a named array; how many there are. */
static long numbers_of(const char *name, double *out, long room)
{
    char pattern[64];
    long count = 0;
    snprintf(pattern, sizeof pattern, "Name=\"%s\"", name);
    const char *at = strstr(text, pattern);
    if (at == NULL) fail_msg("no array %s", name);
    at = strchr(at, '>') + 1;
    for (;;) {
        char *end;
        const double value = strtod(at, &end);
        if (end == at) break;
        assert_true(isfinite(value));
        if (count < room) out[count] = value;
        count++;
        at = end;
    }
    assert_int_equal(strncmp(at + strspn(at, "\n "), "</DataArray>", 12), 0);
    return count;
}

static const double survey[9] = {0.0, 0.5 * PI, 0.0, 20.0, 0.5 * PI, 0.6, 30.0, 0.2 * PI, 0.6};

typedef struct scene {
    rig s;
    dmb_id string;
} scene;

/* A flexible string with a rigid end, and a second one on the axis of the bend. */
static scene make(void)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def second = dmb_string_def_default();
    scene m;
    rig_open(&m.s, 0.0, 0.0, -9.81);
    wall.survey_count = 3;
    wall.survey = survey;
    add_wall(&m.s, &wall);
    pipe.elements = 2;
    m.string = add_pipes(&m.s, &pipe, 3);
    pipe.kind = DMB_PIPE_RIGID;
    pipe.elements = 1;
    add_pipes(&m.s, &pipe, 1);
    second.start_depth = 10.0;
    pipe.string = add_string(&m.s, &second);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    add_pipes(&m.s, &pipe, 2);
    rig_start(&m.s, NULL);
    return m;
}

/* Two pipes of 10 m that lie in a level hole, with tool joints of 2 m or a ring at 3 m of the second. */
static rig lying(int ring, dmb_id *string)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def stabiliser = dmb_stabiliser_def_default();
    rig s;
    rig_open(&s, 0.0, 0.0, -9.81);
    add_wall(&s, &wall);
    pipe.length = 10.0;
    pipe.joint_length = ring ? 0.0 : 2.0;
    *string = add_pipes(&s, &pipe, 2);
    stabiliser.pipe = 1;
    stabiliser.fraction = 0.3;
    stabiliser.outer_diameter = 0.075;
    if (ring) must_model(&s, dmb_model_add_stabiliser(s.model, &stabiliser, NULL));
    (void)rig_start(&s, NULL);
    (void)find_equilibrium(&s, NULL);
    return s;
}

static double force_of(const rig *s, uint32_t contact)
{
    dmb_contact found = dmb_contact_default();
    must(s, dmb_query_contact(s->sim, contact, &found));
    return found.normal_force;
}

/* A picture has the force of a node where the node is, half of it in the middle of an element whose other node is free:
 * pipes of 8 m with tool joints of 2 m, ten points a pipe; a pipe that a ring divides at 3 m, a point each 0.5 m. */
static void normal_forces(void **state)
{
    double drawn[64];
    dmb_id string;
    rig s = lying(0, &string);
    (void)state;
    (void)written(dmb_write_vtk_strings(s.sim, 10, file_name()), file_name());
    assert_int_equal(numbers_of("normal_force", drawn, 64), 21);
    const double first = force_of(&s, 0), second = force_of(&s, 1);
    check_relative("middle of the first pipe's tube [N]", drawn[4], 0.5 * first, 1e-6);
    for (int i = 8; i <= 10; i++) check_relative("first tool joint [N]", drawn[i], first, 1e-6);
    check_relative("middle of the second pipe's tube [N]", drawn[14], 0.5 * (first + second), 1e-6);
    for (int i = 18; i <= 20; i++) check_relative("second tool joint [N]", drawn[i], second, 1e-6);
    rig_close(&s);
    s = lying(1, &string);
    (void)written(dmb_write_vtk_strings(s.sim, 10, file_name()), file_name());
    assert_int_equal(numbers_of("normal_force", drawn, 64), 31);
    check_below("pipe within the ring, off the wall [N]", fabs(drawn[16]), 1e-9);
    check_relative("middle before the ring [N]", drawn[13], 0.5 * force_of(&s, 0), 1e-6);
    check_relative("middle behind the ring [N]", drawn[23], 0.5 * force_of(&s, 3), 1e-6);
    check_relative("end [N]", drawn[30], force_of(&s, 3), 1e-6);
    rig_close(&s);
}

static void strings(void **state)
{
    (void)state;
    static double values[1 << 14];
    const uint32_t per_element[] = {1, 3, 64};
    const char *arrays[] = {"displacement", "velocity",       "diameter",    "axial_force",
                            "torque",       "bending_moment", "normal_force"};
    scene m = make();
    const rig s = m.s;
    for (int i = 0; i < 20; i++) must(&s, dmb_sim_step(s.sim, 1e-3, NULL));
    for (int k = 0; k < 3; k++) {
        const long first = 7 * per_element[k] + 1, second = 2 * per_element[k] + 1, points = first + second;
        check_well_formed(written(dmb_write_vtk_strings(s.sim, per_element[k], file_name()), file_name()));
        assert_int_equal(attribute("NumberOfPoints"), points);
        assert_int_equal(attribute("NumberOfLines"), 2);
        for (int i = 0; i < 7; i++) assert_int_equal(numbers_of(arrays[i], NULL, 0), points * (i < 2 ? 3 : 1));
        assert_int_equal(numbers_of("connectivity", values, points), points);
        for (long i = 0; i < points; i++) assert_true(values[i] == (double)i);
        assert_int_equal(numbers_of("offsets", values, 2), 2);
        assert_true(values[0] == (double)first && values[1] == (double)points);
        assert_int_equal(numbers_of("position", values, 1 << 14), 3 * points);
        const dmb_pose pose = pose_at(&s, dmb_station(m.string, 3, 1.0));
        for (int i = 0; i < 3; i++) assert_true(values[3 * (first - 1) + i] == pose.position[i]);
        assert_int_equal(numbers_of("TimeValue", values, 1), 1);
        assert_true(values[0] == dmb_sim_time(s.sim));
    }
    assert_int_equal(dmb_write_vtk_strings(s.sim, 0, file_name()), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_strings(s.sim, 65, file_name()), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_strings(s.sim, 1, "/nonexistent/x.vtp"), DMB_ERR_IO);
    assert_int_equal(dmb_write_vtk_strings(s.sim, 1, "/dev/full"), DMB_ERR_IO);
    rig_close(&m.s);
}

/* Every point at the hole's radius from its axis, quads that join rings without a twist. */
static void hole(void **state)
{
    (void)state;
    static double points[1 << 14], corners[1 << 14];
    const double depth1 = 30.0, spacing = 0.7;
    const long around = 12, rings = 44, quads = (rings - 1) * around; /* 30/0.7 = 42.9: 43 gaps */
    scene m = make();
    check_well_formed(
        written(dmb_write_vtk_hole(m.s.model, 0.0, depth1, spacing, (uint32_t)around, file_name()), file_name()));
    assert_int_equal(attribute("NumberOfPoints"), rings * around);
    assert_int_equal(attribute("NumberOfPolys"), quads);
    assert_int_equal(numbers_of("position", points, 1 << 14), 3 * rings * around);
    assert_int_equal(numbers_of("connectivity", corners, 1 << 14), 4 * quads);
    for (long q = 0; q < quads; q++) {
        const double *a = points + 3 * (long)corners[4 * q], *b = points + 3 * (long)corners[4 * q + 3];
        const double gap =
            sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
        assert_true(gap < 1.01 * spacing);
    }
    for (long i = 0; i < around; i++) { /* the first ring stands across the x axis */
        assert_true(fabs(points[3 * i]) < 1e-15);
        assert_true(fabs(hypot(points[3 * i + 1], points[3 * i + 2]) - 0.047) < 1e-15);
    }
    assert_int_equal(numbers_of("depth", points, 1 << 14), rings * around);
    assert_true(points[0] == 0.0 && points[rings * around - 1] == depth1);
    assert_int_equal(numbers_of("offsets", points, 1 << 14), quads);
    rig_close(&m.s);
}

static void bad_holes(void **state)
{
    (void)state;
    const double nan = (double)NAN;
    scene m = make();
    const dmb_model *model = m.s.model;
    rig without;
    const dmb_pipe_def pipe = s1_pipe();
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 0.0, 0.1, 8, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(model, 1.0, 0.0, 0.1, 8, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, 0.0, 8, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, 0.1, 2, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, 0.1, 361, "x"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(model, nan, 1.0, 0.1, 8, "x"), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, (double)INFINITY, 0.1, 8, "x"), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, nan, 8, "x"), DMB_ERR_NOT_FINITE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, 1e-12, 8, "x"), DMB_ERR_TOO_LARGE);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, 0.1, 8, NULL), DMB_ERR_NULL);
    assert_int_equal(dmb_write_vtk_hole(model, 0.0, 1.0, 0.1, 8, "/nonexistent/x.vtp"), DMB_ERR_IO);
    rig_close(&m.s);
    rig_open(&without, 0.0, 0.0, 0.0);
    add_pipes(&without, &pipe, 1);
    assert_int_equal(dmb_write_vtk_hole(without.model, 0.0, 1.0, 0.1, 8, "x"), DMB_ERR_ORDER);
    rig_start(&without, NULL);
    assert_int_equal(dmb_write_vtk_hole(without.model, 0.0, 1.0, 0.1, 8, "x"), DMB_ERR_UNSUPPORTED);
    rig_close(&without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_forces),
        cmocka_unit_test(strings),
        cmocka_unit_test(hole),
        cmocka_unit_test(bad_holes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
