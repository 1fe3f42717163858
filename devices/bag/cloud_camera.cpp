// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/cloud_camera.h"

#include "devices/bag/image_faults.h"
#include "devices/bag/topic_words.h"
#include "devices/images/metre_units.h"
#include "devices/pcd/colour_fields.h"
#include "devices/pcd/pcd_file.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

namespace fathom {

namespace {

constexpr size_t kLensSamples = 9; // clouds that are looked at for lens and unit

// Root of the mean square distance [pixels] of points from their pixels that is allowed: a pixel, and in
// small images a hundredth of the width, where a pixel is a wide angle.
double mostOff(const Intrinsics& lens) {
    return std::min(1.0, 0.01 * lens.width);
}

// Root of the mean square distance [pixels] of the points from their pixels; 0 without points.
double deviation(const PcdCloud& cloud, const FittedLens& fit) {
    double sum = 0.0, count = 0.0;
    for (size_t i = 0; i < cloud.points.size(); ++i) {
        const dvec3 p = fit.opticalTcloud * cloud.points[i];
        if (isMeasured(p)) {
            const size_t column = i % cloud.width, row = i / cloud.width;
            const glm::dvec2 off = fit.lens.project(p) - glm::dvec2(column, row);
            sum += off.x * off.x + off.y * off.y;
            count += 1.0;
        }
    }
    return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

// Whether a program took the cloud from a camera's: points may lack. "/camera/depth/obstacles".
bool namedComputed(const std::string& topic) {
    constexpr std::array<std::string_view, 34> kComputed{
        "obstacle",  "ground",    "nonground",    "floor",    "plane",       "table",      "filtered",
        "segment",   "segmented", "segmentation", "cluster",  "object",      "inlier",     "outlier",
        "crop",      "cropped",   "downsampled",  "voxel",    "voxelized",   "foreground", "background",
        "roi",       "removed",   "map",          "hull",     "target",      "detection",  "grasp",
        "candidate", "masked",    "labeled",      "labelled", "transformed", "accumulated"};
    const size_t first = topic.find('/', 1);
    const bool robot = first != std::string::npos && topic.find('/', first + 1) != std::string::npos;
    const auto words = withoutDigits(camelWordsOf(topic.substr(robot ? first : 0)));
    return std::ranges::any_of(words, [&](std::string word) {
        word.erase(word.ends_with('s') ? word.size() - 1 : word.size());
        return std::ranges::find(kComputed, word) != kComputed.end();
    });
}

// "/camera/depth_registered/points".
bool namedPoints(const std::string& topic) {
    const auto words = camelWordsOf(topic.substr(topic.find_last_of('/') + 1));
    return std::ranges::find(words, "points") != words.end();
}

} // namespace

bool playsClouds(MessageFile& file, const SourceOptions& options) {
    const auto& topics = file.topics();
    const auto isCloud = [](const MessageTopic& t) {
        return t.type == ros::kCloudType && !t.messages.empty();
    };
    if (!options.depth.empty()) {
        const MessageTopic* requested = file.find(options.depth);
        return requested != nullptr && isCloud(*requested);
    }
    if (std::none_of(topics.begin(), topics.end(), isCloud)) {
        return false;
    }
    const auto streams = imageStreams(file, options.info);
    return std::none_of(streams.begin(), streams.end(), mayBeDepth);
}

CloudCamera::CloudCamera(std::unique_ptr<MessageFile> file, SourceOptions options)
    : MessageCamera(std::move(file), std::move(options))
    , metresPerValue_(options_.scale.value_or(1.0)) {
    checkOptions();
    options_.checkMetres(file_->file().string());
    chooseTopic();
    useSpan(topic());
    judgeOrder();
    learnLens();
    warnOfMotion(frame_);
    useClock(topic());
    slots_.emplace(info_.depth.pixels(), info_.hasColour, kFramesInFlight + 1);
}

void CloudCamera::refuse(const std::string& field, const std::string& value,
                         const std::string& allowed) const {
    throw BadInput(file_->file().string(), field, value, allowed);
}

void CloudCamera::checkOptions() const {
    if (!options_.intrinsics.empty() || !options_.extrinsics.empty()) {
        refuse(options_.intrinsics.empty() ? "extrinsics" : "intrinsics", "for clouds",
               "neither: lens and colour follow from the points");
    }
    if (!options_.colour.empty() && options_.colour != "none") {
        refuse("colour", options_.colour, "colour=none, or nothing: clouds hold their colour");
    }
}

// The requested topic; else the first organised one of the best: a camera's own, with colour, named points.
void CloudCamera::chooseTopic() {
    using Score = std::tuple<bool, bool, bool>;
    std::string fault, others;
    std::optional<Score> best;
    for (size_t i = 0; i < file_->topics().size(); ++i) {
        const MessageTopic& topic = file_->topics()[i];
        if (topic.type != ros::kCloudType || topic.messages.empty() ||
            (!options_.depth.empty() && topic.name != options_.depth)) {
            continue;
        }
        std::string why;
        Score score;
        try {
            const ros::Cloud first = ros::cloud(file_->read(topic, 0));
            why = ros::whyNoDepth(first);
            const std::vector<PcdField> fields = first.insideFields();
            score = {!namedComputed(topic.name), bool(ColourFields(fields)), namedPoints(topic.name)};
        } catch (const Error& e) {
            why = e.what();
        }
        if (why.empty() && (!best || score > *best)) {
            best = score;
            topic_ = i;
        }
        fault = fault.empty() && !why.empty() ? topic.name + ": " + why : fault;
    }
    if (!best) {
        throw BadInput(file_->file().string() + ": " + fault);
    }
    for (const MessageTopic& other : file_->topics()) {
        if (other.type == ros::kCloudType && other.name != topic().name) {
            others += (others.empty() ? "; not used: " : ", ") + other.name;
        }
    }
    summary_ = "depth " + topic().name + " (organised cloud)" + others;
}

// Fits lens and axes; why they do not fit, empty = they do.
std::string CloudCamera::fit(const ros::Cloud& message, const PcdCloud& cloud) {
    fit_ = fitLens(cloud);
    frame_ = message.frame;
    info_.hasColour = !cloud.colour.empty() && options_.colour != "none";
    uncoloured_ = cloud.colour.empty() ? cloud.uncoloured : uncoloured_;
    if (fit_.residual <= mostOff(fit_.lens)) {
        return "";
    }
    return "points of frame '" + message.frame + "' deviate from the rays of a pinhole and of a fan" +
           (fit_.fault.empty() ? " by " + std::to_string(fit_.residual) + " pixels" : ": " + fit_.fault);
}

void CloudCamera::judgeOrder() {
    bigEndian_ = orderInstead(topic().name, [&](size_t i) -> Judged {
        const ros::Cloud cloud = cloudAt(i);
        return {ros::whyNoDepth(cloud).empty() ? ros::pointsOrder(cloud) : ByteOrder::Unknown,
                cloud.bigEndian};
    });
}

void CloudCamera::learnLens() {
    std::string fault = "no points";
    ValueSpan seen;
    sample(kLensSamples, [&](size_t i) {
        try {
            const ros::Cloud message = cloudAt(i);
            if (const std::string why = ros::whyNoDepth(message); !why.empty()) {
                throw Error(why);
            }
            const PcdCloud cloud = ros::pointsOf(message, largestLevel_);
            fault = fault.empty() ? "" : fit(message, cloud);
            for (const dvec3& point : cloud.points) {
                const dvec3 p = metresPerValue_ * (fit_.opticalTcloud * point);
                seen.add(isMeasured(p) ? p.z : 0.0);
            }
        } catch (const Error& e) {
            fault = fault.empty() ? "" : e.what();
        }
    });
    if (!fault.empty()) {
        refuse(topic().name, fault,
               "clouds in the frame of their camera: x right and y down, y up and z backward, or x forward "
               "and z up; points without a measurement are NaN or 0");
    }
    addWarning(metresWarning(file_->file().string(), seen));
    if (const std::string warning = lensWarning(fit_.lens); !warning.empty()) {
        log::warn("{}: {}: {}", file_->file().string(), topic().name, warning);
        addWarning(warning);
    }
    info_.depth = info_.colour = fit_.lens;
    info_.poseless = true;
    info_.metresPerUnit = unitForMetres(seen, options_.farthest);
}

// Returns the fault; empty when the slot is filled.
std::string CloudCamera::read(size_t index, FrameSlot& slot, double, Frame::Content&) {
    const ros::Cloud message = cloudAt(index);
    if (message.width != info_.depth.width || message.height != info_.depth.height) {
        return "size differs from the first cloud";
    }
    if (const std::string other = otherFrame(frame_, message.frame); !other.empty()) {
        return other;
    }
    if (const std::string why = ros::whyNoDepth(message); !why.empty()) {
        return why;
    }
    const PcdCloud cloud = ros::pointsOf(message, largestLevel_);
    if (info_.hasColour && cloud.colour.empty()) {
        return cloud.uncoloured;
    }
    if (const double off = deviation(cloud, fit_); off > mostOff(info_.depth)) {
        return "its points deviate from the lens of the first cloud by " + std::to_string(off) + " pixels";
    }
    uint64_t beyond = 0;
    const double valuesPerUnit = info_.metresPerUnit / metresPerValue_;
    for (size_t i = 0; i < cloud.points.size(); ++i) {
        const dvec3 p = fit_.opticalTcloud * cloud.points[i];
        slot.depth()[i] = isMeasured(p) ? unitsOf(p.z, valuesPerUnit, beyond) : uint16_t{0};
    }
    warnBeyond(index, beyond);
    if (info_.hasColour) {
        std::copy(cloud.colour.begin(), cloud.colour.end(), slot.colour().begin());
    }
    return "";
}

} // namespace fathom
