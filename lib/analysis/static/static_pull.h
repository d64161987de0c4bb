/* The pull along strings by the forces of their starting pose. */
#ifndef DMB_ANALYSIS_STATIC_PULL_H
#define DMB_ANALYSIS_STATIC_PULL_H

#include "analysis/static/static.h"

/* 1 if there is one, by the forces of the starting pose, from which the search begins anew. */
int32_t dmb_static_find_pull(dmb_static_search *search, dmb_static_pull *most);

#endif
