// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/realsense_recording.h"

#include "devices/bag/ros2_messages.h"
#include "devices/bag/ros_messages.h"
#include "devices/bag/stream_names.h"
#include "devices/recorded/lens_model.h"
#include "engine/types/parse_number.h"

#include <algorithm>
#include <array>
#include <map>

namespace fathom {

namespace {

constexpr const char* kTextType = "std_msgs/String";
constexpr size_t kMaxText = 1 << 16; // [bytes] of one message

bool isDeviceText(const MessageTopic& topic) {
    return topic.type == kTextType && topic.cdr && topic.name.starts_with("/device_");
}

std::string textOf(MessageCursor message) {
    if (message.left() > kMaxText) {
        throw Error("a text of " + std::to_string(message.left()) + " bytes");
    }
    return message.name();
}

std::vector<std::string> partsOf(const std::string& text, char between) {
    std::vector<std::string> parts;
    for (size_t from = 0; from < text.size();) {
        const size_t end = std::min(text.find(between, from), text.size());
        parts.push_back(text.substr(from, end - from));
        from = end + 1;
    }
    return parts;
}

double numberIn(const std::string& field, const std::string& text) {
    double value = 0.0;
    if (!parseWhole(text, value) || !std::isfinite(value)) {
        throw Error(field + ": '" + text + "' (allowed: a number)");
    }
    return value;
}

// A message "key=value;key=value".
class Fields {
public:
    explicit Fields(MessageCursor message) {
        for (const std::string& part : partsOf(textOf(message), ';')) {
            const size_t equals = std::min(part.find('='), part.size());
            fields_[part.substr(0, equals)] = equals < part.size() ? part.substr(equals + 1) : "";
        }
    }
    const std::string& at(const char* key) const {
        const auto found = fields_.find(key);
        if (found == fields_.end()) {
            throw Error(std::string(key) + ": missing");
        }
        return found->second;
    }
    double number(const char* key) const { return numberIn(key, at(key)); }
    uint32_t size(const char* key) const {
        const double value = number(key);
        if (!(value >= 1.0 && value <= 65535.0) || value != std::floor(value)) {
            throw Error(std::string(key) + ": " + at(key) + " (allowed: 1 to 65535)");
        }
        return static_cast<uint32_t>(value);
    }
    // Separated by commas.
    std::vector<double> numbers(const char* key, size_t count) const {
        std::vector<double> all;
        for (const std::string& part : partsOf(at(key), ',')) {
            all.push_back(numberIn(key, part));
        }
        if (all.size() != count) {
            throw Error(std::string(key) + ": " + std::to_string(all.size()) +
                        " numbers (allowed: " + std::to_string(count) + ")");
        }
        return all;
    }

private:
    std::map<std::string, std::string> fields_;
};

Intrinsics lensIn(const Fields& fields) {
    Intrinsics lens;
    lens.width = fields.size("width");
    lens.height = fields.size("height");
    lens.fx = fields.number("fx");
    lens.fy = fields.number("fy");
    lens.cx = fields.number("ppx");
    lens.cy = fields.number("ppy");
    const std::string& model = fields.at("model");
    const std::string allowed = setDistortion(lens, model, fields.numbers("coeffs", 5));
    if (!allowed.empty()) {
        throw Error("model: " + model + " (allowed: " + allowed + ")");
    }
    return lens;
}

Pose poseIn(const Fields& fields) {
    const std::vector<double> r = fields.numbers("rotation", 9), t = fields.numbers("translation", 3);
    std::array<double, 9> columns{}; // the SDK's order
    std::copy(r.begin(), r.end(), columns.begin());
    return ros::poseFromColumns(columns, {t[0], t[1], t[2]});
}

} // namespace

bool RealSenseRecording::recognises(const MessageFile& file) {
    return std::any_of(file.topics().begin(), file.topics().end(), isDeviceText);
}

RealSenseRecording::RealSenseRecording(std::unique_ptr<MessageFile> original)
    : TranslatedFile(std::move(original)) {
    translateTexts();
    std::vector<std::string> depths;
    for (const MessageTopic& topic : topics_) {
        if (isRealSenseTopic(topic.name) && namedRole(topic.name) == NamedRole::Depth) {
            depths.push_back(topic.name);
        }
    }
    for (const std::string& topic : depths) {
        addUnit(topic);
    }
}

void RealSenseRecording::translateTexts() {
    for (MessageTopic& topic : topics_) {
        if (!isDeviceText(topic)) {
            continue;
        }
        if (topic.name.ends_with("/camera_info")) {
            replace(topic, "sensor_msgs/CameraInfo", [](const MessageCursor& message) {
                return ros2::cameraInfo({}, lensIn(Fields(message)));
            });
        } else if (topic.name.find("/tf/ref_") != std::string::npos) {
            replace(topic, "geometry_msgs/Transform",
                    [](const MessageCursor& message) { return ros2::transform(poseIn(Fields(message))); });
        } else if (namedDepthUnits(topic.name)) {
            replace(topic, "std_msgs/Float32", [](const MessageCursor& message) {
                return ros2::float32(static_cast<float>(numberIn("value", textOf(message))));
            });
        }
    }
}

// Where the sensor has no option: from the metadata of the first image.
void RealSenseRecording::addUnit(const std::string& images) {
    const std::string options = optionsPrefix(images);
    const bool known = std::any_of(topics_.begin(), topics_.end(), [&](const MessageTopic& topic) {
        return topic.name.starts_with(options) && namedDepthUnits(topic.name) && !topic.messages.empty();
    });
    const MessageTopic* metadata = find(parentTopic(baseTopic(images), 1) + "/metadata");
    if (known || metadata == nullptr || metadata->messages.empty() || !isDeviceText(*metadata)) {
        return;
    }
    try {
        const double unit = Fields(read(*metadata, 0)).number("depth_units");
        add(options + "Depth_Units/value", "std_msgs/Float32", ros2::float32(static_cast<float>(unit)));
    } catch (const Error&) { // the camera says that there is no unit
    }
}

} // namespace fathom
