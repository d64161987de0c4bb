/* Sections of the hole as pieces of parabolas. Around the depth D of a section, over h = transition/2 on both sides,
 * two parabolas lead from y0 with slope m0 to y1 with slope m1; they meet at D with the slope
 *     p = (y1 - y0)/h - (m0 + m1)/2,
 * which is one parabola where the two lines meet. Behind them the values hold or go straight on. The mean over the
 * transition of a step is that of the sharp one, so that friction takes the same work. */
#include "drillmbd/scene.h"
#include "force/friction_law.h"
#include "force/hole.h"
#include "model/field_check.h"
#include "model/mesh.h"
#include "model/model.h"
#include "model/section.h"

typedef struct section_values {
    double v[DMB_WALL_COUNT];
} section_values;

static double or_wall(double value, double wall)
{
    return value >= 0.0 ? value : wall;
}

static section_values of_wall(const dmb_wall_def *w)
{
    return (section_values){
        {0.5 * w->diameter, w->stiffness, w->restitution, w->damping, w->mu_static, w->mu_dynamic, 0.0}};
}

/* Static friction coefficient of a section; with a table of the wall, its first coefficient, in proportion. */
static double static_of(const dmb_wall_def *wall, const dmb_hole_section *s)
{
    if (wall->friction_table_count == 0) return or_wall(s->mu_static, wall->mu_static);
    return wall->mu_static * or_wall(s->mu_dynamic, wall->mu_dynamic) / wall->mu_dynamic;
}

static section_values of_section(const dmb_wall_def *wall, const dmb_hole_section *s)
{
    return (section_values){{0.5 * or_wall(s->diameter, wall->diameter), or_wall(s->stiffness, wall->stiffness),
                             or_wall(s->restitution, wall->restitution), or_wall(s->damping, wall->damping),
                             static_of(wall, s), or_wall(s->mu_dynamic, wall->mu_dynamic), s->strength}};
}

/* ---- Checks ------------------------------------------------------------------------------------------------------ */

/* The bounds that the laws set to the wall's constants, with those of the wall filled in. */
static int32_t check_constants(const dmb_mesh *mesh, uint32_t i, const dmb_hole_section *given, const section_values *s)
{
    const dmb_wall_def *wall = &mesh->model->wall;
    dmb_check check = dmb_check_of(&mesh->model->message, "hole section", i);
    if (wall->normal_law == DMB_NORMAL_FLORES) dmb_check_above(&check, "restitution", s->v[DMB_WALL_RESTITUTION], 0.0);
    if (wall->friction_table_count > 0 && given->mu_static >= 0.0)
        dmb_check_fail(&check, DMB_ERR_VALUE, "mu_static", given->mu_static,
                       "left out (-1): friction_table_speed and friction_table_mu of the wall say it, in proportion to "
                       "mu_dynamic");
    else if (wall->friction_table_count == 0 && dmb_friction_has_static(wall->friction_law))
        dmb_check_at_least_field(&check, "mu_static", s->v[DMB_WALL_MU_STATIC], "mu_dynamic",
                                 s->v[DMB_WALL_MU_DYNAMIC]);
    return check.status;
}

/* The transitions of two sections must not overlap, and a line needs a section to lead to. */
static int32_t check_place(const dmb_mesh *mesh, const dmb_hole_section *all, uint32_t i, uint32_t count)
{
    const dmb_hole_section *s = all + i;
    if (i + 1 == count) {
        if (s->shape == DMB_HOLE_STEP) return DMB_OK;
        dmb_message_set(&mesh->model->message,
                        "hole section %u: shape = DMB_HOLE_LINE (%d), must be DMB_HOLE_STEP (%d) in the last one; add "
                        "a section that the line leads to",
                        i, s->shape, DMB_HOLE_STEP);
        return DMB_ERR_GEOMETRY;
    }
    const double room = s[1].depth - s->depth, need = 0.5 * (s->transition + s[1].transition);
    if (room >= need) return DMB_OK;
    dmb_message_set(&mesh->model->message,
                    "hole section %u: depth is %g m above the next one's, must be >= %g m, half of both transitions; "
                    "give shorter transitions",
                    i, room, need);
    return DMB_ERR_GEOMETRY;
}

/* ---- Pieces ------------------------------------------------------------------------------------------------------ */

/* Iteration along the hole: values and their slopes. */
typedef struct section_iterator {
    dmb_mesh *mesh;
    section_values at; /* at the end of the last piece */
    section_values slope;
    double depth; /* [m] where that is */
} section_iterator;

static int32_t push(section_iterator *iterator, const dmb_hole_piece *piece)
{
    const dmb_wall_def *wall = &iterator->mesh->model->wall;
    dmb_hole_piece added = *piece;
    added.factor = dmb_normal_law_of((dmb_normal_law){.kind = wall->normal_law}, piece->value[DMB_WALL_RESTITUTION]).mu;
    return dmb_vector_append(&iterator->mesh->pieces, &iterator->mesh->model->allocator, &added, 1);
}

/* Adds a parabola from the present values and `slope` to those with the slope `to` at h beyond. */
static int32_t push_parabola(section_iterator *iterator, double h, const section_values *to)
{
    dmb_hole_piece piece = {.depth = iterator->depth};
    for (int k = 0; k < DMB_WALL_COUNT; k++) {
        piece.value[k] = iterator->at.v[k];
        piece.slope[k] = iterator->slope.v[k];
        piece.bend[k] = 0.5 * (to->v[k] - iterator->slope.v[k]) / h;
        iterator->at.v[k] += 0.5 * h * (iterator->slope.v[k] + to->v[k]);
    }
    iterator->slope = *to;
    iterator->depth += h;
    return push(iterator, &piece);
}

static int32_t push_straight(section_iterator *iterator, double end)
{
    dmb_hole_piece piece = {.depth = iterator->depth};
    for (int k = 0; k < DMB_WALL_COUNT; k++) {
        piece.value[k] = iterator->at.v[k];
        piece.slope[k] = iterator->slope.v[k];
        iterator->at.v[k] += (end - iterator->depth) * iterator->slope.v[k];
    }
    iterator->depth = end;
    return push(iterator, &piece);
}

/* Adds the transition to a section with these values and slopes. */
static int32_t pass_transition(section_iterator *iterator, const dmb_hole_section *s, const section_values *values,
                               const section_values *slope)
{
    const double h = 0.5 * s->transition;
    section_values middle, end;
    for (int k = 0; k < DMB_WALL_COUNT; k++) {
        end.v[k] = values->v[k] + h * slope->v[k];
        middle.v[k] = (end.v[k] - iterator->at.v[k]) / h - 0.5 * (iterator->slope.v[k] + slope->v[k]);
    }
    if (fabs(middle.v[DMB_WALL_RADIUS]) > DMB_HOLE_SLOPE_MAX) {
        dmb_model *model = iterator->mesh->model;
        dmb_message_set(&model->message,
                        "hole section %u: its radius changes by %g m/m within the transition, must be <= %g; give a "
                        "longer transition",
                        (uint32_t)(s - (const dmb_hole_section *)model->sections.items),
                        fabs(middle.v[DMB_WALL_RADIUS]), DMB_HOLE_SLOPE_MAX);
        return DMB_ERR_GEOMETRY;
    }
    int32_t status = push_parabola(iterator, h, &middle);
    if (status >= 0) status = push_parabola(iterator, h, slope);
    iterator->at = end; /* removes the rounding of the path */
    return status;
}

/* Behind a step values stay; behind the begin of a line they lead straight to those of the next section, which keeps
 * them from its depth on. */
static section_values slope_behind(const dmb_wall_def *wall, const dmb_hole_section *s, const section_values *values)
{
    section_values slope = {{0}};
    if (s->shape == DMB_HOLE_STEP) return slope;
    const section_values next = of_section(wall, s + 1);
    for (int k = 0; k < DMB_WALL_COUNT; k++) slope.v[k] = (next.v[k] - values->v[k]) / (s[1].depth - s->depth);
    return slope;
}

/* Straight on from the last piece to the begin of the transition, then the transition, which ends with values and slope
 * of this section. */
static int32_t pass_section(section_iterator *iterator, uint32_t i, uint32_t count)
{
    const dmb_wall_def *wall = &iterator->mesh->model->wall;
    const dmb_hole_section *all = iterator->mesh->model->sections.items, *s = all + i;
    const section_values values = of_section(wall, s);
    int32_t status = check_place(iterator->mesh, all, i, count);
    if (status >= 0) status = check_constants(iterator->mesh, i, s, &values);
    if (status < 0) return status;
    const section_values slope = slope_behind(wall, s, &values);
    status = push_straight(iterator, s->depth - 0.5 * s->transition);
    return status < 0 ? status : pass_transition(iterator, s, &values, &slope);
}

int32_t dmb_mesh_sections(dmb_mesh *mesh)
{
    const dmb_hole_section *all = mesh->model->sections.items;
    const uint32_t count = mesh->model->sections.count;
    int32_t status = DMB_OK;
    if (count == 0 && !(mesh->model->wall_count > 0 && mesh->model->wall.cut_spacing > 0.0)) return DMB_OK;
    if (mesh->model->wall_count == 0) {
        dmb_message_set(&mesh->model->message, "hole sections: there are %u and no wall; add a wall", count);
        return DMB_ERR_ORDER;
    }
    section_iterator iterator = {.mesh = mesh, .at = of_wall(&mesh->model->wall)};
    if (count > 0) iterator.depth = all->depth - all->transition; /* without any, one piece that cutters may widen */
    for (uint32_t i = 0; i < count && status >= 0; i++) status = pass_section(&iterator, i, count);
    if (status >= 0) status = push_straight(&iterator, iterator.depth);
    mesh->hole.piece = mesh->pieces.items;
    mesh->hole.pieces = (uint32_t)mesh->pieces.count;
    return status;
}

/* ---- Through the hole -------------------------------------------------------------------------------------------- */

/* `hole` is the diameter of the hole at the measured depth `where`. */
static int32_t check_width(const dmb_mesh *mesh, const char *part, const dmb_field_value *is, double hole, double where)
{
    dmb_message text;
    if (is->value <= hole) return DMB_OK;
    if (mesh->hole.pieces == 0)
        dmb_message_set(&text, "<= %g m, the diameter of the hole", hole);
    else
        dmb_message_set(&text,
                        "<= %g m, the diameter of the hole at measured depth %g m; look at the sections of the hole",
                        hole, where);
    dmb_check check = dmb_check_of(&mesh->model->message, part, DMB_NONE);
    const dmb_check_bound must = {text.text, 0.0, hole};
    dmb_check_fail_value(&check, DMB_ERR_GEOMETRY, is, &must);
    return check.status;
}

/* The narrowest place between two depths is no narrower than `diameter`. */
static int32_t check_fits(const dmb_mesh *mesh, const char *part, const char *field, double diameter, double from,
                          double to)
{
    double where;
    const double hole = 2.0 * dmb_hole_least_radius(&mesh->hole, from, to, &where);
    const dmb_field_value is = {field, DMB_NONE, diameter};
    return check_width(mesh, part, &is, hole, where);
}

/* Checks the fit at one depth, where the part itself may widen the hole. */
static int32_t check_fits_cut(const dmb_mesh *mesh, const char *part, const char *field, double diameter, double depth,
                              double cut)
{
    const double hole = fmax(cut, 2.0 * dmb_hole_radius(&mesh->hole, depth));
    const dmb_field_value is = {field, DMB_NONE, diameter};
    return check_width(mesh, part, &is, hole, depth);
}

static int32_t check_pipe(const dmb_mesh *mesh, uint32_t string, const dmb_pipe_def *def, double from, double to)
{
    dmb_message part;
    (void)dmb_pipes_text(&part, string, def);
    const int32_t status = check_fits(mesh, part.text, "outer_diameter", def->outer_diameter, from, to);
    if (status < 0) return status;
    return check_fits(mesh, part.text, "joint_outer_diameter", dmb_joint_diameter(def),
                      fmax(from, to - def->joint_length), to);
}

/* Checks pipes along the hole over their length, others at their near ends. */
static int32_t check_string(const dmb_mesh *mesh, uint32_t string)
{
    dmb_pipe_iterator pipes = dmb_pipe_iterator_of(mesh, string);
    const dmb_string_map *map = dmb_mesh_string_at(mesh, string);
    const bool follows = dmb_mesh_follows_hole(mesh, string);
    double at = dmb_mesh_string_def(mesh, string)->start_depth;
    int32_t status = DMB_OK;
    while (status >= 0 && dmb_pipe_iterator_next(&pipes)) {
        const dmb_pipe_map *pipe = dmb_mesh_pipe_at(mesh, map->first_pipe + pipes.number);
        const double length = pipes.run->def.length;
        if (!follows) at = dmb_mesh_node_at(mesh, pipe->node)->depth;
        status = check_pipe(mesh, string, &pipes.run->def, at, follows ? at + length : at);
        at += length;
    }
    return status;
}

static double depth_of(const dmb_mesh *mesh, uint32_t map_index)
{
    const dmb_body_map *map = DMB_VECTOR_AT(dmb_body_map, &mesh->bodies, map_index);
    return dmb_mesh_node_at(mesh, map->node)->depth + map->arm;
}

int32_t dmb_mesh_fits(dmb_mesh *mesh)
{
    const dmb_model *model = mesh->model;
    dmb_message part;
    int32_t status;
    if (model->wall_count == 0 || model->wall.normal_law == DMB_NORMAL_NONE) return DMB_OK;
    for (uint32_t s = 0; s < mesh->strings.count; s++) {
        status = check_string(mesh, s);
        if (status < 0) return status;
    }
    for (uint32_t i = 0; i < model->bodies.count; i++) {
        const double depth = depth_of(mesh, i);
        status = check_fits(mesh, dmb_model_part_text(model, DMB_PART_BODY, i, &part), "contact_diameter",
                            DMB_LIST_AT(const dmb_body_def, model->bodies, i)->contact_diameter, depth, depth);
        if (status < 0) return status;
    }
    for (uint32_t i = 0; i < model->bits.count; i++) {
        const dmb_bit_def *bit = DMB_LIST_AT(const dmb_bit_def, model->bits, i);
        const double depth = depth_of(mesh, model->bodies.count + i) + 0.5 * bit->length;
        status = check_fits_cut(mesh, dmb_model_part_text(model, DMB_PART_BIT, i, &part), "diameter", bit->diameter,
                                depth, dmb_mesh_bit_cuts(mesh, i));
        if (status < 0) return status;
    }
    for (uint32_t i = 0; i < model->rings.count; i++) {
        const double depth = depth_of(mesh, model->bodies.count + model->bits.count + i);
        status = check_fits_cut(mesh, dmb_model_part_text(model, DMB_PART_STABILISER, i, &part), "outer_diameter",
                                DMB_LIST_AT(const dmb_stabiliser_def, model->rings, i)->outer_diameter, depth,
                                dmb_mesh_ring_cuts(mesh, i));
        if (status < 0) return status;
    }
    return DMB_OK;
}
