// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/mcap_writer.h"

#include "engine/types/error.h"

#include <algorithm>
#include <zlib.h>
#include <zstd.h>

namespace fathom {

namespace {

constexpr std::array<uint8_t, 8> kMcapBegin{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr int kMcapEffort = 1; // zstd level: images of a camera do not shrink much more
constexpr uint8_t kHeaderOp = 1, kFooterOp = 2, kSchemaOp = 3, kChannelOp = 4, kMessageOp = 5, kChunkOp = 6,
                  kMessageIndexOp = 7, kChunkIndexOp = 8, kStatisticsOp = 11, kSummaryOffsetOp = 14,
                  kDataEndOp = 15;

void putRecord(ByteWriter& to, uint8_t kind, const ByteWriter& content) {
    to.value(kind);
    to.value(uint64_t{content.size()});
    to.append(content.bytes());
}

std::vector<uint8_t> packed(const std::vector<uint8_t>& bytes) {
    std::vector<uint8_t> out(ZSTD_compressBound(bytes.size()));
    const size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kMcapEffort);
    if (ZSTD_isError(size) != 0) {
        throw Error(std::string("zstd: ") + ZSTD_getErrorName(size));
    }
    out.resize(size);
    return out;
}

} // namespace

void McapWriter::Span::add(uint64_t time) {
    first = std::min(first, time);
    last = std::max(last, time);
}

McapWriter::McapWriter(const std::filesystem::path& file, size_t chunkBytes)
    : file_(file)
    , chunkBytes_(chunkBytes) {
    ByteWriter head, begin;
    head.text("ros2");
    head.text("fathom");
    begin.append(kMcapBegin);
    putRecord(begin, kHeaderOp, head);
    write(begin);
}

void McapWriter::write(const ByteWriter& bytes) {
    file_.write(bytes.bytes().data(), bytes.size());
    at_ += bytes.size();
}

uint16_t McapWriter::addChannel(const std::string& topic, const std::string& type,
                                const std::string& definition) {
    const auto nextSchema = static_cast<uint16_t>(schemaOf_.size() + 1); // 0 means none
    const auto [schema, fresh] = schemaOf_.emplace(type, nextSchema);
    if (fresh) {
        ByteWriter content;
        content.value(schema->second);
        content.text(type);
        content.text("ros2msg");
        content.text(definition);
        putRecord(schemas_, kSchemaOp, content);
        putRecord(chunk_, kSchemaOp, content);
    }
    const auto channel = static_cast<uint16_t>(countOf_.size());
    countOf_[channel] = 0;
    ByteWriter content;
    content.value(channel);
    content.value(schema->second);
    content.text(topic);
    content.text("cdr");
    content.value(uint32_t{0}); // no metadata
    putRecord(channels_, kChannelOp, content);
    putRecord(chunk_, kChannelOp, content);
    return channel;
}

void McapWriter::add(uint16_t channel, uint64_t time, std::span<const uint8_t> message) {
    constexpr uint64_t kHeader = 22;
    index_[channel].emplace_back(time, chunk_.size());
    chunk_.value(kMessageOp);
    chunk_.value(uint64_t{kHeader + message.size()});
    chunk_.value(channel);
    chunk_.value(static_cast<uint32_t>(countOf_[channel]++));
    chunk_.value(time);
    chunk_.value(time);
    chunk_.append(message);
    chunkSpan_.add(time);
    ++messages_;
    if (chunk_.size() >= chunkBytes_) {
        endChunk();
    }
}

void McapWriter::endChunk() {
    if (index_.empty()) {
        return;
    }
    const std::vector<uint8_t> small = packed(chunk_.bytes());
    ByteWriter content, record;
    content.value(chunkSpan_.first);
    content.value(chunkSpan_.last);
    content.value(uint64_t{chunk_.size()});
    content.value(static_cast<uint32_t>(crc32(0, chunk_.bytes().data(), static_cast<uInt>(chunk_.size()))));
    content.text("zstd");
    content.value(uint64_t{small.size()});
    content.append(small);
    putRecord(record, kChunkOp, content);
    const uint64_t chunkAt = at_;
    write(record);
    writeIndexes(chunkAt, record.size(), small.size());
    span_.add(chunkSpan_.first);
    span_.add(chunkSpan_.last);
    chunkSpan_ = {};
    chunk_.clear();
    index_.clear();
    ++chunks_;
}

void McapWriter::writeIndexes(uint64_t chunkAt, uint64_t chunkSize, uint64_t packedSize) {
    const uint64_t begin = at_;
    ByteWriter places; // channel and place of its index
    for (const auto& [channel, entries] : index_) {
        ByteWriter content, record;
        content.value(channel);
        content.value(static_cast<uint32_t>(16 * entries.size()));
        for (const auto& [time, place] : entries) {
            content.value(time);
            content.value(place);
        }
        putRecord(record, kMessageIndexOp, content);
        places.value(channel);
        places.value(at_);
        write(record);
    }
    ByteWriter content;
    content.value(chunkSpan_.first);
    content.value(chunkSpan_.last);
    content.value(chunkAt);
    content.value(chunkSize);
    content.value(static_cast<uint32_t>(places.size()));
    content.append(places.bytes());
    content.value(at_ - begin);
    content.text("zstd");
    content.value(packedSize);
    content.value(uint64_t{chunk_.size()});
    putRecord(chunkIndexes_, kChunkIndexOp, content);
}

void McapWriter::statistics(ByteWriter& summary) const {
    ByteWriter content;
    content.value(messages_);
    content.value(static_cast<uint16_t>(schemaOf_.size()));
    content.value(static_cast<uint32_t>(countOf_.size()));
    content.value(uint32_t{0}); // attachments
    content.value(uint32_t{0}); // metadata
    content.value(chunks_);
    content.value(messages_ > 0 ? span_.first : uint64_t{0});
    content.value(span_.last);
    content.value(static_cast<uint32_t>(10 * countOf_.size()));
    for (const auto& [channel, count] : countOf_) {
        content.value(channel);
        content.value(count);
    }
    putRecord(summary, kStatisticsOp, content);
}

void McapWriter::finish() {
    endChunk();
    ByteWriter end, none, statisticsRecord, offsets, footer, places;
    none.value(uint32_t{0}); // no checksum
    putRecord(end, kDataEndOp, none);
    write(end);
    statistics(statisticsRecord);
    const uint64_t summaryAt = at_;
    const std::pair<uint8_t, const ByteWriter*> groups[] = {{kSchemaOp, &schemas_},
                                                            {kChannelOp, &channels_},
                                                            {kStatisticsOp, &statisticsRecord},
                                                            {kChunkIndexOp, &chunkIndexes_}};
    for (const auto& [kind, records] : groups) {
        if (records->size() > 0) {
            ByteWriter content;
            content.value(kind);
            content.value(at_);
            content.value(uint64_t{records->size()});
            putRecord(offsets, kSummaryOffsetOp, content);
            write(*records);
        }
    }
    places.value(summaryAt);
    places.value(at_);
    places.value(uint32_t{0}); // no checksum
    write(offsets);
    putRecord(footer, kFooterOp, places);
    footer.append(kMcapBegin);
    write(footer);
    file_.commit();
}

} // namespace fathom
