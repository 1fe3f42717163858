// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/stamped_files.h"

#include "devices/recorded/text_file.h"
#include "engine/types/inside.h"
#include "engine/types/log.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fathom {

namespace {

// Of a line of "t path"; empty = it is one.
std::string lineFault(const std::filesystem::path& folder, const std::string& line,
                      const std::vector<std::string_view>& words, double& stamp) {
    if (words.size() == 2 && parseStamp(words[0], stamp)) {
        return staysInside(pathOf(folder, words[1])) ? "" : "points outside the recording's folder";
    }
    const std::string columns = columnFault(line);
    const bool comma = words.size() == 2 && words[0].find(',') != std::string_view::npos;
    return !columns.empty() ? columns : (comma ? stampFault(line, words[0]) : "is not 't path'");
}

// Lines that are skipped for one cause.
struct SkippedLines {
    TextLine first;
    size_t count = 0;
};

} // namespace

bool parseStamp(std::string_view word, double& stamp) {
    return parseNumber(word, stamp) && std::isfinite(stamp);
}

// Tables of other programs: a decimal comma leaves a space in one of the parts.
std::string columnFault(std::string_view line) {
    if (line.find('"') != std::string_view::npos) {
        return "has quotation marks; columns stand between spaces, without them";
    }
    for (const char between : {',', ';'}) {
        const std::vector<std::string_view> parts = splitFields(line, between);
        const auto isWord = [](std::string_view part) { return splitWords(part).size() == 1; };
        const auto isNumber = [](std::string_view part) {
            double value = 0.0;
            return parseNumber(part, value);
        };
        if (parts.size() > 1 && std::ranges::all_of(parts, isWord) && std::ranges::any_of(parts, isNumber) &&
            !std::ranges::all_of(parts, isNumber)) {
            return std::string("has columns between '") + between + "'; they stand between spaces";
        }
    }
    return "";
}

// Decimal commas are a common cause.
std::string stampFault(std::string_view line, std::string_view word) {
    const std::string columns = columnFault(line);
    if (!columns.empty()) {
        return columns;
    }
    return word.find(',') == std::string_view::npos ? "has a stamp that is not a finite number"
                                                    : "has a stamp with a comma; numbers have decimal points";
}

std::filesystem::path pathOf(const std::filesystem::path& folder, std::string_view word) {
    std::string name(word);
    std::error_code failed;
    if (name.find('\\') != std::string::npos && !std::filesystem::exists(folder / name, failed)) {
        std::ranges::replace(name, '\\', '/');
    }
    return name;
}

std::vector<StampedFile> readStampedFiles(const std::filesystem::path& folder, const char* name) {
    constexpr size_t kShown = 80; // characters
    std::vector<StampedFile> files;
    std::map<std::string, SkippedLines> skipped;
    for (TextLine& line : readDataLines(folder / name)) {
        const std::vector<std::string_view> words = splitWords(line.text);
        double stamp = 0.0;
        const std::string fault = lineFault(folder, line.text, words, stamp);
        if (fault.empty()) {
            files.push_back({stamp, folder / pathOf(folder, words[1])});
        } else if (SkippedLines& lines = skipped[fault]; lines.count++ == 0) {
            lines.first = std::move(line);
        }
    }
    for (const auto& [fault, lines] : skipped) {
        const std::string others =
            lines.count > 1 ? ", as are " + std::to_string(lines.count - 1) + " others" : "";
        log::warn("{}: line {} {}: skipped{}; it is {}", (folder / name).string(), lines.first.number, fault,
                  others, lines.first.text.substr(0, kShown));
    }
    return files;
}

} // namespace fathom
