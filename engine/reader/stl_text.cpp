// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/stl_text.h"

#include "engine/types/lower_case.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iomanip>
#include <locale>
#include <sstream>

namespace fathom {

namespace {

constexpr uintmax_t kHeadBytes = 84, kFacetBytes = 50; // of a binary STL
constexpr size_t kLongestWord = 256, kLargestStl = 512u << 20;
constexpr const char* kNoFacets = "no facets";

// The size of a binary STL follows from its count. Up to one facet more is padding.
std::string binaryFault(const std::filesystem::path& file, const std::string& head, std::string& instead) {
    const uintmax_t size = std::filesystem::file_size(file);
    uint32_t count = 0;
    if (head.size() < kHeadBytes) {
        return "neither a text that begins with 'solid' nor a binary STL of at least 84 bytes";
    }
    std::memcpy(&count, head.data() + kHeadBytes - sizeof count, sizeof count);
    const uintmax_t wanted = kHeadBytes + kFacetBytes * count;
    if (size < wanted || size - wanted >= kFacetBytes) {
        return std::to_string(count) + " facets take " + std::to_string(wanted) + " bytes, the file has " +
               std::to_string(size);
    }
    if (count == 0) {
        return kNoFacets;
    }
    if (size > wanted) {
        instead = readFileAtMost(file, kLargestStl).value_or("").substr(0, wanted);
    }
    return "";
}

void skipLine(std::istream& in) {
    for (int c = in.get(); c != '\n' && c != '\r' && in;) {
        c = in.get();
    }
}

// The facets of all solids as one, of a text in small letters: Assimp rejects a file with an empty solid.
std::string oneSolid(std::string text) {
    std::ranges::replace(text, '\r', '\n');
    std::istringstream in(text);
    std::string out = "solid\n";
    for (std::string line; std::getline(in, line);) {
        const std::string start = line.substr(std::min(line.find_first_not_of(" \t"), line.size()), 8);
        if (!start.starts_with("solid") && !start.starts_with("endsolid")) {
            out += line.substr(0, line.find("endsolid")) + "\n";
        }
    }
    return out + "endsolid\n";
}

// Of a text in small letters that is one solid without a name.
std::string withoutNormals(const std::string& text) {
    std::string out;
    size_t at = 0;
    for (size_t normal = 0; (normal = text.find("normal", at)) != std::string::npos;) {
        const size_t end = text.find("outer", normal);
        if (end == std::string::npos) {
            break;
        }
        out.append(text, at, normal - at).append("normal 0 0 0\n");
        at = end;
    }
    return out.append(text, at);
}

// What Assimp does not read.
struct StlSpelling {
    bool capitals = false, gaps = false; // capital keywords, a solid without facets
    bool normals = false;                // "-nan(ind)" or "1.#IND" in a normal, which nothing uses
};

std::string textFault(std::istream& in, StlSpelling& spelling) {
    size_t facets = 0, corners = 0, before = 0; // before this solid
    bool ended = false;
    for (std::string written; in >> std::setw(kLongestWord) >> written;) {
        const std::string word = lowerCase(written);
        if (word == "vertex") {
            ++corners;
            continue;
        }
        const bool named = word == "solid" || word == "endsolid";
        if (!named && word != "facet") {
            spelling.normals = spelling.normals ||
                               (facets > 0 && corners == 0 && word.find_first_of("(#") != std::string::npos);
            continue;
        }
        if (facets > 0 && corners != 3) {
            return "facet " + std::to_string(facets) + " has " + std::to_string(corners) +
                   " vertices instead of 3";
        }
        spelling.capitals = spelling.capitals || word != written;
        ended = word == "endsolid";
        if (named) {
            spelling.gaps = spelling.gaps || (ended && facets == before);
            before = facets;
            skipLine(in); // the name may be any words
        } else {
            ++facets;
            corners = 0;
        }
    }
    return ended ? facets > 0 ? "" : kNoFacets
                 : "cut off: no endsolid behind facet " + std::to_string(facets);
}

} // namespace

std::string stlFault(const std::filesystem::path& file, std::string& instead) {
    if (endingOf(file) != ".stl") {
        return "";
    }
    std::ifstream in(file, std::ios::binary);
    in.imbue(std::locale::classic());
    std::string head(kHeadBytes, '\0');
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<size_t>(in.gcount()));
    in.clear();
    const size_t mark = head.starts_with("\xef\xbb\xbf") ? 3 : 0; // byte order mark of UTF-8
    const size_t first = std::min(head.find_first_not_of(" \t\r\n", mark), head.size());
    in.seekg(static_cast<std::streamoff>(first));
    if (!lowerCase(head.substr(first)).starts_with("solid") || head.find('\0') != std::string::npos) {
        return binaryFault(file, head, instead);
    }
    StlSpelling spelling;
    const std::string fault = textFault(in, spelling);
    if (fault.empty() && (spelling.gaps || spelling.capitals || spelling.normals || first > 0)) {
        instead = lowerCase(readFileAtMost(file, kLargestStl).value_or("").substr(first));
        instead = spelling.gaps || spelling.normals ? oneSolid(instead) : instead;
        instead = spelling.normals ? withoutNormals(instead) : instead;
    }
    return fault;
}

} // namespace fathom
