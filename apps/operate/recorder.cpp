// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorder.h"

#include "engine/types/error.h"
#include "engine/types/frame.h"
#include "engine/types/log.h"

#include <fstream>
#include <utility>

namespace fathom::operate {

namespace {

constexpr double kLongestGap = 10.0; // [s] without a frame, after which ticks are not recorded until the next

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

void Recorder::start(const std::filesystem::path& folder, const std::string& scene, const CameraInfo& camera,
                     const RecordedScene& edited) {
    stop();
    finish();
    const std::lock_guard lock(mutex_);
    failure_.clear();
    edits_.begin(folder, edited);
    lastCapture_ = -1.0;
    lost_ = frames_ = 0;
    seconds_ = 0.0;
    marked_ = false;
    writer_ = std::make_unique<RecordingWriter>(folder, camera, 1);
    std::ofstream text(folder / "scene.yaml");
    text << scene << std::flush;
    if (!text) {
        throw Error((folder / "scene.yaml").string() + ": cannot be written");
    }
    ticks_.open(folder);
    recording_.store(true);
}

void Recorder::stop(const std::string& why) {
    const std::lock_guard lock(mutex_);
    if (!recording_.exchange(false)) {
        return;
    }
    orFail([this] { endTicks(); });
    failure_ = failure_.empty() ? why : failure_;
    writer_->close();
}

uint64_t Recorder::bytes() const {
    const std::lock_guard lock(mutex_);
    return (writer_ ? writer_->bytes() : imageBytes_) + ticks_.bytes();
}

bool Recorder::writing() const {
    const std::lock_guard lock(mutex_);
    return !recording_.load() && writer_ && !writer_->written();
}

bool Recorder::busy() const {
    const std::lock_guard lock(mutex_);
    return writer_ && writer_->full();
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
    imageBytes_ = writer_->bytes();
    writer_.reset();
}

std::string Recorder::failure() const {
    const std::lock_guard lock(mutex_);
    return failure_;
}

void Recorder::frame(const PublishedFrame& frame, const HostFixtures& set) {
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

// Writes the ticks of the last frame, which no other follows.
void Recorder::endTicks() {
    if (frames_ > 0) {
        ticks_.flush(lastCapture_, lastCapture_ + kLockstepFramePeriod,
                     static_cast<double>(frames_ - 1) * kLockstepFramePeriod, 1.0);
    }
    ticks_.drop();
}

void Recorder::addImage(const PublishedFrame& frame, const HostFixtures& set) {
    if (frames_ > 0 && frame.t > lastCapture_) {
        const double start = static_cast<double>(frames_ - 1) * kLockstepFramePeriod;
        ticks_.flush(lastCapture_, frame.t, start, kLockstepFramePeriod / (frame.t - lastCapture_));
    } else {
        ticks_.drop();
    }
    firstCapture_ = frames_ == 0 ? frame.t : firstCapture_;
    seconds_ = frame.t - firstCapture_;
    lastCapture_ = frame.t;
    ticks_.number(frame.report.index, frames_);
    edits_.frame(frame, frames_);
    writer_->add(
        {static_cast<double>(frames_++) * kLockstepFramePeriod, set.depth, frame.colour, set.baseTcamera});
}

void Recorder::edit(uint64_t number, RecordedScene scene) {
    const std::lock_guard lock(mutex_);
    if (recording()) {
        edits_.add(number, std::move(scene));
    }
}

void Recorder::step(const TickRow& row, const ObeyedSet&) {
    if (!recording()) {
        return;
    }
    const std::lock_guard lock(mutex_);
    const bool marked = marked_.exchange(false);
    const double age = row.record.t - lastCapture_;
    if (frames_ == 0 || age < 0.0) {
        return; // belongs to no frame of the recording
    }
    if (age <= kLongestGap) {
        ticks_.add(row, marked);
    } else if (ticks_.waits()) {
        log::warn("recording: no frame for {} s; ticks are not recorded until the next frame", kLongestGap);
        orFail([this] { endTicks(); });
    }
}

} // namespace fathom::operate
