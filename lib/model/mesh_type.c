/* Types of elements, their kernels, and batches of neighbours with one kernel. */
#include "model/beam_element.h"
#include "model/mesh.h"

/* Equal elements are mostly near each other: a run of pipes has four types at most. */
enum { RECENT_TYPES = 8, NUMBERS = sizeof(dmb_element_type) / sizeof(double) };

/* A type holds nothing but numbers. */
static bool same_type(const dmb_element_type *a, const dmb_element_type *b)
{
    return dmb_same_numbers((const double *)(const void *)a, (const double *)(const void *)b, NUMBERS);
}

/* Index of an equal type among the latest, or of a new one. */
static int32_t share_type(dmb_mesh *mesh, const dmb_element_type *type, uint32_t *index)
{
    const size_t count = mesh->types.count;
    for (size_t i = count; i > 0 && i + RECENT_TYPES > count; --i) {
        if (!same_type(DMB_VECTOR_AT(const dmb_element_type, &mesh->types, i - 1), type)) continue;
        *index = (uint32_t)(i - 1);
        return DMB_OK;
    }
    *index = (uint32_t)count;
    return dmb_vector_append(&mesh->types, &mesh->model->allocator, type, 1);
}

static bool alike(const dmb_mesh_element *a, const dmb_mesh_element *b)
{
    return a->run == b->run && dmb_same_numbers(a->arm, b->arm, 2);
}

static int32_t find_type(dmb_mesh *mesh, dmb_mesh_element *element, const dmb_mesh_element *before)
{
    const dmb_pipe_def *def = &dmb_mesh_run_at(mesh, element->run)->def;
    dmb_element_type type;
    if (before != NULL && alike(element, before)) {
        element->type = before->type;
        return DMB_OK;
    }
    const double damping_time = mesh->features & DMB_FEATURE_DAMPING ? def->damping_time : 0.0;
    dmb_element_type_of(def, element->arm, damping_time, &type);
    type.weight_mass = dmb_buoyancy_factor(def, mesh->model->environment.fluid_density) * type.mass_per_metre * type.length;
    return share_type(mesh, &type, &element->type);
}

static int32_t kernel_of(const dmb_mesh *mesh, const dmb_mesh_element *element)
{
    const bool a = dmb_mesh_node_at(mesh, element->node)->size == DMB_NODE_FULL;
    const bool b = dmb_mesh_node_at(mesh, element->node + 1)->size == DMB_NODE_FULL;
    if (a && b) return DMB_KERNEL_BEAM;
    return a || b ? DMB_KERNEL_MIXED : DMB_KERNEL_PATH;
}

/* A batch ends where the kernel changes or the chain ends. */
static int32_t add_to_batch(dmb_mesh *mesh, uint32_t e)
{
    const dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
    if (e > 0 && element[-1].kernel == element->kernel && element[-1].node + 1 == element->node) {
        ++DMB_VECTOR_AT(dmb_batch, &mesh->batches, mesh->batches.count - 1)->count;
        return DMB_OK;
    }
    const dmb_batch batch = {e, 1, element->kernel, 0};
    return dmb_vector_append(&mesh->batches, &mesh->model->allocator, &batch, 1);
}

int32_t dmb_mesh_types(dmb_mesh *mesh)
{
    int32_t status = DMB_OK;
    for (uint32_t e = 0; e < mesh->elements.count && status >= 0; ++e) {
        dmb_mesh_element *element = dmb_mesh_element_at(mesh, e);
        element->kernel = kernel_of(mesh, element);
        status = find_type(mesh, element, e > 0 ? element - 1 : NULL);
        if (status >= 0) status = add_to_batch(mesh, e);
    }
    return status;
}
