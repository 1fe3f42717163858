// SPDX-License-Identifier: Apache-2.0
// Finds out whether a value that applies to many images, such as a lens, changes within a recording.
#pragma once

#include "devices/bag/image_stream.h"

#include <algorithm>
#include <array>
#include <string>

namespace fathom {

// The messages of a topic that apply to a stream of images: the newest one before an image applies to it.
class ChangedMessages {
public:
    ChangedMessages(MessageFile& file, const MessageTopic& topic)
        : file_(file)
        , topic_(topic) {}

    // Calls fault(message) for the message that applies at `time` [ns], and for one at most 20 ms later,
    // because some drivers send it after its image. Returns the fault, empty = none. Each message is read
    // once in a row. Throws Error while a damaged message applies.
    template <class Fault>
    std::string at(uint64_t time, Fault&& fault) {
        constexpr uint64_t kAtOnce = 20'000'000; // [ns]
        const std::vector<MessageEntry>& all = topic_.messages;
        const auto next = std::ranges::upper_bound(all, time, {}, &MessageEntry::time);
        const auto after = static_cast<size_t>(next - all.begin());
        const size_t first = after > 0 ? after - 1 : 0;
        std::string found = one(first, fault);
        if (found.empty() && after < all.size() && all[after].time - time <= kAtOnce) {
            found = one(after, fault);
        }
        return found;
    }

private:
    template <class Fault>
    std::string one(size_t index, Fault& fault) {
        Known& known = known_[index % 2];
        if (known.index != index) {
            known = {index, fault(file_.read(topic_, index))};
        }
        return known.fault;
    }

    struct Known {
        size_t index = SIZE_MAX;
        std::string fault;
    };
    MessageFile& file_;
    const MessageTopic& topic_;
    std::array<Known, 2> known_;
};

} // namespace fathom
