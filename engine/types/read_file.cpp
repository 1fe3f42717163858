// SPDX-License-Identifier: Apache-2.0
#include "engine/types/read_file.h"

#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/lower_case.h"
#include "engine/types/stand_in.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <unistd.h>

namespace fathom {

bool isRegularFile(const std::filesystem::path& file) {
    std::error_code failed;
    return std::filesystem::is_regular_file(file, failed);
}

std::string endingOf(const std::filesystem::path& file) {
    return lowerCase(file.extension().string());
}

std::string whyUnreadable(const std::filesystem::path& file) {
    std::error_code failed;
    switch (std::filesystem::status(file, failed).type()) {
    case std::filesystem::file_type::not_found:
        return "no such file";
    case std::filesystem::file_type::directory:
        return "a folder";
    case std::filesystem::file_type::regular:
        return ::access(file.c_str(), R_OK) != 0 && errno == EACCES ? "permission denied" : "cannot be read";
    case std::filesystem::file_type::none:
        return failed == std::errc::permission_denied ? "permission denied" : "cannot be read";
    default:
        return "a pipe or device";
    }
}

std::string firstBytes(const std::filesystem::path& file, size_t most) {
    std::string bytes(most, '\0');
    std::ifstream in(isRegularFile(file) ? std::ifstream(file, std::ios::binary) : std::ifstream());
    in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<size_t>(in.gcount()));
    return bytes;
}

std::optional<std::string> readFileAtMost(const std::filesystem::path& file, size_t most) {
    constexpr size_t kPiece = 1u << 16;
    if (!isRegularFile(file)) {
        return std::nullopt;
    }
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        return std::nullopt;
    }
    noteInput(file);
    std::string text;
    while (in && text.size() <= most) {
        const size_t before = text.size(), piece = std::min(kPiece, most + 1 - before);
        text.resize(before + piece);
        in.read(text.data() + before, static_cast<std::streamsize>(piece));
        text.resize(before + static_cast<size_t>(in.gcount()));
    }
    if (in.bad()) { // the disk or network failed: the text is incomplete
        return std::nullopt;
    }
    return text;
}

std::string readWholeFile(const std::filesystem::path& file, size_t most, const std::string& kind) {
    std::optional<std::string> text = readFileAtMost(file, most);
    if (!text) {
        throw BadInput(file.empty() ? "''" : file.string(), "file", whyUnreadable(file), kind);
    }
    if (text->size() > most) {
        std::error_code failed;
        const uintmax_t size = std::filesystem::file_size(file, failed);
        throw BadInput(file.string(), "file",
                       failed || size <= most ? "grows" : std::to_string(size) + " bytes",
                       kind + " of at most " + std::to_string(most >> 20) + " MiB");
    }
    if (const std::string other = standIn(*text); !other.empty()) {
        throw BadInput(file.string(), "content", other, kind);
    }
    return *std::move(text);
}

} // namespace fathom
