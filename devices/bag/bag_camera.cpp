// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/bag_camera.h"

#include "devices/bag/image_faults.h"
#include "devices/bag/stream_chooser.h"
#include "devices/recorded/lens_model.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom {

namespace {

constexpr size_t kPairSamples = 9;

} // namespace

BagCamera::BagCamera(const std::filesystem::path& file, SourceOptions options)
    : BagCamera(openMessageFile(file), std::move(options)) {}

BagCamera::BagCamera(std::unique_ptr<MessageFile> file, SourceOptions options)
    : MessageCamera(std::move(file), std::move(options)) {
    try {
        choice_ = StreamChooser(*file_, options_).choose();
        logWarnings();
        warnOfMotion(choice_.depth.frame);
        useSpan(topicOf(choice_.depth));
        if (!choice_.depth.compressed) {
            judgeOrder();
        }
        chooseUnit();
        useClocks();
        watchChanges();
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(file_->file().string(), "content", e.what(), "whole messages");
    }
    toAxis_ = choice_.rangeImages ? RangeToAxis(info().depth) : RangeToAxis();
    slots_.emplace(info().slotPixels(), info().hasColour, kFramesInFlight + 1);
}

void BagCamera::logWarnings() {
    std::ranges::copy(lensWarnings(choice_.camera), std::back_inserter(choice_.warnings));
    for (const std::string& warning : choice_.warnings) {
        log::warn("{}: {}", file_->file().string(), warning);
        addWarning(warning);
    }
}

std::string BagCamera::streamOptions() const {
    return ",depth=" + choice_.depth.name + ",colour=" + (choice_.colour ? choice_.colour->name : "none");
}

std::string BagCamera::whyNoColour() const {
    if (!choice_.colour) {
        return choice_.unread.empty() ? "the recording has no colour stream"
                                      : "no colour stream is read; not read: " + choice_.unread +
                                            " (read are " + ros::kColourEncodings + ")";
    }
    return choice_.colour->content == ros::Content::Grey
               ? "its only other stream is grey: " + choice_.colour->name + " (" + choice_.colour->encoding +
                     ")"
               : "";
}

void BagCamera::useClocks() {
    useClock(topicOf(choice_.depth));
    if (!choice_.colour) {
        return;
    }
    colour_.emplace(*file_, topicOf(*choice_.colour));
    const auto setTolerance = [this] {
        const double slower = std::max(depth_->period(), colour_->period());
        tolerance_ = slower > 0.0 ? 0.5 * slower : 0.05;
    };
    setTolerance();
    if (depth_->stamped() && colour_->stamped() && pairsByStamp()) {
        return;
    }
    if (depth_->stamped()) { // else said already
        log::warn(
            "{}: no stamps of {} and {} are within {:.3f} s (the first ones differ by {:.3f} s): images are "
            "paired by the time of recording",
            file_->file().string(), choice_.depth.name, choice_.colour->name, tolerance_,
            colour_->stampOf(0) - depth_->stampOf(0));
    }
    depth_->useRecordingTime();
    colour_->useRecordingTime();
    setTolerance();
}

// Whether images have partners by the headers' stamps. Far from each other in the file, only where it was
// written later, where stamps agree, or where no images were recorded at one time: two clocks may differ by
// any time.
bool BagCamera::pairsByStamp() {
    const std::vector<MessageEntry>& all = topicOf(choice_.depth).messages;
    const auto byStamp = [&](size_t i) {
        return colour_->nearest(depth_->stampOf(i), all[i].time, tolerance_).has_value();
    };
    if (!depth_->recordedInTime() || !colour_->recordedInTime()) {
        colour_->searchAll();
    } else if (anyOfSome(byStamp)) {
        return true;
    } else {
        colour_->searchAll();
        if (stampsAgree()) {
            return true; // one topic was recorded late
        }
        size_t recorded = 0; // one alone may end one topic and begin the next
        if (anyOfSome([&](size_t i) {
                recorded += colour_->hasRecorded(all[i].time, tolerance_) ? 1 : 0;
                return recorded > 1;
            })) {
            return false;
        }
    }
    return anyOfSome(byStamp);
}

// Some images: at the start, and over the whole recording.
bool BagCamera::anyOfSome(const std::function<bool(size_t)>& holds) const {
    for (size_t i = cursor_; i < std::min<size_t>(end_, cursor_ + kPairSamples); ++i) {
        if (holds(i)) {
            return true;
        }
    }
    bool any = false;
    sample(kPairSamples, [&](size_t i) { any = any || holds(i); });
    return any;
}

// Options and lenses that have several messages may change.
void BagCamera::watchChanges() {
    const auto watch = [&](std::optional<ChangedMessages>& to, const MessageTopic* topic) {
        if (topic != nullptr && topic->messages.size() > 1) {
            to.emplace(*file_, *topic);
        }
    };
    // Of a lens that is used, and not replaced by a file.
    const auto lens = [&](const ImageStream& stream, const Intrinsics& used) {
        return stream.info && sameLens(*stream.lens, used) ? &file_->topics()[*stream.info] : nullptr;
    };
    if (!options_.scale && !choice_.depth.metres) {
        watch(units_, unitTopic());
    }
    watch(depthLenses_, lens(choice_.depth, info().depth));
    if (choice_.colour) {
        watch(colourLenses_, lens(*choice_.colour, info().colour));
    }
}

// What differs from the first frame at this time of recording; empty = nothing.
std::string BagCamera::changed(uint64_t time) {
    const auto lensFault = [](const ImageStream& stream) {
        return [&stream](const MessageCursor& message) -> std::string {
            const ros::CameraInfo info = ros::cameraInfo(message);
            Intrinsics now = info.lens(stream.rectified);
            if (stream.unsized) {
                now.width = stream.lens->width;
                now.height = stream.lens->height;
            }
            return nearlySameLens(*stream.lens, now)
                       ? ""
                       : "the lens of " + stream.name + " changes from fx " +
                             std::to_string(stream.lens->fx) + " to " + std::to_string(now.fx);
        };
    };
    std::string fault;
    if (units_) {
        fault = units_->at(time, [&](const MessageCursor& message) -> std::string {
            const double now = static_cast<double>(ros::float32(message)), first = info().metresPerUnit;
            return std::abs(now - first) <= 1e-6 * first
                       ? ""
                       : "the depth unit changes from " + significant(first, 6) + " to " +
                             significant(now, 6) + " m";
        });
    }
    if (fault.empty() && depthLenses_) {
        fault = depthLenses_->at(time, lensFault(choice_.depth));
    }
    if (fault.empty() && colourLenses_) {
        fault = colourLenses_->at(time, lensFault(*choice_.colour));
    }
    return fault;
}

ros::Image BagCamera::imageOf(const ImageStream& stream, size_t index) {
    const MessageCursor message = file_->read(topicOf(stream), index);
    Image image = stream.compressed ? ros::compressedImage(message) : ros::image(message);
    warnOnce(stream.name, ros::correctStep(image));
    return image;
}

ros::Image BagCamera::depthAt(size_t index) {
    Image image = imageOf(choice_.depth, index);
    image.bigEndian = bigEndian_.value_or(image.bigEndian);
    return image;
}

// Returns the fault; empty when the slot is filled.
std::string BagCamera::read(size_t index, FrameSlot& slot, double stamp, Frame::Content& content) {
    const Image depth = depthAt(index);
    if (const std::string other = depthFault(choice_.depth, depth, info()); !other.empty()) {
        return choice_.depth.name + ": " + other;
    }
    if (const std::string other = changed(topicOf(choice_.depth).messages[index].time); !other.empty()) {
        return other;
    }
    uint64_t beyond = 0;
    const std::string fault = ros::depthRows(depth, valuesPerUnit_, slot.depth(), beyond);
    if (!fault.empty()) {
        return fault;
    }
    warnBeyond(index, beyond);
    toAxis_.convert(slot.depth());
    return colour_ ? readColour(index, stamp, slot, content.raw) : "";
}

std::string BagCamera::readColour(size_t depthIndex, double stamp, FrameSlot& slot, RawColour& raw) {
    const auto pair = colour_->nearest(stamp, topicOf(choice_.depth).messages[depthIndex].time, tolerance_);
    if (!pair) {
        return "no colour frame within " + std::to_string(tolerance_) + " s";
    }
    const Image colour = imageOf(*choice_.colour, *pair);
    if (const std::string other = colourFault(*choice_.colour, colour, info()); !other.empty()) {
        return choice_.colour->name + ": " + other;
    }
    return ros::colourRows(colour, slot.colour(), raw);
}

} // namespace fathom
