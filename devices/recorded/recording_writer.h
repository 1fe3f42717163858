// SPDX-License-Identifier: Apache-2.0
// Writes a recording folder that RecordedCamera reads: images, index, intrinsics, poses.
#pragma once

#include "devices/recorded/line_file.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace fathom {

// TUM RGB-D layout: rgb/NNNNNN.png, depth/NNNNNN.png, associations.txt (depth.txt alone without colour),
// intrinsics.json, and poses.txt when frames carry poses. Images are encoded on worker threads; add() copies
// the frame and returns. The index gets a line when its images are complete on disk, in order, so a truncated
// recording is a valid, shorter one.
class RecordingWriter {
public:
    static constexpr size_t kWaiting = 90; // frames that may wait to be encoded: 3 s at 30 Hz

    // Creates the folder; rejects one with a recording of any layout, with files in depth/ or rgb/, or with
    // something else under these names (BadInput): it may be the source. Throws Error when it cannot be
    // written, and leaves no file then. threads: number of encoders.
    RecordingWriter(const std::filesystem::path& folder, const CameraInfo& camera, unsigned threads);
    // As finish(), but ignores failures.
    ~RecordingWriter();

    // One depth image with its colour image, row by row, as the camera's info describes them.
    struct StoredFrame {
        double stamp = 0.0; // [s]
        std::vector<uint16_t> depth;
        std::vector<uint32_t> colour;
        std::optional<Pose> pose; // base_T_camera
    };
    // Returns at once, or waits for room when kWaiting frames are queued. Rethrows an encoder's exception.
    void add(const Frame& frame);
    void add(StoredFrame frame);
    // Whether add() would wait now.
    bool full() const;
    // Ends the input and returns at once; queued frames are still written.
    void close() noexcept;
    // True when nothing is queued or being written. Any thread.
    bool written() const;
    // Waits for all images. Without a frame it removes its files, and depth/ and rgb/, so that the folder can
    // be used again. Rethrows an encoder's exception.
    void finish();

    uint32_t frames() const { return added_; }
    uint64_t bytes() const { return bytes_.load(); } // of all images on disk. Any thread.

private:
    struct Job {
        uint32_t number = 0;
        StoredFrame frame;
    };
    struct PoseLine {
        double stamp = 0.0; // [s]
        std::string line;
    };
    void encode();
    void write(const Job& job);
    void count(const std::filesystem::path& file);
    void done(const Job& job);
    void writePose(const PoseLine& pose);
    void end() noexcept;
    void removeFiles() noexcept; // of a recording without frames

    std::filesystem::path folder_;
    CameraInfo camera_;
    LineFile index_, poses_;
    mutable std::mutex mutex_;
    std::condition_variable work_, room_;
    std::deque<Job> waiting_;
    std::map<uint32_t, std::string> indexLines_; // done, waiting for an earlier one
    std::map<uint32_t, PoseLine> poseLines_;     // likewise
    double lastPose_ = 0.0;                      // [s] stamp of the last line of poses.txt
    uint32_t added_ = 0, indexed_ = 0, underWay_ = 0;
    bool ending_ = false;
    std::atomic<uint64_t> bytes_{0};
    std::exception_ptr failure_;
    std::vector<std::thread> threads_;
};

} // namespace fathom
