// SPDX-License-Identifier: Apache-2.0
// The words in the name of a topic, and what each word means for its images.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

// What a word of a topic's name says about its images.
enum class WordUse {
    None,
    Depth,
    Painted, // depth, in colours that a program chose
    Colour,
    Infrared,  // also amplitude, confidence, labels and the like
    Auxiliary, // computed from depth or published about it: errors, labels; no part of a camera's name
    Derived,   // computed from depth, if it stands behind a word of depth: its gradient, its weights
    Unscaled,  // depth that is no metres, also if it stands in front of the word: inverse, relative
};

// Plurals are alike. Some words ("z", "ab") may also be the name of a robot: they say nothing in the first of
// several parts of a topic.
WordUse useOf(const std::string& word, bool firstPart);
// Says how images are sent ("raw", "rect"), has a use, or is a number: nothing that hints at other images.
bool isUsualWord(const std::string& word);
// The last word of a part that names a camera: "edge_cam".
bool endsCamera(const std::string& word);
// Whether the images are what words[at] names, as in "depth_gradient/image". Not in "depth_edge_preserving",
// "depth_flow_aligned", "depth_without_edges" and "edge_cam".
bool describesImages(const std::vector<std::string>& words, size_t at);
// In lower case, split at signs.
std::vector<std::string> tokensOf(const std::string& name);
// Also split in camel case: "irImage" and "IRImage" are two words; but "DepthVis" is one, which has a use.
std::vector<std::string> camelWordsOf(const std::string& name);
// The same without digits at the end of words.
std::vector<std::string> withoutDigits(std::vector<std::string> words);

} // namespace fathom
