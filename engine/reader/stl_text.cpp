// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/stl_text.h"

#include "engine/types/read_file.h"

#include <cstring>
#include <fstream>
#include <iomanip>
#include <locale>
#include <string_view>

namespace fathom {

namespace {

constexpr uintmax_t kHeadBytes = 84, kFacetBytes = 50; // of a binary STL
constexpr size_t kLongestWord = 256;

// As Assimp tells them apart: a binary STL has the size that follows from its count.
bool isTextStl(const std::filesystem::path& file, std::istream& in) {
    char head[kHeadBytes] = {};
    in.read(head, sizeof head);
    const auto got = static_cast<size_t>(in.gcount());
    uint32_t count = 0;
    std::memcpy(&count, head + sizeof head - sizeof count, sizeof count);
    if (got == sizeof head && std::filesystem::file_size(file) == kHeadBytes + kFacetBytes * count) {
        return false;
    }
    const std::string_view text(head, got);
    const size_t first = text.find_first_not_of(" \t\r\n");
    in.clear();
    in.seekg(0);
    return first != std::string_view::npos && text.substr(first).starts_with("solid") &&
           text.find('\0') == std::string_view::npos;
}

void skipLine(std::istream& in) {
    for (int c = in.get(); c != '\n' && c != '\r' && in;) {
        c = in.get();
    }
}

} // namespace

std::string textStlFault(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    in.imbue(std::locale::classic());
    if (endingOf(file) != ".stl" || !isTextStl(file, in)) {
        return "";
    }
    size_t facets = 0, corners = 0;
    bool ended = false;
    for (std::string word; in >> std::setw(kLongestWord) >> word;) {
        if (word == "vertex") {
            ++corners;
            continue;
        }
        const bool named = word == "solid" || word == "endsolid";
        if (!named && word != "facet") {
            continue;
        }
        if (facets > 0 && corners != 3) {
            return "facet " + std::to_string(facets) + " has " + std::to_string(corners) +
                   " vertices instead of 3";
        }
        ended = word == "endsolid";
        if (named) {
            skipLine(in); // the name may be any words
        } else {
            ++facets;
            corners = 0;
        }
    }
    return ended ? "" : "cut off: no endsolid behind facet " + std::to_string(facets);
}

} // namespace fathom
