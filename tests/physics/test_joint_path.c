/* Joints between axial-torsional strings. Nodes that only slide along and turn about a line leave most equations of a
 * joint without a coordinate to act on. Where the line runs along a coordinate axis these rows are 0; elsewhere
 * rounding is left of them, which must not count as an equation. */
#include "rig.h"

enum { STRINGS = 3, STEPS = 2000 };
static const double step = 5e-4; /* [s] */

typedef struct line {
    rig s;
    dmb_id strings[STRINGS], joints[STRINGS];
} line;

static void join(line *l, uint32_t k, int32_t kind)
{
    dmb_joint_def joint = dmb_joint_def_default();
    joint.kind = kind;
    joint.place_a = dmb_station(l->strings[k - 1], 3, 1.0);
    joint.place_b = dmb_station(l->strings[k], 0, 0.0);
    if (kind == DMB_JOINT_CYLINDRICAL || kind == DMB_JOINT_PRISMATIC) joint.stiffness[DMB_X] = 1e6;
    if (kind == DMB_JOINT_CYLINDRICAL || kind == DMB_JOINT_REVOLUTE) joint.stiffness[DMB_RX] = 1e3;
    must_model(&l->s, dmb_model_add_joint(l->s.model, &joint, &l->joints[k]));
}

/* Three strings of 4 pipes of 1.6 m in a line that points along (cos a, sin a sin b, sin a cos b), turning and sliding
 * at the start, pushed and turned at the rig end, weight along the line alone. */
static line open_line(int32_t kind, double a, double b, double g)
{
    line l;
    const double x[3] = {cos(a), sin(a) * sin(b), sin(a) * cos(b)};
    dmb_pipe_def pipe = dmb_pipe_def_default();
    rig_open(&l.s, g * x[0], g * x[1], g * x[2]);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    pipe.length = 1.6;
    for (uint32_t k = 0; k < STRINGS; k++) {
        dmb_string_def string = dmb_string_def_default();
        for (int i = 0; i < 3; i++) string.position[i] = 4 * 1.6 * k * x[i];
        string.rotation[1] = -a * cos(b); /* about the perpendicular of the world's x axis and the line */
        string.rotation[2] = a * sin(b);
        string.velocity[0] = 0.3;
        string.velocity[3] = 12.0;
        if (k > 0) string.start_free = DMB_FREE_ALL;
        pipe.string = l.strings[k] = add_string(&l.s, &string);
        (void)add_pipes(&l.s, &pipe, 4);
        if (k > 0) join(&l, k, kind);
    }
    (void)add_simple_drive(&l.s, DMB_DRIVE_LOAD, l.strings[0], DMB_X, add_constant(&l.s, 2e3));
    (void)add_simple_drive(&l.s, DMB_DRIVE_LOAD, l.strings[0], DMB_RX, add_constant(&l.s, 40.0));
    (void)rig_start(&l.s, NULL);
    return l;
}

/* Ways along and turns about the line of both ends of every string. */
static void read_line(const line *l, double values[4 * STRINGS])
{
    for (uint32_t k = 0; k < STRINGS; k++)
        for (uint32_t end = 0; end < 2; end++) {
            const dmb_place place = dmb_station(l->strings[k], 3 * end, end);
            const dmb_pose pose = pose_at(&l->s, place);
            values[4 * k + 2 * end] =
                sqrt(pose.displacement[0] * pose.displacement[0] + pose.displacement[1] * pose.displacement[1] +
                     pose.displacement[2] * pose.displacement[2]);
            values[4 * k + 2 * end + 1] = rotation_at(&l->s, place);
        }
}

/* Every kind moves as it does on the x axis, whatever the direction of the line; dropped rows are all but those along
 * and about it. */
static void direction_does_not_matter(void **state)
{
    static const int32_t kinds[] = {DMB_JOINT_FIXED,       DMB_JOINT_REVOLUTE,  DMB_JOINT_PRISMATIC,
                                    DMB_JOINT_CYLINDRICAL, DMB_JOINT_UNIVERSAL, DMB_JOINT_SPHERICAL};
    static const uint32_t dependent[] = {4, 2, 2, 0, 4, 2};
    static const double angles[][2] = {{0.0, 0.0}, {0.2307, 0.0}, {-0.2525, 0.0}, {0.45, 0.7}, {1.2, -2.0}};
    (void)state;
    for (int k = 0; k < 6; k++) {
        double want[4 * STRINGS], got[4 * STRINGS], worst = 0.0;
        for (int i = 0; i < 5; i++) {
            line l = open_line(kinds[k], angles[i][0], angles[i][1], 9.81);
            take_steps(&l.s, step, STEPS);
            read_line(&l, i == 0 ? want : got);
            if (i > 0) worst = fmax(worst, largest_difference(4 * STRINGS, got, want));
            assert_int_equal(statistics_of(&l.s).dependent, dependent[k]);
            rig_close(&l.s);
        }
        print_message("joints of kind %d: ways up to %g m\n", kinds[k], want[2]);
        check_below("    from the same on the x axis [m, rad]", worst, 1e-8);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(direction_does_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
