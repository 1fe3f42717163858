// SPDX-License-Identifier: Apache-2.0
// Camera that plays a recording folder once, pair by pair, on request: TUM RGB-D, Open3D, BOP, 7-Scenes or
// ScanNet.
#pragma once

#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/recorded/folder_depth.h"
#include "devices/recorded/recording_layout.h"
#include "devices/recorded/source_options.h"

#include <filesystem>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace fathom {

// Frame index and source number = data line of the index from 0; capture time = depth stamp, later where
// settleTimes() says so. Every data line is either delivered or skipped: a missing or damaged image, another
// size or type, a depth stamp that goes back or has no pose in poses.txt, colour far from depth in time, or a
// PNG where the first colour image is a JPEG (or the reverse) skips the frame and is logged once.
// Frames are read on the calling thread. The camera must outlive its leases; leases may end on any thread.
class RecordedCamera final : public Camera {
public:
    // Throws BadInput when the folder, its index, intrinsics.json or poses.txt is unusable, or when all
    // colour images have a size that intrinsics.json does not state.
    explicit RecordedCamera(const std::filesystem::path& folder, const SourceOptions& options = {});

    const CameraInfo& info() const override { return layout_.intrinsics.camera; }
    // Throws BadInput at the end of a recording without a usable frame, Error when too many leases are
    // alive.
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    std::vector<std::string> warnings() const override;
    uint32_t frameCount() const override { return static_cast<uint32_t>(layout_.index.size()); }
    bool seek(uint32_t index) override;
    std::string description() const override { return "recorded " + folder_.string(); }

private:
    void takeColourFormat();
    void warnAboutStamps();
    void warn(const std::string& warning);
    void useOptions(const SourceOptions& options);
    // Returns the fault; empty = read.
    std::string read(const IndexLine& line, FrameSlot& slot, RawColour& raw);
    Frame lease(uint32_t index, FrameSlot& slot, const RawColour& raw) const;
    void warnAboutLinks(const IndexLine& line);
    bool leadsOut(const std::filesystem::path& image);
    void skip(uint32_t index, const std::string& fault);
    void nameSkipped();

    std::filesystem::path folder_;
    RecordingLayout layout_;
    std::optional<FrameSlots> slots_;
    std::optional<FolderDepth> depth_;
    double mostApart_ = 0.0; // [s] depth and colour of a pair
    uint32_t cursor_ = 0;    // next data line
    uint32_t skipped_ = 0;
    uint32_t named_ = 0;                     // lines before this one are already counted
    bool any_ = false;                       // a valid frame was seen
    bool warnedAboutLinks_ = false;          // warn about links out of the folder once
    std::unordered_set<std::string> judged_; // image folders
    std::optional<double> lastStamp_;        // [s] of the last delivered frame; empty after seek()
    std::string firstFault_;
    std::vector<std::string> warnings_; // of the recording, then the first skipped frames
    std::vector<std::string> unnamed_;  // skipped frames that are not logged yet
};

} // namespace fathom
