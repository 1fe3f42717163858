// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorder.h"

#include "apps/binding/scene_edits.h"
#include "apps/operate/tick_log.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <fstream>
#include <utility>

namespace fathom::operate {

namespace {

constexpr double kFramePeriod = 1.0 / 30.0; // [s] in a replay
constexpr size_t kMostNumbers = 60;         // frames whose index is kept: a tick may use an older frame

void put(std::ostream& out, const dvec3& v) {
    out << "," << v.x << "," << v.y << "," << v.z;
}

} // namespace

// A failure ends the recording, not the session.
template <class Job>
void Recorder::orFail(const Job& job) {
    try {
        job();
    } catch (const std::exception& e) {
        failure_ = e.what();
        log::warn("recording stopped: {}", failure_);
        recording_.store(false);
        writer_->close();
    }
}

void Recorder::openFiles(const std::filesystem::path& folder) {
    hand_.open(folder / "hand.csv", "t_s,x,y,z,qw,qx,qy,qz,button");
    wrench_.open(folder / kWrenchFile, wrenchHead());
    touches_.open(folder / kTouchesFile, touchesHead());
}

void Recorder::start(const std::filesystem::path& folder, const std::string& scene, const CameraInfo& camera,
                     const RecordedScene& edited) {
    stop();
    finish();
    const std::lock_guard lock(mutex_);
    failure_.clear();
    ticks_.clear();
    numbers_.clear();
    upcoming_.clear();
    edits_.close();
    folder_ = folder;
    edited_ = edited;
    scenes_ = 0;
    still_ = false;
    lastCapture_ = lastWritten_ = -1.0;
    lost_ = images_ = 0;
    writer_ = std::make_unique<RecordingWriter>(folder, camera, 1);
    std::ofstream text(folder / "scene.yaml");
    text << scene << std::flush;
    if (!text) {
        throw Error((folder / "scene.yaml").string() + ": cannot be written");
    }
    openFiles(folder);
    recording_.store(true);
}

void Recorder::stop() {
    const std::lock_guard lock(mutex_);
    if (!recording_.exchange(false)) {
        return;
    }
    orFail([this] {
        if (images_ > 0) { // writes the ticks since the last frame
            flushTicks(lastCapture_, lastCapture_ + kFramePeriod,
                       static_cast<double>(images_ - 1) * kFramePeriod, 1.0);
        }
    });
    writer_->close();
}

bool Recorder::writing() const {
    const std::lock_guard lock(mutex_);
    return !recording_.load() && writer_ && !writer_->written();
}

void Recorder::finish() {
    if (!writer_ || recording_.load()) {
        return;
    }
    try {
        writer_->finish(); // without the lock, so that the writer thread of the run can continue
    } catch (const std::exception& e) {
        const std::lock_guard lock(mutex_);
        failure_ = failure_.empty() ? e.what() : failure_;
    }
    const std::lock_guard lock(mutex_);
    writer_.reset();
}

std::string Recorder::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

void Recorder::frame(const PublishedFrame& frame, const Fixtures& set) {
    if (!recording()) {
        return;
    }
    const std::lock_guard lock(mutex_);
    if (!recording()) {
        return;
    }
    if (writer_->full()) {
        ++lost_;
        return;
    }
    orFail([&] { addImage(frame, set); });
}

void Recorder::addImage(const PublishedFrame& frame, const Fixtures& set) {
    if (images_ > 0 && frame.t > lastCapture_) {
        const double start = static_cast<double>(images_ - 1) * kFramePeriod;
        flushTicks(lastCapture_, frame.t, start, kFramePeriod / (frame.t - lastCapture_));
    } else {
        ticks_.clear();
    }
    lastCapture_ = frame.t;
    numbers_.emplace_back(frame.report.index, images_);
    if (numbers_.size() > kMostNumbers) {
        numbers_.pop_front();
    }
    addEdit(frame);
    writer_->add({static_cast<double>(images_++) * kFramePeriod, set.depth, frame.colour, set.baseTcamera});
}

void Recorder::edit(uint64_t number, RecordedScene scene) {
    const std::lock_guard lock(mutex_);
    if (recording()) {
        upcoming_.emplace_back(number, std::move(scene));
    }
}

// The first edit also writes the scene file of the start.
void Recorder::addEdit(const PublishedFrame& frame) {
    const auto takesEffect = [&] { return !upcoming_.empty() && upcoming_.front().first <= frame.edit; };
    if (!takesEffect() && frame.still == still_) {
        return;
    }
    if (!edits_.isOpen()) {
        edits_.open(folder_ / SceneEdits::kFile, SceneEdits::kHead);
        if (images_ > 0) {
            putEdit(0, still_);
        }
    }
    for (; takesEffect(); upcoming_.pop_front()) {
        edited_ = std::move(upcoming_.front().second);
    }
    still_ = frame.still;
    putEdit(images_, still_);
}

void Recorder::putEdit(uint64_t image, bool still) {
    const std::string name = "scene-" + std::to_string(scenes_++) + ".yaml";
    std::ofstream text(folder_ / name);
    text << edited_.text << std::flush;
    if (!text) {
        throw Error((folder_ / name).string() + ": cannot be written");
    }
    std::ostream& out = edits_.lines();
    out << image << "," << name << ",";
    for (size_t i = 0; i < edited_.held.size(); ++i) {
        out << (i == 0 ? "" : " ") << edited_.held[i];
    }
    out << "," << (still ? 1 : 0) << "\n";
    edits_.flush();
}

void Recorder::step(const TickRow& row, const PublishedFrame*, bool, std::span<const uint32_t>) {
    if (recording()) {
        const std::lock_guard lock(mutex_);
        ticks_.push_back(row);
    }
}

void Recorder::flushTicks(double from, double to, double start, double scale) {
    while (!ticks_.empty() && ticks_.front().record.t < to) {
        if (ticks_.front().record.t >= from) {
            putTick(ticks_.front(), start + scale * (ticks_.front().record.t - from));
        }
        ticks_.pop_front();
    }
    hand_.flush();
    wrench_.flush(); // a tick is flushed before its touches
    touches_.flush();
}

void Recorder::putTick(const TickRow& row, double t) {
    if (!(t > lastWritten_)) {
        return; // times in hand.csv must be ascending
    }
    lastWritten_ = t;
    const Pose& hand = row.hand.deviceThandle;
    std::ostream& out = hand_.lines();
    out << t;
    put(out, hand.position);
    out << "," << hand.rotation.w << "," << hand.rotation.x << "," << hand.rotation.y << ","
        << hand.rotation.z << "," << row.hand.buttons << "\n";
    writeTick(wrench_.lines(), touches_.lines(), t, imageOf(row.record.frame), row.record);
}

int64_t Recorder::imageOf(int64_t frame) const {
    const auto at = std::find_if(numbers_.rbegin(), numbers_.rend(),
                                 [&](const auto& number) { return number.first <= frame; });
    return at == numbers_.rend() ? -1 : static_cast<int64_t>(at->second);
}

} // namespace fathom::operate
