// SPDX-License-Identifier: Apache-2.0
#include "engine/front/core.h"

#include "engine/run/open_scene.h"

#include <algorithm>
#include <string_view>

namespace fathom::front {

namespace {

CameraInfo infoOf(const v0::CameraModel& camera, const fathom::Scene& scene) {
    CameraInfo info = internal(camera);
    if (scene.beam) {
        info.beam = BeamSigma{scene.beam->range, scene.beam->perMetre, scene.beam->width};
    }
    return info;
}

} // namespace

void requireSupported(const fathom::Scene& scene) {
    if (scene.arm) {
        throw v0::BadInput(scene.file.string() +
                           ": arm: a scene with an arm (allowed: none in the library yet; use "
                           "`fathom operate`)");
    }
    const std::filesystem::path& tool = scene.tool.file;
    if (!tool.empty() &&
        tool.extension() == ".urdf") { // read in a forked process, which a library must not start
        throw v0::BadInput(scene.file.string() + ": tool.file: " + tool.string() +
                           " (allowed: a .sph file in the library; `fathom spheres` converts)");
    }
    if (scene.port) {
        throw v0::BadInput(scene.file.string() +
                           ": camera.port: a flat port (allowed: none in the library yet; "
                           "correct the depth yourself)");
    }
}

HapticSide::HapticSide(const fathom::Scene& from)
    : scene(from)
    , tool(openTool(scene))
    , shapes(shapesOf(scene))
    , options(makeHapticOptions(scene, tool)) {}

std::unique_ptr<HapticCycle> HapticSide::cycle(const v0::HandStart& start) const {
    const Pose hand = internal(start.deviceThandle);
    const Pose begin = start.baseTtool != nullptr ? internal(*start.baseTtool) : Pose{};
    if (!isFinite(hand) || !isFinite(begin)) {
        throw v0::BadInput(
            "hand: start: a pose that is not finite (allowed: finite numbers, a unit quaternion)");
    }
    return std::make_unique<HapticCycle>(tool, shapes, options, hand,
                                         start.baseTtool != nullptr ? &begin : nullptr);
}

ComputeSide::ComputeSide(const HapticSide& haptic, const v0::CameraModel& camera, const std::string& device)
    : instance(haptic.scene.hasPoints() ? std::make_unique<gpu::Instance>() : nullptr)
    , cycles({instance.get(), device, haptic.scene, infoOf(camera, haptic.scene), haptic.tool},
             [&](const DeviceFacts& facts) {
                 return makePlan(haptic.scene, infoOf(camera, haptic.scene),
                                 static_cast<uint32_t>(haptic.tool.leafCount()), facts);
             }) {}

} // namespace fathom::front
