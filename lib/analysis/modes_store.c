/* Memory of the modes that were found. */
#include <string.h>

#include "analysis/modes.h"
#include "base/allocator.h"
#include "base/handle.h"

static size_t bytes_of(const dmb_modes *modes, uint32_t capacity, int32_t with_im)
{
    return ((size_t)capacity * 3 + (size_t)capacity * modes->rows * (with_im ? 2 : 1)) * sizeof(double) + capacity;
}

static void place(dmb_modes *modes, void *block, uint32_t capacity, int32_t with_im)
{
    modes->s = block;
    modes->re = modes->s + 2 * (size_t)capacity;
    modes->im = with_im ? modes->re + (size_t)capacity * modes->rows : NULL;
    modes->whirl = modes->re + (size_t)capacity * modes->rows * (with_im ? 2 : 1);
    modes->rigid = (uint8_t *)(modes->whirl + capacity);
    modes->capacity = capacity;
}

int32_t dmb_modes_reserve(dmb_modes *modes, uint32_t capacity, int32_t with_im)
{
    const dmb_modes old = *modes;
    const size_t part = (size_t)old.count * old.rows * sizeof(double);
    void *block = dmb_allocate(&modes->allocator, bytes_of(modes, capacity, with_im));
    if (block == NULL) return DMB_ERR_NO_MEMORY;
    place(modes, block, capacity, with_im);
    if (old.s == NULL) return DMB_OK;
    memcpy(modes->s, old.s, 2 * (size_t)old.count * sizeof(double));
    memcpy(modes->re, old.re, part);
    if (old.im != NULL && modes->im != NULL) memcpy(modes->im, old.im, part);
    memcpy(modes->whirl, old.whirl, old.count * sizeof(double));
    memcpy(modes->rigid, old.rigid, old.count);
    dmb_release(&modes->allocator, old.s, bytes_of(&old, old.capacity, old.im != NULL));
    return DMB_OK;
}

void dmb_modes_destroy(dmb_modes **modes)
{
    if (modes == NULL || *modes == NULL) return;
    dmb_modes *m = *modes;
    *modes = NULL;
    if (!dmb_handle_is(m, DMB_HANDLE_MODES)) return;
    const dmb_allocator allocator = m->allocator;
    dmb_model *model = m->state != NULL ? m->state->model : NULL;
    m->magic = DMB_HANDLE_DEAD;
    if (m->s != NULL) dmb_release(&allocator, m->s, bytes_of(m, m->capacity, m->im != NULL));
    dmb_state_discard(m->state);
    if (model != NULL) dmb_model_release(model);
    dmb_release(&allocator, m, sizeof *m);
}

int32_t dmb_modes_open(const dmb_sim *sim, dmb_modes **modes)
{
    dmb_modes *m = dmb_allocate(&sim->allocator, sizeof *m);
    if (m == NULL) return DMB_ERR_NO_MEMORY;
    m->magic = DMB_HANDLE_MODES;
    m->allocator = sim->allocator;
    m->rows = sim->scene->row_count;
    m->state = dmb_state_copy(sim);
    if (m->state != NULL) {
        m->state->magic = DMB_HANDLE_SIM; /* queries look through it */
        m->state->progress = &m->state->own_progress; /* it may outlive the sim */
        dmb_model_hold(m->state->model);
    }
    *modes = m;
    return m->state != NULL ? DMB_OK : DMB_ERR_NO_MEMORY;
}
