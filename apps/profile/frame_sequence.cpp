// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/frame_sequence.h"

#include "devices/recorded/recorded_camera.h"
#include "devices/simulated/analytic_scene.h"
#include "engine/run/open_scene.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>

namespace fathom::profile {

namespace {

constexpr uint32_t kRed = 0xff2020c0u, kYellow = 0xff20b0c0u, kGrey = 0xff808080u; // 0xAABBGGRR

// firstFrame: none = a static camera.
SimulatedCamera cameraOn(const std::string& scene, uint32_t width, uint32_t height,
                         std::optional<uint32_t> firstFrame, bool noise = true) {
    const auto solids = analyticScene(scene);
    if (!solids) {
        throw Error("no analytic scene '" + scene + "'");
    }
    SimulatedCameraOptions options;
    options.width = width;
    options.height = height;
    options.motion = firstFrame.has_value();
    options.firstFrame = firstFrame.value_or(0);
    options.noise = options.water = noise;
    options.metresPerUnit = 0.0001;
    return SimulatedCamera(*solids, options);
}

FixtureClass coloured(const std::string& name, Role role, Band hue) {
    FixtureClass f;
    f.name = name;
    f.role = role;
    f.hue = hue;
    f.saturation = Band{0.4, 1.0};
    f.lightness = Band{0.08, 0.9};
    return f;
}

} // namespace

void takeFrames(Camera& camera, uint32_t frames, FrameSequence& source, const Pose& still) {
    for (uint32_t i = 0; i < frames; ++i) {
        const std::optional<Frame> frame = camera.next();
        if (!frame) {
            break;
        }
        SampleFrame& image = source.frames.emplace_back();
        image.depth.assign((*frame)->depth.begin(), (*frame)->depth.end());
        if (camera.info().hasColour) {
            readColours(**frame, image.colour);
        }
        if ((*frame)->isRaw()) {
            image.packed = {{(*frame)->raw.bytes.begin(), (*frame)->raw.bytes.end()}, (*frame)->raw};
        }
        image.baseTcamera = (*frame)->baseTcamera.value_or(still);
    }
}

FrameSequence analyticFrames(const std::string& scene, uint32_t width, uint32_t height, uint32_t frames) {
    SimulatedCamera camera = cameraOn(scene, width, height, {});
    FrameSequence source{scene, camera.info(), {}};
    takeFrames(camera, frames, source);
    const auto exact = camera.exactView(0); // static scene
    for (SampleFrame& image : source.frames) {
        image.truth = exact.depth;
    }
    return source;
}

FrameSequence exactFrame(const std::string& scene, uint32_t width, uint32_t height) {
    SimulatedCamera camera = cameraOn(scene, width, height, {}, false);
    FrameSequence source{scene, camera.info(), {}};
    takeFrames(camera, 1, source);
    return source;
}

FrameSequence twoCameraFrames(const std::string& scene, uint32_t width, uint32_t height, uint32_t frames) {
    constexpr uint32_t kAside = 52; // frame at which the sway has moved the camera by 25 mm
    FrameSequence source = analyticFrames(scene, width, height, frames);
    SimulatedCamera second = cameraOn(scene, width, height, kAside);
    const std::optional<Frame> frame = second.next();
    for (SampleFrame& image : source.frames) {
        readColours(**frame, image.colour);
    }
    source.camera.colour = source.camera.depth;
    source.camera.registered = false;
    source.camera.colourTdepth = inverse(second.poseAt(kAside));
    return source;
}

FrameSequence recordedFrames(const std::filesystem::path& folder, uint32_t frames) {
    RecordedCamera camera(folder);
    const std::filesystem::path clean = folder.lexically_normal();
    FrameSequence source{
        (clean.has_filename() ? clean : clean.parent_path()).filename().string(), camera.info(), {}};
    takeFrames(camera, frames, source);
    return source;
}

FrameSequence wallFrame(uint32_t width, uint32_t height, double share, WallNoise noise) {
    FrameSequence source{sizeText(width, height), {}, {}};
    Intrinsics& lens = source.camera.depth;
    lens.width = width;
    lens.height = height;
    lens.fx = lens.fy = 0.9 * width;
    lens.cx = 0.5 * (width - 1.0);
    lens.cy = 0.5 * (height - 1.0);
    source.camera.colour = lens;
    source.camera.metresPerUnit = 0.0001;
    SampleFrame& image = source.frames.emplace_back();
    const NormalTable normal;
    const auto redRows = static_cast<uint32_t>(std::lround(share * height));
    const auto yellowRows = std::max(1u, height / 50);
    for (uint32_t v = 0; v < height; ++v) {
        for (uint32_t u = 0; u < width; ++u) {
            const double x = u / static_cast<double>(width), y = v / static_cast<double>(height);
            double z = 0.8 + 0.03 * std::sin(9.0 * x) * std::cos(7.0 * y);
            if (noise == WallNoise::Sensor) {
                const uint64_t bits = counterBits(1, 0, v * width + u, NoisePurpose::Depth);
                z += SimulatedCamera::kDepthSigmaShare * depthSigma(z) * normal(static_cast<uint32_t>(bits));
            }
            image.depth.push_back(static_cast<uint16_t>(std::lround(z / source.camera.metresPerUnit)));
            image.colour.push_back(v < redRows ? kRed : v < redRows + yellowRows ? kYellow : kGrey);
        }
    }
    return source;
}

FrameSequence sentAs(ColourFormat format, FrameSequence source) {
    source.camera.colourFormat = format;
    const Intrinsics& size = source.camera.colour;
    for (SampleFrame& image : source.frames) {
        image.packed = verify::packColour(format, size.width, size.height, image.colour);
        unpackColour(image.packed.image(), image.colour);
    }
    return source;
}

FrameSequence inYuyv(FrameSequence source) {
    return sentAs(ColourFormat::Yuyv, std::move(source));
}

std::vector<FrameSequence> studySources(const Settings& settings, const std::vector<std::string>& analytic,
                                        uint32_t frames) {
    std::vector<FrameSequence> sources;
    if (!settings.source.empty()) {
        sources.push_back(recordedFrames(settings.source, frames));
        return sources;
    }
    for (const std::string& name : analytic) {
        sources.push_back(settings.quick ? analyticFrames(name, 320, 240, frames)
                                         : analyticFrames(name, 640, 480, frames));
    }
    return sources;
}

Scene everyPointScene() {
    Scene scene;
    FixtureClass all;
    all.name = "all";
    all.radius = 0.02;
    scene.fixtures = {all};
    scene.errorBudget = 0.0;
    scene.holdSeconds = 0.0;
    scene.filter.radius = 0;
    scene.filter.edge = 0.0;
    scene.contact.where = Scene::Contact::Where::Gpu;
    return scene;
}

std::string sizeName(const RegionSpheres& spheres) {
    return digits(static_cast<double>(spheres.size()) / 1000.0, 4) + " k spheres";
}

Scene studyScene(const Settings& settings) {
    if (!settings.scene.empty()) {
        return openScene(settings.scene);
    }
    Scene scene;
    if (!settings.source.empty()) {
        FixtureClass all;
        all.name = "all";
        scene.fixtures = {all};
        return scene;
    }
    scene.fixtures = redAndYellow();
    return scene;
}

void refuseEmpty(const Settings& settings, const FrameSequence& source, const RegionSpheres& spheres) {
    if (spheres.size() == 0) {
        throw BadInput(settings.scene.empty() ? source.name : settings.scene.string(), "fixtures",
                       "no forbidden class has points in the frames of " + source.name,
                       "a forbidden class that does; 'fathom replay' shows what each class selects");
    }
}

std::vector<FixtureClass> redAndYellow() {
    return {coloured("red", Role::Forbidden, {345.0, 20.0}),
            coloured("yellow", Role::Guidance, {40.0, 70.0})};
}

Tool ballTool(uint32_t leaves) {
    constexpr double kBall = 0.06; // [m]
    const double radius = 0.9 * kBall / std::cbrt(static_cast<double>(leaves));
    std::vector<Sphere> spheres;
    for (uint32_t i = 0; i < leaves; ++i) { // Fibonacci shells: uniform, and the same on every machine
        const double t = (i + 0.5) / leaves, z = 1.0 - 2.0 * std::fmod(i * 0.7548776662466927, 1.0);
        const double angle = 2.0 * M_PI * std::fmod(i * 0.5698402909980532, 1.0);
        const double ring = std::sqrt(std::max(0.0, 1.0 - z * z)), r = (kBall - radius) * std::cbrt(t);
        spheres.push_back({dvec3(r * ring * std::cos(angle), r * ring * std::sin(angle), r * z), radius});
    }
    return Tool(buildSphereTree(spheres));
}

Pose touchingPose(const Tool& tool, const HostFixtures& fixtures, const Pose& baseTcamera) {
    const RegionSpheres& s = fixtures.spheres;
    dvec3 mean(0.0);
    for (size_t i = 0; i < s.size(); ++i) {
        mean += dvec3(s.x[i], s.y[i], s.z[i]) / static_cast<double>(s.size());
    }
    mean += fixtures.origin;
    const dvec3 back = glm::normalize(baseTcamera.position - mean);
    const auto gapAt = [&](double away) {
        const dvec3 at = mean + away * back - fixtures.origin;
        double least = HUGE_VAL;
        for (size_t i = 0; i < s.size(); i += 1 + s.size() / 4000) { // a few thousand spheres suffice
            for (size_t l = 0; l < tool.leafCount(); l += 1 + tool.leafCount() / 128) {
                const Sphere& leaf = tool.leaves()[l];
                least = std::min(least, glm::length(dvec3(s.x[i], s.y[i], s.z[i]) - at - leaf.centre) -
                                            static_cast<double>(s.radius[i]) - leaf.radius);
            }
        }
        return least;
    };
    double near = 0.0, far = 0.5;
    for (int i = 0; i < 16; ++i) {
        const double middle = 0.5 * (near + far);
        (gapAt(middle) < -0.001 ? near : far) = middle;
    }
    return {mean + far * back, dquat(1.0, 0.0, 0.0, 0.0)};
}

} // namespace fathom::profile
