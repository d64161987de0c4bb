#include "scene_transform.h"

#include <math.h>
#include <string.h>

/* ---- Views ------------------------------------------------------------------------------------------------------ */

scene_view view_identity(void)
{
    const scene_view v = {{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}, 1.0, 1.0, 1.0, 0, 0, 0};
    return v;
}

scene_view view_turned(const double rotation[3])
{
    scene_view v = view_identity();
    rotation_of_vector(rotation, v.matrix);
    return v;
}

void view_back(const scene_view *view, int polar, const double in[3], double out[3])
{
    matrix_apply_transposed(view->matrix, in, out);
    for (int i = 0; i < 3 && !polar; ++i) out[i] *= view->handed;
}

void view_position_back(const scene_view *view, const double in[3], double out[3])
{
    double x[3];
    for (int i = 0; i < 3; ++i) x[i] = in[i] / view->length - view->shift[i];
    matrix_apply_transposed(view->matrix, x, out);
}

void view_rotation_back(const scene_view *view, double roll, const double in[9], double out[9])
{
    const double c = cos(roll), s = sin(roll), h = view->handed;
    const double turn[9] = {1.0, 0.0, 0.0, 0.0, c, -s * h, 0.0, s, c * h}; /* Rx(roll) Q */
    double t[9];
    matrix_transpose(view->matrix, t);
    matrix_times(t, in, out);
    matrix_times(out, turn, out);
}

/* ---- The hole's frame ------------------------------------------------------------------------------------------- */

static void survey_tangent(const double row[3], double t[3])
{
    t[0] = sin(row[1]) * cos(row[2]);
    t[1] = -sin(row[1]) * sin(row[2]); /* azimuth is clockwise seen from above */
    t[2] = -cos(row[1]);
}

/* Minimum curvature: the tangent turns evenly from station to station. */
static void hole_tangent(const scene *s, double depth, double t[3])
{
    double a[3], b[3];
    uint32_t i = 0;
    if (s->survey_count == 0) {
        memcpy(t, s->wall.direction, sizeof a);
        return;
    }
    while (i + 2 < s->survey_count && s->survey[i + 1][0] <= depth) ++i;
    survey_tangent(s->survey[i], a);
    survey_tangent(s->survey[i + 1], b);
    const double part = fmin(1.0, fmax(0.0, (depth - s->survey[i][0]) / (s->survey[i + 1][0] - s->survey[i][0])));
    const double angle = acos(fmin(1.0, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
    const double first = angle > 1e-7 ? sin((1.0 - part) * angle) / sin(angle) : 1.0 - part;
    const double second = angle > 1e-7 ? sin(part * angle) / sin(angle) : part;
    for (int k = 0; k < 3; ++k) t[k] = first * a[k] + second * b[k];
}

/* y axis horizontal in the world, as lib/force/hole.h says. */
static void hole_frame(const scene *s, double depth, double y[3], double z[3])
{
    double t[3];
    hole_tangent(s, depth, t);
    const double size = sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]), across = sqrt(t[0] * t[0] + t[1] * t[1]);
    y[0] = -t[1] / across;
    y[1] = t[0] / across;
    y[2] = 0.0;
    z[0] = (t[1] * y[2] - t[2] * y[1]) / size;
    z[1] = (t[2] * y[0] - t[0] * y[2]) / size;
    z[2] = (t[0] * y[1] - t[1] * y[0]) / size;
}

static int follows_hole(const scene *s, uint32_t k)
{
    return s->has_wall && s->string[k].def.follows_hole;
}

double view_roll(const scene *original, const scene *transformed, const scene_view *view, uint32_t k)
{
    double y[3], z[3], y2[3], z2[3], seen[3];
    if (!follows_hole(original, k)) return 0.0;
    hole_frame(original, original->string[k].def.start_depth, y, z);
    hole_frame(transformed, transformed->string[k].def.start_depth, y2, z2);
    matrix_apply(view->matrix, y, seen);
    return atan2(seen[0] * z2[0] + seen[1] * z2[1] + seen[2] * z2[2],
                 seen[0] * y2[0] + seen[1] * y2[1] + seen[2] * y2[2]);
}

/* ---- Data ------------------------------------------------------------------------------------------------------- */

/* The transformation in the axes of a part: B = Rx(roll) diag(1, 1, handed). */
typedef struct axes {
    double matrix[9], handed;
} axes;

static axes axes_of(const scene_view *v, double roll)
{
    const double c = cos(roll), s = sin(roll), h = v->handed;
    const axes a = {{1.0, 0.0, 0.0, 0.0, c, -s * h, 0.0, s, c * h}, h};
    return a;
}

static void scale(double factor, uint32_t count, double *x)
{
    for (uint32_t i = 0; i < count; ++i) x[i] *= factor;
}

static void polar(const double matrix[9], double factor, double x[3])
{
    matrix_apply(matrix, x, x);
    scale(factor, 3, x);
}

static void place_position(const scene_view *v, double x[3])
{
    matrix_apply(v->matrix, x, x);
    for (int i = 0; i < 3; ++i) x[i] = v->length * (x[i] + v->shift[i]);
}

static void place_rotation(const scene_view *v, double rotation[3])
{
    double R[9], mirror[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, v->handed};
    rotation_of_vector(rotation, R);
    matrix_times(v->matrix, R, R);
    matrix_times(R, mirror, R);
    vector_of_rotation(R, rotation);
}

static void twist(const axes *a, double length, double v[6])
{
    polar(a->matrix, length, v);
    polar(a->matrix, a->handed, v + 3);
}

static void scale_time_function(double factor, time_function_data *p)
{
    for (uint32_t i = 0; i < p->terms; ++i) {
        p->term[i].h0 *= factor;
        p->term[i].h1 *= factor;
    }
}

/* Units, N = kg m/s2: a force is M L, a moment M L2. */
static void transform_surroundings(const scene_view *v, scene *s)
{
    const double L = v->length, M = v->mass;
    dmb_wall_def *const w = &s->wall;
    polar(v->matrix, L, s->environment.gravity);
    s->environment.fluid_density *= M / (L * L * L);
    s->environment.lateral_damping *= M / L;
    s->environment.axial_damping *= M / L;
    s->environment.torsional_damping *= M * L;
    if (!s->has_wall) return;
    place_position(v, w->origin);
    matrix_apply(v->matrix, w->direction, w->direction);
    w->stiffness *= M * pow(L, -w->exponent);
    w->damping *= M / L;
    w->bristle_stiffness /= L;
    w->bristle_damping /= L;
    double *const lengths[] = {&w->diameter,       &w->impact_depth,    &w->approach_speed,
                               &w->stribeck_speed, &w->smoothing_speed, &w->full_speed};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; ++i) *lengths[i] *= L;
    for (uint32_t i = 0; i < s->survey_count; ++i) {
        double t[3];
        survey_tangent(s->survey[i], t);
        matrix_apply(v->matrix, t, t);
        s->survey[i][0] *= L;
        s->survey[i][1] = atan2(hypot(t[0], t[1]), -t[2]) /* sharp near the vertical, too */;
        s->survey[i][2] = atan2(-t[1], t[0]);
    }
}

static void transform_pipe(const scene_view *v, double roll, dmb_pipe_def *p)
{
    const double L = v->length, M = v->mass;
    const axes a = axes_of(v, roll);
    scale(L, 1, &p->length);
    scale(L, 1, &p->outer_diameter);
    scale(L, 1, &p->inner_diameter);
    scale(L, 3, &p->joint_length); /* and its diameters */
    scale(M, 1, &p->joint_mass);
    scale(M * L * L, 2, p->joint_inertia);
    scale(L, 1, &p->eccentricity);
    p->young_modulus *= M / L;
    p->density *= M / (L * L * L);
    p->eccentricity_angle = v->handed * p->eccentricity_angle + roll;
    polar(a.matrix, v->handed / L, p->curvature);
    scale(M * L, 3, p->section_stiffness);
    scale(M * L * L * L, 3, p->section_stiffness + 3);
    scale(M / L, 1, &p->section_mass);
    scale(M * L, 2, p->section_inertia);
}

static void transform_string(const scene_view *v, double roll, string_data *s)
{
    const axes a = axes_of(v, roll);
    double offset[3] = {0.0, s->def.offset[0], s->def.offset[1]};
    polar(a.matrix, v->length, offset);
    s->def.offset[0] = offset[1];
    s->def.offset[1] = offset[2];
    s->def.start_depth *= v->length;
    place_position(v, s->def.position);
    place_rotation(v, s->def.rotation);
    twist(&a, v->length, s->def.velocity);
    for (uint32_t i = 0; i < s->pipes; ++i) transform_pipe(v, roll, &s->pipe[i]);
}

static void transform_body(const scene_view *v, double roll, dmb_body_def *b)
{
    const double L = v->length, M = v->mass;
    const axes a = axes_of(v, roll);
    double J[9] = {b->inertia[0], b->inertia[3], b->inertia[4], b->inertia[3], b->inertia[1],
                   b->inertia[5], b->inertia[4], b->inertia[5], b->inertia[2]};
    double t[9];
    matrix_transpose(a.matrix, t);
    matrix_times(a.matrix, J, J);
    matrix_times(J, t, J);
    const double inertia[6] = {J[0], J[4], J[8], J[1], J[2], J[5]};
    for (int i = 0; i < 6; ++i) b->inertia[i] = M * L * L * inertia[i];
    b->mass *= M;
    polar(a.matrix, L, b->centre);
    place_position(v, b->position);
    place_rotation(v, b->rotation);
    twist(&a, L, b->velocity);
    b->contact_diameter *= L;
    b->contact_length *= L;
}

static void transform_bit(const scene_view *v, scene *s)
{
    const double L = v->length, M = v->mass;
    double *const lengths[] = {&s->bit.diameter,    &s->bit.length,          &s->bit.radius,
                               &s->bit.wear_length, &s->bit.intrusion_depth, &s->bit.bottom};
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; ++i) *lengths[i] *= L;
    s->bit.mass *= M;
    scale(M * L * L, 2, s->bit.inertia);
    s->bit.intrinsic_energy *= M / L;
    s->bit.contact_strength *= M / L;
    scale_time_function(M * L, &s->bit_load);
}

static void transform_side(const scene_view *v, const double *roll, part_ref place, double origin[3], double axis[3],
                           double normal[3])
{
    const axes a = axes_of(v, place.kind == PART_STRING ? roll[place.index] : 0.0);
    const double *const matrix = place.kind == PART_NONE ? v->matrix : a.matrix;
    if (place.kind == PART_NONE)
        place_position(v, origin);
    else
        polar(matrix, v->length, origin);
    matrix_apply(matrix, axis, axis);
    matrix_apply(matrix, normal, normal);
}

/* Frames of joints are mirrored in their z axis: Z, RX and RY change their sign. Laws with one size for lengths and
 * angles (friction speed, stops) are those of angles: scenes have them there alone. */
static void transform_joint(const scene_view *v, const double *roll, joint_data *j)
{
    const double L = v->length, M = v->mass;
    transform_side(v, roll, j->a, j->def.origin_a, j->def.axis_a, j->def.normal_a);
    transform_side(v, roll, j->b, j->def.origin_b, j->def.axis_b, j->def.normal_b);
    j->def.length *= L;
    scale(M, 3, j->def.stiffness);
    scale(M, 3, j->def.damping);
    scale(M * L * L, 3, j->def.stiffness + 3);
    scale(M * L * L, 3, j->def.damping + 3);
    scale(M * L, 3, j->def.friction);
    scale(M * L * L, 3, j->def.friction + 3);
    for (int i = 0; i < 6; ++i) {
        const double factor = (i < 3 ? L : 1.0) * (i >= 2 && i <= 4 ? v->handed : 1.0);
        j->def.rest[i] *= factor;
        j->def.initial_position[i] *= factor;
        j->def.initial_speed[i] *= factor;
    }
}

static void transform_drive(const scene_view *v, drive_data *d)
{
    const double L = v->length, M = v->mass;
    const int turns = d->def.component >= DMB_RX;
    const double sign =
        d->def.component == DMB_Z || d->def.component == DMB_RX || d->def.component == DMB_RY ? v->handed : 1.0;
    const double force = M * L * (turns ? L : 1.0);
    scale_time_function(sign * (d->def.kind == DMB_DRIVE_LOAD ? force : turns ? 1.0 : L), &d->time_function);
    d->def.gain *= M * (turns ? L * L : 1.0);
    d->def.integral_gain *= M * (turns ? L * L : 1.0);
    if (d->def.limit_high < 1e29) { /* symmetric limits: no matter which way it turns */
        d->def.limit_low *= force;
        d->def.limit_high *= force;
    }
}

static void transform_load(const scene_view *v, const double *roll, load_data *l)
{
    const double L = v->length, M = v->mass;
    const axes a = axes_of(v, l->place.kind == PART_STRING ? roll[l->place.index] : 0.0);
    const double *const matrix = l->def.frame == DMB_FRAME_WORLD ? v->matrix : a.matrix;
    polar(matrix, M * L, l->def.force);
    polar(matrix, M * L * L * v->handed, l->def.moment);
}

/* ---- Other descriptions of the same scene ----------------------------------------------------------------------- */

static void halve_place(part_ref *r)
{
    if (r->kind != PART_STRING) return;
    r->pipe = r->fraction > 0.5 ? 2 * r->pipe + 1 : 2 * r->pipe;
}

static void halve(scene *s)
{
    for (uint32_t k = 0; k < s->strings; ++k) {
        string_data *const string = &s->string[k];
        for (uint32_t i = string->pipes; i-- > 0;) {
            dmb_pipe_def half = string->pipe[i];
            half.length *= 0.5;
            half.elements /= 2;
            string->pipe[2 * i] = string->pipe[2 * i + 1] = half;
        }
        string->pipes *= 2;
    }
    for (uint32_t i = 0; i < s->joints; ++i) {
        halve_place(&s->joint[i].a);
        halve_place(&s->joint[i].b);
    }
    for (uint32_t i = 0; i < s->loads; ++i) halve_place(&s->load[i].place);
}

/* A kind that holds some of what `kind` holds. */
static int32_t weaker(int32_t kind, uint32_t choice)
{
    static const int32_t held[][3] = {{DMB_JOINT_FIXED, DMB_JOINT_REVOLUTE, DMB_JOINT_UNIVERSAL},
                                      {DMB_JOINT_REVOLUTE, DMB_JOINT_CYLINDRICAL, DMB_JOINT_SPHERICAL},
                                      {DMB_JOINT_PRISMATIC, DMB_JOINT_CYLINDRICAL, DMB_JOINT_PRISMATIC},
                                      {DMB_JOINT_CYLINDRICAL, DMB_JOINT_CYLINDRICAL, DMB_JOINT_CYLINDRICAL},
                                      {DMB_JOINT_UNIVERSAL, DMB_JOINT_SPHERICAL, DMB_JOINT_UNIVERSAL},
                                      {DMB_JOINT_SPHERICAL, DMB_JOINT_SPHERICAL, DMB_JOINT_SPHERICAL}};
    return held[kind][choice];
}

static void double_joints(scene *s)
{
    stream t = stream_of(s->seed, s->number, TOPIC_OF_RELATION + 50);
    const uint32_t joints = s->joints;
    for (uint32_t i = 0; i < joints; ++i) {
        joint_data *const j = &s->joint[s->joints++];
        *j = s->joint[i];
        j->def.kind = weaker(j->def.kind, draw_count(&t, 0, 2));
        memset(j->def.stiffness, 0, sizeof j->def.stiffness);
        memset(j->def.damping, 0, sizeof j->def.damping);
    }
}

void scene_transform(const scene *original, const scene_view *v, scene *out)
{
    double roll[SCENE_STRINGS];
    *out = *original;
    out->span *= v->length;
    transform_surroundings(v, out);
    for (uint32_t k = 0; k < out->strings; ++k) {
        out->string[k].def.start_depth = original->string[k].def.start_depth * v->length;
        roll[k] = view_roll(original, out, v, k);
        out->string[k].def.start_depth = original->string[k].def.start_depth;
    }
    for (uint32_t k = 0; k < out->strings; ++k) transform_string(v, roll[k], &out->string[k]);
    for (uint32_t i = 0; i < out->bodies; ++i) {
        const int fixed = out->body[i].def.attach != DMB_ATTACH_NONE;
        transform_body(v, fixed ? roll[out->body[i].string] : 0.0, &out->body[i].def);
    }
    if (out->has_bit) transform_bit(v, out);
    for (uint32_t i = 0; i < out->joints; ++i) transform_joint(v, roll, &out->joint[i]);
    for (uint32_t i = 0; i < out->drives; ++i) transform_drive(v, &out->drive[i]);
    for (uint32_t i = 0; i < out->loads; ++i) transform_load(v, roll, &out->load[i]);
    if (v->halved) halve(out);
    if (v->doubled) double_joints(out);
}
