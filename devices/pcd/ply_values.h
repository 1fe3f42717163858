// SPDX-License-Identifier: Apache-2.0
// The values of a PLY file, one after the other.
#pragma once

#include "devices/pcd/ply_header.h"

namespace fathom {

// Values after the header, as double. `element` and `index` name the record in errors. Throws BadInput.
class PlyValues {
public:
    // The text outlives it.
    PlyValues(std::string file, std::string_view text, const PlyHeader& head)
        : file_(std::move(file))
        , text_(text)
        , at_(head.end)
        , format_(head.format) {}

    // A list gives its first value, NaN when it has none; the others are passed over.
    double property(const PlyProperty& property, const std::string& element, uint64_t index);
    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const;

private:
    double next(PlyType type, const std::string& element, uint64_t index);
    [[noreturn]] void cutOff(const std::string& element, uint64_t index) const;
    double word(const std::string& element, uint64_t index);
    double binary(PlyType type, const std::string& element, uint64_t index);

    std::string file_;
    std::string_view text_;
    size_t at_;
    PlyFormat format_;
};

} // namespace fathom
