#include "model/scene.h"

#include <math.h>
#include <stdbool.h>

static const double same_point = 1e-9; /* [m] */

/* A point that stays on the axis of the hole is as far from the wall as the clearance. */
static bool is_on_axis(const dmb_scene *scene, const dmb_body_map *body, const dmb_scene_joint *joint)
{
    const double *x = joint->b.x;
    if (joint->kind != DMB_JOINT_POINT_ON_HOLE || joint->state == DMB_JOINT_OPEN) return false;
    if (body->site == DMB_NONE || joint->b.node != body->node) return false;
    return fabs(x[0] - scene->sites[body->site].offset) <= same_point && fabs(x[1]) <= same_point &&
           fabs(x[2]) <= same_point;
}

/* Name of the guide or joint that holds the ring: "its guide", a joint by name, or NULL. */
static const char *holder(const dmb_scene *scene, const dmb_body_map *body, dmb_message *text)
{
    if (body->held_ring) return "the guide (free_mask; start_free or end_free of its string)";
    for (uint32_t j = 0; j < scene->joint_count; ++j) {
        const dmb_scene_joint *joint = &scene->joints[j];
        if (is_on_axis(scene, body, joint)) return dmb_part_text(text, "joint", j, joint->name, sizeof joint->name);
    }
    return NULL;
}

uint32_t dmb_held_ring(const dmb_scene *scene, uint32_t from, dmb_message *text)
{
    const uint32_t rings = scene->body_count - scene->ring_count, bodies = rings - scene->bit_count;
    dmb_message part;
    for (uint32_t i = from; i < scene->body_count; ++i) {
        dmb_message name;
        const char *by = holder(scene, &scene->bodies[i], &name);
        if (by == NULL) continue;
        const uint32_t first = i < bodies ? 0 : i < rings ? bodies : rings;
        dmb_part_text(&part,
                      i < bodies  ? "body"
                      : i < rings ? "bit"
                                  : "ring",
                      i - first, scene->bodies[i].name, sizeof scene->bodies[i].name);
        if (i >= rings) {
            dmb_message_set(text, "%s: it never touches the wall, %s holds it sideways: free it there, or move it",
                            part.text, by);
            return i;
        }
        dmb_message_set(text, "%s: its ring never touches the wall, %s holds it sideways: free it there, or give no %s",
                        part.text, by, i < bodies ? "contact_diameter" : "diameter");
        return i;
    }
    return DMB_NONE;
}
