// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/stream_names.h"

#include "devices/bag/topic_words.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

namespace fathom {

namespace {

bool namesImage(const std::string& word) {
    const WordUse use = useOf(word, true);
    return use == WordUse::Depth || use == WordUse::Colour || use == WordUse::Infrared;
}

// Words that may name a camera: "front", "2" of "/frontDepth2".
std::vector<std::string> cameraWordsOf(const std::string& topic) {
    std::vector<std::string> words = camelWordsOf(baseTopic(topic));
    for (std::string& word : words) {
        const size_t name = word.find_last_not_of("0123456789") + 1;
        const WordUse use = useOf(word.substr(0, name), true);
        if (name < word.size() && (use == WordUse::Depth || use == WordUse::Colour)) {
            word.erase(0, name);
        }
    }
    return words;
}

std::vector<std::string> wordsOf(const std::string& topic) {
    return withoutDigits(camelWordsOf(topic));
}

bool holds(const std::vector<std::string>& words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

// What stands between the slashes, and may be empty.
std::vector<std::string> partsOf(const std::string& topic) {
    std::vector<std::string> parts;
    for (size_t start = topic.starts_with('/') ? 1 : 0; start <= topic.size();) {
        const size_t end = std::min(topic.find('/', start), topic.size());
        parts.push_back(topic.substr(start, end - start));
        start = end + 1;
    }
    return parts;
}

// "/a/b/" of "/a/b/depth/image_raw"; without such a part of "/a/b/image_raw", too.
std::string cameraOf(const std::string& topic) {
    const std::string base = baseTopic(topic);
    for (size_t start = 0; start < base.size();) {
        const size_t end = std::min(base.find('/', start), base.size());
        if (std::ranges::any_of(withoutDigits(tokensOf(base.substr(start, end - start))), namesImage)) {
            return base.substr(0, start);
        }
        start = end + 1;
    }
    return base.substr(0, base.find_last_of('/') + 1);
}

// Follows the words of a topic, part by part.
class RoleOfWords {
public:
    void add(const std::vector<std::string>& words, bool first, bool last);
    NamedRole role() const { return derived_ && role_ == NamedRole::Depth ? NamedRole::Infrared : role_; }
    bool ofDepth() const { return role_ == NamedRole::Depth; } // depth, or computed from it
    size_t decided() const { return decided_; }                // number of parts up to the one that decides

private:
    void use(const std::vector<std::string>& words, size_t at, bool first);

    NamedRole role_ = NamedRole::None;
    bool target_ = false, named_ = false;         // the next word, and the last one, name another camera
    bool depthHere_ = false, colourHere_ = false; // in this part
    bool unscaledHere_ = false, derived_ = false; // no metres
    bool depthFolder_ = false;                    // the part before holds depth
    size_t parts_ = 0, decided_ = 0;
};

void RoleOfWords::use(const std::vector<std::string>& words, size_t at, bool first) {
    const WordUse use = useOf(words[at], first && !depthHere_);
    if (use == WordUse::Derived || use == WordUse::Unscaled) {
        derived_ = derived_ || (role_ == NamedRole::Depth && describesImages(words, at));
        unscaledHere_ = unscaledHere_ || use == WordUse::Unscaled;
        return;
    }
    if (use == WordUse::None) {
        return;
    }
    decided_ = parts_;
    colourHere_ = use == WordUse::Colour;
    switch (use) {
    case WordUse::Colour:
        role_ = depthHere_ ? NamedRole::Either : NamedRole::Colour;
        break;
    case WordUse::Depth:
    case WordUse::Painted:
        role_ = NamedRole::Depth;
        depthHere_ = true;
        derived_ = unscaledHere_;
        break;
    default:
        role_ = NamedRole::Infrared;
        break;
    }
}

void RoleOfWords::add(const std::vector<std::string>& words, bool first, bool last) {
    ++parts_;
    depthHere_ = colourHere_ = unscaledHere_ = false;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        const bool more = i + 1 < words.size();
        if (target_) {
            target_ = false;
            named_ = true;
        } else if (word == "to" || (word == "in" && more) || (word == "and" && named_)) {
            target_ = true;
        } else if (!((word == "distance" || word == "relative") && more && words[i + 1] == "to")) {
            // Else of ranges, of an image's plane, or of a frame.
            named_ = false;
            use(words, i, first);
        }
    }
    const bool camera = !words.empty() && endsCamera(words.back());
    if (camera && role_ == NamedRole::Either) {
        role_ = NamedRole::Colour;
    }
    if (last && colourHere_ && depthFolder_ && role_ == NamedRole::Colour) {
        role_ = NamedRole::Either;
        --decided_;
    }
    depthFolder_ = depthHere_ && role_ == NamedRole::Depth && !camera &&
                   (words.front() == "depth" || words.front() == "aligned");
}

RoleOfWords roleOfWords(const std::string& topic) {
    RoleOfWords all;
    const std::vector<std::string> parts = partsOf(baseTopic(topic));
    for (size_t i = 0; i < parts.size(); ++i) {
        const bool last = i + 1 == parts.size();
        // Below a folder of depth cameras: the name of a computer.
        const bool computer = i == 1 && !last && (parts[i] == "edge" || parts[i] == "flow");
        all.add(computer ? std::vector<std::string>{} : wordsOf(parts[i]), i == 0 && !last, last);
    }
    return all;
}

} // namespace

NamedRole namedRole(const std::string& topic) {
    if (const std::string sensor = orbbecSensor(topic); !sensor.empty()) {
        return sensor == "3"                                       ? NamedRole::Depth
               : sensor == "2" || sensor == "11" || sensor == "12" ? NamedRole::Colour
                                                                   : NamedRole::Infrared;
    }
    return roleOfWords(topic).role();
}

std::string folderOfEither(const std::string& topic) {
    const size_t parts = partsOf(baseTopic(topic)).size(), decided = roleOfWords(topic).decided();
    return decided < parts ? parentTopic(baseTopic(topic), static_cast<int>(parts - decided)) + "/" : "";
}

bool namedDistance(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(baseTopic(topic));
    const bool surely = std::ranges::any_of(words, [](const std::string& word) {
        const WordUse use = useOf(word, false);
        return !word.starts_with("distance") && word != "z" &&
               (use == WordUse::Depth || use == WordUse::Painted);
    });
    return !surely && namedRole(topic) == NamedRole::Depth;
}

bool namedDepthImage(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(baseTopic(topic));
    const auto depth = std::ranges::find(words, "depth");
    const bool camera = depth != words.end() && depth + 1 != words.end() && endsCamera(*(depth + 1));
    const bool ofDepth = namedRole(topic) == NamedRole::Depth || roleOfWords(topic).ofDepth();
    return ofDepth && !namedDistance(topic) && !camera;
}

bool namedPlainly(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(baseTopic(topic));
    const auto depth = std::ranges::find_if(
        words, [](const std::string& word) { return useOf(word, true) == WordUse::Depth; });
    return std::all_of(depth, words.end(), isUsualWord);
}

bool namedRectified(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(baseTopic(topic));
    return holds(words, "rect") || holds(words, "rectified") || holds(words, "undistorted");
}

bool namedRegistered(const std::string& topic) {
    const std::vector<std::string> words = wordsOf(topic);
    return holds(words, "aligned") || holds(words, "registered");
}

bool namedRight(const std::string& topic) {
    return holds(wordsOf(topic), "right");
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
