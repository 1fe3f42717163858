// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/source_options.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <array>
#include <cmath>
#include <set>

namespace fathom {

namespace {

constexpr std::array<std::string_view, 9> kSourceKeys{
    "depth", "colour", "color", "info", "intrinsics", "extrinsics", "scale", "start", "duration"};

// Where ",key=" of a known key begins; npos = nowhere.
size_t nextKey(const std::string& text, size_t from) {
    for (size_t comma = text.find(',', from); comma != std::string::npos; comma = text.find(',', comma + 1)) {
        for (const std::string_view key : kSourceKeys) {
            if (text.compare(comma + 1, key.size(), key) == 0 && text[comma + 1 + key.size()] == '=') {
                return comma;
            }
        }
    }
    return std::string::npos;
}

double optionNumber(const std::string& key, const std::string& value, bool zero) {
    double number = 0.0;
    if (!parseNumber(std::string_view(value), number) || !std::isfinite(number) || number < 0.0 ||
        (number == 0.0 && !zero)) {
        throw BadInput("--source", key, value, zero ? "a number of at least 0" : "a number above 0");
    }
    return number;
}

void setOption(SourceOptions& options, const std::string& key, const std::string& value) {
    if (value.empty()) {
        throw BadInput("--source", key, "nothing", key + "=VALUE");
    }
    if (key == "depth") {
        options.depth = value;
    } else if (key == "colour" || key == "color") {
        options.colour = value;
    } else if (key == "info") {
        options.info = value;
    } else if (key == "intrinsics") {
        options.intrinsics = value;
    } else if (key == "extrinsics") {
        options.extrinsics = value;
    } else if (key == "scale") {
        options.scale = optionNumber(key, value, false);
    } else if (key == "start") {
        options.start = optionNumber(key, value, true);
    } else {
        options.duration = optionNumber(key, value, false);
    }
}

} // namespace

void SourceOptions::checkUnit(const std::string& file) const {
    if (scale && !(*scale >= kFinestUnit && *scale <= kCoarsestUnit)) {
        throw BadInput(file, "scale", significant(*scale, 6),
                       "metres per unit, 0.000001 to 0.1; 1000 units per metre are 0.001");
    }
}

void SourceOptions::checkMetres(const std::string& file) const {
    if (scale && !(*scale >= kFinestUnit && *scale <= kCoarsestValue)) {
        throw BadInput(file, "scale", significant(*scale, 6),
                       "metres per unit, 0.000001 to 100; 1000 units per metre are 0.001");
    }
}

void SourceOptions::checkNoTopics(const std::string& file) const {
    for (const auto& [key, topic] : {std::pair("depth", depth), std::pair("info", info),
                                     std::pair("colour", depthOnly() ? "" : colour)}) {
        if (!topic.empty()) {
            throw BadInput(
                file, key, topic,
                "only for files with topics; intrinsics=FILE gives a lens, colour=none plays depth");
        }
    }
}

SourceRequest parseSource(const std::string& text) {
    size_t comma = nextKey(text, 0);
    SourceRequest request{text.substr(0, comma), {}};
    std::set<std::string> seen;
    while (comma != std::string::npos) {
        const size_t next = nextKey(text, comma + 1);
        const std::string pair = text.substr(comma + 1, next == std::string::npos ? next : next - comma - 1);
        const size_t equals = pair.find('=');
        const std::string key = pair.substr(0, equals);
        if (!seen.insert(key).second) {
            throw BadInput("--source", key, "given twice", "each key once");
        }
        setOption(request.options, key, pair.substr(equals + 1));
        comma = next;
    }
    return request;
}

} // namespace fathom
