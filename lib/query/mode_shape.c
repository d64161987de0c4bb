/* Mode shapes. A mode shape is a motion of the nodes; therefore a copy of the sim with this motion is queried like any
 * other motion. */
#include <string.h>

#include "analysis/modes/modes.h"
#include "base/failure.h"
#include "element/beam.h"
#include "math/real.h"
#include "query/query.h"
#include "sim/access.h"
#include "system/assemble/energy.h"

DMB_DECLARE_STRUCT(dmb_modes_info)
DMB_DECLARE_STRUCT(dmb_mode)
DMB_DECLARE_STRUCT(dmb_mode_shape)

static int32_t check_modes(const dmb_modes *modes, const void *answer)
{
    if (modes == NULL) return DMB_ERR_NULL;
    if (!dmb_handle_is(modes, DMB_HANDLE_MODES)) return DMB_ERR_HANDLE;
    return answer != NULL ? DMB_OK : DMB_ERR_NULL;
}

static int32_t check_index(const dmb_modes *modes, uint32_t index, const void *answer)
{
    const int32_t status = check_modes(modes, answer);
    if (status < 0) return status;
    return index < modes->count ? DMB_OK : DMB_ERR_VALUE;
}

/* Copy of the state with the real (part 0) or imaginary (part 1) part of a mode as velocity: velocities of places are
 * linear in those of the nodes, as small displacements are, and have the same coefficients. Only arrays that the
 * queries read are exchanged; the state of the modes is not changed. */
static dmb_sim moving(const dmb_modes *modes, uint32_t index, int part)
{
    dmb_sim view = *modes->state;
    view.now.velocity = (part == 0 ? modes->re : modes->im) + (size_t)modes->rows * index;
    view.now.acceleration = view.increment; /* zeros */
    return view;
}

static int parts_of(const dmb_modes *modes)
{
    return modes->im != NULL ? 2 : 1;
}

int32_t dmb_modes_get_info(const dmb_modes *modes, dmb_modes_info *info)
{
    const int32_t status = check_modes(modes, info);
    return dmb_failed("modes", status < 0 ? status : dmb_modes_info_write(info, &modes->info));
}

/* ---- Energies ---------------------------------------------------------------------------------------------------- */

/* Adds the strain energy of axial strain (component 0), of torsion (3), and of bending with shear (all others). */
static void add_strain_parts(const dmb_sim *view, uint32_t first, uint32_t count, double sum[3])
{
    for (uint32_t e = first; e < first + count; e++) {
        const dmb_element_type *type = view->scene->types + view->scene->element_type[e];
        double rate[6];
        dmb_element_strain_rate(view->scene, &view->now, e, rate);
        for (int i = 0; i < 6; i++) sum[i % 3 ? 2 : i / 3] += 0.5 * type->stiffness[i] * rate[i] * rate[i];
        sum[2] += 0.5 * dmb_beam_cross_energy(type, rate);
    }
}

static double strain_energy(const dmb_sim *view, uint32_t first, uint32_t count)
{
    double parts[3] = {0.0, 0.0, 0.0};
    add_strain_parts(view, first, count, parts);
    return parts[0] + parts[1] + parts[2];
}

/* Fractions of the sum; 0 if the sum is 0. */
static void set_fractions(const double parts[3], double share[3])
{
    const double all = parts[0] + parts[1] + parts[2];
    for (int i = 0; i < 3; i++) share[i] = all > 0.0 ? parts[i] / all : 0.0;
}

static void add_kinetic_parts(const dmb_sim *view, double sum[3])
{
    double parts[3];
    for (uint32_t e = 0; e < view->scene->element_count; e++) {
        dmb_element_kinetic_parts(view->scene, &view->now, e, parts);
        for (int i = 0; i < 3; i++) sum[i] += parts[i];
    }
    for (uint32_t i = 0; i < view->scene->rigid_mass_count; i++) {
        dmb_rigid_mass_kinetic_parts(view->scene, &view->now, i, parts);
        for (int k = 0; k < 3; k++) sum[k] += parts[k];
    }
    for (uint32_t i = 0; i < view->scene->added_mass_count; i++) {
        dmb_added_mass_kinetic_parts(view->scene, &view->now, i, parts);
        for (int k = 0; k < 3; k++) sum[k] += parts[k];
    }
}

/* With the shape as velocity its momentum is r_i^T M x, r_i the unit translations: the participation factor, and since
 * x^H M x = 1 its square is the effective mass; over all modes these sum to the mass that supports leave free. Energies
 * are those of the amplitude 1: the kinetic one has |s|^2. */
static void describe(const dmb_modes *modes, uint32_t index, dmb_mode *mode)
{
    const double *s = modes->s + 2 * (size_t)index, size = hypot(s[0], s[1]);
    double parts[3] = {0.0, 0.0, 0.0}, strain[3] = {0.0, 0.0, 0.0};
    mode->rigid = modes->rigid[index];
    mode->frequency = size / DMB_TWO_PI;
    mode->damping = size > 0.0 && s[0] != 0.0 ? -s[0] / size : 0.0;
    memcpy(mode->eigenvalue, s, sizeof mode->eigenvalue);
    for (int part = 0; part < parts_of(modes); part++) {
        const dmb_sim view = moving(modes, index, part);
        dmb_momentum momentum = dmb_momentum_default();
        add_kinetic_parts(&view, parts);
        add_strain_parts(&view, 0, view.scene->element_count, strain);
        (void)dmb_answer_momentum(&view, &momentum);
        for (int i = 0; i < 3; i++) {
            if (part == 0) mode->participation[i] = momentum.linear[i];
            mode->effective_mass[i] += momentum.linear[i] * momentum.linear[i];
        }
    }
    mode->whirl = modes->whirl[index];
    mode->kinetic = size * size * (parts[0] + parts[1] + parts[2]);
    mode->strain = strain[0] + strain[1] + strain[2];
    set_fractions(parts, mode->share);
    set_fractions(strain, mode->strain_share);
}

int32_t dmb_modes_get(const dmb_modes *modes, uint32_t index, dmb_mode *mode)
{
    const int32_t status = check_index(modes, index, mode);
    dmb_mode answer;
    if (status < 0) return dmb_failed("modes", status);
    memset(&answer, 0, sizeof answer);
    describe(modes, index, &answer);
    return dmb_failed("modes", dmb_mode_write(mode, &answer));
}

/* ---- By part ----------------------------------------------------------------------------------------------------- */

typedef struct part_energy {
    double kinetic, strain;
} part_energy;

static int32_t add_pipe(const dmb_sim *view, dmb_id string, uint32_t pipe, part_energy *sum)
{
    int32_t status;
    double kinetic;
    const dmb_pipe_map *map = dmb_pipe_of(view, string, pipe, &status);
    if (map == NULL) return status;
    status = dmb_answer_kinetic_energy(view, string, pipe, &kinetic);
    if (status < 0) return status;
    sum->kinetic += kinetic;
    sum->strain += strain_energy(view, map->element, map->elements);
    return DMB_OK;
}

static int32_t add_part(const dmb_sim *view, dmb_id part, uint32_t pipe, part_energy *sum)
{
    const uint32_t string = dmb_model_part_index(view->model, part, DMB_PART_STRING);
    double kinetic;
    if (string == DMB_NONE) {
        const int32_t status = dmb_answer_kinetic_energy(view, part, pipe, &kinetic);
        if (status >= 0) sum->kinetic += kinetic;
        return status;
    }
    if (pipe != DMB_NONE) return add_pipe(view, part, pipe, sum);
    int32_t status = DMB_OK;
    for (uint32_t i = 0; i < view->scene->strings[string].pipe_count && status >= 0; i++)
        status = add_pipe(view, part, i, sum);
    return status;
}

int32_t dmb_modes_part(const dmb_modes *modes, uint32_t index, dmb_id part, uint32_t pipe, double *kinetic,
                       double *strain)
{
    int32_t status = check_index(modes, index, kinetic);
    part_energy sum = {0.0, 0.0};
    if (status < 0) return dmb_failed("modes", status);
    if (strain == NULL) return dmb_failed("modes", DMB_ERR_NULL);
    for (int i = 0; i < parts_of(modes); i++) {
        const dmb_sim view = moving(modes, index, i);
        status = add_part(&view, part, pipe, &sum);
        if (status < 0) return dmb_failed("modes", status);
    }
    const double *s = modes->s + 2 * (size_t)index;
    *kinetic = (s[0] * s[0] + s[1] * s[1]) * sum.kinetic;
    *strain = sum.strain;
    return DMB_OK;
}

/* ---- Shape ------------------------------------------------------------------------------------------------------- */

static void turn_to_world(const double R[9], double d[6])
{
    dmb_mat3_vec(R, d, d);
    dmb_mat3_vec(R, d + 3, d + 3);
}

int32_t dmb_modes_shape(const dmb_modes *modes, uint32_t index, dmb_place place, dmb_mode_shape *shape)
{
    int32_t status = check_index(modes, index, shape);
    dmb_mode_shape answer;
    dmb_material_point point;
    dmb_material_point_pose pose;
    if (status == DMB_OK) status = dmb_mode_shape_read(&answer, shape);
    if (status < 0) return dmb_failed("modes", status);
    if (answer.frame != DMB_FRAME_WORLD && answer.frame != DMB_FRAME_BODY) return dmb_failed("modes", DMB_ERR_VALUE);
    status = dmb_material_point_of(modes->state, place, &point);
    if (status < 0) return dmb_failed("modes", status);
    dmb_material_point_pose_of(modes->state->scene, &modes->state->now, &point, &pose);
    memset(answer.im, 0, sizeof answer.im);
    for (int part = 0; part < parts_of(modes); part++) {
        const dmb_sim view = moving(modes, index, part);
        dmb_material_point_motion motion;
        double *to = part == 0 ? answer.re : answer.im;
        dmb_material_point_motion_of(view.scene, &view.now, &point, &motion);
        dmb_vec6_copy(motion.velocity, to);
        if (answer.frame == DMB_FRAME_WORLD) turn_to_world(pose.rotation, to);
    }
    return dmb_failed("modes", dmb_mode_shape_write(shape, &answer));
}
