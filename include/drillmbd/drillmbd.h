/* libdrillmbd - rigid-flexible multibody dynamics of drilling rigs: describe - compile - run - ask. */
#ifndef DRILLMBD_DRILLMBD_H
#define DRILLMBD_DRILLMBD_H

#include "analysis.h"
#include "base.h"
#include "bha.h"
#include "control.h"
#include "drilling.h"
#include "forces.h"
#include "hole.h"
#include "joints.h"
#include "model.h"
#include "modes.h"
#include "names.h"
#include "output.h"
#include "query.h"
#include "response.h"
#include "ring.h"
#include "sensitivity.h"
#include "sim.h"
#include "state_space.h"

#endif
