// SPDX-License-Identifier: Apache-2.0
#include "engine/reader/mjcf.h"

#include "engine/model/xml_text.h"
#include "engine/reader/answers.h"
#include "engine/reader/mjcf_body.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <iterator>
#include <map>
#include <set>
#include <sstream>

namespace fathom {

namespace {

constexpr size_t kLargestFile = 16u << 20; // [bytes]
constexpr int kMaxIncludes = 64;

const tinyxml2::XMLElement& parse(tinyxml2::XMLDocument& document, const std::string& file,
                                  const std::string& text) {
    const ParserScope parser;
    if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS ||
        document.RootElement() == nullptr) {
        throw BadInput(file, "line " + std::to_string(document.ErrorLineNum()),
                       std::string("not understood (") + document.ErrorName() + ")", "an MJCF file");
    }
    return *document.RootElement();
}

// Replaces each <include> by the content of its file, which may include others.
class Includes {
public:
    Includes(const std::filesystem::path& file, tinyxml2::XMLDocument& document)
        : file_(file)
        , document_(document) {}

    void expand(tinyxml2::XMLElement& element) {
        for (auto* child = element.FirstChildElement(); child != nullptr;) {
            auto* next = child->NextSiblingElement();
            if (std::string(child->Name()) == "include") {
                tinyxml2::XMLElement* const first = replace(element, *child);
                next = first != nullptr ? first : next;
            } else {
                expand(*child);
            }
            child = next;
        }
    }

private:
    // Cloning loses the lines, so the elements keep their place in an attribute.
    static void writePlaces(tinyxml2::XMLElement& element, const std::string& file) {
        const std::string place = file + ": line " + std::to_string(element.GetLineNum());
        if (element.Attribute(kPlaceAttribute) == nullptr) {
            element.SetAttribute(kPlaceAttribute, place.c_str());
        }
        for (auto* child = element.FirstChildElement(); child != nullptr;
             child = child->NextSiblingElement()) {
            writePlaces(*child, file);
        }
    }

    // Returns the first element that came, null when there was none.
    tinyxml2::XMLElement* replace(tinyxml2::XMLElement& parent, tinyxml2::XMLElement& include) {
        const char* const named = include.Attribute("file");
        const MjcfPlace place = mjcfPlace(include, file_.string());
        if (named == nullptr || ++count_ > kMaxIncludes) {
            throw BadInput(place.file, place.line + ": <include>",
                           named == nullptr ? "without file" : "one more",
                           "a file, " + std::to_string(kMaxIncludes) + " at most");
        }
        const std::filesystem::path path = file_.parent_path() / named;
        tinyxml2::XMLDocument other;
        parse(other, path.string(), readWholeFile(path, kLargestFile, "a readable MJCF file"));
        tinyxml2::XMLElement& root = *other.RootElement();
        writePlaces(root, path.string());
        tinyxml2::XMLNode* after = &include;
        tinyxml2::XMLElement* first = nullptr;
        for (auto* child = root.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
            after = parent.InsertAfterChild(after, child->DeepClone(&document_));
            first = first == nullptr ? after->ToElement() : first;
        }
        parent.DeleteChild(&include);
        return first;
    }

    const std::filesystem::path file_;
    tinyxml2::XMLDocument& document_;
    int count_ = 0;
};

} // namespace

bool isMjcf(const std::string& text) {
    for (XmlPieces pieces(text); pieces.next();) {
        if (!pieces.piece().name.empty()) {
            return pieces.piece().name == "mujoco";
        }
    }
    return false;
}

namespace {

using MjcfWords = std::set<std::string>;

// What MuJoCo knows of the elements that are read; it rejects a file with anything else.
const std::map<std::string, MjcfWords>& mjcfAttributes() {
    constexpr const char* kPose = " pos quat axisangle xyaxes zaxis euler";
    const auto wordsOf = [](const std::string& text) {
        std::istringstream in(text);
        return MjcfWords{std::istream_iterator<std::string>(in), {}};
    };
    static const std::map<std::string, MjcfWords> kAll{
        {"body", wordsOf(std::string("name childclass mocap gravcomp user sleep") + kPose)},
        {"frame", wordsOf(std::string("name childclass") + kPose)},
        {"freejoint", wordsOf("name group align")},
        {"geom",
         wordsOf(std::string("name class type contype conaffinity condim group priority size material "
                             "friction mass density shellinertia solmix solref solimp margin gap "
                             "fromto hfield mesh fitscale rgba fluidshape fluidcoef adhesion user") +
                 kPose)},
        {"joint", wordsOf("name class type group pos axis springdamper limited range ref springref armature "
                          "damping frictionloss stiffness margin solreflimit solimplimit solreffriction "
                          "solimpfriction actuatorfrcrange actuatorfrclimited actuatorgravcomp user")},
        {"site", wordsOf(std::string("name class type group material size fromto rgba user") + kPose)}};
    return kAll;
}

bool holdsParts(const std::string& kind) {
    return kind == "body" || kind == "frame" || kind == "worldbody";
}

// Notes elements and attributes below bodies and defaults that MuJoCo does not know, each once.
void noteUnknown(const tinyxml2::XMLElement& holder, MjcfWords& noted, std::vector<std::string>& notes) {
    static const MjcfWords kOthers{"inertial", "camera", "light",     "plugin", "composite",
                                   "flexcomp", "attach", "replicate", "skin"};
    for (auto* child = holder.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
        const std::string kind = child->Name();
        const auto note = [&](const std::string& what) {
            if (noted.insert(what).second) {
                const MjcfPlace place = mjcfPlace(*child, ""); // no file: the main one
                notes.push_back((place.file.empty() ? "" : place.file + ": ") + place.line + ": " +
                                excerpt(printable(what)) + " is unknown to MuJoCo and not read");
            }
        };
        const auto known = mjcfAttributes().find(kind);
        if (known == mjcfAttributes().end()) {
            if (holdsParts(holder.Name()) && kOthers.count(kind) == 0) {
                note("<" + kind + ">");
            }
        } else {
            for (auto* own = child->FirstAttribute(); own != nullptr; own = own->Next()) {
                const std::string name = own->Name();
                if (name != kPlaceAttribute && known->second.count(name) == 0) {
                    note("<" + kind + " " + name + "=...>");
                }
            }
        }
        if (kind == "default" || holdsParts(kind)) {
            noteUnknown(*child, noted, notes);
        }
    }
}

} // namespace

std::string urdfOfMjcf(const std::filesystem::path& file, const std::string& text,
                       std::vector<std::string>& notes) {
    tinyxml2::XMLDocument document;
    parse(document, file.string(), text);
    Includes(file, document).expand(*document.RootElement());
    MjcfBodies bodies(file.string(), *document.RootElement());
    std::string urdf = bodies.urdf();
    notes = bodies.notes();
    MjcfWords noted;
    noteUnknown(*document.RootElement(), noted, notes);
    return urdf;
}

} // namespace fathom
