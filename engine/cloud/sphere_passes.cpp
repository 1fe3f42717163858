// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/sphere_passes.h"

#include "shaders/shared/constants.h"
#include "shaders/spheres.h"
#include "shaders/spheres_by_patch.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

namespace {

using namespace shared;
using Up = UploadBuffers;
using Work = WorkBuffers;
using Set = SetBuffers;

// Bindings and constants that both forms of `spheres` share (shaders/lib/spheres.glsl).
PassInfo spheresOf(const CloudContext& c, std::span<const uint32_t> spirv, size_t counted) {
    const Plan& plan = c.plan;
    return {"spheres",
            spirv,
            {&Up::params,
             depthOf(plan, kDepthTexels),
             {&Work::masks, kMaskTexels},
             {&Work::points, kVec4Texels},
             &Work::listed,
             &Work::list,
             &Work::counters,
             &Work::seen,
             &Work::kept,
             &Work::keptTime,
             &Work::memoryCounts,
             &Set::spheres,
             &Set::held,
             &Work::classes,
             &Set::bits,
             &Set::nodes,
             &Set::nodeCounts,
             &Work::radii,
             &Work::heldRadii},
            {{kSpecThin, plan.thin},
             {kSpecLeaks, plan.leaks},
             {kSpecClasses, plan.classes},
             {kSpecFan, plan.fan},
             {kSpecBeam, plan.beam},
             {kSpecLens, lensModelOf(c.camera.depth)},
             {kSpecTree, plan.tree}},
            GroupsCounted{counted}};
}

PassInfo spheresByPatch(const CloudContext& c) {
    PassInfo pass = spheresOf(c, spheres_by_patch_spv, offsetof(FrameCounters, patchGroups));
    pass.bindings.insert(pass.bindings.end(),
                         {&Set::packed, &Set::places, &Set::runs, &Work::growth, &Set::classes});
    // Smaller groups wait less at barriers; larger ones finish a patch sooner.
    const uint32_t group = std::min(c.plan.pixelGroup, c.plan.manyPatches ? 128u : 256u);
    pass.constants.insert(pass.constants.end(),
                          {{kSpecGroupSize, group}, {kSpecHold, c.plan.hold}, {kSpecPack, c.plan.pack}});
    return pass;
}

// hold: kHold... of shaders/shared/constants.h.
PassInfo spheresBySub(const CloudContext& c, uint32_t hold, size_t counted) {
    PassInfo pass = spheresOf(c, spheres_spv, counted);
    pass.bindings.insert(pass.bindings.end(), {{&Work::growth, kVec4Texels},
                                               {&Work::seen, kVec4Texels},
                                               {&Work::kept, kVec4Texels},
                                               {&Work::keptTime, VK_FORMAT_R32_UINT},
                                               &Set::classes});
    pass.constants.insert(
        pass.constants.end(),
        {{kSpecGroupSize, c.plan.subPatchGroup}, {kSpecHold, hold}, {kSpecTexels, c.plan.memoryTexels}});
    return pass;
}

} // namespace

std::vector<PassInfo> spherePasses(const CloudContext& c) {
    if (c.plan.byPixel) {
        return {spheresByPatch(c)};
    }
    if (!c.plan.hold) {
        return {spheresBySub(c, kHoldNone, offsetof(FrameCounters, subPatchGroups))};
    }
    PassInfo withoutHeld = spheresBySub(c, kHoldWithoutPoints, offsetof(FrameCounters, withoutHeldGroups));
    withoutHeld.filled = &Work::memoryCounts; // `classify` has read it; both dispatches count again
    return {withoutHeld, spheresBySub(c, kHoldWithPoints, offsetof(FrameCounters, withHeldGroups))};
}

} // namespace fathom::cloud
