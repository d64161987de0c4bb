/* Discretisation error of the described mesh (eq:beam.mesh-error): between two neighbouring contact points an element
 * carries its side load q as a beam clamped at both, although the wall supports a lying pipe continuously. The spurious
 * bending moment is q s^2/12, s the spacing of the contact points. */
#include <math.h>

#include "analysis/model_check/model_check.h"
#include "base/sized_struct.h"
#include "math/quadrature.h"
#include "model/model.h"

#define DMB_MESH_ERROR_ADVISED 0.01 /* [-] of the yield strength */
#define DMB_USUAL_YIELD_STRAIN 3e-3 /* [-] of drill-pipe steel of unspecified strength */

typedef struct mesh_march {
    const dmb_scene *scene;
    double axial;  /* [N] tension at the present place by the weight below it */
    uint32_t node; /* this and the further nodes of the string are contained in it */
} mesh_march;

/* ---- Tension ----------------------------------------------------------------------------------------------------- */

/* [N] Axial weight on a node, at the depth of its centre: half of each element beside it, rigid pipes, tool joints,
 * rings, bodies and bits, less buoyancy. */
static double axial_weight(const dmb_scene *scene, uint32_t node)
{
    const double mass = scene->weight_mass[node], moment = scene->weight_moment[3 * (size_t)node];
    const double arm = mass > 0.0 || mass < 0.0 ? moment / mass : 0.0;
    double x[3], t[3], bend[3];
    dmb_hole_frame(&scene->hole, scene->reference_depth[node] + arm, x, t, bend);
    return mass * dmb_vec3_dot(scene->gravity, t);
}

/* String that the node begins; DMB_NONE: none. */
static uint32_t string_from(const dmb_scene *scene, uint32_t node)
{
    for (uint32_t s = 0; s < scene->string_count; s++)
        if (scene->strings[s].node_count > 0 && scene->strings[s].first_node == node) return s;
    return DMB_NONE;
}

/* 1: the node is a free body, no part of a string. */
static int is_body(const dmb_scene *scene, uint32_t node)
{
    return scene->chains[scene->node_chain[node]].count == 1 && string_from(scene, node) == DMB_NONE;
}

/* [N] Axial weight of what joints carry at the far end of a string: bodies, and strings that begin there. */
static double hanging_weight(const dmb_scene *scene, uint32_t string)
{
    double sum = 0.0;
    uint32_t cluster = DMB_NONE;
    for (uint32_t hops = 0; scene->cluster_count > 0 && hops < scene->string_count && string != DMB_NONE; hops++) {
        const uint32_t from = string, at = scene->node_cluster[scene->strings[from].end_node];
        string = DMB_NONE;
        if (at == DMB_NONE || at == cluster) break;
        cluster = at;
        const dmb_cluster *c = scene->clusters + at;
        for (uint32_t i = 0; i < c->node_count; i++) {
            const uint32_t node = scene->cluster_nodes[c->node + i], next = string_from(scene, node);
            if (is_body(scene, node)) sum += axial_weight(scene, node);
            if (next == DMB_NONE || next == from) continue;
            const dmb_string_map *map = scene->strings + next;
            for (uint32_t k = 0; k < map->node_count; k++) sum += axial_weight(scene, map->first_node + k);
            string = next;
        }
    }
    return sum;
}

/* [m] Largest distance of neighbouring contact points of an element of this length. */
static double contact_spacing(const dmb_pipe_def *def, double length)
{
    const dmb_lobatto_rule *rule = dmb_lobatto(def->contact_points);
    double largest = 0.0;
    if (rule == NULL) return length;
    for (int i = 0; i + 1 < rule->count; i++) largest = fmax(largest, rule->node[i + 1] - rule->node[i]);
    return largest * length;
}

/* [N/m] Side load per metre on the wall at depth [m] of a pipe of `weight` [kg/m]: lateral weight and tension times
 * curvature. */
static double side_load(const mesh_march *march, double depth, double weight)
{
    const double *gravity = march->scene->gravity;
    double x[3], t[3], bend[3], load[3];
    dmb_hole_frame(&march->scene->hole, depth, x, t, bend);
    const double along = dmb_vec3_dot(gravity, t);
    for (int k = 0; k < 3; k++) load[k] = weight * (gravity[k] - along * t[k]) + march->axial * bend[k];
    return dmb_vec3_norm(load);
}

/* [-] Error of the bending stress of one element, relative to the yield strength. Its far node carries half of it, so
 * that the tension is that of its middle. */
static double element_error(mesh_march *march, const dmb_pipe_def *def, uint32_t e)
{
    const dmb_scene *scene = march->scene;
    const dmb_element_type *type = scene->types + scene->element_type[e];
    const uint32_t node = scene->element_node[e];
    const double depth = 0.5 * (scene->reference_depth[node] + scene->reference_depth[node + 1]);
    while (march->node > node + 1) march->axial += axial_weight(scene, --march->node);
    const double q = side_load(march, depth, type->weight_mass / type->length);
    const double s = contact_spacing(def, type->length);
    const double EI = fmin(type->strain_stiffness[4], type->strain_stiffness[5]);
    const double yield = def->yield_strength > 0.0 ? def->yield_strength / def->young_modulus : DMB_USUAL_YIELD_STRAIN;
    return q * s * s / 12.0 * 0.5 * def->outer_diameter / (EI * yield);
}

/* Pipes that are not flexible have no error. */
static double pipe_error(mesh_march *march, const dmb_pipe_def *def, const dmb_pipe_map *pipe)
{
    double largest = 0.0;
    if (pipe->kind != DMB_PIPE_FLEXIBLE) return 0.0;
    for (uint32_t i = pipe->elements; i-- > 0;) largest = fmax(largest, element_error(march, def, pipe->element + i));
    return largest;
}

/* Called with each pipe of a string, from the far end. */
typedef void (*pipe_visit)(void *context, const dmb_pipe_run *run, uint32_t pipe, double error);

/* Upwards from the far end, because the tension of a place is the weight below it, as of a string whose far end is free
 * and that slides without friction. */
static void visit_pipes(const dmb_model *model, uint32_t string, pipe_visit visit, void *context)
{
    const dmb_scene *scene = model->scene;
    const dmb_string_map *map = scene->strings + string;
    mesh_march march = {scene, hanging_weight(scene, string), map->first_node + map->node_count};
    for (uint32_t i = model->runs.count; i-- > 0;) {
        const dmb_pipe_run *run = DMB_LIST_AT(const dmb_pipe_run, model->runs, i);
        if (run->string != string) continue;
        for (uint32_t k = run->count; k-- > 0;) {
            const uint32_t pipe = run->first + k;
            visit(context, run, pipe, pipe_error(&march, &run->def, scene->pipes + map->first_pipe + pipe));
        }
    }
}

static int wall_is_met(const dmb_scene *scene)
{
    return scene->has_hole && (scene->features & DMB_FEATURE_CONTACT) != 0;
}

/* ---- Array ------------------------------------------------------------------------------------------------------- */

static void store(void *context, const dmb_pipe_run *run, uint32_t pipe, double error)
{
    (void)run;
    ((double *)context)[pipe] = error;
}

int32_t dmb_analysis_mesh(const dmb_model *model, dmb_id string, double *error, uint32_t capacity)
{
    if (model == NULL || error == NULL) return dmb_model_failed(model, "mesh error", DMB_ERR_NULL);
    if (!dmb_handle_is(model, DMB_HANDLE_MODEL)) return dmb_model_failed(model, "mesh error", DMB_ERR_HANDLE);
    if (model->scene == NULL) return dmb_model_failed(model, "mesh error", DMB_ERR_ORDER);
    const uint32_t index = dmb_model_part_index(model, string, DMB_PART_STRING);
    if (index == DMB_NONE) return dmb_model_failed(model, "mesh error", DMB_ERR_ID);
    const uint32_t pipes = model->scene->strings[index].pipe_count;
    if (capacity < pipes) return dmb_model_failed(model, "mesh error", DMB_ERR_VALUE);
    for (uint32_t i = 0; i < pipes; i++) error[i] = 0.0;
    if (wall_is_met(model->scene)) visit_pipes(model, index, store, error);
    return DMB_OK;
}

/* ---- Warnings ---------------------------------------------------------------------------------------------------- */

typedef struct worst_pipe {
    const dmb_pipe_run *run;
    double error;
    uint32_t pipe, count; /* the worst pipe, and the number of pipes above the bound */
} worst_pipe;

static void compare(void *context, const dmb_pipe_run *run, uint32_t pipe, double error)
{
    worst_pipe *worst = context;
    if (!(error > DMB_MESH_ERROR_ADVISED)) return;
    worst->count++;
    if (!(error > worst->error)) return;
    worst->run = run;
    worst->error = error;
    worst->pipe = pipe;
}

/* [-] Number of elements of a pipe at which the error, of second order in their length, falls to the advised one. */
static uint32_t advised(const worst_pipe *worst)
{
    const double factor = sqrt(worst->error / DMB_MESH_ERROR_ADVISED);
    return (uint32_t)ceil(fmin(DMB_PIPE_ELEMENTS_MAX, worst->run->def.elements * factor));
}

static void warn(const worst_pipe *worst, dmb_model_check_line_fn line, void *context)
{
    const dmb_pipe_def *def = &worst->run->def;
    dmb_message text, name, more;
    dmb_message_clear(&more);
    if (worst->count > 1) dmb_message_set(&more, " (and %u more)", worst->count - 1);
    dmb_message_set(
        &text,
        "%s, pipe %u%s: %u element(s) in %g m; the estimated error of its bending stress is %g %% of the yield "
        "strength, advised is at most %g %%; set elements to at least %u",
        dmb_pipes_text(&name, worst->run->string, def), worst->pipe, more.text, def->elements, def->length,
        1e-1 * round(1e3 * worst->error), 1e2 * DMB_MESH_ERROR_ADVISED, advised(worst));
    line(context, text.text);
}

void dmb_mesh_warnings(const dmb_model *model, dmb_model_check_line_fn line, void *context)
{
    if (!wall_is_met(model->scene)) return;
    for (uint32_t s = 0; s < model->scene->string_count; s++) {
        worst_pipe worst = {NULL, 0.0, 0, 0};
        visit_pipes(model, s, compare, &worst);
        if (worst.run != NULL) warn(&worst, line, context);
    }
}
