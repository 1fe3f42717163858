// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/ebml_reader.h"

#include <algorithm>
#include <array>
#include <bit>

namespace fathom {

namespace {

constexpr size_t kLongestId = 4, kLongestSize = 8; // [bytes]

uint64_t bigEndian(std::span<const uint8_t> bytes) {
    uint64_t value = 0;
    for (const uint8_t byte : bytes) {
        value = value << 8 | byte;
    }
    return value;
}

// Bytes that the leading zeros of the first one tell.
size_t lengthOf(std::span<const uint8_t> bytes, size_t longest) {
    const size_t length = bytes.empty() ? 0 : 1 + static_cast<size_t>(std::countl_zero(bytes[0]));
    if (length == 0 || length > longest || length > bytes.size()) {
        throw Error("a damaged element");
    }
    return length;
}

} // namespace

std::pair<uint64_t, size_t> ebmlNumber(std::span<const uint8_t> bytes) {
    const size_t length = lengthOf(bytes, kLongestSize);
    return {bigEndian(bytes.first(length)) & ~(uint64_t{1} << (7 * length)), length};
}

EbmlElement EbmlReader::cutElement(uint64_t at, uint64_t parentEnd) {
    const uint64_t end = std::min(parentEnd, file_.size());
    std::array<uint8_t, kLongestId + kLongestSize> head{};
    const std::span<uint8_t> found =
        std::span<uint8_t>(head).first(std::min<uint64_t>(head.size(), end - std::min(at, end)));
    file_.read(at, found);
    const size_t idLength = lengthOf(found, kLongestId);
    const auto [size, sizeLength] = ebmlNumber(found.subspan(idLength));
    EbmlElement element;
    element.id = static_cast<uint32_t>(bigEndian(found.first(idLength)));
    element.dataAt = at + idLength + sizeLength;
    const bool endless = size == (uint64_t{1} << (7 * sizeLength)) - 1;
    element.sized = !endless && size <= parentEnd - element.dataAt;
    element.cut = !endless && !element.sized;
    element.end = element.sized ? element.dataAt + size : parentEnd;
    return element;
}

EbmlElement EbmlReader::element(uint64_t at, uint64_t parentEnd) {
    const EbmlElement element = cutElement(at, parentEnd);
    if (element.cut) {
        throw Error("an element ends after its parent");
    }
    return element;
}

uint64_t EbmlReader::number(const EbmlElement& element) {
    return bigEndian(bytes(element, kLongestSize));
}

std::string EbmlReader::text(const EbmlElement& element, uint64_t most) {
    const std::vector<uint8_t> read = bytes(element, most);
    const auto end = std::find(read.begin(), read.end(), 0); // it may be padded
    return printable(std::string(read.begin(), end));
}

std::vector<uint8_t> EbmlReader::bytes(const EbmlElement& element, uint64_t most) {
    return file_.read(element.dataAt, element.size(), most);
}

} // namespace fathom
