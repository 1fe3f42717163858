// SPDX-License-Identifier: Apache-2.0
// Writes a recording folder that RecordedCamera reads: pictures, index, intrinsics, poses.
#pragma once

#include "devices/recorded/line_file.h"
#include "engine/types/camera_info.h"
#include "engine/types/frame.h"

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
// intrinsics.json, and poses.txt when frames carry poses. Pictures are encoded on threads of its own; add()
// copies the frame and returns. The index gets a line once its pictures are whole on disk, in order, so that
// a recording cut off anywhere is a shorter recording.
class RecordingWriter {
public:
    static constexpr size_t kWaiting = 90; // frames that may wait to be encoded: 3 s at 30 Hz

    // Makes the folder; one that has an index already is refused (BadInput). Throws Error when it cannot be
    // written. threads: of encoders.
    RecordingWriter(const std::filesystem::path& folder, const CameraInfo& camera, unsigned threads);
    // As finish(), but says nothing of failures.
    ~RecordingWriter();

    // One depth picture with its colour picture, row by row, as the camera's info describes them.
    struct Image {
        double stamp = 0.0; // [s]
        std::vector<uint16_t> depth;
        std::vector<uint32_t> colour;
        std::optional<Pose> pose; // base_T_camera
    };
    // Returns at once, or when there is room again while kWaiting frames wait. Throws what an encoder threw.
    void add(const Frame& frame);
    void add(Image image);
    // Whether add() would wait now.
    bool full() const;
    // No more will come: returns at once, while what waits is written.
    void close() noexcept;
    // Whether nothing waits or is being written. Any thread.
    bool written() const;
    // Waits for all pictures. Throws what an encoder threw.
    void finish();

    uint32_t frames() const { return added_; }
    double longestWait() const { return longestWait_; } // [s] that add() was held up

private:
    struct Job {
        uint32_t number = 0;
        Image image;
    };
    void encode();
    void write(const Job& job) const;
    void done(const Job& job);
    void end() noexcept;

    std::filesystem::path folder_;
    CameraInfo camera_;
    LineFile index_, poses_;
    mutable std::mutex mutex_;
    std::condition_variable work_, room_;
    std::deque<Job> waiting_;
    std::map<uint32_t, std::string> indexLines_, poseLines_; // done, but an earlier one is not
    uint32_t added_ = 0, indexed_ = 0, underWay_ = 0;
    double longestWait_ = 0.0;
    bool ending_ = false;
    std::exception_ptr failure_;
    std::vector<std::thread> threads_;
};

} // namespace fathom
