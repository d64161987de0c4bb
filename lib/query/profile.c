/* Profile: state of a string over its length, quantity by quantity: the results of dmb_query_pose, _motion, _section
 * and _contact at each station, and loads over limits of the pipe's definition. */
#include "query/query.h"

#include <math.h>
#include <string.h>

#include "model/section.h"
#include "sim/access.h"

DMB_DEFINE_INIT(dmb_profile, 64, {.station_count = 1})

enum { STATIONS_MAX = 1 << 24 };

/* ---- Stations ---------------------------------------------------------------------------------------------------- */

/* A run of equal pipes of the string, and its start. */
typedef struct station_iterator {
    const dmb_sim *sim;
    const dmb_pipe_run *runs;
    uint32_t run_count, string; /* index */
    uint32_t run;               /* in runs, of this string */
    double start;               /* [m] of the run, from the rig end */
} station_iterator;

static void to_run_from(station_iterator *iterator, uint32_t first)
{
    for (iterator->run = first;
         iterator->run < iterator->run_count && iterator->runs[iterator->run].string != iterator->string;)
        iterator->run++;
}

static void rewind_iterator(station_iterator *iterator)
{
    iterator->start = 0.0;
    to_run_from(iterator, 0);
}

/* Next run of the string; 0 after the last one. */
static int to_next_run(station_iterator *iterator)
{
    const uint32_t here = iterator->run;
    const dmb_pipe_run *run = &iterator->runs[here];
    to_run_from(iterator, here + 1);
    if (iterator->run < iterator->run_count) {
        iterator->start += run->count * run->def.length;
        return 1;
    }
    iterator->run = here;
    return 0;
}

/* Pipe and fraction at a distance within the string. Stations usually ascend: the iterator goes on from the run of the
 * last one, so that a profile passes each run once; a station further back starts again at the rig. An end between two
 * pipes of a run is the start of the second one; that of a run is the end of its last pipe. */
static dmb_place place_at(station_iterator *iterator, dmb_id string, double distance)
{
    const dmb_pipe_run *run;
    dmb_place place = {.part = string};
    double along;
    if (distance < iterator->start) rewind_iterator(iterator);
    run = &iterator->runs[iterator->run];
    while (distance - iterator->start > run->count * run->def.length && to_next_run(iterator))
        run = &iterator->runs[iterator->run];
    along = (distance - iterator->start) / run->def.length;
    place.pipe = along < run->count ? (uint32_t)along : run->count - 1;
    place.fraction = fmin(along - place.pipe, 1.0);
    place.pipe += run->first;
    return place;
}

static double distance_of(const dmb_profile *profile, uint32_t station, double length)
{
    if (profile->distance != NULL) return profile->distance[station];
    return profile->station_count > 1 ? length * station / (profile->station_count - 1) : 0.0;
}

/* ---- Values of a station ----------------------------------------------------------------------------------------- */

/* Quantities of one station, by DMB_PROFILE_. */
typedef struct station {
    const dmb_sim *sim;
    const dmb_pipe_run *run;
    dmb_place place;
    dmb_material_point point;
    double diameters[2];        /* [m] outer and inner, of the tool joint where the station is in one */
    double tangent[3], bend[3]; /* of the hole's axis; 0 without a hole */
    dmb_kept_loads *kept;
    double values[DMB_PROFILE_QUANTITIES];
} station;

/* Deviation from the hole's axis in its frame: sideways and up. */
static void pose_values(station *at)
{
    const dmb_scene *scene = at->sim->scene;
    dmb_material_point_pose pose;
    double axis[3], R[9], off[3], *v = at->values;
    dmb_material_point_pose_of(scene, &at->sim->now, &at->point, &pose);
    dmb_vec3_copy(pose.position, v + DMB_PROFILE_X);
    dmb_vec3_copy(pose.displacement, v + DMB_PROFILE_DISPLACEMENT_X);
    v[DMB_PROFILE_ROTATION] = dmb_material_point_turn(&at->sim->now, &at->point);
    v[DMB_PROFILE_DEPTH] = dmb_material_point_depth(scene, &at->sim->now, &at->point, pose.position);
    if (!scene->has_hole) return;
    dmb_hole_frame(&scene->hole, v[DMB_PROFILE_DEPTH], axis, at->tangent, at->bend);
    dmb_hole_frame_rotation(&scene->hole, v[DMB_PROFILE_DEPTH], R);
    dmb_vec3_sub(pose.position, axis, off);
    dmb_mat3_tvec(R, off, off);
    v[DMB_PROFILE_DEVIATION_SIDE] = off[1];
    v[DMB_PROFILE_DEVIATION_UP] = off[2];
    v[DMB_PROFILE_DEVIATION] = hypot(off[1], off[2]);
}

static int in_tool_joint(const station *at)
{
    return at->point.beyond > 0.0;
}

/* Pressures of the mud outside and inside, at rest or flowing. */
static dmb_mud_pressure pressures(const station *at)
{
    const uint32_t string = dmb_model_part_index(at->sim->model, at->place.part, DMB_PART_STRING);
    return dmb_mud_pressure_at(at->sim, string, at->values[DMB_PROFILE_DISTANCE], at->values + DMB_PROFILE_X);
}

/* [N] rho_i Q V_i of the mud that flows inside, V_i = Q/A_i: the last term of eq:mud.effective. */
static double momentum(const station *at)
{
    const dmb_mud_flow *flow = &at->sim->scene->flow;
    if (at->sim->scene->flow_count == 0) return 0.0;
    return flow->inside * flow->rate * flow->rate / dmb_ring_area(at->diameters[1], 0.0);
}

/* [N] p_o A_o - p_i A_i: effective less true axial force at rest (eq:mud.effective). With one mud at rest both
 * pressures are equal, and the product with the ring of steel avoids the difference. */
static double pressure_force(const station *at)
{
    const dmb_mud_pressure p = pressures(at);
    const double *d = at->diameters;
    if (!dmb_mud_is_apart(at->sim->scene)) return p.outside * dmb_ring_area(d[0], d[1]);
    return p.outside * dmb_ring_area(d[0], 0.0) - p.inside * dmb_ring_area(d[1], 0.0);
}

static const dmb_pipe_map *pipe_of(const station *at)
{
    const dmb_scene *scene = at->sim->scene;
    return &scene->pipes[scene->strings[at->run->string].first_pipe + at->place.pipe];
}

/* Bending from the moment, because the strain of an element is a mean. Axial-torsional pipes have the curvature of the
 * hole instead, which their tool joints do not share (eq:drilling.bending). */
static void bending_values(station *at, const double force[6])
{
    double *v = at->values;
    dmb_pipe_section section;
    dmb_section_of(&at->run->def, &section);
    v[DMB_PROFILE_BENDING_MOMENT] = hypot(force[4], force[5]);
    v[DMB_PROFILE_CURVATURE] = hypot(force[4] / section.stiffness[4], force[5] / section.stiffness[5]);
    if (pipe_of(at)->kind == DMB_PIPE_AXIAL_TORSIONAL) {
        v[DMB_PROFILE_CURVATURE] = dmb_body_curvature(&at->run->def, dmb_vec3_norm(at->bend));
        v[DMB_PROFILE_BENDING_MOMENT] = fmax(section.stiffness[4], section.stiffness[5]) * v[DMB_PROFILE_CURVATURE];
    }
    if (in_tool_joint(at)) v[DMB_PROFILE_CURVATURE] = 0.0;
}

/* Section forces. Equations and buckling know the effective force alone; the true one, N = N_e - (p_o A_o - p_i A_i) +
 * rho_i Q V_i (eq:mud.effective), is that of a strain gauge, and requires the position, for the pressures. */
static void section_values(station *at, int32_t groups)
{
    double force[6], *v = at->values;
    dmb_section_force_at(at->sim, at->place, &at->point, at->kept, force);
    v[DMB_PROFILE_EFFECTIVE_FORCE] = force[0];
    if ((groups & DMB_TAKES_PRESSURE) != 0) v[DMB_PROFILE_AXIAL_FORCE] = force[0] - pressure_force(at) + momentum(at);
    v[DMB_PROFILE_TORQUE] = force[3];
    v[DMB_PROFILE_SHEAR_FORCE] = hypot(force[1], force[2]);
    v[DMB_PROFILE_SHEAR_Y] = force[1];
    v[DMB_PROFILE_SHEAR_Z] = force[2];
    v[DMB_PROFILE_MOMENT_Y] = force[4];
    v[DMB_PROFILE_MOMENT_Z] = force[5];
    if ((groups & DMB_TAKES_BENDING) != 0) bending_values(at, force);
}

/* [N/m] Buoyant weight of the pipe with its tool joint. */
static double weight_per_metre(const station *at)
{
    const dmb_mud mud = dmb_mud_of(at->sim->scene);
    return dmb_weighing_mass(&at->run->def, &mud) / at->run->def.length;
}

/* 1: the station is beyond the middle of the stretch between the element's nodes, rigid arms included. */
static int beyond_middle(const station *at)
{
    const dmb_scene *scene = at->sim->scene;
    const dmb_element_type *type = &scene->types[scene->element_type[at->point.element]];
    const double along = type->arm[0] + at->point.fraction * type->length + at->point.beyond;
    return along >= 0.5 * (type->arm[0] + type->length + type->arm[1]);
}

/* Contact point of the stabiliser at the station; DMB_NONE: none with wall contact. Rings are sorted by string and
 * place, their ranges do not overlap: the first one that ends at or beyond the station. */
static uint32_t stabiliser_site(const station *at)
{
    const dmb_scene *scene = at->sim->scene;
    const double distance = at->values[DMB_PROFILE_DISTANCE];
    uint32_t low = 0, high = scene->ring_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const dmb_ring_map *ring = scene->rings + middle;
        if (ring->string < at->run->string ||
            (ring->string == at->run->string && ring->at + ring->half_length < distance))
            low = middle + 1;
        else
            high = middle;
    }
    if (low == scene->ring_count || scene->rings[low].string != at->run->string) return DMB_NONE;
    return distance < scene->rings[low].at - scene->rings[low].half_length ? DMB_NONE
                                                                           : scene->bodies[scene->rings[low].body].site;
}

/* Contact point inside the element that represents the station; DMB_NONE: one of its ends does. Contact points inside
 * carry lengths around the middle of the element: the station belongs to the one in whose length it lies, else to a
 * node. */
static uint32_t inside_site(const station *at)
{
    const dmb_scene *scene = at->sim->scene;
    const dmb_element_type *type = &scene->types[scene->element_type[at->point.element]];
    const uint32_t first = dmb_node_sites(scene);
    uint32_t low = 0, high = scene->inside_count;
    if (high == 0 || in_tool_joint(at)) return DMB_NONE;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (scene->inside[middle].element < at->point.element)
            low = middle + 1;
        else
            high = middle;
    }
    double inside = 0.0;
    for (uint32_t i = low; i < scene->inside_count && scene->inside[i].element == at->point.element; i++)
        inside += scene->sites[first + i].length;
    double left = at->point.fraction * type->length - 0.5 * (type->length - inside);
    for (; low < scene->inside_count && scene->inside[low].element == at->point.element && left >= 0.0; low++) {
        left -= scene->sites[first + low].length;
        if (left < 0.0) return first + low;
    }
    return DMB_NONE;
}

/* Contact point that represents the station: that of a stabiliser there, otherwise the nearest one. */
static uint32_t nearest_site(const station *at)
{
    uint32_t element = stabiliser_site(at);
    if (element != DMB_NONE) return element;
    if (at->point.element == DMB_NONE) {
        return at->place.fraction < 0.5 ? dmb_site_after(at->sim, at->place.part, at->place.pipe, 0)
                                        : dmb_site_of(at->sim, at->place.part, at->place.pipe);
    }
    const uint32_t inside = inside_site(at);
    if (inside != DMB_NONE) return inside;
    element = at->point.element - pipe_of(at)->element;
    return dmb_site_after(at->sim, at->place.part, at->place.pipe, beyond_middle(at) ? element + 1 : element);
}

static double clearance_at(const station *at)
{
    const dmb_scene *scene = at->sim->scene;
    const uint32_t site = nearest_site(at);
    double radius = 0.5 * at->diameters[0];
    if (site != DMB_NONE)
        radius = site < scene->site_count ? scene->sites[site].radius
                                          : scene->axial_torsional_sites[site - scene->site_count].radius;
    return fmax(0.0, dmb_hole_radius(&scene->hole, at->values[DMB_PROFILE_DEPTH]) - radius);
}

/* Von Mises stress of the effective force (eq:drilling.von-mises), in which hydrostatic pressure drops out; with
 * different mud inside and outside the pressure difference enters. The momentum of flowing mud is no stress of the
 * steel: it is added back to the effective force (eq:mud.effective). */
static void stress_values(station *at)
{
    const dmb_scene *scene = at->sim->scene;
    const dmb_pipe_def *def = &at->run->def;
    double *v = at->values;
    v[DMB_PROFILE_VON_MISES] =
        dmb_tube_von_mises(at->diameters[0], at->diameters[1], v[DMB_PROFILE_EFFECTIVE_FORCE] + momentum(at),
                           v[DMB_PROFILE_TORQUE], v[DMB_PROFILE_BENDING_MOMENT]);
    if (dmb_mud_is_apart(scene)) {
        const dmb_mud_pressure p = pressures(at);
        v[DMB_PROFILE_VON_MISES] =
            dmb_tube_pressed_von_mises(at->diameters, v[DMB_PROFILE_EFFECTIVE_FORCE] + momentum(at),
                                       v[DMB_PROFILE_TORQUE], v[DMB_PROFILE_BENDING_MOMENT], p.inside - p.outside);
    }
    if (def->yield_strength > 0.0) v[DMB_PROFILE_YIELD_SHARE] = v[DMB_PROFILE_VON_MISES] / def->yield_strength;
}

/* Ratios of the compression to eq:drilling.sinusoidal and eq:drilling.helical, for the softer bending direction. */
static void buckling_values(station *at)
{
    const dmb_scene *scene = at->sim->scene;
    double *v = at->values;
    dmb_pipe_section section;
    if (!scene->has_hole) return;
    dmb_section_of(&at->run->def, &section);
    dmb_confined_pipe pipe = {.EI = fmin(section.stiffness[4], section.stiffness[5]), .clearance = clearance_at(at)};
    dmb_vec3_scale(weight_per_metre(at), scene->gravity, pipe.weight);
    dmb_vec3_copy(at->tangent, pipe.tangent);
    dmb_vec3_copy(at->bend, pipe.bend);
    v[DMB_PROFILE_SINUSOIDAL_SHARE] = dmb_sinusoidal_ratio(&pipe, v[DMB_PROFILE_EFFECTIVE_FORCE]);
    v[DMB_PROFILE_HELICAL_SHARE] = dmb_helical_ratio(&pipe, v[DMB_PROFILE_EFFECTIVE_FORCE]);
}

/* Forces per metre: a contact point represents a length of wall, which depends on the mesh; its force over that length
 * converges with the mesh. */
static int32_t contact_values(station *at)
{
    const uint32_t site = nearest_site(at);
    dmb_contact contact = dmb_contact_default();
    const int32_t status = site == DMB_NONE ? DMB_OK : dmb_answer_contact(at->sim, site, &contact);
    const double per_metre = contact.length > 0.0 ? 1.0 / contact.length : 0.0;
    if (site != DMB_NONE) at->values[DMB_PROFILE_GAP] = contact.gap;
    at->values[DMB_PROFILE_NORMAL_FORCE] = contact.normal_force * per_metre;
    at->values[DMB_PROFILE_FRICTION_AXIAL] = contact.friction[0] * per_metre;
    at->values[DMB_PROFILE_FRICTION_AROUND] = contact.friction[1] * per_metre;
    return status;
}

/* Acceleration of the centre in body axes: rate of the body-frame velocity and w x v. */
static void motion_values(station *at)
{
    dmb_material_point_motion motion;
    double a[3], *v = at->values;
    dmb_material_point_motion_of(at->sim->scene, &at->sim->now, &at->point, &motion);
    dmb_vec3_cross(motion.velocity + 3, motion.velocity, a);
    dmb_vec3_add(a, motion.acceleration, a);
    v[DMB_PROFILE_VELOCITY_AXIAL] = motion.velocity[0];
    v[DMB_PROFILE_VELOCITY_LATERAL] = hypot(motion.velocity[1], motion.velocity[2]);
    v[DMB_PROFILE_SPIN] = motion.velocity[3];
    v[DMB_PROFILE_ACCELERATION_AXIAL] = a[0];
    v[DMB_PROFILE_ACCELERATION_LATERAL] = hypot(a[1], a[2]);
}

/* 1: values of these groups require the pose. */
static int takes_pose(const station *at, int32_t groups)
{
    return (groups & DMB_TAKES_POSE) != 0 ||
           ((groups & DMB_TAKES_BENDING) != 0 && pipe_of(at)->kind == DMB_PIPE_AXIAL_TORSIONAL) ||
           ((groups & DMB_TAKES_LIMITS) != 0 && dmb_mud_is_apart(at->sim->scene));
}

/* Groups are computed in the order of their dependence: pose and depth, motion, contact, then section forces, of which
 * stresses and buckling ratios are made. In a rigid pipe there is no section, its values stay 0. */
static int32_t fill(station *at, int32_t groups)
{
    int32_t status = DMB_OK;
    if (takes_pose(at, groups)) pose_values(at);
    if ((groups & DMB_TAKES_MOTION) != 0) motion_values(at);
    if ((groups & DMB_TAKES_CONTACT) != 0) status = contact_values(at);
    if ((groups & DMB_TAKES_SECTION) == 0 || at->point.element == DMB_NONE) return status;
    if (status < 0) return status;
    section_values(at, groups);
    if ((groups & DMB_TAKES_LIMITS) != 0) stress_values(at);
    if ((groups & DMB_TAKES_BUCKLING) != 0) buckling_values(at);
    return DMB_OK;
}

/* ---- The call ---------------------------------------------------------------------------------------------------- */

static int32_t check_quantities(const dmb_profile *profile, const double *values, int32_t *groups)
{
    *groups = 0;
    if (profile->quantities == NULL || values == NULL) return DMB_ERR_NULL;
    if (profile->quantity_count < 1 || profile->quantity_count > DMB_PROFILE_QUANTITIES) return DMB_ERR_VALUE;
    for (uint32_t i = 0; i < profile->quantity_count; i++) {
        if (dmb_profile_groups(profile->quantities[i]) < 0) return DMB_ERR_VALUE;
        *groups |= dmb_profile_groups(profile->quantities[i]);
    }
    return DMB_OK;
}

/* Checks that the strides of two quantities never address the same memory: one stride exceeds the extent of the other.
 */
static int32_t check_strides(dmb_profile *profile)
{
    const uint64_t most = SIZE_MAX / sizeof(double) / STATIONS_MAX;
    if (profile->station_stride == 0 && profile->quantity_stride == 0) {
        profile->station_stride = profile->quantity_count;
        profile->quantity_stride = 1;
    }
    if (profile->station_stride > most || profile->quantity_stride > most) return DMB_ERR_VALUE;
    if (profile->quantity_stride > 0 && profile->station_stride >= profile->quantity_count * profile->quantity_stride)
        return DMB_OK;
    return profile->station_stride > 0 && profile->quantity_stride >= profile->station_count * profile->station_stride
               ? DMB_OK
               : DMB_ERR_VALUE;
}

static int32_t check_distances(const dmb_profile *profile, double length)
{
    if (profile->station_count < 1 || profile->station_count > STATIONS_MAX) return DMB_ERR_VALUE;
    for (uint32_t i = 0; profile->distance != NULL && i < profile->station_count; i++) {
        if (!isfinite(profile->distance[i])) return DMB_ERR_NOT_FINITE;
        if (!(profile->distance[i] >= 0.0 && profile->distance[i] <= length)) return DMB_ERR_VALUE;
    }
    return DMB_OK;
}

static int32_t find_string(const dmb_sim *sim, dmb_id *string, uint32_t *index)
{
    if (string->index == 0 && string->generation == 0) *string = dmb_model_id(sim->model, DMB_PART_STRING, 0);
    *index = dmb_model_part_index(sim->model, *string, DMB_PART_STRING);
    return *index < sim->scene->string_count ? DMB_OK : DMB_ERR_ID;
}

/* Sets sim, place and run of a station. */
static int32_t read_station(station *at, double distance, int32_t groups)
{
    const int32_t status = dmb_string_point_of(at->sim, at->place, &at->point);
    if (status < 0) return status;
    for (int k = 0; k < DMB_PROFILE_QUANTITIES; k++) at->values[k] = (double)NAN;
    at->values[DMB_PROFILE_DISTANCE] = distance;
    dmb_pipe_diameters(&at->run->def, in_tool_joint(at), at->diameters);
    return fill(at, groups);
}

/* Stations of a call, one after the other. */
typedef struct station_run {
    dmb_profile profile;
    station_iterator iterator;
    int32_t groups;
    dmb_kept_loads kept;
} station_run;

static int32_t take_station(station_run *run, uint32_t i, station *at)
{
    const double length = run->iterator.sim->scene->strings[run->iterator.string].length;
    const double distance = distance_of(&run->profile, i, length);
    at->kept = &run->kept;
    at->place = place_at(&run->iterator, run->profile.string, distance);
    at->run = &run->iterator.runs[run->iterator.run];
    return read_station(at, distance, run->groups);
}

/* values: where results go, NULL is refused. */
static int32_t begin_run(const dmb_sim *sim, const dmb_profile *given, const double *values, station_run *run)
{
    dmb_profile *profile = &run->profile;
    int32_t status = dmb_profile_read(profile, given);
    run->iterator.sim = sim;
    if (status == DMB_OK) status = find_string(sim, &profile->string, &run->iterator.string);
    if (status == DMB_OK) status = check_quantities(profile, values, &run->groups);
    if (status == DMB_OK) status = check_distances(profile, sim->scene->strings[run->iterator.string].length);
    if (status < 0) return status;
    run->iterator.runs = sim->model->runs.items;
    run->iterator.run_count = sim->model->runs.count;
    rewind_iterator(&run->iterator);
    /* lanes compute the loads of neighbouring elements together: with few stations most of them would not be used */
    dmb_kept_loads_begin(8 * (uint64_t)profile->station_count < sim->scene->element_count ? 1 : DMB_LOADS_KEPT,
                         &run->kept);
    return DMB_OK;
}

int32_t dmb_answer_profile(const dmb_sim *sim, const dmb_profile *given)
{
    int32_t status = dmb_ask(sim, given);
    station_run run;
    station at = {.sim = sim};
    const dmb_profile *profile = &run.profile;
    if (status == DMB_OK) status = begin_run(sim, given, given->values, &run);
    if (status == DMB_OK) status = check_strides(&run.profile);
    for (uint32_t i = 0; status >= 0 && i < profile->station_count; i++) {
        status = take_station(&run, i, &at);
        for (uint32_t q = 0; q < profile->quantity_count && status >= 0; q++)
            profile->values[i * profile->station_stride + q * profile->quantity_stride] =
                at.values[profile->quantities[q]];
    }
    return status;
}

/* extreme: least value, its distance, largest, its distance. */
static void widen(double value, double distance, double extreme[4])
{
    if (isnan(value)) return;
    if (!(extreme[0] <= value)) extreme[0] = value, extreme[1] = distance;
    if (!(extreme[2] >= value)) extreme[2] = value, extreme[3] = distance;
}

int32_t dmb_answer_profile_extremes(const dmb_sim *sim, const dmb_profile *given, double *extremes)
{
    int32_t status = dmb_ask(sim, given);
    double found[DMB_PROFILE_QUANTITIES][4] = {{0.0}};
    station_run run;
    station at = {.sim = sim};
    const dmb_profile *profile = &run.profile;
    if (status == DMB_OK) status = begin_run(sim, given, extremes, &run);
    if (status < 0) return status;
    for (uint32_t i = 0; i < 4 * profile->quantity_count; i++) found[i / 4][i % 4] = (double)NAN;
    for (uint32_t i = 0; i < profile->station_count && status >= 0; i++) {
        status = take_station(&run, i, &at);
        for (uint32_t q = 0; q < profile->quantity_count && status >= 0; q++)
            widen(at.values[profile->quantities[q]], at.values[DMB_PROFILE_DISTANCE], found[q]);
    }
    if (status >= 0) memcpy(extremes, found, 4 * profile->quantity_count * sizeof *extremes);
    return status;
}

int32_t dmb_profile_value(const dmb_sim *sim, dmb_place place, int32_t quantity, double *value)
{
    station_iterator iterator = {.sim = sim, .runs = sim->model->runs.items, .run_count = sim->model->runs.count};
    dmb_kept_loads kept;
    station at = {.sim = sim, .place = place, .kept = &kept};
    dmb_kept_loads_begin(1, &kept);
    iterator.string = dmb_model_part_index(sim->model, place.part, DMB_PART_STRING);
    if (iterator.string >= sim->scene->string_count) return DMB_ERR_ID;
    at.run = dmb_pipe_run_of(sim->model, iterator.string, place.pipe);
    if (at.run == NULL) return DMB_ERR_VALUE;
    rewind_iterator(&iterator);
    while (&iterator.runs[iterator.run] != at.run && to_next_run(&iterator)) continue;
    const double distance = iterator.start + (place.pipe - at.run->first + place.fraction) * at.run->def.length;
    const int32_t status = read_station(&at, distance, dmb_profile_groups(quantity));
    if (status >= 0) *value = at.values[quantity];
    return status;
}
