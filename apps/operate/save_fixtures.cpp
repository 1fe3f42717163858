// SPDX-License-Identifier: Apache-2.0
// Writes the fixtures back into the scene file: replaces the rows, with comments between them, and keeps
// every other line.
#include "apps/binding/scene_edits.h"
#include "apps/operate/fixture_editor.h"
#include "engine/types/number_text.h"
#include "engine/types/output_file.h"
#include "engine/types/read_file.h"

#include <charconv>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string_view>

namespace fathom::operate {

namespace {

constexpr size_t kMaxSceneBytes = size_t{64} << 20; // the reader of scenes has its own, smaller limit

// The shortest text that is read back as the same number.
std::string exactly(double value) {
    char digits[40];
    return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

void put(std::ostream& out, const char* key, const std::optional<Band>& band) {
    if (band) {
        out << ", " << key << ": [" << exactly(band->lo) << ", " << exactly(band->hi) << "]";
    }
}

void putVec(std::ostream& out, const dvec3& v) {
    out << "[" << exactly(v.x) << ", " << exactly(v.y) << ", " << exactly(v.z) << "]";
}

void putQuat(std::ostream& out, const dquat& q) {
    out << "[" << exactly(q.x) << ", " << exactly(q.y) << ", " << exactly(q.z) << ", " << exactly(q.w) << "]";
}

void putPoints(std::ostream& out, const FixtureClass& f) {
    const FixtureClass plain;
    put(out, "hue", f.hue);
    put(out, "saturation", f.saturation);
    put(out, "lightness", f.lightness);
    put(out, "range", f.range);
    if (f.box) {
        out << ", box: {min: ";
        putVec(out, f.box->min);
        out << ", max: ";
        putVec(out, f.box->max);
        out << "}";
    }
    out << ", radius: " << exactly(f.radius);
    if (f.standoff != plain.standoff) {
        out << ", standoff: " << exactly(f.standoff);
    }
    if (f.orientation != plain.orientation) {
        out << ", quat_xyzw: ";
        putQuat(out, f.orientation);
    }
    if (f.minCount != plain.minCount) {
        out << ", min_count: " << f.minCount;
    }
    if (f.largestPart) {
        out << ", largest_part: true";
    }
    if (f.trim != 0.0) {
        out << ", trim: " << exactly(f.trim);
    }
}

void putRow(std::ostream& out, const FixtureClass& f) {
    constexpr const char* kShapes[] = {"", "sphere", "box", "plane", "cylinder", "line", "axis"};
    out << "  - { name: " << doubleQuoted(f.name) << ", role: "
        << (f.role == Role::Guidance ? "guidance"
            : f.keepIn               ? "keep_in"
                                     : "forbidden");
    if (f.isPoints()) {
        putPoints(out, f);
    } else {
        out << ", shape: " << kShapes[static_cast<int>(f.shape)] << ", base_T_shape: {xyz: ";
        putVec(out, f.baseTshape.position);
        out << ", quat_xyzw: ";
        putQuat(out, f.baseTshape.rotation);
        out << "}, size: ";
        putVec(out, f.size);
    }
    out << " }\n";
}

// Whether a line is neither blank nor a comment.
bool hasContent(const std::string& line) {
    const size_t first = line.find_first_not_of(" \t\r");
    return first != std::string::npos && line[first] != '#';
}

// Replaces the block of a top-level key, or appends it. Blank lines and comments after the block are kept:
// they belong to what follows.
std::string withBlock(const std::string& old, const std::string& key, const std::string& block) {
    std::istringstream in(old);
    std::string result, after, line;
    bool inside = false, done = false;
    while (std::getline(in, line)) {
        const bool begins = line.starts_with(key), content = hasContent(line);
        inside =
            begins || (inside && (!content || std::string_view(" -]}").find(line[0]) != std::string::npos));
        done = done || begins;
        if (inside && !begins) {
            after = content ? "" : after + line + "\n"; // comments between rows belong to the old rows
            continue;
        }
        result += after + (begins ? block : line + "\n");
        after.clear();
    }
    return result + after + (done ? "" : block);
}

// Ends each line of the block as the lines of the file end.
std::string withLineEndsOf(const std::string& old, const std::string& block) {
    if (old.find("\r\n") == std::string::npos) {
        return block;
    }
    std::string out;
    for (const char c : block) {
        out += c == '\n' ? "\r\n" : std::string(1, c);
    }
    return out;
}

std::string windowBlock(const Scene::Window& window) {
    std::ostringstream out;
    out << std::setprecision(6) << "window: {text_scale: " << window.textScale
        << ", large: " << (window.spaceIsLarge ? "space" : "camera") << ", yaw: " << window.yaw
        << ", pitch: " << window.pitch << ", distance: " << window.distance
        << (window.pilotLayout ? ", layout: pilot" : "") << (window.tones ? "" : ", tones: false") << "}\n";
    return out.str();
}

} // namespace

std::string FixtureEditor::text(bool spares) const {
    std::ifstream in(scene_.file, std::ios::binary);
    std::stringstream old;
    old << in.rdbuf();
    return textFrom(old.str(), spares);
}

std::string FixtureEditor::textFrom(const std::string& old, bool spares) const {
    std::ostringstream block;
    block << "fixtures:\n";
    size_t rows = 0, row = 0;
    for (FixtureClass f : scene_.fixtures) {
        if (!isSpare(f) || spares) {
            f.name = isSpare(f) ? spareName(row) : f.name;
            putRow(block, f);
            ++rows;
        }
        ++row;
    }
    const auto replaced = [&old](const std::string& text, const char* key, const std::string& with) {
        return withBlock(text, key, withLineEndsOf(old, with));
    };
    std::string text = replaced(old, "fixtures:", rows == 0 ? "fixtures: []\n" : block.str());
    if (!scene_.pilot.empty()) {
        text = replaced(text, "pilot:", "pilot: " + doubleQuoted(scene_.pilot) + "\n");
    }
    return scene_.window ? replaced(text, "window:", windowBlock(*scene_.window)) : text;
}

RecordedScene recordedScene(const FixtureEditor& editor) {
    RecordedScene recorded{editor.text(true), {}};
    const std::vector<FixtureClass>& rows = editor.scene().fixtures;
    for (uint32_t row = 0; row < rows.size(); ++row) {
        if (rows[row].isPoints() && rows[row].frozen) {
            recorded.frozenRows.push_back(row);
        }
    }
    return recorded;
}

std::string FixtureEditor::rows() const {
    std::ostringstream block;
    for (const FixtureClass& f : scene_.fixtures) {
        if (!isSpare(f)) {
            putRow(block, f);
        }
    }
    return block.str();
}

std::string FixtureEditor::save() {
    try {
        const std::string text =
            textFrom(readWholeFile(scene_.file, kMaxSceneBytes, "a readable scene file"), false);
        const Scene read =
            loadSceneText(text, scene_.file.string()); // a text that does not load replaces nothing
        OutputFile file(std::filesystem::canonical(scene_.file), OutputFile::Replaces::Input);
        file.write(text);
        file.commit();
        saved_ = rows();
        return std::to_string(read.fixtures.size()) + " fixtures saved to " + scene_.file.string();
    } catch (const std::exception& e) {
        return std::string("not saved: ") + e.what();
    }
}

} // namespace fathom::operate
