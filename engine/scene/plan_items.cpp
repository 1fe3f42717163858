// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/plan_items.h"

#include "engine/types/printed.h"

namespace fathom {

namespace {

std::string millimetres(double metres) {
    return printed("%.4g mm", 1e3 * metres);
}

std::string budgetSentence(const Plan& plan, const Scene& scene) {
    return "error budget " + millimetres(scene.errorBudget) +
           (plan.byPixel ? ", within the pass spheres" : "");
}

const char* noBudgetSentence(const Plan& plan) {
    return plan.beam      ? "each point's sphere has its own radius"
           : plan.spheres ? "error budget 0 keeps every point"
                          : "no forbidden point class";
}

std::string filterSentence(const Plan& plan) {
    if (plan.filterRadius == 0) {
        return plan.edge || plan.isolation ? "no filter, implausible pixels rejected"
                                           : "no filter: points as measured";
    }
    const std::string side = std::to_string(2 * plan.filterRadius + 1);
    return "bilateral filter " + side + "x" + side +
           (plan.filterBlock     ? ", 4x4 blocks from registers"
            : plan.filterPairs() ? ", shared-memory tiles, two pixels at a time"
            : plan.tiled         ? ", shared-memory tiles"
                                 : ", direct reads") +
           (plan.polynomialWeights ? ", polynomial weights" : "");
}

void explainPasses(Plan& plan, const Scene& scene, const CameraInfo& camera) {
    const auto pass = [&](const char* name, bool in, std::string yes, std::string no) {
        plan.items.push_back({"pass", name, in, in ? std::move(yes) : std::move(no), 0});
    };
    pass("occlusion", plan.occlusion,
         "colour is not registered to depth: parallax hides points from the colour camera",
         !scene.usesColour() ? "no class uses colour" : "colour is registered to depth");
    pass("classify", plan.passes,
         std::string("the scene has point classes") +
             (plan.water ? ", colours corrected for water before the gates" : ""),
         "the scene has no point class");
    pass("list", plan.lists(), "lists patches with work, and those with points or guidance",
         plan.passes ? "classify makes the lists" : "the scene has no point class");
    pass("surface", plan.passes, filterSentence(plan), "the scene has no point class");
    const char* const noEstimates = whyNoEstimates(scene, camera);
    pass("estimate", plan.estimates,
         "depths averaged over at most " + std::to_string(scene.filter.memory) + " frames" +
             (camera.poseless ? ", static camera" : ", camera poses known"),
         noEstimates != nullptr ? noEstimates : "");
    pass("thin", plan.thin, budgetSentence(plan, scene), noBudgetSentence(plan));
    pass("spheres", plan.spheres,
         std::string("forbidden classes") + (plan.beam ? ", 3 sigma of range and beam added" : "") +
             (plan.hold ? ", unseen points held" : "") +
             (plan.leaks ? ", checked for holes between points"
                         : ", near enough to exclude holes between points") +
             (plan.pack ? ", packed for transfer to the host" : ""),
         "no forbidden point class");
    pass("tree", plan.tree,
         std::string("bounds up to one root for the query") +
             (plan.byPixel ? ", within the passes spheres and deliver" : ""),
         plan.spheres ? "the CPU query uses a grid" : "no forbidden point class");
    pass("moments", plan.moments, "mean and covariance of the guidance classes", "no guidance class");
    pass("deliver", plan.passes, "sends patch counters and marks to the host and clears them",
         "the scene has no point class");
    pass("tree_query", plan.query == Plan::Query::Gpu, "contact query on the GPU",
         plan.query == Plan::Query::Cpu ? "contact query on the CPU" : "no contact constraints");
}

void explainBuffer(Plan& plan, const char* name, bool in, uint64_t bytes, std::string why) {
    plan.items.push_back({"buffer", name, in, std::move(why), in ? bytes : 0});
}

void explainImages(Plan& plan, const CameraInfo& camera) {
    const uint64_t pixels = camera.depth.pixels();
    const char* copies =
        plan.inPlace ? "for frames that are not in whole pages of host memory" : "written by the host";
    explainBuffer(plan, "depth upload", plan.passes, 2 * pixels, copies);
    explainBuffer(plan, "colour upload", plan.colour, camera.colourBytes(),
                  !plan.colour ? "no class uses colour"
                  : camera.colourFormat != ColourFormat::Rgba
                      ? std::string(copies) + "; " + nameOf(camera.colourFormat) + ", unconverted"
                      : copies);
    explainBuffer(plan, "depth on the device", plan.keepDepth, 2 * pixels,
                  plan.keepDepth ? "read across the bus once" : "passes read the upload");
    explainBuffer(plan, "rays", plan.rays, 8 * pixels,
                  plan.fan    ? "beams at equal angles"
                  : plan.rays ? "distorted lens"
                              : "no lens distortion: computed from the pixel");
    explainBuffer(plan, "rays on the host", plan.rays && plan.packsDepths(), 8 * pixels,
                  !plan.packsDepths() ? "the host receives points, not depths"
                  : plan.rays         ? "the host computes points from depths"
                                      : "no lens distortion: computed from the pixel");
}

void explainResults(Plan& plan, const Scene& scene, const CameraInfo& camera) {
    const PatchLayout layout = patchLayout(camera.depth.width, camera.depth.height);
    const uint64_t slots = layout.slots();
    explainBuffer(plan, "masks and points", plan.passes, 17 * slots, "class bits and base-frame points");
    explainBuffer(plan, "depth estimates", plan.estimates, 32 * slots,
                  plan.estimates ? "of this frame and the one before" : whyNoEstimates(scene, camera));
    explainBuffer(plan, "thinning cells", plan.thin, slots,
                  plan.thin ? "one decision per 4x4 cell" : "no thinning");
    explainBuffer(plan, "memory of points", plan.hold, 36 * slots,
                  plan.hold ? "points that can be held" : "hold_s is 0");
    const uint64_t bytesOfSlot = (plan.hold ? 32u : 16u) + (plan.classes > 1 ? 1u : 0u);
    explainBuffer(plan, "sphere slots", plan.tree, slots * bytesOfSlot,
                  plan.tree ? "of one fixture set, for the GPU query" : "no GPU query");
    explainBuffer(plan, "radii", plan.spheres && !plan.pack, slots * (plan.hold ? 8u : 4u),
                  !plan.spheres ? "no forbidden point class"
                  : plan.pack   ? "the host reads packed spheres"
                                : "the host reads them with the points");
    const bool packedClasses = plan.pack && plan.classes > 1;
    explainBuffer(plan, "classes of spheres", plan.spheres && (!plan.pack || packedClasses), slots,
                  !plan.spheres   ? "no forbidden point class"
                  : packedClasses ? "for patches with several classes"
                  : plan.pack     ? "only one class"
                                  : "the host reads them with the points");
    explainBuffer(plan, "packed spheres", plan.pack, slots * plan.packedBytes() + 72ull * layout.patches(),
                  !plan.spheres        ? "no forbidden point class"
                  : plan.packsDepths() ? "of one fixture set; one depth per seen sphere"
                  : plan.pack          ? "of one fixture set"
                                       : "the host reads radii with the points");
    explainBuffer(plan, "tree nodes", plan.tree, 20ull * layout.bounds(),
                  plan.tree ? "of one fixture set" : "no query traverses a tree");
    explainBuffer(plan, "moments", plan.moments, Plan::momentBytes(layout), "of one fixture set");
    explainBuffer(plan, "fixture sets", plan.passes, kFixtureSets * plan.setBytes(layout),
                  plan.passes ? std::to_string(kFixtureSets) + " sets, with the buffers of each; never more"
                              : "the scene has no point class");
}

void explainThreads(Plan& plan) {
    const auto thread = [&](const char* name, bool in, const char* why) {
        plan.items.push_back({"thread", name, in, why, 0});
    };
    thread("frame", true, "frames, uploads, passes (realtime)");
    thread("contact", plan.query != Plan::Query::None,
           plan.query != Plan::Query::None ? "contact sets (realtime)" : "no contact constraints");
    thread("clearance", plan.query != Plan::Query::None,
           plan.query != Plan::Query::None ? "smallest gap for logs and displays (realtime)"
                                           : "no contact constraints");
    thread("haptic", true, "ticks (realtime)");
    thread("publishers", plan.publishers > 1,
           plan.publishers > 1 ? "additional threads help the frame thread to publish each set"
                               : "the frame thread alone publishes each set");
}

void explainArm(Plan& plan) {
    const auto arm = [&](const char* name, bool in, const char* why) {
        plan.items.push_back({"arm", name, in, why, 0});
    };
    arm("joint space", plan.arm,
        plan.arm ? "joint increments are the unknowns; every link is checked against the fixtures"
                 : "no arm: the tool moves freely");
    arm("self_filter", plan.selfFilter,
        plan.selfFilter ? "in classify: removes points inside the arm's spheres"
        : plan.arm      ? "no arm.self_filter: the arm stays in the cloud"
                        : "no arm");
}

} // namespace

// Why depths cannot be averaged over frames; null when they can.
const char* whyNoEstimates(const Scene& scene, const CameraInfo& camera) {
    return !scene.hasPoints()                       ? "the scene has no point class"
           : scene.filter.memory == 0               ? "filter.memory is 0"
           : camera.beam || camera.depth.fan        ? "not for sensors that measure along beams"
           : camera.poseless && !scene.cameraStatic ? "frames have no poses, and camera.static is not set"
                                                    : nullptr;
}

void explainPlan(Plan& plan, const Scene& scene, const CameraInfo& camera) {
    explainPasses(plan, scene, camera);
    explainImages(plan, camera);
    explainResults(plan, scene, camera);
    explainThreads(plan);
    explainArm(plan);
}

} // namespace fathom
