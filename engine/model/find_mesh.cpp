// SPDX-License-Identifier: Apache-2.0
#include "engine/model/find_mesh.h"

#include "engine/model/link_spheres.h"
#include "engine/model/xml_text.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

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

// A mesh name: its package, empty for none, and the path in the package.
struct MeshName {
    std::string package, path;
};

MeshName partsOf(const std::string& name) {
    for (const std::string scheme : {"package://", "model://", "file://"}) {
        if (name.starts_with(scheme)) {
            const std::string rest = name.substr(scheme.size());
            const size_t slash = scheme == "file://" ? std::string::npos : rest.find('/');
            return slash == std::string::npos ? MeshName{"", rest}
                                              : MeshName{rest.substr(0, slash), rest.substr(slash + 1)};
        }
    }
    return {"", name};
}

// Names of the package that a folder may be: its own name, or the one of its package.xml.
std::set<std::string> packageNames(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::set<std::string> names{std::filesystem::weakly_canonical(folder, ignored).filename().string()};
    const std::string manifest = readFileAtMost(folder / "package.xml", kLargestManifest).value_or("");
    bool named = false;
    for (XmlPieces pieces(manifest); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        if (named) {
            return {std::string(piece.text)};
        }
        named = piece.name == "name" && !piece.closes;
    }
    return names;
}

class MeshSearch {
public:
    MeshSearch(const std::string& name, const ShapeSource& source)
        : name_(name)
        , parts_(partsOf(name)) {
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
        for (const bool whole : {true, false}) { // with the package's name as a folder, and without
            const std::string path =
                whole && !parts_.package.empty() ? parts_.package + "/" + parts_.path : parts_.path;
            for (const std::string& wanted : {path, percentDecoded(path)}) {
                for (const auto& folder : folders) {
                    if (auto place = look(folder, wanted, whole || parts_.package.empty());
                        !place.file.empty()) {
                        return place;
                    }
                }
            }
            if (parts_.package.empty()) {
                break;
            }
        }
        throw ShapeRefused{
            "mesh '" + excerpt(name_) + "' not found; looked for " + excerpt(looked_, 1000),
            "an existing file; arm.meshes names the folder to use for package:// and model://"};
    }

private:
    MeshPlace look(const std::filesystem::path& folder, const std::string& wanted, bool whole) {
        std::error_code ignored;
        const std::filesystem::path file = folder / wanted;
        std::string place = file.lexically_normal().string();
        if (std::filesystem::exists(file, ignored)) {
            const std::string warning = whole || others_.empty() ? "" : warningOf(folder);
            if (warning.empty() || warning == kUnnamed) {
                return {file,
                        warning.empty() ? "" : place + " is taken for '" + excerpt(name_) + "'; " + warning};
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
        const auto names = packageNames(folder);
        if (names.count(parts_.package) > 0) {
            return "";
        }
        for (const std::string& other : others_) {
            if (names.count(other) > 0) {
                return "of package " + other;
            }
        }
        return rivals_.empty() ? kUnnamed : "of package " + parts_.package + rivals_;
    }

    const std::string& name_;
    MeshName parts_;
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
