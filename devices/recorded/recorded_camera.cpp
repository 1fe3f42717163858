// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recorded_camera.h"

#include "devices/recorded/png_image.h"
#include "engine/types/error.h"
#include "engine/types/inside.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr double kMostApart = 0.1;   // [s] depth and colour of a pair
constexpr size_t kMostWarnings = 20; // skipped frames that are named in the summary, too

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

std::optional<PoseTrack> readPoses(const fs::path& folder) {
    const fs::path file = folder / "poses.txt";
    return fs::exists(file) ? std::optional<PoseTrack>(file) : std::nullopt;
}

PngSize sizeOf(const Intrinsics& lens) {
    return {lens.width, lens.height};
}

std::string words(PngSize size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

} // namespace

RecordedCamera::RecordedCamera(const fs::path& folder)
    : folder_(existingFolder(folder))
    , intrinsics_(readIntrinsics(folder / "intrinsics.json"))
    , index_(readIndex(folder, intrinsics_))
    , poses_(readPoses(folder))
    , slots_(std::max(intrinsics_.camera.depth.pixels(), intrinsics_.camera.colour.pixels()),
             intrinsics_.camera.hasColour, kFramesInFlight + 2) {
    if (info().hasColour) {
        checkColourSize();
    }
    const Intrinsics& lens = info().depth;
    for (uint32_t i = 0; intrinsics_.rangeImages && i < lens.pixels(); ++i) {
        const uint32_t column = i % lens.width, row = i / lens.width;
        const dvec3 ray(lens.ray(column, row), 1.0);
        axisShare_.push_back(static_cast<float>(1.0 / glm::length(ray)));
    }
}

void RecordedCamera::toDepth(std::span<uint16_t> ranges) const {
    for (size_t i = 0; i < axisShare_.size(); ++i) {
        ranges[i] = static_cast<uint16_t>(static_cast<float>(ranges[i]) * axisShare_[i] + 0.5f);
    }
}

// A single image of another size is a bad frame; a colour stream that never has the stated size is a
// recording without registration.
void RecordedCamera::checkColourSize() const {
    const PngSize wanted = sizeOf(info().colour);
    std::optional<PngSize> other;
    for (const IndexLine& line : index_) {
        const auto depth = readPngSize(line.depth), colour = readPngSize(line.colour);
        if (colour == wanted) {
            return;
        }
        if (depth == sizeOf(info().depth) && colour) {
            other = colour;
        }
    }
    if (other) {
        throw BadInput((folder_ / "intrinsics.json").string(), "color.width, color.height",
                       "colour images of " + words(*other) + " where " + words(wanted) + " is told",
                       "colour of the depth's size, or blocks depth and color with extrinsics_topic_tf");
    }
}

std::string RecordedCamera::read(const IndexLine& line, FrameSlot& slot) const {
    if (!line.fault.empty()) {
        return line.fault;
    }
    if (lastStamp_ && line.depthStamp < *lastStamp_) {
        return "depth stamp " + std::to_string(line.depthStamp) + " goes back from " +
               std::to_string(*lastStamp_);
    }
    if (poses_ && !poses_->at(line.depthStamp)) {
        return poses_->whyNone(line.depthStamp);
    }
    if (info().hasColour && !(std::abs(line.colourStamp - line.depthStamp) <= kMostApart)) {
        return "its colour is " + std::to_string(std::abs(line.colourStamp - line.depthStamp)) +
               " s from its depth, over " + std::to_string(kMostApart) + " s";
    }
    const CameraInfo& camera = info();
    std::string fault =
        readDepthPng(line.depth, sizeOf(camera.depth), slot.depth().first(camera.depth.pixels()));
    if (!fault.empty()) {
        return line.depth.string() + ": " + fault;
    }
    toDepth(slot.depth());
    if (!camera.hasColour) {
        return "";
    }
    fault = readColourPng(line.colour, sizeOf(camera.colour), slot.colour().first(camera.colour.pixels()));
    return fault.empty() ? "" : line.colour.string() + ": " + fault;
}

Frame RecordedCamera::lease(uint32_t index, FrameSlot& slot) const {
    Frame::Content content;
    content.index = index;
    content.sourceNumber = index;
    content.captureTime = index_[index].depthStamp;
    content.depth = slot.depth().first(info().depth.pixels());
    content.colour = slot.colour().first(info().hasColour ? info().colour.pixels() : 0);
    if (poses_) {
        content.baseTcamera = poses_->at(content.captureTime);
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
    if (warnings_.size() < kMostWarnings) {
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
    return all;
}

bool RecordedCamera::seek(uint32_t index) {
    if (index >= index_.size()) {
        return false;
    }
    cursor_ = index;
    lastStamp_.reset();
    return true;
}

// Paths that leave the folder are a fault (readIndex). Links are followed with a warning: the user may have
// made them, but they may also have come with the recording.
void RecordedCamera::tellOfLinks(const IndexLine& line) {
    for (const fs::path& image : {line.depth, line.colour}) {
        if (!toldOfLinks_ && !image.empty() && leadsOut(image)) {
            log::warn("{}: a link points outside the recording's folder", image.string());
            toldOfLinks_ = true;
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
    if (cursor_ == index_.size()) {
        return std::nullopt;
    }
    FrameSlot* slot = slots_.acquire();
    if (slot == nullptr) {
        throw Error(description() + ": all frame buffers are leased");
    }
    while (cursor_ < index_.size()) {
        const uint32_t index = cursor_++;
        tellOfLinks(index_[index]);
        const std::string fault = read(index_[index], *slot);
        if (fault.empty()) {
            lastStamp_ = index_[index].depthStamp;
            any_ = true;
            nameSkipped();
            return lease(index, *slot);
        }
        skip(index, fault);
    }
    slot->release();
    if (any_) {
        nameSkipped();
    } else {
        throw BadInput(folder_.string(), "frames",
                       "none of " + std::to_string(index_.size()) + " is usable; first: " + firstFault_,
                       "at least one usable pair of images");
    }
    return std::nullopt;
}

} // namespace fathom
