// SPDX-License-Identifier: Apache-2.0
// Elements of an EBML file, at any place and no larger than is asked for. Source: RFC 8794.
#pragma once

#include "devices/bag/file_bytes.h"
#include "engine/types/error.h"

#include <string>

namespace fathom {

// One element. `end` is that of its parent where its size is not known, or is larger (cut).
struct EbmlElement {
    uint32_t id = 0;              // with the bits that tell its length
    uint64_t dataAt = 0, end = 0; // [bytes] from the file's begin
    bool sized = true, cut = false;

    uint64_t size() const { return end - dataAt; }
};

// All calls throw Error when the element is damaged or ends after its parent. One thread.
class EbmlReader {
public:
    explicit EbmlReader(FileBytes& file)
        : file_(file) {}

    EbmlElement element(uint64_t at, uint64_t parentEnd);
    // The same; one that ends after its parent ends with it, and has no size.
    EbmlElement cutElement(uint64_t at, uint64_t parentEnd);
    // Calls use(child) for each child, in order.
    template <class Use>
    void children(const EbmlElement& parent, Use&& use) {
        for (uint64_t at = parent.dataAt; at < parent.end;) {
            const EbmlElement child = element(at, parent.end);
            use(child);
            at = child.end;
        }
    }
    // An unsigned number of at most 8 bytes.
    uint64_t number(const EbmlElement& element);
    // At most `most` bytes.
    std::string text(const EbmlElement& element, uint64_t most);
    std::vector<uint8_t> bytes(const EbmlElement& element, uint64_t most);

private:
    FileBytes& file_;
};

// The number at the begin of the bytes, with a length of its own, and that length; throws Error.
std::pair<uint64_t, size_t> ebmlNumber(std::span<const uint8_t> bytes);

} // namespace fathom
