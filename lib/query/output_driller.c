/* Outputs for the driller. The section at the rig end transfers the load carried by the rig. The hook load is the axial
 * force on its near side, tension > 0; the torque applied by the rig is the opposite of the torque of the section. */
#include "force/bit_rock.h"
#include "query/query.h"
#include "sim/access.h"
#include "system/assemble/assemble.h"
#include "system/assemble/energy.h"

typedef struct asked_string {
    const dmb_sim *sim;
    dmb_id id;
    const dmb_string_map *map;
} asked_string;

int32_t dmb_output_string(const dmb_sim *sim, const dmb_output *output, dmb_id *string, uint32_t *index)
{
    *string = output->place.part;
    if (string->index == 0 && string->generation == 0) *string = dmb_model_id(sim->model, DMB_PART_STRING, 0);
    *index = dmb_model_part_index(sim->model, *string, DMB_PART_STRING);
    return *index < sim->scene->string_count ? DMB_OK : DMB_ERR_ID;
}

static dmb_place rig_end(const asked_string *s)
{
    return dmb_station(s->id, 0, 0.0);
}

static dmb_place far_end(const asked_string *s)
{
    return dmb_station(s->id, s->map->pipe_count - 1, 1.0);
}

/* Avoids -0: 0 stays +0. */
static double signed_value(double sign, double value)
{
    return sign > 0.0 ? value : 0.0 - value;
}

/* External damping that the node at the rig end has for half of its element, along and about the axis. */
static void add_half_damping(const dmb_sim *sim, uint32_t element, double load[2])
{
    const dmb_scene *scene = sim->scene;
    const double *along = sim->now.velocity + scene->layout.row[scene->element_node[element]];
    const double v[6] = {along[0], 0.0, 0.0, along[1], 0.0, 0.0};
    const double half[3] = {0.5 * scene->types[scene->element_type[element]].length, 0.0, 0.0};
    double f[6];
    if (!dmb_external_damping_at(sim, half, v, f)) return;
    load[0] += f[0];
    load[1] += f[3];
}

/* For axial-torsional pipes dmb_query_section returns the mean over an element; here the value is that at the section
 * itself. */
static int32_t section_of_rig_end(const asked_string *s, int32_t component, double sign, double *value)
{
    const dmb_pipe_map *pipe = s->sim->scene->pipes + s->map->first_pipe;
    dmb_section section = dmb_section_default();
    if (pipe->kind == DMB_PIPE_AXIAL_TORSIONAL) {
        double load[2];
        dmb_axial_torsional_start_loads(s->sim->scene, &s->sim->now, pipe->element, load);
        add_half_damping(s->sim, pipe->element, load);
        *value = signed_value(sign, load[component == DMB_RX]);
        return DMB_OK;
    }
    const int32_t status = dmb_answer_section(s->sim, rig_end(s), &section);
    if (status >= 0) *value = signed_value(sign, section.force[component]);
    return status;
}

static int32_t body_velocity(const asked_string *s, dmb_place place, int32_t component, double *value)
{
    dmb_motion motion = dmb_motion_default();
    motion.frame = DMB_FRAME_BODY;
    const int32_t status = dmb_answer_motion(s->sim, place, &motion);
    if (status >= 0) *value = motion.velocity[component];
    return status;
}

static int32_t depth_of_far_end(const asked_string *s, double *value)
{
    dmb_pose pose = dmb_pose_default();
    const int32_t status = dmb_answer_pose(s->sim, far_end(s), &pose);
    if (status >= 0) *value = pose.depth;
    return status;
}

/* Sum over the flexible lengths of the axial strain (0) or the twist (3). */
static double sum_of_strain(const asked_string *s, int component)
{
    const dmb_scene *scene = s->sim->scene;
    double sum = 0.0;
    for (uint32_t p = s->map->first_pipe; p < s->map->first_pipe + s->map->pipe_count; p++)
        for (uint32_t e = 0; e < scene->pipes[p].elements; e++) {
            double strain[6];
            dmb_element_strain(scene, &s->sim->now, scene->pipes[p].element + e, strain);
            sum += strain[component];
        }
    return sum;
}

/* ---- Bits on the string ------------------------------------------------------------------------------------------ */

typedef struct bits_of_string {
    uint32_t count, rocks; /* bits, those with a rock law */
    uint32_t first;
    int32_t on_bottom; /* 1 if one of them is on bottom */
    double weight, torque;
} bits_of_string;

static int32_t ask_bits(const asked_string *s, bits_of_string *bits)
{
    const dmb_scene *scene = s->sim->scene;
    for (uint32_t k = 0; k < scene->bit_count; k++) {
        dmb_bit_rock_result rock;
        double load;
        if (scene->bits[k].reamer) continue;
        if (scene->bits[k].node - s->map->first_node >= s->map->node_count) continue;
        dmb_bit_force_of(s->sim, k, &rock, &load);
        if (bits->count++ == 0) bits->first = k;
        bits->rocks += scene->bits[k].law.kind != DMB_ROCK_NONE;
        bits->on_bottom |= rock.on_bottom;
        bits->weight += rock.weight_on_bit + load;
        bits->torque += rock.torque_on_bit;
    }
    return bits->count > 0 ? DMB_OK : DMB_ERR_UNSUPPORTED;
}

/* Weight and torque are sums over the bits of the string, reamers excluded. The rate of penetration is that of the
 * first bit, and 0 while none of the bits with a rock law is on bottom. */
static int32_t value_of_bits(const asked_string *s, int32_t quantity, double *value)
{
    bits_of_string bits = {0};
    const int32_t status = ask_bits(s, &bits);
    if (status < 0) return status;
    if (quantity == DMB_OUTPUT_WEIGHT_ON_BIT) *value = bits.weight;
    if (quantity == DMB_OUTPUT_TORQUE_ON_BIT) *value = bits.torque;
    if (quantity == DMB_OUTPUT_RATE_OF_PENETRATION)
        *value = bits.rocks > 0 && !bits.on_bottom ? 0.0 : dmb_bit_speed_of(s->sim, bits.first);
    if (quantity != DMB_OUTPUT_OFF_BOTTOM) return DMB_OK;
    if (bits.rocks == 0) return DMB_ERR_UNSUPPORTED;
    *value = bits.on_bottom ? 0.0 : 1.0;
    return DMB_OK;
}

/* ---- The rig ----------------------------------------------------------------------------------------------------- */

/* Sum of the reaction of support and motion drives and the force of force drives, along the string's x axis. */
static int32_t force_of_rig(const asked_string *s, int32_t component, double sign, double *value)
{
    const dmb_scene *scene = s->sim->scene;
    double reaction[6], sum;
    const int32_t status = dmb_answer_reaction(s->sim, s->id, reaction);
    if (status < 0) return status;
    sum = reaction[component];
    for (uint32_t i = 0; i < scene->drive_count; i++) {
        const dmb_scene_drive *drive = scene->drives + i;
        if (drive->joint == DMB_NONE && drive->node == s->map->start_node && drive->component == component &&
            drive->kind != DMB_DRIVE_MOTION)
            sum += s->sim->now.drives[i].force;
    }
    *value = signed_value(sign, sum);
    return DMB_OK;
}

int32_t dmb_driller_value(const dmb_sim *sim, const dmb_output *output, double *value)
{
    asked_string s = {.sim = sim};
    uint32_t index;
    const int32_t status = dmb_output_string(sim, output, &s.id, &index);
    if (status < 0) return status;
    s.map = sim->scene->strings + index;
    switch (output->quantity) {
    case DMB_OUTPUT_HOOK_LOAD: return section_of_rig_end(&s, DMB_X, 1.0, value);
    case DMB_OUTPUT_ROTATION_TORQUE: return section_of_rig_end(&s, DMB_RX, -1.0, value);
    case DMB_OUTPUT_WEIGHT_ON_BIT:
    case DMB_OUTPUT_TORQUE_ON_BIT:
    case DMB_OUTPUT_RATE_OF_PENETRATION:
    case DMB_OUTPUT_OFF_BOTTOM: return value_of_bits(&s, output->quantity, value);
    case DMB_OUTPUT_BIT_SPEED: return body_velocity(&s, far_end(&s), DMB_RX, value);
    case DMB_OUTPUT_BIT_DEPTH: return depth_of_far_end(&s, value);
    case DMB_OUTPUT_ROTARY_SPEED: return body_velocity(&s, rig_end(&s), DMB_RX, value);
    case DMB_OUTPUT_FEED_SPEED: return body_velocity(&s, rig_end(&s), DMB_X, value);
    case DMB_OUTPUT_STRETCH: *value = sum_of_strain(&s, 0); return DMB_OK;
    case DMB_OUTPUT_WIND_UP: *value = signed_value(-1.0, sum_of_strain(&s, 3)); return DMB_OK;
    case DMB_OUTPUT_RIG_FORCE: return force_of_rig(&s, DMB_X, -1.0, value);
    default: return force_of_rig(&s, DMB_RX, 1.0, value); /* DMB_OUTPUT_RIG_TORQUE */
    }
}
