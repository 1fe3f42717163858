// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/text_file.h"

#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/parse_number.h"
#include "engine/types/read_file.h"
#include "engine/types/stand_in.h"

namespace fathom {

namespace {

constexpr std::string_view kSpace = " \t\r";
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF"; // some editors begin UTF-8 with it
constexpr uint64_t kMaxBytes = 64u << 20;
constexpr size_t kMaxLines = 1'000'000; // nine hours of frames; bounds the memory of short lines
constexpr size_t kMaxText = 16u << 20;  // the stamps of three hours of frames; each byte needs up to forty

std::string_view trim(std::string_view text) {
    const size_t begin = text.find_first_not_of(kSpace);
    return begin == std::string_view::npos ? std::string_view{}
                                           : text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

} // namespace

std::string readTextFile(const std::filesystem::path& file) {
    return readWholeFile(file, kMaxText, "a readable text file");
}

DataLines::DataLines(const std::filesystem::path& file)
    : name_(file.string())
    , in_(isRegularFile(file) ? std::ifstream(file) : std::ifstream()) {
    if (!in_.is_open()) {
        throw BadInput(name_, "file", whyUnreadable(file), "a readable text file");
    }
    refuseStandIn(file, "a readable text file");
    noteInput(file);
}

bool DataLines::next(TextLine& line) {
    for (;;) {
        in_.getline(buffer_.data(), buffer_.size());
        ++number_;
        if (in_.fail() && !in_.eof()) {
            throw BadInput(name_, "line " + std::to_string(number_),
                           "'" + std::string(buffer_.data()).substr(0, 80) + "'",
                           std::to_string(kLongest) + " characters at most");
        }
        if (in_.fail()) {
            return false;
        }
        const auto taken = static_cast<size_t>(in_.gcount()); // including the line end, if any
        std::string_view text = {buffer_.data(), taken - (in_.eof() ? 0 : 1)};
        if (number_ == 1) {
            refuseUtf16(name_, text, "a readable text file");
        }
        text.remove_prefix(number_ == 1 && text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0);
        text = trim(text);
        if (!text.empty() && text[0] != '#') {
            line.number = number_;
            line.text = text;
            return true;
        }
    }
}

std::vector<TextLine> readDataLines(const std::filesystem::path& file) {
    DataLines from(file);
    std::vector<TextLine> lines;
    size_t bytes = 0;
    for (TextLine line; from.next(line); lines.push_back(line)) {
        bytes += line.text.size() + 1;
        if (bytes > kMaxBytes || lines.size() == kMaxLines) {
            throw BadInput(file.string(), "line " + std::to_string(line.number),
                           bytes > kMaxBytes ? "over 64 MiB so far" : "over 1000000 lines so far",
                           "at most 1000000 lines of 64 MiB in all");
        }
    }
    return lines;
}

std::vector<std::string_view> splitFields(std::string_view line, char between) {
    std::vector<std::string_view> fields;
    for (size_t begin = 0;;) {
        const size_t end = line.find(between, begin);
        fields.push_back(trim(line.substr(begin, end == std::string_view::npos ? end : end - begin)));
        if (end == std::string_view::npos) {
            return fields;
        }
        begin = end + 1;
    }
}

bool parseNumber(std::string_view word, double& value) {
    word.remove_prefix(word.starts_with('+') ? 1 : 0);
    return parseWhole(word, value);
}

bool parseNumber(std::string_view word, uint32_t& value) {
    return parseWhole(word, value);
}

} // namespace fathom
