// SPDX-License-Identifier: Apache-2.0
// Parameters of one contact query.
#ifndef FATHOM_SHARED_QUERY_PARAMS_H
#define FATHOM_SHARED_QUERY_PARAMS_H
#include "shaders/shared/interop.h"
FATHOM_SHARED_BEGIN

struct QueryParams {
    uvec4 size;      // patches across, down; -; largest number of results
    uvec4 levels[6]; // region tree: nodes across, down; index of the first; -
    uvec4
        region; // number of region levels; 1 = there are held points; degree and first leaf of the tool tree
    vec4 reach; // reach [m]; -; -; -
};
FATHOM_SIZE(QueryParams, 144);

FATHOM_SHARED_END
#endif
