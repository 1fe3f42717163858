// SPDX-License-Identifier: Apache-2.0
// The word that was probably meant by a misspelt one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fathom {

// The word of the least edit distance (insert, delete, replace, swap of neighbours) to `word`, the first of
// equals. Empty if at least half of the longer word would change.
std::string_view nearestWord(std::string_view word, std::span<const std::string_view> words);

// Whether `word` is probably `known` with at most two typing errors, none of them in a digit.
bool isMisspelt(std::string_view word, std::string_view known);

// ", did you mean 'NAME'?" with the nearest word, or empty.
std::string suggestion(std::string_view word, std::span<const std::string_view> words);

} // namespace fathom
