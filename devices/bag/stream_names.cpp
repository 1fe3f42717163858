// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace fathom {

namespace {

constexpr std::array<std::string_view, 2> kDepthWords{"depth", "range"};
constexpr std::array<std::string_view, 3> kColourWords{"rgb", "color", "colour"};
constexpr std::array<std::string_view, 32> kInfraredWords{
    "ir",     "infra",       "infrared",     "nir",        "nearir",      "lwir",      "thermal",
    "flir",   "intensity",   "amplitude",    "confidence", "disparity",   "reflec",    "reflectivity",
    "signal", "reflectance", "ambient",      "noise",      "uncertainty", "variance",  "temperature",
    "label",  "labels",      "segmentation", "semantic",   "mask",        "instances", "gray",
    "grey",   "mono",        "fisheye",      "phase"};
// What depth cameras publish about their depth, maps of a height, and what programs draw or compute on
// images. No part of a camera's name.
constexpr std::array<std::string_view, 27> kBesideWords{"error",         "err",
                                                        "std",           "stddev",
                                                        "sigma",         "snr",
                                                        "quality",       "cost",
                                                        "costmap",       "elevation",
                                                        "height",        "normal",
                                                        "normals",       "surface",
                                                        "validity",      "age",
                                                        "seg",           "instance",
                                                        "detection",     "detections",
                                                        "overlay",       "panoptic",
                                                        "classes",       "heatmap",
                                                        "depthvis",      "disparitynormalized",
                                                        "surfacenormals"};
constexpr std::array<std::string_view, 4> kPainted{"colored", "coloured", "colorized", "colourized"};

template <size_t N>
bool among(const std::array<std::string_view, N>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// Lower-case words; humps: "frontDepth" is two.
std::vector<std::string> wholeWordsOf(const std::string& topic, bool humps = false) {
    std::vector<std::string> words(1);
    bool small = false; // the last character
    for (const char c : topic) {
        const auto byte = static_cast<unsigned char>(c);
        if (!words.back().empty() &&
            (std::isalnum(byte) == 0 || (humps && small && std::isupper(byte) != 0))) {
            words.emplace_back();
        }
        if (std::isalnum(byte) != 0) {
            words.back() += static_cast<char>(std::tolower(byte));
        }
        small = std::islower(byte) != 0 || std::isdigit(byte) != 0;
    }
    return words;
}

// Words that may name a camera: "front", "2" of "/frontDepth2".
std::vector<std::string> cameraWordsOf(const std::string& topic) {
    std::vector<std::string> words = wholeWordsOf(baseTopic(topic), true);
    for (std::string& word : words) {
        const size_t name = word.find_last_not_of("0123456789") + 1;
        const std::string use = word.substr(0, name);
        if (name < word.size() && (among(kDepthWords, use) || among(kColourWords, use))) {
            word.erase(0, name);
        }
    }
    return words;
}

// Without digits at their end.
std::vector<std::string> wordsOf(const std::string& topic) {
    std::vector<std::string> words = wholeWordsOf(topic);
    for (std::string& word : words) {
        while (word.size() > 1 && std::isdigit(static_cast<unsigned char>(word.back())) != 0) {
            word.pop_back();
        }
    }
    return words;
}

// "/a/b/" of "/a/b/depth/image_raw"; without such a part of "/a/b/image_raw", too.
std::string cameraOf(const std::string& topic) {
    const std::string base = baseTopic(topic);
    for (size_t start = 0; start < base.size();) {
        const size_t end = std::min(base.find('/', start), base.size());
        const auto words = wordsOf(base.substr(start, end - start));
        if (std::any_of(words.begin(), words.end(), [](const std::string& word) {
                return among(kDepthWords, word) || among(kColourWords, word) || among(kInfraredWords, word);
            })) {
            return base.substr(0, start);
        }
        start = end + 1;
    }
    return base.substr(0, base.find_last_of('/') + 1);
}

} // namespace

NamedRole namedRole(const std::string& topic) {
    if (const std::string sensor = orbbecSensor(topic); !sensor.empty()) {
        return sensor == "3"                                       ? NamedRole::Depth
               : sensor == "2" || sensor == "11" || sensor == "12" ? NamedRole::Colour
                                                                   : NamedRole::Infrared;
    }
    NamedRole role = NamedRole::None;
    bool target = false;
    for (const std::string& word : wordsOf(baseTopic(topic))) {
        if (target) { // the word after "to" is another camera
            target = false;
        } else if (word == "to") {
            target = true;
        } else if (among(kDepthWords, word) || among(kPainted, word)) {
            role = NamedRole::Depth;
        } else if (among(kColourWords, word)) {
            role = NamedRole::Colour;
        } else if (among(kInfraredWords, word) || among(kBesideWords, word)) {
            role = NamedRole::Infrared;
        }
    }
    return role;
}

bool namedDepthImage(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(baseTopic(topic));
    const auto depth = std::find(words.begin(), words.end(), "depth");
    const bool camera = depth != words.end() && depth + 1 != words.end() &&
                        (*(depth + 1) == "camera" || *(depth + 1) == "cam" || *(depth + 1) == "sensor");
    return namedRole(topic) == NamedRole::Depth && !camera;
}

bool namedRectified(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(baseTopic(topic));
    return std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return word == "rect" || word == "rectified" || word == "undistorted";
    });
}

bool namedRegistered(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(topic);
    return std::any_of(words.begin(), words.end(),
                       [](const std::string& word) { return word == "aligned" || word == "registered"; });
}

bool namedRight(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(topic);
    return std::find(words.begin(), words.end(), "right") != words.end();
}

bool isRealSenseTopic(const std::string& topic) {
    return topic.starts_with("/device_") && baseTopic(topic).ends_with("/image/data");
}

std::string orbbecSensor(const std::string& topic) {
    constexpr std::string_view kSensor = "/cam/sensor_", kFrame = "/frameType_";
    const size_t end = topic.find(kFrame);
    return topic.starts_with(kSensor) && end != std::string::npos
               ? topic.substr(kSensor.size(), end - kSensor.size())
               : "";
}

bool isSdkTopic(const std::string& topic) {
    return isRealSenseTopic(topic) || !orbbecSensor(topic).empty();
}

std::string optionsPrefix(const std::string& topic) {
    return isRealSenseTopic(topic)        ? parentTopic(baseTopic(topic), 3) + "/option/"
           : !orbbecSensor(topic).empty() ? parentTopic(topic, 1) + "/option/"
                                          : "";
}

std::vector<std::string> lensTopics(const std::string& topic) {
    const std::string base = baseTopic(topic), sensor = orbbecSensor(base);
    if (!sensor.empty()) {
        return {"/cam/streamProfileType_" + sensor};
    }
    if (isRealSenseTopic(base)) { // of its bags, and of its databases
        return {parentTopic(base, 2) + "/info/camera_info", parentTopic(base, 2) + "/camera_info"};
    }
    return {parentTopic(base, 1) + "/camera_info", base + "/camera_info", base + "_info"};
}

bool namedDepthUnits(const std::string& topic) {
    std::string name = topic;
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) {
        return c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
    });
    return name.ends_with("/option/depth_units/value");
}

size_t sharedParts(const std::string& a, const std::string& b) {
    size_t parts = 0;
    for (size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i) {
        parts += a[i] == '/' && i > 0 ? 1 : 0;
    }
    return parts;
}

size_t sharedWords(const std::string& a, const std::string& b) {
    const std::vector<std::string> ofA = cameraWordsOf(a), ofB = cameraWordsOf(b);
    return static_cast<size_t>(std::count_if(ofA.begin(), ofA.end(), [&](const std::string& word) {
        return !word.empty() && std::find(ofB.begin(), ofB.end(), word) != ofB.end();
    }));
}

bool namedOneCamera(const std::string& a, const std::string& b) {
    const std::string ofA = cameraOf(a), ofB = cameraOf(b);
    const size_t shorter = std::min(ofA.size(), ofB.size());
    return shorter > 1 ? ofA.starts_with(ofB) || ofB.starts_with(ofA) : ofA.size() < 2 && ofB.size() < 2;
}

bool namedExtrinsicsOf(const std::string& extrinsics, const std::string& depth, const std::string& colour) {
    constexpr std::string_view kParent = "extrinsics/", kName = "depth_to_color";
    if (!extrinsics.ends_with(kName)) {
        return false;
    }
    std::string camera = extrinsics.substr(0, extrinsics.size() - kName.size());
    camera.erase(camera.ends_with(kParent) ? camera.size() - kParent.size() : camera.size());
    return depth.starts_with(camera) && colour.starts_with(camera);
}

std::string parentTopic(std::string topic, int levels) {
    for (int i = 0; i < levels; ++i) {
        topic.erase(std::min(topic.find_last_of('/'), topic.size()));
    }
    return topic;
}

std::string baseTopic(const std::string& topic) {
    for (const char* suffix : {"/compressed", "/compressedDepth", "/zstd"}) {
        if (topic.ends_with(suffix)) {
            return topic.substr(0, topic.size() - std::string_view(suffix).size());
        }
    }
    return topic;
}

} // namespace fathom
