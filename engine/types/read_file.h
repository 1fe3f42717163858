// SPDX-License-Identifier: Apache-2.0
// Whole files, never more of them than a reader can use.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

// The first `most` bytes of a file, and one more if it has more: then size() > most. Memory grows with what
// is read, so that neither a huge file nor an endless one costs more. Nothing when it cannot be opened or is
// a folder.
std::optional<std::string> readFileAtMost(const std::filesystem::path& file, size_t most);

// The whole of it. Throws BadInput when it cannot be read or has more than `most` bytes (a whole number of
// MiB), with both sizes. kind: what is allowed, "a readable ...".
std::string readWholeFile(const std::filesystem::path& file, size_t most, const std::string& kind);

} // namespace fathom
