/* libdrillmbd - rigid-flexible multibody dynamics of drilling rigs: describe - compile - run - ask - analyse. */
#ifndef DRILLMBD_DRILLMBD_H
#define DRILLMBD_DRILLMBD_H

#include "analyse.h"
#include "ask.h"
#include "base.h"
#include "run.h"
#include "scene.h"

#endif
