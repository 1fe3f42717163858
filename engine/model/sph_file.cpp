// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sph_file.h"

#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/output_file.h"
#include "engine/types/parse_number.h"
#include "engine/types/read_file.h"
#include "engine/types/split_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>

namespace fathom {

namespace {

constexpr size_t kShownCharacters = 60;
constexpr uint64_t kMaxBytes = 256u << 20;
constexpr uint64_t kShortestLine = 8; // "0 0 0 0" and its end: bounds the number of nodes in a file
constexpr size_t kLongestLine = 4096; // free text may be longer, a node line never is

// The lines of the file that are not blank, with their numbers.
class Lines {
public:
    explicit Lines(const std::filesystem::path& file)
        : name_(file.string())
        , in_(isRegularFile(file) ? std::ifstream(file, std::ios::binary) : std::ifstream()) {
        std::error_code failed;
        size_ = std::filesystem::file_size(file, failed);
        if (!in_.is_open() || failed) {
            throw BadInput(name_, "file", whyUnreadable(file), "a readable sphere tree (.sph)");
        }
        noteInput(file);
        if (size_ > kMaxBytes) {
            throw BadInput(name_, "file", std::to_string(size_) + " bytes",
                           "at most " + std::to_string(kMaxBytes));
        }
    }

    uint64_t bytes() const { return size_; }

    // Words of the next line that is not blank; throws at the end of the file.
    std::vector<std::string_view> next(const std::string& wanted) {
        while (std::getline(in_, line_)) {
            if (++number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) { // some editors begin UTF-8 with it
                line_.erase(0, 3);
            }
            if (line_.size() > kLongestLine) {
                refuse("a line of " + std::to_string(line_.size()) + " characters", wanted);
            }
            std::vector<std::string_view> words = splitWords(line_);
            if (!words.empty()) {
                return words;
            }
        }
        ++number_;
        refuse("end of file", wanted);
    }

    [[noreturn]] void refuse(const std::string& value, const std::string& allowed) const {
        throw BadInput(name_, "line " + std::to_string(number_), value, allowed);
    }
    [[noreturn]] void refuseLine(const std::string& allowed) const {
        refuse("'" + line_.substr(0, kShownCharacters) + "'", allowed);
    }

private:
    std::string name_;
    std::ifstream in_;
    uint64_t size_ = 0;
    std::string line_;
    uint64_t number_ = 0;
};

// Slots of a complete tree; more than `most` comes back as most + 1, so that nothing overflows.
uint64_t slotCount(uint32_t levels, uint32_t degree, uint64_t most) {
    uint64_t count = 0, width = 1;
    for (uint32_t l = 0; l < levels && count <= most; ++l) {
        count += width;
        width = std::min(width * degree, most + 1);
    }
    return std::min(count, most + 1);
}

SphereTree readHeader(Lines& lines) {
    const std::string wanted = "the number of levels and of children per node, both at least 1";
    const std::vector<std::string_view> words = lines.next(wanted);
    SphereTree tree;
    if (words.size() != 2 || !parseWhole(words[0], tree.levels) || !parseWhole(words[1], tree.degree) ||
        tree.levels == 0 || tree.degree == 0) {
        lines.refuseLine(wanted);
    }
    const uint64_t most = std::min<uint64_t>(kMaxSphNodes, lines.bytes() / kShortestLine + 1);
    const uint64_t count = slotCount(tree.levels, tree.degree, most);
    if (count > most) {
        lines.refuseLine("levels and degree of at most " + std::to_string(most) +
                         " nodes, as many as in the file");
    }
    tree.nodes.resize(count);
    return tree;
}

Sphere readNode(Lines& lines, double scale) {
    const std::string wanted = "x y z r [occupancy] [ax ay az ar errDec], finite where r >= 0";
    const std::vector<std::string_view> words = lines.next(wanted);
    const size_t columns = words.size();
    double v[4];
    bool good = columns == 4 || columns == 5 || columns == 9 || columns == 10;
    for (size_t i = 0; good && i < 4; ++i) {
        good = parseWhole(words[i], v[i]);
    }
    if (good && v[3] < 0.0) {
        return {}; // unused: its numbers may be anything
    }
    const Sphere node{dvec3(v[0], v[1], v[2]) * scale, v[3] * scale};
    // Squares must stay finite, because distances between spheres follow.
    if (!good || !isFinite(node.centre) || !(glm::dot(node.centre, node.centre) < 1e100) ||
        !(node.radius < 1e50)) {
        lines.refuseLine(wanted);
    }
    return node;
}

// Slots under an unused slot may hold garbage; a used node without children must reach the last level.
void settleChildren(SphereTree& tree) {
    for (uint64_t n = 0; n < tree.firstLeaf(); ++n) {
        const auto first = tree.nodes.begin() + static_cast<long>(n * tree.degree + 1);
        const auto last = first + tree.degree;
        if (tree.nodes[n].radius < 0.0) {
            std::fill(first, last, Sphere{});
        } else if (std::all_of(first, last, [](const Sphere& s) { return s.radius < 0.0; })) {
            *first = tree.nodes[n];
        }
    }
}

// The toolkit's radii bound the surface, not the children, and its flat files hold a meaningless radius.
void recomputeRadii(SphereTree& tree) {
    for (uint64_t n = tree.firstLeaf(); n-- > 0;) {
        Sphere& parent = tree.nodes[n];
        if (parent.radius < 0.0) {
            continue;
        }
        parent.radius = 0.0;
        for (uint32_t k = 0; k < tree.degree; ++k) {
            const Sphere& child = tree.nodes[n * tree.degree + 1 + k];
            if (child.radius >= 0.0) {
                const double reach = glm::distance(parent.centre, child.centre) + child.radius;
                parent.radius = std::max(parent.radius, reach);
            }
        }
        parent.radius *= 1.0 + 1e-12; // rounded outward, so that grandchildren are inside too
    }
}

} // namespace

SphereTree readSph(const std::filesystem::path& file, double metresPerUnit) {
    if (!(metresPerUnit > 0.0) || !std::isfinite(metresPerUnit)) {
        throw Error("the unit of a .sph file must be a positive length");
    }
    Lines lines(file);
    SphereTree tree = readHeader(lines);
    for (Sphere& node : tree.nodes) {
        node = readNode(lines, metresPerUnit);
    }
    if (tree.nodes[0].radius < 0.0) {
        throw BadInput(file.string(), "root node", "unused", "a tree with at least one sphere");
    }
    settleChildren(tree);
    recomputeRadii(tree);
    return tree;
}

void writeSph(const SphereTree& tree, const std::filesystem::path& file) {
    if (const std::string fault = validate(tree); !fault.empty()) {
        throw Error(file.string() + ": not written: " + fault);
    }
    std::string text = std::to_string(tree.levels) + " " + std::to_string(tree.degree) + "\n";
    for (const Sphere& s : tree.nodes) {
        char line[160];
        const bool used = s.radius >= 0.0;
        std::snprintf(line, sizeof line, "%.17g %.17g %.17g %.17g %d\n", s.centre.x, s.centre.y, s.centre.z,
                      used ? s.radius : -1.0, used ? 1 : 0);
        text += line;
    }
    OutputFile out(file);
    out.write(text);
    out.commit();
}

} // namespace fathom
