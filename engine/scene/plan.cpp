// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/plan.h"

#include "engine/scene/camera_limits.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr uint32_t kMaxWidth = 3840, kMaxHeight = 2160;
constexpr uint32_t kManyPatches = 6000; // measured on an H100; 1280x720 has 3600 patches, 1920x1080 has 8160
constexpr uint32_t kManyProcessors = 8, kMostPublishers = 12;
constexpr uint32_t kOtherThreads = 4;    // haptic, contact, writer or window, and one for the system
constexpr uint64_t kSmallestPage = 4096; // [bytes] on any host: camera memory consists of whole pages

bool mayLeak(const Scene& scene, const Intrinsics& lens) {
    return std::any_of(scene.fixtures.begin(), scene.fixtures.end(), [&](const FixtureClass& f) {
        return f.isPoints() && f.role == Role::Forbidden &&
               scene.farZ >= leaksFrom(lens, f.radius + 3.0 * scene.registrationSigma);
    });
}

// Shared memory of surface.comp: the points of a patch and of the filter window around it.
uint64_t bytesOfTile(uint32_t radius) {
    const uint64_t edge = 16 + 2 * radius;
    return 3 * sizeof(float) * edge * edge;
}

// Why depths cannot be averaged over frames; null when they can.
const char* whyNoEstimates(const Scene& scene, const CameraInfo& camera) {
    return !scene.hasPoints()                       ? "the scene has no point class"
           : scene.filter.memory == 0               ? "filter.memory is 0"
           : camera.beam || camera.depth.fan        ? "not for sensors that measure along beams"
           : camera.poseless && !scene.cameraStatic ? "frames have no poses, and camera.static is not set"
                                                    : nullptr;
}

// Sets the parts of the plan that depend on the scene and the camera.
void decideByScene(const Scene& scene, const CameraInfo& camera, Plan& plan) {
    plan.spheres = scene.hasForbiddenPoints();
    plan.arm = scene.arm.has_value();
    plan.selfFilter = plan.arm && scene.arm->selfFilter && scene.hasPoints();
    plan.moments = scene.hasGuidance();
    plan.cloud = scene.hasPoints();
    plan.colour = plan.cloud && scene.usesColour() && camera.hasColour;
    plan.yuyv = plan.colour && camera.yuyv;
    plan.water = plan.colour && scene.attenuation;
    plan.occlusion = plan.colour && !camera.registered;
    plan.beam = plan.spheres && camera.beam.has_value();
    plan.thin = plan.spheres && scene.errorBudget > 0.0 &&
                !plan.beam; // the proof of thinning needs one radius per class
    plan.hold = plan.spheres && scene.holdSeconds > 0.0;
    plan.leaks = plan.spheres && mayLeak(scene, camera.depth);
    for (const FixtureClass& f : scene.fixtures) {
        plan.classes += f.isPoints() ? 1 : 0;
        plan.box = plan.box || (f.isPoints() && f.box);
        plan.range = plan.range || (f.isPoints() && f.range);
        plan.guidancePoints = plan.guidancePoints ||
                              (f.isPoints() && f.role == Role::Guidance && (f.largestPart || f.trim > 0.0));
    }
    plan.rays = plan.cloud && !camera.depth.pinhole();
    plan.fan = plan.cloud && camera.depth.fan;
    plan.filterRadius = scene.filter.radius;
    plan.edge = scene.filter.edge > 0.0;
    plan.estimates = plan.cloud && whyNoEstimates(scene, camera) == nullptr;
    plan.polynomialWeights = scene.filter.weights == Scene::Filter::Weights::Polynomial;
}

// How the passes that a scene needs are laid out.
void decideByDevice(const CameraInfo& camera, const DeviceFacts& device, Plan& plan) {
    const bool cpu = device.kind == DeviceKind::Cpu;
    plan.inPlace =
        plan.cloud && device.hostPointerAlignment > 0 && device.hostPointerAlignment <= kSmallestPage;
    plan.memoryTexels = plan.hold && cpu;
    plan.pack = plan.spheres && !cpu; // a CPU device has no bus to cross, and packing takes 2 ms
    plan.keepDepth = plan.cloud && !cpu && camera.depth.width % 4 == 0;
    while (plan.pixelGroup > device.maxInvocations) {
        plan.pixelGroup /= 2;
    }
    // On GPUs publishers spin while the device works, so other threads need processors of their own. A CPU
    // device has finished by then.
    if (plan.spheres && cpu) {
        plan.publishers = std::min(kMostPublishers, device.hostProcessors);
    } else if (plan.spheres && device.hostProcessors >= kManyProcessors) {
        plan.publishers = std::min(kMostPublishers, device.hostProcessors - kOtherThreads);
    }
    // Measured: on a CPU device shared-memory tiles are 2-4 times slower than direct reads.
    plan.tiled = !cpu && plan.filterRadius >= 2 && bytesOfTile(plan.filterRadius) <= device.maxSharedBytes;
    plan.groupCounts = !cpu; // on a CPU device a barrier costs more than the counts
    plan.byPixel = !cpu;     // on a CPU device shared memory took twice as long
    plan.manyPatches =
        plan.byPixel && patchLayout(camera.depth.width, camera.depth.height).patches() >= kManyPatches;
    // On a CPU device a load is a gather, lane by lane, so neighbouring pixels share their loads.
    plan.filterBlock = cpu && plan.filterRadius <= 2;
}

void decideQuery(const Scene& scene, uint32_t toolLeaves, const DeviceFacts& device, Plan& plan) {
    if (plan.spheres) {
        const bool gpu = scene.contact.where == Scene::Contact::Where::Gpu ||
                         (scene.contact.where == Scene::Contact::Where::Auto &&
                          device.kind != DeviceKind::Cpu && toolLeaves >= device.gpuQueryLeaves);
        plan.query = gpu ? Plan::Query::Gpu : Plan::Query::Cpu;
    }
    plan.tree = plan.query == Plan::Query::Gpu;
}

// Decides the switches. The items that explain them depend only on these.
Plan decide(const Scene& scene, const CameraInfo& camera, uint32_t toolLeaves, const DeviceFacts& device) {
    Plan plan;
    decideByScene(scene, camera, plan);
    decideByDevice(camera, device, plan);
    decideQuery(scene, toolLeaves, device, plan);
    return plan;
}

std::string budgetSentence(const Plan& plan, const Scene& scene) {
    return "error budget " + std::to_string(scene.errorBudget * 1e3) + " mm" +
           (plan.byPixel ? ", within the pass spheres" : "");
}

const char* noBudgetSentence(const Plan& plan) {
    return plan.beam      ? "each point's sphere has its own radius"
           : plan.spheres ? "error budget 0 keeps every point"
                          : "no forbidden point class";
}

void explainPasses(Plan& plan, const Scene& scene, const CameraInfo& camera) {
    const auto pass = [&](const char* name, bool in, std::string yes, std::string no) {
        plan.items.push_back({"pass", name, in, in ? std::move(yes) : std::move(no), 0});
    };
    pass("occlusion", plan.occlusion,
         "colour is not registered to depth: parallax hides points from the colour camera",
         !scene.usesColour() ? "no class uses colour" : "colour is registered to depth");
    pass("classify", plan.cloud,
         std::string("the scene has point classes") +
             (plan.water ? ", colours corrected for water before the gates" : ""),
         "the scene has no point class");
    pass("list", plan.lists(), "lists patches with work, and those with points or guidance",
         plan.cloud ? "classify writes the list" : "the scene has no point class");
    pass("surface", plan.cloud,
         plan.filterRadius != 0 ? "bilateral filter " + std::to_string(2 * plan.filterRadius + 1) + "x" +
                                      std::to_string(2 * plan.filterRadius + 1) +
                                      (plan.filterBlock     ? ", 4x4 blocks from registers"
                                       : plan.filterPairs() ? ", shared-memory tiles, two pixels at a time"
                                       : plan.tiled         ? ", shared-memory tiles"
                                                            : ", direct reads") +
                                      (plan.polynomialWeights ? ", polynomial weights" : "")
                                : "no filter: points as measured",
         "the scene has no point class");
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
    pass("tree", plan.tree, "bounds up to one root for the query",
         plan.spheres ? "the CPU query uses a grid" : "no forbidden point class");
    pass("moments", plan.moments, "mean and covariance of the guidance classes", "no guidance class");
    pass("deliver", plan.cloud, "sends patch counters and marks to the host and clears them",
         "the scene has no point class");
    pass("tree_query", plan.query == Plan::Query::Gpu, "contact query on the GPU",
         plan.query == Plan::Query::Cpu ? "contact query on the CPU" : "no contact constraints");
}

void explainBuffer(Plan& plan, const char* name, bool in, uint64_t bytes, std::string why) {
    plan.items.push_back({"buffer", name, in, std::move(why), in ? bytes : 0});
}

void explainImages(Plan& plan, const CameraInfo& camera) {
    const uint64_t pixels = camera.depth.pixels();
    const char* copies = plan.inPlace
                             ? "double-buffered, for frames that are not in whole pages of host memory"
                             : "double-buffered";
    explainBuffer(plan, "depth upload", plan.cloud, 2 * 2 * pixels, copies);
    explainBuffer(plan, "colour upload", plan.colour, 2 * camera.colourBytes(),
                  !plan.colour ? "no class uses colour"
                  : plan.yuyv  ? std::string(copies) + "; YUYV, unconverted"
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
    explainBuffer(plan, "masks and points", plan.cloud, 17 * slots, "class bits and base-frame points");
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
    explainBuffer(plan, "tree nodes", plan.tree, 20ull * layout.nodes(),
                  plan.tree ? "of one fixture set" : "no query traverses a tree");
    explainBuffer(plan, "moments", plan.moments, 64ull * 8 * layout.patches(), "of one fixture set");
}

} // namespace

// Points are z (rho, 1), rho of neighbours at most 1 / f apart. With a the distance of two, |dz| <= 0.7 a:
// sqrt(1 - 0.7^2) a <= |z rho - z' rho'| <= z / f + |rho'| 0.7 a.
double leaksFrom(const Intrinsics& lens, double radius) noexcept {
    const auto reach = [](double centre, uint32_t size, double f) {
        return std::max(centre, size - centre) / f;
    };
    const double widest =
        std::hypot(reach(lens.cx, lens.width, lens.fx), reach(lens.cy, lens.height, lens.fy));
    const double left = 0.71 - 0.7 * widest;
    return !lens.pinhole() || left <= 0.0 ? 0.0 : 0.999 * radius * left * std::min(lens.fx, lens.fy);
}

PatchLayout patchLayout(uint32_t width, uint32_t height) {
    if (width == 0 || height == 0 || width > kMaxWidth || height > kMaxHeight) {
        throw BadInput("camera", "image size", std::to_string(width) + "x" + std::to_string(height),
                       "1x1 to 3840x2160");
    }
    PatchLayout layout;
    layout.across = (width + 15) / 16;
    layout.down = (height + 15) / 16;
    layout.levels.push_back({layout.across * 4, layout.down * 4, 0});
    layout.levels.push_back({layout.across, layout.down, layout.patches() * 16});
    while (layout.levels.back().across * layout.levels.back().down > 1) {
        const PatchLayout::Level below = layout.levels.back();
        layout.levels.push_back(
            {(below.across + 3) / 4, (below.down + 3) / 4, below.first + below.across * below.down});
    }
    return layout;
}

bool Plan::has(const std::string& name) const {
    return std::any_of(items.begin(), items.end(), [&](const Item& i) { return i.name == name && i.in; });
}

uint32_t Plan::dispatchesPerFrame() const {
    // classify and surface; patches that hold nothing, then those that do; the tree's patches, then all above
    // them in one group
    return (occlusion ? 1u : 0u) + (cloud ? 2u : 0u) + (delivers() ? 1u : 0u) + (lists() ? 1u : 0u) +
           (estimates ? 1u : 0u) + (thins() ? 1u : 0u) + (spheres ? (hold && lists() ? 2u : 1u) : 0u) +
           (tree ? 2u : 0u) + (moments ? 1u : 0u);
}

Plan makePlan(const Scene& scene, const CameraInfo& camera, uint32_t toolLeaves, const DeviceFacts& device) {
    if (camera.yuyv && camera.colour.width % 2 != 0) {
        throw BadInput("camera", "width of its YUYV colour", std::to_string(camera.colour.width),
                       "even, because two pixels share a word");
    }
    checkCamera(camera, "camera");
    Plan plan = decide(scene, camera, toolLeaves, device);
    explainPasses(plan, scene, camera);
    explainImages(plan, camera);
    explainResults(plan, scene, camera);
    const auto thread = [&](const char* name, bool in, const char* why) {
        plan.items.push_back({"thread", name, in, why, 0});
    };
    thread("camera", true, "frames, uploads, passes (realtime)");
    thread("contact", plan.query != Plan::Query::None,
           plan.query != Plan::Query::None ? "contact sets (realtime)" : "no contact constraints");
    thread("haptic", true, "ticks (realtime)");
    thread("publishers", plan.publishers > 1,
           plan.publishers > 1 ? "additional threads help the camera thread to publish each set"
                               : "the camera thread alone publishes each set");
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
    return plan;
}

} // namespace fathom
