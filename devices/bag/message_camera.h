// SPDX-License-Identifier: Apache-2.0
// What cameras that play a file of messages share: the span that is played, the clock, faults of single
// messages.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/bag/stamped_stream.h"
#include "devices/camera.h"
#include "devices/frame_slots.h"
#include "devices/images/byte_order.h"
#include "devices/recorded/source_options.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>

namespace fathom {

// Frame index and source number = message of the depth topic from 0, capture time = its header's stamp, from
// where a clock is set back later by as much. A message with a fault, and one whose stamp alone goes back, is
// skipped, counted and logged.
class MessageCamera : public Camera {
public:
    std::optional<Frame> next() override;
    uint32_t skipped() const override { return skipped_; }
    uint32_t frameCount() const override { return end_; }
    uint32_t firstFrame() const override { return first_; }
    bool seek(uint32_t index) override;
    std::vector<std::string> warnings() const override { return warnings_; }

protected:
    MessageCamera(std::unique_ptr<MessageFile> file, SourceOptions options)
        : options_(std::move(options))
        , file_(std::move(file))
        , warnings_(file_->warnings()) {}

    // Opens depth_. Start and duration of the options count from the topic's first message, by the time of
    // recording; by the stamps where messages were not recorded when they were sent.
    void useSpan(const MessageTopic& topic);
    void useClock(const MessageTopic& topic); // after useSpan()
    // A warning that is logged already; empty = none.
    void addWarning(const std::string& warning);
    void warnOfMotion(const std::string& frame); // of depth: logs a warning where it moves in the recording
    // Calls use(i) for up to `samples` messages over the whole span.
    template <class Use>
    void sample(size_t samples, Use&& use) const {
        const size_t step = std::max<size_t>(1, (end_ - cursor_) / samples);
        for (size_t i = cursor_; i < end_; i += step) {
            use(i);
        }
    }
    struct Judged {
        ByteOrder order = ByteOrder::Unknown;
        bool bigEndian = false; // as stated
    };
    // Whether the topic's messages are big-endian, where is_bigendian states the other order; empty = it is
    // right, or no message decides. judge(i): of message i. Of a few over the whole span, the first that is
    // not Unknown decides. Warns.
    std::optional<bool> orderInstead(const std::string& topic, const std::function<Judged(size_t)>& judge);
    // Logs and adds "subject: fault" once; an empty fault is none.
    void warnOnce(const std::string& subject, const std::string& fault);
    // Warns once of points that the unit of depth cannot hold, unless the scene's far excludes them.
    void warnBeyond(size_t index, uint64_t beyond);
    // Fills the slot from message `index`, and content.raw if the colour is not R8 G8 B8 A8. Returns the
    // fault, empty when it is filled. May throw Error.
    virtual std::string read(size_t index, FrameSlot& slot, double stamp, Frame::Content& content) = 0;

    SourceOptions options_;
    std::unique_ptr<MessageFile> file_;
    std::optional<StampedStream> depth_;
    std::optional<FrameSlots> slots_;
    uint32_t cursor_ = 0, end_ = 0;

private:
    bool stampsRise();
    void followClock(uint32_t index, double stamp);
    std::string faultOf(size_t index, FrameSlot& slot, double stamp, Frame::Content& content);

    uint32_t skipped_ = 0, first_ = 0;
    bool delivered_ = false, warnedBeyond_ = false;
    std::optional<double> lastStamp_; // [s] of the last delivered frame, in its header
    double shift_ = 0.0;              // [s] from headers to capture times
    uint32_t setBack_ = 0;            // messages before this one are already named
    std::string firstFault_;
    std::vector<std::string> warnings_;
};

} // namespace fathom
