// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/passes.h"

#include "engine/cloud/sphere_passes.h"
#include "shaders/classify.h"
#include "shaders/estimate.h"
#include "shaders/list.h"
#include "shaders/moments.h"
#include "shaders/occlusion.h"
#include "shaders/shared/constants.h"
#include "shaders/surface.h"
#include "shaders/thin.h"
#include "shaders/tree.h"

#include <algorithm>
#include <cstddef>

namespace fathom::cloud {

namespace {

using namespace shared;
using Up = UploadBuffers;
using Work = WorkBuffers;
using Set = SetBuffers;

static_assert(offsetof(FrameCounters, subs) == kArgumentWords * sizeof(uint32_t));

constexpr VkFormat kFourDepths = VK_FORMAT_R16G16B16A16_UINT;

Groups groupsFor(uint64_t invocations, uint32_t groupSize) {
    return {static_cast<uint32_t>((invocations + groupSize - 1) / groupSize), 1, 1};
}

PassInfo occlusion(const CloudContext& c) {
    PassInfo pass{"occlusion",
                  occlusion_spv,
                  {&Up::params, {&Up::depth, kDepthTexels}, &Work::rays, &Work::nearest},
                  {{kSpecGroupSize, c.plan.pixelGroup},
                   {kSpecRays, c.plan.rays},
                   {kSpecLens, lensModelOf(c.camera.colour)}},
                  groupsFor(c.camera.depth.pixels(), c.plan.pixelGroup)};
    pass.filled = &Work::nearest;
    pass.fill = 0xffffffffu;
    return pass;
}

static_assert(static_cast<uint32_t>(ColourFormat::Rgba) == kFormatRgba &&
              static_cast<uint32_t>(ColourFormat::Uyvy) == kFormatUyvy &&
              static_cast<uint32_t>(ColourFormat::Bgr) == kFormatBgr &&
              static_cast<uint32_t>(ColourFormat::JpegPlanes) == kFormatJpegPlanes);

// Texels of the colour image. four: of four pixels, if the format has words.
VkFormat colourTexels(ColourFormat format, bool four) {
    switch (format) {
    case ColourFormat::Rgba:
        return four ? VK_FORMAT_R32G32B32A32_UINT : kColourTexels;
    case ColourFormat::Yuyv:
    case ColourFormat::Uyvy:
        return four ? VK_FORMAT_R32G32_UINT : kColourTexels;
    default:
        return VK_FORMAT_R32_UINT;
    }
}

PassInfo classify(const CloudContext& c) {
    const Plan& plan = c.plan;
    const uint32_t colour = !plan.colour ? kColourNone : plan.occlusion ? kColourLookedUp : kColourRegistered;
    const uint32_t four = c.camera.depth.width % 4 != 0 ? kFourNone
                          : colour == kColourRegistered ? kFourDepthAndColour
                                                        : kFourDepth;
    // A patch takes 64 invocations of four pixels in one row, or 16 of four pixels in four rows. A wide group
    // covers four patches.
    const uint32_t rows = plan.byPixel ? 1u : 4u, invocations = plan.byPixel ? 256u : 16u;
    const uint32_t group = std::min(invocations, plan.pixelGroup);
    return {"classify",
            classify_spv,
            {&Up::params,
             {&Up::depth, four != kFourNone ? kFourDepths : kDepthTexels},
             &Work::rays,
             {&Up::colour, colourTexels(c.camera.colourFormat, four == kFourDepthAndColour)},
             &Work::nearest,
             &Work::masks,
             &Work::listed,
             &Work::list,
             &Work::counters,
             &Work::memoryCounts,
             &Up::arm,
             &Work::depth},
            {{kSpecGroupSize, group},
             {kSpecRays, plan.rays},
             {kSpecColour, colour},
             {kSpecLens, lensModelOf(c.camera.colour)},
             {kSpecHold, plan.hold},
             {kSpecSubPatchGroup, plan.subPatchGroup},
             {kSpecClasses, plan.classes},
             {kSpecBox, plan.box},
             {kSpecFour, four},
             {kSpecRange, plan.range},
             {kSpecSelfFilter, plan.selfFilter},
             {kSpecWater, plan.water},
             {kSpecRows, rows},
             {kSpecWide, plan.byPixel},
             {kSpecKeep, plan.keepDepth},
             {kSpecGuidance, plan.moments},
             {kSpecLists, !plan.lists()},
             {kSpecFormat, static_cast<uint32_t>(c.camera.colourFormat)}},
            Groups{plan.byPixel ? (c.layout.across + 3) / 4 : c.layout.across, c.layout.down,
                   invocations / group},
            plan.lists() ? After::Barrier : After::IndirectBarrier};
}

PassInfo list(const CloudContext& c) {
    return {"list",
            list_spv,
            {&Up::params, &Work::listed, &Work::memoryCounts, &Work::list, &Work::counters},
            {{kSpecGroupSize, c.plan.subPatchGroup},
             {kSpecHold, c.plan.hold},
             {kSpecGuidance, c.plan.moments},
             {kSpecSubPatchGroup, c.plan.subPatchGroup}},
            groupsFor(c.layout.patches(), c.plan.subPatchGroup),
            After::IndirectBarrier};
}

PassInfo surface(const CloudContext& c) {
    const Plan& plan = c.plan;
    const bool four = plan.filterBlock && c.camera.depth.width % 4 == 0;
    // A patch has 16 sub-patches, 32 pairs of their rows. Pairs of pixels use smaller groups, so that more of
    // them run at once.
    const uint32_t group = plan.filterBlock ? (plan.filterRadius > 2 ? 32u : 16u)
                                            : std::min(plan.pixelGroup, plan.filterPairs() ? 64u : 256u);
    const uint32_t weights = plan.polynomialWeights ? kWeightsPolynomial
                             : plan.quarticWeights  ? kWeightsQuartic
                                                    : kWeightsExponential;
    return {"surface",
            surface_spv,
            {&Up::params,
             depthOf(plan, four ? kFourDepths : kDepthTexels),
             &Work::rays,
             {&Work::masks, kMaskTexels},
             &Work::list,
             &Work::points},
            {{kSpecGroupSize, group},
             {kSpecRays, plan.rays},
             {kSpecRadius, plan.filterRadius},
             {kSpecEdge, plan.edge},
             {kSpecIsolation, plan.isolation},
             {kSpecTiled, plan.tiled && !plan.filterBlock},
             {kSpecBlock, plan.filterBlock},
             {kSpecFour, four},
             {kSpecWeights, weights},
             {kSpecPair, plan.filterPairs()}},
            GroupsCounted{offsetof(FrameCounters, patchGroups)}};
}

PassInfo estimate(const CloudContext& c) {
    const bool four = c.camera.depth.width % 4 == 0;
    return {"estimate",
            estimate_spv,
            {&Up::params,
             depthOf(c.plan, four ? kFourDepths : kDepthTexels),
             &Work::rays,
             &Work::masks,
             &Work::list,
             &Work::points,
             {&Work::estimates, VK_FORMAT_R32G32B32A32_UINT},
             &Work::estimates},
            {{kSpecGroupSize, std::min(c.plan.pixelGroup, 64u)},
             {kSpecRays, c.plan.rays},
             {kSpecFour, four},
             {kSpecMoves, !c.camera.poseless},
             {kSpecLens, lensModelOf(c.camera.depth)}},
            GroupsCounted{offsetof(FrameCounters, patchGroups)}};
}

PassInfo thin(const CloudContext& c) {
    return {"thin",
            thin_spv,
            {&Up::params,
             {&Work::masks, kMaskTexels},
             {&Work::points, kVec4Texels},
             &Work::listed,
             &Work::list,
             &Work::counters,
             &Work::growth},
            {{kSpecGroupSize, c.plan.subPatchGroup}, {kSpecClasses, c.plan.classes}},
            GroupsCounted{offsetof(FrameCounters, subPatchGroups)}};
}

PassInfo moments(const CloudContext& c) {
    // Without shared memory: one invocation per patch; `guidedGroups` counts groups of subPatchGroup / 16
    // patches.
    const uint32_t group = c.plan.byPixel ? 16u : std::max(8u, c.plan.subPatchGroup / 16u);
    return {"moments",
            moments_spv,
            {&Up::params,
             {&Work::masks, kMaskTexels},
             {&Work::points, kVec4Texels},
             &Work::list,
             &Set::moments,
             &Work::counters},
            {{kSpecGroupSize, group}, {kSpecShared, c.plan.byPixel}},
            GroupsCounted{offsetof(FrameCounters, guidedGroups)},
            c.plan.spheres ? After::Nothing : After::Barrier}; // `spheres` does not read its results
}

PassInfo tree(const CloudContext& c) {
    const uint32_t group = c.plan.subPatchGroup;
    return {"tree",
            tree_spv,
            {&Work::listed,
             &Set::nodes,
             &Set::nodeCounts,
             {&Set::nodes, kVec4Texels},
             {&Set::nodeCounts, VK_FORMAT_R32G32B32A32_UINT}},
            {{kSpecGroupSize, group}},
            groupsFor(c.layout.patches(), group),
            After::Barrier,
            treeParams(c.layout)};
}

} // namespace

shared::TreeParams treeParams(const PatchLayout& layout) {
    return {layout.patches(), layout.levels[1].first};
}

std::vector<PassInfo> framePasses(const CloudContext& c) {
    std::vector<PassInfo> passes;
    const auto add = [&](bool in, PassInfo (*describe)(const CloudContext&)) {
        if (in) {
            passes.push_back(describe(c));
        }
    };
    add(c.plan.occlusion, occlusion);
    add(c.plan.passes, classify);
    add(c.plan.lists(), list);
    add(c.plan.passes, surface);
    add(c.plan.estimates, estimate);
    add(c.plan.thins(), thin);
    add(c.plan.moments, moments);
    if (c.plan.spheres) {
        std::ranges::move(spherePasses(c), std::back_inserter(passes));
    }
    add(c.plan.tree && !c.plan.byPixel, tree);
    return passes;
}

} // namespace fathom::cloud
