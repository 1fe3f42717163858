// SPDX-License-Identifier: Apache-2.0
#include "engine/model/urdf_file.h"

#include "engine/model/reader_process.h"
#include "engine/model/xml_text.h"
#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <cmath>
#include <console_bridge/console.h>
#include <iterator>
#include <locale>
#include <set>
#include <sstream>
#include <string_view>
#include <urdf_model/pose.h>
#include <urdf_parser/urdf_parser.h>

namespace fathom {

namespace {

constexpr size_t kLargestUrdf = 16u << 20;
constexpr const char* kCapsuleFile = "capsule: "; // radius and length follow
constexpr size_t kMostLinks = 1000;               // traversals from the root are recursive

// Captures the parser's message for use in Fathom's own error line.
class Listener : public console_bridge::OutputHandler {
public:
    Listener()
        : before_(console_bridge::getOutputHandler()) {
        console_bridge::useOutputHandler(this);
    }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() override { console_bridge::useOutputHandler(before_); }
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) {
            first_ = text.substr(0, text.find('\n'));
        }
    }
    const std::string& first() const { return first_; }

private:
    console_bridge::OutputHandler* before_;
    std::string first_;
};

// The parser requires only one root: links in a loop of joints have no root above them and would never be
// freed.
void checkLinks(const urdf::ModelInterface& model, const std::string& file) {
    if (model.links_.size() > kMostLinks) {
        throw BadInput(file, "robot", std::to_string(model.links_.size()) + " links",
                       std::to_string(kMostLinks) + " at most");
    }
    std::set<const urdf::Link*> below;
    std::vector<const urdf::Link*> open{model.getRoot().get()};
    while (!open.empty()) {
        const urdf::Link* const link = open.back();
        open.pop_back();
        if (below.insert(link).second) {
            std::ranges::transform(link->child_links, std::back_inserter(open),
                                   [](const auto& child) { return child.get(); });
        }
    }
    const auto stray = std::ranges::find_if(
        model.links_, [&](const auto& link) { return below.count(link.second.get()) == 0; });
    if (stray == model.links_.end()) {
        return;
    }
    throw BadInput(file, "link " + stray->first, "in a loop of joints", "a tree of links below one root");
}

std::shared_ptr<const urdf::ModelInterface> parse(const std::filesystem::path& file,
                                                  const std::string& text) {
    const Listener listener;
    const std::shared_ptr<const urdf::ModelInterface> model = [&] {
        const LibraryAtWork library;
        return urdf::parseURDF(text);
    }();
    if (!model) {
        throw BadInput(file.string(), "robot", listener.first().empty() ? "not understood" : listener.first(),
                       "a URDF robot");
    }
    checkLinks(*model, file.string());
    return model;
}

// The parser and the model's destructor are recursive, so tens of thousands of nested links overflow the
// stack. A file that a child process survives from parsing to destruction is safe here.
void tryOut(const std::filesystem::path& file, const std::string& text) {
    std::string fault;
    const auto read = [&](int pipe) {
        std::string refusal;
        try {
            parse(file, text);
        } catch (const std::exception& e) {
            refusal = e.what();
        }
        return writeText(pipe, refusal);
    };
    const ReaderEnd end = runReader(file, {read, [&](int pipe) { return readText(pipe, fault); }});
    if (!end.whole) {
        throw BadInput(file.string(), "robot", broken("URDF reader", end), "a URDF robot");
    }
    if (!fault.empty()) {
        throw BadInput(fault);
    }
}

// <capsule radius length/> becomes a mesh whose file name holds the sizes, which the parser passes on.
std::string hideCapsules(const std::string& text) {
    std::string out;
    for (XmlPieces pieces(text); pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        if (piece.name != "capsule") {
            out += piece.text;
        } else if (piece.closes) {
            out += "</mesh>";
        } else {
            out += "<mesh filename=\"" + std::string(kCapsuleFile) +
                   xmlEscaped(xmlAttribute(piece.text, "radius") + " " + xmlAttribute(piece.text, "length")) +
                   (piece.isEmpty ? "\"/>" : "\">");
        }
    }
    return out;
}

void refuseXacro(const std::filesystem::path& file, const std::string& text) {
    if (text.find("<xacro:") != std::string::npos) {
        throw BadInput(file.string(), "robot", "a xacro file",
                       "a URDF; expand it with: xacro " + file.filename().string() + " > " +
                           file.stem().stem().string() + ".urdf");
    }
}

} // namespace

std::optional<CapsuleSize> capsuleOf(const urdf::Geometry& shape) {
    const auto* mesh = dynamic_cast<const urdf::Mesh*>(&shape);
    if (mesh == nullptr || mesh->filename.rfind(kCapsuleFile, 0) != 0) {
        return std::nullopt;
    }
    std::istringstream sizes(mesh->filename.substr(std::string_view(kCapsuleFile).size()));
    sizes.imbue(std::locale::classic());
    CapsuleSize size{NAN, NAN};
    return sizes >> size.radius >> size.length ? size : CapsuleSize{NAN, NAN};
}

std::shared_ptr<const urdf::ModelInterface> readUrdf(const std::filesystem::path& file) {
    std::string text = readWholeFile(file, kLargestUrdf, "a readable URDF file");
    if (text.empty()) {
        throw BadInput(file.string(), "file", "empty", "a readable URDF file");
    }
    refuseXacro(file, text);
    if (text.find("<capsule") != std::string::npos) {
        text = hideCapsules(text);
    }
    tryOut(file, text);
    return parse(file, text);
}

Pose poseOf(const urdf::Pose& pose) {
    const urdf::Rotation& r = pose.rotation;
    return {{pose.position.x, pose.position.y, pose.position.z}, glm::normalize(dquat(r.w, r.x, r.y, r.z))};
}

} // namespace fathom
