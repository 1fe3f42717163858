// SPDX-License-Identifier: Apache-2.0
// Writes the fixtures back into the scene file: replaces their block and keeps every other line.
#include "apps/operate/fixture_editor.h"
#include "apps/session/session.h"
#include "engine/types/error.h"

#include <fstream>
#include <iomanip>
#include <sstream>

namespace fathom::operate {

namespace {

void put(std::ostream& out, const char* key, const std::optional<Band>& band) {
    if (band) {
        out << ", " << key << ": [" << band->lo << ", " << band->hi << "]";
    }
}

void putVec(std::ostream& out, const dvec3& v) {
    out << "[" << v.x << ", " << v.y << ", " << v.z << "]";
}

void putQuat(std::ostream& out, const dquat& q) {
    out << "[" << q.x << ", " << q.y << ", " << q.z << ", " << q.w << "]";
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
    out << ", radius: " << f.radius;
    if (f.standoff != plain.standoff) {
        out << ", standoff: " << f.standoff;
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
        out << ", trim: " << f.trim;
    }
}

// As a YAML scalar in double quotes.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        if (c == '\n') {
            out += "\\n";
        } else {
            out += c;
        }
    }
    return out + "\"";
}

void putRow(std::ostream& out, const FixtureClass& f) {
    constexpr const char* kShapes[] = {"", "sphere", "box", "plane", "cylinder", "line", "axis"};
    out << "  - { name: " << quoted(f.name) << ", role: "
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

// Replaces the block of a top-level key, or appends it.
std::string withBlock(const std::string& old, const std::string& key, const std::string& block) {
    std::istringstream in(old);
    std::string result, line;
    bool inside = false, done = false;
    while (std::getline(in, line)) {
        const bool topLevel = !line.empty() && line[0] != ' ' && line[0] != '#' && line[0] != '-';
        if (line.rfind(key, 0) == 0) {
            inside = done = true;
            result += block;
            continue;
        }
        inside = inside && !topLevel;
        result += inside ? "" : line + "\n";
    }
    return done ? result : result + block;
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
    std::ifstream in(scene_.file);
    std::stringstream old;
    old << in.rdbuf();
    std::ostringstream block;
    block << std::setprecision(10) << "fixtures:\n";
    size_t rows = 0, row = 0;
    for (FixtureClass f : scene_.fixtures) {
        if (!isSpare(f) || spares) {
            f.name = isSpare(f) ? spareName(row) : f.name;
            putRow(block, f);
            ++rows;
        }
        ++row;
    }
    std::string text = withBlock(old.str(), "fixtures:", rows == 0 ? "fixtures: []\n" : block.str());
    if (!scene_.pilot.empty()) {
        text = withBlock(text, "pilot:", "pilot: " + quoted(scene_.pilot) + "\n");
    }
    return scene_.window ? withBlock(text, "window:", windowBlock(*scene_.window)) : text;
}

RecordedScene recordedScene(const FixtureEditor& editor) {
    RecordedScene recorded{editor.text(true), {}};
    const std::vector<FixtureClass>& rows = editor.scene().fixtures;
    for (uint32_t row = 0; row < rows.size(); ++row) {
        if (rows[row].isPoints() && rows[row].frozen) {
            recorded.held.push_back(row);
        }
    }
    return recorded;
}

std::string FixtureEditor::rows() const {
    std::ostringstream block;
    block << std::setprecision(10);
    for (const FixtureClass& f : scene_.fixtures) {
        if (!isSpare(f)) {
            putRow(block, f);
        }
    }
    return block.str();
}

std::string FixtureEditor::save() {
    const std::filesystem::path fresh = scene_.file.string() + ".new";
    std::ofstream(fresh) << text();
    try {
        const Scene read = loadScene(fresh); // replaces the old file only when the new one loads
        std::filesystem::rename(fresh, scene_.file);
        saved_ = rows();
        return std::to_string(read.fixtures.size()) + " fixtures saved to " + scene_.file.string();
    } catch (const std::exception& e) {
        std::error_code ignored;
        std::filesystem::remove(fresh, ignored);
        return std::string("not saved: ") + e.what();
    }
}

} // namespace fathom::operate
