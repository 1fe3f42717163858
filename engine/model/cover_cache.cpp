// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_cache.h"

#include "engine/model/mesh_file.h"
#include "engine/types/cache_file.h"
#include "engine/types/cache_folder.h"
#include "engine/types/error.h"
#include "engine/types/printed.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace fathom {

namespace {

constexpr const char* kHeader = "fathom cover 6"; // raise the number when covers or this format change
constexpr size_t kLargest = 4u << 20;

std::string hex(uint64_t value) {
    return printed("%016llx", static_cast<unsigned long long>(value));
}

std::string textOf(const ShapeSpheres& made) {
    std::string text = std::string(kHeader) + "\n" + (made.open ? "open\n" : "");
    for (const std::string& note : made.notes) {
        text += "note " + note + "\n";
    }
    for (const Sphere& s : made.spheres) {
        text += printed("%.17g %.17g %.17g %.17g\n", s.centre.x, s.centre.y, s.centre.z, s.radius);
    }
    return text + hex(fnv1a(text, 0)) + "\n";
}

// Nothing when the text is not as textOf() writes it.
std::optional<ShapeSpheres> madeOf(const std::string& text) {
    const size_t end = text.rfind('\n', text.size() < 2 ? 0 : text.size() - 2) + 1;
    if (!text.starts_with(std::string(kHeader) + "\n") || end == 0 ||
        text.substr(end) != hex(fnv1a(std::string_view(text).substr(0, end), 0)) + "\n") {
        return std::nullopt;
    }
    ShapeSpheres made;
    std::istringstream lines(text.substr(0, end));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        if (line.starts_with("note ")) {
            made.notes.push_back(line.substr(5));
            continue;
        }
        if (line == "open") {
            made.open = true;
            continue;
        }
        Sphere s;
        if (std::sscanf(line.c_str(), "%lf %lf %lf %lf", &s.centre.x, &s.centre.y, &s.centre.z, &s.radius) !=
                4 ||
            !isFinite(s.centre) || !(s.radius > 0.0)) {
            return std::nullopt;
        }
        made.spheres.push_back(s);
    }
    return made.spheres.empty() ? std::nullopt : std::optional(made);
}

} // namespace

CoverCache::CoverCache()
    : folder_(cacheFolder()) {
    folder_ /= folder_.empty() ? "" : "covers";
}

std::string CoverCache::keyOf(const std::filesystem::path& mesh, const std::string& options) const {
    if (folder_.empty()) {
        return "";
    }
    const auto bytes = readFileAtMost(mesh, kLargestMesh);
    if (!bytes || bytes->size() > kLargestMesh) {
        return "";
    }
    const std::string kind = mesh.extension().string() + " " + options;
    return hex(fnv1a(*bytes, fnv1a(kind))) + hex(fnv1a(*bytes, fnv1a(kind, 1)));
}

std::optional<ShapeSpheres> CoverCache::find(const std::string& key) const {
    const auto text = key.empty() ? std::nullopt : readFileAtMost(folder_ / key, kLargest);
    return text && text->size() <= kLargest ? madeOf(*text) : std::nullopt;
}

bool CoverCache::store(const std::string& key, const ShapeSpheres& made) const {
    const std::string text = textOf(made);
    if (key.empty() || made.spheres.empty() || text.size() > kLargest) {
        return false;
    }
    try {
        storeCacheFile(folder_ / key, text);
    } catch (const Error&) {
        return false;
    }
    trim();
    return true;
}

void CoverCache::trim() const {
    std::error_code failed;
    std::vector<std::pair<std::filesystem::file_time_type, std::filesystem::path>> files;
    for (std::filesystem::directory_iterator at(folder_, failed), end; !failed && at != end;
         at.increment(failed)) {
        files.emplace_back(at->last_write_time(failed), at->path());
    }
    if (files.size() <= kMaxFiles) {
        return;
    }
    std::sort(files.begin(), files.end());
    for (size_t i = 0; i + kMaxFiles < files.size(); ++i) {
        std::filesystem::remove(files[i].second, failed);
    }
}

} // namespace fathom
