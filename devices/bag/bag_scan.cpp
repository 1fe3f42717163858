// SPDX-License-Identifier: Apache-2.0
// How BagFile finds messages without an index, as after a crash of the recorder: chunk by chunk.
#include "devices/bag/bag_file.h"
#include "devices/bag/bag_records.h"
#include "devices/bag/byte_cursor.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace fathom {

namespace {

std::string countOf(uint64_t chunks, const char* what) {
    return std::to_string(chunks) + what + (chunks == 1 ? " chunk is " : " chunks are ");
}

std::string placesText(uint64_t places, uint64_t first) {
    return places == 0
               ? ""
               : (places == 1 ? ", a damaged place is skipped"
                              : ", " + std::to_string(places) + " damaged places are skipped") +
                     (places == 1 ? ", at byte " : ", the first one at byte ") + std::to_string(first);
}

} // namespace

// The record at this place of the file, without its data; nothing at the file's end, at bytes that are none,
// and at a record that the file's end cuts, unless it is a chunk.
std::optional<BagFile::Header> BagFile::headerAt(uint64_t at) {
    if (at >= size_) {
        return std::nullopt;
    }
    try {
        in_.clear();
        in_.seekg(static_cast<std::streamoff>(at));
        Header header;
        header.fields = bag::parseFields(readBlock());
        header.op = bag::number<uint8_t>(header.fields, "op");
        uint32_t size = 0;
        in_.read(reinterpret_cast<char*>(&size), sizeof size);
        header.end = static_cast<uint64_t>(in_.tellg()) + size;
        header.empty = size == 0;
        header.cut = header.end > size_;
        return in_ && (!header.cut || header.op == bag::kChunk) ? std::optional(header) : std::nullopt;
    } catch (const Error&) {
        return std::nullopt;
    }
}

// The next chunk from this place on, found by its header; empty = none. For files that are damaged between
// chunks.
std::optional<uint64_t> BagFile::nextChunk(uint64_t from) {
    constexpr std::string_view kMark("\x04\0\0\0op=\x05", 8); // a field of the header, at any place in it
    constexpr uint64_t kBlock = 1u << 20, kMaxHeader = 128;   // [bytes]
    std::string bytes;
    for (uint64_t at = from; at < size_; at += kBlock) {
        bytes.resize(std::min(kBlock + 2 * kMaxHeader, size_ - at));
        in_.clear();
        in_.seekg(static_cast<std::streamoff>(at));
        in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        bytes.resize(static_cast<size_t>(in_.gcount()));
        for (size_t mark = bytes.find(kMark); mark != std::string::npos; mark = bytes.find(kMark, mark + 1)) {
            for (size_t start = mark - std::min<size_t>(mark, kMaxHeader); start + 4 <= mark; ++start) {
                uint32_t length = 0;
                std::memcpy(&length, bytes.data() + start, sizeof length);
                const std::optional<Header> found =
                    length <= kMaxHeader && start + 4 + length > mark ? headerAt(at + start) : std::nullopt;
                if (found && found->op == bag::kChunk && found->fields.contains("compression")) {
                    return at + start;
                }
            }
        }
    }
    return std::nullopt;
}

// Of a closed bag, whose index names them all, so that a damaged chunk does not lose the ones it describes.
std::map<uint32_t, size_t> BagFile::connectionsAt(uint64_t indexAt) {
    std::map<uint32_t, size_t> topicOf;
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(indexAt));
    try {
        while (const auto record = indexAt == 0 ? std::nullopt : nextOfIndex(true)) {
            if (bag::number<uint8_t>(record->fields, "op") == bag::kConnection) {
                const bag::Fields fields = bag::parseFields(record->data);
                topicOf[bag::number<uint32_t>(record->fields, "conn")] =
                    topicAt(bag::word(record->fields, "topic"), bag::word(fields, "type"), false);
            }
        }
    } catch (const Error&) { // the chunks name them, too
    }
    return topicOf;
}

void BagFile::scan(uint64_t chunksAt, uint64_t indexAt, const std::string& lost) {
    topics_.clear();
    std::map<uint32_t, size_t> topicOf = connectionsAt(indexAt); // of a connection
    uint64_t whole = 0, damaged = 0, messages = 0, gaps = 0, firstGap = 0, unread = 0;
    for (uint64_t at = chunksAt; at < size_ && !begun_;) {
        const std::optional<Header> header = headerAt(at);
        const bool leads = header && !header->cut && (header->end == size_ || headerAt(header->end));
        const std::optional<uint64_t> next = leads ? header->end : nextChunk(at + 1);
        uint64_t found = 0;
        if (header && header->op == bag::kChunk) {
            // The recorder states the size of a chunk when it is complete. An incomplete copy cuts it, too.
            const bool plain = bag::word(header->fields, "compression") == "none";
            if ((header->empty || (header->cut && plain)) && (leads || !next)) {
                begun_ = at;
            }
            found = scanChunk(at, topicOf);
            (found > 0 ? whole : damaged) += 1;
            messages += found;
        }
        const uint64_t read = found > 0 ? header->end : at;
        if (!leads && next && (found > 0 || !header || header->op != bag::kChunk)) {
            firstGap = gaps++ == 0 ? read : firstGap;
        }
        unread = !next && !header ? size_ - at : 0;
        at = next.value_or(header && !header->cut ? header->end : size_);
    }
    if (messages == 0) {
        throw BadInput(file().string(), "index",
                       lost + ": the bag was not closed, and no whole chunk holds a message",
                       "an indexed bag (rosbag reindex)");
    }
    warn(lost + ": " + countOf(whole, "") + "searched for messages" +
         (damaged > 0 ? ", " + countOf(damaged, " damaged") + "skipped" : "") + placesText(gaps, firstGap) +
         (unread > 0 ? ", the last " + std::to_string(unread) + " bytes are not read" : "") +
         "; rosbag reindex makes an index");
    sortByTime();
}

// Takes connections and messages of the chunk up to the first damage. Returns the number of messages.
uint64_t BagFile::scanChunk(uint64_t chunkAt, std::map<uint32_t, size_t>& topicOf) {
    uint64_t found = 0;
    try {
        const UnpackedChunk chunk = unpack(chunkAt);
        for (ByteCursor cursor(*chunk); !cursor.empty();) {
            const uint64_t offset = chunk->size() - cursor.left();
            const bag::Fields fields = bag::parseFields(cursor.block());
            const std::span<const uint8_t> data = cursor.block();
            const auto op = bag::number<uint8_t>(fields, "op");
            if (op == bag::kConnection) {
                topicOf[bag::number<uint32_t>(fields, "conn")] =
                    topicAt(bag::word(fields, "topic"), bag::word(bag::parseFields(data), "type"), false);
            } else if (op == bag::kMessage) {
                const auto topic = topicOf.find(bag::number<uint32_t>(fields, "conn"));
                const auto time = bag::number<uint64_t>(fields, "time"); // seconds, nanoseconds
                if (topic != topicOf.end()) {
                    topics_[topic->second].messages.push_back(
                        {(time & 0xffffffffu) * 1'000'000'000u + (time >> 32), chunkAt, offset});
                    ++found;
                }
            }
        }
    } catch (const Error&) { // cut off, or damaged: what comes before is whole
    }
    return found;
}

// The chunk that the recorder had begun, or that the file's end cuts: the rest of the file, not compressed.
std::vector<uint8_t> BagFile::begunChunk() {
    readBlock(); // its header
    in_.seekg(sizeof(uint32_t), std::ios::cur);
    const auto from = static_cast<uint64_t>(in_.tellg());
    if (size_ - from > bag::kMaxBytes) {
        throw Error("a chunk of " + std::to_string(size_ - from) + " bytes");
    }
    std::vector<uint8_t> rest(size_ - from);
    in_.read(reinterpret_cast<char*>(rest.data()), static_cast<std::streamsize>(rest.size()));
    if (!in_) {
        throw Error("truncated");
    }
    return rest;
}

} // namespace fathom
