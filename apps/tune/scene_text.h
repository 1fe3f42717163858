// SPDX-License-Identifier: Apache-2.0
// Changes single values in the text of a scene file and keeps everything else: order, layout, comments.
#pragma once

#include <string>
#include <vector>

namespace fathom::tune {

// A value of one or more nested keys, and the comment that goes above the section.
struct SceneValue {
    std::vector<std::string> path; // from the top: {"filter", "radius"}
    std::string value;             // as YAML
    std::string comment = {};      // one or more lines; empty = none
};

// The text with these values and comments. A missing key is inserted; a missing section is appended. When a
// file's layout does not allow that (anchors, flow style over lines), the whole file is written anew: then
// its own comments are lost, and all of the new ones are at the top. `text` must be a scene that loads.
std::string withValues(const std::string& text, const std::vector<SceneValue>& values);

// Start of the comment lines that this program writes.
inline constexpr const char* kMark = "# tune:";

// Comment lines of at most 100 columns, each marked with kMark; line breaks of the text stay.
std::string commentLines(const std::string& text);

// The text without the lines of an earlier commentLines().
std::string withoutComments(const std::string& text);

} // namespace fathom::tune
