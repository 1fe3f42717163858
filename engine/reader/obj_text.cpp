// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/obj_text.h"

#include "engine/types/parse_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <vector>

namespace fathom {

namespace {

constexpr size_t kShownText = 60; // of a line that is rejected

std::vector<std::string_view> objWords(std::string_view line) {
    constexpr std::string_view kBlank = " \t\v\f";
    std::vector<std::string_view> words;
    for (size_t at = 0; (at = line.find_first_not_of(kBlank, at)) != std::string_view::npos;) {
        const size_t end = std::min(line.find_first_of(kBlank, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

// Begins with a digit or a minus, as Assimp counts numbers. False for anything but a finite number.
bool addNumber(std::string_view word, std::string& plain) {
    word.remove_prefix(word.starts_with('+') ? 1 : 0);
    double value = NAN;
    if (!parseWhole(word, value) || !std::isfinite(value)) {
        return false;
    }
    char text[40];
    plain.append(text, std::to_chars(text, text + sizeof text, value).ptr).push_back(' ');
    return true;
}

// Vertices read so far, and the farthest one that a face has named: it may follow in a later line.
struct ObjVertices {
    long long count = 0;
    long long named = 0;
    size_t namedInLine = 0;
};

// The vertex of a corner "vertex/texture/normal". Negative numbers count back from the last vertex.
bool addCorner(std::string_view word, size_t line, ObjVertices& vertices, std::string& plain) {
    word = word.substr(0, word.find('/'));
    long long vertex = 0;
    if (!parseWhole(word, vertex) || vertex == 0 || vertex < -vertices.count) {
        return false;
    }
    if (vertex > vertices.named) {
        vertices.named = vertex;
        vertices.namedInLine = line;
    }
    plain.append(word).push_back(' ');
    return true;
}

bool isVertex(std::string_view word) {
    return word == "v";
}

bool isFace(std::string_view word) {
    return word == "f" || word == "fo"; // fo: the face of older files
}

// A surface that is no polygon, also of older files. Curves have no area, and nothing is lost with them.
bool isFreeForm(std::string_view word) {
    return word == "surf" || word == "bsp" || word == "bzp" || word == "cdp";
}

// Numbers behind the first three are a weight or a colour. False for a line that is not understood.
bool addLine(const std::vector<std::string_view>& words, size_t line, ObjVertices& vertices,
             std::string& plain) {
    const bool vertex = isVertex(words[0]);
    vertices.count += vertex ? 1 : 0;
    const size_t wanted = vertex ? 4 : words.size();
    bool good = words.size() >= wanted && words.size() > 1;
    plain += vertex ? "v " : "f ";
    for (size_t i = 1; good && i < wanted; ++i) {
        good = vertex ? addNumber(words[i], plain) : addCorner(words[i], line, vertices, plain);
    }
    plain.back() = '\n';
    return good;
}

// Lines end with LF, CR LF or CR.
class ObjLines {
public:
    explicit ObjLines(const std::filesystem::path& file)
        : in_(file, std::ios::binary) {
        if (in_.peek() == 0xef) { // a byte order mark
            in_.ignore(3);
        }
    }

    // The next line that says something, without its comment. Only vertices and faces continue behind a
    // backslash: it may also end a comment or a name.
    bool next(std::string& line) {
        line.clear();
        while (one(line)) {
            const std::vector<std::string_view> words = objWords(line);
            const bool data =
                !words.empty() && (isVertex(words[0]) || isFace(words[0]) || isFreeForm(words[0]));
            if (data && line.back() == '\\') {
                line.back() = ' ';
                continue;
            }
            if (data) {
                return true;
            }
            line.clear();
        }
        return !line.empty();
    }

    size_t number() const { return number_; }

private:
    bool one(std::string& line) {
        bool comment = false;
        int c = in_.rdbuf()->sbumpc();
        if (c == EOF) {
            return false;
        }
        for (++number_; c != EOF && c != '\n' && c != '\r'; c = in_.rdbuf()->sbumpc()) {
            comment = comment || c == '#';
            if (!comment) {
                line.push_back(static_cast<char>(c));
            }
        }
        if (c == '\r' && in_.rdbuf()->sgetc() == '\n') {
            in_.rdbuf()->sbumpc();
        }
        line.erase(line.find_last_not_of(" \t") + 1);
        return true;
    }

    std::ifstream in_;
    size_t number_ = 0;
};

} // namespace

std::string plainObj(const std::filesystem::path& file, std::string& plain) {
    ObjLines lines(file);
    plain.clear();
    bool faces = false;
    ObjVertices vertices;
    for (std::string line; lines.next(line);) {
        const std::vector<std::string_view> words = objWords(line);
        const bool freeForm = isFreeForm(words[0]);
        if (freeForm || !addLine(words, lines.number(), vertices, plain)) {
            return "line " + std::to_string(lines.number()) + ": '" + line.substr(0, kShownText) +
                   (freeForm ? "', a free-form surface, not faces"
                             : "', not 'v x y z' or 'f' and numbers of vertices");
        }
        faces = faces || isFace(words[0]);
    }
    if (vertices.named > vertices.count) {
        return "line " + std::to_string(vertices.namedInLine) + ": vertex " + std::to_string(vertices.named) +
               " of " + std::to_string(vertices.count);
    }
    return plain.empty() ? "no vertices" : faces ? "" : "no faces";
}

} // namespace fathom
