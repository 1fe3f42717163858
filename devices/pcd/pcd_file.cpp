// SPDX-License-Identifier: Apache-2.0
#include "devices/pcd/pcd_file.h"

#include "devices/pcd/ascii_value.h"
#include "devices/pcd/colour_fields.h"
#include "devices/pcd/pcd_field.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/parse_number.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <sstream>
#include <string>

namespace fathom {

namespace {

constexpr uint32_t kMaxWidth = 3840, kMaxHeight = 2160;
constexpr size_t kMaxBytes = size_t{1} << 30;
constexpr size_t kMaxBytesOfPoint = 4096;
constexpr size_t kMaxLzfRatio = 88; // a match of three bytes unpacks to at most 264

struct Header {
    std::vector<PcdField> fields;
    uint32_t width = 0, height = 0;
    std::string data;
    size_t bytes = 0;   // a point
    bool posed = false; // by VIEWPOINT
};

struct Source {
    std::string file;
    std::vector<uint8_t> bytes;
    size_t at = 0;

    [[noreturn]] void refuse(const std::string& field, const std::string& value,
                             const std::string& allowed) const {
        throw BadInput(file, field, value, allowed);
    }
    std::string line() {
        const auto begin = bytes.begin() + static_cast<long>(at);
        const auto end = std::find(begin, bytes.end(), '\n');
        if (end == bytes.end()) {
            refuse("header", "cut off", "a PCD header that ends in DATA");
        }
        at = static_cast<size_t>(end - bytes.begin()) + 1;
        std::string text(begin, end);
        while (!text.empty() && text.back() == '\r') {
            text.pop_back();
        }
        return text;
    }
};

std::vector<std::string> wordsOf(const std::string& line) {
    std::istringstream in(line);
    return {std::istream_iterator<std::string>(in), {}};
}

size_t wholeNumber(const Source& source, const std::string& field, const std::string& word, size_t most) {
    size_t value = 0;
    if (!parseWhole(word, value) || value < 1 || value > most) {
        source.refuse(field, word, "1 to " + std::to_string(most));
    }
    return value;
}

void checkCount(const Source& source, const std::vector<std::string>& words, const Header& header) {
    if (words.size() != header.fields.size() + 1 || header.fields.empty()) {
        source.refuse(words.front(), std::to_string(words.size() - 1) + " values",
                      "as many as FIELDS: " + std::to_string(header.fields.size()));
    }
}

// x y z qw qx qy qz other than the identity, which some writers state as zeros, or with qw last; other words
// are none.
bool isPose(const std::vector<std::string>& viewpoint) {
    constexpr double kRounding = 1e-6;
    std::array<double, 7> pose{};
    bool known = viewpoint.size() == pose.size() + 1;
    for (size_t i = 0; known && i < pose.size(); ++i) {
        known = parseNumber(viewpoint[i + 1], pose[i]);
    }
    double apart = 0.0;
    for (const size_t i : {0, 1, 2, 4, 5}) {
        apart += std::abs(pose[i]);
    }
    return known && !(apart + std::abs(pose[3] * pose[6]) <= kRounding);
}

void readHeaderLine(const Source& source, const std::vector<std::string>& words, Header& header) {
    const std::string& key = words.front();
    if (key == "FIELDS" || key == "COLUMNS") {
        for (size_t i = 1; i < words.size(); ++i) {
            header.fields.push_back({.name = words[i]});
        }
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
        checkCount(source, words, header);
        for (size_t i = 0; i < header.fields.size(); ++i) {
            PcdField& field = header.fields[i];
            if (key == "TYPE") {
                field.type = words[i + 1][0];
            } else {
                (key == "SIZE" ? field.size : field.count) =
                    wholeNumber(source, key, words[i + 1], key == "SIZE" ? 8 : 1024);
            }
        }
    } else if (words.size() > 1 && key == "WIDTH") {
        header.width = static_cast<uint32_t>(wholeNumber(source, key, words[1], SIZE_MAX >> 33));
    } else if (words.size() > 1 && key == "HEIGHT") {
        header.height = static_cast<uint32_t>(wholeNumber(source, key, words[1], kMaxHeight));
    } else if (key == "VIEWPOINT") {
        header.posed = isPose(words);
    } else if (words.size() > 1 && key == "DATA") {
        header.data = words[1];
    }
}

Header readHeader(Source& source) {
    Header header;
    while (header.data.empty()) {
        const std::vector<std::string> words = wordsOf(source.line());
        if (!words.empty() && words.front()[0] != '#') {
            readHeaderLine(source, words, header);
        }
    }
    if (header.height < 2) {
        source.refuse("HEIGHT", std::to_string(header.height), "2 or more: an organised cloud, row by row");
    }
    if (header.width < 2 || header.width > kMaxWidth) {
        source.refuse("WIDTH", std::to_string(header.width), "2 to " + std::to_string(kMaxWidth));
    }
    for (PcdField& field : header.fields) {
        field.offset = header.bytes;
        header.bytes += field.size * field.count;
    }
    if (header.bytes > kMaxBytesOfPoint) {
        source.refuse("SIZE", std::to_string(header.bytes) + " bytes a point",
                      "at most " + std::to_string(kMaxBytesOfPoint));
    }
    return header;
}

// Checked before memory is allocated for what the header states. Each value takes a character and, unless it
// is the last one, a separator.
void checkAsciiSize(const Source& source, const Header& header) {
    size_t values = 0;
    for (const PcdField& field : header.fields) {
        values += field.count * header.width * header.height;
    }
    const size_t bytes = source.bytes.size() - source.at, least = 2 * values - 1;
    if (bytes < least) {
        source.refuse("DATA", std::to_string(bytes) + " bytes",
                      "at least " + std::to_string(least) + ": WIDTH x HEIGHT points");
    }
}

// Converts ASCII values to the bytes of a binary file.
std::vector<uint8_t> readAscii(Source& source, const Header& header) {
    checkAsciiSize(source, header);
    const std::string text(source.bytes.begin() + static_cast<long>(source.at), source.bytes.end());
    std::istringstream in(text);
    std::vector<uint8_t> out(header.bytes * header.width * header.height, 0);
    for (size_t point = 0; point < size_t{header.width} * header.height; ++point) {
        for (const PcdField& field : header.fields) {
            for (size_t i = 0; i < field.count; ++i) {
                std::string word;
                if (!(in >> word)) {
                    source.refuse("DATA", "ends at point " + std::to_string(point), "WIDTH x HEIGHT points");
                }
                uint8_t* to = out.data() + point * header.bytes + field.offset + i * field.size;
                if (!putAsciiValue(word, field.type, field.size, to)) {
                    source.refuse("DATA", "'" + word.substr(0, 40) + "' at point " + std::to_string(point),
                                  "numbers of TYPE " + std::string(1, field.type) + " for " + field.name);
                }
            }
        }
    }
    return out;
}

// Compressed: all of the first field, then all of the second...
std::vector<uint8_t> readCompressed(const Source& source, const Header& header) {
    const size_t points = size_t{header.width} * header.height, wanted = points * header.bytes;
    uint32_t packed = 0, unpacked = 0;
    if (source.bytes.size() - source.at < 8) {
        source.refuse("DATA", "cut off", "sizes and compressed points");
    }
    std::memcpy(&packed, source.bytes.data() + source.at, 4);
    std::memcpy(&unpacked, source.bytes.data() + source.at + 4, 4);
    const bool possible = unpacked == wanted && packed <= source.bytes.size() - source.at - 8 &&
                          wanted <= packed * kMaxLzfRatio;
    std::vector<uint8_t> columns(possible ? wanted : 0); // no memory for what only a header states
    if (!possible || !unpackLzf({source.bytes.data() + source.at + 8, packed}, columns)) {
        source.refuse("DATA", std::to_string(unpacked) + " bytes unpacked",
                      std::to_string(wanted) + ", undamaged");
    }
    std::vector<uint8_t> out(wanted);
    for (const PcdField& field : header.fields) {
        const size_t size = field.size * field.count;
        const uint8_t* column = columns.data() + field.offset * points;
        for (size_t i = 0; i < points; ++i) {
            std::memcpy(out.data() + i * header.bytes + field.offset, column + i * size, size);
        }
    }
    return out;
}

std::vector<uint8_t> readPoints(Source& source, const Header& header) {
    if (header.data == "ascii") {
        return readAscii(source, header);
    }
    if (header.data == "binary_compressed") {
        return readCompressed(source, header);
    }
    if (header.data != "binary") {
        source.refuse("DATA", header.data, "ascii, binary, binary_compressed");
    }
    const size_t wanted = header.bytes * header.width * header.height;
    if (source.bytes.size() - source.at < wanted) {
        source.refuse("DATA", std::to_string(source.bytes.size() - source.at) + " bytes",
                      std::to_string(wanted));
    }
    const auto begin = source.bytes.begin() + static_cast<long>(source.at);
    return {begin, begin + static_cast<long>(wanted)};
}

} // namespace

PcdCloud readPcd(const std::filesystem::path& file) {
    const std::string text = readWholeFile(file, kMaxBytes, "an organised PCD file");
    Source source{file.string(), {text.begin(), text.end()}, 0};
    const Header header = readHeader(source);
    const PcdField *x = fieldNamed(header.fields, "x"), *y = fieldNamed(header.fields, "y"),
                   *z = fieldNamed(header.fields, "z");
    const PcdField* intensity = fieldNamed(header.fields, "intensity");
    for (const PcdField* field : {x, y, z}) {
        if (field == nullptr || field->type != 'F' || !field->isNumber()) {
            source.refuse("FIELDS", field == nullptr ? "no x, y, z" : field->name,
                          "x, y and z of type F and size 4 or 8");
        }
    }
    const std::vector<uint8_t> bytes = readPoints(source, header);
    PcdCloud cloud{header.width, header.height, {}, {}, {}, {}, header.posed ? "VIEWPOINT" : ""};
    for (size_t i = 0; i < size_t{header.width} * header.height; ++i) {
        const uint8_t* point = bytes.data() + i * header.bytes;
        cloud.points.push_back({x->at(point), y->at(point), z->at(point)});
        if (intensity != nullptr && intensity->isNumber()) {
            cloud.intensity.push_back(static_cast<float>(intensity->at(point)));
        }
    }
    const size_t row = header.bytes * header.width;
    double largest = 0.0;
    cloud.colour = ColourFields(header.fields)
                       .read({bytes.data(), header.width, header.height, header.bytes, row}, largest);
    cloud.uncoloured = cloud.colour.empty() ? whyUncoloured(header.fields) : "";
    return cloud;
}

} // namespace fathom
