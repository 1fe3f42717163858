// SPDX-License-Identifier: Apache-2.0
#include "devices/images/npy_header.h"

#include "devices/images/npy_image.h"
#include "devices/recorded/recording_intrinsics.h"
#include "devices/recorded/text_file.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

namespace fathom {

namespace {

constexpr std::array<uint8_t, 6> kNpyMagic{0x93, 'N', 'U', 'M', 'P', 'Y'};
constexpr size_t kMaxNpyHeader = 1u << 16; // [bytes]

// The dictionary's text between its braces, and where the values begin; empty when it is cut off.
std::string_view npyDictionary(ImageBytes bytes, size_t& values) {
    const bool first = bytes[6] == 1;
    const size_t begin = first ? 10 : 12;
    if (bytes.size() < begin || bytes[6] < 1 || bytes[6] > 3) {
        return {};
    }
    size_t length = bytes[8] | size_t{bytes[9]} << 8;
    length |= first ? 0 : size_t{bytes[10]} << 16 | size_t{bytes[11]} << 24;
    if (length > std::min(kMaxNpyHeader, bytes.size() - begin)) {
        return {};
    }
    values = begin + length;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + begin, length);
    const size_t open = text.find('{'), close = text.rfind('}');
    return open == std::string_view::npos || close == std::string_view::npos || close < open
               ? std::string_view{}
               : text.substr(open + 1, close - open - 1);
}

// "'key': value" pairs, split at commas outside of brackets.
std::map<std::string_view, std::string_view> npyFields(std::string_view text) {
    std::map<std::string_view, std::string_view> fields;
    const auto add = [&](std::string_view pair) {
        const auto parts = splitFields(pair, ':');
        if (parts.size() == 2 && parts[0].size() > 2) {
            fields.emplace(parts[0].substr(1, parts[0].size() - 2), parts[1]);
        }
    };
    int depth = 0;
    size_t begin = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        depth += text[i] == '(' || text[i] == '[' ? 1 : (text[i] == ')' || text[i] == ']' ? -1 : 0);
        if (text[i] == ',' && depth == 0) {
            add(text.substr(begin, i - begin));
            begin = i + 1;
        }
    }
    add(text.substr(begin));
    return fields;
}

bool takeDescr(std::string_view descr, NpyHeader& head) {
    const auto oneOf = [](std::string_view all, char c) { return all.find(c) != std::string_view::npos; };
    if (descr.size() != 5 || descr.front() != '\'' || descr.back() != '\'' || !oneOf("<>", descr[1]) ||
        !oneOf("uif", descr[2]) || !oneOf("248", descr[3])) {
        return false;
    }
    head.bigEndian = descr[1] == '>';
    head.kind = descr[2];
    head.bytes = descr[3] - uint32_t{'0'};
    return true;
}

// "(480, 640)" or "(480, 640, 1)".
bool takeShape(std::string_view shape, NpyHeader& head) {
    if (shape.size() < 2 || shape.front() != '(' || shape.back() != ')') {
        return false;
    }
    const auto sides = splitFields(shape.substr(1, shape.size() - 2), ',');
    const bool two = sides.size() == 2, three = sides.size() == 3 && sides[2] == "1";
    return (two || three) && parseNumber(sides[0], head.height) && parseNumber(sides[1], head.width) &&
           head.width >= 1 && head.height >= 1 && head.width <= kMaxImageWidth &&
           head.height <= kMaxImageHeight;
}

std::string npyFault(const char* field, std::string_view value, const char* allowed) {
    return std::string("NPY: ") + field + ": " + std::string(value.substr(0, 80)) + " (allowed: " + allowed +
           ")";
}

} // namespace

bool isNpy(ImageBytes bytes) {
    return bytes.size() >= 10 && std::equal(kNpyMagic.begin(), kNpyMagic.end(), bytes.begin());
}

NpyHeader parseNpyHeader(ImageBytes bytes) {
    NpyHeader head;
    const std::string_view text = isNpy(bytes) ? npyDictionary(bytes, head.values) : std::string_view{};
    auto fields = npyFields(text);
    if (!fields.contains("descr") || !fields.contains("fortran_order") || !fields.contains("shape")) {
        head.fault = "NPY: a header without descr, fortran_order and shape, or cut off";
    } else if (!takeDescr(fields["descr"], head)) {
        head.fault = npyFault("descr", fields["descr"], "integers or floating point of 2, 4 or 8 bytes: <u2");
    } else if (fields["fortran_order"] != "False") {
        head.fault = npyFault("fortran_order", fields["fortran_order"], "False: save ascontiguousarray()");
    } else if (!takeShape(fields["shape"], head)) {
        head.fault = npyFault("shape", fields["shape"], "(height, width), at most (2160, 3840)");
    }
    return head;
}

} // namespace fathom
