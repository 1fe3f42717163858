// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/mcap_summary.h"

#include "devices/bag/byte_cursor.h"
#include "devices/bag/mcap_records.h"

#include <algorithm>
#include <array>
#include <zlib.h>

namespace fathom {

namespace {

constexpr uint64_t kSummaryBytes = 256u << 20; // of the whole summary
constexpr uint64_t kFooterBytes = mcap::kRecordHeader + 20, kEndMagic = mcap::kMagic.size();

struct Footer {
    uint64_t summaryAt = 0; // 0 = no summary
    uint32_t checksum = 0;  // of the summary, 0 = none
    uint64_t at = 0;        // of the footer's record
};

std::optional<Footer> footerOf(FileBytes& file) {
    if (file.size() < kFooterBytes + 2 * kEndMagic) {
        return std::nullopt;
    }
    Footer footer;
    footer.at = file.size() - kEndMagic - kFooterBytes;
    std::array<uint8_t, kFooterBytes> bytes{};
    file.read(footer.at, bytes);
    ByteCursor cursor(bytes);
    if (cursor.value<uint8_t>() != mcap::kFooter ||
        cursor.value<uint64_t>() != kFooterBytes - mcap::kRecordHeader) {
        return std::nullopt;
    }
    footer.summaryAt = cursor.value<uint64_t>();
    cursor.value<uint64_t>(); // offsets of the summary's groups
    footer.checksum = cursor.word();
    return footer.summaryAt == 0 || footer.summaryAt >= footer.at ? std::nullopt : std::optional(footer);
}

McapSummary::Chunk chunkOf(std::span<const uint8_t> content) {
    ByteCursor cursor(content);
    cursor.take(16); // first and last time
    const auto at = cursor.value<uint64_t>(), length = cursor.value<uint64_t>();
    cursor.block(); // place of each channel's index
    const auto indexes = cursor.value<uint64_t>();
    if (length < mcap::kRecordHeader || at > UINT64_MAX - length) {
        throw Error("a chunk without a header");
    }
    return {at + mcap::kRecordHeader, length - mcap::kRecordHeader, at + length, indexes};
}

// Whether all chunks with their indexes follow each other before the summary.
bool ordered(const std::vector<McapSummary::Chunk>& chunks, uint64_t end) {
    uint64_t last = kEndMagic;
    for (const McapSummary::Chunk& chunk : chunks) {
        if (chunk.at < last + mcap::kRecordHeader || chunk.indexesAt > end ||
            chunk.indexesSize > end - chunk.indexesAt) {
            return false;
        }
        last = chunk.indexesAt + chunk.indexesSize;
    }
    return true;
}

std::optional<McapSummary> parsed(std::span<const uint8_t> records, uint64_t end) {
    McapSummary summary;
    bool counted = false;
    uint32_t chunks = 0;
    for (ByteCursor cursor(records); !cursor.empty();) {
        const auto kind = cursor.value<uint8_t>();
        const std::span<const uint8_t> content = cursor.take(cursor.value<uint64_t>());
        if (kind == mcap::kSchema) {
            summary.schemas.emplace_back(content.begin(), content.end());
        } else if (kind == mcap::kChannel) {
            summary.channels.emplace_back(content.begin(), content.end());
        } else if (kind == mcap::kChunkIndex) {
            summary.chunks.push_back(chunkOf(content));
        } else if (kind == mcap::kStatistics) {
            ByteCursor figures(content);
            summary.messages = figures.value<uint64_t>();
            figures.take(14); // numbers of schemas, channels, attachments, metadata
            chunks = figures.word();
            counted = true;
        }
    }
    std::ranges::sort(summary.chunks, [](const auto& a, const auto& b) { return a.at < b.at; });
    const bool whole = counted && chunks == summary.chunks.size() && ordered(summary.chunks, end);
    return whole ? std::optional(std::move(summary)) : std::nullopt;
}

} // namespace

std::optional<McapSummary> mcapSummary(FileBytes& file) {
    try {
        const std::optional<Footer> footer = footerOf(file);
        if (!footer) {
            return std::nullopt;
        }
        // The checksum covers the footer, too, up to itself.
        constexpr uint64_t kCovered = kFooterBytes - sizeof(uint32_t);
        const std::vector<uint8_t> bytes =
            file.read(footer->summaryAt, footer->at - footer->summaryAt + kCovered, kSummaryBytes);
        if (footer->checksum != 0 &&
            crc32(0, bytes.data(), static_cast<uInt>(bytes.size())) != footer->checksum) {
            return std::nullopt;
        }
        return parsed(std::span(bytes).first(bytes.size() - kCovered), footer->summaryAt);
    } catch (const Error&) {
        return std::nullopt;
    }
}

} // namespace fathom
