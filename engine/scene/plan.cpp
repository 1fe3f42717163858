// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/plan.h"

#include "engine/scene/camera_limits.h"
#include "engine/scene/plan_items.h"
#include "engine/types/decimation.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"
#include "shaders/shared/frame_params.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

constexpr uint32_t kMaxWidth = 3840, kMaxHeight = 2160;
constexpr uint32_t kManyPatches = 6000; // measured on an H100; 1280x720 has 3600 patches, 1920x1080 has 8160
constexpr uint32_t kManyProcessors = 8, kMaxPublishers = 12;
// Haptic, contact, writer or window, and one for the system and the clearance (a tenth of a CPU).
constexpr uint32_t kOtherThreads = 4;
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

// Sets the parts of the plan that depend on the scene and the camera.
void decideByScene(const Scene& scene, const CameraInfo& camera, Plan& plan) {
    plan.spheres = scene.hasForbiddenPoints();
    plan.arm = scene.arm.has_value();
    plan.selfFilter = plan.arm && scene.arm->selfFilter && scene.hasPoints();
    plan.moments = scene.hasGuidance();
    plan.passes = scene.hasPoints();
    plan.colour = plan.passes && scene.usesColour() && camera.hasColour;
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
    plan.rays = plan.passes && !camera.depth.pinhole();
    plan.fan = plan.passes && camera.depth.fan;
    plan.filterRadius = scene.filter.radius;
    plan.edge = scene.filter.edge > 0.0;
    plan.isolation = scene.filter.isolated;
    plan.estimates = plan.passes && whyNoEstimates(scene, camera) == nullptr;
    plan.polynomialWeights = scene.filter.weights == Scene::Filter::Weights::Polynomial;
}

// How the passes that a scene needs are laid out.
void decideByDevice(const CameraInfo& camera, const DeviceFacts& device, Plan& plan) {
    const bool cpu = device.kind == DeviceKind::Cpu;
    plan.onCpu = cpu;
    plan.inPlace =
        plan.passes && device.hostPointerAlignment > 0 && device.hostPointerAlignment <= kSmallestPage;
    plan.memoryTexels = plan.hold && cpu;
    plan.pack = plan.spheres && !cpu; // a CPU device has no bus to cross, and packing takes 2 ms
    plan.keepDepth = plan.passes && !cpu && camera.depth.width % 4 == 0;
    while (plan.pixelGroup > device.maxInvocations) {
        plan.pixelGroup /= 2;
    }
    // On GPUs publishers spin while the device works, so other threads need processors of their own. A CPU
    // device has finished by then.
    if (plan.spheres && cpu) {
        plan.publishers = std::min(kMaxPublishers, device.hostProcessors);
    } else if (plan.spheres && device.hostProcessors >= kManyProcessors) {
        plan.publishers = std::min(kMaxPublishers, device.hostProcessors - kOtherThreads);
    }
    // Measured: on a CPU device shared-memory tiles are 2-4 times slower than direct reads.
    plan.tiled = !cpu && plan.filterRadius >= 2 && bytesOfTile(plan.filterRadius) <= device.maxSharedBytes;
    plan.byPixel = !cpu; // on a CPU device shared memory took twice as long
    plan.manyPatches =
        plan.byPixel && patchLayout(camera.depth.width, camera.depth.height).patches() >= kManyPatches;
    // On a CPU device a load is a gather, lane by lane, so neighbouring pixels share their loads.
    plan.filterBlock = cpu;
    plan.quarticWeights = cpu && !plan.polynomialWeights; // a CPU device computes exp in 20 instructions
}

void decideQuery(const Scene& scene, uint32_t toolLeaves, const DeviceFacts& device, Plan& plan) {
    if (plan.spheres) {
        const bool gpu = scene.contact.where == Scene::Contact::Where::Gpu ||
                         (scene.contact.where == Scene::Contact::Where::Auto &&
                          device.kind != DeviceKind::Cpu && toolLeaves >= device.gpuQueryLeaves);
        plan.query = gpu ? Plan::Query::Gpu : Plan::Query::Cpu;
    }
    plan.tree = plan.query == Plan::Query::Gpu;
    plan.grid = plan.query == Plan::Query::Cpu;
}

// Decides the switches. The items that explain them depend only on these.
Plan decide(const Scene& scene, const CameraInfo& camera, uint32_t toolLeaves, const DeviceFacts& device) {
    Plan plan;
    decideByScene(scene, camera, plan);
    decideByDevice(camera, device, plan);
    decideQuery(scene, toolLeaves, device, plan);
    return plan;
}

// Buffers of one value per slot bound the image. The largest ones: texels of `points` or `estimates`, bytes
// of `points`, `estimates` or `packed`.
uint64_t mostSlots(const Plan& plan, const DeviceFacts& device) {
    const uint64_t texels = plan.estimates ? 2 : 1;
    const uint64_t bytes = std::max<uint64_t>(plan.estimates ? 32 : 16, plan.pack ? plan.packedBytes() : 0);
    return std::min(device.maxTexels / texels, device.maxStorageBufferBytes / bytes);
}

uint64_t slotsOf(const CameraInfo& camera, uint32_t every) {
    return patchLayout((camera.depth.width + every - 1) / every, (camera.depth.height + every - 1) / every)
        .slots();
}

void checkSize(const Plan& plan, const Scene& scene, const CameraInfo& camera, const DeviceFacts& device) {
    const uint64_t most = mostSlots(plan, device);
    if (!plan.passes || slotsOf(camera, 1) <= most) {
        return;
    }
    uint32_t every = 1;
    while (every <= kMaxDecimation && slotsOf(camera, every) > most) {
        ++every;
    }
    every *= scene.decimation;
    throw BadInput(
        "camera", "image size", sizeText(camera.depth.width, camera.depth.height),
        "at most " + std::to_string(most) + " pixels in squares of 16x16 on " + device.name +
            (every > kMaxDecimation ? "" : ", for example with camera.decimation: " + std::to_string(every)));
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
        throw BadInput("camera", "image size", sizeText(width, height), "1x1 to 3840x2160");
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
    // classify and surface; patches that hold nothing, then those that do; the bounds of patches, unless
    // `spheres` makes them
    return (occlusion ? 1u : 0u) + (passes ? 2u : 0u) + (delivers() ? 1u : 0u) + (lists() ? 1u : 0u) +
           (estimates ? 1u : 0u) + (thins() ? 1u : 0u) + (spheres ? (hold && lists() ? 2u : 1u) : 0u) +
           (tree && lists() ? 1u : 0u) + (moments ? 1u : 0u);
}

uint64_t Plan::momentBytes(const PatchLayout& layout) {
    return sizeof(shared::PatchMoments) * shared::kMaxClasses * layout.patches();
}

uint64_t Plan::setBytes(const PatchLayout& layout) const {
    if (!passes) {
        return 0;
    }
    const uint64_t slots = layout.slots(), patches = layout.patches();
    const uint64_t spheresOfTree = slots * ((hold ? 32u : 16u) + (classes > 1 ? 1u : 0u));
    return sizeof(shared::FrameCounters) + 4 * patches + // patch marks
           (spheres ? 64 * patches : 0) +                // one word of pixel bits per sub-patch
           (spheres && tree ? spheresOfTree : 0) +
           (tree ? 20ull * layout.bounds() : 0) +              // bound and count of each node
           (pack ? slots * packedBytes() + 72 * patches : 0) + // places (64) and run (8) of each patch
           (moments ? momentBytes(layout) : 0) + (guidancePoints ? 17 * slots : 0); // point and class bits
}

Plan makePlan(const Scene& scene, const CameraInfo& camera, uint32_t toolLeaves, const DeviceFacts& device) {
    checkCamera(camera, "camera");
    Plan plan = decide(scene, camera, toolLeaves, device);
    checkSize(plan, scene, camera, device);
    explainPlan(plan, scene, camera);
    return plan;
}

} // namespace fathom
