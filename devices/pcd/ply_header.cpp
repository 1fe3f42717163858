// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/ply_header.h"

#include "engine/types/error.h"
#include "engine/types/lower_case.h"
#include "engine/types/parse_number.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fathom {

namespace {

constexpr size_t kPlyElements = 64, kPlyProperties = 256, kPlyLine = 4096, kPlyHeader = 1u << 20;

struct PlyTypeName {
    std::string_view name, other;
    PlyType type;
    uint8_t bytes;
};
constexpr std::array kPlyTypes{PlyTypeName{"char", "int8", PlyType::Int8, 1},
                               PlyTypeName{"uchar", "uint8", PlyType::Uint8, 1},
                               PlyTypeName{"short", "int16", PlyType::Int16, 2},
                               PlyTypeName{"ushort", "uint16", PlyType::Uint16, 2},
                               PlyTypeName{"int", "int32", PlyType::Int32, 4},
                               PlyTypeName{"uint", "uint32", PlyType::Uint32, 4},
                               PlyTypeName{"float", "float32", PlyType::Float32, 4},
                               PlyTypeName{"double", "float64", PlyType::Float64, 8}};

// Reads the header's lines one by one.
class PlyHeadReader {
public:
    PlyHeadReader(const std::string& file, std::string_view text)
        : file_(file)
        , text_(text) {}

    PlyHeader read() {
        if (line() != std::vector<std::string>{"ply"}) {
            refuse("format", "no PLY", "a PLY file");
        }
        bool formatted = false;
        for (auto words = line(); words != std::vector<std::string>{"end_header"}; words = line()) {
            if (words.empty()) {
                continue;
            }
            if (words[0] == "format") {
                readFormat(words);
                formatted = true;
            } else if (words[0] == "element") {
                readElement(words);
            } else if (words[0] == "property") {
                readProperty(words);
            } else if (words[0] == "obj_info" || words[0] == "comment") {
                readSize(words);
            } else {
                refuse("header", words[0], "format, element, property, comment, obj_info, end_header");
            }
        }
        if (!formatted) {
            refuse("format", "missing", kFormats);
        }
        head_.end = at_;
        return std::move(head_);
    }

private:
    static constexpr const char* kFormats = "ascii, binary_little_endian or binary_big_endian 1.0";

    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(file_, field, value, allowed);
    }

    // The words of the next line, which may end in CR LF.
    std::vector<std::string> line() {
        const size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos || end - at_ > kPlyLine || end > kPlyHeader) {
            refuse("header", end == std::string_view::npos ? "cut off" : "too long",
                   "a PLY header that ends in end_header, lines of at most 4096 characters");
        }
        std::vector<std::string> words(1);
        for (const char c : text_.substr(at_, end - at_)) {
            if (std::isspace(static_cast<unsigned char>(c)) == 0) {
                words.back() += c;
            } else if (!words.back().empty()) {
                words.emplace_back();
            }
        }
        if (words.back().empty()) {
            words.pop_back();
        }
        at_ = end + 1;
        return words;
    }

    void readFormat(const std::vector<std::string>& words) {
        constexpr std::array<std::string_view, 3> kNames{"ascii", "binary_little_endian",
                                                         "binary_big_endian"};
        const auto name = std::ranges::find(kNames, words.size() > 1 ? words[1] : "");
        if (name == kNames.end() || words.size() < 3 || words[2] != "1.0") {
            refuse("format", words.size() > 1 ? words[1] : "missing", kFormats);
        }
        head_.format = static_cast<PlyFormat>(name - kNames.begin());
    }

    void readElement(const std::vector<std::string>& words) {
        PlyElement element;
        const std::string count = words.size() == 3 ? words[2] : "missing";
        if (!parseWhole(count, element.count)) {
            refuse("element " + (words.size() > 1 ? words[1] : ""), count, "a name and a number");
        }
        if (head_.elements.size() >= kPlyElements) {
            refuse("element", words[1], "at most 64 elements");
        }
        element.name = words[1];
        head_.elements.push_back(std::move(element));
    }

    PlyType type(const std::string& name) const {
        const auto found = std::ranges::find_if(
            kPlyTypes, [&](const PlyTypeName& t) { return t.name == name || t.other == name; });
        if (found == kPlyTypes.end()) {
            refuse("property", name, "char, uchar, short, ushort, int, uint, float, double");
        }
        return found->type;
    }

    void readProperty(const std::vector<std::string>& words) {
        const bool list = words.size() == 5 && words[1] == "list";
        if (head_.elements.empty() || (words.size() != 3 && !list)) {
            refuse("property", words.size() > 1 ? words[1] : "missing",
                   "a type and a name, or list, two types and a name, behind an element");
        }
        std::vector<PlyProperty>& all = head_.elements.back().properties;
        if (all.size() >= kPlyProperties) {
            refuse("property", words.back(), "at most 256 of an element");
        }
        all.push_back({words.back(), type(words[words.size() - 2]), list, PlyType::Uint8});
        if (list) {
            all.back().countType = type(words[2]);
            if (plyReal(all.back().countType)) {
                refuse("property " + words.back(), words[2], "a list with a whole number of values");
            }
        }
    }

    // "obj_info num_cols 640", "comment width: 640", "comment height=480".
    void readSize(const std::vector<std::string>& words) {
        std::string name = words.size() > 1 ? lowerCase(words[1]) : "",
                    value = words.size() > 2 ? words.back() : "";
        if (const size_t mark = name.find_first_of("=:"); mark != std::string::npos) {
            value = mark + 1 < name.size() ? name.substr(mark + 1) : value;
            name.erase(mark);
        }
        const bool columns = name == "num_cols" || name == "width" || name == "cols" || name == "columns";
        const bool rows = name == "num_rows" || name == "height" || name == "rows";
        uint32_t number = 0;
        if ((columns || rows) && parseWhole(value, number)) {
            (columns ? head_.width : head_.height) = number;
        }
    }

    const std::string& file_;
    std::string_view text_;
    size_t at_ = 0;
    PlyHeader head_;
};

} // namespace

size_t plyBytes(PlyType type) {
    return kPlyTypes[static_cast<size_t>(type)].bytes;
}

bool plyReal(PlyType type) {
    return type == PlyType::Float32 || type == PlyType::Float64;
}

size_t PlyElement::find(const std::string& property) const {
    const auto found = std::ranges::find(properties, property, &PlyProperty::name);
    return static_cast<size_t>(found - properties.begin());
}

PlyHeader plyHeader(const std::string& file, std::string_view text) {
    return PlyHeadReader(file, text).read();
}

} // namespace fathom
