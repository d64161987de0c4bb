/* Programmes: the caller's terms and tables are copied into one block of the model. */
#ifndef DMB_MODEL_DESCRIBE_DRIVE_H
#define DMB_MODEL_DESCRIBE_DRIVE_H

#include "model/model.h"

/* Frees a programme's copy of terms and tables. */
void dmb_programme_release(dmb_programme *programme, const dmb_allocator *allocator);

#endif
