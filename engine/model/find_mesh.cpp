// SPDX-License-Identifier: Apache-2.0
#include "engine/model/find_mesh.h"

#include "engine/model/link_spheres.h"
#include "engine/model/xml_text.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>

namespace fathom {

namespace {

constexpr size_t kLargestManifest = 1u << 20;

// "%20" becomes a space: mesh names are URIs.
std::string percentDecoded(const std::string& text) {
    std::string out;
    for (size_t i = 0; i < text.size(); ++i) {
        unsigned code = 0;
        const char* const digits = text.data() + i + 1;
        if (text[i] == '%' && i + 2 < text.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2 && code != 0) {
            out += static_cast<char>(code);
            i += 2;
        } else {
            out += text[i];
        }
    }
    return out;
}

bool sameButCapitals(const std::string& a, const std::string& b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

// A mesh name: its package, empty for none, and the path in the package.
struct MeshName {
    std::string package, path;
};

MeshName partsOf(std::string name) {
    std::ranges::replace(name, '\\', '/'); // of URDFs made on Windows
    for (const std::string scheme : {"package://", "model://", "file://"}) {
        if (sameButCapitals(name.substr(0, scheme.size()), scheme)) {
            const std::string rest = name.substr(scheme.size());
            const size_t slash = scheme == "file://" ? std::string::npos : rest.find('/');
            return slash == std::string::npos ? MeshName{"", rest}
                                              : MeshName{rest.substr(0, slash), rest.substr(slash + 1)};
        }
    }
    return {"", name};
}

// "https://" of an address that is no file's; empty = none. One letter is a drive: "C://".
std::string schemeOf(const std::string& name) {
    constexpr std::string_view kSign = "://";
    const size_t sign = name.find(kSign);
    const std::string scheme = sign == std::string::npos ? "" : name.substr(0, sign);
    const bool letters = std::ranges::all_of(
        scheme, [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '.' || c == '-'; });
    const bool read = sameButCapitals(scheme, "package") || sameButCapitals(scheme, "model") ||
                      sameButCapitals(scheme, "file");
    return !letters || scheme.size() < 2 || read ? "" : scheme + std::string(kSign);
}

// The only entry of a folder whose name differs from `name` in capitals; empty = none, or several.
std::filesystem::path entryLike(const std::filesystem::path& folder, const std::string& name) {
    std::filesystem::path found;
    std::error_code failed;
    std::filesystem::directory_iterator at(folder.empty() ? "." : folder, failed);
    for (; !failed && at != std::filesystem::directory_iterator(); at.increment(failed)) {
        if (sameButCapitals(at->path().filename().string(), name)) {
            if (!found.empty()) {
                return {};
            }
            found = at->path();
        }
    }
    return found;
}

// folder / wanted where each part is looked for with any capitals, its own first; empty = no such file.
std::filesystem::path inAnyCase(const std::filesystem::path& folder, const std::filesystem::path& wanted) {
    std::error_code ignored;
    std::filesystem::path at = wanted.is_absolute() ? wanted.root_path() : folder;
    for (const std::filesystem::path& part : wanted.relative_path()) {
        at = std::filesystem::exists(at / part, ignored) ? at / part : entryLike(at, part.string());
        if (at.empty()) {
            break;
        }
    }
    return at;
}

// The name in a folder's package.xml; empty = none.
std::string manifestName(const std::filesystem::path& folder) {
    const std::string manifest = readFileAtMost(folder / "package.xml", kLargestManifest).value_or("");
    for (XmlTags tags(manifest); tags.next();) {
        if (tags.path() == "package" && tags.tag().name == "name") {
            return tags.content();
        }
    }
    return "";
}

class MeshSearch {
public:
    MeshSearch(const std::string& name, const ShapeSource& source)
        : name_(name)
        , parts_(partsOf(name))
        , chosen_(!source.meshes.empty()) {
        for (const std::string& other : source.names) {
            const MeshName parts = partsOf(other);
            if (!parts.package.empty() && parts.package != parts_.package) {
                others_.insert(parts.package);
                if (parts.path == parts_.path) {
                    rivals_ += " or " + parts.package;
                }
            }
        }
    }

    MeshPlace in(const std::vector<std::filesystem::path>& folders) {
        for (const auto& folder : folders) { // a backslash may also be part of a file's name
            std::error_code ignored;
            if (name_.find('\\') != std::string::npos && std::filesystem::exists(folder / name_, ignored)) {
                return {folder / name_, ""};
            }
        }
        for (const bool exact : {true, false}) { // capitals
            exact_ = exact;
            for (const bool whole : {true, false}) { // with the package's name as a folder, and without
                for (const auto& [folder, wanted] : places(folders, whole)) {
                    if (auto place = look(folder, wanted, whole || parts_.package.empty());
                        !place.file.empty()) {
                        return place;
                    }
                }
                if (parts_.package.empty()) {
                    break;
                }
            }
        }
        if (const std::string scheme = schemeOf(name_); !scheme.empty()) {
            throw ShapeRefused{
                "mesh '" + excerpt(name_) + "' is an address of " + scheme,
                "a file on this machine: download it, and name that file; package://, model:// "
                "and file:// are read"};
        }
        if (sameButCapitals(name_.substr(0, 5), "file:") && !sameButCapitals(name_.substr(0, 7), "file://")) {
            throw ShapeRefused{"mesh '" + excerpt(name_) + "' not found",
                               "file:// before an absolute path, or a path without file:"};
        }
        throw ShapeRefused{
            "mesh '" + excerpt(name_) + "' not found; looked for " + excerpt(looked_, 1000),
            "an existing file; arm.meshes names the folder to use for package:// and model://"};
    }

private:
    std::vector<std::pair<std::filesystem::path, std::string>>
    places(const std::vector<std::filesystem::path>& folders, bool whole) const {
        const std::string path =
            whole && !parts_.package.empty() ? parts_.package + "/" + parts_.path : parts_.path;
        std::vector<std::string> spellings{path};
        if (std::string decoded = percentDecoded(path); decoded != path) {
            spellings.push_back(std::move(decoded));
        }
        std::vector<std::pair<std::filesystem::path, std::string>> all;
        for (const std::string& wanted : spellings) {
            for (const auto& folder : folders) {
                all.emplace_back(folder, wanted);
            }
        }
        return all;
    }
    MeshPlace look(const std::filesystem::path& folder, const std::string& wanted, bool whole) {
        std::error_code ignored;
        const std::filesystem::path file = exact_ ? folder / wanted : inAnyCase(folder, wanted);
        std::string place = (file.empty() ? folder / wanted : file).lexically_normal().string();
        if (!file.empty() && std::filesystem::exists(file, ignored)) {
            const std::string warning = whole ? "" : warningOf(folder);
            if (warning.empty() || warning == kUnnamed || (chosen_ && others_.empty())) {
                return {file,
                        warning.empty() ? "" : place + " is taken for '" + excerpt(name_) + "'; " + warning,
                        !exact_};
            }
            place += " (" + warning + ")";
        }
        if (seen_.insert(place).second) {
            looked_ += (looked_.empty() ? "" : ", ") + place;
        }
        return {};
    }

    static constexpr const char* kUnnamed = "its folder has not the package's name";

    // Why a file below a folder may not be of the mesh's package.
    std::string warningOf(const std::filesystem::path& folder) const {
        if (const std::string stated = manifestName(folder); !stated.empty()) {
            const bool own = sameButCapitals(stated, parts_.package) ||
                             sameButCapitals(stated, percentDecoded(parts_.package));
            return own ? "" : "of package " + excerpt(printable(stated));
        }
        std::error_code ignored;
        const std::string name = std::filesystem::weakly_canonical(folder, ignored).filename().string();
        if (others_.empty() || name == parts_.package) {
            return "";
        }
        if (others_.count(name) > 0) {
            return "of package " + name;
        }
        return rivals_.empty() ? kUnnamed : "of package " + parts_.package + rivals_;
    }

    const std::string& name_;
    MeshName parts_;
    bool chosen_;                  // the user names the folder
    bool exact_ = true;            // the name as it is; else with any capitals
    std::set<std::string> others_; // packages of the URDF's other meshes
    std::string rivals_;           // those of meshes with the same path
    std::string looked_;           // for the message
    std::set<std::string> seen_;   // places in it
};

} // namespace

MeshPlace findMesh(const std::string& name, const ShapeSource& source) {
    if (name.empty()) {
        throw ShapeRefused{"a mesh without a file name", "<mesh filename=\"...\"/>"};
    }
    std::vector<std::filesystem::path> folders{source.meshes};
    if (source.meshes.empty()) {
        folders = {source.urdf.parent_path()};
        for (int up = 0; up < 3; ++up) {
            folders.push_back(folders.back() / "..");
        }
    }
    return MeshSearch(name, source).in(folders);
}

} // namespace fathom
