// SPDX-License-Identifier: Apache-2.0
// How BagFile finds messages without an index, as after a crash of the recorder: chunk by chunk.
#include "devices/bag/bag_file.h"
#include "devices/bag/bag_records.h"
#include "devices/bag/byte_cursor.h"

namespace fathom {

namespace {

std::string countOf(uint64_t chunks, const char* what) {
    return std::to_string(chunks) + what + (chunks == 1 ? " chunk is " : " chunks are ");
}

} // namespace

// The record at this place of the file, without its data; nothing at the file's end, at bytes that are none,
// and at a record that the file's end cuts, unless it is a chunk.
std::optional<BagFile::Head> BagFile::headAt(uint64_t at) {
    if (at >= size_) {
        return std::nullopt;
    }
    try {
        in_.clear();
        in_.seekg(static_cast<std::streamoff>(at));
        Head head;
        head.fields = bag::parseFields(readBlock());
        head.op = bag::number<uint8_t>(head.fields, "op");
        uint32_t size = 0;
        in_.read(reinterpret_cast<char*>(&size), sizeof size);
        head.end = static_cast<uint64_t>(in_.tellg()) + size;
        head.empty = size == 0;
        head.cut = head.end > size_;
        return in_ && (!head.cut || head.op == bag::kChunk) ? std::optional(head) : std::nullopt;
    } catch (const Error&) {
        return std::nullopt;
    }
}

void BagFile::scan(uint64_t chunksAt, const std::string& lost) {
    topics_.clear();
    std::map<uint32_t, size_t> topicOf; // of a connection
    uint64_t whole = 0, damaged = 0, messages = 0;
    uint64_t at = chunksAt;
    for (std::optional<Head> head = headAt(at); head && !begun_; head = headAt(at)) {
        if (head->op == bag::kChunk) {
            // The recorder states the size of a chunk when it is complete. An incomplete copy cuts it, too.
            if (head->empty || (head->cut && bag::word(head->fields, "compression") == "none")) {
                begun_ = at;
            }
            const uint64_t found = scanChunk(at, topicOf);
            (found > 0 ? whole : damaged) += 1;
            messages += found;
        }
        at = head->end;
    }
    if (messages == 0) {
        throw BadInput(file().string(), "index",
                       lost + ": the bag was not closed, and no whole chunk holds a message",
                       "an indexed bag (rosbag reindex)");
    }
    warn(lost + ": " + countOf(whole, "") + "searched for messages" +
         (damaged > 0 ? ", " + countOf(damaged, " damaged") + "skipped" : "") +
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
    readBlock(); // its head
    in_.seekg(sizeof(uint32_t), std::ios::cur);
    const auto from = static_cast<uint64_t>(in_.tellg());
    if (size_ - from > bag::kMostBytes) {
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
