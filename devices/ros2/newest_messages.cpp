// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/newest_messages.h"

namespace fathom {

size_t NewestMessages::add(const std::string& topic, const std::string& type, size_t most) {
    const size_t at = topicAt(topic, type, true);
    if (at == kept_.size()) {
        kept_.emplace_back();
        most_.push_back(most);
    }
    return at;
}

void NewestMessages::keep(size_t topic, RawMessagePtr message) {
    std::vector<RawMessagePtr>& kept = kept_[topic];
    if (kept.size() == most_[topic]) {
        kept.erase(kept.begin());
    }
    const auto time = static_cast<uint64_t>(1e9 * message->arrivalUtc);
    kept.push_back(std::move(message));
    std::vector<MessageEntry>& entries = topics_[topic].messages;
    if (entries.size() < kept.size()) {
        entries.push_back({0, topic, entries.size()});
    }
    entries.back().time = time;
}

} // namespace fathom
