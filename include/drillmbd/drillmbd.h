/* libdrillmbd - rigid-flexible multibody dynamics of drilling rigs: describe - compile - run - ask. */
#ifndef DRILLMBD_DRILLMBD_H
#define DRILLMBD_DRILLMBD_H

#include "base.h"
#include "model.h"
#include "sim.h"
#include "query.h"
#include "analysis.h"
#include "modes.h"
#include "response.h"

#endif
