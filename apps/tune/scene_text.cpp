// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/scene_text.h"

#include <algorithm>
#include <sstream>
#include <utility>
#include <yaml-cpp/yaml.h>

namespace fathom::tune {

namespace {

constexpr size_t kColumns = 100;

// Replaces `erase` characters at `at` by `text`.
struct TextEdit {
    size_t at = 0, erase = 0;
    std::string text;
};

size_t placeOf(const YAML::Node& node) {
    return static_cast<size_t>(std::max(0, node.Mark().pos));
}

// Length of the scalar that begins at `at`, quotes included.
size_t scalarLength(const std::string& text, size_t at, const YAML::Node& node) {
    if (at < text.size() && (text[at] == '"' || text[at] == '\'')) {
        const size_t end = text.find(text[at], at + 1);
        return end == std::string::npos ? 0 : end + 1 - at;
    }
    return node.Scalar().size();
}

// The key's own node, whose mark is in front of it.
YAML::Node keyIn(const YAML::Node& map, const std::string& name) {
    for (const auto& entry : map) {
        if (entry.first.IsScalar() && entry.first.Scalar() == name) {
            return entry.first;
        }
    }
    return {};
}

TextEdit insertion(const YAML::Node& map, const std::string& entry) {
    const size_t at = placeOf(map);
    if (map.Style() == YAML::EmitterStyle::Flow) {
        return {at + 1, 0, " " + entry + (map.size() == 0 ? " " : ",")};
    }
    const int column = std::max(0, map.begin()->first.Mark().column);
    return {placeOf(map.begin()->first), 0, entry + "\n" + std::string(static_cast<size_t>(column), ' ')};
}

// Whether a scalar has this value already, as text or as number.
bool holds(const YAML::Node& node, const std::string& value) {
    if (!node.IsScalar() || node.Scalar() == value) {
        return node.IsScalar();
    }
    double had = 0.0, wanted = 0.0;
    return YAML::convert<double>::decode(node, had) &&
           YAML::convert<double>::decode(YAML::Node(value), wanted) && had == wanted;
}

class SceneEditor {
public:
    SceneEditor(const std::string& text, const YAML::Node& root)
        : text_(text)
        , root_(root) {}

    void set(const SceneValue& value) {
        const std::string& top = value.path.front();
        if (!value.comment.empty()) {
            comment(top, value.comment);
        }
        YAML::Node node = root_;
        for (size_t i = 0; i < value.path.size(); ++i) {
            const YAML::Node next = std::as_const(node)[value.path[i]];
            if (!next.IsDefined()) {
                add(node, i, value);
                return;
            }
            node.reset(next);
        }
        if (!holds(node, value.value)) {
            edits_.push_back({placeOf(node), scalarLength(text_, placeOf(node), node), value.value});
        }
    }

    std::string result() {
        std::ranges::stable_sort(edits_, {}, &TextEdit::at);
        std::string out = text_;
        for (auto edit = edits_.rbegin(); edit != edits_.rend(); ++edit) {
            out.replace(edit->at, edit->erase, edit->text);
        }
        out += out.empty() || out.back() == '\n' ? "" : "\n";
        return out + appended_;
    }

private:
    bool atTop() const { return root_.Style() == YAML::EmitterStyle::Flow; }

    void comment(const std::string& top, const std::string& words) {
        const YAML::Node key = keyIn(root_, top);
        if (key.IsDefined() && !key.IsNull()) {
            edits_.push_back({atTop() ? 0 : placeOf(key), 0, commentLines(words)});
        } else {
            (atTop() ? edits_.emplace_back().text : appended_) += commentLines(words);
        }
    }

    // Adds the key path[depth] and those below it to `map`.
    void add(const YAML::Node& map, size_t depth, const SceneValue& value) {
        std::string entry = value.path[depth] + ": ";
        for (size_t i = depth + 1; i < value.path.size(); ++i) {
            entry += "{ " + value.path[i] + ": ";
        }
        entry += value.value;
        for (size_t i = depth + 1; i < value.path.size(); ++i) {
            entry += " }";
        }
        if (depth == 0 && !atTop()) {
            appended_ += entry + "\n";
        } else {
            edits_.push_back(insertion(map, entry));
        }
    }

    const std::string& text_;
    const YAML::Node& root_;
    std::vector<TextEdit> edits_;
    std::string appended_;
};

// The same values on the nodes themselves. A value is replaced as an entry of its map, because assigning to
// a node also changes its aliases.
YAML::Node editedNodes(const std::string& text, const std::vector<SceneValue>& values) {
    YAML::Node root = YAML::Load(text);
    for (const SceneValue& value : values) {
        YAML::Node map = root;
        for (size_t i = 0; i + 1 < value.path.size(); ++i) {
            map.reset(YAML::Node(map[value.path[i]]));
        }
        const YAML::Node old = std::as_const(map)[value.path.back()];
        if (!old.IsDefined() || !holds(old, value.value)) {
            map.remove(value.path.back());
            map[value.path.back()] = YAML::Load(value.value);
        }
    }
    return root;
}

bool sameNodes(const YAML::Node& a, const YAML::Node& b) {
    if (a.Type() != b.Type() || a.size() != b.size()) {
        return false;
    }
    if (a.IsScalar()) {
        return a.Scalar() == b.Scalar();
    }
    if (a.IsSequence()) {
        for (size_t i = 0; i < a.size(); ++i) {
            if (!sameNodes(a[i], b[i])) {
                return false;
            }
        }
        return true;
    }
    return !a.IsMap() || std::ranges::all_of(a, [&](const auto& entry) {
        const YAML::Node other = b[entry.first.Scalar()];
        return other.IsDefined() && sameNodes(entry.second, other);
    });
}

// One section per missing key, so that several values of one make one entry.
std::vector<SceneValue> joined(const std::string& text, const std::vector<SceneValue>& values) {
    const YAML::Node root = YAML::Load(text);
    std::vector<SceneValue> list;
    for (const SceneValue& value : values) {
        const auto same = std::ranges::find_if(list, [&](const SceneValue& other) {
            return other.path.size() == 1 && value.path.size() == 2 && other.path[0] == value.path[0];
        });
        if (value.path.size() != 2 || root[value.path[0]].IsDefined()) {
            list.push_back(value);
        } else if (same == list.end()) {
            list.push_back(
                {{value.path[0]}, "{ " + value.path[1] + ": " + value.value + " }", value.comment});
        } else {
            same->value.insert(same->value.size() - 2, ", " + value.path[1] + ": " + value.value);
            same->comment += (same->comment.empty() ? "" : "\n") + value.comment;
        }
    }
    return list;
}

} // namespace

std::string withValues(const std::string& text, const std::vector<SceneValue>& values) {
    const YAML::Node wanted = editedNodes(text, values), root = YAML::Load(text);
    SceneEditor editor(text, root);
    for (const SceneValue& value : joined(text, values)) {
        editor.set(value);
    }
    std::string result = editor.result();
    try {
        if (sameNodes(YAML::Load(result), wanted)) {
            return result;
        }
    } catch (const YAML::Exception&) { // written anew below
    }
    std::ostringstream out;
    for (const SceneValue& value : values) {
        out << (value.comment.empty() ? "" : commentLines(value.comment));
    }
    out << wanted << "\n";
    return out.str();
}

std::string commentLines(const std::string& text) {
    std::istringstream lines(text);
    std::string out, line, word;
    while (std::getline(lines, line)) {
        std::istringstream words(line);
        std::string row = kMark;
        while (words >> word) {
            if (row.size() + 1 + word.size() > kColumns && row.back() != ' ') {
                out += row + "\n";
                row = std::string(kMark) + "  ";
            }
            row += " " + word;
        }
        out += row + "\n";
    }
    return out;
}

std::string withoutComments(const std::string& text) {
    std::istringstream lines(text);
    std::string out, line;
    while (std::getline(lines, line)) {
        out += line.starts_with(kMark) ? "" : line + "\n";
    }
    return out;
}

} // namespace fathom::tune
