// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recorded_camera.h"

#include "devices/recorded/colour_image.h"
#include "devices/recorded/index_times.h"
#include "devices/recorded/lens_model.h"
#include "devices/recorded/recording_extrinsics.h"
#include "devices/recorded/small_units.h"
#include "devices/recorded/unread_poses.h"
#include "engine/types/error.h"
#include "engine/types/inside.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr double kMaxPairGap = 0.1; // [s] depth and colour of a pair, or half of medianPeriod()
constexpr size_t kMaxWarnings = 20; // skipped frames that are named in the summary, too

const fs::path& existingFolder(const fs::path& folder) {
    std::error_code failed;
    if (!fs::is_directory(folder, failed)) {
        throw BadInput(folder.string(), "folder", "missing", "an existing recording folder (TUM RGB-D)");
    }
    if (fs::is_empty(folder, failed)) {
        throw BadInput(folder.string(), "folder", "empty", "a recording folder (TUM RGB-D)");
    }
    return folder;
}

PngSize sizeOf(const Intrinsics& lens) {
    return {lens.width, lens.height};
}

} // namespace

RecordedCamera::RecordedCamera(const fs::path& folder, const SourceOptions& options)
    : folder_(existingFolder(folder))
    , layout_(readLayout(folder, options)) {
    options.checkNoTopics(folder_.string());
    warnings_ = settleTimes(layout_, folder_);
    std::ranges::for_each(layout_.warnings, [this](const std::string& warning) { warn(warning); });
    mostApart_ = std::max(kMaxPairGap, 0.5 * medianPeriod(layout_.index));
    useOptions(options);
    std::ranges::for_each(lensWarnings(info()), [this](const std::string& warning) { warn(warning); });
    if (const std::string poses = info().poseless ? unreadPoses(folder_, layout_.index.size()) : "";
        !poses.empty()) {
        log::warn("{}: {}", folder_.string(), poses);
    }
    if (info().hasColour) {
        takeColourFormat();
    }
    slots_.emplace(info().slotPixels(), info().hasColour, kFramesInFlight + 2);
}

// Warns of stamps that would be those of a camera in milliseconds, microseconds or nanoseconds.
void RecordedCamera::warnAboutStamps() {
    const std::vector<IndexLine>& index = layout_.index;
    if (index.size() < 2) {
        return;
    }
    if (countFrames(index)) {
        warn(
            "its stamps are whole numbers that rise by 1: they are read as seconds, but look like numbers of "
            "frames");
    }
    const double whole = index.back().depthStamp - index.front().depthStamp;
    const double period = whole / static_cast<double>(index.size() - 1);
    if (const SmallUnit* unit = smallUnitOf(period)) {
        warn(significant(period, 6) + " s between its frames: stamps are read as seconds, but look like " +
             unit->name);
    }
}

void RecordedCamera::warn(const std::string& warning) {
    log::warn("{}: {}", folder_.string(), warning);
    warnings_.push_back(warning);
}

void RecordedCamera::useOptions(const SourceOptions& options) {
    CameraInfo& camera = layout_.intrinsics.camera;
    depth_.emplace(folder_, layout_, options);
    camera.metresPerUnit = depth_->metresPerUnit();
    camera.poseless = !layout_.poses && !layout_.posePerImage;
    camera.hasColour = camera.hasColour && !options.depthOnly();
    if (!options.extrinsics.empty()) {
        camera.registered = false;
        camera.colourTdepth = readExtrinsics(options.extrinsics);
    }
    warnAboutStamps();
    std::vector<IndexLine>& index = layout_.index;
    if (options.start == 0.0 && std::isinf(options.duration)) {
        return;
    }
    const double first = index.front().depthStamp + options.start;
    const bool start = first > index.back().depthStamp; // no duration would hold a frame
    std::erase_if(index, [&](const IndexLine& line) {
        return line.depthStamp < first || line.depthStamp >= first + options.duration;
    });
    if (index.empty()) {
        throw BadInput(folder_.string(), start ? "start" : "duration",
                       std::to_string(start ? options.start : options.duration),
                       start ? "a time before the last frame" : "a time with at least one frame");
    }
}

// That of the first image of the stated size. A single image of another size is a bad frame; a colour stream
// that never has the stated size is a recording without registration.
void RecordedCamera::takeColourFormat() {
    const PngSize wanted = sizeOf(info().colour);
    std::optional<PngSize> other;
    for (const IndexLine& line : layout_.index) {
        const auto colour = colourImageSize(line.colour);
        if (colour == wanted) {
            layout_.intrinsics.camera.colourFormat = colourImageFormat(line.colour);
            return;
        }
        if (colour && depthImageHeader(line.depth).size == sizeOf(info().depth)) {
            other = colour;
        }
    }
    if (other) {
        const std::string& file = layout_.intrinsics.file; // empty: a lens that is known
        throw BadInput(
            folder_.string() + (file.empty() ? "" : ": " + file), "color.width, color.height",
            "colour images of " + sizeText(other->width, other->height) + " where " +
                (file.empty() ? "the usual lens of this layout has " + sizeText(wanted.width, wanted.height)
                              : sizeText(wanted.width, wanted.height) + " is stated"),
            "colour of the depth's size, or blocks depth and color with extrinsics_topic_tf, in the "
            "layout's file or in intrinsics=FILE after the folder name");
    }
}

std::string RecordedCamera::read(const IndexLine& line, FrameSlot& slot, RawColour& raw) {
    if (!line.fault.empty()) {
        return line.fault;
    }
    if (lastStamp_ && line.depthStamp < *lastStamp_) {
        return "depth stamp " + std::to_string(line.depthStamp) + " goes back from " +
               std::to_string(*lastStamp_);
    }
    if (layout_.poses && !layout_.poses->at(line.depthStamp)) {
        return layout_.poses->whyNone(line.depthStamp);
    }
    if (info().hasColour && !(std::abs(line.colourStamp - line.depthStamp) <= mostApart_)) {
        return "its colour is " + std::to_string(std::abs(line.colourStamp - line.depthStamp)) +
               " s from its depth, over " + std::to_string(mostApart_) + " s";
    }
    const CameraInfo& camera = info();
    std::string fault = depth_->read(line.depth, slot.depth().first(camera.depth.pixels()));
    if (!fault.empty()) {
        return line.depth.string() + ": " + fault +
               (line.orderGuessed ? " (colour comes first in associations.txt where no path names depth)"
                                  : "");
    }
    if (!camera.hasColour) {
        return "";
    }
    fault = readColourImage(line.colour, sizeOf(camera.colour), slot.colour(), raw);
    if (fault.empty() && raw.format != camera.colourFormat) {
        fault = camera.colourFormat == ColourFormat::Rgba ? "a JPEG, but the first colour image is a PNG"
                                                          : "a PNG, but the first colour image is a JPEG";
    }
    return fault.empty() ? "" : line.colour.string() + ": " + fault;
}

Frame RecordedCamera::lease(uint32_t index, FrameSlot& slot, const RawColour& raw) const {
    Frame::Content content;
    content.index = index;
    content.sourceNumber = index;
    content.captureTime = layout_.index[index].depthStamp;
    content.depth = slot.depth().first(info().depth.pixels());
    content.raw = raw;
    if (info().hasColour && !content.isRaw()) {
        content.colour = slot.colour().first(info().colour.pixels());
    }
    if (layout_.poses) {
        content.baseTcamera = layout_.poses->at(content.captureTime);
    } else if (layout_.index[index].baseTcamera) {
        content.baseTcamera = layout_.index[index].baseTcamera;
    }
    return slot.lend(content);
}

// Logged immediately after the first valid frame, or deferred until it. If none comes, the final error
// reports them.
void RecordedCamera::skip(uint32_t index, const std::string& fault) {
    if (index < named_) { // already reported before a seek()
        return;
    }
    named_ = index + 1;
    ++skipped_;
    unnamed_.push_back("frame " + std::to_string(index) + " skipped: " + fault);
    if (firstFault_.empty()) {
        firstFault_ = fault;
    }
    if (warnings_.size() < kMaxWarnings) {
        warnings_.push_back(unnamed_.back());
    }
}

void RecordedCamera::nameSkipped() {
    for (const std::string& line : unnamed_) {
        log::warn("{}: {}", folder_.string(), line);
    }
    unnamed_.clear();
}

std::vector<std::string> RecordedCamera::warnings() const {
    std::vector<std::string> all = warnings_;
    if (skipped_ > all.size()) {
        all.push_back(std::to_string(skipped_ - all.size()) + " more frames skipped");
    }
    std::ranges::copy(depth_->warnings(), std::back_inserter(all));
    return all;
}

bool RecordedCamera::seek(uint32_t index) {
    if (index >= layout_.index.size()) {
        return false;
    }
    cursor_ = index;
    lastStamp_.reset();
    return true;
}

// Paths that leave the folder are a fault (readIndex). Links are followed with a warning: the user may have
// made them, but they may also have come with the recording.
void RecordedCamera::warnAboutLinks(const IndexLine& line) {
    for (const fs::path& image : {line.depth, line.colour}) {
        if (!warnedAboutLinks_ && !image.empty() && leadsOut(image)) {
            log::warn("{}: a link points outside the recording's folder", image.string());
            warnedAboutLinks_ = true;
        }
    }
}

// Each image folder is checked once for links that leave the recording.
bool RecordedCamera::leadsOut(const fs::path& image) {
    std::error_code unknown;
    if (fs::is_symlink(image, unknown)) {
        return !liesInside(image, folder_);
    }
    const fs::path parent = image.parent_path();
    return judged_.insert(parent.string()).second && !liesInside(parent, folder_);
}

std::optional<Frame> RecordedCamera::next() {
    if (cursor_ == layout_.index.size()) {
        return std::nullopt;
    }
    FrameSlot* slot = &slots_->acquireFor(description());
    while (cursor_ < layout_.index.size()) {
        const uint32_t index = cursor_++;
        warnAboutLinks(layout_.index[index]);
        RawColour raw;
        const std::string fault = read(layout_.index[index], *slot, raw);
        if (fault.empty()) {
            lastStamp_ = layout_.index[index].depthStamp;
            any_ = true;
            nameSkipped();
            return lease(index, *slot, raw);
        }
        skip(index, fault);
    }
    slot->release();
    if (any_) {
        nameSkipped();
    } else {
        throw BadInput(folder_.string(), "frames",
                       "none of " + std::to_string(layout_.index.size()) +
                           " is usable; first: " + firstFault_,
                       "at least one usable pair of images" +
                           (layout_.intrinsics.file.empty() ? ", of the size of this layout's usual lens; or "
                                                              "intrinsics=FILE after the folder name"
                                                            : ", of the size in " + layout_.intrinsics.file));
    }
    return std::nullopt;
}

} // namespace fathom
