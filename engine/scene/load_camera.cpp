// SPDX-License-Identifier: Apache-2.0
// Sections `camera` and `filter` of a scene file.
#include "engine/scene/load.h"

#include "engine/types/angle.h"
#include "engine/types/decimation.h"
#include "engine/types/number_text.h"

#include <algorithm>

namespace fathom {

namespace {

// `frames`, or `pictures`, its former name.
std::optional<YamlNode> frameCount(const YamlNode& node) {
    const auto frames = node.find("frames"), pictures = node.find("pictures");
    if (frames && pictures) {
        pictures->refuse("none: it is the former name of frames");
    }
    return frames ? frames : pictures;
}

CameraSource simulatedSource(const YamlNode& node, const YamlNode& simulated) {
    constexpr std::string_view kScenes[] = {"tank", "sphere", "plane",  "torus", "slot",
                                            "gap",  "plate",  "corner", "sonar", "wetmate"};
    constexpr std::string_view kFormats[] = {"rgba", "yuyv"};
    CameraSource source{CameraSource::Kind::Simulated, std::string(kScenes[simulated.oneOf(kScenes)])};
    const bool sonar = source.value == "sonar";
    const auto arm = node.find("arm");
    source.showsArm = arm && arm->boolean();
    if (source.showsArm && sonar) {
        arm->refuse("false: the simulated sonar draws none");
    }
    if (const auto frames = frameCount(node)) {
        source.images = static_cast<uint32_t>(frames->integer(1, 100'000));
    }
    const auto colour = node.find("colour");
    source.yuyv = colour && colour->oneOf(kFormats) == 1;
    if (source.yuyv && sonar) {
        colour->refuse("rgba: the simulated sonar is grey");
    }
    return source;
}

// "NAME=VALUE,NAME=VALUE": files are relative to the scene's folder.
std::string withFilesBesideScene(Scene& scene, std::string text) {
    for (const std::string key : {"intrinsics=", "extrinsics="}) {
        const size_t found = text.starts_with(key) ? 0 : text.find("," + key);
        if (found == std::string::npos) {
            continue;
        }
        const size_t begin = text.find('=', found) + 1, end = std::min(text.find(',', begin), text.size());
        text.replace(begin, end - begin, besideScene(scene, text.substr(begin, end - begin)).string());
    }
    return text;
}

// "PATH,NAME=VALUE,NAME=VALUE": the path and the files are relative to the scene's folder.
std::string recordingBesideScene(Scene& scene, const std::string& text) {
    size_t options = text.find(',');
    while (options != std::string::npos) { // file names may have commas
        const size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz", options + 1);
        if (end != std::string::npos && text[end] == '=') {
            break;
        }
        options = text.find(',', options + 1);
    }
    options = std::min(options, text.size());
    return besideScene(scene, text.substr(0, options)).string() +
           withFilesBesideScene(scene, text.substr(options));
}

CameraSource loadSource(const YamlNode& node, Scene& scene) {
    node.checkKeys({"simulated", "recorded", "v4l2", "ros2", "arm", "frames", "pictures", "colour"});
    const auto simulated = node.find("simulated"), recorded = node.find("recorded"), v4l2 = node.find("v4l2"),
               ros2 = node.find("ros2");
    const int given = int(simulated.has_value()) + int(recorded.has_value()) + int(v4l2.has_value()) +
                      int(ros2.has_value());
    if (given != 1) {
        node.refuse(std::to_string(given) + " sources", "exactly one of simulated, recorded, v4l2, ros2");
    }
    if (simulated) {
        return simulatedSource(node, *simulated);
    }
    if (const auto arm = node.find("arm")) {
        arm->refuse("none: only a simulated camera draws an arm");
    }
    if (const auto frames = frameCount(node)) {
        frames->refuse(
            std::string("none: only a simulated camera has a selectable number") +
            (recorded ? "; of a recording, ,start=S and ,duration=S behind PATH play a part" : ""));
    }
    if (const auto colour = node.find("colour")) {
        colour->refuse("none: only a simulated camera has a selectable format");
    }
    if (recorded) {
        return {CameraSource::Kind::Recorded, recordingBesideScene(scene, recorded->text())};
    }
    if (ros2) {
        return {CameraSource::Kind::Ros2, withFilesBesideScene(scene, ros2->text())};
    }
    return {CameraSource::Kind::V4l2, v4l2->text()};
}

void loadDepthRange(const YamlNode& camera, Scene& scene) {
    const auto nearZ = camera.find("near"), farZ = camera.find("far");
    if (nearZ) {
        scene.nearZ = nearZ->number(Range::between(1e-3, 1e4));
    }
    if (farZ) {
        scene.farZ = farZ->number(Range::between(1e-3, 1e4));
    }
    if (scene.nearZ < scene.farZ) {
        return;
    }
    // The file may contain only one of the two: report that one.
    if (nearZ) {
        nearZ->refuse("a number below camera.far = " + significant(scene.farZ, 6));
    }
    farZ->refuse("a number above camera.near = " + significant(scene.nearZ, 6));
}

void loadPort(const YamlNode& node, Scene& scene) {
    node.checkKeys({"distance", "index"});
    FlatPort port;
    port.distance = node.at("distance").number(Range::between(0.0, 10.0));
    if (!(port.distance < scene.nearZ)) {
        node.at("distance").refuse("a number below camera.near = " + significant(scene.nearZ, 6));
    }
    node.read("index", port.index, Range::between(1.0, 2.0));
    scene.port = port;
}

void loadBeam(const YamlNode& node, Scene& scene) {
    node.checkKeys({"width_deg", "sigma", "sigma_per_m"});
    BeamSigma beam;
    beam.width = kDegree * node.at("width_deg").number(Range::between(0.0, 30.0));
    node.read("sigma", beam.range, Range::between(0.0, 1.0));
    node.read("sigma_per_m", beam.perMetre, Range::between(0.0, 1.0));
    scene.beam = beam;
}

} // namespace

void loadCamera(const YamlNode& camera, Scene& scene) {
    camera.checkKeys({"source", "near", "far", "base_T_camera", "registration_sigma", "port", "beam",
                      "attenuation", "static", "decimation"});
    camera.read("decimation", scene.decimation, 1, kMaxDecimation);
    camera.read("static", scene.cameraStatic);
    if (const auto attenuation = camera.find("attenuation")) {
        scene.attenuation = attenuation->vec3(Range::between(0.0, 20.0));
    }
    if (const auto source = camera.find("source")) {
        scene.source = loadSource(*source, scene);
    }
    loadDepthRange(camera, scene);
    if (const auto pose = camera.find("base_T_camera")) {
        scene.baseTcamera = loadPose(*pose);
    }
    camera.read("registration_sigma", scene.registrationSigma, Range::between(0.0, 1.0));
    if (const auto port = camera.find("port")) {
        loadPort(*port, scene);
    }
    if (const auto beam = camera.find("beam")) {
        loadBeam(*beam, scene);
    }
}

void loadFilter(const YamlNode& filter, Scene& scene) {
    filter.checkKeys({"radius", "sigma", "edge", "isolated", "weights", "memory"});
    filter.read("memory", scene.filter.memory, 0, 120);
    filter.read("radius", scene.filter.radius, 0, 16);
    filter.read("sigma", scene.filter.sigma, Range::between(1e-5, 10.0));
    filter.read("edge", scene.filter.edge, Range::between(0.0, 10.0));
    filter.read("isolated", scene.filter.isolated, {{"reject", true}, {"keep", false}});
    using Weights = Scene::Filter::Weights;
    filter.read("weights", scene.filter.weights,
                {{"exact", Weights::Exact}, {"polynomial", Weights::Polynomial}});
}

} // namespace fathom
