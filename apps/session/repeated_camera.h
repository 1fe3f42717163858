// SPDX-License-Identifier: Apache-2.0
// An endless camera from a finite source, because a pilot's session lasts longer than a recording.
#pragma once

#include "devices/camera_decorator.h"
#include "engine/types/log_once.h"

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fathom {

// Reopens the source when it has ended, without logging the same lines again. Frame index and source number
// keep counting; it cannot seek. Any thread may call info() and description().
class RepeatedCamera final : public CameraDecorator {
public:
    // Throws what open() throws.
    explicit RepeatedCamera(std::function<std::unique_ptr<Camera>()> open);

    const CameraInfo& info() const override { return info_; }
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_ + CameraDecorator::skipped(); }
    uint32_t frameCount() const override { return 0; }
    uint32_t firstFrame() const override { return 0; }
    bool seek(uint32_t) override { return false; }
    std::shared_ptr<CameraControls> controls() const override { return controls_; }
    bool stampsExposure() const override { return stampsExposure_.load(); }
    std::string description() const override { return description_; }

private:
    RepeatedCamera(std::function<std::unique_ptr<Camera>()> open, std::unique_ptr<log::LoggedLines> logged);

    std::unique_ptr<log::LoggedLines> logged_; // of the first source: its opening is before the members
    std::function<std::unique_ptr<Camera>()> open_;
    CameraInfo info_; // of the first source; constant, because other threads read it
    std::string description_;
    std::shared_ptr<CameraControls> controls_;   // of a live source, which does not end
    std::atomic<bool> stampsExposure_{false};    // of the newest frame
    std::vector<std::unique_ptr<Camera>> ended_; // kept while frames still lease their memory
    uint32_t skipped_ = 0, offset_ = 0, next_ = 0;
};

} // namespace fathom
