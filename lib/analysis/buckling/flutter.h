/* Growth of damped modes on the way along the equilibria. Where K is unsymmetric, a state loses its stability before
 * det K passes 0 when a complex pair of roots of  det(s^2 M + s C + K) = 0  crosses the imaginary axis: flutter
 * (Ziegler 1952). The eigenvalues of K alone do not tell: at which load a complex pair of them becomes real and
 * negative depends on the weights that they are measured by, and nothing happens to the motion there. So the damped
 * modes are found at the points of the path, and where one grows the factor is closed in between the last point at
 * which none did and this one. */
#ifndef DMB_ANALYSIS_BUCKLING_FLUTTER_H
#define DMB_ANALYSIS_BUCKLING_FLUTTER_H

#include "analysis/buckling/path.h"
#include "drillmbd/analysis.h"

typedef struct dmb_flutter {
    const dmb_load_pattern *pattern;
    dmb_buckling_info *info; /* flutter, growth, ... are told here */
    dmb_sim *state;          /* the state that is judged; NULL before the first one */
    dmb_message message;     /* of modes that could not be found */
    double growth;           /* [1/s] of the state judged last */
    int32_t off;             /* 1: not to be looked for */
    int32_t failed;          /* 1: modes of some state could not be found */
} dmb_flutter;

/* 1 where growth is looked for: nothing has grown so far. */
int dmb_flutter_goes_on(const dmb_flutter *flutter);
/* The state that the path begins in. An error is a matter of memory, or cancelled; a state whose
 * modes cannot be found is passed by, and message tells why. Here and in the following. */
int32_t dmb_flutter_begin(dmb_flutter *flutter, const dmb_path *path);
/* The way from the last point to the one `arc` beyond, which is judged; the next point of the path is gone then. Errors
 * of dmb_path_correct too. */
int32_t dmb_flutter_look(dmb_flutter *flutter, dmb_path *path, double arc);
/* A pose that the loads do not move, from the factor 0 to `to`: in equal parts. */
int32_t dmb_flutter_of_pose(dmb_flutter *flutter, dmb_sim *at, double to);
/* At the end of the way: nothing found where some state was passed by is not judged. */
void dmb_flutter_conclude(dmb_flutter *flutter);
void dmb_flutter_close(dmb_flutter *flutter);

#endif
