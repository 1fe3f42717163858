// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorder.h"

#include "apps/operate/turn_log.h"
#include "devices/recorded/intrinsics_output.h"
#include "devices/recorded/png_output.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cstdio>
#include <iomanip>

namespace fathom::operate {

namespace {

constexpr double kFramePeriod = 1.0 / 30.0; // [s] of a replay
constexpr size_t kMostWaiting = 60;         // pictures

void put(std::ostream& out, const dvec3& v) {
    out << "," << v.x << "," << v.y << "," << v.z;
}

} // namespace

void Recorder::start(const std::filesystem::path& folder, const std::string& scene,
                     const CameraInfo& camera) {
    stop();
    const std::lock_guard lock(mutex_);
    folder_ = folder;
    camera_ = camera;
    std::filesystem::create_directories(folder / "depth");
    std::filesystem::create_directories(folder / "rgb");
    writeIntrinsics(folder / "intrinsics.json", camera);
    std::ofstream(folder / "scene.yaml") << scene;
    const auto open = [&](std::ofstream& file, const char* name, const char* head) {
        file = std::ofstream(folder / name);
        file << std::setprecision(17) << head << "\n";
        if (!file) {
            throw Error((folder / name).string() + ": cannot be written");
        }
    };
    open(hand_, "hand.csv", "t_s,x,y,z,qw,qx,qy,qz,button");
    open(wrench_, kWrenchFile, wrenchHead());
    open(touches_, kTouchesFile, touchesHead());
    if (camera.hasColour) {
        open(index_, "associations.txt", "# t_rgb rgb t_depth depth");
    } else {
        open(index_, "depth.txt", "# t_depth depth");
    }
    open(poses_, "poses.txt", "# t tx ty tz qx qy qz qw");
    waiting_.clear();
    turns_.clear();
    numbers_.clear();
    lastCapture_ = lastWritten_ = -1.0;
    lost_ = pictures_ = 0;
    ending_ = false;
    thread_ = std::thread([this] { writePictures(); });
    recording_.store(true);
}

void Recorder::stop() {
    recording_.store(false);
    {
        const std::lock_guard lock(mutex_);
        if (pictures_ > 0) { // the turns since the last picture
            flushTurns(lastCapture_, lastCapture_ + kFramePeriod,
                       static_cast<double>(pictures_ - 1) * kFramePeriod, 1.0);
        }
        ending_ = true;
    }
    more_.notify_all();
    if (thread_.joinable()) {
        thread_.join();
    }
    for (std::ofstream* file : {&hand_, &wrench_, &touches_, &index_, &poses_}) {
        file->close();
    }
}

void Recorder::frame(const PublishedFrame& frame, const Fixtures& set) {
    if (!recording()) {
        return;
    }
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= kMostWaiting || ending_) {
        ++lost_;
        return;
    }
    if (pictures_ > 0 && frame.t > lastCapture_) {
        const double start = static_cast<double>(pictures_ - 1) * kFramePeriod;
        flushTurns(lastCapture_, frame.t, start, kFramePeriod / (frame.t - lastCapture_));
    } else {
        turns_.clear();
    }
    lastCapture_ = frame.t;
    numbers_.emplace_back(frame.report.index, pictures_++);
    if (numbers_.size() > kMostWaiting) {
        numbers_.pop_front();
    }
    waiting_.push_back({set.depth, frame.colour, set.baseTcamera});
    more_.notify_one();
}

void Recorder::turn(const TurnRow& row, const PublishedFrame*, bool, std::span<const uint32_t>) {
    if (recording()) {
        const std::lock_guard lock(mutex_);
        turns_.push_back(row);
    }
}

void Recorder::flushTurns(double from, double to, double start, double scale) {
    while (!turns_.empty() && turns_.front().record.t < to) {
        if (turns_.front().record.t >= from) {
            putTurn(turns_.front(), start + scale * (turns_.front().record.t - from));
        }
        turns_.pop_front();
    }
}

void Recorder::putTurn(const TurnRow& row, double t) {
    if (!(t > lastWritten_)) {
        return; // a path's times ascend
    }
    lastWritten_ = t;
    const Pose& hand = row.hand.deviceThandle;
    hand_ << t;
    put(hand_, hand.position);
    hand_ << "," << hand.rotation.w << "," << hand.rotation.x << "," << hand.rotation.y << ","
          << hand.rotation.z << "," << row.hand.buttons << "\n";
    writeTurn(wrench_, touches_, t, pictureOf(row.record.frame), row.record);
}

int64_t Recorder::pictureOf(int64_t frame) const {
    const auto at = std::find_if(numbers_.rbegin(), numbers_.rend(),
                                 [&](const auto& number) { return number.first <= frame; });
    return at == numbers_.rend() ? -1 : static_cast<int64_t>(at->second);
}

void Recorder::writePictures() {
    for (uint32_t number = 0;; ++number) {
        Picture picture;
        {
            std::unique_lock lock(mutex_);
            more_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
            if (waiting_.empty()) {
                return;
            }
            picture = std::move(waiting_.front());
            waiting_.pop_front();
        }
        char name[16];
        std::snprintf(name, sizeof name, "%06u.png", number);
        const std::string stamp = std::to_string(number * kFramePeriod);
        writeDepthPng(folder_ / "depth" / name, {camera_.depth.width, camera_.depth.height}, picture.depth);
        if (camera_.hasColour) {
            writeColourPng(folder_ / "rgb" / name, {camera_.colour.width, camera_.colour.height},
                           picture.colour);
            index_ << stamp << " rgb/" << name << " ";
        }
        index_ << stamp << " depth/" << name << "\n";
        const Pose& p = picture.baseTcamera;
        poses_ << stamp << " " << p.position.x << " " << p.position.y << " " << p.position.z << " "
               << p.rotation.x << " " << p.rotation.y << " " << p.rotation.z << " " << p.rotation.w << "\n";
    }
}

} // namespace fathom::operate
