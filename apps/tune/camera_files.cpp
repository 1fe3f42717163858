// SPDX-License-Identifier: Apache-2.0
#include "apps/tune/camera_files.h"

#include "engine/types/inside.h"

#include <algorithm>

namespace fathom::tune {

namespace {

namespace fs = std::filesystem;

struct TextPart {
    size_t begin = 0, length = 0;
};

// The values of the options that name files. The loader of scenes ends them at a comma, too.
std::vector<TextPart> fileOptions(const std::string& source) {
    std::vector<TextPart> parts;
    for (const std::string key : {"intrinsics=", "extrinsics="}) {
        const size_t found = source.starts_with(key) ? 0 : source.find("," + key);
        if (found != std::string::npos) {
            const size_t begin = source.find('=', found) + 1;
            parts.push_back({begin, std::min(source.find(',', begin), source.size()) - begin});
        }
    }
    std::ranges::sort(parts, {}, &TextPart::begin);
    return parts;
}

// Where ",NAME=VALUE" begins behind the path of a recording, which may have commas itself.
size_t optionsBegin(const std::string& recording) {
    for (size_t comma = recording.find(','); comma != std::string::npos;
         comma = recording.find(',', comma + 1)) {
        const size_t end = recording.find_first_not_of("abcdefghijklmnopqrstuvwxyz", comma + 1);
        if (end != std::string::npos && recording[end] == '=') {
            return comma;
        }
    }
    return recording.size();
}

} // namespace

std::string movedPath(const fs::path& path, const fs::path& home, const fs::path& folder) {
    if (path.is_absolute()) {
        return path.string();
    }
    const fs::path file = (fs::weakly_canonical(home) / path).lexically_normal();
    return file.lexically_proximate(fs::weakly_canonical(folder)).string();
}

std::string movedSource(const std::string& kind, const std::string& value, const fs::path& home,
                        const fs::path& folder) {
    const size_t options = kind == "recorded" ? optionsBegin(value) : 0;
    std::string moved = value.substr(options);
    const std::vector<TextPart> parts = fileOptions(moved);
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
        const std::string path = moved.substr(part->begin, part->length);
        if (!staysInside(path)) {
            moved.replace(part->begin, part->length, movedPath(path, home, folder));
        }
    }
    return kind == "recorded" ? movedPath(value.substr(0, options), home, folder) + moved : moved;
}

std::vector<fs::path> filesBesideScene(const std::string& source) {
    std::vector<fs::path> files;
    for (const TextPart& part : fileOptions(source)) {
        const fs::path path = source.substr(part.begin, part.length);
        if (staysInside(path)) {
            files.push_back(path);
        }
    }
    return files;
}

} // namespace fathom::tune
