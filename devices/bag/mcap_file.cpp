// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/mcap_file.h"

#include "devices/bag/mcap_records.h"
#include "devices/bag/unpack_chunk.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"

#include <array>
#include <set>
#include <zlib.h>

namespace fathom {

namespace {

constexpr uint64_t kMcapBytes = 1u << 30;      // of one record that is read, or of one unpacked chunk
constexpr uint64_t kMcapMessages = 20'000'000; // of a file
constexpr size_t kMcapTopics = 10'000;

std::string mcapText(ByteCursor& cursor) {
    return cursor.name();
}

// One record of an unpacked chunk.
struct Inner {
    uint8_t kind = 0;
    size_t at = 0;
    std::span<const uint8_t> content;
};

bool nextInner(std::span<const uint8_t> bytes, size_t& at, Inner& inner) {
    if (bytes.size() - at < mcap::kRecordHeader) {
        return false;
    }
    ByteCursor cursor(bytes.subspan(at));
    inner.kind = cursor.value<uint8_t>();
    const auto size = cursor.value<uint64_t>();
    if (size > cursor.left()) {
        throw Error("truncated");
    }
    inner.at = at;
    inner.content = cursor.take(size);
    at += mcap::kRecordHeader + size;
    return true;
}

} // namespace

McapFile::McapFile(const std::filesystem::path& file)
    : MessageFile(file)
    , in_(file) {
    std::array<uint8_t, mcap::kMagic.size()> magic{};
    if (in_.size() >= magic.size()) {
        in_.read(0, magic);
    }
    if (magic != mcap::kMagic) {
        throw BadInput(file.string(), "format", in_.open() ? "not MCAP" : whyUnreadable(file),
                       "an MCAP file of version 0");
    }
    try {
        in_.readAhead(false);
        if (!useSummary()) {
            scan();
        }
        readUnindexed();
        resolve();
        in_.readAhead(true);
    } catch (const Error& e) {
        throw BadInput(file.string(), "content", e.what(), "whole MCAP records");
    }
}

std::vector<uint8_t> McapFile::content(uint64_t at, uint64_t size) {
    return in_.read(at, size, kMcapBytes);
}

void McapFile::readSchema(std::span<const uint8_t> content) {
    ByteCursor cursor(content);
    const auto id = cursor.value<uint16_t>();
    schemas_[id] = mcapText(cursor);
}

void McapFile::readChannel(std::span<const uint8_t> content) {
    ByteCursor cursor(content);
    const auto id = cursor.value<uint16_t>(), schema = cursor.value<uint16_t>();
    const std::string topic = mcapText(cursor), encoding = mcapText(cursor);
    const auto type = schemas_.find(schema);
    const bool read = encoding == "cdr" || encoding == "ros1";
    if (channels_.contains(id)) {
        return;
    }
    if (topics_.size() >= kMcapTopics) {
        throw Error("more than " + std::to_string(kMcapTopics) + " topics");
    }
    const std::string name = type == schemas_.end() ? "" : type->second;
    channels_[id] = topicAt(topic, read ? name : encoding + " " + name, encoding == "cdr");
}

void McapFile::readIndex(std::span<const uint8_t> content) {
    ByteCursor cursor(content);
    const auto channel = cursor.value<uint16_t>();
    for (ByteCursor entries(cursor.block()); !entries.empty();) {
        const auto time = entries.value<uint64_t>(), offset = entries.value<uint64_t>();
        add(channel, {time, chunks_.back().at, offset});
    }
}

void McapFile::add(uint16_t channel, const MessageEntry& entry) {
    if (++messages_ > kMcapMessages) {
        throw Error("more than " + std::to_string(kMcapMessages) + " messages");
    }
    found_[channel].push_back(entry);
}

// Chunks without an index, and for each channel that no record outside of chunks describes the first whole
// chunk with its messages.
void McapFile::readUnindexed() {
    std::set<uint64_t> damaged;
    const auto tryChunk = [&](const Chunk& chunk, bool messages) {
        try {
            scanChunk(chunk, messages);
        } catch (const Error& e) {
            damaged.insert(chunk.at);
            log::warn("{}: a chunk at byte {} is skipped: {}", file().string(), chunk.at, e.what());
        }
    };
    std::map<uint64_t, Chunk> indexed; // by place
    for (const Chunk& chunk : chunks_) {
        if (chunk.indexed) {
            indexed.emplace(chunk.at, chunk);
        } else {
            tryChunk(chunk, true);
        }
    }
    for (const auto& [channel, entries] : found_) {
        uint64_t tried = 0;
        for (auto entry = entries.begin(); entry != entries.end() && !channels_.contains(channel); ++entry) {
            const auto chunk = indexed.find(entry->chunk);
            if (entry->chunk == tried || chunk == indexed.end() || damaged.contains(entry->chunk)) {
                continue;
            }
            tried = entry->chunk;
            tryChunk(chunk->second, false);
            if (!damaged.contains(tried)) {
                break;
            }
        }
    }
}

void McapFile::scanChunk(const Chunk& chunk, bool messages) {
    const UnpackedChunk bytes = unpack(chunk.at);
    Inner inner;
    for (size_t at = 0; nextInner(*bytes, at, inner);) {
        if (inner.kind == mcap::kSchema) {
            readSchema(inner.content);
        } else if (inner.kind == mcap::kChannel) {
            readChannel(inner.content);
        } else if (inner.kind == mcap::kMessage && messages) {
            ByteCursor cursor(inner.content);
            const auto channel = cursor.value<uint16_t>();
            cursor.word();
            add(channel, {cursor.value<uint64_t>(), chunk.at, inner.at});
        }
    }
}

void McapFile::resolve() {
    for (auto& [channel, entries] : found_) {
        const auto topic = channels_.find(channel);
        if (topic != channels_.end()) {
            auto& all = topics_[topic->second].messages;
            all.insert(all.end(), entries.begin(), entries.end());
        }
    }
    found_.clear();
    sortByTime();
}

UnpackedChunk McapFile::unpack(uint64_t chunkAt) {
    return unpacked_.at(chunkAt, [&] {
        const auto chunk = std::ranges::lower_bound(chunks_, chunkAt, {}, &Chunk::at);
        if (chunk == chunks_.end() || chunk->at != chunkAt) {
            throw Error("the index does not point to a chunk");
        }
        const std::vector<uint8_t> packed = content(chunkAt, chunk->size);
        ByteCursor cursor(packed);
        cursor.take(16); // first and last time
        const auto size = cursor.value<uint64_t>();
        const uint32_t sum = cursor.word();
        const std::string compression = mcapText(cursor);
        const auto length = cursor.value<uint64_t>();
        if (size > kMcapBytes || length > cursor.left()) {
            throw Error("a chunk of " + std::to_string(size) + " bytes");
        }
        std::vector<uint8_t> bytes = unpackChunk(compression.empty() ? "none" : compression,
                                                 cursor.take(length), static_cast<uint32_t>(size));
        if (sum != 0 && crc32(0, bytes.data(), static_cast<uInt>(bytes.size())) != sum) {
            throw Error("a chunk whose checksum is wrong");
        }
        return bytes;
    });
}

MessageBytes McapFile::bytes(const MessageEntry& entry) {
    constexpr size_t kMcapHeader = 22; // channel, sequence, two times
    MessageBytes message;
    if (entry.chunk == 0) {
        uint64_t size = 0;
        const std::vector<uint8_t> head = content(entry.offset - sizeof size, sizeof size);
        std::memcpy(&size, head.data(), sizeof size);
        message = MessageBytes::of(content(entry.offset, size));
    } else {
        const UnpackedChunk chunk = unpack(entry.chunk);
        Inner inner;
        size_t at = entry.offset;
        if (at > chunk->size() || !nextInner(*chunk, at, inner) || inner.kind != mcap::kMessage) {
            throw Error("the index does not point to a message");
        }
        message = {inner.content, chunk};
    }
    if (message.view.size() < kMcapHeader) {
        throw Error("truncated");
    }
    message.view = message.view.subspan(kMcapHeader);
    return unpackMessage(std::move(message));
}

} // namespace fathom
