// SPDX-License-Identifier: Apache-2.0
// The byte order and the depth unit of BagCamera.
#include "devices/bag/bag_camera.h"
#include "devices/bag/image_faults.h"
#include "devices/images/metre_units.h"
#include "devices/recorded/depth_scale.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"

#include <cmath>

namespace fathom {

namespace {

constexpr double kMillimetre = 0.001; // REP 118: 16-bit depth
constexpr size_t kUnitSamples = 9;

} // namespace

void BagCamera::judgeOrder() {
    bigEndian_ = orderInstead(choice_.depth.name, [&](size_t i) -> Judged {
        const Image image = imageOf(choice_.depth, i);
        const bool ofStream = depthFault(choice_.depth, image, info()).empty();
        return {ofStream ? ros::depthOrder(image) : ByteOrder::Unknown, image.bigEndian};
    });
}

// An SDK's option of the depth stream; null = none.
const MessageTopic* BagCamera::unitTopic() const {
    const std::string options = optionsPrefix(choice_.depth.name);
    for (const MessageTopic& topic : file_->topics()) {
        if (!options.empty() && topic.name.starts_with(options) && namedDepthUnits(topic.name) &&
            !topic.messages.empty()) {
            return &topic;
        }
    }
    return nullptr;
}

// By the option, else by the file of the lens, else millimetres.
double BagCamera::sensorUnit() {
    const MessageTopic* topic = unitTopic();
    if (topic == nullptr && (choice_.statedUnit || !choice_.unreadScale.empty())) {
        warnOfUnit(choice_.unitWarning);
        return choice_.statedUnit ? *choice_.statedUnit : throw BadInput(choice_.unreadScale);
    }
    if (topic == nullptr) {
        if (isSdkTopic(choice_.depth.name)) {
            const bool orbbec = !orbbecSensor(choice_.depth.name).empty();
            const std::string missing = std::string("no ") +
                                        (orbbec ? "depth unit in /cam/property (75 or 176)"
                                                : "option Depth_Units next to " + choice_.depth.name) +
                                        ": depth is read as millimetres";
            log::warn("{}: {}; scale=M after the file name gives another unit{}", file_->file().string(),
                      missing, orbbec ? "" : " (D405: 0.0001, L515: 0.00025)");
            addWarning(missing);
        }
        return kMillimetre;
    }
    // Stored as float: use 0.001, not 0.0010000000474974513.
    const double unit = std::round(1e9 * static_cast<double>(ros::float32(file_->read(*topic, 0)))) * 1e-9;
    if (!(unit >= kFinestUnit && unit <= kCoarsestUnit)) {
        throw BadInput(file_->file().string(), topic->name, significant(unit, 6),
                       "0.000001 to 0.1 metres per unit, or scale=M after the file name");
    }
    const std::string both = choice_.statedUnit ? unitsDiffer(options_.intrinsics.filename().string(),
                                                              *choice_.statedUnit, topic->name, unit)
                                                : "";
    warnOfUnit(both);
    return unit;
}

void BagCamera::warnOfUnit(const std::string& warning) {
    if (!warning.empty()) {
        log::warn("{}: {}", file_->file().string(), warning);
        addWarning(warning);
    }
}

ValueSpan BagCamera::sampledMetres() {
    ValueSpan seen;
    sample(kUnitSamples, [&](size_t i) {
        try {
            seen.add(ros::valueSpan(depthAt(i)));
        } catch (const Error&) { // named when it is played
        }
    });
    return seen;
}

// Metres get the finest unit that holds one and a half times the farthest depth seen, or the scene's far.
void BagCamera::chooseUnit() {
    CameraInfo& camera = choice_.camera;
    if (!choice_.depth.metres) {
        options_.checkUnit(file_->file().string());
        camera.metresPerUnit = options_.scale ? *options_.scale : sensorUnit();
        return;
    }
    const double metresPerValue = options_.scale.value_or(1.0);
    options_.checkMetres(file_->file().string());
    const ValueSpan seen = sampledMetres().scaled(metresPerValue);
    addWarning(metresWarning(file_->file().string(), seen));
    camera.metresPerUnit = unitForMetres(seen, options_.farthest);
    valuesPerUnit_ = camera.metresPerUnit / metresPerValue;
}

} // namespace fathom
