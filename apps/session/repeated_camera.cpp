// SPDX-License-Identifier: Apache-2.0
#include "apps/session/repeated_camera.h"

#include <utility>

namespace fathom {

namespace {

std::unique_ptr<Camera> openOnce(const std::function<std::unique_ptr<Camera>()>& open,
                                 log::LoggedLines& logged) {
    const log::LogOnce once(logged);
    return open();
}

} // namespace

RepeatedCamera::RepeatedCamera(std::function<std::unique_ptr<Camera>()> open)
    : RepeatedCamera(std::move(open), std::make_unique<log::LoggedLines>()) {}

RepeatedCamera::RepeatedCamera(std::function<std::unique_ptr<Camera>()> open,
                               std::unique_ptr<log::LoggedLines> logged)
    : CameraDecorator(openOnce(open, *logged))
    , logged_(std::move(logged))
    , open_(std::move(open))
    , info_(CameraDecorator::info())
    , description_(CameraDecorator::description())
    , controls_(CameraDecorator::controls()) {}

std::optional<Frame> RepeatedCamera::next() {
    std::optional<log::LogOnce> once;
    if (!live()) { // a live source does not end, and its later events are others
        once.emplace(*logged_);
    }
    std::optional<Frame> frame = CameraDecorator::next();
    if (!frame) {
        skipped_ += CameraDecorator::skipped();
        if (ended_.size() > 1) {
            ended_.erase(ended_.begin()); // its leases ended one round earlier
        }
        ended_.push_back(replaceSource(open_()));
        offset_ = next_;
        frame = CameraDecorator::next();
    }
    if (!frame) {
        return frame;
    }
    stampsExposure_.store(CameraDecorator::stampsExposure());
    Frame::Content content = **frame;
    content.index += offset_;
    content.sourceNumber += offset_;
    next_ = content.index + 1;
    // The new frame owns the lease until it ends.
    auto* lease = new Frame(std::move(*frame));
    return Frame(content, [lease] { delete lease; });
}

} // namespace fathom
