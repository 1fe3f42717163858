// SPDX-License-Identifier: Apache-2.0
#include "engine/run/open_scene.h"

#include "engine/cycle/arm_text.h"
#include "engine/haptics/device_preset.h"
#include "engine/model/sphere_sets.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <fmt/core.h>

#include <algorithm>

namespace fathom {

namespace {

constexpr double kUsualRadius = 0.5;                      // [m] most
constexpr double kUsualTool = 2.0, kUsualDistance = 20.0; // [m] most

// Far from its origin a base frame is that of a map, not one in millimetres.
void warnIfFar(const std::string& what, const dvec3& place) {
    const double distance = glm::length(place);
    warnIfLong(what + ": reaches", distance < 1e3 * kUsualDistance ? distance : 0.0, kUsualDistance);
}

// Lengths that are as good as any by the rules of the scene file, but rare in metres.
void warnAboutLengths(const Scene& scene) {
    const std::string file = scene.file.string() + ": ";
    warnIfFar(file + "camera.base_T_camera", scene.baseTcamera.position);
    for (const FixtureClass& f : scene.fixtures) {
        const std::string name = file + "fixtures: " + f.name + ": ";
        if (f.isPoints()) {
            warnIfLong(name + "radius: reaches", f.radius, kUsualRadius);
            continue;
        }
        warnIfFar(name + "base_T_shape", f.baseTshape.position);
        warnIfLong(name + "size: reaches", std::max({f.size.x, f.size.y, f.size.z}), kUsualDistance);
    }
}

Scene checked(Scene scene) {
    const std::filesystem::path& file = scene.file;
    warnAboutLengths(scene);
    for (const std::string& path : scene.outside) {
        log::warn("{}: '{}' is outside the scene file's folder", file.string(), path);
    }
    if (findPreset(scene.haptics.device) == nullptr) {
        throw BadInput(file.string(), "haptics.device", scene.haptics.device, presetNames());
    }
    return scene;
}

} // namespace

Scene openScene(const std::filesystem::path& file) {
    return checked(loadScene(file));
}

Scene openSceneText(const std::string& text) {
    return checked(loadSceneText(text, "scene text"));
}

void warnIfLong(const std::string& what, double length, double most) {
    if (length > most) {
        log::warn("{} {:.4g} m (is the value in millimetres?)", what, length);
    }
}

namespace {

Tool builtTool(const Scene& scene, const ReaderOptions& reader) {
    const std::filesystem::path& file = scene.tool.file.empty() ? scene.file : scene.tool.file;
    try {
        if (!scene.tool.file.empty()) {
            return Tool(readSphereTree(file, scene.tool.link, reader));
        }
        std::vector<Sphere> leaves;
        for (const auto& [x, y, z, r] : scene.tool.spheres) {
            leaves.push_back({{x, y, z}, r});
        }
        return Tool(buildSphereTree(leaves));
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(
            file.string(), "tool", e.what(),
            fmt::format("1 to {} spheres with coordinates up to {} m and radii above 0, up to {} m",
                        kMaxLeaves, kMaxToolReach, kMaxLeafRadius));
    }
}

Tool writtenTool(const Scene& scene, const ReaderOptions& reader) {
    Tool tool = builtTool(scene, reader);
    const std::filesystem::path& file = scene.tool.file.empty() ? scene.file : scene.tool.file;
    warnIfLong(file.string() + ": tool: reaches", tool.boundingRadius(), kUsualTool);
    return tool;
}

// [m] from its base at the start.
double reachOf(const ArmSetup& arm) {
    const ArmFrames frames = arm.framesAt(arm.startPosture());
    double reach = 0.0;
    for (size_t i = 0; i < arm.model.leaves.size(); ++i) {
        reach = std::max(reach, glm::distance(arm.model.centre(frames, i), arm.baseTarm.position) +
                                    arm.model.leaves[i].sphere.radius);
    }
    return reach;
}

} // namespace

std::unique_ptr<ArmSetup> openArm(const Scene& scene, const ReaderOptions& reader) {
    const bool tool = scene.arm && scene.tool.given();
    auto arm =
        makeArmSetup(scene, tool ? writtenTool(scene, reader).leaves() : std::span<const Sphere>(), reader);
    if (arm) {
        warnIfLong(scene.arm->urdf.string() + ": the arm reaches", reachOf(*arm), kUsualDistance);
    }
    for (const std::string& line : arm ? describeArm(*arm) : std::vector<std::string>{}) {
        log::info("arm: {}", line);
    }
    if (arm && scene.arm->tip.empty()) {
        log::warn("{}: tip {}; base {}; arm.tip and arm.base name others", scene.arm->urdf.string(),
                  arm->model.tipText, arm->model.baseText);
    }
    for (const std::string& note : arm ? arm->model.notes : std::vector<std::string>{}) {
        log::warn("{}: {}", scene.arm->urdf.string(), note);
    }
    return arm;
}

Tool openTool(const Scene& scene, const ArmSetup* arm, const ReaderOptions& reader) {
    return arm != nullptr ? arm->heldTool() : writtenTool(scene, reader);
}

} // namespace fathom
