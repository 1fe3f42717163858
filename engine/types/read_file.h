// SPDX-License-Identifier: Apache-2.0
// Whole files, never more of them than a reader can use.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

// Links followed. False for what is not there, for folders, and for pipes, sockets and devices, of which
// opening or reading need have no end: a reader of files asks before it opens one.
bool isRegularFile(const std::filesystem::path& file);
// Why such a reader has nothing to read: "a pipe or a device", else "cannot be read".
std::string whyUnreadable(const std::filesystem::path& file);

// The first `most` bytes of a file, and one more if it has more: then size() > most. Memory grows with what
// is read, so that a huge file costs no more. Nothing when it cannot be opened or is
// no regular file.
std::optional<std::string> readFileAtMost(const std::filesystem::path& file, size_t most);

// The whole of it. Throws BadInput when it cannot be read or has more than `most` bytes (a whole number of
// MiB), with both sizes. kind: what is allowed, "a readable ...".
std::string readWholeFile(const std::filesystem::path& file, size_t most, const std::string& kind);

} // namespace fathom
