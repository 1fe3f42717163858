// SPDX-License-Identifier: Apache-2.0
// Reads whole files up to a size limit.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace fathom {

// Follows links. False for missing files, folders, pipes, sockets and devices. Readers check this before they
// open a file, because opening or reading a pipe or device may never end.
bool isRegularFile(const std::filesystem::path& file);
// Its extension in lower case, ".urdf"; empty when it has none.
std::string endingOf(const std::filesystem::path& file);
// Why a file is not readable, for messages.
std::string whyUnreadable(const std::filesystem::path& file);

// Its first `most` bytes, or all if it has fewer. Empty when it cannot be opened or is not a regular file.
std::string firstBytes(const std::filesystem::path& file, size_t most);

// Reads at most `most` + 1 bytes, so size() > most means that the file is larger. Memory grows with the bytes
// read. Empty when the file cannot be opened or is not a regular file.
std::optional<std::string> readFileAtMost(const std::filesystem::path& file, size_t most);

// Reads the whole file. Throws BadInput when it cannot be read, has more than `most` bytes (a whole number of
// MiB; the message has both sizes), or holds something else in place of its content (standIn()). kind: the
// allowed kind of file, "a readable ...".
std::string readWholeFile(const std::filesystem::path& file, size_t most, const std::string& kind);

} // namespace fathom
