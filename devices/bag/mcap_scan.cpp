// SPDX-License-Identifier: Apache-2.0
// How McapFile finds chunks and messages: by the summary, or record by record.
#include "devices/bag/mcap_file.h"
#include "devices/bag/mcap_records.h"
#include "devices/bag/mcap_summary.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>

namespace fathom {

// Takes chunks and channels from the summary, and messages from the indexes after the chunks. False, with
// nothing taken, where these do not hold as many messages as the summary counts.
bool McapFile::useSummary() {
    const std::optional<McapSummary> summary = mcapSummary(in_);
    if (!summary) {
        return false;
    }
    try {
        for (const std::vector<uint8_t>& schema : summary->schemas) {
            readSchema(schema);
        }
        for (const std::vector<uint8_t>& channel : summary->channels) {
            readChannel(channel);
        }
        for (const McapSummary::Chunk& chunk : summary->chunks) {
            chunks_.push_back({chunk.at, chunk.size, true});
            readIndexes(chunk.indexesAt, chunk.indexesSize);
        }
    } catch (const Error&) {
        messages_ = UINT64_MAX;
    }
    if (messages_ == summary->messages) {
        return true;
    }
    schemas_.clear();
    channels_.clear();
    topics_.clear();
    found_.clear();
    chunks_.clear();
    messages_ = 0;
    return false;
}

void McapFile::readIndexes(uint64_t at, uint64_t size) {
    const std::vector<uint8_t> records = content(at, size);
    for (ByteCursor cursor(records); !cursor.empty();) {
        const auto kind = cursor.value<uint8_t>();
        const std::span<const uint8_t> index = cursor.take(cursor.value<uint64_t>());
        if (kind != mcap::kMessageIndex) {
            throw Error("a record among the indexes");
        }
        readIndex(index);
    }
}

// Headers of all records, in sequence. Chunks are not unpacked.
void McapFile::scan() {
    for (uint64_t at = mcap::kMagic.size(); at < in_.size();) {
        std::array<uint8_t, mcap::kRecordHeader> head{};
        if (in_.size() - at < head.size()) {
            break;
        }
        in_.read(at, head);
        uint64_t size = 0;
        std::memcpy(&size, head.data() + 1, sizeof size);
        if (size > in_.size() - at - mcap::kRecordHeader) {
            break;
        }
        if (!record(head[0], at + mcap::kRecordHeader, size)) {
            return; // the footer
        }
        at += mcap::kRecordHeader + size;
    }
    if (!chunks_.empty()) {
        chunks_.back().indexed = false; // its indexes may be incomplete
    }
    for (auto& [channel, entries] : found_) {
        messages_ -= std::erase_if(
            entries, [&](const MessageEntry& e) { return !chunks_.empty() && e.chunk == chunks_.back().at; });
    }
    warn("ends early: it was not finished; " + std::to_string(chunks_.size()) + " whole chunks are used");
}

bool McapFile::record(uint8_t kind, uint64_t at, uint64_t size) {
    if (kind == mcap::kSchema) {
        readSchema(content(at, size));
    } else if (kind == mcap::kChannel) {
        readChannel(content(at, size));
    } else if (kind == mcap::kChunk) {
        chunks_.push_back({at, size, false});
    } else if (kind == mcap::kMessageIndex && !chunks_.empty()) {
        chunks_.back().indexed = true;
        readIndex(content(at, size));
    } else if (kind == mcap::kMessage) {
        const std::vector<uint8_t> head = content(at, std::min<uint64_t>(size, 22));
        ByteCursor cursor(head);
        const auto channel = cursor.value<uint16_t>();
        cursor.word(); // sequence
        add(channel, {cursor.value<uint64_t>(), 0, at});
    }
    return kind != mcap::kFooter;
}

} // namespace fathom
