// SPDX-License-Identifier: Apache-2.0
// A node of the scene file with its dotted path; every value is checked on access.
#pragma once

#include "engine/types/pose.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace fathom {

// Range of allowed numbers: lo <= x <= hi, or also 0. Every key has both bounds, within what the passes can
// compute in float32. NaN is outside of every range.
struct Range {
    double lo, hi;
    bool orZero = false;

    static Range between(double lo, double hi) { return {lo, hi}; }
    static Range zeroOr(double lo, double hi) { return {lo, hi, true}; }
    static Range position() { return {-1e6, 1e6}; } // [m] in the base frame
    static Range finite() {
        return {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
    }

    bool contains(double x) const { return (x >= lo && x <= hi) || (orZero && x == 0.0); }
    std::string words() const; // "a number from 0 to 360"
};

// Every member throws BadInput naming the file, the dotted path (fixtures[0].hue), the value and what is
// allowed.
class YamlNode {
public:
    // The one document of a file of at most 1 MiB. Syntax errors are reported with the line.
    static YamlNode parseFile(const std::filesystem::path& file);
    // Same for a text; messages call it `file`.
    static YamlNode parseText(const std::filesystem::path& file, const std::string& text);

    // Mappings. checkKeys() rejects a node that is not a mapping, an unknown key (and suggests the nearest
    // known one) and a duplicate key. Call it before find() or at().
    void checkKeys(std::initializer_list<std::string_view> known) const;
    std::optional<YamlNode> find(std::string_view key) const;
    YamlNode at(std::string_view key) const; // throws when the key is missing
    // Names and values of a mapping whose names the user chooses. Rejects a name given twice.
    std::vector<std::pair<std::string, YamlNode>> entries() const;

    // Lists of any length or of exactly n.
    std::vector<YamlNode> list() const;
    std::vector<YamlNode> list(size_t n) const;

    // Scalars. Quoted numbers and booleans are text and are rejected.
    bool is(std::string_view word) const; // true if the scalar equals `word`
    std::string text() const;             // not empty, printable (printable.h)
    bool boolean() const;                 // true or false
    double number(const Range& range,
                  const std::string& orElse = "") const; // orElse: "auto or ", for the message
    uint32_t integer(uint32_t lo, uint32_t hi) const;

    // Index of the scalar in `words`; rejects others and suggests the nearest.
    size_t oneOf(std::span<const std::string_view> words) const;
    template <class T>
    T choice(std::initializer_list<std::pair<std::string_view, T>> words) const;

    dvec3 vec3(const Range& range) const; // list of three numbers
    dquat quatXyzw() const;               // list of four, x y z w; not zero; normalised

    // Value of a key, by the function above that returns this type. Keeps `out` when the key is missing.
    void read(std::string_view key, double& out, const Range& range) const;
    void read(std::string_view key, std::optional<double>& out, const Range& range) const;
    void read(std::string_view key, uint32_t& out, uint32_t lo, uint32_t hi) const;
    void read(std::string_view key, bool& out) const;
    void read(std::string_view key, std::string& out) const;
    void read(std::string_view key, dvec3& out, const Range& range) const;
    void read(std::string_view key, dquat& out) const;
    template <class T>
    void read(std::string_view key, T& out,
              std::initializer_list<std::pair<std::string_view, std::type_identity_t<T>>> words) const;

    [[noreturn]] void refuse(const std::string& allowed) const; // throws for this node's value
    [[noreturn]] void refuse(const std::string& value, const std::string& allowed) const;

    const std::string& path() const { return path_; }
    std::string value() const; // as shown in messages

private:
    YamlNode(const YAML::Node& node, std::string file, std::string path);
    std::string childPath(std::string_view key) const;

    YAML::Node node_;
    std::string file_;
    std::string path_; // empty for the whole file
};

template <class T>
T YamlNode::choice(std::initializer_list<std::pair<std::string_view, T>> words) const {
    std::vector<std::string_view> names;
    for (const auto& entry : words) {
        names.push_back(entry.first);
    }
    return (words.begin() + oneOf(names))->second;
}

template <class T>
void YamlNode::read(std::string_view key, T& out,
                    std::initializer_list<std::pair<std::string_view, std::type_identity_t<T>>> words) const {
    if (const auto node = find(key)) {
        out = node->choice<T>(words);
    }
}

} // namespace fathom
