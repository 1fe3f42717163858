// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/v4l2_camera.h"

#include "devices/v4l2/camera_streams.h"
#include "devices/v4l2/live_calibration.h"
#include "devices/v4l2/pixel_format.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <poll.h>
#include <thread>

namespace fathom {

namespace {

constexpr int kPollMs = 50;
constexpr double kFirstFrame = 5.0; // [s] start-up time of a camera
constexpr double kUnusable = 2.5;   // times `silence`; longer than watch() waits, whose message comes first

Clock::time_point grace() {
    return Clock::now() + std::chrono::milliseconds(static_cast<int>(1e3 * kFirstFrame));
}

} // namespace

V4l2Camera::V4l2Camera(const CameraRequest& request)
    : request_(request) {
    ChosenNodes nodes = chooseNodes(request);
    const LiveCalibration calibration = calibrationFor(request, nodes);
    info_ = calibration.info;
    description_ =
        "camera " + nodes.depth.card() + " (" + nodes.depth.file().string() + ", " + calibration.origin + ")";
    depthRequest_ = {nodes.depthFormat, {info_.depth.width, info_.depth.height}, request.rate};
    colourRequest_ = {nodes.colourFormat, {info_.colour.width, info_.colour.height}, request.rateOfColour()};
    info_.poseless = true;
    info_.colourFormat = info_.hasColour ? colourFormatOf(nodes.colourFormat) : ColourFormat::Rgba;
    known_ = KnownCamera{nodes.depth.identity(), nodes.colour ? nodes.colour->identity() : ""};
    slots_ = std::make_unique<FrameSlots>(info_.slotPixels(), info_.hasColour, kFramesInFlight + 1);
    streams_ = std::make_unique<Streams>(std::move(nodes), depthRequest_, colourRequest_);
    controls_ = std::make_shared<V4l2Controls>(controlNodes());
    open();
}

V4l2Camera::~V4l2Camera() = default;

std::vector<V4l2Controls::Node> V4l2Camera::controlNodes() const {
    std::vector<V4l2Controls::Node> nodes{{"depth", streams_->depth.node().file()}};
    if (streams_->colour) {
        nodes.push_back({"colour", streams_->colour->node().file()});
    }
    return nodes;
}

std::vector<CameraStream> V4l2Camera::delivered() const {
    std::vector<CameraStream> all;
    const auto add = [&](const char* name, const CaptureStream& stream) {
        const StreamRequest& r = stream.request();
        all.push_back({name, r.size.width, r.size.height, 1.0 / stream.period(), fourccName(r.fourcc)});
    };
    add("depth", streams_->depth);
    if (streams_->colour) {
        add("colour", *streams_->colour);
    }
    return all;
}

void V4l2Camera::open() {
    pairing_ = FramePairing(streams_->colour ? streams_->colour->period() : 0.0);
    depthPeriod_ = streams_->depth.period();
    firstBy_ = grace();
    depthWatch_ = colourWatch_ = {firstBy_, false};
    lastStamp_ = lastCapture_ = 0.0; // one that was too high must not reject the frames of now
}

// Retired streams are kept while a frame uses their memory.
void V4l2Camera::close() {
    arrivals_.clear();
    pairing_.clear();
    if (streams_) {
        missingBefore_ += streams_->missing();
        missingColourBefore_ += streams_->missingColour();
        streams_->metadata.reset();
        retired_.push_back(std::move(streams_));
    }
    std::erase_if(retired_, [](const auto& streams) { return streams->leased.load() == 0; });
}

void V4l2Camera::reopen() {
    close(); // an unplugged device keeps its number while its memory is mapped
    try {
        streams_ = std::make_unique<Streams>(chooseNodes(request_, known_), depthRequest_, colourRequest_);
    } catch (const BadInput& e) {
        throw DeviceLost(e.what());
    }
    controls_->moveTo(controlNodes());
    open();
}

uint64_t V4l2Camera::lost() const {
    return missingBefore_ + (streams_ ? streams_->missing() : 0) + overtaken_;
}

std::string V4l2Camera::description() const {
    return description_ + (exposureStamps_ > 0 ? ", which reports the start of exposure" : "");
}

uint64_t V4l2Camera::lostColour() const {
    return missingColourBefore_ + (streams_ ? streams_->missingColour() : 0);
}

std::optional<Frame> V4l2Camera::next() {
    if (request_.frames != 0 && delivered_ >= request_.frames) {
        return std::nullopt;
    }
    try {
        if (!streams_) {
            reopen();
        }
        const uint32_t before = skipped_.count();
        for (const Clock::time_point since = std::max(Clock::now(), firstBy_);;) {
            gather();
            if (!request_.everyFrame && starved()) {
                giveUpStale();
            } else if (std::optional<Frame> frame = settle()) {
                return frame;
            }
            wait();
            skipped_.limit(description_, before, secondsSince(since), kUnusable * request_.silence);
        }
    } catch (const DeviceLost&) {
        close();
        throw;
    }
}

// Reads everything that the driver has ready, in order of capture.
void V4l2Camera::gather() {
    const size_t before = arrivals_.size();
    while (const auto buffer = streams_->takeDepth()) {
        arrivals_.push_back({true, *buffer});
        depthWatch_ = {std::max(depthWatch_.last, Clock::now()), false};
    }
    const uint64_t missing = streams_->missingColour();
    while (const auto buffer = streams_->colour ? streams_->colour->take() : std::nullopt) {
        arrivals_.push_back({false, *buffer});
        colourWatch_ = {std::max(colourWatch_.last, Clock::now()), false};
    }
    if (streams_->missingColour() > missing) {
        skipped_.add(description_,
                     "colour frames are missing: depth is paired with a neighbour, if one is close", 0);
    }
    if (arrivals_.size() > before + 1) {
        std::stable_sort(arrivals_.begin(), arrivals_.end(),
                         [](const Arrival& a, const Arrival& b) { return a.buffer.stamp < b.buffer.stamp; });
    }
}

// A driver without a free buffer drops new frames and keeps old ones, so everything it returns is old.
bool V4l2Camera::starved() const {
    return streams_->depth.queued() == 0 || (streams_->colour && streams_->colour->queued() == 0);
}

void V4l2Camera::giveUpStale() {
    for (const Arrival& arrival : arrivals_) {
        arrival.depth ? pairing_.depth(arrival.buffer) : pairing_.colour(arrival.buffer);
    }
    arrivals_.clear();
    pairing_.letGo();
    for (const CapturedBuffer& depth : pairing_.unpairedDepth()) {
        ++overtaken_;
        streams_->depth.giveBack(depth.index);
    }
    recycle();
}

void V4l2Camera::watch(bool depth, CaptureStream& stream, Watch& watch) {
    const double silent = secondsSince(watch.last);
    if (silent > 2.0 * request_.silence) {
        throw DeviceLost(stream.node().file().string() + ": no frame for " + std::to_string(silent) + " s");
    }
    if (silent > request_.silence && !watch.restarted) {
        log::warn("{}: no {} frame for {:.1f} s: restarted", stream.node().file().string(),
                  depth ? "depth" : "colour", silent);
        watch.restarted = true;
        ++restarts_;
        stream.restart();
    }
}

void V4l2Camera::wait() {
    pollfd ready[2] = {{streams_->depth.node().descriptor(), POLLIN, 0}, {-1, POLLIN, 0}};
    if (streams_->colour) {
        ready[1].fd = streams_->colour->node().descriptor();
    }
    ::poll(ready, 2, kPollMs);
    for (const pollfd& one : ready) {
        if (one.fd >= 0 && (one.revents & POLLERR) != 0 && (one.revents & POLLIN) == 0) {
            // Unplugged (gather() detects it), or not streaming: nothing to wait for.
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }
    watch(true, streams_->depth, depthWatch_);
    if (streams_->colour) {
        watch(false, *streams_->colour, colourWatch_);
    }
}

std::optional<Frame> V4l2Camera::settle() {
    std::vector<FramePairing::Pair> pairs;
    while (pairs.empty() || !request_.everyFrame) {
        if (auto pair = pairing_.next()) {
            pairs.push_back(*pair);
        } else if (!arrivals_.empty()) {
            const Arrival arrival = arrivals_.front();
            arrivals_.erase(arrivals_.begin());
            arrival.depth ? pairing_.depth(arrival.buffer) : pairing_.colour(arrival.buffer);
        } else {
            break;
        }
    }
    std::optional<Frame> frame;
    for (size_t i = 0; i < pairs.size(); ++i) {
        if (i + 1 < pairs.size()) { // a newer one is available
            ++overtaken_;
            streams_->depth.giveBack(pairs[i].depth.index);
        } else {
            frame = lease(pairs[i]);
        }
    }
    recycle();
    return frame;
}

void V4l2Camera::recycle() {
    for (const CapturedBuffer& depth : pairing_.unpairedDepth()) {
        skipped_.add(description_, "no colour frame close in time");
        streams_->depth.giveBack(depth.index);
    }
    for (const CapturedBuffer& colour : pairing_.usedColour()) {
        streams_->colour->giveBack(colour.index);
    }
}

std::optional<Frame> V4l2Camera::lease(const FramePairing::Pair& pair) {
    FrameSlot* slot = &slots_->acquireFor(description_);
    Frame::Content content;
    const std::string fault = fill(pair, *slot, content);
    const bool inPlace = fault.empty() && content.depth.data() != slot->depth().data();
    if (!inPlace) {
        streams_->depth.giveBack(pair.depth.index);
    }
    if (!fault.empty()) {
        slot->release();
        skipped_.add(description_, fault);
        return std::nullopt;
    }
    content.index = delivered_++;
    content.sourceNumber = delivered_;
    lastStamp_ = pair.depth.stamp; // colour stamps of the same driver are compared with it
    lastCapture_ = std::max(lastCapture_, pair.depth.exposure.value_or(pair.depth.stamp));
    content.captureTime = lastCapture_;
    exposureStamps_ += pair.depth.exposure ? 1 : 0;
    if (!inPlace) {
        ++copied_;
        return slot->lend(content);
    }
    ++streams_->leased;
    slot->name(content); // colour
    content.depthMemory = pair.depth.memory;
    return Frame(content, [slot, streams = streams_.get(), buffer = pair.depth.index] {
        slot->release();
        streams->depth.giveBack(buffer);
        --streams->leased; // last, because it may free the streams
    });
}

} // namespace fathom
