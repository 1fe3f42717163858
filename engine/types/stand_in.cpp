// SPDX-License-Identifier: Apache-2.0
#include "engine/types/stand_in.h"

#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace fathom {

namespace {

using namespace std::string_view_literals;

constexpr const char* kLfs = "a Git LFS pointer, which 'git lfs pull' replaces by the file";
constexpr const char* kAnnex = "a git-annex pointer, which 'git annex get' replaces by the file";
constexpr const char* kPage = "a web page (HTML) in place of the file";

struct KnownStandIn {
    std::string_view begin;
    const char* what;
};
constexpr std::array kStandIns{KnownStandIn{"version https://git-lfs.github.com/spec/", kLfs},
                               KnownStandIn{"/annex/objects/", kAnnex},
                               KnownStandIn{"PK\x03\x04", "a ZIP archive: unpack it"},
                               KnownStandIn{"\x1f\x8b", "packed by gzip: unpack it"},
                               KnownStandIn{"\x28\xb5\x2f\xfd", "packed by Zstandard: unpack it (zstd -d)"},
                               KnownStandIn{"\xfd"
                                            "7zXZ",
                                            "packed by xz: unpack it"},
                               KnownStandIn{"BZh", "packed by bzip2: unpack it"},
                               KnownStandIn{"7z\xbc\xaf\x27\x1c", "a 7z archive: unpack it"},
                               KnownStandIn{"Rar!\x1a", "a RAR archive: unpack it"}};
constexpr std::string_view kTar = "ustar";
constexpr size_t kTarAt = 257;

bool beginsAsPage(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    return std::ranges::any_of(std::array{"<!doctype html"sv, "<html"sv}, [&](std::string_view tag) {
        return std::ranges::equal(text.substr(0, tag.size()), tag,
                                  [](unsigned char a, char b) { return std::tolower(a) == b; });
    });
}

} // namespace

std::string standIn(std::string_view begin) {
    for (const KnownStandIn& known : kStandIns) {
        if (begin.starts_with(known.begin)) {
            return known.what;
        }
    }
    if (begin.size() > kTarAt && begin.substr(kTarAt).starts_with(kTar)) {
        return "a tar archive: unpack it";
    }
    return beginsAsPage(begin) ? kPage : "";
}

std::string standInOf(const std::filesystem::path& file) {
    return standIn(firstBytes(file, kTarAt + kTar.size()));
}

void refuseStandIn(const std::filesystem::path& file, const std::string& kind) {
    if (const std::string what = standInOf(file); !what.empty()) {
        throw BadInput(file.string(), "content", what, kind);
    }
}

void refuseUtf16(const std::filesystem::path& file, std::string_view begin, const std::string& kind) {
    if (begin.starts_with("\xff\xfe") || begin.starts_with("\xfe\xff")) {
        throw BadInput(file.string(), "content", "UTF-16 text: save it as UTF-8", kind);
    }
}

} // namespace fathom
