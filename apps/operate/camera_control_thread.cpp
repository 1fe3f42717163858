// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/camera_control_thread.h"

#include <chrono>

namespace fathom::operate {

CameraControlThread::CameraControlThread(std::shared_ptr<CameraControls> controls)
    : controls_(std::move(controls)) {
    if (controls_) {
        thread_ = std::thread([this] { serve(); });
    }
}

CameraControlThread::~CameraControlThread() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) {
        thread_.join();
    }
}

void CameraControlThread::show(bool shown) {
    {
        const std::lock_guard lock(mutex_);
        if (shown == shown_) {
            return;
        }
        shown_ = shown;
        answer_.known = answer_.known && shown;
    }
    changed_.notify_one();
}

void CameraControlThread::request(const CameraControl& control, int64_t value) {
    {
        const std::lock_guard lock(mutex_);
        requested_.emplace(control, value);
    }
    changed_.notify_one();
}

CameraControlThread::Answer CameraControlThread::answer() const {
    const std::lock_guard lock(mutex_);
    return answer_;
}

void CameraControlThread::serve() {
    constexpr auto kPeriod = std::chrono::seconds(1);
    std::unique_lock lock(mutex_);
    while (!ends_) {
        const auto wanted = std::exchange(requested_, std::nullopt);
        const bool reads = shown_ || wanted;
        lock.unlock();
        const std::string fault = wanted ? controls_->set(wanted->first, wanted->second) : "";
        std::vector<CameraControl> controls = reads ? controls_->read() : std::vector<CameraControl>();
        lock.lock();
        if (wanted) {
            answer_.fault = fault;
        }
        if (reads) {
            answer_.controls = std::move(controls);
            answer_.known = shown_;
        }
        const auto called = [&] { return ends_ || requested_ || (shown_ && !answer_.known); };
        if (shown_) {
            changed_.wait_for(lock, kPeriod, called);
        } else {
            changed_.wait(lock, called);
        }
    }
}

} // namespace fathom::operate
