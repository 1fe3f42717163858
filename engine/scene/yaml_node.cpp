// SPDX-License-Identifier: Apache-2.0
#include "engine/scene/yaml_node.h"

#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/log.h"
#include "engine/types/parse_number.h"
#include "engine/types/read_file.h"
#include "engine/types/rotation_fault.h"
#include "engine/types/suggestion.h"
#include "engine/types/yaml_document.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fathom {

namespace {

constexpr size_t kMaxBytes = 1u << 20; // a scene has a few kB; the parser needs up to 250 bytes per byte
constexpr size_t kShownCharacters = 80;

bool isQuoted(const YAML::Node& node) {
    // yaml-cpp's tag of a scalar in quotes is "!", a plain one has "?".
    return node.Tag() == "!" || node.Tag() == "tag:yaml.org,2002:str";
}

// For messages about numbers: quotes make text of them.
std::string withQuotes(const YAML::Node& node, const std::string& value) {
    return isQuoted(node) && !node.Scalar().empty() ? "'" + value + "' in quotes" : value;
}

// line: from 0. The parser blames a value for a tab before it.
bool beginsWithTab(const std::string& text, int line) {
    size_t begin = 0;
    for (int i = 0; i < line && begin < text.size(); ++i) {
        begin = std::min(text.find('\n', begin), text.size()) + 1;
    }
    const size_t first = text.find_first_not_of(' ', begin);
    return first != std::string::npos && text[first] == '\t';
}

} // namespace

YamlNode::YamlNode(const YAML::Node& node, std::string file, std::string path)
    : node_(node)
    , file_(std::move(file))
    , path_(std::move(path)) {}

YamlNode YamlNode::parseFile(const std::filesystem::path& file) {
    return parseText(file, readWholeFile(file, kMaxBytes, "a readable scene file (YAML)"));
}

YamlNode YamlNode::parseText(const std::filesystem::path& file, const std::string& text) {
    if (text.size() > kMaxBytes) {
        throw BadInput(file.string(), "size", std::to_string(text.size()), "at most 1 MiB");
    }
    try {
        return YamlNode(onlyYamlDocument(file.string(), text), file.string(), "");
    } catch (const YAML::Exception& e) {
        const std::string where = e.mark.is_null() ? "syntax" : "line " + std::to_string(e.mark.line + 1);
        const bool tab = !e.mark.is_null() && beginsWithTab(text, e.mark.line);
        throw BadInput(file.string(), where, tab ? "a tab at the beginning" : excerpt(e.msg),
                       "YAML, indented with spaces");
    }
}

std::string YamlNode::childPath(std::string_view key) const {
    return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void YamlNode::checkKeys(std::initializer_list<std::string_view> known) const {
    const std::span<const std::string_view> words(known.begin(), known.size());
    if (!node_.IsMap()) {
        refuse("a mapping with keys " + joined(words));
    }
    std::set<std::string> seen;
    for (const auto& entry : node_) {
        if (!entry.first.IsScalar()) {
            const std::string line = "line " + std::to_string(entry.first.Mark().line + 1);
            throw BadInput(file_, path_.empty() ? line : path_ + ", " + line, "a key that is not a word",
                           joined(words));
        }
        const std::string key = entry.first.Scalar();
        if (key == "<<") {
            throw BadInput(file_, childPath(key), "a merge key", "keys written out: " + joined(words));
        }
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            throw BadInput(file_, childPath(excerpt(key)), "unknown key" + suggestion(key, words),
                           joined(words));
        }
        if (!seen.insert(key).second) {
            throw BadInput(file_, childPath(key), "given twice", "each key once");
        }
    }
}

std::optional<YamlNode> YamlNode::find(std::string_view key) const {
    for (const auto& entry : node_) {
        if (entry.first.IsScalar() && entry.first.Scalar() == key) {
            return YamlNode(entry.second, file_, childPath(key));
        }
    }
    return std::nullopt;
}

YamlNode YamlNode::at(std::string_view key) const {
    std::optional<YamlNode> child = find(key);
    if (!child) {
        throw BadInput(file_, childPath(key), "missing", "this key must be given");
    }
    return *std::move(child);
}

std::vector<std::pair<std::string, YamlNode>> YamlNode::entries() const {
    if (!node_.IsMap()) {
        refuse("a mapping {NAME: value}");
    }
    std::vector<std::pair<std::string, YamlNode>> all;
    std::set<std::string> seen;
    for (const auto& entry : node_) {
        const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
        if (key.empty() || !seen.insert(key).second) {
            throw BadInput(file_, childPath(excerpt(key)), key.empty() ? "no name" : "given twice",
                           "each name once");
        }
        all.emplace_back(key, YamlNode(entry.second, file_, childPath(key)));
    }
    return all;
}

std::vector<YamlNode> YamlNode::list() const {
    if (!node_.IsSequence()) {
        refuse("a list");
    }
    std::vector<YamlNode> items;
    for (const YAML::Node& item : node_) {
        items.push_back(YamlNode(item, file_, path_ + "[" + std::to_string(items.size()) + "]"));
    }
    return items;
}

std::vector<YamlNode> YamlNode::list(size_t n) const {
    if (!node_.IsSequence() || node_.size() != n) {
        refuse("a list of " + std::to_string(n) + " numbers");
    }
    return list();
}

bool YamlNode::is(std::string_view word) const {
    return node_.IsScalar() && node_.Scalar() == word;
}

std::string YamlNode::text() const {
    if (!node_.IsScalar() || node_.Scalar().empty()) {
        refuse("text");
    }
    if (printable(node_.Scalar()) != node_.Scalar()) {
        refuse("text in UTF-8 without line breaks and other control characters");
    }
    return node_.Scalar();
}

bool YamlNode::boolean() const { // in the spellings of YAML 1.2
    const bool yes = is("true") || is("True") || is("TRUE"), no = is("false") || is("False") || is("FALSE");
    if (isQuoted(node_) || !(yes || no)) {
        refuse(withQuotes(node_, value()), "true or false");
    }
    return yes;
}

double YamlNode::number(const Range& range, const std::string& orElse) const {
    double x = 0.0;
    bool good = node_.IsScalar() && !isQuoted(node_);
    if (good) {
        std::string_view digits = node_.Scalar();
        digits.remove_prefix(digits.starts_with('+') ? 1 : 0); // valid in YAML, rejected by parseWhole()
        good = parseWhole(digits, x) && std::isfinite(x);
    }
    if (!good || !range.contains(x)) {
        refuse(withQuotes(node_, value()), orElse + range.words());
    }
    return x;
}

uint32_t YamlNode::integer(uint32_t lo, uint32_t hi) const {
    uint32_t n = 0;
    const bool good = node_.IsScalar() && !isQuoted(node_) && parseWhole(node_.Scalar(), n);
    if (!good || n < lo || n > hi) {
        refuse(withQuotes(node_, value()),
               "a whole number from " + std::to_string(lo) + " to " + std::to_string(hi));
    }
    return n;
}

size_t YamlNode::oneOf(std::span<const std::string_view> words) const {
    const std::string word = node_.IsScalar() ? node_.Scalar() : "";
    const auto found = std::find(words.begin(), words.end(), word);
    if (found == words.end()) {
        refuse(value() + suggestion(word, words), joined(words));
    }
    return static_cast<size_t>(found - words.begin());
}

dvec3 YamlNode::vec3(const Range& range) const {
    const std::vector<YamlNode> items = list(3);
    return {items[0].number(range), items[1].number(range), items[2].number(range)};
}

dquat YamlNode::quatXyzw() const {
    constexpr const char* kQuaternion = "4 numbers: a quaternion x y z w of non-zero length";
    if (!node_.IsSequence() || node_.size() != 4) {
        refuse(kQuaternion);
    }
    const std::vector<YamlNode> items = list();
    double q[4], largest = 0.0;
    for (size_t i = 0; i < 4; ++i) {
        q[i] = items[i].number(Range::finite());
        largest = std::max(largest, std::abs(q[i]));
    }
    if (!(largest > 1e-300)) {
        refuse(kQuaternion);
    }
    const dquat given(q[3], q[0], q[1], q[2]);
    if (const std::string fault = quaternionFault(given, "x y z w"); !fault.empty()) {
        log::warn("{}: {}: {} is scaled to length 1 (expected: {})", file_, path_, value(), fault);
    }
    return unitOf(given);
}

void YamlNode::read(std::string_view key, double& out, const Range& range) const {
    if (const auto node = find(key)) {
        out = node->number(range);
    }
}

void YamlNode::read(std::string_view key, std::optional<double>& out, const Range& range) const {
    if (const auto node = find(key)) {
        out = node->number(range);
    }
}

void YamlNode::read(std::string_view key, uint32_t& out, uint32_t lo, uint32_t hi) const {
    if (const auto node = find(key)) {
        out = node->integer(lo, hi);
    }
}

void YamlNode::read(std::string_view key, bool& out) const {
    if (const auto node = find(key)) {
        out = node->boolean();
    }
}

void YamlNode::read(std::string_view key, std::string& out) const {
    if (const auto node = find(key)) {
        out = node->text();
    }
}

void YamlNode::read(std::string_view key, dvec3& out, const Range& range) const {
    if (const auto node = find(key)) {
        out = node->vec3(range);
    }
}

void YamlNode::read(std::string_view key, dquat& out) const {
    if (const auto node = find(key)) {
        out = node->quatXyzw();
    }
}

void YamlNode::refuse(const std::string& allowed) const {
    refuse(value(), allowed);
}

void YamlNode::refuse(const std::string& value, const std::string& allowed) const {
    throw BadInput(file_, path_.empty() ? "file" : path_, value, allowed);
}

std::string YamlNode::value() const {
    if (node_.IsScalar()) {
        return node_.Scalar().empty() ? "empty text" : excerpt(node_.Scalar());
    }
    if (node_.IsSequence()) {
        // Never emit the whole node: an alias inside its own anchor would recurse forever.
        std::string all = "[";
        for (const YAML::Node& item : node_) {
            all += (all.size() == 1 ? "" : ", ") + (item.IsScalar() ? item.Scalar() : std::string("..."));
            if (all.size() > kShownCharacters) {
                break;
            }
        }
        return excerpt(all + "]", kShownCharacters);
    }
    return node_.IsMap() ? "a mapping" : "nothing";
}

} // namespace fathom
