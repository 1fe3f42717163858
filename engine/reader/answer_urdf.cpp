// SPDX-License-Identifier: Apache-2.0
// URDFs by urdfdom.
#include "engine/model/reader_pipe.h"
#include "engine/model/urdf_packet.h"
#include "engine/model/xml_text.h"
#include "engine/reader/answers.h"
#include "engine/reader/control_joints.h"
#include "engine/reader/lost_shapes.h"
#include "engine/reader/mjcf.h"
#include "engine/reader/other_kinds.h"
#include "engine/reader/parser_text.h"
#include "engine/reader/urdf_spelling.h"
#include "engine/types/error.h"
#include "engine/types/printable.h"
#include "engine/types/read_file.h"

#include <algorithm>
#include <array>
#include <console_bridge/console.h>
#include <iterator>
#include <set>
#include <urdf_parser/urdf_parser.h>
#include <vector>

namespace fathom {

namespace {

constexpr size_t kLargestUrdf = 16u << 20;
constexpr const char* kTree = "a tree of links below one root";

// Captures the parser's errors.
class Listener : public console_bridge::OutputHandler {
public:
    Listener() { console_bridge::useOutputHandler(this); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
    void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
        if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && errors_.size() < kMaxErrors) {
            errors_.push_back(text.substr(0, std::min(text.find('\n'), kLongestError)));
        }
    }
    const std::vector<std::string>& errors() const { return errors_; }

private:
    static constexpr size_t kMaxErrors = 1000, kLongestError = 300;
    std::vector<std::string> errors_;
};

// The parser requires only one root: links in a loop of joints have no root above them, and links of several
// joints would be visited once per path from the root.
void checkLinks(const urdf::ModelInterface& model, const std::string& file) {
    if (model.links_.size() > kMaxLinks) {
        throw BadInput(file, "robot", std::to_string(model.links_.size()) + " links",
                       std::to_string(kMaxLinks) + " at most");
    }
    std::set<std::string> carried;
    for (const auto& [name, joint] : model.joints_) {
        if (!carried.insert(joint->child_link_name).second) {
            throw BadInput(file, "link " + joint->child_link_name, "the child of several joints", kTree);
        }
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
    throw BadInput(file, "link " + stray->first, "in a loop of joints", kTree);
}

bool hasExpression(std::string_view text) {
    return text.find("${") != std::string_view::npos || text.find("$(") != std::string_view::npos;
}

// An expression of xacro in a visual, where the parser reads no number: an undefined name of a material stays
// in expanded files.
bool isUnreadExpression(std::string_view path, const XmlPiece& tag) {
    constexpr std::string_view kVisual = "robot/link/visual", kShape = "robot/link/visual/geometry";
    const bool numbers = tag.name == "origin" || (path == kShape && tag.name != "mesh") ||
                         hasExpression(xmlAttribute(tag.text, "scale"));
    const bool visual = path == kVisual || (path.starts_with(kVisual) && path[kVisual.size()] == '/') ||
                        (path == "robot/link" && tag.name == "visual");
    return visual && !numbers && hasExpression(tag.text);
}

// Whether xacro makes parts of the robot here. An undefined macro stays in expanded files.
bool isXacro(std::string_view path, const XmlPiece& tag) {
    constexpr std::array<std::string_view, 7> kControl{"macro", "include", "property",    "arg",
                                                       "if",    "unless",  "insert_block"};
    const std::array<std::string_view, 4> unread{"robot/gazebo", "robot/transmission", "robot/ros2_control",
                                                 "robot/link/visual"};
    const auto around = [&](std::string_view place) {
        return path == place || (path.starts_with(place) && path[place.size()] == '/');
    };
    if (tag.name.starts_with("xacro:")) {
        return std::ranges::count(kControl, tag.name.substr(6)) > 0 || std::ranges::none_of(unread, around);
    }
    const bool part = path == "robot" && (tag.name == "link" || tag.name == "joint");
    return hasExpression(tag.text) && (part || around("robot/link") || around("robot/joint")) &&
           !isUnreadExpression(path, tag);
}

// Throws for elements of xacro, or its expressions, that make a link or joint; notes those that do not.
void refuseXacro(const std::filesystem::path& file, const std::string& text,
                 std::vector<std::string>& notes) {
    const std::string name = file.filename().string(), stem = file.stem().stem().string();
    const std::string expanded = stem + (stem + ".urdf" == name ? "_expanded.urdf" : ".urdf");
    std::set<std::string> noted;
    for (XmlTags tags(text); tags.next();) {
        const std::string own(tags.tag().name);
        if (isXacro(tags.path(), tags.tag())) {
            throw BadInput(file.string(), "robot", "a xacro file",
                           "a URDF; expand it with: xacro " + name + " > " + expanded);
        }
        const bool element = own.starts_with("xacro:");
        if ((element || isUnreadExpression(tags.path(), tags.tag())) && noted.insert(own).second) {
            const std::string holder(tags.path().substr(tags.path().rfind('/') + 1));
            std::string line = element ? "<" : "an expression of xacro in <";
            line += printable(own) + "> in <" + printable(holder);
            notes.push_back(line + "> is not expanded and not read");
        }
    }
}

// The joint whose <mimic> has a value that an error quotes in brackets: the parser does not name it.
std::string mimicWith(const std::string& error, const std::string& text) {
    const size_t open = error.find('('), close = error.rfind(')');
    std::string joint;
    for (XmlPieces pieces(text); open < close && close != std::string::npos && pieces.next();) {
        const XmlPiece& piece = pieces.piece();
        joint = piece.name == "joint" && !piece.closes ? xmlAttribute(piece.text, "name") : joint;
        if (piece.name == "mimic" &&
            piece.text.find(error.substr(open + 1, close - open - 1)) != std::string::npos) {
            return "; mimic of joint [" + joint + "]";
        }
    }
    return "";
}

// The parser's first error, and the joint it is in.
std::string faultOf(const std::vector<std::string>& errors, const std::string& text) {
    const auto named = std::ranges::find_if(
        errors, [](const std::string& error) { return error.find("oint [") != std::string::npos; });
    if (errors.empty() || named == errors.begin()) {
        return errors.empty() ? "not understood" : errors[0];
    }
    if (errors[0].find("'robot' element") != std::string::npos &&
        text.find("<!DOCTYPE") != std::string::npos) {
        return "hidden by <!DOCTYPE ...>, which is not read: remove it, and write the values of its entities";
    }
    return errors[0] + (named == errors.end() ? mimicWith(errors[0], text) : "; " + *named);
}

// What the parser would accept instead of the value that it reports.
std::string allowedFor(const std::string& fault) {
    constexpr std::array<std::array<const char*, 2>, 7> kAllowed{
        {{"does not specify limits",
          R"(<limit lower="l" upper="u"/> [rad], [m]; type="continuous" for a joint that turns without limits)"},
         {"has no known type", "revolute, continuous, prismatic, fixed, planar, floating, in small letters"},
         {"'version' specified", R"(<robot version="1.0">, or no version)"},
         {"No name given for the robot", R"(<robot name="n">)"},
         {"is not a valid float", "a finite number, such as -1.5"},
         {"Unable to parse component", R"(numbers with spaces between, such as "0 0 1.5")"},
         {"elements but", R"(three numbers with spaces between, such as "0 0 1.5")"}}};
    const auto found = std::ranges::find_if(
        kAllowed, [&](const auto& line) { return fault.find(line[0]) != std::string::npos; });
    return found == kAllowed.end() ? "a URDF robot" : (*found)[1];
}

void noteSoftLimits(const urdf::ModelInterface& model, std::vector<std::string>& notes) {
    for (const auto& [name, joint] : model.joints_) {
        const auto& soft = joint->safety;
        const auto& hard = joint->limits;
        if (soft && hard && soft->soft_upper_limit > soft->soft_lower_limit &&
            (soft->soft_lower_limit > hard->lower || soft->soft_upper_limit < hard->upper)) {
            notes.push_back(
                "joint " + printable(name) +
                ": the narrower limits of <safety_controller> are not read; arm.joints sets limits");
        }
    }
}

// Isaac Sim closes chains with <loop_joint>, Gazebo with a <joint> of its own: neither is a tree's.
void noteLoops(const std::string& text, std::vector<std::string>& notes) {
    size_t loops = 0;
    std::string first;
    for (XmlTags tags(text); tags.next();) {
        const XmlPiece& tag = tags.tag();
        const std::string type = xmlAttribute(tag.text, "type");
        const bool gazebo = tags.path() == "robot/gazebo" && tag.name == "joint" && !type.empty();
        if ((gazebo && type != "fixed") || (tags.path() == "robot" && tag.name == "loop_joint")) {
            first = loops++ == 0 ? printable(xmlAttribute(tag.text, "name")) : first;
        }
    }
    if (loops > 0) {
        notes.push_back(std::to_string(loops) + " joints of <loop_joint> or <gazebo>, the first " + first +
                        ", are not read: loops stay open");
    }
}

std::string packetOf(const std::filesystem::path& file) {
    std::string text = readWholeFile(file, kLargestUrdf, "a readable URDF file");
    if (text.empty()) {
        throw BadInput(file.string(), "file", "empty", "a readable URDF file");
    }
    std::vector<std::string> notes;
    refuseOtherKinds(file, text);
    refuseXacro(file, text, notes);
    text = isMjcf(text) ? urdfOfMjcf(file, text, notes) : withNormalisedTags(text);
    const Listener listener;
    const std::shared_ptr<urdf::ModelInterface> model = [&] {
        const ParserScope parser;
        return urdf::parseURDF(textForParser(text, file.string()));
    }();
    if (!model) {
        const std::string fault = faultOf(listener.errors(), text);
        throw BadInput(file.string(), "robot", printable(fault), allowedFor(fault));
    }
    checkLinks(*model, file.string());
    checkSpelling(text, file.string(), notes);
    refuseLostShapes(*model, text, file.string(), listener.errors());
    noteLoops(text, notes);
    noteSoftLimits(*model, notes);
    noteCommandLimits(*model, text, notes);
    addControlMimics(*model, text, notes);
    return packUrdf(*model, notes);
}

} // namespace

// The parser and the model's destructor are recursive: tens of thousands of nested links overflow the stack.
bool answerUrdf(const std::filesystem::path& file, int pipe, uint64_t mostMemory) {
    std::string fault, packet;
    try {
        packet = packetOf(file);
    } catch (const std::bad_alloc&) {
        fault = file.string() + ": takes over " + std::to_string(mostMemory >> 20) + " MiB to read";
    } catch (const std::exception& e) {
        fault = e.what();
    }
    const uint64_t size = packet.size();
    return writeText(pipe, fault) && writeAll(pipe, &size, sizeof size) &&
           writeAll(pipe, packet.data(), size);
}

} // namespace fathom
