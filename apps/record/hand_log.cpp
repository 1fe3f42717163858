// SPDX-License-Identifier: Apache-2.0
#include "apps/record/hand_log.h"

#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/frame.h"

#include <chrono>
#include <iomanip>

namespace fathom {

namespace {

constexpr auto kPeriod = std::chrono::milliseconds(1);

} // namespace

HandLog::HandLog(std::unique_ptr<LiveHand> hand, const std::filesystem::path& file)
    : hand_(std::move(hand))
    , out_(file)
    , file_(file) {
    out_ << "t_s,x,y,z,qw,qx,qy,qz,button\n" << std::setprecision(12);
    if (!out_) {
        throw Error(file.string() + ": cannot be written");
    }
    thread_ = std::thread([this] { watch(); });
}

HandLog::~HandLog() {
    stop_.store(true);
    if (thread_.joinable()) {
        thread_.join();
    }
    if (frames_ == 0) {
        std::error_code ignored;
        std::filesystem::remove(file_, ignored);
    }
}

void HandLog::watch() noexcept {
    Clock::time_point next = Clock::now();
    while (!stop_.load()) {
        const double t = monotonicSeconds();
        const HandSample sample = hand_->read(t);
        hand_->write({}, 0.001);
        {
            const std::lock_guard lock(mutex_);
            waiting_.push_back({t, sample});
        }
        ++samples_;
        next = std::max(next + kPeriod, Clock::now()); // a late sample is not repeated
        std::this_thread::sleep_until(next);
    }
}

void HandLog::flush(double from, double to, double start, double scale) {
    std::deque<Sample> taken;
    {
        const std::lock_guard lock(mutex_);
        while (!waiting_.empty() && waiting_.front().t < to) {
            taken.push_back(waiting_.front());
            waiting_.pop_front();
        }
    }
    for (const Sample& sample : taken) {
        const double t = start + scale * (sample.t - from);
        if (sample.t < from || !(t > written_)) {
            continue;
        }
        written_ = t;
        const dvec3& p = sample.hand.deviceThandle.position;
        const dquat& q = sample.hand.deviceThandle.rotation;
        out_ << t << "," << p.x << "," << p.y << "," << p.z << "," << q.w << "," << q.x << "," << q.y << ","
             << q.z << "," << sample.hand.buttons << "\n";
    }
}

void HandLog::frame(double captureTime) {
    if (frames_ > 0 && captureTime > last_) {
        flush(last_, captureTime, (frames_ - 1) * kLockstepFramePeriod,
              kLockstepFramePeriod / (captureTime - last_));
    } else if (frames_ == 0) { // samples before the first frame are dropped
        const std::lock_guard lock(mutex_);
        std::erase_if(waiting_, [=](const Sample& s) { return s.t < captureTime; });
    }
    last_ = captureTime;
    ++frames_;
}

void HandLog::finish() {
    stop_.store(true);
    if (thread_.joinable()) {
        thread_.join();
    }
    if (frames_ > 0) {
        flush(last_, last_ + kLockstepFramePeriod, (frames_ - 1) * kLockstepFramePeriod, 1.0);
    }
    out_.close();
    if (!out_) {
        throw Error(file_.string() + ": cannot be written");
    }
}

} // namespace fathom
