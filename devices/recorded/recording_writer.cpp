// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/recording_writer.h"

#include "devices/recorded/frame_folder.h"
#include "devices/recorded/intrinsics_output.h"
#include "devices/recorded/png_output.h"
#include "engine/types/colour_copy.h"
#include "engine/types/error.h"
#include "engine/types/printed.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace fathom {

namespace {

namespace fs = std::filesystem;

std::string numbered(const char* folder, uint32_t number) {
    return printed("%s/%06u.png", folder, number);
}

// Nanoseconds, and all digits of a stamp that nine decimals do not restore.
std::string text(double value) {
    char digits[400];
    std::snprintf(digits, sizeof digits, "%.9f", value);
    if (std::strtod(digits, nullptr) != value) {
        const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed).ptr;
        return {digits, end};
    }
    return digits;
}

// A line of poses.txt, with all digits.
std::string poseText(double stamp, const Pose& pose) {
    const dvec3& t = pose.position;
    const dquat& q = pose.rotation;
    std::string line = text(stamp);
    for (const double value : {t.x, t.y, t.z, q.x, q.y, q.z, q.w}) {
        line += printed(" %.17g", value);
    }
    return line;
}

// Files by which a folder is read as a recording, of any layout.
constexpr std::array<const char*, 14> kMarks{"associations.txt",
                                             "depth.txt",
                                             "rgb.txt",
                                             "poses.txt",
                                             "groundtruth.txt",
                                             "intrinsics.json",
                                             "camera_intrinsic.json",
                                             "intrinsic.json",
                                             "camera_primesense.json",
                                             "scene_camera.json",
                                             "intrinsic",
                                             "intrinsics_depth.txt",
                                             "cam_K.txt",
                                             "metadata.yaml"};

// Why the folder must not be written to; empty = it may.
std::string whyTaken(const fs::path& folder) {
    std::error_code failed;
    for (const char* name : kMarks) {
        if (fs::exists(fs::symlink_status(folder / name, failed))) {
            return std::string("has ") + name;
        }
    }
    if (hasFrameImages(folder)) {
        return "has images frame-N.depth.png";
    }
    for (const char* name : {"depth", "rgb"}) {
        const fs::path images = folder / name;
        const fs::file_status status = fs::symlink_status(images, failed);
        if (fs::is_symlink(status)) {
            return std::string(name) + " is a symbolic link";
        }
        if (fs::exists(status) && !fs::is_directory(status)) {
            return std::string(name) + " is not a folder";
        }
        if (fs::is_directory(status) && !fs::is_empty(images, failed)) {
            return std::string("has files in ") + name + "/";
        }
    }
    return "";
}

const fs::path& freshFolder(const fs::path& folder) {
    if (const std::string why = whyTaken(folder); !why.empty()) {
        throw BadInput("--out", folder.string(), why, "a folder without a recording");
    }
    for (const char* name : {"depth", "rgb"}) {
        std::error_code failed;
        fs::create_directories(folder / name, failed);
        if (failed) {
            throw Error(folder.string() + ": cannot be written (" + failed.message() + ")");
        }
    }
    return folder;
}

} // namespace

RecordingWriter::RecordingWriter(const fs::path& folder, const CameraInfo& camera, unsigned threads)
    : folder_(freshFolder(folder))
    , camera_(camera) {
    try {
        index_.open(folder / (camera.hasColour ? "associations.txt" : "depth.txt"));
        writeIntrinsics(folder / "intrinsics.json", camera);
    } catch (...) {
        removeFiles();
        throw;
    }
    for (unsigned i = 0; i < std::max(1u, threads); ++i) {
        threads_.emplace_back([this] { encode(); });
    }
}

RecordingWriter::~RecordingWriter() {
    end();
}

void RecordingWriter::add(const Frame& frame) {
    StoredFrame image{frame->captureTime, {frame->depth.begin(), frame->depth.end()}, {}, frame->baseTcamera};
    readColours(*frame, image.colour);
    add(std::move(image));
}

void RecordingWriter::add(StoredFrame frame) {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [this] { return waiting_.size() < kWaiting || failure_; });
    if (failure_) {
        std::rethrow_exception(failure_);
    }
    waiting_.push_back({added_++, std::move(frame)});
    work_.notify_one();
}

bool RecordingWriter::full() const {
    const std::lock_guard lock(mutex_);
    return waiting_.size() >= kWaiting && !failure_;
}

bool RecordingWriter::written() const {
    const std::lock_guard lock(mutex_);
    return waiting_.empty() && underWay_ == 0;
}

void RecordingWriter::encode() {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            work_.wait(lock, [this] { return !waiting_.empty() || ending_; });
            if (waiting_.empty()) {
                return;
            }
            job = std::move(waiting_.front());
            waiting_.pop_front();
            ++underWay_;
            room_.notify_one();
        }
        try {
            write(job);
            done(job);
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = failure_ ? failure_ : std::current_exception();
            room_.notify_all();
        }
        const std::lock_guard lock(mutex_);
        --underWay_;
    }
}

void RecordingWriter::count(const fs::path& file) {
    std::error_code failed;
    const uintmax_t size = fs::file_size(file, failed);
    bytes_ += failed ? 0 : size;
}

void RecordingWriter::write(const Job& job) {
    const auto size = [](const Intrinsics& lens) { return PngSize{lens.width, lens.height}; };
    const fs::path depth = folder_ / numbered("depth", job.number);
    writeDepthPng(depth, size(camera_.depth), job.frame.depth);
    count(depth);
    if (camera_.hasColour) {
        const fs::path colour = folder_ / numbered("rgb", job.number);
        writeColourPng(colour, size(camera_.colour), job.frame.colour);
        count(colour);
    }
}

// Lines are written in order, each when all earlier ones are done.
void RecordingWriter::done(const Job& job) {
    const std::string depth = text(job.frame.stamp) + " " + numbered("depth", job.number);
    const std::string line =
        camera_.hasColour ? text(job.frame.stamp) + " " + numbered("rgb", job.number) + " " + depth : depth;
    const std::lock_guard lock(mutex_);
    indexLines_[job.number] = line;
    if (job.frame.pose) {
        poseLines_[job.number] = {job.frame.stamp, poseText(job.frame.stamp, *job.frame.pose)};
    }
    while (!indexLines_.empty() && indexLines_.begin()->first == indexed_) {
        index_.lines() << indexLines_.begin()->second << "\n";
        indexLines_.erase(indexLines_.begin());
        if (const auto pose = poseLines_.find(indexed_); pose != poseLines_.end()) {
            writePose(pose->second);
            poseLines_.erase(pose);
        }
        ++indexed_;
    }
    poses_.flush(); // before the index lists its images
    index_.flush();
}

// Times of poses rise, and a pose belongs to a time: frames of one stamp share a line.
void RecordingWriter::writePose(const PoseLine& pose) {
    if (!poses_.isOpen()) {
        poses_.open(folder_ / "poses.txt");
    } else if (pose.stamp <= lastPose_) {
        return;
    }
    poses_.lines() << pose.line << "\n";
    lastPose_ = pose.stamp;
}

void RecordingWriter::close() noexcept {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    work_.notify_all();
}

void RecordingWriter::removeFiles() noexcept {
    std::error_code ignored;
    for (const char* name : {"intrinsics.json", "associations.txt", "depth.txt", "depth", "rgb"}) {
        fs::remove(folder_ / name, ignored); // not a folder with files
    }
}

void RecordingWriter::end() noexcept {
    close();
    for (std::thread& thread : threads_) {
        thread.join();
    }
    if (added_ == 0 && !threads_.empty()) { // once
        removeFiles();
    }
    threads_.clear();
}

void RecordingWriter::finish() {
    end();
    if (failure_) {
        std::rethrow_exception(failure_);
    }
}

} // namespace fathom
